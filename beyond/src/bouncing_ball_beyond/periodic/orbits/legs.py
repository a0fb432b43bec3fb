"""One leg of a periodic orbit: a contact, and the flight after it that lands near a given time.

The landing is the one near the next state of the orbit, and not the first one, so that the leg
depends smoothly on its start also where the flight grazes the table.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_beyond.models.contacts_and_flights import Departure, Impact, Section
from bouncing_ball_beyond.models.deviations import Jacobian
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.periodic.orbits.stability import matrices_of, product_of


@dataclass(frozen=True)
class Legs:
    """The legs of orbits, arrays of shape (..., k).

    ``residual`` are the two equations of each leg, its height and its velocity in the words of
    :mod:`bouncing_ball_beyond.periodic.orbits.problem`, shape (..., k, 2), and ``duration`` the
    durations of the contacts; ``clock`` is ϖ of linear contacts whose durations are unknowns.
    ``velocity`` and ``acceleration`` are y′ and δ″ at the phase θ_{i+1}, with y of
    :class:`Landing`. ``dynamics``, which is None where no ball is inside the ranges of
    the parameters, ``impact``, ``departure`` and ``landing`` are flat.
    """

    residual: np.ndarray
    duration: np.ndarray
    clock: np.ndarray | None
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
            clock=None,
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
        dynamics = self.dynamics
        flat = self.impact, self.departure, self.landing
        if len(self.duration) > 1:
            dynamics, *flat = dynamics.kept(slice(math.prod(shape)), *flat)
        impact, departure, landing = flat
        return Legs(
            residual=self.residual[0],
            duration=self.duration[0],
            clock=None if self.clock is None else self.clock[0],
            velocity=self.velocity[0],
            acceleration=self.acceleration[0],
            dynamics=dynamics,
            impact=impact,
            departure=departure,
            landing=landing,
        )

    @property
    def ends(self) -> np.ndarray:
        """arsinh ϖD of linear contacts, D of others: the durations as their equations have them."""
        return self.duration if self.clock is None else np.arcsinh(self.clock * self.duration)

    @cached_property
    def after(self) -> tuple[Impact, np.ndarray]:
        """The impacts with which the flights end, and the times from impact to impact."""
        landing = self.landing
        return self._arrived(
            landing.time + landing.late, landing.velocity + landing.late * landing.acceleration
        )

    @cached_property
    def near(self) -> tuple[Impact, np.ndarray]:
        """The states of the flights at the phases θ_{i+1} as impacts, and the times to them.

        There the ball has not landed yet, or should have landed before.
        """
        return self._arrived(self.landing.time, self.landing.velocity)

    def _arrived(self, time: np.ndarray, velocity: np.ndarray) -> tuple[Impact, np.ndarray]:
        section = self.dynamics.section(self.landing.lag)
        return arrived(section, self.departure, time, velocity)

    @cached_property
    def tangent(self) -> Jacobian:
        """DP, the derivative of the map from the start of each leg to its landing."""
        return self._jacobian(near=False)

    @cached_property
    def tangent_near(self) -> Jacobian:
        """The derivative of the map from the start of each leg to the phase θ_{i+1}.

        It is that of a landing at this phase. It belongs to the equations, and is equal to
        :attr:`tangent` once they are satisfied.
        """
        return self._jacobian(near=True)

    @cached_property
    def matrices(self) -> np.ndarray:
        """DP of each leg as a matrix, shape (..., k, 2, 2)."""
        return matrices_of(self.tangent)

    @cached_property
    def monodromy(self) -> np.ndarray:
        """The derivative of the map Pᵏ of each orbit, shape (..., 2, 2)."""
        return product_of(self.matrices)

    @cached_property
    def trace_and_determinant(self) -> tuple[np.ndarray, np.ndarray]:
        """Trace and determinant of the monodromy of each orbit.

        The determinant is the product of the contractions.
        """
        product = self.monodromy
        return product[..., 0, 0] + product[..., 1, 1], self.contraction.prod(axis=-1)

    @cached_property
    def contraction(self) -> np.ndarray:
        """The factors by which the contacts multiply areas."""
        if self.dynamics is None:
            return self.duration
        with np.errstate(all="ignore"):
            factor = self.dynamics.contraction(self.impact, self.departure)
        return np.reshape(factor, self.duration.shape)

    @cached_property
    def lowest(self) -> np.ndarray:
        """The smallest local minimum of δ in each flight, 1 where there is none."""
        if self.departure is None:
            return self.duration
        duration = np.where(np.isfinite(self.duration.ravel()), self.departure.duration, np.nan)
        with np.errstate(all="ignore"):
            _, passed = self.near
            height = self.departure.flight.lowest(passed - duration)
        return height.reshape(self.duration.shape)

    @property
    def end_slopes(self) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of :attr:`ends` by θ and by v, for a model that continues its contacts."""
        if self.dynamics is None:
            return self.duration, self.duration
        by_phase, by_velocity = (x.reshape(self.duration.shape) for x in self.departure.slopes)
        if self.clock is None:
            return by_phase, by_velocity
        factor = self.clock / np.hypot(1, self.clock * self.duration)
        return factor * by_phase, factor * by_velocity

    def _jacobian(self, near: bool) -> Jacobian:
        """The derivative of the map up to the landing, or up to the phase θ_{i+1}."""
        if self.dynamics is None:
            return Jacobian(*(4 * [self.duration]))
        with np.errstate(all="ignore"):
            end = self.near if near else self.after
            found = self.dynamics.jacobian(self.impact, self.departure, *end)
        return Jacobian(*(entry.reshape(self.duration.shape) for entry in found))


class Landing(NamedTuple):
    """Landings of flights near given times since their starts, where y = δ + κ δ′ vanishes.

    ``height``, ``velocity``, ``rate`` and ``acceleration`` are y, δ′, y′ and δ″ at these times,
    and ``late`` are the times from there to the landings, by one step of Newton's method. If a
    ball lands slowly, this step may be far too long, and yet ``rate`` times ``late`` is exactly
    minus the height. ``lag`` is the κ of contacts that resume.
    """

    time: np.ndarray
    height: np.ndarray
    velocity: np.ndarray
    rate: np.ndarray
    acceleration: np.ndarray
    late: np.ndarray
    lag: np.ndarray


def landed(
    section: Section,
    impact: Impact,
    departure: Departure,
    duration: np.ndarray,
    interval: np.ndarray,
) -> Landing:
    """The landings near the times ``interval`` after the first impacts, both on the section."""
    time = interval + section.delay(impact) - duration
    gap, velocity, acceleration, _ = departure.flight.gap(time)
    lag, slope = section.reached(velocity)
    height = gap + lag * velocity
    rate = velocity + slope * acceleration
    return Landing(
        time=time,
        height=height,
        velocity=velocity,
        rate=rate,
        acceleration=acceleration,
        late=-height / rate,
        lag=section.lag,
    )


def arrived(
    section: Section, departure: Departure, time: np.ndarray, velocity: np.ndarray
) -> tuple[Impact, np.ndarray]:
    """The impacts on the section at times since the starts of flights, with these δ′, and the times
    from impact to impact.
    """
    impact = section.impact(departure.phase + time, velocity)
    return impact, departure.duration + time - section.delay(impact)


def lag_of(dynamics: Dynamics, resumes: np.ndarray) -> np.ndarray:
    """κ of the contacts that resume below the level of the table, and 0 for others."""
    if dynamics.contact is None or not resumes.any():
        return np.zeros(resumes.shape)
    return np.where(resumes, dynamics.contact.lag, 0.0)


def selects_ends(dynamics: Dynamics, impact: Impact, duration: np.ndarray) -> bool:
    """Whether the ends of these contacts follow from their durations, so that the durations are
    unknowns of an orbit: linear contacts, and contacts with rests on the table after them.
    """
    if not dynamics.continues or not np.any(duration > 0):
        return False
    if dynamics.contact is not None:
        return True
    return bool(dynamics.depart(impact, near=duration).sticks.any())


def rests_as_expected(dynamics: Dynamics, impact: Impact, duration: np.ndarray) -> np.ndarray:
    """Whether the balls come to rest on the table where these durations are those of a rest, and
    nowhere else; always, if there is no rest.
    """
    alike = np.ones(duration.shape, dtype=bool)
    lasting = np.flatnonzero(duration > 0)
    if dynamics.contact is not None or not lasting.size:
        return alike
    part, start, expected = dynamics.kept(lasting, impact, duration)
    rests = part.depart(start, near=expected).sticks
    alike[lasting] = part.comes_to_rest(start) == rests
    return alike
