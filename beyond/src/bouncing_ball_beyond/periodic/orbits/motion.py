"""The motion of a ball on a periodic orbit, in contact and in flight, and its highest point.

Heights and velocities are absolute, and times count from an impact.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.numerics.arrays import blocks
from bouncing_ball_beyond.periodic.orbits.highest import about_highest
from bouncing_ball_beyond.periodic.orbits.impacts import (
    OrbitImpacts,
    bounces,
    flights,
    intervals,
    number_or_row,
    of_existing,
    table_amplitude,
)

# The highest point of a contact is searched in so many rounds of so many samples. The last steps
# are 16⁻⁵ of the first, and the error of the height is of the order of the square of the last step.
_SAMPLES = 33
_ROUNDS = 6
_EPS = np.finfo(float).eps
# Number of orbits whose samples are in memory at the same time.
_BLOCK = 1024


def release_heights(orbit: OrbitImpacts) -> np.ndarray:
    """Heights at release, which follow from the flights to the next impacts, shape (..., k)."""
    landing = table_amplitude(orbit) * np.sin(np.roll(orbit.phases, -1, axis=-1))
    landing = landing + of_existing(orbit, _landing_gap, orbit.impacts)
    mean_velocity = (bounces(orbit) + np.roll(orbit.velocities, -1, axis=-1)) / 2
    return landing - mean_velocity * flights(orbit)


def _landing_gap(orbit: OrbitImpacts) -> np.ndarray:
    """δ of the flights at the impacts with which they end, shape (..., k)."""
    dynamics, impact = orbit.starts
    gap = dynamics.section().gap(impact).reshape(*orbit.shape, orbit.impacts)
    return np.roll(gap, -1, axis=-1)


def max_height(orbit: OrbitImpacts) -> Any:
    """Greatest height over the orbit: the apex of the highest flight, unless the table lifts the
    ball higher during a long contact.
    """
    rising = np.maximum(bounces(orbit), 0.0)
    apex = np.max(release_heights(orbit) + rising * rising / 2, axis=-1)
    top = np.array(np.broadcast_to(apex, orbit.shape))
    lasting = np.any(orbit.durations > 0, axis=-1)
    low = np.flatnonzero((top < orbit.amplitude) & lasting)
    # The samples of all orbits at once would take gigabytes.
    for part in blocks(low.size, _BLOCK):
        lifted = _top_of_contacts(orbit.flat(orbit.shape).take(low[part]))
        top.flat[low[part]] = np.maximum(top.flat[low[part]], lifted)
    return number_or_row(top)


def _top_of_contacts(orbit: OrbitImpacts) -> np.ndarray:
    """Greatest height in the contacts of each orbit."""

    def height(since: np.ndarray) -> np.ndarray:
        gap, _ = in_contacts(orbit, since)
        return gap + table_amplitude(orbit) * np.sin(orbit.phases + since)

    heights, *_ = about_highest(height, 0.0 * orbit.durations, orbit.durations, _SAMPLES, _ROUNDS)
    return np.max(heights, axis=(0, -1))


def in_contacts(orbit: OrbitImpacts, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """δ and δ′ at times since the starts of all contacts, shape (..., orbits, k)."""
    problem, y = orbit.own_equations
    legs = problem.legs(y)
    flat = time.reshape(-1, orbit.size * orbit.impacts)
    found = legs.dynamics.within(legs.impact, legs.departure, flat)
    displacement, velocity = (x.reshape(time.shape) for x in found)
    return displacement, velocity


def contact_motion(orbit: OrbitImpacts, time: ArrayLike, impact: int = 0) -> tuple[Any, Any]:
    """δ and δ′ at times 0 ≤ s ≤ τ_b in the contact of one impact, NaN at other times.

    The results have the shape to which the times and the orbits broadcast; they are floats for
    one orbit at one time.
    """
    s = np.asarray(time, dtype=float)
    shape = np.broadcast_shapes(s.shape, orbit.shape)
    each = np.broadcast_to(s, shape).reshape(-1, orbit.size)
    found = np.full((2, *each.shape), np.nan)
    which = np.flatnonzero(np.broadcast_to(orbit.exists, orbit.shape))
    if which.size:
        row = orbit if which.size == orbit.size else orbit.flat(orbit.shape).take(which)
        problem, y = row.own_equations
        legs = problem.legs(y)
        number = np.arange(row.size) * orbit.impacts + impact
        dynamics, start, departure = legs.dynamics.kept(number, legs.impact, legs.departure)
        found[..., which] = dynamics.within(start, departure, each[:, which])
    # A time may be the duration up to rounding.
    last = orbit.durations[..., impact] * (1 + 8 * _EPS)
    inside = (s >= 0) & (s <= last)
    displacement, velocity = np.where(inside, found.reshape(2, *shape), np.nan)
    return number_or_row(displacement), number_or_row(velocity)


def contact_path(orbit: OrbitImpacts, time: ArrayLike, impact: int = 0) -> tuple[Any, Any]:
    """Height z and velocity z′ at times 0 ≤ s ≤ τ_b in the contact of one impact."""
    displacement, velocity = contact_motion(orbit, time, impact)
    phase = orbit.phases[..., impact] + np.asarray(time)
    height = displacement + orbit.amplitude * np.sin(phase)
    speed = velocity + orbit.amplitude * np.cos(phase)
    return number_or_row(height), number_or_row(speed)


def flight_path(orbit: OrbitImpacts, time: ArrayLike, impact: int = 0) -> tuple[Any, Any]:
    """Height and velocity in the flight after one impact, from which the time τ is counted.

    In the paper, with the release at τ_b and the bouncing-off velocity z′_b ::

        z  = -(τ - τ_b)²/2 + (τ - τ_b) z′_b + Λ sin(τ_b + φ)    (14)
        z′ = -(τ - τ_b) + z′_b                                  (15)
    """
    s = np.asarray(time) - orbit.durations[..., impact]
    bounce = bounces(orbit)[..., impact]
    velocity = bounce - s
    height = release_heights(orbit)[..., impact] + (bounce + velocity) / 2 * s
    return number_or_row(height), number_or_row(velocity)


def path(orbit: OrbitImpacts, time: ArrayLike) -> tuple[Any, Any]:
    """Absolute height and velocity at any time since the first impact, with period 2πm.

    The shape is that to which the times and the orbits broadcast; both are floats for one
    orbit at one time. At the time of an impact without duration, the velocity is that after
    the impact.
    """
    t = np.mod(np.asarray(time, dtype=float), 2 * np.pi * np.asarray(orbit.periods))
    lasts = intervals(orbit)
    passed = np.cumsum(lasts, axis=-1)
    height = np.zeros(np.broadcast_shapes(t.shape, orbit.shape))
    velocity = np.zeros_like(height)
    for k in range(orbit.impacts):
        begun = passed[..., k] - lasts[..., k]
        s = t - begun
        duration = orbit.durations[..., k]
        here = (t >= begun) & (t < passed[..., k]) if orbit.impacts > 1 else True
        touching = s < duration
        inside = contact_path(orbit, np.where(touching & here, s, 0.0), k)
        outside = flight_path(orbit, np.where(touching, duration, s), k)
        height = np.where(here, np.where(touching, inside[0], outside[0]), height)
        velocity = np.where(here, np.where(touching, inside[1], outside[1]), velocity)
    return number_or_row(height), number_or_row(velocity)


def touches(orbit: OrbitImpacts, time: ArrayLike) -> Any:
    """Whether the ball is in contact at times since the first impact, as :func:`path`."""
    t = np.mod(np.asarray(time, dtype=float), 2 * np.pi * np.asarray(orbit.periods))
    lasts = intervals(orbit)
    since = t[..., np.newaxis] - (np.cumsum(lasts, axis=-1) - lasts)
    return number_or_row(np.any((since >= 0) & (since <= orbit.durations), axis=-1))
