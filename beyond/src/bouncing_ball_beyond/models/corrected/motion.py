"""Impacts of the corrected restitution model: instant, release, flight, landing.

The impact is that of :mod:`bouncing_ball_beyond.models.corrected.impact`. The flight that
follows counts from the end of the contact on, D - t_c after the
instant. The ball leaves there if it rises and comes above the table's level.
If it does not, the impact was too weak for its load (v is of the order of a D), and the
ball stays on the table until the table's downward acceleration exceeds gravity, at Λ sin τ = 1
while the table rises. For Λ ≤ 1 it never leaves.

The landing on the table's level is found as in the other two models, and is proved to be the
first. On the flight continued from there, the instant is where the ball has the depth
h = v t_c(v). A few steps of Newton's method find it, starting from the solution for a constant
load; after a slow landing the first such time is searched for.

A state on the Poincaré section is (φ, δ′) at the start of contact, t_c before
the instant. The height of the continued flight at this start differs from the table's level by
about a t_c²/2.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bouncing_ball_beyond.inherited.models.flight import Unloaded, table
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.inherited.numerics.first_zero import Zero, first_zero
from bouncing_ball_beyond.models.contacts_and_flights import (
    NO_LAG,
    Departure,
    DurationSlopes,
    Impact,
    Section,
)
from bouncing_ball_beyond.models.corrected import impact as corrected_map
from bouncing_ball_beyond.models.deviations import Deviation, Jacobian
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.models.flight import Flight, FromBelow, emerge
from bouncing_ball_beyond.models.sticking import lift_off, lifted, stay

# Newton steps from the landing to the instant: the start has an error of third order in t_c, and
# each step doubles the order.
_DESCENT = 4
# A landing is slow if its speed is below so many t_c (1 + Λ). During the descent of a faster one,
# which takes 2 t_c at most, δ + h falls with a quarter of this speed at least.
_SLOW = 4.0
# A search for a slow instant, if the delay depends on the speed, takes steps of this part of the
# time, and then bisects the step on which δ + h changes its sign.
_STEP = 1 / 16
_BISECTIONS = 20
# A time that exceeds the duration of a contact by rounding still belongs to it.
_LATER = 1e-12
# Errors of the tabulated signature of an elastic contact, multiplied by the ratio of flight
# time to delay.
_ELASTIC = 1e-10


@dataclass(frozen=True)
class Instants(Section):
    """The instants of the impacts: the phase ψ, and δ′ = -v before the impact.

    The ball is below the table there by h = v t_c(v), that is κ = -t_c(-δ′).
    """

    dynamics: "CorrectedDynamics"

    def impact(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        """The impacts at these instants, with their starts."""
        law, amplitude = self.dynamics.law, self.dynamics.amplitude
        instant = reduce_angle(phase)
        arrival = velocity + table(instant, amplitude)[0]
        hit = corrected_map.impact(law.where_known, amplitude, instant, arrival)
        return Impact.at_level(*corrected_map.start_of(amplitude, hit), hit)

    def state(self, impact: Impact) -> tuple[np.ndarray, np.ndarray]:
        """The phase of the instant and the relative velocity before it."""
        hit = impact.known
        return reduce_angle(hit.phase), -hit.speed

    def delay(self, impact: Impact) -> np.ndarray:
        """t_c."""
        return reduce_angle(reduce_angle(impact.known.phase) - impact.phase)

    def gap(self, impact: Impact) -> np.ndarray:
        """δ of the flights t_c before the instants."""
        now = np.zeros(impact.phase.shape)
        gap, _ = self.dynamics.within(impact, self.dynamics.depart(impact, near=now), now)
        return gap

    def reached(self, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """-t_c and -d(v t_c)/dv."""
        instant = self.dynamics.law.where_known(-velocity)
        return -instant.delay, instant.d_delay * velocity - instant.delay


@dataclass(frozen=True, repr=False)
class CorrectedDynamics(Dynamics):
    """Impacts and flights of the corrected model; ``law`` is the signature."""

    forgets: ClassVar[bool] = True
    continues: ClassVar[bool] = True

    def start(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        """First impacts that start at phases φ with δ′ at the table's level, and their instants."""
        arrival = velocity + table(phase, self.amplitude)[0]
        instant = corrected_map.meeting(self.law, self.amplitude, phase, arrival)
        hit = corrected_map.impact(self.law, self.amplitude, *instant)
        return Impact.at_level(phase, velocity, hit)

    def depart(
        self, impact: Impact, *, near: np.ndarray | None = None, differentiate: bool = False
    ) -> Departure:
        """The end of each contact, or of the rest on the table that follows it.

        With ``near`` it is the one of the two that is nearest to this duration, also where the
        other one is that of the ball.
        """
        departure = self._released(impact)
        if near is not None:
            departure = stay(departure, self._rests(departure, near), self.amplitude)
            departure = lifted(departure, self.amplitude)
            return departure._replace(slopes=_slopes(impact, departure))
        start, leaves = emerge(departure.flight)
        departure = stay(departure, ~leaves, self.amplitude)
        flight = FromBelow(departure.flight, np.where(leaves, start, 0.0))
        departure = departure._replace(flight=flight)
        return lifted(departure, self.amplitude) if differentiate else departure

    def _released(self, impact: Impact) -> Departure:
        """The ends of the contacts, and the flights from there, also of balls that do not rise."""
        hit = impact.known
        amplitude = self.amplitude
        x, y = table(hit.phase, amplitude)
        rest = hit.instant.duration - hit.instant.delay
        whole = Flight(hit.height - y, hit.velocity - x, x, y, amplitude)
        displacement, velocity, _, _ = whole.gap(rest)
        end = hit.phase + rest
        flight = Flight(displacement, velocity, *table(end, amplitude), amplitude)
        none = np.zeros_like(end)
        return Departure(end, hit.instant.duration + none, flight, none)

    def _rests(self, released: Departure, duration: np.ndarray) -> np.ndarray:
        """Which durations are nearer to the end of a rest on the table than to that of the contact
        before it.
        """
        lift = lift_off(released.phase, self.amplitude)
        rest = np.where(lift.never, np.inf, lift.wait)
        return duration > released.duration + rest / 2

    def arrive(self, departure: Departure, landing: Zero) -> tuple[Impact, np.ndarray]:
        """The start of the contact after a landing, and the time from the last start to it."""
        flight = departure.flight
        at_level = departure.phase + landing.time
        flown = landing.time + self._descent(at_level, -landing.rate)
        instant = reduce_angle(departure.phase + flown)
        arrival = flight.velocity + flight.x - flown
        hit = corrected_map.impact(self.law, self.amplitude, instant, arrival)
        phase, velocity = corrected_map.start_of(self.amplitude, hit)
        passed = departure.duration + flown - hit.instant.delay
        return Impact.at_level(phase, velocity, hit), passed

    def _descent(self, phase: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Time from landings (phase, δ′) on the table's level to the instants.

        At the instant ``δ + h(-δ′) = 0``. With a constant load a and delay t_c this is
        ``a s²/2 + (u - a t_c) s = u t_c`` for the landing speed u = -δ′.
        """
        x, y = table(phase, self.amplitude)
        fall = Flight(np.zeros_like(velocity), velocity, x, y, self.amplitude)
        here = self.law(-velocity)
        delay = here.delay
        pull = (1 - y) * delay
        both = -velocity - pull + np.sqrt(velocity * velocity + pull * pull)
        falls = both > 0
        time = np.where(falls, -2 * delay * velocity / np.where(falls, both, 1.0), 2 * delay)
        slow = np.flatnonzero(-velocity < _SLOW * delay * (1 + self.amplitude))
        if slow.size:
            time[slow] = self.take(slow)._slow_descent(fall.take(slow), delay[slow])
        for _ in range(_DESCENT):
            displacement, rate, acceleration, _ = fall.gap(time)
            if not self.law.is_constant:
                here = self.law(-rate)
            by_time = rate - (here.delay - here.d_delay * rate) * acceleration
            missing = displacement - rate * here.delay
            sinks = by_time < 0
            time = time - np.where(sinks, missing / np.where(sinks, by_time, -1.0), 0.0)
        return time

    def _slow_descent(self, fall: Flight, delay: np.ndarray) -> np.ndarray:
        """The first times at which falls from the table's level have the depth h; t_c is the delay
        at the landing.

        After a slow landing δ + h may rise at first, and become 0 several times.
        """
        speed = -fall.velocity
        # Up to this time δ + h, which is u t_c at first, loses less than it has.
        start = speed * delay / (2 * (speed + (1 + self.amplitude) * delay))
        if self.law.is_constant:
            return first_zero(Unloaded(fall, -delay), start).time
        early = late = start
        above = np.ones(start.shape, dtype=bool)
        while above.any():
            early = np.where(above, late, early)
            late = np.where(above, late * (1 + _STEP), late)
            above &= self._above_depth(fall, late)
        for _ in range(_BISECTIONS):
            middle = (early + late) / 2
            above = self._above_depth(fall, middle)
            early = np.where(above, middle, early)
            late = np.where(above, late, middle)
        return late

    def _above_depth(self, fall: Flight, time: np.ndarray) -> np.ndarray:
        """Whether the balls are above the depth h of an impact with their speed."""
        displacement, rate, _, _ = fall.gap(time)
        return (rate < 0) & (displacement - rate * self.law(-rate).delay > 0)

    def jacobian(
        self, impact: Impact, departure: Departure, after: Impact, passed: np.ndarray
    ) -> Jacobian:
        """Derivative of the map from one instant to the next.

        It is zero if the ball sticks, because its later motion does not depend on the impact.
        """
        hit = impact.known
        then = after.known
        x, y = table(hit.phase, self.amplitude)
        none = np.zeros_like(passed)
        free = np.where(departure.sticks, 0.0, 1.0)
        here, _ = hit.instant.tangent(hit.speed, 1 - y)
        there, _ = then.instant.tangent(then.speed, 0)
        between = passed + then.instant.delay - hit.instant.delay
        end = table(then.phase, self.amplitude)
        released = Deviation.pair(
            Deviation(free, none, -here.load * x * free),
            Deviation(none, here.delay * free, -here.restitution * free),
        )
        images = released.flown((x, y), end, between, -then.speed, -there.delay)
        return Jacobian.of_columns(images)

    def section(self, lag: np.ndarray = NO_LAG) -> Section:
        """The instants; no contact resumes."""
        return Instants(self, lag)

    def contraction(self, impact: Impact, departure: Departure) -> np.ndarray:
        """The factor of areas at the instant, 0 if the ball sticks.

        With X = Λ cos ψ, Y = Λ sin ψ, the velocity w after the impact, dw = W dψ - b dp and the
        depth's slope e, it is ``[b (w - X - e Y) - e (W + 1)]/(v - e a)``. Without dissipation it
        is 1 up to the error of a tabulated signature, which is set to 1.
        """
        hit = impact.known
        x, y = table(hit.phase, self.amplitude)
        here, _ = hit.instant.tangent(hit.speed, 1 - y)
        by_phase = -(1 + here.restitution) * y - here.load * x
        after = here.restitution * (hit.velocity - x - here.delay * y) - here.delay * (by_phase + 1)
        factor = after / (hit.speed - here.delay * (1 - y))
        factor = np.where(np.abs(factor - 1) < _ELASTIC, 1.0, factor)
        return np.where(departure.sticks, 0.0, factor)

    def within(
        self, impact: Impact, departure: Departure, time: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ on the parabolas of the flights before and after the instants, 0 at rest."""
        hit = impact.known
        since = time - hit.instant.delay
        start = np.where(since < 0, hit.arrival, hit.velocity)
        x, y = table(hit.phase + since, self.amplitude)
        rests = time > hit.instant.duration * (1 + _LATER)
        displacement = hit.height + (start - since / 2) * since - y
        return np.where(rests, 0.0, displacement), np.where(rests, 0.0, start - since - x)


def _slopes(impact: Impact, departure: Departure) -> DurationSlopes:
    """The derivatives of the durations by ψ and by -v: those of D(v), or of t_c(v) - ψ for a rest,
    which lasts until a fixed phase.
    """
    instant = impact.known.instant
    rests = departure.sticks
    by_speed = np.where(rests, instant.d_delay, instant.d_duration)
    return DurationSlopes(np.where(rests, -1.0, 0.0), -by_speed)
