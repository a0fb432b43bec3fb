"""One number out of the datasets."""

from collections.abc import Callable, Mapping

import numpy as np
import xarray as xr

from bouncing_ball.claims.ledger import Measure
from bouncing_ball.datasets.selection import index_of
from bouncing_ball.errors import ModelError

_REDUCTIONS: dict[str, Callable[[np.ndarray], float]] = {
    "max": np.max,
    "min": np.min,
    "sum": np.sum,
}


def measured(measure: Measure, datasets: Mapping[str, xr.Dataset]) -> float:
    """The number that a measure names.

    Raises
    ------
    ModelError
        If the dataset, the variable or the place is missing, if more than one
        number is left, or if any of them is not a number: what is not there is
        not passed over.

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
    if values.dtype.kind not in "biuf":
        raise ModelError(f"{measure}: {measure.variable} does not hold numbers")
    for name, wanted in measure.at:
        try:
            values = values.isel({name: index_of(values, name, wanted)})
        except ModelError as error:
            raise ModelError(f"{measure}: {error}") from None
    numbers = values.values.astype(float).ravel()
    if not numbers.size:
        raise ModelError(f"{measure}: no numbers over {', '.join(map(str, values.dims))}")
    if np.isnan(numbers).any():
        raise ModelError(f"{measure}: {np.isnan(numbers).sum()} of {numbers.size} not a number")
    if measure.reduce != "value":
        return float(_REDUCTIONS[measure.reduce](numbers))
    if numbers.size > 1:
        dims = ", ".join(map(str, values.dims))
        raise ModelError(f"{measure}: {numbers.size} numbers over {dims}, not 1")
    return float(numbers[0])
