"""Locate special orbits between two orbits of a march, or near a guess."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.periodic.equations import KINDS, MULTIPLIERS, SINGULAR, OrbitEquations
from bouncing_ball_beyond.periodic.march import (
    Points,
    Solution,
    ends_at,
    newton,
    points_at,
    same_sign,
)


class Crossings(NamedTuple):
    """Steps of branches in which a test function changes its sign.

    Attributes
    ----------
    row : array of int, shape (steps,)
        Branch of each step.
    number : array of int, shape (steps,)
        Index of the step along its branch.
    kind : array of str, shape (steps,)
        Kind of special orbit whose test function changes its sign.
    ends, slopes : array, shape (2, steps, N)
        Orbits and tangents at the start and at the end of each step.
    values : array, shape (2, steps)
        Test functions at the start and at the end of each step.
    """

    row: NDArray
    number: NDArray
    kind: NDArray
    ends: NDArray
    slopes: NDArray
    values: NDArray


def crossings_of(
    equations: OrbitEquations,
    row: NDArray,
    z: NDArray,
    slopes: NDArray,
    tests: NDArray,
    grazings: bool,
) -> Crossings:
    """Find all steps in which a test function changes its sign.

    ``z`` contains the orbits of all branches, shape (points, N). ``row`` is the branch of each
    orbit. If ``grazings`` is False, grazings of flights and releases are not looked for.
    """
    number = np.arange(len(row)) - np.searchsorted(row, row)
    every = equations.rows(row)
    touches = {"grazing of a flight", "grazing of a release"} if grazings else set()
    others = sorted(touches - {equations.kind})
    names = [*equations.kinds, *others]
    values = np.array([*tests.T, *(KINDS[name].test(every, z, None) for name in others)])
    crossed = (values[:, :-1] * values[:, 1:] < 0) & (row[1:] == row[:-1])
    # At a pole or a jump of tr/(1 + det), the tests change sign although no multiplier is ±1.
    pole = np.abs(np.diff(np.arctan(values[1] - 1))) > np.pi / 2
    crossed[:2] &= ~pole
    crossed[:3] &= ~crossed[SINGULAR].any(axis=0)
    which, at = np.nonzero(crossed)
    both = np.stack([at, at + 1])
    kinds = np.array(names)[which]
    return Crossings(row[at], number[at], kinds, z[both], slopes[both], values[which, both])


BETWEEN = 9
"""Number of orbits in a step among which `divided` looks for one between two bifurcations."""


@np.errstate(all="ignore")
def divided(equations: OrbitEquations, path: Points) -> Points:
    """Insert orbits of one branch between two Neimark-Sacker bifurcations in one step.

    They are looked for where det turns back and is nearer to 1 than it changed in a step.
    """
    pair = equations.kinds.index("Neimark-Sacker")
    values = path.tests[:, pair]
    size = np.abs(values)
    turns = (values[1:-1] * values[:-2] > 0) & (values[1:-1] * values[2:] > 0)
    turns &= (size[1:-1] < size[:-2]) & (size[1:-1] <= size[2:])
    turns &= 2 * size[1:-1] < np.maximum(size[:-2], size[2:])
    for i in np.flatnonzero(turns)[::-1] + 1:
        units = equations.scales(path.z[[i]])
        chords = np.diff(path.z[i - 1 : i + 2], axis=0)
        share = np.tile(np.linspace(0, 1, BETWEEN), 2)[:, np.newaxis]
        step = np.repeat([0, 1], BETWEEN)
        normal = (chords / units**2)[step]
        solution = newton(equations, path.z[i - 1 + step] + share * chords[step], normal)
        there = points_at(equations, solution.z, solution.tangent, solution.linear)
        opposite = np.where(solution.converged, there.tests[:, pair] * np.sign(values[i]), 0.0)
        best = int(opposite.argmin())
        if opposite[best] < 0:
            at = i + step[best]
            inner = same_sign(path.take([at - 1]), there.take([best]))
            parts = zip(path, inner, strict=True)
            path = Points(*(np.insert(old, at, new[0], axis=0) for old, new in parts))
    return path


def _cubic(part: NDArray, ends: NDArray, slopes: NDArray) -> NDArray:
    """Interpolate between the ends of steps with Hermite cubics.

    ``part`` is the position in each step, from 0 to 1. ``slopes`` are derivatives with respect to
    ``part``.
    """
    x = part[:, np.newaxis]
    chord = ends[1] - ends[0]
    bend = slopes[0] + slopes[1] - 2 * chord
    return ends[0] + x * (slopes[0] + x * (chord - slopes[0] - bend + x * bend))


def _tests_of(kinds: NDArray, equations: OrbitEquations, solution: Solution) -> NDArray:
    """For each orbit, evaluate the test function of its kind, shape (rows,)."""
    values = np.empty(len(kinds))
    for name in np.unique(kinds):
        these = kinds == name
        linear = solution.linear.rows(these)
        values[these] = KINDS[name].test(equations.rows(these), solution.z[these], linear)
    return values


@np.errstate(all="ignore")
def located(equations: OrbitEquations, crossings: Crossings) -> tuple[NDArray, NDArray]:
    """Find the orbits at which the test functions are zero.

    The rule of Anderson and Björck (BIT 13, 253, 1973) brackets the zero along the chord of each
    step. Newton's method corrects each orbit on the plane perpendicular to the chord.

    Returns the orbits, shape (steps, N), and whether each was found.
    """
    equations = equations.rows(crossings.row)
    ends = crossings.ends.copy()
    values = crossings.values.copy()
    units = equations.scales(ends[0])
    chord = (ends[1] - ends[0]) / units
    normal = chord / units / np.sum(chord**2, axis=1, keepdims=True)
    slopes = crossings.slopes / np.sum(normal * crossings.slopes, axis=2, keepdims=True)
    weights = values.copy()
    rows = np.arange(len(chord))
    place = np.array([0 * rows, 0 * rows + 1.0])
    latest = 0 * rows - 1
    # The equations are singular at a period halving: use `halved_at`.
    is_located = crossings.kind != "period halving"
    singular = np.array([ends_at(name, None) for name in crossings.kind])
    z = ends[0]
    nearest = ends[0].copy()
    least = np.full(len(chord), np.inf)
    for _ in range(60):
        step = place[1] - place[0]
        part = weights[0] / (weights[0] - weights[1])
        guess = _cubic(part, ends, slopes * step[:, np.newaxis])
        solution = newton(equations, guess, normal)
        if equations.kind:
            # At the end of a curve the equations are singular, but the curve is smooth.
            lost = ~solution.converged & singular
            solution.z[lost] = guess[lost]
            solution.tangent[lost] = slopes[0, lost]
            solution.converged[lost] = True
            solution = solution._replace(linear=equations.linearized(solution.z))
        is_located &= solution.converged
        z = np.where(is_located[:, np.newaxis], solution.z, guess)
        value = _tests_of(crossings.kind, equations, solution)
        nearer = np.abs(value) < least
        nearest[nearer] = z[nearer]
        least[nearer] = np.abs(value)[nearer]
        side = (value * values[1] > 0).astype(int)
        ratio = 1 - value / values[side, rows]
        again = np.where(ratio > 0, ratio, 0.5)
        weights[1 - side, rows] *= np.where(side == latest, again, 1.0)
        moved = np.abs(place[0] + part * step - place[side, rows])
        place[side, rows] = place[0] + part * step
        values[side, rows] = value
        weights[side, rows] = value
        ends[side, rows] = solution.z
        slopes[side, rows] = solution.tangent
        latest = side
        if ((np.abs(value) < 1e-13) | (moved < 1e-14) | ~is_located).all():
            break
    # Use the iterate with the smallest test function, because rounding errors may move later
    # iterates away: at the ends of curves the equations are singular.
    largest = np.abs(crossings.values).max(axis=0)
    is_located &= least < 1e-6 * np.maximum(largest, 0.1)
    # A saddle with the real multipliers μ and 1/μ is neutral, and no bifurcation. On a curve of
    # saddle-nodes or period doublings, the multipliers are equal: a resonance.
    pair = crossings.kind == "Neimark-Sacker"
    if pair.any() and equations.kind not in MULTIPLIERS:
        there = equations.rows(pair)
        is_located[pair] &= np.abs(there.turn(there.linearized(nearest[pair]))) < 1
    return nearest, is_located


def halved_at(equations: OrbitEquations, ends: NDArray) -> NDArray | None:
    """Find the period halving in a step. There the orbits merge with orbits of half the period.

    The orbits of half the period double their period at the same point. Newton's method finds this
    period doubling. The orbit there, run through twice, is the orbit of the halving. Returns None
    if Newton's method fails, or if the period doubling is far from the step.
    """
    half, near = equations.halved(ends)
    doubling = replace(half, kind="period doubling")
    solution = newton(doubling, near.mean(axis=0, keepdims=True), iterations=20)
    if not solution.converged[0]:
        return None
    twice = half.doubled(solution.z)[1]
    z = equations.later(twice, np.round((ends[0, 0] - twice[0, 0]) / (2 * np.pi)))[0]
    units = equations.scales(ends[:1])[0]
    reach = np.abs((ends[1] - ends[0]) / units).max()
    return z if np.abs((z - ends[0]) / units).max() < 3 * reach else None
