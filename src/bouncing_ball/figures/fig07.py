"""Figure 7: look of the 1-T orbit of the spring-damper model."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.figures.style import CONTACT, GUIDE, TABLE, canvas, note, parameters

_ARROW = {
    "arrowstyle": "-|>",
    "color": "black",
    "linewidth": 0.9,
    "shrinkA": 0,
    "shrinkB": 0,
    "mutation_scale": 9,
}


class Moment(NamedTuple):
    """An instant of the cycle, with the ball's height and velocity, and the paper's names."""

    time: float
    height: float
    velocity: float
    name: str
    velocity_name: str


def _instants(data: xr.Dataset) -> list[Moment]:
    """Impact, release, and the next impact."""
    ball = data.ball.values
    released = float(ball[data.contact.values.astype(bool)][-1])
    duration, end = float(data.contact_duration), float(data.time[-1])
    before, after = float(data.impact_velocity), float(data.bounce_velocity)
    return [
        Moment(0.0, float(ball[0]), before, r"$\tau_i=0$", r"$z′_i$"),
        Moment(duration, released, after, r"$\tau_b$", r"$z′_b$"),
        Moment(end, float(ball[-1]), before, r"$\tau_2=\tau_i+2\pi n$", r"$z′_2$"),
    ]


def _draw_velocity(axes: Axes, instant: Moment, reach: float) -> None:
    """An arrow along the ball's velocity: a tangent of fixed length in τ."""
    here = (instant.time, instant.height)
    rise = reach * instant.velocity
    # Into the impact, or out of the release.
    arrives = instant.velocity < 0
    tail = (instant.time - reach, instant.height - rise) if arrives else here
    head = here if arrives else (instant.time + reach, instant.height + rise)
    axes.annotate("", xy=head, xytext=tail, arrowprops=_ARROW)
    if arrives:
        note(axes, instant.velocity_name, tail, (4, 1), ha="left", va="center")
    else:
        note(axes, instant.velocity_name, head, (-4, 1), ha="right", va="center")


def _draw_instant(axes: Axes, instant: Moment, low: float, reach: float) -> None:
    """A guide down to its name, a dot at the ball, and the ball's velocity."""
    axes.plot([instant.time, instant.time], [low, instant.height], **GUIDE)
    axes.plot(instant.time, instant.height, "o", color="black", markersize=3.5, zorder=5)
    _draw_velocity(axes, instant, reach)
    note(axes, instant.name, (instant.time, low), (0, -2), ha="center", va="top")


def _name_curves(axes: Axes, data: xr.Dataset) -> None:
    """Names of ball, table, contact and flight beside them."""
    time, ball, table = data.time.values, data.ball.values, data.table.values
    touching = data.contact.values.astype(bool)
    top, dip = int(np.argmax(ball)), int(np.argmin(table))
    note(axes, "ball $z$", (time[top], ball[top]), (0, 5), ha="center", color=CONTACT)
    below = (time[dip], table[dip])
    note(axes, "table $w$", below, (0, 4), ha="center", va="bottom", color="#5f5f5f")
    middle = (float(data.contact_duration) / 2, float(ball[touching].min()))
    note(axes, "contact", middle, (0, -9), ha="center", va="top", fontsize=8)
    axes.annotate("flight", (time[top], 0.62 * ball[top]), ha="center", fontsize=8)


def draw(data: xr.Dataset) -> Figure:
    """One cycle with the instants and velocities of the paper's equations marked."""
    figure, axes = canvas(5.0, 3.0)
    time, ball = data.time.values, data.ball.values
    end = float(time[-1])
    touching = data.contact.values.astype(bool)
    axes.plot(time, data.table, color=TABLE)
    axes.plot(time[~touching], ball[~touching], color=CONTACT)
    axes.plot(time[touching], ball[touching], color=CONTACT, linewidth=2.6)
    low = float(data.table.min()) - 0.16 * float(ball.max() - data.table.min())
    for instant in _instants(data):
        _draw_instant(axes, instant, low, reach=0.12 * end)
    _name_curves(axes, data)
    axes.set(
        ylabel="$z$, $w$",
        xticks=[],
        xlim=(-0.16 * end, 1.12 * end),
        ylim=(low, 1.15 * float(ball.max())),
    )
    axes.set_xlabel(r"time $\tau$", labelpad=16)
    shown = parameters(data, "n", "restitution", "amplitude", "frequency_ratio")
    axes.set_title(shown, fontsize=9)
    return figure
