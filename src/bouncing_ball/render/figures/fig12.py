"""Figure 12: time histories of both models for several ϖ."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.render.figures.style import COLOURS, RESTITUTION, TABLE, canvas, number


def _three_cycles(phase, ball, cycle):
    """The orbit repeats: the cycles before and after are drawn as well, in turns.

    Each point once: where a cycle ends and the next begins, rounding would
    make a segment without direction, and the dashes of the line start anew.
    """
    shifted = np.concatenate([phase[:-1] - cycle, phase[:-1], phase + cycle])
    return shifted / (2 * np.pi), np.concatenate([ball[:-1], ball[:-1], ball])


def draw(data: xr.Dataset) -> Figure:
    """Height against the phase of the table, which is the same for all curves."""
    figure, axes = canvas(5.0, 3.2)
    cycle = 2 * np.pi * data.attrs["n"]
    turns = np.linspace(-0.1, data.attrs["n"] + 0.35, 400)
    axes.plot(
        turns, data.attrs["amplitude"] * np.sin(2 * np.pi * turns), color=TABLE, label="table"
    )
    looks = ((0, (1, 1)), (0, (3, 1, 1, 1)), (0, (5, 1.5)), (0, (8, 1.5)), "-", "-")
    # From the softest contact to the stiffest, the lightest colour first.
    colours = COLOURS[:0:-1]
    for k, ratio in enumerate(data.frequency_ratio.values):
        curve = data.sel(frequency_ratio=ratio)
        phase, ball = curve.table_phase.values, curve.ball.values
        axes.plot(
            *_three_cycles(phase, ball, cycle),
            color=colours[k % len(colours)],
            linestyle=looks[k % len(looks)],
            label=rf"$\varpi={number(ratio)}$",
        )
    phase = data.time.values + float(data.restitution_phase)
    axes.plot(
        *_three_cycles(phase, data.restitution_ball.values, cycle),
        color=RESTITUTION,
        label="restitution",
        linewidth=1.0,
    )
    axes.set(
        xlabel=r"phase of the table $(\tau+\varphi)/2\pi$",
        ylabel="$z$, $w$",
        xlim=(turns[0], turns[-1]),
    )
    axes.set_title(
        rf"$n={data.attrs['n']}$, $r={number(data.attrs['restitution'])}$, "
        rf"$\Lambda={number(data.attrs['amplitude'])}$",
        fontsize=9,
    )
    figure.legend(loc="outside right center")
    return figure
