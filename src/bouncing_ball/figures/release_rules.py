"""What the release rule changes in Table 1 and in the thresholds of the errors."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.figures.canvas import (
    WIDE,
    canvas,
    legend_below,
    logarithmic,
    number,
    parameters,
)
from bouncing_ball.figures.style import COLOURS, GUIDE, TABLE, Look

_DASHES = {"saddle-node": "-", "period doubling": (0, (4, 1.5))}
_MARKS = ("o", "x", "s")
_NAMES = {"saddle_node": "saddle-node", "bounce_velocity": "bouncing-off velocity"}


def release_rules(data: xr.Dataset) -> Figure:
    """Shift of the bifurcations (left) and thresholds of each quantity (right)."""
    figure, (left, right) = canvas(WIDE, 3.8, columns=2, width_ratios=(1.0, 1.25))
    _draw_shifts(left, data)
    _draw_thresholds(right, data)
    # What the arrows mean, in the colour of none of the readings.
    right.plot([], [], ">", color=TABLE, markersize=6, label="never within the range")
    legend_below(figure, *right.get_legend_handles_labels(), ncols=4)
    return figure


def _draw_shifts(axes: Axes, data: xr.Dataset) -> None:
    """Shift of the bifurcations with ϖ, one curve for each family and bifurcation."""
    for n, colour in zip(data.n.values, COLOURS, strict=False):
        for bound, dashes in _DASHES.items():
            amplitude = data.bifurcation_amplitude.sel(n=n, bound=bound)
            shift = amplitude.sel(release="force") - amplitude.sel(release="displacement")
            label = f"$n={n}$, {bound}"
            axes.plot(data.frequency_ratio, shift, color=colour, linestyle=dashes, label=label)
    axes.axhline(0.0, **GUIDE)
    logarithmic(axes, data.frequency_ratio)
    axes.set_ylabel(r"shift of $\Lambda$, force minus displacement")
    axes.set_title(parameters(data, "restitution"))
    axes.legend(
        fontsize=6,
        loc="lower right",
        bbox_to_anchor=(1.0, 0.1),
        ncols=2,
        columnspacing=0.7,
        handlelength=1.6,
        handletextpad=0.4,
    )


def _draw_thresholds(axes: Axes, data: xr.Dataset) -> None:
    """Threshold of each quantity, one mark for each reading; an arrow where there is none.

    The marks of a quantity stand below one another, in the order of the legend.
    """
    rows = np.arange(data.sizes["quantity"])[::-1]
    given = {
        name.removeprefix("thresholds__"): value
        for name, value in data.attrs.items()
        if name.startswith("thresholds__")
    }
    limit = given["frequency_ratio__max"]
    for k, (reading, mark) in enumerate(zip(data.reading.values, _MARKS, strict=False)):
        one, colour, places = data.sel(reading=reading), COLOURS[k], rows + 0.24 * (1 - k)
        face = "none" if mark == "s" else colour
        look: Look = {"color": colour, "markerfacecolor": face, "markersize": 5}
        axes.plot(one.error_threshold, places, mark, label=str(reading), **look)
        never = one.threshold_status.str.startswith("outside").values
        at_the_end = np.full(never.sum(), limit / 1.25)
        axes.plot(at_the_end, places[never], ">", color=colour, markersize=6)
    for row in rows[:-1]:
        axes.axhline(row - 0.5, **GUIDE)
    logarithmic(axes)
    names = (str(name) for name in data.quantity.values)
    axes.set(
        xlabel=rf"$\varpi$ for an error of {100 * given['tolerance']:g} %",
        xlim=(1, limit),
        yticks=rows,
        yticklabels=[_NAMES.get(name, name.replace("_", " ")) for name in names],
        ylim=(-0.7, len(rows) - 0.3),
        title=rf"$n={given['n']}$, $r={number(given['restitution'])}$, "
        rf"$\Lambda={number(given['amplitude'])}$",
    )
