"""Balls over time, from impact to impact: simulation, and the calls ``simulate``, ``history`` and
``drop``.

A leg is a contact and the flight after it, from one impact to the next (:func:`next_impact`). The
first release and the first landing are certified (:mod:`bouncing_ball.numerics.first_zero`), so
that no event is passed over. All quantities are dimensionless, and times are in units of 1/Ω.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.datasets import CASE
from bouncing_ball.datasets.arguments import (
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
from bouncing_ball.errors import ModelError, require, suggesting
from bouncing_ball.models.flight import Flight, fly, table
from bouncing_ball.models.model import Departure, Model, Status, a_ball
from bouncing_ball.numerics.arrays import pick
from bouncing_ball.numerics.elementary import reduce_angle

# A single simulation of the command line needs no labels, and importing xarray takes longer: it is
# imported where results are labelled.
if TYPE_CHECKING:
    import xarray as xr

    from bouncing_ball.datasets.labelled import Grid
    from bouncing_ball.drawing.result import Result

# Largest number of impacts of a ball over time.
_MOST = 20_000
# Rounding may give a ball at rest on the table a small upward velocity.
_ROUNDING = 8 * np.finfo(float).eps


class Leg(NamedTuple):
    """From an impact to the next one: the release, the time from the first impact to the second,
    and the phase, δ and δ′ of the second.

    δ = 0 and δ′ ≤ 0 at an impact, except where a contact resumes at δ < 0. After a contact that
    never ends the state is NaN and the time infinite.
    """

    departure: Departure
    time: np.ndarray
    phase: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray


def next_impact(
    model: Model,
    phase: ArrayLike,
    velocity: ArrayLike,
    amplitude: ArrayLike,
    displacement: ArrayLike = 0.0,
) -> Leg:
    """The Poincaré map: contact and flight from an impact to the next one.

    Parameters
    ----------
    model : Model
    phase, velocity : array_like
        φ and δ′ at the impact.
    amplitude : array_like
        Λ.
    displacement : array_like
        δ at the impact; 0, unless a contact resumes.

    Returns
    -------
    Leg
        Arrays of the shape to which the model and the arguments broadcast.

    Raises
    ------
    ModelError
        If a flight is too long for floating-point numbers.

    Examples
    --------
    The map satisfies both lines of Eq. 5. The first impact, at τ₀ = 0.3, turns δ′ = -2 into 1:

    >>> from bouncing_ball import rigid
    >>> r, amplitude, start = 0.5, 1.2, 0.3
    >>> v = 1 + amplitude * np.cos(start)
    >>> after = next_impact(rigid(restitution=r), start, -2.0, amplitude)
    >>> s, end = after.time, start + after.time
    >>> landing = amplitude * (np.sin(end) - np.sin(start)) - (s * v - s**2 / 2)
    >>> bounced = -r * after.velocity + amplitude * np.cos(end)
    >>> expected = -r * (v - s) + (1 + r) * amplitude * np.cos(end)
    >>> bool(abs(landing) < 1e-14), bool(abs(bounced - expected) < 1e-14)
    (True, True)
    """
    given = [np.asarray(x, dtype=float) for x in (phase, velocity, amplitude, displacement)]
    shape = np.broadcast_shapes(model.shape, *(x.shape for x in given))
    start, closing, lam, gap = (np.broadcast_to(x, shape).reshape(-1) for x in given)
    row = model.flat(shape)
    departure = row.impact(start, closing, lam, gap)
    going = np.flatnonzero(departure.status == Status.BOUNCING)
    release = reduce_angle(start[going] + departure.duration[going])
    left = pick(departure, going)
    lag = pick(np.asarray(row.lag), going)
    landing = fly(release, left.displacement, left.velocity, lam[going], lag)
    found = np.full((4, start.size), np.nan)
    found[0] = np.inf
    found[:, going] = [
        left.duration + landing.time,
        reduce_angle(release + landing.time),
        landing.displacement,
        landing.velocity,
    ]
    shaped = Departure(*(values.reshape(shape)[()] for values in departure))
    return Leg(shaped, *(values.reshape(shape)[()] for values in found))


@dataclass(frozen=True, eq=False)
class ImpactSequence:
    """Impacts in order: arrays of shape (impacts, balls), NaN after a contact that does not end.

    An impact is the start of a contact. "Relative" means relative to the table.

    Parameters
    ----------
    model : Model
        A model for all balls, or a row with one for each.
    amplitude : ndarray, shape (balls,)
        Λ.
    status : ndarray of int, shape (balls,)
        What each ball does after its last impact, a :class:`.Status`.
    time, phase : ndarray
        Time of the impact since the first one, and the table's phase, in [-π, π].
    displacement, relative_velocity : ndarray
        δ and δ′ at the impact. δ = 0, except where a contact resumes below the table's level.
    contact_duration : ndarray
        Time until the ball leaves: 0 for an impact with a restitution coefficient unless the ball
        rests on the table, and infinite for permanent contact.
    release_displacement, relative_bounce_velocity : ndarray
        δ and δ′ when the ball leaves.
    """

    model: Model
    amplitude: np.ndarray
    status: np.ndarray
    time: np.ndarray
    phase: np.ndarray
    displacement: np.ndarray
    relative_velocity: np.ndarray
    contact_duration: np.ndarray
    release_displacement: np.ndarray
    relative_bounce_velocity: np.ndarray

    @property
    def impact_velocity(self) -> np.ndarray:
        """Absolute velocity z′_i of the ball at each impact, before it."""
        return self.relative_velocity + table(self.phase, self.amplitude)[0]

    @property
    def bounce_velocity(self) -> np.ndarray:
        """Absolute velocity z′_b of the ball at each release; NaN if the contact never ends."""
        lasts = np.where(np.isfinite(self.contact_duration), self.contact_duration, np.nan)
        return self.relative_bounce_velocity + table(self.phase + lasts, self.amplitude)[0]


def relative_velocities(
    phase: np.ndarray, velocity: np.ndarray, amplitude: np.ndarray
) -> np.ndarray:
    """δ′ ≤ 0 of first impacts with the absolute velocities z′_i.

    Raises
    ------
    ModelError
        If a ball rises from the table.

    Examples
    --------
    >>> relative_velocities(np.zeros(1), np.full(1, -3.0), np.full(1, 0.5)).tolist()
    [-3.5]
    """
    rate, _ = table(phase, amplitude)
    relative = velocity - rate
    rises = relative > _ROUNDING * (np.abs(velocity) + amplitude)
    if np.any(rises):
        k = int(np.argmax(rises))
        raise ModelError(
            "a ball that rises from the table has no impact: its velocity "
            f"z′ = {velocity[k]:g} is above that of the table, w′ = {rate[k]:g}"
        )
    return np.minimum(relative, 0.0)


def _impacts(
    model: Model, amplitude: np.ndarray, phase: np.ndarray, velocity: np.ndarray
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """The impacts of balls one after another: the columns of :class:`ImpactSequence` from ``time``
    on, shape (7, balls), and the status of the balls. There is no end to them unless no ball
    bounces any more.
    """
    balls = phase.size
    row = model.flat((balls,))
    status = np.full(balls, Status.BOUNCING)
    state = reduce_angle(phase), relative_velocities(phase, velocity, amplitude), np.zeros(balls)
    passed = np.zeros(balls)
    going = np.arange(balls)
    while going.size:
        start, closing, gap = state
        leg = next_impact(row.take(going), start, closing, amplitude[going], gap)
        columns = np.full((7, balls), np.nan)
        columns[:, going] = [passed, start, gap, closing, *leg.departure[:3]]
        status[going] = leg.departure.status
        yield columns, status
        on = leg.departure.status == Status.BOUNCING
        going = going[on]
        passed = (passed + leg.time)[on]
        state = leg.phase[on], leg.velocity[on], leg.displacement[on]


def impacts_of(
    model: Model, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike, impacts: int
) -> ImpactSequence:
    """The impacts of balls from a first impact on, the first included.

    Parameters
    ----------
    model : Model
        One model, or one for each ball.
    amplitude, phase, velocity : array_like
        Λ, and the table's phase φ and the absolute velocity z′_i just before the first impact; they
        broadcast to a row of balls.
    impacts : int
        Number of impacts. Balls that remain on the table have fewer.

    Raises
    ------
    ModelError
        If a ball rises from the table at first.

    Examples
    --------
    >>> from bouncing_ball import rigid
    >>> impacts_of(rigid(restitution=0.5), 0.0, 0.0, [-1.0, -2.0], 3).time.T.tolist()
    [[0.0, 1.0, 1.5], [0.0, 2.0, 3.0]]
    """
    starts = np.broadcast_arrays(*map(np.atleast_1d, (amplitude, phase, velocity)))
    lam, phi, speed = (x.astype(float) for x in starts)
    rows = islice(_impacts(model, lam, phi, speed), impacts)
    return _sequence(model, lam, rows, impacts)


def _sequence(
    model: Model, amplitude: np.ndarray, rows: Iterator[tuple[np.ndarray, np.ndarray]], count: int
) -> ImpactSequence:
    """The sequence of these impacts, with at least ``count`` rows; rows of NaN stand for none."""
    found = []
    status = np.zeros(amplitude.size, dtype=int)
    for columns, after in rows:
        found.append(columns)
        status = after
    missing = [np.full((7, amplitude.size), np.nan)] * (count - len(found))
    columns = np.stack(found + missing, axis=1)
    return ImpactSequence(model, amplitude, status, *columns)


def impacts_until(
    model: Model, amplitude: np.ndarray, phase: np.ndarray, velocity: np.ndarray, end: np.ndarray
) -> ImpactSequence:
    """The impacts of balls up to times since their first impacts, and the first one after each.

    The arguments are rows of one length; otherwise they are those of :func:`impacts_of`.

    Raises
    ------
    ModelError
        If a ball has too many impacts in this time, or rises from the table at first.
    """

    def until_the_end() -> Iterator[tuple[np.ndarray, np.ndarray]]:
        for count, (columns, status) in enumerate(_impacts(model, amplitude, phase, velocity)):
            if count == _MOST:
                raise ModelError(
                    f"a ball has more than {_MOST} impacts in this time: use fewer periods"
                )
            yield columns, status
            if np.all((status != Status.BOUNCING) | (columns[0] > end)):
                return

    return _sequence(model, amplitude, until_the_end(), 0)


class History(NamedTuple):
    """Height z and velocity z′ of a ball, height w of the table, and whether the ball touches the
    table, at each time. The ball's entries are NaN before the first impact, and after the last
    contact, because the end of the last flight is not known.
    """

    height: np.ndarray
    velocity: np.ndarray
    table: np.ndarray
    touching: np.ndarray


def motion_at(sequence: ImpactSequence, ball: int, time: np.ndarray) -> History:
    """The motion of one ball of a sequence at times since its first impact.

    Examples
    --------
    >>> from bouncing_ball import rigid
    >>> sequence = impacts_of(rigid(restitution=1.0), 0.0, 0.0, -2.0, 2)
    >>> motion_at(sequence, 0, np.array([0.0, 2.0, 4.0])).height.tolist()
    [0.0, 2.0, 0.0]
    """
    amplitude = sequence.amplitude[ball]
    began = sequence.time[:, ball]
    last = int(np.sum(np.isfinite(began))) - 1
    row = np.clip(np.searchsorted(began[: last + 1], time, side="right") - 1, 0, None)
    since = time - began[row]
    duration = sequence.contact_duration[row, ball]
    touching = (since >= 0) & (since <= duration)
    # The end of the last flight is not known.
    flying = (since > duration) & ((row < last) | (sequence.status[ball] != Status.BOUNCING))
    start = sequence.phase[row, ball]
    rate, height = table(start + since, amplitude)
    gap = np.full(time.shape, np.nan)
    speed = np.full(time.shape, np.nan)
    gap[touching], speed[touching] = sequence.model.take(ball).in_contact(
        since[touching],
        start[touching],
        sequence.relative_velocity[row, ball][touching],
        amplitude,
        sequence.displacement[row, ball][touching],
    )
    flight = Flight(
        start[flying] + duration[flying],
        sequence.release_displacement[row, ball][flying],
        sequence.relative_bounce_velocity[row, ball][flying],
        amplitude,
    )
    gap[flying], speed[flying], *_ = flight.gap(since[flying] - duration[flying])
    return History(gap + height, speed + rate, height, touching)


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
    >>> from bouncing_ball import rigid
    >>> found = simulate(rigid(restitution=0.5), amplitude=0.0, velocity=-4.0, impacts=3)
    >>> found.time.values.tolist(), found.status.item()
    ([0.0, 4.0, 6.0], 'bouncing')
    """
    from bouncing_ball.drawing.result import Result

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
    >>> from bouncing_ball import rigid
    >>> elastic = rigid(restitution=1.0)
    >>> found = history(elastic, amplitude=0.0, velocity=[-1.0, -2.0], periods=1.0, samples=4)
    >>> found.ball.dims, found.ball_velocity.isel(time=1).values + math.pi / 2
    (('velocity', 'time'), array([1., 2.]))
    """
    from bouncing_ball.drawing.result import Result

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

    >>> from bouncing_ball import rigid
    >>> found = drop(rigid(restitution=0.5), height=8.0, periods=1.0, samples=1000)
    >>> round(float(found.ball.where(found.time > 4.0).max()), 4)
    2.0
    """
    from bouncing_ball.drawing.result import Result

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
    from bouncing_ball.datasets.labelled import Grid

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
    from bouncing_ball.datasets.labelled import Grid

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

    from bouncing_ball.datasets.variables import Variable, describe

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

    from bouncing_ball.datasets.variables import describe

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
