r"""What the atlas covers, in tiles, and how the work is divided.

An orbit of the atlas is a node (release rule, n, r, p) at a frequency ratio ϖ. The
position p in (0, 1) is that of Λ in the stable range of the restitution model ::

    Λ = Λ_SN + p (Λ_PD - Λ_SN)

A *tile* is a range of r times a range of p, for one rule and one n; its nodes are
the midpoints of an even grid in it. A *row* is all tiles of one rule, one n and one
range of r. Rows are computed one by one, a *shard* is some rows in order: so its
numbers do not depend on how many shards there are. All quantities are dimensionless.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np

from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.signature import Instant, LinearSignature
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import ModelError
from bouncing_ball.orbits import restitution_orbit

# A linear contact released by its force has a higher restitution coefficient.
_LOWEST = {Release.DISPLACEMENT: 0.0, Release.FORCE: float(np.exp(-2))}
# Ratios closer than this are one.
_SAME = 1e-9


class Row(NamedTuple):
    """Place of a row among the rules, the families and the ranges of r."""

    release: int
    n: int
    restitution: int


@dataclass(frozen=True)
class Nodes:
    """Nodes of one rule and one n; arrays of one shape."""

    release: Release
    n: int
    restitution: np.ndarray
    amplitude: np.ndarray

    @cached_property
    def damping_ratio(self) -> np.ndarray:
        """ζ of the contact whose free impact has the restitution coefficient r."""
        return np.asarray(self.contact(1.0).damping_ratio)

    @cached_property
    def instant(self) -> Instant:
        """The signature of the contacts at ϖ = 1."""
        return LinearSignature(self.contact(1.0))()

    def contact(self, frequency_ratio: float | np.ndarray) -> SpringDamper:
        """The contacts of the nodes at ϖ, an array of any shape that broadcasts with theirs."""
        if "damping_ratio" in self.__dict__:
            return SpringDamper(frequency_ratio, self.damping_ratio, self.release)
        r = self.restitution
        return SpringDamper.from_restitution(r, frequency_ratio, self.release, measured=True)

    def __getitem__(self, key: Any) -> Self:
        return type(self)(self.release, self.n, self.restitution[key], self.amplitude[key])


@dataclass(frozen=True)
class Plan:
    """The atlas of a section ``atlas`` of the configuration."""

    parameters: Mapping[str, Any]

    @property
    def releases(self) -> list[Release]:
        """The release rules."""
        return [Release.of(name) for name in self.parameters["release"]]

    @property
    def families(self) -> list[int]:
        """The indices n."""
        return list(self.parameters["n"])

    @property
    def edges(self) -> np.ndarray:
        """Bounds of the ranges of r, rounded to what one would type."""
        part = self.parameters["restitution"]
        return np.round(np.linspace(part["min"], part["max"], part["tiles"] + 1), 12)

    @property
    def positions(self) -> np.ndarray:
        """Bounds of the ranges of p."""
        return np.linspace(0.0, 1.0, self.parameters["position"]["tiles"] + 1)

    @property
    def tolerances(self) -> np.ndarray:
        """Relative errors tolerated."""
        return np.array(self.parameters["tolerances"], dtype=float)

    @property
    def examined(self) -> np.ndarray:
        """The ϖ at which the errors themselves are described."""
        return np.array(self.parameters["examined"], dtype=float)

    @cached_property
    def ratios(self) -> np.ndarray:
        """All ϖ, increasing: the grid, with those examined among it."""
        scanned = np.geomspace(
            *(self.parameters["frequency_ratio"][k] for k in ("min", "max", "samples"))
        )
        apart = np.abs(np.log(scanned[:, np.newaxis] / self.examined)) > _SAME
        return np.sort(np.concatenate([scanned[np.all(apart, axis=1)], self.examined]))

    @property
    def resolution(self) -> float:
        """Largest step of the grid: a threshold is known to lie within one."""
        return float(np.max(self.ratios[1:] / self.ratios[:-1])) - 1

    @cached_property
    def rows(self) -> list[Row]:
        """The rows, in order, without ranges of r that a rule does not reach."""
        return [
            Row(i, j, k)
            for i, rule in enumerate(self.releases)
            for j in range(len(self.families))
            for k, low in enumerate(self.edges[:-1])
            if low >= _LOWEST[rule]
        ]

    @property
    def nodes_per_tile(self) -> int:
        """Number of nodes in a tile."""
        return self.parameters["restitution"]["samples"] * self.parameters["position"]["samples"]

    @property
    def orbits(self) -> int:
        """Number of orbits evaluated: all nodes at all ϖ."""
        return len(self.rows) * self.orbits_per_row

    @property
    def orbits_per_row(self) -> int:
        """Those of a row."""
        return self.nodes_per_row * len(self.ratios)

    @property
    def shards(self) -> int:
        """Number of shards: as many as are asked for, at most one for each row."""
        return min(self.parameters["shards"], len(self.rows))

    def shard(self, index: int) -> list[Row]:
        """The rows of a shard; the shards' numbers of rows differ by one at most.

        Raises
        ------
        ModelError
            If there is no such shard.
        """
        if not 0 <= index < self.shards:
            raise ModelError(f"no shard {index}: they are 0 to {self.shards - 1}")
        ends = len(self.rows) * np.arange(self.shards + 1) // self.shards
        return self.rows[ends[index] : ends[index + 1]]

    @property
    def nodes_per_row(self) -> int:
        """Number of nodes in a row."""
        return self.parameters["position"]["tiles"] * self.nodes_per_tile

    def nodes(self, row: Row, start: int = 0, end: int | None = None) -> Nodes:
        """The nodes of a row from one to another, tile by tile, in each r by r."""
        tiles, count = self.parameters["position"]["tiles"], self._count("position")
        index = np.arange(start, self.nodes_per_row if end is None else end)
        tile, within = np.divmod(index, self.nodes_per_tile)
        along_r, along_p = np.divmod(within, count)
        low, high = self.edges[row.restitution : row.restitution + 2]
        r = _midpoint(along_r, float(low), float(high), self._count("restitution"))
        return self.placed(row, r, _midpoint(tile * count + along_p, 0.0, 1.0, tiles * count))

    def placed(self, row: Row, r: np.ndarray, p: np.ndarray) -> Nodes:
        """Nodes at any r and p, for a row's rule and n."""
        n = self.families[row.n]
        low, high = restitution_orbit.saddle_node(n, r), restitution_orbit.period_doubling(n, r)
        return Nodes(self.releases[row.release], n, r, low + p * (high - low))

    def bounds(self, row: Row) -> Nodes:
        """The r of a row, for what does not depend on p; Λ is then the saddle-node's."""
        low, high = self.edges[row.restitution : row.restitution + 2]
        count = self._count("restitution")
        r = _midpoint(np.arange(count), float(low), float(high), count)
        return self.placed(row, r, np.zeros_like(r))

    def _count(self, name: str) -> int:
        return self.parameters[name]["samples"]


def _midpoint(index: np.ndarray, low: float, high: float, count: int) -> np.ndarray:
    """Midpoints of some of equal parts of an interval.

    Examples
    --------
    >>> _midpoint(np.arange(2), 0.0, 1.0, 2).tolist()
    [0.25, 0.75]
    """
    return low + (index + 0.5) / count * (high - low)
