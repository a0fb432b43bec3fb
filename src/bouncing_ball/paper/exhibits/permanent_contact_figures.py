"""Figures 11 and 16: thresholds of permanent contact."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.drawing.canvas import canvas
from bouncing_ball.paper.exhibits.error_thresholds_figures import (
    _RIGID,
    _draw_error,
    _draw_threshold,
)


def permanent_contact(data: xr.Dataset) -> Figure:
    """Fig. 11: Λ_SD and its minimum."""
    figure, axes = canvas(height=2.6)
    _draw_threshold(axes, data)
    axes.text(0.3, 0.22, "permanent contact", transform=axes.transAxes, fontsize=8)
    axes.text(0.42, 0.72, "the ball leaves the table", transform=axes.transAxes, fontsize=8)
    return figure


def permanent_contact_error(data: xr.Dataset) -> Figure:
    """Fig. 16: Λ_SD and the restitution model's Λ_CR; below, the relative error."""
    figure, (axes, below) = canvas(height=4.2, rows=2, sharex=True)
    _draw_threshold(axes, data)
    limit = float(data.restitution_threshold)
    axes.axhline(limit, label=r"restitution, $\Lambda_{CR}$", **_RIGID)
    axes.set(xlabel="", ylabel=r"threshold amplitude $\Lambda$")
    axes.legend(loc="upper right")
    _draw_error(below, data, "PC", digits=2)
    return figure
