"""Labelled results of balls over time, computed on the grid of arguments.

All quantities are dimensionless, and times are in units of 1/Ω. The axes of the arguments come
first in every result.
"""

import math
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.calls.balls import Ball
from bouncing_ball.datasets import CASE
from bouncing_ball.datasets.labelled import Grid
from bouncing_ball.datasets.variables import Variable, describe
from bouncing_ball.drawing.result import Result
from bouncing_ball.errors import ModelError, require
from bouncing_ball.models.flight import Flight, land, table
from bouncing_ball.models.history import history as of_one_ball
from bouncing_ball.models.sequence import ImpactSequence, Status
from bouncing_ball.periodic.model import ImpactModel

_OF_SIMULATIONS = {
    "impact": Variable("number of the impact"),
    "impact_phase": Variable("phase of the table at the impact", symbol="φ", units="rad"),
    "status": Variable("what the ball does after the last of these impacts"),
}
# Number of impacts of a ball that are simulated at first, and the largest number allowed.
_FIRST, _MOST = 4, 65_536
# A ball on a table at rest whose velocity changes by less than this part from its first impacts to
# its last, in three intervals or more, has less than 0.2 intervals more or less in the largest
# number of impacts.
_LOSSLESS = 1e-10
# Largest number of states of all balls. A state takes about fifty bytes, and as much again while
# it is computed.
_STATES = 10_000_000


class _Starts(NamedTuple):
    """First impacts of a row of balls: Λ, the table's phase φ, and z′_i, each of shape (ball,)."""

    amplitude: np.ndarray
    phase: np.ndarray
    velocity: np.ndarray

    @classmethod
    def on(cls, grid: Grid) -> "_Starts":
        """The first impacts that are given by the arguments of a call."""
        return cls(grid.row("amplitude"), grid.row("phase"), grid.row("velocity"))

    def model(self, ball: Ball, grid: Grid) -> ImpactModel:
        """The model of each ball, whose law may depend on the speed of its first impact."""
        speed = self.amplitude * np.cos(self.phase) - self.velocity
        return ball.row(grid).at_speed(speed if grid.shape else float(speed[0])).model


def model_of_starts(ball: Ball, grid: Grid) -> ImpactModel:
    """The model of the balls that start with the impacts (Λ, φ, z′_i) of a grid."""
    return _Starts.on(grid).model(ball, grid)


def impacts_on_grid(ball: Ball, amplitude: Any, phase: Any, velocity: Any, impacts: int) -> Result:
    """Sequences of impacts from the first impacts (Λ, φ, z′_i) of a grid.

    Raises
    ------
    ModelError
        If a state is outside its range, or if a ball rises from the table.
    """
    grid = Grid(amplitude=amplitude, phase=phase, velocity=velocity, **ball.parameters)
    starts = _Starts.on(grid)
    sequence = starts.model(ball, grid).simulate(*starts, impacts)
    status = [Status(number).name.lower().replace("_", " ") for number in sequence.status.tolist()]
    of_impacts = {
        "time": sequence.time,
        "impact_phase": sequence.phase,
        "impact_velocity": sequence.impact_velocity,
        "contact_duration": sequence.contact_duration,
        "bounce_velocity": sequence.bounce_velocity,
    }
    rows = xr.Dataset({name: ((CASE, "impact"), value.T) for name, value in of_impacts.items()})
    described = describe(rows.assign(status=(CASE, status)), _OF_SIMULATIONS)
    return Result.of(grid.unfold(described), "simulate")


def history_on_grid(
    ball: Ball, amplitude: Any, phase: Any, velocity: Any, periods: float, samples: int
) -> Result:
    """Balls and table over time, from the first impacts (Λ, φ, z′_i) of a grid.

    ``ball``, ``ball_velocity``, ``table`` and ``contact`` are over (…, time).

    Raises
    ------
    ModelError
        If a ball has too many impacts in this time, or a parameter is outside its range.
    """
    grid = Grid(amplitude=amplitude, phase=phase, velocity=velocity, **ball.parameters)
    time = instants(periods, samples, grid.size)
    starts = _Starts.on(grid)
    since = np.broadcast_to(time, (grid.size, time.size))
    return _over_time(grid, time, _followed(starts.model(ball, grid), starts, since))


def drop_on_grid(
    ball: Ball, height: Any, amplitude: Any, phase: Any, periods: float, samples: int
) -> Result:
    """Balls and table over time since the balls were released at rest at the height h, with the
    (h, Λ, φ) of a grid.

    Raises
    ------
    ModelError
        If a ball is released below the table, or has too many impacts in this time.
    """
    grid = Grid(height=height, amplitude=amplitude, phase=phase, **ball.parameters)
    time = instants(periods, samples, grid.size)
    start = grid.row("height")
    lam = grid.row("amplitude")
    phi = grid.row("phase")
    rate, level = table(phi, lam)
    require(start >= level, start, "height", "at or above the table, Λ sin φ")
    flight = Flight(start - level, -rate, rate, level, lam)
    falling = land(flight, flight.earliest_landing()).time
    first = _Starts(lam, phi + falling, -falling)
    since = time - falling[:, np.newaxis]
    found = _followed(first.model(ball, grid), first, since)
    above = since < 0
    fallen = start[:, np.newaxis] - time * time / 2
    found["ball"] = np.where(above, fallen, found["ball"])
    found["ball_velocity"] = np.where(above, -time, found["ball_velocity"])
    found["table"] = table(first.phase[:, np.newaxis] + since, lam[:, np.newaxis])[1]
    dropped = _over_time(grid, time, found)
    dropped.time.attrs["long_name"] = "time since the ball was let go"
    return dropped


def instants(periods: float, samples: int, balls: int) -> np.ndarray:
    """Times over several periods of the table, with ``samples`` times in each period.

    Raises
    ------
    ModelError
        If the states of this many balls at all these times would fill the memory.

    Examples
    --------
    >>> (instants(1.0, 4, 1) / np.pi).tolist()
    [0.0, 0.5, 1.0, 1.5, 2.0]
    """
    count = math.ceil(periods * samples) + 1
    if count * balls > _STATES:
        raise ModelError(
            f"{count * balls} states exceed the limit of {_STATES}: use fewer samples or balls"
        )
    return np.linspace(0.0, 2 * np.pi * periods, count)


def _followed(model: ImpactModel, starts: _Starts, time: np.ndarray) -> dict[str, np.ndarray]:
    """The variables of a history for balls at times (ball, sample) since their first
    impacts.
    """
    sequence = _until(model, starts, time[:, -1])
    balls = [of_one_ball(sequence[k], each) for k, each in enumerate(time)]
    for one in balls:
        if np.any(one.touching & np.isnan(one.height)):
            raise ModelError(
                "a ball stays on its contact for longer than its motion is followed: use fewer "
                "periods, or a contact of more damping or less stiffness"
            )
    return {
        "ball": np.array([one.height for one in balls]),
        "ball_velocity": np.array([one.velocity for one in balls]),
        "table": np.array([one.table for one in balls]),
        "contact": np.array([one.touching for one in balls]),
    }


def _until(model: ImpactModel, starts: _Starts, end: np.ndarray) -> ImpactSequence:
    """The impacts of balls up to a time since their first impacts, shape (ball,).

    Raises
    ------
    ModelError
        If a ball has too many impacts in this time.
    """
    impacts = _FIRST
    while True:
        found = model.simulate(*starts, impacts)
        unfinished = (found.status == Status.BOUNCING) & (found.time[-1] <= end)
        if not np.any(unfinished):
            return found
        if impacts == _MOST or np.any(unfinished & _hops_on(found, end)):
            raise ModelError(
                f"a ball has more than {_MOST} impacts in this time: use fewer periods"
            )
        impacts *= 4


def _hops_on(found: ImpactSequence, end: np.ndarray) -> np.ndarray:
    """Which balls have more than the largest number of impacts up to a time, as is known for balls
    that lose no energy on a table at rest, shape (ball,).

    The next impact of a ball on such a table depends on the velocity of the last one alone. If the
    velocities are equal, so are all intervals.
    """
    first = found.relative_velocity[0]
    lossless = np.abs(found.relative_velocity[-1] - first) < _LOSSLESS * np.abs(first)
    interval = found.time[-1] / (len(found.time) - 1)
    return (found.amplitude == 0) & lossless & (end > (_MOST + 1) * interval)


def _over_time(grid: Grid, time: np.ndarray, found: dict[str, np.ndarray]) -> Result:
    rows = {name: ((CASE, "time"), values) for name, values in found.items()}
    return Result.of(grid.unfold(describe(xr.Dataset(rows, {"time": time}))), "history")
