"""An n-T orbit of the spring-damper model and what is read from it.

Time runs from the start of contact, τ_i = 0; the contact ends at τ_b = D, the
next one starts at τ_2 = 2πn. All quantities are dimensionless.
"""

from dataclasses import dataclass

import numpy as np

from bouncing_ball.impacts.spring_damper import Contact, Release, contact_flow
from bouncing_ball.orbits.closed_form import BranchPoint

# Samples of a contact among which its highest point is looked for, and Newton
# steps from there.
_CONTACT_SAMPLES = 33
_REFINEMENTS = 4


@dataclass(frozen=True)
class ContactOrbit:
    """n-T orbits, one per element of the (broadcast) arrays.

    Parameters
    ----------
    n : int or array of int
        Index of the family.
    contact : Contact
        ϖ, ζ and the release rule.
    amplitude, phase : array
        Λ and the table's phase φ at the start of contact.
    duration : array
        Contact duration τ_b.
    impact_velocity : array
        Absolute velocity z′_i of the ball at the start of contact.
    """

    n: int | np.ndarray
    contact: Contact
    amplitude: np.ndarray
    phase: np.ndarray
    duration: np.ndarray
    impact_velocity: np.ndarray

    @classmethod
    def from_branch(cls, point: BranchPoint, contact: Contact, n: int) -> "ContactOrbit":
        """The orbit at a point of the closed-form branch."""
        return cls(n, contact, point.amplitude, point.phase, point.duration, point.u + point.x)

    @property
    def flight_time(self) -> np.ndarray:
        """τ_2 - τ_b (Eq. 19)."""
        return 2 * np.pi * np.asarray(self.n) - self.duration

    @property
    def bounce_velocity(self) -> np.ndarray:
        """Absolute velocity z′_b at release, z′_i + 2πn - τ_b (Eq. 27)."""
        return self.impact_velocity + self.flight_time

    @property
    def relative_impact_velocity(self) -> np.ndarray:
        """z′_i - w′_i."""
        return self.impact_velocity - self.amplitude * np.cos(self.phase)

    @property
    def relative_bounce_velocity(self) -> np.ndarray:
        """z′_b - w′_b."""
        return self.bounce_velocity - self.amplitude * np.cos(self.phase + self.duration)

    @property
    def apparent_restitution(self) -> np.ndarray:
        """r_a = -(z′_b - w′_b)/(z′_i - w′_i) (Eq. 17)."""
        return -self.relative_bounce_velocity / self.relative_impact_velocity

    @property
    def release_displacement(self) -> np.ndarray:
        """δ_b at release: 0, or where the contact force vanishes -2ζδ′_b/ϖ."""
        if self.contact.release is Release.FORCE:
            lag = 2 * self.contact.damping_ratio / self.contact.frequency_ratio
            return -lag * self.relative_bounce_velocity
        return np.zeros_like(self.duration)

    @property
    def bounce_height(self) -> np.ndarray:
        """Absolute height z_b of the ball at release.

        From the flight, which ends at the table's level Λ sin φ.
        """
        landing = self.amplitude * np.sin(self.phase)
        mean_velocity = (self.bounce_velocity + self.impact_velocity) / 2
        return landing - mean_velocity * self.flight_time

    @property
    def flight_top(self) -> np.ndarray:
        """Greatest height in flight: its top, or its start if released downwards."""
        rising = np.maximum(self.bounce_velocity, 0.0)
        return self.bounce_height + rising * rising / 2

    @property
    def max_height(self) -> np.ndarray:
        """Greatest absolute height over the cycle.

        In flight, if that reaches Λ: in contact the ball stays below the table.
        Else a long contact may lift it higher with the table; its highest
        sample is then refined by Newton's method on the velocity.
        """
        top = self.flight_top
        if not np.any(top < self.amplitude):
            return top
        share = np.linspace(0.0, 1.0, _CONTACT_SAMPLES)
        share = share.reshape(-1, *(1,) * np.ndim(self.duration))
        height, _ = self.contact_path(share * self.duration)
        highest = np.argmax(np.where(np.isnan(height), -np.inf, height), axis=0)
        step = self.duration / (_CONTACT_SAMPLES - 1)
        centre = highest * step
        low = np.maximum(centre - step, 0.0)
        high = np.minimum(centre + step, self.duration)
        time = centre
        for _ in range(_REFINEMENTS):
            _, velocity = self.contact_path(time)
            slope = self._contact_acceleration(time)
            moved = np.where(slope < 0, -velocity / np.where(slope < 0, slope, -1.0), 0.0)
            time = np.clip(time + moved, low, high)
        return np.maximum(top, self.contact_path(time)[0])

    def _contact_flow(self, time: np.ndarray):
        return contact_flow(
            time,
            0.0,
            self.relative_impact_velocity,
            self.phase,
            self.amplitude,
            self.contact.frequency_ratio,
            self.contact.damping_ratio,
        )

    def _contact_acceleration(self, time: np.ndarray) -> np.ndarray:
        table = self.amplitude * np.sin(self.phase + time)
        return self._contact_flow(time).acceleration - table

    def contact_path(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Absolute position and velocity at times 0 ≤ τ ≤ τ_b in contact."""
        flow = self._contact_flow(time)
        angle = self.phase + time
        return (
            flow.displacement + self.amplitude * np.sin(angle),
            flow.velocity + self.amplitude * np.cos(angle),
        )

    def flight_path(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Absolute position and velocity at times τ_b ≤ τ ≤ τ_2 in flight (Eqs. 14-15)."""
        s = time - self.duration
        velocity = self.bounce_velocity - s
        return self.bounce_height + (self.bounce_velocity + velocity) / 2 * s, velocity
