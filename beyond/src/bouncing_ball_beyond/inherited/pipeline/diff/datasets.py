"""The comparison of two datasets, variable by variable, each within its budget.

A study declares the budget of a variable beside the variable itself
(:mod:`bouncing_ball_beyond.inherited.datasets.variables`), and it stands in the attributes of the
dataset. The drift of a number is |new - record| over the range of the record's values, or over
another scale; it may be as large as the budget. The drift between two NaN, or between two
infinities of the same sign, is zero; between a finite value and one that is not finite it is
infinite. Texts, counts and truth values have not drifted if they are equal, and have an infinite
drift if they are not.

If the two datasets were made from other parameters, this is what the comparison says, and
differences of the numbers are secondary: they have no share of a budget.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.datasets.variables import IGNORED, ROUNDING, Budget
from bouncing_ball_beyond.inherited.pipeline.diff.outcome import Outcome, Row
from bouncing_ball_beyond.inherited.pipeline.diff.texts import excerpt, some
from bouncing_ball_beyond.inherited.pipeline.provenance import TEXTUAL, parameters_of

# Number of samples by which a point may slide along a curve.
_REACH = 2
# A number below this part of the range of its variable is compared with this range.
_TINY = 1e-3


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
    return float(np.ptp(finite) or np.max(np.abs(finite)) or 1.0)


def same(record: ArrayLike, new: ArrayLike) -> np.ndarray:
    """Whether values are equal, entry by entry; NaN is equal to NaN.

    Examples
    --------
    >>> same([np.nan, 1.0, np.inf], [np.nan, 2.0, np.inf]).tolist()
    [True, False, True]
    """
    is_missing = np.not_equal(record, record) & np.not_equal(new, new)
    return np.equal(record, new) | is_missing


def pointwise(record: ArrayLike, new: ArrayLike, scale: ArrayLike) -> np.ndarray:
    """|new - record| / scale, element by element.

    Examples
    --------
    >>> pointwise([0.0, 1.0, np.nan], [0.5, 1.0, np.nan], 2.0).tolist()
    [0.25, 0.0, 0.0]
    >>> pointwise([1.0, 1.0], [np.nan, 2.0], [1.0, np.nan]).tolist()
    [inf, inf]
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        distance = np.abs(np.subtract(new, record)) / scale
    return np.where(same(record, new), 0.0, np.where(np.isnan(distance), np.inf, distance))


def to_segments(points: np.ndarray, line: np.ndarray, left: np.ndarray) -> np.ndarray:
    """Distance of points x + iy from segments of a line.

    Parameters
    ----------
    points : ndarray of complex, shape (..., N)
    line : ndarray of complex, shape (..., M)
    left : ndarray of int, shape (N or 1, K)
        For each point the segments that are looked at, by their left ends.

    Examples
    --------
    >>> to_segments(np.array([1 + 1j, 5]), np.array([0, 2 + 0j]), np.array([[0]])).tolist()
    [1.0, 3.0]
    """
    start = line[..., left]
    chord = line[..., left + 1] - start
    away = points[..., None] - start
    square = np.abs(chord) ** 2
    along = np.clip((away * chord.conj()).real / np.where(square > 0, square, 1.0), 0.0, 1.0)
    # fmin, because a segment with an end that is not finite does not count.
    return np.fmin.reduce(np.abs(away - along * chord), axis=-1)


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
    with np.errstate(invalid="ignore"):
        old = x + 1j * y
        now = new_x + 1j * new_y
    count = old.shape[-1]
    reach = np.arange(-_REACH - 1, _REACH + 1)
    left = np.clip(np.arange(count)[:, None] + reach, 0, max(count - 2, 0))
    with np.errstate(invalid="ignore", over="ignore"):
        # The distance from the vertex itself, because a vertex between two gaps has no segment.
        distance = np.abs(now - old)
        if count > 1:
            ways = (to_segments(now, old, left), to_segments(old, now, left))
            distance = np.maximum(*(np.fmin(distance, way) for way in ways))
    finite = [np.isfinite(part) for part in (x, y, new_x, new_y)]
    alike = ((finite[0] & finite[2]) | same(x, new_x)) & ((finite[1] & finite[3]) | same(y, new_y))
    return np.where(np.all(finite, axis=0), distance, np.where(alike, 0.0, np.inf))


def budget_of(attributes: Mapping[Any, Any]) -> Budget:
    """The budget in the attributes of a variable; rounding if it declares none.

    Examples
    --------
    >>> budget_of({"budget": 1e-8, "scale": "1"}), budget_of({}).size
    (Budget(size=1e-08, scale='1', over=''), 1e-13)
    """
    return Budget(
        size=float(attributes.get("budget", ROUNDING)),
        scale=str(attributes.get("scale", "")),
        over=str(attributes.get("over", "")),
    )


def _beside(data: xr.Dataset, name: str, other: str) -> np.ndarray:
    """Another variable of a dataset, broadcast to the shape of the first."""
    return data[other].broadcast_like(data[name]).transpose(*data[name].dims).values


def _curve_drift(name: str, record: xr.Dataset, new: xr.Dataset, over: str) -> np.ndarray:
    """Distance of two curves, sampled along ``point``, in units of the scales of both axes."""
    axis = record[name].dims.index("point")
    x = _beside(record, name, over)
    y = record[name].values
    scaled = (x / span(x), y / span(y))
    scaled += (_beside(new, name, over) / span(x), new[name].values / span(y))
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
    scale: ArrayLike = span(old) if budget.scale == "" else 1.0
    if budget.scale not in ("", "1"):
        scale = _beside(record, name, budget.scale)
    return pointwise(old.values, new[name].values, scale) / budget.size


def _form(data: xr.Dataset, name: str) -> str:
    """Type and sizes of a variable, empty without one; texts of all lengths have the same type.

    Examples
    --------
    >>> _form(xr.Dataset({"x": (("case", "n"), [[1, 2]])}), "x")
    'int64, case: 1, n: 2'
    """
    if name not in data.variables:
        return ""
    kind = "text" if data[name].dtype.kind in "OSUT" else str(data[name].dtype)
    sizes = [f"{dimension}: {size}" for dimension, size in data[name].sizes.items()]
    return ", ".join([kind, *sizes]) + (" (coordinate)" if name in data.coords else "")


def _labels(name: str, record: xr.Dataset, new: xr.Dataset) -> str:
    """The labels that only one of two coordinates has.

    Examples
    --------
    >>> record, new = (xr.Dataset(coords={"claim": x}) for x in (["law", "map"], ["law", "fold"]))
    >>> _labels("claim", record, new)
    '; new: fold; gone: map'
    """
    if not all(name in data.dims and data[name].dtype.kind in "OSUT" for data in (record, new)):
        return ""
    old, now = (data[name].values.tolist() for data in (record, new))
    added = [label for label in now if label not in old]
    lost = [label for label in old if label not in now]
    named = {"new": added, "gone": lost}
    return "".join(f"; {word}: {some(labels)}" for word, labels in named.items() if labels)


def attribute_rows(
    both: Sequence[Mapping[Any, Any]], outcome: Outcome, about: str = ""
) -> list[Row]:
    """The attributes that differ in the record and in the new file, such as parameters or units.

    Examples
    --------
    >>> rows = attribute_rows([{"n": 1, "r__min": 0.85}, {"n": "1"}], Outcome.PARAMETERS)
    >>> [row.told for row in rows]
    ["n 1 → '1'", 'r.min 0.85 → nothing']
    """
    found = []
    for name in sorted({**both[0], **both[1]}):
        values = [np.asarray(side[name]).tolist() if name in side else None for side in both]
        if repr(values[0]) != repr(values[1]):
            # A number and its text have quotation marks to tell them apart.
            shown = str if str(values[0]) != str(values[1]) else repr
            old, now = (None if value is None else shown(value) for value in values)
            told = f"{name.replace('__', '.')}{about} {excerpt(old, now)}"
            found.append(Row(name, outcome, told))
    return found


def _place(variable: xr.DataArray, index: Sequence[int]) -> str:
    """Coordinates of an entry, or its indices where a dimension has none; a coordinate has no place
    along itself.

    Examples
    --------
    >>> _place(xr.DataArray([[1.0, 2.0]], {"t": [0.0, 0.5]}, ("case", "t")), (0, 1))
    ' at case = 0, t = 0.5'
    """
    places = zip(variable.dims, index, strict=True)
    others = [(name, k) for name, k in places if name != variable.name]
    labels = [(name, variable[name].values[k]) for name, k in others]
    named = [f"{name} = {f'{x:.6g}' if isinstance(x, float) else x}" for name, x in labels]
    return f" at {', '.join(named)}" if named else ""


def _told(record: Any, new: Any) -> str:
    """Two entries; of numbers six digits, unless it takes more to tell them apart.

    Examples
    --------
    >>> _told(0.8403156852330397, 0.8395002457896041), _told(0.1, 0.1 + 2**-50), _told("", "one")
    ('0.840316 → 0.8395', '0.1 → 0.1000000000000009', 'nothing → one')
    """
    texts = [f"{x:.6g}" if isinstance(x, float) else str(x) for x in (record, new)]
    if texts[0] == texts[1]:
        texts = [str(record), str(new)]
    return " → ".join(text or "nothing" for text in texts)


def _variable_rows(name: str, record: xr.Dataset, new: xr.Dataset) -> list[Row]:
    """The entry of a variable that moved most over its budget, and of words all that changed."""
    old = record[name]
    now = new[name]
    moved = ~same(old.values, now.values)
    if not moved.any():
        return [Row(name, Outcome.IDENTICAL)]
    # The budget that the record declares; a first one may come with the new dataset.
    budget = budget_of(old.attrs if "budget" in old.attrs else now.attrs)
    share = drift_over_budget(name, record, new, budget)
    # Among the entries that moved, because several may have the same share.
    largest = np.argmax(np.where((share > 0) | moved, share, -1.0))
    is_words = old.dtype.kind in "OSUT"
    places = np.argwhere(moved) if is_words else [np.unravel_index(largest, share.shape)]
    beyond = f"{np.count_nonzero(share > 1)} beyond the budget"
    count = f"; {np.count_nonzero(moved)} of {old.size} entries moved, {beyond}"
    found = []
    for place in (tuple(map(int, each)) for each in places):
        entries = (old.values[place], now.values[place])
        size = math.inf
        title = name if is_words else old.attrs.get("long_name", name)
        if old.dtype.kind in "fiu":
            before, after = map(float, entries)
            # A number below a thousandth of the range is compared with this range. Of a defect
            # this would be noise: it is as large as it exceeds its budget.
            whole = abs(before) if abs(before) > _TINY * span(old) else span(old)
            change = (after - before) / whole
            if budget.scale:
                size = float(share[place])
            elif math.isfinite(change):
                size = abs(change)
                title = f"{100 * change:+.2g} % in {title}"
        told = f"{title}{_place(old, place)}: {_told(*entries)}"
        outcome = Outcome.DRIFTED if share[place] > 1 else Outcome.ROUNDING
        told += count if old.size > 1 and not is_words else ""
        found.append(Row(name, outcome, told, size, float(share[place]), is_words))
    return found


def compare_datasets(record: xr.Dataset, new: xr.Dataset) -> list[Row]:
    """A row for each parameter and each part of the structure that differs, and for each variable.

    Examples
    --------
    >>> budget = {"budget": 1e-12, "scale": "1"}
    >>> record = xr.Dataset({"residual": ("point", [0.0, 1.0], budget)}, attrs={"n": 1})
    >>> new = record.copy(data={"residual": [2.0**-41, 1.0]})
    >>> (row,) = compare_datasets(record, new)
    >>> row.name, str(row.outcome), round(row.share, 3)
    ('residual', 'rounding', 0.455)
    >>> for row in compare_datasets(record, new.assign_attrs(n=2)):
    ...     print(f"{row.outcome}: {row.told}")
    changed parameters: n 1 → 2
    changed parameters: residual at point = 0: 0 → 4.54747e-13; \
1 of 2 entries moved, 0 beyond the budget
    """
    both = (record, new)
    rows = attribute_rows([parameters_of(data.attrs) for data in both], Outcome.PARAMETERS)
    is_other = bool(rows)
    words = [{word: data.attrs.get(word, "") for word in TEXTUAL} for data in both]
    rows += attribute_rows(words, Outcome.STRUCTURE, " of the dataset")
    for name in map(str, {**record.variables, **new.variables}):
        forms = [_form(data, name) for data in both]
        if all(forms):
            attributes = [data[name].attrs for data in both]
            rows += attribute_rows(attributes, Outcome.STRUCTURE, f" of {name}")
        if forms[0] != forms[1]:
            told = f"{name}: {' → '.join(form or 'nothing' for form in forms)}"
            labels = _labels(name, record, new)
            rows.append(Row(name, Outcome.STRUCTURE, told + labels, is_words=bool(labels)))
            continue
        for row in _variable_rows(name, record, new):
            is_secondary = is_other and row.outcome is not Outcome.IDENTICAL
            outcome = Outcome.PARAMETERS if is_secondary else row.outcome
            rows.append(replace(row, outcome=outcome, share=0.0 if is_secondary else row.share))
    return rows
