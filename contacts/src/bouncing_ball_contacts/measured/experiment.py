r"""A text file of measured impacts, and the experiments that belong to the package.

A file has lines ``# key: value`` with the source and the ball, one line with the names and units of
the columns, and one line of numbers for each impact ::

    # mass: 9.6 g
    drop_height [m],rebound_height [m]
    0.10,0.015

The columns (:mod:`bouncing_ball_contacts.measured.columns`) are the speeds of the impacts with
their restitution coefficients or with the speeds of the rebounds, or the heights of drops and
rebounds, or the intervals between the impacts of one bouncing ball or their times; a column
``recording`` numbers the recordings if there are several. ``uncertainty``, of the restitution
coefficient, ``duration`` and ``duration_uncertainty`` may follow speeds or heights. If the mass and
the diameter of the ball are known, the drag of the air is removed from heights and intervals
(:mod:`bouncing_ball_contacts.measured.flights`). The files of the package are in SI units. Other
lines that begin with ``#`` are comments.

Where a file has no uncertainties their size follows from the scatter of the points. Errors of
restitution coefficients that stand in the file are then taken as equal. Those that follow from
heights or intervals are not: the same error of all heights, of a reading or of an uneven floor, is
an error of e that falls as 1/v² (:func:`bouncing_ball_contacts.measured.flights.by_height`).
"""

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.errors import ModelError, ParameterError, did_you_mean
from bouncing_ball_contacts.contact.units import STANDARD_GRAVITY, SIParameter, in_si
from bouncing_ball_contacts.measured.columns import (
    HIGHEST,
    Columns,
    read_columns,
    without_si_unit,
)
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
# Relative differences of equal intervals by the rounding of times of six digits.
_EQUAL = 1e-5


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
    notes : tuple of str
        What of the file was not read.
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
    notes: tuple[str, ...] = ()

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
    columns = read_columns(str(path), rows, intervals=intervals, leave_out=leave_out)
    numbers = {key: value for key, value in head.items() if key in QUANTITIES}
    for name, value in options.items():
        if value is not None:
            key = name.replace("_", " ")
            numbers[key] = in_si(name, value, QUANTITIES[key])
    _require_their_use(path, numbers, columns)
    texts = {key: value for key, value in head.items() if key in TEXTS}
    try:
        return _experiment(path.stem, texts, numbers, columns)
    except ParameterError as error:
        text, *values = error.args
        raise ParameterError(f"{path}: {text}", *values) from None
    except ModelError as error:
        raise ModelError(f"{path}: {error}") from None


def _require_their_use(path: Path, numbers: dict[str, float], columns: Columns) -> None:
    """Refuse numbers that change nothing, because another column or number is missing."""
    if "resolution" in numbers and not columns.is_heard:
        raise ModelError(f"{path}: a resolution needs intervals or times")
    is_timed = "contact time" in numbers or "duration" in columns.values
    if "contact time uncertainty" in numbers and not is_timed:
        raise ModelError(f"{path}: the uncertainty of a contact time needs the contact time")


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
        key = key.casefold()
        if not colon:
            continue
        if key in QUANTITIES:
            head[key] = _quantity(path, at, key, value, QUANTITIES[key])
        elif key in TEXTS:
            head[key] = f"{head[key]} {value}" if key in head else value
        elif meant := did_you_mean(key, QUANTITIES):
            # A misspelt mass would be read as a comment, and the drag would stay.
            raise ModelError(f"{path}, line {at}: unknown key {key!r}{meant}")
    return head, rows


def _quantity(path: Path, at: int, name: str, value: str, kind: SIParameter) -> float:
    try:
        return in_si(name, without_si_unit(value, kind), kind)
    except ParameterError as error:
        raise ModelError(f"{path}, line {at}: {error}") from None


class _Recording(NamedTuple):
    """Successive intervals, the lines of their ends, and the number of the recording."""

    intervals: np.ndarray
    lines: list[int]
    number: int


def _recordings(columns: Columns) -> list[_Recording]:
    """The intervals of each recording, in the order of the file; one that has a line that is left
    out is two recordings.
    """
    name = "interval" if "interval" in columns.values else "time"
    values = columns.values[name]
    numbers = columns.values.get("recording", np.ones(values.size))
    is_left_out = np.isin(columns.lines, columns.left_out)
    found = []
    for each in dict.fromkeys(numbers):
        rows = np.flatnonzero(numbers == each)
        parts = [part for part in np.split(rows, np.flatnonzero(is_left_out[rows])) if part.size]
        kept = [part[int(is_left_out[part[0]]) :] for part in parts]
        usable = [_recording(name, values, part, columns.lines, int(each)) for part in kept]
        long = [one for one in usable if one.intervals.size > 1]
        if not long:
            which = f"recording {each:g} has" if "recording" in columns.values else "there are"
            raise ModelError(
                f"{which} fewer than two intervals, which the impact between them needs"
            )
        found += long
    return found


def _recording(
    name: str, values: np.ndarray, rows: np.ndarray, lines: list[int], number: int
) -> _Recording:
    """The intervals of rows of the file.

    Raises
    ------
    ModelError
        If a flight is higher than a wrong unit explains, an interval is longer than the one before
        it, as no flight after an impact is, or times are equally spaced.
    """
    part = values[rows]
    of_time = name == "time"
    intervals = np.diff(part) if of_time else part
    ends = [lines[row] for row in (rows[1:] if of_time else rows)]
    for end, interval in zip(ends, intervals, strict=True):
        height = STANDARD_GRAVITY * interval**2 / 8
        if height > HIGHEST:
            raise ParameterError(
                f"line {end}: a flight of {interval:g} s is {height:.0f} m high: are these ms? "
                f"write the unit in the heading: '{name} (ms)', or leave the line out by "
                "{leave_out}"
            )
    if of_time and intervals.size > 1 and np.allclose(intervals, intervals[0], rtol=_EQUAL, atol=0):
        raise ModelError("the times are equally spaced, as those of a film and not of impacts")
    for k in range(1, intervals.size):
        if intervals[k] > intervals[k - 1]:
            raise ParameterError(
                f"line {ends[k]}, recording {number}: {intervals[k]:g} s after "
                f"{intervals[k - 1]:g} s, where each bounce is shorter than the one before: "
                "correct the line, or leave it out by {leave_out}"
            )
    return _Recording(intervals, ends, number)


def _experiment(
    name: str, texts: dict[str, str], numbers: dict[str, float], table: Columns
) -> Experiment:
    mass = numbers.get("mass")
    diameter = numbers.get("diameter")
    length = math.inf
    if mass is not None and diameter is not None:
        length = drag_length(mass, diameter)
    found: Heard | None = None
    bias = 0.0
    columns = table.values
    if not table.is_heard:
        kept = ~np.isin(table.lines, table.left_out)
        columns = {key: values[kept] for key, values in columns.items()}
    if "speed" in columns:
        speeds = columns["speed"]
        rebounds = columns.get("rebound_speed")
        restitutions = columns["restitution"] if rebounds is None else rebounds / speeds
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
                for recording in _recordings(table)
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
        left_out=table.left_out,
        notes=table.notes,
        heard=found,
    )
