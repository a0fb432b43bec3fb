"""The comparison of two datasets, variable by variable: structure first, then numbers."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import xarray as xr

from bouncing_ball.compare.budgets import IGNORED, Budget, budget_of
from bouncing_ball.compare.drift import curve, pointwise, same, span
from bouncing_ball.compare.outcome import Outcome, Row
from bouncing_ball.compare.texts import compare_texts
from bouncing_ball.errors import printable

# Attributes with the origin of a file, or with texts about it, are not compared.
_NOT_COMPARED = ("provenance_", "title", "references", "history")
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
    share = shares(name, record, new, budget_of(artifact, name))
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
    >>> record = xr.Dataset({"residual": ("point", [0.0, 1.0])})
    >>> found = compare_datasets("fig", record, record + 2.0**-41)
    >>> [(each.name, str(each.outcome), round(each.share, 3)) for each in found][:1]
    [('residual', 'within budget', 0.455)]
    """
    changed = compare_texts(header(record), header(new), None)
    rows = [replace(row, name="header", outcome=Outcome.STRUCTURE) for row in changed]
    for name in map(str, record.variables):
        if name in new.variables and _form(record[name]) == _form(new[name]):
            rows += _entries(artifact, name, record, new)
    return rows
