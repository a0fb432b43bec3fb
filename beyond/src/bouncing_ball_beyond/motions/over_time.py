"""Balls over time: from a first impact, or from the height at which they are dropped.

All quantities are dimensionless, and times are in units of 1/Ω. The axes of the arguments come
first in every result.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.datasets.arguments import (
    AMPLITUDE,
    IMPACTS,
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
from bouncing_ball_beyond.inherited.errors import ModelError, ParameterError, suggesting
from bouncing_ball_beyond.inherited.models import history as root
from bouncing_ball_beyond.inherited.models.flight import table
from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.models.ball import Ball
from bouncing_ball_beyond.models.docstrings import as_in
from bouncing_ball_beyond.models.given_ball import a_ball
from bouncing_ball_beyond.models.history import motion_at
from bouncing_ball_beyond.models.sequence import ImpactSequence

# A single simulation of the command line needs no labels, and importing xarray takes longer: it is
# imported where results are labelled.
if TYPE_CHECKING:
    from bouncing_ball_beyond.drawing.result import Result
    from bouncing_ball_beyond.inherited.datasets.labelled import Grid

# Number of impacts of a ball that are simulated at first, and the largest number allowed.
_FIRST, _MOST = 4, 65_536
# A ball on a table at rest whose velocity changes by less than this part from its first impacts to
# its last, in three intervals or more, has less than 0.2 intervals more or less in the largest
# number of impacts.
_LOSSLESS = 1e-10


VELOCITY = -math.pi
"""The default of the absolute velocity before the first impact: that of the 1-T orbit of the
restitution model."""


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
    ball: Ball,
    amplitude: AmplitudeAxis,
    phase: StartAxis,
    velocity: StartAxis,
    relative_velocity: StartAxis | None = None,
) -> tuple[Grid, FirstImpacts]:
    """The grid that Λ, the phases, the velocities and the ball span, and its first impacts.

    The velocities are relative to the table if ``relative_velocity`` is given.

    Raises
    ------
    ModelError
        If an argument is missing, of a wrong type or shape, or out of range, or if both velocities
        are given.
    """
    parameters = a_ball(ball).parameters
    if relative_velocity is None:
        grid, starts = root.first_impacts(parameters, amplitude, phase, velocity)
        return grid, FirstImpacts(*starts)
    if velocity is not VELOCITY:
        raise ParameterError("argument {relative_velocity}: not allowed with argument {velocity}")
    from bouncing_ball_beyond.inherited.datasets.labelled import Grid

    grid = Grid(
        amplitude=checked("amplitude", amplitude, AMPLITUDE),
        phase=checked("phase", phase, START),
        relative_velocity=checked("relative_velocity", relative_velocity, START),
        **parameters,
    )
    lam, phi, relative = (grid.row(name) for name in ("amplitude", "phase", "relative_velocity"))
    return grid, FirstImpacts(lam, phi, table(phi, lam)[0] + relative)


@suggesting
@as_in(root.simulate)
def simulate(
    ball: Ball,
    *,
    amplitude: AmplitudeAxis,
    phase: StartAxis = 0.0,
    velocity: StartAxis = VELOCITY,
    relative_velocity: StartAxis | None = None,
    impacts: Impacts = 100,
) -> Result:
    """The sequence of impacts of a ball of any model that begins with a given first impact.

    Parameters
    ----------
    ball : Ball
    relative_velocity : float or array, optional
        δ′ = z′ - w′ ≤ 0 before the first impact, the velocity relative to the table, in place of
        the absolute velocity.

    Examples
    --------
    >>> from bouncing_ball_beyond import corrected, spring_damper
    >>> ball = corrected(spring_damper(restitution=0.5, frequency_ratio=100.0))
    >>> found = simulate(ball, amplitude=0.0, velocity=-4.0, impacts=3)
    >>> found.time.values.round(2).tolist(), found.status.item()
    ([0.0, 4.02, 6.03], 'bouncing')
    """
    from bouncing_ball_beyond.drawing.result import Result

    grid, first = first_impacts(ball, amplitude, phase, velocity, relative_velocity)
    count = checked_number("impacts", impacts, IMPACTS)
    require_memory(count * grid.size, "states", "impacts or balls")
    sequence = first.model(ball, grid).simulate(*first, count)
    return Result.of(root.dataset_of_impacts(grid, sequence), "simulate")


@suggesting
@as_in(root.history, simulate)
def history(
    ball: Ball,
    *,
    amplitude: AmplitudeAxis,
    phase: StartAxis = 0.0,
    velocity: StartAxis = VELOCITY,
    relative_velocity: StartAxis | None = None,
    periods: Periods = 10.0,
    samples: SampleCount = 200,
) -> Result:
    """A ball of any model over time, from a first impact as in :func:`simulate`.

    Parameters
    ----------
    ball : Ball
    """
    from bouncing_ball_beyond.drawing.result import Result

    grid, first = first_impacts(ball, amplitude, phase, velocity, relative_velocity)
    time = root.instants(periods, samples, grid.size)
    since = np.broadcast_to(time, (grid.size, time.size))
    found = _at_times(first.model(ball, grid), first, since)
    return Result.of(root.dataset_of_history(grid, time, found), "history")


@suggesting
@as_in(root.drop)
def drop(
    ball: Ball,
    *,
    height: PositiveAxis,
    amplitude: AmplitudeAxis = 0.0,
    phase: StartAxis = 0.0,
    periods: Periods = 10.0,
    samples: SampleCount = 200,
) -> Result:
    """A ball of any model that is dropped at rest above a table, which does not move unless Λ is
    given.

    Parameters
    ----------
    ball : Ball
    """
    from bouncing_ball_beyond.drawing.result import Result

    grid, falling, starts = root.first_falls(a_ball(ball).parameters, height, amplitude, phase)
    time = root.instants(periods, samples, grid.size)
    first = FirstImpacts(*starts)
    since = time - falling[:, np.newaxis]
    found = _at_times(first.model(ball, grid), first, since)
    return Result.of(root.dataset_of_drop(grid, time, since, found), "history")


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
    return root.columns_of(balls)


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
