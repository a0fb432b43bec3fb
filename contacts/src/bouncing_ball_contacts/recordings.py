"""Recordings of bounces, as instruments, programs and people write them.

A file is a table with any delimiter and decimal sign, with or without headings, or the first sheet
of a spreadsheet. Its columns say what was measured: times of impacts or intervals between them,
heights of a drop and its rebound, speeds before and after, restitution coefficients, positions over
time, or a signal in which impacts stand out. Lines ``# key: value`` above it name the ball.
"""

import re
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass, field
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
    "position": "m",
    "in": "m/s",
    "out": "m/s",
    "duration": "s",
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
    ("rebound", r"rebound|bounce height|^h ?(1|2|'|′|after|out|r)\b|^h'"),
    ("drop", r"drop|release|initial height|start height|^h ?(0|before|in|i)\b"),
    ("height", r"height|^h$"),
    ("recording", r"recording|^run\b|trial|series|ball\b"),
    ("count", r"number|^(no|nr)\.?$|^n$|^#$|index|^(event|bounce|impact)s?$"),
    ("time", r"^t ?\d*$|time|second"),
    ("position", r"^y$|position.*y|^z$|vertical"),
    ("signal", r"^f[a-z]?$|force|volt|ampl|sound|accel|pressure|^ch ?\d|recording|audio|load"),
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


@dataclass(frozen=True)
class Recording:
    """What was measured.

    ``kind`` is "flights" (durations of successive flights in s), "heights" (successive tops),
    "drops" (pairs of heights), "speeds" (pairs) or "coefficients" (pairs of speed and r).

    ``chains`` are arrays, one for each recording; those of pairs have two columns. ``uncertainty``
    has standard deviations of r, ``durations`` contact times in s, one or one for each impact;
    ``head`` has what the file says of the ball.
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
    return _measured(name, columns, head, table)


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
        found = re.fullmatch(r"(.+?)(?:\s*/\s*|[_ ]| in )(s|ms|us|µs|m|cm|mm|m/s|cm/s|N|V)", cell)
    return (found[1].strip(), found[2]) if found else (cell, "")


def _meaning(name: str, unit: str) -> str | None:
    plain = re.sub(r"[{}$\\]", "", name).replace("_", " ").lower().strip()
    for meaning, pattern in _MEANINGS:
        if plain and re.search(pattern, plain):
            return meaning
    return "time" if unit.lower() in ("s", "ms") else None


def _columns(name: str, table: _Table) -> dict[str, Array]:
    values = table.values
    names = table.names
    units = table.units
    alike = {re.sub(r"\d+", "", each) for each in names}
    if len(values) == 1 and len(names) > 2 and len(alike) == 1:
        # One recording in one line, as "Time 1 (s)", "Time 2 (s)", …
        values = values.T
        names = names[:1]
        units = units[:1]
    found: dict[str, list[Array]] = {}
    for column, heading, unit in zip(values.T, names, units, strict=True):
        meaning = _meaning(heading, unit)
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
    columns = {meaning: parts[0] for meaning, parts in found.items()}
    if len(found.get("rebound", [])) > 1 and "drop" in columns:
        # Several rebounds of one drop height, each in a column.
        columns["drop"] = np.tile(columns["drop"], len(found["rebound"]))
        columns["rebound"] = np.concatenate(found["rebound"])
    return columns


def _without_headings(values: Array) -> dict[str, list[Array]]:
    """Return the times of a table without headings: one column, or labels with start and end."""
    first = values[:, 0]
    rises = bool(np.all(np.diff(first[np.isfinite(first)]) > 0))
    if values.shape[1] == 1:
        return {"time": [first]}
    second = values[:, 1]
    is_label = rises and bool(np.all(~np.isfinite(second) | (second >= first)))
    return {"time": [first]} if is_label else {}


def _measured(
    name: str, columns: dict[str, Array], head: dict[str, str], table: _Table
) -> Recording:
    have = columns.keys()
    notes: list[str] = []
    for speed in {"in", "out"} & have:
        if np.nanmax(columns[speed]) < 0:
            notes.append("the velocities are all negative: their sizes are the speeds")
        columns[speed] = np.abs(columns[speed])
    lines = table.lines
    if {"drop", "rebound"} <= have:
        kind = "drops"
        chains = [_pairs(name, lines, columns["drop"], columns["rebound"], "m")]
    elif {"in", "out"} <= have:
        kind = "speeds"
        chains = [_pairs(name, lines, columns["in"], columns["out"], "m/s")]
    elif {"in", "restitution"} <= have:
        kind = "coefficients"
        chains = [_pairs(name, lines, columns["in"], columns["restitution"], "")]
    elif {"time", "position"} <= have:
        kind = "speeds"
        chains = [_track(name, columns["time"], columns["position"])]
        notes.append(
            f"{len(chains[0])} impacts were found where flights meet; gravity is the scale."
        )
    elif {"time", "signal"} <= have:
        kind = "flights"
        chains = [np.diff(_peaks(name, columns["time"], columns["signal"]))]
        notes.append(f"{len(chains[0]) + 1} impacts were found in the signal")
    elif "time" in have or "interval" in have:
        kind = "flights"
        chains, of = _flights(name, columns, lines)
        if {"time", "interval"} <= have:
            notes.append(f"the file has times and intervals: it is read by its {of}")
    elif "height" in have or "drop" in have:
        kind = "heights"
        tops = columns.get("height", columns.get("drop"))
        assert tops is not None
        chains = _parts(tops, columns)
        _require_falling(name, chains, "height", "m", _HIGHEST)
    else:
        known = ", ".join(each for each in table.names if each) or "a table without headings"
        raise Refused(
            f"{name}: no bounces in {known}: times, intervals, heights, speeds or positions are "
            "needed"
        )
    uncertainty = columns.get("uncertainty")
    if uncertainty is not None and kind in ("drops", "speeds", "coefficients"):
        uncertainty = uncertainty[: len(lines)][np.isfinite(uncertainty[: len(lines)])]
        if len(uncertainty) != len(chains[0]) or np.any(uncertainty <= 0):
            raise Refused(f"{name}: each impact needs an uncertainty above 0, or none has one")
    else:
        uncertainty = None
    durations = None
    if "contact time" in head:
        durations = np.array([in_si("contact time", head["contact time"], "s")])
    elif "duration" in have and np.isfinite(columns["duration"]).any():
        durations = columns["duration"][np.isfinite(columns["duration"])]
        if len(durations) != len(chains[0]):
            durations = np.array([durations.mean()])
    return Recording(
        name=name,
        kind=kind,
        chains=tuple(chains),
        uncertainty=uncertainty,
        durations=durations,
        head=head,
        notes=tuple(notes),
    )


def _pairs(name: str, lines: list[int], first: Array, second: Array, unit: str) -> Array:
    good = np.isfinite(first) & np.isfinite(second)
    pairs = np.column_stack([first, second])[good]
    if not len(pairs):
        raise Refused(f"{name} has no complete line")
    numbers = np.resize(lines, len(first))[good]
    for line, (before, after) in zip(numbers, pairs, strict=True):
        where = f"{name}, line {line}"
        if before <= 0 or after <= 0:
            raise Refused(f"{where}: {before:g} and {after:g} are not both positive")
        if unit == "m" and before > _HIGHEST:
            raise Refused(f"{where}: a height of {before:.3g} m: is it in cm? write the unit")
        if unit != "m" and before > _FASTEST:
            raise Refused(f"{where}: a speed of {before:.3g} m/s: is it in cm/s? write the unit")
        if after > 1.05 * before and unit:
            raise Refused(
                f"{where}: it rebounds with {after:.3g} {unit} from {before:.3g} {unit}: are the "
                "columns exchanged?"
            )
        if not unit and after > 1.05:
            raise Refused(f"{where}: a restitution coefficient of {after:.3g} is above 1")
    return pairs


def _parts(values: Array, columns: dict[str, Array]) -> list[Array]:
    """Return the values of each recording, divided where a line was left out."""
    numbers = columns.get("recording", np.zeros(len(values)))
    found = []
    for number in dict.fromkeys(numbers[np.isfinite(numbers)]):
        of_this = values[numbers == number]
        ends = np.flatnonzero(~np.isfinite(of_this) | (of_this == 0))
        found += [part[np.isfinite(part) & (part != 0)] for part in np.split(of_this, ends)]
    return [part for part in found if len(part)]


def _flights(name: str, columns: dict[str, Array], lines: list[int]) -> tuple[list[Array], str]:
    """Return the durations of flights, and whether they were read by times or by intervals."""
    times = columns.get("time")
    if times is not None:
        numbers = columns.get("recording", np.zeros(len(times)))
        rising = all(
            np.all(np.diff(times[(numbers == each) & np.isfinite(times)]) > 0)
            for each in np.unique(numbers[np.isfinite(numbers)])
        )
        # A list of numbers that fall is one of intervals, whatever its heading.
        if rising:
            shifted = np.where(times == 0, 1e-12, times)
            chains = [np.diff(part) for part in _parts(shifted, columns) if len(part) > 1]
            _require_falling(name, chains, "flight", "s", _LONGEST)
            return chains, "times"
    values = columns.get("interval", times)
    assert values is not None
    chains = _parts(values, columns)
    _require_falling(name, chains, "flight", "s", _LONGEST)
    return chains, "intervals"


def _require_falling(name: str, chains: list[Array], what: str, unit: str, most: float) -> None:
    for chain in chains:
        if np.any(chain <= 0):
            raise Refused(f"{name}: a {what} of {chain.min():.4g} {unit} is not positive")
        if len(chain) and chain.max() > most:
            small = "ms" if unit == "s" else "cm"
            raise Refused(
                f"{name}: a {what} of {chain.max():.4g} {unit}: is it in {small}? write the unit "
                f"in the heading, as in '{what} ({small})'"
            )
        longer = np.flatnonzero(chain[1:] > _LONGER * chain[:-1])
        if len(longer):
            i = int(longer[0])
            raise Refused(
                f"{name}: a {what} of {chain[i + 1]:.4g} {unit} follows one of {chain[i]:.4g} "
                f"{unit}: an impact is missing, or another recording begins (give a column "
                "'recording', or --leave-out its line)"
            )


def _even(times: Array) -> Array:
    """Return the times of a camera, which are even, although a table rounds them."""
    frames = np.arange(len(times))
    slope, start = np.polyfit(frames, times, 1)
    even = start + slope * frames
    # Where frames are missing, some time is nearer to another frame than to its own.
    return even if np.abs(even - times).max() < 0.5 * slope else times


def _track(name: str, times: Array, heights: Array) -> Array:
    """Return speeds before and after impacts, where the parabolas of neighbouring flights meet.

    All flights have one curvature, which is that of gravity and gives the scale.
    """
    from scipy.signal import find_peaks

    good = np.isfinite(times) & np.isfinite(heights)
    t = _even(times[good])
    y = heights[good]
    if len(t) < 8:
        raise Refused(f"{name}: a track of {len(t)} positions is too short")
    low, _ = find_peaks(-y, prominence=0.03 * np.ptp(y))
    edges = [-1, *(int(i) for i in low), len(y)]
    flights = []
    for start, end in zip(edges[:-1], edges[1:], strict=True):
        # The frames beside an impact may show a part of it.
        inside = np.arange(max(start + 2, 0), min(end - 1, len(y)))
        flights.append(inside if len(inside) >= 4 else None)
    pairs = []
    for before, after in zip(flights[:-1], flights[1:], strict=True):
        if before is None or after is None:
            continue
        pairs.append(_meeting(t[before], y[before], t[after], y[after]))
    if not pairs:
        raise Refused(f"{name}: no impact between two flights of four positions in the track")
    return np.array(pairs)


def _meeting(t1: Array, y1: Array, t2: Array, y2: Array) -> tuple[float, float]:
    """Return the speeds in m/s at which two flights of one curvature meet."""
    zero = t2[0]
    rows1 = np.column_stack([(t1 - zero) ** 2, np.ones_like(t1), t1 - zero, 0 * t1, 0 * t1])
    rows2 = np.column_stack([(t2 - zero) ** 2, 0 * t2, 0 * t2, np.ones_like(t2), t2 - zero])
    a, c1, b1, c2, b2 = np.linalg.lstsq(
        np.vstack([rows1, rows2]), np.concatenate([y1, y2]), rcond=None
    )[0]
    meet = -(c2 - c1) / (b2 - b1)
    scale = STANDARD_GRAVITY / (2 * abs(a))
    sign = -np.sign(a)
    return float(-sign * (b1 + 2 * a * meet) * scale), float(sign * (b2 + 2 * a * meet) * scale)


def _peaks(name: str, times: Array, signal: Array) -> Array:
    """Return the times at which a signal rises above a fifth of its largest peak after silence."""
    good = np.isfinite(times) & np.isfinite(signal)
    t = times[good]
    size = np.abs(signal[good] - np.median(signal[good]))
    level = max(size.max() / 5, 6 * float(np.median(size)))
    above = np.flatnonzero(size > level)
    starts = above[np.diff(t[above], prepend=-np.inf) > _SILENCE] if len(above) else above
    if len(starts) < 3:
        raise Refused(f"{name}: {len(starts)} impacts stand out of the signal: three are needed")
    return t[starts]
