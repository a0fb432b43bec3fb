"""Whether a dataset holds what is to be drawn or set from it."""

from collections.abc import Callable
from pathlib import Path
from traceback import extract_tb
from typing import TypeVar

import xarray as xr

from bouncing_ball.errors import ModelError

T = TypeVar("T")


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
