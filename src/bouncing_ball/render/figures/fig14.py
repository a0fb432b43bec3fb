"""Figure 14: greatest height of the ball against ϖ."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.render.figures.branches import draw_curve
from bouncing_ball.render.figures.style import CONTACT, RESTITUTION, canvas, logarithmic, number
from bouncing_ball.render.figures.thresholds import mark_error_threshold


def draw(data: xr.Dataset) -> Figure:
    """The height in both models and the threshold of the relative error."""
    figure, axes = canvas(height=2.7)
    limit, tolerance = float(data.restitution_max_height), float(data.tolerance[0])
    draw_curve(
        axes,
        data.frequency_ratio,
        data.max_height,
        data.admissible,
        color=CONTACT,
        label="spring-damper",
    )
    axes.axhline(limit, color=RESTITUTION, linewidth=1.0, label="restitution")
    axes.axhspan(
        (1 - tolerance) * limit,
        (1 + tolerance) * limit,
        color="#d9d9d9",
        linewidth=0,
        label=rf"$\pm{100 * tolerance:g}\,\%$",
    )
    mark_error_threshold(axes, data, "h", digits=1, height=0.06, side="left")
    logarithmic(axes)
    axes.set(
        xlabel=r"frequency ratio $\varpi$",
        ylabel=r"greatest height $\max\,z$",
        xlim=(float(data.frequency_ratio[0]), float(data.frequency_ratio[-1])),
    )
    axes.set_ylim(top=1.09 * limit)
    axes.set_title(
        rf"$n={data.attrs['n']}$, $r={number(data.attrs['restitution'])}$, "
        rf"$\Lambda={number(data.attrs['amplitude'])}$",
        fontsize=9,
    )
    axes.legend(loc="lower right", bbox_to_anchor=(1.02, 0.3), handlelength=1.2)
    return figure
