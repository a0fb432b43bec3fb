"""Where the restitution model is right by accident."""

import xarray as xr


def accidental(data: xr.Dataset) -> xr.DataArray:
    """Whether its error passes through zero above the ϖ from which it is within the tolerance.

    The error then changes its sign there, and would be beyond the tolerance otherwise.

    Examples
    --------
    >>> data = xr.Dataset(
    ...     {"error_threshold": (("model", "restitution"), [[3.0, 80.0]]),
    ...      "error_zero": ("restitution", [9.0, 2.0])}, coords={"model": ["restitution"]})
    >>> accidental(data).values.tolist()
    [True, False]
    """
    return data.error_zero > data.error_threshold.sel(model="restitution", drop=True)
