r"""What is kept of the orbits of tiles: thresholds, extremes and counts.

Blocks of nodes are walked one after another; of each node its thresholds are kept, and its
errors at the examined ϖ. The answers of a tile, of which the files are made, are maxima of
them and counts: they do not grow with the number of nodes.
"""

from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.error_law import remainder
from bouncing_ball.accuracy.errors import modulus, orbit_errors
from bouncing_ball.accuracy.quantities import OF_ORBITS
from bouncing_ball.atlas.crossings import last_crossings
from bouncing_ball.atlas.plan import Plan
from bouncing_ball.atlas.walk import walk
from bouncing_ball.contacts.signature import Signature

BLOCK = 1024
"""Nodes walked at once: as many as make long arrays, and keep the walk in the cache."""
PER_DECADE = 10
"""Bins of the histograms of thresholds in a decade of ϖ."""


def threshold_bins(ratios: np.ndarray) -> np.ndarray:
    """Lower bounds of the bins: 0 for what holds at all ϖ, infinity for what never does.

    Examples
    --------
    >>> threshold_bins(np.array([3.0, 4.0])).round(3).tolist()
    [0.0, 2.512, 3.162, 3.981, inf]
    """
    low, high = (np.floor(PER_DECADE * np.log10(ratios[k]) + 1e-9) for k in (0, -1))
    return np.array([0.0, *10 ** (np.arange(low, high + 1) / PER_DECADE), np.inf])


def _of_nodes(plan: Plan, row: int, index: np.ndarray) -> dict[str, np.ndarray]:
    """What is kept of some nodes of a row, the last axis."""
    nodes, down = plan.nodes(row, index), plan.ratios[::-1]
    steps = list(walk(nodes, plan.ratios))
    error = np.concatenate([np.moveaxis(orbit_errors(step.orbit), 2, 0) for step in steps])
    stable = np.concatenate([step.stable for step in steps])
    # ϖ came down; the examined ones increase.
    at = np.flatnonzero(np.isin(down, plan.examined))[::-1]
    examined = np.moveaxis(error[at], 0, 2)
    signature = Signature(nodes.contact(down[at, np.newaxis]))
    left = remainder(nodes.n, signature(), nodes.amplitude, examined[0], OF_ORBITS)
    threshold = last_crossings(down, error, np.array(plan.tolerances))
    return {
        "threshold": np.moveaxis(threshold, 0, 2),
        "error": examined,
        "stated": left.stated,
        "exceeded": left.stated & left.exceeded,
        "unstable": ~stable[at],
        "sought": sum(step.sought.sum(axis=0) for step in steps),
        "restitution": nodes.restitution,
        "amplitude": nodes.amplitude,
    }


def row_answers(plan: Plan, row: int) -> xr.Dataset:
    """The answers of the tiles of a row, which are its positions."""
    every = np.arange(plan.nodes_per_row)
    blocks = [_of_nodes(plan, row, every[k : k + BLOCK]) for k in range(0, len(every), BLOCK)]
    # The last two axes are the tiles and the nodes in each.
    node: dict[str, np.ndarray] = {}
    for name in blocks[0]:
        joined = np.concatenate([block[name] for block in blocks], axis=-1)
        node[name] = joined.reshape(*joined.shape[:-1], plan.position.tiles, -1)
    threshold, error, bins = node["threshold"], node["error"], threshold_bins(plan.ratios)
    size = np.where(np.isfinite(error), np.abs(error), -np.inf)
    # The first of the nodes with the largest error; none where no error is finite.
    largest, worst = size.max(axis=-1), size.argmax(axis=-1)
    worst_of = {
        name: np.where(largest >= 0, node[name][np.arange(plan.position.tiles), worst], np.nan)
        for name in ("restitution", "amplitude")
    }
    place = np.searchsorted(bins, threshold, side="right") - 1
    place = np.where(threshold <= plan.ratios[0] * (1 + 1e-12), 0, place)
    exceeding = modulus(error)[:, :, np.newaxis] > np.reshape(plan.tolerances, (-1, 1, 1, 1))
    holding = [threshold <= ratio for ratio in sorted(plan.examined)]
    of_error, of_threshold = ("model", "quantity"), ("model", "quantity", "tolerance")
    ratio, tile = "frequency_ratio", "position"

    def total(which: np.ndarray) -> np.ndarray:
        return which.sum(axis=-1, dtype=np.int32)

    data: dict[str, Any] = {
        "largest_threshold": ((*of_threshold, tile), threshold.max(axis=-1)),
        "threshold_counts": (
            ("threshold_bin", *of_threshold, tile),
            np.stack([total(place == k) for k in range(len(bins))]),
        ),
        "holding": ((ratio, *of_threshold, tile), total(np.stack(holding))),
        "exceeding": ((*of_threshold, ratio, tile), total(exceeding)),
        "largest_error": ((*of_error, ratio, tile), largest),
        "worst_restitution": ((*of_error, ratio, tile), worst_of["restitution"]),
        "worst_amplitude": ((*of_error, ratio, tile), worst_of["amplitude"]),
        "law_stated": (("quantity", ratio, tile), total(node["stated"])),
        "law_exceeding": (("quantity", ratio, tile), total(node["exceeded"])),
        "unstable": ((ratio, tile), total(node["unstable"])),
        "sought": ((tile,), total(node["sought"])),
    }
    order = (tile, *of_threshold, "threshold_bin", ratio)
    return xr.Dataset(data).transpose(*order, missing_dims="ignore")
