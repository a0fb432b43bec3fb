"""Recordings of bounces: what was measured, and the flights, heights or pairs of it.

The columns of a table say what was measured, by the first of :data:`LAYOUTS` that they have. A
column of balls makes one recording for each ball. Series are divided by an empty cell or line, by
a column of recordings, and where a count of bounces jumps. Series that no ball has are refused with
their line.
"""

import itertools
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_contacts.flights import impact_of
from bouncing_ball_contacts.tables import (
    COLUMNS,
    HEADINGS,
    LAYOUTS,
    NAMES,
    TEXTS,
    Column,
    Lines,
    Table,
    table_of,
)
from bouncing_ball_contacts.tracks import FEWEST, TOLD, copies, impacts_of_track, outliers
from bouncing_ball_contacts.units import (
    STANDARD_GRAVITY,
    Array,
    Refused,
    holding,
    in_si,
    positive,
    show,
    units_of,
)

_PAIRS = ("drops", "speeds", "coefficients")
# Without its other half such a column says that another one is missing.
_HALVES = ("drop height", "rebound height", "trial", "speed before", "speed after", "restitution")
# What was computed of the columns that are read.
_COMPUTED = {
    "drops": ("restitution", "average"),
    "speeds": ("restitution",),
    "track": ("restitution", "speed", "sideways", ""),
    "times": ("restitution", "interval", "height", "drop height"),
    "flights": ("restitution",),
    "heights": ("restitution",),
}
_IGNORED = {"": "not known", "remark": "not read"}
_READINGS = "height|rebound|bounce|drop|trial|speed|velocity|time"
_ERRORS = "uncertainty|deviation|error|std|ratio|energy"
_KEYS = ("mass", "diameter", "contact time", "resolution", "frame rate")
_QUANTITY = r"[-+]?\d+(?:[.,]\d+)?\s*[^\W\d][^\s,;(]*"
# An error of a reading may let a flight or a height be that of the one before times this.
_GROWTH = 1.02
# Relative difference of times from those of free fall: slow motion is slower than 1.1 times.
_SAME_CLOCK = 0.1


@dataclass(frozen=True, eq=False)
class Recording:
    """What was measured.

    Attributes
    ----------
    name : str
        Name of the file or the experiment.
    kind : str
        "flights" (durations of successive flights in s), "heights" (successive tops), "drops"
        (pairs of heights), "speeds" (pairs), "coefficients" (pairs of speed and r), or "track".
    chains : tuple of arrays
        One array for each recording; pairs have two columns. A track has one array for each impact,
        with the columns time, position, and 1 after the impact or else 0. A flight is the time from
        touch to touch, which includes the contact at its begin, unless ``is_free``.
    uncertainty : array
        Standard deviations of r.
    contact_time : float
        In s; 0 if it is not known.
    is_free : bool
        Whether flights do not include the contact.
    are_times : bool
        Whether a flight is the difference of two measured times.
    digit : float
        Last digit of the readings in SI units, or 0. Heights of drops and speeds of coefficients
        are set, and not read.
    head : dict
        Quantities in the head of the file.
    groups : array
        What each impact shares an error with: the height of its drop, its film, or the name in a
        column ``group``; None without any.
    has_clock : bool
        Whether times of a film are true. Otherwise positions are in m, and the times follow from
        the free fall.
    has_sideways : bool
        Whether a column x showed how a film is turned.
    no_speed : str
        Why the speeds of a film are not known, and what to do; empty if they are known.
    notes : tuple of str
        What a user has to know.
    """

    name: str
    kind: str
    chains: tuple[Array, ...]
    uncertainty: Array | None = None
    contact_time: float = 0.0
    is_free: bool = False
    are_times: bool = False
    digit: float = 0.0
    head: dict[str, str] = field(default_factory=dict)
    groups: NDArray[Any] | None = None
    has_clock: bool = True
    has_sideways: bool = False
    no_speed: str = ""
    notes: tuple[str, ...] = ()

    @property
    def films(self) -> list[tuple[Array, ...]]:
        """Tracks of the impacts of each film; another film begins before the impact of the last."""
        if self.kind != "track":
            return []
        begins = np.array([track[0, 0] for track in self.chains])
        impacts = np.array([track[track[:, 2] == 0, 0].max() for track in self.chains])
        ends = np.flatnonzero(begins[1:] < impacts[:-1]) + 1
        edges = itertools.pairwise([0, *ends, len(begins)])
        return [self.chains[begin:end] for begin, end in edges]


def rounding_of(recording: Recording) -> float:
    """Return the rounding of the readings in SI units: the frame of a film, or the last digit.

    Three readings are needed for a digit, because numbers lose zeros at their end.
    """
    if recording.are_times and "frame rate" in recording.head:
        return 1 / positive("frame rate", recording.head["frame rate"], "Hz")
    has_digit = sum(map(len, recording.chains)) >= 3
    return recording.digit * has_digit


def _rounding_given(table: Table, unit: str) -> float:
    """Return the rounding whose standard deviation, 1/√12 of it, is the resolution in the head."""
    said = table.head.get("resolution")
    return 0.0 if said is None else math.sqrt(12) * positive("resolution", said, unit)


# Numbers to series.


def _series(table: Table) -> list[Table]:
    """Return the lines of each recording of each group."""
    groups = table.parts("group").values()
    return [part for group in groups for part in group.parts("recording").values()]


def _runs(table: Table, columns: list[Column]) -> list[tuple[Array, Lines]]:
    """Return the runs of numbers between missing numbers, with their lines.

    Numbers of several columns, such as h0 and h1, run along each line.
    """
    runs: list[tuple[Array, Lines]] = []
    if len(columns) > 1:
        matrix = np.column_stack([table.values(column) for column in columns])
        # A stopwatch writes 0 for stops that did not happen.
        is_over = np.flip(np.cumsum(np.flip(matrix, axis=1) > 0, axis=1), axis=1) == 0
        matrix[is_over] = math.nan
        runs += zip(matrix, np.broadcast_to(table.lines[:, None], matrix.shape), strict=True)
    else:
        for part in _series(table):
            begins = [0]
            for column in part.of("count"):
                begins += (np.flatnonzero(np.diff(column.numbers) > 1) + 1).tolist()
            values = part.values(*part.of(columns[0].role))
            for begin, end in itertools.pairwise([*begins, len(values)]):
                runs.append((values[begin:end], part.lines[begin:end]))
    return [
        (values[piece], lines[piece])
        for values, lines in runs
        for piece in np.ma.clump_unmasked(np.ma.masked_invalid(values))
    ]


def _groups(
    table: Table, lines: Sequence[int], default: NDArray[Any] | None
) -> NDArray[Any] | None:
    """Return the group of the impact in each line, if there is a column of groups."""
    names = dict(zip(table.lines.tolist(), table.names("group"), strict=True))
    return np.array([names[line] for line in lines]) if table.of("group") else default


def _refuse_durations(table: Table, flights: Array, lines: Lines, another: str) -> None:
    """Refuse durations in s that are too short, too long or not positive."""
    half = len(flights) // 2
    # Flights get shorter, even if r is 0.997.
    if half >= 10 and flights[half:].mean() > 0.97 * flights[:half].mean():
        of_series = {"time", *TEXTS} - {"remark"}
        others = [column.name for column in table.columns if column.role not in of_series]
        raise Refused(
            f"{table.name}: evenly spaced times are those of samples ({', '.join(others)}): "
            "positions, y (m), are read, and sounds as WAV, but neither accelerations nor forces; "
            + COLUMNS
        )
    table.refuse(
        flights <= 0,
        f"the time is not after the one before: sort the lines, or {another}",
        lines=lines,
    )
    table.refuse(
        flights < 1e-3, "a flight of {} s is too short: is the unit right?", flights, lines=lines
    )
    table.refuse(
        flights > 9,
        "a flight of {} s is too long: is it in ms? write (ms) behind the heading, or divide times "
        "of slow motion",
        flights,
        lines=lines,
    )


def _refuse_echoes(table: Table, flights: Array, lines: Lines, grows: float, remedy: str) -> None:
    """Refuse flights in s that end with an echo, or with a touch that was counted twice.

    Such a flight is shorter than half of the geometric mean of its neighbours, and the next flight
    is longer than it. Three missing touches make a smaller difference. The last flight is shorter
    than a quarter of the duration that the two flights before it predict.
    """
    # A first flight is compared with the next one only.
    before = np.concatenate([flights[1:2] / 4, flights[:-1]])
    after = flights[1:]
    is_echo = np.zeros(len(flights), bool)
    is_short = 4 * flights[:-1] ** 2 < before[:-1] * after
    is_echo[:-1] = is_short & (after > _GROWTH * flights[:-1] + grows)
    if len(flights) > 2 and flights[-2] <= _GROWTH * flights[-3] + grows:
        is_echo[-1] = 4 * flights[-1] * flights[-3] < flights[-2] ** 2
    table.refuse(
        is_echo,
        f"{{}} s after the touch before it: an echo, or one touch counted twice; {remedy}",
        flights,
        lines=lines,
    )


def _refuse_ratios(table: Table, flights: Array, lines: Lines, rounding: float) -> None:
    """Refuse flights in s with a missing impact, and a first flight that is a fall.

    If two flights are taken as one, the ratio of the third flight to it is r²/(1 + r) < r/2. A fall
    is half a flight, so the ratio of the next flight to it is 2r. The limit between 2r and r is
    their geometric mean √2 r.
    """
    middle = flights[1:-1]
    beside = flights[:-2] * flights[2:]
    table.refuse(
        (middle + rounding / 2) ** 2 < beside / 2,
        "a flight of {} s, after which one of {} s has less than half of the ratio that the next "
        "one has: an impact is missing within it (--leave-out its line)",
        flights[:-2],
        middle,
        lines=lines[:-2],
    )
    table.refuse(
        ((middle - rounding / 2) ** 2 > math.sqrt(2) * beside)[:1],
        "a flight of {} s is much shorter than the next two: it begins with the release, or "
        "the next flight contains an impact (--leave-out the line of either flight)",
        flights,
        lines=lines,
    )


def _of_series(table: Table, kind: str, columns: list[Column]) -> Recording:
    """Return the recording of heights, of flights, or of times."""
    runs = _runs(table, columns)
    # Times of one line that decrease are those between touches.
    if len(columns) > 1 and sum(values[-1] - values[0] for values, _ in runs) < 0:
        kind = kind.replace("times", "flights")
    if kind == "times":
        runs = [(np.diff(times), lines[1:]) for times, lines in runs]
    recording = Recording(
        table.name,
        "heights" if kind == "heights" else "flights",
        tuple(values for values, _ in runs if len(values)),
        are_times=kind == "times",
        # The errors of intervals that were rounded one by one do not cancel, as those of times.
        digit=0.0 if kind == "flights" else min(column.scale * column.digit for column in columns),
        head=table.head,
        groups=_groups(table, [i for _, lines in runs for i in lines[1:].tolist()], None),
    )
    rounding = rounding_of(recording) if recording.chains else 0.0
    unit = "m" if kind == "heights" else "s"
    rounding = max(rounding, _rounding_given(table, unit))
    # Errors of two readings may let a height grow by a last digit, and those of three times a
    # flight by two.
    grows = rounding if kind == "heights" else 2 * rounding
    film = "; times of a film need a line # frame rate: 30" if kind == "times" else ""
    remedy = "delete this line" if kind == "times" else "add it to the next flight"
    another = "leave an empty line where another recording begins"
    first = "its line"
    if len(columns) > 1:
        another = f"write one heading, as {columns[0].name}, over runs side by side"
        first = f"column {columns[0].name!r}"
    what = "height of {} m" if kind == "heights" else "flight of {} s"
    for values, lines in runs:
        if kind == "heights":
            falls = (values[1:] / values[:-1])[:2]
            table.refuse(
                np.array([len(falls) == 2 and falls[0] < 0.9 and abs(falls[1] - 1) < 0.03]),
                "these heights do not fall on as those of successive bounces: repeated drops from "
                "one height are named drop height, trial 1, trial 2",
                lines=lines,
            )
        else:
            _refuse_durations(table, values, lines, another)
            _refuse_echoes(table, values, lines, grows, remedy)
        table.refuse(
            values[1:] > _GROWTH * values[:-1] + grows,
            f"a {what} follows one of {{}}: an impact is missing (--leave-out its line), the first "
            f"time is the release (delete {first}), or {another}; readings with such errors need "
            f"--resolution{film}",
            values[1:],
            values[:-1],
            lines=lines[1:],
        )
        if kind != "heights":
            _refuse_ratios(table, values, lines, rounding)
    return recording


def _of_pairs(table: Table, kind: str, columns: list[Column], errors: list[Column]) -> Recording:
    """Return the recording of pairs of the first column and each other column."""
    first, *others = (table.values(column) for column in columns)
    # Without a unit an uncertainty has that of the coefficients.
    known = [replace(error, unit=error.unit or columns[-1].unit) for error in errors]
    rows = [np.column_stack([first, other, *map(table.values, known)]) for other in others]
    numbers = np.concatenate(rows)
    is_there = ~np.isnan(numbers).any(axis=1)
    pairs = numbers[is_there, :2]
    lines = np.tile(table.lines, len(others))[is_there]
    if kind != "coefficients":
        unit = "m" if kind == "drops" else "m/s"
        grows = _rounding_given(table, unit)
        _refuse_growth(table, kind, pairs, lines, grows)
    read_off = columns if kind == "speeds" else columns[1:]
    digit = min(column.scale * column.digit for column in read_off)
    uncertainty = numbers[is_there, 2] if errors else None
    # A height of a drop and a speed of a coefficient are set once for all trials.
    shared = {"drops": _heights_that_are_one(pairs[:, 0]), "coefficients": pairs[:, 0]}
    groups = _groups(table, lines.tolist(), shared.get(kind))
    return Recording(table.name, kind, (pairs,), uncertainty, digit=digit, groups=groups)


def _heights_that_are_one(heights: Array) -> Array:
    """Return the lowest of the heights of a group, which differ by 1 % at most."""
    lowest = heights.copy()
    for i, j in itertools.pairwise(np.argsort(heights)):
        if heights[j] <= 1.01 * lowest[i]:
            lowest[j] = lowest[i]
    return lowest


def _refuse_growth(table: Table, kind: str, pairs: Array, lines: Lines, grows: float) -> None:
    """Refuse pairs of heights or speeds with an r above 1.05."""
    before, after = pairs.T
    unit = "m" if kind == "drops" else "m/s"
    most = 1.05**2 if kind == "drops" else 1.05
    said = f"it rebounds with {{}} {unit} from {{}} {unit}: is a number wrong, or are the columns "
    table.refuse(after > most * before + grows, f"{said}exchanged?", after, before, lines=lines)


# Samples to series.


class _Film(NamedTuple):
    """Times in s, positions and lines of a film, and which positions are left out.

    Positions sideways ``x`` are NaN if they are not known.
    """

    t: Array
    y: Array
    x: Array
    lines: Lines
    is_copy: NDArray[np.bool_]
    is_out: NDArray[np.bool_]

    def impacts(self, way: int) -> tuple[dict[int, Array], dict[int, str]]:
        """Return tracks of impacts, and why others are not used, by their lines.

        ``way`` is -1 if positions grow downwards.
        """
        used = np.flatnonzero(~(self.is_copy | self.is_out))
        if len(used) <= 2 * FEWEST:
            return {}, {}
        tracks, unused = impacts_of_track(self.t[used], way * self.y[used])
        lines = self.lines[used].tolist()
        return {lines[i]: track for i, track in tracks.items()}, {
            lines[i]: reason for i, reason in unused.items()
        }

    def upright(self, tracks: Iterable[Array]) -> "_Film":
        """Return the film with positions along gravity, the acceleration of the flights in tracks.

        A turned picture adds a part of the ball's drift to the positions upwards.
        """
        pull = np.zeros(2)
        for t, _, after in (track.T for track in tracks):
            at = np.searchsorted(self.t, t)
            lines = np.column_stack([after, 1 - after, after * t, (1 - after) * t])
            bend = t**2 - lines @ np.linalg.lstsq(lines, t**2, rcond=None)[0]
            pull += bend @ np.column_stack([self.x, self.y])[at]
        turned = np.column_stack([self.x, self.y]) @ pull * np.sign(pull[1]) / np.hypot(*pull)
        return self._replace(y=turned)


def _film(columns: list[Column], t: Array, y: Array, x: Array, lines: Lines) -> _Film:
    """Return a film of positions; its rounded times are replaced by those of even frames."""
    frames = np.arange(len(t))
    even = np.polyval(np.polyfit(frames, t, 1), frames)
    is_even = np.abs(t - even).max() <= columns[0].scale * columns[0].digit
    t = np.where(is_even, even, t)
    digit = columns[1].digit
    is_copy = np.diff(t, prepend=-1.0) == 0
    moments = np.flatnonzero(~is_copy)
    is_copy[moments] = copies(t[moments], y[moments], digit)
    is_out = np.zeros(len(t), bool)
    left = np.flatnonzero(~is_copy)
    if len(left) > 2 * FEWEST:
        is_out[left] = outliers(t[left], y[left], digit)
    return _Film(t, y, x, lines, is_copy, is_out)


def _sideways(table: Table, positions: Column) -> Array:
    """Return the positions x in the unit of others; NaN without one such column."""
    columns = table.of("sideways")
    if len(columns) != 1 or (columns[0].unit in units_of("m")) != (positions.unit in units_of("m")):
        return np.full(len(table.lines), math.nan)
    units = [f"1 {column.unit}" for column in (columns[0], positions)]
    is_length = positions.unit in units_of("m")
    x, y = (in_si("unit", unit, "m") if is_length else 1.0 for unit in units)
    return columns[0].numbers * x / y


def _films(table: Table, columns: list[Column]) -> list[_Film]:
    """Return the films; an empty line or a name divides films."""
    films = []
    for part in _series(table):
        times, positions = part.of(columns[0].role)[0], part.of(columns[1].role)[0]
        both = np.column_stack([part.values(times), positions.numbers, _sideways(part, positions)])
        # A frame without a position is no end of a film.
        is_end = np.isnan(both[:, :2]).all(axis=1)
        for rows in np.split(np.arange(len(both)), np.flatnonzero(is_end)):
            frames = rows[~np.isnan(both[rows, 0])]
            table.refuse(
                np.diff(both[frames, 0]) < 0,
                "the time is not after the one before: sort the lines, or leave an empty line "
                "before another film",
                lines=part.lines[frames[1:]],
            )
            with_position = frames[~np.isnan(both[frames, 1])]
            if len(with_position) > 2 * FEWEST:
                t, y, x = both[with_position].T
                films.append(_film(columns, t - t[0], y, x, part.lines[with_position]))
    if not films:
        raise Refused(f"{table.name}: too few lines of a track; tops are one column, height")
    return films


def _left_out(
    films: list[_Film], impacts: list[dict[int, Array]], unused: list[dict[int, str]]
) -> list[str]:
    """Return what is left out of films between the begin of their first and end of last flight."""
    left: dict[str, list[int]] = {
        "copies of the frame before": [],
        "positions that no ball has": [],
        "frames that are missing before": [],
    }
    said = []
    for film, tracks_by_line, others in zip(films, impacts, unused, strict=True):
        said += [
            f"the impact in line {line} is not used: {others[line]}"
            for line in others
            if others[line] in TOLD
        ]
        if not tracks_by_line:
            continue
        tracks = list(tracks_by_line.values())
        begin, end = tracks[0][0, 0], tracks[-1][-1, 0]
        during = (film.t >= begin) & (film.t <= end)
        steps = np.diff(film.t, prepend=film.t[0])
        of_kinds = film.is_copy, film.is_out, steps > 2.5 * np.median(steps)
        for lines, is_left in zip(left.values(), of_kinds, strict=True):
            lines += film.lines[during & is_left].tolist()
    return said + [
        f"left out are {what}: line {', '.join(map(str, lines[:3]))}"
        + f" and {len(lines) - 3} more" * (len(lines) > 3)
        for what, lines in left.items()
        if lines
    ]


def _clock(
    columns: list[Column], gravity: Any, fall: Any, has_rate: bool
) -> tuple[float, str, str]:
    """Return m per unit if times follow from the free fall, else 0; why no speed is known; a note.

    Gravity, in units of the positions per s², tells true times if the unit is one of lengths. For
    pixels the times are taken as true; the longest fall in s tells whether they are.
    """
    unit = columns[1].unit
    metres = in_si("unit", f"1 {unit}", "m") if unit in ("", *units_of("m")) else math.nan
    slow = math.sqrt(STANDARD_GRAVITY / (metres * gravity))
    by = f"gravity is {metres * gravity:.3g} m/s² by the heights in {unit} and the times"
    is_stated = columns[0].name.lower() in NAMES["frame"].split(", ")
    if abs(slow - 1) < _SAME_CLOCK:
        return 0.0, "", ""
    if unit == "px" or (not unit and has_rate):
        drop = STANDARD_GRAVITY * fall**2 / 2
        clock = "frame rate" if is_stated else "times"
        said = f"by the {clock} the ball falls from {show(drop, 'm')}: "
        # As of a height without a unit.
        is_far = drop > 10
        said += f"{'' if is_far else 'if it does not, '}correct the {clock}"
        return 0.0, *((said, "") if is_far else ("", said))
    if not unit:
        return 0.0, "the positions need a unit: y (m), or y (px) next to true times", ""
    if slow < 1 or is_stated:
        return 0.0, f"{by}{is_stated * ' of the frame rate'}: correct what is wrong", ""
    return metres, "", f"{by}: times are {slow:.3g} times the true ones, which are used"


def _of_track(table: Table, columns: list[Column]) -> Recording:
    """Return the tracks of impacts of one film or several, scaled by gravity."""
    unit = columns[1].unit
    if unit not in ("", "px", *units_of("m")):
        said = f"{columns[1].name!r} is in {unit}, and is no position, y (m)"
        raise Refused(f"{table.name}: {said}, {COLUMNS}")
    films = _films(table, columns)
    # Upside down no flight is a parabola.
    ways = [[film.impacts(way) for film in films] for way in (1, -1)]
    films_of = max(
        ways, key=lambda impacts: [sum(map(len, part)) for part in zip(*impacts, strict=True)]
    )
    way = 1 if films_of is ways[0] else -1
    has_sideways = all(np.isfinite(film.x).all() for film in films)
    if has_sideways and any(tracks_by_line for tracks_by_line, _ in films_of):
        films = [
            film.upright(tracks_by_line.values()) if tracks_by_line else film
            for film, (tracks_by_line, _) in zip(films, films_of, strict=True)
        ]
        films_of = [film.impacts(way) for film in films]
    of_films = [tracks_by_line for tracks_by_line, _ in films_of]
    unused = [others for _, others in films_of]
    numbers = [line for tracks_by_line in of_films for line in tracks_by_line]
    tracks = [track for tracks_by_line in of_films for track in tracks_by_line.values()]
    if not tracks:
        reasons = {line: said for others in unused for line, said in others.items()}
        lowest = "".join(f"; line {line}: {said}" for line, said in list(reasons.items())[:1])
        raise Refused(f"{table.name}: no impact between two flights in the track{lowest}")
    before, _, gravity, *_ = np.transpose([impact_of(track) for track in tracks])
    metres, no_speed, by_clock = _clock(
        columns, np.mean(gravity), np.max(before / gravity), "frame rate" in table.head
    )
    notes = [
        (by_clock, by_clock),
        (no_speed, f"no speed is known, and no drag of the air is removed: {no_speed}"),
        *((True, note) for note in _left_out(films, of_films, unused)),
        (
            way < 0,
            "the positions grow downwards, as in a picture: they were turned",
        ),
    ]
    film_of = np.repeat(np.arange(len(films)), [len(tracks_by_line) for tracks_by_line in of_films])
    groups = _groups(table, numbers, film_of if len(set(film_of)) > 1 else None)
    return Recording(
        table.name,
        "track",
        tuple(track * [1, metres or 1, 1] for track in tracks),
        groups=groups,
        has_clock=not metres,
        has_sideways=has_sideways,
        no_speed=no_speed,
        notes=tuple(holding(notes)),
    )


# What was measured.


def _layout(table: Table) -> tuple[str, list[Column]]:
    """Return what was measured, and its columns."""
    roles = {column.role for column in table.columns}
    # An r beside times was computed of these.
    computed = {"restitution"} if {"time", "interval"} & roles else set()
    # So is the drop height beside the touches of each fall.
    computed |= {"drop height"} if "touch" in roles else set()
    is_half = bool(roles & set(_HALVES) - computed)
    layouts = [layout for layout in LAYOUTS if not is_half or layout[0] in _PAIRS]
    kind, needed = next((layout for layout in layouts if roles >= set(layout[1])), ("", ()))
    if not kind:
        there = ", ".join(
            f"{column.name!r} is {_IGNORED.get(column.role, column.role)}"
            for column in table.columns
            if column.name
        )
        film = (
            "frames are times with a line above the headings, # frame rate: 30; "
            if "frame" in roles
            else ""
        )
        raise Refused(
            f"{table.name}: no bounces, as {there}: {film}{HEADINGS}; a title or a comment begins "
            "with #"
        )
    columns = [column for role in needed for column in table.of(role)]
    for column, other in itertools.pairwise(columns):
        counted = {"heights": "height", "times": "touch"}.get(kind, "trial")
        is_counted = column.role == counted and (
            counted == "touch" or re.search(r"\d$", column.name + other.name)
        )
        if column.role == other.role and not is_counted:
            raise Refused(
                f"{table.name}: two columns are both {column.role}, {column.name!r} and "
                f"{other.name!r}: write trial 1,trial 2 over repeated drops, h0,h1,h2 over "
                "successive tops, the same heading over runs side by side of one ball, and 'height "
                f"(cm) (golf)' over those of several balls, {COLUMNS}"
            )
    return kind, columns


def _is_reading(column: Column, kind: str) -> bool:
    """Return whether a column that is not used looks like a measurement."""
    is_error = re.search(_ERRORS, column.name.lower())
    if is_error or column.role in _COMPUTED.get(kind, ()) or np.isnan(column.numbers).all():
        return False
    is_of_bounce = any(column.unit in units_of(unit) for unit in ("s", "m", "m/s"))
    named = column.role or re.search(_READINGS, column.name.lower())
    return bool(is_of_bounce or (named and not column.is_count))


def _recording(table: Table, leave_out: Sequence[int]) -> Recording:
    """Return the recording of one ball."""
    kind, columns = _layout(table)
    errors = table.of("uncertainty")[:1] if kind == "coefficients" else []
    is_there = np.all([~np.isnan(column.numbers) for column in columns + errors], axis=0)
    if kind in _PAIRS:
        recording = _of_pairs(table, kind, columns, errors)
    elif kind == "track":
        recording = _of_track(table, columns)
    else:
        recording = _of_series(table, kind, columns)
    if not sum(map(len, recording.chains)):
        named = ", ".join(column.name for column in columns)
        raise Refused(f"{table.name}: no line that is not left out has numbers in {named}")
    used = [*columns, *errors, *(table.of("sideways") if recording.has_sideways else [])]
    lasts = table.head.get("contact time")
    ignored = [
        column
        for column in table.columns
        if column.name and column not in used and column.role not in TEXTS
    ]
    for column in ignored:
        if _is_reading(column, kind):
            raise Refused(
                f"{table.name}: column {column.name!r} looks like a measurement, but "
                f"{' and '.join(dict.fromkeys(one.role for one in columns))} are read: "
                f"delete it, or name it 'remark', {COLUMNS}"
            )
    unused = ", ".join(repr(column.name) for column in ignored)
    gaps = ", ".join(map(str, np.setdiff1d(table.lines[~is_there], leave_out)))
    divides = " and divides the series" if recording.kind in ("flights", "heights") else ""
    notes = [
        *((True, note) for note in recording.notes),
        (unused, f"columns not used: {unused}"),
        (table.head.get("heard"), f"heard: {table.head.get('heard')}"),
        (gaps, f"a number is missing in line {gaps}, which is left out{divides}"),
        *(
            (
                key.removesuffix(" uncertainty") not in _KEYS and re.fullmatch(_QUANTITY, value),
                f"the head has '{key}: {value}', but only {', '.join(_KEYS)} are used",
            )
            for key, value in table.head.items()
        ),
    ]
    return replace(
        recording,
        head=table.head,
        contact_time=positive("contact time", lasts, "s") if lasts else 0.0,
        is_free=columns[0].role == "flight",
        notes=tuple(holding(notes)),
    )


def read(
    source: str | Path | Mapping[str, Any],
    leave_out: Sequence[int] = (),
    ball: str | None = None,
    resolution: Any = None,
    columns: Mapping[str, str] | None = None,
) -> dict[str, Recording]:
    """Return the recordings of a file, an experiment or columns, by the names of their balls.

    Parameters
    ----------
    source : str, Path or mapping
        Columns have headings as in a file, ``{"time (s)": [0.45, 1.17, 1.75]}``.
    leave_out : sequence of int
        Numbers of lines, from 1 on, that are left out with the impacts beside them.
    ball : str, optional
        The name of one, in a column ``ball``, in small letters or capital ones.
    resolution : quantity, optional
        The standard deviation of a reading, in place of that of the head. A number is refused only
        if it is wrong by more than such errors.
    columns : mapping, optional
        Headings of columns by the names that they have in the file, or by their numbers from 1 on,
        as in ``{"Zeit": "t (s)", "3": "y (cm)"}``; other columns are not read.

    Returns
    -------
    dict
        One recording for each ball, or a single one with an empty name.

    Raises
    ------
    Refused
        If there are no bounces, or if a number or a column cannot be read.
    """
    table = table_of(source, leave_out, columns)
    if resolution is not None:
        table = replace(table, head={**table.head, "resolution": str(resolution)})
    for column in table.columns:
        # A reading with its unit, such as 36 cm, begins with a digit, and is no name.
        texts = {cell for cell in column.cells if re.match(r"\D", cell)}
        if not column.role and np.isnan(column.numbers).all() and len(texts) > 1:
            raise Refused(
                f"{table.name}: column {column.name!r} has {', '.join(sorted(texts)[:5])}: name it "
                f"'ball' for one result each, or 'group' for one of all, {COLUMNS}"
            )
    balls = table.parts("ball")
    if ball is None:
        return {name: _recording(part, leave_out) for name, part in balls.items()}
    for name, part in balls.items():
        if name.lower() == ball.lower():
            return {name: _recording(part, leave_out)}
    known = ", ".join(filter(None, balls))
    said = f"{known}: name one, --ball" if known else "no column of balls: leave out --ball"
    raise Refused(f"{table.name} has {said}")
