"""From any state above the table to the first impact, the same in both models."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import ModelError
from bouncing_ball.motion.angles import reduce_angle, table
from bouncing_ball.motion.ensembles import flatten
from bouncing_ball.motion.landing import Flight, land


class Arrival(NamedTuple):
    """First impacts: time until it, table phase in [-π, π], and the velocity of the
    ball, absolute and relative to the table."""

    time: np.ndarray
    phase: np.ndarray
    velocity: np.ndarray
    relative_velocity: np.ndarray


def first_impact(
    amplitude: ArrayLike, phase: ArrayLike, height: ArrayLike, velocity: ArrayLike
) -> Arrival:
    """The first impact of balls in flight.

    Parameters
    ----------
    amplitude, phase : array_like
        Λ and the table's phase at the start.
    height, velocity : array_like
        Absolute z and z′ of the ball. On the table, z = Λ sin φ, a ball that
        does not rise is at its impact.

    Raises
    ------
    ModelError
        If a ball starts below the table.

    Examples
    --------
    Dropped from a height of 2 on a table at rest:

    >>> arrival = first_impact(0.0, 0.0, 2.0, 0.0)
    >>> float(arrival.time), float(arrival.velocity)
    (2.0, -2.0)
    """
    _, (lam, phase, height, velocity), shape = flatten([], [amplitude, phase, height, velocity])
    if not np.all(np.isfinite(lam) & np.isfinite(phase + height + velocity) & (lam >= 0)):
        raise ModelError("amplitude, phase, height and velocity must be finite, and Λ ≥ 0")
    x, y = table(phase, lam)
    gap, speed = height - y, velocity - x
    if not np.all(gap >= -4 * np.finfo(float).eps * (np.abs(height) + lam)):
        raise ModelError("a ball starts below the table: z < Λ sin φ")
    gap = np.maximum(gap, 0.0)
    flight = Flight(gap, speed, x, y, lam)
    down = (gap == 0) & (speed < 0)
    landing = land(flight, np.where(down, 0.0, flight.sure()))
    time = np.where(down, 0.0, landing.time)
    relative = np.where(down, speed, -landing.rate)
    end = reduce_angle(phase + time)
    out = (time, end, relative + table(end, lam)[0], relative)
    return Arrival(*(row.reshape(shape) for row in out))
