"""Figure 16: permanent-contact threshold of both models against ϖ."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.style import RESTITUTION, canvas
from bouncing_ball.figures.thresholds import draw_threshold, mark_error_threshold


def draw(data: xr.Dataset) -> Figure:
    """Fig. 11 with the restitution model and the threshold of the relative error."""
    figure, axes = canvas(height=2.6)
    draw_threshold(axes, data)
    high = axes.get_xlim()[1]
    limit = float(data.restitution_threshold)
    axes.axhline(limit, color=RESTITUTION, linewidth=1.0)
    axes.annotate(
        r"$\Lambda_{CR}$",
        (high, limit),
        xytext=(0, 3),
        textcoords="offset points",
        ha="right",
        fontsize=8,
    )
    mark_error_threshold(axes, data, "PC", digits=2, height=0.82, side="right")
    return figure
