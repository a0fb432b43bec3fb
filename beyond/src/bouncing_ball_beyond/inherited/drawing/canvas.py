"""Figures without overlaps, and the parts that all of their panels share."""

from collections.abc import Iterator, Sequence
from contextvars import ContextVar
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.layout_engine import LayoutEngine
from matplotlib.lines import Line2D
from matplotlib.ticker import NullLocator

from bouncing_ball_beyond.inherited.drawing.labels import number_label
from bouncing_ball_beyond.inherited.drawing.style import LINES, MARKS, palette
from bouncing_ball_beyond.inherited.errors import ModelError

WIDTH = 3.4
"""Width of a one-column figure in inches."""

WIDE = 7.0
"""Width of a two-column figure in inches."""

GIVEN: ContextVar[tuple[Axes, ...]] = ContextVar("GIVEN", default=())
"""The axes into which a user draws, see :mod:`bouncing_ball_beyond.inherited.drawing.fitted`; none,
as a rule."""


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


def legend_below(
    figure: Figure | SubFigure,
    *groups: Sequence[Any],
    ncols: int | None = None,
    labels: Sequence[str] = (),
    **options: Any,
) -> None:
    """A legend below all panels, read row by row, with as many columns as its width has room for.

    Each group of handles begins a row. Without groups the legend has the handles of all panels,
    each name once, and the kinds of orbits come last. ``labels`` are the names of the handles in
    their order, and ``ncols`` is the largest number of columns.
    """
    rows = [list(group) for group in groups] or _named(figure)
    for handle, label in zip((handle for row in rows for handle in row), labels, strict=False):
        handle.set_label(label)
    if given := GIVEN.get():
        # The figure is that of the user and may have other panels.
        entries = [handle for row in rows for handle in row]
        given[0].legend(handles=entries, ncols=1, **options)
        return
    blank = Line2D([], [], linestyle="none", label="")
    most = max(map(len, rows))
    for columns in range(min(most, ncols or most), 0, -1):
        filled = [row + [blank] * (-len(row) % columns) for row in rows[:-1]]
        entries = [handle for row in (*filled, rows[-1]) for handle in row]
        # matplotlib fills the columns one after another.
        by_column = [entry for k in range(columns) for entry in entries[k::columns]]
        legend = figure.legend(
            handles=by_column, loc="outside lower center", ncols=columns, **options
        )
        if legend.get_window_extent().width <= figure.bbox.width or columns == 1:
            return
        legend.remove()


def _named(figure: Figure | SubFigure) -> list[list[Any]]:
    """What the panels name, each name once: the curves, and the kinds of orbits in their order."""
    found: dict[str, Any] = {}
    for axes in GIVEN.get() or figure.axes:
        for handle, name in zip(*axes.get_legend_handles_labels(), strict=True):
            found.setdefault(name, handle)
    kinds = [_in_black(found[kind]) for kind in LINES | MARKS if kind in found]
    curves = [handle for name, handle in found.items() if name not in LINES | MARKS]
    return [row for row in (curves, kinds) if row]


def _in_black(line: Line2D) -> Line2D:
    """The look of a line without its colour, which is that of one curve of several."""
    entry = Line2D([], [])
    entry.update_from(line)
    entry.set(color="black", label=line.get_label())
    return entry


def logarithmic(axes: Axes, ratio: xr.DataArray | None = None, **settings: Any) -> None:
    """A logarithmic axis of the frequency ratio with plain numbers at the decades.

    If the values of ϖ are given, the axis is labelled and limited to their range. Further settings
    are those of :meth:`matplotlib.axes.Axes.set`.
    """
    if ratio is not None:
        axes.set(xlabel=r"frequency ratio $\varpi$", xlim=(float(ratio[0]), float(ratio[-1])))
    axes.set(xscale="log", **settings)
    axes.xaxis.set_major_formatter(lambda value, _: f"${number_label(value)}$")
    axes.xaxis.set_minor_formatter(lambda value, _: "")


def coloured(data: xr.Dataset, dim: str) -> Iterator[tuple[xr.Dataset, str]]:
    """The dataset at each place along a dimension, with a colour for each place."""
    places = (data.isel({dim: k}) for k in range(data.sizes[dim]))
    return zip(places, palette(data.sizes[dim]), strict=True)


def draw_curve(axes: Axes, x: Any, y: Any, admissible: Any, **look: Any) -> None:
    """A curve of orbits with a given look, dotted where the orbits are inadmissible."""
    x = np.asarray(x)
    y = np.asarray(y)
    shown = np.asarray(admissible, dtype=bool)
    axes.plot(x, np.where(shown, y, np.nan), **look)
    if not np.all(shown):
        axes.plot(x, np.where(shown, np.nan, y), color=look["color"], **LINES["inadmissible"])
