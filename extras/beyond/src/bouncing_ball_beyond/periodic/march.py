"""Pseudo-arclength continuation of many solution curves at once.

The solutions of F(z) = 0, with N unknowns and N - 1 equations, form curves. `march` follows many of
them in parallel, one curve per row. Each step predicts the next point along the tangent. Then
`newton` corrects this point on the plane perpendicular to the tangent.

Source: E. L. Allgower and K. Georg, *Introduction to Numerical Continuation Methods*, SIAM (2003).
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.periodic.equations import (
    KINDS,
    MULTIPLIERS,
    SINGULAR,
    LinearizedLegs,
    OrbitEquations,
)

RESIDUAL_ROUNDING = 8 * np.finfo(float).eps
"""Size of the rounding errors of the equations, relative to their largest terms."""

TOLERANCE = 1e-11
"""Newton's method stops if its step is smaller than this, in units of `OrbitEquations.sizes`.

The next step would consist of rounding errors only.

At half and at twice: results change by 7e-14.
"""

SPECIAL = 1e-9
"""`TOLERANCE` for special orbits. Their gradients have errors of up to 1e-7.

At half and at twice: no effect on bifurcations; 2 of 90 curves stop up to 8e-4 elsewhere.
"""

NOISE = 1e-3
"""If the equations hold within rounding, Newton steps larger than this are not taken.

Units as for `TOLERANCE`. Such a step consists of rounding errors divided by a nearly singular
matrix, as at a saddle-node.

At half and at twice: no effect. Without `NOISE`, 1 of 540 heights next to saddle-nodes is lost.
"""

FAST = 0.1
"""Ratio of successive Newton steps below which the gradient is not computed again.

This applies to special orbits with one free parameter, which are isolated points.

At half and at twice: results change by 1e-13.
"""

LONG = 2.0
"""Longest Newton step to a special orbit, divided by 1 + |z|. Longer steps rarely converge.

At half and at twice: no effect. Without `LONG`, error thresholds take 1.4 times as long.
"""

FIRST_STEP = 0.1
"""Length of the first step along a branch, in units of `OrbitEquations.scales`.

In these units the length combines the root mean square change of the unknowns over the impacts and
the relative change of the parameter.

At half: 5 % more points. At twice: 3 % fewer; 2 of 144 branches end elsewhere.
"""

LONGEST_STEP = 0.4
"""Longest step along a branch.

At half: up to 48 % more points. At twice: up to 27 % fewer; 1 of 144 branches loses two special
orbits.
"""

SHORTEST_STEP = 1e-9
"""Step length below which a branch ends.

At half and at twice: no effect.
"""

STRAIGHT = 0.95
"""Minimum cosine of the angle between the tangents at both ends of a step.

With half the angle: 3 % more points. With twice the angle: 2 % fewer.
"""

LARGEST_TURN = 0.3
"""Largest change of arctan(tr/(1 + det)) in a step. A larger change could hide two bifurcations.

At half: 30 % more points. At twice: 11 % fewer.
"""

STALLED = 1e-4
"""Share of the steps in all unknowns but T below which a branch ends: contacts last ever longer,
and nothing else changes. The ball then no longer leaves the table, or no longer hits it.
"""

BEFORE_END = 1e-3
"""Distance between the end of a branch and the extra point before this end.

The distance is divided by the distance between the start of the step and the end of the branch.

At half and at twice: no effect.
"""


AT_GOAL = "the end of the window"
"""Reason for the end of a branch: it left the window of the parameters."""

TOO_FAST = "the orbits change too fast to be followed"
"""Reason for the end of a branch: its steps became shorter than `SHORTEST_STEP`."""

CLOSED = "the branch is closed: it is back at its start"
"""Reason for the end of a branch: it returned to its start."""


class Solution(NamedTuple):
    """Result of Newton's method, one orbit per row.

    Attributes
    ----------
    z : array, shape (rows, N)
        Unknowns.
    converged : array of bool, shape (rows,)
        Whether the method converged.
    tangent : array, shape (rows, N)
        Tangents of the solution curves, scaled to normal · tangent = 1.
    linear : LinearizedLegs
        Linearised equations at the last iterate.
    """

    z: NDArray
    converged: NDArray
    tangent: NDArray
    linear: LinearizedLegs


@np.errstate(all="ignore")
def newton(
    equations: OrbitEquations,
    z: NDArray,
    normal: NDArray | None = None,
    iterations: int = 12,
) -> Solution:
    """Use Newton's method to solve the equations. Each row stays on its own plane.

    Parameters
    ----------
    equations : OrbitEquations
        Equations, one row per orbit.
    z : array, shape (rows, N)
        Initial guesses. The planes pass through them.
    normal : array, shape (rows, N), optional
        Normals of the planes. By default the last parameter is fixed. Special orbits with one free
        parameter are isolated points and need no plane.
    iterations : int
        Maximum number of iterations.

    Returns
    -------
    Solution
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
        # The terms of the equations are as large as Λ, the times or the speeds.
        _, amplitude, _ = equations.at(z[:, equations.size :])
        size = np.abs(z[:, : equations.size]).max(axis=1) + np.abs(amplitude[..., 0])
        exact = defect < RESIDUAL_ROUNDING * (1 + size)
        step = np.where((exact & ~(moved < NOISE))[:, np.newaxis], 0.0, step)
        z = z + step
        # Converged: the step is small, or the residual consists of rounding errors.
        converged = (moved < TOLERANCE) | exact
        if (converged | np.isnan(moved)).all():
            break
    # If z is so large that the times have no digits left, the step is small without convergence.
    converged &= defect < 1e-7
    return Solution(z, converged, solution[..., 1], linear)


def _special(equations: OrbitEquations, z: NDArray, normal: NDArray, iterations: int) -> Solution:
    """Newton's method for special orbits.

    Gradients are expensive, so the iteration of a row stops as soon as the row has converged. While
    the steps to an isolated special orbit shrink fast (see `FAST`), Broyden's rule updates the
    gradient.
    """
    z = z.copy()
    tangent = np.full(z.shape, np.nan)
    converged = np.zeros(len(z), bool)
    todo = np.arange(len(z))
    part = equations
    gradient, step = np.ones((2, *z.shape))
    slow = ~converged
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
        converged[todo] = moved < np.where(slow, SPECIAL, TOLERANCE)
        going = ~converged[todo] & np.isfinite(moved)
        slow = (moved >= FAST * size_before[todo])[going] | (len(equations.along) > 1)
        size_before[todo] = moved
        step = step[going]
        todo = todo[going]
        if not todo.size:
            break
        part = equations.rows(todo)
    return Solution(z, converged, tangent, equations.linearized(z))


class Start(NamedTuple):
    """Starts of branches, one per row.

    Attributes
    ----------
    equations : OrbitEquations
    z : array, shape (rows, N)
        First orbits.
    direction : array, shape (rows, N)
        Directions in which the branches leave z.
    goal : array, shape (rows,)
        Parameter values at which the branches end.
    reasons : array of str, shape (rows,)
        Reasons why there is no branch; "" if there is one.
    step : float or array, shape (rows,)
        Lengths of the first steps.
    origin : array, shape (rows, N), optional
        Special orbits from which the branches emanate, if z is not the first point.
    """

    equations: OrbitEquations
    z: NDArray
    direction: NDArray
    goal: NDArray
    reasons: NDArray
    step: float | NDArray = FIRST_STEP
    origin: NDArray | None = None

    def take(self, which: Any) -> "Start":
        """Select rows."""
        taken = {name: values[which] for name, values in self._asdict().items() if np.ndim(values)}
        return self._replace(equations=self.equations.rows(which), **taken)


def tangents(equations: OrbitEquations, z: NDArray) -> NDArray:
    """Unit tangents of the solution curves at z, shape (rows, N). z may be a turning point."""
    linear = equations.linearized(z)
    normal = np.ones(z.shape)
    for _ in range(2):
        normal = unit(equations.bordered(z, linear, normal)[..., 1])
    return normal


def unit(vectors: NDArray) -> NDArray:
    """Scale each row to length 1."""
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


class Points(NamedTuple):
    """One point on each branch.

    Attributes
    ----------
    z, tangents : array, shape (rows, N)
        Orbits and tangents.
    tests : array, shape (rows, tests)
        Test functions, which vanish at special orbits (`OrbitEquations.kinds`).
    halves : array, shape (rows, ...)
        Differences between the first and the second half of the orbit. They vanish at a period
        halving.
    """

    z: NDArray
    tangents: NDArray
    tests: NDArray
    halves: NDArray

    def take(self, which: Any) -> "Points":
        """Select rows."""
        return Points(*(rows[which] for rows in self))


def points_at(
    equations: OrbitEquations, z: NDArray, tangents: NDArray, linear: LinearizedLegs
) -> Points:
    """Evaluate the test functions at orbits."""
    return Points(z, tangents, equations.tests(z, linear), equations.halves(z))


def same_sign(before: Points, after: Points) -> Points:
    """Return ``after`` with a signed test for period halving.

    The last test is the norm of ``halves``, which is never negative. A step across a period halving
    reverses the direction of ``halves``. The test then gets the opposite sign.
    """
    merged = np.sum(before.halves * after.halves, axis=1) < 0
    tests = after.tests.copy()
    tests[:, -1] *= np.where(merged, -1, 1) * np.sign(before.tests[:, -1])
    return after._replace(tests=tests)


def _predicted(
    equations: OrbitEquations, here: Points, step: NDArray, units: NDArray, window: NDArray
) -> tuple:
    """Predict a step along each tangent. A step that leaves the window ends at its border.

    Returns
    -------
    length : array, shape (rows,)
        Lengths of the steps.
    z, normal : array, shape (rows, N)
        Predicted orbits, and normals of the planes on which to correct them.
    last : array of bool, shape (rows,)
        Whether the step ends at the border.
    bound : array of int, shape (rows,)
        Column of z with the parameter that reaches the border first.
    """
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
    """Follow branches until they end.

    A step is halved if Newton's method fails, or if the tangent or the multipliers change too much.
    Beyond an end of a branch the multipliers have no meaning. A step across an end therefore adds a
    point just before the end.

    Parameters
    ----------
    start : Start
        Starts of the branches, one per row.
    window : array, shape (rows, 2, p)
        Lower and upper limits of the p parameters.
    until : sequence of str or None
        Kind of special orbit at which each branch ends, if any.
    points : int
        Maximum number of points on a branch.

    Returns
    -------
    list of (Points, str)
        Points of each branch, and the reason why it ends.
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
            there = same_sign(here, there)
            crossed = here.tests * there.tests < 0
            ending = crossed[:, SINGULAR].any(axis=1)
            inner = there
            if ending.any():
                inner = _before_end(equations, here, there, normal)
            # Before an end the determinant is positive, so tr/(1 + det) has no pole.
            angles = np.arctan([orbits.tests[:, 1] - 1 for orbits in (here, inner)])
            turned = np.abs(angles[1] - angles[0])
            cosine = _cosine(there, here, units)
            missed = np.linalg.norm((there.z - guess) / units, axis=1)
            values = there.z[:, equations.size :]
            inside = ((values >= low) & (values <= high)).all(axis=1)
        good = solution.converged & inside & (cosine > STRAIGHT) & (missed < 0.4 * length)
        good &= (turned < LARGEST_TURN) | (length < 1e-6)
        easy = (cosine > 0.99) & (turned < LARGEST_TURN / 2)
        moved = zip(here, there, strict=True)
        here = Points(*(np.where(good[:, np.newaxis], new, old) for old, new in moved))
        ahead = np.abs(unit(here.tangents / units))
        if equations.ball.has_duration:
            ahead[:, 2 : equations.size : equations.unknowns] = 0.0
        stalled = ahead.max(axis=1) < STALLED
        longer = np.minimum(np.where(easy, 2 * step, step), LONGEST_STEP)
        step = np.where(good, longer, length / 2)
        # Distance of each branch from its start, modulo whole turns of the table.
        turns = np.round((here.z - first.z)[:, 0] / (2 * np.pi))
        away = np.linalg.norm(equations.later(here.z - first.z, -turns) / units, axis=1)
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
            ends[rows[j]] = _end_of_step(passed, last[j], back[j], kind, equations.kind)
            if stalled[j] and not ends[rows[j]]:
                nearest = np.abs(here.tests[j, SINGULAR]).argmin()
                ends[rows[j]] = equations.kinds[SINGULAR][nearest]
            if not ends[rows[j]] and len(paths[rows[j]]) >= points:
                ends[rows[j]] = f"the maximum of {points} points is reached"
        for j in np.flatnonzero(step < SHORTEST_STEP):
            ends[rows[j]] = ends[rows[j]] or TOO_FAST
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
    """Find the point just before the first end that each step crosses.

    The tests are NaN if Newton's method fails.
    """
    before = here.tests[:, SINGULAR]
    after = there.tests[:, SINGULAR]
    share = np.where(before * after < 0, before / (before - after), 1.0).min(axis=1)
    share = (1 - BEFORE_END) * share[:, np.newaxis]
    solution = newton(equations, here.z + share * (there.z - here.z), normal)
    inner = points_at(equations, solution.z, solution.tangent, solution.linear)
    inner.tests[~solution.converged] = np.nan
    return same_sign(here, inner)


def _cosine(points: Points, others: Points, units: NDArray) -> NDArray:
    """Cosine of the angle between two tangents in each row, in scaled units."""
    return np.sum(unit(points.tangents / units) * unit(others.tangents / units), axis=1)


def _end_of_step(passed: NDArray, last: bool, back: bool, until: str | None, curve: str) -> str:
    """Reason why a branch ends with this step, or "" if it continues.

    ``passed`` are the kinds of special orbits that the step crossed.
    """
    for name in passed:
        if ends_at(name, until, curve):
            return str(name)
    if last:
        return AT_GOAL
    return CLOSED if back else ""


def ends_at(kind: str, until: str | None, curve: str = "") -> bool:
    """Whether a branch, or a curve of special orbits, ends at special orbits of this kind.

    A curve of Neimark-Sacker bifurcations ends where the multipliers become real: the orbits beyond
    are neutral saddles.
    """
    is_real = curve == "Neimark-Sacker" and kind in MULTIPLIERS
    return is_real or kind == until or (kind in KINDS and KINDS[kind].end != "")


def _path_of(path: list[Points], end: str, equations: OrbitEquations, units: NDArray) -> Points:
    """Join the points of one branch. A closed branch ends exactly at its start."""
    if end == CLOSED:
        ahead = np.sum(path[0].tangents * (path[-1].z - path[0].z) / units**2) > 0
        turns = np.round((path[-1].z[0, 0] - path[0].z[0, 0]) / (2 * np.pi))
        z = equations.later(path[0].z, turns)
        path = [*(path[:-1] if ahead else path), path[0]._replace(z=z)]
    return Points(*(np.concatenate(parts) for parts in zip(*path, strict=True)))
