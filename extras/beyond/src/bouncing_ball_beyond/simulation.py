"""Balls that are simulated from impact to impact, side by side, and their motions over time.

A ball of the restitution model or of a spring and damper on a sine is followed by the loops of
:mod:`.one_ball`, and many balls, and all others, by the same steps on arrays (docs/impacts.md).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from bouncing_ball_beyond import one_ball
from bouncing_ball_beyond.balls import (
    FEW,
    Ball,
    H,
    brief,
    check_ball,
    checked,
    root_of_parabola,
    safe_steps,
    whole_number,
)
from bouncing_ball_beyond.impact_map import ImpactMap
from bouncing_ball_beyond.one_ball import COLUMNS, ROUNDING, STEPS, TURN
from bouncing_ball_beyond.tables import SINE, Table, Values, check_table

one_ball.compile_loops()

AT_ONCE = 32
MOST_IMPACTS = 1_000_000
"""The number of impacts of a ball that :func:`history` follows."""
TINY = 1e-300


class Leaving(NamedTuple):
    """How balls leave the table.

    ``own_time`` and ``duration`` are T and D of the impacts; D is infinite for a ball that stays.
    ``turns`` and ``phase`` are those of the table at the end, ``gap`` and ``speed`` are δ and δ′
    there. ``emerges`` is when a ball rises through the level after an instant below it.
    """

    own_time: np.ndarray
    duration: np.ndarray
    turns: np.ndarray
    phase: np.ndarray
    gap: np.ndarray
    speed: np.ndarray
    emerges: np.ndarray


@dataclass(frozen=True)
class Balls:
    """A row of balls, each before its next impact.

    ``turns`` and ``phase`` are the whole turns of the table and its phase, so that a late phase has
    all digits, and ``speed`` is u. Parameters of the ball are numbers, or arrays over the row.
    ``map`` has the contacts of one ball that is followed over many impacts.
    """

    ball: Ball
    amplitude: np.ndarray
    turns: np.ndarray
    phase: np.ndarray
    speed: np.ndarray
    table: Table = SINE
    map: ImpactMap | None = None

    def take(self, which: Any) -> "Balls":
        arrays = ("amplitude", "turns", "phase", "speed")
        rows = {name: getattr(self, name)[which] for name in arrays}
        return replace(self, ball=self.ball.rows(which), **rows)


@np.errstate(divide="ignore", invalid="ignore")
def first_zeros(look: Callable, start: NDArray, given: list, fewest: int = 1) -> NDArray:
    """The times of first zeros of functions f ≥ 0, one for each ball, by :func:`.safe_steps`.

    There are none before the times ``start``. ``look(t, *given)`` is a later time before which
    there is none either, f, f′ and f″ there, K and J. The last balls are left out, as NaN, if they
    are fewer than ``fewest``.
    """
    time = np.full(start.shape, np.nan)
    left = np.arange(start.size)
    rows = np.array([start, *given])
    steps = 0
    while left.size >= fewest and steps < STEPS:
        steps += 1
        t, f, slope, second, bend, jerk = look(*rows)
        step, last = safe_steps(t, np.maximum(f, 0.0), slope, second, bend, jerk)
        rows[0] = t + step
        if last.any():
            time[left[last]] = rows[0, last]
            (going,) = (~last).nonzero()
            left = left[going]
            rows = rows.take(going, axis=1)
    return time


def landings(
    table: Table, start: NDArray, amplitude: NDArray, gap: NDArray, w: NDArray, *waves: NDArray
) -> NDArray:
    """The times of :func:`.one_ball.landing` for arrays of one shape."""
    _, _, bend, jerk, *_ = table.bounds
    absolute = w + table.pulls(waves)[0]
    below = gap + (sum(waves[1::2]) - amplitude * table.peaks[0])
    aloft = np.sqrt(np.maximum(absolute * absolute + 2 * below, 0.0))

    def look(t: NDArray, *given: NDArray) -> tuple:
        bend, jerk, ascent, descent, *state = given
        t = np.where((ascent <= t) & (t < descent), descent, t)
        gap, w, *waves = state
        return t, *table.flights(t, gap, w, waves), bend, jerk

    limits = [1 + bend * amplitude, jerk * amplitude, absolute - aloft, absolute + aloft]
    fewest = FEW if table.compiled else 1
    time = first_zeros(look, start, [*limits, gap, w, *waves], fewest)
    for i in np.isnan(time).nonzero()[0] if table.compiled else ():
        time[i], _ = one_ball.landing(*(each[i] for each in (start, gap, w, *waves, amplitude)))
    return time


def emergences(
    table: Table, start: NDArray, amplitude: NDArray, gap: NDArray, w: NDArray, *waves: NDArray
) -> NDArray:
    """The times, not before ``start``, at which balls rise through the level of the table or are
    above it; infinite for those that fall back before."""

    def look(t: NDArray, bend: NDArray, jerk: NDArray, *state: NDArray) -> tuple:
        gap, w, *waves = state
        position, rate, second = table.flights(t, gap, w, waves)
        # The search ends where it falls back, or is above: f = 0 there.
        goes_on = (rate > 0) & (position < 0)
        return t, np.where(goes_on, -position, 0.0), -np.abs(rate), -second, bend, jerk

    _, _, bend, jerk, *_ = table.bounds
    limits = [1 + bend * amplitude, jerk * amplitude]
    time = first_zeros(look, start, [*limits, gap, w, *waves])
    return np.where(table.flights(time, gap, w, waves)[1] > 0, time, np.inf)


def resumptions(
    table: Table, kappa: NDArray, amplitude: NDArray, gap: NDArray, w: NDArray, *waves: NDArray
) -> tuple:
    """The times of :func:`.one_ball.rise` for arrays, and whether contacts resume there."""

    def look(t: NDArray, bend: NDArray, jerk: NDArray, kappa: NDArray, *state: NDArray) -> tuple:
        gap, w, *waves = state
        position, rate, second = table.flights(t, gap, w, waves)
        third = table.third(t, w, rate, waves)
        # Above the level there is nothing to resume, and the search ends: f = 0 there.
        f = np.where(position < 0, position + kappa * rate, 0.0)
        slope = np.where(position < 0, rate + kappa * second, -1.0)
        return t, f, slope, second + kappa * third, bend, jerk

    _, _, bend, jerk, snap, _ = (amplitude * bound for bound in table.bounds)
    limits = [1 + bend + kappa * jerk, jerk + kappa * snap]
    time = first_zeros(look, np.zeros(gap.shape), [*limits, kappa, gap, w, *waves])
    return time, table.flights(time, gap, w, waves)[0] < 0


def instants(
    ball: Ball,
    table: Table,
    landed: NDArray,
    gap: Values,
    w: Values,
    waves: list,
    amplitude: Values,
) -> tuple[NDArray, NDArray]:
    r"""The times after landings at which the gap is that at which impacts of the ball start, and
    the speeds."""
    t = landed.copy()
    speed = np.empty_like(t)
    strongest = 1 + table.bounds[2] * amplitude
    for _ in range(STEPS):
        position, rate, second = table.flights(t, gap, w, waves)
        start = ball.start(-rate + 1j * H)
        slope_of_start = start.imag / H
        f = position - start.real
        slope = rate + slope_of_start * second
        lag = np.abs(slope_of_start)
        bend = strongest * (1 + lag)
        step = root_of_parabola(np.maximum(f, 0.0), slope, bend)
        size = np.abs(gap) + (t + lag) * (np.abs(w) + strongest * (1 + t))
        passed = f < -16 * ROUNDING * size  # more than rounding
        step = np.where(passed, -f / slope, step)
        speed = -rate
        if not np.any(np.abs(step) > 4 * ROUNDING * t):
            break
        t += step
    return t, speed


def leave(balls: Balls) -> Leaving:
    """How balls leave the table after their impacts."""
    if balls.map:
        own_time, duration, gap, w = balls.map.leaves(balls.phase, balls.speed)
    else:
        given = balls.phase, balls.speed, balls.amplitude, balls.table
        own_time, duration, gap, w = balls.ball.leaves(*given)
    if not balls.ball.lasts:
        return rest(balls, gap, w)
    turns, phase = reduced(np.where(duration < np.inf, balls.phase + duration, 0.0))
    return Leaving(own_time, duration, balls.turns + turns, phase, gap, w, emerges=0 * w)


def rest(balls: Balls, gap: Values, w: Values) -> Leaving:
    """How balls leave after instantaneous impacts, some of them after :func:`.one_ball.rest`."""
    table = balls.table
    amplitude = balls.amplitude
    phase = balls.phase
    left = balls.ball.left(balls.speed)
    restitution = w / np.maximum(balls.speed, TINY)
    # A limit beyond that of :func:`.one_ball.settling`.
    gravity = 1 + amplitude * table(phase, 2)
    limit = 0.51 * one_ball.CHATTER * gravity * gravity * (1 - restitution)
    fourth = amplitude * table.bounds[4]
    stay = np.full(w.shape, -1.0)
    emerges = np.zeros(w.shape)
    (slow,) = ((gap == 0) & (w * np.maximum(fourth, 1.0) <= limit)).nonzero()
    if slow.size:
        _, y, x = table.pulls(table.waves(phase[slow], amplitude[slow]))
        given = (each.tolist() for each in (w[slow], restitution[slow], x, y, fourth[slow]))
        stay[slow] = [*map(one_ball.settling, *given)]
    (sinks,) = may_sink(gap, w, 1 + table.bounds[2] * amplitude, left).nonzero()
    if sinks.size:
        waves = table.waves(phase, amplitude)
        given = (each[sinks] for each in (left, amplitude, gap, w, *waves))
        emerges[sinks] = emergences(table, *given)
        stay[sinks] = np.where(emerges[sinks] < np.inf, -1.0, left[sinks])
    rests = stay >= 0
    duration = np.maximum(stay, 0.0)
    leaves = phase + duration
    (waits,) = rests.nonzero()
    waits = waits[1 + amplitude[waits] * table(leaves[waits], 2) >= 0]
    if waits.size:
        wait, leaves[waits] = table.until_lift_off(leaves[waits], amplitude[waits])
        duration[waits] += wait
    ends = phase + np.where(duration < np.inf, duration, 0.0)
    turns = balls.turns + np.round((ends - leaves) / TURN)
    gap, w, emerges = (np.where(rests, 0.0, each) for each in (gap, w, emerges))
    return Leaving(np.zeros(w.shape), duration, turns, leaves, gap, w, emerges=emerges)


def may_sink(gap: Values, w: Values, strongest: NDArray, left: NDArray) -> NDArray:
    """Which balls may not rise after the time ``left``, or not through the level of the table."""
    return (gap < 0) & ((w <= strongest * left) | (w * w + 2 * strongest * gap <= 0))


def reduced(phase: Values) -> tuple[NDArray, NDArray]:
    turns = np.floor(phase / TURN + 0.5)
    return turns, phase - turns * TURN


@np.errstate(divide="ignore", invalid="ignore")
def fly(balls: Balls, leaving: Leaving) -> tuple[NDArray, NDArray]:
    """The time of the flights of balls up to their next impacts, and their closing speeds."""
    ball = balls.ball
    table = balls.table
    amplitude = balls.amplitude
    gap = leaving.gap
    w = leaving.speed
    waves = table.waves(leaving.phase, amplitude)
    _, y, x = table.pulls(waves)
    # A ball without a speed leaves because the table falls away: -w″ ≥ 1, but for rounding.
    y = np.where((w == 0) & (gap == 0), np.maximum(y, 1.0), y)
    strongest = 1 + table.bounds[2] * amplitude
    start = (w + np.sqrt(np.maximum(w * w + 2 * strongest * gap, 0.0))) / strongest
    # δ ≥ (-w″ - 1) t²/2 - w‴ t³/6 - A t⁴/24 with the bound A of the fourth derivative.
    fourth = table.bounds[4] * amplitude
    left_behind = (2 * x + np.sqrt(4 * x * x + 12 * fourth * np.maximum(y - 1, 0.0))) / fourth
    start = np.where((y >= 1) & (gap == 0), np.maximum(start, left_behind), start)
    start = np.where(leaving.emerges > 0, leaving.emerges, start)
    resumes = np.zeros(w.shape, bool)
    states = amplitude, gap, w, *waves
    if np.any(ball.kappa):
        kappa = np.broadcast_to(ball.kappa, w.shape)
        # A ball with w ≥ (1 + √2) κ g has κ g at the level, and δ + κδ′ rises up to there, under
        # the strongest gravity g.
        (sinks,) = may_sink(gap, w, strongest, (1 + np.sqrt(2)) * kappa).nonzero()
        given = (each[sinks] for each in (kappa, *states))
        start[sinks], resumes[sinks] = resumptions(table, *given)
    time = np.where(start < np.inf, start, np.nan)
    (lands,) = (~resumes & (start < np.inf)).nonzero()
    time[lands] = landings(table, start[lands], *(each[lands] for each in states))
    if ball.sinks:
        return instants(ball, table, time, gap, w, waves, amplitude)
    speed = -table.flights(time, gap, w, waves)[1]
    return time, np.where(resumes, speed, np.maximum(speed, 0.0))


def step(balls: Balls) -> tuple[NDArray, NDArray, Balls]:
    """One impact of each ball, and the flight after it.

    Returns a record (8, balls) with the columns of :data:`.one_ball.COLUMNS`, the indices of the
    balls that leave the table, and these before their next impacts.
    """
    leaving = leave(balls)
    record = np.full((len(COLUMNS), balls.phase.size), np.nan)
    record[:3] = balls.turns, balls.phase, balls.speed
    record[3:7] = leaving.own_time, leaving.duration, leaving.gap, leaving.speed
    (going,) = (leaving.duration < np.inf).nonzero()
    balls = balls.take(going)
    leaving = Leaving(*(each[going] for each in leaving))
    time, speed = fly(balls, leaving)
    record[7, going] = time
    turns, phase = reduced(leaving.phase + time)
    after = replace(balls, turns=leaving.turns + turns, phase=phase, speed=speed)
    lands = np.isfinite(time)
    return record, going[lands], after if lands.all() else after.take(lands)


def follow_each(balls: Balls, impacts: int) -> tuple[NDArray, NDArray, Balls]:
    given: Any = balls.ball.looped(balls.table)
    state = balls.turns, balls.phase, balls.speed, balls.amplitude, *given, balls.ball.kappa
    record = np.full((impacts, len(COLUMNS), balls.phase.size), np.nan)
    ends = np.empty((4, balls.phase.size))
    for j, numbers in enumerate(zip(*np.broadcast_arrays(*state), strict=True)):
        out = np.full(record.shape[:2], np.nan)
        arguments: list[Any] = [*map(float, numbers), out]
        ends[:, j] = one_ball.impacts(*arguments)
        record[:, :, j] = out
    stays, turns, phase, speed = ends
    (going,) = (stays == 0).nonzero()
    return record, going, replace(balls, turns=turns, phase=phase, speed=speed).take(going)


def follow_by_map(
    balls: Balls, contacts: ImpactMap, impacts: int
) -> tuple[NDArray, NDArray, Balls]:
    record = np.full((impacts, len(COLUMNS), balls.phase.size), np.nan)
    turns, phase, speed = balls.turns.copy(), balls.phase.copy(), balls.speed.copy()
    done = np.zeros(balls.phase.size, int)
    bounces = np.ones(balls.phase.size, bool)
    while (bounces & (done < impacts)).any():
        (ready,) = (bounces & (done < impacts)).nonzero()
        quick = contacts.knows(speed[ready])
        here = ready[quick] if 2 * np.count_nonzero(quick) >= ready.size else ready[~quick]
        rows = replace(balls.take(here), turns=turns[here], phase=phase[here], speed=speed[here])
        each, going, after = step(rows)
        record[done[here], :, here] = each.T
        done[here] += 1
        bounces[here] = False
        here = here[going]
        bounces[here] = True
        turns[here], phase[here], speed[here] = after.turns, after.phase, after.speed
    (left,) = bounces.nonzero()
    after = replace(balls, turns=turns, phase=phase, speed=speed).take(left)
    return record, left, after


def follow(balls: Balls, impacts: int) -> tuple[NDArray, NDArray, Balls]:
    """A number of impacts of each ball.

    Returns a record (impacts, 8, balls) as that of :func:`step`, NaN after the last impact of a
    ball, the indices of the balls that do not stay on the table, and these before their next
    impacts.
    """
    if balls.phase.size < FEW and balls.ball.looped(balls.table):
        return follow_each(balls, impacts)
    if balls.map:
        return follow_by_map(balls, balls.map, impacts)
    record = np.full((impacts, len(COLUMNS), balls.phase.size), np.nan)
    left = np.arange(balls.phase.size)
    for impact in record:
        if not left.size:
            break
        impact[:, left], going, balls = step(balls)
        left = left[going]
    return record, left, balls


def axis(name: str, value: Any, dim: str | None = None) -> xr.DataArray:
    """An argument as a labelled array: a list is an axis with the name of the argument."""
    if isinstance(value, xr.DataArray):
        return value.astype(float)
    if np.asarray(value).dtype.kind in "SU":
        raise ValueError(f"{name} = {brief(value)}: is a text, and must be a number")
    value = np.asarray(value, float)
    if value.ndim > 1 or not np.isfinite(value).all():
        raise ValueError(f"{name}: must be a finite number, a list of them or an xarray.DataArray")
    dims = [dim or name] * value.ndim
    return xr.DataArray(value, {name: (dims, value)} if dims else {}, dims)


def grid_of(ball: Ball, **values: Any) -> tuple[xr.DataArray, Ball, list[NDArray]]:
    """The grid that arguments, one of them the amplitude, and array parameters of a ball span.

    Parameters of a ball vary together: along an axis with the name of the parameter, or "ball" if
    several are arrays. Returns an array with the axes of the grid, the ball with parameters for
    each point of it, in one row, and the values of the arguments at each point.
    """
    check_ball(ball)
    rows = {name: value for name, value in ball.parameters.items() if np.ndim(value)}
    dim = "ball" if len(rows) > 1 else None
    arrays = [axis(name, value) for name, value in values.items()]
    arrays += [axis(name, value, dim) for name, value in rows.items()]
    every = xr.broadcast(*arrays)
    flat = [each.values.ravel() for each in every]
    amplitude = flat[list(values).index("amplitude")]
    if (amplitude < 0).any():
        raise ValueError(f"amplitude = {amplitude.min():g}: must be at least 0")
    if rows:
        ball = ball.at(**dict(zip(rows, flat[len(values) :], strict=True)))
    grid = every[0].assign_coords(xr.merge(each.coords for each in arrays).coords)
    return grid, ball, flat[: len(values)]


def first_impacts(
    ball: Ball,
    amplitude: Values,
    phase: Values,
    velocity: Values,
    relative_velocity: Values,
    table: Table = SINE,
) -> tuple[xr.DataArray, Balls]:
    """The grid of first impacts of :func:`simulate`, and the balls before them."""
    check_table(table)
    absolute = relative_velocity is None
    if not absolute and velocity is not None:
        raise ValueError("velocity, relative_velocity: at most one of them may be given")
    velocity = -np.pi if velocity is None else velocity
    name = "velocity" if absolute else "relative_velocity"
    given = {name: velocity if absolute else relative_velocity}
    grid, ball, (amplitude, phase, value) = grid_of(ball, amplitude=amplitude, phase=phase, **given)
    speed = amplitude * table(phase, 1) * absolute - value
    if (speed < 0).any():
        raise ValueError(
            f"{name} = {value[np.argmin(speed)]:g}: the ball rises from the table, by a relative"
            f" velocity of {-speed.min():g}"
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
    "amplitude": ("excitation amplitude", "Λ", "1"),
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
    """Values over the points of a grid as a labelled dataset.

    ``variables`` are arrays with the points of the grid as their first axis, and the axes of the
    ``coordinates`` after it.
    """
    found = xr.Dataset(coords=dict(grid.coords) | coordinates)
    names = list(coordinates)
    for name, value in variables.items():
        value = np.reshape(value, grid.shape + np.shape(value)[1:])
        found[name] = ((*grid.dims, *names[: value.ndim - grid.ndim]), value)
    return described(found, descriptions)


def described(found: xr.Dataset, descriptions: Mapping) -> xr.Dataset:
    for name in found.variables:
        if name in descriptions:
            labels = zip(("long_name", "symbol", "units"), descriptions[name], strict=True)
            found[name].attrs.update(labels)
    return found


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
    """The impacts of a ball that begins with a given first impact.

    Parameters
    ----------
    ball : Ball
        Its parameters may be arrays.
    amplitude : float or array
        Excitation amplitude Λ ≥ 0. Here and below a list is an axis of the result with the name of
        the argument, and several span a grid; an ``xarray.DataArray`` has its own axes.
    phase : float or array
        Phase of the table at the first impact.
    velocity, relative_velocity : float or array
        At most one of both: the velocity of the ball before it, by default -π in units of g/Ω, or
        that relative to the table, δ′ ≤ 0.
    impacts : int
        Largest number of impacts.
    table : Table
        The waveform of the table, by default a sine.

    Returns
    -------
    xarray.Dataset
        ``time``, ``impact_phase``, ``impact_velocity``, ``bounce_velocity``, ``contact_duration``
        and ``flight_time`` of each ``impact``, and ``relative_impact_velocity`` and
        ``relative_bounce_velocity``, NaN after the last one; and the ``status`` of the ball,
        "bouncing" or "permanent contact". Bounces that end on the table are summed up in the
        ``contact_duration`` of one impact, with the rest up to the lift-off.

    Raises
    ------
    ValueError
        If Λ is negative, an argument is no number, or the ball rises from the table at first.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> simulate(Rigid(0.5), amplitude=0.0, velocity=-4.0, impacts=3).time.values.tolist()
    [0.0, 4.0, 6.0]
    """
    grid, balls = first_impacts(ball, amplitude, phase, velocity, relative_velocity, table)
    record, going, _ = follow(balls, whole_number("impacts", impacts))
    turns, start, u, _, duration, _, w, flight_time = np.moveaxis(record, 1, 0)
    before = balls.amplitude * table(start, 1)
    after = balls.amplitude * table(start + np.where(duration < np.inf, duration, np.nan), 1)
    status = np.full(balls.phase.shape, "permanent contact")
    status[going] = "bouncing"
    found = {
        "time": TURN * (turns - balls.turns) + (start - balls.phase),
        "impact_phase": start,
        "impact_velocity": before - u,
        "relative_impact_velocity": -u,
        "contact_duration": duration,
        "bounce_velocity": after + w,
        "relative_bounce_velocity": w,
        "flight_time": flight_time,
    }
    found = {name: value.T for name, value in found.items()} | {"status": status}
    return dataset(grid, found, DESCRIPTIONS, impact=np.arange(len(record)))


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
    """A ball over time, from a first impact as in :func:`simulate`.

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
        Height and velocity of the ``ball``, height of the ``table`` and whether they are in
        ``contact``, over ``time``. Times are Ωt and heights Ω²y/g.

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
    """A ball that is dropped at rest above the table, over time.

    Parameters
    ----------
    height : float or array
        Height above the middle of the motion of the table, in units of g/Ω².
    ball, amplitude, phase, periods, samples, table
        As in :func:`history`; the phase is that of the table when the ball is dropped.

    Returns
    -------
    xarray.Dataset
        As of :func:`history`, whose errors it has too, and one if the ball is below the table.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> found = drop(Rigid(0.5), height=[2.0, 8.0], periods=1.0)
    >>> found.ball.sel(time=0).values.tolist()
    [2.0, 8.0]
    """
    grid, ball, (height, amplitude, phase) = grid_of(
        ball, height=height, amplitude=amplitude, phase=phase
    )
    check_table(table)
    gap = height - amplitude * table(phase)
    if (gap < 0).any():
        raise ValueError(f"height = {height[np.argmin(gap)]:g}: is below the table")
    nothing = np.zeros(gap.shape)
    w = -amplitude * table(phase, 1)
    balls = Balls(ball, amplitude, nothing, phase, nothing, table)
    dropped = Leaving(nothing, nothing, nothing, phase, gap, w, emerges=nothing)
    time, speed = fly(balls, dropped)
    # A ball that lies on a table which does not fall faster is at its first impact already.
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
    """The dataset of balls over time, from their first impacts or from rows that record falls."""
    periods = checked("periods", periods, 0, np.inf, low_allowed=False)
    times = np.linspace(0, TURN * periods, round(periods * whole_number("samples", samples)) + 1)
    shape = balls.phase.size, times.size
    found = {name: np.empty(shape) for name in ("ball", "ball_velocity", "table")}
    found["contact"] = np.empty(shape, bool)
    for j, amplitude in enumerate(balls.amplitude):
        one = balls.take([j])
        records = [fall[:, :, j]]
        origin = TURN * one.turns[0] + one.phase[0] - records[0][:, 7].sum()
        while one.phase.size and TURN * one.turns[0] + one.phase[0] - origin < times[-1]:
            more, _, one = follow(one, AT_ONCE)
            records.append(more[:, :, 0])
            if AT_ONCE * len(records) > MOST_IMPACTS:
                raise ValueError(f"a ball has more than {MOST_IMPACTS} impacts in this time")
        record = np.concatenate(records)
        record = record[np.isfinite(record[:, 0])]
        one = balls.take([j])
        gap, rate, found["contact"][j] = states_at(record, origin, one, times)
        found["table"][j] = amplitude * balls.table(origin + times)
        found["ball"][j] = gap + found["table"][j]
        found["ball_velocity"][j] = rate + amplitude * balls.table(origin + times, 1)
    return dataset(grid, found, DESCRIPTIONS, time=times)


def states_at(
    record: NDArray, origin: float, balls: Balls, times: NDArray
) -> tuple[NDArray, NDArray, NDArray]:
    """δ, δ′ and whether one ball is in contact at times after the phase ``origin`` of the table."""
    ball = balls.ball
    amplitude = float(balls.amplitude[0])
    begin = TURN * record[:, 0] + record[:, 1] - origin
    # Rounding may put the beginning after the first of the times.
    number = np.maximum(np.searchsorted(begin, times, side="right") - 1, 0)
    _, phase, u, _, duration, gap, w, _ = record[number].T
    since = np.maximum(times - begin[number], 0.0)
    contact = since < duration
    leaves = np.where(contact, 0.0, phase + duration)
    waves = balls.table.waves(leaves, amplitude)
    gap, rate, _ = balls.table.flights(np.where(contact, 0.0, since - duration), gap, w, waves)
    gap[contact] = 0.0
    rate[contact] = 0.0
    if ball.lasts and contact.any():
        given = phase[contact], u[contact], since[contact], amplitude
        gap[contact], rate[contact] = ball.contact_after(*given, balls.table)
    return gap, rate, contact
