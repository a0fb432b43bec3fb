"""Figure 11: permanent-contact threshold against ϖ."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.style import canvas
from bouncing_ball.figures.thresholds import draw_threshold


def draw(data: xr.Dataset) -> Figure:
    """The threshold and its minimum."""
    figure, axes = canvas(height=2.6)
    draw_threshold(axes, data)
    axes.text(0.3, 0.22, "permanent contact", transform=axes.transAxes, fontsize=8)
    axes.text(0.42, 0.72, "the ball leaves the table", transform=axes.transAxes, fontsize=8)
    return figure
