"""Use arrays to follow many balls at once from impact to impact.

For a single ball, arrays are 40 to 200 times slower than the scalar loops of :mod:`.one_ball`
(docs/impacts.md). These loops take the same steps as the arrays. The table must be a sine, and the
ball must have a constant restitution coefficient, or a spring and a damper.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from importlib.util import find_spec
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.contacts import one_ball
from bouncing_ball_beyond.contacts.balls import FEW_BALLS, Ball, brief, safe_steps
from bouncing_ball_beyond.contacts.one_ball import COLUMNS, STEPS
from bouncing_ball_beyond.motions.effort import Effort
from bouncing_ball_beyond.motions.impact_map import ImpactMap
from bouncing_ball_beyond.tables.table import PERIOD, SINE, Table, Values

# Importing numba takes a second, so it is imported when the first ball is followed.
compile_loops = cache(one_ball.compile_loops)


class Leaving(NamedTuple):
    """States of balls at the end of their impacts.

    Attributes
    ----------
    scaled_duration, duration : array
        T and D of the impacts. D is infinite for a ball that stays on the table.
    turns, phase : array
        Whole turns and phase of the table at the end of the impact.
    gap, speed : array
        δ and δ′ at the end of the impact.
    """

    scaled_duration: np.ndarray
    duration: np.ndarray
    turns: np.ndarray
    phase: np.ndarray
    gap: np.ndarray
    speed: np.ndarray


@dataclass(frozen=True)
class Balls:
    """A row of balls, each before its next impact.

    Attributes
    ----------
    ball : Ball
        The ball. Its parameters are numbers, or arrays with one entry for each ball of the row.
    amplitude : array
        Excitation amplitude Λ.
    turns, phase : array
        Whole turns of the table and its phase. They are separate, so late phases keep all digits.
    speed : array
        Closing speed u.
    table : Table
        The waveform.
    map : ImpactMap, optional
        Map that replaces the integration of contacts, if one ball is followed over many impacts.
    """

    ball: Ball
    amplitude: np.ndarray
    turns: np.ndarray
    phase: np.ndarray
    speed: np.ndarray
    table: Table = SINE
    map: ImpactMap | None = None

    def __post_init__(self) -> None:
        if self.ball.below_table:
            raise ValueError(
                f"ball = {brief(self.ball)}: replaces contacts of orbits, and is not followed from"
                " impact to impact: follow the ball `of`"
            )

    def take(self, which: Any) -> "Balls":
        arrays = ("amplitude", "turns", "phase", "speed")
        rows = {name: getattr(self, name)[which] for name in arrays}
        return replace(self, ball=self.ball.rows(which), **rows)


@np.errstate(divide="ignore", invalid="ignore")
def first_zeros(look: Callable, start: NDArray, given: list, fewest: int = 1) -> NDArray:
    """Use :func:`.safe_steps` to find the first zero of a function f ≥ 0 for each ball.

    No zero may be before ``start``. ``look(t, *given)`` returns (t₁, f, f′, f″, K, J). No zero may
    be between t and t₁. f and its derivatives are taken at t₁. K and J are the bounds that
    :func:`.safe_steps` needs. The search stops when fewer than ``fewest`` balls are left, and
    returns NaN for these balls.
    """
    time = np.full(start.shape, np.nan)
    todo = np.arange(start.size)
    rows = np.array([start, *given])
    steps = 0
    while todo.size >= fewest and steps < STEPS:
        steps += 1
        t, f, slope, second, bend, jerk = look(*rows)
        step, last = safe_steps(t, np.maximum(f, 0.0), slope, second, bend, jerk)
        rows[0] = t + step
        if last.any():
            time[todo[last]] = rows[0, last]
            (going,) = (~last).nonzero()
            todo = todo[going]
            rows = rows.take(going, axis=1)
    return time


def landings(
    table: Table, start: NDArray, amplitude: NDArray, gap: NDArray, w: NDArray, *waves: NDArray
) -> NDArray:
    """Times of landings. This is :func:`.one_ball.landing` for arrays of the same shape."""
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
    fewest = FEW_BALLS if table.is_sine else 1
    time = first_zeros(look, start, [*limits, gap, w, *waves], fewest)
    for i in np.isnan(time).nonzero()[0] if table.is_sine else ():
        time[i], _ = one_ball.landing(*(values[i] for values in (start, gap, w, *waves, amplitude)))
    return time


def resumptions(
    table: Table, kappa: NDArray, amplitude: NDArray, gap: NDArray, w: NDArray, *waves: NDArray
) -> tuple:
    """Times of :func:`.one_ball.resumption` for arrays, and whether contacts resume then."""

    def look(t: NDArray, bend: NDArray, jerk: NDArray, kappa: NDArray, *state: NDArray) -> tuple:
        gap, w, *waves = state
        position, rate, second = table.flights(t, gap, w, waves)
        third = table.third(t, w, rate, waves)
        # f = 0 ends the search above the level, because no contact can resume there.
        f = np.where(position < 0, position + kappa * rate, 0.0)
        slope = np.where(position < 0, rate + kappa * second, -1.0)
        return t, f, slope, second + kappa * third, bend, jerk

    _, _, bend, jerk, snap, _ = (amplitude * bound for bound in table.bounds)
    limits = [1 + bend + kappa * jerk, jerk + kappa * snap]
    time = first_zeros(look, np.zeros(gap.shape), [*limits, kappa, gap, w, *waves])
    return time, table.flights(time, gap, w, waves)[0] < 0


def leave(balls: Balls) -> Leaving:
    """Compute the states of balls at the end of their impacts."""
    if balls.map:
        scaled_duration, duration, gap, w = balls.map.leaves(balls.phase, balls.speed)
    else:
        given = balls.phase, balls.speed, balls.amplitude, balls.table
        scaled_duration, duration, gap, w = balls.ball.leaves(*given)
    if not balls.ball.has_duration:
        return settle_instants(balls, gap, w)
    turns, phase = reduced(np.where(duration < np.inf, balls.phase + duration, 0.0))
    return Leaving(scaled_duration, duration, balls.turns + turns, phase, gap, w)


def settle_instants(balls: Balls, gap: Values, w: Values) -> Leaving:
    """Compute the states after instantaneous impacts.

    Balls that bounce ever lower come to rest, as in :func:`.one_ball.settle`.
    """
    table = balls.table
    amplitude = balls.amplitude
    phase = balls.phase
    restitution = w / np.maximum(balls.speed, 1e-300)
    # This limit is larger than the limit in :func:`.one_ball.settling`, which makes the decision.
    gravity = 1 + amplitude * table(phase, 2)
    limit = 0.51 * one_ball.CHATTER * gravity * gravity * (1 - restitution)
    fourth = amplitude * table.bounds[4]
    stay = np.full(w.shape, -1.0)
    (slow,) = (w * np.maximum(fourth, 1.0) <= limit).nonzero()
    if slow.size:
        _, y, x = table.pulls(table.waves(phase[slow], amplitude[slow]))
        given = (values.tolist() for values in (w[slow], restitution[slow], x, y, fourth[slow]))
        stay[slow] = [*map(one_ball.settling, *given)]
    rests = stay >= 0
    duration = np.maximum(stay, 0.0)
    leaves = phase + duration
    (waits,) = rests.nonzero()
    waits = waits[1 + amplitude[waits] * table(leaves[waits], 2) >= 0]
    if waits.size:
        wait, leaves[waits] = until_lift_off(table, leaves[waits], amplitude[waits])
        duration[waits] += wait
    ends = phase + np.where(duration < np.inf, duration, 0.0)
    turns = balls.turns + np.round((ends - leaves) / PERIOD)
    w = np.where(rests, 0.0, w)
    return Leaving(np.zeros(w.shape), duration, turns, leaves, gap, w)


def until_lift_off(table: Table, phase: NDArray, amplitude: NDArray) -> tuple[NDArray, NDArray]:
    """Return how long resting balls stay on the table, and the phases at which they leave.

    The time is infinite if a ball never leaves.
    """
    phases = table.lift_offs(amplitude)
    wait = (phases - phase[..., np.newaxis]) % PERIOD
    # Rounding must not postpone the lift-off by a turn.
    wait = np.where(wait > PERIOD - one_ball.CHATTER**2, 0.0, wait)
    wait = np.where(np.isnan(wait), np.inf, wait)
    first = wait.argmin(axis=-1)[..., np.newaxis]
    leaves = np.take_along_axis(phases, first, -1)[..., 0]
    return wait.min(axis=-1), reduced(leaves)[1]


def reduced(phase: Values) -> tuple[NDArray, NDArray]:
    turns = np.floor(phase / PERIOD + 0.5)
    return turns, phase - turns * PERIOD


@np.errstate(divide="ignore", invalid="ignore")
def fly(balls: Balls, leaving: Leaving) -> tuple[NDArray, NDArray]:
    """Return the durations of flights and the closing speeds of the next impacts."""
    ball = balls.ball
    table = balls.table
    amplitude = balls.amplitude
    gap = leaving.gap
    w = leaving.speed
    waves = table.waves(leaving.phase, amplitude)
    _, y, x = table.pulls(waves)
    # A ball without a speed leaves because the table falls away: -w″ ≥ 1 within rounding.
    y = np.where((w == 0) & (gap == 0), np.maximum(y, 1.0), y)
    strongest = 1 + table.bounds[2] * amplitude
    start = (w + np.sqrt(np.maximum(w * w + 2 * strongest * gap, 0.0))) / strongest
    # δ ≥ (-w″ - 1) t²/2 - w‴ t³/6 - A t⁴/24 with the bound A of the fourth derivative.
    fourth = table.bounds[4] * amplitude
    left_behind = (2 * x + np.sqrt(4 * x * x + 12 * fourth * np.maximum(y - 1, 0.0))) / fourth
    start = np.where((y >= 1) & (gap == 0), np.maximum(start, left_behind), start)
    resumes = np.zeros(w.shape, bool)
    states = amplitude, gap, w, *waves
    if np.any(ball.kappa):
        kappa = np.broadcast_to(ball.kappa, w.shape)
        # Let g be the strongest gravity. A ball with w ≥ (1 + √2) κ g reaches the level of the
        # table with a speed of at least κ g. Until then δ + κδ′ rises, so no contact resumes.
        slow = (w <= strongest * (1 + np.sqrt(2)) * kappa) | (w * w + 2 * strongest * gap <= 0)
        (low,) = ((gap < 0) & slow).nonzero()
        given = (values[low] for values in (kappa, *states))
        start[low], resumes[low] = resumptions(table, *given)
    time = np.where(start < np.inf, start, np.nan)
    (lands,) = (~resumes & (start < np.inf)).nonzero()
    time[lands] = landings(table, start[lands], *(values[lands] for values in states))
    speed = -table.flights(time, gap, w, waves)[1]
    return time, np.where(resumes, speed, np.maximum(speed, 0.0))


def step(balls: Balls) -> tuple[NDArray, NDArray, Balls]:
    """Follow each ball over one impact and the flight after it.

    Returns

    1. a record of the shape (8, balls), with the columns of :data:`.one_ball.COLUMNS`;
    2. the indices of the balls that leave the table and land again;
    3. these balls before their next impacts.
    """
    leaving = leave(balls)
    record = np.full((len(COLUMNS), balls.phase.size), np.nan)
    record[:3] = balls.turns, balls.phase, balls.speed
    record[3:7] = leaving.scaled_duration, leaving.duration, leaving.gap, leaving.speed
    (going,) = (leaving.duration < np.inf).nonzero()
    balls = balls.take(going)
    leaving = Leaving(*(values[going] for values in leaving))
    time, speed = fly(balls, leaving)
    record[7, going] = time
    turns, phase = reduced(leaving.phase + time)
    after = replace(balls, turns=leaving.turns + turns, phase=phase, speed=speed)
    lands = np.isfinite(time)
    return record, going[lands], after if lands.all() else after.take(lands)


def bounce_each(balls: Balls, impacts: int) -> tuple[NDArray, NDArray, Balls]:
    given: Any = balls.ball.loop_parameters(balls.table)
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


def bounce(
    balls: Balls, impacts: int, effort: Effort | None = None
) -> tuple[NDArray, NDArray, Balls]:
    """Follow each ball over a number of impacts, which count as an effort.

    Returns

    1. a record of the shape (impacts, 8, balls), with the columns of :data:`.one_ball.COLUMNS`; it
       is NaN after the last impact of a ball;
    2. the indices of the balls that still bounce;
    3. these balls before their next impacts.
    """
    if effort and not compile_loops.cache_info().currsize and find_spec("numba"):
        effort.report("numba compiles the functions of motions, or loads what it compiled before")
    compile_loops()
    if balls.phase.size < FEW_BALLS and balls.ball.loop_parameters(balls.table):
        if effort:
            effort.spend(impacts * balls.phase.size)
        return bounce_each(balls, impacts)
    record = np.full((impacts, len(COLUMNS), balls.phase.size), np.nan)
    todo = np.arange(balls.phase.size)
    for impact in record:
        if not todo.size:
            break
        if effort:
            effort.spend(todo.size)
        impact[:, todo], going, balls = step(balls)
        todo = todo[going]
    return record, todo, balls
