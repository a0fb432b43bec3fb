r"""Impacts with a restitution coefficient: impact, chattering, and the map from impact to impact.

Let v₀ be the ball's velocity just after an impact at the phase τ₀. The ball flies for a time s
until it lands, and the impact turns its relative velocity δ′ into ``-r δ′`` (Eq. 2). With the
flight of Eqs. 3 and 4, the map from (τ₀, v₀) to the phase τ₁ = τ₀ + s and the velocity v₁ just
after the next impact is (Eq. 5) ::

    Λ (sin τ₁ - sin τ₀) = s v₀ - s²/2
    v₁ = -r (v₀ - s) + (1 + r) Λ cos τ₁

Here the map is composed of the impact (:meth:`RestitutionDynamics.depart`) and of the flight up to
the landing (:meth:`.Dynamics.fly`), and a state is (τ, δ′) just before an impact.

Balls chatter as in the inherited library
(:mod:`bouncing_ball_beyond.inherited.models.restitution`), and then rest on the table until they
lift off (:mod:`bouncing_ball_beyond.models.sticking`).
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bouncing_ball_beyond.inherited.models.restitution import chattering
from bouncing_ball_beyond.models.contacts_and_flights import Departure, DurationSlopes, Impact
from bouncing_ball_beyond.models.deviations import Deviation, Jacobian
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.models.flight import Flight
from bouncing_ball_beyond.models.sticking import lift_off, lifted, stay

# The window in which a ball is proved to come to rest, in units of T₀; the longer it is, the more
# the relative gravity may change within it.
_WINDOW = 1.25
# The smallest speed of an impact for which r is asked.
_SLOW = np.array(np.finfo(float).tiny)


@dataclass(frozen=True, repr=False)
class RestitutionDynamics(Dynamics):
    """Impacts and flights of the restitution model; ``law`` holds numbers r in [0, 1], or what
    :meth:`rebound` of a subclass needs.

    Examples
    --------
    The map satisfies both lines of Eq. 5, shown at the top of this module. The first impact, at
    τ₀ = 0.3, turns δ′ = -2 into 1:

    >>> r, amplitude, start = 0.5, 1.2, 0.3
    >>> v = 1 + amplitude * np.cos(start)
    >>> after = RestitutionDynamics.of(r, amplitude).next_impact(start, -2.0)
    >>> s, end = after.time, start + after.time
    >>> landing = amplitude * (np.sin(end) - np.sin(start)) - (s * v - s**2 / 2)
    >>> bounced = -r * after.relative_velocity + amplitude * np.cos(end)
    >>> expected = -r * (v - s) + (1 + r) * amplitude * np.cos(end)
    >>> bool(abs(landing) < 1e-14), bool(abs(bounced - expected) < 1e-14)
    (True, True)
    """

    forgets: ClassVar[bool] = True
    continues: ClassVar[bool] = True
    is_constant: ClassVar[bool] = True
    """Whether r is the same at every speed."""

    def rebound(self, speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """r and d(r v)/dv at impact speeds v > 0; for a constant r both are r."""
        return self.law, self.law

    def _rebound_of(self, impact: Impact) -> tuple[np.ndarray, np.ndarray]:
        # A ball that rests on the table has no impact speed; its r has no effect.
        return self.rebound(np.maximum(-impact.velocity, _SLOW))

    def depart(
        self, impact: Impact, *, near: np.ndarray | None = None, differentiate: bool = False
    ) -> Departure:
        """The flight after each impact, or the rest on the table after chattering.

        The impact turns δ′ into -r δ′, with δ′ = z′ - w′. In the paper, in metres and seconds, this
        is ẏ⁺ - ẇ = -r (ẏ⁻ - ẇ) (Eq. 2).

        With ``near`` it is the rest where this duration is positive, and the flight elsewhere. The
        bounces before the rest are left out then, also if they would last beyond the lift-off
        (:meth:`comes_to_rest`): the state at the lift-off does not depend on them.
        """
        if near is not None:
            return self._rested(impact, near > 0)
        r, _ = self._rebound_of(impact)
        velocity = -r * impact.velocity
        x, y = self.table_at(impact)
        sticks, settling = chattering(velocity, r, x, y, self.amplitude)
        flight = Flight(np.zeros(x.shape), velocity, x, y, self.amplitude)
        departure = self._left(impact, flight, sticks, settling)
        return lifted(departure, self.amplitude) if differentiate else departure

    def _rested(self, impact: Impact, rests: np.ndarray) -> Departure:
        """The rest on the table up to the lift-off where ``rests`` says so, otherwise the flight.

        A rest lasts until a fixed phase, so that the slope of its duration by φ is -1.
        """
        r, _ = self._rebound_of(impact)
        none = np.zeros(impact.phase.shape)
        velocity = -r * impact.velocity
        flight = Flight(none, velocity, *self.table_at(impact), self.amplitude)
        departure = lifted(self._left(impact, flight, rests, none), self.amplitude)
        return departure._replace(
            slopes=DurationSlopes(np.where(departure.sticks, -1.0, 0.0), none)
        )

    def comes_to_rest(self, impact: Impact) -> np.ndarray:
        """Whether the bounces after each impact end before the next lift-off.

        Next to the limit this takes the more bounces, the nearer r is to 1: some 300 for r = 0.9.
        """
        balls = np.arange(impact.phase.size)
        settled = np.zeros(balls.shape, dtype=bool)
        lift = lift_off(impact.phase, self.amplitude)
        left = np.where(lift.never, np.nan, np.mod(lift.phase - impact.phase, 2 * np.pi))
        for leg in self.legs(impact, differentiate=True):
            comes_to_rest = leg.departure.sticks | self.take(balls)._rests_within(leg.impact, left)
            settled[balls[comes_to_rest]] = True
            left, balls = leg.keep(np.flatnonzero(~comes_to_rest), left, balls)
            _, passed = leg.fly()
            left = left - passed
            left, balls = leg.keep(np.flatnonzero(left > 0), left, balls)
        return settled

    def _rests_within(self, impact: Impact, left: np.ndarray) -> np.ndarray:
        """Which balls certainly come to rest within these times, by a bound on all their bounces.

        While the relative gravity is between g and G, a flight that begins with v takes 2v/g at
        most and lands with (2G/g - 1) v at most, so that all bounces together take 2v/(g (1 - q))
        with q = r (2G/g - 1). Within a time W the relative gravity changes by Λ W at most. This
        holds for a constant r.
        """
        if not self.is_constant:
            return np.zeros(left.shape, dtype=bool)
        _, height = self.table_at(impact)
        gravity = 1 - height
        first = -2 * self.law * impact.velocity
        # There is no bound without a loss, or where the table falls away.
        with np.errstate(divide="ignore", invalid="ignore"):
            window = _WINDOW * first / (gravity * (1 - self.law))
            change = self.amplitude * window
            least = gravity - change
            ratio = self.law * (2 * (gravity + change) / least - 1)
            whole = first / (least * (1 - ratio))
        return (least > 0) & (ratio < 1) & (whole <= window) & (window <= left)

    def _left(
        self, impact: Impact, flight: Flight, sticks: np.ndarray, settling: np.ndarray
    ) -> Departure:
        """The flights after the impacts, or after the rest of the balls that stick."""
        departure = Departure(
            phase=impact.phase + settling,
            duration=settling,
            flight=flight,
            status=np.zeros(settling.shape),
            settling=settling,
        )
        return stay(departure, sticks, self.amplitude)

    def jacobian(
        self, impact: Impact, departure: Departure, after: Impact, passed: np.ndarray
    ) -> Jacobian:
        """Derivative of the map over impact and flight.

        It is zero if the ball sticks, because its later motion does not depend on the impact.
        """
        _, slope = self._rebound_of(impact)
        none = np.zeros(passed.shape)
        free = np.logical_not(departure.sticks).astype(float)
        by_phase = Deviation(free, none, none)
        by_velocity = Deviation(none, none, -slope * free)
        return self.over_flight((by_phase, by_velocity), departure, after, passed)

    def contraction(self, impact: Impact, departure: Departure) -> np.ndarray:
        """r d(r v)/dv, which is r² for a constant r; 0 if the ball sticks."""
        r, slope = self._rebound_of(impact)
        return np.where(departure.sticks, 0.0, r * slope)
