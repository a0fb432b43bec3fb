"""Datasets as netCDF files, written atomically and reproducibly."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from bouncing_ball.datasets.files import replacing
from bouncing_ball.errors import ModelError

CONVENTIONS = "CF-1.11"
"""The netCDF conventions that the files follow."""


def parameter_attributes(parameters: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Nested parameters as flat netCDF attributes, with CF names, which contain no points.

    Lists of numbers remain lists; lists of anything else become JSON.

    Examples
    --------
    >>> parameter_attributes({"n": 1, "range": {"min": 0.5}, "cases": [{"r": 1}]})
    {'n': 1, 'range__min': 0.5, 'cases': '[{"r": 1}]'}
    """
    flat: dict[str, Any] = {}
    for key, value in parameters.items():
        name = (prefix + key).replace(".", "__")
        if isinstance(value, Mapping):
            flat |= parameter_attributes(value, f"{name}.")
        elif isinstance(value, list) and not all(type(x) in (int, float) for x in value):
            flat[name] = json.dumps(value, ensure_ascii=False)
        else:
            flat[name] = int(value) if isinstance(value, bool) else value
    return flat


def write_dataset(dataset: xr.Dataset, path: str | Path, *, compressed: bool = False) -> None:
    """Write a dataset under the CF conventions, completely or not at all.

    Coordinates have no fill value, because all their values exist.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    encoding: dict[str, dict[str, Any]] = {str(x): {"_FillValue": None} for x in dataset.coords}
    for name, values in dataset.data_vars.items():
        # Compression makes a map of a few small integers many times smaller.
        if values.ndim and (compressed or values.dtype == "int8"):
            encoding[str(name)] = {"zlib": True, "complevel": 4}
    with replacing(path) as temporary:
        dataset.to_netcdf(temporary, engine="netcdf4", format="NETCDF4", encoding=encoding)


def read_dataset(path: str | Path) -> xr.Dataset:
    """Read a dataset into memory and close its file.

    Raises
    ------
    ModelError
        If the file does not exist or is damaged.
    """
    try:
        with xr.open_dataset(path, engine="netcdf4") as dataset:
            return dataset.load()
    except FileNotFoundError:
        raise ModelError(f"no dataset {path}") from None
    # The type of the error that the libraries raise depends on the place of the damage.
    except (OSError, ValueError, RuntimeError, AttributeError) as error:
        raise ModelError(f"{path} is damaged") from error
