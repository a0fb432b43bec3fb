"""Figures 11 and 16: thresholds of permanent contact."""

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.drawing.canvas import canvas, logarithmic
from bouncing_ball.drawing.labels import note, parameters
from bouncing_ball.drawing.style import CONTACT, GUIDE, LIMIT
from bouncing_ball.drawing.thresholds import draw_relative_error


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
    axes.axhline(limit, label=r"restitution, $\Lambda_{CR}$", **LIMIT)
    axes.set(xlabel="", ylabel=r"threshold amplitude $\Lambda$")
    axes.legend(loc="upper right")
    draw_relative_error(below, data, "PC", digits=2)
    return figure


def _draw_threshold(axes: Axes, data: xr.Dataset) -> None:
    """Λ_SD, or Λ_F of the force release, with its minimum."""
    high = float(data.frequency_ratio[-1])
    minimum = float(data.minimum_threshold)
    force = data.attrs.get("release") == "force"
    symbol = r"$\Lambda_{F}$" if force else r"$\Lambda_{SD}$"
    name = f"spring-damper, {symbol}"
    axes.plot(data.frequency_ratio, data.threshold_amplitude, color=CONTACT, label=name)
    axes.axhline(minimum, **GUIDE)
    name = "minimum" if force else r"$2\zeta\sqrt{1-\zeta^2}$"
    note(axes, name, (high, minimum), (0, 3), ha="right", fontsize=8)
    ylabel = f"threshold amplitude {symbol}"
    title = rf"{parameters(data, 'restitution')}, $\zeta={float(data.damping_ratio):.4f}$"
    logarithmic(axes, data.frequency_ratio, ylabel=ylabel, ylim=(0, 2), title=title)
