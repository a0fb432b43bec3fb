r"""The orbits that the atlas covers, in tiles, and the division of the work.

An orbit of the atlas belongs to a node (release rule, n, r, p) and a frequency ratio ϖ.
The position p in (0, 1) gives Λ in the stable range of the restitution model ::

    Λ = Λ_SN + p (Λ_PD - Λ_SN)

A *tile* is a range of r times a range of p, for one rule and one n; its nodes are
the midpoints of the cells of an even grid. A *row* consists of all tiles of one rule, one n
and one range of r. A *shard* consists of consecutive rows. Rows are computed one by one, so
that the results do not depend on the number of shards. All quantities are dimensionless.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np
from pydantic import Field, Strict

from bouncing_ball.datasets.parameters import (
    Family,
    FrequencyRatio,
    Interval,
    Many,
    Parameters,
    Restitution,
    Span,
    Tolerance,
    number,
)
from bouncing_ball.models.damping import Release, damping_ratio
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic.one_impact import restitution_branch as restitution_orbit

# Lower bounds of r: a linear contact with the force release has r > e⁻².
_LOWEST = {Release.DISPLACEMENT: 0.0, Release.FORCE: float(np.exp(-2))}
# Frequency ratios that differ by less than this in ln ϖ are regarded as equal.
_SAME = 1e-9


@dataclass(frozen=True)
class Nodes:
    """Nodes of one release rule and one family n, with r and Λ as arrays of one shape."""

    release: Release
    n: int
    restitution: np.ndarray
    amplitude: np.ndarray

    @cached_property
    def damping_ratio(self) -> np.ndarray:
        """ζ of the contact whose free impact has the restitution coefficient r."""
        return np.asarray(damping_ratio(self.restitution, self.release))

    def contact(self, frequency_ratio: float | np.ndarray) -> SpringDamper:
        """The contacts of the nodes at ϖ, whose shape broadcasts with that of the nodes."""
        return SpringDamper(frequency_ratio, self.damping_ratio, self.release)


class EqualRanges(Parameters):
    """Equal ranges, with equally spaced nodes in each."""

    tiles: Annotated[int, number("number of equal ranges", ge=1, le=2000)]
    samples: Annotated[int, number("number of evenly spaced nodes in each range", ge=1, le=10000)]


class RestitutionRanges(Interval, EqualRanges):
    """Equal ranges of r. A release rule has nodes only in the ranges that its contacts reach."""

    min: Annotated[Restitution, Field(description="smallest r, for rules that reach it")]
    max: Annotated[Restitution, Field(description="largest r, above min")]


class Plan(Parameters):
    """The parameters of the atlas, the section ``atlas`` of the configuration."""

    n: Many[Family]
    release: Many[Annotated[Release, Strict(False)]]
    restitution: RestitutionRanges
    position: EqualRanges
    frequency_ratio: Span
    tolerances: Many[Tolerance]
    examined: Annotated[Many[FrequencyRatio], Field(description="ϖ at which errors are described")]
    shards: Annotated[int, number("number of jobs, at most one for each row", ge=1, le=20000)]

    @cached_property
    def edges(self) -> np.ndarray:
        """Bounds of the ranges of r, rounded to 12 decimals, shape (ranges + 1,)."""
        part = self.restitution
        return np.round(np.linspace(part.min, part.max, part.tiles + 1), 12)

    @cached_property
    def positions(self) -> np.ndarray:
        """Bounds of the ranges of p, shape (ranges + 1,)."""
        return np.linspace(0.0, 1.0, self.position.tiles + 1)

    @cached_property
    def ratios(self) -> np.ndarray:
        """All ϖ in increasing order: the grid merged with the examined ϖ."""
        grid = self.frequency_ratio.grid()
        examined = np.sort(self.examined)
        apart = np.abs(np.log(grid[:, np.newaxis] / examined)) > _SAME
        return np.sort(np.concatenate([grid[np.all(apart, axis=1)], examined]))

    @property
    def resolution(self) -> float:
        """Largest relative step of the grid; a threshold is bracketed to within one step."""
        return float(np.max(self.ratios[1:] / self.ratios[:-1])) - 1

    @property
    def shape(self) -> tuple[int, int, int]:
        """Numbers of rules, families and ranges of r: the shape of the array of all rows."""
        return len(self.release), len(self.n), self.restitution.tiles

    @cached_property
    def rows(self) -> np.ndarray:
        """Indices of the rows, without those whose range of r the rule does not reach."""
        reached = [self.edges[:-1] >= _LOWEST[rule] for rule in self.release]
        return np.flatnonzero(np.broadcast_to(np.array(reached)[:, np.newaxis], self.shape))

    def shard_rows(self) -> list[np.ndarray]:
        """The rows of each shard; the numbers of rows of two shards differ by at most one."""
        return np.array_split(self.rows, min(self.shards, len(self.rows)))

    @property
    def nodes_per_tile(self) -> int:
        """Number of nodes in a tile."""
        return self.restitution.samples * self.position.samples

    @property
    def nodes_per_row(self) -> int:
        """Number of nodes in a row."""
        return self.position.tiles * self.nodes_per_tile

    @property
    def orbit_count(self) -> int:
        """Number of orbits evaluated: all nodes at all ϖ."""
        return len(self.rows) * self.nodes_per_row * len(self.ratios)

    def nodes(self, row: int, index: np.ndarray) -> Nodes:
        """The nodes of a row with the numbers ``index``, which count tile by tile, and in a tile
        through all p at one r after another.
        """
        count = self.position.tiles * self.position.samples
        p = _midpoints(0.0, 1.0, count).reshape(self.position.tiles, 1, -1)
        every_r, every_p = np.broadcast_arrays(self.restitutions(row)[:, np.newaxis], p)
        return self.placed(row, every_r.ravel()[index], every_p.ravel()[index])

    def restitutions(self, row: int) -> np.ndarray:
        """The values of r of the nodes of a row, shape (samples,)."""
        place = row % self.restitution.tiles
        low = float(self.edges[place])
        high = float(self.edges[place + 1])
        return _midpoints(low, high, self.restitution.samples)

    def placed(self, row: int, r: np.ndarray, p: np.ndarray) -> Nodes:
        """Nodes with the rule and the n of a row, at given r and p, arrays of one shape."""
        rule, family, _ = np.unravel_index(row, self.shape)
        n = self.n[family]
        low = restitution_orbit.saddle_node(n, r)
        high = restitution_orbit.period_doubling(n, r)
        return Nodes(self.release[rule], n, r, low + p * (high - low))


def _midpoints(low: float, high: float, count: int) -> np.ndarray:
    """Midpoints of equal parts of an interval.

    Examples
    --------
    >>> _midpoints(0.0, 1.0, 2).tolist()
    [0.25, 0.75]
    """
    return low + (np.arange(count) + 0.5) / count * (high - low)
