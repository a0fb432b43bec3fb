"""Special points on a branch: zeros of test functions, and limits of a domain.

An event is a zero of a test function g(y). It is detected by a sign change between two points of
the branch, and then located as a solution of the extended system ``F(y) = 0, g(y) = 0``, to the
tolerance of Newton's method whatever the length of the step. A domain is given by a truth value
alone, so that its limits on the branch are located by bisection.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.numerics.corrector import Condition, NewtonSettings, Problem, newton, plane

# Step of the central differences for ∇g, near the optimum ε^(1/3). It affects the speed of
# convergence but not the limit, which depends on g alone.
_DIFFERENCE = 6e-6
# With an approximate gradient more iterations are needed than in the plain corrector.
_PATIENT = NewtonSettings(max_iterations=20)
# Rounding may move a zero at an end of the bracket outside, by at most this part of the bracket.
_SLACK = 1e-6
# A defect of this size is a hundred roundings. A test function that is as small before and after a
# step may have it at its zero as well.
_DEFECT = 1e-13
# A chord is divided at these shares, at points that are computed together, which costs hardly more
# than one point does; and the largest number of such divisions.
_SHARES = np.linspace(0.0, 1.0, 17)[1:-1, np.newaxis]
_ROUNDS = 15
# A chord is divided until its length relative to the point is at most this rounding error.
_ROUNDING = 4e-16
_TINY = np.finfo(float).tiny


@dataclass(frozen=True)
class Event:
    """A test function on the branch.

    Parameters
    ----------
    name : str
        The name of the located zeros in results.
    function : callable
        g(y), for y of shape (..., N + 1).
    terminal : bool
        Whether the branch ends at a zero. The function is then positive inside the domain.
    reason : str
        The reason why the branch ends at a terminal event, as a sentence.
    condition : callable, optional
        g(y) with its gradient; by default the gradient is a central difference.
    is_sign : bool
        Whether g(y) is only a sign, 1 inside a domain and -1 outside, whose limit is located by
        bisection.
    """

    name: str
    function: Callable[[np.ndarray], np.ndarray]
    terminal: bool = False
    reason: str = ""
    condition: Condition | None = None
    is_sign: bool = False


class SpecialPoint(NamedTuple):
    """A located event: its name, and its point y of shape (N + 1,)."""

    name: str
    point: np.ndarray


def vanishing(function: Callable[[np.ndarray], np.ndarray]) -> Condition:
    """The condition that a test function vanishes, with its gradient by central differences.

    Examples
    --------
    >>> value, gradient = vanishing(lambda y: y[..., 0] ** 2)(np.array([3.0, 1.0]))
    >>> float(value), gradient.round(6).tolist()
    (9.0, [6.0, 0.0])
    """

    def condition(y):
        size = y.shape[-1]
        offsets = np.concatenate([np.zeros((1, size)), np.eye(size), -np.eye(size)])
        offsets = offsets.reshape(-1, *(1,) * (y.ndim - 1), size)
        values = function(y + _DIFFERENCE * offsets)
        slopes = (values[1 : size + 1] - values[size + 1 :]) / (2 * _DIFFERENCE)
        return values[0], np.moveaxis(slopes, 0, -1)

    return condition


def locate(
    problem: Problem,
    event: Event,
    left: np.ndarray,
    right: np.ndarray,
    settings: NewtonSettings = _PATIENT,
    *,
    values: tuple[float, float] | None = None,
    tangents: tuple[np.ndarray, np.ndarray] | None = None,
) -> SpecialPoint | None:
    """The zero of an event between two points of the branch, each of shape (N + 1,).

    Newton's method on the extended system starts from the secant estimate. The result is None if
    the method does not converge, or converges outside the bracket or to no zero, because a step of
    the continuation was too long or because there is none. ``values`` are those of the test
    function and ``tangents`` those of the branch at the two points, if they are known. With
    tangents the estimate lies on a cubic through the two points, and not on their chord.
    """
    if event.is_sign:
        last = domain_limits(problem, lambda y: event.function(y) > 0, np.stack([left, right]))
        return SpecialPoint(event.name, last[0])
    before, after = values or (float(event.function(point)) for point in (left, right))
    chord = right - left
    share = before / (before - after)
    guess = left + share * chord
    if tangents is not None:
        length = np.linalg.norm(chord)
        begins, ends = (length * tangent - chord for tangent in tangents)
        guess += bend(share, begins, ends)
    condition = event.condition or vanishing(event.function)
    found = newton(problem, guess, condition, settings)
    progress = (found.point - left) @ chord / (chord @ chord)
    # Where a test function and its differences become large without bounds, a short step is no sign
    # of a zero.
    vanishes = found.residual <= max(abs(before), abs(after), _DEFECT)
    if not (found.converged and vanishes and -_SLACK <= progress <= 1 + _SLACK):
        return None
    return SpecialPoint(event.name, found.point)


def bend(share: Any, begins: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """What is to be added to the point at a share of a chord, so that it lies on Hermite's cubic.

    Parameters
    ----------
    share : float or array
        The place on the chord, from 0 to 1.
    begins, ends : ndarray
        The tangents of the cubic at the ends of the chord, as long as it, minus the chord.

    Examples
    --------
    The parabola (s, s²) between s = 0 and s = 1, with the tangents (1, 0) and (1, 2):

    >>> chord = np.array([1.0, 1.0])
    >>> bend(0.5, np.array([1.0, 0.0]) - chord, np.array([1.0, 2.0]) - chord).tolist()
    [0.0, -0.25]
    """
    return share * (1 - share) * ((1 - share) * begins - share * ends)


class Change(NamedTuple):
    """An event on a step, and its test function before and after the step, of different signs."""

    event: Event
    before: float
    after: float


def changes_of_sign(events: Sequence[Event], before: np.ndarray, after: np.ndarray) -> list[Change]:
    """The events whose test functions differ in sign before and after a step."""
    changed = np.flatnonzero((before >= 0) != (after >= 0))
    return [Change(events[k], float(before[k]), float(after[k])) for k in changed.tolist()]


class Passage(NamedTuple):
    """The events on a step along a branch.

    ``special`` holds the located events in order, up to the first terminal event, and ``terminal``
    is this event, or None. ``missed`` is an event that could not be located, or None; it does not
    matter if there is a terminal event.
    """

    special: tuple[SpecialPoint, ...]
    terminal: Event | None
    missed: Event | None


def locate_all(
    problem: Problem,
    changes: Sequence[Change],
    left: np.ndarray,
    right: np.ndarray,
    tangents: tuple[np.ndarray, np.ndarray],
) -> Passage:
    """The zeros of several events between two points of the branch with these tangents, in order
    along the chord.
    """
    located = []
    missed = None
    last = right
    # Events beyond the end of the branch are not located.
    for event, before, after in sorted(changes, key=lambda change: not change.event.terminal):
        there = after if last is right else float(event.function(last))
        if (before >= 0) == (there >= 0):
            continue
        known = tangents if last is right else None
        special = locate(problem, event, left, last, values=(before, there), tangents=known)
        if special is None:
            missed = event
            continue
        located.append((event, special))
        if event.terminal:
            last = special.point
    located.sort(key=lambda pair: float((pair[1].point - left) @ (right - left)))
    for count, (event, _) in enumerate(located, start=1):
        if event.terminal:
            return Passage(tuple(special for _, special in located[:count]), event, None)
    return Passage(tuple(special for _, special in located), None, missed)


def domain_limits(
    problem: Problem, inside_at: Callable[[np.ndarray], np.ndarray], points: np.ndarray
) -> np.ndarray:
    """The last points of a branch inside a domain, one for each of the limits that it crosses.

    A limit lies between a point inside and a point outside. The chord between the two points is
    divided into 16 parts, again and again, where each point is corrected onto the branch, until the
    two points agree to rounding.

    Parameters
    ----------
    problem : Problem
        Its solutions are the branch.
    inside_at : callable
        Tells for solutions of shape (..., N + 1) whether they are inside.
    points : ndarray, shape (m, N + 1)
        Solutions in order along the branch.

    Returns
    -------
    ndarray, shape (k, N + 1)
        One point for each of the k limits, in order along the branch.
    """
    known = inside_at(points)
    at = np.flatnonzero(known[:-1] != known[1:])
    inside = points[np.where(known[at], at, at + 1)]
    outside = points[np.where(known[at], at + 1, at)]
    if not at.size:
        return inside
    row = np.arange(at.size)
    for _ in range(_ROUNDS):
        normal = outside - inside
        length = np.linalg.norm(normal, axis=-1, keepdims=True)
        if np.all(length[:, 0] <= _ROUNDING * np.linalg.norm(inside, axis=-1)):
            break
        between = inside[:, np.newaxis] + _SHARES * normal[:, np.newaxis]
        across = np.broadcast_to((normal / np.maximum(length, _TINY))[:, np.newaxis], between.shape)
        found = newton(problem, between, plane(across, between))
        # The limit lies after the last of the first points that are inside, and before the next.
        reached = np.where(found.converged[..., np.newaxis], found.point, inside[:, np.newaxis])
        good = inside_at(reached) & found.converged
        count = np.cumprod(good, axis=-1).sum(axis=-1)
        known = np.concatenate([inside[:, np.newaxis], reached, outside[:, np.newaxis]], axis=1)
        solved = np.pad(found.converged, ((0, 0), (1, 1)), constant_values=True)
        inside = known[row, count]
        outside = np.where(solved[row, count + 1, np.newaxis], known[row, count + 1], outside)
    return inside
