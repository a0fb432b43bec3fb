"""Balls over time: from a first impact, or from the height at which they are dropped.

All quantities are dimensionless, and times are in units of 1/Ω. The axes of the arguments come
first in every result.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from bouncing_ball.datasets import CASE
from bouncing_ball.datasets.arguments import (
    AMPLITUDE,
    IMPACTS,
    PERIODS,
    POSITIVE,
    SAMPLES,
    START,
    AmplitudeAxis,
    Axis,
    Impacts,
    Periods,
    PositiveAxis,
    SampleCount,
    StartAxis,
    checked,
    checked_number,
    require_memory,
)
from bouncing_ball.errors import ModelError, require, suggesting
from bouncing_ball.models.flight import land, table
from bouncing_ball.models.model import Status
from bouncing_ball_beyond.models.ball import Ball
from bouncing_ball_beyond.models.flight import Flight
from bouncing_ball_beyond.models.given_ball import a_ball
from bouncing_ball_beyond.models.history import motion_at
from bouncing_ball_beyond.models.sequence import ImpactSequence

# A single simulation of the command line needs no labels, and importing xarray takes longer: it is
# imported where results are labelled.
if TYPE_CHECKING:
    from bouncing_ball.datasets.labelled import Grid
    from bouncing_ball_beyond.drawing.result import Result

# Number of impacts of a ball that are simulated at first, and the largest number allowed.
_FIRST, _MOST = 4, 65_536
# A ball on a table at rest whose velocity changes by less than this part from its first impacts to
# its last, in three intervals or more, has less than 0.2 intervals more or less in the largest
# number of impacts.
_LOSSLESS = 1e-10


class FirstImpacts(NamedTuple):
    """First impacts of a row of balls: Λ, the table's phase φ, and z′_i, each of shape (ball,)."""

    amplitude: np.ndarray
    phase: np.ndarray
    velocity: np.ndarray

    def model(self, ball: Ball, grid: Grid) -> Any:
        """The model of each ball, whose law may depend on the speed of its first impact."""
        speed = self.amplitude * np.cos(self.phase) - self.velocity
        return a_ball(ball).row(grid).at_speed(speed if grid.shape else float(speed[0]))


def first_impacts(
    ball: Ball, amplitude: AmplitudeAxis, phase: StartAxis, velocity: StartAxis
) -> tuple[Grid, FirstImpacts]:
    """The grid that Λ, the phases, the velocities and the ball span, and its first impacts.

    Raises
    ------
    ModelError
        If an argument is missing, of a wrong type or shape, or out of range.
    """
    grid = _grid(
        ball,
        amplitude=checked("amplitude", amplitude, AMPLITUDE),
        phase=checked("phase", phase, START),
        velocity=checked("velocity", velocity, START),
    )
    first = FirstImpacts(grid.row("amplitude"), grid.row("phase"), grid.row("velocity"))
    return grid, first


@suggesting
def simulate(
    ball: Ball,
    *,
    amplitude: AmplitudeAxis,
    phase: StartAxis = 0.0,
    velocity: StartAxis = -math.pi,
    impacts: Impacts = 100,
) -> Result:
    """The sequence of impacts that begins with a given first impact.

    Parameters
    ----------
    ball : Ball
    amplitude : float or array
        Excitation amplitude Λ.
    phase : float or array
        Phase of the table at the first impact.
    velocity : float or array
        Absolute velocity of the ball before the first impact.
    impacts : int
        Largest number of impacts.

    Returns
    -------
    Result
        ``time``, ``impact_phase``, ``impact_velocity``, ``contact_duration`` and
        ``bounce_velocity`` of each ``impact``, NaN after the last one; and the ``status`` of the
        ball after it. The last axis is ``impact``; each argument that is an array has an axis
        before it. The figure shows the phases and velocities of the impacts over time.

    Raises
    ------
    ModelError
        If a parameter is missing, of a wrong type or shape, or out of range, if the ball rises
        from the table at first, or if there are more impacts than fit into memory.

    Examples
    --------
    >>> from bouncing_ball_beyond import rigid
    >>> found = simulate(rigid(restitution=0.5), amplitude=0.0, velocity=-4.0, impacts=3)
    >>> found.time.values.tolist(), found.status.item()
    ([0.0, 4.0, 6.0], 'bouncing')
    """
    grid, first = first_impacts(ball, amplitude, phase, velocity)
    count = checked_number("impacts", impacts, IMPACTS)
    require_memory(count * grid.size, "states", "impacts or balls")
    return _labelled_impacts(grid, first.model(ball, grid).simulate(*first, count))


@suggesting
def history(
    ball: Ball,
    *,
    amplitude: AmplitudeAxis,
    phase: StartAxis = 0.0,
    velocity: StartAxis = -math.pi,
    periods: Periods = 10.0,
    samples: SampleCount = 200,
) -> Result:
    """A ball over time, from a first impact as in :func:`simulate`.

    Parameters
    ----------
    ball : Ball
    amplitude : float or array
        Excitation amplitude Λ.
    phase : float or array
        Phase of the table at the first impact.
    velocity : float or array
        Absolute velocity of the ball before the first impact.
    periods : float
        Number of periods 2π of the table.
    samples : int
        Number of samples in each period.

    Returns
    -------
    Result
        ``ball`` z, ``ball_velocity`` z′, ``table`` w and whether they are in ``contact``. The
        last axis is ``time``; each argument that is an array has an axis before it. The figure
        shows the heights over time.

    Raises
    ------
    ModelError
        If a parameter is missing, of a wrong type or shape, or out of range, or if a ball has too
        many impacts in this time.

    Examples
    --------
    >>> from bouncing_ball_beyond import rigid
    >>> elastic = rigid(restitution=1.0)
    >>> found = history(elastic, amplitude=0.0, velocity=[-1.0, -2.0], periods=1.0, samples=4)
    >>> found.ball.dims, found.ball_velocity.isel(time=1).values + math.pi / 2
    (('velocity', 'time'), array([1., 2.]))
    """
    grid, first = first_impacts(ball, amplitude, phase, velocity)
    length = checked_number("periods", periods, PERIODS)
    count = checked_number("samples", samples, SAMPLES)
    time = instants(length, count, grid.size)
    since = np.broadcast_to(time, (grid.size, time.size))
    return _labelled_history(grid, time, _at_times(first.model(ball, grid), first, since))


@suggesting
def drop(
    ball: Ball,
    *,
    height: PositiveAxis,
    amplitude: AmplitudeAxis = 0.0,
    phase: StartAxis = 0.0,
    periods: Periods = 10.0,
    samples: SampleCount = 200,
) -> Result:
    """A ball that is dropped at rest above a table, which does not move unless Λ is given.

    Parameters
    ----------
    ball : Ball
    height : float or array
        Height of the ball above the middle of the table's motion, in units of g/Ω².
    amplitude : float or array
        Excitation amplitude Λ.
    phase : float or array
        Phase of the table when the ball is dropped.
    periods : float
        Number of periods 2π of the table.
    samples : int
        Number of samples in each period.

    Returns
    -------
    Result
        As for :func:`history`; the time begins when the ball is dropped.

    Raises
    ------
    ModelError
        If a parameter is missing, of a wrong type or shape, or out of range, if the ball would be
        dropped below the table, or if it has too many impacts in this time.

    Examples
    --------
    From h a ball falls for √(2h), and rises to r²h:

    >>> from bouncing_ball_beyond import rigid
    >>> found = drop(rigid(restitution=0.5), height=8.0, periods=1.0, samples=1000)
    >>> round(float(found.ball.where(found.time > 4.0).max()), 4)
    2.0
    """
    start = checked("height", height, POSITIVE)
    lam = checked("amplitude", amplitude, AMPLITUDE)
    phi = checked("phase", phase, START)
    length = checked_number("periods", periods, PERIODS)
    count = checked_number("samples", samples, SAMPLES)
    grid = _grid(ball, height=start, amplitude=lam, phase=phi)
    time = instants(length, count, grid.size)
    found = _dropped(ball, grid, time)
    labelled = _labelled_history(grid, time, found)
    labelled.time.attrs["long_name"] = "time since the ball was let go"
    return labelled


def _grid(ball: Ball, **arguments: Axis) -> Grid:
    """The grid that the arguments of a call and the parameters of the ball span, in this order."""
    from bouncing_ball.datasets.labelled import Grid

    return Grid(**arguments, **a_ball(ball).parameters)


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
    require_memory(count * balls, "states", "samples or balls")
    return np.linspace(0.0, 2 * np.pi * periods, count)


def _dropped(ball: Ball, grid: Grid, time: np.ndarray) -> dict[str, np.ndarray]:
    """The variables of a history for balls at times since they were released at rest at the height
    h, with the (h, Λ, φ) of a grid.

    Raises
    ------
    ModelError
        If a ball is released below the table.
    """
    start = grid.row("height")
    lam = grid.row("amplitude")
    phi = grid.row("phase")
    rate, level = table(phi, lam)
    require(start >= level, start, "height", "at or above the table, Λ sin φ")
    flight = Flight(start - level, -rate, rate, level, lam)
    falling = land(flight, flight.earliest_landing()).time
    first = FirstImpacts(lam, phi + falling, -falling)
    since = time - falling[:, np.newaxis]
    found = _at_times(first.model(ball, grid), first, since)
    above = since < 0
    fallen = start[:, np.newaxis] - time * time / 2
    found["ball"] = np.where(above, fallen, found["ball"])
    found["ball_velocity"] = np.where(above, -time, found["ball_velocity"])
    _, found["table"] = table(first.phase[:, np.newaxis] + since, lam[:, np.newaxis])
    return found


def _at_times(model: Any, starts: FirstImpacts, time: np.ndarray) -> dict[str, np.ndarray]:
    """The variables of a history for balls at times (ball, sample) since their first
    impacts.
    """
    sequence = _until(model, starts, time[:, -1])
    balls = [motion_at(sequence[k], each) for k, each in enumerate(time)]
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


def _until(model: Any, starts: FirstImpacts, end: np.ndarray) -> ImpactSequence:
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


def _labelled_impacts(grid: Grid, sequence: ImpactSequence) -> Result:
    """Sequences of impacts with the axes of the grid, and a last axis "impact"."""
    import xarray as xr

    from bouncing_ball.datasets.variables import Variable, describe
    from bouncing_ball_beyond.drawing.result import Result

    status = [Status(number).name.lower().replace("_", " ") for number in sequence.status.tolist()]
    of_impacts = {
        "time": sequence.time,
        "impact_phase": sequence.phase,
        "impact_velocity": sequence.impact_velocity,
        "contact_duration": sequence.contact_duration,
        "bounce_velocity": sequence.bounce_velocity,
    }
    meanings = {
        "impact": Variable("number of the impact"),
        "impact_phase": Variable("phase of the table at the impact", symbol="φ", units="rad"),
        "status": Variable("what the ball does after the last of these impacts"),
    }
    rows = xr.Dataset({name: ((CASE, "impact"), value.T) for name, value in of_impacts.items()})
    described = describe(rows.assign(status=(CASE, status)), meanings)
    return Result.of(grid.unfold(described), "simulate")


def _labelled_history(grid: Grid, time: np.ndarray, found: dict[str, np.ndarray]) -> Result:
    """Balls and table with the axes of the grid, and a last axis "time"."""
    import xarray as xr

    from bouncing_ball.datasets.variables import describe
    from bouncing_ball_beyond.drawing.result import Result

    rows = {name: ((CASE, "time"), values) for name, values in found.items()}
    return Result.of(grid.unfold(describe(xr.Dataset(rows, {"time": time}))), "history")
