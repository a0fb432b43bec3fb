"""What the rules and scripts of the atlas need: names, times and whole files of shards."""

import math
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from bouncing_ball.atlas.plan import Plan
from bouncing_ball.datasets.netcdf import DatasetError
from bouncing_ball.pipeline.job import is_as_written, read_input

FOLDER = "results/atlas"
LOGS = "results/logs/atlas"

# Processor time of an orbit on a slow machine, with some to spare.
_SECONDS_PER_ORBIT = 3e-6
_LEAST_MINUTES = 10


def shard_names(parameters: Mapping[str, Any]) -> list[str]:
    """The shards by number and count, so that another number of them has other names.

    Examples
    --------
    >>> from bouncing_ball.configuration.yaml_file import read_yaml
    >>> shard_names(read_yaml("config/config.yaml")["atlas"])[:2]
    ['0000-of-0020', '0001-of-0020']
    """
    count = Plan(parameters).shards
    return [f"{k:04d}-of-{count:04d}" for k in range(count)]


def shard_minutes(parameters: Mapping[str, Any]) -> int:
    """Minutes that a cluster should give to a shard."""
    plan = Plan(parameters)
    seconds = plan.orbits / plan.shards * _SECONDS_PER_ORBIT
    return _LEAST_MINUTES + math.ceil(seconds / 60)


def log_of(path: str) -> str:
    """The log of the job that makes a file of the atlas.

    Examples
    --------
    >>> log_of("results/atlas/shards/limits.nc")
    'results/logs/atlas/shards/limits.log'
    """
    return str(Path(LOGS, Path(path).relative_to(FOLDER)).with_suffix(".log"))


def discard_damaged(paths: Iterable[str]) -> list[str]:
    """Remove files that are not what their jobs wrote; which they were."""
    damaged = [path for path in paths if Path(path).is_file() and not _whole(path)]
    for path in damaged:
        Path(path).unlink()
    return damaged


def _whole(path: str) -> bool:
    return is_as_written(path, log_of(path))


def read_shards(paths: Iterable[str]) -> Iterator[xr.Dataset]:
    """The shards, one after another.

    Raises
    ------
    DatasetError
        If one is not what its job wrote.
    """
    for path in paths:
        yield read_part(path)


def read_part(path: str) -> xr.Dataset:
    """A file of the atlas that another job has made.

    Raises
    ------
    DatasetError
        If it is not what its job wrote.
    """
    if not Path(path).is_file():
        raise DatasetError(f"no dataset {path}")
    return read_input(path, log_of(path))
