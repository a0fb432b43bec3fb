"""Relative errors along ϖ with their tolerance and threshold (Figs. 14 and 16)."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from bouncing_ball.drawing.canvas import logarithmic
from bouncing_ball.drawing.labels import note
from bouncing_ball.drawing.style import CONTACT, GUIDE


def draw_relative_error(axes: Axes, data: xr.Dataset, name: str, digits: int) -> None:
    """The relative error on a logarithmic axis, the tolerance, and the ϖ of the last crossing."""
    error = data.relative_error
    tolerance = float(data.attrs["tolerance"])
    shown = np.isfinite(error.values) & (error.values > 0)
    axes.plot(data.frequency_ratio.values[shown], error.values[shown], color=CONTACT)
    axes.axhline(tolerance, **GUIDE)
    end = (float(data.frequency_ratio[-1]), tolerance)
    note(axes, rf"{100 * tolerance:g} %", end, (0, 2), ha="right", fontsize=8)
    found = float(data.error_threshold)
    if np.isfinite(found):
        axes.axvline(found, **GUIDE)
        axes.plot(found, tolerance, "o", color="black", markersize=4)
        value = rf"$\varpi_{{{name},{100 * tolerance:g}\%}}={found:.{digits}f}$"
        note(axes, value, (found, tolerance), (5, 5), fontsize=8)
    logarithmic(axes, data.frequency_ratio, yscale="log", ylabel="relative error")
