r"""Contacts of any law, from their start to their release, and their derivatives.

The contacts march from panel to panel of :mod:`bouncing_ball.beyond.laws.panel`, many at the same
time. The derivatives of the end follow from the linearised equations of the collocation: one linear
system for each panel.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.beyond.laws.panel import (
    FINER,
    IMAGINARY_STEP,
    LONGER,
    NODES,
    Balls,
    Panel,
    Start,
    Sweeps,
    gauss_rule,
    grip_of,
    lever_of,
    load_of,
    slopes_of,
)
from bouncing_ball.beyond.laws.scales import scales
from bouncing_ball.paper.contact.damping import Release

if TYPE_CHECKING:
    from bouncing_ball.beyond.laws.contact_law import ContactLaw

# Length of the first panel per node, in units of P^{1/m}/V; twice that with Newton's sweeps.
_FIRST = 0.05
# The duration of a panel over P/V that is allowed for a descending ball even after a shorter panel.
_DOWN = 0.7
# Number of contacts computed at the same time, chosen such that their nodes fit into the cache.
_BLOCK = 2048
# Number of bytes that are allocated and freed once. From then on glibc keeps freed memory;
# otherwise it returns the temporary arrays of each sweep to the system, and a third of the time is
# spent on allocating them again.
_KEPT = 1 << 24
# The largest number of panels of one contact: for a dozen oscillations in the computation of
# orbits, and for some hundreds in a simulation.
_PANELS = 120
MOST_PANELS = 2000
# Relative change of p in a panel up to which plain time is used: p = 0 is then more than a panel
# away.
_FAR = 0.7
# The speed over V that is given to a ball at rest on the table, because otherwise q would not
# change.
_AT_REST = 1e-9
# A time counts as the end of the contact if less than this part of the contact remains.
_END = 1e-12


class ContactEnds(NamedTuple):
    """The ends of contacts: D, p_e and p′_e, NaN where no end was found.

    ``jacobian`` has the derivatives of (D, p_e, p′_e) with respect to (φ, v, Λ, w), shape
    (..., 3, 4). ``contraction`` is the factor by which the contact multiplies areas of the phase
    plane: exp(-∫ ∂f/∂p′ dt), times a factor for a step of the force at the release. ``integrals``
    has ∫ p dt and ∫ p′ w dt over the contact, with the table's level w = Λ sin(φ + t), shape
    (..., 2); they are NaN unless they are computed.
    """

    duration: np.ndarray
    penetration: np.ndarray
    rate: np.ndarray
    jacobian: np.ndarray
    contraction: np.ndarray
    integrals: np.ndarray


def _some(which: np.ndarray, law: ContactLaw, *rows: Any) -> Any:
    """The laws of some of the contacts, and tuples of arrays whose last axis is the contacts.

    The indices are in ascending order, so that all of them select the rows themselves.
    """
    if which.size == rows[-1][0].shape[-1]:
        return law, *rows
    return law.take(which), *(row._make(x[..., which] for x in row) for row in rows)


def _in_time(law: ContactLaw, start: Start, now: Balls, until: np.ndarray | None) -> Panel:
    """The next panel in plain time, which costs half as much and suffices if q hardly changes."""
    m = law.root
    lever = lever_of(m, now.root)
    now = now._replace(root=now.root**m, push=now.push / lever, step=now.step * lever)
    panel = Sweeps(law, start, now, until, m=1).panel()
    root = np.maximum(panel.root, 0.0) ** (1 / m)
    then = lever_of(m, root[-1])
    following = panel.following / np.where(panel.good, then, lever)
    return panel._replace(root=root, final=panel.final * then, following=following)


def _in_root(law: ContactLaw, start: Start, now: Balls, until: np.ndarray | None) -> Panel:
    """The next panel in the time s of the root."""
    return Sweeps(law, start, now, until).panel()


def _next(law: ContactLaw, start: Start, now: Balls, until: np.ndarray | None) -> Panel:
    """The next panels, each in plain time if that suffices and in s otherwise."""
    far = law.root * np.abs(now.rate) * now.step < _FAR * now.root
    sides = [np.flatnonzero(far), np.flatnonzero(~far)]
    panels = []
    for which, follow in zip(sides, (_in_time, _in_root), strict=True):
        if which.size:
            limit = None if until is None else until[which]
            laws, starts, balls = _some(which, law, start, now)
            panels.append(follow(laws, starts, balls, limit))
    order = np.argsort(np.concatenate(sides))
    return Panel(*(np.concatenate(x, axis=-1)[..., order] for x in zip(*panels, strict=True)))


def _longest(m: int, now: Balls, panel: Panel) -> np.ndarray:
    """The greatest length of the next panels; time runs faster the deeper a ball is."""
    root = panel.root[-1]
    rate = panel.rate[-1]
    time = np.maximum(LONGER * (panel.time[-1] - now.time), _DOWN * now.length / now.speed)
    deeper = (root**m + rate * time) ** (1 / m)
    return np.where(rate > 0, (deeper - root) / rate, np.inf)


def _derivatives(
    law: ContactLaw, start: Start, panel: Panel, by: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The derivatives of (q, p′, t) at the ends of panels, and ∫ ∂F/∂p′ ds.

    They are derivatives with respect to (φ, v, Λ, w), and ``by`` are those at the start of the
    panels, shape (..., 3, 4). They solve the linearised equations of the collocation ::

        δF = F_q δq + F_u δp′ + F_t (δφ + δt) + F_Λ δΛ + F_w δw
    """
    count = len(panel.push)
    rule = gauss_rule(count)
    m = law.root
    q = panel.root[:-1].T
    angle = start.phase[:, np.newaxis] + panel.time[:-1].T
    lever = lever_of(m, q)
    bend = m * (m - 1) * q ** max(m - 2, 0)
    depth = panel.root[:-1] ** m
    rate = panel.rate[:-1]
    load = load_of(start, panel.time[:-1]) if law.feels_load else 0.0
    slopes = slopes_of(lambda p, u: law.loaded_force(p, u, load), depth, rate)

    def column(rows):
        return rows[:, :, np.newaxis]

    by_root = column(bend * panel.push.T / lever - lever * lever * slopes.by_penetration.T)
    by_rate = column(-lever * slopes.by_rate.T)
    # The share of the load that the force carries; the force is linear in the load.
    if law.feels_load:
        carried = law.loaded_force(depth, rate, 1.0) - law.force(depth, rate)
    else:
        carried = np.zeros(1)
    felt = lever * (1 - carried.T)
    by_time = column(-felt * start.amplitude[:, np.newaxis] * np.cos(angle))
    step = panel.step[:, np.newaxis, np.newaxis]
    whole = step * rule.integral
    once = whole[:, :-1]
    to_end = whole[:, -1:]
    # δp′ = δp′₀ + once δF, δq = δq₀ + once δp′, δt = δt₀ + bent δq
    twice = step * (once @ rule.integral[:-1])
    bent = once * bend[:, np.newaxis]
    root0, rate0, time0 = (by[:, np.newaxis, k] for k in range(3))
    free_root = root0 + step * rule.node * rate0
    known = by_root * free_root + by_rate * rate0 + by_time * (time0 + bent @ free_root)
    known[:, :, 0] += by_time[:, :, 0]
    known[:, :, 2] -= felt * np.sin(angle)
    known[:, :, 3] += felt
    matrix = np.eye(count) - by_root * twice - by_rate * once - by_time * (bent @ twice)
    pushed = np.linalg.solve(matrix, known)
    of_root = free_root + twice @ pushed
    of_rate = rate0 + once @ pushed
    ends = [
        root0 + to_end @ of_rate,
        rate0 + to_end @ pushed,
        time0 + to_end @ (column(bend) * of_root),
    ]
    return np.concatenate(ends, axis=1), (to_end @ by_rate)[:, 0, 0]


def _at_release(
    law: ContactLaw, start: Start, panel: Panel, by: np.ndarray, strain: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The derivatives of (D, p_e, p′_e) and the contraction, for panels that end at the release.

    ``by`` are the derivatives of (q, p′, t) at the ends of the panels, and ``strain`` is the
    integral of ∂F/∂p′ over the contacts.
    """
    m = law.root
    root = panel.root[-1]
    rate = panel.rate[-1]
    lever = lever_of(m, root)
    angle = start.phase + panel.time[-1]
    load = load_of(start, panel.time[-1])
    grip_by_root = np.imag(grip_of(law, m, root + IMAGINARY_STEP, rate, load)) / IMAGINARY_STEP.imag
    grip_by_rate = np.imag(grip_of(law, m, root, rate + IMAGINARY_STEP, load)) / IMAGINARY_STEP.imag
    grip_by_load = np.imag(grip_of(law, m, root, rate, load + IMAGINARY_STEP)) / IMAGINARY_STEP.imag
    grip_by_root = np.where(panel.surfaced, 1.0, grip_by_root)
    grip_by_rate = np.where(panel.surfaced, 0.0, grip_by_rate)
    grip_by_load = np.where(panel.surfaced, 0.0, grip_by_load)
    turning = -start.amplitude * np.cos(angle)
    falls = grip_by_root * rate + grip_by_rate * panel.final + grip_by_load * turning * lever
    # If the force has a step at the release, the rate of change of the grip has a step too.
    force = law.loaded_force(root**m, rate, load)
    step = np.where(grip_by_rate == 0, 0.0, grip_by_rate * lever * force)
    by_root, by_rate, by_time = (by[:, k] for k in range(3))
    by_load = turning[:, np.newaxis] * by_time
    by_load += np.stack([turning, 0 * angle, -np.sin(angle), np.ones_like(angle)], axis=1)

    def column(row):
        return row[:, np.newaxis]

    moved = column(grip_by_root) * by_root + column(grip_by_rate) * by_rate
    moved = moved + column(grip_by_load) * by_load
    # How much later in s the release is.
    later = -moved / column(falls)
    ends = [
        by_time + column(lever) * later,
        column(lever) * (by_root + column(rate) * later),
        by_rate + column(panel.final) * later,
    ]
    return np.stack(ends, axis=1), np.exp(strain) * falls / (falls + step)


def _integrals(law: ContactLaw, start: Start, panel: Panel) -> np.ndarray:
    """∫ p dt and ∫ p′ Λ sin(φ + t) dt over panels in s, shape (contacts, 2)."""
    root = panel.root[:-1]
    weight = gauss_rule(len(panel.push)).integral[-1]
    passed = weight[:, np.newaxis] * panel.step * lever_of(law.root, root)
    sunk = root**law.root
    moved = panel.rate[:-1] * (start.weight - load_of(start, panel.time[:-1]))
    return np.stack([(sunk * passed).sum(axis=0), (moved * passed).sum(axis=0)], axis=1)


def _begin(law: ContactLaw, start: Start, nodes: int) -> Balls:
    """The balls at the start of their contacts."""
    scale = scales(law, np.abs(start.rate), start.weight + np.abs(start.amplitude))
    rest = _AT_REST * scale.speed
    rate = np.where((start.depth == 0) & (start.rate < rest), rest, start.rate)
    zero = np.zeros_like(rate)
    side = np.where(law.kink(start.depth, rate) < 0, -1.0, 1.0) if law.has_kink else zero
    return Balls(
        root=start.depth ** (1 / law.root),
        rate=rate,
        time=zero,
        push=zero,
        step=_FIRST * scale.length ** (1 / law.root) / scale.speed * nodes,
        length=scale.length,
        speed=scale.speed,
        side=side,
    )


class _March:
    """A row of contacts on their way to the release.

    ``balls`` holds their states, ``by`` the derivatives of (q, p′, t), ``strain`` the integral of
    ∂F/∂p′, and ``done`` says which contacts have ended.
    """

    def __init__(
        self,
        law: ContactLaw,
        start: Start,
        until: np.ndarray | None,
        differentiate: bool,
        integrate: bool,
    ) -> None:
        size = start.rate.size
        self.law = law
        self.start = start
        self.until = until
        self.differentiate = differentiate
        self.integrate = integrate
        self.count = FINER if differentiate else NODES
        # Plain time needs neither the root at the nodes nor the same nodes for all contacts.
        self.allows_time = law.root > 1 and not (differentiate or integrate)
        self.balls = Balls(*np.full((len(Balls._fields), size), np.nan))
        self.by = np.zeros((size, 3, 4))
        self.by[:, 1, 1] = 1.0
        self.strain = np.zeros(size)
        self.jacobian = np.full((size, 3, 4), np.nan)
        self.contraction = np.full(size, np.nan)
        self.integrals = np.full((size, 2), 0.0 if integrate else np.nan)
        self.done = np.zeros(size, dtype=bool)

    def run(self, panels: int) -> None:
        """Follow the contacts until all have ended, for at most this number of panels."""
        active = np.flatnonzero(np.isfinite(self.start).all(axis=0))
        is_newton = self.law.root == 1 and not self.differentiate
        law, start = _some(active, self.law, self.start)
        begin = _begin(law, start, nodes=self.count * (1 + is_newton))
        for row, value in zip(self.balls, begin, strict=True):
            row[active] = value
        for _ in range(panels if active.size else 0):
            for here in np.array_split(active, -(-active.size // _BLOCK)):
                self._advance(here)
            active = active[~self.done[active]]
            if not active.size:
                break

    def _advance(self, here: np.ndarray) -> None:
        """Try the next panel of the contacts with these indices."""
        until = None if self.until is None else self.until[here]
        law, start = _some(here, self.law, self.start)
        now = Balls(*(row[here] for row in self.balls))
        if self.allows_time:
            panel = _next(law, start, now, until)
        else:
            panel = Sweeps(law, start, now, until, self.count).panel()
        following = panel.following
        if law.root > 1:
            longest = np.where(panel.good, _longest(law.root, now, panel), np.inf)
            following = np.minimum(following, longest)
        self.balls.step[here] = following
        good = np.flatnonzero(panel.good)
        law, start, panel = _some(good, law, start, panel)
        self._accept(here[good], law, start, panel)

    def _accept(self, here: np.ndarray, law: ContactLaw, start: Start, panel: Panel) -> None:
        """Move the contacts with these indices to the ends of their panels."""
        self.balls.root[here] = panel.root[-1]
        self.balls.rate[here] = panel.rate[-1]
        self.balls.time[here] = panel.time[-1]
        self.balls.push[here] = panel.final
        self.balls.side[here[panel.turned]] *= -1
        self.done[here] = panel.last
        if self.integrate:
            self.integrals[here] += _integrals(law, start, panel)
        if self.differentiate and here.size:
            self.by[here], more = _derivatives(law, start, panel, self.by[here])
            self.strain[here] += more
            end = np.flatnonzero(panel.last)
            at = here[end]
            law, start, panel = _some(end, law, start, panel)
            self.jacobian[at], self.contraction[at] = _at_release(
                law, start, panel, self.by[at], self.strain[at]
            )

    def ends(self) -> ContactEnds:
        """The ends of the contacts, or the states at the given times."""
        root, rate, time = (
            np.where(self.done, x, np.nan)
            for x in (self.balls.root, self.balls.rate, self.balls.time)
        )
        depth = np.maximum(root, 0.0) ** self.law.root
        if self.until is None and self.law.release is Release.DISPLACEMENT:
            depth *= 0
        self.integrals[~self.done] = np.nan
        return ContactEnds(
            duration=time,
            penetration=depth,
            rate=rate,
            jacobian=self.jacobian,
            contraction=self.contraction,
            integrals=self.integrals,
        )


def march(
    law: ContactLaw,
    start: Start,
    panels: int = _PANELS,
    until: np.ndarray | None = None,
    *,
    differentiate: bool = False,
    integrate: bool = False,
) -> ContactEnds:
    """A row of contacts, from states with p ≥ 0 to the release.

    Parameters
    ----------
    law : ContactLaw
        One law, or one for each contact.
    start : Start
        The states. A ball at p = 0 moves down, or is at rest on the table.
    panels : int
        The largest number of panels that are tried for each contact; an oscillation takes about
        eight.
    until : array, optional
        Times after the start at which p and p′ are computed, instead of at the release.
    differentiate : bool
        Whether derivatives are computed, for contacts that start at p = 0; otherwise they are NaN.
    integrate : bool
        Whether the integrals are computed, for a table with gravity (w = 1).

    Examples
    --------
    After a quarter of an oscillation the ball is at the depth v/ϖ:

    >>> from bouncing_ball.beyond.laws.linear import LinearLaw
    >>> zero = np.zeros(1)
    >>> start = Start(zero, np.full(1, np.pi), zero, zero, zero)
    >>> march(LinearLaw(np.pi, 0.0), start, until=np.full(1, 0.5)).penetration.round(12).tolist()
    [1.0]
    """
    np.empty(_KEPT, dtype=np.int8)
    contacts = _March(law, start, until, differentiate, integrate)
    with np.errstate(all="ignore"):
        contacts.run(panels)
    return contacts.ends()


def states(
    law: ContactLaw, start: Start, end: Sequence[np.ndarray], time: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """p and p′ at times within contacts whose ends (D, p_e, p′_e) are known.

    All arrays have one entry per contact.
    """
    inside = np.flatnonzero((time > 0) & (time < (1 - _END) * end[0]))
    laws, own = _some(inside, law, start)
    found = march(laws, own, MOST_PANELS, time[inside])
    depth = np.where(time > 0, end[1], start.depth)
    rate = np.where(time > 0, end[2], start.rate)
    depth[inside] = found.penetration
    rate[inside] = found.rate
    return depth, rate


def _row(
    law: ContactLaw, *columns: ArrayLike
) -> tuple[ContactLaw, list[np.ndarray], tuple[int, ...]]:
    """The laws and the columns, broadcast and flattened, and the shape to which they broadcast."""
    arrays = [np.asarray(x, dtype=float) for x in columns]
    shape = np.broadcast_shapes(law.shape, *(x.shape for x in arrays))
    return law.flat(shape), [np.broadcast_to(x, shape).reshape(-1) for x in arrays], shape


def contacts(
    law: ContactLaw,
    speed: ArrayLike,
    phase: ArrayLike = 0.0,
    amplitude: ArrayLike = 0.0,
    weight: ArrayLike = 1.0,
) -> ContactEnds:
    """Contacts that start at p = 0 with speed v > 0 at a phase φ of the table.

    Parameters
    ----------
    law : ContactLaw
        One law, or one for each contact.
    speed, phase, amplitude : array_like
        v, φ and Λ.
    weight : array_like
        The weight w: 1, or 0 for a free impact.

    Returns
    -------
    ContactEnds
        Arrays of the shape to which the arguments broadcast. They are NaN where v ≤ 0, and where
        the ball is not released within a dozen oscillations.

    Examples
    --------
    A quarter of the energy is left after an impact with r = 1/2:

    >>> from bouncing_ball.beyond.laws.hertzian import Tsuji, tsuji_damping
    >>> free = contacts(Tsuji(100.0, tsuji_damping(0.5)), 3.0, weight=0.0)
    >>> round(float(free.rate), 12)
    -1.5
    """
    laws, (v, phi, lam, w), shape = _row(law, speed, phase, amplitude, weight)
    start = Start(depth=0 * v, rate=np.where(v > 0, v, np.nan), phase=phi, amplitude=lam, weight=w)
    found = march(laws, start, differentiate=True)
    return ContactEnds(*(x.reshape((*shape, *x.shape[1:])) for x in found))


def integrals(
    law: ContactLaw,
    duration: ArrayLike,
    depth: ArrayLike,
    rate: ArrayLike,
    phase: ArrayLike,
    amplitude: ArrayLike,
) -> np.ndarray:
    """∫ p dt and ∫ p′ w dt over contacts that start with p and p′ and last D, with w = Λ sin τ.

    The shape is (2, ...); a contact without a duration has the integrals 0.

    Examples
    --------
    A fast ball hardly feels gravity, so that p = 1000 sin πt, whose integral is 2000/π:

    >>> from bouncing_ball.beyond.laws.linear import LinearLaw
    >>> law = LinearLaw(np.pi, 0.0)
    >>> sunk, moved = integrals(law, 1.0, 0.0, 1000.0 * np.pi, 0.0, 0.0)
    >>> round(float(sunk) / 1000, 3), float(moved)
    (0.637, 0.0)
    """
    laws, (lasts, p, u, phi, lam), shape = _row(law, duration, depth, rate, phase, amplitude)
    start = Start(
        depth=p,
        rate=np.where(lasts > 0, u, np.nan),
        phase=phi,
        amplitude=lam,
        weight=np.ones_like(p),
    )
    found = march(laws, start, MOST_PANELS, integrate=True).integrals.T
    return np.where(lasts > 0, found, 0.0).reshape(2, *shape)


def path(
    law: ContactLaw,
    found: ContactEnds,
    time: ArrayLike,
    speed: ArrayLike,
    phase: ArrayLike = 0.0,
    amplitude: ArrayLike = 0.0,
    weight: ArrayLike = 1.0,
) -> tuple[np.ndarray, np.ndarray]:
    """p and p′ a time after the start of contacts, with 0 ≤ time ≤ D.

    Parameters
    ----------
    law : ContactLaw
    found : ContactEnds
        The result of :func:`contacts` for these starts.
    time : array_like
        The times; they may have additional leading axes.
    speed, phase, amplitude, weight : array_like
        The starts, as in :func:`contacts`.

    Examples
    --------
    >>> from bouncing_ball.beyond.laws.linear import LinearLaw
    >>> law = LinearLaw(np.pi, 0.0)
    >>> depth, rate = path(law, contacts(law, np.pi, weight=0.0), 0.5, np.pi, weight=0.0)
    >>> round(float(depth), 12), abs(round(float(rate), 12))
    (1.0, 0.0)
    """
    ends = found[:3]
    start = speed, phase, amplitude, weight
    laws, columns, shape = _row(law, time, *ends, *start)
    t, duration, end_depth, end_rate, v, phi, lam, w = columns
    start = Start(depth=np.zeros_like(t), rate=v, phase=phi, amplitude=lam, weight=w)
    depth, rate = states(laws, start, (duration, end_depth, end_rate), t)
    return depth.reshape(shape), rate.reshape(shape)
