"""One Newton's method and one march for all curves of solutions.

A problem F(z) = 0 has one equation less than unknowns. Its curves, many of them as rows side by
side, are followed by pseudo-arclength continuation: along the tangent, and by Newton's method on
the plane across it.

Source: E. L. Allgower and K. Georg, *Introduction to Numerical Continuation Methods*, SIAM (2003).
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.equations import KINDS, SINGULAR, LinearizedLegs, OrbitEquations

RESIDUAL_ROUNDING = 4 * np.finfo(float).eps
"""Rounding errors of the equations, relative to their largest terms."""

TOLERANCE = 1e-11
"""The largest last step, in units of `OrbitEquations.sizes`: the next one is one of rounding."""

SPECIAL = 1e-9
"""The same for special orbits, whose gradients have errors of 1e-7 at most."""

NOISE = 1e-3
"""The same for a step from an orbit whose equations hold but for rounding: a longer one is made of
rounding errors over a singular matrix, as at a saddle-node, and is not taken."""

FAST = 0.1
"""A special orbit at a point needs no new gradient if a step is so much shorter than the last."""

LONG = 2.0
"""A step to a special orbit, relative to 1 + |z|, that leads too far away, and seldom back."""

FIRST_STEP = 0.1
LONGEST_STEP = 0.4
SHORTEST_STEP = 1e-9
"""Lengths of steps: root mean squares of the changes of the unknowns over the impacts, and relative
changes of the parameter."""

STRAIGHT = 0.95
"""The least cosine of the angle between the tangents at the ends of a step."""

LARGEST_TURN = 0.3
"""The largest change of arctan(tr/(1 + det)) in a step, so that no two bifurcations hide in it."""

FADED = 1e-6
"""The speed of an impact, in g/Ω, below which it has vanished if a step does not even halve it: so
branches end whose contacts last longer and longer."""

BEFORE_END = 1e-3
"""The share of a step to an end of a branch that is left to the end in a point before it."""


AT_GOAL = "the end of the window"
CLOSED = "the branch is closed: it is back at its start"
"""Two of the reasons why a branch ends."""

IMPACT = "grazing of an impact"
"""The kind of orbit at which the speed of an impact is zero."""


class Solution(NamedTuple):
    """Orbits by rows, which of them are found, and tangents with normal · tangent = 1."""

    z: NDArray
    found: NDArray
    tangent: NDArray
    linear: LinearizedLegs


@np.errstate(all="ignore")
def newton(
    equations: OrbitEquations,
    z: NDArray,
    normal: NDArray | None = None,
    iterations: int = 12,
) -> Solution:
    """Solutions on the planes through rows z across a normal, by Newton's method.

    By default the last parameter is fixed. With one free parameter, special orbits of a kind are
    points, and need no plane.
    """
    if normal is None:
        normal = np.zeros_like(z)
        normal[:, -1] = 1.0
    if equations.kind:
        return _special(equations, z, normal, iterations)
    for _ in range(iterations):
        linear = equations.linearized(z)
        solution = equations.bordered(z, linear, normal)
        step = solution[..., 0]
        defect = np.abs(linear.legs).max(axis=(1, 2))
        moved = (np.abs(step) / equations.sizes(z)).max(axis=1)
        # Lengths in the equations are of the size of Λ, or of the times and the speeds.
        _, amplitude, _ = equations.at(z[:, equations.size :])
        size = np.abs(z[:, : equations.size]).max(axis=1) + np.abs(amplitude[..., 0])
        exact = defect < RESIDUAL_ROUNDING * (1 + size)
        step = np.where((exact & ~(moved < NOISE))[:, np.newaxis], 0.0, step)
        z = z + step
        # Steps become small, or they are made of nothing but rounding errors of the equations.
        found = (moved < TOLERANCE) | exact
        if (found | np.isnan(moved)).all():
            break
    # Far away, where times have no digits left, steps are small as well.
    found &= defect < 1e-7
    return Solution(z, found, solution[..., 1], linear)


def _special(equations: OrbitEquations, z: NDArray, normal: NDArray, iterations: int) -> Solution:
    """Special orbits; only rows that are not found yet go on, because their gradients cost: as long
    as steps to points become shorter fast, they are changed by Broyden's rule."""
    z = z.copy()
    tangent = np.full(z.shape, np.nan)
    found = np.zeros(len(z), bool)
    todo = np.arange(len(z))
    part = equations
    gradient, step = np.ones((2, *z.shape))
    slow = ~found
    size_before = np.ones(len(z))
    for _ in range(iterations):
        linear = part.linearized(z[todo])
        value = part.excess(z[todo], linear)
        gradient[todo] += (value / np.sum(step**2, axis=1))[:, np.newaxis] * step
        if slow.any():
            _, gradient[todo[slow]] = part.rows(slow).condition(z[todo[slow]])
        condition = value, gradient[todo]
        solution = part.bordered(z[todo], linear, normal[todo], condition)
        step = solution[..., 0]
        size = np.abs(step).max(axis=1) / (1 + np.abs(z[todo]).max(axis=1))
        step[size > LONG] = np.nan
        z[todo] += step
        tangent[todo] = solution[..., 1]
        moved = (np.abs(step) / part.sizes(z[todo])).max(axis=1)
        found[todo] = moved < np.where(slow, SPECIAL, TOLERANCE)
        going = ~found[todo] & np.isfinite(moved)
        slow = (moved >= FAST * size_before[todo])[going] | (len(equations.along) > 1)
        size_before[todo] = moved
        step = step[going]
        todo = todo[going]
        if not todo.size:
            break
        part = equations.rows(todo)
    return Solution(z, found, tangent, equations.linearized(z))


class Start(NamedTuple):
    """Where branches start, by rows: orbits, directions, the values to be reached, and the reasons
    for no branch, "" if there is one; ``origin`` are the special orbits before z, if there are any.
    """

    equations: OrbitEquations
    z: NDArray
    direction: NDArray
    goal: NDArray
    reasons: NDArray
    step: float | NDArray = FIRST_STEP
    origin: NDArray | None = None

    def take(self, which: Any) -> "Start":
        """Some of the rows."""
        taken = {name: each[which] for name, each in self._asdict().items() if np.ndim(each)}
        return self._replace(equations=self.equations.rows(which), **taken)


def tangents(equations: OrbitEquations, z: NDArray) -> NDArray:
    """Directions of curves of orbits through z, also where the parameter turns back; (rows, N)."""
    linear = equations.linearized(z)
    normal = np.ones(z.shape)
    for _ in range(2):
        normal = unit(equations.bordered(z, linear, normal)[..., 1])
    return normal


def unit(vectors: NDArray) -> NDArray:
    """Rows of the length 1."""
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


class Points(NamedTuple):
    """One orbit of each row, with its tests (rows, tests), and differences of its halves."""

    z: NDArray
    tangents: NDArray
    tests: NDArray
    halves: NDArray

    def take(self, which: Any) -> "Points":
        """Some of the rows."""
        return Points(*(each[which] for each in self))


def points_at(
    equations: OrbitEquations, z: NDArray, tangents: NDArray, linear: LinearizedLegs
) -> Points:
    """Orbits with their tests."""
    return Points(z, tangents, equations.tests(z, linear), equations.halves(z))


def _same_sign(before: Points, after: Points) -> Points:
    """The points after a step, whose distances from a period halving change their sign at one."""
    merged = np.sum(before.halves * after.halves, axis=1) < 0
    tests = after.tests.copy()
    tests[:, -1] *= np.where(merged, -1, 1) * np.sign(before.tests[:, -1])
    return after._replace(tests=tests)


def _predicted(
    equations: OrbitEquations, here: Points, step: NDArray, units: NDArray, window: NDArray
) -> tuple:
    """Steps along the tangents, up to the window: their lengths, ends and normals, which of them
    are the last ones, and the number of the parameter in z that ends them."""
    low, high = window.swapaxes(0, 1)
    ahead = unit(here.tangents / units)
    rate = (ahead * units)[:, equations.size :]
    ends = np.where(rate > 0, high, low)
    with np.errstate(divide="ignore", invalid="ignore"):
        whole = np.where(rate == 0, np.inf, (ends - here.z[:, equations.size :]) / rate)
    first = np.arange(len(whole)), whole.argmin(axis=1)
    last = whole[first] <= step
    length = np.where(last, whole[first], step)
    z = here.z + length[:, np.newaxis] * ahead * units
    normal = ahead / units
    bound = equations.size + first[1]
    normal[last] = 0.0
    normal[last, bound[last]] = np.sign(rate[first])[last]
    z[last, bound[last]] = ends[first][last]
    return length, z, normal, last, bound


def march(
    start: Start, window: NDArray, until: Sequence[str | None] | NDArray, points: int
) -> list[tuple[Points, str]]:
    """The accepted points of each branch, and why it ends.

    A step is halved if Newton's method fails, or tangents or multipliers change too much. One that
    goes beyond an end, where multipliers tell nothing, has a point just before it.
    """
    equations = start.equations
    here = points_at(equations, start.z, start.direction, equations.linearized(start.z))
    first = here
    rows = np.arange(len(start.z))
    paths = [[here.take([row])] for row in rows]
    ends = [""] * len(rows)
    step = np.broadcast_to(start.step, len(rows))
    farthest = np.zeros(len(rows))
    while rows.size:
        units = equations.scales(here.z)
        low, high = window[rows].swapaxes(0, 1)
        length, guess, normal, last, bound = _predicted(equations, here, step, units, window[rows])
        solution = newton(equations, guess, normal, iterations=7)
        solution.z[last, bound[last]] = guess[last, bound[last]]
        with np.errstate(all="ignore"):
            there = points_at(equations, solution.z, solution.tangent, solution.linear)
            there = _same_sign(here, there)
            crossed = here.tests * there.tests < 0
            ending = crossed[:, SINGULAR].any(axis=1)
            inner = there
            if ending.any():
                inner = _before_end(equations, here, there, normal)
            # The determinant is positive up to there, so that tr/(1 + det) has no pole.
            angles = np.arctan([each.tests[:, 1] - 1 for each in (here, inner)])
            turned = np.abs(angles[1] - angles[0])
            cosine = _cosine(there, here, units)
            missed = np.linalg.norm((there.z - guess) / units, axis=1)
            values = there.z[:, equations.size :]
            inside = ((values >= low) & (values <= high)).all(axis=1)
        good = solution.found & inside & (cosine > STRAIGHT) & (missed < 0.4 * length)
        good &= (turned < LARGEST_TURN) | (length < 1e-6)
        fades = np.zeros(rows.size, bool)
        if equations.ball.has_duration and equations.kind != IMPACT:
            speed = equations.kinds.index(IMPACT)
            before, after = (each.tests[:, speed] for each in (here, there))
            fades = good & (0 < after) & (after < FADED) & (after > before / 2) & (after < before)
        easy = (cosine > 0.99) & (turned < LARGEST_TURN / 2)
        moved = zip(here, there, strict=True)
        here = Points(*(np.where(good[:, np.newaxis], new, old) for old, new in moved))
        longer = np.minimum(np.where(easy, 2 * step, step), LONGEST_STEP)
        step = np.where(good, longer, length / 2)
        away = _from_start(equations, first, here, units)
        back = (away < step / 2) & (farthest > 2 * step)
        if back.any():
            back &= _cosine(here, first, units) > STRAIGHT
        farthest = np.maximum(farthest, away)
        for j in np.flatnonzero(good):
            if ending[j] and np.isfinite(inner.tests[j]).all():
                paths[rows[j]].append(inner.take([j]))
            paths[rows[j]].append(here.take([j]))
            kind = until[rows[j]]
            passed = np.array(equations.kinds)[crossed[j]]
            ends[rows[j]] = _end_of_step(passed, last[j], back[j], kind)
            if not ends[rows[j]] and fades[j]:
                ends[rows[j]] = f"the speed of an impact has fallen below {FADED:g}"
            if not ends[rows[j]] and len(paths[rows[j]]) >= points:
                ends[rows[j]] = f"all {points} points are used"
        for j in np.flatnonzero(step < SHORTEST_STEP):
            ends[rows[j]] = ends[rows[j]] or "no further orbit is found"
        going = np.array([not ends[row] for row in rows])
        if not going.all():
            rows = rows[going]
            equations = start.equations.rows(rows)
            here = here.take(going)
            first = first.take(going)
            step = step[going]
            farthest = farthest[going]
    units = start.equations.scales(start.z)
    whole = zip(paths, ends, units, strict=True)
    return [(_path_of(path, end, start.equations, unit), end) for path, end, unit in whole]


def _before_end(equations: OrbitEquations, here: Points, there: Points, normal: NDArray) -> Points:
    """Points of steps just before the first of the ends that they cross, NaN if not found."""
    before = here.tests[:, SINGULAR]
    after = there.tests[:, SINGULAR]
    share = np.where(before * after < 0, before / (before - after), 1.0).min(axis=1)
    share = (1 - BEFORE_END) * share[:, np.newaxis]
    solution = newton(equations, here.z + share * (there.z - here.z), normal)
    inner = points_at(equations, solution.z, solution.tangent, solution.linear)
    inner.tests[~solution.found] = np.nan
    return _same_sign(here, inner)


def _cosine(points: Points, others: Points, units: NDArray) -> NDArray:
    """Cosines of the angles between tangents."""
    return np.sum(unit(points.tangents / units) * unit(others.tangents / units), axis=1)


def _end_of_step(passed: NDArray, last: bool, back: bool, until: str | None) -> str:
    """Why a branch ends with a step in which some kinds of special orbits are passed, or ""."""
    for name in passed:
        if ends_at(name, until):
            return str(name)
    if last:
        return AT_GOAL
    return CLOSED if back else ""


def ends_at(kind: str, until: str | None) -> bool:
    """Whether a curve ends at a kind of special orbit."""
    return kind == until or (kind in KINDS and KINDS[kind].end != "")


def _from_start(equations: OrbitEquations, first: Points, here: Points, units: NDArray) -> NDArray:
    """How far branches are from their starts, up to whole turns of the table."""
    turns = np.round((here.z - first.z)[:, 0] / (2 * np.pi))
    away = equations.later(here.z - first.z, -turns)
    return np.linalg.norm(away / units, axis=1)


def _path_of(path: list[Points], end: str, equations: OrbitEquations, units: NDArray) -> Points:
    """The points of one row; a closed branch ends exactly at its start."""
    if end == CLOSED:
        ahead = np.sum(path[0].tangents * (path[-1].z - path[0].z) / units**2) > 0
        turns = np.round((path[-1].z[0, 0] - path[0].z[0, 0]) / (2 * np.pi))
        z = equations.later(path[0].z, turns)
        path = [*(path[:-1] if ahead else path), path[0]._replace(z=z)]
    return Points(*(np.concatenate(each) for each in zip(*path, strict=True)))
