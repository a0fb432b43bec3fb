r"""The paper's equations of the n-T orbits (Eqs. 21-27) for a continuation.

Of the paper's six unknowns, A and B follow from the start of contact
(Eqs. 21-22) and z′_b from the periodicity (Eq. 27), all linearly. The rest,
``(φ, z′_i, ϖ τ_b)``, solves the three equations left: release (Eq. 23), the
velocity at release (Eq. 24) and landing (Eq. 25). The duration is counted in
the contact's own time, which keeps it of order one.

The continuation parameter is Λ, or ln ϖ at a fixed Λ.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.continuation.events import Event
from bouncing_ball.orbits import restitution_orbit as restitution_orbits
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit
from bouncing_ball.orbits.system import OrbitSystem


class Parameter(StrEnum):
    """Continuation parameter, the last entry of y."""

    AMPLITUDE = "amplitude"
    LOG_FREQUENCY_RATIO = "log_frequency_ratio"


@dataclass(frozen=True)
class SpringDamperSystem(OrbitSystem):
    """n-T orbits as a :class:`~bouncing_ball.continuation.problem.Problem`.

    Parameters
    ----------
    n : int
        Index of the family. It, ζ and the fixed parameter may be arrays along
        the leading axis of y, to solve for many systems at once.
    damping_ratio : float
        ζ.
    parameter : Parameter
        What the last entry of y = (φ, z′_i, ϖ τ_b, p) is.
    fixed : float
        The other of (Λ, ϖ), held constant.
    release : Release
        What ends the contact.
    """

    n: int | np.ndarray
    damping_ratio: float | np.ndarray
    parameter: Parameter
    fixed: float | np.ndarray
    release: Release = Release.DISPLACEMENT

    def orbit(self, y: np.ndarray) -> SpringDamperOrbit:
        """The orbits at points y of shape (..., 4)."""
        phase, impact, angle, p = np.moveaxis(y, -1, 0)
        # Where there is no orbit p is NaN, and the contact is a contact all the same.
        fixed, zeta = (np.broadcast_to(x, p.shape) for x in (self.fixed, self.damping_ratio))
        by_amplitude = self.parameter is Parameter.AMPLITUDE
        amplitude, omega = (p, fixed) if by_amplitude else (fixed, np.exp(p))
        contact = SpringDamper(omega, zeta, self.release)
        return SpringDamperOrbit(self.n, contact, amplitude, phase, angle / omega, impact)

    def coordinates(self, orbit: SpringDamperOrbit) -> tuple[np.ndarray, ...]:
        """(φ, z′_i, ϖ τ_b, p)."""
        omega = np.asarray(orbit.contact.frequency_ratio)
        by_amplitude = self.parameter is Parameter.AMPLITUDE
        parameter = orbit.amplitude if by_amplitude else np.log(omega)
        return orbit.phase, orbit.impact_velocity, omega * orbit.contact_duration, parameter

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """Exact Jacobian of the residual, shape (..., 3, 4)."""
        o, by_amplitude = self.orbit(y), self.parameter is Parameter.AMPLITUDE
        lam, omega = o.amplitude, o.contact.frequency_ratio
        flow = o.contact_flow(o.contact_duration)
        # Derivatives of (τ, δ, δ′, φ, Λ, ϖ) of the flow with respect to (φ, z′_i, ϖ τ_b, p).
        inner = np.zeros((*y.shape[:-1], 6, 4))
        inner[..., 0, 2] = 1 / omega
        inner[..., 2, 0], inner[..., 2, 1] = lam * np.sin(o.phase), 1
        inner[..., 3, 0] = 1
        if by_amplitude:
            inner[..., 2, 3], inner[..., 4, 3] = -np.cos(o.phase), 1
        else:
            inner[..., 0, 3], inner[..., 5, 3] = -o.contact_duration, omega
        d_duration, _, _, d_phase, d_lam, d_omega = np.moveaxis(inner, -2, 0)
        ends = np.moveaxis(flow.jacobian[..., :6] @ inner, -2, 0)
        scale, sine, displacement = (
            np.asarray(x)[..., np.newaxis]
            for x in (omega, o.contact.release_sine, flow.displacement)
        )
        release = scale * ends[0] + displacement * d_omega + 2 * sine * ends[1]
        start = d_phase, np.eye(4)[1], d_lam
        return np.stack([release, *o.flight_jacobian(start, [d_duration, *ends])], axis=-2)

    def guess(self, amplitude: float, frequency_ratio: float) -> np.ndarray:
        """The stable restitution orbit with a free contact: y to start from.

        Close to a solution for ϖ ≫ 1 only.
        """
        contact = SpringDamper(frequency_ratio, self.damping_ratio, self.release)
        r = float(contact.restitution)
        phase = float(restitution_orbits.phase(self.n, r, amplitude))
        angle = float(contact.free_duration * contact.frequency_ratio)
        p = amplitude if self.parameter is Parameter.AMPLITUDE else np.log(frequency_ratio)
        return np.array([phase, -self.n * np.pi, angle, p])

    def events(self) -> tuple[Event, ...]:
        """Those of every contact, and the loss of a release that leaves the table."""
        *bifurcations, contact, flight = super().events()
        release = Event(
            "release lost",
            lambda y: self.orbit(y).relative_bounce_velocity,
            terminal=True,
            reason="release lost: the ball no longer leaves the table as the contact ends",
        )
        return *bifurcations, contact, release, flight
