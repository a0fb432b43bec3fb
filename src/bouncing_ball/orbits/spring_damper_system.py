r"""The paper's equations of the n-T orbits (Eqs. 21-27) as a continuation problem.

Of the paper's six unknowns, A and B follow from the start of contact
(Eqs. 21-22) and z′_b from the periodicity (Eq. 27), all linearly. The other
unknowns, ``(φ, z′_i, ϖ τ_b)``, solve the three remaining equations: release (Eq. 23), the
velocity at release (Eq. 24) and landing (Eq. 25). The duration is measured in units of
1/ϖ, because it is then of order one.

The continuation parameter is Λ, or ln ϖ at a fixed Λ.
"""

from dataclasses import dataclass, replace

import numpy as np

from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.orbits import restitution_orbit
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit
from bouncing_ball.orbits.system import OrbitSystem


@dataclass(frozen=True)
class SpringDamperSystem(OrbitSystem):
    """The equations of n-T orbits as a :class:`~bouncing_ball.continuation.problem.Problem`.

    Parameters
    ----------
    n : int
        Index of the family. The index, the contact and Λ may be arrays along the leading axis
        of y, to solve many systems at the same time.
    contact : SpringDamper
        ϖ, ζ and the release rule.
    amplitude : float, optional
        Λ, at which the orbits are followed along ln ϖ. By default the parameter is Λ.
    """

    n: int | np.ndarray
    contact: SpringDamper
    amplitude: float | np.ndarray | None = None

    def orbit(self, y: np.ndarray) -> SpringDamperOrbit:
        """The orbits at points y = (φ, z′_i, ϖ τ_b, p), shape (..., 4)."""
        phase, impact, angle, p = np.moveaxis(y, -1, 0)
        lam, contact = p, self.contact
        if self.amplitude is not None:
            lam = np.broadcast_to(self.amplitude, p.shape)
            contact = replace(contact, frequency_ratio=np.exp(p))
        duration = angle / contact.frequency_ratio
        return SpringDamperOrbit(self.n, contact, lam, phase, duration, impact)

    def point(self, orbit: SpringDamperOrbit) -> np.ndarray:
        """y = (φ, z′_i, ϖ τ_b, p) of orbits, shape (..., 4)."""
        omega = np.asarray(orbit.law.frequency_ratio)
        parameter = orbit.amplitude if self.amplitude is None else np.log(omega)
        angle = omega * orbit.contact_duration
        entries = np.broadcast_arrays(orbit.phase, orbit.impact_velocity, angle, parameter)
        return np.stack(entries, axis=-1)

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """Exact Jacobian of the residual, shape (..., 3, 4)."""
        o = self.orbit(y)
        omega, flow = o.law.frequency_ratio, o.contact_flow(o.contact_duration)
        # Derivatives of (τ, δ, δ′, φ, Λ, ϖ) of the flow with respect to
        # (φ, z′_i, ϖ τ_b, Λ, ln ϖ), where either Λ or ln ϖ is held fixed.
        inner = np.zeros((*y.shape[:-1], 6, 5))
        inner[..., 0, 2], inner[..., 0, 4] = 1 / omega, -o.contact_duration
        inner[..., 2, 0], inner[..., 2, 1] = o.amplitude * np.sin(o.phase), 1
        inner[..., 2, 3] = -np.cos(o.phase)
        inner[..., 3, 0] = inner[..., 4, 3] = 1
        inner[..., 5, 4] = omega
        inner = np.delete(inner, 4 if self.amplitude is None else 3, axis=-1)
        d_duration, _, _, d_phase, d_lam, d_omega = np.moveaxis(inner, -2, 0)
        ends = np.moveaxis(flow.jacobian[..., :6] @ inner, -2, 0)
        scale, sine, displacement = (
            np.asarray(x)[..., np.newaxis] for x in (omega, o.law.release_sine, flow.displacement)
        )
        release = scale * ends[0] + displacement * d_omega + 2 * sine * ends[1]
        start = d_phase, np.eye(4)[1], d_lam
        return np.stack([release, *o.flight_jacobian(start, [d_duration, *ends])], axis=-2)

    def guess(self, amplitude: float, frequency_ratio: float) -> np.ndarray:
        """The stable orbit of the restitution model, with the duration of a free contact, as a
        start y for Newton's method.

        It is close to a solution for ϖ ≫ 1 only.

        Raises
        ------
        NoOrbitError
            If Λ lies below the saddle-node of the restitution model.
        """
        contact = replace(self.contact, frequency_ratio=frequency_ratio)
        phase = restitution_orbit.phase(self.n, contact.restitution, amplitude)
        duration = contact.free_duration
        return self.point(SpringDamperOrbit.of(self.n, contact, amplitude, phase, duration))
