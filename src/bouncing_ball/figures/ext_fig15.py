"""Extension: Figure 15 with the corrected model."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from bouncing_ball.figures.style import (
    COLOURS,
    PERIOD_DOUBLING,
    RESTITUTION,
    SADDLE_NODE,
    STABLE,
    UNSTABLE,
    Look,
    canvas,
    parameters,
)

_COLOURS = {"spring-damper": COLOURS[1], "restitution": RESTITUTION, "corrected": COLOURS[3]}

_BROAD: Look = {"linewidth": 3.5, "alpha": 0.45}


def draw(data: xr.Dataset) -> Figure:
    """Phase of impact of all three models against Λ."""
    figure, axes = canvas(4.6, 3.6)
    for model in data.model.values:
        part, colour = data.sel(model=model), _COLOURS[str(model)]
        phase, stable = part.phase.values / np.pi, part.stable.values.astype(bool)
        # Nearly all of the corrected branch lies on that of the contact.
        broad = _BROAD if model == "spring-damper" else {}
        large = {"markersize": 8} if model == "spring-damper" else {}
        for there, look in ((stable, STABLE), (~stable, UNSTABLE)):
            curve = np.where(there, phase, np.nan)
            axes.plot(part.amplitude.values, curve, color=colour, **(look | broad))
        for bound, look in zip(data.bound.values, (SADDLE_NODE, PERIOD_DOUBLING), strict=True):
            at = part.sel(bound=bound)
            axes.plot(
                float(at.bifurcation_amplitude),
                float(at.bifurcation_phase) / np.pi,
                color=colour,
                **(look | large),
            )
    axes.set(
        xlabel=r"amplitude $\Lambda$",
        ylabel="phase of impact over $\\pi$",
        xlim=(0.9 * float(data.amplitude.min()), data.attrs["amplitude_max"]),
    )
    axes.set_title(parameters(data, "n", "restitution", "frequency_ratio"), fontsize=9)
    lines = [
        Line2D([], [], color=_COLOURS["spring-damper"], label="spring-damper", **_BROAD),
        Line2D([], [], color=_COLOURS["restitution"], label="restitution"),
        Line2D([], [], color=_COLOURS["corrected"], label="corrected"),
    ]
    marks = [
        Line2D([], [], color="#5f5f5f", label="saddle-node", **SADDLE_NODE),
        Line2D([], [], color="#5f5f5f", label="period doubling", **PERIOD_DOUBLING),
    ]
    figure.legend(handles=[*lines, *marks], loc="outside lower center", ncols=3)
    return figure
