"""Figures 8, 14 and 16 on contacts of other laws."""

from itertools import cycle

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.canvas import WIDE, canvas, legend_below, logarithmic, number, parameters
from bouncing_ball.figures.style import LAWS, RESTITUTION

# The linear contact, whose threshold is smooth, comes first.
_SHAPES = ("", "o", "s", "^")


def figures_of_laws(data: xr.Dataset) -> Figure:
    """Phase against Λ, greatest height and permanent contact against π/D."""
    figure, (branches, heights, held) = canvas(WIDE, 2.9, columns=3)
    ratio, marked = data.duration_ratio.values, []
    for law, shape in zip(data["law"].values, cycle(_SHAPES), strict=False):
        look, part = LAWS[str(law)], data.sel(law=law)
        for k in range(data.sizes["shown_ratio"]):
            one = part.isel(shown_ratio=k)
            (line,) = branches.plot(one.amplitude, one.phase / np.pi, linewidth=1.0, **look)
        heights.plot(ratio, part.max_height, linewidth=1.0, **look)
        # That of a nonlinear contact goes up and down between samples too: the line only
        # leads from one to the next, and breaks off where no threshold was found.
        drawn = {"linewidth": 0.3, "linestyle": "-"} if shape else {"linewidth": 0.8}
        marks = {"marker": shape, "markersize": 1.8}
        marked += held.plot(ratio, part.threshold_amplitude, **(look | drawn | marks))
        marked[-1:] = [(line, marked[-1])]
    heights.axhline(float(data.restitution_max_height), color=RESTITUTION, linewidth=0.6)
    held.axhline(1.0, color=RESTITUTION, linewidth=0.6)
    branches.set(xlabel=r"$\Lambda$", ylabel=r"phase $\varphi/\pi$")
    listed = ", ".join(f"{x:g}" for x in data.shown_ratio.values)
    branches.set_title(rf"{parameters(data, 'restitution')}, $\pi/D$ = {listed}", fontsize=8)
    title = rf"$r={number(data.attrs['heights__restitution'])}$"
    for axes, name, margin in (
        (heights, r"greatest height $\max\,z$", 1.0),
        (held, r"threshold of permanent contact", 1.06),
    ):
        logarithmic(axes)
        axes.set(xlabel=r"$\pi/D$", ylabel=name, xlim=(ratio[0] / margin, ratio[-1] * margin))
        axes.set_title(title, fontsize=8)
    legend_below(figure, marked, map(str, data["law"].values), ncols=len(marked))
    return figure
