"""Figure 15: existence and stability of the n-T orbit in both models."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.branches import (
    draw_branch,
    draw_marks,
    label_ends,
    legend_handles,
)
from bouncing_ball.figures.domains import draw_special
from bouncing_ball.figures.style import (
    COLOURS,
    PERIOD_DOUBLING,
    RESTITUTION,
    SADDLE_NODE,
    canvas,
    number,
    parameters,
)


def draw(data: xr.Dataset) -> Figure:
    """Phases of both models against Λ."""
    figure, axes = canvas(5.6, 3.4)
    draw_branch(
        axes,
        data.restitution_amplitude,
        data.restitution_phase / np.pi,
        data.restitution_stable,
        data.restitution_admissible,
        RESTITUTION,
    )
    for name, mark in (("saddle_node", SADDLE_NODE), ("period_doubling", PERIOD_DOUBLING)):
        draw_marks(axes, data[f"{name}_amplitude"], data[f"{name}_phase"], mark, RESTITUTION)
    curve = data.squeeze("frequency_ratio")
    start, end = COLOURS[1], COLOURS[2]
    release = curve.special_phase + curve.special_contact_duration
    draw_branch(axes, curve.amplitude, curve.phase / np.pi, curve.stable, curve.admissible, start)
    draw_branch(
        axes, curve.amplitude, curve.release_phase / np.pi, curve.stable, curve.admissible, end
    )
    draw_special(axes, curve, curve.special_phase, start)
    draw_special(axes, curve, release, end)
    names = (
        (curve.amplitude, curve.release_phase, r"spring-damper, $\varphi+\tau_b$"),
        (data.restitution_amplitude, data.restitution_phase, r"restitution, $\varphi$"),
        (curve.amplitude, curve.phase, r"spring-damper, $\varphi$"),
    )
    # The contact may have no such branch.
    lowest = curve.amplitude.fillna(data.saddle_node_amplitude).min()
    axes.set(
        xlabel=r"amplitude $\Lambda$",
        ylabel="phase of the table over $\\pi$",
        xlim=(0.9 * float(lowest), data.attrs["amplitude_max"]),
    )
    axes.set_title(
        rf"{parameters(data, 'n', 'restitution')}, $\varpi={number(float(curve.frequency_ratio))}$",
        fontsize=9,
    )
    # The restitution branch runs the same way or the other: its upper end is meant.
    ends = [(int(np.nanargmax(phase)) if phase.notnull().any() else 0) for _, phase, _ in names]
    label_ends(
        axes,
        [
            (float(x[at]), float(y[at]) / np.pi, name)
            for (x, y, name), at in zip(names, ends, strict=True)
        ],
        0.07,
    )
    figure.legend(
        handles=legend_handles("#5f5f5f", inadmissible=not bool(data.admissible.all())),
        loc="outside lower center",
        ncols=4,
        columnspacing=1.0,
        handletextpad=0.5,
    )
    return figure
