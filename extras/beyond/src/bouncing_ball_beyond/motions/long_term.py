"""Long-term motions of balls: permanent contact, periodic motion, or chaos.

Let s = (τ, u) be the state of a ball at an impact, F(s) its state k impacts later, and M the
derivative of F. The motion is periodic with k impacts if

1. the last k impacts agree with the k impacts before them within `NEAR_BEFORE`;
2. the distance from s to the fixed point s* = s + (I - M)⁻¹ (F(s) - s) is less than `RETURNED`;
3. the moduli of both eigenvalues of M (the multipliers) are less than 1 - `MARGIN`.

The motion from s to F(s) is a *lap*. A periodic motion is *locked* if the ball sticks to the table
in each period (docs/orbits.md). A *section* is a group of successive impacts.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.special import stdtrit

from bouncing_ball_beyond.contacts.balls import (
    Ball,
    H,
    check_one_ball,
    checked,
    one_number,
    whole_number,
)
from bouncing_ball_beyond.contacts.laws import ForceLaw
from bouncing_ball_beyond.motions.bounces import Balls, bounce
from bouncing_ball_beyond.motions.effort import Effort
from bouncing_ball_beyond.motions.impact_map import impact_map
from bouncing_ball_beyond.motions.simulation import (
    DESCRIPTIONS,
    dataset,
    described,
    first_impacts,
    grid_of,
)
from bouncing_ball_beyond.tables.table import PERIOD, SINE, Table, Values, check_table

RETURNED = 1e-7
"""Largest distance of a state from the fixed point of a periodic motion; see `apart`.

It is far above rounding errors. It is far below the distance between two orbits whose multipliers
are less than 1 - `MARGIN`.

At half: no kind of 960 motions changes. At twice: 2 of 960 are periodic instead of undecided.
"""
NEAR_BEFORE = 1e-5
"""Largest distance between corresponding impacts of the last two laps of a periodic motion.

At half and at twice: no effect on 960 kinds of motion.
"""
CANDIDATES = 8
"""Maximum number of returns within `NEAR_BEFORE` that are tried, the most recent first.

At half and at twice: no effect on 960 kinds of motion.
"""
MARGIN = 1e-3
"""Margin by which the multipliers of a periodic motion must be less than 1.

At half and at twice: up to 10 of 142 slow motions have another reason.
"""
ROUNDING_GROWTH = np.log(RETURNED / 2.0**-52)
"""Logarithm of the growth that turns a rounding error into a deviation of `RETURNED`."""
SECTION = 25
"""Number of impacts in a section. Growth of deviations is summed over each section.

At half and at twice: up to 7 of 960 chaotic or marginal motions change their kind.
"""
IMPACTS_AT_ONCE = 1 << 16
"""Number of impacts computed at once, summed over all balls."""
RESTART = np.array([[1.0, 0.618], [0.0, 0.0]])[:, :, np.newaxis, np.newaxis]
"""Map that replaces a deviation by an arbitrary deviation after a lift-off."""
RESET_OFFSET = 1e6
"""Offset larger than the logarithm of the growth over all impacts computed at once."""
WORTH_A_MAP = 20_000
"""Number of impacts, summed over all balls, above which an :class:`.ImpactMap` saves time.

Building the map takes as long as about a thousand contacts.

At half: three basins take 40 % less time. At twice: 28 % more.
"""
FOLLOWED_FIRST = 100
"""Number of impacts after which an :class:`.ImpactMap` saves time, even for a single ball.

Building the map takes as long as these impacts.
"""
BALLS_AT_ONCE = 1 << 14
"""Maximum number of balls followed at once.

At half: 17 % faster. At twice: 14 % slower.
"""
SIGNIFICANT = 5.0
"""Number of standard errors by which the exponent of a chaotic motion must exceed zero.

Chance alone causes such a deviation once in three million cases.
"""
SETTLING_LENGTHS = 5.0
"""Number of relaxation lengths skipped before an exponent is computed.

Over one relaxation length areas contract by a factor of e, and the deviation of the energy from its
mean shrinks by the same factor.

At half and at twice: up to 2 of 60 nearly elastic balls change between chaotic and undecided.
"""
TELLING_LENGTHS = 20.0
"""Minimum number of relaxation lengths from which the error of an exponent is estimated.

At half: 4 of 60 nearly elastic balls gain an error. At twice: 5 lose theirs.
"""
LOW_DISCREPANCY = (0.7548776662466927, 0.5698402909980532)
"""Generators of a low-discrepancy sequence.

The fractional parts of their multiples cover the unit square evenly.
"""
NEIGHBOURS = 32
"""Number of neighbours of a chaotic ball that are followed to detect transient chaos.

At half and at twice: no effect on 56 exponents; the time is proportional.
"""

LIFT_OFF_ERROR = 1e-12
"""Tolerance for rounding errors in the condition -w″ = 1 of a lift-off."""

PERIODIC, LOCKED, PERMANENT, CHAOTIC, UNDECIDED = (
    "periodic",
    "locked",
    "permanent contact",
    "chaotic",
    "undecided",
)
NO_RECURRENCE = "it has not repeated, and its Lyapunov exponent may be zero within its error"
LITTLE_LOSS = (
    "it has not repeated, and its impacts have lost too little energy to tell whether its Lyapunov"
    " exponent is zero"
)
MARGINAL = "it returns, but neighbouring motions converge too slowly to prove that it repeats"
LOST_TO_ROUNDING = "rounding errors grow too large before it repeats"
RESUMES = "a contact would resume below the table, where the contact law is not defined"
TRANSIENT = "it looks chaotic, but a neighbour comes to rest or repeats: it may be a transient"


def tangent_maps(balls: Balls, record: NDArray, lifts: NDArray) -> NDArray:
    """Derivatives of the next impact (τ, u) with respect to the present impact (τ, u).

    Returns an array of the shape (2, 2, impacts, balls). It is zero at a lift-off, where the next
    impact does not depend on the present impact.
    """
    ball = balls.ball
    table = balls.table
    amplitude = balls.amplitude
    _, tau, u, T, duration, _, w, time = np.moveaxis(record, 1, 0)
    if balls.map:
        slopes = balls.map.end_slopes(tau, u, T)
    else:
        slopes = ball.end_slopes(tau, u, T, amplitude, table)
    slopes = np.where(are_rests(T, duration), 0.0, slopes)
    later, dgap, dw = slopes
    later = later + np.array([1.0, 0.0])[:, np.newaxis, np.newaxis]
    leaves = tau + duration
    x, y, _ = table.pulls(table.waves(leaves, amplitude))
    x_end, y_end, _ = table.pulls(table.waves(leaves + time, amplitude))
    rate = w + x - time - x_end
    start = ball.start(-rate + 1j * H).imag / H
    dgap = dgap + time * dw + (x - x_end - y * time) * later
    drate = dw + (y_end - y) * later
    dtime = -(dgap + start * drate) / (rate + start * (y_end - 1))
    maps = np.array([later + dtime, -drate - (y_end - 1) * dtime])
    return np.where(lifts, 0.0, maps)


def are_rests(T: NDArray, duration: NDArray) -> NDArray:
    """Whether impacts are rests on the table. Then T is 0, but D is positive."""
    return (T == 0) & (duration > 0)


def lift_offs(balls: Balls, record: NDArray) -> NDArray:
    """Whether each contact is a rest that ends with a lift-off, shape (impacts, balls)."""
    _, tau, _, T, duration, _, w, _ = np.moveaxis(record, 1, 0)
    rests = are_rests(T, duration) & (w == 0)
    push = -balls.amplitude * balls.table(np.where(rests, tau + duration, 0.0), 2)
    return rests & (push < 1 + LIFT_OFF_ERROR)


def product(maps: NDArray) -> NDArray:
    """Product of the maps of each ball, shape (2, 2, balls), with the last impact on the left.

    ``maps`` has the shape (2, 2, impacts, balls).
    """
    while (n := maps.shape[2]) > 1:
        pairs = np.einsum("ijnb,jknb->iknb", maps[:, :, 1::2], maps[:, :, : n - 1 : 2])
        maps = np.concatenate([pairs, maps[:, :, n - n % 2 :]], axis=2)
    return maps[:, :, 0]


def ends_of(balls: Balls, impacts: int, effort: Effort, step: str) -> dict:
    """Find the motion on which each ball ends.

    Each ball is followed until its motion is known, for at most ``impacts`` impacts, rounded up to
    whole sections. Returns arrays over the balls by name; `OF_MOTIONS` describes them.
    """
    impacts = whole_number("impacts", impacts)
    effort.spend(0, step)
    numbers = ("lyapunov_exponent", "lyapunov_error", "exponent_sum", "end_phase", "end_speed")
    ends = {name: np.zeros(balls.phase.size, int) for name in ("impacts", "periods", "followed")}
    ends |= {name: np.full(balls.phase.size, "", object) for name in ("kind", "reason")}
    ends |= {name: np.full(balls.phase.size, np.nan) for name in numbers}
    ends["rested"] = np.zeros(balls.phase.size, bool)
    for first in range(0, balls.phase.size, BALLS_AT_ONCE):
        lane = np.arange(first, min(first + BALLS_AT_ONCE, balls.phase.size))
        _follow_to_end(ends, balls.take(lane), lane, impacts, effort)
    return ends


def is_worth_a_map(balls: Balls, impacts: int, seen: int) -> bool:
    """Whether an :class:`.ImpactMap` saves time, after ``seen`` of the impacts.

    A map saves time if three conditions hold: there are at least `WORTH_A_MAP` impacts, or
    `FOLLOWED_FIRST` were not enough; the contact law must be integrated numerically; and all balls
    have the same parameters and the same Λ.
    """
    few = balls.phase.size * impacts < WORTH_A_MAP and seen < FOLLOWED_FIRST
    if few or not isinstance(balls.ball, ForceLaw):
        return False
    several = any(map(np.ndim, balls.ball.parameters.values()))
    return not several and np.ptp(balls.amplitude) == 0


def _store(ends: dict, which: Any, **values: Any) -> None:
    """Store one value or array per name for the balls ``which``."""
    for name, value in values.items():
        ends[name][which] = value


def _take(track: dict, which: Any) -> dict:
    """Select balls from all arrays of ``track``; balls are the last axis."""
    return {name: values[..., which] for name, values in track.items()}


@np.errstate(all="ignore")
def _follow_to_end(ends: dict, balls: Balls, lane: NDArray, impacts: int, effort: Effort) -> None:
    """Follow balls until the motion of each ball is known, and store the motions in ``ends``.

    Floating-point warnings are off, because deviations overflow in long motions and vanish at a
    lift-off.
    """
    zeros = np.zeros(lane.size)
    track = {
        "lane": lane,  # index of the ball
        "vector": np.array([zeros + 1, zeros]),  # deviation, scaled to length 1
        "climb": zeros,  # log growth of the deviation above its minimum since the last lift-off
        "most": zeros,  # maximum climb since the last lift-off
        "lifted": zeros - 1,  # number of the impact before the last lift-off, -1 if there is none
        "lifted_at": zeros,  # time of the last lift-off
        "marginal": zeros > 0,  # whether neighbours of a returning ball converge too slowly
        "sections": np.zeros((0, 3, lane.size)),  # log growth, time, log of the area contraction
    }
    seen = 0
    while track["lane"].size and seen < impacts:
        if not balls.map and is_worth_a_map(balls, impacts, seen):
            amplitude = float(balls.amplitude[0])
            top = np.fmax.reduce([fastest(balls.ball, amplitude, balls.table), *balls.speed])
            mapped = impact_map(balls.ball, amplitude, balls.table, float(top), effort)
            balls = replace(balls, map=mapped)
        count = min(
            max(seen // SECTION, 1),
            -(-(impacts - seen) // SECTION),
            max(IMPACTS_AT_ONCE // track["lane"].size // SECTION, 1),
        )
        record, going, after = bounce(balls, count * SECTION, effort)
        _store_resting(ends, track["lane"], record, going, seen)
        balls = balls.take(going)
        track = _take(track, going)
        record = record[:, :, going]
        lifts = lift_offs(balls, record)
        maps = tangent_maps(balls, record, lifts)
        again = recurrence(balls, record, after, maps)
        lap = grow_deviations(track, record, after, maps, lifts)
        track["marginal"] = again["marginal"]
        _store_periodic(ends, track["lane"], record, after, again, seen)
        locked = _store_locked(ends, track, record, after, lifts, lap, seen)
        seen += len(record)
        (todo,) = (~locked & ~again["repeats"]).nonzero()
        balls = after.take(todo)
        track = _take(track, todo)
    _store_others(ends, balls, track, seen)


def running_products(maps: NDArray) -> tuple[NDArray, NDArray]:
    """Products of all maps up to each impact.

    Returns scaled products, shape (2, 2, impacts, balls), and the logarithms of the scale factors,
    shape (impacts, balls). Each pass doubles the number of factors.
    """
    products = maps.copy()
    logarithms = np.zeros(maps.shape[2:])
    factors = 1
    while factors < maps.shape[2]:
        longer = np.einsum("ijnb,jknb->iknb", products[:, :, factors:], products[:, :, :-factors])
        size = np.abs(longer).max(axis=(0, 1))
        products[:, :, factors:] = longer / size
        logarithms[factors:] += logarithms[:-factors] + np.log(size)
        factors *= 2
    return products, logarithms


def grow_deviations(
    track: dict, record: NDArray, after: Balls, maps: NDArray, lifts: NDArray
) -> NDArray:
    """Propagate the deviation of each ball over the recorded impacts, and update ``track``.

    Returns the maximum climb (see `_follow_to_end`) between the last two lift-offs, shape (balls,).
    """
    # A lift-off erases the deviation. Restart it in an arbitrary direction.
    smooth = np.where(lifts | ~np.isfinite(maps).all(axis=(0, 1)), RESTART, maps)
    products, logarithms = running_products(smooth)
    vectors = np.einsum("ijnb,jb->inb", products, track["vector"])
    length = np.hypot(*vectors)
    growth = np.diff(logarithms + np.log(length), axis=0, prepend=0.0)
    growth = np.where(lifts, 0.0, growth)
    # Shift the sums down at each lift-off. The running minimum then restarts at the lift-off.
    number = lifts.cumsum(axis=0)
    sums = growth.cumsum(axis=0) - RESET_OFFSET * number
    climb = sums - np.minimum(np.minimum.accumulate(sums, axis=0), -track["climb"])
    most, lap = (np.where(number == number[-1] - k, climb, 0.0).max(axis=0) for k in (0, 1))
    lap = np.where(number[-1] == 1, np.maximum(lap, track["most"]), lap)
    areas = np.nan_to_num(contraction(maps), neginf=0.0)
    sums = np.stack([growth, np.diff(times(record, after), axis=0), areas])
    sums = sums.reshape(3, len(record) // SECTION, SECTION, lifts.shape[1]).sum(axis=2)
    track["vector"] = vectors[:, -1] / length[-1]
    track["most"] = np.where(number[-1] == 0, np.maximum(most, track["most"]), most)
    track["climb"] = climb[-1]
    track["sections"] = np.concatenate([track["sections"], np.moveaxis(sums, 0, 1)])
    return lap


def times(record: NDArray, after: Balls) -> NDArray:
    """Times of the recorded impacts and of the next impact, shape (impacts + 1, balls)."""
    turns = np.vstack([record[:, 0], after.turns])
    return PERIOD * turns + np.vstack([record[:, 1], after.phase])


def recurrence(balls: Balls, record: NDArray, after: Balls, maps: NDArray) -> dict:
    """Find the shortest lap after which each ball returns to the state of its next impact.

    Returns arrays over the balls:

    - ``repeats``: whether the motion is periodic;
    - ``marginal``: whether the ball returns but ``radius`` differs from 1 by less than `MARGIN`;
    - ``impacts``, ``periods``: impacts and table periods in a lap, 0 if the ball does not return;
    - ``radius``: largest modulus of the multipliers of a lap;
    - ``areas``: logarithm of the area contraction over a lap.
    """
    n, _, m = record.shape
    half = n // 2
    phase = np.vstack([record[:, 1], after.phase])
    speed = np.vstack([record[:, 2], after.speed]) / (1 + balls.amplitude)
    near = apart(phase[n] - phase[n - half : n], speed[n] - speed[n - half : n])[::-1] < NEAR_BEFORE
    near &= near.cumsum(axis=0) <= CANDIDATES
    distance = np.full(m, np.inf)
    lag = np.zeros(m, int)
    radius = np.zeros(m)
    areas = np.zeros(m)
    for k in np.flatnonzero(near.any(axis=1)) + 1:
        # Multiples of a lap have the same fixed point, so keep the shortest lap.
        (some,) = (near[k - 1] & (distance > NEAR_BEFORE)).nonzero()
        last = phase[:, some], speed[:, some]
        turn = apart(
            *(quantity[n + 1 - k :] - quantity[n + 1 - 2 * k : n + 1 - k] for quantity in last)
        )
        some = some[turn.max(axis=0) < NEAR_BEFORE]
        scale = 1 + balls.amplitude[some]
        angle = (phase[n] - phase[n - k])[some]
        angle -= PERIOD * np.round(angle / PERIOD)
        change = (speed[n] - speed[n - k])[some] * scale
        lap = maps[:, :, n - k :, some]
        (a, b), (c, d) = product(lap)
        divisor = 1 - (a + d) + (a * d - b * c)
        to_phase = ((1 - d) * angle + b * change) / divisor
        to_speed = (c * angle + (1 - a) * change) / divisor
        lag[some] = k
        distance[some] = apart(to_phase, to_speed / scale)
        radius[some] = largest_multiplier(a + d, a * d - b * c)
        areas[some] = contraction(lap).sum(axis=0)
    passed = times(record, after)
    passed = passed[n] - passed[n - lag, np.arange(m)]
    return {
        "repeats": (distance < RETURNED) & (radius < 1 - MARGIN),
        "marginal": (lag > 0) & (np.abs(radius - 1) < MARGIN),
        "impacts": lag,
        "periods": np.round(passed / PERIOD).astype(int),
        "radius": radius,
        "areas": areas,
    }


def apart(angle: NDArray, speed: Values) -> NDArray:
    """Distance between two states.

    It is the maximum of ``angle``, the difference of their phases modulo 2π, and ``speed``, the
    difference of their speeds divided by 1 + Λ.
    """
    return np.maximum(np.abs(angle - PERIOD * np.round(angle / PERIOD)), np.abs(speed))


def largest_multiplier(trace: NDArray, determinant: NDArray) -> NDArray:
    """Largest modulus of the eigenvalues of a 2×2 matrix, from its trace and determinant."""
    root = np.sqrt(trace * trace / 4 - determinant + 0j)
    return np.maximum(np.abs(trace / 2 + root), np.abs(trace / 2 - root))


def contraction(maps: NDArray) -> NDArray:
    """Logarithm of the contraction of areas, the modulus of the determinant of each map."""
    return np.log(np.abs(maps[0, 0] * maps[1, 1] - maps[0, 1] * maps[1, 0]))


def _store_resting(ends: dict, lane: NDArray, record: NDArray, going: NDArray, seen: int) -> None:
    """Store balls that stay on the table, or whose contact would resume below the table."""
    resting = np.delete(np.arange(lane.size), going)
    count = np.isfinite(record[:, 0, resting]).sum(axis=0)
    stays = np.isinf(record[count - 1, 4, resting])
    _store(
        ends,
        lane[resting],
        kind=np.where(stays, PERMANENT, UNDECIDED),
        periods=stays,
        reason=np.where(stays, "", RESUMES),
        followed=seen + count,
    )


def _store_end(ends: dict, lane: NDArray, after: Balls, which: Any, **values: Any) -> None:
    """Store results and the state at the next impact, for balls that keep bouncing."""
    _store(ends, lane, end_phase=after.phase[which], end_speed=after.speed[which], **values)


def _store_periodic(
    ends: dict, lane: NDArray, record: NDArray, after: Balls, again: dict, seen: int
) -> None:
    """Store balls whose motion is periodic.

    A ball sticks in a contact if the contact lasts more than twice as long as a free impact.
    """
    (some,) = again["repeats"].nonzero()
    again = _take(again, some)
    # If a free impact never ends, its T is NaN, and the comparison is false.
    free = after.ball.rows(some).free(np.abs(record[:, 2, some]))
    sticks = record[:, 3, some] > 2 * free
    of_lap = np.arange(len(record))[:, np.newaxis] >= len(record) - again["impacts"]
    _store_end(
        ends,
        lane[some],
        after,
        some,
        kind=np.where((sticks & of_lap).any(axis=0), LOCKED, PERIODIC),
        impacts=again["impacts"],
        periods=again["periods"],
        lyapunov_exponent=np.log(again["radius"]) / again["periods"],
        lyapunov_error=0.0,
        exponent_sum=again["areas"] / again["periods"],
        followed=seen + len(record),
    )


def _store_locked(
    ends: dict, track: dict, record: NDArray, after: Balls, lifts: NDArray, lap: NDArray, seen: int
) -> NDArray:
    """Store balls that lift off twice at the same phase; record the other lift-offs in ``track``.

    Returns whether each ball was stored, shape (balls,).
    """
    row = np.arange(lap.size)
    n = len(lifts)
    last = n - 1 - lifts[::-1].argmax(axis=0)
    at = PERIOD * record[:, 0] + record[:, 1] + record[:, 4]
    # Balls may leave the table at several phases. A motion repeats when one phase recurs.
    with np.errstate(invalid="ignore"):
        phase = np.where(lifts, record[:, 1] + record[:, 4], np.nan)
        same = apart(phase - phase[last, row], 0.0) < RETURNED
    earlier = lifts & same & (np.arange(n)[:, np.newaxis] < last)
    before = n - 1 - earlier[::-1].argmax(axis=0)
    twice = earlier.any(axis=0)
    before_all = apart(track["lifted_at"] - phase[last, row], 0.0) < RETURNED
    number = np.where(twice, seen + before, np.where(before_all, track["lifted"], -1))
    time = np.where(twice, at[before, row], track["lifted_at"])
    lifted = lifts.any(axis=0)
    track["lifted"] = np.where(lifted, seen + last, track["lifted"])
    track["lifted_at"] = np.where(lifted, at[last, row], track["lifted_at"])
    locked = lifted & (number >= 0)
    known = lap[locked] < ROUNDING_GROWTH
    _store_end(
        ends,
        track["lane"][locked],
        after,
        locked,
        kind=LOCKED,
        impacts=np.where(known, (track["lifted"] - number)[locked], 0),
        periods=np.where(known, np.round((track["lifted_at"] - time)[locked] / PERIOD), 0),
        reason=np.where(known, "", LOST_TO_ROUNDING),
        lyapunov_exponent=-np.inf,
        lyapunov_error=0.0,
        exponent_sum=-np.inf,
        followed=track["lifted"][locked] + 1,
    )
    return locked


def _store_others(ends: dict, balls: Balls, track: dict, seen: int) -> None:
    """Store balls that neither repeat nor come to rest.

    A ball is chaotic if neighbouring motions separate exponentially. Otherwise it is undecided.
    """
    for j, lane in enumerate(track["lane"]):
        growth, time, areas = track["sections"][:, :, j].T
        rate, scatter, error = exponent(growth, time, areas)
        if track["marginal"][j]:
            reason = MARGINAL
        elif rate > SIGNIFICANT * scatter and growth.sum() > ROUNDING_GROWTH:
            reason = ""
        elif rate < -SIGNIFICANT * scatter and track["most"][j] > ROUNDING_GROWTH:
            reason = LOST_TO_ROUNDING
        else:
            reason = NO_RECURRENCE if np.isfinite(error) else LITTLE_LOSS
        _store_end(
            ends,
            lane,
            balls,
            j,
            kind=UNDECIDED if reason else CHAOTIC,
            reason=reason,
            rested=track["lifted"][j] >= 0,
            lyapunov_exponent=PERIOD * rate,
            lyapunov_error=PERIOD * error,
            exponent_sum=PERIOD * areas.sum() / time.sum(),
            followed=seen,
        )


def exponent(growth: NDArray, time: NDArray, areas: NDArray) -> tuple[float, float, float]:
    """Estimate a growth rate from the sections of a motion.

    Nearly elastic balls change their energy slowly. The start of the motion is therefore ignored:
    the first quarter of the sections, or the first `SETTLING_LENGTHS` relaxation lengths if these
    are longer. Neighbouring sections are correlated, so the error is the maximum over blocks of 1,
    2, 4, ... sections (Flyvbjerg and Petersen, J. Chem. Phys. 91, 461, 1989). The error is
    multiplied by the ratio of a quantile of Student's t distribution to the same quantile of the
    normal distribution.

    Parameters
    ----------
    growth, time, areas : array, shape (sections,)
        Log growth, duration and log area contraction of each section.

    Returns
    -------
    rate : float
        Growth per unit time.
    scatter : float
        Standard error, if sections were independent.
    error : float
        Standard error that allows for correlation: ±2 errors are a 95 % interval. NaN if fewer than
        `TELLING_LENGTHS` relaxation lengths remain.

    Examples
    --------
    >>> rate, scatter, error = exponent(np.array([1.0, 3.0] * 8), np.ones(16), np.full(16, -9.0))
    >>> float(rate), round(float(scatter), 2)
    (2.0, 0.3)
    """
    lengths = -np.cumsum(areas)
    first = max(growth.size // 4, int(np.searchsorted(lengths, SETTLING_LENGTHS)))
    first = min(first, max(growth.size - 2, 0))
    rate = growth[first:].sum() / time[first:].sum()
    if growth.size < 2:
        return rate, np.inf, np.nan
    residual = growth[first:] - rate * time[first:]
    errors: list[NDArray] = []
    while residual.size >= (4 if errors else 2):
        n = residual.size
        error = np.sqrt(n / (n - 1) * np.sum(residual**2)) / time[first:].sum()
        errors.append(error * np.array([1.0, stdtrit(n - 1, 0.975) / 1.96]))
        residual = residual[: n // 2 * 2].reshape(-1, 2).sum(axis=1)
    widest = np.max(errors, axis=0)[1]
    tells = lengths[-1] - lengths[first] >= TELLING_LENGTHS
    return rate, errors[0][0], widest if tells else np.nan


OF_MOTIONS = DESCRIPTIONS | {
    "kind": ("kind of motion on which the ball ends", "", "1"),
    "impacts": ("impacts until the motion repeats, 0 if it does not", "k", "1"),
    "periods": ("periods of the table until the motion repeats, 0 if it does not", "m", "1"),
    "lyapunov_exponent": ("largest Lyapunov exponent, per period of the table", "λ", "1"),
    "lyapunov_error": ("error of the exponent: twice it on both sides are 95 %", "", "1"),
    "exponent_sum": ("sum of both Lyapunov exponents, per period of the table", "", "1"),
    "reason": ("why the motion is undecided, or its period not known", "", "1"),
    "followed": ("number of impacts for which the ball was followed", "", "1"),
    "end_phase": ("phase of the table at an impact of the motion", "φ", "rad"),
    "end_velocity": ("velocity of the ball before that impact", "z′", "1"),
    "speed": ("closing speed of the first impact", "u", "1"),
    "destination": ("number of the motion on which a start ends", "", "1"),
    "motion": ("number of a motion", "", "1"),
    "share": ("share of the starts that end on the motion", "", "1"),
    "share_error": ("standard error of the share", "", "1"),
    "start": ("number of the start", "", "1"),
    "impact_speed": ("closing speed of the impact", "u", "1"),
}
"""Long name, symbol and unit of the variables of datasets of motions."""


def motion_of(
    ball: Ball,
    *,
    amplitude: Values,
    phase: Values = 0.0,
    velocity: Values = None,
    relative_velocity: Values = None,
    impacts: int = 2000,
    table: Table = SINE,
    progress: Callable | None = None,
) -> xr.Dataset:
    """Find the motion on which a ball ends. The first impact is given as in :func:`.simulate`.

    Parameters
    ----------
    ball, amplitude, phase, velocity, relative_velocity, table
        As in :func:`.simulate`. Arrays span a grid.
    impacts : int
        Number of impacts after which the search for a repetition ends. It is rounded up to a
        multiple of 25.
    progress : callable, optional
        Function that receives a line of text every two seconds, such as ``print``. By default
        the lines appear in a terminal only.

    Returns
    -------
    xarray.Dataset
        Variables over the grid:

        - ``kind``: "periodic", "locked", "permanent contact", "chaotic" or "undecided". A locked
          motion is periodic, and the ball sticks to the table in each period.
        - ``reason``: why the motion is undecided, or why its period is unknown.
        - ``impacts``, ``periods``: number of impacts, and of periods of the table, until the motion
          repeats; 0 if it does not. They are also 0 for a locked motion if rounding errors
          determine them; ``reason`` then reports this. Bounces that are summed up before a rest do
          not count.
        - ``lyapunov_exponent``: largest Lyapunov exponent per period of the table.
        - ``lyapunov_error``: error of the exponent; 0 if the motion repeats.
        - ``exponent_sum``: sum of both Lyapunov exponents, per period of the table.
        - ``followed``: number of impacts for which the ball was followed.
        - ``end_phase``, ``end_velocity``: phase of the table at one impact of the motion, and
          velocity of the ball before this impact.

    Raises
    ------
    ValueError
        As :func:`.simulate`.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> motions = motion_of(Rigid(0.5), amplitude=[0.5, 1.2, 1.6])
    >>> motions.kind.values.tolist(), motions.impacts.values.tolist()
    (['permanent contact', 'periodic', 'periodic'], [0, 1, 2])
    """
    grid, balls = first_impacts(ball, amplitude, phase, velocity, relative_velocity, table)
    effort = Effort("motion_of", np.inf, progress)
    return dataset_of(grid, balls.amplitude, table, ends_of(balls, impacts, effort, "the balls"))


def dataset_of(grid: xr.DataArray, amplitude: Values, table: Table, ends: dict) -> xr.Dataset:
    """Convert the results of :func:`ends_of` to a dataset over a grid."""
    variables = ends.copy()
    variables["end_velocity"] = amplitude * table(ends["end_phase"], 1) - variables.pop("end_speed")
    del variables["rested"]
    variables |= {name: ends[name].astype(str) for name in ("kind", "reason")}
    return dataset(grid, variables, OF_MOTIONS)


def lyapunov(
    ball: Ball,
    *,
    amplitude: Values,
    phase: Values = 0.0,
    velocity: Values = None,
    relative_velocity: Values = None,
    impacts: int = 2000,
    neighbours: int = NEIGHBOURS,
    table: Table = SINE,
    progress: Callable | None = None,
) -> xr.Dataset:
    """Compute the Lyapunov exponents of the motion on which a ball ends; see :func:`motion_of`.

    Parameters
    ----------
    ball, amplitude, phase, velocity, relative_velocity, impacts, table, progress
        As in :func:`motion_of`.
    neighbours : int
        Number of neighbours of each motion that looks chaotic. They start next to its last state,
        and each is followed for up to ``impacts`` impacts. If a neighbour comes to rest on the
        table or repeats its motion, the chaos may be a transient. The kind is then "undecided", and
        the exponent is NaN. With 0 neighbours, transients are not detected, and a ball with a
        contact law takes a quarter of the time.

    Returns
    -------
    xarray.Dataset
        Variables of :func:`motion_of`. The exponent of a periodic motion is ln|μ|/m, where μ is the
        multiplier with the larger modulus. It is -∞ if the later motion does not depend on earlier
        impacts. The error is NaN if a ball was followed for too few relaxation lengths; one such
        length is about 1/(1 - r²) impacts. A ``reason`` concerns the kind or the period of
        the motion; its exponent is right unless it is NaN.

    Warnings
    --------
    With a contact law, 2,000 impacts of a chaotic ball take 1 to 9 s of processor time, and with 32
    neighbours 5 s to a minute. ``simscape_contact`` takes longest.

    Examples
    --------
    The multipliers of the 1-T orbit are complex, and their modulus is r:

    >>> from bouncing_ball_beyond import Rigid
    >>> motion = lyapunov(Rigid(0.85), amplitude=1.0, phase=1.1)
    >>> round(float(np.exp(motion.lyapunov_exponent)), 6)
    0.85
    """
    neighbours = whole_number("neighbours", neighbours, 0)
    grid, balls = first_impacts(ball, amplitude, phase, velocity, relative_velocity, table)
    effort = Effort("lyapunov", np.inf, progress)
    ends = ends_of(balls, impacts, effort, "the balls")
    (chaotic,) = (ends["kind"] == CHAOTIC).nonzero()
    beside = np.repeat(chaotic, neighbours)
    shift = RETURNED * np.tile(np.arange(1, neighbours + 1), chaotic.size)
    states = {"phase": ends["end_phase"][beside], "speed": ends["end_speed"][beside] + shift}
    near = ends_of(replace(balls.take(beside), **states), impacts, effort, "their neighbours")
    repeats = np.isin(near["kind"], [CHAOTIC, UNDECIDED], invert=True)
    # After a rest all motions are the same, and a second rest would repeat it.
    leaves = chaotic[(repeats | near["rested"]).reshape(chaotic.size, neighbours).any(axis=1)]
    _store(
        ends,
        leaves,
        kind=UNDECIDED,
        reason=TRANSIENT,
        lyapunov_exponent=np.nan,
        lyapunov_error=np.nan,
    )
    return dataset_of(grid, balls.amplitude, table, ends)


def fastest(ball: Ball, amplitude: Values, table: Table = SINE) -> Values:
    """Return a speed above which every impact slows the ball: (1 + r) max(V, 1)/(1 - r).

    V is the maximum speed of the table, which is Λ for a sine. After an impact at the absolute
    speed v, the speed is at most r v + (1 + r) V. This is less than v if v is above the returned
    speed. r is the restitution coefficient of a free impact at the speed 2π, or 0 if that impact
    never ends. A divisor 1 - r below 0.05 is replaced by 0.05.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> float(fastest(Rigid(0.5), 2.0))
    6.0
    """
    r = np.nan_to_num(ball.signature(PERIOD).restitution)
    return (1 + r) * np.maximum(amplitude * table.bounds[1], 1.0) / np.maximum(1 - r, 0.05)


def basins(
    ball: Ball,
    *,
    amplitude: Values,
    starts: int = 200,
    relative_velocity_max: float | None = None,
    impacts: int = 2000,
    table: Table = SINE,
    progress: Callable | None = None,
) -> xr.Dataset:
    """Start balls from a grid of first impacts, and find the motions on which they end.

    Parameters
    ----------
    ball : Ball
        A single ball.
    amplitude : float
        Λ.
    starts : int
        Number of starts along each axis. The axes are the phase of the table and the closing speed.
    relative_velocity_max : float, optional
        Largest closing speed. The default is (1 + r) max(V, 1)/(1 - r), where V is the maximum
        speed of the table. A divisor 1 - r below 0.05 is replaced by 0.05. If r ≤ 0.95, every
        impact above the default slows the ball.
    table : Table
        Waveform of the table, by default a sine.
    impacts : int
        Maximum number of impacts of a ball, as in :func:`motion_of`. A ball is followed until
        its motion is known.
    progress : callable, optional
        As in :func:`motion_of`.

    Returns
    -------
    xarray.Dataset
        One variable over the grid of starts:

        - ``destination``: number of the motion on which the start ends.

        Variables over the axis ``motion``:

        - ``kind``, ``impacts``, ``periods``: as in :func:`motion_of`.
        - ``share``, ``share_error``: share of the starts that end on the motion, and its standard
          error.
        - ``end_phase``, ``end_velocity``: fastest impact of the motion.

        Two motions that repeat count as one motion only if their impacts agree. All motions of one
        kind with an unknown period count as one motion, and its fastest impact is NaN. The
        attribute ``impacts`` is the argument of the same name.

    Raises
    ------
    ValueError
        If the ball or the amplitude is an array.

    Warnings
    --------
    A motion that is "chaotic" after ``impacts`` impacts may be a long transient. For ϖ = 15,
    r = 0.7, Λ = 1.3 and 60 starts along each axis, 2 % are chaotic after 2,000 impacts, and 0 %
    after 20,000.

    Rounding errors determine where a chaotic transient ends. An example is Tsuji's law with
    r = 0.85, a duration of 0.1 at the speed 3, and Λ = 1.2. A relative change of 10⁻¹⁴ in the first
    speeds changes the end of 21 of 900 balls. This is less than the standard errors of the shares.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> motions = basins(Rigid(0.5), amplitude=1.2, starts=20)
    >>> sorted(motions.kind.values.tolist()), float(motions.share.sum())
    (['locked', 'periodic'], 1.0)
    """
    check_one_ball(ball)
    check_table(table)
    amplitude = one_number("amplitude", amplitude, low_allowed=True)
    middle = (np.arange(whole_number("starts", starts)) + 0.5) / starts
    fast = (
        fastest(ball, amplitude, table) if relative_velocity_max is None else relative_velocity_max
    )
    checked("relative_velocity_max", fast, 0, np.inf, low_allowed=False)
    grid, ball, (amplitude, u, tau) = grid_of(
        ball, amplitude=amplitude, speed=fast * middle, phase=PERIOD * middle - np.pi
    )
    balls = Balls(ball, amplitude, 0 * tau, tau, u, table)
    effort = Effort("basins", np.inf, progress)
    which, motions = told_apart(balls, ends_of(balls, impacts, effort, "the balls"))
    share = np.bincount(which) / which.size
    values = {name: np.array(column) for name, column in motions.items()} | {
        "share": share,
        "share_error": np.sqrt(share * (1 - share) / which.size),
        "motion": np.arange(share.size),
    }
    destinations = dataset(grid, {"destination": which}, OF_MOTIONS)
    destinations = destinations.assign({name: ("motion", value) for name, value in values.items()})
    return described(destinations.assign_attrs(impacts=impacts), OF_MOTIONS)


def told_apart(balls: Balls, ends: dict) -> tuple[NDArray, dict]:
    """Distinguish the motions on which balls end.

    Returns

    1. the index of the motion of each ball, shape (balls,);
    2. the properties of the motions: by name, an array with an entry for each motion.
    """
    kinds = ends["kind"].astype(str)
    balls = replace(balls, phase=ends["end_phase"], speed=ends["end_speed"])
    which = np.full(kinds.size, -1)
    motions: list[tuple] = []
    while (which < 0).any():
        first = int(which.argmin())
        kind = kinds[first]
        k, periods = (int(ends[name][first]) for name in ("impacts", "periods"))
        same = (kinds == kind) & (ends["impacts"] == k) & (ends["periods"] == periods)
        (same,) = (same & (which < 0)).nonzero()
        fastest_impact = np.nan, np.nan
        if k:
            # A ball on the same motion ends at an impact of this motion.
            phase, u = bounce(balls.take(np.array([first])), k)[0][:, 1:3, 0].T
            amplitude = balls.amplitude[first]
            near = np.full(same.size, np.inf)
            for impact_phase, speed in zip(phase, u, strict=True):
                away = (
                    balls.phase[same] - impact_phase,
                    (balls.speed[same] - speed) / (1 + amplitude),
                )
                near = np.fmin(near, apart(*away))
            same = same[near < NEAR_BEFORE]
            i = int(u.argmax())
            fastest_impact = phase[i], amplitude * balls.table(phase[i], 1) - u[i]
        which[same] = len(motions)
        motions.append((kind, k, periods, *map(float, fastest_impact)))
    order = sorted(range(len(motions)), key=motions.__getitem__)
    columns = zip(*(motions[i] for i in order), strict=True)
    names = "kind", "impacts", "periods", "end_phase", "end_velocity"
    return np.argsort(order)[which], dict(zip(names, columns, strict=True))


def orbit_diagram(
    ball: Ball,
    *,
    amplitude: Values,
    starts: int = 6,
    samples: int = 64,
    impacts: int = 2000,
    table: Table = SINE,
    progress: Callable | None = None,
) -> xr.Dataset:
    """Find the motions on which balls end, for each value of Λ or of a parameter of the ball.

    Parameters
    ----------
    ball : Ball
    amplitude : float or array
        Λ. Either Λ or one parameter of the ball must be an array.
    starts : int
        Number of balls at each value. Their starts are spread evenly over phases and speeds. The
        same number of balls starts from the final states at the next larger value, and again the
        same number from the final states at the next smaller value. Motions are thus followed in
        both directions.
    samples : int
        Number of recorded impacts of each motion.
    impacts, table, progress
        As in :func:`motion_of`.

    Returns
    -------
    xarray.Dataset
        Variables of :func:`motion_of` for each ``start``. In addition, ``impact_phase`` and
        ``impact_speed`` of each ``impact``; they are NaN in permanent contact.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> diagram = orbit_diagram(Rigid(0.5), amplitude=[1.5, 1.6], starts=4, impacts=200)
    >>> diagram.impacts.isel(start=2).values.tolist()
    [1, 2]
    """
    check_table(table)
    grid, ball, (amplitude,) = grid_of(ball, amplitude=amplitude)
    if grid.ndim != 1:
        raise ValueError("amplitude, ball: exactly one parameter must be an array")
    value, start = np.mgrid[: grid.size, : whole_number("starts", starts)].reshape(2, -1)
    phase = PERIOD * (LOW_DISCREPANCY[0] * (start + 1) % 1)
    several = ball.rows(value)
    speed = fastest(several, amplitude[value], table) * (LOW_DISCREPANCY[1] * (start + 1) % 1)
    balls = Balls(several, amplitude[value], 0 * phase, phase, speed, table)
    effort = Effort("orbit_diagram", np.inf, progress)
    passes = [ends_of(balls, impacts, effort, "the first starts")]
    for step in (1, -1):
        beside = np.clip(value + step, 0, grid.size - 1) * starts + start
        phase, speed = (passes[0][name][beside] for name in ("end_phase", "end_speed"))
        moves = np.isfinite(phase)
        phase = np.where(moves, phase, balls.phase)
        speed = np.where(moves, speed, balls.speed)
        beside = replace(balls, phase=phase, speed=speed)
        passes.append(ends_of(beside, impacts, effort, "starts from the ends at other values"))
    shape = grid.size, starts
    ends = {
        name: np.hstack([motions[name].reshape(shape) for motions in passes]).ravel()
        for name in passes[0]
    }
    value = np.repeat(np.arange(grid.size), len(passes) * starts)
    state = ends["end_phase"], ends["end_speed"]
    balls = Balls(ball.rows(value), amplitude[value], 0.0 * value, *state, table)
    (moving,) = np.isfinite(balls.phase).nonzero()
    impact = np.full((2, value.size, samples), np.nan)
    impact[:, moving] = np.moveaxis(bounce(balls.take(moving), samples)[0][:, 1:3], 0, -1)
    variables = dict(zip(("impact_phase", "impact_speed"), impact, strict=True))
    grid = grid.expand_dims(start=np.arange(len(passes) * starts), axis=1)
    recorded = dataset(grid, variables, OF_MOTIONS, impact=np.arange(samples))
    return dataset_of(grid, balls.amplitude, table, ends).merge(recorded)
