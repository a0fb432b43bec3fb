"""Figures without overlaps, and the parts that all of their panels share."""

from collections.abc import Iterator
from itertools import cycle
from typing import Any

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.figures.style import COLOURS

WIDTH = 3.4
"""Width of a one-column figure in inches."""
WIDE = 7.0
"""Width of a two-column figure in inches."""


def canvas(
    width: float = WIDTH, height: float = 2.6, rows: int = 1, columns: int = 1, **options: Any
) -> tuple[Figure, Any]:
    """A figure of a size in inches, and its axes (one, or an array), laid out without overlaps.

    Further options are those of :meth:`matplotlib.figure.Figure.subplots`.
    """
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots(rows, columns, **options)


def legend_below(figure: Figure, handles: Any = None, **options: Any) -> None:
    """A legend below all panels.

    Without given handles the legend has those of the first panel, each name once.
    """
    if handles is None:
        drawn, names = figure.axes[0].get_legend_handles_labels()
        handles = [handle for k, handle in enumerate(drawn) if names[k] not in names[:k]]
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
