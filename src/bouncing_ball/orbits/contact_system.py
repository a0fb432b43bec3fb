r"""The paper's equations of the n-T orbits (Eqs. 21-27) for a continuation.

Of the paper's six unknowns, A and B follow from the start of contact
(Eqs. 21-22) and z′_b from the periodicity (Eq. 27), all linearly. The rest,
``(φ, z′_i, ϖ τ_b)``, solves the three equations left: release (Eq. 23), the
velocity at release (Eq. 24) and landing (Eq. 25). The duration is counted in
the contact's own time, which keeps it of order one.

The continuation parameter is Λ, or ln ϖ at a fixed Λ.
"""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from bouncing_ball.continuation.events import Event
from bouncing_ball.impacts.damping import restitution_coefficient
from bouncing_ball.impacts.spring_damper import Contact, Release, contact_flow
from bouncing_ball.orbits import restitution_orbit as restitution_orbits
from bouncing_ball.orbits.closed_form import free_release_angle
from bouncing_ball.orbits.contact_orbit import ContactOrbit
from bouncing_ball.orbits.monodromy import monodromy
from bouncing_ball.orbits.stability import (
    period_doubling_function,
    saddle_node_function,
    trace_and_determinant,
)

# Impact velocity and flight time vanish together where an orbit merges with
# permanent contact. The equations are singular there, and rounding enters
# divided by both: stop where 1e-12 is left.
_MARGIN = 1e-4


class Parameter(StrEnum):
    """Continuation parameter, the last entry of y."""

    AMPLITUDE = "amplitude"
    LOG_FREQUENCY_RATIO = "log_frequency_ratio"


@dataclass(frozen=True)
class OrbitSystem:
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

    def orbit(self, y: np.ndarray) -> ContactOrbit:
        """The orbits at points y of shape (..., 4)."""
        phase, impact, angle, p = (y[..., k] for k in range(4))
        fixed = np.broadcast_to(np.asarray(self.fixed, dtype=float), p.shape)
        zeta = np.broadcast_to(np.asarray(self.damping_ratio, dtype=float), p.shape)
        if self.parameter is Parameter.AMPLITUDE:
            amplitude, omega = p, fixed
        else:
            amplitude, omega = fixed, np.exp(p)
        contact = Contact(omega, zeta, self.release)
        return ContactOrbit(self.n, contact, amplitude, phase, angle / omega, impact)

    def _flow(self, orbit: ContactOrbit):
        return contact_flow(
            orbit.duration,
            0.0,
            orbit.relative_impact_velocity,
            orbit.phase,
            orbit.amplitude,
            orbit.contact.frequency_ratio,
            orbit.contact.damping_ratio,
        )

    def _release(self, omega, displacement, velocity):
        if self.release is Release.FORCE:
            return omega * displacement + 2 * self.damping_ratio * velocity
        return omega * displacement

    def residual(self, y: np.ndarray) -> np.ndarray:
        """Release, velocity and landing defects, shape (..., 3)."""
        o = self.orbit(y)
        flow = self._flow(o)
        lam, end, flight = o.amplitude, o.phase + o.duration, o.flight_time
        return np.stack(
            [
                self._release(o.contact.frequency_ratio, flow.displacement, flow.velocity),
                flow.velocity + lam * np.cos(end) - o.bounce_velocity,
                flow.displacement
                + lam * (np.sin(end) - np.sin(o.phase))
                + (o.bounce_velocity - flight / 2) * flight,
            ],
            axis=-1,
        )

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """Exact Jacobian of the residual, shape (..., 3, 4)."""
        o = self.orbit(y)
        flow = self._flow(o)
        lam, omega, end = o.amplitude, o.contact.frequency_ratio, o.phase + o.duration
        by_amplitude = self.parameter is Parameter.AMPLITUDE
        zero, one = np.zeros_like(lam), np.ones_like(lam)

        # Derivatives with respect to (φ, z′_i, ϖ τ_b, p), along the last axis.
        def row(*entries):
            return np.stack(entries, axis=-1)

        d_time = row(zero, zero, 1 / omega, zero if by_amplitude else -o.duration)
        d_lam = row(zero, zero, zero, one if by_amplitude else zero)
        d_omega = row(zero, zero, zero, zero if by_amplitude else omega)
        d_phase = row(one, zero, zero, zero)
        d_impact = row(zero, one, zero, zero)

        def scaled(factor, vector):
            return factor[..., np.newaxis] * vector

        d_relative = (
            d_impact - scaled(np.cos(o.phase), d_lam) + scaled(lam * np.sin(o.phase), d_phase)
        )

        def chain(k):
            j = flow.jacobian[..., k, :]
            return (
                scaled(j[..., 0], d_time)
                + scaled(j[..., 2], d_relative)
                + scaled(j[..., 3], d_phase)
                + scaled(j[..., 4], d_lam)
                + scaled(j[..., 5], d_omega)
            )

        d_displacement, d_velocity = chain(0), chain(1)
        d_end, d_flight = d_phase + d_time, -d_time
        d_bounce = d_impact + d_flight
        release = scaled(omega, d_displacement) + scaled(flow.displacement, d_omega)
        if self.release is Release.FORCE:
            release = release + scaled(2 * o.contact.damping_ratio, d_velocity)
        velocity = (
            d_velocity + scaled(np.cos(end), d_lam) - scaled(lam * np.sin(end), d_end) - d_bounce
        )
        landing = (
            d_displacement
            + scaled(np.sin(end) - np.sin(o.phase), d_lam)
            + scaled(lam * np.cos(end), d_end)
            - scaled(lam * np.cos(o.phase), d_phase)
            + scaled(o.flight_time, d_bounce)
            + scaled(o.bounce_velocity - o.flight_time, d_flight)
        )
        return np.stack([release, velocity, landing], axis=-2)

    def guess(self, amplitude: float, frequency_ratio: float) -> np.ndarray:
        """The stable restitution orbit with a free contact: y to start from.

        Close to a solution for ϖ ≫ 1 only.
        """
        zeta = self.damping_ratio
        r = float(restitution_coefficient(zeta, self.release))
        phase = float(restitution_orbits.phase(self.n, r, amplitude))
        contact = Contact(frequency_ratio, zeta, self.release)
        angle = float(free_release_angle(contact)) / np.sqrt((1 - zeta) * (1 + zeta))
        p = amplitude if self.parameter is Parameter.AMPLITUDE else np.log(frequency_ratio)
        return np.array([phase, -self.n * np.pi, angle, p])

    def _stability(self, test: Callable) -> Callable[[np.ndarray], np.ndarray]:
        return lambda y: test(*trace_and_determinant(monodromy(self.orbit(y))))

    def events(self) -> tuple[Event, ...]:
        """Bifurcations, and the ends of the domain in which an orbit makes sense."""
        return (
            Event("saddle-node", self._stability(saddle_node_function)),
            Event("period doubling", self._stability(period_doubling_function)),
            Event(
                "contact lost",
                lambda y: -self.orbit(y).relative_impact_velocity - _MARGIN,
                terminal=True,
                reason="contact lost: the ball no longer closes in on the table at impact",
            ),
            Event(
                "release lost",
                lambda y: self.orbit(y).relative_bounce_velocity,
                terminal=True,
                reason="release lost: the ball no longer leaves the table as the contact ends",
            ),
            Event(
                "flight lost",
                lambda y: self.orbit(y).flight_time - _MARGIN,
                terminal=True,
                reason="flight lost: the contact fills the whole cycle",
            ),
        )
