"""Matrices of closed chains of legs, and their bordered linear equations.

A leg is an impact and the flight after it. In the shapes below,

- rows is the number of orbits, and k the number of legs of each orbit;
- q is the number of unknowns of an impact, the first of which are τ and u;
- p is the number of parameters, and N = kq + p the number of unknowns of an orbit.

The derivatives of legs have the shape (rows, k, q, q + 2 + p). They are derivatives with respect to
the q unknowns of the impact, to τ and u of the next impact, and to the p parameters.
"""

import numpy as np
from numpy.typing import NDArray


def product_of(maps: NDArray) -> NDArray:
    """Product of the maps of all legs, shape (rows, 2, 2), with the last leg on the left.

    ``maps`` has the shape (rows, k, 2, 2).
    """
    while maps.shape[1] > 1:
        even = maps.shape[1] // 2 * 2
        pairs = maps[:, 1:even:2] @ maps[:, 0:even:2]
        maps = np.concatenate([pairs, maps[:, even:]], axis=1)
    return maps[:, 0]


def dense(derivatives: NDArray) -> NDArray:
    """Jacobian, shape (rows, k, q, N), from the derivatives of legs."""
    rows, k, q, columns = derivatives.shape
    matrix = np.zeros((rows, k, q, k * q + columns - q - 2), derivatives.dtype)
    for i in range(k):
        after = (i + 1) % k * q
        matrix[:, i, :, i * q : (i + 1) * q] += derivatives[:, i, :, :q]
        matrix[:, i, :, after : after + 2] += derivatives[:, i, :, q : q + 2]
    matrix[..., k * q :] = derivatives[..., q + 2 :]
    return matrix


def solved_or_nan(matrix: NDArray, values: NDArray) -> NDArray:
    """Solve linear equations. The solution is NaN if the matrix is singular."""
    try:
        return np.linalg.solve(matrix, values)
    except np.linalg.LinAlgError:
        singular = np.linalg.det(matrix) == 0
        return np.linalg.solve(
            np.where(singular[..., np.newaxis, np.newaxis], np.nan, matrix), values
        )


def solve_bordered(
    derivatives: NDArray, right: NDArray, border: NDArray, border_right: NDArray
) -> NDArray:
    """Solve the linear equations of the legs and p further equations, which are called the border.

    Parameters
    ----------
    derivatives : array, shape (rows, k, q, q + 2 + p)
        Derivatives of the legs.
    right : array, shape (rows, k, q, m)
        Right-hand sides of the equations of the legs.
    border : array, shape (rows, p, N)
        Coefficients of the border.
    border_right : array, shape (rows, p, m)
        Right-hand sides of the border.

    Returns
    -------
    array, shape (rows, N, m)
        Solutions. They are NaN if the matrix is singular.
    """
    rows, k, q, _ = derivatives.shape
    matrix = np.concatenate([dense(derivatives).reshape(rows, k * q, -1), border], axis=1)
    values = np.concatenate([right.reshape(rows, k * q, -1), border_right], axis=1)
    return solved_or_nan(matrix, values)
