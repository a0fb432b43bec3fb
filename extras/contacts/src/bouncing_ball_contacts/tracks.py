"""Positions of a ball in a film or of a sensor to the tracks of its impacts.

A flight is a parabola, so positions show by themselves what is wrong with them: copies of a frame,
outliers, and frames that are missing. An impact lies between two flights.
"""

import itertools
import math

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from bouncing_ball_contacts.flights import impact_of
from bouncing_ball_contacts.units import Array, holding

FEWEST = 4
"""Positions that a flight has at least, without positions next to impacts."""
# Standard error of ln r above which an impact is not used.
_MOST = 0.05
# Why an impact is not used.
_FEW = f"there are fewer than {FEWEST} positions before or after it"
_GAP = "positions are missing around it for so long that another impact may be missing, too"
_LOW = f"by the positions before and after it r is known to {_MOST:.0%} at best"
_NO_PARABOLAS = "no two flights meet there: does the tracker jump, as to another ball?"
_HIT = "the ball leaves faster than it came"
TOLD = (_GAP, _NO_PARABOLAS, _HIT)
"""Reasons that are said of an answer, too: at its end each film has impacts with the others."""
# Median of the absolute value of a normally distributed number with the standard deviation 1.
_MEDIAN = 0.6745


def _third_differences(t: Array, y: Array) -> Array:
    """Return the sizes of the third divided differences of positions, shape (n - 3,).

    Those of a parabola vanish. Those of errors are scaled to the size of the errors.
    """
    times = sliding_window_view(t, 4)
    weights = 1 / np.prod(times[:, :, None] - times[:, None] + np.eye(4), axis=2)
    third = np.sum(weights * sliding_window_view(y, 4), axis=1)
    return np.abs(third) / np.sqrt(np.sum(weights**2, axis=1))


def _noise(t: Array, y: Array) -> float:
    """Return the standard deviation of the errors of positions."""
    return float(np.median(_third_differences(t, y))) / _MEDIAN if len(t) > 3 else math.inf


def _repeats(t: Array, y: Array) -> NDArray[np.bool_]:
    """Return which positions are the one before within errors, between moves in one direction.

    From up to four frames of one picture a tracker reads positions that differ by its errors. The
    velocity among them is less than a third of those before and after.
    """
    is_repeat = np.diff(y, prepend=math.nan) == 0
    for count in range(1, min(4, len(y) - 2)):
        moves, steps = (
            np.diff(sliding_window_view(samples, count + 3), axis=1) for samples in (y, t)
        )
        before, after = moves[:, 0] / steps[:, 0], moves[:, -1] / steps[:, -1]
        within = np.max(np.abs(np.cumsum(moves[:, 1:-1], axis=1) / steps[:, 1:-1]), axis=1)
        is_among = np.minimum(np.abs(before), np.abs(after)) > 3 * within
        begins = np.flatnonzero(is_among & (before * after > 0)) + 2
        is_repeat[begins[:, None] + np.arange(count)] = True
    return is_repeat


def copies(t: Array, y: Array, digit: float) -> NDArray[np.bool_]:
    """Return which positions repeat the one before, while the ball moves on in one direction.

    Rounded positions repeat near a top, where the ball moves by one digit. Around a copy it moves
    by three digits or more. Errors let positions repeat by chance, so that a film has copies only
    if the ball moves by 15 errors around one of them: then a third of the move is 4.5 errors of it.
    """
    begins = np.flatnonzero(~_repeats(t, y))
    moves = np.diff(y[begins])
    ways = np.zeros(len(begins))
    ways[1:-1] = np.minimum(*np.abs([moves[:-1], moves[1:]])) * (moves[:-1] * moves[1:] > 0)
    around = np.repeat(ways, np.diff([*begins, len(y)]))
    around[begins] = 0
    has_copies = around.max(initial=0) > 15 * _noise(t[begins], y[begins])
    return has_copies & (around > 2.5 * digit)


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

    # Where a ball turns at its top, errors of many positions make hills of six errors.
    prominence = max(0.02 * np.ptp(up), 10 * _noise(t, up))
    bottoms = find_peaks(-up, prominence=prominence)[0].tolist()
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


def impacts_of_track(t: Array, up: Array) -> tuple[dict[int, Array], dict[int, str]]:
    """Return the tracks of impacts between two flights, and why others are not used.

    Both are by the indices of the lowest positions. A track has the columns time, position, and 1
    after the impact or else 0.

    The parabolas on both sides decide, whatever the frame rate. They meet while no position is
    seen. A bounce that is not seen lasts for T, and the next one for r T. The parabolas around both
    meet below the floor, from where the next bounce lasts for r T + 2T/(1 + r), less than 2T: so no
    bounce is missing if positions are missing for less than half of it.
    """
    flights, bottoms = flights_of(t, up)
    noise = _noise(t, up)
    step = np.median(np.diff(t))
    impacts: dict[int, Array] = {}
    unused: dict[int, str] = {}
    for bottom, (before, after) in zip(bottoms, itertools.pairwise(flights), strict=True):
        if min(len(before), len(after)) < FEWEST:
            unused[bottom] = _FEW
            continue
        span = np.arange(before[0], after[-1] + 1)
        edges = t[before[FEWEST - 1]], t[after[-FEWEST]]
        meet = t[bottom]
        # The lowest position that is seen may lie on either side of an impact that is not seen.
        for _ in range(3):
            both = span[np.abs(t[span] - meet) > 1.5 * step]
            track = np.column_stack([t[both], up[both], t[both] > meet])
            v_before, v_after, gravity, misfit, meet, _, error = impact_of(track)
            meet = np.clip(meet, *edges)
        missing = np.ptp(t[np.searchsorted(t, meet) + [-1, 0]])
        height = min(v_before, v_after) ** 2 / (2 * gravity)
        # What misses the positions by more than a twentieth of the height is no flight.
        is_flight = misfit < 0.05 * height and edges[0] < meet < edges[1]
        said = [
            (gravity <= 0 or v_after <= 0, _NO_PARABOLAS),
            (missing * gravity > v_after, _GAP),
            (not is_flight, _LOW if misfit < 3 * noise else _NO_PARABOLAS),
            (error > _MOST, _LOW),
            # What leaves faster than it came is hit.
            (v_after >= 1.05 * v_before, _HIT),
        ]
        reasons = holding(said)
        if reasons:
            unused[bottom] = reasons[0]
        else:
            impacts[bottom] = track
    return impacts, unused
