"""One number out of the datasets."""

import math
from collections.abc import Mapping

import numpy as np
import xarray as xr

from bouncing_ball.claims.ledger import Measure
from bouncing_ball.errors import ModelError

# Coordinates are computed from the numbers of the configuration.
_MATCH = 1e-9


def measured(measure: Measure, datasets: Mapping[str, xr.Dataset]) -> float:
    """The number that a measure names.

    Raises
    ------
    ModelError
        If the dataset, the variable or the place is missing, if more than one
        number is left, or if it is not a number.

    Examples
    --------
    >>> data = {"table": xr.Dataset({"x": ("n", [1.0, 3.0])}, {"n": [1, 2]})}
    >>> measured(Measure("table", "x", (("n", 2),)), data)
    3.0
    """
    if measure.dataset not in datasets:
        raise ModelError(f"{measure}: no dataset {measure.dataset}")
    dataset = datasets[measure.dataset]
    if measure.variable not in dataset.variables:
        raise ModelError(f"{measure}: {measure.dataset} has no variable {measure.variable}")
    values = dataset[measure.variable]
    for name, wanted in measure.at:
        values = values.isel({name: _index(values, name, wanted, measure)})
    numbers = values.values.astype(float).ravel()
    if measure.reduce != "value":
        number = {"max": np.nanmax, "min": np.nanmin, "sum": np.nansum}[measure.reduce](numbers)
    elif numbers.size == 1:
        number = numbers[0]
    else:
        raise ModelError(f"{measure}: {numbers.size} numbers over {', '.join(values.dims)}, not 1")
    if math.isnan(number):
        raise ModelError(f"{measure}: not a number")
    return float(number)


def _index(values: xr.DataArray, name: str, wanted, measure: Measure) -> int:
    if name not in values.dims:
        raise ModelError(f"{measure}: {measure.variable} has no coordinate {name}")
    labels = values[name].values
    if isinstance(wanted, str):
        there = np.flatnonzero(labels == wanted)
    else:
        there = np.flatnonzero(np.isclose(labels.astype(float), wanted, rtol=_MATCH, atol=0))
    if there.size != 1:
        raise ModelError(f"{measure}: {name} = {wanted} is not among {labels.tolist()}")
    return int(there[0])
