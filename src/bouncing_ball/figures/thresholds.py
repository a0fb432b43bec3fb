"""Thresholds along ϖ: of permanent contact, and of an error (Figs. 11, 14, 16)."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.figures.branches import draw_curve
from bouncing_ball.figures.canvas import canvas, logarithmic
from bouncing_ball.figures.labels import note, parameters
from bouncing_ball.figures.style import CONTACT, GUIDE, MODELS, Look

_RIGID: Look = MODELS["restitution"] | {"linestyle": "--"}


def permanent_contact(data: xr.Dataset) -> Figure:
    """Fig. 11: Λ_SD and its minimum."""
    figure, axes = canvas(height=2.6)
    _draw_threshold(axes, data)
    axes.text(0.3, 0.22, "permanent contact", transform=axes.transAxes, fontsize=8)
    axes.text(0.42, 0.72, "the ball leaves the table", transform=axes.transAxes, fontsize=8)
    return figure


def height_error(data: xr.Dataset) -> Figure:
    """Fig. 14: the greatest height in both models; below, the relative error."""
    figure, (axes, below) = canvas(height=4.2, rows=2, sharex=True)
    look = {"color": CONTACT, "label": "spring-damper"}
    draw_curve(axes, data.frequency_ratio, data.max_height, data.admissible, **look)
    limit = float(data.restitution_max_height)
    axes.axhline(limit, label="restitution", **_RIGID)
    title = parameters(data, "n", "restitution", "amplitude")
    logarithmic(axes, ylabel=r"greatest height $\max\,z$", title=title, ylim=(None, 1.09 * limit))
    axes.legend(loc="lower right")
    _draw_error(below, data, "h", digits=1)
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


def _draw_threshold(axes: Axes, data: xr.Dataset) -> None:
    """Λ_SD, or Λ_F of the force release, with its minimum."""
    high, minimum = float(data.frequency_ratio[-1]), float(data.minimum_threshold)
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


def _draw_error(axes: Axes, data: xr.Dataset, name: str, digits: int) -> None:
    """The relative error on a logarithmic axis, the tolerance, and the ϖ of the last crossing."""
    error, tolerance = data.relative_error.squeeze("quantity"), float(data.tolerance[0])
    shown = np.isfinite(error.values) & (error.values > 0)
    axes.plot(data.frequency_ratio.values[shown], error.values[shown], color=CONTACT)
    axes.axhline(tolerance, **GUIDE)
    end = (float(data.frequency_ratio[-1]), tolerance)
    note(axes, rf"{100 * tolerance:g} %", end, (0, 2), ha="right", fontsize=8)
    found = float(data.error_threshold.squeeze())
    if np.isfinite(found):
        axes.axvline(found, **GUIDE)
        axes.plot(found, tolerance, "o", color="black", markersize=4)
        value = rf"$\varpi_{{{name},{100 * tolerance:g}\%}}={found:.{digits}f}$"
        note(axes, value, (found, tolerance), (5, 5), fontsize=8)
    logarithmic(axes, data.frequency_ratio, yscale="log", ylabel="relative error")
