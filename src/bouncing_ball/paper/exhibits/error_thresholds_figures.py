"""The error of the greatest height along ϖ, and the thresholds of errors (Fig. 14)."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.datasets.selection import each
from bouncing_ball.drawing.canvas import canvas, draw_curve, legend_below, logarithmic
from bouncing_ball.drawing.labels import parameters
from bouncing_ball.drawing.style import CONTACT, LIMIT
from bouncing_ball.drawing.tables import TextTable, at, quantity_in_words, text_table, threshold
from bouncing_ball.drawing.thresholds import draw_relative_error


def height_error(data: xr.Dataset) -> Figure:
    """Fig. 14: the greatest height in both models; below, the relative error."""
    figure, (axes, below) = canvas(height=4.4, rows=2, sharex=True)
    look = {"color": CONTACT, "label": "spring-damper"}
    draw_curve(axes, data.frequency_ratio, data.max_height, data.admissible, **look)
    limit = float(data.restitution_max_height)
    axes.axhline(limit, label="restitution", **LIMIT)
    title = parameters(data, "n", "restitution", "amplitude")
    logarithmic(axes, ylabel=r"greatest height $\max\,z$", title=title)
    draw_relative_error(below, data, data.max_height - limit, "h", digits=1)
    legend_below(figure, ncols=2)
    return figure


def thresholds(data: xr.Dataset) -> TextTable:
    """The ϖ needed for each tolerance, quantity by quantity.

    If the threshold is outside the range scanned, the entry is the end of the range after < or >.
    """
    low = float(data.frequency_ratio[0])
    high = float(data.frequency_ratio[-1])
    found = threshold(".5g", f"< {low:g}", f"> {high:g}")
    columns = {f"{100 * each:g} %": at(found, tolerance=each) for each in data.tolerance.values}
    return text_table(each(data, "quantity"), {"quantity": quantity_in_words, **columns})
