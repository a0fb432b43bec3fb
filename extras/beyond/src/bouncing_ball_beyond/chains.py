"""Chains of legs: their matrices, and linear equations of them with a border."""

import numpy as np
from numpy.typing import NDArray


def product_of(maps: NDArray) -> NDArray:
    """The product of the maps of the legs, the last one at the left, shape (rows, 2, 2)."""
    while maps.shape[1] > 1:
        even = maps.shape[1] // 2 * 2
        pairs = maps[:, 1:even:2] @ maps[:, 0:even:2]
        maps = np.concatenate([pairs, maps[:, even:]], axis=1)
    return maps[:, 0]


def dense(derivatives: NDArray) -> NDArray:
    """The Jacobian (rows, k, q, N) from the derivatives of legs."""
    rows, k, q, columns = derivatives.shape
    matrix = np.zeros((rows, k, q, k * q + columns - q - 2))
    for i in range(k):
        after = (i + 1) % k * q
        matrix[:, i, :, i * q : (i + 1) * q] += derivatives[:, i, :, :q]
        matrix[:, i, :, after : after + 2] += derivatives[:, i, :, q : q + 2]
    matrix[..., k * q :] = derivatives[..., q + 2 :]
    return matrix


def solved_or_nan(matrix: NDArray, values: NDArray) -> NDArray:
    """Solutions of linear equations, NaN where a matrix is singular."""
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
    """Solve the linear equations of the legs together with p further ones, the border.

    Derivatives have the shape (rows, k, q, q + 2 + p), right sides (rows, k, q, m), the border
    (rows, p, N) and its right sides (rows, p, m); solutions (rows, N, m), NaN if singular.
    """
    rows, k, q, _ = derivatives.shape
    matrix = np.concatenate([dense(derivatives).reshape(rows, k * q, -1), border], axis=1)
    values = np.concatenate([right.reshape(rows, k * q, -1), border_right], axis=1)
    return solved_or_nan(matrix, values)
