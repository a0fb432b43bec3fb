"""Newton's method, for a system of equations and for a point of a branch.

A :class:`Problem` has one unknown more than equations, and its solutions form a branch. One added
:data:`Condition`, for example a plane across the branch, selects a point, which Newton's method
finds. The tangent of the branch is the null vector of the problem's Jacobian.
"""

from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np

# Largest defect of a point of which the last Newton step is not small: a hundred roundings.
_SATISFIED = 1e-13
# Largest defect of a solution, relative to (1 + |y|)² because the equations have products of two
# unknowns, such as speed and time. Next to singular ends of branches rounding leaves 1e-11.
_DEFECT = 1e-10
_ROUNDING = np.finfo(float).eps
# A change of an unknown by this share of it is a rounding error.
_UNCERTAIN = 4 * _ROUNDING
# The largest size of a last step that is longer than the tolerance. Its product with the error of a
# Jacobian by differences, about 1e-9, is a rounding error.
_SMALL = 1e-8
# A tangent is found by a linear system unless it is nearly at a right angle to the direction along
# which it is oriented; the reciprocal of this is the cosine.
_OBLIQUE = 1e3


class Problem(Protocol):
    """N equations F(y) = 0 for N unknowns x and one parameter p, with y = (x, p).

    Both methods broadcast over leading axes. The unknowns should be scaled to
    order one, because the arclength is the Euclidean norm of y.
    """

    def residual(self, y: np.ndarray) -> np.ndarray:
        """F(y), shape (..., N) for y of shape (..., N + 1)."""

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """∂F/∂y, shape (..., N, N + 1)."""


class Correction(NamedTuple):
    """Outcome of Newton iterations from one or many guesses.

    ``point`` has the shape of the guesses. ``converged``, ``iterations``, ``residual`` (the largest
    modulus of an equation at the last iteration) and ``step`` (the norm of the last Newton step
    relative to 1 + |y|) have the shape of its leading axes.
    """

    point: np.ndarray
    converged: np.ndarray
    iterations: np.ndarray
    residual: np.ndarray
    step: np.ndarray


class NewtonSettings(NamedTuple):
    """Criteria for the convergence and the failure of a Newton iteration.

    ``tolerance`` bounds the norm of the last step, relative to 1 + |y|. Because the
    convergence is quadratic, the point is then as accurate as F is computed. A longer step is also
    the last one if the next one would be a rounding error. ``max_iterations`` is the greatest
    number of steps.
    """

    tolerance: float = 1e-12
    max_iterations: int = 8


Equations = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Maps y (..., N) to the values of N equations (..., N) and their Jacobian (..., N, N)."""

Condition = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Maps y (..., N + 1) to a value (...,) and its gradient (..., N + 1)."""


def newton(
    problem: Problem,
    guess: np.ndarray,
    condition: Condition,
    settings: NewtonSettings = NewtonSettings(),
) -> Correction:
    """Solve F(y) = 0 together with one scalar condition.

    Parameters
    ----------
    problem : Problem
        N equations.
    guess : ndarray, shape (..., N + 1)
        Many guesses are iterated together; each stops when it has converged.
    condition : Condition
        The equation N + 1, for example that of a plane, or a test function set to zero.
    settings : NewtonSettings

    Returns
    -------
    Correction
        An iteration has not converged if it reached the greatest number of steps, met a singular
        matrix, left the domain of F, or ended at a point that does not satisfy F(y) = 0.
    """

    return checked(solve(bordered(problem, condition), guess, settings), problem.residual)


def bordered(problem: Problem, condition: Condition) -> Equations:
    """The equations of a problem together with a condition: N + 1 equations in N + 1 unknowns."""

    def equations(y):
        value, gradient = condition(y)
        values = np.concatenate([problem.residual(y), value[..., np.newaxis]], axis=-1)
        matrix = np.concatenate([problem.jacobian(y), gradient[..., np.newaxis, :]], axis=-2)
        return values, matrix

    return equations


def checked(found: Correction, residual: Callable[[np.ndarray], np.ndarray]) -> Correction:
    """The outcome of :func:`solve`, whose points have converged only if their residual is small.

    A short step is no sign of a solution where the Jacobian is wrong and large, as it may be on the
    other side of a special point. The equations are evaluated at the points again only if they were
    not satisfied before the last step.

    Examples
    --------
    >>> found = solve(lambda y: (y - 4, np.full((*y.shape, 1), 1e15)), np.array([[1.0], [4.0]]))
    >>> found.converged.tolist(), checked(found, lambda y: y - 4).converged.tolist()
    ([True, True], [False, True])
    """
    satisfied = found.residual <= _largest_defect(found.point)
    if not (found.converged & ~satisfied).any():
        return found
    satisfied |= satisfies(residual, found.point)
    return found._replace(converged=found.converged & satisfied)


def satisfies(residual: Callable[[np.ndarray], np.ndarray], y: np.ndarray) -> np.ndarray:
    """Whether points satisfy equations, up to what rounding leaves of them.

    Examples
    --------
    >>> satisfies(lambda y: y - 4, np.array([[4.0], [4.0 + 1e-8]])).tolist()
    [True, False]
    """
    with np.errstate(all="ignore"):
        return np.abs(residual(y)).max(axis=-1) <= _largest_defect(y)


def is_exact(problem: Problem, y: np.ndarray) -> bool:
    """Whether the defects of a single point are rounding errors, and its derivatives are defined.

    A step of Newton's method from it would be a rounding error as well, or, at a fold, wrong.

    Examples
    --------
    >>> class Line:
    ...     def residual(self, y):
    ...         return y[..., :1] - 4
    ...
    ...     def jacobian(self, y):
    ...         return np.array([[1.0, 0.0]])
    >>> is_exact(Line(), np.array([4.0, 0.0])), is_exact(Line(), np.array([4.1, 0.0]))
    (True, False)
    """
    with np.errstate(all="ignore"):
        exact = np.all(np.abs(problem.residual(y)) <= _SATISFIED)
        return bool(exact and np.isfinite(problem.jacobian(y)).all())


def _largest_defect(y: np.ndarray) -> np.ndarray:
    return _DEFECT * (1 + _norm(y)) ** 2


def solve(
    equations: Equations, guess: np.ndarray, settings: NewtonSettings = NewtonSettings()
) -> Correction:
    """Solve N equations in N unknowns, from one or many guesses of shape (..., N).

    A step that is a rounding error of each unknown is not made, so that a known solution stays as
    it is, to the last digit.

    Examples
    --------
    >>> found = solve(lambda y: (y * y - 4, 2 * y[..., np.newaxis]), np.array([[1.0], [-3.0]]))
    >>> found.point.tolist(), found.converged.tolist()
    ([[2.0], [-2.0]], [True, True])
    """
    y = np.array(guess, dtype=float)
    shape = y.shape[:-1]
    converged = np.zeros(shape, dtype=bool)
    going = np.ones(shape, dtype=bool)
    residual = np.full(shape, np.inf)
    size = np.full(shape, np.inf)
    iterations = np.zeros(shape, dtype=int)
    for _ in range(settings.max_iterations):
        if not going.any():
            break
        iterations += going
        values, matrix = equations(y)
        np.copyto(residual, np.abs(values).max(axis=-1), where=going)
        finite = np.isfinite(residual) & np.isfinite(matrix).all(axis=(-2, -1))
        going &= finite
        if not finite.all():
            # A matrix of NaN would cause a warning beside one that is singular.
            matrix = np.where(finite[..., np.newaxis, np.newaxis], matrix, np.eye(y.shape[-1]))
        change = solve_linear(matrix, values)
        length = _norm(change)
        going &= np.isfinite(length)
        moves = (np.abs(change) > _UNCERTAIN * np.abs(y)).any(axis=-1)
        ahead = np.where(going[..., np.newaxis], y - change, y)
        before = size
        size = np.where(going, length / (1 + _norm(ahead)), size)
        y = np.where(moves[..., np.newaxis], ahead, y)
        converged |= going & ((size <= settings.tolerance) | _next_is_rounding(before, size))
        going &= ~converged
    return Correction(y, converged, iterations, residual, size)


def _norm(vector: np.ndarray) -> np.ndarray:
    """The Euclidean norm along the last axis, infinite where a square overflows."""
    with np.errstate(over="ignore"):
        return np.sqrt((vector * vector).sum(axis=-1))


def _next_is_rounding(before: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Whether the step after two steps of these sizes is a rounding error.

    Quadratic convergence makes the steps e₂ = C e₁² and e₃ = C e₂², so that e₃ = e₂³/e₁². Because
    an inexact Jacobian adds its error times e₂, e₂ must itself be small.

    Examples
    --------
    >>> before = np.array([1e-4, 1e-6, np.inf])
    >>> _next_is_rounding(before, np.array([1e-8, 1e-8, 1e-8])).tolist()
    [True, False, False]
    """
    quadratic = (size <= _SMALL) & np.isfinite(before)
    return quadratic & (size**3 <= _ROUNDING * np.where(quadratic, before, 0.0) ** 2)


def solve_linear(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solutions (..., N) of linear systems; NaN where a matrix is singular or has NaN entries.

    Examples
    --------
    >>> solve_linear(np.array([[2.0, 0.0], [1.0, 1.0]]), np.array([4.0, 5.0])).tolist()
    [2.0, 3.0]
    """
    try:
        return np.linalg.solve(matrix, right[..., np.newaxis])[..., 0]
    except np.linalg.LinAlgError:
        singular = np.linalg.det(matrix) == 0
        matrix = np.where(singular[..., np.newaxis, np.newaxis], np.nan, matrix)
        return np.linalg.solve(matrix, right[..., np.newaxis])[..., 0]


def failure(problem: Problem, found: Correction) -> str:
    """Why a single Newton iteration ended at no solution; empty if it ended at one.

    Next to a bifurcation rounding moves the last step, although the equations are satisfied. Such a
    point is a solution if the Jacobian is defined there.
    """
    after = f"after {int(found.iterations)} Newton iterations"
    if found.converged:
        return ""
    if not np.all(np.isfinite(problem.jacobian(found.point))):
        return f"the derivatives of the equations are not defined {after}"
    return "" if found.residual <= _SATISFIED else f"residual {float(found.residual):.1e} {after}"


def plane(normal: np.ndarray, through: np.ndarray) -> Condition:
    """The condition that y lies in the plane ``normal · (y - through) = 0``.

    y has the shape of ``through``, the points through which the planes lead.

    Examples
    --------
    >>> value, gradient = plane(np.array([0.0, 2.0]), np.array([1.0, 1.0]))(np.array([5.0, 4.0]))
    >>> float(value), gradient.tolist()
    (6.0, [0.0, 2.0])
    """

    gradient = np.broadcast_to(normal, through.shape)

    def condition(y):
        return (normal * (y - through)).sum(axis=-1), gradient

    return condition


def null_vector(matrix: np.ndarray) -> np.ndarray:
    """Unit null vectors, shape (..., M), of matrices (..., N, M) of rank M - 1, with N = M - 1 or
    N = M; NaN where a matrix is not finite.

    Examples
    --------
    >>> np.abs(null_vector(np.array([[3.0, 0.0], [0.0, 0.0]]))).tolist()
    [0.0, 1.0]
    """
    defined = np.all(np.isfinite(matrix), axis=(-2, -1), keepdims=True)
    # The decomposition of a matrix with NaN entries would be an error for all matrices.
    vector = np.linalg.svd(np.where(defined, matrix, 0.0))[2][..., -1, :]
    return np.where(defined[..., 0], vector, np.nan)


def tangent(jacobian: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Unit tangent of the solution curve, oriented along ``along``, shape (..., N + 1).

    It is the null vector of the N × (N + 1) Jacobian, which is also defined at a fold. With the
    row ``along`` the Jacobian is a regular matrix, by which the tangent is found unless it is
    nearly at a right angle to this direction. The arguments have shapes (..., N, N + 1) and
    (..., N + 1). The tangent is NaN where the Jacobian is not finite.

    Examples
    --------
    >>> tangent(np.array([[1.0, 1.0]]), np.array([0.0, -1.0])).round(6).tolist()
    [0.707107, -0.707107]
    """
    along = np.broadcast_to(along, (*jacobian.shape[:-2], jacobian.shape[-1]))
    defined = np.isfinite(jacobian).all(axis=(-2, -1))[..., np.newaxis]
    border = np.concatenate([jacobian, along[..., np.newaxis, :]], axis=-2)
    if not defined.all():
        border = np.where(defined[..., np.newaxis], border, np.eye(along.shape[-1]))
    across = np.zeros(along.shape)
    across[..., -1] = 1
    vector = solve_linear(border, across)
    length = _norm(vector)[..., np.newaxis]
    vector = np.where(defined, vector / length, np.nan)
    turned = ~(length * _norm(along)[..., np.newaxis] < _OBLIQUE)
    if not turned.any():
        return vector
    of_null = null_vector(jacobian)
    ahead = np.sum(of_null * along, axis=-1, keepdims=True)
    return np.where(turned, np.where(ahead < 0, -of_null, of_null), vector)
