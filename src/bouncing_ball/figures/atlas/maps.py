"""The ϖ needed over r and Λ: one chart for each quantity of an orbit."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke

from bouncing_ball.figures.canvas import WIDE, canvas
from bouncing_ball.figures.style import QUANTITIES

LEVELS = (3, 5, 10, 20, 50, 100, 200, 500, 1000)
"""Bounds of the colours; the last colour is for what lies beyond."""
# From light, where a soft contact will do, to dark; even steps of grey.
_COLOURS = (
    "#f7fbff",
    "#deebf7",
    "#c6dbef",
    "#9ecae1",
    "#6baed6",
    "#4292c6",
    "#2171b5",
    "#08519c",
    "#08306b",
)
_LAW_LEVELS = (20, 50, 100, 200, 500)
_LAW: dict[str, Any] = {"colors": "#AA3A00", "linewidths": 0.8, "linestyles": "--"}
# Least distance of two labels; both axes are from 0 to 1.
_APART = 0.12
# What fails needs a large ϖ, and so is dark.
_SOME: dict[str, Any] = {"facecolor": "none", "edgecolor": "white", "hatch": "///"}
_MOST: dict[str, Any] = _SOME | {"hatch": "xxx"}
_HALO = withStroke(linewidth=2.0, foreground="white")
_COLUMNS = (("restitution", "amplitude"), ("restitution", "position"), ("corrected", "position"))


def draw(data: xr.Dataset, quantity: str, n: int = 1) -> Figure:
    """For each rule the restitution model over Λ and over the position, and the corrected one.

    Colour is the ϖ needed, hatched where the rule of thumb fails for some orbit, and crossed
    where it fails for more than half of them; the error law's |K|/ε is drawn over the
    restitution model as lines.
    """
    figure, panels = canvas(WIDE, 5.4, rows=2, columns=3, sharex=True)
    chosen = data.sel(n=n, quantity=quantity)
    for line, release in zip(panels, data.release.values, strict=True):
        for axes, (model, along) in zip(line, _COLUMNS, strict=True):
            part = chosen.sel(release=release, model=model)
            y = _corners(part, along)
            mesh = _panel(axes, part, y)
            if model == "restitution" and along == "position":
                _law(axes, part, y)
            axes.set_title(f"{model} model, {release}", fontsize=8)
            words = r"amplitude $\Lambda$" if along == "amplitude" else "position in the range"
            axes.set_ylabel(words)
    for axes in panels[-1]:
        axes.set_xlabel("restitution coefficient $r$")
    bar = figure.colorbar(mesh, ax=panels, extend="max", ticks=LEVELS, pad=0.02, shrink=0.8)
    bar.ax.set_yticklabels([f"{level:g}" for level in LEVELS])
    percent = 100 * float(data.summary_tolerance)
    bar.set_label(rf"$\varpi$ from which the error is below {percent:g} %")
    figure.suptitle(rf"{QUANTITIES[quantity]}: how stiff a contact must be, $n={n}$", fontsize=10)
    figure.legend(handles=_handles(data), loc="outside lower center", ncols=3)
    return figure


def _corners(part: xr.Dataset, along: str) -> np.ndarray:
    """Λ or the position at the corners of the tiles."""
    amplitude = part.corner_amplitude.values
    if along == "amplitude":
        return amplitude
    return np.broadcast_to(part.position_edge.values, amplitude.shape)


def _panel(axes: Axes, part: xr.Dataset, y: np.ndarray) -> Any:
    r, needed = part.restitution_edge.values, part.needed.values
    x = np.broadcast_to(r[:, np.newaxis], y.shape)
    norm = BoundaryNorm(LEVELS, len(_COLOURS), extend="max")
    shown = np.clip(needed, LEVELS[0], 1e6)
    mesh = axes.pcolormesh(x, y, shown, cmap=ListedColormap(_COLOURS), norm=norm)
    corners = np.stack([x, y], axis=-1)
    around = (corners[:-1, :-1], corners[1:, :-1], corners[1:, 1:], corners[:-1, 1:])
    fails, most = needed > float(part.rule_of_thumb), part.failing_share.values > 0.5
    for where, hatch in ((fails & ~most, _SOME), (most, _MOST)):
        tiles = [np.array(tile) for tile in np.stack(around, axis=2)[where]]
        axes.add_collection(PolyCollection(tiles, linewidth=0, **hatch))
    # The saddle-node and the period doubling, between which the orbits are stable.
    for edge in (0, -1):
        axes.plot(r, y[:, edge], color="black", linewidth=1.0)
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(0.0, None)
    return mesh


def _law(axes: Axes, part: xr.Dataset, y: np.ndarray) -> None:
    middle = (y[:-1, 1:] + y[:-1, :-1]) / 2
    r = np.broadcast_to(part.restitution.values[:, np.newaxis], middle.shape)
    law = np.ma.masked_invalid(part.law_coefficient.values / float(part.summary_tolerance))
    lines = axes.contour(r, middle, law, levels=_LAW_LEVELS, **_LAW)
    lines.set_path_effects([_HALO])
    labels = axes.clabel(lines, fontsize=6, fmt="%g", manual=_label_places(lines.allsegs))
    for text in labels:
        text.set_path_effects([_HALO])


def _label_places(levels: list[list[np.ndarray]]) -> list[np.ndarray]:
    """The middle of the longest line of each level, where no other label is near.

    Where the law passes through zero its lines are too close to each other for labels.
    """
    places: list[np.ndarray] = []
    for level in levels:
        for line in sorted(filter(len, level), key=len)[-1:]:
            place = line[len(line) // 2]
            if all(np.hypot(*(place - other)) > _APART for other in places):
                places.append(place)
    return places


def _handles(data: xr.Dataset) -> list[Patch | Line2D]:
    rule = rf"$\varpi>{float(data.rule_of_thumb):g}$ is not enough for"
    dark = {"linewidth": 0, "facecolor": _COLOURS[-3]}
    law = r"error law, $|K|/\varepsilon$"
    return [
        Patch(**_SOME | dark, label=f"{rule} some orbit"),
        Patch(**_MOST | dark, label=f"{rule} more than half of the orbits"),
        Line2D([], [], color=_LAW["colors"], linestyle="--", linewidth=0.8, label=law),
    ]
