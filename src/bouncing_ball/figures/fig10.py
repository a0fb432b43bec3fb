"""Figure 10: bouncing-off velocity against ϖ."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.amplitudes import draw_amplitudes
from bouncing_ball.figures.style import GUIDE, canvas, note, parameters


def draw(data: xr.Dataset) -> Figure:
    """One curve for each amplitude, with the restitution model's nπ."""
    figure, axes = canvas(height=2.6)
    limit = float(data.restitution_bounce_velocity)
    axes.axhline(limit, **GUIDE)
    name = rf"${round(limit / np.pi)}\pi$" if limit > 1.5 * np.pi else r"$\pi$"
    note(axes, name, (float(data.frequency_ratio[0]), limit), (4, 3), fontsize=8)
    draw_amplitudes(axes, data, "bounce_velocity")
    axes.set_ylabel(r"bouncing-off velocity $z′_b$")
    axes.legend(loc="lower right", title=parameters(data, "n", "restitution"), title_fontsize=8)
    return figure
