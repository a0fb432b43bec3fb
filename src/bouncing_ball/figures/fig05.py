"""Figure 5: apparent restitution coefficient against ϖ, four cases."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.branches import draw_curve
from bouncing_ball.figures.style import (
    COLOURS,
    GUIDE,
    canvas,
    logarithmic,
    note,
    number,
    parameters,
)


def draw(data: xr.Dataset) -> Figure:
    """One curve for each case, with its restitution coefficient as a guide."""
    figure, axes = canvas(height=2.8)
    ratio = data.frequency_ratio
    for case, colour in zip(data.case, COLOURS, strict=False):
        curve = data.sel(case=case)
        r, lam = float(curve.restitution), float(curve.amplitude)
        axes.axhline(r, **GUIDE)
        draw_curve(axes, ratio, curve.apparent_restitution, curve.admissible, color=colour)
        name = rf"$r={number(r)}$, $\Lambda={number(lam)}$"
        note(axes, name, (float(ratio[-1]), r), (0, -3), ha="right", va="top", fontsize=8)
    logarithmic(axes, ratio)
    axes.set(ylabel="apparent restitution $r_a$", ylim=(0, 1.05))
    axes.set_title(parameters(data, "n"), fontsize=9)
    return figure
