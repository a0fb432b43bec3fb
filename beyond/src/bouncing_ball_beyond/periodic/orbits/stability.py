"""The monodromy of an orbit, and the linear stability that follows from its multipliers.

An orbit is stable while its Floquet multipliers lie inside the unit circle. It loses stability at a
saddle-node, where a multiplier is +1 and ``1 - tr + det = 0``, or at a period doubling, where a
multiplier is -1 and ``1 + tr + det = 0``.

The monodromy is the product M = M_k … M_1 of the matrices of the legs. Jacobi's formula gives
``d det(M - μ) = tr(adj(M - μ) dM)``. The trace does not change if its factors are rotated, so that
a change dM_i of one leg contributes ``tr(W_i dM_i)`` with
``W_i = (M_{i-1} … M_1) adj(M - μ) (M_k … M_{i+1})``.
"""

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation
from bouncing_ball_beyond.models.deviations import Jacobian

# The determinant of a contact that does not dissipate differs from 1 by rounding errors of its
# parameters at most.
_ROUNDING = 8 * np.finfo(float).eps


def multipliers(trace: ArrayLike, determinant: ArrayLike) -> np.ndarray:
    """Floquet multipliers, complex, shape (..., 2); that of larger modulus comes first.

    The second multiplier is the determinant divided by the first. It thus keeps its digits where
    the two multipliers differ by orders of magnitude.

    Examples
    --------
    >>> multipliers(3.0, 2.0).tolist()
    [(2+0j), (1+0j)]
    """
    trace, det = np.broadcast_arrays(np.asarray(trace, float), np.asarray(determinant, float))
    half = trace / 2
    root = np.sqrt(half * half - det + 0j)
    first = half + np.where(half < 0, -1, 1) * root
    zero = first == 0
    with np.errstate(invalid="ignore"):  # where there is no orbit
        second = np.where(zero, 0, det / np.where(zero, 1, first))
    return np.stack([first, second], axis=-1)


def multiplier_at(kind: Bifurcation) -> float:
    """The Floquet multiplier at a bifurcation, +1 or -1."""
    return 1.0 if kind is Bifurcation.SADDLE_NODE else -1.0


def is_stable(trace: ArrayLike, determinant: ArrayLike) -> np.ndarray:
    """Whether both multipliers lie inside the unit circle (Jury's conditions).

    These are ``|det| < 1`` and ``1 ∓ tr + det > 0``. A determinant that is 1 up to rounding, as
    that of a contact that does not dissipate, is not below 1.

    Examples
    --------
    >>> bool(is_stable(0.0, 0.5)), bool(is_stable(2.0, 0.5)), bool(is_stable(0.0, 1 - 1e-16))
    (True, False, False)
    """
    inside = np.abs(np.asarray(determinant)) < 1 - _ROUNDING
    return inside & np.all([kind.test(trace, determinant) > 0 for kind in Bifurcation], axis=0)


def is_neutral(trace: ArrayLike, determinant: ArrayLike) -> np.ndarray:
    """Whether both multipliers lie on the unit circle and are no ±1, up to rounding.

    Neighbours neither approach the orbit nor leave it in the linear approximation, as without
    dissipation.

    Examples
    --------
    >>> bool(is_neutral(0.5, 1.0)), bool(is_neutral(-2.8, 1.0)), bool(is_neutral(0.5, 0.9))
    (True, False, False)
    """
    on_circle = np.abs(np.asarray(determinant) - 1) <= _ROUNDING
    return on_circle & np.all([kind.test(trace, determinant) > 0 for kind in Bifurcation], axis=0)


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
