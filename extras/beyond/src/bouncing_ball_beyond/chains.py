"""Chains of legs: their matrices, and linear equations of them with a border."""

import numpy as np
from numpy.typing import NDArray

DENSE = 16
"""Systems of more legs are halved: libraries of linear algebra start threads for large matrices."""


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
    (rows, p, N) and its right sides (rows, p, m); solutions (rows, N, m), NaN if singular. The legs
    are eliminated by pairs (docs/orbits.md).
    """
    rows, k, q, columns = derivatives.shape
    m = right.shape[-1]
    if k <= DENSE:
        matrix = np.concatenate([dense(derivatives).reshape(rows, k * q, -1), border], axis=1)
        values = np.concatenate([right.reshape(rows, k * q, m), border_right], axis=1)
        return solved_or_nan(matrix, values)
    p = border.shape[1]
    pairs = k // 2
    legs = np.concatenate([derivatives, right], axis=-1)
    first = legs[:, 0 : 2 * pairs : 2]
    second = legs[:, 1 : 2 * pairs : 2]
    between = np.zeros((rows, pairs, 2 * q, q))
    between[:, :, :q, :2] = first[..., q : q + 2]
    between[:, :, q:] = second[..., :q]
    others = np.concatenate([first, second], axis=-2)
    others[:, :, :q, q : q + 2] = 0.0
    others[:, :, q:, :q] = 0.0
    orthogonal, triangle = np.linalg.qr(between, mode="complete")
    others = orthogonal.swapaxes(-1, -2) @ others
    eliminated = solved_or_nan(triangle[..., :q, :], others[..., :q, :])
    legs = np.concatenate([others[..., q:, :], legs[:, 2 * pairs :]], axis=1)
    # What the impacts between the pairs add to the border.
    blocks = border[..., : k * q].reshape(rows, p, k, q).swapaxes(1, 2)
    kept = blocks[:, ::2].copy()
    added = blocks[:, 1 : 2 * pairs : 2] @ eliminated
    after = np.arange(1, pairs + 1) % kept.shape[1]
    kept[:, :pairs] -= added[..., :q]
    kept[:, after, :, :2] -= added[..., q : q + 2]
    total = added.sum(axis=1)
    kept = kept.swapaxes(1, 2).reshape(rows, p, -1)
    outer = np.concatenate([kept, border[..., k * q :] - total[..., q + 2 : columns]], axis=-1)
    outer_right = border_right - total[..., columns:]
    solution = solve_bordered(legs[..., :columns], legs[..., columns:], outer, outer_right)
    states = solution[:, :-p].reshape(rows, -1, q, m)
    values = np.broadcast_to(solution[:, np.newaxis, -p:], (rows, pairs, p, m))
    around = np.concatenate([states[:, :pairs], states[:, after, :2], values], axis=2)
    whole = np.empty((rows, k, q, m))
    whole[:, ::2] = states
    whole[:, 1::2] = eliminated[..., columns:] - eliminated[..., :columns] @ around
    return np.concatenate([whole.reshape(rows, k * q, m), solution[:, -p:]], axis=1)
