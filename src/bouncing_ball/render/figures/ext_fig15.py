"""Extension: Figure 15 with the corrected model."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from bouncing_ball.render.figures.style import (
    COLOURS,
    PERIOD_DOUBLING,
    RESTITUTION,
    SADDLE_NODE,
    STABLE,
    UNSTABLE,
    canvas,
    number,
)

_COLOURS = {"spring-damper": COLOURS[1], "restitution": RESTITUTION, "corrected": COLOURS[3]}


def draw(data: xr.Dataset) -> Figure:
    """Phase of impact of all three models against Λ."""
    figure, axes = canvas(4.6, 3.4)
    for model in data.model.values:
        part, colour = data.sel(model=model), _COLOURS[str(model)]
        phase, stable = part.phase.values / np.pi, part.stable.values.astype(bool)
        for there, look in ((stable, STABLE), (~stable, UNSTABLE)):
            axes.plot(part.amplitude.values, np.where(there, phase, np.nan), color=colour, **look)
        for bound, look in zip(data.bound.values, (SADDLE_NODE, PERIOD_DOUBLING), strict=True):
            at = part.sel(bound=bound)
            axes.plot(
                float(at.bifurcation_amplitude),
                float(at.bifurcation_phase) / np.pi,
                color=colour,
                **look,
            )
    axes.set(
        xlabel=r"amplitude $\Lambda$",
        ylabel="phase of impact over $\\pi$",
        xlim=(0.9 * float(data.amplitude.min()), data.attrs["amplitude_max"]),
    )
    axes.set_title(
        rf"$n={data.attrs['n']}$, $r={number(data.attrs['restitution'])}$, "
        rf"$\varpi={number(data.attrs['frequency_ratio'])}$",
        fontsize=9,
    )
    lines = [Line2D([], [], color=colour, label=name) for name, colour in _COLOURS.items()]
    marks = [
        Line2D([], [], color="#5f5f5f", label="saddle-node", **SADDLE_NODE),
        Line2D([], [], color="#5f5f5f", label="period doubling", **PERIOD_DOUBLING),
    ]
    figure.legend(handles=[*lines, *marks], loc="outside lower center", ncols=3)
    return figure
