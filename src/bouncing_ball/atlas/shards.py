"""The shards of the atlas, the limits of all families, and one dataset of all of them."""

from collections.abc import Iterable

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.errors import SIMPLE
from bouncing_ball.accuracy.quantities import OF_LIMITS, OF_ORBITS
from bouncing_ball.atlas.answers import KEPT, row_answers, threshold_bins
from bouncing_ball.atlas.crossings import LastCrossings
from bouncing_ball.atlas.limits_walk import limit_errors
from bouncing_ball.atlas.plan import Plan
from bouncing_ball.datasets.variables import describe
from bouncing_ball.errors import ModelError

_PLACE = ("release", "n", "restitution")
"""The dimensions in place of ``row``."""


def shard(plan: Plan, index: int) -> xr.Dataset:
    """The answers of a shard's rows."""
    rows = plan.shard_rows()[index]
    parts = [row_answers(plan, row) for row in rows]
    data = {
        name: (("row", "position", *dims), np.stack([part[name] for part in parts]))
        for name, (dims, _) in KEPT.items()
    }
    coords = {
        "quantity": [str(q) for q in OF_ORBITS],
        "frequency_ratio": np.sort(plan.examined),
        "threshold_bin": threshold_bins(plan.ratios),
    }
    return _dataset(plan, rows, data, coords)


def limit_shard(plan: Plan) -> xr.Dataset:
    """The ϖ needed for saddle-node, period doubling and permanent contact, of all rows.

    The largest threshold of the r of a row, interpolated as those of the orbits are.
    """
    shape = len(SIMPLE), len(OF_LIMITS)
    needed = np.empty((len(plan.rows), *shape, len(plan.tolerances)))
    family = plan.rows // plan.restitution.tiles
    for each in np.unique(family):
        here = np.flatnonzero(family == each)
        r = np.concatenate([plan.restitutions(row) for row in plan.rows[here]])
        nodes = plan.placed(plan.rows[here[0]], r, np.zeros_like(r))
        crossings = LastCrossings(np.array(plan.tolerances), (*shape, r.size))
        for ratio, error in limit_errors(nodes, plan.ratios):
            crossings.meet(np.array([ratio]), error[np.newaxis])
        threshold = np.moveaxis(crossings.thresholds(), 0, 2).reshape(
            *shape, len(plan.tolerances), len(here), -1
        )
        needed[here] = np.moveaxis(threshold.max(axis=-1), -1, 0)
    data = {"limit_needed": (("row", "model", "limit_quantity", "tolerance"), needed)}
    return _dataset(plan, plan.rows, data, {"limit_quantity": [str(q) for q in OF_LIMITS]})


def _dataset(plan: Plan, rows: np.ndarray, data: dict, coords: dict) -> xr.Dataset:
    common = {"row": rows, "model": list(SIMPLE), "tolerance": np.array(plan.tolerances)}
    return describe(xr.Dataset(data, common | coords))


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
    coords = {
        "release": [str(rule) for rule in plan.release],
        "n": list(plan.n),
        "restitution": _middle(plan.edges),
        "position": _middle(plan.positions),
    }
    seen = np.zeros(np.prod(plan.shape), dtype=int)
    for part in shards:
        _put(plan, whole, coords, part)
        np.add.at(seen, part.row.values, 1)
    for row in plan.rows[seen[plan.rows] != 1]:
        raise ModelError(f"row {row} of the atlas is in {seen[row]} shards, not in one")
    _put(plan, whole, coords, limits)
    data = {
        name: ((*_PLACE, *dims), values.reshape(*plan.shape, *values.shape[1:]))
        for name, (dims, values) in whole.items()
    }
    return describe(xr.Dataset(data, coords))


def _put(plan: Plan, whole: dict, coords: dict, part: xr.Dataset) -> None:
    """The rows of a part into the whole, which is made as its first part comes."""
    for name, variable in part.data_vars.items():
        if name not in whole:
            empty = 0 if variable.dtype.kind == "i" else np.nan
            shape = int(np.prod(plan.shape)), *variable.shape[1:]
            whole[name] = variable.dims[1:], np.full(shape, empty, variable.dtype)
        whole[name][1][part.row.values] = variable.values
    # The number of a row is its place, and a position's is its own in the plan.
    for name in set(part.coords) - {"row"}:
        coords.setdefault(name, part[name].values)


def _middle(edges: np.ndarray) -> np.ndarray:
    return np.round((edges[1:] + edges[:-1]) / 2, 12)
