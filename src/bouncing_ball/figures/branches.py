"""Branches with stability and bifurcations, drawn alike in Figs. 3, 8, 9, 15."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from bouncing_ball.figures.style import (
    GRAZING,
    INADMISSIBLE,
    PERIOD_DOUBLING,
    SADDLE_NODE,
    STABLE,
    UNSTABLE,
    Look,
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


def draw_marks(axes: Axes, amplitude, phase, mark: Look, colour: str) -> None:
    """Marks at bifurcations or grazings, over the branches; the phase over π."""
    x, y = np.asarray(amplitude), np.asarray(phase) / np.pi
    axes.plot(x, y, color=colour, zorder=4, **mark)


def _apart(values: np.ndarray, gap: float) -> np.ndarray:
    """Increasing values moved as little as keeps them ``gap`` apart.

    Examples
    --------
    >>> _apart(np.array([0.0, 1.0, 1.0]), 0.5).tolist()
    [0.0, 0.75, 1.25]
    """
    steps = gap * np.arange(len(values))
    above = np.maximum.accumulate(values - steps)
    below = np.minimum.accumulate((values - steps)[::-1])[::-1]
    return (above + below) / 2 + steps


def label_ends(axes: Axes, ends: Sequence[tuple[float, float, str]], gap: float) -> None:
    """Names of curves right of the axes, each with a line to its end (x, y).

    ``gap`` is the least distance of two names, in parts of the axes' height.
    """
    found = sorted((end for end in ends if np.isfinite(end[1])), key=lambda end: end[1])
    low, high = axes.get_ylim()
    places = _apart(np.array([y for _, y, _ in found]), gap * (high - low))
    for (x, y, name), place in zip(found, places, strict=True):
        axes.annotate(
            name,
            (x, y),
            xytext=(1.045, place),
            textcoords=axes.get_yaxis_transform(),
            va="center",
            fontsize=8,
            annotation_clip=False,
            arrowprops={"arrowstyle": "-", "color": "#5f5f5f", "linewidth": 0.5, "shrinkB": 1},
        )


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
