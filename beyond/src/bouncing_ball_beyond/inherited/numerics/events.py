"""Special points on a branch: zeros of test functions.

An event is a zero of a test function g(y). It is detected by a sign change between two points of
the branch, and then located as a solution of the extended system ``F(y) = 0, g(y) = 0``, to the
tolerance of Newton's method whatever the length of the step.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.numerics.corrector import (
    Condition,
    NewtonSettings,
    Problem,
    newton,
)

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


class SpecialPoint(NamedTuple):
    """A located event: its name, and its point y of shape (N + 1,)."""

    name: str
    point: np.ndarray


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
    normal : ndarray, shape (N + 1,), optional
        The gradient of a g that is linear, a unit vector; see :func:`limit`.
    """

    name: str
    function: Callable[[np.ndarray], np.ndarray]
    terminal: bool = False
    reason: str = ""
    condition: Condition | None = None
    normal: np.ndarray | None = None

    def locate(
        self,
        problem: Problem,
        left: np.ndarray,
        right: np.ndarray,
        settings: NewtonSettings = _PATIENT,
        *,
        values: tuple[float, float] | None = None,
        tangents: tuple[np.ndarray, np.ndarray] | None = None,
        curvature: float = 0.0,
    ) -> SpecialPoint | None:
        """The zero between two points of the branch, each of shape (N + 1,).

        Newton's method on the extended system starts from the secant estimate. The result is None
        if the method does not converge, or converges outside the bracket or to no zero, because a
        step of the continuation was too long or because there is none. ``values`` are those of the
        test function and ``tangents`` those of the branch at the two points, if they are known.
        With tangents the estimate lies on a cubic through the two points, and not on their chord.
        ``curvature`` is that of :class:`Change`.
        """
        before, after = values or (float(self.function(point)) for point in (left, right))
        chord = right - left
        share = crossing(before, after, curvature)
        guess = left + share * chord
        if tangents is not None:
            length = np.linalg.norm(chord)
            begins, ends = (length * tangent - chord for tangent in tangents)
            guess += bend(share, begins, ends)
        condition = self.condition or vanishing(self.function)
        found = newton(problem, guess, condition, settings)
        progress = (found.point - left) @ chord / (chord @ chord)
        # Where a test function and its differences become large without bounds, a short step is no
        # sign of a zero.
        vanishes = found.residual <= max(abs(before), abs(after), _DEFECT)
        if not (found.converged and vanishes and -_SLACK <= progress <= 1 + _SLACK):
            return None
        return SpecialPoint(self.name, found.point)


def limit(name: str, normal: np.ndarray, at: float, reason: str) -> Event:
    """The end of a branch in the plane ``normal · y = at``, from the side where the product is
    larger, such as the end of the range of a parameter.

    The last step ends in this plane, so that there is nothing to locate.

    Examples
    --------
    >>> top = limit("top", np.array([0.0, -1.0]), -3.0, "amplitude = 3 is reached")
    >>> float(top.function(np.array([1.0, 2.0])))
    1.0
    """
    return Event(name, lambda y: y @ normal - at, terminal=True, reason=reason, normal=normal)


def crossing(before: float, after: float, curvature: float = 0.0) -> float:
    """The zero between 0 and 1 of ``before + (after - before) x + curvature x (x - 1)``, a parabola
    with values of different signs at 0 and 1.

    Examples
    --------
    >>> crossing(-1.0, 3.0), crossing(-1.0, 3.0, 4.0)
    (0.25, 0.5)
    """
    if not (before and np.isfinite(curvature)):
        return before / (before - after)
    slope = after - before - curvature
    root = math.copysign(math.sqrt(slope * slope - 4 * curvature * before), after - before)
    return -2 * before / (slope + root)


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
    """An event on a step, its test function before and after the step, of different signs, and the
    second difference of this function over the square of the step; 0 if it is not known.
    """

    event: Event
    before: float
    after: float
    curvature: float


def changes_of_sign(
    events: Sequence[Event],
    before: np.ndarray,
    after: np.ndarray,
    earlier: tuple[np.ndarray, float] | None = None,
) -> list[Change]:
    """The events whose test functions differ in sign before and after a step.

    ``earlier`` are the test functions at the point before the step, and the length of the step
    before over that of this one.

    Examples
    --------
    The square of x less 2, at -1, 1 and 2:

    >>> square = Event("square", lambda y: y[..., 0] ** 2 - 2)
    >>> values = np.array([[-1.0], [-1.0], [2.0]])
    >>> changes_of_sign([square], values[1], values[2], (values[0], 2.0))[0].curvature
    1.0
    """
    curvature = np.zeros(before.shape)
    if earlier is not None:
        values, length = earlier
        curvature = (after - before - (before - values) / length) / (1 + length)
    changed = np.flatnonzero((before >= 0) != (after >= 0)).tolist()
    rows = np.stack([before, after, curvature], axis=-1)[changed].tolist()
    return [Change(events[k], *row) for k, row in zip(changed, rows, strict=True)]


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
    for change in sorted(changes, key=lambda change: not change.event.terminal):
        event, before, after, curvature = change
        whole = last is right
        there = after if whole else float(event.function(last))
        if (before >= 0) == (there >= 0):
            continue
        known: dict[str, Any] = {"tangents": tangents, "curvature": curvature} if whole else {}
        special = event.locate(problem, left, last, values=(before, there), **known)
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
