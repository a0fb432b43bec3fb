"""Branches of n-T orbits with stability and bifurcations: phase of the table against Λ.

Lines are solid for stable, dashed for unstable and dotted for inadmissible orbits (Figs. 3, 8, 9,
15).
"""

from itertools import pairwise

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from bouncing_ball.drawing.style import LINES, MARKS


def draw_branch(axes: Axes, curve: xr.Dataset, phase: xr.DataArray, colour: str) -> None:
    """A branch in pieces of one look, each extended to the first point of the next piece."""
    x = curve.amplitude.values
    y = phase.values / np.pi
    stability = np.where(curve.stable, "stable", "unstable")
    kinds = np.where(curve.admissible, stability, "inadmissible")
    edges = [0, *(np.flatnonzero(kinds[1:] != kinds[:-1]) + 1), len(kinds)]
    for start, stop in pairwise(edges):
        run = slice(start, stop + 1)
        axes.plot(x[run], y[run], color=colour, label=kinds[start], **LINES[kinds[start]])


def mark_orbits(axes: Axes, kind: str, x: xr.DataArray, phase: xr.DataArray, colour: str) -> None:
    """The special points of a kind, if there are any."""
    if phase.notnull().any():
        axes.plot(x, phase / np.pi, color=colour, zorder=4, label=kind, **MARKS[kind])


def mark_named_orbits(axes: Axes, data: xr.Dataset, colour: str) -> None:
    """The bifurcations and grazing orbits of the restitution model, where the dataset has them."""
    for kind in MARKS:
        name = kind.replace("-", "_").replace(" ", "_")
        if f"{name}_phase" in data:
            mark_orbits(axes, kind, data[f"{name}_amplitude"], data[f"{name}_phase"], colour)


def label_branch_axes(
    axes: Axes, data: xr.Dataset, ylabel: str, title: str, left: float = 0.0
) -> None:
    """Labels of the axes, a title, and the range of Λ from ``left`` to the end of the branches."""
    axes.set(xlabel=r"amplitude $\Lambda$", ylabel=ylabel, title=title)
    axes.set_xlim(left, data.attrs["amplitude_max"])
