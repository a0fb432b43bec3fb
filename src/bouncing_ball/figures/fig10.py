"""Figure 10: bouncing-off velocity against ϖ."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.branches import draw_curve
from bouncing_ball.figures.style import COLOURS, GUIDE, canvas, logarithmic, number


def draw(data: xr.Dataset) -> Figure:
    """One curve for each amplitude, with the restitution model's nπ."""
    figure, axes = canvas(height=2.6)
    looks = ("-", (0, (5, 1.5)), (0, (1, 1)), (0, (5, 1.5, 1, 1.5)))
    limit = float(data.restitution_bounce_velocity)
    axes.axhline(limit, **GUIDE)
    axes.annotate(
        rf"${round(limit / np.pi)}\pi$" if limit > 1.5 * np.pi else r"$\pi$",
        (float(data.frequency_ratio[0]), limit),
        xytext=(4, 3),
        textcoords="offset points",
        fontsize=8,
    )
    for k, case in enumerate(data.case.values):
        curve = data.sel(case=case)
        draw_curve(
            axes,
            curve.frequency_ratio,
            curve.bounce_velocity,
            curve.admissible,
            color=COLOURS[k % len(COLOURS)],
            linestyle=looks[k % len(looks)],
            label=rf"$\Lambda={number(float(curve.amplitude))}$",
        )
    logarithmic(axes)
    axes.set(
        xlabel=r"frequency ratio $\varpi$",
        ylabel=r"bouncing-off velocity $z_b^{\prime}$",
        xlim=(float(data.frequency_ratio[0]), float(data.frequency_ratio[-1])),
    )
    axes.legend(
        loc="lower right",
        title=rf"$n={data.attrs['n']}$, $r={number(data.attrs['restitution'])}$",
        title_fontsize=8,
    )
    return figure
