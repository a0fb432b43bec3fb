"""Selecting places of a dataset by the labels of its coordinates, or one after another."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.errors import ModelError

# Relative tolerance, because coordinates are computed from the configuration and are rounded.
_MATCH = 1e-9


def index_of(values: xr.DataArray, name: str, wanted: Any) -> int:
    """Index of a label along a dimension; numbers match up to rounding.

    Raises
    ------
    ModelError
        If there is no such dimension or label, or if several labels match.

    Examples
    --------
    >>> index_of(xr.DataArray([5.0, 6.0], {"r": [0.1 + 0.2, 0.5]}), "r", 0.3)
    0
    """
    if name not in values.dims:
        raise ModelError(f"{values.name} has no coordinate {name}")
    labels = values[name].values
    if isinstance(wanted, str) or labels.dtype.kind not in "iuf":
        there = np.flatnonzero([label == wanted for label in labels.tolist()])
    else:
        there = np.flatnonzero(np.isclose(labels, wanted, rtol=_MATCH, atol=0))
    if there.size != 1:
        # Of many labels, only the first and the last are named.
        known = np.array2string(labels, threshold=20, separator=", ", max_line_width=10**6)
        often = "is not among" if not there.size else f"is {there.size} times among"
        raise ModelError(f"{name} = {wanted} {often} {known}")
    return int(there[0])


def each(data: xr.Dataset, *dims: str) -> Iterator[xr.Dataset]:
    """The dataset at each place along some dimensions, the last one running fastest.

    Examples
    --------
    >>> data = xr.Dataset(coords={"n": [1, 2], "bound": ["from", "to"]})
    >>> [part.n.item() for part in each(data, "n", "bound")]
    [1, 1, 2, 2]
    """
    for place in np.ndindex(*(data.sizes[dim] for dim in dims)):
        yield data.isel(dict(zip(dims, place, strict=True)))
