"""Branches with stability and bifurcations, drawn alike in Figs. 3, 8, 9, 15."""

from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from bouncing_ball.render.figures.style import (
    GRAZING,
    INADMISSIBLE,
    PERIOD_DOUBLING,
    SADDLE_NODE,
    STABLE,
    UNSTABLE,
)


def _runs(looks: np.ndarray) -> list[tuple[int, int, int]]:
    """Slices of constant look, each reaching to the next one's first point."""
    edges = [0, *(np.nonzero(np.diff(looks))[0] + 1), len(looks)]
    return [
        (start, min(stop + 1, len(looks)), int(looks[start])) for start, stop in pairwise(edges)
    ]


def draw_branch(axes: Axes, x, y, stable, admissible, colour: str) -> None:
    """A branch: solid where stable, dashed where unstable, dotted where inadmissible."""
    looks = (UNSTABLE, STABLE, INADMISSIBLE)
    kind = np.where(np.asarray(admissible, dtype=bool), np.asarray(stable, dtype=int), 2)
    x, y = np.asarray(x), np.asarray(y)
    for start, stop, look in _runs(kind):
        axes.plot(x[start:stop], y[start:stop], color=colour, **looks[look])


def draw_curve(axes: Axes, x, y, admissible, **look) -> None:
    """A curve of orbits in its own look, dotted where they are inadmissible."""
    x, y, shown = np.asarray(x), np.asarray(y), np.asarray(admissible, dtype=bool)
    axes.plot(x, np.where(shown, y, np.nan), **look)
    if not np.all(shown):
        axes.plot(x, np.where(shown, np.nan, y), color=look["color"], **INADMISSIBLE)


def draw_saddle_nodes(axes: Axes, x, y, colour: str) -> None:
    """Saddle-node markers."""
    axes.plot(x, y, color=colour, zorder=4, **SADDLE_NODE)


def draw_period_doublings(axes: Axes, x, y, colour: str) -> None:
    """Period-doubling markers."""
    axes.plot(x, y, color=colour, zorder=4, **PERIOD_DOUBLING)


def draw_grazings(axes: Axes, x, y, colour: str) -> None:
    """Markers of the limits of admissibility."""
    axes.plot(x, y, color=colour, zorder=4, **GRAZING)


def legend_handles(colour: str = "black", inadmissible: bool = False) -> list[Line2D]:
    """Handles for stable, unstable, saddle-node and period doubling, and those
    of inadmissible orbits if there are any."""
    rest = [
        Line2D([], [], color=colour, label="inadmissible", **INADMISSIBLE),
        Line2D([], [], color=colour, label="grazing", **GRAZING),
    ]
    return [
        Line2D([], [], color=colour, label="stable", **STABLE),
        Line2D([], [], color=colour, label="unstable", **UNSTABLE),
        Line2D([], [], color=colour, label="saddle-node", **SADDLE_NODE),
        Line2D([], [], color=colour, label="period doubling", **PERIOD_DOUBLING),
        *(rest if inadmissible else []),
    ]
