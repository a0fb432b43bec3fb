"""From the lift-off to the next sticking: the locked orbits of the restitution model.

After sticking, a ball of the restitution model always leaves in the state of the lift-off. Its
return to the table therefore follows from (Λ, r) alone, and the ball locks if it sticks again.
"""

from itertools import islice
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.long_run.recurrence import periods_in
from bouncing_ball.models.rigid import RestitutionModel


class Lap(NamedTuple):
    """Ways from the lift-off to the next sticking; 0 or NaN for a ball that does not stick again.

    All arrays have one shape. ``periods`` and ``impacts`` are the numbers of periods of the table
    and of impacts until the ball sticks, and ``wait`` is the time from the end of the chattering to
    the next lift-off. Where a deviation grows beyond the digits of a double on the way, rounding
    errors decide on all three.
    """

    periods: np.ndarray
    impacts: np.ndarray
    wait: np.ndarray


def laps(restitution: ArrayLike, amplitude: ArrayLike, impacts: int) -> Lap:
    """The laps of balls that lift off from a table with Λ > 1, within a number of impacts.

    Examples
    --------
    >>> laps([0.5, 0.6], [2.5, 3.0], 100).periods.tolist()
    [6, 13]
    """
    r, lam = np.broadcast_arrays(
        np.asarray(restitution, dtype=float), np.asarray(amplitude, dtype=float)
    )
    # A ball at rest on the table, at a phase at which the table presses on it.
    phase = np.full(r.shape, -np.pi / 2)
    velocity = np.zeros(r.shape)
    dynamics, state, shape = RestitutionModel(r).dynamics(lam).in_a_row(phase, velocity)
    found = Lap(
        periods=np.zeros(r.size, dtype=int),
        impacts=np.zeros(r.size, dtype=int),
        wait=np.full(r.size, np.nan),
    )
    lane = np.arange(r.size)
    # The time since the lift-off.
    time = np.zeros(r.size)
    legs = dynamics.legs(dynamics.start(*state), differentiate=True)
    for count, leg in enumerate(islice(legs, impacts)):
        departure = leg.departure
        sticks = departure.sticks
        if count and sticks.any():
            there = lane[sticks]
            found.periods[there] = periods_in((time + departure.duration)[sticks])
            found.impacts[there] = count
            found.wait[there] = (departure.duration - departure.settling)[sticks]
            left = np.flatnonzero(~sticks)
            lane, time = leg.keep(left, lane, time)
            if not left.size:
                break
        _, passed = leg.fly()
        # The first leg begins with the rest on the table.
        time = time + passed - (0 if count else leg.departure.duration)
    return Lap(*(x.reshape(shape) for x in found))
