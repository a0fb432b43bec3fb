r"""Restitution-coefficient model: the impact map.

State just after an impact: phase τ of the table, absolute velocity v of the
ball. The ball flies for a time s and lands when ::

    Λ (sin(τ + s) - sin τ) = s v - s²/2
    v₁ = -r (v - s) + (1 + r) Λ cos(τ + s)                       (Eq. 5)

Holmes' high-bounce map neglects the table's displacement in the flight time,
s = 2v; only its period doubling is needed, see
:mod:`bouncing_ball.orbits.restitution_orbit`.

All quantities are dimensionless.
"""

import numpy as np
from numpy.typing import ArrayLike


def landing_gap(
    flight_time: ArrayLike, phase: ArrayLike, velocity: ArrayLike, amplitude: ArrayLike
) -> np.ndarray:
    """Height of the ball over the table after a flight time s.

    ``s v - s²/2 - Λ (sin(τ + s) - sin τ)``; the exact map lands at its first
    positive zero (Eq. 5, first line).
    """
    s, tau = np.asarray(flight_time, dtype=float), np.asarray(phase, dtype=float)
    # sin(τ+s) - sin τ = 2 cos(τ + s/2) sin(s/2): exact for short flights.
    rise = 2 * np.cos(tau + s / 2) * np.sin(s / 2)
    return s * np.asarray(velocity) - s * s / 2 - np.asarray(amplitude) * rise


def bounce(
    flight_time: ArrayLike,
    phase: ArrayLike,
    velocity: ArrayLike,
    amplitude: ArrayLike,
    restitution: ArrayLike,
) -> np.ndarray:
    """Velocity just after the impact that ends a flight (Eq. 5, second line).

    Examples
    --------
    A ball thrown up at 3 on a table at rest comes back after s = 6:

    >>> float(bounce(6.0, 0.0, 3.0, 0.0, 0.5))
    1.5
    """
    s, r = np.asarray(flight_time, dtype=float), np.asarray(restitution, dtype=float)
    table = np.asarray(amplitude) * np.cos(np.asarray(phase) + s)
    return -r * (np.asarray(velocity) - s) + (1 + r) * table


def exact_map_jacobian(
    flight_time: ArrayLike,
    phase: ArrayLike,
    velocity: ArrayLike,
    amplitude: ArrayLike,
    restitution: ArrayLike,
) -> np.ndarray:
    """Jacobian of the exact map (τ, v) → (τ₁, v₁) (Eq. 5), shape (..., 2, 2).

    ``flight_time`` must solve the landing condition. Differentiating it,
    ``ds = -(∂gap/∂τ dτ + s dv)/(v - s - Λ cos τ₁)``. The determinant is
    ``r² (v - Λ cos τ)/(v₁ - Λ cos τ₁)`` in these coordinates.
    """
    s, tau, v, lam, r = np.broadcast_arrays(
        *(np.asarray(x, float) for x in (flight_time, phase, velocity, amplitude, restitution))
    )
    landing = tau + s
    closing = v - s - lam * np.cos(landing)
    s_tau = lam * (np.cos(landing) - np.cos(tau)) / closing
    s_v = -s / closing
    # v₁ depends on s through the gravity term and the table's phase.
    v_s = r - (1 + r) * lam * np.sin(landing)
    jacobian = np.empty((*s.shape, 2, 2))
    jacobian[..., 0, 0] = 1 + s_tau
    jacobian[..., 0, 1] = s_v
    jacobian[..., 1, 0] = v_s * s_tau - (1 + r) * lam * np.sin(landing)
    jacobian[..., 1, 1] = v_s * s_v - r
    return jacobian
