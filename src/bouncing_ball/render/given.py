"""Whether a dataset holds what is to be drawn or set from it."""

from collections.abc import Callable
from pathlib import Path
from traceback import extract_tb
from typing import TypeVar

import numpy as np
import xarray as xr

from bouncing_ball.errors import ModelError

T = TypeVar("T")

# What is there for some parameters only: bifurcations and grazings may lie outside
# the window, errors may never cross the tolerance, other parameters are not printed.
_MAY_BE_EMPTY = {
    "difference",
    "error_threshold",
    "error_zero",
    "grazing_amplitude",
    "grazing_phase",
    "period_doubling_turn",
    "printed",
    "special_amplitude",
    "special_contact_duration",
    "special_phase",
    "special_residual",
    "step_needed",
    # Of the windows: there is no stiff limit under the force rule.
    "joining_ratio",
    "stiff_window",
    # Of claims: a statement has no printed number, a formula no deviation.
    "deviation",
    "deviation_units",
    "found",
    "limit",
}


def empty_variables(data: xr.Dataset) -> list[str]:
    """Variables without a single finite number that should have one.

    Examples
    --------
    >>> empty_variables(xr.Dataset({"phase": ("point", [np.nan, np.nan]), "n": 1.0}))
    ['phase']
    """
    empty = [
        str(name)
        for name, values in data.variables.items()
        if values.dtype.kind in "fc" and not np.isfinite(values.values).any()
    ]
    numbers = [str(name) for name, values in data.data_vars.items() if values.dtype.kind in "fc"]
    # Each of some may be empty, but not all that there is.
    if numbers and set(numbers) <= set(empty):
        return empty
    return [name for name in empty if name not in _MAY_BE_EMPTY]


def from_dataset(render: Callable[[xr.Dataset], T], data: xr.Dataset, path: str) -> T:
    """What ``render`` makes of a dataset, if the dataset holds what it takes.

    Raises
    ------
    ModelError
        In one line: what is missing in the file, and the command that makes it
        again; or where ``render`` fails on it.
    """
    again = f"make it again, snakemake --cores 2 --force {path}"
    # Every dimension of a dataset that is written has a coordinate.
    bare = [str(name) for name in data.dims if name not in data.coords]
    if bare:
        raise ModelError(f"{path}: no coordinate {', '.join(bare)}: {again}")
    empty = empty_variables(data)
    if empty:
        raise ModelError(f"{path}: no finite number in {', '.join(empty)}: {again}")
    try:
        return render(data)
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        # The file is what its job wrote: made again it would be the same.
        words = " ".join(str(error).split()).strip('"')
        last = extract_tb(error.__traceback__)[1]
        raise ModelError(
            f"{path}: {type(error).__name__}, {words}: the file is whole, the fault is in line "
            f"{last.lineno} of {Path(last.filename).name} or in the study"
        ) from error
