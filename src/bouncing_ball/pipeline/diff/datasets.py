"""The change of a variable from the accepted record that the comparison allows: its budget.

A drift is |new - record| divided by the range of the record's values, or by ``scale``. Texts,
counts and truth values are compared exactly. The budget of a variable is in its row of
:mod:`bouncing_ball.datasets.variables`; budgets of single artifacts are in ``budgets.csv``, each
with its source. A budget without another source comes from the convergence study, a test that
varies tolerances, grids and rounding: it is the next power of ten above ten times the largest
change.

Drifts of numbers: pure functions of arrays.

A drift is dimensionless: a difference divided by a scale. The drift between two NaN, or between
two infinities of the same sign, is zero; the drift between a finite value and one that is not
finite is infinite.

The comparison of two datasets, variable by variable: structure first, then numbers.
"""

import csv
import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from bouncing_ball.errors import printable
from bouncing_ball.pipeline.diff.outcome import Outcome, Row
from bouncing_ball.pipeline.diff.texts import compare_texts


class Budget(NamedTuple):
    """The largest change allowed of a variable, relative to a scale: "1", or another variable.

    Without a scale the change is relative to the range of the record's values. With ``over`` two
    curves over that variable are compared, through the samples along the dimension ``point``,
    because the samples may slide along the curve. The share ``share`` of the entries, of texts and
    counts as well, may exceed the budget, because rounding decides about some entries.
    """

    size: float
    scale: str = ""
    over: str = ""
    share: float = 0.0


ROUNDING = 1e-13
"""The smallest budget, for variables without another one."""

IGNORED = math.inf
"""The budget, ``inf`` in the tables, of variables that another dataset also has, or about which
rounding decides."""

PICTURE = 1.0
"""The largest root mean square difference of two pictures, in grey levels of 255.

Changing parameters by two units in the last place changes all rounding errors, as another processor
does, and moves the pixels of a figure by at most 0.092 (Fig. 15). The budget is the next power of
ten above ten times this value."""

PICTURES = {"ext_diagram": 60.0, "ext_locking": 40.0, "ext_means": 60.0, "ext_locked": 40.0}
"""Budgets of pictures of motions about which rounding decides: three times the 19 and 12 grey
levels by which a change of 1e-15 in the start moves these pictures."""

ARTIFACTS: dict[str, dict[str, Budget]] = {}
"""Budgets of single artifacts, by variable; ``*`` stands for all variables that are not named."""

_TABLE = Path(__file__).with_suffix(".csv").read_text(encoding="utf-8")
for _row in csv.DictReader(_TABLE.splitlines()):
    _budget = Budget(float(_row["size"]), _row["scale"], _row["over"], float(_row["share"] or 0))
    for _name in _row["artifact"].split():
        ARTIFACTS.setdefault(_name, {}).update(dict.fromkeys(_row["variable"].split(), _budget))


def budget_of(artifact: str, name: str, attributes: Mapping[str, Any] | None = None) -> Budget:
    """The budget of a variable of an artifact's dataset.

    It is that of the artifact if there is one, otherwise that of the variable's attributes, which
    its study has declared, otherwise rounding.

    Examples
    --------
    >>> budget_of("fig05", "phase").size, budget_of("fig08", "phase").over
    (1e-13, 'amplitude')
    >>> budget_of("fig05", "found", {"budget": 1e-8, "scale": "1"}).size
    1e-08
    """
    own = ARTIFACTS.get(artifact, {})
    declared = attributes or {}
    general = Budget(float(declared.get("budget", ROUNDING)), str(declared.get("scale", "")))
    return own.get(name, own.get("*", general))


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
    record, new = np.asarray(record), np.asarray(new)
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
    record, new = np.asarray(record, dtype=float), np.asarray(new, dtype=float)
    with np.errstate(invalid="ignore", divide="ignore"):
        distance = np.abs(new - record) / scale
    return np.where(same(record, new), 0.0, np.where(np.isnan(distance), np.inf, distance))


def _to_polyline(x, y, line_x, line_y) -> np.ndarray:
    """Distance of point k from the segments k - 1 - reach … k + reach of a polyline."""
    count = x.shape[-1]
    # The distance from the vertex itself, because a vertex between two gaps has no segment.
    best = np.hypot(x - line_x, y - line_y)
    for offset in range(-_REACH - 1, _REACH + 1) if count > 1 else ():
        left = np.clip(np.arange(count) + offset, 0, count - 2)
        ax, ay = line_x[..., left], line_y[..., left]
        dx, dy = line_x[..., left + 1] - ax, line_y[..., left + 1] - ay
        square = dx * dx + dy * dy
        along = ((x - ax) * dx + (y - ay) * dy) / np.where(square > 0, square, 1.0)
        along = np.clip(along, 0.0, 1.0)
        # fmin, because a segment with an end that is not finite does not count.
        best = np.fmin(best, np.hypot(x - ax - along * dx, y - ay - along * dy))
    return best


def curve(x: ArrayLike, y: ArrayLike, new_x: ArrayLike, new_y: ArrayLike) -> np.ndarray:
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

    >>> curve([0, 1, 2], [0, 0, 0], [0.0, 1.5, 2.0], [0, 0, 0]).tolist()
    [0.0, 0.0, 0.0]
    >>> curve([0, 1, 2], [0, 0, 0], [0, 1, 2], [0.0, 0.25, 0.0]).max().item()
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


# Attributes with the origin of a file, or with texts about it, are not compared.
_NOT_COMPARED = ("provenance_", "title", "references", "history", "budget", "scale")
# Largest number of entries of a variable in a report.
_LARGEST = 5


def _form(variable: xr.DataArray) -> str:
    """Type and sizes of a variable; texts of all lengths have the same type.

    Examples
    --------
    >>> _form(xr.DataArray([[1, 2]], dims=("case", "n")))
    'int64, case: 1, n: 2'
    """
    kind = "text" if variable.dtype.kind in "OSUT" else str(variable.dtype)
    return ", ".join([kind, *(f"{name}: {size}" for name, size in variable.sizes.items())])


def header(data: xr.Dataset) -> str:
    """The structure of a dataset as lines: variables with their types and sizes, and attributes.

    Examples
    --------
    >>> print(header(xr.Dataset({"x": ("t", [0.0], {"units": "1"})}, attrs={"n": 1})))
    attribute n: 1
    attribute units of x: '1'
    x: float64, t: 1
    """
    lines = [f"{x}: {_form(data[x])}{' (coordinate)' * (x in data.coords)}" for x in data.variables]
    owners = [("", data.attrs), *((f" of {name}", data[name].attrs) for name in data.variables)]
    for owner, attributes in owners:
        for name, value in attributes.items():
            if not name.startswith(_NOT_COMPARED):
                lines.append(f"attribute {name}{owner}: {np.asarray(value).tolist()!r}")
    return "\n".join(sorted(lines))


def _beside(data: xr.Dataset, name: str, other: str) -> np.ndarray:
    """Another variable of a dataset, broadcast to the shape of the first."""
    return data[other].broadcast_like(data[name]).transpose(*data[name].dims).values


def _allowed(drift: np.ndarray, share: float) -> np.ndarray:
    """Drifts over the budget, after capping those of the share of entries that may exceed it.

    Examples
    --------
    >>> _allowed(np.array([0.5, np.inf, 0.0, 0.0]), 0.5).tolist()
    [0.5, 0.5, 0.0, 0.0]
    >>> _allowed(np.array([np.inf, 0.0]), 0.4).tolist()
    [inf, 0.0]
    """
    beyond = drift > 1
    part = beyond.mean()
    return np.where(beyond, part / share, drift) if 0 < part <= share else drift


def shares(name: str, record: xr.Dataset, new: xr.Dataset, budget: Budget) -> np.ndarray:
    """Drift of each entry of a variable over the budget; ∞ for a change where none is allowed.

    Parameters
    ----------
    name : str
        A variable of both datasets, of the same shape and type.
    record, new : Dataset
    budget : Budget
        For texts, counts and truth values only ``over`` and ``share`` have an effect.

    Raises
    ------
    KeyError, ValueError
        If the budget names a variable or a dimension that does not exist.

    Examples
    --------
    >>> record = xr.Dataset({"x": ("t", [0.0, 1.0, 2.0])})
    >>> shares("x", record, record + 0.5, Budget(0.25)).tolist()
    [1.0, 1.0, 1.0]
    >>> shares("x", record, record + 0.5, Budget(0.25, scale="1")).tolist()
    [2.0, 2.0, 2.0]
    """
    a, b = record[name], new[name]
    if budget.size == IGNORED:
        return np.zeros(a.shape)
    if budget.share:
        return _allowed(shares(name, record, new, budget._replace(share=0.0)), budget.share)
    if budget.over:
        axis = a.dims.index("point")
        x, new_x = (_beside(data, name, budget.over) for data in (record, new))
        pairs = [(x, span(x)), (a, span(a)), (new_x, span(x)), (b, span(a))]
        moved = (np.moveaxis(np.asarray(part) / scale, axis, -1) for part, scale in pairs)
        return np.moveaxis(curve(*moved), -1, axis) / budget.size
    if a.dtype.kind != "f":
        return np.where(same(a.values, b.values), 0.0, np.inf)
    scale = span(a) if not budget.scale else 1.0
    if budget.scale not in ("", "1"):
        scale = _beside(record, name, budget.scale)
    return pointwise(a.values, b.values, scale) / budget.size


def _place(variable: xr.DataArray, index: tuple[int, ...]) -> str:
    """Coordinates of an entry, or its indices where a dimension has none.

    Examples
    --------
    >>> _place(xr.DataArray([[1.0, 2.0]], {"t": [0.0, 0.5]}, ("case", "t")), (0, 1))
    'case = 0, t = 0.5'
    """
    places = zip(variable.dims, index, strict=True)
    labels = {name: variable[name].values[k] for name, k in places}
    texts = {name: f"{x:.6g}" if isinstance(x, float) else x for name, x in labels.items()}
    return ", ".join(f"{name} = {text}" for name, text in texts.items())


def _entries(artifact: str, name: str, record: xr.Dataset, new: xr.Dataset) -> Iterator[Row]:
    """The entries of a variable that have moved most, each with its share of the budget."""
    a, b = record[name], new[name]
    unmoved = same(a.values, b.values)
    if unmoved.all():
        yield Row(name, Outcome.IDENTICAL)
        return
    share = shares(name, record, new, budget_of(artifact, name, new[name].attrs))
    places = np.argwhere((share > 0) | ~unmoved)
    order = np.argsort([-share[*place] for place in places], kind="stable")
    beyond = int(np.count_nonzero(share > 1))
    note = f"{beyond} of {share.size} entries beyond the budget" if beyond else ""
    for at in (tuple(places[k]) for k in order[:_LARGEST]):
        outcome = Outcome.WITHIN if share[at] <= 1 else Outcome.DRIFTED
        old, now = (printable(side[at].item(), 60) for side in (a, b))
        yield Row(name, outcome, old, now, float(share[at]), _place(a, at), note)


def compare_datasets(artifact: str, record: xr.Dataset, new: xr.Dataset) -> list[Row]:
    """Rows for the headers of two datasets, and for all variables that have the same form.

    A variable has a row for each of the entries that moved most, five at most, or one row if it is
    identical.

    Examples
    --------
    >>> budget = {"budget": 1e-12, "scale": "1"}
    >>> record, new = (
    ...     xr.Dataset({"residual": ("point", [x, 1.0], budget)}) for x in (0.0, 2.0**-41)
    ... )
    >>> found = compare_datasets("fig", record, new)
    >>> [(each.name, str(each.outcome), round(each.share, 3)) for each in found][:1]
    [('residual', 'within budget', 0.455)]
    """
    changed = compare_texts(header(record), header(new), None)
    rows = [replace(row, name="header", outcome=Outcome.STRUCTURE) for row in changed]
    for name in map(str, record.variables):
        if name in new.variables and _form(record[name]) == _form(new[name]):
            rows += _entries(artifact, name, record, new)
    return rows
