"""Figure 10: bouncing-off velocity against ϖ."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.render.figures.amplitudes import draw_amplitudes
from bouncing_ball.render.figures.style import GUIDE, canvas, number


def draw(data: xr.Dataset) -> Figure:
    """One curve for each amplitude, with the restitution model's nπ."""
    figure, axes = canvas(height=2.6)
    limit = float(data.restitution_bounce_velocity)
    axes.axhline(limit, **GUIDE)
    axes.annotate(
        rf"${round(limit / np.pi)}\pi$" if limit > 1.5 * np.pi else r"$\pi$",
        (float(data.frequency_ratio[0]), limit),
        xytext=(4, 3),
        textcoords="offset points",
        fontsize=8,
    )
    draw_amplitudes(axes, data, "bounce_velocity")
    axes.set_ylabel(r"bouncing-off velocity $z′_b$")
    axes.legend(
        loc="lower right",
        title=rf"$n={data.attrs['n']}$, $r={number(data.attrs['restitution'])}$",
        title_fontsize=8,
    )
    return figure
