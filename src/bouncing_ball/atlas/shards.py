"""The shards of the atlas: the answers of some rows of tiles, and those of all limits.

Blocks of a fixed number of nodes are walked one after another, and their
answers combined: the memory does not grow with the number of nodes, and the numbers
depend neither on how many shards there are nor on who computes them.
"""

from collections.abc import Callable, Iterator
from functools import reduce
from itertools import pairwise

import numpy as np
import xarray as xr

from bouncing_ball.atlas import answers as kept
from bouncing_ball.atlas.answers import Answers, Tiled
from bouncing_ball.atlas.errors import (
    MODELS,
    OF_LIMITS,
    OF_ORBITS,
    limit_law,
    orbit_errors,
    orbit_law,
)
from bouncing_ball.atlas.limits_walk import limit_errors
from bouncing_ball.atlas.plan import Nodes, Plan, Row
from bouncing_ball.atlas.walk import TOGETHER, walk
from bouncing_ball.datasets.variables import describe
from bouncing_ball.orbits import restitution_orbit

BLOCK = 8192 // TOGETHER
"""Nodes walked at once: as many as keep the arrays in the cache, some ϖ long."""

WALKED = ("unstable", "sought", "farthest")
"""Of the walk, not of errors: exact orbits that are not stable, orbits that were looked for
directly, and the largest relative distance of an orbit's Λ from its node's."""
LIMIT = "limit_"
"""Prefix of the answers about limits."""


def _ignore(count: int) -> None:
    """Report no progress."""


def shard(plan: Plan, index: int, told: Callable[[int], None] = _ignore) -> xr.Dataset:
    """The answers of a shard's rows.

    Parameters
    ----------
    plan : Plan
    index : int
    told : callable
        Is given the number of orbits evaluated, from time to time.
    """
    rows = plan.shard(index)
    parts = [row_answers(plan, row, told) for row in rows]
    dims = {name: ("row", "position", *kept.DIMENSIONS[name]) for name in kept.DIMENSIONS}
    dims |= {name: ("row", "position", "frequency_ratio") for name in WALKED[:1]}
    dims |= {name: ("row", "position") for name in WALKED[1:]}
    data = {name: (dims[name], np.stack([part[name] for part in parts])) for name in dims}
    return _dataset(plan, rows, data, OF_ORBITS)


def limit_shard(plan: Plan) -> xr.Dataset:
    """The answers about saddle-node, period doubling and permanent contact of all rows."""
    found: dict[Row, Answers] = {}
    for place in dict.fromkeys((row.release, row.n) for row in plan.rows):
        rows = [row for row in plan.rows if (row.release, row.n) == place]
        found |= zip(rows, _limits(plan, rows), strict=True)
    data = {
        name: (("row", *dims), np.stack([found[row][name] for row in plan.rows]))
        for name, dims in kept.DIMENSIONS.items()
    }
    return _dataset(plan, plan.rows, data, OF_LIMITS)


def _dataset(plan: Plan, rows, data, quantities) -> xr.Dataset:
    coords = {
        "row": [plan.rows.index(row) for row in rows],
        "model": list(MODELS),
        "quantity": [str(quantity) for quantity in quantities],
        "tolerance": plan.tolerances,
        "frequency_ratio": plan.examined,
        "threshold_bin": kept.threshold_bins(plan.ratios),
        "law_bin": kept.LAW_BINS,
    }
    return describe(xr.Dataset(data, coords))


def row_answers(plan: Plan, row: Row, told: Callable[[int], None] = _ignore) -> Answers:
    """The answers of the tiles of a row, some tiles at a time, or a tile in pieces."""
    together = plan.nodes_per_tile * max(1, BLOCK // plan.nodes_per_tile)
    starts = range(0, plan.nodes_per_row, together)
    ends = (min(start + together, plan.nodes_per_row) for start in starts)
    # Combined as they come: no two blocks are in memory.
    parts = [
        reduce(_both, _blocks(plan, row, start, end, told))
        for start, end in zip(starts, ends, strict=True)
    ]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def _blocks(
    plan: Plan, row: Row, start: int, end: int, told: Callable[[int], None]
) -> Iterator[Answers]:
    """The answers of some whole tiles at once, or of one tile piece by piece."""
    each = plan.nodes_per_tile
    pieces = -(-each // BLOCK)
    ends = [start + (end - start) * k // pieces for k in range(pieces + 1)]
    for low, high in pairwise(ends):
        yield _block(plan, plan.nodes(row, low, high), np.arange(low - start, high - start) // each)
        told((high - low) * len(plan.ratios))


def _both(one: Answers, other: Answers) -> Answers:
    return kept.combined(one, other) | {
        "unstable": one["unstable"] + other["unstable"],
        "sought": one["sought"] + other["sought"],
        "farthest": np.maximum(one["farthest"], other["farthest"]),
    }


def _block(plan: Plan, nodes: Nodes, tile: np.ndarray) -> Answers:
    """The answers of some nodes, whose tiles are numbered from 0."""
    tiled = Tiled(
        tile,
        nodes.restitution,
        nodes.amplitude,
        orbit_law(nodes),
        plan.tolerances,
        plan.ratios,
        plan.examined,
    )
    unstable: list[np.ndarray] = []
    sought, off = np.zeros(tile.shape, int), np.zeros(tile.shape)

    def errors() -> Iterator[tuple[np.ndarray, np.ndarray]]:
        nonlocal sought, off
        for step in walk(nodes, plan.ratios):
            sought = sought + np.sum(step.sought, axis=0)
            away = np.abs(step.orbit.amplitude / nodes.amplitude - 1)
            off = np.fmax(off, np.fmax.reduce(away, axis=0))
            error = orbit_errors(step.orbit, nodes.instant, step.frequency_ratio[:, np.newaxis])
            examined = np.isin(step.frequency_ratio, plan.examined)
            unstable.extend(
                np.add.reduceat(~step.stable[examined], tiled.starts, axis=1, dtype=np.int32)
            )
            yield step.frequency_ratio, np.moveaxis(error, 2, 0)

    return kept.answers(tiled, errors()) | {
        "unstable": np.stack(unstable[::-1], axis=-1),
        "sought": np.add.reduceat(sought, tiled.starts, dtype=np.int32),
        "farthest": np.maximum.reduceat(off, tiled.starts),
    }


def _limits(plan: Plan, rows: list[Row]) -> list[Answers]:
    """The answers about the limits of rows of one rule and one n; a row is a tile."""
    each = plan.parameters["restitution"]["samples"]
    r = np.concatenate([plan.bounds(row).restitution for row in rows])
    nodes = plan.placed(rows[0], r, np.zeros_like(r))
    flip = restitution_orbit.period_doubling(nodes.n, r)
    tiled = Tiled(
        np.arange(len(r)) // each,
        r,
        flip,
        limit_law(nodes, flip),
        plan.tolerances,
        plan.ratios,
        plan.examined,
    )
    found = kept.answers(tiled, limit_errors(nodes, plan.ratios))
    return [{name: values[k] for name, values in found.items()} for k in range(len(rows))]
