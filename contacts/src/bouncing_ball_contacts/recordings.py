"""Recordings of bounces, as instruments, programs and people write them.

Every source becomes lines of text: those of a file, of the first sheet of a spreadsheet, or of
columns that are given. The lines are read in four steps.

1. Lines are cells, with any delimiter and decimal sign. Lines ``# key: value`` name the ball.
2. The heading of a column says its quantity, such as a height, whether that is one before or after
   an impact, and its unit: by words in five languages, or else by the unit.
3. The quantities that are there say what was measured: the first of the layouts that they have.
4. Numbers are grouped into series. A number that is missing divides a series, whether its cell or
   its line is empty, it is no number, or its line is left out.

Positions over time and signals are samples, of which a missing one does not matter. Numbers that a
ball cannot have are refused, with their line.
"""

import contextlib
import csv
import difflib
import functools
import io
import itertools
import json
import math
import re
import unicodedata
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib.resources import files
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_contacts.flights import impact_of
from bouncing_ball_contacts.schemes import Array
from bouncing_ball_contacts.units import STANDARD_GRAVITY, Refused, in_si, positive

Lines = NDArray[np.intp]
_Run = tuple[Array, Lines]
_Layouts = tuple[tuple[str, tuple[str, ...]], ...]

# What the head may say, and the words for it.
_KEYS = {
    "mass": r"(?:ball )?(?:mass[ae]?|masa)(?: of (?:the )?ball)?",
    "diameter": r"(?:ball )?(?:diam\w*|durchmesser)(?: of (?:the )?ball)?",
    "contact time": "contact time|kontaktzeit",
    "resolution": "resolution",
    "frame rate": "fps|frame ?rate|frames per second|bildrate",
}
# A key, its unit, and what is said, which is a number if a comma or a tab is between them.
_NAMED = (
    r"\W*([^\d:=(\[]+?)\s*(?:[(\[]([^)\]]*)[)\]])?\s*"
    r"(?:[:=]|[,;\t]\s*(?=[-+]?\d[\d.,]*(?:[\s,;]|$)))\s*(.*\S)"
)
_HEADINGS = (
    "write headings such as time, interval, height, drop_height and rebound_height, speed_before "
    "and speed_after, speed and COR, or t and y"
)
_NO_RECORDING = (
    "is no recording: give a file, the name of an experiment, or columns such as "
    "{'time (s)': [0.45, 1.17, 1.75]}"
)
_TIMES = "times are in seconds, mm:ss.s or hh:mm:ss.s"
_UNSORTED = "the one before: sort the lines, or leave an empty line where another recording begins"
# A number with or without a unit, in a sentence or in cells of the head, and remarks behind it.
_QUANTITY = (
    r"([-+]?\d+(?:[.,]\d+)?)(?:\s*±\s*[\d.,]+)?[\s,;]*([^\W\d][^\s,;(\"]*|%)?[\s,;\"]*(?:[±(].*)?"
)
# A unit behind a heading without brackets, or in a row of units. Inches are "inch", because "in"
# is a word.
_UNIT = (
    r"(?:[mµun]?s|m?sec|seconds?|min|[cmµ]?m|met(?:re|er)s?|inch(?:es)?|ft|foot|feet|yd|[cm]?m/s|km/h|mph"
    r"|px|k?N|m?V|%|-)"
)
_RECORDING = r"recording|aufnahme|series|experiment|\b(?:ball|run|set|trial)\b"
# The quantity of a heading is that of the first row with which its words agree. Accents
# are removed, and most signs are spaces. What is derived from readings or expected is no reading.
_QUANTITIES = (
    ("derived", r"^(?!.*(restitution|\bcor\b)).*(\bratio|efficien|percent|calcul|berechn|verhalt)"),
    (
        "derived",
        r"\blos[st]|predict|theor|expect|ideal|simulat|fitted|sqrt|squar|[√^]|^1 (e|cor)\b",
    ),
    ("derived", r"\b(log|log10|ln|lg)\b|verlust|erwart|\bperte|\bprevu|/(?! ?s\b)"),
    ("force", r"force|kraft|^f\b|\bf ?z\b"),
    ("signal", r"amplitude|volt|spannung|sound|audio|microphone|accel|beschl|signal|pressure"),
    ("signal", r"^a\s*[xyz]\b"),
    ("frame", r"^(\w+ )?(frames?|bild)( (number|no|nr|index))?$"),
    ("count", r"^n\b|\b(no|nr|number|count|index|step|frame)\b"),
    ("unused", r"\b(x|energy|mass|diameter|radius)\b"),
    ("unused", r"dur.*(uncert|err|std)|(uncert|err|std).*dur"),
    ("error", r"(uncert|err|std).*(time|height|speed|veloc|\b[hvt]\b)"),
    ("error", r"(time|height|speed|veloc|\b[hvt]\b).*(uncert|err|std)|^[dδ] ?[hv]\d*\b"),
    ("uncertainty", r"uncert|error|\berr\b|\bstd|standard dev|\bs[de]m?\b|sigma|[±σ]|fehler"),
    ("uncertainty", r"unsicherheit|^[dδ] ?(e|cor)\b"),
    ("coefficient", r"\bcor\b|restitution|coefficient|stosszahl|\b[er]\b"),
    ("interval", r"interval|flight|flug|air ?time|hang|between|difference|\b(d|δ|delta) ?t\b"),
    ("duration", r"duration|dauer|contact|kontakt"),
    ("speed", r"speed|\bq?vel|geschwindigkeit|vitesse|\bv'?\b|\bv[012ifxyz]\b|\bv(in|out)\b"),
    ("height", r"height|altitude|hohe|hauteur|altura|altezza|\bh'?\b|\bh[\dif]\b|\bh ?prime"),
    ("time", r"time|zeit|temps|tiempo|tempo|\bt ?\d*\b"),
    ("position", r"position|\bq?pos\b|\b[cp]?[yz]\d*\b|^(distance|displacement)$"),
    ("recording", rf"{_RECORDING}(?! (\d|\w\b))"),
)
# In the same way, whether a height or speed is that before or after an impact.
_SIDES = (
    ("before", r"before|avant|antes|prima|\bvor|aufprall"),
    ("after", r"after|apres|despues|dopo|\bnach|rebound|bounce|final|\bend|\bto\b|rebote|rimbal"),
    ("after", r"rebond|ruck|prall|reflect|separat|out\b|outgoing|\bup\b|'|prime|\b[hv] ?f|\bv ?2"),
    ("before", r"drop|fall|initia|inizial|inicial|start|release|original|ausgang|abwurf|einfall"),
    ("before", r"inciden|approach|impact|\bv?in\b|incoming|\bdown\b|\bfrom\b|caduta|caida|chute"),
    ("before", r"\b[hv] ?[0i]\b"),
    ("after", r"average|mean\b|(trial|run|test|measurement) \d"),
)
_AVERAGE = r"average|mean\b"
# These words alone are heights, if no unit says otherwise.
_HEIGHTS_ALONE = r"drop|release|bounce|rebound|rimbal|rebote|rebond|average|trial"
_SI = {
    "time": "s",
    "interval": "s",
    "duration": "s",
    "height": "m",
    "speed": "m/s",
    "coefficient": "",
    "uncertainty": "",
}
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
# Of each quantity: its name, the least that is plausible, the most without a unit and with one, and
# the unit that was perhaps meant. An error of its reading may let an r exceed 1.
_PLAUSIBLE = {
    "interval": ("flight", 1e-3, 9.0, 9.0, "ms"),
    "height": ("height", 1e-6, 10.0, 100.0, "cm"),
    "speed": ("speed", 1e-6, 100.0, 100.0, "cm/s"),
    "coefficient": ("restitution coefficient", 0.0, 1.05, 1.05, "%"),
    "uncertainty": ("uncertainty", 0.0, 1.0, 1.0, "%"),
    "duration": ("contact time", 0.0, 1.0, 1.0, "ms"),
}
# An error of a reading may let a flight or a height be that of the one before times this.
_GROWTH = 1.02
# A signal is quiet for at least this time between impacts, in s.
_QUIET = 0.03
# Flights of a track have at least so many positions, without those beside an impact.
_FEWEST = 4


@dataclass(frozen=True)
class Recording:
    """What was measured.

    ``kind`` is "flights" (durations of successive flights in s), "heights" (successive tops),
    "drops" (pairs of heights), "speeds" (pairs), "coefficients" (pairs of speed and r), or "track".

    ``chains`` are arrays, one for each recording; those of pairs have two columns. A track has one
    for each impact, with the columns time, position, and 1 after the impact or else 0. A flight is
    the time from touch to touch, which includes the contact at its begin. ``uncertainty`` has
    standard deviations of r, ``durations`` contact times in s, one or one for each impact (of
    flights: for each touch); ``head`` has what the file says of the ball.
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
    return sorted(each.name.removesuffix(".csv") for each in folder.iterdir())


# Sources to lines of text.


def _sheet(data: bytes) -> str:
    """Return the first sheet of a spreadsheet with tabs; a row keeps its number."""
    lines: list[str] = []
    with zipfile.ZipFile(io.BytesIO(data)) as book:
        names = book.namelist()
        first = min(each for each in names if each.startswith("xl/worksheets/sheet"))
        sheet = ElementTree.fromstring(book.read(first))
        texts = "xl/sharedStrings.xml"
        shared = []
        if texts in names:
            shared = ["".join(each.itertext()) for each in ElementTree.fromstring(book.read(texts))]
    for row in sheet.iterfind(".//{*}row"):
        lines += [""] * (int(row.get("r", "1")) - len(lines))
        for cell in row:
            value = cell.findtext("{*}v") or "".join(cell.itertext())
            text = shared[int(value)] if cell.get("t") == "s" else value
            # Columns have the letters A to Z, AA and so on.
            letters = re.sub(r"\d", "", cell.get("r", "A"))
            column = functools.reduce(lambda n, letter: 26 * n + ord(letter) - 64, letters, 0)
            tabs = "\t" * (column - 1 - lines[-1].count("\t"))
            lines[-1] += tabs + " ".join(text.split())
    return "\n".join(lines)


def _columns_as_text(name: str, columns: Any) -> str:
    """Return columns with their headings as lines with tabs."""
    values = list(columns.values()) if isinstance(columns, Mapping) else [""]
    are_lists = all(
        hasattr(each, "__len__") and not isinstance(each, str | dict) for each in values
    )
    if not are_lists or any(np.ndim(cell) for each in values for cell in each if cell is not None):
        raise Refused(f"{name} {_NO_RECORDING}")
    if len(set(map(len, values))) > 1:
        raise Refused(f"{name} differ in length: {', '.join(map(str, map(len, values)))} cells")
    rows = zip(*values, strict=True)
    cells = [["" if cell is None else str(cell) for cell in row] for row in [columns, *rows]]
    return "\n".join(map("\t".join, cells))


def _text_of(source: Any) -> tuple[str, str]:
    """Return the name of a source and its text."""
    if not isinstance(source, str | Path):
        name = "columns" if isinstance(source, Mapping) else type(source).__name__
        return name, _columns_as_text(name, source)
    path = Path(source)
    if str(source) in experiments() and not path.exists():
        path = Path(str(files(__package__).joinpath("experiments", f"{source}.csv")))
    if path.is_dir():
        raise Refused(f"{source} is a directory: give a file in it")
    if not path.exists():
        near = difflib.get_close_matches(str(source), experiments(), 1) or experiments()
        raise Refused(
            f"{source} is no file, and none of the experiments: did you mean {' or '.join(near)}?"
        )
    name = Path(source).name
    data = path.read_bytes()
    if data.startswith(b"PK"):
        try:
            return name, _sheet(data)
        except (zipfile.BadZipFile, ElementTree.ParseError, LookupError, ValueError):
            raise Refused(f"{name}: the spreadsheet cannot be read") from None
    try:
        text = data.decode("utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    if "\0" in text:
        raise Refused(f"{name} is no text and no spreadsheet")
    if not text.lstrip().startswith(("{", "[")):
        return name, text
    try:
        return name, _columns_as_text(name, json.loads(text))
    except json.JSONDecodeError:
        raise Refused(f"{name} {_NO_RECORDING}") from None


# Lines to cells.


@dataclass(frozen=True)
class _Table:
    """Cells below headings, with the numbers of their lines, and what the head says.

    One column is bare if it has no heading, which is then "time".
    """

    name: str
    head: dict[str, str]
    headings: list[str]
    cells: list[list[str]]
    lines: Lines
    is_bare: bool

    def refuse(self, is_bad: NDArray[np.bool_], lines: Lines, text: str, *numbers: Array) -> None:
        """Refuse the first number that is bad; the text has places for numbers of that line."""
        for i in np.flatnonzero(is_bad)[:1]:
            said = text.format(*(f"{each[i]:.6g}" for each in numbers))
            raise Refused(f"{self.name}, line {lines[i]}: {said}")


def _number(text: str) -> float:
    """Return a number, or seconds of a text such as 1:02.5; NaN if it is neither."""
    plain = text.split("±")[0].strip().replace("−", "-").replace(",", ".")
    if not re.fullmatch(r"(\d+:){0,2}[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", plain):
        return math.nan
    parts = plain.split(":")
    return sum(float(part) * 60**power for power, part in enumerate(reversed(parts)))


def _split(name: str, lines: list[str]) -> list[list[str]]:
    """Return the cells of lines, by the sign that divides most of them."""
    filled = [line for line in lines if line]
    # A comma that stands in single numbers only is a decimal sign.
    decimals = r"[-+]?[\d:]*\d,\d+(\s+[-+]?[\d:]*\d,\d+)*"
    is_decimal = all(re.fullmatch(decimals, line) for line in filled if "," in line)
    signs = "\t; " if is_decimal else "\t;, "
    most = [sign for sign in signs if sum(sign in line for line in filled) > len(filled) / 2]
    sign = next(iter(most), "\t")
    cells = [next(csv.reader([each], delimiter=sign, skipinitialspace=True), []) for each in lines]
    unclear = [cell for row in cells for cell in row if re.fullmatch(r"[1-9]\d{0,2},\d{3}", cell)]
    if unclear and sign == ",":
        raise Refused(
            f"{name}: {unclear[0]!r} may have thousands or decimals: write it without a comma"
        )
    return cells


def _said(line: str) -> dict[str, str]:
    """Return what the head says: '# Mass = 46 g', 'Mass: 46 g, Diameter: 4 cm' or 'Mass (g),46'."""
    said = {}
    for part in re.split(rf"(?i)[,;]\s*(?=(?:{'|'.join(_KEYS.values())})\s*[:=])", line):
        if named := re.match(_NAMED, part):
            key = named[1].lower().replace("_", " ")
            number = re.fullmatch(_QUANTITY, named[3])
            value = f"{number[1]} {number[2] or named[2] or ''}".strip() if number else named[3]
            said[next((each for each in _KEYS if re.fullmatch(_KEYS[each], key)), key)] = value
    return said


def _table_of(name: str, text: str, leave_out: Sequence[int]) -> _Table:
    """Return the table of a text, without the cells of lines that are left out."""
    head: dict[str, str] = {}
    kept: dict[int, str] = {}
    for i, line in enumerate(text.rstrip().splitlines(), 1):
        # Audacity writes frequencies in lines with a backslash.
        if not re.match(r"\s*[#\\]", line):
            kept[i] = line.strip(" ")
        for key, said in _said(line).items() if re.match(r"\s*#", line) else ():
            head[key] = f"{head.get(key, '')} {said}".strip()
    if not any(kept.values()):
        raise Refused(f"{name} is empty")
    texts = list(kept.values())
    cells = _split(name, texts)
    has_numbers = [not np.isnan([*map(_number, row)]).all() for row in cells]
    # Lines such as "Mass,46,g" may stand above the headings.
    worded = itertools.takewhile(lambda row: np.isnan(_number("".join(row[:1]))), cells)
    headed = (i for i, row in enumerate(worded) if not has_numbers[i] and _are_headings(row))
    first = next(headed, 0)
    begin = next((i for i in range(first, len(cells)) if has_numbers[i]), None)
    if begin is None:
        raise Refused(f"{name} has no line of numbers" + (f"; {_TIMES}" if ":" in text else ""))
    head |= {key: said for line in texts[:begin] for key, said in _said(line).items()}
    above = [row for row in cells[:begin] if any(row)]
    lines = np.array(list(kept))[begin:]
    rows = cells[begin:]
    # An empty line after each line divides nothing.
    step = 1 if any(any(row) for row in rows[1::2]) else 2
    rows = rows[::step]
    lines = lines[::step]
    if unknown := set(leave_out) - set(lines.tolist()):
        raise Refused(f"{name} has no line {min(unknown)} of numbers to leave out")
    is_bare = False
    if not above:
        # One line of numbers is a column.
        rows = [[cell] for cell in rows[0]] if len(rows) == 1 else rows
        lines = np.resize(lines, len(rows))
        numbers = np.array([[_number(cell) for cell in [*row, "", ""][:2]] for row in rows])
        starts, ends = numbers.T
        # A label ends before the middle of the time until the next one.
        are_labels = (ends >= starts) & (ends < np.append((starts[:-1] + starts[1:]) / 2, math.inf))
        if not (are_labels | np.isnan(ends).all()).all():
            raise Refused(f"{name}: no bounces in a table without headings: {_HEADINGS}")
        above = [["time"]]
        is_bare = bool(np.isnan(ends).all())
    headings = above[-1]
    if len(above) > 1 and all(re.fullmatch(rf"\W?({_UNIT}|in)?\W?", unit) for unit in headings):
        headings = [
            f"{one} ({unit.strip('()[]')})"
            for one, unit in itertools.zip_longest(*above[-2:], fillvalue="")
        ]
    rows = [[] if line in leave_out else row for line, row in zip(lines, rows, strict=True)]
    for line, row, has_one in zip(lines, rows, has_numbers[begin::step], strict=False):
        if not has_one and _are_headings(row):
            raise Refused(f"{name}: line {line} is a second heading: write one table in each file")
    width = len(headings)
    rows = [[*row, *[""] * width][:width] for row in rows]
    return _Table(name, head, headings, rows, lines, is_bare)


# Headings to quantities.


@dataclass(frozen=True, eq=False)
class _Column:
    """A column with its unit, its role, such as "time" or "height before", and its cells."""

    name: str
    unit: str
    role: str
    texts: list[str]
    numbers: Array


def _counts(numbers: Array) -> bool:
    """Return whether numbers count, mostly by one."""
    steps = np.diff(numbers)
    return bool(np.sum(steps == 1) > len(steps) / 2 and not np.any((steps < 1) | (steps % 1 > 0)))


@functools.cache
def _quantity_of(unit: str) -> str:
    """Return what has this unit: a time, a height or a speed."""
    for quantity in ("height", "speed", "time"):
        with contextlib.suppress(Refused):
            in_si(quantity, f"1 {unit}" if unit else "", _SI[quantity])
            return quantity
    return ""


def _column(heading: str, texts: list[str]) -> _Column:
    """Return the column of a heading such as 'h0 (cm)', 'h0/cm', 'h0_cm' or 'h0 in cm'."""
    # People write m s-1 for m/s, and (cm ± 0.5).
    heading = re.sub(r"\b([ckm]?m)[\s·]*s(\^?[-−]1|⁻¹)", r"\1/s", heading)
    heading = re.sub(r"\s*±\s*[\d.,]+", "", heading)
    parts = (
        re.fullmatch(r"(.*?)[\s/]*[(\[](?!energ)([^)\]]*)[)\]]", heading)
        or re.fullmatch(rf"(.*?)(?:[\s_,]+in|\s*/)?[\s_,]+({_UNIT})", heading)
        or re.fullmatch(rf"(.*?)\s*/\s*\(?({_UNIT}|in)\)?", heading)
    )
    name, unit = parts.groups() if parts else (heading, "")
    # Programs write "Run 1: Time (s)".
    name = re.sub(r"^[^:]*: +", "", name).replace("²", "^2")
    # (mm:ss) is no unit, and (-) is that of a number without one.
    unit = "" if ":" in unit or unit == "-" else unit
    apart = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)
    letters = unicodedata.normalize("NFKD", apart).casefold()
    words = re.sub(
        r"[^\w'±√^/]|_", " ", re.sub(r"[’′`]", "'", re.sub(r"[\u0300-\u036f]", "", letters))
    )

    def first(table: Sequence[tuple[str, str]], said: str) -> str:
        return next((value for value, pattern in table if re.search(pattern, said)), "")

    quantity = first(_QUANTITIES, words)
    side = first(_SIDES, words)
    numbers = np.array([_number(text) for text in texts])
    # "bounce" above 1, 2, 4 is the number of the bounce.
    bare = "height" if not unit and re.search(_HEIGHTS_ALONE, words) else ""
    if (
        quantity in ("", "interval")
        and not (bare and side == "before")
        and not unit
        and _counts(numbers)
    ):
        quantity = "count"
    if not quantity and side:
        quantity = _quantity_of(unit.lower()) or bare
    role = f"{quantity} {side}".strip() if quantity in ("height", "speed") else quantity
    if "%" in unit and role not in ("coefficient", "uncertainty"):
        role = "derived"
    return _Column(name, unit, role, texts, numbers)


def _are_headings(row: list[str]) -> bool:
    """Return whether two cells of a line name quantities."""
    return sum(_column(cell.strip(), []).role not in ("", "unused") for cell in row) > 1


def _are_counted(columns: list[_Column]) -> bool:
    """Return whether headings are alike but for counts, as h1 and h2, or first and second."""
    count = r"\d+(st|nd|rd|th)?|first|second|third|fourth|fifth"
    alike = {re.sub(count, "#", each.name, flags=re.I) for each in columns}
    steps = np.diff([sum(map(int, re.findall(r"\d+", each.name))) for each in columns])
    return len(alike) == 1 and ((steps == 1).all() or (steps == 0).all())


def _vertical(columns: list[_Column]) -> list[_Column]:
    """Return that of the columns x, y, z of a quantity that changes most sharply, as at impacts."""
    columns = [each for each in columns if not re.search("absolut", each.name, re.I)] or columns
    names = {each.name for each in columns}
    if len(names) < len(columns) or len({re.sub(r"[xyzXYZ]\b", "", name) for name in names}) > 1:
        return columns
    bends = [np.nan_to_num(np.abs(np.diff(each.numbers, 2))).max(initial=0) for each in columns]
    return [columns[int(np.argmax(bends))]]


def _columns(table: _Table) -> dict[str, list[_Column]]:
    """Return the columns by their roles."""
    roles: dict[str, list[_Column]] = {}
    for heading, *texts in zip(table.headings, *table.cells, strict=True):
        column = _column(heading.strip(), texts)
        roles.setdefault(column.role, []).append(column)
    if "frame rate" in table.head and "frame" in roles and "time" not in roles:
        rate = _number(table.head["frame rate"].split()[0])
        roles["time"] = [
            replace(each, role="time", numbers=each.numbers / rate) for each in roles.pop("frame")
        ]
    for bare in ("height", "speed"):
        halves = [f"{bare} before", f"{bare} after"]
        absent = [half for half in halves if half not in roles]
        # A column without a side is the other half of one that has a side.
        if len(absent) == 1 and bare in roles:
            roles[absent[0]] = roles.pop(bare)
        rebounds = roles.get(halves[1], [])
        single = [each for each in rebounds if not re.search(_AVERAGE, each.name, re.I)]
        if single:
            roles[halves[1]] = single
    return roles


def _values(table: _Table, column: _Column, unit: str = "") -> Array:
    """Return the numbers of a column in SI units; ``unit`` is that of a heading without one."""
    quantity = column.role.split()[0]
    unit = column.unit or unit
    named = f"{table.name}, column {column.name!r}"
    scale = in_si(named, f"1 {unit}", _SI[quantity]) if unit else 1.0
    # The sign of a velocity is its direction.
    values = scale * (np.abs(column.numbers) if quantity == "speed" else column.numbers)
    if quantity != "time":
        _check(table, quantity, bool(unit), values, table.lines)
    return values


def _check(table: _Table, quantity: str, has_unit: bool, values: Array, lines: Lines) -> None:
    """Refuse values in SI units that no ball has."""
    what, least, bare, with_unit, perhaps = _PLAUSIBLE[quantity]
    said = f"a {what} of {{}} {_SI[quantity]}".strip()
    most = with_unit if has_unit else bare
    hint = "" if has_unit else " without a unit"
    hint += f": is it in {perhaps}? write ({perhaps}) behind the heading"
    table.refuse(values <= 0, lines, f"{said} is not positive", values)
    table.refuse(
        values < least, lines, f"{said} is too small: write its unit behind the heading", values
    )
    table.refuse(values > most, lines, f"{said}{hint}", values)


# Numbers to series.


def _runs(values: Array, lines: Lines) -> list[_Run]:
    """Return the numbers between missing ones, with their lines."""
    pieces = np.ma.clump_unmasked(np.ma.masked_invalid(values))
    return [(values[piece], lines[piece]) for piece in pieces]


def _groups(roles: dict[str, list[_Column]], is_missing: NDArray[np.bool_]) -> list[Lines]:
    """Return the rows of each recording, divided where the count of bounces jumps."""
    jumps = [
        np.diff(each.numbers, prepend=each.numbers[0]) > 1
        for each in roles.get("count", [])
        if _counts(each.numbers)
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


def _series(table: _Table, columns: list[_Column], groups: list[Lines]) -> list[_Run]:
    """Return series that run down columns, or along lines if only those make sense."""
    matrix = np.column_stack([_values(table, each) for each in columns])
    lines = np.broadcast_to(table.lines[:, None], matrix.shape)
    down = [
        run
        for i in range(len(columns))
        for rows in groups
        for run in _runs(matrix[rows, i], lines[rows, i])
    ]
    # Columns such as "run 1 interval" are recordings.
    if len(columns) == 1 or all(
        re.search(rf"(?:{_RECORDING})\W*\d", each.name, re.I) for each in columns
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
        fitting = rising or fitting
    if len(fitting) != 1:
        raise Refused(
            f"{table.name}: each line or each column may be a recording: write one below the other "
            "with an empty line between"
        )
    return fitting[0]


def _flights(table: _Table, runs: list[_Run]) -> list[_Run]:
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


def _of_series(table: _Table, columns: list[_Column], runs: list[_Run]) -> Recording:
    """Return the recording of heights, of flights, or of times."""
    quantity = columns[0].role.split()[0]
    if quantity == "time":
        quantity = "interval"
        runs = _flights(table, runs)
    said = f"a {_PLAUSIBLE[quantity][0]} of {{}} {_SI[quantity]}"
    grown = (
        f"{said} follows one of {{}} {_SI[quantity]}: an impact is missing, the first time is that "
        "of the release, or another recording begins (give a column 'recording', or --leave-out "
        "its line)"
    )
    missed = (
        "a flight of {} s, after which one of {} s has less than half of the ratio that the next "
        "one has: an impact is missing within it (--leave-out its line)"
    )
    for values, lines in runs:
        _check(table, quantity, bool(columns[0].unit), values, lines)
        is_grown = values[1:] > _GROWTH * values[:-1]
        table.refuse(is_grown, lines[1:], grown, values[1:], values[:-1])
        if quantity == "interval":
            # To two flights that are taken as one the third has the ratio r²/(1 + r) < r/2.
            ratios = values[1:] / values[:-1]
            is_missed = ratios[:-1] < ratios[1:] / 2
            table.refuse(is_missed, lines[:-2], missed, values[:-2], values[1:-1])
            # To a fall, which is half a flight, the next one has the ratio 2r. The middle between
            # that and r, in the logarithms that scatter alike, is √2 r.
            table.refuse(
                ratios[:1] > math.sqrt(2) * ratios[1:2],
                lines,
                "a flight of {} s is short beside the two after it: it begins with the release, or "
                "the next one has an impact within it (--leave-out the line of either)",
                values,
            )
    kind = "heights" if quantity == "height" else "flights"
    return Recording(table.name, kind, tuple(values for values, _ in runs if len(values)))


def _check_pairs(table: _Table, kind: str, pairs: Array, lines: Lines) -> None:
    """Refuse pairs of heights or speeds with an r above 1.05."""
    before, after = pairs.T
    si = "m" if kind == "drops" else "m/s"
    most = 1.05**2 if kind == "drops" else 1.05
    said = f"it rebounds with {{}} {si} from {{}} {si}: is a number wrong, or are the columns "
    table.refuse(after > most * before, lines, f"{said}exchanged?", after, before)


def _of_pairs(table: _Table, kind: str, columns: list[_Column]) -> Recording:
    """Return the recording of pairs: of the first column with each of the others."""
    first, *others = (_values(table, each) for each in columns)
    pairs = np.concatenate([np.column_stack([first, each]) for each in others])
    lines = np.tile(table.lines, len(others))
    is_there = ~np.isnan(pairs).any(axis=1)
    if kind != "coefficients":
        _check_pairs(table, kind, pairs[is_there], lines[is_there])
    return Recording(table.name, kind, (pairs[is_there],))


def _are_successive(table: _Table, columns: list[_Column]) -> bool:
    """Return whether heights in lines are those of one ball, and not rebounds of one drop.

    Successive heights fall on: each by more than the square root of the first factor.
    """
    h = np.column_stack([_values(table, each) for each in columns])
    falls = h[:, 2:] ** 2 * h[:, :1] < h[:, 1:-1] ** 2 * h[:, 1:2]
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
    table: _Table, columns: list[_Column], rows: NDArray[np.bool_]
) -> tuple[Array, Array, Lines]:
    """Return times in s, values as they are written, and lines."""
    t = _values(table, columns[0])[rows]
    lines = table.lines[rows]
    if len(t) <= 2 * _FEWEST:
        raise Refused(f"{table.name}: {len(t)} lines of a track or a signal are too few; {_TIMES}")
    table.refuse(np.diff(t) < 0, lines[1:], f"the time is not after {_UNSORTED}")
    gap = np.diff(t) > 20 * np.mean(np.diff(t))
    table.refuse(gap, lines[1:], "a gap in the time: one recording of positions or signals is read")
    return t, columns[1].numbers[rows], lines


def _of_track(table: _Table, columns: list[_Column], rows: NDArray[np.bool_]) -> Recording:
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
    _check(table, "interval", bool(columns[0].unit), lasting, lines[[each[0] for each in long]])
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
        "gravity is the scale": True,
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


def _of_signal(table: _Table, columns: list[_Column], rows: NDArray[np.bool_]) -> Recording:
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


def _layout(
    table: _Table, roles: dict[str, list[_Column]], intervals: bool
) -> tuple[str, list[_Column]]:
    """Return what was measured, and the columns with that."""
    layouts = _PAIRS if _HALVES & roles.keys() else _PAIRS + _SERIES
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
        raise Refused(f"{table.name}: {wanted}: {_HEADINGS}")
    kind, needed = found
    columns = []
    for role in needed:
        same = _vertical(roles[role]) if kind in ("track", "signal") else roles[role]
        # Counted columns are rebounds of a drop, or those of several balls.
        may_be_several = len(needed) == 1 or role == "height after"
        if len(same) > 1 and not (may_be_several and _are_counted(same)):
            raise Refused(
                f"{table.name}: two columns are both taken as {role}, {same[0].name!r} and "
                f"{same[1].name!r}: leave one out, as of several balls, or {_HEADINGS}"
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
    table: _Table, roles: dict[str, list[_Column]], columns: list[_Column], rows: NDArray[np.bool_]
) -> tuple[Array | None, Array | None]:
    """Return the uncertainties of r and contact times of rows, or the mean of these."""
    uncertainty = None
    durations = None
    if "uncertainty" in roles and columns[-1].role == "coefficient":
        # Without a unit it has that of the coefficients.
        found = _values(table, roles["uncertainty"][0], columns[-1].unit)[rows]
        uncertainty = None if np.isnan(found).all() else found
        if np.isnan(found).any() and uncertainty is not None:
            raise Refused(f"{table.name}: each impact needs an uncertainty, or none has one")
    if "duration" in roles:
        found = _values(table, roles["duration"][0])[rows]
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
    name, text = _text_of(source)
    table = _table_of(name, text, leave_out)
    head = table.head
    roles = _columns(table)
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
            + (f"; {_TIMES}" if columns[0].role == "time" else "")
        )
    uncertainty, durations = _uncertainty_and_durations(table, roles, columns, is_complete)
    durations = durations if recording.durations is None else recording.durations
    if "contact time" in head:
        durations = np.array([positive("contact time", head["contact time"], "s")])
    if durations is not None and re.search("flight|flug|air ?time|hang", columns[0].name, re.I):
        # These are free of contact, and the flights of recordings are from touch to touch.
        touches = (chain + float(durations.mean()) for chain in recording.chains)
        recording = replace(recording, chains=tuple(touches))
    gaps = is_missing & ~np.isin(table.lines, leave_out)
    missing = ", ".join(map(str, table.lines[gaps]))
    divides = " and divides the series" if recording.kind in ("flights", "heights") else ""
    unused = [
        repr(f"{key}: {value}")
        for key, value in head.items()
        if key not in _KEYS and " uncertainty" not in key and re.fullmatch(_QUANTITY, value)
    ]
    unread = [
        each.name
        for role, group in roles.items()
        for each in group
        if role not in ("count", "frame", "recording", "duration")
        and not (role == "uncertainty" and uncertainty is not None)
        and each not in columns
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
        f"a number is missing in line {missing}, which is left out{divides}": gaps.any(),
        f"the head has {', '.join(unused)}, but only {', '.join(_KEYS)} are used": bool(unused),
    }
    notes = recording.notes + tuple(text for text, holds in further.items() if holds)
    return replace(recording, head=head, uncertainty=uncertainty, durations=durations, notes=notes)
