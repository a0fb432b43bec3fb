r"""The restitution model, corrected: an impact is an instant in the right place.

From the start of contact, at table phase φ and relative velocity δ′ = -v, the
flight is continued for the delay t_c of the contact law's signature. There, at
the phase ψ = φ + t_c and below the table's level, the ball has the velocity p
relative to nothing but the ground, and the impact turns ``v_c = Λ cos ψ - p``
into ``r_c v_c = r v_c + σ a`` with the load ``a = 1 - Λ sin ψ``::

    p = δ′ + Λ cos φ - t_c
    z = Λ sin φ + p t_c + t_c²/2
    w = Λ cos ψ + r v_c + σ a

The flight from (ψ, z, w) ends at the next start of contact, and its part up to
φ + D stands for the rest of the contact. The map from start to start is that
of the restitution model for t_c = σ = 0. Nothing else is approximated: t_c, r
and σ stand for the contact to second order in its duration
(:mod:`bouncing_ball.impacts.signature`).

All quantities are dimensionless; all functions broadcast.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.impacts.signature import Instant, Signature


class Throw(NamedTuple):
    """The impact of a start of contact: where it is, and what it does.

    ``phase`` is ψ, ``height`` and ``velocity`` the ball's absolute z and w just
    after; ``speed`` is v_c, ``arrival`` the absolute velocity p before.
    ``start`` and ``instant`` are the signatures that were used: at the start of
    contact (t_c, D) and at the instant (r, σ).
    """

    phase: np.ndarray
    height: np.ndarray
    velocity: np.ndarray
    speed: np.ndarray
    arrival: np.ndarray
    start: Instant
    instant: Instant


def throw(
    signature: Signature, amplitude: ArrayLike, phase: ArrayLike, relative_velocity: ArrayLike
) -> Throw:
    """From the start of contact (φ, δ′ < 0) to just after the impact.

    Examples
    --------
    On a table at rest an elastic ball returns with the speed that it has when
    the impact comes, a little below the table:

    >>> from bouncing_ball.impacts.signature import LinearSignature
    >>> from bouncing_ball.impacts.spring_damper import Contact
    >>> impact = throw(LinearSignature(Contact(np.pi, 0.0)), 0.0, 0.0, -2.0)
    >>> float(impact.velocity), float(impact.height)
    (2.5, -1.125)
    """
    lam, phi, u = (np.asarray(x, dtype=float) for x in (amplitude, phase, relative_velocity))
    start = signature(-u)
    delay = start.delay
    psi = phi + delay
    # Differences over the short delay as products, which lose no digits.
    half, middle = np.sin(delay / 2), phi + delay / 2
    slowed = 2 * lam * np.sin(middle) * half  # Λ (cos φ - cos ψ)
    speed = delay - u - slowed
    arrival = u + lam * np.cos(phi) - delay
    height = lam * np.sin(phi) + (arrival + delay / 2) * delay
    instant = signature(speed)
    load = 1 - lam * np.sin(psi)
    after = lam * np.cos(psi) + instant.restitution * speed + instant.load * load
    return Throw(psi, height, after, speed, arrival, start, instant)


def cycle_jacobian(
    signature: Signature,
    amplitude: ArrayLike,
    phase: ArrayLike,
    relative_velocity: ArrayLike,
    landing: ArrayLike,
) -> np.ndarray:
    """Jacobian of the map (φ, δ′) → (φ₁, δ′₁), shape (..., 2, 2).

    Parameters
    ----------
    signature : Signature
    amplitude, phase, relative_velocity : array_like
        Λ and the start of contact.
    landing : array_like
        Time from the start of contact to the next one.
    """
    lam, phi, u, total = np.broadcast_arrays(
        *(np.asarray(x, dtype=float) for x in (amplitude, phase, relative_velocity, landing))
    )
    impact = throw(signature, lam, phi, u)
    delay, end = impact.start.delay, phi + total
    flight = total - delay
    x, y = lam * np.cos(impact.phase), lam * np.sin(impact.phase)
    by_speed = (
        impact.instant.restitution
        + impact.instant.d_restitution * impact.speed
        + impact.instant.d_load * (1 - y)
    )
    next_velocity = impact.velocity - flight - lam * np.cos(end)
    jacobian = np.empty((*phi.shape, 2, 2))
    for column, (d_phase, d_u) in enumerate(((1.0, 0.0), (0.0, 1.0))):
        d_delay = -impact.start.d_delay * d_u
        d_psi = d_phase + d_delay
        d_arrival = d_u - lam * np.sin(phi) * d_phase - d_delay
        d_height = lam * np.cos(phi) * d_phase + delay * d_arrival
        d_height = d_height + (impact.arrival + delay) * d_delay
        d_speed = -y * d_psi - d_arrival
        d_after = by_speed * d_speed - (y + impact.instant.load * x) * d_psi
        # Landing: z + w T - T²/2 = Λ sin(ψ + T).
        sinking = lam * np.cos(end) * d_psi - d_height - flight * d_after
        d_flight = sinking / next_velocity
        jacobian[..., 0, column] = d_psi + d_flight
        moved = lam * np.sin(end) * (d_psi + d_flight)
        jacobian[..., 1, column] = d_after - d_flight + moved
    return jacobian
