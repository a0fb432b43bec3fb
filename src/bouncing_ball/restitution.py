"""The restitution model: an impact is an instant (Eqs. 1-9).

Time is in units of 1/Ω and length in units of g/Ω². The table is at w = Λ sin τ, a flight obeys
z″ = -1, and an impact reverses the velocity relative to the table and multiplies it by the
restitution coefficient r (Eq. 2). An n-T orbit has one impact, at the phase φ of the table, and
repeats after n periods of the table; X = Λ cos φ is the velocity of the table at the impact and
Y = Λ sin φ its height, the impact height.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

Numbers = float | NDArray
"""A number, or an array of them."""

PERMANENT_CONTACT = 1.0
"""Λ_CR: a ball at rest stays on the table up to this amplitude (Eq. 9)."""

STICKING = 1e-9
"""Relative velocity after an impact below which a ball sticks to the table. Its impacts then follow
each other faster and faster, and their velocities fall geometrically."""


def bounce_velocity(n: Numbers) -> NDArray:
    """Velocity nπ of the ball just after the impact of an n-T orbit (Eq. 6).

    >>> round(float(bounce_velocity(1)), 6)
    3.141593
    """
    return np.pi * np.asarray(n)


def saddle_node(n: Numbers, r: Numbers) -> NDArray:
    """Amplitude nπ(1 - r)/(1 + r) from which on the n-T orbits exist (Eq. 7).

    It is also the velocity X of the table at the impact of every n-T orbit (Eq. 6).

    >>> round(float(saddle_node(1, 0.85)), 4)
    0.2547
    """
    r = np.asarray(r)
    return bounce_velocity(n) * (1 - r) / (1 + r)


def impact_phase(n: Numbers, r: Numbers, amplitude: Numbers) -> NDArray:
    """Phase φ of the impact of the stable n-T orbit (Eq. 6); that of the unstable orbit is -φ.

    It is NaN below the saddle-node.

    >>> round(float(impact_phase(1, 0.65, 1.0)), 4)
    0.8414
    """
    with np.errstate(invalid="ignore"):
        return np.arccos(saddle_node(n, r) / np.asarray(amplitude))


def trace(r: Numbers, impact_height: Numbers) -> NDArray:
    """Trace 1 + r² - (1 + r)² Y of the linearised map (Eq. 5) at an n-T orbit; its determinant
    is r².
    """
    r = np.asarray(r)
    return 1 + r**2 - (1 + r) ** 2 * np.asarray(impact_height)


def period_doubling_height(r: Numbers) -> NDArray:
    """Impact height Y = 2(1 + r²)/(1 + r)² at the period doubling: 1 + trace + determinant = 0."""
    r = np.asarray(r)
    return 2 * (1 + r**2) / (1 + r) ** 2


def period_doubling(n: Numbers, r: Numbers) -> NDArray:
    """Amplitude at which the n-T orbit of the map of Eq. 5 loses its stability.

    >>> round(float(period_doubling(1, 0.85)), 4)
    1.0383
    """
    return np.hypot(period_doubling_height(r), saddle_node(n, r))


def holmes_period_doubling(n: Numbers, r: Numbers) -> NDArray:
    """The period doubling as printed, Λ² = 1 + [nπ(1 - r)/(1 + r)]² (Eq. 8).

    It belongs to Holmes' map, which neglects the height of the table against that of the flight;
    there Y is 1, its trace 1 + r - 2(1 + r) Y and its determinant r.

    >>> round(float(holmes_period_doubling(1, 0.85)), 4)
    1.0319
    """
    return np.hypot(1, saddle_node(n, r))


def stable(r: Numbers, impact_height: Numbers) -> NDArray[np.bool_]:
    """Whether both Floquet multipliers of an n-T orbit lie inside the unit circle."""
    return is_stable(trace(r, impact_height), np.asarray(r) ** 2)


def is_stable(trace: Numbers, determinant: Numbers) -> NDArray[np.bool_]:
    """Whether both eigenvalues of a 2 × 2 matrix lie inside the unit circle.

    An orbit within 1e-9 of a bifurcation counts as not stable, so that rounding errors do not
    decide at the bifurcation itself.
    """
    determinant = np.asarray(determinant)
    margin = 1e-9
    return (np.abs(trace) < 1 + determinant - margin) & (determinant < 1 - margin)


def max_height(n: Numbers, r: Numbers, amplitude: Numbers) -> NDArray:
    """Greatest height Λ sin φ + (nπ)²/2 of the ball over a cycle of the stable n-T orbit."""
    impact_height = np.asarray(amplitude) * np.sin(impact_phase(n, r, amplitude))
    return impact_height + bounce_velocity(n) ** 2 / 2


def height(n: int, impact_height: Numbers, time: Numbers) -> NDArray:
    """Height of the ball at times since an impact at the height Y, for an n-T orbit (Eq. 4)."""
    since = np.mod(time, 2 * np.pi * n)
    return impact_height + bounce_velocity(n) * since - since**2 / 2


def velocity(n: int, time: Numbers) -> NDArray:
    """Velocity of the ball at times since an impact of an n-T orbit (Eq. 3)."""
    return bounce_velocity(n) - np.mod(time, 2 * np.pi * n)


def grazing_height(n: int, r: float) -> float:
    """Impact height of the n-T orbit whose flight touches the table; no orbit has a smaller one.

    The ball is at Y(1 - cos s) + h(s) above the table at a time s after the impact, with
    h(s) = nπ s - s²/2 - X sin s. This is positive for all s if Y exceeds the largest value of
    -h(s)/(1 - cos s), which has a maximum in each period of the flight.
    """
    x = float(saddle_node(n, r))

    def needed(s):
        return -(bounce_velocity(n) * s - s**2 / 2 - x * np.sin(s)) / (1 - np.cos(s))

    largest = -np.inf
    for k in range(n):
        # Between two whole periods after the impact 1 - cos s is positive, and at each of them the
        # function tends to minus infinity, so that it has a maximum in between.
        grid = 2 * np.pi * (k + np.linspace(0, 1, 202)[1:-1])
        best = int(np.argmax(needed(grid)))
        low = grid[max(best - 1, 0)]
        high = grid[min(best + 1, grid.size - 1)]
        found = minimize_scalar(
            lambda s: -needed(s), bounds=(low, high), method="bounded", options={"xatol": 1e-12}
        )
        largest = max(largest, -found.fun)
    return largest


def flight_time(amplitude: float, time: float, velocity: float) -> float:
    """Duration of the flight of a ball that leaves the table at a time τ with a velocity (Eq. 5).

    It is the first positive zero of the height above the table, which is searched in steps of a
    twentieth of a radian; where the height falls and rises again within a step, its minimum is
    looked at, too. A ball without relative velocity must be where the table falls faster than it,
    Λ sin τ >= 1.
    """
    start = amplitude * np.sin(time)
    relative = velocity - amplitude * np.cos(time)

    def gap(s):
        return start + velocity * s - s**2 / 2 - amplitude * np.sin(time + s)

    def gap_rate(s):
        return velocity - s - amplitude * np.cos(time + s)

    # The relative acceleration is at least -(1 + Λ), so that the ball does not land before this.
    earliest = 2 * relative / (1 + amplitude)
    if relative <= STICKING:
        # The height above the table begins with (Λ sin τ - 1)s²/2 + Λ cos τ s³/6, which is positive
        # unless cos τ < 0: half of its zero is taken then.
        slowing = max(-amplitude * np.cos(time), 0.0)
        earliest = min(0.01, 1.5 * (start - 1) / slowing) if slowing else 0.01
    # At this time the flight is at the lowest level of the table.
    latest = velocity + np.sqrt(velocity**2 + 2 * (start + amplitude))
    grid = np.linspace(earliest, latest, 2 + int(20 * (latest - earliest)))
    rates = gap_rate(grid)
    dips = np.flatnonzero((rates[:-1] < 0) & (rates[1:] > 0))
    minima = [brentq(gap_rate, grid[i], grid[i + 1]) for i in dips]
    stops = np.sort(np.concatenate([grid, minima]))
    below = np.flatnonzero(gap(stops[1:]) <= 0)
    if gap(stops[0]) <= 0 or below.size == 0:
        # Rounding errors decide at both ends of the search, where the height is zero.
        return float(stops[0] if below.size else stops[-1])
    return brentq(gap, stops[below[0]], stops[below[0] + 1], xtol=1e-14)


def impact_map(
    r: float, amplitude: float, time: float, velocity: float
) -> tuple[float, float, NDArray]:
    """The next impact: its time, the velocity after it (Eq. 5), and the derivative of both.

    The derivative is a 2 × 2 matrix; its rows are those of time and velocity, its columns those by
    time and velocity of the impact before.
    """
    duration = flight_time(amplitude, time, velocity)
    following = time + duration
    table_before = amplitude * np.cos(time)
    table_after = amplitude * np.cos(following)
    bounce = -r * (velocity - duration) + (1 + r) * table_after
    landing = velocity - duration - table_after
    by_time = 1 - (table_before - table_after) / landing
    by_velocity = -duration / landing
    table_turn = (1 + r) * amplitude * np.sin(following)
    derivative = np.array(
        [
            [by_time, by_velocity],
            [
                r * (by_time - 1) - table_turn * by_time,
                r * (by_velocity - 1) - table_turn * by_velocity,
            ],
        ]
    )
    return following, bounce, derivative


@dataclass(frozen=True)
class Impacts:
    """The impacts of a ball: their times τ, the velocities of the ball after them, the logarithm of
    the growth of a small deviation from each impact to the next, which has an entry less, and the
    number of impacts after which the ball sticks to the table for a while.
    """

    time: NDArray
    velocity: NDArray
    growth: NDArray
    stickings: int


def departure(amplitude: float, time: float) -> float:
    """The time at which a ball leaves the table if it sticks to it at a time τ and Λ > 1.

    It is the next time at which Λ sin τ exceeds 1, so that the table falls faster than the ball.
    """
    rising = np.arcsin(1 / amplitude)
    phase = np.mod(time, 2 * np.pi)
    if rising <= phase <= np.pi - rising:
        return time
    return time + np.mod(rising - phase, 2 * np.pi)


def iterate(r: float, amplitude: float, time: float, velocity: float, impacts: int) -> Impacts:
    """Follow a ball that leaves the table at a time τ with a velocity over a number of impacts.

    After an impact with a relative velocity below STICKING the ball moves with the table until
    that falls faster than the ball. Deviations from its motion are then lost, so that the growth
    is NaN.

    Raises
    ------
    ValueError
        If the ball comes to rest, on a table with Λ <= 1 (Eq. 9).
    """
    times = np.empty(impacts)
    velocities = np.empty(impacts)
    growth = np.full(impacts - 1, np.nan)
    times[0] = time
    velocities[0] = velocity
    deviation = np.array([1.0, 0.0])
    stickings = 0
    for k in range(impacts - 1):
        time = times[k]
        velocity = velocities[k]
        sticks = velocity - amplitude * np.cos(time) <= STICKING
        if sticks and amplitude <= PERMANENT_CONTACT:
            raise ValueError(
                f"the ball at Λ = {amplitude:g} comes to rest: Λ must exceed 1 (Eq. 9)"
            )
        if sticks:
            stickings += 1
            time = departure(amplitude, time)
            velocity = amplitude * np.cos(time)
        times[k + 1], velocities[k + 1], derivative = impact_map(r, amplitude, time, velocity)
        deviation = derivative @ deviation
        size = np.hypot(*deviation)
        deviation = deviation / size
        if not sticks:
            growth[k] = np.log(size)
    return Impacts(times, velocities, growth, stickings)


def repetition(path: Impacts) -> tuple[int, int]:
    """After how many impacts, and how many periods of the table, a motion repeats; zeros if not.

    The last quarter of the impacts must repeat, in phase and velocity, to 1e-9, which a stable
    orbit reaches by then unless it is close to a bifurcation.
    """
    settled = 3 * path.time.size // 4
    time = path.time[settled:]
    velocity = path.velocity[settled:]
    for count in range(1, time.size // 2):
        periods = (time[count:] - time[:-count]) / (2 * np.pi)
        same_phase = np.abs(periods - np.rint(periods)).max() < 1e-9
        if same_phase and np.abs(velocity[count:] - velocity[:-count]).max() < 1e-9:
            return count, int(np.rint(periods[0]))
    return 0, 0


def lyapunov_exponent(path: Impacts, block: int = 32) -> tuple[float, float]:
    """Largest Lyapunov exponent per period of the table, and its standard error.

    The first quarter of the impacts is left out. The error is that of a ratio of means over blocks
    of impacts. Both are NaN if the ball sticks to the table in the others.
    """
    blocks = 3 * path.growth.size // (4 * block)
    grown = path.growth[-blocks * block :].reshape(blocks, block).sum(axis=1)
    passed = np.diff(path.time[-blocks * block - 1 :: block]) / (2 * np.pi)
    exponent = grown.sum() / passed.sum()
    scatter = np.sum((grown - exponent * passed) ** 2) * blocks / (blocks - 1)
    return exponent, np.sqrt(scatter) / passed.sum()
