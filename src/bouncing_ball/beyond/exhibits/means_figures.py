"""The smallest frequency ratio from which on the means over a motion are right."""

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from bouncing_ball.beyond.exhibits.motion_maps import (
    UNKNOWN,
    draw_shares,
    mark_nodes,
    patches,
    plane_map,
)
from bouncing_ball.drawing.canvas import legend_below, stacked
from bouncing_ball.drawing.labels import number
from bouncing_ball.drawing.style import COLOURS, Look

_MEANS = {name: (name, colour, marker) for name, colour, marker in zip(
    ("power", "height", "flights", "exponent"), COLOURS, "osv^", strict=False)}  # fmt: skip


def mean_motions(data: xr.Dataset) -> Figure:
    """The smallest ϖ from which on a mean of each simple model is right, over (Λ, r); below, the
    share of nodes known to be right from ϖ on.
    """
    ratios = data.frequency_ratio.values
    means = data["mean"].values
    figure, (maps, below) = stacked(6.6, (4.4, 2.2))
    rows = maps.subplots(2, len(means), sharex=True, sharey=True)
    fills = [*colormaps["viridis_r"](np.linspace(0, 0.75, len(ratios))), *UNKNOWN.values()]
    look: Look = {"cmap": ListedColormap(fills), "vmin": -0.5, "vmax": len(fills) - 0.5}
    for simple, row in zip(data.simple.values, rows, strict=True):
        for mean, axes in zip(means, row, strict=True):
            one = data.sel(simple=simple, mean=mean)
            place = np.searchsorted(ratios, one.needed_ratio.fillna(0).values)
            for k, name in enumerate(UNKNOWN, len(ratios)):
                place[(one.decision == name).values] = k
            plane_map(axes, one, place, **look)
            for name, marker in {"undecided": "x", "no number": "_"}.items():
                mark_nodes(axes, one, one.decision == name, {"marker": marker, "markersize": 3})
        row[0].set_ylabel(f"{simple} model\n$r$")
    for mean, top, bottom in zip(means, *rows, strict=True):
        top.set_title(mean)
        bottom.set_xlabel(r"amplitude $\Lambda$")
    names = [rf"$\varpi\geq{number(float(ratio))}$" for ratio in ratios]
    handles = patches(zip([*names, *UNKNOWN], fills, strict=True))
    legend_below(maps, handles, ncols=5, fontsize=7)
    draw_shares(below, data, "right", "mean", _MEANS, "{} model")
    below.axes[0].set_ylabel("share of nodes known to be\nright from here on")
    return figure
