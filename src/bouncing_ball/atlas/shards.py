"""The shards of the atlas, the limits of all families, and one dataset of all of them."""

from collections.abc import Iterable

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.errors import SIMPLE, errors
from bouncing_ball.accuracy.quantities import OF_LIMITS, OF_ORBITS
from bouncing_ball.atlas.answers import KEPT, row_answers, threshold_bins
from bouncing_ball.atlas.crossings import LastCrossings
from bouncing_ball.atlas.plan import Plan
from bouncing_ball.atlas.walk import TOGETHER
from bouncing_ball.datasets.variables import described
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
    family, down = plan.rows // plan.restitution.tiles, plan.ratios[::-1]
    for each in np.unique(family):
        here = np.flatnonzero(family == each)
        r = np.concatenate([plan.restitutions(row) for row in plan.rows[here]])
        # The limits do not depend on the position.
        nodes = plan.placed(plan.rows[here[0]], r, np.zeros_like(r))
        crossings = LastCrossings(np.array(plan.tolerances), (*shape, r.size))
        for k in range(0, len(down), TOGETHER):
            ratio = down[k : k + TOGETHER]
            contact = nodes.contact(ratio[:, np.newaxis])
            error = errors(contact, nodes.n, nodes.amplitude, OF_LIMITS)
            crossings.meet(ratio, np.moveaxis(error, 2, 0))
        largest = crossings.thresholds().reshape(-1, *shape, len(here), plan.restitution.samples)
        needed[here] = np.moveaxis(largest.max(axis=-1), (0, -1), (-1, 0))
    data = {"limit_needed": (("row", "model", "limit_quantity", "tolerance"), needed)}
    return _dataset(plan, plan.rows, data, {"limit_quantity": [str(q) for q in OF_LIMITS]})


def _dataset(plan: Plan, rows: np.ndarray, data: dict, coords: dict) -> xr.Dataset:
    common = {"row": rows, "model": list(SIMPLE), "tolerance": np.array(plan.tolerances)}
    return described(data, common | coords)


def merge(plan: Plan, shards: Iterable[xr.Dataset], limits: xr.Dataset) -> xr.Dataset:
    """The answers of all shards by rule, n, range of r and range of p.

    Ranges of r that a rule does not reach have no nodes: their counts are 0, the rest is not a
    number.

    Raises
    ------
    ModelError
        If the shards do not hold each row of the plan once.
    """
    found = xr.concat(list(shards), "row", coords="minimal", compat="override", join="exact")
    seen = np.bincount(found.row, minlength=np.prod(plan.shape))
    for row in plan.rows[seen[plan.rows] != 1]:
        raise ModelError(f"row {row} of the atlas is in {seen[row]} shards, not in one")
    whole = xr.merge([found, limits], join="outer", compat="no_conflicts")
    empty = {name: 0 if part.dtype.kind == "i" else np.nan for name, part in whole.items()}
    whole = whole.reindex(row=np.arange(len(seen)), fill_value=empty)
    data = {
        str(name): ((*_PLACE, *part.dims[1:]), part.values.reshape(*plan.shape, *part.shape[1:]))
        for name, part in whole.items()
    }
    coords: dict[str, object] = {str(x): whole[x].values for x in whole.coords if x != "row"}
    places = [str(rule) for rule in plan.release], list(plan.n), _middle(plan.edges)
    coords |= dict(zip(_PLACE, places, strict=True)) | {"position": _middle(plan.positions)}
    return described(data, coords)


def _middle(edges: np.ndarray) -> np.ndarray:
    return np.round((edges[1:] + edges[:-1]) / 2, 12)
