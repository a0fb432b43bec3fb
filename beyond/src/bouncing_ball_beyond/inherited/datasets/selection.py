"""The places of a dataset, one after another."""

from collections.abc import Iterator

import numpy as np
import xarray as xr


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
