"""Thresholds along ϖ: of permanent contact, and of an error (Figs. 11, 14, 16)."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.datasets.selection import each
from bouncing_ball.drawing.canvas import canvas, draw_curve, logarithmic
from bouncing_ball.drawing.labels import note, parameters
from bouncing_ball.drawing.style import CONTACT, GUIDE, MODELS, Look
from bouncing_ball.drawing.tables import Table, at, entry_of, quantity, table

_RIGID: Look = MODELS["restitution"] | {"linestyle": "--"}


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


def thresholds(data: xr.Dataset) -> Table:
    """The ϖ needed for each tolerance, quantity by quantity.

    If the threshold is outside the range scanned, the entry is the end of the range after < or >.
    """
    low, high = (f"{float(data.frequency_ratio[k]):g}" for k in (0, -1))
    found = _threshold(".5g", f"< {low}", f"> {high}")
    columns = {f"{100 * each:g} %": at(found, tolerance=each) for each in data.tolerance.values}
    return table(each(data, "quantity"), {"quantity": quantity, **columns})


def _threshold(form: str, within: str, never: str):
    """A column of thresholds, with the given texts for thresholds outside the range scanned."""

    def column(part: xr.Dataset) -> str:
        outside = within if part.threshold_status.item() == "within" else never
        return entry_of(part.error_threshold, form, outside)

    return column
