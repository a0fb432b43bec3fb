"""Orbits of the spring-damper model over time (Figs. 7 and 12)."""

from itertools import cycle

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.drawing.canvas import WIDE, canvas, coloured, legend_below
from bouncing_ball.drawing.labels import note, note_beside, number_label, parameters
from bouncing_ball.drawing.style import ARROW, CONTACT, DASHES, GUIDE, TABLE, Look

_RIGID = "#b3b3b3"
# Time is in periods of the table, as in Fig. 2.
_PERIOD = 2 * np.pi
_TIME = r"time $\tau/2\pi$"


def contact_history(data: xr.Dataset) -> Figure:
    """Fig. 7: one cycle with the instants and velocities of the paper's equations."""
    figure, axes = canvas(5.0, 3.2)
    time = data.time.values / _PERIOD
    ball = data.ball.values
    table = data.table.values
    touching = data.contact.values.astype(bool)
    end = float(time[-1])
    axes.plot(time, table, color=TABLE)
    flight = time >= time[touching][-1]
    axes.plot(time[flight], ball[flight], color=CONTACT)
    axes.plot(time[touching], ball[touching], color=CONTACT, linewidth=2.6)
    duration = float(data.contact_duration) / _PERIOD
    reach = 0.12 * end
    before = float(data.impact_velocity) * _PERIOD
    after = float(data.bounce_velocity) * _PERIOD
    _draw_velocity(axes, 0.0, ball[0], before, reach, r"$z′_i$")
    _draw_instant(axes, 0.0, ball[0], r"$\tau_i=0$", "right")
    release = ball[touching][-1]
    _draw_velocity(axes, duration, release, after, reach, r"$z′_b$")
    _draw_instant(axes, duration, release, r"$\tau_b$", "left")
    _draw_velocity(axes, end, ball[-1], before, reach, r"$z′_2$")
    _draw_instant(axes, end, ball[-1], r"$\tau_2=\tau_i+2\pi n$", "center")
    title = parameters(data, "n", "restitution", "amplitude", "frequency_ratio")
    axes.set(xlabel=_TIME, ylabel="$z$, $w$", xlim=(-0.16 * end, 1.12 * end))
    # The names of the instants are between the title and the panel.
    axes.set_title(title, pad=18)
    axes.margins(y=0.12)
    figure.draw_without_rendering()
    top = int(np.argmax(ball))
    dip = int(np.argmin(table))
    note_beside(axes, "ball $z$", (time[top], ball[top]), color=CONTACT)
    note_beside(axes, "table $w$", (time[dip], table[dip]), color="#5f5f5f")
    low = int(np.argmin(np.where(touching, ball, np.inf)))
    note_beside(axes, "contact", (time[low], ball[low]), fontsize=8)
    axes.annotate("flight", (time[top], 0.62 * ball[top]), ha="center", fontsize=8)
    return figure


def _draw_instant(axes: Axes, instant: float, height: float, name: str, side: str) -> None:
    """A start or an end of contact, with its name at the head of a guide."""
    axes.axvline(instant, **GUIDE)
    axes.plot(instant, height, "o", color="black", markersize=3.5, zorder=5)
    look: Look = {"xycoords": axes.get_xaxis_transform(), "ha": side, "va": "bottom"}
    apart = {"left": 2, "center": 0, "right": -2}[side]
    note(axes, name, (instant, 1.0), (apart, 3), **look)


def _draw_velocity(
    axes: Axes, instant: float, height: float, velocity: float, reach: float, symbol: str
) -> None:
    """The tangent before an impact, or after a release, with a fixed length in time."""
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
    """Fig. 12: height over time, with the table Λ sin τ of all curves; on the right the apex."""
    figure, (axes, summit) = canvas(WIDE, 3.4, columns=2, width_ratios=(2.4, 1.0))
    n = data.attrs["n"]
    amplitude = data.attrs["amplitude"]
    time = np.linspace(-0.1, n + 0.35, 400 * n)
    axes.plot(time, amplitude * np.sin(_PERIOD * time), color=TABLE, label="table")
    for part in (axes, summit):
        _draw_both_models(part, data)
    title = parameters(data, "n", "restitution", "amplitude")
    axes.set(xlabel=_TIME, ylabel="$z$, $w$", xlim=(time[0], time[-1]), title=title)
    _enlarge_summit(summit, data)
    legend_below(figure, columnspacing=1.2)
    return figure


def _enlarge_summit(summit: Axes, data: xr.Dataset) -> None:
    """Limits that separate the stiffest contact from the restitution model at the summit."""
    ball = data.restitution_ball.values
    top = float(ball.max())
    at = float(data.table_phase[int(ball.argmax())])
    stiffest = float(data.ball.isel(frequency_ratio=-1).max())
    below = max(3 * (top - stiffest), 0.02 * top)
    reach = np.sqrt(2 * below) / _PERIOD  # of a free flight
    at /= _PERIOD
    summit.set(xlabel=_TIME, title=_title_of_summit(data, top - below))
    summit.set(xlim=(at - reach, at + reach), ylim=(top - below, top + 0.15 * below))


def _title_of_summit(data: xr.Dataset, lowest: float) -> str:
    """The title of the enlargement: the curves in it, because most contacts stay below it."""
    inside = data.frequency_ratio.values[data.ball.max("table_phase").values > lowest]
    names = ", ".join(number_label(ratio) for ratio in inside[::-1])
    return rf"the summit: restitution, $\varpi={names}$"


def _draw_both_models(axes: Axes, data: xr.Dataset) -> None:
    """Both models; the restitution model is a broad line, on which the other lines are visible."""
    phase = data.table_phase.values / _PERIOD
    n = data.attrs["n"]
    rigid = _three_cycles(phase, data.restitution_ball.values, n)
    axes.plot(*rigid, color=_RIGID, label="restitution", linewidth=3.5)
    # The stiffest contact is black, solid and above the others for any number of contacts.
    stiffest_first = coloured(data.sortby("frequency_ratio", ascending=False), "frequency_ratio")
    for k, ((curve, colour), dashes) in enumerate(zip(stiffest_first, cycle(DASHES))):
        flight = _three_cycles(phase, curve.ball.values, n)
        look: Look = {"color": colour, "linestyle": dashes, "linewidth": 1.0, "zorder": 3 - k / 10}
        axes.plot(*flight, label=rf"$\varpi={number_label(curve.frequency_ratio.item())}$", **look)


def _three_cycles(
    time: np.ndarray, ball: np.ndarray, length: float
) -> tuple[np.ndarray, np.ndarray]:
    """Time and height of an orbit over three cycles; the outer cycles repeat the middle cycle.

    The point between two cycles occurs only once, because a segment of zero length would restart
    the dashes of the line.
    """
    shifted = np.concatenate([time[:-1] - length, time[:-1], time + length])
    return shifted, np.concatenate([ball[:-1], ball[:-1], ball])
