r"""The march of contacts of any law, from panel to panel, from their start to their release.

Many contacts march at the same time. Each tries its next panel
(:mod:`bouncing_ball_beyond.models.laws.sweeps`) until one is accurate, and moves to its end; the
derivatives move with it (:mod:`bouncing_ball_beyond.models.laws.linearised`).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from bouncing_ball_beyond.models.laws.force_law import ForceLaw
from bouncing_ball_beyond.models.laws.linearised import at_end, at_release
from bouncing_ball_beyond.models.laws.panel import (
    FINER,
    NODES,
    BallsInContact,
    Panel,
    Start,
    lever_of,
    selected,
)
from bouncing_ball_beyond.models.laws.scales import scales
from bouncing_ball_beyond.models.laws.sweeps import LONGER, Sweeps

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
# The time since the start of a contact, over P/V, from which Newton's sweeps are used in plain
# time: a free impact takes about three, and after it a ball that is still in contact settles.
_SETTLING = 12.0
# The speed over V that is given to a ball at rest on the table, because otherwise q would not
# change.
_AT_REST = 1e-9


class ContactEnds(NamedTuple):
    """The ends of contacts: D, p_e and p′_e, NaN where no end was found.

    ``jacobian`` has the derivatives of (D, p_e, p′_e) with respect to (φ, v, Λ, w), shape
    (..., 3, 4). ``contraction`` is the factor by which the contact multiplies areas of the phase
    plane: exp(-∫ ∂f/∂p′ dt), times a factor for a step of the force at the release.
    """

    duration: np.ndarray
    penetration: np.ndarray
    rate: np.ndarray
    jacobian: np.ndarray
    contraction: np.ndarray


def _in_plain_time(
    law: ForceLaw, start: Start, now: BallsInContact, until: np.ndarray | None, *, linearised: bool
) -> Panel:
    """The next panel in plain time, which costs half as much and suffices if q hardly changes.

    For balls that lie on their contacts its sweeps are Newton's, ``linearised``.
    """
    m = law.root
    lever = lever_of(m, now.root)
    step = now.step * lever
    # In plain time, the length of a panel that ends at a given time is known.
    if until is not None and linearised:
        step = np.minimum(step, until - now.time)
    now = now._replace(root=now.root**m, push=now.push / lever, step=step)
    panel = Sweeps(law, start, now, until, m=1, linearised=linearised).panel()
    root = np.maximum(panel.root, 0.0) ** (1 / m)
    then = lever_of(m, root[-1])
    following = panel.following / np.where(panel.good, then, lever)
    return panel._replace(root=root, final=panel.final * then, following=following)


def _in_root(law: ForceLaw, start: Start, now: BallsInContact, until: np.ndarray | None) -> Panel:
    """The next panel in the time s of the root."""
    return Sweeps(law, start, now, until).panel()


def _next(law: ForceLaw, start: Start, now: BallsInContact, until: np.ndarray | None) -> Panel:
    """The next panels, each in plain time if that suffices and in s otherwise."""
    far = law.root * np.abs(now.rate) * now.step < _FAR * now.root
    settling = _SETTLING * now.length
    lies = far & (now.time * now.speed > settling)
    # Next to a given time, Picard's sweeps suffice.
    if until is not None:
        lies &= (until - now.time) * now.speed > settling
    sides = [np.flatnonzero(far & ~lies), np.flatnonzero(lies), np.flatnonzero(~far)]
    follows: tuple[Callable[..., Panel], ...] = (
        partial(_in_plain_time, linearised=False),
        partial(_in_plain_time, linearised=True),
        _in_root,
    )
    panels = []
    for which, follow in zip(sides, follows, strict=True):
        if which.size:
            limit = None if until is None else until[which]
            laws, starts, balls = selected(which, law, start, now)
            panels.append(follow(laws, starts, balls, limit))
    order = np.argsort(np.concatenate(sides))
    return Panel(*(np.concatenate(x, axis=-1)[..., order] for x in zip(*panels, strict=True)))


def _longest(m: int, now: BallsInContact, panel: Panel) -> np.ndarray:
    """The greatest length of the next panels; time runs faster the deeper a ball is."""
    root = panel.root[-1]
    rate = panel.rate[-1]
    time = np.maximum(LONGER * (panel.time[-1] - now.time), _DOWN * now.length / now.speed)
    sunk = (root**m + rate * time) ** (1 / m) - root
    # A ball that hardly sinks any more, whose q changes by less than its rounding, has dq = dp/λ.
    length = np.where(sunk > 0, sunk / rate, time / lever_of(m, root))
    return np.where(rate > 0, length, np.inf)


def _begin(law: ForceLaw, start: Start, nodes: int) -> BallsInContact:
    """The balls at the start of their contacts."""
    scale = scales(law, np.abs(start.rate), start.weight + np.abs(start.amplitude))
    rest = _AT_REST * scale.speed
    rate = np.where((start.depth == 0) & (start.rate < rest), rest, start.rate)
    zero = np.zeros_like(rate)
    side = np.where(law.kink(start.depth, rate) < 0, -1.0, 1.0) if law.has_kink else zero
    return BallsInContact(
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
        law: ForceLaw,
        start: Start,
        until: np.ndarray | None,
        differentiate: bool,
    ) -> None:
        np.empty(_KEPT, dtype=np.int8)
        size = start.rate.size
        self.law = law.started(start.rate) if law.feels_start_speed else law
        self.start = start
        self.until = until
        self.differentiate = differentiate
        self.count = FINER if differentiate else NODES
        # Plain time needs neither the root at the nodes nor the same nodes for all contacts.
        self.allows_time = law.root > 1 and not differentiate
        self.balls = BallsInContact(*np.full((len(BallsInContact._fields), size), np.nan))
        self.by = np.zeros((size, 3, 4))
        self.by[:, 1, 1] = 1.0
        self.strain = np.zeros(size)
        self.jacobian = np.full((size, 3, 4), np.nan)
        self.contraction = np.full(size, np.nan)
        self.done = np.zeros(size, dtype=bool)
        self.states: list[tuple[np.ndarray, BallsInContact]] | None = None

    def begin(self) -> None:
        """Set the balls to the starts of their contacts."""
        active = self._known()
        is_newton = self.law.root == 1 and not self.differentiate
        law, start = selected(active, self.law, self.start)
        begin = _begin(law, start, nodes=self.count * (1 + is_newton))
        for row, value in zip(self.balls, begin, strict=True):
            row[active] = value

    def record(self) -> None:
        """From now on, keep the states of the balls at the ends of their panels."""
        self.states = []
        self._record(self._known())

    def _known(self) -> np.ndarray:
        return np.flatnonzero(np.isfinite(self.start).all(axis=0))

    def _record(self, here: np.ndarray) -> None:
        if self.states is not None:
            self.states.append((here, BallsInContact(*(row[here] for row in self.balls))))

    def run(self, panels: int, enough: np.ndarray) -> None:
        """Follow the contacts until all have ended or have reached the times ``enough``, for at
        most this number of panels.
        """
        active = self._known()
        for _ in range(panels if active.size else 0):
            for here in np.array_split(active, -(-active.size // _BLOCK)):
                self._advance(here)
            active = active[~self.done[active]]
            active = active[self.balls.time[active] < enough[active]]
            if not active.size:
                break

    def _advance(self, here: np.ndarray) -> None:
        """Try the next panel of the contacts with these indices."""
        until = None if self.until is None else self.until[here]
        law, start = selected(here, self.law, self.start)
        now = BallsInContact(*(row[here] for row in self.balls))
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
        law, start, panel = selected(good, law, start, panel)
        self._accept(here[good], law, start, panel)

    def _accept(self, here: np.ndarray, law: ForceLaw, start: Start, panel: Panel) -> None:
        """Move the contacts with these indices to the ends of their panels."""
        self.balls.root[here] = panel.root[-1]
        self.balls.rate[here] = panel.rate[-1]
        self.balls.time[here] = panel.time[-1]
        self.balls.push[here] = panel.final
        self.balls.side[here[panel.turned]] *= -1
        self.done[here] = panel.last
        self._record(here)
        if self.differentiate and here.size:
            self.by[here], more = at_end(law, start, panel, self.by[here])
            self.strain[here] += more
            end = np.flatnonzero(panel.last)
            if not end.size:
                return
            at = here[end]
            law, start, panel = selected(end, law, start, panel)
            self.jacobian[at], self.contraction[at] = at_release(
                law, start, panel, self.by[at], self.strain[at]
            )

    def ends(self) -> ContactEnds:
        """The ends of the contacts, or the states at the given times."""
        root, rate, time = (
            np.where(self.done, x, np.nan)
            for x in (self.balls.root, self.balls.rate, self.balls.time)
        )
        depth = np.maximum(root, 0.0) ** self.law.root
        if self.until is None and self.law.release.at_surface:
            depth *= 0
        return ContactEnds(
            duration=time,
            penetration=depth,
            rate=rate,
            jacobian=self.jacobian,
            contraction=self.contraction,
        )


def march(
    law: ForceLaw,
    start: Start,
    panels: int = _PANELS,
    until: np.ndarray | None = None,
    *,
    differentiate: bool = False,
    longest: float = np.inf,
) -> ContactEnds:
    """A row of contacts, from states with p ≥ 0 to the release.

    Parameters
    ----------
    law : ForceLaw
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
    longest : float
        The time after which contacts are not followed any further.

    Examples
    --------
    After a quarter of an oscillation the ball is at the depth v/ϖ:

    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> zero = np.zeros(1)
    >>> start = Start(zero, np.full(1, np.pi), zero, zero, zero)
    >>> march(SpringDamper(np.pi, 0.0), start, until=np.full(1, 0.5)).penetration.round(12).tolist()
    [1.0]
    """
    contacts = _March(law, start, until, differentiate)
    with np.errstate(all="ignore"):
        if start.rate.size:
            contacts.begin()
        contacts.run(panels, enough=np.full(start.rate.size, longest))
    return contacts.ends()


def march_through(
    law: ForceLaw, start: Start, contact: np.ndarray, time: np.ndarray, panels: int
) -> ContactEnds:
    """The states at several times of each contact; NaN if it was not followed to the last of them.

    Each contact is followed once, and each time is reached from the last panel before it.

    Parameters
    ----------
    law : ForceLaw
        One law.
    start : Start
        The states at the starts of the contacts.
    contact, time : array
        The index of a start, and a time after it and before the release.
    panels : int
        The largest number of panels that are tried for each contact.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> zero = np.zeros(1)
    >>> start = Start(zero, np.full(1, np.pi), zero, zero, zero)
    >>> which = np.zeros(2, dtype=int)
    >>> found = march_through(SpringDamper(np.pi, 0.0), start, which, np.array([0.25, 0.5]), 99)
    >>> (found.penetration**2).round(12).tolist()
    [0.5, 1.0]
    """
    contacts = _March(law, start, None, differentiate=False)
    last = np.zeros(start.rate.size)
    np.maximum.at(last, contact, time)
    single = Start(*(row[contact] for row in start))
    samples = _March(law, single, time, differentiate=False)
    with np.errstate(all="ignore"):
        contacts.begin()
        contacts.record()
        contacts.run(panels, enough=last)
        for row, value in zip(samples.balls, _before(contacts, contact, time), strict=True):
            row[:] = value
        # A contact that ends before the time has no state there.
        too_late = contacts.balls.time[contact] < time
        lost = ~contacts.done & (contacts.balls.time < last)
        samples.start.rate[too_late | lost[contact]] = np.nan
        samples.run(panels, enough=time)
    return samples.ends()


def _before(contacts: _March, contact: np.ndarray, time: np.ndarray) -> BallsInContact:
    """The last recorded states of contacts at or before given times."""
    which = np.concatenate([here for here, _ in contacts.states or []])
    columns = zip(*(balls for _, balls in contacts.states or []), strict=True)
    rows = BallsInContact(*map(np.concatenate, columns))
    # Complex numbers are ordered by their real parts first.
    place = which + 1j * rows.time
    order = np.argsort(place, kind="stable")
    found = order[np.searchsorted(place[order], contact + 1j * time, side="right") - 1]
    return BallsInContact(*(row[found] for row in rows))
