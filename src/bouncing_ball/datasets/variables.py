"""The vocabulary of the datasets, ``variables.csv``: symbol, equation and budget of each variable.

A name has the same meaning in every dataset. All quantities are dimensionless:
times are Ωt, lengths Ω²y/g, velocities Ωẏ/g, and phases and angles are in
radians of the table's motion. Units follow the CF conventions ("1", "rad").
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.datasets.files import rows_beside
from bouncing_ball.errors import ModelError

_ROWS = rows_beside(__file__)
VARIABLES: dict[str, dict[str, str]] = {
    row["name"]: {key: row[key] for key in ("long_name", "symbol", "units", "equation")}
    for row in _ROWS
}
"""The attributes of each variable; symbol or equation is empty if the paper has none for it."""
BUDGETS: dict[str, tuple[float, str]] = {
    row["name"]: (float(row["budget"]), row["scale"]) for row in _ROWS if row["budget"]
}
"""The largest change of a variable from the accepted record, as a share of its scale: of 1, of
another variable, or of the range of its values; see :mod:`bouncing_ball.compare.budgets`."""


def describe(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset with attributes for every variable and coordinate.

    A dimension without a coordinate gets its index as the coordinate.

    Raises
    ------
    ModelError
        If a name is not in :data:`VARIABLES`.

    Examples
    --------
    >>> describe(xr.Dataset({"phase": ("point", [0.0])})).phase.attrs["symbol"]
    'φ'
    """
    bare = [name for name in dataset.dims if name not in dataset.coords]
    whole = dataset.assign_coords({name: np.arange(dataset.sizes[name]) for name in bare})
    if unknown := [name for name in whole.variables if name not in VARIABLES]:
        raise ModelError(f"{unknown[0]} has no row in datasets/variables.csv")
    for name in whole.variables:
        whole[name].attrs = VARIABLES[str(name)]
    return whole


def described(variables: Mapping[str, Any], coords: Mapping[str, Any] | None = None) -> xr.Dataset:
    """A dataset of these variables with their attributes, see :func:`describe`.

    Raises
    ------
    ModelError
        If a name is not in :data:`VARIABLES`.

    Examples
    --------
    >>> described({"phase": ("point", [0.0])}).phase.attrs["units"]
    'rad'
    """
    return describe(xr.Dataset(variables, coords))
