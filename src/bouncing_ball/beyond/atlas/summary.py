"""The summary of the atlas, which is small enough for the accepted record.

It contains the frequency ratio needed for one tolerance over r, Λ and n; the shares of the nodes
for which a rule of thumb holds; the suprema of the errors over all orbits in the range of the
atlas, including those between nodes; and the accuracy of the error law.

For a supremum, the modulus of an error is maximised over r and over all Λ at which both the contact
and the simple model have the orbit, up to the restitution model's period doubling. This common
range begins at the higher one of the two saddle-nodes. For the corrected model it reaches below the
saddle-node of the restitution model, and so below the nodes of the atlas. The position in this
range is called p here. Next to the saddle-node, p = 0, where most errors are largest, they vary
with √p; the grid, which is refined around its largest value, is therefore even in √p.
"""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.error_law import coefficients
from bouncing_ball.accuracy.errors import (
    OF_LIMITS,
    OF_ORBITS,
    Quantity,
    modulus,
    paper_error,
    values,
)
from bouncing_ball.accuracy.simple_models import SIMPLE, exact_and_simple_models
from bouncing_ball.accuracy.thresholds import thresholds
from bouncing_ball.beyond.atlas.plan import Nodes, Plan
from bouncing_ball.beyond.atlas.shards import VARIABLES as OF_SHARDS
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.models.model import Model
from bouncing_ball.periodic.one_impact import n_t
from bouncing_ball.periodic.one_impact import restitution_branch as restitution_orbit

VARIABLES = {
    "needed": Variable("ϖ from which the error of all nodes of a tile is tolerated", symbol="ϖ"),
    "needed_quantile": Variable(
        "ϖ from which the error of a share of nodes is tolerated", symbol="ϖ"
    ),
    "holding_share": Variable("share of nodes whose error is tolerated from this ϖ on"),
    "exceeding_share": Variable("share of nodes whose error exceeds the tolerance at this ϖ"),
    "failing_restitution": Variable(
        "r below which the error of the greatest height exceeds the tolerance", symbol="r"
    ),
    "unstable_share": Variable("share of nodes whose exact orbit is not stable"),
    "supremum": Variable("supremum of the relative error where the rule of thumb begins"),
    "supremum_restitution": Variable("r at which the error has its supremum", symbol="r"),
    "supremum_position": Variable(
        "place of this supremum in the range of Λ in which both models have the orbit"
    ),
    "supremum_quantity": Variable("quantity of an orbit, or limit"),
    "supremum_needed": Variable("ϖ from which the error of all orbits is tolerated", symbol="ϖ"),
    "needed_restitution": Variable(
        "r of the last orbit whose error exceeds the tolerance as ϖ rises", symbol="r"
    ),
    "restitution_edge": Variable("ends of the ranges of r", symbol="r"),
    "position_edge": Variable("ends of the ranges of positions"),
    "law_coefficient": Variable(
        "modulus of the error law's K in the middle of the tile", symbol="|K|"
    ),
    "sought_orbits": Variable("orbits that the walk did not reach, looked for directly"),
    "resolution": Variable("largest relative step of ϖ: a threshold lies within one"),
    "summary_tolerance": Variable("relative error tolerated in the summary"),
    "rule_of_thumb": Variable("frequency ratio that is said to be enough", symbol="ϖ"),
}
# Number of points along r and √p, and of grids. Each grid divides the distance of the points by
# four, so that the place of a maximum is known to 1/2000 of the range. The maximum itself is known
# to the square of this, unless it lies at an end of the range, which is a point of every grid.
_POINTS = 9
_ROUNDS = 5
# Smallest √p, next to the saddle-node.
_NEAREST = 1e-6
# The phase of the restitution model is 0 at the saddle-node, so that its relative error grows as
# 1/√p. No other error of an existing orbit exceeds this bound, unless the phase of the simple model
# passes through zero.
_UNBOUNDED = 1e3
TOLERANCE = 0.01
"""The tolerance of charts and tables."""

RULE_OF_THUMB = 100.0
"""The ϖ above which the paper regards the restitution model as accurate."""

QUANTILES = (0.5, 0.9, 0.99)
_TILES = ("restitution", "position")
# Factor that keeps r below 1: at r = 1 the saddle-node is at Λ = 0, and its relative error is 0/0.
_BELOW = 1 - 1e-9
# Number of ϖ that are scanned for a crossing.
_SCANNED = 12


class Largest(NamedTuple):
    """The largest error, and the r and the p of its orbit."""

    error: float
    restitution: float
    position: float


def compared_models(plan: Plan, row: int, model: str, ratio: float, r: np.ndarray) -> list[Model]:
    """The exact and a simple model of the contacts of a row that have r, at one ϖ."""
    contact = plan.placed(row, r, np.zeros_like(r)).contact(ratio)
    exact, *simple = exact_and_simple_models(contact)
    return [exact, simple[SIMPLE.index(model)]]


def in_common_range(
    plan: Plan, row: int, model: str, ratio: float, r: np.ndarray, p: np.ndarray
) -> Nodes:
    """Nodes in the range of Λ in which the contact and a simple model have stable orbits.

    The range begins at the higher saddle-node of the two and ends at the period doubling of the
    restitution model. A branch without a saddle-node does not limit it.

    Parameters
    ----------
    plan : Plan
    row : int
        A row, of which the rule and the n are used.
    model : str
        One of :data:`SIMPLE`.
    ratio : float
        ϖ.
    r, p : ndarray
        Restitution coefficients and positions in the range, arrays of one shape.
    """
    each, where = np.unique(r, return_inverse=True)
    nodes = plan.placed(row, r, np.zeros_like(r))
    exact, simple = (
        n_t.saddle_node(one, nodes.n).amplitude
        for one in compared_models(plan, row, model, ratio, each)
    )
    low = np.fmax(exact, simple)[where.reshape(r.shape)]
    high = restitution_orbit.period_doubling(nodes.n, r)
    return Nodes(nodes.release, nodes.n, r, low + p * (high - low))


def largest_error(
    plan: Plan, row: int, kind: tuple[str, Quantity], ratio: float, low: float, high: float = 0.0
) -> Largest:
    """The largest error at ϖ over p and a range of r, or at one r, for the rule and n of a row.

    ``kind`` is the model and the quantity. The error is infinite if it is unbounded, or if there is
    no common range of Λ.
    """
    model, quantity = kind
    # The bifurcations and the permanent contact do not depend on p.
    first = 1.0 if quantity in OF_LIMITS else _NEAREST
    # The corners of the range of (r, √p).
    start = np.array([low, first])
    end = np.array([high or low, 1.0])
    unbounded = False
    for _ in range(_ROUNDS):
        along_r, along_root = np.linspace(start, end, _POINTS).T
        r, root = map(np.ravel, np.meshgrid(np.unique(along_r), np.unique(along_root)))
        nodes = in_common_range(plan, row, model, ratio, r, root**2)
        exact, simple = (
            values(one, nodes.n, nodes.amplitude, [quantity])[0]
            for one in compared_models(plan, row, model, ratio, r)
        )
        size = modulus(paper_error(exact=exact, simple=simple))
        best = int(size.argmax())
        # A value that passes through zero makes the relative error infinite.
        passes_zero = bool(np.any(simple < 0) and np.any(simple > 0))
        unbounded |= passes_zero or size[best] >= _UNBOUNDED
        place = np.array([r[best], root[best]])
        step = (end - start) / (_POINTS - 1)
        start = np.maximum(start, place - step)
        end = np.minimum(end, place + step)
    error = np.inf if unbounded else float(size[best])
    return Largest(error, float(place[0]), float(place[1]) ** 2)


def tolerated(error: Callable[[float], float], grid: np.ndarray, tolerance: float) -> float:
    """The point of ``grid``'s range above which an error is within the tolerance.

    It is found by :func:`~bouncing_ball.accuracy.thresholds.thresholds`, and is NaN if the
    error is within the tolerance at all points of the grid, or exceeds it at the last point.

    Examples
    --------
    >>> [round(tolerated(lambda x: 1 / x, np.array([1.0, 3.0]), y), 9) for y in (0.5, 2.0, 0.1)]
    [2.0, nan, nan]
    """

    def each(places: np.ndarray, _: object) -> np.ndarray:
        return np.array([error(place) for place in places])

    return thresholds(each, grid, each(grid, None)[np.newaxis], tolerance).ratio.item()


def _error(find: Callable[[float], Largest]) -> Callable[[float], float]:
    return lambda place: find(place).error


def suprema(plan: Plan, rule: float, tolerance: float) -> dict[str, tuple]:
    """The suprema at one ϖ, and the ϖ and r above which they are within the tolerance.

    Over (release, n, model, supremum_quantity) the variables are ``supremum``, at the ϖ of the
    rule, with its place in ``supremum_restitution`` and ``supremum_position``; and
    ``supremum_needed``, the ϖ above which all orbits are within the tolerance, with the r of the
    last orbit that is not, ``needed_restitution``. Over (release, n) the variable is
    ``failing_restitution``: at the ϖ of the rule, the error of the greatest height of the
    restitution model exceeds the tolerance below this r. The ϖ and this r are computed by
    :func:`tolerated`.
    """
    rules, families, tiles = plan.shape
    quantities = tuple(Quantity)
    shape = rules, families, len(SIMPLE), len(quantities)
    names = "supremum", "supremum_restitution", "supremum_position"
    found = {name: np.empty(shape) for name in (*names, "supremum_needed", "needed_restitution")}
    failing = np.empty((rules, families))
    scanned = np.geomspace(plan.ratios[0], plan.ratios[-1], _SCANNED)
    for place in np.ndindex(rules, families):
        rows = np.ravel_multi_index((*place, np.arange(tiles)), plan.shape)
        edges = _BELOW * plan.edges[np.append(np.isin(rows, plan.rows), True)]
        for model, quantity in np.ndindex(shape[2:]):
            at = (*place, model, quantity)
            worst = partial(largest_error, plan, rows[0], (SIMPLE[model], quantities[quantity]))
            along_ratio = partial(worst, low=edges[0], high=edges[-1])
            for name, value in zip(names, along_ratio(rule), strict=True):
                found[name][at] = value
            needed = tolerated(_error(along_ratio), scanned, tolerance)
            last = along_ratio(needed).restitution if np.isfinite(needed) else np.nan
            found["supremum_needed"][at] = needed
            found["needed_restitution"][at] = last
        of_height = partial(
            largest_error, plan, rows[0], ("restitution", Quantity.MAX_HEIGHT), rule
        )
        failing[place] = tolerated(_error(of_height), edges, tolerance)
    dims = ("release", "n", "model", "supremum_quantity")
    return {
        **{name: (dims, every) for name, every in found.items()},
        "failing_restitution": (("release", "n"), failing),
    }


def summary(plan: Plan, atlas: xr.Dataset) -> xr.Dataset:
    """The summary for one tolerance and for the rule that a ϖ above a given value is enough.

    The tolerance and the ϖ of the rule are those of the atlas that are nearest to
    :data:`TOLERANCE` and :data:`RULE_OF_THUMB`.
    """
    near = atlas.sel({"tolerance": TOLERANCE, "frequency_ratio": RULE_OF_THUMB}, method="nearest")
    tolerance = float(near.tolerance)
    rule = float(near.frequency_ratio)
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
        "orbits": plan.orbit_count,
        "sought_orbits": int(atlas.sought.sum()),
        "resolution": plan.resolution,
        "summary_tolerance": tolerance,
        "rule_of_thumb": rule,
        **suprema(plan, rule, tolerance),
    }
    edges = {"restitution_edge": plan.edges, "position_edge": plan.positions}
    return described(
        data,
        edges | {"supremum_quantity": list(map(str, Quantity))},
        variables=OF_SHARDS | VARIABLES,
    )


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
    middle_r = (plan.edges[1:] + plan.edges[:-1]) / 2
    middle_p = (plan.positions[1:] + plan.positions[:-1]) / 2
    law = np.full((*plan.shape, len(middle_p), len(OF_ORBITS)), np.nan, "f4")
    for row in plan.rows:
        place = np.unravel_index(row, plan.shape)
        nodes = plan.placed(row, np.full_like(middle_p, middle_r[place[-1]]), middle_p)
        k = coefficients(nodes.n, nodes.damping_ratio, nodes.amplitude, nodes.release)
        law[place] = np.abs([k[q] for q in OF_ORBITS]).T
    return xr.Variable(("release", "n", *_TILES, "quantity"), law)
