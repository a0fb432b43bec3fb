"""The restitution model: an impact is an instant (Eqs. 1-9).

Time is in units of 1/Ω, and length is in units of g/Ω². The table moves as w = Λ sin τ, and the
ball in flight obeys z″ = -1. An impact reverses the velocity of the ball relative to the table, and
multiplies it by the restitution coefficient r (Eq. 2).

An n-T orbit repeats after n periods of the table and has one impact per cycle. At the impact the
table has the phase φ and the velocity X = Λ cos φ. Its height Y = Λ sin φ is the impact height.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

Numbers = float | NDArray
"""A number, or an array of numbers."""

PERMANENT_CONTACT = 1.0
"""Largest amplitude Λ_CR at which a ball at rest on the table stays in contact (Eq. 9)."""

STICKING = 1e-9
"""Relative velocity after an impact below which a ball sticks to the table. Without this limit, the
ball would bounce infinitely often in a finite time, with geometrically decreasing velocities."""


MARGIN = 1e-9
"""Margin of the flags stable and admissible. Without it, rounding errors would decide about an
orbit at a bifurcation, or one that grazes."""


def required(name: str, values: Numbers, wrong: NDArray | bool, allowed: str) -> NDArray:
    """Return the values of an argument as an array; ValueError if some are wrong, or no numbers."""
    values = np.asarray(values)
    if values.dtype.kind not in "biufc":
        raise ValueError(f"{name} is {values.tolist()!r}: give {allowed}")
    if np.any(wrong):
        raise ValueError(f"{name} is {values[wrong].flat[0]:g}: give {allowed}")
    return values


def periods(n: Numbers) -> NDArray:
    """Return numbers n of table periods; ValueError if they are not whole, or below 1."""
    return required("n", n, ~(np.greater_equal(n, 1) & (np.mod(n, 1) == 0)), "whole numbers n >= 1")


def coefficient(r: Numbers) -> NDArray:
    """Return restitution coefficients r; ValueError if they are outside 0 < r <= 1.

    NaN passes, because it marks elements of an array for which no contact exists.
    """
    r = required("r", r, False, "0 < r <= 1")
    return required("r", r, np.less_equal(r, 0) | np.greater(r, 1), "0 < r <= 1")


def finite(name: str, values: Numbers) -> NDArray:
    """Return the values of an argument of a search; ValueError if they are NaN or infinite.

    Closed forms have no such check: they return NaN for NaN.
    """
    values = required(name, values, False, f"finite {name}")
    return required(name, values, ~np.isfinite(values), f"finite {name}")


def ascending(ratios: Numbers) -> NDArray:
    """Return frequency ratios ϖ of a scan; ValueError unless they are finite, positive and rising.

    A search for thresholds needs the order. A number becomes an array of one.
    """
    ratios = np.atleast_1d(ratios)
    if ratios.ndim > 1 or ratios.size == 0 or ratios.dtype.kind not in "iuf":
        raise ValueError(f"ϖ is {ratios.tolist()!r}: give a number, or a list of numbers")
    wrong = ~(np.isfinite(ratios) & np.greater(ratios, 0))
    wrong[1:] |= ratios[1:] <= ratios[:-1]
    return required("ϖ", ratios, wrong, "finite ϖ > 0 in ascending order")


def bounce_velocity(n: Numbers) -> NDArray:
    """Velocity nπ of the ball after the impact of an n-T orbit (Eq. 6).

    >>> round(float(bounce_velocity(1)), 6)
    3.141593
    """
    return np.pi * periods(n)


def saddle_node(n: Numbers, r: Numbers) -> NDArray:
    """Minimum amplitude nπ(1 - r)/(1 + r) at which n-T orbits exist (Eq. 7).

    The velocity X of the table at the impact has the same value, for every n-T orbit (Eq. 6). For
    n = 1 and r < 0.02 the flight of this orbit would pass through the table (`grazing_height`).

    >>> round(float(saddle_node(1, 0.85)), 4)
    0.2547
    """
    r = coefficient(r)
    return bounce_velocity(n) * (1 - r) / (1 + r)


def impact_phase(n: Numbers, r: Numbers, amplitude: Numbers) -> NDArray:
    """Phase φ of the impact of the stable n-T orbit (Eq. 6), NaN below the saddle-node.

    The impact of the unstable n-T orbit has the phase -φ.

    >>> round(float(impact_phase(1, 0.65, 1.0)), 4)
    0.8414
    """
    amplitude = required("Λ", amplitude, np.less(amplitude, 0), "Λ >= 0")
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.arccos(saddle_node(n, r) / amplitude)


def trace(r: Numbers, impact_height: Numbers) -> NDArray:
    """Trace 1 + r² - (1 + r)² Y of the linearised map (Eq. 5) at an n-T orbit.

    The determinant of the linearised map is r².
    """
    r = coefficient(r)
    return 1 + r**2 - (1 + r) ** 2 * np.asarray(impact_height)


def period_doubling_height(r: Numbers) -> NDArray:
    """Impact height Y = 2(1 + r²)/(1 + r)² at the period doubling.

    It solves 1 + trace + determinant = 0.
    """
    r = coefficient(r)
    return 2 * (1 + r**2) / (1 + r) ** 2


def period_doubling(n: Numbers, r: Numbers) -> NDArray:
    """Amplitude √(X² + Y²) at the period doubling of the n-T orbit of Eq. 5.

    Below this amplitude, down to the saddle-node, the orbit is stable. X is given by
    `saddle_node` and Y by `period_doubling_height`.

    >>> round(float(period_doubling(1, 0.85)), 4)
    1.0383
    """
    return np.hypot(period_doubling_height(r), saddle_node(n, r))


def holmes_period_doubling(n: Numbers, r: Numbers) -> NDArray:
    """Amplitude of the period doubling as the paper prints it (Eq. 8).

    The formula Λ² = 1 + [nπ(1 - r)/(1 + r)]² belongs to Holmes' map. This map neglects the height
    of the table compared with the height of the flight. Its trace is 1 + r - 2(1 + r) Y and its
    determinant is r. Its period doubling is therefore at Y = 1.

    >>> round(float(holmes_period_doubling(1, 0.85)), 4)
    1.0319
    """
    return np.hypot(1, saddle_node(n, r))


def stable(r: Numbers, impact_height: Numbers) -> NDArray[np.bool_]:
    """Whether an n-T orbit is stable (`is_stable`)."""
    return is_stable(trace(r, impact_height), np.asarray(r) ** 2)


def is_stable(trace: Numbers, determinant: Numbers) -> NDArray[np.bool_]:
    """Whether an orbit is stable: small deviations do not grow.

    The Floquet multipliers are the eigenvalues of a 2 × 2 matrix. For |trace| < 1 + determinant and
    determinant < 1 both are inside the unit circle. For determinant = 1, without damping, both are
    on the circle: the orbit is *marginally stable*, because deviations neither decay nor grow. At a
    bifurcation, |trace| = 1 + determinant, the orbit is not stable. The conditions are decided by a
    margin, `MARGIN`.
    """
    determinant = np.asarray(determinant)
    return (np.abs(trace) < 1 + determinant - MARGIN) & (determinant < 1 + MARGIN)


def max_height(n: Numbers, r: Numbers, amplitude: Numbers) -> NDArray:
    """Maximum height Λ sin φ + (nπ)²/2 of the ball on the stable n-T orbit.

    It is NaN below the saddle-node.
    """
    impact_height = np.asarray(amplitude) * np.sin(impact_phase(n, r, amplitude))
    return impact_height + bounce_velocity(n) ** 2 / 2


def height(n: int, impact_height: Numbers, time: Numbers) -> NDArray:
    """Height of the ball on an n-T orbit (Eq. 4), at times since an impact at the height Y."""
    since = np.mod(time, 2 * bounce_velocity(n))
    return impact_height + bounce_velocity(n) * since - since**2 / 2


def velocity(n: int, time: Numbers) -> NDArray:
    """Velocity of the ball on an n-T orbit (Eq. 3), at times since an impact."""
    return bounce_velocity(n) - np.mod(time, 2 * np.pi * n)


def grazing_height(n: int, r: float) -> float:
    """Minimum impact height Y of the n-T orbits.

    The flight of the orbit with this impact height touches the table. At a smaller impact height
    the flight would pass through the table.

    Define h(s) = nπ s - s²/2 - X sin s. At a time s after the impact, the ball is at the height
    Y(1 - cos s) + h(s) above the table. This height is positive for all s if Y exceeds the maximum
    of -h(s)/(1 - cos s). This function tends to minus infinity at both ends of each period of the
    flight. Its largest maximum is in the first period, because the parabola nπ s - s²/2 is lowest
    in the first and the last period, and -X sin s lowers h in the outer half of the first one only.
    """
    x = float(saddle_node(n, r))

    def needed(s):
        return -(bounce_velocity(n) * s - s**2 / 2 - x * np.sin(s)) / (1 - np.cos(s))

    grid = 2 * np.pi * np.linspace(0, 1, 202)[1:-1]
    best = int(np.argmax(needed(grid)))
    bounds = (grid[max(best - 1, 0)], grid[min(best + 1, grid.size - 1)])
    minimum = minimize_scalar(
        lambda s: -needed(s), bounds=bounds, method="bounded", options={"xatol": 1e-12}
    )
    return -minimum.fun


def admissible(n: int, r: float, impact_height: Numbers) -> NDArray[np.bool_]:
    """Whether a ball can follow n-T orbits: their flights do not touch the table before its end.

    The margin is that of `is_stable`.
    """
    return np.asarray(impact_height) > grazing_height(n, r) + MARGIN


def flight_time(amplitude: float, time: float, velocity: float) -> float:
    """Duration of a flight that starts on the table at a time τ with a velocity (Eq. 5).

    The duration is the first positive zero of the height above the table. The search takes steps
    of at most 1/20 rad. If the height falls and rises again within a step, the search also
    evaluates its minimum.

    A ball without velocity relative to the table leaves it only if Λ sin τ >= 1. The table then
    falls at least as fast as the ball.

    Raises
    ------
    ValueError
        If an argument is not finite, the ball is slower than the table, or it stays on the table.
    """
    for name, value in (("Λ", amplitude), ("τ", time), ("velocity", velocity)):
        finite(name, value)
    start = amplitude * np.sin(time)
    relative = velocity - amplitude * np.cos(time)
    table = f"Λ cos τ = {amplitude * np.cos(time):g}, the velocity of the table"
    required("velocity", velocity, np.less(relative, -STICKING), f"at least {table}")
    rests = relative <= STICKING and start < 1 - STICKING
    required("velocity", velocity, rests, f"more than {table}: below Λ sin τ = 1 the ball rests")

    def gap(s):
        return start + velocity * s - s**2 / 2 - amplitude * np.sin(time + s)

    def gap_rate(s):
        return velocity - s - amplitude * np.cos(time + s)

    # The relative acceleration is at least -(1 + Λ), so the ball cannot land before this time.
    earliest = 2 * relative / (1 + amplitude)
    if relative <= STICKING:
        # The height above the table is (Λ sin τ - 1)s²/2 + Λ cos τ s³/6 + O(s⁴). If cos τ < 0, the
        # first two terms have a zero at a positive time: start the search at half of this time.
        slowing = max(-amplitude * np.cos(time), 0.0)
        earliest = min(0.01, 1.5 * (start - 1) / slowing) if slowing else 0.01
    # At this time the ball is at the lowest level of the table, -Λ.
    latest = velocity + np.sqrt(velocity**2 + 2 * (start + amplitude))
    grid = np.linspace(earliest, latest, 2 + int(20 * (latest - earliest)))
    rates = gap_rate(grid)
    dips = np.flatnonzero((rates[:-1] < 0) & (rates[1:] > 0))
    minima = [brentq(gap_rate, grid[i], grid[i + 1]) for i in dips]
    stops = np.sort(np.concatenate([grid, minima]))
    below = np.flatnonzero(gap(stops[1:]) <= 0)
    if gap(stops[0]) <= 0 or below.size == 0:
        # The zero is at an end of the search, where rounding errors decide the sign of the height.
        return float(stops[0] if below.size else stops[-1])
    return brentq(gap, stops[below[0]], stops[below[0] + 1], xtol=1e-14)


def impact_map(
    r: float, amplitude: float, time: float, velocity: float
) -> tuple[float, float, NDArray]:
    """Map an impact to the next impact (Eqs. 2 and 5).

    Parameters
    ----------
    r, amplitude : float
        Restitution coefficient and amplitude Λ.
    time, velocity : float
        Time τ of the impact, and velocity of the ball after it.

    Returns
    -------
    time, velocity : float
        Time of the next impact, and velocity of the ball after it.
    derivative : ndarray, shape (2, 2)
        Derivatives of the returned time (row 0) and velocity (row 1) with respect to the given time
        (column 0) and velocity (column 1).
    """
    duration = flight_time(amplitude, time, velocity)
    following = time + duration
    table_before = amplitude * np.cos(time)
    table_after = amplitude * np.cos(following)
    bounce = -coefficient(r) * (velocity - duration) + (1 + r) * table_after
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
    """Successive impacts of a ball.

    Attributes
    ----------
    time : ndarray, shape (impacts,)
        Times τ of the impacts.
    velocity : ndarray, shape (impacts,)
        Velocities of the ball after the impacts.
    growth : ndarray, shape (impacts - 1,)
        Logarithm of the factor by which a small deviation grows from one impact to the next. NaN if
        the ball sticks to the table between them.
    stickings : int
        Number of impacts after which the ball sticks to the table.
    """

    time: NDArray
    velocity: NDArray
    growth: NDArray
    stickings: int


def departure(amplitude: float, time: float) -> float:
    """Time at which a sticking ball leaves the table, for Λ > 1.

    The ball sticks to the table from the given time on. It leaves as soon as Λ sin τ >= 1, because
    the table then falls faster than the ball.
    """
    rising = np.arcsin(1 / amplitude)
    phase = np.mod(time, 2 * np.pi)
    if rising <= phase <= np.pi - rising:
        return time
    return time + np.mod(rising - phase, 2 * np.pi)


def iterate(r: float, amplitude: float, time: float, velocity: float, impacts: int) -> Impacts:
    """Follow a ball over a number of impacts.

    If the relative velocity after an impact is at most STICKING, the ball sticks to the table. It
    then moves with the table until the table falls faster than the ball. All deviations from the
    motion vanish while the ball sticks, so their growth is NaN.

    Parameters
    ----------
    r, amplitude : float
        Restitution coefficient and amplitude Λ.
    time, velocity : float
        Time τ of the first impact, and velocity of the ball after it.
    impacts : int
        Number of impacts, including the first.

    Raises
    ------
    ValueError
        If the ball comes to rest on a table with Λ <= 1 (Eq. 9), or an argument is wrong.
    """
    whole = np.greater_equal(impacts, 1) & (np.mod(impacts, 1) == 0)
    required("impacts", impacts, ~whole, "a whole number of impacts >= 1")
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
    """Numbers of impacts and of table periods after which a motion repeats, (0, 0) if it does not.

    The test uses the last quarter of the impacts. It requires that phase and velocity repeat within
    1e-9, and that the cycle fits twice into this quarter. A motion that tends to a stable orbit
    passes unless the orbit is close to a bifurcation.
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

    The first quarter of the impacts is discarded, and the rest is divided into blocks of `block`
    impacts. The exponent is the growth divided by the number of periods. Its standard error is the
    error of a ratio of means over blocks. Exponent and error are NaN if the ball sticks to the
    table after the first quarter.
    """
    blocks = 3 * path.growth.size // (4 * block)
    grown = path.growth[-blocks * block :].reshape(blocks, block).sum(axis=1)
    passed = np.diff(path.time[-blocks * block - 1 :: block]) / (2 * np.pi)
    exponent = grown.sum() / passed.sum()
    scatter = np.sum((grown - exponent * passed) ** 2) * blocks / (blocks - 1)
    return exponent, np.sqrt(scatter) / passed.sum()
