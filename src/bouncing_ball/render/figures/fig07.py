"""Figure 7: look of the 1-T orbit of the spring-damper model."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.render.figures.style import CONTACT, GUIDE, TABLE, canvas, number


def draw(data: xr.Dataset) -> Figure:
    """One cycle with the instants and velocities of the paper's equations marked."""
    figure, axes = canvas(5.0, 3.0)
    time, ball = data.time.values, data.ball.values
    duration = float(data.contact_duration)
    end = float(time[-1])
    touching = data.contact.values.astype(bool)
    axes.plot(time, data.table, color=TABLE)
    axes.plot(time[~touching], ball[~touching], color=CONTACT)
    axes.plot(time[touching], ball[touching], color=CONTACT, linewidth=2.6)
    marks = {
        0.0: (float(ball[0]), float(data.impact_velocity), r"$\tau_i=0$", r"$z_i^{\prime}$"),
        duration: (
            float(ball[touching][-1]),
            float(data.bounce_velocity),
            r"$\tau_b$",
            r"$z_b^{\prime}$",
        ),
        end: (
            float(ball[-1]),
            float(data.impact_velocity),
            r"$\tau_2=\tau_i+2\pi n$",
            r"$z_2^{\prime}$",
        ),
    }
    span = float(ball.max() - data.table.min())
    low = float(data.table.min()) - 0.16 * span
    for instant, (height, velocity, name, symbol) in marks.items():
        axes.plot([instant, instant], [low, height], **GUIDE)
        axes.plot(instant, height, "o", color="black", markersize=3.5, zorder=5)
        # An arrow along the ball's velocity: a tangent of fixed length in τ.
        reach = 0.12 * end
        before = velocity < 0
        tail = (instant - reach, height - reach * velocity) if before else (instant, height)
        head = (instant, height) if before else (instant + reach, height + reach * velocity)
        axes.annotate(
            "",
            xy=head,
            xytext=tail,
            arrowprops={
                "arrowstyle": "-|>",
                "color": "black",
                "linewidth": 0.9,
                "shrinkA": 0,
                "shrinkB": 0,
                "mutation_scale": 9,
            },
        )
        axes.annotate(
            symbol,
            tail if before else head,
            xytext=(4 if before else -4, 1),
            textcoords="offset points",
            ha="left" if before else "right",
            va="center",
        )
        axes.annotate(
            name, (instant, low), xytext=(0, -2), textcoords="offset points", ha="center", va="top"
        )
    top = int(np.argmax(ball))
    axes.annotate(
        "ball $z$",
        (time[top], ball[top]),
        xytext=(0, 5),
        textcoords="offset points",
        ha="center",
        color=CONTACT,
    )
    dip = int(np.argmin(data.table.values))
    axes.annotate(
        "table $w$",
        (time[dip], float(data.table[dip])),
        xytext=(0, 4),
        textcoords="offset points",
        ha="center",
        va="bottom",
        color="#5f5f5f",
    )
    axes.annotate(
        "contact",
        (duration / 2, float(ball[touching].min())),
        xytext=(0, -9),
        textcoords="offset points",
        ha="center",
        va="top",
        fontsize=8,
    )
    axes.annotate("flight", (time[top], 0.62 * ball[top]), ha="center", fontsize=8)
    axes.set(
        ylabel="$z$, $w$",
        xticks=[],
        xlim=(-0.16 * end, 1.12 * end),
        ylim=(low, 1.15 * float(ball.max())),
    )
    axes.set_xlabel(r"time $\tau$", labelpad=16)
    attributes = data.attrs
    axes.set_title(
        rf"$n={attributes['n']}$, $r={number(attributes['restitution'])}$, "
        rf"$\Lambda={number(attributes['amplitude'])}$, "
        rf"$\varpi={number(attributes['frequency_ratio'])}$",
        fontsize=9,
    )
    return figure
