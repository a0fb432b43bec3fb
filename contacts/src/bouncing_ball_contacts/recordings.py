"""Recordings of bounces, as instruments, programs and people write them.

A file is a table with any delimiter and decimal sign, with or without headings, or the first sheet
of a spreadsheet. Its columns say what was measured: times of impacts or intervals between them,
heights of a drop and its rebound, speeds before and after, restitution coefficients, positions over
time, or a signal in which impacts stand out. Lines ``# key: value`` above it name the ball.
"""

import re
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from importlib.resources import files
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from bouncing_ball_contacts.schemes import Array
from bouncing_ball_contacts.units import STANDARD_GRAVITY, Refused, in_si

UNITS = {
    "time": "s",
    "interval": "s",
    "drop": "m",
    "rebound": "m",
    "height": "m",
    "in": "m/s",
    "out": "m/s",
    "duration": "s",
    "restitution": "",
    "uncertainty": "",
}
# What a heading means: the first pattern that is found in it, in lower case and without units.
_MEANINGS = (
    ("other", r"duration.*(uncert|std|error)"),
    ("uncertainty", r"uncert|std|sigma|error|±|deviation|^u\(?e"),
    ("duration", r"duration|contact time"),
    ("restitution", r"\bcor\b|restitution|^e$|^r$"),
    ("out", r"\b(v|speed|velocity)\b.*\b(out|after|rebound|up|2)\b|^(u|v2|v')$"),
    ("out", r"(rebound|outgoing|rising|exit)\b.*\b(speed|velocity)"),
    ("in", r"\b(v|speed|velocity)\b.*\b(in|before|impact|down|1)\b|^(v|v1|speed|velocity)$"),
    ("in", r"(impact|incoming|falling)\b.*\b(speed|velocity)"),
    ("interval", r"interval|flight|Δt|delta ?t|^dt$"),
    ("rebound", r"rebound|bounce height|^h ?([1-9]\d*|'|′|after|out|r)\b|^h'"),
    ("drop", r"drop|release|initial height|start height|^h ?(0|before|in|i)\b"),
    ("height", r"height|^h$"),
    ("recording", r"recording|^run\b|trial|series|ball\b"),
    ("count", r"number|^(no|nr)\.?$|^n$|^#$|index|^(event|bounce|impact)s?$"),
    ("time", r"^t ?\d*$|time|second"),
    ("position", r"^[yz]\b|^(?!x\b).*\bposition\b(?!.*\bx\b)|vertical"),
    ("force", r"^f[a-z]?$|force|load"),
    ("signal", r"volt|ampl|sound|accel|pressure|^ch ?\d|audio"),
)
_UNIT_ROW = re.compile(
    r"|s|ms|µs|us|m|cm|mm|m/s|cm/s|m/s²|m/s\^2|n|kn|v|mv|a\.u\.|pa|g|seconds?|volts?"
)
_HIGHEST = 100.0
_HIGHEST_WITHOUT_UNIT = 10.0
_FASTEST = 100.0
_LONGEST = 9.0
# An interval may exceed the one before it by the errors of both.
_LONGER = 1.02
# Between two impacts a signal is silent for this time in s.
_SILENCE = 0.03
_SHORTEST_TRACK = 8
# A height that rises by this part of the range belongs to another flight.
_RISE = 0.03


@dataclass(frozen=True)
class Recording:
    """What was measured.

    ``kind`` is "flights" (durations of successive flights in s), "heights" (successive tops),
    "drops" (pairs of heights), "speeds" (pairs) or "coefficients" (pairs of speed and r).

    ``chains`` are arrays, one for each recording; those of pairs have two columns. A flight is the
    time from touch to touch, which includes the contact at its begin. ``uncertainty`` has standard
    deviations of r, ``durations`` contact times in s, one or one for each impact (of flights: for
    each touch); ``head`` has what the file says of the ball.
    """

    name: str
    kind: str
    chains: tuple[Array, ...]
    uncertainty: Array | None = None
    durations: Array | None = None
    head: dict[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


def experiments() -> list[str]:
    """Return the names of the published experiments of the package."""
    folder = files(__package__).joinpath("experiments")
    return sorted(path.name.removesuffix(".csv") for path in folder.iterdir())


def read(source: str | Path, leave_out: Sequence[int] = (), intervals: bool = False) -> Recording:
    """Return the recording of a file, or of a published experiment by its name.

    Parameters
    ----------
    source : str or Path
    leave_out : sequence of int
        Numbers of lines, from 1 on, that are left out with the impacts beside them.
    intervals : bool
        Whether a file with times and intervals is read by its intervals, and not by its times.

    Raises
    ------
    Refused
        If the file has no bounces, or numbers that are no bounces.
    """
    if not isinstance(source, str | Path):
        raise Refused(f"{source!r} is no recording: give a file, a name, or Recording(…)")
    path = Path(source)
    if str(source) in experiments():
        data = files(__package__).joinpath("experiments", f"{source}.csv").read_bytes()
    elif path.is_file():
        data = path.read_bytes()
    else:
        raise Refused(f"{source} is no file, and none of {', '.join(experiments())}")
    name = path.name
    text = _sheet(data) if data.startswith(b"PK") else _decoded(name, data)
    return _interpreted(name, text.splitlines(), set(leave_out), intervals)


def _decoded(name: str, data: bytes) -> str:
    if b"\0" in data[:4000] and data[:2] not in (b"\xff\xfe", b"\xfe\xff"):
        raise Refused(f"{name} is no text and no spreadsheet")
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return data.decode("utf-16", "replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def _sheet(data: bytes) -> str:
    """Return the first sheet of an xlsx file as lines with tabs."""
    import io

    space = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as book:
            shared = []
            if "xl/sharedStrings.xml" in book.namelist():
                root = ElementTree.fromstring(book.read("xl/sharedStrings.xml"))
                shared = ["".join(item.itertext()) for item in root.iter(f"{space}si")]
            sheet = min(name for name in book.namelist() if name.startswith("xl/worksheets/sheet"))
            rows = ElementTree.fromstring(book.read(sheet)).iter(f"{space}row")
            lines = []
            for row in rows:
                cells: dict[int, str] = {}
                for cell in row.iter(f"{space}c"):
                    letters = re.sub(r"\d", "", cell.get("r", "A"))
                    place = 0
                    for letter in letters:
                        place = 26 * place + ord(letter) - 64
                    text = "".join(cell.itertext())
                    cells[place] = shared[int(text)] if cell.get("t") == "s" else text
                lines.append(
                    "\t".join(cells.get(i, "") for i in range(1, max(cells, default=0) + 1))
                )
            return "\n".join(lines)
    except (zipfile.BadZipFile, ValueError, KeyError, ElementTree.ParseError):
        raise Refused("the spreadsheet cannot be read: save it as xlsx or as text") from None


def _interpreted(name: str, lines: list[str], leave_out: set[int], intervals: bool) -> Recording:
    head: dict[str, str] = {}
    body: list[tuple[int, str]] = []
    for number, line in enumerate(lines, 1):
        found = re.match(r"\s*#\s*([\w ]+?)\s*:\s*(.*?)\s*$", line)
        if found:
            before = head.get(found[1].lower())
            head[found[1].lower()] = f"{before} {found[2]}" if before else found[2]
        elif line.strip() and not line.lstrip().startswith("#"):
            body.append((number, line))
    if not body:
        raise Refused(f"{name} is empty")
    if missing := leave_out - {number for number, _ in body}:
        raise Refused(f"{name} has no line {min(missing)} of numbers to leave out")
    table = _table(name, body, leave_out)
    columns = _columns(name, table)
    if intervals:
        if not {"time", "interval"} & columns.keys():
            raise Refused(f"{name} has no column of intervals")
        # A list without a heading is one of intervals as well.
        times = columns.pop("time", np.empty(0))
        if "interval" not in columns and np.all(np.diff(times[np.isfinite(times)]) > 0):
            raise Refused(f"{name} has times, which rise, and no intervals: leave --intervals out")
        columns.setdefault("interval", times)
    recording, used = _measured(name, columns, head, table.names)
    # Lines that were left out on purpose are known to be missing.
    has_gap = ~np.all([np.isfinite(columns[each]) for each in used], axis=0)
    inside = range(table.lines[0], table.lines[-1])
    empty = {number for number in inside if not lines[number - 1].strip()}
    gaps = sorted((empty | set(columns["line"][has_gap])) - leave_out)
    if gaps:
        shown = ", ".join(f"{number:.0f}" for number in gaps[:5]) + (", …" if gaps[5:] else "")
        note = f"a number is missing in line {shown}, which is left out"
        return replace(recording, notes=(*recording.notes, note))
    return recording


@dataclass(frozen=True)
class _Table:
    values: Array
    lines: list[int]
    names: list[str]
    units: list[str]


def _table(name: str, body: list[tuple[int, str]], leave_out: set[int]) -> _Table:
    first_line = body[0][1]
    last = body[-1][1]
    delimiter: str | None = next((mark for mark in ("\t", ";") if mark in last), None)
    decimal_comma = delimiter is not None
    if delimiter is None and "," in last:
        # Commas are decimal signs in a single column, whose heading has no comma.
        one_column = all(_is_decimal(line) for _, line in body[1:])
        decimal_comma = one_column and ("," not in first_line or _is_decimal(first_line))
        delimiter = "\0" if decimal_comma else ","
    elif delimiter is None and len(last.split()) < 2:
        delimiter = "\0"
    cells = [
        [cell.strip().strip('"').strip() for cell in line.rstrip("\n").split(delimiter)]
        for _, line in body
    ]

    def number(cell: str) -> float:
        text = cell.replace("−", "-")
        try:
            return float(text.replace(",", ".") if decimal_comma else text)
        except ValueError:
            return np.nan

    numbers = [[number(cell) for cell in row] for row in cells]
    first = next((i for i, row in enumerate(numbers) if np.isfinite(row).any()), None)
    if first is None:
        raise Refused(f"{name} has no line of numbers")
    # A row of units or headings may contain digits, but rows of numbers begin with one.
    width = max(len(row) for row in numbers[first:])
    rows = []
    kept = []
    for (line, _), row in zip(body[first:], numbers[first:], strict=True):
        padded = row + [np.nan] * (width - len(row))
        rows.append([np.nan] * width if line in leave_out else padded)
        kept.append(line)
    names = [""] * width
    units = [""] * width
    for texts in cells[:first]:
        if len(texts) < min(width, 2) or len(texts) > width:
            continue
        empty = width - len(texts)
        split = [_heading(cell) for cell in texts] + [("", "")] * empty
        if any(names) and all(_UNIT_ROW.fullmatch(cell.strip("[]()").lower()) for cell in texts):
            units = [cell.strip("[]()") for cell in texts] + [""] * empty
        else:
            names = [heading for heading, _ in split]
            units = [unit for _, unit in split]
    return _Table(np.array(rows, float), kept, names, units)


def _is_decimal(line: str) -> bool:
    return re.fullmatch(r"\s*-?\d+,\d+\s*", line) is not None


def _heading(cell: str) -> tuple[str, str]:
    """Return the name and the unit of a heading such as 'Drop height (cm)' or 'h0/cm'."""
    found = re.fullmatch(r"(.*?)\s*[\[(]\s*([^\])]*?)\s*[\])]\s*", cell)
    if found is None:
        units = "s|ms|us|µs|m|cm|mm|px|m/s|cm/s|N|V"
        found = re.fullmatch(rf"(.+?)(?:\s*/\s*|[_ ]| in )({units})", cell)
    if found is None:
        return cell, ""
    return found[1].strip(), "" if found[2] in ("-", "–", "1") else found[2]


def _meaning(name: str, unit: str) -> str | None:
    if unit.lower() in ("px", "pixel", "pixels"):
        return None if name.lower().startswith("x") else "position"
    plain = re.sub(r"[{}$\\]", "", name).replace("_", " ").lower().strip()
    for meaning, pattern in _MEANINGS:
        if plain and re.search(pattern, plain):
            return meaning
    return "time" if unit.lower() in ("s", "ms") else None


def _columns(name: str, table: _Table) -> dict[str, Array]:
    """Return what the columns measure, in SI units, and "line", the numbers of the lines."""
    values = table.values
    names = table.names
    units = table.units
    line = np.array(table.lines)
    columns: dict[str, Array] = {}
    alike = {re.sub(r"\d+", "", each) for each in names}
    first = _meaning(names[0], units[0])
    is_series = first in ("time", "interval", "height") or (first is None and len(values) == 1)
    if len(names) > 2 and len(alike) == 1 and is_series:
        # Each line is a recording, as "Time 1 (s)", "Time 2 (s)", …
        line = np.repeat(line, len(names))
        columns["recording"] = line
        values = values.reshape(-1, 1)
        names = names[:1]
        units = units[:1]
    meanings = [_meaning(*each) for each in zip(names, units, strict=True)]
    if {"time", "height"} <= set(meanings) and len(values) >= _SHORTEST_TRACK:
        place = meanings.index("height")
        rises = values[:, place] - np.fmin.accumulate(values[:, place])
        if np.nanmax(rises, initial=0.0) > _RISE * np.ptp(values[np.isfinite(rises), place]):
            # Tops of flights fall, so that these are heights of a track.
            meanings[place] = "position"
    found: dict[str, list[Array]] = {}
    for column, heading, unit, meaning in zip(values.T, names, units, meanings, strict=True):
        if meaning is None or not np.isfinite(column).any():
            continue
        scale = 1.0
        if unit and meaning in UNITS:
            scale = in_si(f"{name}, column {heading!r}", f"1 {unit}", UNITS[meaning])
        elif meaning in ("drop", "rebound", "height") and np.nanmax(column) > _HIGHEST_WITHOUT_UNIT:
            raise Refused(
                f"{name}: heights up to {np.nanmax(column):g} without a unit: write it in the "
                f"heading, as in '{heading} (cm)'"
            )
        found.setdefault(meaning, []).append(column * scale)
    if not any(names):
        found = _without_headings(values)
    columns |= {meaning: parts[0] for meaning, parts in found.items()} | {"line": line}
    rebounds = found.get("rebound", [])
    if len(rebounds) < 2 or "drop" not in found:
        return columns
    heights = np.column_stack([columns["drop"], *rebounds])
    total = heights[np.isfinite(heights[:, :3]).all(axis=1), :3].sum(axis=0)
    # Of successive bounces, heights fall from each to the next: h₂/h₁ is nearer to h₁/h₀ than to 1.
    if total[2] ** 2 * total[0] < total[1] ** 3:
        line = np.repeat(line, heights.shape[1])
        return {"height": heights.ravel(), "recording": line, "line": line}
    return {
        "drop": np.tile(columns["drop"], len(rebounds)),
        "rebound": np.concatenate(rebounds),
        "line": np.tile(line, len(rebounds)),
    }


def _without_headings(values: Array) -> dict[str, list[Array]]:
    """Return the times of a table without headings: one column, or labels with start and end."""
    first = values[:, 0]
    rises = bool(np.all(np.diff(first[np.isfinite(first)]) > 0))
    if values.shape[1] == 1:
        return {"time": [first]}
    second = values[:, 1]
    is_label = rises and bool(np.all(~np.isfinite(second) | (second >= first)))
    return {"time": [first]} if is_label else {}


_PAIRS = (
    ("drops", "drop", "rebound", "m"),
    ("speeds", "in", "out", "m/s"),
    ("coefficients", "in", "restitution", ""),
)


def _measured(
    name: str, columns: dict[str, Array], head: dict[str, str], names: list[str]
) -> tuple[Recording, list[str]]:
    """Return the recording, and the columns that it was read from."""
    have = columns.keys()
    notes: list[str] = []
    durations = None
    uncertainty = None
    for speed in {"in", "out"} & have:
        if np.nanmax(columns[speed]) < 0:
            notes.append("the velocities are all negative: their sizes are the speeds")
        columns[speed] = np.abs(columns[speed])
    pairs = next((each for each in _PAIRS if {each[1], each[2]} <= have), None)
    if pairs is not None:
        kind, before, after, unit = pairs
        used = [before, after]
        chains = [_pairs(name, columns, before, after, unit)]
        uncertainty = columns.get("uncertainty")
    elif {"time", "position"} <= have:
        kind = "speeds"
        used = ["time", "position"]
        track, is_turned = _track(name, columns)
        chains = [track]
        if is_turned:
            notes.append("the positions grow downwards, as in a picture: they were turned")
        notes.append(f"{len(track)} impacts were found where flights meet; gravity is the scale.")
    elif "time" in have and {"force", "signal"} & have:
        kind = "flights"
        used = ["time", "force" if "force" in have else "signal"]
        touches, durations = _touches(name, columns, used[1])
        chains = [np.diff(touches)]
        notes.append(f"{len(touches)} impacts were found in the signal")
    elif {"time", "interval"} & have:
        kind = "flights"
        chains, of = _flights(name, columns)
        used = [of]
        if {"time", "interval"} <= have:
            notes.append(f"the file has times and intervals: it is read by its {of}s")
    elif {"height", "drop"} & have:
        kind = "heights"
        used = ["height" if "height" in have else "drop"]
        parts = _parts(columns, used[0])
        chains = _falling(name, parts, "height", "m", _HIGHEST)
    else:
        known = ", ".join(each for each in names if each) or "a table without headings"
        raise Refused(
            f"{name}: no bounces in {known}: times, intervals, heights, speeds or positions are "
            "needed"
        )
    if uncertainty is not None:
        uncertainty = uncertainty[np.isfinite(uncertainty)]
        if len(uncertainty) != len(chains[0]) or np.any(uncertainty <= 0):
            raise Refused(f"{name}: each impact needs an uncertainty above 0, or none has one")
    given = columns.get("duration", np.empty(0))
    given = given[np.isfinite(given)]
    if "contact time" in head:
        durations = np.array([in_si("contact time", head["contact time"], "s")])
    elif len(given):
        is_each = pairs is not None and len(given) == len(chains[0])
        durations = given if is_each else np.array([given.mean()])
    found = Recording(name, kind, tuple(chains), uncertainty, durations, head, tuple(notes))
    return found, used


def _pairs(name: str, columns: dict[str, Array], first: str, second: str, unit: str) -> Array:
    pairs = np.column_stack([columns[first], columns[second]])
    good = np.isfinite(pairs).all(axis=1)
    if not good.any():
        raise Refused(f"{name} has no complete line")
    for line, (before, after) in zip(columns["line"][good], pairs[good], strict=True):
        where = f"{name}, line {line}"
        if before <= 0 or after <= 0:
            raise Refused(f"{where}: {before:g} and {after:g} are not both positive")
        if unit == "m" and before > _HIGHEST:
            raise Refused(f"{where}: a height of {before:.3g} m: is it in cm? write the unit")
        if unit != "m" and before > _FASTEST:
            raise Refused(f"{where}: a speed of {before:.3g} m/s: is it in cm/s? write the unit")
        if after > 1.05 * before and unit:
            raise Refused(
                f"{where}: it rebounds with {after:.3g} {unit} from {before:.3g} {unit}: is a "
                "number wrong, or are the columns exchanged?"
            )
        if not unit and after > 1.05:
            raise Refused(
                f"{where}: a restitution coefficient of {after:.3g} is above 1: is it in per cent? "
                "write (%) in the heading"
            )
    return pairs[good]


_Parts = list[tuple[Array, Array]]


def _parts(columns: dict[str, Array], of: str) -> _Parts:
    """Return the values of each recording with their lines, divided where a number is missing."""
    values = columns[of]
    if of != "time":
        values = np.where(values == 0, np.nan, values)
    numbers = columns.get("recording", np.zeros(len(values)))
    found = []
    for number in dict.fromkeys(numbers[np.isfinite(numbers)]):
        both = np.column_stack([values, columns["line"]])[numbers == number]
        ends = np.flatnonzero(~np.isfinite(both[:, 0]))
        found += [part[np.isfinite(part[:, 0])].T for part in np.split(both, ends)]
    return [(part[0], part[1]) for part in found if part.size]


def _flights(name: str, columns: dict[str, Array]) -> tuple[list[Array], str]:
    """Return the durations of flights, and the column that they are of."""
    if "time" in columns:
        parts = _parts(columns, "time")
        steps = [(np.diff(times), lines[1:]) for times, lines in parts if len(times) > 1]
        rises = np.concatenate([step for step, _ in steps] or [np.empty(0)]) > 0
        if rises.all():
            return _falling(name, steps, "flight", "s", _LONGEST), "time"
        # A list of numbers that fall is one of intervals, whatever its heading.
        if "interval" not in columns and rises.mean() > 0.5:
            step, lines = next(each for each in steps if (each[0] <= 0).any())
            raise _unsorted(name, lines[step <= 0][0])
    of = "interval" if "interval" in columns else "time"
    return _falling(name, _parts(columns, of), "flight", "s", _LONGEST), of


def _unsorted(name: str, line: float) -> Refused:
    return Refused(f"{name}, line {line:.0f}: the time is not after the one before: sort the lines")


def _falling(name: str, parts: _Parts, what: str, unit: str, most: float) -> list[Array]:
    """Return chains without their lines, if they are of a bouncing ball."""
    for chain, lines in parts:
        before = np.concatenate([[np.inf], chain[:-1]])
        for line, value, last in zip(lines, chain, before, strict=True):
            found = f"{name}, line {line:.0f}: a {what} of {value:.4g} {unit}"
            if value <= 0:
                raise Refused(f"{found} is not positive")
            if value > most:
                small = "ms" if unit == "s" else "cm"
                raise Refused(
                    f"{found}: is it in {small}? write the unit in the heading, as in '{what} "
                    f"({small})'"
                )
            if value > _LONGER * last:
                raise Refused(
                    f"{found} follows one of {last:.4g} {unit}: an impact is missing, or another "
                    "recording begins (give a column 'recording', or --leave-out its line)"
                )
    return [chain for chain, _ in parts]


def _even(times: Array) -> Array:
    """Return the times of a camera, which are even, although a table rounds them."""
    frames = np.arange(len(times))
    slope, start = np.polyfit(frames, times, 1)
    even = start + slope * frames
    # Where frames are missing, some time is nearer to another frame than to its own.
    return even if np.abs(even - times).max() < 0.5 * slope else times


def _in_time(name: str, columns: dict[str, Array], of: str) -> tuple[Array, Array, Array]:
    """Return the times, values and lines of a track or a signal."""
    rows = np.column_stack([columns["time"], columns[of], columns["line"]])
    times, values, lines = rows[np.isfinite(rows).all(axis=1)].T
    back = np.flatnonzero(np.diff(times) < 0)
    if len(back):
        raise _unsorted(name, lines[back[0] + 1])
    return times, values, lines


def _track(name: str, columns: dict[str, Array]) -> tuple[Array, bool]:
    """Return speeds before and after impacts of a track, and whether it grows downwards.

    Flights are parabolas that are open below: the other way round, they would end at their tops,
    and parabolas would miss the impacts between them.
    """
    times, heights, lines = _in_time(name, columns, "position")
    if len(times) < _SHORTEST_TRACK:
        raise Refused(f"{name}: a track of {len(times)} positions is too short")
    t = _even(times)
    upwards = _meetings(t, heights)
    downwards = _meetings(t, -heights)
    is_turned = downwards[1] < upwards[1]
    meetings = downwards[0] if is_turned else upwards[0]
    if not meetings:
        raise Refused(f"{name}: no impact between two flights of four positions in the track")
    at, before, after = np.array(meetings).T
    impacts = {"line": lines[at.astype(int)].astype(int), "in": before, "out": after}
    return _pairs(name, impacts, "in", "out", "m/s"), bool(is_turned)


def _meetings(t: Array, y: Array) -> tuple[list[tuple[int, float, float]], float]:
    """Return frame, speeds before and after of each impact, and the misfit of the parabolas.

    Two neighbouring flights have one curvature, which is that of gravity and gives the scale.
    """
    from scipy.signal import find_peaks

    low, _ = find_peaks(-y, prominence=_RISE * np.ptp(y))
    edges = [-1, *(int(i) for i in low), len(y)]
    # The frames beside an impact may show a part of it.
    flights = [
        np.arange(max(start + 2, 0), min(end - 1, len(y)))
        for start, end in zip(edges[:-1], edges[1:], strict=True)
    ]
    found = []
    squares = 0.0
    free = 0
    for impact, before, after in zip(low, flights[:-1], flights[1:], strict=True):
        if min(len(before), len(after)) < 4:
            continue
        both = np.concatenate([before, after])
        is_after = np.isin(both, after)
        time = t[both] - t[impact]
        rows = np.column_stack([time**2, ~is_after, ~is_after * time, is_after, is_after * time])
        best = np.linalg.lstsq(rows, y[both], rcond=None)[0]
        squares += float(np.sum((y[both] - rows @ best) ** 2))
        free += len(both) - len(best)
        a, c1, b1, c2, b2 = best
        meet = (c1 - c2) / (b2 - b1)
        scale = STANDARD_GRAVITY / (-2 * a)
        found.append((impact, -(b1 + 2 * a * meet) * scale, (b2 + 2 * a * meet) * scale))
    return found, squares / free if free else np.inf


def _touches(name: str, columns: dict[str, Array], of: str) -> tuple[Array, Array | None]:
    """Return the times at which impacts begin in a signal, and how long they last in a force.

    An impact rises above a fifth of the largest peak after silence. A force has the contact from
    where it last was below a twentieth of its peak, or in the noise, to where it is so again.
    """
    t, signal, _ = _in_time(name, columns, of)
    size = np.abs(signal - np.median(signal))
    noise = float(np.median(size))
    above = np.flatnonzero(size > max(size.max(initial=0.0) / 5, 6 * noise))
    starts = above[np.diff(t[above], prepend=-np.inf) > _SILENCE]
    if len(starts) < 3:
        raise Refused(f"{name}: {len(starts)} impacts stand out of the signal: three are needed")
    if of != "force":
        return t[starts], None
    contacts = []
    for start, end in zip(starts, [*starts[1:], len(t)], strict=True):
        peak = start + int(np.argmax(size[start:end]))
        low = np.flatnonzero(size <= max(size[peak] / 20, 10 * noise))
        place = np.searchsorted(low, peak)
        if 0 < place < len(low):
            # The force begins and ends between two samples.
            begin, over = low[place - 1], low[place]
            contacts.append([t[begin : begin + 2].mean(), t[over - 1 : over + 1].mean()])
    begins, ends = np.array(contacts).T
    return begins, ends - begins
