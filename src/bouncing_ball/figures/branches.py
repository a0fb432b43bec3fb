"""Branches with stability and bifurcations, drawn alike in Figs. 3, 8, 9, 15."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from bouncing_ball.figures.style import PERIOD_DOUBLING, SADDLE_NODE, STABLE, UNSTABLE


def _runs(stable: np.ndarray) -> list[tuple[int, int, bool]]:
    """Slices of constant stability, each reaching to the next one's first point."""
    edges = [0, *(np.nonzero(np.diff(stable.astype(int)))[0] + 1), len(stable)]
    return [
        (start, min(stop + 1, len(stable)), bool(stable[start])) for start, stop in pairwise(edges)
    ]


def draw_branch(axes: Axes, x, y, stable, colour: str, width: float = 1.0) -> None:
    """A branch, solid where stable and dashed where unstable."""
    x, y, stable = np.asarray(x), np.asarray(y), np.asarray(stable, dtype=bool)
    for start, stop, is_stable in _runs(stable):
        look = dict(STABLE if is_stable else UNSTABLE)
        look["linewidth"] *= width
        axes.plot(x[start:stop], y[start:stop], color=colour, **look)


def draw_saddle_nodes(axes: Axes, x, y, colour: str) -> None:
    """Saddle-node markers."""
    axes.plot(x, y, color=colour, zorder=4, **SADDLE_NODE)


def draw_period_doublings(axes: Axes, x, y, colour: str) -> None:
    """Period-doubling markers."""
    axes.plot(x, y, color=colour, zorder=4, **PERIOD_DOUBLING)


def legend_handles(colour: str = "black") -> Sequence[Line2D]:
    """Handles for stable, unstable, saddle-node and period doubling."""
    return [
        Line2D([], [], color=colour, label="stable", **STABLE),
        Line2D([], [], color=colour, label="unstable", **UNSTABLE),
        Line2D([], [], color=colour, label="saddle-node", **SADDLE_NODE),
        Line2D([], [], color=colour, label="period doubling", **PERIOD_DOUBLING),
    ]
