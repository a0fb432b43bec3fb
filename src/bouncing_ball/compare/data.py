"""Two datasets, variable by variable: structure first, then numbers."""

from collections.abc import Iterator
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.compare.drift import curve, pointwise, same, span
from bouncing_ball.compare.files import UnreadableError
from bouncing_ball.compare.outcome import Outcome, worst
from bouncing_ball.datasets.variables import IGNORED, Budget, budget_of

# How and with what a file was made, and words about it.
_NOT_COMPARED = ("provenance_*", "title", "references", "history")
# Numbers and texts, 160 times those of the largest dataset: compressed, zeros take no room.
_MAX_VALUES = 2**22
# Entries of a variable that a report names.
_LARGEST = 5


@dataclass(frozen=True)
class Moved:
    """An entry of a variable that has moved: where, its drift over its budget, both values."""

    place: str
    share: float
    record: str
    new: str


@dataclass(frozen=True)
class VariableResult:
    """The result for one variable; ``largest`` are the entries that have moved most."""

    name: str
    outcome: Outcome
    share: float | None = None
    note: str = ""
    largest: tuple[Moved, ...] = ()


def read_data(content: bytes) -> xr.Dataset:
    """A dataset from its file's content, whole; no number is taken for a date."""
    from netCDF4 import Dataset

    with Dataset("memory", memory=content) as raw:
        if sum(variable.size for variable in raw.variables.values()) > _MAX_VALUES:
            raise UnreadableError(f"more than {_MAX_VALUES} values")
        store = xr.backends.NetCDF4DataStore(raw)
        return xr.open_dataset(store, decode_times=False, decode_timedelta=False).load()


def _kind(variable: xr.DataArray) -> str:
    """The type as it matters: texts of any length are texts."""
    return "text" if variable.dtype.kind in "OSUT" else str(variable.dtype)


def _text(value: Any) -> str:
    """A value in few characters, so that neighbouring numbers look different."""
    value = value.tolist() if isinstance(value, np.ndarray | np.generic) else value
    text = repr(value) if isinstance(value, float) else str(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _attributes(
    record: xr.Dataset | xr.DataArray, new: xr.Dataset | xr.DataArray
) -> Iterator[tuple[Outcome, str]]:
    """One sentence for each attribute that matters and is not the same."""
    for name in sorted({*map(str, record.attrs), *map(str, new.attrs)}):
        if any(fnmatchcase(name, pattern) for pattern in _NOT_COMPARED):
            continue
        if name not in new.attrs:
            yield Outcome.STRUCTURE, f"attribute {name} is gone"
        elif name not in record.attrs:
            yield Outcome.STRUCTURE, f"attribute {name} is new"
        elif not np.array_equal(np.asarray(record.attrs[name]), np.asarray(new.attrs[name])):
            change = f"{_text(record.attrs[name])} → {_text(new.attrs[name])}"
            yield Outcome.DRIFTED, f"attribute {name}: {change}"


def _structure(record: xr.DataArray, new: xr.DataArray) -> Iterator[tuple[Outcome, str]]:
    for what, before, after in (
        ("sizes", dict(record.sizes), dict(new.sizes)),
        ("dimensions", record.dims, new.dims),
        ("type", _kind(record), _kind(new)),
        ("a coordinate", record.name in record.coords, new.name in new.coords),
    ):
        if before != after:
            yield Outcome.STRUCTURE, f"{what}: {before} → {after}"


def _beside(data: xr.Dataset, name: str, other: str) -> np.ndarray:
    """Another variable of a dataset, in the shape of the first."""
    if other not in data.variables or not {*data[other].dims} <= {*data[name].dims}:
        raise UnreadableError(f"the budget of {name} needs {other}, on dimensions of {name}")
    sizes = {dim: data.sizes[dim] for dim in data[name].dims}
    return data[other].variable.set_dims(sizes).transpose(*sizes).values


def shares(name: str, record: xr.Dataset, new: xr.Dataset, budget: Budget | None) -> np.ndarray:
    """Drift of a variable over its budget, place by place; ∞ where nothing may change.

    Parameters
    ----------
    name : str
        A variable of both datasets, of the same shape and type.
    record, new : Dataset
    budget : Budget or None
        Of texts, counts, and yes or no only a budget over a curve counts.

    Raises
    ------
    UnreadableError
        If the budget names a variable or a dimension that is not there.

    Examples
    --------
    >>> record = xr.Dataset({"x": ("t", [0.0, 1.0, 2.0])})
    >>> shares("x", record, record + 0.5, Budget(0.25)).tolist()
    [1.0, 1.0, 1.0]
    """
    a, b = record[name], new[name]
    if budget and budget.over:
        if "point" not in a.dims:
            raise UnreadableError(f"the budget of {name} needs the dimension point")
        axis = a.dims.index("point")
        x, new_x = (_beside(data, name, budget.over) for data in (record, new))
        pairs = [(x, span(x)), (a, span(a)), (new_x, span(x)), (b, span(a))]
        moved = (np.moveaxis(np.asarray(part) / scale, axis, -1) for part, scale in pairs)
        return np.moveaxis(curve(*moved), -1, axis) / budget.size
    if budget is None or a.dtype.kind != "f":
        return np.where(same(a.values, b.values), 0.0, np.inf)
    scale: Any = span(a) if budget.scale is None else budget.scale
    if isinstance(scale, str):
        scale = _beside(record, name, scale)
    return pointwise(a.values, b.values, scale) / budget.size


def _place(variable: xr.DataArray, index: tuple[int, ...]) -> str:
    """Coordinates of an entry, or its indices where a dimension has none.

    Examples
    --------
    >>> _place(xr.DataArray([[1.0, 2.0]], {"t": [0.0, 0.5]}, ("case", "t")), (0, 1))
    'case = 0, t = 0.5'
    """
    found = []
    for name, k in zip(variable.dims, index, strict=True):
        label = variable[name].values[k] if name in variable.coords else k
        found.append(f"{name} = {f'{label:.6g}' if isinstance(label, float) else label}")
    return ", ".join(found)


def _told(name: str, changes: list[tuple[Outcome, str]]) -> VariableResult:
    """The result for what has no number."""
    outcome = worst(outcome for outcome, _ in changes)
    return VariableResult(name, outcome, note="; ".join(text for _, text in changes))


def _compare_variable(
    artifact: str, name: str, record: xr.Dataset, new: xr.Dataset
) -> VariableResult:
    a, b = record[name], new[name]
    if changes := [*_structure(a, b), *_attributes(a, b)]:
        return _told(name, changes)
    if same(a.values, b.values).all():
        return VariableResult(name, Outcome.IDENTICAL, 0.0)
    budget = budget_of(artifact, name)
    if budget and budget.size == IGNORED:
        return VariableResult(name, Outcome.WITHIN, note="differs, and is not compared")
    try:
        share = shares(name, record, new, budget)
    except UnreadableError as error:
        return _told(name, [(Outcome.STRUCTURE, str(error))])
    order = np.argsort(-share, axis=None, kind="stable")[:_LARGEST]
    places = [tuple(map(int, np.unravel_index(k, share.shape))) for k in order]
    largest = tuple(
        Moved(_place(a, at), float(share[at]), _text(a.values[at]), _text(b.values[at]))
        for at in places
        if share[at] > 0
    )
    top = float(share.max())
    outcome = Outcome.WITHIN if top <= 1 else Outcome.DRIFTED
    count = int(np.count_nonzero(share > 1))
    note = f"{count} of {share.size} entries beyond the budget" if count else ""
    return VariableResult(name, outcome, top, note, largest)


def compare_datasets(artifact: str, record: xr.Dataset, new: xr.Dataset) -> list[VariableResult]:
    """All variables, coordinates and attributes of two datasets, worst first.

    Budgets are those of :func:`bouncing_ball.datasets.variables.budget_of`.
    Parameters, the global attributes, are always exact.

    Examples
    --------
    >>> record = xr.Dataset({"residual": ("point", [0.0, 1.0])})
    >>> found = compare_datasets("fig", record, record + 2.0**-41)
    >>> [(each.name, str(each.outcome), round(each.share, 3)) for each in found]
    [('residual', 'within budget', 0.455)]
    """
    results = []
    for name in sorted({*map(str, record.variables), *map(str, new.variables)}):
        if name not in new.variables:
            results.append(VariableResult(name, Outcome.STRUCTURE, note="is gone"))
        elif name not in record.variables:
            results.append(VariableResult(name, Outcome.STRUCTURE, note="is new"))
        else:
            results.append(_compare_variable(artifact, name, record, new))
    if changes := list(_attributes(record, new)):
        results.append(_told("(global attributes)", changes))
    return sorted(results, key=lambda each: (-each.outcome.rank, -(each.share or 0.0), each.name))
