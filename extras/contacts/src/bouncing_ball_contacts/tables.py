"""Tables of text, as instruments, programs and people write them, to columns with quantities.

Every source becomes lines of text: those of a file, of the first sheet of a spreadsheet, or of
columns that are given.

1. Lines are cells, with any delimiter and decimal sign. Lines ``# key: value`` name the ball.
2. The heading of a column says its quantity, such as a height, whether that is one before or after
   an impact, and its unit: by words in five languages, or else by the unit.
3. Numbers that a ball cannot have are refused, with their line.
"""

import contextlib
import csv
import datetime
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
from dataclasses import dataclass, replace
from importlib.resources import files
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_contacts.schemes import Array
from bouncing_ball_contacts.units import Refused, in_si

Lines = NDArray[np.intp]
"""Numbers of lines, or of rows."""

# What the head may say, and the words for it.
KEYS = {
    "mass": r"(?:ball )?(?:mass[ae]?|masa)(?: of (?:the )?ball)?",
    "diameter": r"(?:ball )?(?:diam\w*|durchmesser)(?: of (?:the )?ball)?",
    "contact time": "contact time|kontaktzeit",
    "resolution": "resolution",
    "drop height": "drop height|fallhöhe",
    "frame rate": "fps|frame ?rate|frames per second|bildrate",
}
# A key, its unit, and what is said, which is a number if a comma or a tab is between them.
_NAMED = (
    r"\W*([^\d:=(\[]+?)\s*(?:[(\[]([^)\]]*)[)\]])?\s*"
    r"(?:[:=]|[,;\t]\s*(?=[-+]?\d[\d.,]*(?:[\s,;]|$)))\s*(.*\S)"
)
HEADINGS = (
    "write headings such as time, interval, height, drop_height and rebound_height, speed_before "
    "and speed_after, speed and COR, or t and y"
)
_NO_RECORDING = (
    "is no recording: give a file, the name of an experiment, or columns such as "
    "{'time (s)': [0.45, 1.17, 1.75]}"
)
TIMES = "times are in seconds, mm:ss.s, hh:mm:ss.s or 2024-05-01T12:00:00.25"
# A number with or without a unit, in a sentence or in cells of the head, and remarks behind it.
QUANTITY = (
    r"([-+]?\d+(?:[.,]\d+)?)(?:\s*±\s*[\d.,]+)?[\s,;]*([^\W\d][^\s,;(\"]*|%)?[\s,;\"]*(?:[±(].*)?"
)
# A unit behind a heading without brackets, or in a row of units. Inches are "inch", because "in"
# is a word.
_UNIT = (
    r"(?:[mµun]?s|m?sec|seconds?|min|[cmµ]?m|met(?:re|er)s?|inch(?:es)?|ft|foot|feet|yd|[cm]?m/s|km/h|mph"
    r"|px|k?g|k?N|m?V|%|-)"
)
RECORDING = r"recording|aufnahme|series|experiment|\b(?:ball|run|set|trial)\b"
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
    ("uncertainty", r"unsicherheit|standardabw|^[dδ] ?(e|cor)\b"),
    ("coefficient", r"\bcor\b|restitution|coefficient|stosszahl|\b[er]\b"),
    ("interval", r"interval|flight|flug|air ?time|hang|between|difference|\b(d|δ|delta) ?t\b"),
    ("duration", r"duration|dauer|contact|kontakt"),
    ("speed", r"speed|\bq?vel|geschwindigkeit|vitesse|\bv'?\b|\bv[012ifxyz]\b|\bv(in|out)\b"),
    ("height", r"height|altitude|hohe|hauteur|altura|altezza|\bh'?\b|\bh[\dif]\b|\bh ?prime"),
    ("time", r"time|zeit|temps|tiempo|tempo|\bt ?\d*\b"),
    ("position", r"position|\bq?pos\b|\b[cp]?[yz]\d*\b|^(distance|displacement)$"),
    ("recording", rf"{RECORDING}(?! (\d|\w\b))"),
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
SI = {
    "time": "s",
    "interval": "s",
    "duration": "s",
    "height": "m",
    "speed": "m/s",
    "coefficient": "",
    "uncertainty": "",
}
# Of each quantity: its name, the least that is plausible, the most without a unit and with one, and
# the unit that was perhaps meant. An error of its reading may let an r exceed 1.
PLAUSIBLE = {
    "interval": ("flight", 1e-3, 9.0, 9.0, "ms"),
    "height": ("height", 1e-6, 10.0, 100.0, "cm"),
    "speed": ("speed", 1e-6, 100.0, 100.0, "cm/s"),
    "coefficient": ("restitution coefficient", 0.0, 1.05, 1.05, "%"),
    "uncertainty": ("uncertainty", 0.0, 1.0, 1.0, "%"),
    "duration": ("contact time", 0.0, 1.0, 1.0, "ms"),
}


def experiments() -> list[str]:
    """Return the names of the published experiments of the package."""
    folder = files(__package__).joinpath("experiments")
    return sorted(each.name.removesuffix(".csv") for each in folder.iterdir())


# Sources to lines of text.


def _sheet(data: bytes) -> tuple[str, int]:
    """Return the first sheet with numbers of a spreadsheet, with tabs, and how many have numbers.

    A row keeps its number.
    """
    lines: list[str] = []
    with zipfile.ZipFile(io.BytesIO(data)) as book:
        names = book.namelist()
        sheets = [
            ElementTree.fromstring(book.read(each))
            for each in sorted(names, key=lambda each: (len(each), each))
            if each.startswith("xl/worksheets/sheet")
        ]
        # Numbers have no type, or "n".
        filled = [
            sheet
            for sheet in sheets
            if any(cell.get("t", "n") == "n" for cell in sheet.iterfind(".//{*}c[{*}v]"))
        ]
        sheet = [*filled, *sheets][0]
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
    return "\n".join(lines), len(filled)


def _columns_as_text(name: str, columns: Any) -> str:
    """Return columns with their headings as lines with tabs."""
    if not isinstance(columns, Mapping):
        raise Refused(f"{name} {_NO_RECORDING}")
    # The unit of a quantity takes the place of one in the heading.
    columns = dict(
        (f"{heading.split(' (')[0]} ({each.units:~C})", each.magnitude)
        if hasattr(each, "units")
        else (heading, each)
        for heading, each in columns.items()
    )
    values = list(columns.values())
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


def text_of(source: Any) -> tuple[str, str, int]:
    """Return the name of a source, its text, and how many tables it has, of which it is one."""
    if not isinstance(source, str | Path):
        name = "columns" if isinstance(source, Mapping) else type(source).__name__
        return name, _columns_as_text(name, source), 1
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
            return name, *_sheet(data)
        except (zipfile.BadZipFile, ElementTree.ParseError, LookupError, ValueError):
            raise Refused(
                f"{name}: the spreadsheet cannot be read: save it as xlsx or csv"
            ) from None
    try:
        text = data.decode("utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    if "\0" in text:
        raise Refused(f"{name} is no text and no spreadsheet: save it as xlsx or csv")
    if not text.lstrip().startswith(("{", "[")):
        return name, text, 1
    try:
        return name, _columns_as_text(name, json.loads(text)), 1
    except json.JSONDecodeError:
        raise Refused(f"{name} {_NO_RECORDING}") from None


# Lines to cells.


@dataclass(frozen=True)
class Table:
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


def number_in(text: str) -> float:
    """Return a number, or seconds of 1:02.5 or 2024-05-01T12:01:02.5; NaN if it is neither."""
    plain = text.split("±")[0].strip().replace("−", "-").replace(",", ".")
    with contextlib.suppress(ValueError):
        if "T" in plain:
            return datetime.datetime.fromisoformat(plain).timestamp()
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
    for part in re.split(rf"(?i)[,;]\s*(?=(?:{'|'.join(KEYS.values())})\s*[:=])", line):
        if named := re.match(_NAMED, part):
            key = named[1].lower().replace("_", " ")
            number = re.fullmatch(QUANTITY, named[3])
            value = f"{number[1]} {number[2] or named[2] or ''}".strip() if number else named[3]
            said[next((each for each in KEYS if re.fullmatch(KEYS[each], key)), key)] = value
    return said


def table_of(name: str, text: str, leave_out: Sequence[int]) -> Table:
    """Return the table of a text, without the cells of lines that are left out."""
    head: dict[str, str] = {}
    kept: dict[int, str] = {}
    for i, line in enumerate(text.rstrip().splitlines(), 1):
        # Audacity writes frequencies in lines with a backslash.
        if not re.match(r"\s*[#\\]", line):
            # A date and a time are one cell.
            kept[i] = re.sub(r"(\d-\d\d) (?=\d\d:)", r"\1T", line.strip(" "))
        for key, said in _said(line).items() if re.match(r"\s*#", line) else ():
            head[key] = f"{head.get(key, '')} {said}".strip()
    if not any(kept.values()):
        raise Refused(f"{name} is empty")
    texts = list(kept.values())
    cells = _split(name, texts)
    has_numbers = [not all(math.isnan(number_in(cell)) for cell in row) for row in cells]
    # Lines such as "Mass,46,g" may stand above the headings.
    worded = itertools.takewhile(lambda row: np.isnan(number_in("".join(row[:1]))), cells)
    headed = (i for i, row in enumerate(worded) if not has_numbers[i] and _are_headings(row))
    first = next(headed, 0)
    begin = next((i for i in range(first, len(cells)) if has_numbers[i]), None)
    if begin is None:
        hint = f"; {TIMES}" if ":" in text else "; units belong to the headings"
        raise Refused(f"{name} has no line of numbers{hint}")
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
        numbers = np.array([[number_in(cell) for cell in [*row, "", ""][:2]] for row in rows])
        starts, ends = numbers.T
        # A label ends before the middle of the time until the next one.
        are_labels = (ends >= starts) & (ends < np.append((starts[:-1] + starts[1:]) / 2, math.inf))
        if not (are_labels | np.isnan(ends).all()).all():
            raise Refused(f"{name}: no bounces in a table without headings: {HEADINGS}")
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
    return Table(name, head, headings, rows, lines, is_bare)


# Headings to quantities.


@dataclass(frozen=True, eq=False)
class Column:
    """A column with its unit, its role, such as "time" or "height before", and its cells."""

    name: str
    unit: str
    role: str
    texts: list[str]
    numbers: Array


def counts(numbers: Array) -> bool:
    """Return whether numbers count, mostly by one."""
    steps = np.diff(numbers)
    return bool(np.sum(steps == 1) > len(steps) / 2 and not np.any((steps < 1) | (steps % 1 > 0)))


@functools.cache
def _quantity_of(unit: str) -> str:
    """Return what has this unit: a time, a height or a speed."""
    for quantity in ("height", "speed", "time"):
        with contextlib.suppress(Refused):
            in_si(quantity, f"1 {unit}" if unit else "", SI[quantity])
            return quantity
    return ""


def _column(heading: str, texts: list[str]) -> Column:
    """Return the column of a heading such as 'h0 (cm)', 'h0/cm', 'h0_cm' or 'h0 in cm'."""
    # People write m s-1 for m/s, and (cm ± 0.5).
    heading = re.sub(r"\b([ckm]?m)[\s·]*s(\^?[-−]1|⁻¹)", r"\1/s", heading)
    heading = re.sub(r"\s*±\s*[\d.,]+", "", re.sub(r"\+/?-", "±", heading))
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
    numbers = np.array([number_in(text) for text in texts])
    # As the audio scope of phyphox has them.
    quantity = "signal" if unit == "a.u." else quantity
    # "bounce" above 1, 2, 4 is the number of the bounce.
    bare = "height" if not unit and re.search(_HEIGHTS_ALONE, words) else ""
    if (
        quantity in ("", "interval")
        and not (bare and side == "before")
        and not unit
        and counts(numbers)
    ):
        quantity = "count"
    if not quantity and side:
        quantity = _quantity_of(unit.lower()) or bare
    role = f"{quantity} {side}".strip() if quantity in ("height", "speed") else quantity
    if "%" in unit and role not in ("coefficient", "uncertainty"):
        role = "derived"
    return Column(name, unit, role, texts, numbers)


def _are_headings(row: list[str]) -> bool:
    """Return whether two cells of a line name quantities."""
    return sum(_column(cell.strip(), []).role not in ("", "unused") for cell in row) > 1


def columns_of(table: Table) -> dict[str, list[Column]]:
    """Return the columns by their roles."""
    roles: dict[str, list[Column]] = {}
    for heading, *texts in zip(table.headings, *table.cells, strict=True):
        column = _column(heading.strip(), texts)
        roles.setdefault(column.role, []).append(column)
    if "frame rate" in table.head and "frame" in roles and "time" not in roles:
        rate = number_in(table.head["frame rate"].split()[0])
        for each in roles.pop("frame"):
            times = each.numbers / rate
            column = replace(each, role="time", texts=[*map(str, times)], numbers=times)
            roles.setdefault("time", []).append(column)
    if "drop height" in table.head and "height after" in roles:
        height = np.full(len(table.cells), in_si("drop height", table.head["drop height"], "m"))
        roles.setdefault("height before", [Column("drop height", "m", "height before", [], height)])
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


def _scale(table: Table, column: Column, unit: str) -> float:
    """Return a unit in SI units."""
    named = f"{table.name}, column {column.name!r}"
    return in_si(named, f"1 {unit}", SI[column.role.split()[0]]) if unit else 1.0


def digit_of(table: Table, column: Column) -> float:
    """Return the last digit of the numbers of a column, in SI units."""
    decimals = [re.search(r"[.,](\d+)(?:[eE]([-+]?\d+))?", text) for text in column.texts]
    powers = [int(each[2] or 0) - len(each[1]) for each in decimals if each]
    return _scale(table, column, column.unit) * 10.0 ** min(powers, default=0)


def values_of(table: Table, column: Column, unit: str = "") -> Array:
    """Return the numbers of a column in SI units; ``unit`` is that of a heading without one."""
    quantity = column.role.split()[0]
    unit = column.unit or unit
    # The sign of a velocity is its direction.
    numbers = np.abs(column.numbers) if quantity == "speed" else column.numbers
    values = _scale(table, column, unit) * numbers
    if quantity != "time":
        check(table, quantity, bool(unit), values, table.lines)
    return values


def check(table: Table, quantity: str, has_unit: bool, values: Array, lines: Lines) -> None:
    """Refuse values in SI units that no ball has."""
    what, least, bare, with_unit, perhaps = PLAUSIBLE[quantity]
    said = f"a {what} of {{}} {SI[quantity]}".strip()
    most = with_unit if has_unit else bare
    hint = "" if has_unit else " without a unit"
    hint += f": is it in {perhaps}? write ({perhaps}) behind the heading"
    small = f"{said} is too small: write its unit behind the heading"
    if quantity == "interval":
        hint += ", or divide times of slow motion by its factor"
        small += ", such as (days) of times in a spreadsheet"
    table.refuse(values <= 0, lines, f"{said} is not positive", values)
    table.refuse(values < least, lines, small, values)
    table.refuse(values > most, lines, f"{said}{hint}", values)
