"""Extension: the windows of the stable orbits into which permanent contact continues."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.figures.style import (
    COLOURS,
    CONTACT,
    GRAZING,
    GUIDE,
    PERIOD_DOUBLING,
    SADDLE_NODE,
    TABLE,
    WIDE,
    Look,
    canvas,
    logarithmic,
    number,
)

_MARKS: dict[str, Look] = {
    "saddle-node": {**SADDLE_NODE, "color": COLOURS[1]},
    "period doubling": {**PERIOD_DOUBLING, "color": COLOURS[3]},
    "grazing in contact": {**GRAZING, "color": COLOURS[0]},
    "grazing in flight": {**GRAZING, "marker": "v", "color": COLOURS[2]},
}
# A mark at so many samples, in a run of windows that end alike.
_EVERY = 8


def _runs(kinds: np.ndarray) -> list[np.ndarray]:
    """Indices of neighbours whose window ends in the same way: the end jumps in between."""
    edges = np.flatnonzero(kinds[1:] != kinds[:-1]) + 1
    return np.split(np.arange(kinds.size), edges)


def _draw_window(axes: Axes, window: xr.Dataset) -> None:
    """The window of one r, its upper end marked by what ends it."""
    ratio, kinds = window.frequency_ratio.values, window.window_end.values
    low, high = window.threshold_amplitude.values, window.window_amplitude.values
    for run in _runs(kinds):
        axes.fill_between(ratio[run], low[run], high[run], color="#dcdcdc", linewidth=0)
        axes.plot(ratio[run], high[run], color=TABLE, linewidth=0.8)
    for kind, look in _MARKS.items():
        runs = [run for run in _runs(kinds) if kinds[run[0]] == kind]
        if runs:
            # The ends of each run, and some in between.
            there = np.unique(np.concatenate([[*run[::_EVERY], run[-1]] for run in runs]))
            axes.plot(ratio[there], high[there], label=kind, **(look | {"markersize": 3.5}))
    axes.plot(ratio, low, color=CONTACT, linewidth=1.3, label=r"$\Lambda_{SD}$")
    axes.axhline(1.0, **GUIDE)
    axes.set(xlabel=r"frequency ratio $\varpi$", ylabel=r"amplitude $\Lambda$")
    axes.set_title(rf"stable window, $r={number(float(window.restitution))}$", fontsize=9)
    logarithmic(axes)
    axes.set_ylim(bottom=0.0)
    axes.legend(loc="lower right", title="upper end", title_fontsize=8)


def _draw_widths(axes: Axes, data: xr.Dataset) -> None:
    """Width of the window times ϖ², which tends to a constant."""
    ratio = data.frequency_ratio.values
    for k, r in enumerate(sorted(data.restitution.values)):
        one, colour = data.sel(restitution=r), COLOURS[k % len(COLOURS)]
        width = ratio**2 * (one.window_amplitude - one.threshold_amplitude).values
        for run in _runs(one.window_end.values):
            axes.plot(ratio[run], width[run], marker="." if run.size == 1 else "", color=colour)
        axes.plot([], [], color=colour, label=number(float(r)))
        axes.plot(ratio[-1], one.stiff_window, marker=5, color=colour, clip_on=False)
    axes.set_yscale("log")
    logarithmic(axes)
    axes.set(
        xlabel=r"frequency ratio $\varpi$",
        ylabel=r"$\varpi^2\,(\Lambda_{\mathrm{end}}-\Lambda_{SD})$",
    )
    axes.set_title(r"its width for each $r$, and the limit for $\varpi\to\infty$", fontsize=9)
    axes.legend(loc="lower right", title="$r$, from above", title_fontsize=8)


def draw(data: xr.Dataset) -> Figure:
    """Left, the window of the first r; right, the widths for all."""
    figure, (left, right) = canvas(WIDE, 3.2, columns=2)
    _draw_window(left, data.isel(restitution=0))
    _draw_widths(right, data)
    return figure
