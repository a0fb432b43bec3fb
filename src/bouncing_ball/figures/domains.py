"""Existence and stability domains of the spring-damper model (Figs. 8 and 9)."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from bouncing_ball.figures.branches import (
    draw_branch,
    draw_marks,
    label_ends,
    legend_handles,
)
from bouncing_ball.figures.style import (
    COLOURS,
    END,
    GRAZING,
    PERIOD_DOUBLING,
    SADDLE_NODE,
    WIDE,
    canvas,
    number,
    parameters,
)


def draw_special(axes, curve: xr.Dataset, phase: xr.DataArray, colour: str) -> None:
    """Markers at the special points of one branch, at the given phases."""
    for kind, mark in (
        ("saddle-node", SADDLE_NODE),
        ("period doubling", PERIOD_DOUBLING),
        ("grazing", GRAZING),
    ):
        at = curve.special_kind.values == kind
        draw_marks(axes, curve.special_amplitude[at], phase[at], mark, colour)


def draw_ends(axes, curve: xr.Dataset, phase: xr.DataArray, colour: str) -> bool:
    """A cross where a branch ends inside the window, and whether there is one."""
    inside = [not str(reason).startswith("left the window") for reason in curve.end_reason.values]
    for at in np.array([0, -1])[inside]:
        axes.plot(float(curve.amplitude[at]), float(phase[at]), color=colour, **END)
    return any(inside)


def up_to_second_saddle_node(curve: xr.Dataset) -> xr.Dataset:
    """The branch from its other end to the saddle-node at which its unstable side turns back.

    Beyond it the contact is longer than at it. A branch whose unstable side
    does not turn back is returned as it is.
    """
    durations = curve.special_contact_duration.values[curve.special_kind.values == "saddle-node"]
    if len(durations) < 2:
        return curve
    longest = np.sort(durations)[1]
    part = curve.isel(
        point=curve.contact_duration.values <= longest,
        special=curve.special_contact_duration.values <= longest,
    )
    # Cut there, it does not end there.
    stable_side = part.end_reason.values[-1]
    return part.assign(end_reason=("end", ["left the window of the figure", stable_side]))


def draw_domains(data: xr.Dataset) -> Figure:
    """Phases of the table at the start and at the end of contact against Λ, in one panel."""
    figure, axes = canvas(WIDE, 4.2)
    names, inside, admissible = [], [], []
    for k, ratio in enumerate(data.frequency_ratio.values):
        curve = up_to_second_saddle_node(data.sel(frequency_ratio=ratio))
        colour = COLOURS[k % len(COLOURS)]
        special_release = curve.special_phase + curve.special_contact_duration
        for symbol, phase, special in (
            (r"\varphi", curve.phase, curve.special_phase),
            (r"\varphi+\tau_b", curve.release_phase, special_release),
        ):
            y = phase / np.pi
            draw_branch(axes, curve.amplitude, y, curve.stable, curve.admissible, colour)
            draw_special(axes, curve, special, colour)
            inside.append(draw_ends(axes, curve, y, colour))
            name = rf"$\varpi={number(ratio)}$: ${symbol}$"
            names.append((float(curve.amplitude[-1]), float(y[-1]), name))
        admissible.append(bool(curve.admissible.all()))
    axes.set(
        xlabel=r"amplitude $\Lambda$",
        ylabel="phase of the table over $\\pi$",
        xlim=(0, data.attrs["amplitude_max"]),
    )
    label_ends(axes, names, 0.05)
    markers = legend_handles("#5f5f5f", inadmissible=not all(admissible))
    if any(inside):
        markers.append(Line2D([], [], color="#5f5f5f", label="end of branch", **END))
    figure.legend(
        handles=markers,
        loc="outside lower center",
        ncols=len(markers),
        columnspacing=1.2,
        handletextpad=0.5,
    )
    axes.set_title(parameters(data, "n", "restitution"), fontsize=9)
    return figure
