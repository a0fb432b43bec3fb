"""The restitution model over time and along its branches (Figs. 2 and 3)."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.drawing.branches import draw_rigid_branch, label_branch_axes
from bouncing_ball.drawing.canvas import canvas, coloured, legend_below
from bouncing_ball.drawing.labels import parameters
from bouncing_ball.drawing.style import COLOURS, TABLE


def restitution_history(data: xr.Dataset) -> Figure:
    """Fig. 2: ball and table over time in periods of the table, in the restitution model."""
    figure, axes = canvas(height=2.4)
    periods = data.time / (2 * np.pi)
    axes.plot(periods, data.ball, color=COLOURS[0], label="ball $z$")
    axes.plot(periods, data.table, color=TABLE, label="table $w$")
    title = parameters(data, "n", "restitution", "amplitude")
    axes.set(xlabel=r"time $\tau/2\pi$", ylabel="$z$, $w$", title=title)
    axes.set(xlim=(0, float(periods[-1])), ylim=(None, 1.25 * float(data.ball.max())))
    axes.legend(loc="upper center", ncols=2)
    return figure


def restitution_families(data: xr.Dataset) -> Figure:
    """Fig. 3: the restitution model's branch for each family."""
    figure, axes = canvas(4.6, height=3.6)
    for family, colour in coloured(data, "n"):
        draw_rigid_branch(axes, family, family.sel(impact_map="exact"), colour)
        # The name is beside the branch, because five colours cannot be distinguished in grey.
        top = family.isel(point=family.phase.fillna(-np.inf).argmax("point"))
        end = (top.amplitude, top.phase / np.pi)
        name = f"$n={family.n.item()}$"
        axes.annotate(name, end, (3, 0), textcoords="offset points", va="center", color=colour)
    label_branch_axes(axes, data, r"phase $\varphi/\pi$", parameters(data, "restitution"))
    legend_below(figure, ncols=4)
    return figure
