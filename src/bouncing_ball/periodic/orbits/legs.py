"""One leg of a periodic orbit: a contact, and the flight after it that lands near a given time.

The landing is the one near the next state of the orbit, and not the first one, so that the leg
depends smoothly on its start also where the flight grazes the table.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.models.deviations import Jacobian
from bouncing_ball.models.dynamics import Departure, Dynamics, Impact
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.numerics.first_zero import Zero
from bouncing_ball.periodic.orbits.products import matrices_of

# Rounds that find the time from a landing to the section, and the change relative to the time of a
# leg at which they end; each round doubles the number of digits.
_ROUNDS = 6
_SETTLED = 1e-15


@dataclass(frozen=True)
class Legs:
    """The legs of orbits, arrays of shape (..., k).

    ``residual`` are the two equations of each leg, its height and its velocity in the words of
    :mod:`bouncing_ball.periodic.orbits.problem`, shape (..., k, 2), and ``duration`` the durations
    of the contacts. ``velocity`` and ``acceleration`` are y′ and δ″ at the phase θ_{i+1}, with y =
    δ, or δ + κ δ′ where a contact resumes. ``dynamics``, which is None where no ball is inside the
    ranges of the parameters, ``impact``, ``departure`` and ``landing`` are flat.
    """

    residual: np.ndarray
    duration: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    dynamics: Any
    impact: Any
    departure: Any
    landing: Any

    @classmethod
    def unknown(cls, shape: tuple[int, ...]) -> "Legs":
        """Legs of which nothing is known."""
        none = np.full(shape, np.nan)
        return cls(
            residual=np.full((*shape, 2), np.nan),
            duration=none,
            velocity=none,
            acceleration=none,
            dynamics=None,
            impact=None,
            departure=None,
            landing=None,
        )

    def first(self) -> "Legs":
        """The legs of the first of several points along a first axis."""
        shape = self.duration.shape[1:]
        if self.dynamics is None:
            return Legs.unknown(shape)
        flat = self.impact, self.departure, self.landing
        return Legs(
            self.residual[0],
            self.duration[0],
            self.velocity[0],
            self.acceleration[0],
            *self.dynamics.kept(np.arange(math.prod(shape)), *flat),
        )

    @cached_property
    def tangent(self) -> Jacobian:
        """DP, the derivative of the map from the start of each leg to its landing."""
        return self._jacobian(lambda landing: (landing.after, landing.passed))

    @cached_property
    def near(self) -> Jacobian:
        """The derivative of the map from the start of each leg to the phase θ_{i+1}.

        It is that of a landing at this phase. It belongs to the equations, and is equal to
        :attr:`tangent` once they are satisfied.
        """
        return self._jacobian(lambda landing: (landing.near, landing.passed_near))

    @cached_property
    def matrices(self) -> np.ndarray:
        """DP of each leg as a matrix, shape (..., k, 2, 2)."""
        return matrices_of(self.tangent)

    @cached_property
    def contraction(self) -> np.ndarray:
        """The factors by which the contacts multiply areas."""
        if self.dynamics is None:
            return self.duration
        with np.errstate(all="ignore"):
            factor = self.dynamics.contraction(self.impact, self.departure)
            flown = self.landing.passed - self.departure.duration
            factor = factor * self.dynamics.setting.contraction(flown)
        return np.reshape(factor, self.duration.shape)

    @cached_property
    def duration_slopes(self) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of the durations by θ and by v, for a model that continues its contacts."""
        if self.dynamics is None:
            return self.duration, self.duration
        with np.errstate(all="ignore"):
            by_phase, by_velocity = self.dynamics.duration_slopes(self.impact, self.departure)
        return by_phase.reshape(self.duration.shape), by_velocity.reshape(self.duration.shape)

    def _jacobian(self, end: Callable[["Landing"], tuple[Impact, np.ndarray]]) -> Jacobian:
        """The derivative of the map up to an impact, after a time since the start of the leg."""
        if self.dynamics is None:
            return Jacobian(*(4 * [self.duration]))
        with np.errstate(all="ignore"):
            found = self.dynamics.jacobian(self.impact, self.departure, *end(self.landing))
        return Jacobian(*(entry.reshape(self.duration.shape) for entry in found))


class Landing(NamedTuple):
    """Landings of flights near given times.

    ``after`` are the impacts, ``passed`` the times from impact to impact, and ``late`` the times by
    which the impacts come later on the section than given. ``near`` is the state of the flight at
    the given time, as an impact: there the ball has not landed yet, or should have landed before.
    ``passed_near`` is the time from impact to impact if the flight ends there.
    """

    after: Impact
    passed: np.ndarray
    late: np.ndarray
    near: Impact
    passed_near: np.ndarray


def landed(
    dynamics: Dynamics,
    impact: Impact,
    departure: Departure,
    duration: np.ndarray,
    interval: np.ndarray,
    lag: np.ndarray,
) -> Landing:
    """The landings, where δ + κ δ′ = 0 with κ = ``lag``, near the time ``interval`` after the first
    impacts.

    In the corrected model the section is some time after the landing, which is found in a few
    rounds; in other models the first round is enough.
    """
    before = time_to_section(dynamics, impact)
    none = np.zeros(interval.shape, dtype=bool)
    to_section = np.zeros_like(interval)
    for _ in range(_ROUNDS):
        time = interval - duration - to_section
        gap, rate, acceleration, _ = departure.flight.gap(time)
        # One step of Newton's method. If the ball lands slowly, it may be far too long, and yet it
        # is the one with which the height is exactly δ′ t.
        later = -(gap + lag * rate) / (rate + lag * acceleration)
        landing = Zero(time + later, -(rate + later * acceleration), none, none)
        arrived, passed = dynamics.arrive(departure, landing)
        after = without_force(arrived, lag)
        whole = passed + time_to_section(dynamics, after) - before
        last = to_section
        to_section = whole - duration - landing.time
        if not np.any(np.abs(to_section - last) > _SETTLED * interval):
            break
    there, passed_near = dynamics.arrive(departure, Zero(time, -rate, none, none))
    return Landing(after, passed, whole - interval, without_force(there, lag), passed_near)


def lag_of(dynamics: Dynamics, resumes: np.ndarray) -> np.ndarray:
    """κ of the contacts that resume below the level of the table, and 0 for others."""
    if dynamics.contact is None or not resumes.any():
        return np.zeros(resumes.shape)
    return np.where(resumes, dynamics.contact.lag, 0.0)


def without_force(impact: Impact, lag: np.ndarray) -> Impact:
    """The impacts at δ = -κ δ′, where the force of the contact is zero; at δ = 0 for κ = 0."""
    if not lag.any():
        return impact
    return impact._replace(displacement=-lag * impact.velocity)


def time_to_section(dynamics: Dynamics, impact: Impact) -> np.ndarray:
    """The time from the start of the contact to the section, as an angle."""
    phase, _ = dynamics.section(impact)
    if phase is impact.phase:
        return np.zeros(phase.shape)
    return reduce_angle(phase - impact.phase)
