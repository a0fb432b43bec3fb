r"""The paper's equations of the n-T orbits (Eqs. 21-27) as a continuation problem.

Of the paper's six unknowns, A and B follow from the start of contact
(Eqs. 21-22) and z′_b from the periodicity (Eq. 27), all linearly. The other
unknowns, ``(φ, z′_i, ϖ τ_b)``, solve the three remaining equations: release (Eq. 23), the
velocity at release (Eq. 24) and landing (Eq. 25). The duration is measured in units of
1/ϖ, because it is then of order one. The continuation parameter is Λ.
"""

from dataclasses import dataclass

import numpy as np

from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit
from bouncing_ball.orbits.system import OrbitSystem


@dataclass(frozen=True)
class SpringDamperSystem(OrbitSystem):
    """The equations of n-T orbits as a :class:`~bouncing_ball.continuation.problem.Problem`.

    Parameters
    ----------
    n : int
        Index of the family. The index and the contact may be arrays along the leading axis of y,
        to solve many systems at the same time.
    contact : SpringDamper
        ϖ, ζ and the release rule.
    """

    n: int | np.ndarray
    contact: SpringDamper

    def orbit(self, y: np.ndarray) -> SpringDamperOrbit:
        """The orbits at points y = (φ, z′_i, ϖ τ_b, Λ), shape (..., 4)."""
        phase, impact, angle, lam = np.moveaxis(y, -1, 0)
        duration = angle / self.contact.frequency_ratio
        return SpringDamperOrbit(self.n, self.contact, lam, phase, duration, impact)

    def point(self, orbit: SpringDamperOrbit) -> np.ndarray:
        """y = (φ, z′_i, ϖ τ_b, Λ) of orbits, shape (..., 4)."""
        entries = orbit.phase, orbit.impact_velocity, orbit.contact_duration * orbit.clock
        return np.stack(np.broadcast_arrays(*entries, orbit.amplitude), axis=-1)

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """Exact Jacobian of the residual, shape (..., 3, 4)."""
        o = self.orbit(y)
        omega, flow = o.law.frequency_ratio, o.contact_flow(o.contact_duration)
        # Derivatives of (τ, δ, δ′, φ, Λ) of the flow with respect to (φ, z′_i, ϖ τ_b, Λ).
        inner = np.zeros((*y.shape[:-1], 5, 4))
        inner[..., 0, 2] = 1 / omega
        inner[..., 2, 0], inner[..., 2, 1] = o.amplitude * np.sin(o.phase), 1
        inner[..., 2, 3] = -np.cos(o.phase)
        inner[..., 3, 0] = inner[..., 4, 3] = 1
        d_duration, _, _, d_phase, d_lam = np.moveaxis(inner, -2, 0)
        ends = np.moveaxis(flow.jacobian @ inner, -2, 0)
        scale, sine = (np.asarray(x)[..., np.newaxis] for x in (omega, o.law.release_sine))
        release = scale * ends[0] + 2 * sine * ends[1]
        start = d_phase, np.eye(4)[1], d_lam
        return np.stack([release, *o.flight_jacobian(start, [d_duration, *ends])], axis=-2)
