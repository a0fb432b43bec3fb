"""The answers that are stored for the orbits of a tile: thresholds and counts.

The threshold of an error is the ϖ above which the error stays within a tolerance. It is the first
crossing on a walk from the largest ϖ to the smallest. The threshold is interpolated within one step
of the walk, in logarithms, because ln(error) is nearly a straight line in ln ϖ, or along the error
itself if the error changes its sign. An excursion beyond the tolerance between two ϖ is detected by
the parabola through the nearest three ϖ.

Nodes are walked in blocks. The thresholds of each node and its errors at the examined ϖ are kept
until the tiles of the block are complete. The files contain the answers of tiles, which are maxima
and counts over the nodes, so that the size of the files does not grow with the number of nodes.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.error_law import remainder
from bouncing_ball.accuracy.errors import OF_ORBITS
from bouncing_ball.accuracy.simple_models import orbit_errors
from bouncing_ball.beyond.atlas.plan import Plan
from bouncing_ball.beyond.atlas.walk import walk
from bouncing_ball.models.laws.signature import Signature

# The error is bounded for the interpolation, because it is infinite where a model has no orbit.
_LARGEST = 1e3
_SMALLEST = 1e-300
BLOCK = 1024
"""Number of nodes walked at the same time: the arrays are long and still fit into the cache."""

PER_DECADE = 10
"""Number of bins per decade of ϖ in the histograms of thresholds."""


def last_crossings(ratios: np.ndarray, errors: np.ndarray, tolerances: np.ndarray) -> np.ndarray:
    """The thresholds of many errors, for each of several tolerances.

    Parameters
    ----------
    ratios : ndarray, shape (k,)
        ϖ, decreasing.
    errors : ndarray, shape (k, ...)
        The signed errors at these ϖ, with at least one more dimension. NaN counts as infinite.
    tolerances : ndarray, shape (m,)

    Returns
    -------
    ndarray, shape (m, ...)
        ϖ; infinite where the error exceeds the tolerance at the largest ϖ, and the smallest ϖ
        where it never exceeds the tolerance.

    Examples
    --------
    An error 1/ϖ is within 1 % above ϖ = 100, and is not within 0.01 % at any ϖ of the grid:

    >>> ratios = np.geomspace(1e3, 3.0, 20)
    >>> found = last_crossings(ratios, 1 / ratios[:, np.newaxis], np.array([0.5, 0.01, 0.0001]))
    >>> found[:, 0].round(9).tolist()
    [3.0, 100.0, inf]
    """
    x = np.log(ratios)
    errors = np.where(np.isnan(errors), np.inf, errors)
    # The running maximum from the largest ϖ downwards; this is four times as fast as accumulate.
    largest = np.abs(errors)
    for above, here in pairwise(largest):
        np.maximum(above, here, out=here)
    peaks = _peaks(x, errors)
    found = np.full((len(tolerances), *errors.shape[1:]), x[-1])
    for one, tolerance in zip(found, tolerances, strict=True):
        # The index of the first ϖ at which the error exceeds the tolerance.
        first = np.count_nonzero(largest <= tolerance, axis=0)
        crosses = np.nonzero(first < len(x))
        one[crosses] = _crossing(x, errors, (first[crosses], *crosses), tolerance)
        between = (peaks.middle <= tolerance) & (tolerance < peaks.height)
        # If there are several excursions before the crossing, the first is the threshold. It is
        # therefore written last.
        seen = np.flatnonzero(between & (peaks.step <= first[peaks.entry]))[::-1]
        width = np.sqrt((peaks.height[seen] - tolerance) / -peaks.curvature[seen])
        ends = np.minimum(peaks.place[seen] + width, x[peaks.step[seen] - 2])
        one[tuple(index[seen] for index in peaks.entry)] = ends
    return np.exp(found)


def _crossing(x: np.ndarray, errors: np.ndarray, at: tuple, tolerance: float) -> np.ndarray:
    """ln ϖ at which errors reach the tolerance, within the step that ends at the indices ``at``."""
    step, *entry = at
    # Beyond the largest ϖ no crossing can be located.
    start = step == 0
    left = np.where(start, 1.0, errors[step - 1, *entry])
    right = errors[at]
    turned = (left * right < 0) & np.isfinite(right)
    level = np.log(np.minimum(np.abs(right), _LARGEST) / tolerance)
    before = np.log(np.maximum(np.abs(left), _SMALLEST) / tolerance)
    share = level / np.where(start | turned, 1.0, level - before)
    straight = np.where(turned, right - left, 1.0)
    share = np.where(turned, (right - np.sign(right) * tolerance) / straight, share)
    return np.where(start, np.inf, x[step] + share * (x[step - 1] - x[step]))


class _Peaks(NamedTuple):
    """Parabolas through the errors at three neighbouring ϖ, whose apices lie between them."""

    # The index of the last of the three ϖ, and the indices of the entries.
    step: np.ndarray
    entry: tuple[np.ndarray, ...]
    # The modulus of the error at the middle ϖ and at the apex.
    middle: np.ndarray
    height: np.ndarray
    # ln ϖ of the apex, and half the second derivative.
    place: np.ndarray
    curvature: np.ndarray


def _peaks(x: np.ndarray, errors: np.ndarray) -> _Peaks:
    """The parabolas through errors that are largest at the middle of three ϖ; x is ln ϖ."""
    before = errors[:-2]
    here = errors[1:-1]
    after = errors[2:]
    with np.errstate(invalid="ignore"):
        highest = (here * (here - before) >= 0) & (here * (here - after) > 0)
    finite = np.isfinite(before) & np.isfinite(here) & np.isfinite(after)
    found = np.nonzero(highest & finite)
    step, *entry = found
    sign = np.sign(here[found])
    f0 = sign * before[found]
    f1 = sign * here[found]
    f2 = sign * after[found]
    x0 = x[step]
    x1 = x[step + 1]
    x2 = x[step + 2]
    first = (f1 - f0) / (x1 - x0)
    second = (f2 - f1) / (x2 - x1)
    curvature = (second - first) / (x2 - x0)
    slope = first + curvature * (x1 - x0)
    return _Peaks(
        step=step + 2,
        entry=tuple(entry),
        middle=f1,
        height=f1 - slope * slope / (4 * curvature),
        place=x1 - slope / (2 * curvature),
        curvature=curvature,
    )


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
    low = np.floor(PER_DECADE * np.log10(ratios[0]) + 1e-9)
    high = np.floor(PER_DECADE * np.log10(ratios[-1]) + 1e-9)
    return np.array([0.0, *10 ** (np.arange(low, high + 1) / PER_DECADE), np.inf])


def _of_nodes(plan: Plan, row: int, index: np.ndarray) -> xr.Dataset:
    """The answers of some nodes of a row, over ``node``."""
    nodes = plan.nodes(row, index)
    down = plan.ratios[::-1]
    steps = list(walk(nodes, plan.ratios))
    error = np.concatenate([np.moveaxis(orbit_errors(step.orbit), 2, 0) for step in steps])
    stable = np.concatenate([step.stable for step in steps])
    # The walk goes down in ϖ, whereas the examined ϖ increase.
    at = np.flatnonzero(np.isin(down, plan.examined))[::-1]
    examined = np.moveaxis(error[at], 0, 2)
    signature = Signature(nodes.contact(down[at, np.newaxis]))
    # One quantity after another, because the errors of all quantities do not fit into the cache.
    each = error.reshape(len(down), -1, len(index))
    tolerances = np.array(plan.tolerances)
    found = [last_crossings(down, each[:, k], tolerances) for k in range(each.shape[1])]
    threshold = np.stack(found, axis=1).reshape(-1, *error.shape[1:])
    left = remainder(nodes.n, signature(), nodes.amplitude, examined[0], OF_ORBITS)
    ratio = "frequency_ratio"
    return xr.Dataset(
        {
            "threshold": (("tolerance", "model", "quantity", "node"), threshold),
            "error": (("model", "quantity", ratio, "node"), examined),
            "stated": (("quantity", ratio, "node"), left.is_valid),
            "exceeded": (("quantity", ratio, "node"), left.is_valid & left.exceeded),
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
    starts = range(0, len(nodes), BLOCK)
    bins = threshold_bins(plan.ratios)
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
