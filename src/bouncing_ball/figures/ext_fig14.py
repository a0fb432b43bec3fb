"""Extension: Figure 14 with the corrected model."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.branches import draw_curve
from bouncing_ball.figures.style import (
    COLOURS,
    CONTACT,
    RESTITUTION,
    canvas,
    logarithmic,
    parameters,
)


def draw(data: xr.Dataset) -> Figure:
    """Greatest height in all three models."""
    figure, axes = canvas(height=2.7)
    limit = float(data.restitution_max_height)
    ratio = data.frequency_ratio
    # Broad and pale: nearly all of the corrected curve lies on it.
    look = {"color": CONTACT, "linewidth": 3.5, "alpha": 0.45, "label": "spring-damper"}
    draw_curve(axes, ratio, data.max_height, data.admissible, **look)
    axes.axhline(limit, color=RESTITUTION, linewidth=1.0, linestyle="--", label="restitution")
    axes.plot(ratio, data.corrected_max_height, color=COLOURS[3], linewidth=1.0, label="corrected")
    logarithmic(axes, ratio)
    axes.set_ylabel(r"greatest height $\max\,z$")
    axes.set_ylim(top=1.09 * limit)
    axes.set_title(parameters(data, "n", "restitution", "amplitude"), fontsize=9)
    axes.legend(loc="lower right")
    return figure
