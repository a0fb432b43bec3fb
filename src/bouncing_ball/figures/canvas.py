"""Figures without overlaps, and the words on them."""

from collections.abc import Iterator
from itertools import cycle
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.datasets.selection import each
from bouncing_ball.figures.style import COLOURS

WIDTH = 3.4
"""Width of a one-column figure in inches."""
WIDE = 7.0
"""Width of a two-column figure in inches."""


def canvas(
    width: float = WIDTH, height: float = 2.6, rows: int = 1, columns: int = 1, **options: Any
) -> tuple[Figure, Any]:
    """A figure of a size in inches and its axes, laid out without overlaps."""
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots(rows, columns, **options)


def panels(height: float, rows: int, columns: int) -> tuple[Figure, list[Axes]]:
    """A wide figure of equal panels that share their axes, row by row."""
    figure, axes = canvas(WIDE, height, rows, columns, sharex=True, sharey=True)
    return figure, list(np.ravel(axes))


def legend_below(figure: Figure, handles: Any = None, labels: Any = None, **options: Any) -> None:
    """A legend under all panels; that of the first panel, if no handles are given."""
    if handles is None:
        handles, labels = figure.axes[0].get_legend_handles_labels()
    labels = [handle.get_label() for handle in handles] if labels is None else labels
    figure.legend(handles, labels, loc="outside lower center", **options)


def logarithmic(axes: Axes, ratio: xr.DataArray | None = None, **settings: Any) -> None:
    """Logarithmic frequency-ratio axis with plain numbers at the decades, and other settings.

    It is named, and as long as the ϖ that are given.
    """
    if ratio is not None:
        axes.set(xlabel=r"frequency ratio $\varpi$", xlim=(float(ratio[0]), float(ratio[-1])))
    axes.set(xscale="log", **settings)
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.xaxis.set_minor_formatter(lambda value, _: "")


def coloured(data: xr.Dataset, dim: str) -> Iterator[tuple[xr.Dataset, str]]:
    """The dataset at each place along a dimension, with a colour of its own."""
    return zip(each(data, dim), cycle(COLOURS))


def number(value: float) -> str:
    """A parameter as a label shows it.

    Examples
    --------
    >>> number(0.85), number(10000.0), number(250000.0)
    ('0.85', '10^{4}', '2.5\\\\times 10^{5}')
    """
    if value >= 1e4:
        mantissa, exponent = f"{value:e}".split("e")
        factor = "" if float(mantissa) == 1 else rf"{float(mantissa):g}\times "
        return f"{factor}10^{{{int(exponent)}}}"
    return f"{value:g}"


_SYMBOLS = {"n": "n", "restitution": "r", "amplitude": r"\Lambda", "frequency_ratio": r"\varpi"}


def parameters(data: xr.Dataset, *names: str) -> str:
    """Parameters of a dataset, as a title shows them.

    Examples
    --------
    >>> parameters(xr.Dataset(attrs={"n": 1, "restitution": 0.85}), "n", "restitution")
    '$n=1$, $r=0.85$'
    """
    return ", ".join(f"${_SYMBOLS[name]}={number(data.attrs[name])}$" for name in names)


def note(axes: Axes, text: str, point: Any, offset: Any, **look: Any) -> None:
    """A text at an offset in points from a point of the data."""
    axes.annotate(text, point, xytext=offset, textcoords="offset points", **look)
