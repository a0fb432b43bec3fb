"""Figures without overlaps, and the parts that all of their panels share."""

from collections.abc import Iterator
from contextvars import ContextVar
from itertools import cycle
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.layout_engine import LayoutEngine
from matplotlib.ticker import NullLocator

from bouncing_ball.drawing.labels import QUANTITIES
from bouncing_ball.drawing.style import COLOURS, LINES
from bouncing_ball.errors import ModelError

WIDTH = 3.4
"""Width of a one-column figure in inches."""

WIDE = 7.0
"""Width of a two-column figure in inches."""

GIVEN: ContextVar[tuple[Axes, ...]] = ContextVar("GIVEN", default=())
"""The axes into which a user draws, see :mod:`bouncing_ball.drawing.fitted`; none, as a rule."""


def canvas(
    width: float = WIDTH, height: float = 2.6, rows: int = 1, columns: int = 1, **options: Any
) -> tuple[Figure, Any]:
    """A figure of a size in inches, and its axes (one, or an array), laid out without overlaps.

    Further options are those of :meth:`matplotlib.figure.Figure.subplots`.
    """
    if given := GIVEN.get():
        if len(given) != rows * columns:
            raise ModelError(
                f"this figure has {rows * columns} panels: give as many axes, not {len(given)}"
            )
        panels = np.reshape(np.array(given, dtype=object), (rows, columns)).squeeze()
        figure: Any = given[0].figure
        return figure, panels if panels.ndim else given[0]
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots(rows, columns, **options)


def stacked(height: float, heights: tuple[float, ...]) -> tuple[Figure, Any]:
    """A two-column figure of a height in inches, and its parts with the given relative heights."""
    if GIVEN.get():
        raise ModelError("this figure has parts with panels of their own: draw it without ax")
    figure = Figure(figsize=(WIDE, height), layout="constrained")
    return figure, figure.subfigures(len(heights), height_ratios=heights)


def lay_out(figure: Figure, engine: LayoutEngine) -> None:
    """Place the panels of a figure, and draw all minor ticks of an axis as one line of marks.

    A tick consists of five artists, and a logarithmic axis has dozens of ticks. Ticks with labels
    remain.
    """
    minor = [
        (axis, axis.get_minor_locator())
        for axes in figure.axes
        for axis in (axes.xaxis, axes.yaxis)
        if axes.axison
        and not any(axis.get_minor_formatter().format_ticks([*axis.get_minorticklocs()]))
    ]
    for axis, _ in minor:
        axis.set_minor_locator(NullLocator())
    engine.execute(figure)
    figure.set_layout_engine("none")
    # The number of ticks depends on the size of the panels.
    for axis, locator in minor:
        axis.set_minor_locator(locator)
        low, high = sorted(axis.get_view_interval())
        places = [x for x in axis.get_minorticklocs() if low <= x <= high]
        axis.set_minor_locator(NullLocator())
        ends = places, [0.0] * len(places)
        marks = axis.get_minor_ticks(1)[0].tick1line
        marks.set(data=ends if axis is axis.axes.xaxis else ends[::-1], clip_on=False)
        axis.axes.add_artist(marks)


def image(axes: Axes, values: Any, extent: tuple[float, float, float, float], **look: Any) -> Any:
    """Values over an even grid, shape (y, x), as an image with a pixel around each node."""
    axes.spines[["top", "right"]].set_visible(True)
    look |= {"origin": "lower", "aspect": "auto", "interpolation": "none"}
    return axes.imshow(values, extent=extent, **look)


def legend_below(figure: Figure | SubFigure, handles: Any = None, **options: Any) -> None:
    """A legend below all panels.

    Without given handles the legend has those of the first panel, each name once.
    """
    if handles is None:
        first = GIVEN.get()[0] if GIVEN.get() else figure.axes[0]
        drawn, names = first.get_legend_handles_labels()
        handles = [handle for k, handle in enumerate(drawn) if names[k] not in names[:k]]
    if given := GIVEN.get():
        # The figure is that of the user and may have other panels.
        given[0].legend(handles=handles, **options | {"ncols": 1})
        return
    figure.legend(handles=handles, loc="outside lower center", **options)


def logarithmic(axes: Axes, ratio: xr.DataArray | None = None, **settings: Any) -> None:
    """A logarithmic axis of the frequency ratio with plain numbers at the decades.

    If the values of ϖ are given, the axis is labelled and limited to their range. Further settings
    are those of :meth:`matplotlib.axes.Axes.set`.
    """
    if ratio is not None:
        axes.set(xlabel=r"frequency ratio $\varpi$", xlim=(float(ratio[0]), float(ratio[-1])))
    axes.set(xscale="log", **settings)
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.xaxis.set_minor_formatter(lambda value, _: "")


def coloured(data: xr.Dataset, dim: str) -> Iterator[tuple[xr.Dataset, str]]:
    """The dataset at each place along a dimension, with the next colour for each place."""
    places = (data.isel({dim: k}) for k in range(data.sizes[dim]))
    return zip(places, cycle(COLOURS))


def draw_curve(axes: Axes, x: Any, y: Any, admissible: Any, **look: Any) -> None:
    """A curve of orbits with a given look, dotted where the orbits are inadmissible."""
    x = np.asarray(x)
    y = np.asarray(y)
    shown = np.asarray(admissible, dtype=bool)
    axes.plot(x, np.where(shown, y, np.nan), **look)
    if not np.all(shown):
        axes.plot(x, np.where(shown, np.nan, y), color=look["color"], **LINES["inadmissible"])


def panels_by_quantity(
    data: xr.Dataset, height: float, xlabel: str
) -> tuple[Figure, dict[str, Axes]]:
    """Two rows of three panels, one for the errors of each quantity, with labels at the outside."""
    figure, slots = canvas(WIDE, height, 2, 3, sharex=True, sharey=True)
    for axes in slots.flat:
        axes.set(xlabel=xlabel, ylabel="relative error")
        axes.label_outer()
    quantities = map(str, data["quantity"].values)
    panels = dict(zip(quantities, slots.flat, strict=False))
    for quantity, axes in panels.items():
        axes.set_title(QUANTITIES[quantity])
    return figure, panels
