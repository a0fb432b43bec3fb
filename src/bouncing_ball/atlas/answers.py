r"""What is kept of the orbits of tiles: thresholds, extremes and counts.

All of it is a maximum or a count, so that the tiles of a row may be computed in any
pieces: blocks of nodes are walked one after another, and their answers combined. The memory
does not grow with the number of nodes, and neither do the answers.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np

from bouncing_ball.accuracy.error_law import remainder
from bouncing_ball.accuracy.errors import SIMPLE, modulus, orbit_errors
from bouncing_ball.accuracy.quantities import OF_ORBITS
from bouncing_ball.atlas.crossings import LastCrossings
from bouncing_ball.atlas.plan import Nodes, Plan
from bouncing_ball.atlas.walk import TOGETHER, walk
from bouncing_ball.contacts.signature import Signature

BLOCK = 8192 // TOGETHER
"""Nodes walked at once: as many as keep the arrays in the cache, some ϖ long."""
PER_DECADE = 10
"""Bins of the histograms of thresholds in a decade of ϖ."""

_THRESHOLD = ("model", "quantity", "tolerance")
_ERROR = ("model", "quantity", "frequency_ratio")
_LAW = ("quantity", "frequency_ratio")
_WORST = ("largest_error", "worst_restitution", "worst_amplitude")
KEPT: Mapping[str, tuple[tuple[str, ...], np.ufunc]] = {
    "largest_threshold": (_THRESHOLD, np.maximum),
    "threshold_counts": ((*_THRESHOLD, "threshold_bin"), np.add),
    "holding": ((*_THRESHOLD, "frequency_ratio"), np.add),
    "exceeding": ((*_THRESHOLD, "frequency_ratio"), np.add),
    # These three go together.
    **dict.fromkeys(_WORST, (_ERROR, np.maximum)),
    "law_stated": (_LAW, np.add),
    "law_exceeding": (_LAW, np.add),
    "unstable": (("frequency_ratio",), np.add),
    "sought": ((), np.add),
}
"""The answers, by their names: dimensions after the tile, and how those of some of its
nodes and of the others are combined."""

Answers = dict[str, np.ndarray]
"""Arrays by name, the tiles of a row along the first axis."""


@dataclass(frozen=True)
class Tiles:
    """Some nodes of a row in order of its tiles."""

    number: np.ndarray
    """That of each node's tile, ascending."""
    count: int
    """Number of tiles of the row."""

    def reduce(self, combine: np.ufunc, values: np.ndarray, empty: Any) -> np.ndarray:
        """Values along the last axis, reduced tile by tile; the tiles come first.

        Examples
        --------
        >>> Tiles(np.array([0, 0, 2]), 3).reduce(np.add, np.array([1, 2, 4]), 0).tolist()
        [3, 0, 4]
        """
        there, starts = np.unique(self.number, return_index=True)
        found = np.full((*values.shape[:-1], self.count), empty, values.dtype)
        found[..., there] = combine.reduceat(values, starts, axis=-1)
        return np.moveaxis(found, -1, 0)

    def total(self, which: np.ndarray) -> np.ndarray:
        """Numbers of nodes of which something is true."""
        return self.reduce(np.add, which.astype(np.int32), 0)

    def histogram(self, index: np.ndarray, bins: int) -> np.ndarray:
        """Counts of bin numbers along the last axis, shape (tile, ..., bin)."""
        leading = index.shape[:-1]
        cell = np.arange(int(np.prod(leading))).reshape(*leading, 1)
        flat = (self.number * cell.size + cell) * bins + index
        counts = np.bincount(flat.ravel(), minlength=self.count * cell.size * bins)
        return counts.reshape(self.count, *leading, bins).astype(np.int32)


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
    both = {name: combine(one[name], other[name]) for name, (_, combine) in KEPT.items()}
    worse = other["largest_error"] > one["largest_error"]
    return both | {name: np.where(worse, other[name], one[name]) for name in _WORST}


def row_answers(plan: Plan, row: int) -> Answers:
    """The answers of the tiles of a row."""
    starts = range(0, plan.nodes_per_row, BLOCK)
    # Combined as they come: no two blocks are in memory.
    return reduce(combined, (_block(plan, row, start) for start in starts))


def _block(plan: Plan, row: int, start: int) -> Answers:
    """The answers of some nodes, with nothing in the tiles of the others."""
    index = np.arange(start, min(start + BLOCK, plan.nodes_per_row))
    nodes, tiles = plan.nodes(row, index), Tiles(index // plan.nodes_per_tile, plan.position.tiles)
    tolerances = np.array(plan.tolerances)
    crossings = LastCrossings(tolerances, (len(SIMPLE), len(OF_ORBITS), len(index)))
    described = []
    sought = np.zeros(len(index), np.int32)
    for step in walk(nodes, plan.ratios):
        error = orbit_errors(step.orbit)
        crossings.meet(step.frequency_ratio, np.moveaxis(error, 2, 0))
        sought += np.sum(step.sought, axis=0, dtype=np.int32)
        for k in np.flatnonzero(np.isin(step.frequency_ratio, plan.examined)):
            one, signature = error[:, :, k], Signature(nodes.contact(step.frequency_ratio[k]))
            left = remainder(nodes.n, signature(), nodes.amplitude, one[0], OF_ORBITS)
            described.append(
                _errors(nodes, tiles, tolerances, one)
                | {
                    "law_stated": tiles.total(left.stated),
                    "law_exceeding": tiles.total(left.stated & left.exceeded),
                    "unstable": tiles.total(~step.stable[k]),
                }
            )
    # ϖ came down; the answers are in order of the examined ones, which increase.
    columns = {
        name: np.stack([part[name] for part in described[::-1]], -1) for name in described[0]
    }
    return {
        **columns,
        **_thresholds(plan, tiles, np.moveaxis(crossings.thresholds(), 0, 2)),
        "sought": tiles.reduce(np.add, sought, 0),
    }


def _thresholds(plan: Plan, tiles: Tiles, threshold: np.ndarray) -> Answers:
    """Of thresholds, shape (model, quantity, tolerance, nodes)."""
    bins, ratios = threshold_bins(plan.ratios), plan.ratios
    index = np.searchsorted(bins, threshold, side="right") - 1
    index = np.where(threshold <= ratios[0] * (1 + 1e-12), 0, index)
    holding = [tiles.total(threshold <= ratio) for ratio in sorted(plan.examined)]
    return {
        "largest_threshold": tiles.reduce(np.maximum, threshold, -np.inf),
        "threshold_counts": tiles.histogram(index, len(bins)),
        "holding": np.stack(holding, axis=-1),
    }


def _errors(nodes: Nodes, tiles: Tiles, tolerances: np.ndarray, error: np.ndarray) -> Answers:
    """Of the errors at one ϖ, shape (model, quantity, nodes)."""
    there, order = np.isfinite(error), np.arange(error.shape[-1])
    size = np.where(there, np.abs(error), -np.inf)
    largest = tiles.reduce(np.maximum, size, -np.inf)
    # The first of the nodes with the largest error; none where no error is finite.
    at_worst = (size == np.moveaxis(largest[tiles.number], 0, -1)) & there
    first = tiles.reduce(np.minimum, np.where(at_worst, order, len(order)), len(order))
    exceeding = modulus(error)[:, :, np.newaxis] > tolerances[:, np.newaxis]
    return {
        "exceeding": tiles.total(exceeding),
        "largest_error": largest,
        "worst_restitution": np.append(nodes.restitution, np.nan)[first],
        "worst_amplitude": np.append(nodes.amplitude, np.nan)[first],
    }
