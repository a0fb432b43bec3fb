"""Two datasets, variable by variable: structure first, then numbers."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.compare.drift import curve, pointwise, span
from bouncing_ball.compare.outcome import Outcome, worst
from bouncing_ball.compare.tolerances import Mode, Tolerance, ToleranceError, Tolerances
from bouncing_ball.compare.traces import Trace, place_text, trace, value_text


@dataclass(frozen=True)
class VariableResult:
    """What became of one variable, coordinate or attribute.

    ``drift`` and ``budget`` are shares of the variable's scale, ``share`` is
    the one over the other. ``place``, ``record`` and ``new`` say where the
    drift is largest, and the values there. Without numbers they are None.
    ``trace`` says how it has moved elsewhere.
    """

    name: str
    outcome: Outcome
    mode: Mode | None = None
    drift: float | None = None
    budget: float | None = None
    share: float | None = None
    place: str = ""
    record: str = ""
    new: str = ""
    note: str = ""
    trace: Trace | None = None


def _kind(variable: xr.DataArray) -> str:
    """The type as it matters: texts of any length are texts."""
    return "text" if variable.dtype.kind in "OSUT" else str(variable.dtype)


def _same_values(record: xr.DataArray, new: xr.DataArray) -> np.ndarray:
    a, b = record.values, new.values
    if _kind(record) == "text":
        return np.asarray(a.astype(str) == b.astype(str))
    return np.asarray((a == b) | ((a != a) & (b != b)))


def _attributes(
    record: xr.Dataset | xr.DataArray, new: xr.Dataset | xr.DataArray, rules: Tolerances
) -> Iterator[tuple[Outcome, str]]:
    """One sentence for each attribute that matters and is not the same."""
    for name in sorted({*record.attrs, *new.attrs}, key=str):
        if rules.ignores(str(name)):
            continue
        if name not in new.attrs:
            yield Outcome.STRUCTURE, f"attribute {name} is gone"
        elif name not in record.attrs:
            yield Outcome.STRUCTURE, f"attribute {name} is new"
        elif not np.array_equal(np.asarray(record.attrs[name]), np.asarray(new.attrs[name])):
            change = f"{value_text(record.attrs[name])} → {value_text(new.attrs[name])}"
            yield Outcome.DRIFTED, f"attribute {name}: {change}"


def _structure(record: xr.DataArray, new: xr.DataArray) -> Iterator[str]:
    if record.dims != new.dims:
        before, after = (", ".join(map(str, side.dims)) or "none" for side in (record, new))
        yield f"dimensions: {before} → {after}"
    elif record.shape != new.shape:
        for name in record.dims:
            if record.sizes[name] != new.sizes[name]:
                yield f"size of {name}: {record.sizes[name]} → {new.sizes[name]}"
    if _kind(record) != _kind(new):
        yield f"type: {_kind(record)} → {_kind(new)}"
    if (record.name in record.coords) != (new.name in new.coords):
        yield "coordinate → data" if record.name in record.coords else "data → coordinate"


def _spread(values: xr.DataArray, like: xr.DataArray) -> np.ndarray:
    """The values in the shape of another variable, place by place whatever the labels."""
    sizes = {name: like.sizes[name] for name in like.dims}
    return values.variable.set_dims(sizes).transpose(*like.dims).values


def drifts(name: str, record: xr.Dataset, new: xr.Dataset, rule: Tolerance) -> xr.DataArray:
    """Drift of a variable, place by place.

    Parameters
    ----------
    name : str
        A variable of both datasets, of the same shape and of numbers.
    record, new : Dataset
    rule : Tolerance
        Of mode pointwise or curve.

    Returns
    -------
    DataArray
        Dimensions of the variable.

    Raises
    ------
    ToleranceError
        If the rule names a dimension or variable that is not there.

    Examples
    --------
    >>> record = xr.Dataset({"x": ("t", [0.0, 1.0, 2.0])})
    >>> rule = Tolerance(Mode.POINTWISE, "an example", budget=1e-9)
    >>> drifts("x", record, record + 0.5, rule).values.tolist()
    [0.25, 0.25, 0.25]
    """
    a, b = record[name], new[name]
    if rule.along is not None and rule.along not in a.dims:
        raise ToleranceError(f"mode {rule.mode} needs the dimension {rule.along}")
    for other in (rule.abscissa, rule.scale):
        if isinstance(other, str) and not all(
            other in data.variables and set(data[other].dims) <= set(a.dims)
            for data in (record, new)
        ):
            raise ToleranceError(f"mode {rule.mode} needs {other}, on dimensions of {name}")
    if rule.mode is Mode.CURVE:
        return a.copy(data=_off_curve(a, b, record[rule.abscissa], new[rule.abscissa], rule))
    scale: Any = span(a) if rule.scale is None else rule.scale
    if isinstance(rule.scale, str):
        scale = _spread(record[rule.scale], a)
    return a.copy(data=pointwise(a.values, b.values, scale))


def _off_curve(
    record: xr.DataArray, new: xr.DataArray, axis: xr.DataArray, new_axis: xr.DataArray, rule: Any
) -> np.ndarray:
    """Distance of two curves, in the tube's own measure: the abscissa shrunk to the other axis."""
    width = span(axis) * (rule.axis_budget or rule.allowed) / rule.allowed
    height = span(record)
    place = record.dims.index(rule.along)
    parts = (_spread(axis, record) / width, record.values / height)
    parts += (_spread(new_axis, new) / width, new.values / height)
    return np.moveaxis(curve(*(np.moveaxis(part, place, -1) for part in parts)), -1, place)


def _measured(name: str, record: xr.Dataset, new: xr.Dataset, rule: Tolerance) -> VariableResult:
    try:
        drift = drifts(name, record, new, rule)
    except ToleranceError as error:
        return VariableResult(name, Outcome.STRUCTURE, rule.mode, note=str(error))
    index = tuple(map(int, np.unravel_index(int(np.argmax(drift.values)), drift.shape)))
    largest = float(drift.values[index])
    share = largest / rule.allowed
    note = ""
    if rule.mode is Mode.CURVE:
        axes = [_spread(data[rule.abscissa], record[name])[index] for data in (record, new)]
        note = f"over {rule.abscissa}: {' → '.join(dict.fromkeys(map(value_text, axes)))}"
    return VariableResult(
        name,
        Outcome.WITHIN if share <= 1 else Outcome.DRIFTED,
        rule.mode,
        largest,
        rule.budget,
        share,
        place_text(drift, index),
        value_text(record[name].values[index]),
        value_text(new[name].values[index]),
        note,
        trace(record[name], new[name], drift.values / rule.allowed, rule.along),
    )


def _exactly(
    name: str, record: xr.DataArray, new: xr.DataArray, same: np.ndarray, note: str
) -> VariableResult:
    different = np.argwhere(~same)
    index = tuple(int(k) for k in different[0])
    count = f"{len(different)} of {same.size} entries differ"
    return VariableResult(
        name,
        Outcome.DRIFTED,
        Mode.EXACT,
        math.inf,
        0.0,
        math.inf,
        place_text(record, index),
        value_text(record.values[index]),
        value_text(new.values[index]),
        f"{count}; {note}" if note else count,
        trace(record, new, np.where(same, 0.0, np.inf)),
    )


def _compare_variable(
    name: str, artifact: str, record: xr.Dataset, new: xr.Dataset, rules: Tolerances
) -> VariableResult:
    a, b = record[name], new[name]
    rule = rules.of(artifact, name)
    mode = Mode.EXACT if rule is None else rule.mode
    note = "no entry in the tolerance file" if rule is None else ""
    changes = [*((Outcome.STRUCTURE, text) for text in _structure(a, b)), *_attributes(a, b, rules)]
    if changes:
        return _told(name, changes, mode)
    same = _same_values(a, b)
    if same.all():
        budget = None if rule is None else rule.budget
        return VariableResult(name, Outcome.IDENTICAL, mode, 0.0, budget, 0.0, note=note)
    if mode is Mode.IGNORED:
        return VariableResult(name, Outcome.WITHIN, mode, note="differs, and is not compared")
    if rule is None or mode is Mode.EXACT or _kind(a) == "text":
        return _exactly(name, a, b, same, note)
    return _measured(name, record, new, rule)


def _told(
    name: str, changes: list[tuple[Outcome, str]], mode: Mode | None = None
) -> VariableResult:
    """The result for what has no number."""
    outcome = worst(outcome for outcome, _ in changes)
    return VariableResult(name, outcome, mode, note="; ".join(text for _, text in changes))


def compare_datasets(
    artifact: str, record: xr.Dataset, new: xr.Dataset, rules: Tolerances
) -> list[VariableResult]:
    """All variables, coordinates and attributes of two datasets, worst first.

    A variable without an entry among the tolerances is compared exactly, and
    its note says so. Parameters, the global attributes, are always exact.

    Examples
    --------
    >>> rules = Tolerances(
    ...     {"phase": Tolerance(Mode.POINTWISE, "an example", budget=1e-3)},
    ...     Tolerance(Mode.POINTWISE, "an example", budget=1.0),
    ... )
    >>> record = xr.Dataset({"phase": ("point", [0.0, 1.0])})
    >>> found = compare_datasets("fig", record, record + 2.0**-11, rules)
    >>> [(each.name, str(each.outcome), round(each.share, 3)) for each in found]
    [('phase', 'within budget', 0.488)]
    """
    results = []
    for name in sorted({str(name) for name in (*record.variables, *new.variables)}):
        if name not in new.variables:
            results.append(VariableResult(name, Outcome.STRUCTURE, note="is gone"))
        elif name not in record.variables:
            results.append(VariableResult(name, Outcome.STRUCTURE, note="is new"))
        else:
            results.append(_compare_variable(name, artifact, record, new, rules))
    changes = list(_attributes(record, new, rules))
    if changes:
        results.append(_told("(global attributes)", changes))
    return sorted(results, key=_severity)


def _severity(result: Any) -> tuple:
    """Sorting key: the worst outcome first, then the largest share, then the name."""
    return -result.outcome.rank, -(result.share or 0.0), result.name
