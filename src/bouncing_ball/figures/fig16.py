"""Figure 16: permanent-contact threshold of both models against ϖ."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.style import CONTACT, RESTITUTION, canvas, note
from bouncing_ball.figures.thresholds import draw_error, draw_threshold


def draw(data: xr.Dataset) -> Figure:
    """Fig. 11 with the restitution model; below, the relative error and its threshold."""
    figure, (axes, below) = canvas(height=4.2, rows=2, sharex=True)
    draw_threshold(axes, data)
    high = axes.get_xlim()[1]
    limit = float(data.restitution_threshold)
    axes.axhline(limit, color=RESTITUTION, linewidth=1.0, linestyle="--")
    note(axes, r"$\Lambda_{CR}$", (high, limit), (0, 3), ha="right", fontsize=8)
    # Named where it has left the line of the restitution model behind.
    ratio, curve = data.frequency_ratio.values, data.threshold_amplitude.values
    at = int(np.argmin(np.abs(np.log(ratio / ratio[int(np.argmin(curve))]) - 0.7)))
    name = axes.get_ylabel().split()[-1]
    note(axes, name, (ratio[at], curve[at]), (4, -9), color=CONTACT, fontsize=8)
    axes.set(xlabel="", ylabel=r"threshold amplitude $\Lambda$")
    draw_error(below, data, "PC", digits=2)
    below.set_xlabel(r"frequency ratio $\varpi$")
    return figure
