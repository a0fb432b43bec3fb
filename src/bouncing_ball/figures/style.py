"""One look for all figures, and files that are the same from run to run."""

import json
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.datasets.atomic import replacing

WIDTH = 3.4
"""Width of a one-column figure in inches."""
WIDE = 7.0
"""Width of a two-column figure in inches."""

# The hues of Okabe and Ito, which colour-blind readers can distinguish, darkened to a
# contrast of at least 3:1 with white, in an order in which neighbours differ in
# greyscale too (grey levels 0, 87, 132, 85, 130).
COLOURS = ("#000000", "#0072B2", "#C77C00", "#AA3A00", "#3F96CC")
RESTITUTION = "#000000"
CONTACT = "#0072B2"
TABLE = "#8c8c8c"
Look = dict[str, Any]
"""Keywords of a line or a marker."""

GUIDE: Look = {"color": "#8c8c8c", "linewidth": 0.7, "linestyle": (0, (1, 1.5))}

# Hollow, so that markers which coincide can all be seen.
_HOLLOW: Look = {"linestyle": "none", "markerfacecolor": "none", "markeredgewidth": 1.0}
SADDLE_NODE: Look = {"marker": "o", "markersize": 5, **_HOLLOW}
PERIOD_DOUBLING: Look = {**SADDLE_NODE, "marker": "s"}
STABLE: Look = {"linestyle": "-", "linewidth": 1.3}
GRAZING: Look = {"marker": "^", "markersize": 4.5, "linestyle": "none"}
END: Look = {"marker": "x", "markersize": 5, "linestyle": "none", "markeredgewidth": 1.2}
INADMISSIBLE: Look = {"linestyle": (0, (0.8, 2.2)), "linewidth": 0.8}
UNSTABLE: Look = {"linestyle": (0, (3.5, 2)), "linewidth": 1.0}

_SETTINGS: dict[Any, Any] = {
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 9,
    "axes.labelsize": 9,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "legend.handlelength": 2.2,
    "lines.linewidth": 1.3,
    "savefig.dpi": 300,
    # Fixed salt and text as paths: identifiers and fonts do not depend on the
    # run or on the machine.
    "svg.hashsalt": "bouncing-ball",
    "svg.fonttype": "path",
}


@contextmanager
def style() -> Iterator[None]:
    """Matplotlib settings for drawing and saving one figure."""
    with matplotlib.rc_context(_SETTINGS):
        yield


def canvas(width: float = WIDTH, height: float = 2.6, rows: int = 1, columns: int = 1, **options):
    """A figure and its axes, laid out without overlaps."""
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots(rows, columns, **options)


def logarithmic(axes: Axes, ratio: xr.DataArray | None = None) -> None:
    """Logarithmic frequency-ratio axis with plain numbers at the decades.

    It is named, and as long as the ϖ that are given.
    """
    if ratio is not None:
        axes.set(xlabel=r"frequency ratio $\varpi$", xlim=(float(ratio[0]), float(ratio[-1])))
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.xaxis.set_minor_formatter(lambda value, _: "")


def number(value: float) -> str:
    """A parameter as a label shows it.

    Examples
    --------
    >>> number(0.85), number(10000.0), number(2.0)
    ('0.85', '10^{4}', '2')
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


def note(axes: Axes, text: str, point, offset, **look) -> None:
    """A text at an offset in points from a point of the data."""
    axes.annotate(text, point, xytext=offset, textcoords="offset points", **look)


def save_all(figure: Figure, paths: Iterable[str | Path], metadata: Mapping[str, str]) -> None:
    """Write a figure in several formats, laid out once for all of them."""
    if layout := figure.get_layout_engine():
        layout.execute(figure)
    figure.set_layout_engine("none")
    for path in paths:
        save(figure, path, metadata)


def save(figure: Figure, path: str | Path, metadata: Mapping[str, str]) -> None:
    """Write a figure as PNG or SVG, whole or not at all, the same every time.

    The metadata become text chunks of a PNG; an SVG, whose vocabulary is
    limited, holds them as JSON in its description.
    """
    # Neither a time nor a version of matplotlib's own.
    if Path(path).suffix == ".svg":
        embedded = {"Date": None, "Creator": None, "Description": json.dumps(dict(metadata))}
    else:
        embedded = {"Software": None, **metadata}
    with replacing(path) as temporary:
        figure.savefig(temporary, metadata=embedded)
