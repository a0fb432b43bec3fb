"""Tables with headings to columns of numbers: a file, a published experiment, or columns.

A heading is a name and its unit, as in ``rebound height (cm)``. :data:`NAMES` has the names that
are known; a number at its end counts columns, as in ``trial 2``. Lines that begin with ``#`` are
the head, in which ``# mass: 46 g`` is a quantity of the ball.
"""

import codecs
import csv
import io
import itertools
import math
import re
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_contacts.units import (
    LARGEST,
    SPELLED,
    Array,
    Refused,
    in_si,
    positive,
    refuse,
    units_of,
)

Lines = NDArray[np.intp]

NAMES = {
    "time": "time, t, impact time, event time, timestamp",
    "interval": "interval, time between, dt, delta t, Δt, difference",
    "touch": "start, stop",
    "flight": "flight, flight time, time of flight, air time",
    "drop height": "drop height, drop, initial height, release height, start height, "
    "height before, height of drop",
    "rebound height": "rebound height, rebound, return height, final height, height after, h', "
    "height of rebound, height of bounce",
    "trial": "trial, test, attempt",
    "average": "average, mean, average height, mean height, average bounce height, "
    "average rebound height, average bounce, average rebound",
    "height": "height, h, top, bounce height",
    "speed before": "speed before, velocity before, v before, v in, v0, initial speed",
    "speed after": "speed after, velocity after, v after, v out, final speed, rebound speed",
    "speed": "speed, velocity, v, impact speed, impact velocity",
    "restitution": "restitution, restitution coefficient, coefficient of restitution, COR, e, r",
    "uncertainty": "uncertainty, standard deviation, std, error",
    "position": "y, z, ym, y position, position, distance",
    "sideways": "x, xm, x position",
    "frame": "frame, frames, frame number, slice",
    "ball": "ball, name, body, sample",
    "recording": "recording, run, series, experiment",
    "count": "n, no, nr, number, bounce, bounce number, event number",
    "group": "group, groups",
    "remark": "remark, note, comment, label",
}
"""What a column has, and the names that say so."""
LAYOUTS: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("drops", ("drop height", "rebound height")),
    ("drops", ("drop height", "trial")),
    ("drops", ("drop height", "height")),
    ("drops", ("height", "rebound height")),
    ("drops", ("drop height", "average")),
    ("speeds", ("speed before", "speed after")),
    ("speeds", ("speed", "speed after")),
    ("coefficients", ("speed", "restitution")),
    ("coefficients", ("speed before", "restitution")),
    ("track", ("time", "position")),
    ("track", ("time", "height")),
    ("times", ("time",)),
    ("times", ("touch",)),
    ("flights", ("interval",)),
    ("flights", ("flight",)),
    ("heights", ("height",)),
)
"""What was measured is the first row whose columns are all there."""
COLUMNS = "or say which column is what, as in --columns 'NAME=t (s)'"
"""What each refusal of a heading names; ``columns={'NAME': 't (s)'}`` in Python."""
HEADINGS = (
    "write 'time (s)' over times of impacts, 'interval (s)', 'height (cm)' over successive tops, "
    "'drop height (cm),rebound height (cm)' over drops, or 't (s),y (cm)' over a film, " + COLUMNS
)
"""What messages say of headings that are not known."""
_ROLES = {
    re.sub(r"[ .]", "", name.lower()): role
    for role, names in NAMES.items()
    for name in names.split(", ")
}
_INHERITED = ("m", "m/s")
_QUANTITIES = ("s", *_INHERITED)
TEXTS = ("ball", "recording", "group", "remark", "count", "frame")
"""What divides a table or is said of its lines, and is no reading."""
_KNOWN_UNITS = {*SPELLED, *itertools.chain(*map(units_of, ("s", "m", "m/s"))), "px", "%"}
_CLOCKS = {"millis": "time (ms)", "micros": "time (µs)"}
# Programs write the name of a series before a heading or behind it. The names of programs are those
# of runs; other names may be those of balls.
_SERIES = r"^[^:(\[]*[^\W\d_][^:(\[]*: ?(?=[^\W\d_])| run #\d+"
_RUN = r"(?:latest|remote data|(?:data set|run|video ?analysis)?)[ #]*\d*"
# The name of a ball may stand behind the unit.
_OF_BALL = r"(.*\(\w+\)) *\(([^()]+)\)"
# The monitor of a board writes its clock before each line.
_STAMP = r"\d+:\d+:\d+\.\d{3} -> "
# Labels of a sound track have a begin, an end and a text, and no heading. Programs write six
# decimals; a label that a person types may have fewer, or no end.
_LABEL = r"(\d+\.?\d*)(?:\t(\d+\.?\d*))?(?:\t|$)"
_EXPORTED = r"\d+\.\d{6}\t"
_UNITS = {
    "interval": "s",
    "flight": "s",
    "time": "s",
    "touch": "s",
    "drop height": "m",
    "rebound height": "m",
    "trial": "m",
    "average": "m",
    "height": "m",
    "speed before": "m/s",
    "speed after": "m/s",
    "speed": "m/s",
    "restitution": "",
    "uncertainty": "",
}
# By the unit: what a number is, the largest ones without and with a unit in the heading, and the
# unit in which a larger one may have been written.
_LARGEST = {
    # A time may be counted from 1970.
    "s": ("time", math.inf, math.inf, ""),
    "m": ("height", 10.0, 100.0, "cm or mm"),
    "m/s": ("speed", 100.0, 100.0, "cm/s or mm/s"),
    # An error of its reading may let an r exceed 1.
    "": ("restitution coefficient", 1.05, 1.05, "%"),
}
_SMALLEST = 1e-9
# Lines above a table in which its headings are looked for.
_MOST_LINES = 40
# How files of spreadsheets and archives begin, and what a new spreadsheet has in its archive.
_OLD_SHEET = b"\xd0\xcf\x11\xe0"
_ARCHIVE = b"PK\3\4"
_OF_SHEETS = {"[Content_Types].xml", "mimetype"}
# What a cell has that is no number, and what to do.
_CAUSES = (
    (r"\d+([-/.])\d+\1\d{2,4}\D.*:|\d{4}-\d|.*\d:\d", "write a date or a time of day in seconds"),
    (
        r"[-+−]?\d+([.,'’\s]\d+)+$",
        "write thousands without a sign, and decimals with a point, 1234.5",
    ),
    (r"[-+−.\d]+\s*[^\W\d]", "a unit stands in the heading, as in {} ({})"),
    ("", "correct it, or leave it empty"),
)
# What programs and people write for a missing number.
_MISSING = ("", "-", "–", "—", "na", "n/a", "#n/a")


def experiments() -> list[str]:
    """Return the names of the published experiments of the package."""
    folder = files(__package__).joinpath("experiments")
    return sorted(file.name.removesuffix(".csv") for file in folder.iterdir())


@dataclass(frozen=True, eq=False)
class Column:
    """Column of a table.

    Attributes
    ----------
    name, unit
        Heading without its unit, and the unit.
    role
        What the column contains, a key of :data:`NAMES`; empty if the name is not known.
    cells, numbers
        Texts of the cells, and numbers in the unit of the column; NaN for an empty cell.
    """

    name: str
    unit: str
    role: str
    cells: list[str]
    numbers: Array

    @property
    def scale(self) -> float:
        """Unit of the column in SI units."""
        return in_si(f"unit of column {self.name!r}", f"1 {self.unit}", _UNITS[self.role])

    @property
    def is_count(self) -> bool:
        """Whether the numbers are whole and increase by 0 or 1, as numbers of trials do."""
        steps = np.diff(self.numbers)
        return bool(np.all(self.numbers % 1 == 0) and np.all((steps == 0) | (steps == 1)))

    @property
    def digit(self) -> float:
        """Last digit of the numbers, in the unit of the column."""
        written = [re.search(r"[.,](\d+)(?:[eE]([-+]?\d+))?", cell) for cell in self.cells]
        powers = [int(match[2] or 0) - len(match[1]) for match in written if match]
        return 10.0 ** min(powers, default=0)


@dataclass(frozen=True, eq=False)
class Table:
    """Columns, the numbers of their lines, and the quantities of the head."""

    name: str
    head: dict[str, str]
    columns: list[Column]
    lines: Lines

    def of(self, role: str) -> list[Column]:
        """Return the columns that contain a quantity."""
        return [column for column in self.columns if column.role == role]

    def names(self, role: str) -> list[str]:
        """Return the name in a column for each line; an empty cell has the name above it."""
        cells = [column.cells for column in self.of(role)] or [[""] * len(self.lines)]
        names = [""]
        for cell in cells[0]:
            names.append(cell or names[-1])
        return names[1:]

    def parts(self, role: str) -> "dict[str, Table]":
        """Return the lines of each name in a column."""
        rows_of: dict[str, list[int]] = {}
        for i, name in enumerate(self.names(role)):
            rows_of.setdefault(name, []).append(i)
        parts = {}
        for part, rows in rows_of.items():
            columns = [
                replace(column, cells=[column.cells[i] for i in rows], numbers=column.numbers[rows])
                for column in self.columns
            ]
            parts[part] = replace(self, columns=columns, lines=self.lines[rows])
        return parts

    def refuse(
        self, is_bad: NDArray[np.bool_], text: str, *numbers: Array, lines: Any = None
    ) -> None:
        """Refuse the first bad line; the text is formatted with its numbers."""
        for i in np.flatnonzero(is_bad)[:1]:
            line = (self.lines if lines is None else lines)[i]
            said = text.format(*(f"{array[i]:.6g}" for array in numbers))
            raise Refused(f"{self.name}, line {line}: {said}")

    def values(self, column: Column) -> Array:
        """Return the numbers of a column in SI units; refuse numbers that are out of range."""
        unit = _UNITS[column.role]
        what, bare, most, meant = _LARGEST[unit]
        # The sign of a velocity is its direction.
        values = column.scale * (np.abs(column.numbers) if unit == "m/s" else column.numbers)
        # A stopwatch writes an interval of 0 behind the last event.
        if column.role == "interval" and len(values) and values[-1] == 0:
            values[-1] = math.nan
        said = f"a {what} of {{}} {unit}".strip() + f" below {column.name!r} is "
        small = "not positive, or too small: is the unit right?"
        large = f"large: is it in {meant}? write the unit behind the heading"
        self.refuse(
            (values < _SMALLEST) & (column.role not in ("time", "touch")), said + small, values
        )
        self.refuse(values > (most if column.unit else bare), said + large, values)
        return values


def _text_of(source: Any) -> tuple[str, str]:
    """Return the name of a source, and its text; columns become lines with tabs."""
    if isinstance(source, Mapping):
        return "columns", _columns_as_text(source)
    if not isinstance(source, str | Path):
        raise Refused(
            f"{type(source).__name__} is no recording: give a file, the name of an experiment, or "
            "columns such as {'time (s)': [0.45, 1.17, 1.75]}"
        )
    inside = Path(str(files(__package__).joinpath("experiments", f"{source}.csv")))
    path = inside if str(source) in experiments() and not Path(source).exists() else Path(source)
    known = ", ".join(experiments())
    refuse(
        [
            (
                not path.exists(),
                f"the file {source} does not exist, and the experiments are {known}",
            ),
            (path.is_dir(), f"{path} is a folder: give a file in it"),
        ]
    )
    data = _unpacked(path.name, path.read_bytes())
    if data.startswith(b"RIFF"):
        return path.name, _heard(data)
    # Spreadsheets write what they call Unicode text.
    is_wide = data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    refuse(
        [
            (
                b"\0" in data and not is_wide,
                f"{path.name} is no text: save it as csv in UTF-8, or a sound as WAV, as by ffmpeg "
                f"-i {path.name} {path.stem}.wav",
            ),
        ]
    )
    text = data.decode("utf-16" if is_wide else "utf-8-sig", errors="replace")
    # A single line of numbers is read as the arguments of the command.
    is_typed = re.fullmatch(r"[-+−.\d][^\n:;#\t]*\s*", text)
    return path.name, _columns_as_text(typed_readings(text.split())) if is_typed else text


def _unpacked(name: str, data: bytes) -> bytes:
    """Return the only table of an archive; other data are returned as they are."""
    members: list[str] = []
    tables: list[str] = []
    try:
        if data.startswith(_ARCHIVE):
            archive = zipfile.ZipFile(io.BytesIO(data))
            members = archive.namelist()
            # Programs write folders about the device beside their table.
            tables = [
                member
                for member in members
                if re.fullmatch(r"[^/]+\.(csv|txt|tsv|dat|wav)", member.lower())
            ]
            data = archive.read(tables[0]) if len(tables) == 1 else b""
    except RuntimeError as reason:
        # It is encrypted, or compressed in a way that zipfile does not know.
        raise Refused(f"{name}: {reason}: unpack it, and give its table") from None
    except Exception:
        # Of one wrong bit zipfile raises any of seven exceptions.
        raise Refused(
            f"{name} is a damaged archive: copy it again, or unpack it, and give its table; of a "
            "spreadsheet save the sheet as csv"
        ) from None
    is_sheet = data.startswith(_OLD_SHEET) or _OF_SHEETS & {*members}
    refuse(
        [
            (is_sheet, f"{name} is a spreadsheet: save its sheet as csv"),
            (
                members and len(tables) != 1,
                f"{name} has {', '.join((tables or members)[:5])}: unpack it, and give one table",
            ),
        ]
    )
    return data


def _heard(data: bytes) -> str:
    """Return the labels of the impacts that are heard in a WAV file, and its head below them."""
    # Sounds need SciPy, whose import takes longer than a table.
    from bouncing_ball_contacts.sounds import listen, sound_of

    heard = listen(sound_of(io.BytesIO(data)))
    # What is piped, or read in Python, has times without options.
    said = "; ".join([str(heard), *heard.notes]).replace("--", "")
    return f"{heard.labels}# resolution: {heard.resolution:.2g} s\n# heard: {said}"


def typed_readings(words: Sequence[str]) -> dict[str, Any]:
    """Return a column of numbers that are typed with their unit, as in 1.80 1.21 0.82 m.

    Lengths are successive heights. Increasing times are times of impacts; other times are intervals
    between impacts.

    Raises
    ------
    Refused
        If a word is not a number, or the unit is not a unit of length or time.
    """
    # Commas divide numbers that have points.
    text = " ".join(words)
    text = re.sub(r",(?=\d*\.)", " ", text)
    matches = [re.fullmatch(r"([-+−]?[\d.,]*\d[\d.,]*)?([^\d.,]*)", word) for word in text.split()]
    numbers = [match[1] for match in matches if match and match[1]]
    units = {SPELLED.get(match[2].lower(), match[2]) for match in matches if match and match[2]}
    unit = units.pop() if len(units) == 1 and None not in matches else ""
    if unit not in units_of("s") + units_of("m"):
        raise Refused(
            f"recording: {' '.join(words)!r} are no heights or times with one unit: write "
            "1.80 1.21 0.82 m, or give one file"
        )
    values = [in_si("recording", number, "") for number in numbers]
    if unit in units_of("m"):
        return {f"height ({unit})": numbers}
    is_time = all(later > earlier for earlier, later in itertools.pairwise(values))
    return {f"{'time' if is_time else 'interval'} ({unit})": numbers}


def _columns_as_text(columns: Mapping[str, Any]) -> str:
    """Return columns below their headings; a shorter one has empty cells at its end."""
    rows = itertools.zip_longest(*columns.values())
    lines = [list(columns), *(["" if cell is None else str(cell) for cell in row] for row in rows)]
    return "\n".join("\t".join(line) for line in lines)


def _heading(text: str) -> tuple[str, str, str]:
    """Return the name of a heading, its unit, and its role; an unknown role is empty."""
    plain = " ".join(re.sub("[’′]", "'", text.replace("_", " ")).split())
    plain = re.sub(_SERIES, "", plain, flags=re.IGNORECASE)
    plain = _CLOCKS.get(plain.lower(), plain)
    parts = re.fullmatch(r"(.+?) ?[(\[](.*)[)\]]", plain) or re.fullmatch(
        r"(.+?)(?: in |[ /]+)((?i:n?s|[mµu]s|[cmµ]?m|[ck]?m/s|km/h|inch|ft|px|%))", plain
    )
    name, unit = parts.groups() if parts else (plain, "")
    # People write CM, and M for m.
    unit = SPELLED.get(unit.lower(), unit if unit in _KNOWN_UNITS else unit.lower())
    key = re.sub(r"[ .]", "", name.lower())
    # h0, h1, h2 are counted, and v0 is a name of its own.
    role = _ROLES.get(key) or _ROLES.get(key.rstrip("0123456789"), "")
    # Bounce 1 (s) is the time of a touch, bounce 1 (cm) is a height, and Bounce is a number.
    if role == "count" and unit in units_of("s") + units_of("m"):
        role = "touch" if unit in units_of("s") else "height"
    return name, unit, role


def _number(cell: str, is_decimal_comma: bool) -> float | None:
    """Return the number of a cell, NaN if it is missing, and None if it has another text."""
    plain = cell.replace("−", "-")
    if is_decimal_comma:
        plain = plain.replace(",", ".")
    if plain.lower() in _MISSING:
        return math.nan
    try:
        number = float(plain)
    except ValueError:
        return None
    # Nanoseconds since 1970 are about 2e18.
    return None if abs(number) > 10 * LARGEST else number


def _rows_of(
    name: str, text: str, named: Mapping[str, str]
) -> tuple[dict[str, str], dict[int, list[str]], bool]:
    """Return the quantities of the head, the cells by line, and whether commas are decimal.

    The headings are the last line with names of columns above the numbers: a line whose next line
    has names is a title, whatever its words.
    """
    head: dict[str, str] = {}
    lines: dict[int, str] = {}
    # Below its table ImageJ has another one, with the lengths of the tracks.
    (text, *_) = re.split(r"\nTrack\W", text)
    for i, written in enumerate(text.rstrip().splitlines(), 1):
        line = re.sub(f"^{_STAMP}", "", written)
        if re.match(r"Tracks \d|[-|:+ ]*---[-|:+ ]*$", line):
            # ImageJ counts its tracks, and a line divides the headings of Markdown.
            continue
        if line.startswith("#"):
            key, _, said = line.lstrip("# ").partition(":")
            key = key.strip().lower()
            head[key] = f"{head.get(key, '')} {said.strip()}".strip()
        elif lines or line.strip():
            lines[i] = line
    begin = _line_of_headings(lines, named)
    table = {i: line for i, line in lines.items() if i >= begin}
    # A line that begins with a backslash has the frequencies of a label.
    labels = {i: line for i, line in lines.items() if not line.startswith("\\")}
    ends = [re.match(_LABEL, line) for line in labels.values() if line]
    is_exported = any(re.match(_EXPORTED, line) for line in labels.values())
    if is_exported and all(
        label and float(label[1]) <= float(label[2] or label[1]) for label in ends
    ):
        # Impacts have no end.
        begins = {i: line.partition("\t")[0] for i, line in labels.items()}
        begin, table = 0, {0: "time (s)", **begins}
    if len(table) < 2 or not table[begin].strip("| "):
        raise Refused(f"{name} has no line of numbers below a heading")
    sign = next((separator for separator in "\t;|," if separator in table[begin]), "")
    below = [_number(cell, True) for cell in list(table.values())[1].split()]
    if not sign and len(below) > 1 and None not in below:
        return head, _divided_by_spaces(name, table), True
    rows = {}
    for i, line in table.items():
        (cells,) = csv.reader([line.strip("| ")], delimiter=sign or "\t", skipinitialspace=True)
        rows[i] = [cell.strip() for cell in cells]
    return head, rows, sign != ","


def _line_of_headings(lines: Mapping[int, str], named: Mapping[str, str]) -> int:
    """Return the line with the names of the columns, above the first line with a number.

    It is the last one with a name that is known, or else the last one that has more than units.
    """
    known = above = fallback = 0
    for i, line in itertools.islice(lines.items(), _MOST_LINES):
        cells = [cell.strip() for cell in re.split(r'[\t;|,"]+', line)]
        words = cells if len(cells) > 1 else [*re.split(r"\s{2,}", line), *line.split()]
        if any(map(_is_reading, words)):
            if known:
                break
            fallback = fallback or above
        elif any(_heading(word)[2] or word in named for word in words):
            known = i
        elif not {*words} <= _KNOWN_UNITS:
            above = i
    return known or fallback or min(lines, default=0)


def _is_reading(cell: str) -> bool:
    """Return whether a cell has a number, which may have a unit."""
    match = re.fullmatch(r"[-+−]?[.,]?\d[-+−\d.,:/'\"± eE]*?([^\W\d]*|%)", cell)
    return bool(match and (not match[1] or SPELLED.get(match[1].lower(), match[1]) in _KNOWN_UNITS))


def _divided_by_spaces(name: str, table: dict[int, str]) -> dict[int, list[str]]:
    """Return the cells by line of a table whose columns are divided by spaces."""
    begin, *lines = table
    # A unit belongs to the name before it, and names with spaces are divided by two.
    headings = re.sub(r" (?=[(\[])", "", table[begin].strip())
    rows = {begin: re.split(r"\s{2,}|\t" if re.search(r"\s{2,}|\t", headings) else " ", headings)}
    rows |= {i: table[i].split() for i in lines}
    for i in lines:
        if rows[i] and len(rows[i]) != len(rows[begin]):
            raise Refused(
                f"{name}, line {i}: {len(rows[i])} cells below {len(rows[begin])} headings: divide "
                "columns by commas, because spaces divide names, and hide a missing number"
            )
    return rows


def _name_in(heading: str) -> tuple[str, str]:
    """Return the name of a run or a track in a heading, and the heading without it."""
    program = re.search(_SERIES, heading, re.IGNORECASE)
    if program:
        return program[0].strip(": "), heading.replace(program[0], "")
    track = re.fullmatch(r"(x|y|flag)(\d+)", heading, re.IGNORECASE)
    if track:
        return track[2], track[1]
    ball = re.fullmatch(_OF_BALL, heading)
    return (ball[2], ball[1]) if ball else ("", heading)


def _series_in(headings: list[str]) -> list[tuple[str, str]]:
    """Return the name of each column's series, and the heading without it.

    A heading that returns begins another run, whatever it is.
    """
    series = [_name_in(heading) for heading in headings]
    plain = [heading for _, heading in series]
    again = [heading for heading in plain if heading and headings.count(heading) > 1]
    are_runs = any(_heading(heading)[2] not in ("", *TEXTS) for heading in again)
    for i, heading in enumerate(plain):
        if are_runs and heading in again:
            series[i] = str(headings[: i + 1].count(heading)), heading
    return series


def _below_each_other(
    name: str, headings: list[str], lines: list[int], rows: list[list[str]]
) -> tuple[list[str], list[int], list[list[str]]]:
    """Return the headings, line numbers and rows of series that are side by side.

    A column without the name of a series, such as one time of all, belongs to each series.
    """
    names, plain = zip(*_series_in(headings), strict=True)
    series = {
        series_name: [i for i, other in enumerate(names) if other in ("", series_name)]
        for series_name in dict.fromkeys(filter(None, names))
    }
    shared = [
        _heading(heading)[2] for heading, named in zip(plain, names, strict=True) if not named
    ]
    if len(series) < 2 or len([role for role in shared if role not in ("", *TEXTS)]) > 1:
        return headings, lines, rows
    kinds = {series_name: [plain[i] for i in columns] for series_name, columns in series.items()}
    # A column that one series has alone is not read.
    common = [heading for heading in plain if all(heading in kind for kind in kinds.values())]
    alike = [heading for heading in dict.fromkeys(common) if heading]
    read, there = (
        {_heading(heading)[2] for heading in some} - {"", *TEXTS} for some in (alike, plain)
    )
    # Positions that only one series has are not left out.
    if not read or (read == {"time"} and there != read):
        both = " and ".join(
            f"{series_name} has {', '.join(kind)}" for series_name, kind in kinds.items()
        )
        raise Refused(f"{name}: {both}: leave the same columns of each, {COLUMNS}")
    numbers: list[int] = []
    stacked: list[list[str]] = []
    for series_name, of_series in series.items():
        columns = [next(i for i in of_series if plain[i] == heading) for heading in alike]
        # A shorter series ends with empty cells.
        is_there = [any(row[i] for i in columns if names[i]) for row in rows]
        length = max(itertools.compress(itertools.count(1), is_there), default=0)
        numbers += lines[:length]
        stacked += [[series_name, *(row[i] for i in columns)] for row in rows[:length]]
    are_runs = all(re.fullmatch(_RUN, series_name, re.IGNORECASE) for series_name in series)
    is_of_balls = not are_runs or any(re.fullmatch(_OF_BALL, heading) for heading in headings)
    return ["ball" if is_of_balls else "recording", *alike], numbers, stacked


def _with_row_of_units(rows: dict[int, list[str]]) -> list[str]:
    """Take the headings out of the rows, and a row of units below them; return the headings."""
    begin, first = list(rows)[:2]
    headings = rows.pop(begin)
    units = [re.sub(r"[()\[\]]", "", cell).strip("-") for cell in rows[first]]
    are_known = {*map(str.lower, filter(None, units))} <= _KNOWN_UNITS
    are_bracketed = all(re.fullmatch(r"[(\[].*[)\]]|", cell) for cell in rows[first])
    if not any(units) or not (are_known or are_bracketed):
        return headings
    del rows[first]
    padded = itertools.zip_longest(headings, units, fillvalue="")
    return [f"{heading} ({unit})" if unit else heading for heading, unit in padded]


def table_of(
    source: Any, leave_out: Sequence[int] = (), named: Mapping[str, str] | None = None
) -> Table:
    """Return the table of a source.

    Cells of lines that are left out are empty. ``named`` has headings by the names that columns
    have in the file, or by their numbers from 1 on; other columns are not read.

    Raises
    ------
    Refused
        If there is no table with headings, or a number is none.
    """
    name, text = _text_of(source)
    head, rows, is_decimal_comma = _rows_of(name, text, named or {})
    begin = next(iter(rows))
    if named and all(_is_reading(cell) for cell in rows[begin] if cell):
        # Above its numbers the file has no names.
        rows = {0: [""] * len(rows[begin]), **rows}
    headings = _with_row_of_units(rows)
    read = _read_columns(name, headings, named or {})
    headings = [read.get(i, heading) for i, heading in enumerate(headings)]
    lines = list(rows)
    unknown = set(leave_out) - set(lines)
    refuse(
        [
            (not rows, f"{name} has no line of numbers below a heading"),
            (unknown, f"{name} has no line {min(unknown, default=0)} of numbers to leave out"),
            *(
                (
                    any(row[len(headings) :]),
                    f"{name}, line {i}: {len(row)} cells below {len(headings)} headings",
                )
                for i, row in rows.items()
            ),
        ]
    )
    rows |= {i: [] for i in leave_out}
    padded = [[*row, *[""] * (len(headings) - len(row))][: len(headings)] for row in rows.values()]
    if not named:
        headings, lines, padded = _below_each_other(name, headings, lines, padded)
    columns: list[Column] = []
    for heading, *written in zip(headings, *padded, strict=True):
        title, unit, role = _heading(heading)
        if named and len(columns) not in read:
            role = "remark"
        cells = written
        if role and role not in TEXTS:
            plain = [_decimal(cell) for cell in written]
            cells, unit = _with_units_of_cells(plain, unit, is_decimal_comma)
        numbers = [_number(cell, is_decimal_comma) for cell in cells]
        if role and role not in TEXTS and None in numbers:
            i = numbers.index(None)
            cause = next(said for form, said in _CAUSES if re.match(form, written[i]))
            example = {"s": "s", "m/s": "m/s", "": "%"}.get(_UNITS.get(role, "m"), "cm")
            raise Refused(
                f"{name}, line {lines[i]}: {written[i]!r} below {title!r} is no number; "
                + cause.format(title, example)
            )
        column = Column(title, unit, role, cells, np.array(numbers, float))
        # Trials by their numbers divide a table, where those of heights have a unit.
        is_number = title.lower() == "trial" and not unit and column.is_count
        columns.append(replace(column, role="recording") if is_number else column)
    if not named and _number(headings[0] or "no", is_decimal_comma) is not None:
        raise Refused(f"{name}, line {begin}: a table begins with headings: {HEADINGS}")
    columns = _with_units(columns)
    return Table(name, head, _with_times(head, columns), np.array(lines))


def _read_columns(name: str, headings: list[str], named: Mapping[str, str]) -> dict[int, str]:
    """Return the headings that are given, by the places of their columns."""
    plain = [_heading(heading)[0].lower() for heading in headings]
    whole = [heading.lower() for heading in headings]
    given = {}
    for key, heading in named.items():
        names = whole if key.lower() in whole else plain
        is_there = key.lower() in names
        i = names.index(key.lower()) if is_there else int(key) - 1 if key.isdecimal() else -1
        refuse(
            [
                (
                    not 0 <= i < len(headings),
                    f"{name} has no column {key!r}: its columns are {', '.join(headings)}",
                ),
                (not _heading(heading)[2], f"--columns: {heading!r} is not known: {HEADINGS}"),
            ]
        )
        given[i] = heading
    return given


def _decimal(cell: str) -> str:
    r"""Return a cell without its error, and with a decimal number for a fraction, feet or a clock.

    >>> [_decimal(cell) for cell in ("50 ± 0.5 cm", "46 1/2", "6' 2\"", "00:01:02.5")]
    ['50 cm', '46.5', '74 in', '62.5']
    """
    plain = re.sub(r"\s*(±|\+/-)\s*[\d.,]+", "", cell)
    mixed = re.match(r"(\d+) (\d+)/([1-9]\d*)", plain)
    if mixed:
        plain = f"{int(mixed[1]) + int(mixed[2]) / int(mixed[3]):g}{plain[mixed.end() :]}"
    feet = re.fullmatch(r"(\d+)\s*['’′]\s*(?:((?:\d|1[01])(?:\.\d+)?)\s*[\"”″]?)?", plain)
    clock = re.fullmatch(r"(?:(\d+):)?(\d+):(\d\d(?:[.,]\d+)?)", plain)
    if clock:
        return str(
            Decimal(clock[3].replace(",", ".")) + 60 * int(clock[2]) + 3600 * int(clock[1] or 0)
        )
    return f"{12 * int(feet[1]) + float(feet[2] or 0):g} in" if feet else plain


def _with_units_of_cells(
    cells: list[str], unit: str, is_decimal_comma: bool
) -> tuple[list[str], str]:
    """Return the numbers of cells such as 1 meter, and their unit: the SI unit of several."""
    matches = [re.fullmatch(r"([-+−]?[\d.,]*\d)\s*([^\W\d]\S*|%)?", cell) for cell in cells]
    parts = [match for match in matches if match]
    units = [SPELLED.get((part[2] or "").lower(), part[2]) or unit for part in parts]
    si = next((quantity for quantity in _QUANTITIES if {*units} <= {*units_of(quantity)}), None)
    if si is None or len(parts) < sum(map(bool, cells)) or not any(part[2] for part in parts):
        return cells, unit
    one = unit or (units[0] if len({*units}) == 1 else si)
    scales = [Decimal(repr(in_si("unit", f"1 {cell_unit}", si))) for cell_unit in (one, *units)]
    plain = (part[1].replace("−", "-") for part in parts)
    numbers = iter(
        str(Decimal(text.replace(",", "." if is_decimal_comma else "")) * scale / scales[0])
        for text, scale in zip(plain, scales[1:], strict=True)
    )
    return [next(numbers) if match else "" for match in matches], one


def _with_units(columns: list[Column]) -> list[Column]:
    """Give heights and speeds the unit of the others. Several times in a line are touches."""
    units = {
        _UNITS.get(column.role, ""): column.unit for column in reversed(columns) if column.unit
    }
    inherited = {unit: units.get(unit, "") for unit in _INHERITED}
    times = [
        column for column in columns if column.role == "time" and re.search(r"\d$", column.name)
    ]
    return [
        replace(
            column,
            unit=column.unit or inherited.get(_UNITS.get(column.role, ""), ""),
            role="touch" if len(times) > 1 and column in times else column.role,
        )
        for column in columns
    ]


def _with_times(head: Mapping[str, str], columns: list[Column]) -> list[Column]:
    """Replace frames by times, if the head has the frame rate and no column has times."""
    if "frame rate" not in head or any(column.role == "time" for column in columns):
        return columns
    rate = positive("frame rate", head["frame rate"], "Hz")
    return [
        replace(
            column,
            unit="s",
            role="time",
            cells=[f"{number / rate:.9f}" for number in column.numbers],
            numbers=column.numbers / rate,
        )
        if column.role == "frame"
        else column
        for column in columns
    ]
