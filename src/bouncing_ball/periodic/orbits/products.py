"""The monodromy of an orbit as a product of the matrices of its legs, and the change of a product.

With M = M_k … M_1, Jacobi's formula gives ``d det(M - μ) = tr(adj(M - μ) dM)``. The trace does not
change if its factors are rotated, so that a change dM_i of one leg contributes ``tr(W_i dM_i)``
with ``W_i = (M_{i-1} … M_1) adj(M - μ) (M_k … M_{i+1})``.
"""

import numpy as np

from bouncing_ball.models.deviations import Jacobian


def matrices_of(tangent: Jacobian) -> np.ndarray:
    """The matrices of the legs, shape (..., k, 2, 2)."""
    rows = np.stack(tangent, axis=-1)
    return rows.reshape(*rows.shape[:-1], 2, 2)


def product_of(matrices: np.ndarray) -> np.ndarray:
    """M_k … M_1 from matrices of shape (..., k, 2, 2)."""
    product = matrices[..., 0, :, :]
    for i in range(1, matrices.shape[-3]):
        product = matrices[..., i, :, :] @ product
    return product


def shifted_determinant(matrices: np.ndarray, multiplier: float) -> tuple[np.ndarray, np.ndarray]:
    """det(M - μ), and the weights W_i of the changes of the legs, shape (..., k, 2, 2)."""
    off = product_of(matrices) - multiplier * np.eye(2)
    value = off[..., 0, 0] * off[..., 1, 1] - off[..., 0, 1] * off[..., 1, 0]
    return value, _weights(matrices, _adjugate(off))


def _adjugate(m: np.ndarray) -> np.ndarray:
    """adj m of matrices of shape (..., 2, 2)."""
    rows = [[m[..., 1, 1], -m[..., 0, 1]], [-m[..., 1, 0], m[..., 0, 0]]]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def _weights(matrices: np.ndarray, adjugate: np.ndarray) -> np.ndarray:
    """W_i = (M_{i-1} … M_1) adj (M_k … M_{i+1}), shape (..., k, 2, 2)."""
    count = matrices.shape[-3]
    before = [np.broadcast_to(np.eye(2), matrices[..., 0, :, :].shape)]
    after = [before[0]]
    for i in range(count - 1):
        before.append(matrices[..., i, :, :] @ before[-1])
        after.append(after[-1] @ matrices[..., count - 1 - i, :, :])
    found = [before[i] @ adjugate @ after[count - 1 - i] for i in range(count)]
    return np.stack(found, axis=-3)
