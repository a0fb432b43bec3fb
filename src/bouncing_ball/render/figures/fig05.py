"""Figure 5: apparent restitution coefficient against ϖ, four cases."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.render.figures.branches import draw_curve
from bouncing_ball.render.figures.style import COLOURS, GUIDE, canvas, logarithmic, number


def draw(data: xr.Dataset) -> Figure:
    """One curve for each case, with its restitution coefficient as a guide."""
    figure, axes = canvas(height=2.8)
    for case, colour in zip(data.case, COLOURS, strict=False):
        curve = data.sel(case=case)
        r, lam = float(curve.restitution), float(curve.amplitude)
        axes.axhline(r, **GUIDE)
        draw_curve(
            axes,
            curve.frequency_ratio,
            curve.apparent_restitution,
            curve.admissible,
            color=colour,
        )
        axes.annotate(
            rf"$r={number(r)}$, $\Lambda={number(lam)}$",
            (float(data.frequency_ratio[-1]), r),
            xytext=(0, -3),
            textcoords="offset points",
            ha="right",
            va="top",
            fontsize=8,
        )
    logarithmic(axes)
    axes.set(
        xlabel=r"frequency ratio $\varpi$",
        ylabel="apparent restitution $r_a$",
        xlim=(float(data.frequency_ratio[0]), float(data.frequency_ratio[-1])),
        ylim=(0, 1.05),
    )
    axes.set_title(rf"$n={data.attrs['n']}$", fontsize=9)
    return figure
