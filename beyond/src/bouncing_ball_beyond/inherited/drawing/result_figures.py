"""Figures of the results of calls, by the names of the calls; they compute nothing."""

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball_beyond.inherited.datasets import CASE, PERIOD_DOUBLING, SADDLE_NODE
from bouncing_ball_beyond.inherited.drawing.branches import over_amplitude
from bouncing_ball_beyond.inherited.drawing.canvas import (
    WIDE,
    WIDTH,
    canvas,
    coloured,
    legend_below,
)
from bouncing_ball_beyond.inherited.drawing.labels import QUANTITIES, in_a_row, symbol, title
from bouncing_ball_beyond.inherited.drawing.style import TABLE, Look


def orbits(data: xr.Dataset) -> Figure:
    """Phase of impact and greatest height of orbits over the last axis of a labelled dataset.

    There is a curve for each place along the other axes; it is solid for stable orbits and dashed
    for unstable orbits.
    """
    figure, panels = canvas(WIDE, 2.8, columns=2)
    figure.suptitle(title(data))
    for curve, place, look in _curves(data, panels):
        for axes, values in zip(panels, (curve.phase / np.pi, curve.max_height), strict=True):
            axes.plot(place, values.where(curve.stable), **look)
            axes.plot(place, values, **look | {"linestyle": "--", "linewidth": 0.8, "label": None})
    panels[0].set(ylabel=r"phase of impact $\varphi/\pi$")
    panels[1].set(ylabel=r"greatest height $\max\,z$")
    if data.phase.ndim > 1:
        legend_below(figure, ncols=4)
    return figure


def limits(data: xr.Dataset) -> Figure:
    """Saddle-node and period doubling over the last axis of a labelled dataset."""
    figure, axes = canvas(WIDTH, 2.8)
    axes.set_title(title(data))
    for curve, place, look in _curves(data, [axes]):
        for kind, dashes in ((SADDLE_NODE, "-"), (PERIOD_DOUBLING, "--")):
            values = curve[f"{kind.replace('-', '_').replace(' ', '_')}_amplitude"]
            label = ", ".join(x for x in (kind, look["label"]) if x)
            axes.plot(place, values, **look | {"linestyle": dashes, "label": label})
    axes.set(ylabel=r"amplitude $\Lambda$", ylim=(0, None))
    legend_below(figure, ncols=2)
    return figure


def permanent_contact(data: xr.Dataset) -> Figure:
    """The Λ up to which a ball stays on the table, over the last axis of a labelled dataset."""
    figure, axes = canvas(WIDTH, 2.6)
    axes.set(title=title(data))
    for curve, place, look in _curves(data, [axes]):
        axes.plot(place, curve.threshold_amplitude, **look)
    axes.set(ylabel=r"amplitude $\Lambda$ that lifts the ball")
    if data.threshold_amplitude.ndim > 1:
        legend_below(figure, ncols=3)
    return figure


def error_thresholds(data: xr.Dataset) -> Figure:
    """The ϖ from which on each error is tolerable; a ball that needs none has no mark."""
    figure, axes = canvas(WIDE, 2.8)
    rows, names = in_a_row(data, "quantity")
    place = np.arange(data.quantity.size)
    for (row, colour), name in zip(coloured(rows, CASE), names, strict=True):
        label = ", ".join(x for x in ("restitution model", name) if x)
        axes.semilogx(row.error_threshold, place, "o", color=colour, label=label, markersize=4)
    axes.set(yticks=place, yticklabels=[QUANTITIES[str(x)] for x in data.quantity.values])
    axes.set(xlabel=r"frequency ratio $\varpi$ of the contact", title=title(data))
    axes.invert_yaxis()
    legend_below(figure, ncols=2)
    return figure


def _curves(
    data: xr.Dataset, panels: Sequence[Axes]
) -> Iterator[tuple[xr.Dataset, np.ndarray, Look]]:
    """Each curve of a labelled dataset over the last axis, with its look; the axis is labelled."""
    along = str(list(data.dims)[-1])
    rows, names = in_a_row(data, along)
    place = data[along].values
    wide = along == "frequency_ratio" and place.max() > 30 * place.min()
    for axes in panels:
        axes.set(xlabel=symbol(along), xscale="log" if wide else "linear")
    for (curve, colour), name in zip(coloured(rows, CASE), names, strict=True):
        yield curve, place, {"color": colour, "label": name, "marker": ".", "markersize": 3}


def impacts(data: xr.Dataset) -> Figure:
    """Phase and velocity of the impacts of balls over time; each ball has a colour."""
    figure, panels = canvas(WIDE, 4.0, rows=2, sharex=True)
    balls, names = in_a_row(data, "impact")
    for (ball, colour), name in zip(coloured(balls, CASE), names, strict=True):
        periods = ball.time / (2 * np.pi)
        look = {"color": colour, "linestyle": "none", "marker": "o", "markersize": 2.5}
        panels[0].plot(periods, ball.impact_phase / np.pi, **look, label=name or None)
        panels[1].plot(periods, ball.impact_velocity, **look)
    panels[0].set(ylabel=r"phase of impact $\varphi/\pi$", ylim=(-1, 1), title=title(data))
    panels[1].set(ylabel="velocity $z′_i$ at impact", xlabel=r"time $\tau/2\pi$")
    if any(names):
        legend_below(figure, ncols=5)
    return figure


def over_time(data: xr.Dataset) -> Figure:
    """Balls and table over time; each ball has a colour and the differing arguments as its name."""
    figure, axes = canvas(WIDE, 2.8)
    balls, names = in_a_row(data, "time")
    periods = data.time / (2 * np.pi)
    tables = balls.table.values
    for k in range(1 if np.ptp(tables, axis=0).max() == 0 else len(tables)):
        axes.plot(periods, tables[k], color=TABLE, label="table $w$", linewidth=0.9)
    for (ball, colour), name in zip(coloured(balls, CASE), names, strict=True):
        axes.plot(periods, ball.ball, color=colour, label=name or "ball $z$", linewidth=1.0)
    axes.set(xlabel=r"time $\tau/2\pi$", ylabel="$z$, $w$", title=title(data))
    axes.set(xlim=(0, float(periods[-1])))
    legend_below(figure, ncols=5)
    return figure


FIGURES: Mapping[str, Callable[[xr.Dataset], Figure]] = {
    "simulate": impacts,
    "history": over_time,
    "orbit": orbits,
    "limits": limits,
    "branch": over_amplitude,
    "permanent-contact": permanent_contact,
    "error_thresholds": error_thresholds,
}
"""The figure of the result of each command or call."""
