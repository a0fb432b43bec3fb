"""The types and ranges of the arguments of calls, and their check.

A number may be given as an array: a list or a numpy array is an axis named after its argument, and
a :class:`xarray.DataArray` keeps its axis.
"""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any, Literal, Union

import numpy as np

from bouncing_ball_beyond.inherited.errors import (
    AMPLITUDE,
    DAMPING_RATIO,
    FAMILY,
    FREQUENCY_RATIO,
    RESTITUTION,
    RIGID_RESTITUTION,
    ParameterError,
    Range,
    count,
    shortened,
)

if TYPE_CHECKING:
    from xarray import DataArray

# The class of xarray is named in quotes, because a single orbit does not need xarray.
Axis = Union[float, Sequence[float], np.ndarray, "DataArray"]
"""A number, or an array of numbers, which is an axis of the result."""

WholeAxis = Union[int, Sequence[int], np.ndarray, "DataArray"]
"""A whole number, or an array of whole numbers, which is an axis of the result."""

AMPLITUDE_OF_ORBIT = AMPLITUDE._replace(or_zero=False)
TOLERANCE = Range(0, 1)
# Heights, speeds and durations, and phases and velocities: their squares keep digits beside Λ.
POSITIVE = Range(1e-12, 1e8, "[]")
START = Range(-1e8, 1e8, "[]")
# An impact takes a third of a millisecond, so that the largest number takes half a minute.
IMPACTS = count(100_000)
PERIODS = Range(0, 10_000, "(]")
SAMPLES = count(100_000)
POINTS = count(10_000, low=10)

FrequencyRatioAxis = Annotated[Axis, FREQUENCY_RATIO]
AmplitudeAxis = Annotated[Axis, AMPLITUDE]
AmplitudeOfOrbitAxis = Annotated[Axis, AMPLITUDE_OF_ORBIT]
RestitutionAxis = Annotated[Axis, RESTITUTION]
RigidRestitutionAxis = Annotated[Axis, RIGID_RESTITUTION]
DampingRatioAxis = Annotated[Axis, DAMPING_RATIO]
ToleranceAxis = Annotated[Axis, TOLERANCE]
PositiveAxis = Annotated[Axis, POSITIVE]
StartAxis = Annotated[Axis, START]
FamilyAxis = Annotated[WholeAxis, FAMILY]
Amplitude = Annotated[float, AMPLITUDE]
AmplitudeOfOrbit = Annotated[float, AMPLITUDE_OF_ORBIT]
Positive = Annotated[float, POSITIVE]
Impacts = Annotated[int, IMPACTS]
Periods = Annotated[float, PERIODS]
SampleCount = Annotated[int, SAMPLES]
Points = Annotated[int, POINTS]
ReleaseName = Literal["displacement", "force"]
SideName = Literal["stable", "unstable"]


MOST_STATES = 10_000_000
"""Largest number of states, orbits or points in a result. One takes 50 to 300 bytes while it is
computed, so that they take three gigabytes at most."""


def require_memory(number: int, of: str, fewer: str, limit: int = MOST_STATES) -> None:
    """Raise :class:`ParameterError` if a result of this many parts would fill the memory.

    Examples
    --------
    >>> require_memory(10**9, "balls", "starts")
    Traceback (most recent call last):
    bouncing_ball_beyond.inherited.errors.ParameterError: 1000000000 balls exceed the limit of \
10000000: use fewer \
starts
    """
    if number > limit:
        raise ParameterError(f"{number} {of} exceed the limit of {limit}: use fewer {fewer}")


def is_array(value: Any) -> bool:
    """Whether an argument spans an axis.

    Examples
    --------
    >>> is_array([1.0]), is_array(np.float64(1.0))
    (True, False)
    """
    # The lengths of the rows of a list are examined later; a number has no axes, and what is no
    # number, such as a dataset, has no number of them.
    if isinstance(value, list | tuple):
        return True
    dimensions = getattr(value, "ndim", 0)
    return isinstance(dimensions, int) and dimensions > 0


def checked(name: str, value: Any, allowed: Range) -> Any:
    """The value of an argument, a Python number or an array, whose entries are all in the range.

    A list becomes a numpy array; a :class:`xarray.DataArray` is unchanged.

    Raises
    ------
    ParameterError
        If the value is missing, of another type or shape, or outside the range.

    Examples
    --------
    >>> checked("restitution", [0.5, 1], RESTITUTION).tolist(), checked("n", np.int64(2), FAMILY)
    ([0.5, 1.0], 2)
    >>> checked("restitution", "x", RESTITUTION)
    Traceback (most recent call last):
    bouncing_ball_beyond.inherited.errors.ParameterError: restitution = 'x' is not a number in \
(0, 1]
    >>> checked("n", True, FAMILY)
    Traceback (most recent call last):
    bouncing_ball_beyond.inherited.errors.ParameterError: n = True is not a whole number from 1 \
to 1000
    """
    if value is None:
        raise ParameterError(f"{{{name}}} is missing")
    if isinstance(value, list | tuple):
        return _checked_list(name, value, allowed)
    if isinstance(value, np.ma.MaskedArray):
        raise ParameterError(f"{{{name}}} is a masked array: give its numbers, {name}.filled(…)")
    # Of an xarray.DataArray or a column of a table.
    inside = getattr(value, "values", None)
    values = inside if isinstance(inside, np.ndarray) else value
    if isinstance(values, np.ndarray) and values.ndim:
        if values.dtype.kind in "iuf":
            # In less than double precision the ranges, and the results, would be rounded.
            wide = np.result_type(values.dtype, np.int64 if values.dtype.kind in "iu" else float)
            value = value.astype(wide, copy=False)
            values = values.astype(wide, copy=False)
        _check_array(name, values, allowed, named=hasattr(value, "dims"))
        return value
    number = _plain(values)
    _check_number(name, number, allowed)
    return int(number) if allowed.whole else float(number)


def checked_number(name: str, value: Any, allowed: Range) -> Any:
    """The value of an argument that must be a single number in the range.

    Raises
    ------
    ParameterError
        If the value is missing, no single number, or outside the range.
    """
    if is_array(value):
        raise ParameterError(f"{{{name}}} must be a single number")
    return checked(name, value, allowed)


def _checked_list(name: str, value: Sequence, allowed: Range) -> np.ndarray:
    if not value:
        raise ParameterError(f"{{{name}}} has no entries")
    for entry in value:
        if isinstance(entry, list | tuple):
            axes = "several axes without names: give an xarray.DataArray"
            raise ParameterError(f"{{{name}}} has {axes}")
        _check_number(name, _plain(entry), allowed)
    return np.array(value, dtype=int if allowed.whole else float)


def _plain(value: Any) -> Any:
    """A number of numpy as one of Python; a date or a time of numpy, which is none, as it is.

    Examples
    --------
    >>> _plain(np.float32(0.5)), _plain(np.timedelta64(5, "ns"))
    (0.5, np.timedelta64(5,'ns'))
    """
    is_number = isinstance(value, np.ndarray | np.generic) and value.dtype.kind not in "mM"
    return value.item() if is_number else value


def _check_array(name: str, values: np.ndarray, allowed: Range, named: bool) -> None:
    if values.ndim > 1 and not named:
        axes = f"{values.ndim} axes without names: give an xarray.DataArray"
        raise ParameterError(f"{{{name}}} has {axes}")
    if not values.size:
        raise ParameterError(f"{{{name}}} has no entries")
    outside = values[~_within(values, allowed)] if values.dtype.kind in "iuf" else values
    for entry in outside.ravel():
        _check_number(name, _plain(entry), allowed)


def _within(values: np.ndarray, allowed: Range) -> np.ndarray:
    """Which numbers of an array are in the range, without a loop over them."""
    above = values > allowed.low if allowed.ends[0] == "(" else values >= allowed.low
    below = values < allowed.high if allowed.ends[1] == ")" else values <= allowed.high
    whole = values == np.floor(values) if allowed.whole else True
    inside = above & below & whole & np.isfinite(values)
    return inside | (values == 0) if allowed.or_zero else inside


def _check_number(name: str, value: Any, allowed: Range) -> None:
    # To Python, True is the number 1.
    if isinstance(value, bool) or value not in allowed:
        raise ParameterError(f"{{{name}}} = {{}} is not {allowed}", shortened(value))


def chosen(name: str, value: Any, allowed: Mapping[str, Any] | Sequence[str]) -> str:
    """The value of an argument that must be one of the names allowed.

    Raises
    ------
    ParameterError
        If it is none of them.

    Examples
    --------
    >>> chosen("side", "up", ("stable", "unstable"))
    Traceback (most recent call last):
    bouncing_ball_beyond.inherited.errors.ParameterError: side = 'up' is not one of stable, unstable
    """
    if not isinstance(value, str) or value not in allowed:
        words = ", ".join(allowed)
        raise ParameterError(f"{{{name}}} = {{}} is not one of {words}", shortened(value))
    return str(value)
