"""One dataset from the shards, read one after another."""

from collections.abc import Iterable

import numpy as np
import xarray as xr

from bouncing_ball.atlas.plan import Plan
from bouncing_ball.atlas.shards import LIMIT
from bouncing_ball.datasets.variables import describe
from bouncing_ball.errors import ModelError

PLACE = ("release", "n", "restitution")
"""The dimensions in place of ``row``."""


def merge(plan: Plan, shards: Iterable[xr.Dataset], limits: xr.Dataset) -> xr.Dataset:
    """The answers of all shards by rule, n, range of r and range of p.

    The memory is that of the result and of one shard. Ranges of r that a rule
    does not reach have no nodes: their counts are 0, the rest is not a number.

    Raises
    ------
    ModelError
        If the shards do not hold each row of the plan once.
    """
    whole: dict[str, tuple[tuple[str, ...], np.ndarray]] = {}
    seen = np.zeros(len(plan.rows), dtype=int)
    for shard in shards:
        _put(plan, whole, shard, "")
        np.add.at(seen, shard.row.values, 1)
    if not np.all(seen == 1):
        row = int(np.argmax(seen != 1))
        raise ModelError(f"row {row} of the atlas is in {seen[row]} shards, not in one")
    _put(plan, whole, limits, LIMIT)
    coords = {
        "release": [str(rule) for rule in plan.releases],
        "n": plan.families,
        "restitution": _middle(plan.edges),
        "position": _middle(plan.positions),
        **{name: limits[name].values for name in ("model", "tolerance", "frequency_ratio")},
        **{name: limits[name].values for name in ("threshold_bin", "law_bin")},
        "quantity": shard["quantity"].values,
        "limit_quantity": limits["quantity"].values,
    }
    return describe(xr.Dataset(dict(whole), coords))


def _middle(edges: np.ndarray) -> np.ndarray:
    return np.round((edges[1:] + edges[:-1]) / 2, 12)


def _put(plan: Plan, whole, part: xr.Dataset, prefix: str) -> None:
    """The rows of a part into the whole, which is made as its first part comes."""
    places = np.array([plan.rows[row] for row in part.row.values])
    shape = len(plan.releases), len(plan.families), len(plan.edges) - 1
    for name, variable in part.data_vars.items():
        key = f"{prefix}{name}"
        if key not in whole:
            dims = [f"{prefix}{d}" if d == "quantity" else str(d) for d in variable.dims[1:]]
            empty = 0 if variable.dtype.kind == "i" else np.nan
            values = np.full((*shape, *variable.shape[1:]), empty, variable.dtype)
            whole[key] = (*PLACE, *dims), values
        whole[key][1][tuple(places.T)] = variable.values
