"""Newton's method on the problem with one condition added, and tangents."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from bouncing_ball.continuation.problem import Problem


class Correction(NamedTuple):
    """Outcome of a Newton iteration.

    ``point`` has the shape of the guess; ``residual`` is the largest entry of
    the extended residual there; ``step`` the last Newton step's norm.
    """

    point: np.ndarray
    converged: bool
    iterations: int
    residual: float
    step: float


class NewtonSettings(NamedTuple):
    """When a Newton iteration has converged, and when it has failed.

    ``tolerance`` bounds the norm of the last step, relative to 1 + |y|. As the
    convergence is quadratic, the point is then as exact as F is computed.
    """

    tolerance: float = 1e-12
    max_iterations: int = 8


Condition = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Maps y (..., N + 1) to a value (...,) and its gradient (..., N + 1)."""


def newton(
    problem: Problem, guess: np.ndarray, condition: Condition, settings: NewtonSettings
) -> Correction:
    """Solve F(y) = 0 together with one scalar condition.

    Parameters
    ----------
    problem : Problem
        N equations.
    guess : ndarray, shape (..., N + 1)
        Many guesses are iterated together, until all have converged.
    condition : Condition
        The equation number N + 1, for instance a plane or a test function.
    settings : NewtonSettings

    Returns
    -------
    Correction
        ``converged`` is false if the iteration ran out, met a singular matrix
        or left the domain of F.
    """
    y = np.array(guess, dtype=float)
    size = residual = np.inf
    for iteration in range(1, settings.max_iterations + 1):
        value, gradient = condition(y)
        right = np.concatenate([problem.residual(y), value[..., np.newaxis]], axis=-1)
        matrix = np.concatenate([problem.jacobian(y), gradient[..., np.newaxis, :]], axis=-2)
        residual = float(np.max(np.abs(right)))
        if not (np.isfinite(residual) and np.all(np.isfinite(matrix))):
            return Correction(y, False, iteration, residual, size)
        try:
            change = np.linalg.solve(matrix, right[..., np.newaxis])[..., 0]
        except np.linalg.LinAlgError:
            return Correction(y, False, iteration, residual, size)
        y = y - change
        relative = np.linalg.norm(change, axis=-1) / (1 + np.linalg.norm(y, axis=-1))
        size = float(np.max(relative))
        if size <= settings.tolerance:
            return Correction(y, True, iteration, residual, size)
    return Correction(y, False, settings.max_iterations, residual, size)


def plane(normal: np.ndarray, through: np.ndarray) -> Condition:
    """The condition that y lies in the plane ``normal · (y - through) = 0``.

    Examples
    --------
    >>> value, gradient = plane(np.array([0.0, 2.0]), np.array([1.0, 1.0]))(np.array([5.0, 4.0]))
    >>> float(value), gradient.tolist()
    (6.0, [0.0, 2.0])
    """

    def condition(y):
        return np.sum(normal * (y - through), axis=-1), np.broadcast_to(normal, y.shape)

    return condition


def tangent(jacobian: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Unit tangent of the solution curve, on the side of ``along``.

    The null vector of the N × (N + 1) Jacobian from a bordered system, which
    is regular at a fold too.

    Examples
    --------
    >>> tangent(np.array([[2.0, 0.0]]), np.array([0.0, -1.0])).tolist()
    [0.0, -1.0]
    """
    matrix = np.concatenate([jacobian, along[..., np.newaxis, :]], axis=-2)
    right = np.zeros((*along.shape, 1))
    right[..., -1, 0] = 1.0
    vector = np.linalg.solve(matrix, right)[..., 0]
    return vector / np.linalg.norm(vector, axis=-1, keepdims=True)


def null_vector(jacobian: np.ndarray) -> np.ndarray:
    """Unit null vector of an N × (N + 1) matrix, with a positive last entry."""
    vector = np.linalg.svd(jacobian)[2][-1]
    return -vector if vector[-1] < 0 else vector
