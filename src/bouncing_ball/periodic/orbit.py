"""One n-T orbit of any model, or an array of orbits: the results that follow from the flight alone.

Time runs from the start of contact, τ_i = 0. The contact ends at τ_b = D, and the next contact
starts at τ_2 = 2πn. Heights and velocities are absolute unless they are called relative, which
means relative to the table: δ = z - w.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import require
from bouncing_ball.models.sequence import Cycle
from bouncing_ball.numerics.arrays import Batch, as_numbers, blocks, in_words
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.periodic import stability

OBSERVABLES = (
    "amplitude",
    "phase",
    "contact_duration",
    "impact_velocity",
    "bounce_velocity",
    "apparent_restitution",
    "max_height",
)
"""The seven observables of an orbit, with their names in datasets and on the command line."""
# An earlier impact or release that the equations do not model shifts the next impact by a
# considerable part of a period. Rounding errors, amplified by one unstable cycle, shift it by far
# less.
_SAME = 1e-6
# The highest point of a contact is searched among this many samples. New samples are then taken
# between the neighbours of the highest sample. The last steps are 16⁻⁵ of the first, and the error
# of the height is of the order of the square of the last step.
_SAMPLES = 33
_REFINEMENTS = 6
# Number of orbits whose samples are in memory at the same time.
_BLOCK = 1024


def check_index(n: ArrayLike) -> None:
    """Raise :class:`ModelError` unless the index of the family is a positive integer.

    Examples
    --------
    >>> check_index(1.5)
    Traceback (most recent call last):
    ...
    bouncing_ball.errors.ModelError: index of the family n = 1.5 is not a positive integer
    """
    name = "index of the family n"
    allowed = "a positive integer"
    index = as_numbers(n, name, allowed)
    whole = (index == np.floor(index)) & (index >= 1) & np.isfinite(index)
    require(whole, np.asarray(n), name, allowed)


def as_columns(*arrays: ArrayLike) -> Iterator[np.ndarray]:
    """The arrays with a last axis of length one, for derivatives along it."""
    return (np.asarray(x)[..., np.newaxis] for x in arrays)


@dataclass(frozen=True, repr=False)
class Orbit(Batch, ABC):
    """n-T orbits of one model, one for each element of the (broadcast) fields.

    Parameters
    ----------
    n : int or array of int
        Index of the family.
    law : Batch
        The law of the impact, which is the only field of the model.
    amplitude, phase : array
        Λ, and the table's phase φ at the start of contact.
    contact_duration : array
        D = τ_b, which is 0 for an instantaneous impact and NaN where there is no orbit.
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
        """Orbits from the values of their fields; there is no orbit where the phase is NaN.

        Λ and φ suffice for an impact without duration, because z′_i is then -nπ.
        """
        if impact_velocity is None:
            impact_velocity = -np.asarray(n) * np.pi
        missing = np.where(np.isnan(phase), np.nan, 0.0)
        amplitude, phase, contact_duration, impact_velocity = np.broadcast_arrays(
            np.asarray(amplitude, dtype=float),
            np.asarray(phase, dtype=float),
            contact_duration + missing,
            impact_velocity + missing,
        )
        return cls(n, law, amplitude, phase, contact_duration, impact_velocity)

    # A model's orbits define the following.

    dynamics: ClassVar[Any]
    """The :class:`~bouncing_ball.models.dynamics.Dynamics` of a law of the impact at Λ."""

    @property
    def unknowns(self) -> tuple[np.ndarray, ...]:
        """The unknowns that determine the contact: (φ, z′_i), unless a model has fewer unknowns."""
        return self.phase, self.impact_velocity

    @property
    def clock(self) -> ArrayLike:
        """Frequency of the contact over that of the table; 1 for an instantaneous impact.

        Durations are compared after multiplication by this factor, because the durations of stiff
        contacts are then of order one.
        """
        return 1.0

    def contact_motion(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times 0 ≤ τ ≤ τ_b in contact, of the shape of the times."""
        return np.zeros_like(time), np.zeros_like(time)

    def contact_path(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Height z and velocity z′ at times 0 ≤ τ ≤ τ_b in contact, of the shape of the times."""
        displacement, velocity = self.contact_motion(time)
        table_phase = self.phase + time
        height = displacement + self.amplitude * np.sin(table_phase)
        return height, velocity + self.amplitude * np.cos(table_phase)

    @abstractmethod
    def residual(self) -> np.ndarray:
        """Defects of the model's equations along the last axis; all are 0 for an orbit."""

    def contact_jacobian(self) -> np.ndarray:
        """Jacobian of (τ_b, δ_b, δ′_b) in (τ, δ′, Λ) at the impact, shape (..., 3, 3).

        The column of Λ is taken at a fixed δ′; the equations of the orbits need it. A model that
        defines both the Jacobian of its equations and its monodromy does not need this method.
        """
        raise NotImplementedError(f"{type(self).__name__} has a monodromy of its own")

    @abstractmethod
    def determinant(self) -> np.ndarray:
        """Determinant of the monodromy, computed from the contraction of areas in the contact.

        Without dissipation it is 1. If it were computed from the entries of the monodromy, their
        rounding errors would decide about stability.
        """

    # Everything below follows from the law and the flight.

    def cycle(self, phase: ArrayLike, relative_velocity: ArrayLike) -> Cycle:
        """The simulated map from impacts (φ, δ′) to the next impacts, at the parameters of these
        orbits.
        """
        dynamics = self.dynamics(self.law, self.amplitude)
        return dynamics.next_impact(phase, relative_velocity)

    def flight_defects(
        self, displacement: ArrayLike, velocity: ArrayLike
    ) -> tuple[np.ndarray, np.ndarray]:
        """Velocity and landing defects (Eqs. 24-25) of contacts that end with (δ_b, δ′_b).

        They are ``δ′_b + Λ cos(φ + D) - z′_b`` and
        ``δ_b + Λ sin(φ + D) - Λ sin φ + (z′_b - T/2) T``, with z′_b = z′_i + T and T = 2πn - D.
        """
        lam = self.amplitude
        end = self.release_phase
        bounce = self.bounce_velocity
        # From the table's level at the impact to the ball at its release, and then to the landing.
        at_release = lam * (np.sin(end) - np.sin(self.phase)) + displacement
        flown = (bounce - self.flight_time / 2) * self.flight_time
        return velocity + lam * np.cos(end) - bounce, at_release + flown

    @property
    def exists(self) -> np.ndarray:
        """Whether there is an orbit, which is the case where the contact duration is finite."""
        return np.isfinite(self.contact_duration)

    @property
    def flight_time(self) -> np.ndarray:
        """T = τ_2 - τ_b = 2πn - D (Eq. 19)."""
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
        """δ′ = z′_i - w′_i at the start of contact, negative."""
        return self.impact_velocity - self.amplitude * np.cos(self.phase)

    @property
    def relative_bounce_velocity(self) -> np.ndarray:
        """δ′ = z′_b - w′_b at release, positive."""
        return self.bounce_velocity - self.amplitude * np.cos(self.release_phase)

    @property
    def apparent_restitution(self) -> np.ndarray:
        """r_a = -(z′_b - w′_b)/(z′_i - w′_i) (Eq. 17)."""
        return -self.relative_bounce_velocity / self.relative_impact_velocity

    @property
    def bounce_height(self) -> np.ndarray:
        """Absolute height z_b of the ball at release.

        It follows from the flight, which ends at the level Λ sin φ of the table.
        """
        landing = self.amplitude * np.sin(self.phase)
        mean_velocity = (self.bounce_velocity + self.impact_velocity) / 2
        return landing - mean_velocity * self.flight_time

    @property
    def max_height(self) -> np.ndarray:
        """Greatest absolute height z over the cycle, in flight or in contact.

        If the apex of the flight reaches Λ, it is the greatest height, because a ball in contact is
        below the table and thus below Λ. Otherwise the table may lift the ball higher during a long
        contact.
        """
        rising = np.maximum(self.bounce_velocity, 0.0)
        apex = self.bounce_height + rising * rising / 2
        top = np.array(np.broadcast_to(apex, self.shape))
        low = np.flatnonzero((top < self.amplitude) & (self.contact_duration > 0))
        # The samples of all orbits at once would take gigabytes.
        for part in blocks(low.size, _BLOCK):
            lifted = self.flat(self.shape).take(low[part])._contact_top()
            top.flat[low[part]] = np.maximum(top.flat[low[part]], lifted)
        return top

    def _contact_top(self) -> np.ndarray:
        """Greatest height in contact, from samples that are refined around the highest sample."""
        steps = np.arange(_SAMPLES).reshape(-1, *(1,) * len(self.shape))
        low = 0.0 * self.contact_duration
        step = self.contact_duration / (_SAMPLES - 1)
        for _ in range(_REFINEMENTS):
            height = self.contact_path(low + step * steps)[0]
            highest = np.argmax(np.where(np.isnan(height), -np.inf, height), axis=0)
            # Refine from one step before the highest sample to one step after it, in the contact.
            low = low + step * np.clip(highest - 1, 0, _SAMPLES - 3)
            step = 2 * step / (_SAMPLES - 1)
        return np.max(height, axis=0)

    def flight_path(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Absolute position and velocity at times τ_b ≤ τ ≤ τ_2 in flight (Eqs. 14-15)."""
        s = time - self.contact_duration
        velocity = self.bounce_velocity - s
        return self.bounce_height + (self.bounce_velocity + velocity) / 2 * s, velocity

    def path(self, time: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """Absolute height and velocity at any time τ since an impact, with period 2πn.

        The shape is that to which the times and the orbits broadcast. At the time of an impact
        without duration, the velocity is that after the impact.
        """
        s = np.mod(np.asarray(time, dtype=float), 2 * np.pi * np.asarray(self.n))
        touching = s < self.contact_duration
        inside = self.contact_path(np.where(touching, s, 0.0))
        outside = self.flight_path(np.where(touching, self.contact_duration, s))
        height = np.where(touching, inside[0], outside[0])
        velocity = np.where(touching, inside[1], outside[1])
        return height, velocity

    def flight_jacobian(
        self, start: Iterable[np.ndarray], contact: Iterable[np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of :meth:`flight_defects` along the last axis, by the chain rule.

        ``start`` holds the derivatives of (φ, z′_i, Λ) at the start of contact, ``contact`` those
        of (τ_b, δ_b, δ′_b) at its end.
        """
        d_phase, d_impact, d_lam = start
        d_duration, d_displacement, d_velocity = contact
        lam, phase, end = as_columns(self.amplitude, self.phase, self.release_phase)
        bounce, flight = as_columns(self.bounce_velocity, self.flight_time)
        # The release is at φ + τ_b, the velocity there is z′_b = z′_i + T, and T = 2πn - τ_b.
        d_end = d_phase + d_duration
        d_bounce = d_impact - d_duration
        velocity = d_velocity + np.cos(end) * d_lam - lam * np.sin(end) * d_end - d_bounce
        rise = (np.sin(end) - np.sin(phase)) * d_lam
        rise = rise + lam * (np.cos(end) * d_end - np.cos(phase) * d_phase)
        landing = d_displacement + rise + flight * d_bounce - (bounce - flight) * d_duration
        return velocity, landing

    def jacobian(self) -> np.ndarray:
        """Jacobian of the flight's two defects in (φ, z′_i, Λ), shape (..., 2, 3).

        The contact is determined by its start (φ, z′_i): its duration depends on (φ, z′_i, Λ), and
        the field ``contact_duration`` is not held fixed.
        """
        inner = np.tile(np.eye(3), (*self.shape, 1, 1))
        inner[..., 1, 0] = self.amplitude * np.sin(self.phase)
        inner[..., 1, 2] = -np.cos(self.phase)
        contact = np.moveaxis(self.contact_jacobian() @ inner, -2, 0)
        return np.stack(self.flight_jacobian(np.eye(3), contact), axis=-2)

    def system_jacobian(self) -> np.ndarray:
        """Jacobian of the equations by the :attr:`unknowns` and Λ, shape (..., N, N + 1)."""
        return self.jacobian()

    def monodromy(self) -> np.ndarray:
        """Jacobian of the return map (τ, δ′) → (τ₁, δ′₁), shape (..., 2, 2).

        Its eigenvalues are the Floquet multipliers; the Poincaré section is the start of contact.
        If the start is moved by (dφ, dz′_i), the defects of velocity and height are (dV, dH), and
        the flight time to the table changes by s. Here ``u s = -(dH + T dV)``, where u is the
        relative impact velocity. The next start is therefore moved by (dφ + s, dz′_i + dV - s).
        """
        # The rows of the two defects; the columns of φ and z′_i.
        d_velocity, d_height = np.moveaxis(self.jacobian()[..., :2], -2, 0)
        flight, speed = as_columns(self.flight_time, self.relative_impact_velocity)
        later = -(d_height + flight * d_velocity) / speed
        moved = np.eye(2) + np.stack([later, d_velocity - later], axis=-2)
        # From (φ, z′_i) to (φ, δ′): δ′ = z′_i - Λ cos φ.
        turn = np.zeros_like(moved)
        turn[..., 1, 0] = self.amplitude * np.sin(self.phase)
        return (np.eye(2) + turn) @ moved @ (np.eye(2) - turn)

    def trace_and_determinant(self) -> tuple[np.ndarray, np.ndarray]:
        """Trace and determinant of the monodromy, each with the shape of the orbits."""
        return self._trace, self.determinant()

    @cached_property
    def _trace(self) -> np.ndarray:
        return np.trace(self.monodromy(), axis1=-2, axis2=-1)

    def multipliers(self) -> np.ndarray:
        """Floquet multipliers, complex, shape (..., 2); that of larger modulus comes first."""
        return stability.multipliers(*self.trace_and_determinant())

    def is_stable(self) -> np.ndarray:
        """Whether both multipliers lie inside the unit circle: asymptotic stability."""
        return stability.is_stable(*self.trace_and_determinant())

    def is_admissible(self) -> np.ndarray:
        """Whether the simulated ball follows the orbit for a cycle.

        The ball follows the orbit if there is no earlier release and no earlier landing, so that
        the next impact of the simulation, whose events are certified, is that of the orbit. The
        result is False where there is no orbit.
        """
        approaches = self.relative_impact_velocity < 0
        possible = approaches & (self.contact_duration >= 0) & (self.flight_time > 0)
        admissible = np.zeros(self.shape, dtype=bool)
        if np.any(possible):
            part = self[possible] if self.shape else self
            speed = part.relative_impact_velocity
            cycle = part.cycle(part.phase, speed)
            returned = np.abs(cycle.relative_velocity / speed - 1) < _SAME
            same = np.abs(cycle.time - 2 * np.pi * np.asarray(part.n)) < _SAME
            # The next impact may be a contact that resumes below the level of the table. It starts
            # with a rising ball, so that its velocity differs from that of the orbit.
            admissible[possible] = same & returned
        return admissible

    def defect(self) -> np.ndarray:
        """Largest absolute value of the defects of the model's equations."""
        return np.max(np.abs(self.residual()), axis=-1)

    def distance(self, other: Orbit) -> np.ndarray:
        """Largest difference to other orbits in Λ, φ, z′_i, and in D times :attr:`clock`."""
        turned = reduce_angle(self.phase - other.phase)
        longer = (self.contact_duration - other.contact_duration) * self.clock
        faster = self.impact_velocity - other.impact_velocity
        larger = self.amplitude - other.amplitude
        differences = np.broadcast_arrays(larger, turned, longer, faster)
        return np.max(np.abs(differences), axis=0)
