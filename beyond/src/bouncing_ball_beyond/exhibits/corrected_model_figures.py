"""The corrected model: flights that meet at an instant, and orders of convergence."""

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball_beyond.drawing.laws_and_models import MODELS, panels_by_quantity
from bouncing_ball_beyond.inherited.datasets.selection import each
from bouncing_ball_beyond.inherited.drawing.canvas import canvas, legend_below, logarithmic
from bouncing_ball_beyond.inherited.drawing.labels import note, parameters
from bouncing_ball_beyond.inherited.drawing.style import COLOURS, CONTACT, GUIDE, TABLE, Look
from bouncing_ball_beyond.inherited.drawing.tables import (
    Columns,
    TextTable,
    at,
    entry_of,
    quantity_in_words,
    text_table,
    threshold,
    value,
)
from bouncing_ball_beyond.inherited.drawing.thresholds import with_zeros

# Errors are below 1 but next to a phase of 0; the orders have the room above.
_ERRORS = (1e-11, 1e5)
_LAW: Look = {"color": COLOURS[4], "linewidth": 1.0}
_AT_NODE: Look = {"linestyle": (0, (1, 1.5)), "linewidth": 1.6}
# Quantiles of the measured orders: the median, and the ends of the middle 90 %.
_QUANTILES = (0.05, 0.5, 0.95)


def meeting_flights(data: xr.Dataset) -> Figure:
    """ext_instant: the continued flights before and after a contact; below, the contact force.

    The continued flights meet at the centroid of the force.
    """
    figure, (top, below) = canvas(4.2, 3.6, rows=2, sharex=True, height_ratios=(2.2, 1.0))
    time = data.time.values
    end = float(data.contact_duration)
    touching = (time >= 0) & (time <= end)
    near = (time > -0.15 * end) & (time < 1.15 * end)
    flights = (("before", COLOURS[2], time >= 0), ("after", COLOURS[3], time <= end))
    for name, colour, continued in flights:
        flight = data[f"flight_{name}"].where(continued & near)
        look: Look = {"color": colour, "linestyle": "--", "linewidth": 1.1}
        top.plot(time, flight, label=f"flight {name}, continued", **look)
    top.plot(time, data.table, color=TABLE, label="table")
    top.plot(time, data.ball, color=CONTACT, label="ball")
    top.plot(time[touching], data.ball.values[touching], color=CONTACT, linewidth=2.6)
    meeting = float(data.meeting_time)
    low = float(data.meeting_height)
    top.plot(meeting, low, "o", color="black", markersize=5, zorder=5)
    force = data.contact_force.values[touching]
    below.fill_between(time[touching], force, facecolor="#bfdbec", edgecolor=CONTACT)
    for axes in (top, below):
        axes.axvline(meeting, **GUIDE)
    note(below, "$t^*$", (meeting, 0), (3, 3), fontsize=9)
    margin = float(data.table.values[touching].max()) - low
    title = parameters(data, "n", "restitution", "amplitude", "frequency_ratio")
    top.set(ylabel="height", ylim=(low - 0.12 * margin, low + 1.6 * margin), title=title)
    below.set(xlabel=r"time since the start of contact $\tau$", ylabel="contact force")
    top.margins(x=0)
    legend_below(figure, ncols=2)
    return figure


def orders(data: xr.Dataset) -> Figure:
    """ext_orders: errors of both models and what the error law leaves, along ϖ.

    The panel of the height has them at the saddle-node of the restitution model, too.
    """
    figure, axes_of = panels_by_quantity(data, 4.6, r"frequency ratio $\varpi$")
    ratio = data.frequency_ratio.values
    orbit, node = (data.sel(place=place) for place in data["place"].values)
    for name, axes in axes_of.items():
        part = orbit.sel(quantity=name)
        for order, model in enumerate(data["model"].values, 1):
            one = part.sel(model=model)
            look = MODELS[model]
            error = one.relative_error.values
            zero = part.error_zero if model == "restitution" else part.corrected_error_zero
            axes.plot(*with_zeros(ratio, error, zero), label=model, **look)
            # A guide with this slope through the last point.
            axes.plot(ratio, error[-1] * (ratio[-1] / ratio) ** order, **GUIDE)
            _note_order(axes, order, one.order, look)
        axes.plot(ratio, part.law_left, label="error law, what it leaves", **_LAW)
        _note_order(axes, 3, part.law_order, _LAW)
    height = node.sel(quantity="max_height")
    axes = axes_of["max_height"]
    rows = (
        (height.node_error, height.node_order, 0.5, MODELS["restitution"]),
        (height.law_left, height.law_order, 1.5, _LAW),
    )
    for line, (error, order, slope, look) in enumerate(rows, 4):
        axes.plot(ratio, error, **look | _AT_NODE)
        axes.plot(ratio, error.values[-1] * (ratio[-1] / ratio) ** slope, **GUIDE)
        _note_order(axes, line, order, look)
    for other in axes_of.values():
        logarithmic(other, yscale="log", xlim=(ratio[0], ratio[-1]), ylim=_ERRORS)
    axes.plot([], [], color=GUIDE["color"], label="at the saddle-node", **_AT_NODE)
    figure.suptitle(
        f"{parameters(data, 'n', 'restitution', 'amplitude')}; orders of "
        f"{data.sizes['sample']} random orbits, median (and the middle 90 %)"
    )
    legend_below(figure, ncols=2)
    return figure


def _note_order(axes: Axes, line: int, order: xr.DataArray, look: Look) -> None:
    """The median of measured orders and the middle 90 %, in a line at the top right."""
    low, middle, high = order.quantile(_QUANTILES).values
    text = f"{middle:.2f} ({low:.2f} to {high:.2f})"
    place: Look = {"transform": axes.transAxes, "ha": "right", "va": "top"}
    axes.text(0.97, 1.05 - 0.07 * line, text, color=look["color"], fontsize=7, **place)


def ext_orders(data: xr.Dataset) -> TextTable:
    """The error law by quantity; the permanent contact, which has no correction, comes last.

    C is the corrected model's error times ϖ²; the last column is the ϖ at which
    the restitution model's error changes its sign.
    """
    found = threshold(".4g", "all", "none")
    columns: Columns = {
        "quantity": quantity_in_words,
        "K": value("coefficient", ".4f"),
        "C": value("second_order", ".4f"),
        "law": value("law_threshold", ".4g"),
        **{str(model): at(found, model=model) for model in data.model.values},
        "error zero at": value("error_zero", ".3g"),
    }
    header, body = text_table(each(data, "quantity"), columns)
    coefficient = entry_of(data.permanent_coefficient, ".4f")
    law = entry_of(data.permanent_law, ".4g")
    exact = entry_of(data.permanent_threshold, ".4g")
    numbers = [coefficient, "–", law, exact, "–", "–"]
    return header, [*body, ["permanent contact, second order", *numbers]]
