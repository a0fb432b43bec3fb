"""Contacts of any force law, in a time in which their motion is analytic (docs/panels.md).

1. Root time. p″ = a - f(p, p′), with the load a = g + w″(τ + t). Forces such as p^{3/2} are
   analytic functions of q = p^{1/m}. In the *root time* s, with dt = λ ds and λ = m q^{m-1},

       dq/ds = v,    dv/ds = F = λ (a - f),    dt/ds = λ,    with v = p′,

   and the motion is analytic up to both ends of a contact.
2. A panel (:func:`solve_panel`). On a panel of the length h, F is a polynomial with the values F_j
   at the Gauss nodes. Sweeps find them: integrals of F give v, those of v give q, and those of λ
   give t. A sweep adds two orders in ωh, with the frequency ω of the oscillation in s.
3. Is it resolved? (:func:`_resolved`) If the last Legendre coefficients of v are ε, the end of the
   panel is right to the order of ε².
4. Events (:func:`_next_panel`). A panel ends where the force has a kink, at the release, and at the
   end of a period of the table.
5. Ends that are barely reached (:func:`_maxima`). It also ends at a maximum of the release function
   that may be above zero.
6. Balls that stay (:meth:`_Contacts.compare_periods`).
7. Derivatives (:func:`carried`). They are those of the collocation.
8. Contacts up to a known end (:func:`integrate_to`). They are one panel, if they are like a free
   impact of their speed, whose linear equations then make each sweep nearly a step of Newton's
   method.
9. Which linear equations (:func:`by_newton`, :func:`are_solved_directly`). Chosen by their size.

An array of contacts has the shape (rows,), and one of values at nodes (nodes, rows). Derivatives
are (directions, rows).
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.optimize import elementwise

from bouncing_ball_beyond.balls import H
from bouncing_ball_beyond.tables import Table, Values

# "At half" and "at twice" say what changed with nine laws and 60 contacts each (docs/panels.md).
# "No effect" means that ends, times and speeds agreed to 1e-11 and evaluations within 5 %.

RESOLVED = 1e-7
"""Largest last Legendre coefficients of v of an accepted panel, divided by its maximum speed.
The error of the end is their square. At half: no effect. At twice: 5 % fewer evaluations."""

FALLING = 0.02
"""Largest ratio of the last Legendre coefficients to the middle ones of an accepted panel. Beyond a
kink the ratio is (1/2)² to (1/2)³, and the square of the last coefficients is not the error.
At half and at twice: no effect. Without `FALLING`, the median error of ends behind a kink that a
limited damper does not declare is 4e-9 instead of 5e-15."""

SMOOTH = 1e-13
"""Last coefficients below which a panel is accepted even if its coefficients do not fall: all of
them are rounding errors. At half and at twice: no effect."""

SWEEPS = 20
"""Maximum number of sweeps of a panel. A panel that needs more is made shorter.
At half: 14 % more evaluations. At twice: one slow contact with a barely reached end changes by
2e-3."""

CONVERGED = 1e-13
"""Change of v in a sweep, divided by the maximum speed, below which the sweeps stop.
At half and at twice: evaluations change by 3 %."""

ACCEPTED_CHANGE = 1e-12
"""Largest last change of v, divided by the maximum speed, of an accepted panel.
At half and at twice: evaluations change by 3 %."""

EARLY = 3
"""Sweep whose change of v determines the length of the next panel.
At half and at twice: evaluations change by 3 %."""

WANTED = 0.03
"""Target for the change of v in the sweep `EARLY`, divided by the maximum speed.
At half and at twice: evaluations change by 3 %. This value needed the fewest sweeps."""

LONGER = 2.0
"""Largest ratio of the lengths of successive panels.
At half panels cannot grow: 2.6 times as many evaluations. At twice: no effect."""

EVENT_STEP = 1e-13
"""Largest last Newton step to an event, divided by the length of the panel.
At half and at twice: no effect."""

SAME = 1e-10
"""Distance of a kink from the release, divided by the length of the panel, below which both are one
event. At half and at twice: no effect. Without `SAME`, an impact on a limited
damper with ζ = 0, whose kink is at the release, takes 2096 panels instead of 8."""

MOST_PANELS = 4000
"""Maximum number of panels of a contact. A contact that needs more has no end, NaN, and an
impact needs about six. At half, contacts with 2000 to 4000 panels would have no end either."""

PATIENT = 40
"""Number of panels after which a contact is solved by Newton's method: the ball lies on the table.
At half and at twice: no effect. Without `PATIENT`, 100 contacts of a strongly damped law, of which
54 stay, take 22 times as many evaluations."""

PERIODS = 30
"""Number of periods after which a contact counts as permanent, unless the caller gives another.
At half and at twice: no effect."""

SAFE = 8.0
"""Factor on the sum of all further changes of a contact. If that multiple cannot lift the ball, the
contact is permanent: see :meth:`_Contacts.compare_periods`.
At half: 5 % fewer evaluations. At twice: 3 % more."""

CONTACTS_AT_ONCE = 1000
"""Number of contacts that are followed together. Their nodes fit into a processor's cache.
At half and at twice: the same time within 25 %."""

FEW_CONTACTS = 50
"""Number of contacts up to which linear equations are solved directly; above it, by sweeps.
If m = 1, the panels of so few contacts are solved by Newton's method.
At half and at twice: the same time within 25 %."""

FEW_ENTRIES = 2 * 80 * 80
"""Number of matrix entries up to which linear equations of whole contacts are solved directly;
above it, by sweeps. These matrices fit into a processor's cache.
At half and at twice: the same time within 25 %."""

TINY = 1e-300
"""Smallest divisor. It only prevents divisions by zero."""

LISTED = ("tau", "u", "T")
"""What is an array for each contact, also where it is the same number for all."""


class Gauss(NamedTuple):
    """Gauss nodes on [0, 1] and their weights.

    ``integrals`` and ``coefficients`` are the matrices from values at the nodes to the integrals up
    to the nodes and to the Legendre coefficients, and ``twice`` is the square of the former.
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
"""The nodes of a panel, and those of a whole contact in one panel."""


class Guess(NamedTuple):
    """Whole contacts as they would be without a load: F at their nodes, shape (nodes, rows).

    Row i has the matrix inverses[which[i]], the inverse of that of :meth:`LinearizedPanel.matrix`.
    """

    gauss: Gauss
    push: NDArray
    which: NDArray
    inverses: Sequence[NDArray]

    def of(self, rows: NDArray) -> "Guess":
        """Those of some rows."""
        return self._replace(push=self.push[:, rows], which=self.which[rows])

    def corrected(self, missing: NDArray) -> NDArray:
        """About what is to be added to F that misses so much, shape (nodes, ..., rows)."""
        if len(self.inverses) == 1:
            flat = self.inverses[0] @ missing.reshape(len(missing), -1)
            return flat.reshape(missing.shape)
        found = np.empty_like(missing)
        for k, inverse in enumerate(self.inverses):
            at = self.which == k
            part = missing[..., at]
            found[..., at] = (inverse @ part.reshape(len(part), -1)).reshape(part.shape)
        return found


class Rows(NamedTuple):
    """Numbers and arrays, real or complex, as rows of contacts and directions of steps.

    ``given`` has real numbers, or arrays of the shape (rows,), and ``steps`` the imaginary parts
    that are not zero, of the shape (directions, rows). The directions are along the first axis of
    complex arrays, if the real parts are the same along it; those without a step are left out.
    """

    shape: tuple
    given: dict
    steps: dict
    size: int
    stepped: NDArray

    @property
    def directions(self) -> int:
        """The number of directions with a step."""
        return int(np.count_nonzero(self.stepped))

    def joined(self, real: NDArray, imaginary: NDArray) -> NDArray:
        """Results (k, rows) and derivatives (k, directions, rows) in the shape of the values."""
        if not self.stepped.size:
            return real.reshape(len(real), *self.shape)
        values = np.repeat(real[:, np.newaxis] + 0j, self.stepped.size, axis=1)
        values[:, self.stepped] += 1j * imaginary
        return values.reshape(len(values), *self.shape)


def values_by_row(values: Mapping) -> Rows:
    """:class:`Rows` of numbers and arrays that broadcast."""
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
    """The equation of motion of contacts, and where panels end.

    ``force`` is f(p, v, a, given). ``release`` is the release function of (q, v, t, given): it is
    negative in a contact and zero at its end. Zeros of ``kinks`` are those of the force. ``given``
    has numbers, or arrays of the shape (rows,): "tau", "amplitude", "gravity", the "table" with its
    parameters, and what the force needs. ``steps`` are their imaginary parts, (directions, rows).
    """

    root: int
    force: Callable
    release: Callable
    kinks: tuple
    given: Mapping
    steps: Mapping
    gauss: Gauss = PANEL

    def of(self, rows: NDArray) -> "ContactMotion":
        """The motion of some of the contacts."""
        given = {name: x[rows] if np.ndim(x) else x for name, x in self.given.items()}
        return self._replace(
            given=given, steps={name: x[:, rows] for name, x in self.steps.items()}
        )

    def stepped(self) -> dict:
        """What is given, complex of the shape (directions, rows) where it has a step."""
        return {**self.given} | {name: self.given[name] + 1j * x for name, x in self.steps.items()}

    def lever(self, q: NDArray) -> NDArray:
        """λ = m q^{m-1}."""
        if self.root == 1:
            return np.ones_like(q)
        power = q
        for _ in range(self.root - 2):
            power = power * q
        return self.root * power


def load_of(t: NDArray, given: Mapping) -> Values:
    """a = g + Λ W″(τ + t)."""
    return given["gravity"] + given["amplitude"] * waveform(given)(given["tau"] + t, 2)


def waveform(given: Mapping) -> Table:
    """The table with the values of its parameters that are given."""
    table = given["table"]
    return table.at(**{name: given[name] for name in table.parameters})


def rates(motion: ContactMotion, state: Sequence | NDArray) -> tuple:
    """dq/ds, dv/ds and dt/ds."""
    q, v, t = state
    lever = motion.lever(q)
    a = load_of(t, motion.given)
    return v, lever * (a - motion.force(q * lever / motion.root, v, a, motion.given)), lever


def event_rate(
    motion: ContactMotion, event: Callable, state: Sequence | NDArray
) -> tuple[NDArray, NDArray]:
    """A function of an event and its derivative with respect to s along the motion."""
    beside = (y + 1j * H * rate for y, rate in zip(state, rates(motion, state), strict=True))
    value = event(*beside, motion.given)
    return value.real, value.imag / H


class Panel(NamedTuple):
    """Solved panels.

    ``nodes`` and ``end`` are (q, v, t) at the nodes and at the end, and ``push`` is F at the nodes.
    ``early`` is the change of v in the sweep EARLY, and ``change`` about that of a further sweep.
    """

    nodes: tuple
    end: tuple
    push: np.ndarray
    length: np.ndarray
    early: np.ndarray
    change: np.ndarray

    def of(self, rows: NDArray) -> "Panel":
        """The panels of some rows."""
        nodes, end = (tuple(y[..., rows] for y in each) for each in self[:2])
        return Panel(nodes, end, *(x[..., rows] for x in self[2:]))

    def states(self, places: NDArray, gauss: Gauss) -> list[NDArray]:
        """About q, v and t at places on [0, 1], each of the shape (places, rows)."""
        order = gauss.nodes.size
        values = legendre.legvander(2 * places - 1, order - 1) @ gauss.coefficients
        return [values @ y for y in self.nodes]

    def pushed(self, share: NDArray, gauss: Gauss) -> NDArray:
        """Interpolate F to the Gauss nodes of the first part of each panel."""
        coefficients = gauss.coefficients @ self.push
        places = 2 * share * gauss.nodes[:, np.newaxis] - 1
        return legendre.legval(places, coefficients, tensor=False)

    def replace_some(self, at: NDArray, new: "Panel") -> None:
        """Write other panels into these."""
        old = (*self.nodes, *self.end, *self[2:])
        for whole, part in zip(old, (*new.nodes, *new.end, *new[2:]), strict=True):
            whole[..., at] = part


class LinearizedPanel(NamedTuple):
    """The linearised collocation of panels: δF = F_q δq + F_v δv + F_t δt + what is known.

    ``by_q``, ``by_v``, ``by_t`` and ``bend``, which is dλ/dq, have the shape (nodes, 1, rows), and
    h has the shape (rows,).
    """

    by_q: np.ndarray
    by_v: np.ndarray
    by_t: np.ndarray
    bend: np.ndarray
    h: np.ndarray
    gauss: Gauss

    def integrated(self, values: NDArray) -> NDArray:
        """Integrals up to the nodes, of values at the nodes, shape (nodes, directions, rows)."""
        flat = self.gauss.integrals @ values.reshape(len(values), -1)
        return self.h * flat.reshape(values.shape)

    def time(self, q: NDArray) -> NDArray:
        """δt from δq at the nodes."""
        return self.integrated(self.bend * q)

    def felt(self, q: NDArray, v: NDArray, t: NDArray) -> NDArray:
        """What changes of the state change of F."""
        return self.by_q * q + self.by_v * v + self.by_t * t

    def matrix(self) -> NDArray:
        """The matrix of the linear system for δF of each panel, shape (rows, nodes, nodes).

        The matrix is dimensionless.
        """
        by_q, by_v, by_t, bend = (each.transpose(2, 0, 1) for each in self[:4])
        h = self.h[:, np.newaxis, np.newaxis]
        once = h * self.gauss.integrals
        twice = h * h * self.gauss.twice
        time = once @ (bend * twice)
        return np.eye(self.gauss.nodes.size) - by_v * once - by_q * twice - by_t * time

    def solved(self, known: NDArray) -> NDArray:
        """δF at the nodes, shape (nodes, directions, rows), by a linear system for each panel."""
        return np.linalg.solve(self.matrix(), np.moveaxis(known, 2, 0)).transpose(1, 2, 0)

    def swept(self, known: NDArray, guess: Guess | None = None) -> NDArray:
        """As :meth:`solved`, by sweeps; they converge as those of the motion have done."""
        push = guess.corrected(known) if guess else known
        rate = self.integrated(push)
        change = np.zeros(rate.shape[1:])
        for _ in range(2 * SWEEPS):
            along = self.integrated(rate)
            felt = known + self.felt(along, rate, self.time(along))
            push = push + guess.corrected(felt - push) if guess else felt
            before = rate
            rate = self.integrated(push)
            earlier = change
            change = np.abs(rate - before).max(0)
            left = change * np.fmin(change / earlier, 1.0)
            if not np.any(left > CONVERGED * np.abs(rate).max(0)):
                return push
        return self.solved(known)


def linearize(motion: ContactMotion, nodes: tuple, h: NDArray) -> LinearizedPanel:
    """:class:`LinearizedPanel` about a motion, by complex steps of the force."""
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
    by_q, by_v, by_t, bend = (each[:, np.newaxis] for each in (by_q, by_v, by_t, bend))
    return LinearizedPanel(by_q, by_v, by_t, bend, h, motion.gauss)


def _end_of(start: Sequence, h: NDArray, slopes: tuple, weights: NDArray) -> tuple:
    """q, v and t at the ends of panels, from their derivatives with respect to s at the nodes."""
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
    """The motion on panels from (q, v, t) at their starts, of the lengths h or up to an event.

    An event is found if the last step to it is at most ``within``. ``push`` is a guess of F.

    The sweeps are Picard's, or steps of Newton's method. With these the panel of a ball that lies
    on the table may be as long as many oscillations of its contact, which have died out. Those of
    whole contacts have the linear equations of a guess in place of their own. In each sweep a step
    of Newton's method also moves the end of a panel towards its event.
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
        # Each sweep changes v by a smaller part of the last change than the one before, and a step
        # of Newton's method by the square of that part.
        left = change * np.fmin(change / earlier, 1.0) ** (2 if newton else 1)
        done = near & (left <= CONVERGED * np.abs(v).max(0)) | ~np.isfinite(change)
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
    return Panel((q, v, t), end, push, h + moved, early, np.where(near, left, np.inf))


def carried(
    motion: ContactMotion,
    nodes: tuple,
    by: NDArray,
    h: NDArray,
    *,
    newton: bool = False,
    guess: Guess | None = None,
) -> NDArray:
    """Derivatives of (q, v, t) at the ends of panels, from those at the starts.

    Both have the shape (3, directions, rows).
    """
    linear = linearize(motion, nodes, h)
    q0, v0, t0 = by
    alone = q0 + h * motion.gauss.nodes[:, np.newaxis, np.newaxis] * v0
    # Of what is given, τ alone is felt as the time is.
    known = linear.felt(alone, v0, t0 + motion.steps.get("tau", 0.0) + linear.time(alone))
    if motion.steps.keys() - {"tau", "T"}:
        q, v, t = (x[:, np.newaxis] for x in nodes)
        given = motion.stepped() | {"tau": motion.given["tau"]}
        lever = motion.lever(q)
        a = load_of(t, given)
        known = known + (lever * (a - motion.force(q * lever / motion.root, v, a, given))).imag
    # That in which only the end of a contact moves is still at rest.
    moves = known.any(axis=(0, 2))
    push = np.zeros_like(known)
    if are_solved_directly(linear, newton, guess):
        push[:, moves] = linear.solved(known[:, moves])
    else:
        push[:, moves] = linear.swept(known[:, moves], guess)
    rate = v0 + linear.integrated(push)
    pace = linear.bend * (q0 + linear.integrated(rate))
    weights = motion.gauss.weights
    return by + np.array([h * np.tensordot(weights, each, 1) for each in (rate, push, pace)])


def _resolved(motion: ContactMotion, panel: Panel, size: NDArray) -> tuple[NDArray, NDArray]:
    """Whether v is right on panels, and factors for the next lengths; ``size`` is its scale.

    v has the rounding error of the speed that gravity alone would give the ball, if it is larger.
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
    """The first event of each panel, -1 if there is none, and about its place on [0, 1].

    ``side`` has the signs of the functions before their events. It is written where it is not known
    yet, 0, and where a kink was crossed at the end of the last panel, together with another event.
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
        # A contact that starts at the zero of a function does not end there.
        here = np.maximum(here, x[1] / 2)
        earlier = here < place[crossed]
        place[crossed[earlier]] = here[earlier]
        which[crossed[earlier]] = k
    return which, place


def _maxima(
    motion: ContactMotion, event: Callable, before: NDArray, states: list
) -> tuple[NDArray, NDArray]:
    """Maxima between nodes at which a function may reach zero: contacts, and places on [0, 1].

    ``before`` has the signs of the function before its event, and ``states`` are (q, v, t) at the
    starts, nodes and ends of panels.
    """
    below = -before * event(*states, motion.given)
    middle = below[1:-1]
    rises = middle - below[:-2]
    falls = middle - below[2:]
    # Between three values a parabola rises less above the highest one than to it.
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
    found = elementwise.find_minimum(depth, bracket, args=(np.arange(row.size),))
    # Inside a panel the motion is only as right as the last coefficients are small.
    reached = found.f_x <= RESOLVED * np.abs(below[:, row]).max(0)
    return row[reached], found.x[reached]


def _first_maximum(
    motion: ContactMotion, events: tuple, side: NDArray, start: Sequence, panel: Panel
) -> NDArray:
    """The place on [0, 1] of the first of the :func:`_maxima` of all events; infinity if none."""
    states = [np.vstack(x) for x in zip(start, panel.nodes, panel.end, strict=True)]
    first = np.full(start[0].size, np.inf)
    for event, before in zip(events, side, strict=True):
        row, place = _maxima(motion, event, before, states)
        np.minimum.at(first, row, place)
    return first


def _shift(
    motion: ContactMotion, event: Callable, state: Sequence | NDArray, by: NDArray
) -> NDArray:
    """Derivatives of s at an event, from those of (q, v, t), (3, directions, rows)."""
    _, slope = event_rate(motion, event, state)
    beside = (y + 1j * each for y, each in zip(state, by, strict=True))
    return -event(*beside, motion.stepped()).imag / slope


def _pace(motion: ContactMotion, state: Sequence | NDArray) -> NDArray:
    """Derivatives of (s, q, v, t) with respect to s, beside directions."""
    return np.array([np.ones_like(state[0]), *rates(motion, state)])[:, np.newaxis]


def _next_panel(
    motion: ContactMotion,
    events: tuple,
    side: NDArray,
    start: Sequence,
    length: NDArray,
    newton: bool,
) -> tuple[Panel, NDArray]:
    """The next panels, which end at their first events, and these, -1 if none. Writes ``side``."""
    panel = solve_panel(motion, start, length, newton=newton)
    which, place = _first_event(motion, events, side, start, panel)
    rows = np.arange(which.size)
    found = which
    place = length * place
    for _ in events:
        for k in np.unique(found[found >= 0]):
            at = rows[found == k]
            begin = [y[at] for y in start]
            short = place[found == k]
            within = EVENT_STEP * length[at]
            push = panel.of(at).pushed(short / panel.length[at], motion.gauss)
            given = motion.of(at), begin, short, events[k], within
            panel.replace_some(at, solve_panel(*given, push=push, newton=newton))
        which[rows[found >= 0]] = found[found >= 0]
        doubtful = (found >= 0) & np.isfinite(panel.change[rows])
        if not motion.kinks:
            doubtful &= found > 0
        rows = rows[doubtful]
        if not rows.size:
            break
        # Another event may turn out to be earlier than the one that seemed to be the first.
        others = side[:, rows]
        others[which[rows], np.arange(rows.size)] = np.nan
        begin = [y[rows] for y in start]
        found, place = _first_event(motion.of(rows), events, others, begin, panel.of(rows))
        place = panel.length[rows] * place
    kink = np.flatnonzero((which >= 0) & (which < len(motion.kinks)))
    if kink.size and len(events) > len(motion.kinks):
        # A kink at the release itself.
        end = [y[kink] for y in panel.end]
        value, slope = event_rate(motion.of(kink), motion.release, end)
        together = np.abs(value / slope) <= SAME * panel.length[kink]
        which[kink[together]] = len(motion.kinks)
    return panel, which


def _turn(q: NDArray, v: NDArray, t: NDArray, given: Mapping) -> Values:
    """The event that ends each period of the table."""
    return t - given["turn"]


def by_newton(motion: ContactMotion, contacts: int, lies: bool) -> bool:
    """Whether panels are solved by Newton's method and not by sweeps.

    For balls that lie on the table a panel is as long as many oscillations, which have died out.
    With m = 1 the equations are nearly linear, and a matrix for each of a few contacts costs less
    than the sweeps.
    """
    return lies or (motion.root == 1 and contacts <= FEW_CONTACTS)


def are_solved_directly(linear: LinearizedPanel, newton: bool, guess: Guess | None) -> bool:
    """Whether the equations of derivatives are solved by matrices and not by sweeps: those of few
    panels, or of whole contacts whose matrices fit into a processor's cache."""
    if guess:
        return linear.by_q.size * len(linear.by_q) <= FEW_ENTRIES
    return newton or linear.h.size <= FEW_CONTACTS


@dataclass
class _Contacts:
    """Contacts on their way; most arrays have a value for each of them."""

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

    def advance(self, here: NDArray, lies: bool) -> None:
        """Move some contacts to the ends of their next panels, or make these shorter."""
        motion = self.motion.of(here)
        s, *start = self.now[:, here]
        length = self.length[here]
        last = np.zeros(here.size, bool)
        if self.until is not None:
            left = self.until[here] - s
            pieces = np.fmax(np.ceil(left / length - 1e-9), 1)
            length = left / pieces
            last = pieces == 1
        side = self.side[:, here]
        newton = by_newton(motion, here.size, lies)
        panel, which = _next_panel(motion, self.events, side, start, length, newton)
        self.side[:, here] = side
        greatest = np.abs(panel.nodes[1]).max(0)
        good, factor = _resolved(motion, panel, np.fmax(self.size[here], greatest))
        # The end of a shorter panel shows whether there is an event.
        place = _first_maximum(motion, self.events, side, start, panel)
        doubtful = good & (place < 1)
        factor = np.where(doubtful, place * panel.length / length, factor)
        good &= ~doubtful
        if self.until is not None:
            # So many equal panels as before are fewer than those of the best lengths.
            factor = np.where(good, np.fmax(factor, 1.0), factor)
        self.length[here] = length * np.where(good & (which >= 0), 1.0, factor)
        self.ended[here] = good & last & (which < 0)
        kept = here[good]
        self.size[kept] = np.fmax(self.size[kept], greatest[good])
        self.least[kept] = np.fmin(self.least[kept], panel.nodes[0].min(0)[good])
        self.now[:, kept] = np.array([s + panel.length, *panel.end])[:, good]
        which = which[good]
        if self.by.any() or self.motion.steps.keys() - {"T"}:
            self.differentiate(kept, which, panel.of(good), newton=newton)
        at_events = which >= 0
        if at_events.any():
            self.end_events(kept[at_events], which[at_events])

    def differentiate(self, here: NDArray, which: NDArray, panel: Panel, *, newton: bool) -> None:
        """Move the derivatives to the ends of panels, some of which are at events."""
        given = self.motion.of(here), panel.nodes, self.by[1:, :, here], panel.length
        self.by[1:, :, here] = carried(*given, newton=newton)
        for k in np.unique(which[which >= 0]):
            at = here[which == k]
            motion = self.motion.of(at)
            shift = _shift(motion, self.events[k], self.now[1:, at], self.by[1:, :, at])
            self.by[:, :, at] += _pace(motion, self.now[1:, at]) * shift

    def end_events(self, here: NDArray, which: NDArray) -> None:
        """Change the sides of kinks, end contacts at their releases, and compare periods."""
        release = len(self.motion.kinks)
        self.side[which, here] *= -1
        self.ended[here] |= which == release
        turned = here[which > release]
        self.compare_periods(turned)
        turn = self.motion.given["turn"]
        self.side[release + 1 :, turned] = -1.0
        turn[turned] += self.period[turned]

    def compare_periods(self, turned: NDArray) -> None:
        """Find out at the ends of periods which contacts are permanent.

        From one period to the next q, v over its frequency and the least q change, at last in a
        geometric series. Its sum is the largest change that is still to come, and the contact is
        permanent if q was larger than SAFE such changes in all of the last period. The ratio is the
        larger one of the last two.
        """
        q, v, t = self.now[1:, turned]
        stiffness = -rates(self.motion.of(turned), (q + 1j * H, v, t))[1].imag / H
        least = self.least[turned]
        now = np.array([q, v, least])
        change = np.abs(now - self.before[:, turned])
        moved = change[0] + change[1] / np.sqrt(stiffness) + change[2]
        ratio = moved / self.moved[turned]
        larger = np.maximum(ratio, self.ratio[turned])
        to_come = moved * larger / (1 - larger)
        stays = (larger < 1) & (SAFE * to_come < least)
        left = self.longest[turned] * self.period[turned] - self.motion.given["turn"][turned]
        self.lost[turned] = stays | (left < 0.5 * self.period[turned])
        self.before[:, turned] = now
        self.least[turned] = np.inf
        self.moved[turned] = moved
        self.ratio[turned] = ratio


@np.errstate(all="ignore")
def whole_panel(
    motion: ContactMotion, start: NDArray, until: NDArray, guess: Guess
) -> tuple[Panel, NDArray]:
    """Contacts up to root times in one panel each, and which of them are like their guess."""
    panel = solve_panel(motion, (*start, 0 * until), until, push=guess.push, guess=guess)
    good, _ = _resolved(motion, panel, np.abs(panel.nodes[1]).max(0))
    return panel, good


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
    """As :func:`integrate_contacts`, contacts up to root times, with the derivatives of these.

    Contacts that end as free impacts do take one panel each.
    """
    left = np.arange(until.size)
    ends = np.empty((4, until.size))
    slopes = np.zeros((4, *by.shape[1:]))
    if guess:
        whole = motion._replace(gauss=guess.gauss)
        panel, good = whole_panel(whole, start, until, guess)
        ends = np.array([until, *panel.end])
        at = np.flatnonzero(good)
        left = np.flatnonzero(~good)
        if by.shape[1] and at.size:
            begin = np.array([*by, 0 * by[0]])[..., at]
            given = whole.of(at), panel.of(at).nodes, begin, until[at]
            slopes[1:, :, at] = carried(*given, guess=guess.of(at))
    if left.size:
        some = motion.of(left), start[:, left], by[..., left], length[left], period[left]
        ends[:, left], slopes[..., left] = integrate_contacts(*some, until=until[left])
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
) -> tuple[NDArray, NDArray]:
    """Contacts from their starts to the first releases, to root times, or to times.

    A contact is permanent if its motion repeats after a period, or if it lasts too long.

    Parameters
    ----------
    start, by : array, shapes (2, rows) and (2, directions, rows)
        q and v at the start, and their derivatives.
    length, period : array, shape (rows,)
        Those of the first panel, and of the table.
    until : array, shape (rows,), optional
        Root times at which contacts are left.
    after : array, shape (rows,), optional
        Times after the start at which contacts are left.
    longest : int or array, shape (rows,)
        A contact that lasts for so many periods is taken for a permanent one.

    Returns
    -------
    ends, derivatives : array, shapes (4, rows) and (4, directions, rows)
        Root time, q, v and the time after the start; NaN for permanent contacts.
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
    known = now.sum(0) + load_of(0 * v, motion.given) + (0 if until is None else until)
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
    )
    for attempt in range(MOST_PANELS):
        active = np.flatnonzero(~(contacts.ended | contacts.lost))
        if not active.size:
            break
        for here in np.array_split(active, -(-active.size // CONTACTS_AT_ONCE)):
            # Most balls have left the table after few panels, and the others lie on it.
            contacts.advance(here, lies=attempt >= PATIENT)
    now[:, ~contacts.ended] = np.nan
    return now, contacts.by
