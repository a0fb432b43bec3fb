"""Branches of n-T orbits with stability and bifurcations: phase of the table against Λ.

Lines are solid for stable, dashed for unstable and dotted for inadmissible orbits (Figs. 3, 8, 9,
15).
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from bouncing_ball.datasets import GRAZING
from bouncing_ball.drawing.style import LINES, MARKS


class SpecialPoints(NamedTuple):
    """The special points of a branch: arrays of one shape, NaN where there is no special point.

    ``kind`` is a name in ``MARKS``, ``along`` the place on the branch in the measure of its
    points, ``amplitude`` Λ and ``phase`` the phase shown, in rad.
    """

    kind: np.ndarray
    along: np.ndarray
    amplitude: np.ndarray
    phase: np.ndarray

    def between(self, low: float, high: float, kinds: set[str]) -> np.ndarray:
        """Λ and the phase over π of the special points of some kinds on a part of the branch, in
        its order, shape (2, count).
        """
        at = np.flatnonzero(
            np.isin(self.kind, list(kinds)) & (self.along >= low) & (self.along <= high)
        )
        at = at[np.argsort(self.along[at])]
        return np.stack([self.amplitude[at], self.phase[at] / np.pi])


def draw_branch(
    axes: Axes,
    curve: xr.Dataset,
    along: np.ndarray,
    phase: xr.DataArray,
    special: SpecialPoints,
    colour: str,
) -> None:
    """A branch in pieces of one look, which meet in its special points.

    ``along`` increases along the branch, and places its points among the special points. A branch
    of which a part is drawn begins and ends at the special points beyond its points.
    """
    line = np.stack([curve.amplitude.values, phase.values / np.pi])
    stability = np.where(curve.stable, "stable", "unstable")
    kinds = np.where(curve.admissible, stability, "inadmissible")
    edges = [0, *(np.flatnonzero(kinds[1:] != kinds[:-1]) + 1), len(kinds)]
    first = special.between(-np.inf, along[0], set(MARKS))[:, -1:]
    for start, stop in pairwise(edges):
        last = _border(line, kinds, along, special, stop)
        x, y = np.concatenate([first, line[:, start:stop], last], axis=-1)
        axes.plot(x, y, color=colour, label=kinds[start], **LINES[kinds[start]])
        first = last


def _border(
    line: np.ndarray, kinds: np.ndarray, along: np.ndarray, special: SpecialPoints, stop: int
) -> np.ndarray:
    """Where a piece ends that begins before the point ``stop``, at most one place, shape (2, k).

    Where the look changes but no special point is known the place is the next point.
    """
    if stop == len(kinds):
        return special.between(along[-1], np.inf, set(MARKS))[:, :1]
    grazes = "inadmissible" in kinds[stop - 1 : stop + 1]
    possible = {GRAZING} if grazes else set(MARKS) - {GRAZING}
    found = special.between(along[stop - 1], along[stop], possible)[:, :1]
    return found if found.size else line[:, stop : stop + 1]


def mark_orbits(axes: Axes, kind: str, x: xr.DataArray, phase: xr.DataArray, colour: str) -> None:
    """The special points of a kind, if there are any."""
    if phase.notnull().any():
        axes.plot(x, phase / np.pi, color=colour, zorder=4, label=kind, **MARKS[kind])


def draw_rigid_branch(axes: Axes, curve: xr.Dataset, data: xr.Dataset, colour: str) -> None:
    """The branch of the restitution model, along which φ increases, with its special points.

    ``curve`` has the orbits, and ``data`` the numbers Λ and φ of those bifurcations and grazing
    orbits that it names.
    """
    named = [(kind, kind.replace("-", "_").replace(" ", "_")) for kind in MARKS]
    named = [(kind, name) for kind, name in named if f"{name}_phase" in data]
    phase = np.array([float(data[f"{name}_phase"]) for _, name in named])
    special = SpecialPoints(
        kind=np.array([kind for kind, _ in named]),
        along=phase,
        amplitude=np.array([float(data[f"{name}_amplitude"]) for _, name in named]),
        phase=phase,
    )
    draw_branch(axes, curve, curve.phase.values, curve.phase, special, colour)
    for kind, name in named:
        mark_orbits(axes, kind, data[f"{name}_amplitude"], data[f"{name}_phase"], colour)


def label_branch_axes(
    axes: Axes, data: xr.Dataset, ylabel: str, title: str, left: float = 0.0
) -> None:
    """Labels of the axes, a title, and the range of Λ from ``left`` to the end of the branches."""
    axes.set(xlabel=r"amplitude $\Lambda$", ylabel=ylabel, title=title)
    axes.set_xlim(left, data.attrs["amplitude_max"])
