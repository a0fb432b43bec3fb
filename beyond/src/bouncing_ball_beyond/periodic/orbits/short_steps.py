"""Newton's method in short steps, from a guess that is not next to the solution.

A step of Newton's method is linear in the values of the equations: with all of them multiplied by
one factor it is shorter and has the same direction.
"""

from typing import NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.numerics.corrector import (
    Condition,
    Correction,
    Equations,
    NewtonSettings,
    Problem,
    bordered,
    checked,
    failure,
    null_vector,
    plane,
    solve,
    solve_linear,
)

# The accuracy in the parameter with which folds are located.
_LOCATED = 1e-12


class ShortSteps(NamedTuple):
    """The greatest length and the greatest number of the steps of Newton's method."""

    longest: float
    max_iterations: int = 30


def shortened(equations: Equations, longest: float) -> Equations:
    """Equations with the same solutions, of which no step of Newton's method is longer.

    Examples
    --------
    The step to the zero of x - 3 from 0 has the length 3:

    >>> short = shortened(lambda y: (y - 3, np.ones((*y.shape, 1))), 0.5)
    >>> values, matrix = short(np.zeros((1, 1)))
    >>> (-values / matrix[..., 0]).tolist()
    [[0.5]]
    """

    def short(y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        values, matrix = equations(y)
        # A matrix of NaN would cause a warning; Newton's method ends at this point anyway.
        known = np.isfinite(matrix).all(axis=(-2, -1), keepdims=True)
        length = np.linalg.norm(solve_linear(np.where(known, matrix, np.nan), values), axis=-1)
        share = np.where(length > longest, longest / length, 1.0)
        return share[..., np.newaxis] * values, matrix

    return short


def solve_short(equations: Equations, guess: np.ndarray, steps: ShortSteps) -> Correction:
    """:func:`bouncing_ball_beyond.inherited.numerics.corrector.solve` in short steps."""
    settings = NewtonSettings(max_iterations=steps.max_iterations)
    with np.errstate(all="ignore"):
        return solve(shortened(equations, steps.longest), guess, settings)


def newton_short(
    problem: Problem, guess: np.ndarray, condition: Condition, steps: ShortSteps
) -> Correction:
    """:func:`bouncing_ball_beyond.inherited.numerics.corrector.newton` in short steps."""
    equations = bordered(problem, condition)
    return checked(solve_short(equations, guess, steps), problem.residual)


def solution_near(problem: Problem, guess: np.ndarray, steps: ShortSteps) -> tuple[np.ndarray, str]:
    """The solution with the parameter of a guess, shape (N + 1,), and why there is none, or "".

    At a fold the equations with a fixed parameter are singular. There the solution in the plane
    across the curve is the same, because the parameter only moves by rounding errors.
    """
    axis = np.eye(guess.size)[-1]
    found = newton_short(problem, guess, plane(axis, guess), steps)
    why = failure(problem, found)
    if why:
        across = null_vector(problem.jacobian(guess))
        fold = newton_short(problem, guess, plane(across, guess), steps)
        if abs(fold.point[-1] - guess[-1]) <= _LOCATED and not failure(problem, fold):
            return fold.point, ""
    return found.point, why
