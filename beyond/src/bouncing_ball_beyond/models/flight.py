r"""Free flight and the landing that ends it (Eqs. 3-4, 14-15).

Let s be the time since the ball left the table, δ_b and v its relative displacement and
velocity at s = 0, and X = Λ cos φ_b, Y = Λ sin φ_b at the table's phase φ_b. Then ::

    δ(s) = δ_b + v s - s²/2 + Y (1 - cos s) + X (s - sin s)
    δ″   = -1 + Λ sin(φ_b + s) ≥ -(1 + Λ),    |δ‴| ≤ Λ

This form loses no digits in a short flight. The ball cannot land while it is
above the table's highest point, z > Λ, and the search skips this part.
"""

import math
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.errors import ModelError
from bouncing_ball.numerics.elementary import sine_and_versine
from bouncing_ball.numerics.first_zero import Derivatives, Motion, Zero, first_zero

# Constants are arrays without an axis, as in :mod:`bouncing_ball.numerics.elementary`.
_ZERO = np.array(0.0)
_HALF = np.array(0.5)
_ONE = np.array(1.0)
_TWO = np.array(2.0)
# A minimum is known when the next step to it is this short; its height then has an error of the
# order of the square. Bisections of an interval of at most π take at most so many steps.
_SHORT = 2.0**-26
_STEPS = 28
# Intervals of all flights that are searched for minima at the same time.
_TOGETHER = 8192
# The height where there is no minimum.
_FAR = 1.0


def table(phase: np.ndarray, amplitude: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
    """Λ cos φ and Λ sin φ: the table's velocity and height, or minus its jerk and acceleration.

    Examples
    --------
    >>> [float(x) for x in table(np.zeros(()), 2.0)]
    [2.0, 0.0]
    """
    sine, versine = sine_and_versine(phase)
    return amplitude * (_ONE - versine), amplitude * sine


class Above(NamedTuple):
    """The times at which a ball passes the table's highest point, z = Λ; equal if it does not."""

    begins: np.ndarray
    ends: np.ndarray


class Flight(Motion):
    """The motion y = -δ of balls in flight; its first upward zero is the landing.

    In the paper, a flight since τ₀ is ::

        z′ = -(τ - τ₀) + z′₀                                (4)
        z  = -(τ - τ₀)²/2 + (τ - τ₀) z′₀ + z₀

    Eq. 1 is the second line in metres and seconds, y = -g (t - t₀)²/2 + (t - t₀) ẏ₀ + y₀, and Eq. 3
    the first line at the next impact, z′₁ = -(τ₁ - τ₀) + z′₀.
    Here s = τ - τ₀, δ = z - w and v = z′₀ - w′₀ with the table's w = Λ sin τ: the ball has landed
    where δ = 0.

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

    @cached_property
    def above(self) -> Above:
        """The times between which z > Λ."""
        absolute = self.velocity + self.x
        square = absolute * absolute + _TWO * (self.displacement + (self.y - self.amplitude))
        root = np.sqrt(np.maximum(square, _ZERO))
        return Above(absolute - root, absolute + root)

    def gap(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """δ, δ′, δ″ and δ‴ after a time of flight."""
        sine, versine = sine_and_versine(time)
        x = self.x
        y = self.y
        thrown = self.displacement + time * (self.velocity - _HALF * time)
        displacement = thrown + (y * versine + x * (time - sine))
        # The table's velocity has fallen by this much from Λ cos φ_b.
        slowing = y * sine + x * versine
        rate = (self.velocity - time) + slowing
        second = y + (x * sine - y * versine) - _ONE
        return displacement, rate, second, x - slowing

    def __call__(self, time: np.ndarray) -> Derivatives:
        displacement, rate, second, third = self.gap(time)
        lam = self.amplitude
        return Derivatives(
            value=-displacement,
            rate=-rate,
            second=-second,
            third=-third,
            second_bound=_ONE + lam,
            third_bound=lam,
            fourth_bound=lam,
        )

    def skip(self, time: np.ndarray, steps: int = 0) -> np.ndarray:
        """The end of the time in which z > Λ, or the time itself if it is not within this time."""
        begins, ends = self.above
        return np.where((time >= begins) & (time < ends), ends, time)

    def level_speed_squared(self) -> np.ndarray:
        """v² + 2(1 + Λ)δ_b: the square of the relative speed at the table's level against the
        strongest relative gravity, 1 + Λ.

        If it is positive and v > 0, the ball certainly comes above this level.
        """
        return self.velocity * self.velocity + _TWO * (_ONE + self.amplitude) * self.displacement

    def earliest_landing(self) -> np.ndarray:
        """A time before which the ball has certainly not landed.

        It is the flight time of a ball thrown with v from δ_b against the strongest
        relative gravity, 1 + Λ. For a ball at rest on a table with Y ≥ 1, which recedes, it
        follows from ``δ ≥ (Y - 1) s²/2 + X s³/6 - Λ s⁴/24``.
        """
        speed = np.sqrt(np.maximum(self.level_speed_squared(), _ZERO))
        time = (self.velocity + speed) / (_ONE + self.amplitude)
        if self.velocity.all():
            return time
        x = self.x
        top = np.maximum(self.amplitude, 1.0)
        rests = (self.velocity == 0) & (self.displacement == 0) & (self.y >= 1)
        lift = np.maximum(self.y - 1, 0.0)
        by_lift = np.minimum(lift / np.maximum(np.abs(x), 1e-300), np.sqrt(3 * lift / top))
        by_jerk = 4 * x / top
        return np.where(rests, np.maximum(by_lift, by_jerk), time)

    def lowest(self, time: np.ndarray) -> np.ndarray:
        """The smallest local minimum of δ within each flight of this duration, 1 if there is none.

        A minimum is unique in each interval in which Λ sin τ > 1, because δ″ = Λ sin τ - 1 is
        positive there and nowhere else. All minima are therefore found.
        """
        lowest = np.full(time.shape, _FAR)
        amplitude = np.broadcast_to(self.amplitude, time.shape)
        may = np.flatnonzero((amplitude > 1) & np.isfinite(time))
        if not may.size:
            return lowest
        part = self.take(may)
        longest = time[may]
        opening = np.arcsin(1 / amplitude[may])
        start = np.arctan2(part.y, part.x)
        # The first interval with Λ sin τ > 1 that ends after the start of the flight.
        low = opening - start
        width = np.pi - 2 * opening
        low = low - 2 * np.pi * np.floor((low + width) / (2 * np.pi))
        # This interval and the next ones along a first axis.
        count = math.ceil(min((longest - low).max() / (2 * np.pi), _TOGETHER / may.size))
        low = low + 2 * np.pi * np.arange(max(count, 1))[:, np.newaxis]
        while np.any(low < longest):
            left, right = ends = np.clip([low, low + width], 0.0, longest)
            before, after = part.gap(ends)[1]
            turning = (before < 0) & (after > 0)
            if turning.any():
                _, turns = turning.nonzero()
                bottom = part.take(turns)._bottom(left[turning], right[turning])
                np.minimum.at(lowest, may[turns], bottom)
            low = low + 2 * np.pi * len(low)
        return lowest

    def _bottom(self, left: np.ndarray, right: np.ndarray) -> np.ndarray:
        """The minimum of δ between times at which δ falls and rises, with δ″ > 0 between them.

        Newton's method for δ′ = 0 takes the steps, and a bisection where it would leave the rest
        of the interval.
        """
        time = (left + right) / 2
        for _ in range(_STEPS):
            gap, rate, second, _ = self.gap(time)
            left = np.where(rate < 0, time, left)
            right = np.where(rate < 0, right, time)
            step = -rate / second
            if np.abs(step).max() <= _SHORT:
                break
            ahead = time + step
            inside = (ahead >= left) & (ahead <= right)
            time = np.where(inside, ahead, (left + right) / 2)
        return gap + rate * step / 2


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


class Unloaded(Motion):
    """The motion -(δ + κ δ′) in flight; the search ends where δ ≥ 0."""

    def __init__(self, flight: Flight, lag: Any):
        self.flight = flight
        self.lag = lag
        self.forcing = flight.amplitude * np.sqrt(1 + lag * lag)

    def __call__(self, time: np.ndarray) -> Derivatives:
        lag = self.lag
        displacement, rate, second, third = self.flight.gap(time)
        # At the release y = 0 but for rounding; this zero is not the one that is searched for.
        y = np.where(time == 0, 0.0, displacement + lag * rate)
        return Derivatives(
            value=-y,
            rate=-(rate + lag * second),
            second=-(second + lag * third),
            # The fourth derivative of δ is minus that of the table: δ⁗ = -Λ sin τ = -(1 + δ″).
            third=lag * (1 + second) - third,
            second_bound=1 + self.forcing,
            third_bound=self.forcing,
            fourth_bound=self.forcing,
            ended=displacement >= 0,
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


def land(flight: Flight, start: np.ndarray) -> Zero:
    """The first landing; ``start`` is a time before which there is certainly none.

    The ``rate`` of the result is minus the relative impact velocity.

    Raises
    ------
    ModelError
        If no landing was found, because the flight is too long for floating-point numbers.

    Examples
    --------
    A ball thrown up with the velocity 3 from a table at rest comes back after s = 6:

    >>> zero, three = np.zeros(1), np.full(1, 3.0)
    >>> flight = Flight(zero, three, zero, zero, 0.0)
    >>> landing = land(flight, flight.earliest_landing())
    >>> landing.time.tolist(), landing.rate.tolist()
    ([6.0], [3.0])
    """
    landing = first_zero(flight, flight.skip(start))
    if landing.undecided.any():
        raise ModelError("a landing was not found: the flight is out of floating-point range")
    return landing
