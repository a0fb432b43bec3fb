"""Orbits of the spring-damper model over time (Figs. 7 and 12)."""

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
    time = data.time.values
    ball = data.ball.values
    table = data.table.values
    touching = data.contact.values.astype(bool)
    end = float(time[-1])
    axes.plot(time, table, color=TABLE)
    flight = time >= time[touching][-1]
    axes.plot(time[flight], ball[flight], color=CONTACT)
    axes.plot(time[touching], ball[touching], color=CONTACT, linewidth=2.6)
    low = table.min() - 0.16 * (ball.max() - table.min())
    duration = float(data.contact_duration)
    reach = 0.12 * end
    before = float(data.impact_velocity)
    after = float(data.bounce_velocity)
    _draw_velocity(axes, 0.0, ball[0], before, reach, r"$z′_i$")
    _draw_instant(axes, 0.0, ball[0], low, r"$\tau_i=0$")
    release = ball[touching][-1]
    _draw_velocity(axes, duration, release, after, reach, r"$z′_b$")
    _draw_instant(axes, duration, release, low, r"$\tau_b$")
    _draw_velocity(axes, end, ball[-1], before, reach, r"$z′_2$")
    _draw_instant(axes, end, ball[-1], low, r"$\tau_2=\tau_i+2\pi n$")
    top = int(np.argmax(ball))
    dip = int(np.argmin(table))
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


def _draw_instant(axes: Axes, instant: float, height: float, low: float, name: str) -> None:
    """A start or an end of contact, with its name at the foot of a guide."""
    axes.plot([instant, instant], [low, height], **GUIDE)
    axes.plot(instant, height, "o", color="black", markersize=3.5, zorder=5)
    note(axes, name, (instant, low), (0, -2), ha="center", va="top")


def _draw_velocity(
    axes: Axes, instant: float, height: float, velocity: float, reach: float, symbol: str
) -> None:
    """The tangent before an impact, or after a release, with a fixed length in τ."""
    side = np.copysign(reach, velocity)
    here = (instant, height)
    far = (instant + side, height + side * velocity)
    if velocity < 0:
        axes.annotate("", xy=here, xytext=far, arrowprops=ARROW)
        note(axes, symbol, far, (4, 1), ha="left", va="center")
    else:
        axes.annotate("", xy=far, xytext=here, arrowprops=ARROW)
        note(axes, symbol, far, (-4, 1), ha="right", va="center")


def both_histories(data: xr.Dataset) -> Figure:
    """Fig. 12: height over τ, with the table Λ sin τ of all curves; on the right the apex."""
    figure, (axes, summit) = canvas(WIDE, 3.4, columns=2, width_ratios=(2.4, 1.0))
    n = data.attrs["n"]
    amplitude = data.attrs["amplitude"]
    period = 2 * np.pi * n
    time = np.linspace(-0.1 * 2 * np.pi, period + 0.35 * 2 * np.pi, 400)
    axes.plot(time, amplitude * np.sin(time), color=TABLE, label="table")
    for part in (axes, summit):
        _draw_both_models(part, data, period)
    halves = np.arange(0, 2 * n + 1)
    axes.set_xticks(np.pi * halves, ["0", r"$\pi$", *(rf"${k}\pi$" for k in halves[2:])])
    title = parameters(data, "n", "restitution", "amplitude")
    axes.set(xlabel=r"time $\tau$", ylabel="$z$, $w$", xlim=(time[0], time[-1]), title=title)
    _enlarge_summit(summit, data)
    legend_below(figure, ncols=data.sizes["frequency_ratio"] + 2, columnspacing=1.2)
    return figure


def _enlarge_summit(summit: Axes, data: xr.Dataset) -> None:
    """Limits that separate the stiffest contact from the restitution model at the summit."""
    ball = data.restitution_ball.values
    top = float(ball.max())
    at = float(data.table_phase[int(ball.argmax())])
    stiffest = float(data.ball.isel(frequency_ratio=-1).max())
    below = max(3 * (top - stiffest), 0.02 * top)
    reach = np.sqrt(2 * below)  # of a free flight
    summit.set(xlabel=r"time $\tau$", title="the summit, enlarged")
    summit.set(xlim=(at - reach, at + reach), ylim=(top - below, top + 0.15 * below))


def _draw_both_models(axes: Axes, data: xr.Dataset, period: float) -> None:
    """Both models; the restitution model is a broad line, on which the other lines are visible."""
    phase = data.table_phase.values
    rigid = _three_cycles(phase, data.restitution_ball.values, period)
    axes.plot(*rigid, color=_RIGID, label="restitution", linewidth=3.5)
    # The stiffest contact is black, solid and above the others for any number of contacts.
    stiffest_first = coloured(data.sortby("frequency_ratio", ascending=False), "frequency_ratio")
    for k, ((curve, colour), dashes) in enumerate(zip(stiffest_first, cycle(_DASHES))):
        flight = _three_cycles(phase, curve.ball.values, period)
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
