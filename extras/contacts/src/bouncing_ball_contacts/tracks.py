"""Positions of a ball in a film or of a sensor to the tracks of its impacts.

A flight is a parabola, so positions show by themselves what is wrong with them: copies of a frame,
outliers, and frames that are missing. An impact lies between two flights.
"""

import itertools
import math
from collections.abc import Sequence

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from bouncing_ball_contacts.flights import impact_of
from bouncing_ball_contacts.units import STANDARD_GRAVITY, Array

FEWEST = 4
"""Positions that a flight has at least, without positions next to impacts."""
# Number of steps between two flights above which an impact is not used: positions are missing.
_LONGEST_GAP = 10
# Median of the absolute value of a normally distributed number with the standard deviation 1.
_MEDIAN = 0.6745


def speeds_of_film(tracks: Sequence[Array], drag: float, has_clock: bool) -> Array:
    """Return the speeds in m/s before and after the impacts of a film, shape (n, 2).

    Gravity is the scale of each impact. Without a clock positions are in m, and times are scaled
    until gravity is the standard one.

    A camera that moves, or that is tilted while the ball moves sideways, adds one speed to all
    positions. It is the speed at which the floor moves from impact to impact, and is subtracted.

    Parameters
    ----------
    tracks : sequence of arrays
        Of each impact, as of `impact_of`.
    drag : float
        ρ C A/(2 m) in 1/m.
    has_clock : bool
        Whether times are true.
    """
    for _ in range(1 if has_clock else 5):
        before, after, gravity, _, time, floor = np.transpose([impact_of(x, drag) for x in tracks])
        slow = 1.0 if has_clock else math.sqrt(max(gravity.mean() / STANDARD_GRAVITY, 1e-9))
        tracks = [each * [slow, 1, 1] for each in tracks]
    since = time - time.mean()
    moves = since @ floor / max(since @ since, 1e-9)
    speeds = np.column_stack([before + moves, after - moves])
    return speeds * (STANDARD_GRAVITY / gravity)[:, None]


def _third_differences(t: Array, y: Array) -> Array:
    """Return the sizes of the third divided differences of positions, shape (n - 3,).

    Those of a parabola vanish. Those of errors are scaled to the size of the errors.
    """
    times = sliding_window_view(t, 4)
    weights = 1 / np.prod(times[:, :, None] - times[:, None] + np.eye(4), axis=2)
    third = np.sum(weights * sliding_window_view(y, 4), axis=1)
    return np.abs(third) / np.sqrt(np.sum(weights**2, axis=1))


def copies(y: Array, digit: float) -> NDArray[np.bool_]:
    """Return which positions repeat the one before, while the ball moves on in one direction.

    Rounded positions repeat near a top, where the ball moves by one digit. Around a copy it moves
    by three digits or more.
    """
    begins = np.flatnonzero(np.diff(y, prepend=math.nan) != 0)
    moves = np.diff(y[begins])
    ways = np.sign(moves) * (np.abs(moves) > 2.5 * digit)
    goes_on = np.zeros(len(begins), bool)
    goes_on[1:-1] = ways[:-1] * ways[1:] > 0
    is_copy = np.repeat(goes_on, np.diff([*begins, len(y)]))
    is_copy[begins] = False
    return is_copy


def outliers(t: Array, y: Array, digit: float) -> NDArray[np.bool_]:
    """Return which positions are no positions of a ball.

    A ball that bounces is at most two steps away from the median of seven positions around it. Each
    position, also next to an impact, lies on a parabola with three neighbours.
    """
    # Importing it takes longer than all else here.
    from scipy.ndimage import median_filter

    steps = median_filter(np.abs(np.diff(y, prepend=y[0])), 11)
    is_out: NDArray[np.bool_] = np.abs(y - median_filter(y, 7)) > 5 * steps + 3 * digit
    left = np.flatnonzero(~is_out)
    third = _third_differences(t[left], y[left])
    padded = np.pad(third, 3, constant_values=math.inf)
    smallest = np.min(sliding_window_view(padded, 4), axis=1)
    is_out[left] = smallest > 5 * max(float(np.median(third)) / _MEDIAN, digit)
    return is_out


def flights_of(t: Array, up: Array) -> tuple[list[NDArray[np.intp]], list[int]]:
    """Return the indices of each flight, without positions next to impacts, and the impacts."""
    from scipy.signal import find_peaks

    noise = float(np.median(_third_differences(t, up))) / _MEDIAN
    bottoms = find_peaks(-up, prominence=max(0.02 * np.ptp(up), 6 * noise))[0].tolist()
    edges = [-2, *bottoms, len(up) + 1]
    flights = [np.arange(a + 2, b - 1) for a, b in itertools.pairwise(edges)]
    if bottoms:
        # A hand may hold the ball at first, and at last it may lie still: the first flight begins
        # below 0.9 of its height, and the last one ends below 0.1 of it.
        fall = up[: bottoms[0]] - up[bottoms[0]]
        held = np.flatnonzero(fall > 0.9 * fall.max()).max()
        flights[0] = flights[0][flights[0] > held]
        rise = up[bottoms[-1] :] - up[bottoms[-1]]
        top = int(np.argmax(rise))
        down = np.flatnonzero(rise[top:] < 0.1 * rise[top]).min(initial=len(rise))
        flights[-1] = flights[-1][flights[-1] < bottoms[-1] + top + down]
    return flights, bottoms


def impacts_of_track(t: Array, up: Array) -> dict[int, Array]:
    """Return the tracks of impacts between two flights, by the indices of their lowest positions.

    A track has the columns time, position, and 1 after the impact or else 0.
    """
    flights, bottoms = flights_of(t, up)
    longest = _LONGEST_GAP * float(np.median(np.diff(t)))
    impacts = {}
    for bottom, (before, after) in zip(bottoms, itertools.pairwise(flights), strict=True):
        # Where positions are missing, other impacts may be, too.
        if min(len(before), len(after)) < FEWEST or t[after[0]] - t[before[-1]] > longest:
            continue
        both = np.concatenate([before, after])
        track = np.column_stack([t[both], up[both], np.isin(both, after)])
        v_before, v_after, gravity, misfit, *_ = impact_of(track)
        # What misses the positions by more than a twentieth of the height is no flight, and what
        # leaves faster than it came is hit.
        slowest = min(v_before, v_after)
        is_flight = gravity > 0 and misfit < 0.05 * slowest**2 / (2 * gravity)
        if is_flight and 0 < v_after < 1.05 * v_before:
            impacts[bottom] = track
    return impacts
