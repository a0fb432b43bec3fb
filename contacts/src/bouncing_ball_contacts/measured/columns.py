r"""The columns of a text file of measured impacts, as people and instruments write them.

The *heading* is the first line that names the columns of one of these ways to measure an impact ::

    drop_height, rebound_height         h and h′
    speed, rebound_speed                v and u = e v
    speed, restitution                  v and e
    time                                times of the impacts of one bouncing ball
    interval                            the intervals between them

A file with several ways is read by the first of them, because e and intervals may have been
computed from the others. The heading may be in capitals, with its units in brackets or behind it,
as in interval_ms. Columns are separated by commas, tabs or semicolons; beside tabs and semicolons,
and in a single column, numbers may have decimal commas. Lines above the heading and columns that
the way does not use are left out, with a note for each line and one for the columns; a column that
only counts needs none.

The numbers of a column of speeds that are all negative are read as velocities, with a note. Numbers
that a wrong unit explains better than a ball are refused: an impact speed above 100 m/s, a height
above 100 m, and above 10 m if the heading names no unit.
"""

import csv
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.errors import ModelError, ParameterError, Range
from bouncing_ball_contacts.contact.units import COMMON, SIParameter, number_in_si

COLUMNS = {
    "speed": SIParameter("m/s", "1 m/s"),
    "restitution": SIParameter("", "0.85", Range(0, 1, "(]")),
    "rebound_speed": SIParameter("m/s", "0.8 m/s"),
    "uncertainty": SIParameter("", "0.01"),
    "duration": SIParameter("s", "1 ms"),
    "duration_uncertainty": SIParameter("s", "0.1 ms"),
    "drop_height": SIParameter("m", "1 m"),
    "rebound_height": SIParameter("m", "70 cm"),
    "interval": SIParameter("s", "0.5 s"),
    "time": SIParameter("s", "0.5 s", Range(-1e40, 1e40, "[]")),
    "recording": SIParameter("", "1"),
}
"""The columns of a file, their units and ranges."""
# Where intervals are asked for.
_HEARD = (("interval",), ("time",))
_WAYS = (
    ("drop_height", "rebound_height"),
    ("speed", "rebound_speed"),
    ("speed", "restitution"),
    *reversed(_HEARD),
)
# What may follow speeds or heights.
_FURTHER = ("uncertainty", "duration", "duration_uncertainty")
# What an impact does not increase, with its unit.
_PAIRS = (("speed", "rebound_speed", "m/s"), ("drop_height", "rebound_height", "m"))
# Headings of instruments, in lower case.
_ALIASES = {
    "v": "speed",
    "impact speed": "speed",
    "e": "restitution",
    "event time": "time",
    "impact time": "time",
    "times": "time",
    "t": "time",
    "intervals": "interval",
    "time interval": "interval",
    "drop": "drop_height",
    "rebound": "rebound_height",
}
_SPEED = re.compile(r"(?:v|speed|velocity) (?:(in|before)|out|after)(?: impact)?")
# Columns that only count.
_COUNT = re.compile(r"(?:numbers?(?: of \w+)?|no\.?|nr\.?|n|#|index|events?|bounces?|impacts?|)")
_HEADING = re.compile(r"([^\[\]]*)(?:\[(.*)\])?")
# The hyphen and the minus sign.
_MINUS = ("-", "\N{MINUS SIGN}")
_DECIMAL_COMMA = re.compile(r"[+-]?\d+,\d+")
_FASTEST = 100.0
HIGHEST = 100.0
"""The greatest height in m that is not taken for one in a wrong unit."""
_HIGHEST_WITHOUT_UNIT = 10.0


@dataclass(frozen=True)
class Columns:
    """The numbers of a file.

    Parameters
    ----------
    values : dict
        By the name of the column, in SI units. In a line that is left out they are NaN.
    lines : list of int
        The line of each row of numbers.
    left_out : tuple of int
        The lines that the user leaves out.
    notes : tuple of str
        What of the file was not read.
    """

    values: dict[str, np.ndarray]
    lines: list[int]
    left_out: tuple[int, ...]
    notes: tuple[str, ...]

    @property
    def is_heard(self) -> bool:
        """Whether they are times of impacts or intervals between them."""
        return not self.values.keys().isdisjoint({"interval", "time"})


class _Heading(NamedTuple):
    """The text of a heading, the column that it names or None, and its unit."""

    text: str
    name: str | None
    unit: str

    @property
    def is_count(self) -> bool:
        return self.name is None and _COUNT.fullmatch(self.text.casefold()) is not None


class _Column(NamedTuple):
    """A column that is read: its place, its unit, and the SI value of the unit."""

    place: int
    unit: str
    factor: float


def _heading(text: str) -> _Heading:
    found = _HEADING.fullmatch(text.translate(str.maketrans("()", "[]")))
    if found is None:
        return _Heading(text, None, "")
    words = found[1].replace("_", " ").split()
    name = _name(words)
    unit = found[2] or ""
    # A unit behind the words, without brackets.
    if name is None and not unit and words:
        name = _name(words[:-1])
        unit = words[-1]
        if name is not None and unit not in COMMON.get(COLUMNS[name].name, {}):
            name = None
    return _Heading(text, name, unit if name is not None else "")


def _name(words: list[str]) -> str | None:
    """The column that the words of a heading name, if they name one."""
    text = " ".join(words).casefold()
    speed = _SPEED.fullmatch(text)
    if speed is not None:
        return "speed" if speed[1] else "rebound_speed"
    name = _ALIASES.get(text, text.replace(" ", "_"))
    return name if name in COLUMNS else None


def _cells(line: str, mark: str) -> list[str]:
    return [
        cell.strip() for cell in next(csv.reader([line], delimiter=mark, skipinitialspace=True))
    ]


def _mark(line: str) -> str:
    return next((mark for mark in "\t;" if mark in line), ",")


def _headings(line: str) -> list[_Heading]:
    return [_heading(text) for text in _cells(line, _mark(line))]


def _way(headings: Iterable[_Heading], ways: tuple[tuple[str, ...], ...]) -> tuple[str, ...]:
    """The first of the ways whose columns are there; empty if there is none."""
    names = {each.name for each in headings}
    return next((way for way in ways if names.issuperset(way)), ())


def read_columns(
    where: str, rows: list[tuple[int, str]], *, intervals: bool, leave_out: tuple[int, ...]
) -> Columns:
    """The columns of a file.

    Parameters
    ----------
    where : str
        The file, for messages.
    rows : list of (int, str)
        Its lines without comments, and their numbers.
    intervals : bool
        Whether intervals are asked for, which need no heading.
    leave_out : tuple of int
        Lines whose numbers are left out.

    Raises
    ------
    ModelError
        If a line is not understood; the message names it.

    Examples
    --------
    >>> rows = [(1, "Drops"), (2, "No.;v_in (km/h);v_out (km/h)"), (3, "1;7,2;3,6")]
    >>> found = read_columns("a.csv", rows, intervals=False, leave_out=())
    >>> {name: values.tolist() for name, values in found.values.items()}
    {'speed': [2.0], 'rebound_speed': [1.0]}
    >>> found.notes
    ("Left out: line 1 above the heading, 'Drops'.",)
    """
    if not rows:
        raise ModelError(f"{where} has no line with the names of the columns")
    first = next((k for k, (_, line) in enumerate(rows) if _is_number(line)), len(rows))
    # Without a heading that is understood, the message is on the line above the numbers.
    last = first - 1 if 0 < first < len(rows) else 0
    top = next((k for k in range(first) if _way(_headings(rows[k][1]), _WAYS)), last)
    if first == 0:
        if not intervals:
            raise ParameterError(
                f"{where}, line {rows[0][0]}: numbers without a heading: is it a file of "
                "{intervals}, or is a line such as 'speed [m/s],restitution' missing?"
            )
        rows = [(0, "interval [s]"), *rows]
    at, line = rows[top]
    headings = _headings(line)
    way = _way(headings, _HEARD if intervals else _WAYS)
    if not way and _way(headings, _WAYS):
        raise ModelError(f"{where} has no column interval or time")
    used = _used(f"{where}, line {at}", headings, way)
    body = _body(where, headings, used, _mark(line), rows[top + 1 :])
    lines = [at for at, _ in body]
    for number in leave_out:
        if number not in lines:
            raise ModelError(f"{where} has no line {number} with numbers to leave out")
    notes = [f"Left out: line {at} above the heading, {text!r}." for at, text in rows[:top]]
    notes += _of_columns(headings, used, way)
    if way == ("interval",) and any(each.is_count or each.name == "time" for each in headings):
        body, starts = _without_starts(headings, body)
        notes += [
            f"Line {at} is the first impact, before which there is no interval." for at in starts
        ]
    if not body:
        raise ModelError(f"{where} has no line of numbers")
    notes += _without_signs(headings, used, body, leave_out)
    values = _values(where, used, body, leave_out)
    return Columns(values, [at for at, _ in body], leave_out, tuple(notes))


def _is_number(line: str) -> bool:
    """Whether a line begins with a number."""
    try:
        float(_point(_cells(line, _mark(line))[0]))
    except ValueError:
        return False
    return True


def _point(text: str) -> str:
    """A number with a decimal point in place of a comma; other texts as they are."""
    return text.replace(",", ".") if _DECIMAL_COMMA.match(text) else text


def _used(where: str, headings: list[_Heading], way: tuple[str, ...]) -> dict[str, _Column]:
    """The columns that are read, by name.

    Raises
    ------
    ModelError
        If they do not decide what the file is.
    """
    names = [each.name for each in headings]
    unknown = [each.text for each in headings if each.name is None and not each.is_count]
    further = ("recording",) if way in _HEARD else _FURTHER
    wanted = [name for name in (*way, *further) if name in names]
    if not way or any(names.count(name) > 1 for name in wanted):
        ways = "; or ".join(" and ".join(each) for each in _WAYS)
        why = f"; not known: {', '.join(map(repr, unknown))}" if unknown else ""
        raise ModelError(f"{where}: the columns must be {ways}, each of them once{why}")
    for name in _FURTHER:
        if way in _HEARD and name in names:
            raise ModelError(f"{where}: intervals and times have no column {name}")
    if "duration_uncertainty" in wanted and "duration" not in wanted:
        raise ModelError(f"{where}: duration_uncertainty needs a column duration")
    units = {name: headings[names.index(name)].unit for name in wanted}
    return {
        name: _Column(names.index(name), unit, _unit_value(where, name, unit))
        for name, unit in units.items()
    }


def _of_columns(
    headings: list[_Heading], used: dict[str, _Column], way: tuple[str, ...]
) -> list[str]:
    """The note on the columns that are not read."""
    read = {column.place for column in used.values()}
    rest = [each for k, each in enumerate(headings) if k not in read and not each.is_count]
    if not rest:
        return []
    named = f"column{'s' * (len(rest) > 1)} {', '.join(repr(each.text) for each in rest)}"
    why = f", because {headings[used[way[0]].place].text!r} is read" if _way(rest, _WAYS) else ""
    return [f"Left out: {named}{why}."]


def _body(
    where: str,
    headings: list[_Heading],
    used: dict[str, _Column],
    mark: str,
    rows: list[tuple[int, str]],
) -> list[tuple[int, list[str]]]:
    """The cells of each line, with decimal points."""
    # A comma in a single column is a decimal one if all lines have one.
    if (
        len(headings) == 1
        and rows
        and all(_DECIMAL_COMMA.fullmatch(row.strip()) for _, row in rows)
    ):
        mark = ";"
    found = []
    for at, line in rows:
        cells = _cells(line, mark)
        # Marks at the end of a line, and cells of columns that are not read, may be missing.
        while len(cells) > len(headings) and not cells[-1]:
            cells.pop()
        if not max(used.values()).place < len(cells) <= len(headings):
            columns = "one column" if len(headings) == 1 else f"{len(headings)} columns"
            raise ModelError(
                f"{where}, line {at}: {len(cells)} values for {columns}; numbers have a decimal "
                "point and no comma, unless columns are separated by tabs or semicolons"
            )
        found.append((at, cells if mark == "," else [_point(cell) for cell in cells]))
    return found


def _without_starts(
    headings: list[_Heading], body: list[tuple[int, list[str]]]
) -> tuple[list[tuple[int, list[str]]], list[int]]:
    """The lines of intervals of numbered impacts without the first line of a recording if its
    interval is 0 or empty, and the lines that this leaves out.
    """
    names = [each.name for each in headings]
    value = names.index("interval")
    recording = names.index("recording") if "recording" in names else None
    seen: set[str] = set()
    kept, starts = [], []
    for at, cells in body:
        key = "" if recording is None else cells[recording]
        if key not in seen and re.fullmatch(r"0*(\.0*)?", cells[value]):
            starts.append(at)
        else:
            kept.append((at, cells))
        seen.add(key)
    return kept, starts


def _without_signs(
    headings: list[_Heading],
    used: dict[str, _Column],
    body: list[tuple[int, list[str]]],
    leave_out: tuple[int, ...],
) -> list[str]:
    """Take the signs from columns of velocities that are all negative; the notes on them."""
    notes = []
    for name in ("speed", "rebound_speed"):
        if name not in used:
            continue
        place = used[name].place
        if all(cells[place].startswith(_MINUS) for at, cells in body if at not in leave_out):
            for _, cells in body:
                cells[place] = cells[place].lstrip("".join(_MINUS))
            text = headings[place].text
            notes.append(f"The velocities {text!r} are all negative: their sizes are the speeds.")
    return notes


def _values(
    where: str,
    used: dict[str, _Column],
    body: list[tuple[int, list[str]]],
    leave_out: tuple[int, ...],
) -> dict[str, np.ndarray]:
    """The numbers in SI units, checked."""
    found: dict[str, list[float]] = {name: [] for name in used}
    for at, cells in body:
        line = f"{where}, line {at}"
        for name, column in used.items():
            # The line stays in the place where it divides a recording.
            is_left_out = at in leave_out and name != "recording"
            value = math.nan if is_left_out else _cell(line, name, cells[column.place], column)
            _require_a_ball(line, name, value, column)
            found[name].append(value)
        for before, after, unit in _PAIRS:
            if after in used and found[after][-1] > found[before][-1]:
                raise ModelError(
                    f"{line}: {_words(after)} of {found[after][-1]:g} {unit} is above "
                    f"{_words(before)} of {found[before][-1]:g} {unit}"
                )
    return {name: np.array(values) for name, values in found.items()}


def _words(name: str) -> str:
    return f"the {name.replace('_', ' ')}"


def without_si_unit(text: str, kind: SIParameter) -> str:
    """A text without its unit if that is the SI unit, so that no other unit needs to be known.

    Examples
    --------
    >>> mass = SIParameter("kg", "20 g")
    >>> without_si_unit("0.3 kg", mass), without_si_unit("3 g", mass)
    ('0.3', '3 g')
    """
    value, _, unit = text.partition(" ")
    return value if unit.strip() == kind.name else text


def _unit_value(where: str, name: str, unit: str) -> float:
    """The SI value of the unit of a column."""
    if not unit:
        return 1.0
    try:
        return number_in_si(name, without_si_unit(f"1 {unit}", COLUMNS[name]), COLUMNS[name])
    except ParameterError as error:
        raise ModelError(f"{where}: {error}") from None


def _cell(line: str, name: str, text: str, column: _Column) -> float:
    kind = COLUMNS[name]
    if name in ("duration", "duration_uncertainty") and not text:
        return math.nan
    try:
        # Fifteen digits keep those of the file without the rounding of the factor.
        value = float(f"{number_in_si(name, text, kind) * column.factor:.15g}")
    except ParameterError as error:
        raise ModelError(f"{line}: {error}") from None
    if value not in kind.allowed:
        raise ModelError(f"{line}: {name} = {value:g} is not {kind.allowed}")
    return value


def _require_a_ball(line: str, name: str, value: float, column: _Column) -> None:
    """Refuse speeds and heights that a wrong unit explains better.

    Raises
    ------
    ModelError
        If the number is beyond the bounds of this module.
    """
    if COLUMNS[name].name == "m/s" and value > _FASTEST:
        said = f"a speed of {value:.3g} m/s"
        meant = "cm/s"
    elif COLUMNS[name].name == "m" and value > (HIGHEST if column.unit else _HIGHEST_WITHOUT_UNIT):
        said = f"a height of {value:.3g} m"
        meant = "cm"
    else:
        return
    raise ModelError(
        f"{line}: {said}: are these {meant}? write the unit in the heading: '{name} ({meant})'"
    )
