"""The summary of the atlas, which is small enough for the accepted record.

It contains the frequency ratio needed for one tolerance over r, Λ and n; the shares of the nodes
for which a rule of thumb holds; the suprema of the errors; and the accuracy of the error law.
"""

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.error_law import coefficients
from bouncing_ball.accuracy.quantities import OF_ORBITS, Quantity
from bouncing_ball.atlas.plan import Plan
from bouncing_ball.atlas.suprema import suprema
from bouncing_ball.datasets.variables import described

TOLERANCE = 0.01
"""The tolerance of charts and tables."""
RULE_OF_THUMB = 100.0
"""The ϖ above which the paper regards the restitution model as accurate."""
QUANTILES = (0.5, 0.9, 0.99)
_TILES = ("restitution", "position")


def summary(plan: Plan, atlas: xr.Dataset) -> xr.Dataset:
    """The summary for one tolerance and for the rule that a ϖ above a given value is enough.

    The tolerance and the ϖ of the rule are those of the atlas that are nearest to
    :data:`TOLERANCE` and :data:`RULE_OF_THUMB`.
    """
    near = atlas.sel({"tolerance": TOLERANCE, "frequency_ratio": RULE_OF_THUMB}, method="nearest")
    tolerance, rule = float(near.tolerance), float(near.frequency_ratio)
    data = {
        "needed": atlas.largest_threshold.sel({"tolerance": tolerance}, drop=True).astype("f4"),
        "limit_needed": atlas.limit_needed,
        "holding_share": _share(atlas, "holding"),
        "exceeding_share": _share(atlas, "exceeding"),
        "needed_quantile": _quantiles(atlas),
        "unstable_share": _share(atlas, "unstable"),
        "law_stated": atlas.law_stated.sum(("n", *_TILES)),
        "law_exceeding": atlas.law_exceeding.sum(("n", *_TILES)),
        "law_coefficient": _law(plan),
        "orbits": plan.orbits,
        "sought_orbits": int(atlas.sought.sum()),
        "resolution": plan.resolution,
        "summary_tolerance": tolerance,
        "rule_of_thumb": rule,
        **suprema(plan, rule, tolerance),
    }
    edges = {"restitution_edge": plan.edges, "position_edge": plan.positions}
    return described(data, edges | {"supremum_quantity": list(map(str, Quantity))})


def _share(atlas: xr.Dataset, name: str) -> xr.DataArray:
    """Share of the nodes of each rule and n that are counted by a variable of the atlas."""
    nodes = atlas.threshold_counts.isel(model=0, quantity=0, tolerance=0, drop=True)
    return atlas[name].sum(_TILES) / nodes.sum(("threshold_bin", *_TILES))


def _quantiles(atlas: xr.Dataset) -> xr.DataArray:
    """ϖ above which each share of :data:`QUANTILES` of the nodes is accurate: the upper end of a
    bin, or the largest threshold if that is smaller.
    """
    counts = atlas.threshold_counts.sum(_TILES)
    share = counts.cumsum("threshold_bin") / counts.sum("threshold_bin")
    ends = xr.DataArray(np.append(atlas.threshold_bin[1:], np.inf), dims="threshold_bin")
    largest = atlas.largest_threshold.max(_TILES)
    places = [(share >= q).argmax("threshold_bin") for q in QUANTILES]
    found = [np.minimum(ends.isel(threshold_bin=place), largest) for place in places]
    return xr.concat(found, xr.Variable("share", list(QUANTILES))).transpose(..., "share")


def _law(plan: Plan) -> xr.Variable:
    """The modulus of K of the error law at the centres of the tiles, for the charts."""
    middle_r, middle_p = ((edges[1:] + edges[:-1]) / 2 for edges in (plan.edges, plan.positions))
    law = np.full((*plan.shape, len(middle_p), len(OF_ORBITS)), np.nan, "f4")
    for row in plan.rows:
        place = np.unravel_index(row, plan.shape)
        nodes = plan.placed(row, np.full_like(middle_p, middle_r[place[-1]]), middle_p)
        k = coefficients(nodes.n, nodes.damping_ratio, nodes.amplitude, nodes.release)
        law[place] = np.abs([k[q] for q in OF_ORBITS]).T
    return xr.Variable(("release", "n", *_TILES, "quantity"), law)
