r"""What is kept of the errors of a tile's nodes: thresholds, extremes and counts.

All of it is a maximum, a minimum or a count, so that a tile may be computed in any
pieces; only counts grow with the number of nodes, and their size does not.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from bouncing_ball.accuracy.error_law import STATED
from bouncing_ball.atlas.crossings import LastCrossings
from bouncing_ball.atlas.errors import MODELS, Law

PER_DECADE = 10
"""Bins of the histograms of thresholds in a decade of ϖ."""
LAW_BINS = np.array([-np.inf, -1, 0, 0.5, 0.8, 0.9, 0.95, 0.99, 1.01, 1.05, 1.1, 1.2, 1.5, 2, 5])
"""Lower bounds of the bins of error over law."""

THRESHOLD = ("model", "quantity", "tolerance")
ERROR = ("model", "quantity", "frequency_ratio")
_LAW = ("quantity", "frequency_ratio")
DIMENSIONS: Mapping[str, tuple[str, ...]] = {
    "largest_threshold": THRESHOLD,
    "smallest_threshold": THRESHOLD,
    "threshold_counts": (*THRESHOLD, "threshold_bin"),
    "holding": (*THRESHOLD, "frequency_ratio"),
    "exceeding": (*THRESHOLD, "frequency_ratio"),
    "largest_error": ERROR,
    "worst_restitution": ERROR,
    "worst_amplitude": ERROR,
    "absent": ERROR,
    "law_counts": (*_LAW, "law_bin"),
    "law_stated": _LAW,
    "law_exceeding": _LAW,
}
"""The answers, by their names, with their dimensions after the tile."""
_WORST = ("worst_restitution", "worst_amplitude")
_COMBINE: Mapping[str, Any] = {"largest_threshold": np.maximum, "smallest_threshold": np.minimum}

Answers = dict[str, np.ndarray]
"""Arrays by name, the tiles along the first axis."""


@dataclass(frozen=True)
class Tiled:
    """Nodes in order of their tiles, and what is asked of their errors."""

    tile: np.ndarray
    """Index of each node's tile, ascending without a gap from 0."""
    restitution: np.ndarray
    amplitude: np.ndarray
    law: Law
    tolerances: np.ndarray
    ratios: np.ndarray
    """All ϖ of the walk, increasing."""
    examined: np.ndarray
    """Those of them at which the errors are described."""

    @property
    def starts(self) -> np.ndarray:
        """Index of the first node of each tile."""
        return np.searchsorted(self.tile, np.arange(self.tile[-1] + 1))


def threshold_bins(ratios: np.ndarray) -> np.ndarray:
    """Lower bounds of the bins: 0 for what holds at all ϖ, infinity for what never does.

    Examples
    --------
    >>> threshold_bins(np.array([3.0, 4.0])).round(3).tolist()
    [0.0, 2.512, 3.162, 3.981, inf]
    """
    low, high = (np.floor(PER_DECADE * np.log10(ratios[k]) + 1e-9) for k in (0, -1))
    return np.array([0.0, *10 ** (np.arange(low, high + 1) / PER_DECADE), np.inf])


def combined(one: Answers, other: Answers) -> Answers:
    """The answers of the same tiles from two sets of their nodes, the first come first."""
    both = {
        name: _COMBINE.get(name, np.add)(one[name], other[name])
        for name in DIMENSIONS
        if name not in (*_WORST, "largest_error")
    }
    worse = other["largest_error"] > one["largest_error"]
    for name in (*_WORST, "largest_error"):
        both[name] = np.where(worse, other[name], one[name])
    return both


def answers(nodes: Tiled, errors: Iterator[tuple[np.ndarray, np.ndarray]]) -> Answers:
    """The answers of each tile from signed errors, some ϖ after others from the largest.

    Parameters
    ----------
    nodes : Tiled
    errors : iterator of (ndarray, ndarray)
        ϖ, decreasing, and errors of shape (ϖ, model, quantity, nodes).
    """
    quantities = len(nodes.law.coefficient)
    found = LastCrossings(nodes.tolerances, (len(MODELS), quantities, len(nodes.tile)))
    described = []
    for ratios, error in errors:
        found.meet(ratios, error)
        at = np.nonzero(np.isin(ratios, nodes.examined))[0]
        described += [_described(nodes, ratios[k], error[k]) for k in at]
    # ϖ came down; the answers are in order of the examined ones, which increase.
    columns = {
        name: np.stack([part[name] for part in described[::-1]], -1) for name in described[0]
    }
    columns["law_counts"] = np.moveaxis(columns["law_counts"], -1, -2)
    return columns | _of_thresholds(nodes, np.moveaxis(found.thresholds(), 0, 2))


def _per_tile(nodes: Tiled, combine: np.ufunc, values: np.ndarray) -> np.ndarray:
    """Values along the last axis, reduced tile by tile; the tiles come first."""
    values = values.astype(np.int32) if values.dtype == bool else values
    reduced = combine.reduceat(values, nodes.starts, axis=-1)
    return np.moveaxis(reduced.astype(values.dtype), -1, 0)


def _histogram(nodes: Tiled, index: np.ndarray, bins: int) -> np.ndarray:
    """Counts of bin numbers along the last axis, shape (tile, ..., bin)."""
    tiles, leading = int(nodes.tile[-1]) + 1, index.shape[:-1]
    cell = np.arange(int(np.prod(leading))).reshape(*leading, 1)
    flat = (nodes.tile * cell.size + cell) * bins + index
    counts = np.bincount(flat.ravel(), minlength=tiles * cell.size * bins)
    return counts.reshape(tiles, *leading, bins).astype(np.int32)


def _of_thresholds(nodes: Tiled, threshold: np.ndarray) -> Answers:
    """Of thresholds, shape (model, quantity, tolerance, nodes)."""
    bins, ratios = threshold_bins(nodes.ratios), nodes.ratios
    index = np.searchsorted(bins, threshold, side="right") - 1
    index = np.where(threshold <= ratios[0] * (1 + 1e-12), 0, index)
    holding = [_per_tile(nodes, np.add, threshold <= ratio) for ratio in nodes.examined]
    return {
        "largest_threshold": _per_tile(nodes, np.maximum, threshold),
        "smallest_threshold": _per_tile(nodes, np.minimum, threshold),
        "threshold_counts": _histogram(nodes, index, len(bins)),
        "holding": np.stack(holding, axis=-1),
    }


def _described(nodes: Tiled, ratio: float, error: np.ndarray) -> Answers:
    """Of the errors at one ϖ, shape (model, quantity, nodes)."""
    there = np.isfinite(error)
    size = np.where(there, np.abs(error), -np.inf)
    largest = np.maximum.reduceat(size, nodes.starts, axis=-1)
    # The first of the nodes with the largest error; none where no error is finite.
    order = np.arange(len(nodes.tile))
    at_worst = (size == np.take(largest, nodes.tile, axis=-1)) & there
    first = np.minimum.reduceat(np.where(at_worst, order, len(order)), nodes.starts, axis=-1)
    known = np.append(nodes.restitution, np.nan), np.append(nodes.amplitude, np.nan)
    infinite = np.where(there, np.abs(error), np.inf)
    exceeding = infinite[:, :, np.newaxis] > nodes.tolerances[:, np.newaxis]
    return {
        "exceeding": _per_tile(nodes, np.add, exceeding),
        "largest_error": np.moveaxis(largest, -1, 0),
        "worst_restitution": np.moveaxis(known[0][first], -1, 0),
        "worst_amplitude": np.moveaxis(known[1][first], -1, 0),
        "absent": _per_tile(nodes, np.add, ~there),
        **_against_law(nodes, ratio, error[0]),
    }


def _against_law(nodes: Tiled, ratio: float, error: np.ndarray) -> Answers:
    """The restitution model's errors over what the law says, shape (quantity, nodes)."""
    law, there = nodes.law, np.isfinite(error)
    predicted = law.coefficient / ratio**law.order
    with np.errstate(divide="ignore", invalid="ignore"):
        share = error / predicted
    # What is not there is counted in a bin of its own, which is then dropped.
    index = np.where(np.isfinite(share), np.searchsorted(LAW_BINS, share, side="right") - 1, 0)
    index = np.where(np.isfinite(share), index, len(LAW_BINS))
    stated = there & (law.small / ratio < STATED) & np.isfinite(law.remainder)
    with np.errstate(invalid="ignore"):
        beyond = np.abs(error - predicted) > law.remainder * law.small / ratio**2
    return {
        "law_counts": _histogram(nodes, index, len(LAW_BINS) + 1)[..., :-1],
        "law_stated": _per_tile(nodes, np.add, stated),
        "law_exceeding": _per_tile(nodes, np.add, stated & beyond),
    }
