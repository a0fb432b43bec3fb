"""Special points on a branch: test functions and their exact location.

An event is a zero of a test function g(y). A sign change between two points
of the branch announces it; it is then located on the extended system
``F(y) = 0, g(y) = 0``, to the tolerance of Newton's method and not to the step.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bouncing_ball.continuation.corrector import Condition, NewtonSettings, newton
from bouncing_ball.continuation.problem import Problem

# Step of the central differences for ∇g, near the optimum ε^(1/3). It sets how
# fast the iteration converges; where it converges to is set by g alone.
_DIFFERENCE = 6e-6
# A first-order gradient costs a few iterations more than the plain corrector.
_EXTRA_ITERATIONS = 12
# How far beyond the bracket rounding may put a zero at its end, in parts of it.
_SLACK = 1e-6


@dataclass(frozen=True)
class Event:
    """A test function on the branch.

    Parameters
    ----------
    name : str
        What its zero is called in results.
    function : callable
        g(y), for y of shape (..., N + 1).
    terminal : bool
        Whether the branch ends there. A terminal function is positive inside.
    reason : str
        For a terminal event, why the branch ends, in words.
    """

    name: str
    function: Callable[[np.ndarray], np.ndarray]
    terminal: bool = False
    reason: str = ""


class SpecialPoint(NamedTuple):
    """A located event: its name, the point y and the largest residual left."""

    name: str
    point: np.ndarray
    residual: float


def fold(problem: Problem, name: str = "fold") -> Event:
    """Event at which ∂F/∂x is singular: the branch turns in the parameter."""

    return Event(name, lambda y: np.linalg.det(problem.jacobian(y)[..., :-1]))


def parameter_bound(bound: float, upper: bool, reason: str) -> Event:
    """Terminal event at which the parameter, the last entry of y, meets a bound."""
    sign = -1.0 if upper else 1.0
    return Event("parameter bound", lambda y: sign * (y[..., -1] - bound), True, reason)


def vanishing(function: Callable[[np.ndarray], np.ndarray]) -> Condition:
    """The condition that a test function is zero, its gradient by differences."""

    def condition(y):
        size = y.shape[-1]
        offsets = np.concatenate([np.zeros((1, size)), np.eye(size), -np.eye(size)])
        offsets = offsets.reshape(-1, *(1,) * (y.ndim - 1), size)
        values = function(y + _DIFFERENCE * offsets)
        slopes = (values[1 : size + 1] - values[size + 1 :]) / (2 * _DIFFERENCE)
        return values[0], np.moveaxis(slopes, 0, -1)

    return condition


def locate(
    problem: Problem, event: Event, left: np.ndarray, right: np.ndarray, settings: NewtonSettings
) -> SpecialPoint | None:
    """The zero of an event between two points of the branch, shape (N + 1,) each.

    Newton's method on the extended system, from the secant estimate. None where it leaves the
    bracket: a step of the continuation was too long, or there is no zero.
    """
    values, chord = [float(event.function(y)) for y in (left, right)], right - left
    guess = left + values[0] / (values[0] - values[1]) * chord
    patient = settings._replace(max_iterations=settings.max_iterations + _EXTRA_ITERATIONS)
    found = newton(problem, guess, vanishing(event.function), patient)
    progress = (found.point - left) @ chord / (chord @ chord)
    if not (found.converged and -_SLACK <= progress <= 1 + _SLACK):
        return None
    return SpecialPoint(event.name, found.point, float(found.residual))
