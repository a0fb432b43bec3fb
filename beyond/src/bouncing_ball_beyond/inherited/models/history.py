"""Balls over time: the calls ``simulate``, ``history`` and ``drop``.

All quantities are dimensionless, and times are in units of 1/Ω.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from bouncing_ball_beyond.inherited.datasets import CASE
from bouncing_ball_beyond.inherited.datasets.arguments import (
    AMPLITUDE,
    IMPACTS,
    PERIODS,
    POSITIVE,
    SAMPLES,
    START,
    AmplitudeAxis,
    Impacts,
    Periods,
    PositiveAxis,
    SampleCount,
    StartAxis,
    checked,
    checked_number,
    require_memory,
)
from bouncing_ball_beyond.inherited.errors import ModelError, require, suggesting
from bouncing_ball_beyond.inherited.models.flight import fly, table
from bouncing_ball_beyond.inherited.models.model import Model, Status, a_ball
from bouncing_ball_beyond.inherited.models.simulation import impacts_of, impacts_until, motion_at

# A single simulation of the command line needs no labels, and importing xarray takes longer: it is
# imported where results are labelled.
if TYPE_CHECKING:
    import xarray as xr

    from bouncing_ball_beyond.inherited.datasets.labelled import Grid
    from bouncing_ball_beyond.inherited.drawing.result import Result


@suggesting
def simulate(
    ball: Model,
    *,
    amplitude: AmplitudeAxis,
    phase: StartAxis = 0.0,
    velocity: StartAxis = -math.pi,
    impacts: Impacts = 100,
) -> Result:
    """The sequence of impacts that begins with a given first impact.

    Parameters
    ----------
    ball : Model
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
    >>> from bouncing_ball_beyond.inherited import rigid
    >>> found = simulate(rigid(restitution=0.5), amplitude=0.0, velocity=-4.0, impacts=3)
    >>> found.time.values.tolist(), found.status.item()
    ([0.0, 4.0, 6.0], 'bouncing')
    """
    from bouncing_ball_beyond.inherited.drawing.result import Result

    grid, starts = first_impacts(a_ball(ball).parameters, amplitude, phase, velocity)
    count = checked_number("impacts", impacts, IMPACTS)
    require_memory(count * grid.size, "states", "impacts or balls")
    sequence = impacts_of(ball.row(grid), *starts, count)
    return Result.of(dataset_of_impacts(grid, sequence), "simulate")


@suggesting
def history(
    ball: Model,
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
    ball : Model
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
    >>> from bouncing_ball_beyond.inherited import rigid
    >>> elastic = rigid(restitution=1.0)
    >>> found = history(elastic, amplitude=0.0, velocity=[-1.0, -2.0], periods=1.0, samples=4)
    >>> found.ball.dims, found.ball_velocity.isel(time=1).values + math.pi / 2
    (('velocity', 'time'), array([1., 2.]))
    """
    from bouncing_ball_beyond.inherited.drawing.result import Result

    grid, starts = first_impacts(a_ball(ball).parameters, amplitude, phase, velocity)
    time = instants(periods, samples, grid.size)
    since = np.broadcast_to(time, (grid.size, time.size))
    found = _at_times(ball.row(grid), starts, since)
    return Result.of(dataset_of_history(grid, time, found), "history")


@suggesting
def drop(
    ball: Model,
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
    ball : Model
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

    >>> from bouncing_ball_beyond.inherited import rigid
    >>> found = drop(rigid(restitution=0.5), height=8.0, periods=1.0, samples=1000)
    >>> round(float(found.ball.where(found.time > 4.0).max()), 4)
    2.0
    """
    from bouncing_ball_beyond.inherited.drawing.result import Result

    grid, falling, starts = first_falls(a_ball(ball).parameters, height, amplitude, phase)
    time = instants(periods, samples, grid.size)
    since = time - falling[:, np.newaxis]
    found = _at_times(ball.row(grid), starts, since)
    return Result.of(dataset_of_drop(grid, time, since, found), "history")


Starts = tuple[np.ndarray, np.ndarray, np.ndarray]
"""First impacts of a row of balls: Λ, the table's phase φ, and z′_i, each of shape (ball,)."""


def first_impacts(
    parameters: Mapping[str, Any], amplitude: AmplitudeAxis, phase: StartAxis, velocity: StartAxis
) -> tuple[Grid, Starts]:
    """The grid of the arguments and of the parameters of a ball, and the first impacts.

    Raises
    ------
    ModelError
        If an argument is missing, of a wrong type or shape, or out of range.
    """
    from bouncing_ball_beyond.inherited.datasets.labelled import Grid

    grid = Grid(
        amplitude=checked("amplitude", amplitude, AMPLITUDE),
        phase=checked("phase", phase, START),
        velocity=checked("velocity", velocity, START),
        **parameters,
    )
    return grid, (grid.row("amplitude"), grid.row("phase"), grid.row("velocity"))


def first_falls(
    parameters: Mapping[str, Any], height: PositiveAxis, amplitude: AmplitudeAxis, phase: StartAxis
) -> tuple[Grid, np.ndarray, Starts]:
    """The grid of the arguments and of the parameters of a ball that is dropped at rest, the times
    that it falls, and the first impacts.

    Raises
    ------
    ModelError
        If an argument is missing, of a wrong type or shape, or out of range, or if a ball would be
        dropped below the table.
    """
    from bouncing_ball_beyond.inherited.datasets.labelled import Grid

    grid = Grid(
        height=checked("height", height, POSITIVE),
        amplitude=checked("amplitude", amplitude, AMPLITUDE),
        phase=checked("phase", phase, START),
        **parameters,
    )
    start, lam, phi = (grid.row(name) for name in ("height", "amplitude", "phase"))
    rate, level = table(phi, lam)
    require(start >= level, start, "height", "at or above the table, Λ sin φ")
    falling = fly(phi, start - level, -rate, lam).time
    return grid, falling, (lam, phi + falling, -falling)


def instants(periods: Any, samples: Any, balls: int) -> np.ndarray:
    """Times over several periods of the table, with ``samples`` times in each period.

    Raises
    ------
    ModelError
        If an argument is out of range, or if the states of this many balls at all these times would
        fill the memory.

    Examples
    --------
    >>> (instants(1.0, 4, 1) / np.pi).tolist()
    [0.0, 0.5, 1.0, 1.5, 2.0]
    """
    length = checked_number("periods", periods, PERIODS)
    count = math.ceil(length * checked_number("samples", samples, SAMPLES)) + 1
    require_memory(count * balls, "states", "samples or balls")
    return np.linspace(0.0, 2 * np.pi * length, count)


def _at_times(model: Model, starts: Starts, time: np.ndarray) -> dict[str, np.ndarray]:
    """The variables of a history for balls at times (ball, sample) since their first impacts."""
    sequence = impacts_until(model, *starts, time[:, -1])
    if np.any(sequence.status == Status.UNDECIDED):
        raise ModelError(
            "a ball stays on its contact for longer than its motion is followed: use fewer "
            "periods, or a contact of more damping or less stiffness"
        )
    return columns_of([motion_at(sequence, k, each) for k, each in enumerate(time)])


def columns_of(balls: Sequence[Any]) -> dict[str, np.ndarray]:
    """The variables of the histories of several balls, as that of a :class:`History` each."""
    return {
        "ball": np.array([one.height for one in balls]),
        "ball_velocity": np.array([one.velocity for one in balls]),
        "table": np.array([one.table for one in balls]),
        "contact": np.array([one.touching for one in balls]),
    }


def dataset_of_impacts(grid: Grid, sequence: Any) -> xr.Dataset:
    """The impacts of an :class:`ImpactSequence` with the axes of the grid, and a last axis
    "impact".
    """
    import xarray as xr

    from bouncing_ball_beyond.inherited.datasets.variables import Variable, describe

    status = [Status(number).words for number in sequence.status.tolist()]
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
    return grid.unfold(describe(rows.assign(status=(CASE, status)), meanings))


def dataset_of_history(grid: Grid, time: np.ndarray, found: Mapping[str, np.ndarray]) -> xr.Dataset:
    """Balls and table with the axes of the grid, and a last axis "time"."""
    import xarray as xr

    from bouncing_ball_beyond.inherited.datasets.variables import describe

    rows = {name: ((CASE, "time"), values) for name, values in found.items()}
    return grid.unfold(describe(xr.Dataset(rows, {"time": time})))


def dataset_of_drop(
    grid: Grid, time: np.ndarray, since: np.ndarray, found: dict[str, np.ndarray]
) -> xr.Dataset:
    """The history of balls that fall from the heights of a grid until ``since``, the time since
    their first impacts, is 0.
    """
    above = since < 0
    fallen = grid.row("height")[:, np.newaxis] - time * time / 2
    found["ball"] = np.where(above, fallen, found["ball"])
    found["ball_velocity"] = np.where(above, -time, found["ball_velocity"])
    whole = dataset_of_history(grid, time, found)
    whole.time.attrs["long_name"] = "time since the ball was let go"
    return whole
