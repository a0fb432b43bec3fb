"""Recordings of bounces, as instruments, programs and people write them.

A file is a table with any delimiter and decimal sign, with or without headings, or the first sheet
of a spreadsheet. Its columns say what was measured: times of impacts or intervals between them,
heights of a drop and its rebound, speeds before and after, restitution coefficients, positions over
time, or a signal in which impacts stand out. Lines ``# key: value`` above it name the ball.
"""

import contextlib
import csv
import io
import json
import math
import re
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib.resources import files
from itertools import zip_longest
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from bouncing_ball_contacts.schemes import Array
from bouncing_ball_contacts.units import STANDARD_GRAVITY, Refused, in_si

UNITS = {
    "time": "s",
    "interval": "s",
    "drop": "m",
    "rebound": "m",
    "average": "m",
    "height": "m",
    "in": "m/s",
    "out": "m/s",
    "duration": "s",
    "restitution": "",
    "uncertainty": "",
}
# Words of German, French, Spanish and Italian headings.
_WORDS = {
    "rebound": "rück(?:sprung|prall)|abprall|rebond|rebote|rimbalzo",
    "drop": "fall(?=höhe)|chute|ca[ií]da|caduta"
    "|(?<=hauteur )initiale|(?<=altura )inicial|(?<=altezza )iniziale",
    "height": "höhe|hauteur|altura|altezza",
    "impact": "einfall|aufprall|auftreff|impacto|impatto",
    "speed": "geschwindigkeit|vitesse|velocidad|velocità",
    "before": r"\bvor\b|avant|antes|\bprima\b",
    "after": r"\bnach\b|après|después|\bdopo\b",
    "restitution": "restitu|stoßzahl",
    "average": r"mittel(?:wert)?|moyenne|promedio|\bmedia\b",
    "time": r"\bzeit|\btemps\b|tiempo|\btempo\b",
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
    ("out", r"^v ?f$|final\b.*\b(speed|velocity)"),
    ("in", r"^v ?[0i]$|(impact|incoming|falling|initial)\b.*\b(speed|velocity)"),
    ("interval", r"interval|flight|bou\w+ time|Δt|delta ?t|^dt$"),
    ("average", r"^(average|mean)$|\b(average|mean)\b.*bound|bound.*\b(average|mean)\b"),
    ("rebound", r"rebound|bounce height|bounced|\bh ?([1-9]\d*|after|out|r|f)\b|^h ?['′]"),
    ("rebound", r"height.*\b(after|end|final|reached)|^(after|end|final|max\w*)\b.*height"),
    ("drop", r"drop|release|^(initial|start)\b.*height|height.*\b(before|initial|start)"),
    ("drop", r"\bh ?(0|before|in|i)\b"),
    ("height", r"height|^h$"),
    ("recording", r"recording|^run\b|trial|series|ball\b"),
    ("count", r"number|^(no|nr)\.?$|^n$|^#$|index|^(event|bounce|impact)s?$"),
    ("time", r"^t ?\d*$|time|second"),
    ("position", r"^[yz]\b|^(?!x\b).*\bposition\b(?!.*\bx\b)|vertical"),
    ("force", r"^f[a-z]?$|force|load"),
    ("signal", r"volt|ampl|sound|accel|pressure|^ch ?\d|audio"),
)
_UNIT_ROW = re.compile(
    r"|s|ms|µs|us|ns|m|cm|mm|m/s|cm/s|m/s²|m/s\^2|n|kn|v|mv|a\.u\.|pa|g|seconds?|volts?"
)
_SUGGESTED = (
    "write headings such as time, interval, height, drop_height and rebound_height, "
    "speed_before and speed_after, speed and COR, or t and y"
)
_TIMES = "times are in seconds, mm:ss.s or hh:mm:ss.s"
_HEADS = ("mass", "diameter", "contact time", "resolution")
_LENGTHS = ("m", "cm", "mm")
_PIXELS = ("px", "pixel", "pixels")
_HIGHEST = 100.0
_HIGHEST_WITHOUT_UNIT = 10.0
_FASTEST = 100.0
_LONGEST = 9.0
# An interval may exceed the one before it by the errors of both.
_LONGER = 1.02
# Between two impacts a signal is silent for this time in s.
_SILENCE = 0.03
# A contact that lasts longer, in s, is not one of a ball.
_LONGEST_CONTACT = 0.03
_SHORTEST_TRACK = 8
# Heights that contradict gravity by this factor are said so.
_OFF = 2.0
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


def read(
    source: str | Path | Mapping[str, Any], leave_out: Sequence[int] = (), intervals: bool = False
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
    if not isinstance(source, str | Path):
        lines = _of_columns(type(source).__name__, source).splitlines()
        return _interpreted("columns", lines, set(leave_out), intervals)
    path = Path(source)
    if str(source) in experiments():
        path = Path(str(files(__package__).joinpath("experiments", f"{source}.csv")))
    if not path.exists() or path.is_dir():
        raise Refused(f"{source} is no file, and none of {', '.join(experiments())}")
    data = path.read_bytes()
    name = Path(source).name
    text = _sheet(data) if data.startswith(b"PK") else _decoded(name, data)
    with contextlib.suppress(json.JSONDecodeError):
        text = _of_columns(name, json.loads(text))
    return _interpreted(name, text.splitlines(), set(leave_out), intervals)


def _of_columns(name: str, columns: Any) -> str:
    """Return columns by their headings as lines with tabs."""
    try:
        rows = zip_longest(*map(np.asarray, columns.values()), fillvalue="")
        return "\n".join("\t".join(map(str, row)) for row in (columns, *rows))
    except (AttributeError, TypeError, ValueError):
        raise Refused(
            f"{name} is no recording: give a file, the name of an experiment, or columns such as "
            "{'time (s)': [0.45, 1.17, 1.75]}"
        ) from None


def _decoded(name: str, data: bytes) -> str:
    is_wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    if b"\0" in data[:4000] and not is_wide:
        raise Refused(f"{name} is no text and no spreadsheet")
    with contextlib.suppress(UnicodeDecodeError):
        return data.decode("utf-16" if is_wide else "utf-8-sig")
    return data.decode("latin-1")


def _sheet(data: bytes) -> str:
    """Return the first sheet of an xlsx file as lines with tabs."""
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
                    letters = reversed(re.sub(r"\d", "", cell.get("r", "A")))
                    place = sum(26**i * (ord(each) - 64) for i, each in enumerate(letters))
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
        found = re.match(r"\s*#\s*([\w ]+?)\s*[:=]\s*(.*?)\s*$", line)
        if found:
            key = found[1].lower().replace("_", " ")
            head[key] = f"{head[key]} {found[2]}" if key in head else found[2]
        # Audacity has the frequencies of a label in a line that begins with a backslash.
        elif not line.lstrip().startswith(("#", "\\")):
            body.append((number, line))
    full = [each for each in body if each[1].strip()]
    if not full:
        raise Refused(f"{name} is empty")
    # Empty lines divide series, unless each line is followed by one.
    body = [each for each in body if full[0] <= each <= full[-1]]
    if len(body) > 1.5 * len(full):
        body = full
    if missing := leave_out - {number for number, _ in body}:
        raise Refused(f"{name} has no line {min(missing)} of numbers to leave out")
    values, numbers, headings = _table(name, body, leave_out)
    columns = _columns(name, values, numbers, headings)
    known = ", ".join(heading for heading, _ in headings if heading)
    recording, used = _measured(name, columns, head, intervals, known)
    notes = list(recording.notes)
    unused = [
        f"'{key}: {value}'"
        for key, value in head.items()
        if not key.startswith(_HEADS) and re.fullmatch(r"[\d.,]+( ?[^\d\s-]\S*)?", value)
    ]
    if unused:
        notes.append(f"the head has {', '.join(unused)}, but only {', '.join(_HEADS)} are used")
    # Lines that were left out on purpose are known to be missing.
    has_gap = ~np.all([np.isfinite(columns[each]) for each in used], axis=0)
    gaps = sorted(set(columns["line"][has_gap]) - leave_out)
    if gaps:
        shown = ", ".join(f"{number:.0f}" for number in gaps[:5]) + (", …" if gaps[5:] else "")
        divides = " and divides the series" if recording.kind in ("flights", "heights") else ""
        notes.append(f"a number is missing in line {shown}, which is left out{divides}")
    return replace(recording, notes=tuple(notes))


_Headings = list[tuple[str, str]]


def _table(
    name: str, body: list[tuple[int, str]], leave_out: set[int]
) -> tuple[Array, Array, _Headings]:
    """Return the numbers, NaN where there is none, their lines, and names and units of columns."""
    first_line = body[0][1]
    last = body[-1][1]
    delimiter: str | None = next((mark for mark in ("\t", ";", ",") if mark in last), None)
    is_column = len(last.split()) < 2 and not delimiter
    if delimiter == ",":
        # Commas are decimal signs in a single column, whose heading has no comma.
        one_column = all(_is_decimal(line) for _, line in body[1:] if line.strip())
        is_column = one_column and ("," not in first_line or _is_decimal(first_line))
    if is_column:
        delimiter = "\x1f"
    rows = (
        next(csv.reader([line], delimiter=delimiter)) if delimiter and line else line.split()
        for _, line in body
    )
    cells = [[cell.strip().strip('"').strip() for cell in row] for row in rows]

    def number(cell: str) -> float:
        """Return a number, the seconds of mm:ss.s or hh:mm:ss.s, or NaN."""
        if delimiter == "," and re.fullmatch(r"[1-9]\d{0,2},\d{3}", cell):
            raise Refused(
                f"{name}: {cell!r} may have thousands or decimals: write it without a comma"
            )
        text = cell.replace("−", "-").replace(",", ".")
        try:
            return sum(float(part) * 60**i for i, part in enumerate(reversed(text.split(":"))))
        except ValueError:
            return np.nan

    numbers = [[number(cell) for cell in row] for row in cells]
    first = next((i for i, row in enumerate(numbers) if np.isfinite(row).any()), None)
    if first is None:
        raise Refused(f"{name} has no line of numbers; {_TIMES}")
    # A row of units or headings may contain digits, but rows of numbers begin with one.
    width = max(len(row) for row in numbers[first:])
    lines = np.array([line for line, _ in body[first:]])
    values = np.full((len(lines), width), np.nan)
    for i in np.flatnonzero(~np.isin(lines, list(leave_out))):
        row = numbers[first + i]
        values[i, : len(row)] = row
    headings = [("", "")] * width
    for texts in cells[:first]:
        if not (any(texts) and min(width, 2) <= len(texts) <= width):
            continue
        each = texts + [""] * (width - len(texts))
        units = [cell.strip("[]()") for cell in each]
        is_below = any(heading for heading, _ in headings)
        if is_below and all(_UNIT_ROW.fullmatch(unit.lower()) for unit in units):
            headings = [(old[0], unit) for old, unit in zip(headings, units, strict=True)]
        else:
            headings = [_heading(cell) for cell in each]
    for place, heading in enumerate(headings):
        if _meaning(*heading) == "recording" and not np.isfinite(values[:, place]).any():
            # Recordings may have names.
            recordings = [(row + [""] * width)[place] for row in cells[first:]]
            values[:, place] = [recordings.index(each) for each in recordings]
    return values, lines, headings


def _is_decimal(line: str) -> bool:
    return re.fullmatch(r"\s*-?[\d:]+,\d+\s*", line) is not None


def _heading(cell: str) -> tuple[str, str]:
    """Return the name and the unit of a heading such as 'Drop height (cm)' or 'h0/cm'."""
    units = "s|ms|us|µs|ns|m|cm|mm|px|m/s|cm/s|N|V"
    found = re.fullmatch(r"(.*?)\s*[\[(]\s*([^\])]*?)\s*[\])]\s*", cell) or re.fullmatch(
        rf"(.+?)(?:\s*/\s*|[_ ]| in )({units})", cell
    )
    if found is None:
        return cell, ""
    # In (mm:ss) the colon says it all.
    return found[1].strip(), "" if found[2] in ("-", "–", "1") or ":" in found[2] else found[2]


def _meaning(name: str, unit: str) -> str | None:
    plain = re.sub(r"[{}$\\]", "", name).replace("_", " ").lower().strip()
    for word, foreign in _WORDS.items():
        plain = re.sub(foreign, f" {word} ", plain).strip()
    found = next((each for each, pattern in _MEANINGS if plain and re.search(pattern, plain)), None)
    if found == "height" and unit.lower() in _PIXELS:
        return "position"
    return "time" if found is None and unit.lower() in ("s", "ms") else found


def _meanings(headings: _Headings, values: Array) -> list[str | None]:
    """Return what the columns mean beside each other."""
    meanings = [_meaning(*each) for each in headings]
    # "Bounce" is a number of a bounce, or its height.
    meanings = [
        "rebound" if each == "count" and (unit in _LENGTHS or np.any(column % 1 > 0)) else each
        for each, (_, unit), column in zip(meanings, headings, values.T, strict=True)
    ]
    if "drop" in meanings and "rebound" not in meanings:
        # "Trial 1", "Trial 2", … beside a drop height.
        meanings = [
            "rebound" if each in (None, "recording") and re.search(r"\d$", heading) else each
            for each, (heading, _) in zip(meanings, headings, strict=True)
        ]
    if meanings.count("height") == 1 and len(of_pair := {"drop", "rebound"} & set(meanings)) == 1:
        meanings[meanings.index("height")] = ({"drop", "rebound"} - of_pair).pop()
    if "time" in meanings and meanings.count("height") == 1:
        place = meanings.index("height")
        steps = np.diff(values[:, place])
        # Tops of flights fall, whereas a track rises in half of its frames.
        if np.sum(steps > 0) > 0.3 * np.count_nonzero(steps):
            meanings[place] = "position"
        elif np.any(steps) and "interval" not in meanings:
            meanings[meanings.index("time")] = None
    return meanings


def _columns(name: str, values: Array, line: Array, headings: _Headings) -> dict[str, Array]:
    """Return what the columns measure, in SI units, and "line", the numbers of the lines."""
    columns: dict[str, Array] = {}
    alike = {re.sub(r"\d+", "", heading) for heading, _ in headings}
    first = _meaning(*headings[0])
    is_series = first in ("time", "interval", "height") or (first is None and len(values) == 1)
    if len(headings) > 1 and len(alike) == 1 and is_series:
        # Each line is a recording, as "Time 1 (s)", "Time 2 (s)", …, or each column is.
        later = -values if first in ("interval", "height") else values
        by_column = len(values) > 1 and not (np.diff(later, axis=0) <= 0).any()
        if by_column and not (np.diff(later) <= 0).any():
            raise Refused(
                f"{name}: each line or each column may be a recording: write one below the other "
                "with an empty line between"
            )
        number = np.tile(np.arange(len(headings), dtype=float), len(values))
        line = np.repeat(line, len(headings))
        columns["recording"] = number if by_column else line
        values = values.reshape(-1, 1)
        headings = headings[:1]
    meanings = _meanings(headings, values)
    found: dict[str, list[Array]] = {}
    for column, (heading, unit), meaning in zip(values.T, headings, meanings, strict=True):
        if meaning is None or not np.isfinite(column).any():
            continue
        scale = 1.0
        if meaning == "position" and unit in _LENGTHS:
            columns["metre"] = np.array(in_si(heading, f"1 {unit}", "m"))
        if unit and meaning in UNITS:
            scale = in_si(f"{name}, column {heading!r}", f"1 {unit}", UNITS[meaning])
        elif UNITS.get(meaning) == "m" and np.nanmax(column) > _HIGHEST_WITHOUT_UNIT:
            raise Refused(
                f"{name}: heights up to {np.nanmax(column):g} without a unit: write it in the "
                f"heading, as in '{heading} (cm)'"
            )
        found.setdefault(meaning, []).append(column * scale)
    for meaning in ("interval", "height", "drop", "in", "out"):
        if len(found.get(meaning, [])) > 1:
            raise Refused(
                f"{name}: two columns are both taken as {meaning}: leave one out, or {_SUGGESTED}"
            )
    if "rebound" not in found and "average" in found:
        found["rebound"] = found["average"]
    is_label = not ((values[:, 0] > values[:, 1:2].T).any() or (np.diff(values[:, 0]) <= 0).any())
    if alike == {""} and (is_label or values.shape[1] == 1):
        # One column, or labels with start and end.
        found = {"time": [values[:, 0]]}
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
    return columns | {
        "drop": np.tile(columns["drop"], len(rebounds)),
        "rebound": np.concatenate(rebounds),
        "line": np.tile(line, len(rebounds)),
    }


_PAIRS = (
    ("drops", "drop", "rebound", "m"),
    ("speeds", "in", "out", "m/s"),
    ("coefficients", "in", "restitution", ""),
)


def _measured(
    name: str, columns: dict[str, Array], head: dict[str, str], intervals: bool, known: str
) -> tuple[Recording, list[str]]:
    """Return the recording, and the columns that it was read from."""
    have = columns.keys()
    notes: list[str] = []
    durations = None
    for speed in {"in", "out"} & have:
        if np.nanmax(columns[speed]) < 0:
            notes.append("the velocities are all negative: their sizes are the speeds")
        columns[speed] = np.abs(columns[speed])
    # One half of a pair is no series.
    alone = {"drop", "rebound", "in", "out"} & have
    pairs = next((each for each in _PAIRS if {each[1], each[2]} <= have), None)
    uncertainty = None if pairs is None else columns.get("uncertainty")
    if intervals and not {"time", "interval"} & have:
        raise Refused(f"{name} has no column of intervals")
    if pairs is not None:
        kind, *used, unit = pairs
        chains = [_pairs(name, columns, used, unit)]
    elif {"time", "position"} <= have:
        kind = "speeds"
        used = ["time", "position"]
        track, notes = _track(name, columns)
        chains = [track]
    elif "time" in have and {"force", "signal"} & have:
        kind = "flights"
        used = ["time", "force" if "force" in have else "signal"]
        touches, durations = _touches(name, columns, used[1])
        chains = [np.diff(touches)]
        notes.append(f"{len(touches)} impacts were found in the signal")
    elif {"time", "interval"} & have and not alone:
        kind = "flights"
        chains, of = _flights(name, columns, intervals)
        used = [of]
        if {"time", "interval"} <= have and not intervals:
            notes.append(f"the file has times and intervals: it is read by its {of}s")
    elif "height" in have and not alone:
        kind = "heights"
        used = ["height"]
        chains = _falling(name, _parts(columns, "height"), "height", "m", _HIGHEST)
    else:
        raise Refused(
            f"{name}: no bounces in {known or 'a table without headings'}: {_SUGGESTED}; {_TIMES}"
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
    recording = Recording(
        name=name,
        kind=kind,
        chains=tuple(chains),
        uncertainty=uncertainty,
        durations=durations,
        head=head,
        notes=tuple(notes),
    )
    return recording, used


def _pairs(name: str, columns: dict[str, Array], both: Sequence[str], unit: str) -> Array:
    pairs = np.column_stack([columns[each] for each in both])
    good = np.isfinite(pairs).all(axis=1)
    if not good.any():
        raise Refused(f"{name} has no complete line")
    for line, (before, after) in zip(columns["line"][good], pairs[good], strict=True):
        what, si, most = ("height", "m", _HIGHEST) if unit == "m" else ("speed", "m/s", _FASTEST)
        wrong = ""
        if before <= 0 or after <= 0:
            wrong = f"{before:g} and {after:g} are not both positive"
        elif before > most:
            wrong = f"a {what} of {before:.3g} {si}: is it in c{si}? write the unit"
        elif not unit and after > 1.05:
            wrong = f"an r of {after:.3g} is above 1: write (%) in the heading if it is in per cent"
        elif unit and after > 1.05 * before:
            wrong = (
                f"it rebounds with {after:.3g} {unit} from {before:.3g} {unit}: is a number wrong, "
                "or are the columns exchanged?"
            )
        if wrong:
            raise Refused(f"{name}, line {line}: {wrong}")
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


def _flights(name: str, columns: dict[str, Array], intervals: bool) -> tuple[list[Array], str]:
    """Return the durations of flights, and the column that they are of."""
    of = "interval" if "interval" in columns else "time"
    if "time" in columns and not (intervals and of == "interval"):
        parts = _parts(columns, "time")
        steps = [(np.diff(times), lines[1:]) for times, lines in parts if len(times) > 1]
        rises = np.concatenate([step for step, _ in steps] or [np.empty(0)]) > 0
        if rises.all() and intervals:
            raise Refused(f"{name} has times, which rise, and no intervals: leave --intervals out")
        if rises.all():
            return _falling(name, steps, "flight", "s", _LONGEST), "time"
        # A list of numbers that fall is one of intervals, whatever its heading.
        if of == "time" and rises.mean() > 0.5:
            step, lines = next(each for each in steps if (each[0] <= 0).any())
            raise _unsorted(name, lines[step <= 0][0])
    return _falling(name, _parts(columns, of), "flight", "s", _LONGEST), of


def _unsorted(name: str, line: float) -> Refused:
    return Refused(
        f"{name}, line {line:.0f}: the time is not after the one before: sort the lines, or leave "
        "an empty line where another recording begins"
    )


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
                raise Refused(f"{found}: is it in {small}? write ({small}) behind the heading")
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


def _track(name: str, columns: dict[str, Array]) -> tuple[Array, list[str]]:
    """Return speeds before and after impacts of a track, and notes on how it was read.

    Flights are parabolas that are open below: the other way round, they would end at their tops,
    and parabolas would miss the impacts between them.
    """
    times, heights, lines = _in_time(name, columns, "position")
    if len(times) < _SHORTEST_TRACK:
        raise Refused(f"{name}: a track of {len(times)} positions is too short")
    t = _even(times)
    upwards = _meetings(t, heights)
    downwards = _meetings(t, -heights)
    meetings, _ = min(upwards, downwards, key=lambda each: each[1])
    if not meetings:
        raise Refused(f"{name}: no impact between two flights of four positions in the track")
    notes = [f"{len(meetings)} impacts were found where flights meet; gravity is the scale."]
    if meetings is downwards[0]:
        notes.append("the positions grow downwards, as in a picture: they were turned")
    at, before, after, scale = np.array(meetings).T
    if "metre" in columns:
        ratio = float(np.median(scale) / columns["metre"])
        if 0 < ratio < 1 / _OFF or ratio > _OFF:
            notes.append(
                f"gravity is {STANDARD_GRAVITY / ratio:.3g} m/s² by the heights and times: the "
                f"times are {math.sqrt(ratio):.2g} times the true ones, as in slow motion, and so "
                "are the speeds, or the heights have another unit"
            )
    impacts = {"line": lines[at.astype(int)].astype(int), "in": before, "out": after}
    return _pairs(name, impacts, ("in", "out"), "m/s"), notes


def _meetings(t: Array, y: Array) -> tuple[list[tuple[int, float, float, float]], float]:
    """Return frame, speeds before and after, and scale of each impact, and the parabolas' misfit.

    Two neighbouring flights have one curvature, which is that of gravity and gives the scale in m.
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
        speeds = -(b1 + 2 * a * meet) * scale, (b2 + 2 * a * meet) * scale
        found.append((impact, *speeds, scale))
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
        low = np.flatnonzero(size <= max(size[peak] / 20, 6 * noise))
        over = int(np.searchsorted(low, peak))
        if 0 < over < len(low):
            # The force begins and ends between two samples.
            contacts.append(np.interp(low[over - 1 : over + 1] + [0.5, -0.5], np.arange(len(t)), t))
    begins, ends = np.array(contacts).T
    if (ends - begins).max() > _LONGEST_CONTACT:
        # The signal rings on, so that the end of a contact does not show.
        return t[starts], None
    return begins, ends - begins
