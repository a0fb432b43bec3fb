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


def mark_error_threshold(
    axes: Axes, data: xr.Dataset, name: str, digits: int, height: float, side: str
) -> None:
    """The ϖ from which the error stays below the tolerance, if it is in the range.

    Labelled on the ``side`` of its line, at a height in parts of the axes.
    """
    found = float(data.error_threshold.squeeze())
    if np.isnan(found):
        return
    percent = 100 * float(data.tolerance[0])
    axes.axvline(found, **GUIDE)
    axes.annotate(
        rf"$\varpi_{{{name},{percent:g}\%}}={found:.{digits}f}$",
        (found, height),
        xycoords=("data", "axes fraction"),
        xytext=(-4 if side == "left" else 4, 0),
        textcoords="offset points",
        ha="right" if side == "left" else "left",
        fontsize=8,
    )
