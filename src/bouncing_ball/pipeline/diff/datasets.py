"""The comparison of two datasets, variable by variable.

Parameters come first. If the two datasets were made from other parameters, this is what the
comparison says, and differences of the numbers are secondary: they have no share of a budget.
Otherwise the structure must be the same, and each variable has a drift at each of its entries,
which is compared with the budget of the variable (:mod:`bouncing_ball.pipeline.diff.budgets`).

A drift is dimensionless: a difference divided by a scale. The drift between two NaN, or between
two infinities of the same sign, is zero; the drift between a finite value and one that is not
finite is infinite. Texts, counts and truth values have not drifted if they are equal, and have an
infinite drift if they are not.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from bouncing_ball.pipeline.diff.budgets import IGNORED, Budget, budget_of
from bouncing_ball.pipeline.diff.cause import parameter_changes
from bouncing_ball.pipeline.diff.outcome import ComparedItem, Outcome
from bouncing_ball.pipeline.provenance import TEXTUAL, parameters_of

# Number of samples by which a point may slide along a curve.
_REACH = 2


def span(values: ArrayLike) -> float:
    """The scale of a variable: max - min over its finite values.

    The scale of a constant is its magnitude, or 1 if the constant is 0. The scale is not the value
    of a single entry, because that would be tiny next to a zero of the variable.

    Examples
    --------
    >>> span([-1.0, 3.0, np.nan]), span([5.0, 5.0]), span([0.0])
    (4.0, 5.0, 1.0)
    """
    values = np.asarray(values, dtype=float)
    finite = values[np.isfinite(values)]
    if not finite.size:
        return 1.0
    return float(np.ptp(finite)) or float(np.max(np.abs(finite))) or 1.0


def same(record: ArrayLike, new: ArrayLike) -> np.ndarray:
    """Whether values are equal, entry by entry; NaN is equal to NaN.

    Examples
    --------
    >>> same([np.nan, 1.0, np.inf], [np.nan, 2.0, np.inf]).tolist()
    [True, False, True]
    """
    record = np.asarray(record)
    new = np.asarray(new)
    return (record == new) | ((record != record) & (new != new))


def pointwise(record: ArrayLike, new: ArrayLike, scale: ArrayLike) -> np.ndarray:
    """|new - record| / scale, element by element.

    Examples
    --------
    >>> pointwise([0.0, 1.0, np.nan], [0.5, 1.0, np.nan], 2.0).tolist()
    [0.25, 0.0, 0.0]
    >>> pointwise([1.0, 1.0], [np.nan, 2.0], [1.0, np.nan]).tolist()
    [inf, inf]
    """
    record = np.asarray(record, dtype=float)
    new = np.asarray(new, dtype=float)
    with np.errstate(invalid="ignore", divide="ignore"):
        distance = np.abs(new - record) / scale
    return np.where(same(record, new), 0.0, np.where(np.isnan(distance), np.inf, distance))


def _to_polyline(x, y, line_x, line_y) -> np.ndarray:
    """Distance of point k from the segments k - 1 - reach … k + reach of a polyline."""
    count = x.shape[-1]
    # The distance from the vertex itself, because a vertex between two gaps has no segment.
    nearest = np.hypot(x - line_x, y - line_y)
    if count == 1:
        return nearest
    for offset in range(-_REACH - 1, _REACH + 1):
        left = np.clip(np.arange(count) + offset, 0, count - 2)
        left_x = line_x[..., left]
        left_y = line_y[..., left]
        chord_x = line_x[..., left + 1] - left_x
        chord_y = line_y[..., left + 1] - left_y
        square = chord_x * chord_x + chord_y * chord_y
        along = ((x - left_x) * chord_x + (y - left_y) * chord_y) / np.where(
            square > 0, square, 1.0
        )
        along = np.clip(along, 0.0, 1.0)
        distance = np.hypot(x - left_x - along * chord_x, y - left_y - along * chord_y)
        # fmin, because a segment with an end that is not finite does not count.
        nearest = np.fmin(nearest, distance)
    return nearest


def curve_distance(x: ArrayLike, y: ArrayLike, new_x: ArrayLike, new_y: ArrayLike) -> np.ndarray:
    """Distance between two sampled curves, at each sample, along the last axis.

    All coordinates are divided by their scales. The result is the larger of two distances: of the
    new sample from the record's polyline, and of the record's sample from the new polyline. Samples
    that slide along the curve therefore cause at most the sagitta of a chord, and two curves within
    a distance ε of each other have a drift of at most ε.

    Parameters
    ----------
    x, y, new_x, new_y : array_like, shape (..., N)

    Examples
    --------
    A straight line whose inner sample is moved along the line, and then off the line:

    >>> curve_distance([0, 1, 2], [0, 0, 0], [0.0, 1.5, 2.0], [0, 0, 0]).tolist()
    [0.0, 0.0, 0.0]
    >>> curve_distance([0, 1, 2], [0, 0, 0], [0, 1, 2], [0.0, 0.25, 0.0]).max().item()
    0.25
    """
    x, y, new_x, new_y = (np.asarray(part, dtype=float) for part in (x, y, new_x, new_y))
    with np.errstate(invalid="ignore", over="ignore"):
        distance = np.maximum(_to_polyline(new_x, new_y, x, y), _to_polyline(x, y, new_x, new_y))
    finite = np.isfinite(x) & np.isfinite(y) & np.isfinite(new_x) & np.isfinite(new_y)
    alike = _alike(x, new_x) & _alike(y, new_y)
    return np.where(finite, distance, np.where(alike, 0.0, np.inf))


def _alike(record, new):
    """Whether both values are finite, both NaN, or both infinite with the same sign."""
    return (np.isfinite(record) & np.isfinite(new)) | same(record, new)


def _form(data: xr.Dataset, name: str) -> str | None:
    """Type and sizes of a variable, None if there is none; texts of all lengths have the same type.

    Examples
    --------
    >>> _form(xr.Dataset({"x": (("case", "n"), [[1, 2]])}), "x")
    'int64, case: 1, n: 2'
    """
    if name not in data.variables:
        return None
    variable = data[name]
    kind = "text" if variable.dtype.kind in "OSUT" else str(variable.dtype)
    sizes = [f"{dimension}: {size}" for dimension, size in variable.sizes.items()]
    role = " (coordinate)" if name in data.coords else ""
    return ", ".join([kind, *sizes]) + role


def _attribute_rows(
    name: str, record: Mapping[Any, Any], new: Mapping[Any, Any]
) -> list[ComparedItem]:
    """The attributes of a variable or a dataset that differ, such as units or a raised budget."""
    found = []
    for attribute in sorted(record.keys() | new.keys()):
        old_text, new_text = (
            repr(np.asarray(side[attribute]).tolist()) if attribute in side else None
            for side in (record, new)
        )
        if old_text != new_text:
            found.append(
                ComparedItem(f"{attribute} of {name}", Outcome.STRUCTURE, old_text, new_text)
            )
    return found


def word_rows(record: xr.Dataset, new: xr.Dataset) -> list[ComparedItem]:
    """A row for each text about a dataset that differs, such as its title and its references.

    Examples
    --------
    >>> record, new = (xr.Dataset(attrs={"title": title}) for title in ("Figure 1", "Figure 2"))
    >>> [(row.name, row.new) for row in word_rows(record, new)]
    [('title of the dataset', "'Figure 2'")]
    """
    old, now = ({name: data.attrs.get(name, "") for name in TEXTUAL} for data in (record, new))
    return _attribute_rows("the dataset", old, now)


def structure_rows(record: xr.Dataset, new: xr.Dataset) -> list[ComparedItem]:
    """A row for each variable of another type or size, and for each attribute that differs.

    The attributes of the dataset itself are compared elsewhere.

    Examples
    --------
    >>> record, new = (xr.Dataset({"x": ("t", values)}) for values in ([0.0], [0.0, 1.0]))
    >>> (row,) = structure_rows(record, new)
    >>> row.name, row.record, row.new
    ('x', 'float64, t: 1', 'float64, t: 2')
    """
    found = []
    for name in map(str, {**record.variables, **new.variables}):
        old_form = _form(record, name)
        new_form = _form(new, name)
        if old_form != new_form:
            found.append(ComparedItem(name, Outcome.STRUCTURE, old_form, new_form))
        if old_form is not None and new_form is not None:
            found += _attribute_rows(name, record[name].attrs, new[name].attrs)
    return found


def _broadcast_beside(data: xr.Dataset, name: str, other: str) -> np.ndarray:
    """Another variable of a dataset, broadcast to the shape of the first."""
    return data[other].broadcast_like(data[name]).transpose(*data[name].dims).values


def _curve_drift(name: str, record: xr.Dataset, new: xr.Dataset, over: str) -> np.ndarray:
    """Distance of two curves, sampled along ``point`` or another dimension of points, such as
    ``long_point``, in units of the scales of both axes.
    """
    (along,) = (dim for dim in record[name].dims if str(dim).endswith("point"))
    axis = record[name].dims.index(along)
    x = _broadcast_beside(record, name, over)
    new_x = _broadcast_beside(new, name, over)
    y = record[name].values
    new_y = new[name].values
    scaled = (x / span(x), y / span(y), new_x / span(x), new_y / span(y))
    distance = curve_distance(*(np.moveaxis(values, axis, -1) for values in scaled))
    return np.moveaxis(distance, -1, axis)


def drift_over_budget(name: str, record: xr.Dataset, new: xr.Dataset, budget: Budget) -> np.ndarray:
    """Drift of each entry of a variable over the budget; ∞ for a change where none is allowed.

    Parameters
    ----------
    name : str
        A variable of both datasets, of the same shape and type.
    record, new : Dataset
    budget : Budget
        For texts, counts and truth values only ``over`` has an effect.

    Raises
    ------
    KeyError, ValueError
        If the budget names a variable or a dimension that does not exist.

    Examples
    --------
    >>> record = xr.Dataset({"x": ("t", [0.0, 1.0, 2.0])})
    >>> drift_over_budget("x", record, record + 0.5, Budget(0.25)).tolist()
    [1.0, 1.0, 1.0]
    >>> drift_over_budget("x", record, record + 0.5, Budget(0.25, scale="1")).tolist()
    [2.0, 2.0, 2.0]
    """
    old = record[name]
    if budget.size == IGNORED:
        return np.zeros(old.shape)
    if budget.over:
        return _curve_drift(name, record, new, budget.over) / budget.size
    if old.dtype.kind != "f":
        return np.where(same(old.values, new[name].values), 0.0, np.inf)
    match budget.scale:
        case "":
            scale: ArrayLike = span(old)
        case "1":
            scale = 1.0
        case other:
            scale = _broadcast_beside(record, name, other)
    return pointwise(old.values, new[name].values, scale) / budget.size


def _place(variable: xr.DataArray, index: tuple[int, ...]) -> str:
    """Coordinates of an entry, or its indices where a dimension has none.

    Examples
    --------
    >>> _place(xr.DataArray([[1.0, 2.0]], {"t": [0.0, 0.5]}, ("case", "t")), (0, 1))
    'case = 0, t = 0.5'
    """
    return ", ".join(f"{name} = {text}" for name, text in _labels(variable, index).items())


def _labels(variable: xr.DataArray, index: tuple[int, ...]) -> dict[str, str]:
    """The coordinates of an entry as texts, by their names."""
    places = zip(variable.dims, index, strict=True)
    labels = {str(name): variable[name].values[k] for name, k in places}
    return {name: f"{x:.6g}" if isinstance(x, float) else str(x) for name, x in labels.items()}


def relative_change(record: float, new: float, scale: float) -> float:
    """(new - record) / |record|, or over the scale for a record below a thousandth of the scale.

    Examples
    --------
    >>> relative_change(2.0, 1.5, 10.0), relative_change(0.0, 0.5, 10.0)
    (-0.25, 0.05)
    """
    size = abs(record)
    return float((new - record) / (size if size > 1e-3 * scale else scale))


def _word_changes(old: xr.DataArray, now: xr.DataArray, unmoved: np.ndarray) -> tuple[str, ...]:
    """Each entry of a variable of words that changed: its place, and both contents.

    Examples
    --------
    >>> old, now = (xr.DataArray(words, {"t": [1, 2]}) for words in (["a", "b"], ["a", "c"]))
    >>> _word_changes(old, now, np.array([True, False]))
    ('2: b → c',)
    """
    is_axis = old.name in old.dims
    found = []
    for place in zip(*np.nonzero(~unmoved), strict=True):
        index = tuple(int(k) for k in place)
        # The labels of an axis are their own places.
        where = "" if is_axis else f"{', '.join(_labels(old, index).values())}: "
        contents = [str(side.values[index]) or "nothing" for side in (old, now)]
        found.append(where + " → ".join(contents))
    return tuple(found)


def _variable_row(artifact: str, name: str, record: xr.Dataset, new: xr.Dataset) -> ComparedItem:
    """The largest move of a variable over its budget, and the number of entries that moved."""
    old = record[name]
    now = new[name]
    unmoved = same(old.values, now.values)
    if unmoved.all():
        return ComparedItem(name, Outcome.IDENTICAL, entries=old.size)
    share = drift_over_budget(name, record, new, budget_of(artifact, name, now.attrs))
    # Among the entries that moved, because several may have the same share.
    order = np.where((share > 0) | ~unmoved, share, -1.0)
    place = tuple(int(k) for k in np.unravel_index(np.argmax(order), order.shape))
    beyond = int(np.count_nonzero(share > 1))
    change = 0.0
    changes: tuple[str, ...] = ()
    if old.dtype.kind in "fiu":
        change = relative_change(float(old.values[place]), float(now.values[place]), span(old))
    elif old.dtype.kind in "OSUT" and old.ndim:
        changes = _word_changes(old, now, unmoved)
    return ComparedItem(
        name,
        Outcome.DRIFTED if beyond else Outcome.WITHIN,
        record=str(old.values[place]),
        new=str(now.values[place]),
        share=float(share[place]),
        at=_place(old, place),
        moved=int(np.count_nonzero(~unmoved)),
        beyond=beyond,
        entries=old.size,
        title=str(old.attrs.get("long_name", name)),
        change=change,
        changes=changes,
    )


def _secondary(row: ComparedItem) -> ComparedItem:
    """A row of two datasets with other parameters: the difference has no share of a budget."""
    if row.outcome is Outcome.IDENTICAL:
        return row
    return replace(row, outcome=Outcome.PARAMETERS, share=0.0, beyond=0)


def compare_datasets(artifact: str, record: xr.Dataset, new: xr.Dataset) -> list[ComparedItem]:
    """A row for each parameter and each part of the structure that differs, and for each variable.

    Examples
    --------
    >>> budget = {"budget": 1e-12, "scale": "1"}
    >>> record = xr.Dataset({"residual": ("point", [0.0, 1.0], budget)}, attrs={"n": 1})
    >>> new = record.copy(data={"residual": [2.0**-41, 1.0]})
    >>> (row,) = compare_datasets("fig", record, new)
    >>> row.name, str(row.outcome), round(row.share, 3)
    ('residual', 'within budget', 0.455)
    >>> for row in compare_datasets("fig", record, new.assign_attrs(n=2)):
    ...     print(f"{row.name}: {row.outcome}, {row.record} → {row.new}")
    parameter n: changed parameters, 1 → 2
    residual: changed parameters, 0.0 → 4.547473508864641e-13
    """
    changes = parameter_changes(parameters_of(record.attrs), parameters_of(new.attrs))
    parameters = [
        ComparedItem(f"parameter {change.name}", Outcome.PARAMETERS, change.record, change.new)
        for change in changes
    ]
    structure = structure_rows(record, new)
    variables = [
        _variable_row(artifact, name, record, new)
        for name in map(str, record.variables)
        if _form(record, name) == _form(new, name)
    ]
    if changes:
        variables = [_secondary(row) for row in variables]
    return parameters + structure + variables
