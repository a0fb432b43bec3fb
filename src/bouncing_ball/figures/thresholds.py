"""Thresholds along ϖ: of permanent contact (Figs. 11, 16), of an error (Figs. 14, 16)."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from bouncing_ball.figures.style import CONTACT, GUIDE, logarithmic, note, parameters


def draw_threshold(axes: Axes, data: xr.Dataset) -> None:
    """Λ_SD with its minimum."""
    high, minimum = float(data.frequency_ratio[-1]), float(data.minimum_threshold)
    axes.plot(data.frequency_ratio, data.threshold_amplitude, color=CONTACT)
    axes.axhline(minimum, **GUIDE)
    force = data.attrs.get("release") == "force"
    name = "minimum" if force else r"$2\zeta\sqrt{1-\zeta^2}$"
    note(axes, name, (high, minimum), (0, 3), ha="right", fontsize=8)
    logarithmic(axes, data.frequency_ratio)
    rule = "F" if force else "SD"
    axes.set(ylabel=rf"threshold amplitude $\Lambda_{{{rule}}}$", ylim=(0, 2))
    damping = rf"$\zeta={float(data.damping_ratio):.4f}$"
    axes.set_title(f"{parameters(data, 'restitution')}, {damping}", fontsize=9)


def draw_error(axes: Axes, data: xr.Dataset, name: str, digits: int) -> None:
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
