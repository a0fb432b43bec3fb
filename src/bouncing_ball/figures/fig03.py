"""Figure 3: existence domains of the n-T orbits, restitution model."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.branches import (
    draw_branch,
    draw_marks,
    label_ends,
    legend_handles,
)
from bouncing_ball.figures.style import (
    GRAZING,
    PERIOD_DOUBLING,
    RESTITUTION,
    SADDLE_NODE,
    canvas,
    parameters,
)


def draw(data: xr.Dataset) -> Figure:
    """Phase against amplitude, one branch for each family."""
    figure, axes = canvas(4.2, height=3.6)
    ends = []
    for n in data.n.values:
        family = data.sel(n=n)
        phase = family.phase / np.pi
        draw_branch(axes, family.amplitude, phase, family.stable, family.admissible, RESTITUTION)
        exact = family.sel(impact_map="exact")
        for name, mark in (
            ("grazing", GRAZING),
            ("saddle_node", SADDLE_NODE),
            ("period_doubling", PERIOD_DOUBLING),
        ):
            place = exact[f"{name}_amplitude"], exact[f"{name}_phase"]
            draw_marks(axes, *place, mark, RESTITUTION)
        last = int(np.nanargmax(phase.values))
        ends.append((float(family.amplitude[last]), float(phase[last]), f"$n={n}$"))
    axes.set(
        xlabel=r"amplitude $\Lambda$",
        ylabel=r"phase $\varphi/\pi$",
        xlim=(0, data.attrs["amplitude_max"]),
        ylim=(-0.52, 0.52),
    )
    label_ends(axes, ends, 0.055)
    axes.set_title(parameters(data, "restitution"), fontsize=9)
    figure.legend(
        handles=legend_handles(inadmissible=not bool(data.admissible.all())),
        loc="outside lower center",
        ncols=4,
        columnspacing=1.2,
        handletextpad=0.5,
    )
    return figure
