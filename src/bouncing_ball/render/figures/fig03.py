"""Figure 3: existence domains of the n-T orbits, restitution model."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.render.figures.branches import (
    draw_branch,
    draw_grazings,
    draw_period_doublings,
    draw_saddle_nodes,
    label_ends,
    legend_handles,
)
from bouncing_ball.render.figures.style import RESTITUTION, canvas, number


def draw(data: xr.Dataset) -> Figure:
    """Phase against amplitude, one branch for each family."""
    figure, axes = canvas(4.2, height=3.6)
    ends = []
    for n in data.n.values:
        family = data.sel(n=n)
        phase = family.phase / np.pi
        draw_branch(axes, family.amplitude, phase, family.stable, family.admissible, RESTITUTION)
        grazing = float(family.grazing_amplitude), float(family.grazing_phase) / np.pi
        draw_grazings(axes, *grazing, RESTITUTION)
        node = float(family.saddle_node_amplitude), float(family.saddle_node_phase) / np.pi
        draw_saddle_nodes(axes, *node, RESTITUTION)
        exact = family.sel(impact_map="exact")
        draw_period_doublings(
            axes,
            float(exact.period_doubling_amplitude),
            float(exact.period_doubling_phase) / np.pi,
            RESTITUTION,
        )
        last = int(np.nanargmax(phase.values))
        ends.append((float(family.amplitude[last]), float(phase[last]), f"$n={n}$"))
    axes.set(
        xlabel=r"amplitude $\Lambda$",
        ylabel=r"phase $\varphi/\pi$",
        xlim=(0, data.attrs["amplitude_max"]),
        ylim=(-0.52, 0.52),
    )
    label_ends(axes, ends, 0.055)
    axes.set_title(rf"$r={number(data.attrs['restitution'])}$", fontsize=9)
    figure.legend(
        handles=legend_handles(inadmissible=not bool(data.admissible.all())),
        loc="outside lower center",
        ncols=4,
        columnspacing=1.2,
        handletextpad=0.5,
    )
    return figure
