"""Whether a dataset holds what is to be drawn or set from it."""

import xarray as xr

from bouncing_ball.datasets.emptiness import lost_variables
from bouncing_ball.errors import ModelError


def require_numbers(data: xr.Dataset, path: str) -> xr.Dataset:
    """The dataset, if each of its variables has a number or is said to have none.

    Raises
    ------
    ModelError
        In one line: which variables lost their numbers, and the command that makes them again.
    """
    if lost := lost_variables(data):
        raise ModelError(
            f"{path}: no finite number in {', '.join(lost)}: "
            f"make it again, snakemake --cores 2 --force {path}"
        )
    return data
