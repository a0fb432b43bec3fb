r"""A text file of measured impacts, and the experiments that belong to the package.

A file has lines ``# key: value`` with the source and the ball, one line with the names and units of
the columns, and one line of numbers for each impact ::

    # mass: 9.6 g
    drop_height [m],rebound_height [m]
    0.10,0.015

The columns are ``speed`` and ``restitution``, or ``drop_height`` and ``rebound_height``, or
``interval`` or ``time``, the intervals between the impacts of one bouncing ball or their times; a
column ``recording`` numbers the recordings if there are several. ``uncertainty``, of the
restitution coefficient, ``duration`` and ``duration_uncertainty`` may follow speeds or heights. If
the mass and the diameter of the ball are known, the drag of the air is removed from heights and
intervals (:mod:`bouncing_ball_contacts.measured.flights`). The files of the package are in SI
units.

Files that instruments write are read as well. Columns may be separated by tabs or by semicolons,
and numbers may then have decimal commas; a single column of numbers may have them, too. Headings
may be those of telephone apps, such as ``Interval (s)`` and ``Event time (s)``, and a column that
counts the events is passed over.

Where a file has no uncertainties their size follows from the scatter of the points. Errors of
restitution coefficients that stand in the file are then taken as equal. Those that follow from
heights or intervals are not: the same error of all heights, of a reading or of an uneven floor, is
an error of e that falls as 1/v² (:func:`bouncing_ball_contacts.measured.flights.by_height`).
"""

import csv
import math
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.errors import ModelError, ParameterError, Range
from bouncing_ball_contacts.contact.units import SIParameter, in_si, number_in_si
from bouncing_ball_contacts.measured.fit import ContactFit, fit_contact
from bouncing_ball_contacts.measured.flights import (
    Heard,
    by_height,
    drag_length,
    drop_speeds,
    heard,
    together,
)

DATA = Path(__file__).with_name("data")
"""The folder of the package's experiments."""

COLUMNS = {
    "speed": SIParameter("m/s", "1 m/s"),
    "restitution": SIParameter("", "0.85", Range(0, 1, "(]")),
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
QUANTITIES = {
    "mass": SIParameter("kg", "20 g"),
    "diameter": SIParameter("m", "40 mm"),
    "contact time": SIParameter("s", "1 ms"),
    "contact time uncertainty": SIParameter("s", "0.1 ms"),
    "resolution": SIParameter("s", "1 ms"),
}
"""The numbers at the head of a file."""
TEXTS = ("title", "ball", "measured by", "published", "source", "read", "note")
"""The texts at the head of a file; each may stand on several lines."""
# Headings of instruments, in lower case, and columns that only count.
_ALIASES = {
    "event time": "time",
    "impact time": "time",
    "times": "time",
    "t": "time",
    "intervals": "interval",
    "time interval": "interval",
    "drop": "drop_height",
    "rebound": "rebound_height",
}
_COUNTS = {
    "event",
    "events",
    "bounce",
    "impact",
    "index",
    "no",
    "no.",
    "nr",
    "number",
    "n",
    "#",
    "",
}
_DECIMAL_COMMA = re.compile(r"[+-]?\d+,\d+")
_WAYS = ({"speed", "restitution"}, {"drop_height", "rebound_height"}, {"interval"}, {"time"})
_FURTHER = {"uncertainty", "duration", "duration_uncertainty"}
_OF_INTERVALS = {"recording"}
"""What may follow speeds or heights, and what may follow intervals."""


@dataclass(frozen=True)
class Experiment:
    """Measured impacts and where they come from, in SI units.

    Parameters
    ----------
    name : str
        The name of the file without its ending.
    texts : dict
        The texts at the head of the file.
    speeds, restitutions : ndarray
        Impact speeds and restitution coefficients, after the removal of the drag.
    uncertainties : ndarray or None
        Standard deviations of the restitution coefficients, or their covariance matrix.
    relative_errors : ndarray or None
        Standard deviations up to a common factor, where only these are known.
    durations, duration_uncertainties : ndarray, float or None
        Contact times: one for each point, or a single one.
    mass, diameter : float or None
        Of the ball.
    drag_bias : float
        The largest change of a restitution coefficient by the removal of the drag; 0 if it was not
        removed.
    is_without_drag : bool
        Whether it was removed, for which the mass and the diameter are known.
    is_of_flights : bool
        Whether the speeds follow from heights or times of flights, on which the drag acts.
    heard : Heard or None
        The impacts of a bouncing ball with the biases that were removed.
    left_out : tuple of int
        The lines of the file that were left out.
    """

    name: str
    texts: dict[str, str]
    speeds: np.ndarray
    restitutions: np.ndarray
    uncertainties: np.ndarray | None = None
    relative_errors: np.ndarray | None = None
    durations: Any = None
    duration_uncertainties: Any = None
    mass: float | None = None
    diameter: float | None = None
    drag_bias: float = 0.0
    is_without_drag: bool = False
    is_of_flights: bool = False
    heard: Heard | None = field(default=None, repr=False)
    left_out: tuple[int, ...] = ()

    @property
    def title(self) -> str:
        """The title, by default the name."""
        return self.texts.get("title", self.name)

    def fit(self, laws: tuple[str, ...] | None = None) -> ContactFit:
        """The contact laws fitted to this experiment, see :func:`.fit.fit_contact`."""
        is_given = self.uncertainties is not None
        return fit_contact(
            self.speeds,
            self.restitutions,
            self.durations,
            uncertainties=self.uncertainties if is_given else self.relative_errors,
            absolute_uncertainties=is_given or self.relative_errors is None,
            duration_uncertainties=self.duration_uncertainties,
            mass=self.mass,
            laws=laws,
        )


def experiment_names() -> list[str]:
    """The names of the package's experiments.

    Examples
    --------
    >>> "croquet" in experiment_names()
    True
    """
    return sorted(each.stem for each in DATA.glob("*.csv"))


def experiment(name: str) -> Experiment:
    """The experiment of the package with this name.

    Raises
    ------
    ModelError
        If there is no such experiment.

    Examples
    --------
    >>> experiment("croquet").speeds.size
    10
    """
    if name not in experiment_names():
        raise ModelError(f"unknown experiment {name!r}: one of {', '.join(experiment_names())}")
    return read(DATA / f"{name}.csv")


def read(file: str | Path, **options: Any) -> Experiment:
    """The experiment in a file.

    Parameters
    ----------
    file : path
    **options
        Numbers in place of those at the head of the file, with ``_`` for a space: ``mass``,
        ``diameter``, ``contact_time``, ``contact_time_uncertainty`` and ``resolution``.
        ``intervals=True`` reads the intervals of one bouncing ball, for which a line with the names
        of the columns is not needed. ``leave_out`` has the numbers of lines that are left out: no
        impact beside such an interval or time is used.

    Raises
    ------
    ModelError
        If the file cannot be read or a line is not understood; the message names the line.
    """
    if not str(file):
        raise ModelError("the name of the file is empty")
    path = Path(file)
    intervals = options.pop("intervals", False)
    leave_out = tuple(options.pop("leave_out", ()))
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeError) as error:
        why = error.strerror if isinstance(error, OSError) else "it is not a text in UTF-8"
        raise ModelError(f"{path} cannot be read: {why}") from None
    if path.parent == DATA:
        # A file of the package is known by its name.
        path = Path(path.name)
    head, rows = _parts(path, lines)
    rows = _with_points(rows)
    if rows and _is_number(rows[0][1].split(",")[0]):
        if not intervals:
            raise ParameterError(
                f"{path}, line {rows[0][0]}: numbers without a heading: is it a file of "
                "{intervals}, or is a line such as 'speed [m/s],restitution' missing?"
            )
        rows = [(0, "interval [s]"), *rows]
    columns, at = _columns(path, rows)
    for line in leave_out:
        if line not in at:
            raise ModelError(f"{path} has no line {line} with numbers to leave out")
    if intervals and not columns.keys() & {"interval", "time"}:
        raise ModelError(f"{path} has no column interval or time")
    numbers = {key: value for key, value in head.items() if key in QUANTITIES}
    for name, value in options.items():
        if value is not None:
            key = name.replace("_", " ")
            numbers[key] = in_si(name, value, QUANTITIES[key])
    _require_their_use(path, numbers, columns)
    texts = {key: value for key, value in head.items() if key in TEXTS}
    try:
        return _experiment(path.stem, texts, numbers, columns, _Lines(at, leave_out))
    except ParameterError as error:
        text, *values = error.args
        raise ParameterError(f"{path}: {text}", *values) from None
    except ModelError as error:
        raise ModelError(f"{path}: {error}") from None


class _Lines(NamedTuple):
    """The lines of the rows of numbers, and those that are left out."""

    numbers: list[int]
    left_out: tuple[int, ...]


def _with_points(rows: list[tuple[int, str]]) -> list[tuple[int, str]]:
    """Rows with commas between the columns and points in numbers, whatever an instrument writes."""
    text = "\n".join(line for _, line in rows)
    mark = next((mark for mark in "\t;" if mark in text), None)
    if mark is not None:
        # A mark at the end of a line is no further column.
        parts = ((at, line.strip(mark).split(mark)) for at, line in rows)
        return [(at, ",".join(_point(cell) for cell in cells)) for at, cells in parts]
    headings = [line for _, line in rows if any(map(str.isalpha, line))]
    numbers = [line.strip() for _, line in rows if line not in headings]
    # A comma in a heading is one between columns, also if all numbers of a file are whole.
    has_one_column = not any("," in line for line in headings)
    if has_one_column and numbers and all(map(_DECIMAL_COMMA.fullmatch, numbers)):
        return [(at, _point(line)) for at, line in rows]
    return rows


def _point(cell: str) -> str:
    """A number with a decimal point in place of a comma; other texts as they are."""
    text = cell.strip().strip('"')
    return text.replace(",", ".") if _DECIMAL_COMMA.match(text) else text


def _require_their_use(
    path: Path, numbers: dict[str, float], columns: dict[str, np.ndarray]
) -> None:
    """Refuse numbers that change nothing, because another column or number is missing."""
    if "resolution" in numbers and not columns.keys() & {"interval", "time"}:
        raise ModelError(f"{path}: a resolution needs intervals or times")
    is_timed = "contact time" in numbers or "duration" in columns
    if "contact time uncertainty" in numbers and not is_timed:
        raise ModelError(f"{path}: the uncertainty of a contact time needs the contact time")


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _parts(path: Path, lines: list[str]) -> tuple[dict[str, Any], list[tuple[int, str]]]:
    """The head of a file, and its other lines with their numbers."""
    head: dict[str, Any] = {}
    rows = []
    for at, line in enumerate(lines, start=1):
        if not line.startswith("#"):
            if line.strip():
                rows.append((at, line))
            continue
        key, colon, value = (part.strip() for part in line[1:].partition(":"))
        if not colon:
            continue
        if key in QUANTITIES:
            head[key] = _quantity(path, at, key, value, QUANTITIES[key])
        elif key in TEXTS:
            head[key] = f"{head[key]} {value}" if key in head else value
        else:
            known = ", ".join((*TEXTS, *QUANTITIES))
            raise ModelError(f"{path}, line {at}: unknown key {key!r}: one of {known}")
    return head, rows


def _plain(text: str, kind: SIParameter) -> str:
    """A text without its unit if that is the SI unit, so that no other unit needs to be known.

    Examples
    --------
    >>> _plain("0.3 kg", QUANTITIES["mass"]), _plain("3 g", QUANTITIES["mass"])
    ('0.3', '3 g')
    """
    value, _, unit = text.partition(" ")
    return value if unit.strip() == kind.name else text


def _quantity(path: Path, at: int, name: str, value: str, kind: SIParameter) -> float:
    try:
        return in_si(name, _plain(value, kind), kind)
    except ParameterError as error:
        raise ModelError(f"{path}, line {at}: {error}") from None


def _columns(path: Path, rows: list[tuple[int, str]]) -> tuple[dict[str, np.ndarray], list[int]]:
    """The columns of a file in SI units, by name, and the lines of their rows."""
    if not rows:
        raise ModelError(f"{path} has no line with the names of the columns")
    at, line = rows[0]
    headings = next(csv.reader([line]))
    counts = len(headings) > 1 and headings[0].strip().casefold() in _COUNTS
    titles = [_title(path, at, each) for each in headings[counts:]]
    wanted = [name for name, _ in titles]
    if len(set(wanted)) < len(wanted) or set(wanted) - _FURTHER - _OF_INTERVALS not in _WAYS:
        ways = "; or ".join(" and ".join(sorted(way, reverse=True)) for way in _WAYS)
        raise ModelError(f"{path}, line {at}: the columns must be {ways}, each of them once")
    is_heard = bool({"interval", "time"} & set(wanted))
    if "recording" in wanted and not is_heard:
        raise ModelError(f"{path}, line {at}: a column recording needs a column interval or time")
    for name in wanted:
        if is_heard and name in _FURTHER:
            raise ModelError(f"{path}, line {at}: intervals and times have no column {name}")
    if "duration_uncertainty" in wanted and "duration" not in wanted:
        raise ModelError(f"{path}, line {at}: duration_uncertainty needs a column duration")
    found: dict[str, list[float]] = {name: [] for name in wanted}
    for at, line in rows[1:]:
        cells = next(csv.reader([line]))[counts:]
        if len(cells) != len(titles):
            columns = "one column" if len(titles) == 1 else f"{len(titles)} columns"
            raise ModelError(
                f"{path}, line {at}: {len(cells)} values for {columns}; numbers have a decimal "
                "point and no comma, unless columns are separated by tabs or semicolons"
            )
        for (name, factor), cell in zip(titles, cells, strict=True):
            found[name].append(_cell(path, at, name, cell, factor))
        if "drop_height" in found and found["rebound_height"][-1] > found["drop_height"][-1]:
            back, drop = (f"{found[f'{name}_height'][-1]:g} m" for name in ("rebound", "drop"))
            raise ModelError(
                f"{path}, line {at}: the rebound of {back} is above the drop of {drop}"
            )
    if not found[wanted[0]]:
        raise ModelError(f"{path} has no line of numbers")
    return {name: np.array(values) for name, values in found.items()}, [at for at, _ in rows[1:]]


def _title(path: Path, at: int, text: str) -> tuple[str, float]:
    """The name of a column and the SI value of its unit."""
    brackets = text.strip().translate(str.maketrans("()", "[]"))
    name, _, unit = brackets.removesuffix("]").partition("[")
    name = name.strip().casefold()
    name = _ALIASES.get(name, name.replace(" ", "_"))
    if name not in COLUMNS:
        raise ModelError(f"{path}, line {at}: unknown column {name!r}: one of {', '.join(COLUMNS)}")
    if not unit:
        return name, 1.0
    try:
        return name, number_in_si(name, _plain(f"1 {unit}", COLUMNS[name]), COLUMNS[name])
    except ParameterError as error:
        raise ModelError(f"{path}, line {at}: {error}") from None


def _cell(path: Path, at: int, name: str, cell: str, factor: float) -> float:
    kind = COLUMNS[name]
    text = cell.strip()
    if name in ("duration", "duration_uncertainty") and not text:
        return math.nan
    try:
        # Fifteen digits keep those of the file without the rounding of the factor.
        value = float(f"{number_in_si(name, text, kind) * factor:.15g}")
    except ParameterError as error:
        raise ModelError(f"{path}, line {at}: {error}") from None
    if value not in kind.allowed:
        raise ModelError(f"{path}, line {at}: {name} = {value:g} is not {kind.allowed}")
    return value


class _Recording(NamedTuple):
    """Successive intervals, the lines of their ends, and the number of the recording."""

    intervals: np.ndarray
    lines: list[int]
    number: int


def _recordings(columns: dict[str, np.ndarray], lines: _Lines) -> list[_Recording]:
    """The intervals of each recording, in the order of the file; one that has a line that is left
    out is two recordings.
    """
    name = "interval" if "interval" in columns else "time"
    values = columns[name]
    numbers = columns.get("recording", np.ones(values.size))
    found = []
    for each in dict.fromkeys(numbers):
        rows = np.flatnonzero(numbers == each)
        left_out = [k for k, row in enumerate(rows) if lines.numbers[row] in lines.left_out]
        parts = [part for part in np.split(rows, left_out) if part.size]
        kept = [part[lines.numbers[part[0]] in lines.left_out :] for part in parts]
        usable = [_recording(name, values, part, lines, int(each)) for part in kept]
        long = [one for one in usable if one.intervals.size > 1]
        if not long:
            which = f"recording {each:g} has" if "recording" in columns else "there are"
            raise ModelError(
                f"{which} fewer than two intervals, which the impact between them needs"
            )
        found += long
    return found


def _recording(
    name: str, values: np.ndarray, rows: np.ndarray, lines: _Lines, number: int
) -> _Recording:
    """The intervals of rows of the file.

    Raises
    ------
    ModelError
        If an interval is longer than the one before it, as no flight after an impact is.
    """
    part = values[rows]
    of_time = name == "time"
    intervals = np.diff(part) if of_time else part
    ends = [lines.numbers[row] for row in (rows[1:] if of_time else rows)]
    for k in range(1, intervals.size):
        if intervals[k] > intervals[k - 1]:
            raise ParameterError(
                f"line {ends[k]}, recording {number}: {intervals[k]:g} s after "
                f"{intervals[k - 1]:g} s, where each bounce is shorter than the one before: "
                "correct the line, or leave it out by {leave_out}"
            )
    return _Recording(intervals, ends, number)


def _experiment(
    name: str,
    texts: dict[str, str],
    numbers: dict[str, float],
    columns: dict[str, np.ndarray],
    lines: _Lines,
) -> Experiment:
    mass = numbers.get("mass")
    diameter = numbers.get("diameter")
    length = math.inf
    if mass is not None and diameter is not None:
        length = drag_length(mass, diameter)
    found: Heard | None = None
    bias = 0.0
    if "interval" not in columns and "time" not in columns:
        kept = np.array([line not in lines.left_out for line in lines.numbers])
        columns = {key: values[kept] for key, values in columns.items()}
    if "speed" in columns:
        speeds = columns["speed"]
        restitutions = columns["restitution"]
        errors = columns.get("uncertainty")
    elif "drop_height" in columns:
        heights = columns["drop_height"], columns["rebound_height"]
        speeds, back = drop_speeds(*heights, length)
        restitutions = back / speeds
        errors = columns.get("uncertainty")
        without, back = drop_speeds(*heights)
        bias = float(np.max(np.abs(restitutions - back / without)))
    else:
        found = together(
            [
                heard(
                    recording.intervals,
                    resolution=numbers.get("resolution"),
                    length=length,
                    contact_time=numbers.get("contact time", 0.0),
                )
                for recording in _recordings(columns, lines)
            ]
        )
        speeds = found.speeds
        restitutions = found.restitutions
        errors = found.covariance
        bias = float(np.max(np.abs(found.drag_bias)))
    is_without_drag = math.isfinite(length) and "speed" not in columns
    is_of_heights = errors is None and "speed" not in columns
    return Experiment(
        name=name,
        texts=texts,
        speeds=speeds,
        restitutions=restitutions,
        uncertainties=errors,
        relative_errors=by_height(speeds, restitutions) if is_of_heights else None,
        durations=columns.get("duration", numbers.get("contact time")),
        duration_uncertainties=columns.get(
            "duration_uncertainty", numbers.get("contact time uncertainty")
        ),
        mass=mass,
        diameter=diameter,
        drag_bias=bias if is_without_drag else 0.0,
        is_without_drag=is_without_drag,
        is_of_flights="speed" not in columns,
        left_out=lines.left_out,
        heard=found,
    )
