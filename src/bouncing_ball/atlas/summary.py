"""What people ask of the atlas, small enough for the accepted record.

The frequency ratio needed for one tolerance over r, Λ and n; the shares of nodes on
which a rule of thumb holds; the worst orbits; and how the error law fares.
"""

from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.error_law import coefficients, law_thresholds
from bouncing_ball.accuracy.quantities import OF_LIMITS, OF_ORBITS
from bouncing_ball.atlas.plan import AtlasParameters
from bouncing_ball.datasets.variables import describe
from bouncing_ball.orbits import restitution_orbit

QUANTILES = (0.5, 0.9, 0.99, 1.0)


def summary(plan: AtlasParameters, atlas: xr.Dataset) -> xr.Dataset:
    """The summary for a tolerance and a rule "ϖ above this is enough"."""
    tolerance, rule_of_thumb = plan.summary.tolerance, plan.summary.rule_of_thumb
    one = atlas.sel({"tolerance": tolerance})
    failing = one.sel({"frequency_ratio": rule_of_thumb})
    nodes = float(plan.nodes_per_tile)
    data: dict[str, Any] = {
        "needed": one.largest_threshold.astype("f4"),
        "limit_needed": atlas.limit_needed,
        "holding_share": _share(atlas, "holding"),
        "exceeding_share": _share(atlas, "exceeding"),
        "needed_quantile": _quantiles(atlas),
        "failing_share": (failing.exceeding / nodes).astype("f4"),
        "failing_restitution": _reach(plan.edges, failing.exceeding, "restitution"),
        "failing_position": _reach(plan.positions, failing.exceeding, "position"),
        "unstable_share": _share(atlas, "unstable"),
        "law_stated": atlas.law_stated.sum(("n", *_TILES)),
        "law_exceeding": atlas.law_exceeding.sum(("n", *_TILES)),
        **_worst(atlas, rule_of_thumb),
        **_drawn(plan),
    }
    numbers = {
        "orbits": plan.orbits,
        "sought_orbits": int(atlas.sought.sum()),
        "farthest": float(atlas.farthest.max()),
        "resolution": plan.resolution,
        "summary_tolerance": tolerance,
        "rule_of_thumb": rule_of_thumb,
    }
    found = xr.Dataset({name: _bare(value) for name, value in (data | numbers).items()})
    return describe(found)


def _bare(value: Any) -> Any:
    """A variable without the coordinates that were picked from."""
    return value.reset_coords(drop=True) if isinstance(value, xr.DataArray) else value


_TILES = ("restitution", "position")


def _share(atlas: xr.Dataset, name: str) -> xr.DataArray:
    """Share of the nodes of each rule and n of which something is counted."""
    nodes = atlas.threshold_counts.isel(model=0, quantity=0, tolerance=0, drop=True)
    return atlas[name].sum(_TILES) / nodes.sum(("threshold_bin", *_TILES))


def _quantiles(atlas: xr.Dataset) -> xr.DataArray:
    """ϖ from which a share of the nodes is right: the upper end of a bin, or the largest of all."""
    counts = atlas.threshold_counts.sum(_TILES)
    share = (counts.cumsum("threshold_bin") / counts.sum("threshold_bin")).values
    bins = np.append(atlas.threshold_bin.values[1:], np.inf)
    dims = tuple(d for d in counts.dims if d != "threshold_bin")
    largest = atlas.largest_threshold.max(_TILES).transpose(*dims).values
    ends = [bins[np.argmax(share >= q, axis=-1)] for q in QUANTILES[:-1]]
    found = [*(np.minimum(end, largest) for end in ends), largest]
    return xr.DataArray(
        np.stack(found, -1),
        {d: counts[d] for d in dims} | {"share": list(QUANTILES)},
        (*dims, "share"),
    )


def _reach(edges: np.ndarray, exceeding: xr.DataArray, along: str) -> xr.DataArray:
    """Upper end of the last range in which a node fails; 0 where none does."""
    others = [name for name in _TILES if name != along]
    fails = exceeding.sum(others) > 0
    ends = xr.DataArray(edges[1:], {along: exceeding[along]}, (along,))
    return ends.where(fails, 0.0).max(along)


def _worst(atlas: xr.Dataset, ratio: float) -> dict[str, xr.DataArray]:
    """The node with the largest error at a ϖ, for each rule, n, model and quantity."""
    there = atlas.sel({"frequency_ratio": ratio})
    error = there.largest_error.fillna(-np.inf)
    place = error.argmax(_TILES)
    return {
        "worst_error": error.isel(place),
        "worst_restitution": there.worst_restitution.isel(place),
        "worst_amplitude": there.worst_amplitude.isel(place),
    }


def _drawn(plan: AtlasParameters) -> dict[str, xr.DataArray]:
    """For the charts: Λ at the corners of the tiles, and the error law in their middles."""
    r, p = plan.edges, plan.positions
    n = np.array(plan.n)[:, np.newaxis]
    # The corners lie at r = 1 too, where there is no saddle-node above Λ = 0.
    low, high = restitution_orbit.saddle_node(n, r), restitution_orbit.period_doubling(n, r)
    corners = low[..., np.newaxis] + p * (high - low)[..., np.newaxis]
    middle_r, middle_p = (r[1:] + r[:-1]) / 2, (p[1:] + p[:-1]) / 2
    law = np.full((*plan.shape, len(middle_p), len(OF_ORBITS)), np.nan, "f4")
    limit = np.full((*plan.shape, len(OF_LIMITS)), np.nan)
    for row in plan.rows:
        place = np.unravel_index(row, plan.shape)
        nodes = plan.placed(row, np.full_like(middle_p, middle_r[place[-1]]), middle_p)
        orbits = nodes.n, nodes.damping_ratio, nodes.amplitude, nodes.release
        k, needed = coefficients(*orbits), law_thresholds(*orbits, plan.summary.tolerance)
        law[place] = np.abs([k[q] for q in OF_ORBITS]).T
        # The limits are the same for all positions.
        limit[place] = [needed[q][0] for q in OF_LIMITS]
    dims = ("release", "n", "restitution", "position", "quantity")
    return {
        "corner_amplitude": xr.DataArray(
            corners.astype("f4"), dims=("n", "restitution_edge", "position_edge")
        ),
        "restitution_edge": xr.DataArray(r, dims="restitution_edge"),
        "position_edge": xr.DataArray(p, dims="position_edge"),
        "limit_law_needed": xr.DataArray(limit, dims=(*dims[:3], "limit_quantity")),
        "law_coefficient": xr.DataArray(law, dims=dims),
    }
