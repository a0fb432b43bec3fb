"""Figure 16: permanent-contact threshold of both models against ϖ."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.style import GUIDE, RESTITUTION, canvas
from bouncing_ball.figures.thresholds import draw_threshold


def draw(data: xr.Dataset) -> Figure:
    """Fig. 11 with the restitution model and the threshold of the relative error."""
    figure, axes = canvas(height=2.6)
    draw_threshold(axes, data)
    high = axes.get_xlim()[1]
    limit, tolerance = float(data.restitution_threshold), float(data.tolerance[0])
    axes.axhline(limit, color=RESTITUTION, linewidth=1.0)
    axes.annotate(
        r"$\Lambda_{CR}$",
        (high, limit),
        xytext=(0, 3),
        textcoords="offset points",
        ha="right",
        fontsize=8,
    )
    found = float(data.error_threshold.squeeze())
    if found == found:  # not NaN: the threshold lies in the range
        axes.axvline(found, **GUIDE)
        axes.annotate(
            rf"$\varpi_{{PC,{100 * tolerance:g}\%}}={found:.2f}$",
            (found, 0.82),
            xycoords=("data", "axes fraction"),
            xytext=(4, 0),
            textcoords="offset points",
            fontsize=8,
        )
    return figure
