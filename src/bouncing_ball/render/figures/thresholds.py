"""Thresholds along ϖ: of permanent contact (Figs. 11, 16), of an error (Figs. 14, 16)."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from bouncing_ball.render.figures.style import CONTACT, GUIDE, logarithmic, number


def draw_threshold(axes: Axes, data: xr.Dataset) -> None:
    """Λ_SD with its minimum."""
    low, high = float(data.frequency_ratio[0]), float(data.frequency_ratio[-1])
    minimum = float(data.minimum_threshold)
    axes.plot(data.frequency_ratio, data.threshold_amplitude, color=CONTACT)
    axes.axhline(minimum, **GUIDE)
    force = data.attrs.get("release") == "force"
    axes.annotate(
        "minimum" if force else r"$2\zeta\sqrt{1-\zeta^2}$",
        (high, minimum),
        xytext=(0, 3),
        textcoords="offset points",
        ha="right",
        fontsize=8,
    )
    logarithmic(axes)
    axes.set(
        xlabel=r"frequency ratio $\varpi$",
        ylabel=r"threshold amplitude $\Lambda_{F}$"
        if force
        else r"threshold amplitude $\Lambda_{SD}$",
        xlim=(low, high),
        ylim=(0, 2),
    )
    axes.set_title(
        rf"$r={number(data.attrs['restitution'])}$, $\zeta={float(data.damping_ratio):.4f}$",
        fontsize=9,
    )


def draw_error(axes: Axes, data: xr.Dataset, name: str, digits: int) -> None:
    """The relative error on a logarithmic axis, the tolerance, and the ϖ of the last crossing."""
    error, tolerance = data.relative_error.squeeze("quantity"), float(data.tolerance[0])
    shown = np.isfinite(error.values) & (error.values > 0)
    axes.plot(data.frequency_ratio.values[shown], error.values[shown], color=CONTACT)
    axes.axhline(tolerance, **GUIDE)
    axes.annotate(
        rf"{100 * tolerance:g} %",
        (float(data.frequency_ratio[-1]), tolerance),
        xytext=(0, 2),
        textcoords="offset points",
        ha="right",
        fontsize=8,
    )
    found = float(data.error_threshold.squeeze())
    if np.isfinite(found):
        axes.axvline(found, **GUIDE)
        axes.plot(found, tolerance, "o", color="black", markersize=4)
        axes.annotate(
            rf"$\varpi_{{{name},{100 * tolerance:g}\%}}={found:.{digits}f}$",
            (found, tolerance),
            xytext=(5, 5),
            textcoords="offset points",
            fontsize=8,
        )
    logarithmic(axes)
    axes.set(yscale="log", ylabel="relative error")
