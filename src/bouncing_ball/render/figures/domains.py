"""Existence and stability domains of the spring-damper model (Figs. 8 and 9)."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from bouncing_ball.render.figures.branches import (
    draw_branch,
    draw_grazings,
    draw_period_doublings,
    draw_saddle_nodes,
    legend_handles,
)
from bouncing_ball.render.figures.style import COLOURS, END, WIDE, canvas, number


def draw_special(axes, curve: xr.Dataset, phase: xr.DataArray, colour: str) -> None:
    """Markers at the special points of one branch, at the given phases."""
    kinds = curve.special_kind.values
    for kind, mark in (
        ("saddle-node", draw_saddle_nodes),
        ("period doubling", draw_period_doublings),
        ("grazing", draw_grazings),
    ):
        at = kinds == kind
        mark(axes, curve.special_amplitude.values[at], phase.values[at] / np.pi, colour)


def draw_ends(axes, curve: xr.Dataset, phase: xr.DataArray, colour: str) -> None:
    """A cross where a branch ends inside the window, and not at its edge."""
    for at, reason in zip((0, -1), curve.end_reason.values, strict=True):
        if not str(reason).startswith("left the window"):
            axes.plot(float(curve.amplitude[at]), float(phase[at]), color=colour, **END)


def draw_domains(data: xr.Dataset) -> Figure:
    """Phases of the table at the start and at the end of contact against Λ."""
    figure, panels = canvas(WIDE, 3.3, columns=2, sharex=True, sharey=True)
    ratios = data.frequency_ratio.values
    for colour, ratio in zip(COLOURS, ratios, strict=False):
        curve = data.sel(frequency_ratio=ratio)
        special_release = curve.special_phase + curve.special_contact_duration
        for axes, phase, special in (
            (panels[0], curve.phase, curve.special_phase),
            (panels[1], curve.release_phase, special_release),
        ):
            draw_branch(
                axes, curve.amplitude, phase / np.pi, curve.stable, curve.admissible, colour
            )
            draw_special(axes, curve, special, colour)
            draw_ends(axes, curve, phase / np.pi, colour)
    panels[0].set_ylabel("phase of the table over $\\pi$")
    panels[0].set_title(r"start of contact, $\varphi/\pi$", fontsize=9)
    panels[1].set_title(r"end of contact, $(\varphi+\tau_b)/\pi$", fontsize=9)
    for axes in panels:
        axes.set(xlabel=r"amplitude $\Lambda$", xlim=(0, data.attrs["amplitude_max"]))
    contacts = [
        Line2D([], [], color=colour, linewidth=1.3, label=rf"$\varpi={number(ratio)}$")
        for colour, ratio in zip(COLOURS, ratios, strict=False)
    ]
    inside = any(not str(r).startswith("left the window") for r in data.end_reason.values.flat)
    markers = legend_handles("#5f5f5f", inadmissible=not bool(data.admissible.all()))
    if inside:
        markers.append(Line2D([], [], color="#5f5f5f", label="end of branch", **END))
    figure.legend(
        handles=[*contacts, *markers],
        loc="outside lower center",
        ncols=len(contacts) + len(markers),
        columnspacing=1.2,
        handletextpad=0.5,
    )
    figure.suptitle(rf"$n={data.attrs['n']}$, $r={number(data.attrs['restitution'])}$", fontsize=9)
    return figure
