"""One n-T orbit of any model, or arrays of them: what follows from the flight alone.

Time runs from the start of contact, τ_i = 0; the contact ends at τ_b = D, the next one
starts at τ_2 = 2πn. Everything is dimensionless.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.batch import Batch, in_words
from bouncing_ball.errors import require
from bouncing_ball.motion.angles import reduce_angle
from bouncing_ball.motion.sequence import Cycle
from bouncing_ball.orbits import stability

OBSERVABLES = (
    "amplitude",
    "phase",
    "contact_duration",
    "impact_velocity",
    "bounce_velocity",
    "apparent_restitution",
    "max_height",
)
"""What is read from an orbit, by the names that datasets and the command line use."""

# An event that the equations do not know of shifts the next impact by a good
# part of a period; rounding, amplified by one unstable cycle, by far less.
_SAME = 1e-6


def check_index(n: ArrayLike) -> None:
    """Raise :class:`ModelError` unless the index of the family is a positive integer.

    Examples
    --------
    >>> check_index(1.5)
    Traceback (most recent call last):
    ...
    bouncing_ball.errors.ModelError: index of the family n = 1.5 is not a positive integer
    """
    index = np.asarray(n, dtype=float)
    whole = (index == np.floor(index)) & (index >= 1) & np.isfinite(index)
    require(whole, np.asarray(n), "index of the family n", "a positive integer")


@dataclass(frozen=True, repr=False)
class Orbit(Batch, ABC):
    """n-T orbits of one model, one per element of the (broadcast) arrays.

    Parameters
    ----------
    n : int or array of int
        Index of the family.
    law : Batch
        The law of the impact: what the model is made of.
    amplitude, phase : array
        Λ and the table's phase φ at the start of contact.
    contact_duration : array
        τ_b, 0 for an instantaneous impact. NaN where there is no orbit.
    impact_velocity : array
        Absolute velocity z′_i of the ball at the start of contact.
    """

    n: Any
    law: Any
    amplitude: np.ndarray
    phase: np.ndarray
    contact_duration: np.ndarray
    impact_velocity: np.ndarray

    def __repr__(self) -> str:
        names = ("n", "law", *OBSERVABLES)
        values = (f"  {name:<22}{in_words(getattr(self, name))}" for name in names)
        return "\n".join([type(self).__name__, *values])

    @classmethod
    def of(
        cls,
        n: ArrayLike,
        law: Any,
        amplitude: ArrayLike,
        phase: ArrayLike,
        contact_duration: ArrayLike = 0.0,
        impact_velocity: ArrayLike | None = None,
    ) -> Self:
        """Orbits known by their numbers; none where the phase is NaN.

        Λ and φ are enough where the impact takes no time: z′_i is then -nπ.
        """
        velocity = -np.asarray(n) * np.pi if impact_velocity is None else impact_velocity
        missing = np.where(np.isnan(phase), np.nan, 0.0)
        values = (amplitude, phase, contact_duration + missing, velocity + missing)
        return cls(n, law, *np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in values)))

    # What a model's orbits add.

    @property
    def clock(self) -> ArrayLike:
        """Rate of the contact's own time against the table's; 1 without any."""
        return 1.0

    @property
    def release_displacement(self) -> np.ndarray:
        """δ_b at release."""
        return np.zeros_like(self.contact_duration)

    def contact_motion(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times 0 ≤ τ ≤ τ_b in contact."""
        return np.zeros_like(time), np.zeros_like(time)

    def contact_path(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Absolute position and velocity at times 0 ≤ τ ≤ τ_b in contact."""
        angle, (displacement, velocity) = self.phase + time, self.contact_motion(time)
        lift, pace = self.amplitude * np.sin(angle), self.amplitude * np.cos(angle)
        return displacement + lift, velocity + pace

    def holding(self, time: np.ndarray) -> np.ndarray:
        """What a contact holds the ball by: negative until it vanishes at the release."""
        return self.contact_path(time)[0] - self.amplitude * np.sin(self.phase + time)

    def can_be_simulated(self) -> np.ndarray:
        """Whether :meth:`cycle` is defined for each orbit's parameters."""
        return np.ones(self.shape, dtype=bool)

    @abstractmethod
    def residual(self) -> np.ndarray:
        """Defects of the model's equations, along the last axis."""

    def contact_jacobian(self) -> np.ndarray:
        """Jacobian of (τ_b, δ_b, δ′_b) in (τ, δ′, Λ) at the impact, shape (..., 3, 3).

        Λ, at a fixed δ′, is for the equations of the orbits. Not needed where both the
        equations and the monodromy are a model's own.
        """
        raise NotImplementedError(f"{type(self).__name__} has a monodromy of its own")

    @abstractmethod
    def determinant(self) -> np.ndarray:
        """Determinant of the monodromy, from the contraction and not from its entries.

        Their rounding would decide between stable and not without dissipation.
        """

    @abstractmethod
    def cycle(self, phase: ArrayLike, relative_velocity: ArrayLike) -> Cycle:
        """From impacts (φ, δ′) with these orbits' parameters to the next, simulated."""

    # What follows from the flight.

    def flight_defects(
        self, displacement: ArrayLike, velocity: ArrayLike
    ) -> tuple[np.ndarray, np.ndarray]:
        """Velocity and landing defects (Eqs. 24-25) of contacts that end with (δ_b, δ′_b)."""
        lam, end, bounce = self.amplitude, self.release_phase, self.bounce_velocity
        rise = lam * (np.sin(end) - np.sin(self.phase)) + displacement
        fall = (bounce - self.flight_time / 2) * self.flight_time
        return velocity + lam * np.cos(end) - bounce, rise + fall

    @property
    def exists(self) -> np.ndarray:
        """Whether there is an orbit."""
        return np.isfinite(self.contact_duration)

    @property
    def flight_time(self) -> np.ndarray:
        """τ_2 - τ_b (Eq. 19)."""
        return 2 * np.pi * np.asarray(self.n) - self.contact_duration

    @property
    def release_phase(self) -> np.ndarray:
        """The table's phase φ + τ_b at release."""
        return self.phase + self.contact_duration

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
        return self.bounce_velocity - self.amplitude * np.cos(self.release_phase)

    @property
    def apparent_restitution(self) -> np.ndarray:
        """r_a = -(z′_b - w′_b)/(z′_i - w′_i) (Eq. 17)."""
        return -self.relative_bounce_velocity / self.relative_impact_velocity

    @property
    def bounce_height(self) -> np.ndarray:
        """Absolute height z_b of the ball at release.

        From the flight, which ends at the table's level Λ sin φ.
        """
        landing = self.amplitude * np.sin(self.phase)
        mean_velocity = (self.bounce_velocity + self.impact_velocity) / 2
        return landing - mean_velocity * self.flight_time

    @property
    def max_height(self) -> np.ndarray:
        """Greatest absolute height over the cycle."""
        return self.flight_top

    @property
    def flight_top(self) -> np.ndarray:
        """Greatest height in flight: its top, or its start if released downwards."""
        rising = np.maximum(self.bounce_velocity, 0.0)
        return self.bounce_height + rising * rising / 2

    def flight_path(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Absolute position and velocity at times τ_b ≤ τ ≤ τ_2 in flight (Eqs. 14-15)."""
        s = time - self.contact_duration
        velocity = self.bounce_velocity - s
        return self.bounce_height + (self.bounce_velocity + velocity) / 2 * s, velocity

    def path(self, time: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """Absolute height and velocity at any time since an impact.

        Where an impact takes no time the velocity is the one after it.
        """
        s = np.mod(np.asarray(time, dtype=float), 2 * np.pi * np.asarray(self.n))
        touching = s < self.contact_duration
        inside = self.contact_path(np.where(touching, s, 0.0))
        outside = self.flight_path(np.where(touching, self.contact_duration, s))
        height, velocity = (np.where(touching, a, b) for a, b in zip(inside, outside, strict=True))
        return height, velocity

    def monodromy(self) -> np.ndarray:
        """Jacobian of the return map (τ, δ′) → (τ₁, δ′₁), shape (..., 2, 2).

        Its eigenvalues are the Floquet multipliers. The section is the start of
        contact. One cycle is contact, then flight; the flight ends at an
        implicit event, whose time is differentiated through its condition.
        """
        jacobian, lam = self.contact_jacobian()[..., :2], np.asarray(self.amplitude)
        d_duration, d_displacement, d_velocity = (jacobian[..., k, :] for k in range(3))
        start = np.broadcast_to(np.array([1.0, 0.0]), d_duration.shape)
        d_release_phase = start + d_duration
        landing_phase = self.phase + 2 * np.pi * np.asarray(self.n)

        def table(x):
            return np.asarray(x)[..., np.newaxis]

        d_height = d_displacement + table(lam * np.cos(self.release_phase)) * d_release_phase
        d_bounce = d_velocity - table(lam * np.sin(self.release_phase)) * d_release_phase
        # The flight ends on the table: z_b + z′_b T - T²/2 = Λ sin(τ_b + T).
        table_velocity = table(lam * np.cos(landing_phase))
        d_gap = d_height + table(self.flight_time) * d_bounce - table_velocity * d_release_phase
        d_flight = -d_gap / table(self.relative_impact_velocity)
        d_landing_phase = d_release_phase + d_flight
        d_impact = d_bounce - d_flight + table(lam * np.sin(landing_phase)) * d_landing_phase
        return np.stack([d_landing_phase, d_impact], axis=-2)

    def trace_and_determinant(self) -> tuple[np.ndarray, np.ndarray]:
        """Trace and determinant of the monodromy."""
        return stability.trace_and_determinant(self.monodromy())[0], self.determinant()

    def multipliers(self) -> np.ndarray:
        """Floquet multipliers, complex, shape (..., 2), the larger modulus first."""
        return stability.multipliers(*self.trace_and_determinant())

    def is_stable(self) -> np.ndarray:
        """Whether both multipliers lie inside the unit circle."""
        return stability.is_stable(*self.trace_and_determinant())

    def is_admissible(self) -> np.ndarray:
        """Whether the simulated cycle is the orbit's own.

        No earlier release and no earlier landing: the simulation's next impact,
        whose events are certified, is the orbit's own. False where there is none.
        """
        u = self.relative_impact_velocity
        shape = np.shape(u)
        possible = (u < 0) & (self.contact_duration >= 0) & (self.flight_time > 0)
        admissible = np.zeros(shape, dtype=bool)
        if np.any(possible):
            part = self[possible] if shape else self
            at, speed = part.phase, part.relative_impact_velocity
            cycle = part.cycle(at, speed)
            returned = np.abs(cycle.relative_velocity / speed - 1) < _SAME
            same = np.abs(cycle.time - 2 * np.pi * np.asarray(part.n)) < _SAME
            admissible[possible] = same & returned & (cycle.displacement == 0)
        return admissible

    def defect(self) -> np.ndarray:
        """Largest defect of the model's equations."""
        return np.max(np.abs(self.residual()), axis=-1)

    def distance(self, other: Orbit) -> np.ndarray:
        """Largest difference in Λ, φ, contact duration in its own time, and z′_i."""
        differences = (
            self.amplitude - other.amplitude,
            reduce_angle(self.phase - other.phase),
            (self.contact_duration - other.contact_duration) * self.clock,
            self.impact_velocity - other.impact_velocity,
        )
        return np.max(np.abs(np.broadcast_arrays(*differences)), axis=0)
