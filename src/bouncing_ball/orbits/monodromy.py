r"""Linearised return map of the spring-damper model.

The section is the start of contact, δ = 0; a state on it is (τ, u), the
table's phase and the relative impact velocity. One cycle is contact then
flight; both end at an implicit event, whose time is differentiated through
the event's condition. The flow in contact contracts (τ, δ, δ′) volume by
e^{-2ζϖ s} and the flight preserves it, so that on an n-T orbit
``det = exp(-2ζϖ τ_b)`` exactly, for both release rules.
"""

import numpy as np

from bouncing_ball.impacts.spring_damper import Release, contact_flow
from bouncing_ball.orbits.contact_orbit import ContactOrbit
from bouncing_ball.orbits.stability import trace_and_determinant


def monodromy(orbit: ContactOrbit) -> np.ndarray:
    """Jacobian of (τ, u) → (τ₁, u₁) at n-T orbits, shape (..., 2, 2).

    Returns
    -------
    numpy.ndarray
        Its eigenvalues are the Floquet multipliers. Dimensionless.
    """
    contact, lam = orbit.contact, np.asarray(orbit.amplitude)
    omega, zeta = np.asarray(contact.frequency_ratio), np.asarray(contact.damping_ratio)
    u = orbit.relative_impact_velocity
    flow = contact_flow(orbit.duration, 0.0, u, orbit.phase, lam, omega, zeta)
    by_time, by_velocity, by_phase = (flow.jacobian[..., :, k] for k in (0, 2, 3))

    def released(rows):
        if contact.release is Release.FORCE:
            return 2 * zeta * rows[..., 1] + omega * rows[..., 0]
        return rows[..., 0]

    # d(contact time), as a row over (dτ, du).
    d_duration = np.stack(
        [-released(by_phase) / released(by_time), -released(by_velocity) / released(by_time)],
        axis=-1,
    )
    d_state = np.stack([by_phase, by_velocity], axis=-1)  # (..., [δ, δ′], [τ, u])
    d_state = d_state + by_time[..., :, np.newaxis] * d_duration[..., np.newaxis, :]

    start = np.broadcast_to(np.array([1.0, 0.0]), d_duration.shape)
    d_release_phase = start + d_duration
    release_phase = orbit.phase + orbit.duration
    landing_phase = orbit.phase + 2 * np.pi * np.asarray(orbit.n)

    def table(x):
        return np.asarray(x)[..., np.newaxis]

    d_height = d_state[..., 0, :] + table(lam * np.cos(release_phase)) * d_release_phase
    d_bounce = d_state[..., 1, :] - table(lam * np.sin(release_phase)) * d_release_phase
    # The flight ends on the table: z_b + z′_b T - T²/2 = Λ sin(τ_b + T).
    table_velocity = table(lam * np.cos(landing_phase))
    d_gap = d_height + table(orbit.flight_time) * d_bounce - table_velocity * d_release_phase
    d_flight = -d_gap / table(u)
    d_landing_phase = d_release_phase + d_flight
    d_impact = d_bounce - d_flight + table(lam * np.sin(landing_phase)) * d_landing_phase
    return np.stack([d_landing_phase, d_impact], axis=-2)


def trace_and_contraction(orbit: ContactOrbit) -> tuple[np.ndarray, np.ndarray]:
    """Trace of the monodromy and its exact determinant, exp(-2ζϖ τ_b).

    The determinant of the matrix itself carries the rounding of its entries,
    which at ζ = 0 would decide between stable and not.

    Examples
    --------
    >>> from bouncing_ball.impacts.spring_damper import Contact
    >>> from bouncing_ball.orbits.limits import orbit_at
    >>> float(trace_and_contraction(orbit_at(Contact(5.0, 0.0), 1, 0.5))[1])
    1.0
    """
    loss = np.asarray(orbit.contact.damping_ratio) * orbit.contact.frequency_ratio
    return trace_and_determinant(monodromy(orbit))[0], np.exp(-2 * loss * orbit.duration)
