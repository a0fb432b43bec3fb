"""The shards of the atlas, the limits of all families, and the merged dataset."""

from collections.abc import Hashable, Iterable
from itertools import chain

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.errors import OF_LIMITS, OF_ORBITS
from bouncing_ball.accuracy.simple_models import SIMPLE, errors
from bouncing_ball.beyond.atlas.answers import last_crossings, row_answers, threshold_bins
from bouncing_ball.beyond.atlas.plan import Plan
from bouncing_ball.datasets.variables import Variable, describe, described
from bouncing_ball.errors import ModelError

VARIABLES = {
    "row": Variable("row of tiles: a release rule, an index n and a range of r"),
    "position": Variable(
        "place in the stable range of the restitution model, from its saddle-node at 0 to its "
        "period doubling at 1",
        symbol="(Λ - Λ_SN)/(Λ_PD - Λ_SN)",
    ),
    "threshold_bin": Variable(
        "lower end of a bin of thresholds; 0: at every ϖ scanned, infinity: at none", symbol="ϖ"
    ),
    "largest_threshold": Variable("ϖ from which the error of all nodes is tolerated", symbol="ϖ"),
    "threshold_counts": Variable("number of nodes by the ϖ from which their error is tolerated"),
    "holding": Variable("number of nodes whose error is tolerated from this ϖ on"),
    "exceeding": Variable("number of nodes whose error exceeds the tolerance at this ϖ"),
    "law_stated": Variable("number of nodes for which the error law is stated"),
    "law_exceeding": Variable("number of these beyond the stated remainder"),
    "unstable": Variable("number of nodes whose exact orbit is not stable"),
    "sought": Variable("number of orbits that the walk did not reach, looked for directly"),
    "limit_quantity": Variable("limit of the stable range, or of permanent contact"),
    "limit_needed": Variable(
        "ϖ from which the error of all limits of a range of r is tolerated", symbol="ϖ"
    ),
}
_PLACE = ("release", "n", "restitution")
"""The dimensions into which ``row`` is unfolded."""


def shard(plan: Plan, index: int) -> xr.Dataset:
    """The answers of a shard's rows, over ``row`` and the dimensions of
    :func:`~bouncing_ball.beyond.atlas.answers.row_answers`.
    """
    rows = plan.shard_rows()[index]
    found = xr.concat([row_answers(plan, row) for row in rows], "row")
    coords = {
        "quantity": [str(q) for q in OF_ORBITS],
        "frequency_ratio": np.sort(plan.examined),
        "threshold_bin": threshold_bins(plan.ratios),
    }
    return describe(found.assign_coords(_common(plan, rows) | coords), variables=VARIABLES)


def limit_shard(plan: Plan) -> xr.Dataset:
    """The ϖ needed for the saddle-node, the period doubling and the permanent contact, of all rows.

    ``limit_needed`` (row, model, limit_quantity, tolerance) is the largest threshold among the r of
    a row; thresholds are interpolated like those of the orbits.
    """
    down = plan.ratios[::-1]
    needed = np.empty((len(plan.rows), len(SIMPLE), len(OF_LIMITS), len(plan.tolerances)))
    for k, row in enumerate(plan.rows):
        # The limits do not depend on the position p.
        r = plan.restitutions(row)
        nodes = plan.placed(row, r, np.zeros_like(r))
        error = errors(nodes.contact(down[:, np.newaxis]), nodes.n, nodes.amplitude, OF_LIMITS)
        threshold = last_crossings(down, np.moveaxis(error, 2, 0), np.array(plan.tolerances))
        needed[k] = np.moveaxis(threshold.max(axis=-1), 0, -1)
    data = {"limit_needed": (("row", "model", "limit_quantity", "tolerance"), needed)}
    return described(
        data,
        _common(plan, plan.rows) | {"limit_quantity": list(map(str, OF_LIMITS))},
        variables=VARIABLES,
    )


def _common(plan: Plan, rows: np.ndarray) -> dict[str, object]:
    return {"row": rows, "model": list(SIMPLE), "tolerance": np.array(plan.tolerances)}


def merge(plan: Plan, shards: Iterable[xr.Dataset], limits: xr.Dataset) -> xr.Dataset:
    """The answers of all shards by rule, n, range of r and range of p.

    Ranges of r that a rule does not reach have no nodes: their counts are 0, and the other
    variables are NaN.

    Raises
    ------
    ModelError
        If the shards do not contain each row of the plan exactly once.
    """
    seen = np.zeros(np.prod(plan.shape), dtype=int)
    first = None
    whole: dict[str, tuple[tuple[Hashable, ...], np.ndarray]] = {}
    coords: dict[str, object] = {}
    # One shard at a time, so that memory holds only the result and one part.
    for part in chain(shards, [limits]):
        first = part.coords.to_dataset() if first is None else first
        xr.align(first, part, join="exact", exclude={"row"})
        coords |= {str(x): part[x].values for x in part.coords if x != "row"}
        seen[part.row] += part is not limits
        for name, values in part.items():
            if name not in whole:
                empty = 0 if values.dtype.kind == "i" else np.nan
                rows = np.full((seen.size, *values.shape[1:]), empty, values.dtype)
                whole[str(name)] = (*_PLACE, *values.dims[1:]), rows
            whole[str(name)][1][part.row] = values
    for row in plan.rows[seen[plan.rows] != 1]:
        raise ModelError(f"row {row} of the atlas is in {seen[row]} shards, not in one")
    data = {
        name: (dims, rows.reshape(plan.shape + rows.shape[1:]))
        for name, (dims, rows) in whole.items()
    }
    coords |= {
        "release": [str(rule) for rule in plan.release],
        "n": list(plan.n),
        "restitution": _middle(plan.edges),
        "position": _middle(plan.positions),
    }
    return described(data, coords, variables=VARIABLES)


def _middle(edges: np.ndarray) -> np.ndarray:
    return np.round((edges[1:] + edges[:-1]) / 2, 12)
