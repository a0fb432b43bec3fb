"""Figure 13: Poincaré map of both models."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.figures.branches import draw_curve
from bouncing_ball.figures.style import (
    COLOURS,
    RESTITUTION,
    Look,
    canvas,
    note,
    number,
    parameters,
)

# Above this frequency ratio the points crowd at that of the restitution model.
_NAMED_UP_TO = 10.0
_LIMIT: Look = {"markersize": 9, "zorder": 5, "linestyle": "none", "color": RESTITUTION}


def _draw_trace(axes: Axes, curve: xr.Dataset, phase, velocity, label, **look) -> None:
    """Phase and velocity over π as ϖ varies, its round values marked.

    Of a curve with a label the small values are named; the next one's would overlap.
    """
    x, y = phase.values / np.pi, velocity.values / np.pi
    line = {"color": look["color"], "linestyle": look["linestyle"]}
    draw_curve(axes, x, y, curve.admissible, **line)
    axes.plot([], [], marker="o", markersize=4, label=label, **look)
    for k, at in enumerate(np.flatnonzero(curve.labelled.values)):
        axes.plot(x[at], y[at], marker="o", markersize=4, **look)
        ratio = float(curve.frequency_ratio[at])
        if label and ratio <= _NAMED_UP_TO:
            # Neighbours on both sides of the curve.
            offset, side = ((5, 4), "left") if k % 2 == 0 else ((-5, -4), "right")
            name, point = rf"$\varpi={number(ratio)}$", (x[at], y[at])
            note(axes, name, point, offset, ha=side, va="center", fontsize=8)


def draw(data: xr.Dataset) -> Figure:
    """Phase and velocity, over π, at the start and at the end of contact.

    Each curve is traced by ϖ; a few of its values are marked on it.
    """
    figure, axes = canvas(4.4, 4.0)
    for k, case in enumerate(data.case.values):
        curve = data.sel(case=case)
        colour = COLOURS[1 + k % (len(COLOURS) - 1)]
        end = (curve.release_phase, curve.bounce_velocity, data.restitution_bounce_velocity)
        start = (curve.phase, curve.impact_velocity, data.restitution_impact_velocity)
        for (phase, velocity, limit), name, dashes, face in (
            (end, r"end of contact, $(\varphi+\tau_b,\,z′_b)$", "-", colour),
            (start, r"start of contact, $(\varphi,\,z′_i)$", (0, (4, 1.5)), "white"),
        ):
            look = {"color": colour, "linestyle": dashes, "markerfacecolor": face}
            # Named once for all cases.
            _draw_trace(axes, curve, phase, velocity, name if k == 0 else None, **look)
            point = float(curve.restitution_phase) / np.pi, float(limit) / np.pi
            axes.plot(*point, "*", **_LIMIT)
    axes.plot([], [], "*", label="restitution model", **_LIMIT)
    axes.set(xlabel=r"phase of the table over $\pi$", ylabel=r"velocity of the ball, $z′/\pi$")
    axes.margins(x=0.14)
    axes.axhline(0.0, color="#8c8c8c", linewidth=0.5)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    axes.set_title(
        parameters(data, "n", "restitution")
        + "".join(rf", $\Lambda={number(x)}$" for x in data["amplitude"].values),
        fontsize=9,
    )
    return figure
