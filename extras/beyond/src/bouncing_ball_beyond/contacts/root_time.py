"""Integrate contacts of any force law in a time in which the motion is analytic (docs/panels.md).

1. Root time. The penetration p satisfies p″ = a - f(p, p′), with the load a = g + w″(τ + t). Forces
   such as p^{3/2} are analytic functions of q = p^{1/m}. In the *root time* s, with dt = λ ds and
   λ = m q^{m-1},

       dq/ds = v,    dv/ds = F = λ (a - f),    dt/ds = λ,    with v = p′,

   and the motion is analytic up to both ends of a contact.
2. A panel (:func:`solve_panel`). On a panel of the length h, F is a polynomial with the values F_j
   at the Gauss nodes. Sweeps find these values: v is the integral of F, q is the integral of v, and
   t is the integral of λ. Each sweep adds two orders in ωh, where ω is the frequency of the
   oscillation in s.
3. Accuracy (:func:`_resolved`). If the last Legendre coefficients of v are ε, the error of the end
   of the panel is of the order ε².
4. Events (:func:`_next_panel`). An *event* is a kink of the force, the release, or the end of a
   period of the table. A panel ends at its first event.
5. Ends that the motion only just reaches (:func:`_maxima`). A panel also ends at a maximum of the
   release function that may be above zero.
6. Permanent contacts (:meth:`_Contacts.compare_periods`). The motion is compared with the motion
   one period before.
7. Derivatives (:func:`carried`). They solve the linearised equations of the collocation.
8. Contacts of a given length (:func:`integrate_to`). A contact that resembles a free impact of its
   speed is one panel. The linear equations of the free impact then make each sweep nearly a Newton
   step.

Arrays of contacts have the shape (rows,), values at nodes the shape (nodes, rows), and derivatives
the shape (directions, rows).
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.optimize import elementwise

from bouncing_ball_beyond.contacts.balls import H
from bouncing_ball_beyond.tables.table import Table, Values

# Each constant was halved and doubled, with nine laws and 60 contacts each (docs/panels.md). "At
# half" and "at twice" give the effect. "No effect" means that ends, times and speeds agreed within
# 1e-11, and the numbers of evaluations within 5 %.

RESOLVED = 1e-7
"""Limit of the last Legendre coefficients of v of an accepted panel, divided by the maximum speed.
The error at the end of the panel is the square of these coefficients. At half: no effect. At twice:
5 % fewer evaluations."""

FALLING = 0.02
"""Largest ratio of the last to the middle Legendre coefficients of an accepted panel.
If a panel contains a kink, the ratio is (1/2)² to (1/2)³, and the error is larger than the square
of the last coefficients. At half and at twice: no effect. `FALLING` matters for kinks that the law
does not declare. For example, with a limited damper and without `FALLING`, the median error of ends
is 4e-9 instead of 5e-15."""

SMOOTH = 1e-13
"""Size of the last coefficients below which a panel is accepted even if its coefficients do not
fall, because all of them are rounding errors. At half and at twice: no effect."""

SWEEPS = 20
"""Maximum number of sweeps of a panel. A panel that needs more sweeps is made shorter.
At half: 14 % more evaluations. At twice: one slow contact, whose end is only just reached, changes
by 2e-3."""

CONVERGED = 1e-13
"""Change of v in a sweep, divided by the maximum speed, below which the sweeps stop.
At half and at twice: evaluations change by 3 %."""

ACCEPTED_CHANGE = 1e-12
"""Limit of the last change of v, divided by the maximum speed, for a panel to be accepted.
At half and at twice: evaluations change by 3 %."""

EARLY = 3
"""Sweep whose change of v determines the length of the next panel.
At half and at twice: evaluations change by 3 %."""

WANTED = 0.03
"""Target for the change of v in the sweep `EARLY`, divided by the maximum speed.
At half and at twice: evaluations change by 3 %. This value needed the fewest sweeps."""

LONGER = 2.0
"""Largest ratio of the lengths of successive panels.
At half: panels cannot grow, and evaluations increase by a factor of 2.6. At twice: no effect."""

EVENT_STEP = 1e-13
"""Limit of the last Newton step to an event, divided by the length of the panel.
The event is found if the step is smaller. At half and at twice: no effect."""

SAME = 1e-10
"""Distance of a kink from the release, divided by the length of the panel, below which the kink
counts as the release. At half and at twice: no effect. Without `SAME`, an impact on a limited
damper with ζ = 0, whose kink is at the release, takes 2096 panels instead of 8."""

MOST_PANELS = 4000
"""Maximum number of panels of a contact. The end of a contact that needs more panels is NaN.
An impact needs about six. At half: the ends of contacts with 2000 to 4000 panels would be NaN."""

PATIENT = 8
"""Number of panels after which the ball lies on the table, and Newton's method solves the contact.
At half: half as many panels of long contacts. At five times: five to ten times as much time for
contacts of orbits of a strongly damped law that last for a period."""

PERIODS = 30
"""Number of periods after which a contact counts as permanent. The caller may give another number.
At half and at twice: no effect."""

SAFE = 8.0
"""Safety factor on the sum of all further changes of a contact. If the sum times this factor cannot
lift the ball, the contact is permanent; see :meth:`_Contacts.compare_periods`.
At half: 5 % fewer evaluations. At twice: 3 % more."""

CONTACTS_AT_ONCE = 1000
"""Number of contacts that are followed together. Their nodes fit into a processor's cache.
At half and at twice: the same time within 25 %."""

FEW_CONTACTS = 50
"""Number of contacts up to which Newton's method solves the panels if m = 1. At half and at twice:
the same time within 25 %."""

TINY = 1e-300
"""Smallest divisor. It only prevents divisions by zero."""

LISTED = ("tau", "u", "T")
"""Quantities that are stored as arrays of the shape (rows,), even if they are equal in all rows."""


class Gauss(NamedTuple):
    """Gauss quadrature on [0, 1].

    Attributes
    ----------
    nodes, weights : array, shape (n,)
        Nodes and weights.
    integrals : array, shape (n, n)
        Matrix from values at the nodes to integrals up to the nodes.
    twice : array, shape (n, n)
        Square of ``integrals``, for double integrals.
    coefficients : array, shape (n, n)
        Matrix from values at the nodes to Legendre coefficients.
    """

    nodes: NDArray
    weights: NDArray
    integrals: NDArray
    twice: NDArray
    coefficients: NDArray

    @classmethod
    def of_order(cls, n: int) -> "Gauss":
        """Return the Gauss nodes of order n."""
        x, weights = legendre.leggauss(n)
        coefficients = np.linalg.inv(legendre.legvander(x, n - 1))
        integrals = legendre.legval(x, legendre.legint(coefficients, lbnd=-1)).T / 2
        return cls((x + 1) / 2, weights / 2, integrals, integrals @ integrals, coefficients)


PANEL = Gauss.of_order(20)
WHOLE = tuple(Gauss.of_order(n) for n in (32, 48, 64, 80))
"""Gauss nodes of a panel (`PANEL`), and of panels that cover a whole contact (`WHOLE`)."""


class Guess(NamedTuple):
    """Guesses of whole contacts. They are free impacts.

    Attributes
    ----------
    gauss : Gauss
    push : array, shape (nodes, rows)
        F of the free impacts at their nodes.
    which : array of int, shape (rows,)
        Index of the matrix of each row in ``inverses``.
    inverses : sequence of arrays, shape (nodes, nodes)
        Inverses of the matrices of :meth:`LinearizedPanel.matrix`.
    """

    gauss: Gauss
    push: NDArray
    which: NDArray
    inverses: Sequence[NDArray]

    def corrected(self, missing: NDArray) -> NDArray:
        """Estimate the correction of F from the residual ``missing``, shape (nodes, ..., rows)."""
        correction = np.empty_like(missing)
        for k, inverse in enumerate(self.inverses):
            at = self.which == k
            part = missing[..., at]
            correction[..., at] = (inverse @ part.reshape(len(part), -1)).reshape(part.shape)
        return correction


class Rows(NamedTuple):
    """Values of contacts, one row for each contact, and their complex steps in several directions.

    The first axis counts directions if the real parts of complex arrays are equal along this axis.

    Attributes
    ----------
    shape : tuple
        Shape of the broadcast values.
    given : dict of numbers or arrays, shape (rows,)
        Real parts.
    steps : dict of arrays, shape (directions, rows)
        Imaginary parts that are not all zero. Directions without a step are left out.
    size : int
        Number of rows.
    stepped : array of bool
        Whether each direction has a step.
    """

    shape: tuple
    given: dict
    steps: dict
    size: int
    stepped: NDArray

    @property
    def directions(self) -> int:
        """Number of directions with a step."""
        return int(np.count_nonzero(self.stepped))

    def joined(self, real: NDArray, imaginary: NDArray) -> NDArray:
        """Join results and derivatives to complex arrays of the shape (k, *shape).

        Results have the shape (k, rows), and derivatives the shape (k, directions, rows).
        """
        if not self.stepped.size:
            return real.reshape(len(real), *self.shape)
        values = np.repeat(real[:, np.newaxis] + 0j, self.stepped.size, axis=1)
        values[:, self.stepped] += 1j * imaginary
        return values.reshape(len(values), *self.shape)


def values_by_row(values: Mapping) -> Rows:
    """Convert numbers and arrays that broadcast to :class:`Rows`."""
    arrays = {name: np.asarray(value) for name, value in values.items()}
    shape = np.broadcast_shapes(*(x.shape for x in arrays.values()))
    complexes = {name: x.imag for name, x in arrays.items() if x.dtype.kind == "c"}
    ahead = (x.real for x in arrays.values() if x.ndim == len(shape))
    beside = complexes and shape and all(((x == x[:1]) | (x != x)).all() for x in ahead)
    inner = shape[1:] if beside else shape
    directions = (shape[0] if beside else 1) if complexes else 0
    size = math.prod(inner)
    given = {}
    steps = {}
    for name, x in arrays.items():
        real = x.real[0] if x.ndim > len(inner) else x.real
        given[name] = np.broadcast_to(real, inner).ravel() if x.ndim or name in LISTED else real[()]
        if name in complexes and complexes[name].any():
            steps[name] = np.broadcast_to(x.imag, shape).reshape(directions, size)
            given[name] = np.broadcast_to(given[name], size)
    stepped: Any = sum((step.any(axis=1) for step in steps.values()), np.zeros(directions, bool))
    steps = {name: step[stepped] for name, step in steps.items()}
    return Rows(shape, given, steps, size, stepped)


class ContactMotion(NamedTuple):
    """The equation of motion of contacts, and the events at which panels end.

    Attributes
    ----------
    root : int
        m.
    force : callable
        Force f(p, v, a, given).
    release : callable
        Release function of (q, v, t, given). It is negative in a contact and zero at its end.
    kinks : tuple of callables
        Functions of (q, v, t, given). Their zeros are the kinks of the force.
    given : mapping of numbers or arrays, shape (rows,)
        "tau", "amplitude", "gravity", the "table" and its parameters, and the arguments of the
        force.
    steps : mapping of arrays, shape (directions, rows)
        Imaginary parts of ``given``.
    gauss : Gauss
        Nodes of the panels.
    """

    root: int
    force: Callable
    release: Callable
    kinks: tuple
    given: Mapping
    steps: Mapping
    gauss: Gauss = PANEL

    def of(self, rows: NDArray) -> "ContactMotion":
        """Select contacts."""
        given = {name: x[rows] if np.ndim(x) else x for name, x in self.given.items()}
        return self._replace(
            given=given, steps={name: x[:, rows] for name, x in self.steps.items()}
        )

    def stepped(self) -> dict:
        """Return ``given`` with steps. Values with a step are complex, shape (directions, rows)."""
        return {**self.given} | {name: self.given[name] + 1j * x for name, x in self.steps.items()}

    def lever(self, q: NDArray) -> NDArray:
        """Return λ = m q^{m-1}."""
        if self.root == 1:
            return np.ones_like(q)
        power = q
        for _ in range(self.root - 2):
            power = power * q
        return self.root * power


def load_of(t: NDArray, given: Mapping) -> Values:
    """Return the load a = g + Λ W″(τ + t)."""
    return given["gravity"] + given["amplitude"] * waveform(given)(given["tau"] + t, 2)


def waveform(given: Mapping) -> Table:
    """Return the table with the parameters in ``given``."""
    table = given["table"]
    return table.at(**{name: given[name] for name in table.parameters})


def rates(motion: ContactMotion, state: Sequence | NDArray) -> tuple:
    """Return dq/ds, dv/ds and dt/ds."""
    q, v, t = state
    lever = motion.lever(q)
    a = load_of(t, motion.given)
    return v, lever * (a - motion.force(q * lever / motion.root, v, a, motion.given)), lever


def event_rate(
    motion: ContactMotion, event: Callable, state: Sequence | NDArray
) -> tuple[NDArray, NDArray]:
    """Return an event function, and its derivative with respect to s along the motion."""
    beside = (y + 1j * H * rate for y, rate in zip(state, rates(motion, state), strict=True))
    value = event(*beside, motion.given)
    return value.real, value.imag / H


class Panel(NamedTuple):
    """Solved panels.

    Attributes
    ----------
    nodes : tuple of arrays, shape (nodes, rows)
        q, v and t at the nodes.
    end : tuple of arrays, shape (rows,)
        q, v and t at the ends.
    push : array, shape (nodes, rows)
        F at the nodes.
    length : array, shape (rows,)
        Lengths in root time.
    early : array, shape (rows,)
        Change of v in the sweep `EARLY`.
    change : array, shape (rows,)
        Estimate of the change of v in a further sweep.
    """

    nodes: tuple
    end: tuple
    push: np.ndarray
    length: np.ndarray
    early: np.ndarray
    change: np.ndarray

    def of(self, rows: NDArray) -> "Panel":
        """Select rows."""
        nodes, end = (tuple(y[..., rows] for y in states) for states in self[:2])
        return Panel(nodes, end, *(x[..., rows] for x in self[2:]))

    def states(self, places: NDArray, gauss: Gauss) -> NDArray:
        """Interpolate q, v and t at positions on [0, 1], shape (3, positions, rows).

        ``places`` has the shape (positions,), or (positions, rows).
        """
        if places.ndim > 1:
            coefficients = (gauss.coefficients @ y for y in self.nodes)
            return np.array([legendre.legval(2 * places - 1, c, False) for c in coefficients])
        order = gauss.nodes.size
        values = legendre.legvander(2 * places - 1, order - 1) @ gauss.coefficients
        return np.array([values @ y for y in self.nodes])

    def pushed(self, share: NDArray, gauss: Gauss) -> NDArray:
        """Interpolate F to the Gauss nodes of the first part of each panel, [0, ``share``]."""
        coefficients = gauss.coefficients @ self.push
        places = 2 * share * gauss.nodes[:, np.newaxis] - 1
        return legendre.legval(places, coefficients, tensor=False)

    def replace_some(self, at: NDArray, new: "Panel") -> None:
        """Overwrite the panels in the rows ``at``."""
        old = (*self.nodes, *self.end, *self[2:])
        for whole, part in zip(old, (*new.nodes, *new.end, *new[2:]), strict=True):
            whole[..., at] = part


class LinearizedPanel(NamedTuple):
    """The linearised equations of panels: δF = F_q δq + F_v δv + F_t δt + known terms.

    Attributes
    ----------
    by_q, by_v, by_t : array, shape (nodes, 1, rows)
        F_q, F_v and F_t at the nodes.
    bend : array, shape (nodes, 1, rows)
        dλ/dq at the nodes.
    h : array, shape (rows,)
        Lengths of the panels.
    gauss : Gauss
    """

    by_q: np.ndarray
    by_v: np.ndarray
    by_t: np.ndarray
    bend: np.ndarray
    h: np.ndarray
    gauss: Gauss

    def integrated(self, values: NDArray) -> NDArray:
        """Integrate values at the nodes up to each node, shape (nodes, directions, rows)."""
        flat = self.gauss.integrals @ values.reshape(len(values), -1)
        return self.h * flat.reshape(values.shape)

    def matrix(self) -> NDArray:
        """Matrix of the linear system for δF of each panel, shape (rows, nodes, nodes).

        The matrix is dimensionless.
        """
        by_q, by_v, by_t, bend = (coefficients.transpose(2, 0, 1) for coefficients in self[:4])
        h = self.h[:, np.newaxis, np.newaxis]
        once = h * self.gauss.integrals
        twice = h * h * self.gauss.twice
        time = once @ (bend * twice)
        return np.eye(self.gauss.nodes.size) - by_v * once - by_q * twice - by_t * time

    def solved(self, known: NDArray) -> NDArray:
        """Solve directly for δF at the nodes, shape (nodes, directions, rows)."""
        return np.linalg.solve(self.matrix(), np.moveaxis(known, 2, 0)).transpose(1, 2, 0)


def linearize(motion: ContactMotion, nodes: tuple, h: NDArray) -> LinearizedPanel:
    """Use complex steps of the force to linearise panels about a motion."""
    q, v, t = nodes
    given = motion.given
    m = motion.root
    lever = motion.lever(q)
    bend = m * (m - 1) * q ** max(m - 2, 0)
    p = q * lever / m
    a = load_of(t, given)
    along = motion.force(p + 1j * H, v, a, given)
    felt = 1 - motion.force(p, v, a + 1j * H, given).imag / H
    by_q = bend * (a - along.real) - lever * lever * along.imag / H
    by_v = -lever * motion.force(p, v + 1j * H, a, given).imag / H
    by_t = lever * felt * given["amplitude"] * waveform(given)(given["tau"] + t, 3)
    by_q, by_v, by_t, bend = (
        coefficients[:, np.newaxis] for coefficients in (by_q, by_v, by_t, bend)
    )
    return LinearizedPanel(by_q, by_v, by_t, bend, h, motion.gauss)


def _end_of(start: Sequence, h: NDArray, slopes: tuple, weights: NDArray) -> tuple:
    """Return q, v and t at the ends of panels.

    ``slopes`` are the derivatives of q, v and t with respect to s at the nodes.
    """
    return tuple(y + h * (weights @ slope) for y, slope in zip(start, slopes, strict=True))


def solve_panel(
    motion: ContactMotion,
    start: Sequence,
    h: NDArray,
    event: Callable | None = None,
    within: Values = 0.0,
    *,
    push: Values = 0.0,
    newton: bool = False,
    guess: Guess | None = None,
) -> Panel:
    """Solve for the motion on panels.

    By default the sweeps are Picard iterations. Steps of Newton's method allow longer panels for a
    ball that lies on the table: a panel may then cover many oscillations that have died out. A
    ``guess`` replaces the linear equations of the panel by those of free impacts.

    Parameters
    ----------
    motion : ContactMotion
    start : sequence of arrays, shape (rows,)
        q, v and t at the starts.
    h : array, shape (rows,)
        Lengths of the panels. If there is an event function, the lengths are guesses.
    event : callable, optional
        Event function. The panels end at its zero. In each sweep a Newton step moves the end of
        each panel towards this zero.
    within : float or array, shape (rows,)
        Limit of the last Newton step to an event. The event is found if the step is smaller.
    push : float or array, shape (nodes, rows)
        Guess of F.
    newton : bool
        Whether the sweeps are steps of Newton's method.
    guess : Guess, optional
        Linear equations of whole contacts.

    Returns
    -------
    Panel
    """
    q0, v0, t0 = start
    _, weights, integrals, *_ = motion.gauss
    v = v0 + h * (integrals @ np.broadcast_to(push, (weights.size, v0.size)))
    blind = EARLY if np.ndim(push) == 0 and not newton else 0
    moved = 0.0
    early, change = np.zeros((2, v0.size))
    near = True
    for sweep in range(SWEEPS):
        q = q0 + h * (integrals @ v)
        lever = motion.lever(q)
        t = t0 + h * (integrals @ lever)
        if sweep == 0 or event or motion.root > 1:
            # Otherwise the time is the root time, and does not change from sweep to sweep.
            a = load_of(t, motion.given)
        force = lever * (a - motion.force(q * lever / motion.root, v, a, motion.given))
        if newton:
            missing = (force - push)[:, np.newaxis]
            force = push + linearize(motion, (q, v, t), h).solved(missing)[:, 0]
        elif guess:
            force = push + guess.corrected(force - push)
        push = force
        before = v
        v = v0 + h * (integrals @ push)
        if sweep < blind:
            continue
        earlier = change
        change = np.abs(v - before).max(0)
        if sweep == EARLY and not newton:
            early = change
        if event:
            end = _end_of(start, h, (v, push, lever), weights)
            value, slope = event_rate(motion, event, end)
            moved = np.clip(-value / slope, -0.5 * h, 0.5 * h)
            near = np.abs(moved) <= within
        # The ratio of successive changes of v falls from sweep to sweep, and Newton's method
        # squares it. This gives a bound of the next change.
        to_come = change * np.fmin(change / earlier, 1.0) ** (2 if newton else 1)
        done = near & (to_come <= CONVERGED * np.abs(v).max(0)) | ~np.isfinite(change)
        if guess and sweep:
            done |= change > earlier
        if np.all(done):
            break
        if event:
            h = h + moved
            v = v0 + h * (integrals @ push)
    q = q0 + h * (integrals @ v)
    lever = motion.lever(q)
    t = t0 + h * (integrals @ lever)
    end = _end_of(start, h, (v, push, lever), weights)
    if event:
        end = tuple(y + moved * rate for y, rate in zip(end, rates(motion, end), strict=True))
    return Panel((q, v, t), end, push, h + moved, early, np.where(near, to_come, np.inf))


def carried(
    motion: ContactMotion,
    nodes: tuple,
    by: NDArray,
    h: NDArray,
) -> NDArray:
    """Compute the derivatives of (q, v, t) at the ends of panels.

    ``by`` contains the derivatives at the starts. Both have the shape (3, directions, rows).
    """
    linear = linearize(motion, nodes, h)
    q0, v0, t0 = by
    alone = q0 + h * motion.gauss.nodes[:, np.newaxis, np.newaxis] * v0
    # A step of τ acts like a step of t. Steps of other given values act through the force.
    later = t0 + motion.steps.get("tau", 0.0) + linear.integrated(linear.bend * alone)
    known = linear.by_q * alone + linear.by_v * v0 + linear.by_t * later
    if motion.steps.keys() - {"tau", "T"}:
        q, v, t = (x[:, np.newaxis] for x in nodes)
        given = motion.stepped() | {"tau": motion.given["tau"]}
        lever = motion.lever(q)
        a = load_of(t, given)
        known = known + (lever * (a - motion.force(q * lever / motion.root, v, a, given))).imag
    # Directions that only move the end of a contact have δF = 0.
    moves = known.any(axis=(0, 2))
    push = np.zeros_like(known)
    push[:, moves] = linear.solved(known[:, moves])
    rate = v0 + linear.integrated(push)
    pace = linear.bend * (q0 + linear.integrated(rate))
    weights = motion.gauss.weights
    return by + np.array(
        [h * np.tensordot(weights, integrand, 1) for integrand in (rate, push, pace)]
    )


def _resolved(motion: ContactMotion, panel: Panel, size: NDArray) -> tuple[NDArray, NDArray]:
    """Test the accuracy of panels.

    Returns whether each panel is accepted, and factors for the lengths of the next panels. ``size``
    is the scale of v. If gravity alone would accelerate the ball to a larger speed than this scale,
    the rounding errors of v are relative to that speed.
    """
    v = panel.nodes[1]
    order = len(v)
    last, middle = (
        np.abs(motion.gauss.coefficients[k : k + 2] @ v).max(0) / size
        for k in (order - 2, order // 2)
    )
    fall = motion.given["gravity"] * (panel.end[2] - panel.nodes[2][0])
    rounded = np.fmax(1.0, fall / size)
    falls = last <= FALLING * middle
    smooth = (last <= RESOLVED) & falls | (last <= SMOOTH * rounded)
    good = smooth & (panel.change <= ACCEPTED_CHANGE * size * rounded)
    by_tail = (RESOLVED / np.maximum(last, TINY)) ** (1 / order)
    by_sweeps = (WANTED * size / np.maximum(panel.early, TINY)) ** (1 / (2 * EARLY + 2))
    factor = 0.9 * np.minimum(by_tail, by_sweeps)
    factor = np.where(np.isfinite(factor), np.clip(factor, 0.25, LONGER), 0.25)
    return good, np.where(good, factor, np.minimum(factor, 0.5))


def _first_event(
    motion: ContactMotion, events: tuple, side: NDArray, start: Sequence, panel: Panel
) -> tuple[NDArray, NDArray]:
    """Find the first event of each panel.

    Returns the index of the event, -1 if there is none, and an estimate of its position on [0, 1].
    ``side`` contains the signs of the event functions before their events. Two kinds of signs of
    kinks are updated: unknown signs (0), and signs that changed at the end of the last panel
    together with another event.
    """
    states = [np.vstack(x) for x in zip(start, panel.nodes, panel.end, strict=True)]
    which = np.full(start[0].size, -1)
    place = np.full(start[0].size, np.inf)
    x = np.concatenate([[0.0], motion.gauss.nodes, [1.0]])
    for k, event in enumerate(events):
        values = event(*states, motion.given)
        if k < len(motion.kinks):
            late = (values[0] * side[k] <= 0) & (values[1] * side[k] <= 0)
            side[k, late] = np.sign(values[1, late])
        over = values[1:] * side[k] < 0
        crossed = np.flatnonzero(over.any(0))
        after = 1 + over[:, crossed].argmax(0)
        low = np.abs(values[after - 1, crossed])
        high = np.abs(values[after, crossed])
        here = x[after - 1] + (x[after] - x[after - 1]) * low / np.maximum(low + high, TINY)
        # An event function may be zero at the start of a contact, but the contact does not end
        # there.
        here = np.maximum(here, x[1] / 2)
        earlier = here < place[crossed]
        place[crossed[earlier]] = here[earlier]
        which[crossed[earlier]] = k
    return which, place


def _maxima(
    motion: ContactMotion, event: Callable, before: NDArray, states: list
) -> tuple[NDArray, NDArray]:
    """Find maxima between nodes at which an event function may reach zero.

    Returns the rows of the panels with a maximum, and the positions of the maxima on [0, 1].
    ``before`` contains the signs of the function before its event. ``states`` are (q, v, t) at the
    starts, nodes and ends of the panels.
    """
    below = -before * event(*states, motion.given)
    middle = below[1:-1]
    rises = middle - below[:-2]
    falls = middle - below[2:]
    # The maximum of a parabola through three values is less than d above the largest value. Here d
    # is the larger difference between the largest value and the other values.
    near = (rises >= 0) & (falls > 0) & (middle + np.maximum(rises, falls) > 0)
    node, row = np.nonzero(near)
    if not row.size:
        return row, np.zeros(0)
    polynomials = [motion.gauss.coefficients @ y[1:-1, row] for y in states]

    def depth(place: NDArray, k: NDArray) -> NDArray:
        state = (legendre.legval(2 * place - 1, y[:, k], tensor=False) for y in polynomials)
        return before[row[k]] * event(*state, motion.of(row[k]).given)

    x = np.concatenate([[0.0], motion.gauss.nodes, [1.0]])
    bracket = x[node], x[node + 1], x[node + 2]
    minimum = elementwise.find_minimum(depth, bracket, args=(np.arange(row.size),))
    # Inside a panel the error of the motion is of the size of the last coefficients.
    reached = minimum.f_x <= RESOLVED * np.abs(below[:, row]).max(0)
    return row[reached], minimum.x[reached]


def _first_maximum(
    motion: ContactMotion, events: tuple, side: NDArray, start: Sequence, panel: Panel
) -> NDArray:
    """Position on [0, 1] of the first maximum in :func:`_maxima` of all events, or infinity."""
    states = [np.vstack(x) for x in zip(start, panel.nodes, panel.end, strict=True)]
    first = np.full(start[0].size, np.inf)
    for event, before in zip(events, side, strict=True):
        row, place = _maxima(motion, event, before, states)
        np.minimum.at(first, row, place)
    return first


def _shift(
    motion: ContactMotion, event: Callable, state: Sequence | NDArray, by: NDArray
) -> NDArray:
    """Compute the derivatives of s at an event, shape (directions, rows).

    ``by`` contains the derivatives of (q, v, t), shape (3, directions, rows).
    """
    _, slope = event_rate(motion, event, state)
    beside = (y + 1j * derivative for y, derivative in zip(state, by, strict=True))
    return -event(*beside, motion.stepped()).imag / slope


def _pace(motion: ContactMotion, state: Sequence | NDArray) -> NDArray:
    """Derivatives of (s, q, v, t) with respect to s, shape (4, 1, rows)."""
    return np.array([np.ones_like(state[0]), *rates(motion, state)])[:, np.newaxis]


def _next_panel(
    motion: ContactMotion,
    events: tuple,
    side: NDArray,
    start: Sequence,
    length: NDArray,
    newton: bool,
) -> tuple[Panel, NDArray]:
    """Compute the next panels, which end at their first events.

    Returns the panels and the index of the event at the end of each, or -1. Updates ``side``.
    """
    panel = solve_panel(motion, start, length, newton=newton)
    which, place = _first_event(motion, events, side, start, panel)
    rows = np.arange(which.size)
    event = which
    place = length * place
    for _ in events:
        for k in np.unique(event[event >= 0]):
            at = rows[event == k]
            begin = [y[at] for y in start]
            short = place[event == k]
            within = EVENT_STEP * length[at]
            push = panel.of(at).pushed(short / panel.length[at], motion.gauss)
            given = motion.of(at), begin, short, events[k], within
            panel.replace_some(at, solve_panel(*given, push=push, newton=newton))
        which[rows[event >= 0]] = event[event >= 0]
        doubtful = (event >= 0) & np.isfinite(panel.change[rows])
        if not motion.kinks:
            doubtful &= event > 0
        rows = rows[doubtful]
        if not rows.size:
            break
        # The exact panel may contain an earlier event than the estimated first event.
        others = side[:, rows]
        others[which[rows], np.arange(rows.size)] = np.nan
        begin = [y[rows] for y in start]
        event, place = _first_event(motion.of(rows), events, others, begin, panel.of(rows))
        place = panel.length[rows] * place
    kink = np.flatnonzero((which >= 0) & (which < len(motion.kinks)))
    if kink.size and len(events) > len(motion.kinks):
        # A kink at the release counts as the release.
        end = [y[kink] for y in panel.end]
        value, slope = event_rate(motion.of(kink), motion.release, end)
        together = np.abs(value / slope) <= SAME * panel.length[kink]
        which[kink[together]] = len(motion.kinks)
    return panel, which


def _turn(q: NDArray, v: NDArray, t: NDArray, given: Mapping) -> Values:
    """Event function that vanishes at the end of each period of the table."""
    return t - given["turn"]


@dataclass
class _Contacts:
    """State of the integration of contacts. Most arrays have one value per contact."""

    motion: ContactMotion
    events: tuple
    until: NDArray | None
    now: NDArray
    by: NDArray
    length: NDArray
    period: NDArray
    longest: NDArray
    size: NDArray
    side: NDArray
    before: NDArray
    least: NDArray
    moved: NDArray
    ratio: NDArray
    ended: NDArray
    lost: NDArray
    first: NDArray
    accept: Callable | None

    def advance(self, here: NDArray, lies: bool) -> None:
        """Move contacts to the ends of their next panels. Panels that fail are made shorter."""
        motion = self.motion.of(here)
        s, *start = self.now[:, here]
        length = self.length[here]
        last = np.zeros(here.size, bool)
        if self.until is not None:
            remaining = self.until[here] - s
            pieces = np.fmax(np.ceil(remaining / length - 1e-9), 1)
            length = remaining / pieces
            last = pieces == 1
        side = self.side[:, here]
        # Panels of a ball that lies on the table cover many oscillations that have died out. If
        # m = 1, the equations are nearly linear, and one matrix per contact costs less than sweeps.
        newton = lies or (motion.root == 1 and here.size <= FEW_CONTACTS)
        panel, which = _next_panel(motion, self.events, side, start, length, newton)
        self.side[:, here] = side
        greatest = np.abs(panel.nodes[1]).max(0)
        good, factor = _resolved(motion, panel, np.fmax(self.size[here], greatest))
        # If a maximum may reach zero, end the panel at the maximum. The end shows whether there is
        # an event.
        place = _first_maximum(motion, self.events, side, start, panel)
        doubtful = good & (place < 1)
        factor = np.where(doubtful, place * panel.length / length, factor)
        good &= ~doubtful
        if self.until is not None:
            # Do not shorten accepted panels. Otherwise the number of equal pieces grows.
            factor = np.where(good, np.fmax(factor, 1.0), factor)
        self.length[here] = length * np.where(good & (which >= 0), 1.0, factor)
        self.ended[here] = good & last & (which < 0)
        kept = here[good]
        self.size[kept] = np.fmax(self.size[kept], greatest[good])
        self.least[kept] = np.fmin(self.least[kept], panel.nodes[0].min(0)[good])
        if self.accept:
            self.accept(kept, s[good], panel.of(good))
        if motion.root > 1:
            # Time runs backwards from the first zero of q to the second. There the contact starts
            # again, so an integration to a later root time is of no use.
            v = self.first[kept]
            self.lost[kept] |= (self.now[1, kept] * v < 0) & (panel.end[0][good] * v >= 0)
        self.now[:, kept] = np.array([s + panel.length, *panel.end])[:, good]
        which = which[good]
        if self.by.any() or self.motion.steps.keys() - {"T"}:
            self.differentiate(kept, which, panel.of(good))
        at_events = which >= 0
        if at_events.any():
            self.end_events(kept[at_events], which[at_events])
        # A panel that is shorter than a rounding error makes no progress.
        s = self.now[0, here]
        self.lost[here] |= s + self.length[here] == s

    def differentiate(self, here: NDArray, which: NDArray, panel: Panel) -> None:
        """Compute the derivatives at the ends of panels. An end at an event also moves."""
        given = self.motion.of(here), panel.nodes, self.by[1:, :, here], panel.length
        self.by[1:, :, here] = carried(*given)
        for k in np.unique(which[which >= 0]):
            at = here[which == k]
            motion = self.motion.of(at)
            shift = _shift(motion, self.events[k], self.now[1:, at], self.by[1:, :, at])
            self.by[:, :, at] += _pace(motion, self.now[1:, at]) * shift

    def end_events(self, here: NDArray, which: NDArray) -> None:
        """Handle events: flip the signs of kinks, end contacts at releases, compare periods."""
        release = len(self.motion.kinks)
        self.side[which, here] *= -1
        self.ended[here] |= which == release
        turned = here[which > release]
        self.compare_periods(turned)
        turn = self.motion.given["turn"]
        self.side[release + 1 :, turned] = -1.0
        turn[turned] += self.period[turned]

    def compare_periods(self, turned: NDArray) -> None:
        """Decide at the ends of periods which contacts are permanent.

        Three quantities are compared with the period before: q, v divided by the frequency of the
        oscillation, and the minimum of q. The changes of the three quantities are added. The
        changes in successive periods finally form a geometric series. Its ratio is taken as the
        larger of the last two ratios. The sum of the series is a bound of all further changes. The
        contact is permanent if the minimum of q in the last period is larger than `SAFE` times
        this bound.
        """
        q, v, t = self.now[1:, turned]
        stiffness = -rates(self.motion.of(turned), (q + 1j * H, v, t))[1].imag / H
        # A ball without a restoring force does not stay on the table: `moved` is then infinite.
        stiffness = np.where(stiffness > 0, stiffness, 0.0)
        least = self.least[turned]
        now = np.array([q, v, least])
        change = np.abs(now - self.before[:, turned])
        moved = change[0] + change[1] / np.sqrt(stiffness) + change[2]
        ratio = moved / self.moved[turned]
        larger = np.maximum(ratio, self.ratio[turned])
        to_come = moved * larger / (1 - larger)
        stays = (larger < 1) & (SAFE * to_come < least)
        longest = self.longest[turned] * self.period[turned]
        remaining = longest - self.motion.given["turn"][turned]
        self.lost[turned] = stays | (remaining < 0.5 * self.period[turned])
        self.before[:, turned] = now
        self.least[turned] = np.inf
        self.moved[turned] = moved
        self.ratio[turned] = ratio


@np.errstate(all="ignore")
def whole_panel(
    motion: ContactMotion, start: NDArray, until: NDArray, guess: Guess
) -> tuple[Panel, NDArray]:
    """Solve each contact up to a root time in one panel.

    Returns the panels, and whether each panel is accepted. A panel is accepted if its contact is
    like the guess, whose ball is never faster than at its start.
    """
    panel = solve_panel(motion, (*start, 0 * until), until, push=guess.push, guess=guess)
    fastest = np.abs(panel.nodes[1]).max(0)
    good, _ = _resolved(motion, panel, fastest)
    return panel, good & (fastest <= 2 * np.abs(start[1]))


def sampled(motion: ContactMotion, start: NDArray, until: NDArray, places: NDArray) -> NDArray:
    """Interpolate q, v and t at fractions of the root times ``until``, shape (3, places, rows).

    They are NaN beyond the end of a contact that does not last that long.
    """
    states = np.full((3, places.size, until.size), np.nan)

    def accept(rows: NDArray, starts: NDArray, panel: Panel) -> None:
        here = (np.multiply.outer(places, until[rows]) - starts) / panel.length
        inside = (here > -SAME) & (here < 1 + SAME)
        some = states[..., rows]
        states[..., rows] = np.where(inside, panel.states(here, motion.gauss), some)

    by = np.zeros((2, 0, until.size))
    given = until / (1.5 * motion.root), np.full(until.size, 2 * np.pi)
    integrate_contacts(motion, start, by, *given, until=until, accept=accept)
    return states


@np.errstate(all="ignore")
def integrate_to(
    motion: ContactMotion,
    start: NDArray,
    by: NDArray,
    length: NDArray,
    period: NDArray,
    until: NDArray,
    by_until: NDArray,
    guess: Guess | None,
) -> tuple[NDArray, NDArray]:
    """Integrate contacts up to the root times ``until``, whose derivatives are ``by_until``.

    A contact that resembles a free impact takes one panel. Other arguments and results are those of
    :func:`integrate_contacts`.
    """
    todo = np.arange(until.size)
    ends = np.empty((4, until.size))
    slopes = np.zeros((4, *by.shape[1:]))
    if guess:
        whole = motion._replace(gauss=guess.gauss)
        panel, good = whole_panel(whole, start, until, guess)
        ends = np.array([until, *panel.end])
        at = np.flatnonzero(good)
        todo = np.flatnonzero(~good)
        for here in np.array_split(at, at.size // CONTACTS_AT_ONCE + 1) if by.shape[1] else ():
            begin = np.array([*by, 0 * by[0]])[..., here]
            given = whole.of(here), panel.of(here).nodes, begin, until[here]
            slopes[1:, :, here] = carried(*given)
    if todo.size:
        some = motion.of(todo), start[:, todo], by[..., todo], length[todo], period[todo]
        ends[:, todo], slopes[..., todo] = integrate_contacts(*some, until=until[todo])
    return ends, slopes + _pace(motion, ends[1:]) * (by_until - slopes[0])


@np.errstate(all="ignore")
def integrate_contacts(
    motion: ContactMotion,
    start: NDArray,
    by: NDArray,
    length: NDArray,
    period: NDArray,
    longest: Values = PERIODS,
    until: NDArray | None = None,
    after: NDArray | None = None,
    accept: Callable | None = None,
) -> tuple[NDArray, NDArray]:
    """Integrate contacts up to the first releases, to given root times, or to given times.

    A contact is permanent if its motion converges to a motion in which the ball never leaves the
    table (:meth:`_Contacts.compare_periods`), or if the contact lasts for ``longest`` periods.

    Parameters
    ----------
    motion : ContactMotion
    start : array, shape (2, rows)
        q and v at the start.
    by : array, shape (2, directions, rows)
        Derivatives of q and v at the start.
    length : array, shape (rows,)
        Lengths of the first panels.
    period : array, shape (rows,)
        Periods of the table.
    longest : int or array, shape (rows,)
        Number of periods after which a contact counts as permanent.
    until : array, shape (rows,), optional
        Root times at which the integration stops.
    after : array, shape (rows,), optional
        Times after the start at which the integration stops.
    accept : callable, optional
        Function that receives the accepted panels: their rows, their starts in root time, and the
        panels.

    Returns
    -------
    ends : array, shape (4, rows)
        Root time, q, v, and time after the start. They are NaN for permanent contacts.
    derivatives : array, shape (4, directions, rows)
        Derivatives of ``ends``.
    """
    q, v = start
    rows = v.size
    turn = (period if after is None else after).copy()
    motion = motion._replace(given={**motion.given, "turn": turn})
    events = (*motion.kinks, motion.release, _turn)
    if until is not None:
        events = motion.kinks
    elif after is not None:
        events = (*motion.kinks, _turn)
    side = np.zeros((len(events), rows))
    side[len(motion.kinks) :] = -1.0
    now = np.array([0 * v, q, v, 0 * v])
    known = now.sum(0) + load_of(0 * v, motion.given)
    if until is not None:
        # There is no contact before its start, where q = p^{1/m} would be negative.
        known = known + np.where(until < 0, np.nan, until)
    contacts = _Contacts(
        motion=motion,
        events=events,
        until=until,
        now=now,
        by=np.array([0 * by[0], *by, 0 * by[0]]),
        length=length.copy(),
        period=period,
        longest=np.broadcast_to(longest, rows),
        size=np.abs(v),
        side=side,
        before=np.array([q, v, 0 * v]),
        least=np.full(rows, np.inf),
        moved=np.zeros(rows),
        ratio=np.full(rows, np.inf),
        ended=np.zeros(rows, bool),
        lost=~np.isfinite(known),
        first=v,
        accept=accept,
    )
    for attempt in range(MOST_PANELS):
        active = np.flatnonzero(~(contacts.ended | contacts.lost))
        if not active.size:
            break
        for here in np.array_split(active, -(-active.size // CONTACTS_AT_ONCE)):
            # Most balls leave the table after few panels. The other balls lie on the table.
            contacts.advance(here, lies=attempt >= PATIENT)
    now[:, ~contacts.ended] = np.nan
    return now, contacts.by
