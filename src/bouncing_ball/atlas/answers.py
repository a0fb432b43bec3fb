"""The answers that are stored for the orbits of a tile: thresholds and counts.

Nodes are walked in blocks. The thresholds of each node and its errors at the examined ϖ are kept
until the tiles of the block are complete. The files contain the answers of tiles, which are maxima
and counts over the nodes, so that the size of the files does not grow with the number of nodes.
"""

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.error_law import remainder
from bouncing_ball.accuracy.errors import orbit_errors
from bouncing_ball.accuracy.quantities import OF_ORBITS
from bouncing_ball.atlas.crossings import last_crossings
from bouncing_ball.atlas.plan import Plan
from bouncing_ball.atlas.walk import walk
from bouncing_ball.contacts.signature import Signature

BLOCK = 1024
"""Number of nodes walked at the same time: the arrays are long and still fit into the cache."""
PER_DECADE = 10
"""Number of bins per decade of ϖ in the histograms of thresholds."""


def threshold_bins(ratios: np.ndarray) -> np.ndarray:
    """Lower bounds of the bins of thresholds: 0 for errors within the tolerance at all ϖ, and
    infinity for errors that exceed it at the largest ϖ.

    ``ratios`` are the ϖ of the atlas, increasing, shape (k,).

    Examples
    --------
    >>> threshold_bins(np.array([3.0, 4.0])).round(3).tolist()
    [0.0, 2.512, 3.162, 3.981, inf]
    >>> threshold_bins(np.array([10.0, 12.0])).tolist()
    [0.0, 10.0, inf]
    """
    low, high = (np.floor(PER_DECADE * np.log10(ratios[k]) + 1e-9) for k in (0, -1))
    return np.array([0.0, *10 ** (np.arange(low, high + 1) / PER_DECADE), np.inf])


def _of_nodes(plan: Plan, row: int, index: np.ndarray) -> xr.Dataset:
    """The answers of some nodes of a row, over ``node``."""
    nodes, down = plan.nodes(row, index), plan.ratios[::-1]
    steps = list(walk(nodes, plan.ratios))
    error = np.concatenate([np.moveaxis(orbit_errors(step.orbit), 2, 0) for step in steps])
    stable = np.concatenate([step.stable for step in steps])
    # The walk goes down in ϖ, whereas the examined ϖ increase.
    at = np.flatnonzero(np.isin(down, plan.examined))[::-1]
    examined = np.moveaxis(error[at], 0, 2)
    signature = Signature(nodes.contact(down[at, np.newaxis]))
    # One quantity after another, because the errors of all quantities do not fit into the cache.
    each = error.reshape(len(down), -1, len(index))
    found = [
        last_crossings(down, each[:, k], np.array(plan.tolerances)) for k in range(each.shape[1])
    ]
    threshold = np.stack(found, axis=1).reshape(-1, *error.shape[1:])
    left = remainder(nodes.n, signature(), nodes.amplitude, examined[0], OF_ORBITS)
    ratio = "frequency_ratio"
    return xr.Dataset(
        {
            "threshold": (("tolerance", "model", "quantity", "node"), threshold),
            "error": (("model", "quantity", ratio, "node"), examined),
            "stated": (("quantity", ratio, "node"), left.stated),
            "exceeded": (("quantity", ratio, "node"), left.stated & left.exceeded),
            "unstable": ((ratio, "node"), ~stable[at]),
            "sought": ("node", sum(step.sought.sum(axis=0) for step in steps)),
        }
    )


def row_answers(plan: Plan, row: int) -> xr.Dataset:
    """The answers of the tiles of a row, over ``position``.

    ``largest_threshold`` is the largest ϖ that a node of a tile needs; the other variables are
    numbers of nodes. Dimensions are model, quantity, tolerance, threshold_bin and the examined ϖ.
    """
    size = plan.nodes_per_tile * max(1, BLOCK // plan.nodes_per_tile)
    every = np.arange(plan.nodes_per_row)
    parts = [_of_tiles(plan, row, every[k : k + size]) for k in range(0, len(every), size)]
    return xr.concat(parts, "position")


def _of_tiles(plan: Plan, row: int, nodes: np.ndarray) -> xr.Dataset:
    """The answers of some tiles of a row; during the computation each node takes 3 kB."""
    starts, bins = range(0, len(nodes), BLOCK), threshold_bins(plan.ratios)
    blocks = [_of_nodes(plan, row, nodes[k : k + BLOCK]) for k in starts]
    tiles = xr.concat(blocks, "node").coarsen(node=plan.nodes_per_tile)
    each = tiles.construct(node=("position", "own"))
    # A bin excludes its upper end. The first bin is an exception: it contains the thresholds that
    # are equal to the smallest ϖ.
    place = np.searchsorted(bins, each.threshold, side="right") - 1
    place = np.where(each.threshold <= plan.ratios[0] * (1 + 1e-12), 0, place)
    in_bins = np.stack([np.sum(place == k, axis=-1) for k in range(len(bins))])
    examined = xr.Variable("frequency_ratio", sorted(plan.examined))
    tolerances = xr.Variable("tolerance", list(plan.tolerances))
    counts = {
        "threshold_counts": (("threshold_bin", *each.threshold.dims[:-1]), in_bins),
        "holding": (each.threshold <= examined).sum("own"),
        "exceeding": (abs(each.error).fillna(np.inf) > tolerances).sum("own"),
        "law_stated": each.stated.sum("own"),
        "law_exceeding": each.exceeded.sum("own"),
        "unstable": each.unstable.sum("own"),
        "sought": each.sought.sum("own"),
    }
    largest = each.threshold.max("own")
    found = xr.Dataset(counts).astype(np.int32).assign(largest_threshold=largest)
    order = ("position", "model", "quantity", "tolerance", "threshold_bin", "frequency_ratio")
    return found.transpose(*order)
