"""Simulate balls: compute their impacts or their heights over time, as labelled datasets."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from bouncing_ball_beyond.contacts.balls import Ball, check_ball, checked, one_number, whole_number
from bouncing_ball_beyond.contacts.one_ball import COLUMNS, EPS
from bouncing_ball_beyond.motions.bounces import Balls, Leaving, bounce, fly, reduced
from bouncing_ball_beyond.tables.table import PERIOD, SINE, Table, Values, check_table

AT_ONCE = 32
"""Number of impacts that :func:`history` computes before it checks whether the time is over.

At half: no effect. At twice: 40 % slower.
"""

MOST_IMPACTS = 1_000_000
"""Maximum number of impacts of a ball in :func:`history`. More impacts raise a ValueError."""


def axis(name: str, value: Any, dim: str | None = None) -> xr.DataArray:
    """Return an argument as a labelled array. A list becomes an axis with the argument's name."""
    given = value.values if isinstance(value, xr.DataArray) else value
    numbers = checked(name, given, -np.inf, np.inf, low_allowed=False)
    if given is not value:
        return value.copy(data=numbers)
    if np.ndim(numbers) > 1:
        raise ValueError(f"{name}: must be a number, a list of numbers, or an xarray.DataArray")
    dims = [dim or name] * np.ndim(numbers)
    return xr.DataArray(numbers, {name: (dims, numbers)} if dims else {}, dims)


def grid_of(ball: Ball, **values: Any) -> tuple[xr.DataArray, Ball, list[NDArray]]:
    """Span a grid with array arguments and array parameters of a ball.

    One argument must be ``amplitude``. Array parameters of the ball share one axis. The axis has
    the name of the parameter, or "ball" if several parameters are arrays.

    Returns

    1. an array with the axes of the grid;
    2. the ball, with parameters for each point of the grid in one row;
    3. the values of the arguments at each point.
    """
    check_ball(ball)
    rows = {name: value for name, value in ball.parameters.items() if np.ndim(value)}
    dim = "ball" if len(rows) > 1 else None
    arrays = [axis(name, value) for name, value in values.items()]
    arrays += [axis(name, value, dim) for name, value in rows.items()]
    every = xr.broadcast(*xr.align(*arrays, join="exact"))
    flat = [array.values.ravel() for array in every]
    amplitude = flat[list(values).index("amplitude")]
    if (amplitude < 0).any():
        raise ValueError(f"amplitude = {amplitude.min():g}: must be at least 0")
    if rows:
        ball = ball.at(**dict(zip(rows, flat[len(values) :], strict=True)))
    grid = every[0].assign_coords(xr.merge(array.coords for array in arrays).coords)
    return grid, ball, flat[: len(values)]


def first_impacts(
    ball: Ball,
    amplitude: Values,
    phase: Values,
    velocity: Values,
    relative_velocity: Values,
    table: Table = SINE,
) -> tuple[xr.DataArray, Balls]:
    """Return the grid of the first impacts of :func:`simulate`, and the balls before them."""
    check_table(table)
    absolute = relative_velocity is None
    if not absolute and velocity is not None:
        raise ValueError("velocity, relative_velocity: give at most one of them")
    velocity = -np.pi if velocity is None else velocity
    name = "velocity" if absolute else "relative_velocity"
    given = {name: velocity if absolute else relative_velocity}
    grid, ball, (amplitude, phase, value) = grid_of(ball, amplitude=amplitude, phase=phase, **given)
    speed = amplitude * table(phase, 1) * absolute - value
    if (speed < 0).any():
        raise ValueError(
            f"{name} = {value[np.argmin(speed)]:g}: the ball rises from the table at a relative"
            f" velocity of {-speed.min():g}, but must approach it"
        )
    return grid, Balls(ball, amplitude, *reduced(phase), speed, table)


DESCRIPTIONS = {
    "time": ("time since the start", "τ", "1"),
    "impact_phase": ("phase of the table at the impact", "φ", "rad"),
    "impact_velocity": ("velocity of the ball before the impact", "z′", "1"),
    "relative_impact_velocity": ("velocity relative to the table before the impact", "δ′", "1"),
    "contact_duration": ("duration of the contact, or of the rest on the table", "D", "1"),
    "bounce_velocity": ("velocity of the ball after the impact", "z′", "1"),
    "relative_bounce_velocity": ("velocity relative to the table after the impact", "δ′", "1"),
    "flight_time": ("time of flight after the impact", "", "1"),
    "status": ("what the ball does after the last impact", "", "1"),
    "ball": ("height of the ball", "z", "1"),
    "ball_velocity": ("velocity of the ball", "z′", "1"),
    "table": ("height of the table", "w", "1"),
    "contact": ("whether the ball touches the table", "", "1"),
    "impact": ("number of the impact", "", "1"),
    "amplitude": ("amplitude of the table", "Λ", "1"),
    "phase": ("phase of the table at the first impact", "φ", "rad"),
    "velocity": ("velocity of the ball before the first impact", "z′", "1"),
    "relative_velocity": ("velocity relative to the table before the first impact", "δ′", "1"),
    "height": ("height from which the ball is dropped", "h", "1"),
    "restitution": ("restitution coefficient", "r", "1"),
    "frequency_ratio": ("frequency ratio", "ϖ", "1"),
    "damping_ratio": ("damping ratio", "ζ", "1"),
}
"""Long name, symbol and unit of variables of datasets. All times are Ωt and all lengths Ω²y/g."""


def dataset(
    grid: xr.DataArray, variables: dict, descriptions: Mapping, **coordinates: Any
) -> xr.Dataset:
    """Return values over the points of a grid as a labelled dataset.

    The first axis of each of the ``variables`` has the points of the grid. The axes of the
    ``coordinates`` come after the first axis.
    """
    for name in coordinates.keys() & set(grid.dims):
        raise ValueError(f"{name}: is an axis of the result: rename this axis of the DataArray")
    data = xr.Dataset(coords=dict(grid.coords) | coordinates)
    names = list(coordinates)
    for name, value in variables.items():
        value = np.reshape(value, grid.shape + np.shape(value)[1:])
        data[name] = ((*grid.dims, *names[: value.ndim - grid.ndim]), value)
    return described(data, descriptions)


def described(data: xr.Dataset, descriptions: Mapping) -> xr.Dataset:
    for name in data.variables:
        if name in descriptions:
            labels = zip(("long_name", "symbol", "units"), descriptions[name], strict=True)
            data[name].attrs.update(labels)
    return data


@contextmanager
def in_memory(given: str) -> Iterator:
    """Raise a ValueError that names what was given, instead of a MemoryError."""
    try:
        yield
    except MemoryError:
        text = f"{given}: the results do not fit into memory; give less, or fewer balls"
        raise ValueError(text) from None


def simulate(
    ball: Ball,
    *,
    amplitude: Values,
    phase: Values = 0.0,
    velocity: Values = None,
    relative_velocity: Values = None,
    impacts: int = 100,
    table: Table = SINE,
) -> xr.Dataset:
    """Follow a ball from impact to impact, starting with a given first impact.

    Parameters
    ----------
    ball : Ball
        A ball. Its parameters may be arrays.
    amplitude : float or array
        Excitation amplitude Λ ≥ 0. A list of values becomes an axis of the result with the name of
        the argument, and several lists span a grid. An ``xarray.DataArray`` keeps its own axes.
    phase : float or array
        Phase of the table at the first impact.
    velocity, relative_velocity : float or array
        Velocity of the ball before the first impact, in units of g/Ω; or its velocity δ′ ≤ 0
        relative to the table. Give at most one of them. The default is ``velocity`` = -π.
    impacts : int
        Maximum number of impacts.
    table : Table
        The waveform of the table, by default a sine.

    Returns
    -------
    xarray.Dataset
        Variables of each ``impact``, NaN after the last impact:

        - ``time`` since the start;
        - ``impact_phase``: phase of the table at the start of the impact;
        - ``impact_velocity``, ``bounce_velocity``: velocities of the ball before and after the
          impact;
        - ``relative_impact_velocity``, ``relative_bounce_velocity``: the same velocities relative
          to the table;
        - ``contact_duration``: duration of the contact;
        - ``flight_time``: duration of the flight after the impact.

        The ``status`` of each ball is "bouncing" or "permanent contact". A ball may come to rest
        after infinitely many bounces. One impact then represents these bounces. Its
        ``contact_duration`` is the total time of the bounces and of the rest up to the lift-off.

    Raises
    ------
    ValueError
        If Λ is negative, if an argument is not a number, or if the ball rises from the table at
        the first impact.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> simulate(Rigid(0.5), amplitude=0.0, velocity=-4.0, impacts=3).time.values.tolist()
    [0.0, 4.0, 6.0]
    """
    grid, balls = first_impacts(ball, amplitude, phase, velocity, relative_velocity, table)
    impacts = whole_number("impacts", impacts)
    with in_memory(f"impacts = {impacts}"):
        record, going, _ = bounce(balls, impacts)
    turns, start, u, _, duration, _, w, flight_time = np.moveaxis(record, 1, 0)
    before = balls.amplitude * table(start, 1)
    after = balls.amplitude * table(start + np.where(duration < np.inf, duration, np.nan), 1)
    status = np.full(balls.phase.shape, "permanent contact")
    status[going] = "bouncing"
    variables = {
        "time": PERIOD * (turns - balls.turns) + (start - balls.phase),
        "impact_phase": start,
        "impact_velocity": before - u,
        "relative_impact_velocity": -u,
        "contact_duration": duration,
        "bounce_velocity": after + w,
        "relative_bounce_velocity": w,
        "flight_time": flight_time,
    }
    variables = {name: value.T for name, value in variables.items()} | {"status": status}
    return dataset(grid, variables, DESCRIPTIONS, impact=np.arange(len(record)))


def history(
    ball: Ball,
    *,
    amplitude: Values,
    phase: Values = 0.0,
    velocity: Values = None,
    relative_velocity: Values = None,
    periods: float = 10.0,
    samples: int = 200,
    table: Table = SINE,
) -> xr.Dataset:
    """Compute the height of a ball over time, starting with the first impact of :func:`simulate`.

    Parameters
    ----------
    ball, amplitude, phase, velocity, relative_velocity, table
        As in :func:`simulate`.
    periods : float
        Number of periods 2π of the table.
    samples : int
        Number of samples in each period.

    Returns
    -------
    xarray.Dataset
        Variables over ``time``. Times are Ωt, heights are Ω²y/g, and velocities are in units of
        g/Ω.

        - ``ball``, ``ball_velocity``: height and velocity of the ball;
        - ``table``: height of the table;
        - ``contact``: whether the ball touches the table.

    Raises
    ------
    ValueError
        As :func:`simulate`, or if a ball has more than a million impacts in this time.
    """
    grid, balls = first_impacts(ball, amplitude, phase, velocity, relative_velocity, table)
    nothing = np.zeros((0, len(COLUMNS), balls.phase.size))
    return over_time(grid, balls, nothing, periods, samples)


def drop(
    ball: Ball,
    *,
    height: Values,
    amplitude: Values = 0.0,
    phase: Values = 0.0,
    periods: float = 10.0,
    samples: int = 200,
    table: Table = SINE,
) -> xr.Dataset:
    """Drop a ball at rest above the table, and compute its height over time.

    Parameters
    ----------
    height : float or array
        Initial height z of the ball, in units of g/Ω². The table is at z = ΛW(τ).
    phase : float or array
        Phase of the table when the ball is dropped.
    ball, amplitude, periods, samples, table
        As in :func:`history`.

    Returns
    -------
    xarray.Dataset
        As in :func:`history`.

    Raises
    ------
    ValueError
        As :func:`history`, or if the ball is below the table.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> heights = drop(Rigid(0.5), height=[2.0, 8.0], periods=1.0)
    >>> heights.ball.sel(time=0).values.tolist()
    [2.0, 8.0]
    """
    grid, ball, (height, amplitude, phase) = grid_of(
        ball, height=height, amplitude=amplitude, phase=phase
    )
    check_table(table)
    gap = height - amplitude * table(phase)
    if (gap < -4 * EPS * (np.abs(height) + amplitude)).any():
        raise ValueError(f"height = {height[np.argmin(gap)]:g}: is below the table")
    gap = np.maximum(gap, 0.0)
    nothing = np.zeros(gap.shape)
    w = -amplitude * table(phase, 1)
    balls = Balls(ball, amplitude, nothing, phase, nothing, table)
    dropped = Leaving(nothing, nothing, nothing, phase, gap, w)
    time, speed = fly(balls, dropped)
    # A ball on the table starts with an impact, unless the table falls away faster than the ball.
    gravity = 1 + amplitude * table(phase, 2)
    lies = (gap == 0) & ((w < 0) | ((w == 0) & (gravity >= 0)))
    time = np.where(lies, 0.0, time)
    speed = np.where(lies, -w, speed)
    turns, lands = reduced(phase + time)
    fall = np.array([nothing, phase, nothing, nothing, nothing, gap, w, time])
    first = replace(balls, turns=turns, phase=lands, speed=speed)
    return over_time(grid, first, fall[np.newaxis], periods, samples)


def over_time(
    grid: xr.DataArray, balls: Balls, fall: NDArray, periods: float, samples: int
) -> xr.Dataset:
    """Return the heights of balls over time as a dataset.

    ``fall`` records the flights before the first impacts, shape (flights, 8, balls). It has no
    flights if the motions start with an impact.
    """
    periods = one_number("periods", periods)
    samples = whole_number("samples", samples)
    with in_memory(f"periods = {periods:g}, samples = {samples}"):
        times = np.linspace(0, PERIOD * periods, round(periods * samples) + 1)
        shape = balls.phase.size, times.size
        variables = {name: np.empty(shape) for name in ("ball", "ball_velocity", "table")}
        variables["contact"] = np.empty(shape, bool)
    for j, amplitude in enumerate(balls.amplitude):
        one = balls.take([j])
        records = [fall[:, :, j]]
        origin = PERIOD * one.turns[0] + one.phase[0] - records[0][:, 7].sum()
        while one.phase.size and PERIOD * one.turns[0] + one.phase[0] - origin < times[-1]:
            more, _, one = bounce(one, AT_ONCE)
            records.append(more[:, :, 0])
            if AT_ONCE * len(records) > MOST_IMPACTS:
                raise ValueError(
                    f"a ball has more than {MOST_IMPACTS} impacts in this time: reduce periods"
                )
        record = np.concatenate(records)
        record = record[np.isfinite(record[:, 0])]
        one = balls.take([j])
        gap, rate, variables["contact"][j] = states_at(record, origin, one, times)
        variables["table"][j] = amplitude * balls.table(origin + times)
        variables["ball"][j] = gap + variables["table"][j]
        variables["ball_velocity"][j] = rate + amplitude * balls.table(origin + times, 1)
    return dataset(grid, variables, DESCRIPTIONS, time=times)


def states_at(
    record: NDArray, origin: float, balls: Balls, times: NDArray
) -> tuple[NDArray, NDArray, NDArray]:
    """Return δ, δ′ and whether a ball is in contact, each of the shape (times,).

    ``times`` count from the phase ``origin`` of the table. ``balls`` contains one ball.
    """
    ball = balls.ball
    amplitude = float(balls.amplitude[0])
    begin = PERIOD * record[:, 0] + record[:, 1] - origin
    # Rounding may put the start of the first impact after the first time.
    number = np.maximum(np.searchsorted(begin, times, side="right") - 1, 0)
    _, phase, u, _, duration, gap, w, _ = record[number].T
    since = np.maximum(times - begin[number], 0.0)
    contact = since < duration
    leaves = np.where(contact, 0.0, phase + duration)
    waves = balls.table.waves(leaves, amplitude)
    gap, rate, _ = balls.table.flights(np.where(contact, 0.0, since - duration), gap, w, waves)
    if contact.any():
        given = phase[contact], u[contact], since[contact], amplitude
        gap[contact], rate[contact] = ball.contact_after(*given, balls.table)
    return gap, rate, contact
