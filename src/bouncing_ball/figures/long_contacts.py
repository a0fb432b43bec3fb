"""Permanent contact and the orbits with a long contact: stable windows and basins."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from bouncing_ball.datasets.selection import each
from bouncing_ball.figures.canvas import WIDE, canvas, coloured, legend_below, logarithmic
from bouncing_ball.figures.labels import number
from bouncing_ball.figures.style import (
    COLOURS,
    CONTACT,
    GUIDE,
    MARKS,
    PERIOD_DOUBLING,
    SADDLE_NODE,
    Look,
)

_MARKS: dict[str, Look] = {
    SADDLE_NODE: {**MARKS[SADDLE_NODE], "color": COLOURS[1]},
    PERIOD_DOUBLING: {**MARKS[PERIOD_DOUBLING], "color": COLOURS[3]},
    "grazing in contact": {**MARKS["grazing"], "color": COLOURS[0]},
    "grazing in flight": {**MARKS["grazing"], "marker": "v", "color": COLOURS[2]},
}
# Every so many of the windows with the same kind of end have a mark.
_EVERY = 8
# Colours in the order of the motions; they are five steps of grey.
_FILLS = ("#ffffff", "#b9d7ea", "#b34a10", "#e0a030", "#000000")
_RATIO = r"frequency ratio $\varpi$"
_ORBITS = {1: "o", 2: "^"}


def stable_windows(data: xr.Dataset) -> Figure:
    """ext_rattling: the window of the first r with its ends; ϖ² times the widths for all r."""
    figure, (left, right) = canvas(WIDE, 3.2, columns=2)
    _draw_window(left, data.isel(restitution=0))
    ratio = data.frequency_ratio.values
    for one, colour in coloured(data.sortby("restitution"), "restitution"):
        width = ratio**2 * (one.window_amplitude - one.threshold_amplitude).values
        name = number(float(one.restitution))
        right.plot(ratio, width, ".", color=colour, markersize=2.5, label=name)
        right.plot(ratio[-1], one.stiff_window, marker=5, color=colour, clip_on=False)
    ylabel = r"$\varpi^2\,(\Lambda_{\mathrm{end}}-\Lambda_{SD})$"
    title = r"its width for each $r$, and the limit for $\varpi\to\infty$"
    logarithmic(right, xlabel=_RATIO, yscale="log", ylabel=ylabel, title=title)
    right.legend(loc="lower right", title="$r$, from above", markerscale=3)
    return figure


def basins(data: xr.Dataset) -> Figure:
    """ext_basins: a panel for each Λ, in which each start has the colour of the motion it
    leads to.
    """
    figure, row = canvas(WIDE, 3.1, columns=data.sizes["case"], sharey=True, squeeze=False)
    image: Look = {"origin": "lower", "aspect": "auto", "interpolation": "none"}
    image |= {"extent": (-1.0, 1.0, 0.0, data.attrs["velocity_max"])}
    image |= {"cmap": ListedColormap(_FILLS), "vmin": -0.5, "vmax": len(_FILLS) - 0.5}
    for one, axes in zip(each(data, "case"), row[0], strict=True):
        axes.imshow(one.destination, **image)
        for k, mark in _ORBITS.items():
            at = one.orbit_phase[k] / np.pi, one.orbit_speed[k]
            axes.plot(*at, mark, color="#000000", markerfacecolor="#ffffff", markersize=5)
        # The variable, not the attribute of this name, which is a list.
        amplitude = number(float(one["amplitude"]))
        axes.set(title=rf"$\Lambda={amplitude}$", xlabel=r"phase of impact $\varphi/\pi$")
        axes.spines[["top", "right"]].set_visible(True)
    row[0, 0].set_ylabel(r"relative speed of impact $-\delta′$")
    handles = [
        Patch(facecolor=fill, edgecolor="#000000", linewidth=0.5, label=str(motion))
        for fill, motion in zip(_FILLS, data.motion.values, strict=True)
    ]
    legend_below(figure, handles, ncols=len(handles), fontsize=7)
    return figure


def _draw_window(axes: Axes, window: xr.Dataset) -> None:
    """The window of one r, with marks at its upper end by the kind of the end."""
    ratio, kinds = window.frequency_ratio.values, window.window_end.values
    low, high = window.threshold_amplitude.values, window.window_amplitude.values
    axes.fill_between(ratio, low, high, color="#dcdcdc", linewidth=0)
    for kind, look in _MARKS.items():
        there = np.flatnonzero(kinds == kind)[::_EVERY]
        if there.size:
            axes.plot(ratio[there], high[there], label=kind, **(look | {"markersize": 3.5}))
    axes.plot(ratio, low, color=CONTACT, linewidth=1.3, label=r"$\Lambda_{SD}$")
    axes.axhline(1.0, **GUIDE)
    title = rf"stable window, $r={number(float(window.restitution))}$"
    logarithmic(axes, xlabel=_RATIO, ylabel=r"amplitude $\Lambda$", title=title)
    axes.set_ylim(bottom=0.0)
    axes.legend(loc="lower right", title="upper end")
