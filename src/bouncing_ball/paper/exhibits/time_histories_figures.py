"""Motion of ball and table over time (Figs. 2, 7 and 12, and ext_instant)."""

from itertools import cycle

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.drawing.canvas import WIDE, canvas, coloured, legend_below
from bouncing_ball.drawing.labels import note, number, parameters
from bouncing_ball.drawing.style import ARROW, CONTACT, GUIDE, TABLE, Look

# From the stiffest contact to the most compliant.
_DASHES = ("-", (0, (8, 1.5)), (0, (5, 1.5)), (0, (3, 1, 1, 1)), (0, (1, 1)))
_RIGID = "#b3b3b3"


def contact_history(data: xr.Dataset) -> Figure:
    """Fig. 7: one cycle with the instants and velocities of the paper's equations."""
    figure, axes = canvas(5.0, 3.0)
    time, ball, table = data.time.values, data.ball.values, data.table.values
    touching, end = data.contact.values.astype(bool), float(time[-1])
    axes.plot(time, table, color=TABLE)
    axes.plot(time[~touching], ball[~touching], color=CONTACT)
    axes.plot(time[touching], ball[touching], color=CONTACT, linewidth=2.6)
    low = table.min() - 0.16 * (ball.max() - table.min())
    duration, reach = float(data.contact_duration), 0.12 * end
    before, after = float(data.impact_velocity), float(data.bounce_velocity)
    for instant, height, velocity, name, symbol in (
        (0.0, ball[0], before, r"$\tau_i=0$", r"$z′_i$"),
        (duration, ball[touching][-1], after, r"$\tau_b$", r"$z′_b$"),
        (end, ball[-1], before, r"$\tau_2=\tau_i+2\pi n$", r"$z′_2$"),
    ):
        axes.plot([instant, instant], [low, height], **GUIDE)
        axes.plot(instant, height, "o", color="black", markersize=3.5, zorder=5)
        # The tangent before the impact, or after the release, with a fixed length in τ.
        side = np.copysign(reach, velocity)
        here, far = (instant, height), (instant + side, height + side * velocity)
        head, tail = (here, far) if velocity < 0 else (far, here)
        axes.annotate("", xy=head, xytext=tail, arrowprops=ARROW)
        offset, ha = ((4, 1), "left") if velocity < 0 else ((-4, 1), "right")
        note(axes, symbol, far, offset, ha=ha, va="center")
        note(axes, name, (instant, low), (0, -2), ha="center", va="top")
    top, dip = int(np.argmax(ball)), int(np.argmin(table))
    note(axes, "ball $z$", (time[top], ball[top]), (0, 5), ha="center", color=CONTACT)
    note(axes, "table $w$", (time[dip], table[dip]), (0, 4), ha="center", color="#5f5f5f")
    middle = (duration / 2, ball[touching].min())
    note(axes, "contact", middle, (0, -9), ha="center", va="top", fontsize=8)
    axes.annotate("flight", (time[top], 0.62 * ball[top]), ha="center", fontsize=8)
    title = parameters(data, "n", "restitution", "amplitude", "frequency_ratio")
    axes.set(xlim=(-0.16 * end, 1.12 * end), ylim=(low, 1.15 * ball.max()), xticks=[], title=title)
    axes.set_ylabel("$z$, $w$")
    axes.set_xlabel(r"time $\tau$", labelpad=16)
    return figure


def both_histories(data: xr.Dataset) -> Figure:
    """Fig. 12: height over τ, with the table Λ sin τ of all curves; on the right the apex."""
    figure, (axes, summit) = canvas(WIDE, 3.4, columns=2, width_ratios=(2.4, 1.0))
    n, amplitude = data.attrs["n"], data.attrs["amplitude"]
    period = 2 * np.pi * n
    time = np.linspace(-0.1 * 2 * np.pi, period + 0.35 * 2 * np.pi, 400)
    axes.plot(time, amplitude * np.sin(time), color=TABLE, label="table")
    for part in (axes, summit):
        _draw_both_models(part, data, period)
    halves = np.arange(0, 2 * n + 1)
    axes.set_xticks(np.pi * halves, ["0", r"$\pi$", *(rf"${k}\pi$" for k in halves[2:])])
    title = parameters(data, "n", "restitution", "amplitude")
    axes.set(xlabel=r"time $\tau$", ylabel="$z$, $w$", xlim=(time[0], time[-1]), title=title)
    # The enlargement separates the stiffest contact from the restitution model.
    ball = data.restitution_ball.values
    top, at = float(ball.max()), float(data.time[int(ball.argmax())] + data.restitution_phase)
    below = max(3 * (top - float(data.ball.isel(frequency_ratio=-1).max())), 0.02 * top)
    reach = np.sqrt(2 * below)  # of a free flight
    summit.set(xlabel=r"time $\tau$", title="the summit, enlarged")
    summit.set(xlim=(at - reach, at + reach), ylim=(top - below, top + 0.15 * below))
    legend_below(figure, ncols=data.sizes["frequency_ratio"] + 2, columnspacing=1.2)
    return figure


def _draw_both_models(axes: Axes, data: xr.Dataset, period: float) -> None:
    """Both models; the restitution model is a broad line, on which the other lines are visible."""
    phase = data.time.values + float(data.restitution_phase)
    rigid = _three_cycles(phase, data.restitution_ball.values, period)
    axes.plot(*rigid, color=_RIGID, label="restitution", linewidth=3.5)
    # The stiffest contact is black, solid and above the others for any number of contacts.
    stiffest_first = coloured(data.sortby("frequency_ratio", ascending=False), "frequency_ratio")
    for k, ((curve, colour), dashes) in enumerate(zip(stiffest_first, cycle(_DASHES))):
        flight = _three_cycles(curve.table_phase.values, curve.ball.values, period)
        look: Look = {"color": colour, "linestyle": dashes, "linewidth": 1.0, "zorder": 3 - k / 10}
        axes.plot(*flight, label=rf"$\varpi={number(curve.frequency_ratio.item())}$", **look)


def _three_cycles(
    phase: np.ndarray, ball: np.ndarray, period: float
) -> tuple[np.ndarray, np.ndarray]:
    """Phase and height of an orbit over three cycles; the outer cycles repeat the middle cycle.

    The point between two cycles occurs only once, because a segment of zero length would restart
    the dashes of the line.
    """
    shifted = np.concatenate([phase[:-1] - period, phase[:-1], phase + period])
    return shifted, np.concatenate([ball[:-1], ball[:-1], ball])
