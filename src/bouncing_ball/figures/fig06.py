"""Figure 6: apparent restitution coefficient against ϖ, three amplitudes."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.branches import draw_curve
from bouncing_ball.figures.style import COLOURS, GUIDE, canvas, logarithmic, number


def draw(data: xr.Dataset) -> Figure:
    """One curve for each amplitude, at one restitution coefficient."""
    figure, axes = canvas(height=2.6)
    looks = ("-", (0, (5, 1.5)), (0, (1, 1)), (0, (5, 1.5, 1, 1.5)))
    for k, case in enumerate(data.case.values):
        curve = data.sel(case=case)
        axes.axhline(float(curve.restitution), **GUIDE)
        draw_curve(
            axes,
            curve.frequency_ratio,
            curve.apparent_restitution,
            curve.admissible,
            color=COLOURS[k % len(COLOURS)],
            linestyle=looks[k % len(looks)],
            label=rf"$\Lambda={number(float(curve.amplitude))}$",
        )
    logarithmic(axes)
    axes.set(
        xlabel=r"frequency ratio $\varpi$",
        ylabel="apparent restitution $r_a$",
        xlim=(float(data.frequency_ratio[0]), float(data.frequency_ratio[-1])),
    )
    shown = ", ".join(sorted({number(r) for r in data.restitution.values}))
    axes.legend(title=rf"$n={data.attrs['n']}$, $r={shown}$", title_fontsize=8)
    return figure
