"""Figure 6: apparent restitution coefficient against ϖ, three amplitudes."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.amplitudes import draw_amplitudes
from bouncing_ball.figures.style import GUIDE, canvas, number, parameters


def draw(data: xr.Dataset) -> Figure:
    """One curve for each amplitude, with the restitution coefficient as a guide."""
    figure, axes = canvas(height=2.6)
    for restitution in sorted(set(data.restitution.values.tolist())):
        axes.axhline(restitution, **GUIDE)
    draw_amplitudes(axes, data, "apparent_restitution")
    axes.set_ylabel("apparent restitution $r_a$")
    shown = ", ".join(sorted({number(r) for r in data.restitution.values}))
    axes.legend(title=f"{parameters(data, 'n')}, $r={shown}$", title_fontsize=8)
    return figure
