"""Parts that the figures with maps of motions over restitution and amplitude share."""

from collections.abc import Iterable, Mapping
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from bouncing_ball.datasets import PERIOD_DOUBLING, SADDLE_NODE
from bouncing_ball.drawing.canvas import image, legend_below, logarithmic
from bouncing_ball.drawing.labels import number_label
from bouncing_ball.drawing.style import COLOURS, Look

# The lowest period of each colour for locked motions.
PERIODS = (1, 2, 3, 4, 5, 9, 17, 33)
LOCKED = colormaps["viridis_r"](np.linspace(0.08, 1, len(PERIODS)))
UNKNOWN_PERIOD = "locked, unknown period"
OTHER_COLOURS = {
    UNKNOWN_PERIOD: "#c994c7",
    "orbit": "#ffffff",
    "subharmonic": "#d9d9d9",
    "permanent contact": "#8c8c8c",
    "chaotic": "#f3d3c1",
    "undecided": "#b5b5b5",
}
# Marks that also distinguish areas in greyscale: plus signs for locked motions whose period is not
# known, crosses for unknown motions, dots for chaotic ones, and strokes for other areas whose grey
# level is that of a period.
DOTS: dict[str, Look] = {
    UNKNOWN_PERIOD: {"marker": "+", "markersize": 2.4, "markeredgewidth": 0.5},
    "chaotic": {"marker": ".", "markersize": 1.4, "markeredgewidth": 0},
    "undecided": {"marker": "x", "markersize": 1.6, "color": "#000000", "markeredgewidth": 0.3},
    "permanent contact": {"marker": "_", "markersize": 2.5, "markeredgewidth": 0.4},
    "subharmonic": {"marker": "|", "markersize": 2.5, "markeredgewidth": 0.4},
}
# Largest number of restitution coefficients at which nodes are marked.
_MARKED = 43
UNKNOWN = {"not at any": "#000000", "undecided": "#ffffff", "no number": "#c8c8c8"}
_HATCHES = {
    UNKNOWN_PERIOD: "++++",
    "chaotic": "......",
    "undecided": "xxxx",
    "subharmonic": "||||||",
}
_HATCHES |= dict.fromkeys(("permanent contact", "no number"), "------")
_BARS: Look = {"markersize": 4, "linewidth": 0.8, "capsize": 2}
# The factor by which bars that would hide each other are moved from their ϖ.
_ASIDE = 1.06
LOWEST_RATE = -1.5
HIGHEST_RATE = 1.5
"""Exponents outside of this range are drawn as its ends."""
# Colours that become lighter throughout, from blue below 0 to yellow above 0.
_FALLING = colormaps["Blues_r"](np.linspace(0, 0.65, 128))
_GROWING = colormaps["YlOrBr_r"](np.linspace(0.5, 1, 128))
RATES = ListedColormap([*_FALLING, *_GROWING]).with_extremes(bad=OTHER_COLOURS["permanent contact"])
_BIFURCATION: Look = {"color": "#000000", "linewidth": 0.9}
_BIFURCATIONS: dict[str, Look] = {
    SADDLE_NODE: _BIFURCATION | {"linestyle": "-"},
    PERIOD_DOUBLING: _BIFURCATION | {"linestyle": (0, (3, 1.5))},
}
# Parts of a bar from below: known to agree, not known, and known to differ.
_PARTS: tuple[Look, ...] = (
    {"facecolor": COLOURS[1], "label": "the same"},
    {"facecolor": "#ffffff", "hatch": "////", "label": "not known"},
    {"facecolor": "#d9d9d9", "label": "another"},
)


def node_map(
    axes: Axes, one: xr.Dataset, values: np.ndarray, kinds: Iterable[str], **look: Any
) -> Any:
    """Values at the nodes, with marks for some kinds of motion, and with the saddle-node (solid)
    and period doubling (dashed) of the 1-T orbit over r.
    """
    drawn = plane_map(axes, one, values, **look)
    for kind in kinds:
        mark_nodes(axes, one, one.kind == kind, DOTS[kind])
    xlim = axes.get_xlim()
    ylim = axes.get_ylim()
    for name, look in _BIFURCATIONS.items():
        lam = one[f"{name.replace('-', '_').replace(' ', '_')}_amplitude"]
        axes.plot(lam, one.restitution, **look)
    axes.set(xlim=xlim, ylim=ylim)
    return drawn


def curves_of_bifurcations() -> list[Line2D]:
    """Entries of a legend for the bifurcations of the 1-T orbit."""
    return [
        Line2D([], [], label=f"{name} of the 1-T orbit", **look)
        for name, look in _BIFURCATIONS.items()
    ]


def kinds_shown(data: xr.Dataset) -> xr.DataArray:
    """The kinds of motion, of which those that are locked with an unknown period have a name of
    their own.
    """
    unknown = (data.kind == "locked") & (data.periods == 0)
    return data.kind.astype(object).where(~unknown, UNKNOWN_PERIOD)


def mark_nodes(axes: Axes, one: xr.Dataset, chosen: xr.DataArray, look: Look) -> None:
    """Mark the chosen nodes of the plane."""
    # On a finer grid only some nodes have marks, which would cover the colours.
    skip = -(-chosen.restitution.size // _MARKED)
    r, lam = skip * np.array(np.nonzero(chosen.values[::skip, ::skip]))
    drawn: Look = {"color": "#000000", "linestyle": "none", **look}
    axes.plot(one.amplitude.values[lam], one.restitution.values[r], **drawn)


def plane_map(axes: Axes, one: xr.Dataset, values: np.ndarray, **look: Any) -> Any:
    """Values at the nodes of the plane as an image; the middles of its pixels are the nodes."""
    left, right = _outer_edges(one.amplitude.values)
    low, high = _outer_edges(one.restitution.values)
    return image(axes, values, (left, right, low, high), **look)


def _outer_edges(nodes: np.ndarray) -> np.ndarray:
    """The ends of a range whose first and last cells have their middles at the outer nodes."""
    return 1.5 * nodes[[0, -1]] - 0.5 * nodes[[1, -2]]


def legend_of_kinds(data: xr.Dataset) -> list:
    """Entries of a legend for the periods of locked motions, and for the other kinds that occur."""
    names = [_range_of_periods(low, high - 1) for low, high in pairwise(PERIODS)]
    names.append(f"from {PERIODS[-1]} T")
    names[0] = f"locked, {names[0]}"
    others = [(kind, fill) for kind, fill in OTHER_COLOURS.items() if kind in data.kind.values]
    return patches([*zip(names, LOCKED, strict=True), *others])


def _range_of_periods(low: int, high: int) -> str:
    return f"{low} T" if low == high else f"{low} to {high} T"


def patches(fills: Iterable[tuple[str, Any]]) -> list[Patch]:
    """Entries of a legend for areas, hatched where the areas have dots."""
    look: Look = {"edgecolor": "#000000", "linewidth": 0.4}
    return [Patch(facecolor=x, label=name, hatch=_HATCHES.get(name), **look) for name, x in fills]


def stacked_shares(part: Any, data: xr.Dataset, groups: Mapping[str, str], title: str) -> None:
    """Shares of nodes known to agree, not known, and known to differ, as bars one upon another.

    There is a panel for each simple model, with a bar for each group and ϖ. ``groups`` are the
    groups with their names in the picture.
    """
    ratios = data.frequency_ratio.values
    for simple, axes in zip(data.simple.values, part.subplots(1, 2, sharey=True), strict=True):
        one = data.sel(simple=simple, motion_group=list(groups)).transpose("motion_group", ...)
        low = one.agreement_low.values
        high = one.agreement_high.values
        place = np.arange(len(groups))[:, np.newaxis] * (ratios.size + 1) + np.arange(ratios.size)
        sizes = (low, high - low, 1 - high)
        bottoms = (np.zeros_like(low), low, high)
        for size, bottom, look in zip(sizes, bottoms, _PARTS, strict=True):
            drawn: Look = {"edgecolor": "#000000", "linewidth": 0.4, "width": 0.9} | look
            axes.bar(place.ravel(), size.ravel(), bottom=bottom.ravel(), **drawn)
        names = [f"${number_label(float(x))}$" for x in ratios]
        axes.set_xticks(place.ravel(), names * len(groups))
        axes.tick_params(axis="x", labelsize=5.5, length=0)
        for middle, group in zip(place.mean(axis=1), groups.values(), strict=True):
            axes.text(middle, 1.03, group, ha="center", va="bottom", fontsize=7)
        axes.set(xlabel=r"frequency ratio $\varpi$", ylim=(0, 1))
        axes.set_title(title.format(simple), pad=30)
    legend_below(part, ncols=len(_PARTS), fontsize=7)


def draw_shares(
    part: Any, data: xr.Dataset, name: str, dim: str, looks: Mapping, title: str
) -> None:
    """Bounds of shares along ϖ, side by side for the places along a dimension: a mark at the lower
    one, and a bar up to the upper one.

    There is a panel for each simple model.
    """
    for simple, axes in zip(data.simple.values, part.subplots(1, 2, sharey=True), strict=True):
        for k, (place, (text, colour, marker)) in enumerate(looks.items()):
            one = data.sel({"simple": simple, dim: place})
            # Side by side, on both sides of the ϖ at which they were computed.
            ratio = one.frequency_ratio.values * _ASIDE ** (2 * k + 1 - len(looks))
            low, high = (one[f"{name}{end}"].values for end in ("_low", "_high"))
            look: Look = {"color": colour, "marker": marker, "label": text, **_BARS}
            axes.errorbar(ratio, low, [np.zeros_like(low), high - low], **look)
        axes.set(xlabel=r"frequency ratio $\varpi$", title=title.format(simple))
        logarithmic(axes, ylim=(0, 1.03))
    legend_below(part, ncols=len(looks), fontsize=7)


def bars(axes: Axes, place: np.ndarray, data: xr.Dataset, name: str, **look) -> None:
    """A variable at given places, with error bars between its limits ``_low`` and ``_high``."""
    middle, low, high = (data[f"{name}{end}"].values for end in ("", "_low", "_high"))
    look = _BARS | look
    axes.errorbar(place, middle, [middle - low, high - middle], **look)
