"""Extension: Figures 8, 14 and 16 on contacts of other laws."""

from itertools import cycle

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.laws import LAWS
from bouncing_ball.figures.style import (
    RESTITUTION,
    WIDE,
    canvas,
    logarithmic,
    number,
    parameters,
)

# The linear contact, whose threshold is smooth, comes first.
_SHAPES = ("", "o", "s", "^")


def draw(data: xr.Dataset) -> Figure:
    """Phase against Λ, greatest height and permanent contact against π/D."""
    figure, panels = canvas(WIDE, 2.9, columns=3)
    branches, heights, held = np.ravel(panels)
    for law, shape in zip(data["law"].values, cycle(_SHAPES), strict=False):
        look, part = LAWS[str(law)], data.sel(law=law)
        for ratio in data.shown_ratio.values:
            one = part.sel(shown_ratio=ratio)
            # The hardest contacts all lie on the restitution model's branch.
            label = str(law) if ratio == data.shown_ratio.values[0] else None
            branches.plot(one.amplitude, one.phase / np.pi, linewidth=1.0, label=label, **look)
        heights.plot(data.duration_ratio, part.max_height, linewidth=1.0, **look)
        # That of a nonlinear contact goes up and down between samples too: the line only
        # leads from one to the next, and breaks off where no threshold was found.
        drawn = {"linewidth": 0.8} if not shape else {"linewidth": 0.3, "linestyle": "-"}
        held.plot(
            data.duration_ratio,
            part.threshold_amplitude,
            marker=shape,
            markersize=1.8,
            **(look | drawn),
        )
    rigid = {"color": RESTITUTION, "linewidth": 0.6}
    heights.axhline(float(data.restitution_max_height), **rigid)
    held.axhline(1.0, **rigid)
    branches.set(xlabel=r"$\Lambda$", ylabel=r"phase $\varphi/\pi$")
    listed = ", ".join(f"{x:g}" for x in data.shown_ratio.values)
    title = rf"{parameters(data, 'restitution')}, $\pi/D$ = {listed}"
    branches.set_title(title, fontsize=8)
    heights.set(xlabel=r"$\pi/D$", ylabel=r"greatest height $\max\,z$")
    held.set(xlabel=r"$\pi/D$", ylabel=r"threshold of permanent contact")
    for axes in (heights, held):
        logarithmic(axes)
        margin = 1.06 if axes is held else 1.0
        axes.set_xlim(
            float(data.duration_ratio[0]) / margin, float(data.duration_ratio[-1]) * margin
        )
        axes.set_title(rf"$r={number(data.attrs['heights__restitution'])}$", fontsize=8)
    lines, labels = branches.get_legend_handles_labels()
    handles = list(zip(lines, held.lines, strict=False))
    figure.legend(handles, labels, loc="outside lower center", ncols=len(handles))
    return figure
