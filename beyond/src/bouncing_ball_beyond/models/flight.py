"""Free flight of balls on a table whose state at the release is known.

A flight is that of the inherited library (:mod:`bouncing_ball_beyond.inherited.models.flight`, Eqs.
3-4, 14-15). The models of this house know X = Λ cos φ_b and Y = Λ sin φ_b at the release, and balls
may start below the table's level.
"""

import numpy as np

from bouncing_ball_beyond.inherited.models import flight as free
from bouncing_ball_beyond.inherited.numerics.first_zero import Derivatives, Motion, first_zero


class Flight(free.Flight):
    """The motion y = -δ of balls in flight; its first upward zero is the landing.

    Parameters
    ----------
    displacement, velocity : array
        δ_b and v, relative to the table.
    x, y : array
        Λ cos φ_b and Λ sin φ_b.
    amplitude : float or array
        Λ.
    """

    def __init__(self, displacement, velocity, x, y, amplitude):
        self.displacement = displacement
        self.velocity = velocity
        self.x = x
        self.y = y
        self.amplitude = amplitude


class FromBelow(Flight):
    """Flights from below the table's level, with times before which the balls have not landed, or 0
    where it is not known.
    """

    def __init__(self, flight: Flight, aloft: np.ndarray):
        vars(self).update(vars(flight))
        self.aloft = aloft

    def earliest_landing(self) -> np.ndarray:
        """The later one of this time and that of every flight."""
        return np.maximum(self.aloft, super().earliest_landing())


class Rise(Motion):
    """The motion δ of balls below the table's level; the search stops if they fall ever faster."""

    def __init__(self, flight: Flight):
        self.flight = flight

    def __call__(self, time: np.ndarray) -> Derivatives:
        displacement, rate, second, third = self.flight.gap(time)
        lam = self.flight.amplitude
        return Derivatives(
            value=displacement,
            rate=rate,
            second=second,
            third=third,
            second_bound=1 + lam,
            third_bound=lam,
            fourth_bound=lam,
            ended=(rate <= 0) & (second <= 0),
        )


class Fall(Motion):
    """The motion -δ′ of balls that rise relative to the table; its first zero is their top."""

    def __init__(self, flight: Flight):
        self.flight = flight

    def __call__(self, time: np.ndarray) -> Derivatives:
        _, rate, second, third = self.flight.gap(time)
        lam = self.flight.amplitude
        # The fourth derivative of δ is minus that of the table: δ⁗ = -Λ sin τ = -(1 + δ″).
        return Derivatives(
            value=-rate,
            rate=-second,
            second=-third,
            third=second + 1,
            second_bound=lam,
            third_bound=lam,
            fourth_bound=lam,
        )


def emerge(flight: Flight) -> tuple[np.ndarray, np.ndarray]:
    """Whether balls released at the table's level or below it rise above it.

    The results are a time before which they have certainly not landed, and whether they rise.
    """
    time = flight.earliest_landing()
    rising = flight.velocity > 0
    uncertain = np.flatnonzero(rising & (flight.level_speed_squared() <= 0))
    if uncertain.size:
        part = flight.take(uncertain)
        start = np.zeros(uncertain.size)
        # The ball is highest where it first stops rising, and no step can pass over this time.
        top, *_ = part.gap(first_zero(Fall(part), start).time)
        rise = first_zero(Rise(part), start)
        rising[uncertain] = (top > 0) & ~(rise.ended | rise.undecided) & (rise.rate > 0)
        # Above the table's level the flight is bounded by that against the gravity 1 + Λ.
        time[uncertain] = rise.time + 2 * rise.rate / (1 + part.amplitude)
    return time, rising
