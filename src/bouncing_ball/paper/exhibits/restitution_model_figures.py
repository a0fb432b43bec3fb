"""The restitution model over time and along its branches (Figs. 2 and 3)."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.drawing.branches import draw_rigid_branch, mark_orbits
from bouncing_ball.drawing.canvas import canvas, coloured, legend_below
from bouncing_ball.drawing.labels import names_at_the_right, parameters
from bouncing_ball.drawing.style import COLOURS, TABLE


def restitution_history(data: xr.Dataset) -> Figure:
    """Fig. 2: ball and table over time in periods of the table, in the restitution model."""
    figure, axes = canvas(height=2.6)
    periods = data.time / (2 * np.pi)
    axes.plot(periods, data.ball, color=COLOURS[0], label="ball $z$")
    axes.plot(periods, data.table, color=TABLE, label="table $w$")
    title = parameters(data, "n", "restitution", "amplitude")
    axes.set(xlabel=r"time $\tau/2\pi$", ylabel="$z$, $w$", title=title)
    axes.set_xlim(0, float(periods[-1]))
    legend_below(figure)
    return figure


def restitution_families(data: xr.Dataset) -> Figure:
    """Fig. 3: the restitution model's branch for each family."""
    figure, axes = canvas(4.6, height=3.6)
    ends = []
    for family, colour in coloured(data, "n"):
        draw_rigid_branch(axes, family, family.sel(impact_map="exact"), colour)
        # Eq. 8 is the period doubling of Holmes' map.
        holmes = family.sel(impact_map="holmes")
        place = holmes.period_doubling_amplitude, holmes.period_doubling_phase
        mark_orbits(axes, "period doubling, Eq. 8", *place, colour)
        ends.append((f"$n={family.n.item()}$", float(family.phase.max()) / np.pi, colour))
    axes.set(xlabel=r"amplitude $\Lambda$", ylabel=r"phase $\varphi/\pi$")
    axes.set(title=parameters(data, "restitution"), xlim=(0.0, data.attrs["amplitude_max"]))
    legend_below(figure)
    # The names are beside the branches, because five colours cannot be distinguished in grey.
    figure.draw_without_rendering()
    names_at_the_right(axes, ends)
    return figure
