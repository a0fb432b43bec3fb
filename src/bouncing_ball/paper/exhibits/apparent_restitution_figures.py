"""One orbit followed along ϖ, curve by curve (Figs. 5, 6, 10, 13)."""

from itertools import cycle

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.datasets.selection import each
from bouncing_ball.drawing.canvas import canvas, coloured, draw_curve, legend_below, logarithmic
from bouncing_ball.drawing.labels import note, number, parameters
from bouncing_ball.drawing.style import COLOURS, GUIDE, RESTITUTION, Look

_DASHES = ("-", (0, (5, 1.5)), (0, (1, 1)), (0, (5, 1.5, 1, 1.5)))
# Above this frequency ratio the points are close to the point of the restitution model.
_NAMED_UP_TO = 10.0
_LIMIT: Look = {"markersize": 9, "zorder": 5, "linestyle": "none", "color": RESTITUTION}


def apparent_restitution(data: xr.Dataset) -> Figure:
    """Figs. 5 and 6: a curve for each (r, Λ), with the restitution coefficients as guides."""
    figure, axes = canvas(height=2.8)
    for restitution in data.restitution.values:
        axes.axhline(restitution, **GUIDE)
    _draw_cases(axes, data, "apparent_restitution", "apparent restitution $r_a$")
    # The legend is between the lowest curve and the next curve, if these are far apart.
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.12), title=parameters(data, "n"))
    return figure


def bounce_velocity(data: xr.Dataset) -> Figure:
    """Fig. 10: a curve for each Λ, with the restitution model's nπ as a guide."""
    figure, axes = canvas(height=2.6)
    limit = float(data.restitution_bounce_velocity)
    axes.axhline(limit, **GUIDE)
    note(axes, r"$n\pi$", (float(data.frequency_ratio[0]), limit), (4, 3), fontsize=8)
    _draw_cases(axes, data, "bounce_velocity", r"bouncing-off velocity $z′_b$")
    axes.legend(loc="lower right", title=parameters(data, "n"))
    return figure


def poincare_map(data: xr.Dataset) -> Figure:
    """Fig. 13: phase and velocity, over π, at the start and at the end of contact.

    Each curve is parametrised by ϖ, and a few values of ϖ are marked.
    """
    figure, axes = canvas(4.4, 4.0)
    end_label: str | None = r"end of contact, $(\varphi+\tau_b,\,z′_b)$"
    start_label: str | None = r"start of contact, $(\varphi,\,z′_i)$"
    for curve, colour in zip(each(data, "case"), cycle(COLOURS[1:])):
        limit_phase = curve.restitution_phase / np.pi
        look: Look = {"color": colour, "linestyle": "-", "markerfacecolor": colour}
        _draw_trace(axes, curve, curve.release_phase, curve.bounce_velocity, end_label, look)
        axes.plot(limit_phase, data.restitution_bounce_velocity / np.pi, "*", **_LIMIT)
        look = {"color": colour, "linestyle": (0, (4, 1.5)), "markerfacecolor": "white"}
        _draw_trace(axes, curve, curve.phase, curve.impact_velocity, start_label, look)
        axes.plot(limit_phase, data.restitution_impact_velocity / np.pi, "*", **_LIMIT)
        # The legend names the curves of the first case only.
        end_label = None
        start_label = None
    axes.plot([], [], "*", label="restitution model", **_LIMIT)
    axes.set(xlabel=r"phase of the table over $\pi$", ylabel=r"velocity of the ball, $z′/\pi$")
    axes.margins(x=0.14)
    legend_below(figure, ncols=2)
    amplitudes = [
        rf"$\Lambda={number(float(curve['amplitude']))}${_absence(curve)}"
        for curve in each(data, "case")
    ]
    axes.set_title(", ".join([parameters(data, "n", "restitution"), *amplitudes]))
    return figure


def _absence(curve: xr.Dataset) -> str:
    """The words for a curve that has no orbit at any ϖ; otherwise empty."""
    return " (no orbit)" if curve.phase.isnull().all() else ""


def _draw_cases(axes: Axes, data: xr.Dataset, name: str, ylabel: str) -> None:
    """One curve of a variable for each case, named by its r and Λ."""
    for (one, colour), dashes in zip(coloured(data, "case"), cycle(_DASHES), strict=False):
        r = number(float(one["restitution"]))
        lam = number(float(one["amplitude"]))
        label = rf"$r={r}$, $\Lambda={lam}${_absence(one)}"
        look: Look = {"color": colour, "linestyle": dashes, "label": label}
        draw_curve(axes, one.frequency_ratio, one[name], one.admissible, **look)
    logarithmic(axes, data.frequency_ratio, ylabel=ylabel)


def _draw_trace(
    axes: Axes,
    curve: xr.Dataset,
    phase: xr.DataArray,
    velocity: xr.DataArray,
    label: str | None,
    look: Look,
) -> None:
    """Phase and velocity over π as ϖ varies; round values of ϖ are marked.

    Small values are named on curves with a label only, because names on all curves would overlap.
    """
    x = phase.values / np.pi
    y = velocity.values / np.pi
    marked = np.flatnonzero(curve.labelled.values)
    marks: Look = {"marker": "o", "markersize": 4, "markevery": marked.tolist()}
    draw_curve(axes, x, y, curve.admissible, label=label, **look, **marks)
    for k, at in enumerate(marked):
        ratio = float(curve.frequency_ratio[at])
        if label and ratio <= _NAMED_UP_TO:
            # The names of neighbours are on different sides of the curve.
            if k % 2 == 0:
                offset = (5, 4)
                side = "left"
            else:
                offset = (-5, -4)
                side = "right"
            name = rf"$\varpi={number(ratio)}$"
            note(axes, name, (x[at], y[at]), offset, ha=side, va="center", fontsize=8)
