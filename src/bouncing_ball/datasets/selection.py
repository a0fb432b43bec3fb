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
        If no label, or more than one, matches.

    Examples
    --------
    >>> index_of(xr.DataArray([5.0, 6.0], {"r": [0.1 + 0.2, 0.5]}), "r", 0.3)
    0
    """
    labels = values[name].values
    text = isinstance(wanted, str)
    same = labels == wanted if text else np.isclose(labels, wanted, rtol=_MATCH, atol=0)
    if np.count_nonzero(same) != 1:
        raise ModelError(f"{name} = {wanted} is not among {', '.join(map(str, labels))}")
    return int(same.argmax())


def split_by_prefix(data: xr.Dataset, prefix: str) -> tuple[xr.Dataset, xr.Dataset]:
    """The variables of a dataset whose names do not begin so, and the others, named without it.

    Dimensions of the others that begin so are named without it as well.

    Examples
    --------
    >>> data = xr.Dataset({"phase": ("point", [0.0]), "long_phase": ("long_point", [1.0])})
    >>> first, second = split_by_prefix(data, "long_")
    >>> list(first), list(second), second.phase.dims, float(second.phase[0])
    (['phase'], ['phase'], ('point',), 1.0)
    """
    named = [str(name) for name in data.variables if str(name).startswith(prefix)]
    others = data[named]
    begin = {str(name) for name in (*others.variables, *others.dims)}
    shorter = {name: name.removeprefix(prefix) for name in begin if name.startswith(prefix)}
    return data.drop_vars(named), others.rename(shorter)


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
