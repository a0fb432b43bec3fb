"""Figure 12: time histories of both models for several ϖ."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.figures.style import (
    COLOURS,
    RESTITUTION,
    TABLE,
    WIDE,
    canvas,
    number,
    parameters,
)

# From the softest contact to the stiffest.
_LOOKS = ((0, (1, 1)), (0, (3, 1, 1, 1)), (0, (5, 1.5)), (0, (8, 1.5)), "-", "-")
_RIGID = "#b3b3b3"


def _three_cycles(phase, ball, cycle):
    """The orbit repeats: the cycles before and after are drawn as well.

    Each point once: where a cycle ends and the next begins, rounding would
    make a segment without direction, and the dashes of the line start anew.
    """
    shifted = np.concatenate([phase[:-1] - cycle, phase[:-1], phase + cycle])
    return shifted, np.concatenate([ball[:-1], ball[:-1], ball])


def _draw_histories(axes: Axes, data: xr.Dataset, cycle: float) -> None:
    """Both models; the restitution model is a broad line, over which the others are seen."""
    phase = data.time.values + float(data.restitution_phase)
    rigid = _three_cycles(phase, data.restitution_ball.values, cycle)
    axes.plot(*rigid, color=_RIGID, label="restitution", linewidth=3.5)
    colours = [RESTITUTION, *COLOURS[1:]]
    last = data.sizes["frequency_ratio"] - 1
    for k, ratio in enumerate(data.frequency_ratio.values):
        curve = data.sel(frequency_ratio=ratio)
        axes.plot(
            *_three_cycles(curve.table_phase.values, curve.ball.values, cycle),
            # The stiffest contact is black and solid, whatever their number.
            color=colours[(last - k) % len(colours)],
            linestyle="-" if k == last else _LOOKS[k % len(_LOOKS)],
            linewidth=0.9 if k == last else 1.3,
            label=rf"$\varpi={number(ratio)}$",
        )


def _enlarged(data: xr.Dataset) -> tuple[Sequence[float], Sequence[float]]:
    """Limits of time and height about the summit, where the stiffest contact is seen apart."""
    ball = data.restitution_ball.values
    summit = float(ball.max())
    time = float(data.time[int(ball.argmax())]) + float(data.restitution_phase)
    missing = summit - float(data.ball.isel(frequency_ratio=-1).max())
    below = max(3 * missing, 0.02 * summit)
    reach = np.sqrt(2 * below)  # of a free flight
    return (time - reach, time + reach), (summit - below, summit + 0.15 * below)


def draw(data: xr.Dataset) -> Figure:
    """Height over τ, with the table at Λ sin τ for all curves; on the right, the summit."""
    figure, (axes, summit) = canvas(WIDE, 3.4, columns=2, width_ratios=(2.4, 1.0))
    cycle = 2 * np.pi * data.attrs["n"]
    time = np.linspace(-0.1 * 2 * np.pi, cycle + 0.35 * 2 * np.pi, 400)
    axes.plot(time, data.attrs["amplitude"] * np.sin(time), color=TABLE, label="table")
    for part in (axes, summit):
        _draw_histories(part, data, cycle)
    axes.set(xlabel=r"time $\tau$", ylabel="$z$, $w$", xlim=(time[0], time[-1]))
    halves = np.arange(0, 2 * data.attrs["n"] + 1)
    names = ["0", r"$\pi$", *(rf"${k}\pi$" for k in halves[2:])]
    axes.set_xticks(np.pi * halves, names)
    width, height = _enlarged(data)
    summit.set(xlabel=r"time $\tau$", xlim=width, ylim=height)
    summit.set_title("the summit, enlarged", fontsize=9)
    axes.set_title(parameters(data, "n", "restitution", "amplitude"), fontsize=9)
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), columnspacing=1.2)
    return figure
