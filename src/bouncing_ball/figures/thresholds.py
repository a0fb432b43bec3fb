"""Thresholds along ϖ: of permanent contact, and of an error (Figs. 11, 14, 16)."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.figures.branches import draw_curve
from bouncing_ball.figures.canvas import canvas, logarithmic, note, parameters
from bouncing_ball.figures.style import CONTACT, GUIDE, RESTITUTION, Look

_RIGID: Look = {"color": RESTITUTION, "linewidth": 1.0, "linestyle": "--"}


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
    axes.set(
        ylabel=r"greatest height $\max\,z$", title=parameters(data, "n", "restitution", "amplitude")
    )
    axes.set_ylim(top=1.09 * limit)
    axes.legend(loc="lower right")
    logarithmic(axes)
    _draw_error(below, data, "h", digits=1)
    logarithmic(below, data.frequency_ratio)
    return figure


def permanent_contact_error(data: xr.Dataset) -> Figure:
    """Fig. 16: Λ_SD and the restitution model's Λ_CR; below, the relative error."""
    figure, (axes, below) = canvas(height=4.2, rows=2, sharex=True)
    name = _draw_threshold(axes, data)
    high = axes.get_xlim()[1]
    limit = float(data.restitution_threshold)
    axes.axhline(limit, **_RIGID)
    note(axes, r"$\Lambda_{CR}$", (high, limit), (0, 3), ha="right", fontsize=8)
    # Named where it has left the line of the restitution model behind.
    ratio, curve = data.frequency_ratio.values, data.threshold_amplitude.values
    at = int(np.argmin(np.abs(np.log(ratio / ratio[int(np.argmin(curve))]) - 0.7)))
    note(axes, name, (ratio[at], curve[at]), (4, -9), color=CONTACT, fontsize=8)
    axes.set(xlabel="", ylabel=r"threshold amplitude $\Lambda$")
    _draw_error(below, data, "PC", digits=2)
    below.set_xlabel(r"frequency ratio $\varpi$")
    return figure


def _draw_threshold(axes: Axes, data: xr.Dataset) -> str:
    """Λ_SD, or Λ_F of the force release, with its minimum; its symbol."""
    high, minimum = float(data.frequency_ratio[-1]), float(data.minimum_threshold)
    axes.plot(data.frequency_ratio, data.threshold_amplitude, color=CONTACT)
    axes.axhline(minimum, **GUIDE)
    force = data.attrs.get("release") == "force"
    name = "minimum" if force else r"$2\zeta\sqrt{1-\zeta^2}$"
    note(axes, name, (high, minimum), (0, 3), ha="right", fontsize=8)
    logarithmic(axes, data.frequency_ratio)
    symbol = r"$\Lambda_{F}$" if force else r"$\Lambda_{SD}$"
    damping = rf"$\zeta={float(data.damping_ratio):.4f}$"
    title = f"{parameters(data, 'restitution')}, {damping}"
    axes.set(ylabel=f"threshold amplitude {symbol}", ylim=(0, 2), title=title)
    return symbol


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
    logarithmic(axes)
    axes.set(yscale="log", ylabel="relative error")
