"""Figure 14: greatest height of the ball against ϖ."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.branches import draw_curve
from bouncing_ball.figures.style import CONTACT, RESTITUTION, canvas, logarithmic, parameters
from bouncing_ball.figures.thresholds import draw_error


def draw(data: xr.Dataset) -> Figure:
    """The height in both models; below, the relative error and its threshold."""
    figure, (axes, below) = canvas(height=4.2, rows=2, sharex=True)
    look = {"color": CONTACT, "label": "spring-damper"}
    draw_curve(axes, data.frequency_ratio, data.max_height, data.admissible, **look)
    limit = float(data.restitution_max_height)
    axes.axhline(limit, color=RESTITUTION, linewidth=1.0, linestyle="--", label="restitution")
    axes.set(ylabel=r"greatest height $\max\,z$")
    axes.set_ylim(top=1.09 * limit)
    axes.set_title(parameters(data, "n", "restitution", "amplitude"), fontsize=9)
    axes.legend(loc="lower right")
    draw_error(below, data, "h", digits=1)
    logarithmic(axes)
    logarithmic(below, data.frequency_ratio)
    return figure
