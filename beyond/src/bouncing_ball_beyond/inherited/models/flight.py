r"""The table, and the free flight of a ball up to its landing (Eqs. 1, 3, 4, 14, 15).

The table's height is w = Λ sin τ. Let s be the time since the release, at the phase φ_b of the
table, with the displacement δ_b of the ball relative to the table and its relative velocity v. With
X = Λ cos φ_b and Y = Λ sin φ_b ::

    δ(s) = δ_b + v s - s²/2 + Y (1 - cos s) + X (s - sin s)
    δ″   = -1 + Λ sin(φ_b + s) ≥ -(1 + Λ),    |δ‴| ≤ Λ

The rounding errors of this form vanish with s. The ball has landed where δ = 0. It cannot land
while it is above the table's highest point, z > Λ, and the search skips this part.
"""

import math
from typing import NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.numerics.arrays import pick
from bouncing_ball_beyond.inherited.numerics.elementary import sine_and_versine
from bouncing_ball_beyond.inherited.numerics.first_zero import Derivatives, Motion, Zero, first_zero

# Newton steps to a local minimum of δ, each of which squares the error or halves the bracket.
_STEPS = 60
# Intervals of all flights that are searched for minima at the same time.
_TOGETHER = 8192
_NO_MINIMUM = 1.0
# Flights of so many radians occur where a method of solution diverges. Their minima, one for each
# turn of the table, are not sought.
_LONGEST = 1e6


def table(phase: np.ndarray, amplitude: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
    """Λ cos φ and Λ sin φ: the table's velocity and height, or minus its jerk and acceleration.

    Examples
    --------
    >>> [float(x) for x in table(np.zeros(()), 2.0)]
    [2.0, 0.0]
    """
    sine, versine = sine_and_versine(phase)
    return amplitude * (1 - versine), amplitude * sine


class Flight(Motion):
    """The motion y = -δ of balls in flight; its first upward zero is the landing.

    In the paper, a flight since τ₀ is ::

        z′ = -(τ - τ₀) + z′₀                                (4)
        z  = -(τ - τ₀)²/2 + (τ - τ₀) z′₀ + z₀

    Eq. 1 is the second line in metres and seconds, y = -g (t - t₀)²/2 + (t - t₀) ẏ₀ + y₀, and Eq. 3
    the first line at the next impact, z′₁ = -(τ₁ - τ₀) + z′₀. Here s = τ - τ₀ and v = z′₀ - w′₀.

    Parameters
    ----------
    phase, displacement, velocity : ndarray
        φ_b, δ_b and v at the release.
    amplitude : ndarray
        Λ.
    """

    def __init__(
        self,
        phase: np.ndarray,
        displacement: np.ndarray,
        velocity: np.ndarray,
        amplitude: np.ndarray,
    ) -> None:
        self.displacement = displacement
        self.velocity = velocity
        self.amplitude = amplitude
        self.x, self.y = table(phase, amplitude)

    def gap(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """δ, δ′, δ″ and δ‴ after a time of flight.

        Examples
        --------
        >>> flight = Flight(np.zeros(1), np.zeros(1), np.full(1, 3.0), 0.0)
        >>> [float(x[0]) for x in flight.gap(np.ones(1))]
        [2.5, 2.0, -1.0, 0.0]
        """
        sine, versine = sine_and_versine(time)
        thrown = self.displacement + time * (self.velocity - time / 2)
        # The table's velocity has fallen by this much from Λ cos φ_b.
        slowing = self.y * sine + self.x * versine
        return (
            thrown + (self.y * versine + self.x * (time - sine)),
            (self.velocity - time) + slowing,
            self.y + (self.x * sine - self.y * versine) - 1,
            self.x - slowing,
        )

    def __call__(self, time: np.ndarray) -> Derivatives:
        displacement, rate, second, third = self.gap(time)
        return Derivatives(
            value=-displacement,
            rate=-rate,
            second=-second,
            third=-third,
            second_bound=1 + self.amplitude,
            third_bound=self.amplitude,
            fourth_bound=self.amplitude,
        )

    def skip(self, time: np.ndarray, steps: int = 0) -> np.ndarray:
        """The end of the time in which z > Λ, or the time itself if it is not within this time."""
        absolute = self.velocity + self.x
        square = absolute * absolute + 2 * (self.displacement + (self.y - self.amplitude))
        root = np.sqrt(np.maximum(square, 0.0))
        aloft = (time >= absolute - root) & (time < absolute + root)
        return np.where(aloft, absolute + root, time)

    def level_speed_squared(self) -> np.ndarray:
        """v² + 2(1 + Λ)δ_b: the square of the relative speed at the table's level, of a ball that
        is thrown against the strongest relative gravity, 1 + Λ.
        """
        return self.velocity * self.velocity + 2 * (1 + self.amplitude) * self.displacement

    def earliest_landing(self) -> np.ndarray:
        """A time before which the ball has certainly not landed.

        It is the flight time of a ball thrown with v from δ_b against the strongest relative
        gravity, 1 + Λ. For a ball that the table leaves behind, at rest with Y ≥ 1, it follows from
        ``δ ≥ (Y - 1) s²/2 + X s³/6 - Λ s⁴/24``.
        """
        speed = np.sqrt(np.maximum(self.level_speed_squared(), 0.0))
        time = (self.velocity + speed) / (1 + self.amplitude)
        left_behind = (self.velocity == 0) & (self.displacement == 0) & (self.y >= 1)
        if not left_behind.any():
            return time
        top = np.maximum(self.amplitude, 1.0)
        lift = np.maximum(self.y - 1, 0.0)
        by_lift = np.minimum(lift / np.maximum(np.abs(self.x), 1e-300), np.sqrt(3 * lift / top))
        return np.where(left_behind, np.maximum(by_lift, 4 * self.x / top), time)

    def lowest(self, time: np.ndarray) -> np.ndarray:
        """The smallest local minimum of δ within each flight of this duration, 1 if there is none,
        or if the flight lasts for more than 10⁶ radians.

        Where it falls to 0 the flight grazes the table. A minimum is unique in each interval in
        which Λ sin τ > 1, because δ″ = Λ sin τ - 1 is positive there and nowhere else. All minima
        are therefore found.

        Examples
        --------
        >>> one = np.ones(1)
        >>> Flight(0 * one, 0 * one, 3 * one, 0 * one).lowest(6 * one).tolist()
        [1.0]
        """
        lowest = np.full(time.shape, _NO_MINIMUM)
        amplitude = np.broadcast_to(self.amplitude, time.shape)
        may = np.flatnonzero((amplitude > 1) & (time < _LONGEST))
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
                bottom = _bottom(part.take(turns), left[turning], right[turning])
                np.minimum.at(lowest, may[turns], bottom)
            low = low + 2 * np.pi * len(low)
        return lowest


def _bottom(flight: Flight, left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """The minimum of δ between times at which δ falls and rises, with δ″ > 0 between them.

    Newton's method for δ′ = 0 takes the steps, and a bisection where it would leave the bracket.
    """
    time = (left + right) / 2
    for _ in range(_STEPS):
        _, rate, second, _ = flight.gap(time)
        left = np.where(rate < 0, time, left)
        right = np.where(rate < 0, right, time)
        ahead = time - rate / second
        inside = (ahead >= left) & (ahead <= right)
        before = time
        time = np.where(inside, ahead, (left + right) / 2)
        if np.all(time == before):
            break
    return flight.gap(time)[0]


class Unloaded(Motion):
    """The motion -(δ + κ δ′) after a release by vanishing force; the search ends where δ ≥ 0."""

    def __init__(self, flight: Flight, lag: np.ndarray) -> None:
        self.flight = flight
        self.lag = lag
        self.forcing = flight.amplitude * np.sqrt(1 + lag * lag)

    def __call__(self, time: np.ndarray) -> Derivatives:
        displacement, rate, second, third = self.flight.gap(time)
        # At the release it is 0 but for rounding; this zero is not the one that is searched for.
        value = np.where(time == 0, 0.0, displacement + self.lag * rate)
        # The fourth derivative of δ is minus that of the table: δ⁗ = -Λ sin τ = -(1 + δ″).
        fourth = -(1 + second)
        return Derivatives(
            value=-value,
            rate=-(rate + self.lag * second),
            second=-(second + self.lag * third),
            third=-(third + self.lag * fourth),
            second_bound=1 + self.forcing,
            third_bound=self.forcing,
            fourth_bound=self.forcing,
            ended=displacement >= 0,
        )


class Landing(NamedTuple):
    """Ends of flights: the time of flight, δ and δ′.

    δ = 0 and δ′ ≤ 0 at a landing. After a release by vanishing force the contact may resume before
    the ball is back at the table's level; then δ < 0 and δ + κ δ′ = 0.
    """

    time: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray


def fly(
    phase: np.ndarray,
    displacement: np.ndarray,
    velocity: np.ndarray,
    amplitude: np.ndarray,
    lag: np.ndarray | float = 0.0,
) -> Landing:
    """The first landings of balls after their releases, rows of one length.

    Parameters
    ----------
    phase, displacement, velocity : ndarray
        φ_b, δ_b and v at the release.
    amplitude : ndarray
        Λ.
    lag : ndarray or float
        κ: a contact resumes where δ + κ δ′ falls to 0 while δ < 0.

    Raises
    ------
    ModelError
        If a flight is too long for floating-point numbers.

    Examples
    --------
    A ball thrown up with the velocity 3 from a table at rest comes back after s = 6:

    >>> zero, three = np.zeros(1), np.full(1, 3.0)
    >>> [float(x[0]) for x in fly(zero, zero, three, zero)]
    [6.0, 0.0, -3.0]
    """
    flight = Flight(phase, displacement, velocity, amplitude)
    start = flight.earliest_landing()
    resumed = np.zeros(start.shape, dtype=bool)
    slow = np.flatnonzero(~_leaves_fast(flight, lag))
    if slow.size:
        start[slow], resumed[slow] = _above_the_level(flight.take(slow), pick(lag, slow))
    landing = land(flight, start)
    gap, rate, *_ = flight.gap(start)
    return Landing(
        time=np.where(resumed, start, landing.time),
        displacement=np.where(resumed, gap, 0.0),
        velocity=np.where(resumed, rate, -landing.rate),
    )


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
    >>> flight = Flight(zero, zero, three, zero)
    >>> landing = land(flight, flight.earliest_landing())
    >>> landing.time.tolist(), landing.rate.tolist()
    ([6.0], [3.0])
    """
    landing = first_zero(flight, flight.skip(start))
    if landing.undecided.any():
        raise ModelError("a landing was not found: the flight is out of floating-point range")
    return landing


def _leaves_fast(flight: Flight, lag: np.ndarray | float) -> np.ndarray:
    """Whether δ certainly reaches 0 before δ + κ δ′ can fall back to 0.

    With G = 1 + Λ, the strongest relative gravity, ``v² + 2Gδ_b > 0`` and ``√(v² + 2Gδ_b) ≥ κ G``
    are sufficient. A ball that leaves at the table's level, κ = 0, always does.
    """
    square = flight.level_speed_squared()
    strongest = 1 + flight.amplitude
    rises = (square > 0) & (flight.velocity >= 0)
    return (np.equal(lag, 0)) | (rises & (np.sqrt(np.maximum(square, 0.0)) >= lag * strongest))


def _above_the_level(flight: Flight, lag: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The times at which slow balls reach δ = 0 or their contact resumes, and whether it does."""
    found = first_zero(Unloaded(flight, lag), np.zeros(flight.velocity.shape))
    return found.time, ~found.ended & (flight.gap(found.time)[0] < 0)


def flight_derivative(
    phase: np.ndarray,
    time: np.ndarray,
    landing_velocity: np.ndarray,
    amplitude: np.ndarray | float,
    lag: np.ndarray | float = 0.0,
) -> np.ndarray:
    """The derivative of the phase and δ′ at the landing by φ_b and v, shape (..., 2, 2).

    With (X₁, Y₁) = Λ (cos, sin) at the landing after a time T, and δ_b = -κ v at the release, at a
    fixed T::

        ∂δ/∂φ_b = X - X₁ - Y T,    ∂δ′/∂φ_b = Y₁ - Y,    ∂δ/∂v = T - κ,    ∂δ′/∂v = 1

    The landing is later by dT = -dδ/δ′, in which δ′ changes by (Y₁ - 1) dT.

    Parameters
    ----------
    phase, time, landing_velocity : ndarray
        φ_b, T and δ′ at the landing.
    amplitude, lag : ndarray or float
        Λ and κ.

    Examples
    --------
    On a table at rest a ball that leaves faster by 1 flies longer by 2, and lands faster by 1:

    >>> flight_derivative(np.array(0.0), np.array(4.0), np.array(-2.0), 0.0)[:, 1].tolist()
    [2.0, -1.0]
    """
    x, y = table(phase, amplitude)
    x1, y1 = table(phase + time, amplitude)
    later_by_phase = -(x - x1 - y * time) / landing_velocity
    later_by_velocity = -(time - lag) / landing_velocity
    return matrix_of(
        1 + later_by_phase,
        later_by_velocity,
        (y1 - y) + (y1 - 1) * later_by_phase,
        1 + (y1 - 1) * later_by_velocity,
    )


def matrix_of(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> np.ndarray:
    """The matrices with the rows (a, b) and (c, d), shape (..., 2, 2)."""
    entries = np.stack(np.broadcast_arrays(a, b, c, d), axis=-1)
    return entries.reshape(*entries.shape[:-1], 2, 2)
