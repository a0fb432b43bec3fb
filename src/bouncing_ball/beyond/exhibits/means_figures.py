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
from bouncing_ball.drawing.labels import number_label
from bouncing_ball.drawing.style import COLOURS, GUIDE, Look

# The other means are known at few nodes only.
_MEANS = {
    "power": ("power", COLOURS[0], "o"),
    "height": ("height", COLOURS[1], "s"),
}


def mean_motions(data: xr.Dataset) -> Figure:
    """The smallest ϖ from which on the mean power and height of each simple model are right, over
    (Λ, r); below, the share of nodes known to be right from ϖ on.
    """
    ratios = data.frequency_ratio.values
    panels = [(simple, mean) for mean in _MEANS for simple in data.simple.values]
    figure, (maps, below) = stacked(5.2, (3.0, 2.2))
    row = maps.subplots(1, len(panels), sharex=True, sharey=True)
    fills = [*colormaps["viridis_r"](np.linspace(0, 0.9, len(ratios))), *UNKNOWN.values()]
    look: Look = {"cmap": ListedColormap(fills), "vmin": -0.5, "vmax": len(fills) - 0.5}
    for (simple, mean), axes in zip(panels, row, strict=True):
        one = data.sel(simple=simple, mean=mean)
        place = np.searchsorted(ratios, one.needed_ratio.fillna(0).values)
        for k, name in enumerate(UNKNOWN, len(ratios)):
            place[(one.decision == name).values] = k
        plane_map(axes, one, place, **look)
        undecided = {"marker": "x", "markersize": 2.5, "color": GUIDE["color"]}
        mark_nodes(axes, one, one.decision == "undecided", undecided)
        # A white dot tells these nodes from those of the largest ϖ in greyscale.
        at_none = {"marker": "o", "markersize": 2, "color": "#ffffff", "markeredgewidth": 0}
        mark_nodes(axes, one, one.decision == "not at any", at_none)
        axes.set(title=f"mean {mean},\n{simple} model", xlabel=r"amplitude $\Lambda$")
    row[0].set_ylabel("restitution coefficient $r$")
    words = {"not at any": "at no $\\varpi$ tried (white dot)"}
    names = [rf"$\varpi\geq{number_label(float(ratio))}$" for ratio in ratios]
    shown = data.decision.sel(mean=list(_MEANS)).values
    found = zip([*names, *UNKNOWN], fills, strict=True)
    present = [(name, fill) for name, fill in found if name in names or name in shown]
    handles = patches(present)
    for (name, _), handle in zip(present, handles, strict=True):
        handle.set_label(words.get(name, name))
    legend_below(maps, handles, ncols=5, fontsize=7)
    draw_shares(below, data, "right", "mean", _MEANS, "against the {} model")
    below.axes[0].set_ylabel("share of nodes accurate\nfrom this $\\varpi$ on: bounds")
    return figure
