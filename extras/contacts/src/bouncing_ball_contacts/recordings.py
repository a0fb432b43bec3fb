"""Recordings of bounces: what was measured, and the flights, heights or pairs of it.

1. The quantities of a table (:mod:`.tables`) say what was measured: the first of the layouts that
   they have.
2. Numbers are grouped into series. A number that is missing divides a series, whether its cell or
   its line is empty, it is no number, or its line is left out.
3. Positions over time and signals are samples, of which a missing one does not matter: of them the
   flights between impacts are found.

Series that no ball has are refused, with their line.
"""

import itertools
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_contacts.flights import impact_of
from bouncing_ball_contacts.schemes import Array
from bouncing_ball_contacts.tables import (
    HEADINGS,
    KEYS,
    PLAUSIBLE,
    QUANTITY,
    RECORDING,
    SI,
    TIMES,
    Column,
    Lines,
    Table,
    check,
    columns_of,
    counts,
    digit_of,
    number_in,
    table_of,
    text_of,
    values_of,
)
from bouncing_ball_contacts.units import STANDARD_GRAVITY, Refused, in_si, positive

_Run = tuple[Array, Lines]
_Layouts = tuple[tuple[str, tuple[str, ...]], ...]

_UNSORTED = "the one before: sort the lines, or leave an empty line where another recording begins"
# What was measured is the first row whose quantities are all there. Pairs come first: a time beside
# them says nothing more.
_PAIRS: _Layouts = (
    ("drops", ("height before", "height after")),
    ("speeds", ("speed before", "speed after")),
    ("coefficients", ("speed", "coefficient")),
    ("coefficients", ("speed before", "coefficient")),
)
_SERIES: _Layouts = (
    ("signal", ("time", "force")),
    ("track", ("time", "position")),
    ("signal", ("time", "signal")),
    ("track", ("time", "height")),
    ("flights", ("time",)),
    ("flights", ("interval",)),
    ("heights", ("height",)),
)
# Numbers of a pair that lacks its other half are no series.
_HALVES = {"height before", "height after", "speed before", "speed after", "coefficient"}
# An error of a reading may let a flight or a height be that of the one before times this.
_GROWTH = 1.02
# A signal is quiet for at least this time between impacts, in s.
_QUIET = 0.03
# Flights of a track have at least so many positions, without those beside an impact.
_FEWEST = 4
# Seconds of which times may be multiples, the longest first: frames of cameras, also of those whose
# rate is 29.97 in place of 30, and decimals.
_FRAMES = np.outer(1 / np.array([10.0, 24, 25, 30, 50, 60, 100, 120, 240]), [1, 1.001]).ravel()
# Times are taken as those of frames if so few others are multiples by chance.
_CHANCE = 1e-3


@dataclass(frozen=True)
class Recording:
    """What was measured.

    ``kind`` is "flights" (durations of successive flights in s), "heights" (successive tops),
    "drops" (pairs of heights), "speeds" (pairs), "coefficients" (pairs of speed and r), or "track".

    ``chains`` are arrays, one for each recording; those of pairs have two columns. A track has one
    for each impact, with the columns time, position, and 1 after the impact or else 0. A flight is
    the time from touch to touch, which includes the contact at its begin, unless flights are free
    of contact, ``is_free``; ``are_times`` is whether it is the difference of two measured times.
    ``digit`` is the last digit with which readings are written, in SI units, or 0; heights from
    which a ball is dropped and speeds of coefficients are set, and not read. ``uncertainty`` has
    standard deviations of r, ``durations`` contact times in s, one or one for each impact (of
    flights: for each touch); ``head`` has what the file says of the ball.
    """

    name: str
    kind: str
    chains: tuple[Array, ...]
    uncertainty: Array | None = None
    durations: Array | None = None
    is_free: bool = False
    are_times: bool = False
    digit: float = 0.0
    head: dict[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


def _frame_of(recording: Recording) -> float:
    """Return the longest frame in s of which all times are multiples, or 0.

    It is that of the frame rate, if the file has one. Within frames the times of a recording may
    spread over w, which is 1/20 or the digit with which they are written. By chance those of n
    different flights do so with the probability (n + 1) wⁿ, or wⁿ if frames have all their digits.
    Flights of one ball may be alike, and say nothing new. Intervals may have been rounded one by
    one, with errors that do not cancel.
    """
    if not recording.are_times:
        return 0.0
    rate = recording.head.get("frame rate")
    frames = _FRAMES if rate is None else 1 / np.array([number_in(rate.split()[0])])
    share = np.maximum(0.05, recording.digit / frames)
    # Numbers of a computer have errors of 1e-16.
    digits = frames / (recording.digit or 1e-12)
    are_written = np.abs(digits - np.round(digits)) < 1e-9 * digits
    within = np.where(are_written, 0.05, share)
    counts = np.round(np.concatenate(recording.chains) / frames[:, None])
    are_multiples = np.all(counts > 0, axis=1)
    chance = share ** [len(np.unique(each)) for each in counts]
    for flights in recording.chains:
        times = np.insert(flights, 0, 0.0) / frames[:, None]
        spread = np.ptp(np.cumsum(times - np.round(times), axis=1), axis=1)
        are_multiples &= spread < within + 1e-9
        chance *= np.where(are_written, 1, times.shape[1])
    are_frames = are_multiples & ((chance < _CHANCE) | (rate is not None))
    return float(next(iter(frames[are_frames]), 0.0))


def rounding_of(recording: Recording) -> float:
    """Return the frame or the last digit of the readings in SI units, or 0.

    Three readings are needed for a digit, because numbers lose zeros at their end.
    """
    has_digit = sum(map(len, recording.chains)) >= 3
    return max(_frame_of(recording), recording.digit * has_digit)


# Numbers to series.


def _runs(values: Array, lines: Lines) -> list[_Run]:
    """Return the numbers between missing ones, with their lines."""
    pieces = np.ma.clump_unmasked(np.ma.masked_invalid(values))
    return [(values[piece], lines[piece]) for piece in pieces]


def _groups(roles: dict[str, list[Column]], is_missing: NDArray[np.bool_]) -> list[Lines]:
    """Return the rows of each recording, divided where the count of bounces jumps."""
    jumps = [
        np.diff(each.numbers, prepend=each.numbers[0]) > 1
        for each in roles.get("count", [])
        if counts(each.numbers)
    ]
    texts = roles["recording"][0].texts if "recording" in roles else [""] * len(is_missing)
    # A name that is empty, or never beside a number, is that of the row above.
    known = {text for text, missing in zip(texts, is_missing, strict=True) if text and not missing}
    name = ""
    names = [name := text if text in known else name for text in texts]
    parts = [*zip(names, np.cumsum(sum(jumps, 0 * is_missing)).tolist(), strict=True)]
    return [
        np.array([i for i, each in enumerate(parts) if each == part])
        for part in dict.fromkeys(parts)
    ]


def _series(table: Table, columns: list[Column], groups: list[Lines]) -> list[_Run]:
    """Return series that run down columns, or along lines if only those make sense."""
    matrix = np.column_stack([values_of(table, each) for each in columns])
    lines = np.broadcast_to(table.lines[:, None], matrix.shape)
    down = [
        run
        for i in range(len(columns))
        for rows in groups
        for run in _runs(matrix[rows, i], lines[rows, i])
    ]
    # Columns such as "run 1 interval" are recordings.
    if len(columns) == 1 or all(
        re.search(rf"(?:{RECORDING})\W*\d", each.name, re.I) for each in columns
    ):
        return down
    along = [run for i in range(len(matrix)) for run in _runs(matrix[i], lines[i])]
    # A drop and its rebounds are in a line.
    if len(matrix) == 1 or columns[0].role != columns[1].role:
        return along
    ways = [way for way in (down, along) if any(len(x) > 1 for x, _ in way)]
    fitting = [way for way in ways if all((np.diff(x) < 0).all() for x, _ in way)]
    if columns[0].role == "time":
        rising = [way for way in ways if all((np.diff(x) > 0).all() for x, _ in way)]
        # Of several balls there are more times than balls, and of several drops more flights.
        is_long = len(matrix) > len(columns)
        fitting = (rising or fitting) if is_long else rising + fitting
    if len(fitting) != 1:
        raise Refused(
            f"{table.name}: each line or each column may be a recording: write one below the other "
            "with an empty line between"
        )
    return fitting[0]


def _flights(table: Table, runs: list[_Run]) -> list[_Run]:
    """Return the flights between times; times below a heading that fall are flights already."""
    if table.is_bare and any((np.diff(times) <= 0).any() for times, _ in runs):
        raise Refused(
            f"{table.name}: a column without a heading is taken as times in s, which rise: write a "
            "heading, such as interval (s) or height (cm)"
        )
    if all((np.diff(times) < 0).all() for times, _ in runs):
        return runs
    flights = [(np.diff(times), lines[1:]) for times, lines in runs]
    for lasting, lines in flights:
        table.refuse(lasting <= 0, lines, f"the time is not after {_UNSORTED}")
        # Flights get shorter, even if r is 0.997.
        half = len(lasting) // 2
        if half >= 10 and lasting[half:].mean() > 0.97 * lasting[:half].mean():
            raise Refused(
                f"{table.name}: evenly spaced times are those of samples: of what? write headings "
                "such as t and y, or time and force"
            )
    return flights


def _of_series(table: Table, columns: list[Column], runs: list[_Run]) -> Recording:
    """Return the recording of heights, of flights, or of times."""
    quantity = columns[0].role.split()[0]
    digit = min(digit_of(table, each) for each in columns)
    are_times = False
    if quantity == "time":
        quantity = "interval"
        flights = _flights(table, runs)
        are_times = flights is not runs
        runs = flights
    found = Recording(
        table.name,
        "heights" if quantity == "height" else "flights",
        tuple(values for values, _ in runs if len(values)),
        are_times=are_times,
        # The errors of intervals that were rounded one by one do not cancel, as those of times.
        digit=digit if are_times or quantity == "height" else 0.0,
        head=table.head,
    )
    if not found.chains:
        return found
    rounding = rounding_of(found)
    # Errors of two readings may let a height grow by a last digit, and those of three times a
    # flight by two.
    grows = 2 * rounding if are_times else rounding
    said = f"a {PLAUSIBLE[quantity][0]} of {{}} {SI[quantity]}"
    grown = (
        f"{said} follows one of {{}} {SI[quantity]}: an impact is missing, the first time is that "
        "of the release, or another recording begins (give a column 'recording', or --leave-out "
        "its line)"
    )
    missed = (
        "a flight of {} s, after which one of {} s has less than half of the ratio that the next "
        "one has: an impact is missing within it (--leave-out its line)"
    )
    for values, lines in runs:
        check(table, quantity, bool(columns[0].unit), values, lines)
        is_grown = values[1:] > _GROWTH * values[:-1] + grows
        table.refuse(is_grown, lines[1:], grown, values[1:], values[:-1])
        if quantity == "interval":
            # To two flights that are taken as one the third has the ratio r²/(1 + r) < r/2. The
            # next flight may be longer by the error of one time; with that of two times an impact
            # that is missed in a film would hide more often.
            middle = values[1:-1]
            beside = values[:-2] * values[2:]
            is_missed = (middle + rounding / 2) ** 2 < beside / 2
            table.refuse(is_missed, lines[:-2], missed, values[:-2], middle)
            # To a fall, which is half a flight, the next one has the ratio 2r. The middle between
            # that and r, in the logarithms that scatter alike, is √2 r.
            is_short = (middle - rounding / 2) ** 2 > math.sqrt(2) * beside
            table.refuse(
                is_short[:1],
                lines,
                "a flight of {} s is short beside the two after it: it begins with the release, or "
                "the next one has an impact within it (--leave-out the line of either)",
                values,
            )
    return found


def _check_pairs(table: Table, kind: str, pairs: Array, lines: Lines) -> None:
    """Refuse pairs of heights or speeds with an r above 1.05."""
    before, after = pairs.T
    si = "m" if kind == "drops" else "m/s"
    most = 1.05**2 if kind == "drops" else 1.05
    said = f"it rebounds with {{}} {si} from {{}} {si}: is a number wrong, or are the columns "
    table.refuse(after > most * before, lines, f"{said}exchanged?", after, before)


def _of_pairs(table: Table, kind: str, columns: list[Column]) -> Recording:
    """Return the recording of pairs: of the first column with each of the others."""
    first, *others = (values_of(table, each) for each in columns)
    pairs = np.concatenate([np.column_stack([first, each]) for each in others])
    lines = np.tile(table.lines, len(others))
    is_there = ~np.isnan(pairs).any(axis=1)
    if kind != "coefficients":
        _check_pairs(table, kind, pairs[is_there], lines[is_there])
    # Of a drop height in the head the rebounds stand in one column.
    falls = _fall_on(np.array([[*first[:1], *others[0]]]))
    if "drop height" in table.head and falls.size and falls.all():
        raise Refused(
            f"{table.name}: these rebounds fall on as those of one ball: write the drop height as "
            "the first of the heights"
        )
    read_off = columns if kind == "speeds" else columns[1:]
    digit = min(digit_of(table, each) for each in read_off)
    return Recording(table.name, kind, (pairs[is_there],), digit=digit)


def _fall_on(heights: Array) -> NDArray[np.bool_]:
    """Return whether heights along lines fall on, by more than the square root of the first factor.

    Those of one ball do, and rebounds of one drop do not.
    """
    return heights[:, 2:] ** 2 * heights[:, :1] < heights[:, 1:-1] ** 2 * heights[:, 1:2]


def _are_successive(table: Table, columns: list[Column]) -> bool:
    """Return whether heights in lines are those of one ball, and not rebounds of one drop."""
    h = np.column_stack([values_of(table, each) for each in columns])
    falls = _fall_on(h)
    are_falling = falls[~np.isnan(h[:, 2:] * h[:, 1:-1] * h[:, :1])]
    if are_falling.any() and not are_falling.all():
        raise Refused(f"{table.name}: some lines fall on, others have rebounds of one drop")
    return bool(are_falling.any())


# Samples to series.


def _even(t: Array) -> Array:
    """Return times of even frames, if the times agree with these but for their last digit."""
    frames = np.arange(len(t))
    even = np.polyval(np.polyfit(frames, t, 1), frames)
    digits = next((d for d in range(9) if np.abs(np.round(t, d) - t).max() < 1e-10), 9)
    is_rounded = np.abs(t - even).max() <= 10.0**-digits
    return np.where(is_rounded, even, t)


def _flights_of_track(up: Array) -> tuple[list[Lines], list[int]]:
    """Return the positions of each flight, without those beside impacts, and the impacts."""
    # Importing it takes longer than all else here.
    from scipy.signal import find_peaks

    # Third differences of a parabola vanish; those of noise of size 1 have a median of 3.
    noise = float(np.median(np.abs(np.diff(up, 3)))) / 3
    bottoms = find_peaks(-up, prominence=max(0.02 * float(np.ptp(up)), 6 * noise))[0].tolist()
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


def _samples(
    table: Table, columns: list[Column], rows: NDArray[np.bool_]
) -> tuple[Array, Array, Lines]:
    """Return times in s, values as they are written, and lines."""
    t = values_of(table, columns[0])[rows]
    lines = table.lines[rows]
    if len(t) <= 2 * _FEWEST:
        raise Refused(f"{table.name}: {len(t)} lines of a track or a signal are too few; {TIMES}")
    table.refuse(np.diff(t) < 0, lines[1:], f"the time is not after {_UNSORTED}")
    gap = np.diff(t) > 20 * np.mean(np.diff(t))
    table.refuse(gap, lines[1:], "a gap in the time: one recording of positions or signals is read")
    return t, columns[1].numbers[rows], lines


def _of_track(table: Table, columns: list[Column], rows: NDArray[np.bool_]) -> Recording:
    """Return the speeds at impacts; gravity gives their scale."""
    name = table.name
    t, y, lines = _samples(table, columns, rows)
    unit = columns[1].unit
    # Impacts bend a track upwards, which skews second differences. Over the time from frame to
    # frame noise may hide that: of the times, that counts over which they are skewed the most.
    bends = [y[: -2 * n] - 2 * y[n:-n] + y[2 * n :] for n in 2 ** np.arange(8) if 4 * n < len(y)]
    skewness = [float(np.mean(each**3)) / (float(np.std(each)) or 1.0) ** 3 for each in bends]
    turn = -1 if max(skewness, key=abs) < 0 else 1
    flights, bottoms = _flights_of_track(turn * y)
    even = _even(t)
    long = [each for each in flights if len(each) >= _FEWEST]
    lasting = np.array([np.ptp(even[each]) for each in long])
    check(table, "interval", bool(columns[0].unit), lasting, lines[[each[0] for each in long]])
    impacts = {}
    for bottom, (before, after) in zip(bottoms, itertools.pairwise(flights), strict=True):
        both = np.concatenate([before, after])
        track = np.column_stack([even[both], turn * y[both], np.isin(both, after)])
        if min(len(before), len(after)) < _FEWEST:
            continue
        down, up, gravity, misfit = impact_of(track)
        # What misses the positions by more than a twentieth of the height is no flight.
        lowest = min(down, up) ** 2 / (2 * gravity)
        if min(down, up, gravity) > 0 and misfit < 0.05 * lowest:
            impacts[bottom] = track, down, up, gravity
    if not impacts:
        raise Refused(f"{name}: no impact between two flights of four positions in the track")
    tracks, downs, ups, gravities = zip(*impacts.values(), strict=True)
    # Without a scale, as of pixels, nothing contradicts gravity.
    scale = in_si("y", f"1 {unit}", "m") if re.fullmatch("[cm]?m", unit) else math.nan
    gravity = scale * float(np.mean(gravities))
    slow = math.sqrt(STANDARD_GRAVITY / gravity)
    further = {
        f"{len(impacts)} of {len(bottoms)} impacts were found between flights that can be fitted; "
        f"gravity, {np.mean(gravities):.4g} {unit or 'units'}/s² in this track, is the scale": True,
        "the positions grow downwards, as in a picture: they were turned": turn < 0,
        f"gravity is {gravity:.3g} m/s² by the heights and times: the times are {slow:.3g} times "
        "the true ones, as in slow motion, and so are the speeds, or the heights have another "
        "unit": max(slow, 1 / slow) > math.sqrt(2),
    }
    notes = tuple(text for text, holds in further.items() if holds)
    metres = STANDARD_GRAVITY / np.array(gravities)
    pairs = np.column_stack([downs, ups]) * metres[:, None]
    _check_pairs(table, "speeds", pairs, lines[list(impacts)])
    return Recording(name, "track", tracks, notes=notes)


def _of_signal(table: Table, columns: list[Column], rows: NDArray[np.bool_]) -> Recording:
    """Return the flights between impacts that stand out of a signal.

    An impact lasts from where a twentieth of its peak is exceeded until it is no longer.
    """
    t, y, lines = _samples(table, columns, rows)
    size = np.abs(y - np.median(y))
    noise = 1.5 * float(np.median(size))
    loud = np.flatnonzero(size > max(0.1 * size.max(), 8 * noise))
    firsts = loud[np.diff(t[loud], prepend=-math.inf) > _QUIET]
    if len(firsts) < 3:
        raise Refused(
            f"{table.name}: {len(firsts)} impacts stand out of the signal: three are needed"
        )
    starts = []
    ends = []
    for first, until in itertools.pairwise([*firsts, len(t)]):
        peak = first + int(np.argmax(size[first:until]))
        quiet = np.flatnonzero(size <= max(size[peak] / 20, 4 * noise))
        starts.append(int(quiet[quiet < first].max(initial=-1)) + 1)
        ends.append(int(quiet[quiet > peak].min(initial=len(t) - 1)))
    if np.median(np.subtract(ends, starts)) < 2:
        raise Refused(
            f"{table.name}: impacts have one sample each, so that others may lie between two: "
            "sample faster"
        )
    found = _of_series(table, columns[:1], [(t[starts], lines[starts])])
    lasts = t[ends] - t[starts]
    # A force that lasts longer rings on.
    shows_contact = columns[1].role == "force" and lasts.max() < 0.1 * found.chains[0].min()
    notes = (f"{len(starts)} impacts were found in the signal",)
    return replace(found, durations=lasts if shows_contact else None, notes=notes)


# What was measured.


def _are_counted(columns: list[Column]) -> bool:
    """Return whether headings are alike but for counts, as h1 and h2, or first and second."""
    count = r"\d+(st|nd|rd|th)?|first|second|third|fourth|fifth"
    alike = {re.sub(count, "#", each.name, flags=re.I) for each in columns}
    steps = np.diff([sum(map(int, re.findall(r"\d+", each.name))) for each in columns])
    return len(alike) == 1 and ((steps == 1).all() or (steps == 0).all())


def _vertical(columns: list[Column]) -> list[Column]:
    """Return that of the columns x, y, z of a quantity that changes most sharply, as at impacts."""
    columns = [each for each in columns if not re.search("absolut", each.name, re.I)] or columns
    names = {each.name for each in columns}
    if len(names) < len(columns) or len({re.sub(r"[xyzXYZ]\b", "", name) for name in names}) > 1:
        return columns
    bends = [np.nan_to_num(np.abs(np.diff(each.numbers, 2))).max(initial=0) for each in columns]
    return [columns[int(np.argmax(bends))]]


def _layout(
    table: Table, roles: dict[str, list[Column]], intervals: bool
) -> tuple[str, list[Column]]:
    """Return what was measured, and the columns with that."""
    # An r beside times was computed of these.
    computed = {"coefficient"} if {"time", "interval"} & roles.keys() else set()
    layouts = _PAIRS if (_HALVES - computed) & roles.keys() else _PAIRS + _SERIES
    if intervals:
        layouts = (("flights", ("interval",)),)
    found = next((each for each in layouts if roles.keys() >= set(each[1])), None)
    if found is None:
        said = {
            "": "not known",
            "unused": "not used",
            "count": "a count",
            "frame": "a time with a line '# fps: 240' only",
            "error": "an error",
            "derived": "no reading, but derived",
        }
        there = ", ".join(
            f"{column.name!r} is {said.get(role, role)}"
            for role, columns in roles.items()
            for column in columns
            if column.name
        )
        wanted = "no column of intervals" if intervals else f"no bounces, as {there}"
        raise Refused(f"{table.name}: {wanted}: {HEADINGS}")
    kind, needed = found
    columns = []
    for role in needed:
        same = _vertical(roles[role]) if kind in ("track", "signal") else roles[role]
        # Counted columns are rebounds of a drop, or those of several balls.
        may_be_several = len(needed) == 1 or role == "height after"
        if len(same) > 1 and not (may_be_several and _are_counted(same)):
            raise Refused(
                f"{table.name}: two columns are both taken as {role}, {same[0].name!r} and "
                f"{same[1].name!r}: leave one out, as of several balls, or {HEADINGS}"
            )
        columns += same
    heights = columns[-1].numbers[~np.isnan(columns[-1].numbers)]
    falls = -np.diff(heights)
    # Tops fall by less and less, and a ball by more and more.
    are_tops = len(falls) > 1 and falls[-1] < falls[0] and (-falls <= 0.02 * heights[:-1]).all()
    return (
        ("heights", columns[1:]) if needed == ("time", "height") and are_tops else (kind, columns)
    )


def _uncertainty_and_durations(
    table: Table, roles: dict[str, list[Column]], columns: list[Column], rows: NDArray[np.bool_]
) -> tuple[Array | None, Array | None]:
    """Return the uncertainties of r and contact times of rows, or the mean of these."""
    uncertainty = None
    durations = None
    if "uncertainty" in roles and columns[-1].role == "coefficient":
        # Without a unit it has that of the coefficients.
        found = values_of(table, roles["uncertainty"][0], columns[-1].unit)[rows]
        uncertainty = None if np.isnan(found).all() else found
        if np.isnan(found).any() and uncertainty is not None:
            raise Refused(f"{table.name}: each impact needs an uncertainty, or none has one")
    if "duration" in roles:
        found = values_of(table, roles["duration"][0])[rows]
        known = found[~np.isnan(found)]
        is_each = columns[-1].role == "coefficient" and len(known) == len(found)
        if len(known):
            durations = known if is_each else known.mean(keepdims=True)
    return uncertainty, durations


def read(
    source: str | Path | Mapping[str, Any],
    leave_out: Sequence[int] = (),
    intervals: bool = False,
) -> Recording:
    """Return the recording of a file, of a published experiment by its name, or of columns.

    Parameters
    ----------
    source : str, Path or mapping
        Columns have headings as in a file, ``{"time (s)": [0.45, 1.17, 1.75]}``.
    leave_out : sequence of int
        Numbers of lines, from 1 on, that are left out with the impacts beside them.
    intervals : bool
        Whether a file with times and intervals is read by its intervals, and not by its times.

    Raises
    ------
    Refused
        If the file has no bounces, or numbers that are no bounces.
    """
    name, text, tables = text_of(source)
    table = table_of(name, text, leave_out)
    roles = columns_of(table)
    # A mass in each line is that of the ball, if all are alike.
    stated = {
        key: each
        for each in [*roles.get("unused", []), *roles.get("", [])]
        for key, words in KEYS.items()
        if each.unit and re.fullmatch(words, each.name.lower())
        if len(np.unique(each.numbers[~np.isnan(each.numbers)])) == 1
    }
    of_ball = {key: f"{np.nanmean(each.numbers):g} {each.unit}" for key, each in stated.items()}
    head = of_ball | table.head
    kind, columns = _layout(table, roles, intervals)
    is_missing = np.any(np.isnan([each.numbers for each in columns]), axis=0)
    is_complete = np.logical_not(is_missing)
    if kind == "signal":
        recording = _of_signal(table, columns, is_complete)
    elif kind == "track":
        recording = _of_track(table, columns, is_complete)
    elif kind in ("flights", "heights") or _are_successive(table, columns):
        runs = _series(table, columns, _groups(roles, is_missing))
        recording = _of_series(table, columns, runs)
    else:
        recording = _of_pairs(table, kind, columns)
    if not sum(map(len, recording.chains)):
        raise Refused(
            f"{name}: no line that is not left out has numbers in "
            + ", ".join(each.name for each in columns)
            + (f"; {TIMES}" if columns[0].role == "time" else "")
        )
    uncertainty, durations = _uncertainty_and_durations(table, roles, columns, is_complete)
    durations = durations if recording.durations is None else recording.durations
    if "contact time" in head:
        durations = np.array([positive("contact time", head["contact time"], "s")])
    is_free = bool(re.search("flight|flug|air ?time|hang", columns[0].name, re.I))
    gaps = is_missing & ~np.isin(table.lines, leave_out)
    missing = ", ".join(map(str, table.lines[gaps]))
    divides = " and divides the series" if recording.kind in ("flights", "heights") else ""
    unused = [
        repr(f"{key}: {value}")
        for key, value in head.items()
        if key not in KEYS and " uncertainty" not in key and re.fullmatch(QUANTITY, value)
    ]
    unread = [
        each.name
        for role, group in roles.items()
        for each in group
        if role not in ("count", "frame", "recording", "duration")
        and not (role == "uncertainty" and uncertainty is not None)
        and each not in [*columns, *stated.values()]
        and not np.isnan(each.numbers).all()
    ]
    # A column of texts that recur has names, as of balls or surfaces.
    kinds = {
        each.name: set(each.texts) - {""}
        for each in itertools.chain(*roles.values())
        if np.isnan(each.numbers).all()
    }
    pooled = "; ".join(
        f"{name} has {', '.join(sorted(texts))}"
        for name, texts in kinds.items()
        if 1 < len(texts) <= len(table.lines) / 2
    )
    further = {
        f"{pooled}: one r is fitted to all of them": bool(pooled),
        f"columns not used: {', '.join(map(repr, unread))}": bool(unread),
        "errors of readings in columns are not used: give their size by --resolution": (
            "error" in roles or ("uncertainty" in roles and uncertainty is None)
        ),
        "no heading: taken as times in s": table.is_bare,
        "errors in cells are not used: give a column of errors, or --resolution": any(
            "±" in text for each in columns for text in each.texts
        ),
        f"{tables} sheets have numbers: the first one of them is read": tables > 1,
        f"a number is missing in line {missing}, which is left out{divides}": gaps.any(),
        f"the head has {', '.join(unused)}, but only {', '.join(KEYS)} are used": bool(unused),
    }
    notes = recording.notes + tuple(text for text, holds in further.items() if holds)
    return replace(
        recording,
        head=head,
        uncertainty=uncertainty,
        durations=durations,
        is_free=is_free,
        notes=notes,
    )
