"""Variables that hold no number, and a dataset's own word for it.

With parameters of one's own an orbit may be nowhere, or an error never cross its
tolerance. A study that found nothing says so in its dataset, so that a dataset
that has lost its numbers is not taken for one that never had any.
"""

from typing import Any

import numpy as np
import xarray as xr

STATEMENT = "without_values"
"""The attribute that names the variables for which nothing was found."""

# No domain of the paper's parameters ends in a grazing.
_USUALLY_EMPTY = {"grazing_amplitude", "grazing_phase"}


def empty_variables(data: xr.Dataset) -> list[str]:
    """Variables without a single finite number that should have one.

    Examples
    --------
    >>> empty_variables(xr.Dataset({"phase": ("point", [np.nan, np.nan]), "n": 1.0}))
    ['phase']
    """
    return [
        str(name)
        for name, values in data.variables.items()
        if values.dtype.kind in "fc"
        and name not in _USUALLY_EMPTY
        and not np.isfinite(values.values).any()
    ]


def statement(data: xr.Dataset) -> dict[str, Any]:
    """The attribute with which a study says what it found nothing for; none if there is all.

    Examples
    --------
    >>> statement(xr.Dataset({"phase": ("point", [np.nan]), "n": 1.0}))
    {'without_values': 'phase'}
    """
    empty = empty_variables(data)
    return {STATEMENT: ", ".join(empty)} if empty else {}


def lost_variables(data: xr.Dataset) -> list[str]:
    """Variables without a number of which the dataset does not say so.

    Examples
    --------
    >>> data = xr.Dataset({"phase": ("point", [np.nan])})
    >>> lost_variables(data), lost_variables(data.assign_attrs(statement(data)))
    (['phase'], [])
    """
    stated = str(data.attrs.get(STATEMENT, "")).split(", ")
    return [name for name in empty_variables(data) if name not in stated]
