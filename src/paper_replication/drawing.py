"""Draw what all figures share: style, colours, panels, legends, labels and picture files.

All figures have the width `WIDTH` and texts of 8 points. Colours differ in lightness, and curves
also differ in dashes, width or marks. Readers need neither colour vision nor a colour printer.

The pictures are independent of the user's settings: `style` starts from matplotlib's defaults, and
only settings that it is given change them.
"""

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, findfont
from matplotlib.lines import Line2D
from matplotlib.path import Path as Outline
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from paper_replication.datasets import whole

Look = dict[str, Any]
"""Keyword arguments of a line, a mark or a text."""

WIDTH = 3.5
"""Width of all figures in inches: one column of a journal."""

SETTINGS: Look = {
    "font.size": 8,
    "axes.titlesize": "medium",
    "figure.labelsize": "medium",
    "figure.titlesize": "medium",
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    # In units of the font size: 18 points.
    "legend.handlelength": 2.25,
    "legend.columnspacing": 1.2,
    "legend.handletextpad": 0.6,
    "lines.linewidth": 1.2,
    # Dashes of wide and narrow lines coincide only if their lengths are equal.
    "lines.scale_dashes": False,
    "hatch.linewidth": 0.6,
    "figure.constrained_layout.use": True,
    "figure.dpi": 300,
    # Letters are paths, because the layout is computed for one font, which the reader of an SVG may
    # not have.
    "svg.fonttype": "path",
    # Letters of fonts that are embedded: they can be searched, and journals accept them.
    "pdf.fonttype": 42,
}

# Neighbours also differ in grey. Each colour has a contrast of at least 3:1 with white.
COLOURS = ("#000000", "#0072b2", "#c77c00", "#8a2f62", "#3f96cc")
# In points. Each pattern begins and ends with a whole dash on the 18 points of a legend's line.
DASHES = (
    "-",
    (0, (5, 1.5)),
    (0, (7, 1.5, 1, 1.5)),
    (0, (2, 1.2)),
    (0, (6, 1.2, 1.2, 1.2, 1.2, 1.2)),
)
GUIDE: Look = {"color": "#777777", "linewidth": 0.8, "linestyle": (0, (1, 1.6)), "zorder": 1}


def style(own: Mapping[str, Any] | None = None) -> AbstractContextManager:
    """Context for drawing and saving figures: matplotlib's defaults, updated by `SETTINGS` and by
    settings of one's own.

    Raises KeyError for a setting that matplotlib does not have, and ValueError for a value that it
    does not accept, or for a font that is not installed.
    """
    settings: Any = matplotlib.rcParamsDefault | SETTINGS | matplotlib.RcParams(own or {})
    if own:
        if "figure.figsize" in own:
            # `panels` compares it with the default, which may be one's own.
            settings["figure.figsize"] = [np.nextafter(x, 9) for x in settings["figure.figsize"]]
        with matplotlib.rc_context(settings):
            findfont(FontProperties(), fallback_to_default=False)
    return matplotlib.rc_context(settings)


def latex_number(value: float) -> str:
    r"""Return a number in LaTeX with four digits, and as a power of ten if it is at least 10⁴.

    Examples
    --------
    >>> latex_number(0.85), latex_number(0.135851), latex_number(10000.0), latex_number(250000.0)
    ('0.85', '0.1359', '10^{4}', '2.5\\times10^{5}')
    """
    if abs(value) < 1e4:
        return f"{value:.4g}"
    mantissa, exponent = f"{value:.3e}".split("e")
    factor = f"{float(mantissa):g}"
    return f"10^{{{int(exponent)}}}" if factor == "1" else rf"{factor}\times10^{{{int(exponent)}}}"


def colours(count: int) -> Sequence[str]:
    """Colours of curves: the first `COLOURS`, or a scale from dark to light for more curves."""
    if count <= len(COLOURS):
        return COLOURS[:count]
    # The upper part of the colour map has too little contrast with white.
    shades = matplotlib.colormaps["viridis"](np.linspace(0.0, 0.6, count))
    return [to_hex(shade) for shade in shades]


def pale(colour: str) -> str:
    """Mix a colour with white, for wide lines and for areas."""
    red, green, blue = (0.45 * part + 0.55 for part in to_rgb(colour))
    return to_hex((red, green, blue))


# Panels

POINTS = 72
"""Points in an inch. Sizes of texts, sizes of marks and offsets are in points."""

LEGEND_ROWS = 5
"""Rows of a legend for which the height of a figure is meant."""

LEGEND_ROW = 1.56
"""Height of a row of a legend, in units of the font size."""


def panels(
    height: float, rows: int = 1, columns: int = 1, width: float = WIDTH, **options: Any
) -> tuple[Figure, Any]:
    """Create a figure of a height and a width in inches, and its panel or panels.

    A size of one's own, `figure.figsize` of `style`, comes first.
    """
    own = matplotlib.rcParams["figure.figsize"]
    is_own = own != matplotlib.rcParamsDefault["figure.figsize"]
    figure = Figure(figsize=own if is_own else (width, height))
    # This canvas keeps its renderer. Otherwise each measurement of a text would create one.
    FigureCanvasAgg(figure)
    return figure, figure.subplots(rows, columns, **options)


def legend_below(
    figure: Figure, entries: Mapping[str, Any] | None = None, columns: int = 2
) -> None:
    """Add a legend below the panels.

    `entries` are the handles by label; the default is all labelled artists of the panels. A legend
    that is wider than the figure gets fewer columns, and one with many rows makes it higher.
    """
    if entries is None:
        entries = {}
        for axes in figure.axes:
            handles, labels = axes.get_legend_handles_labels()
            # If two panels have the same entry, the handle of the upper panel remains.
            entries |= dict(zip(labels, handles, strict=True)) | entries
    shown = list(entries.values())
    legend = figure.legend(shown, list(entries), loc="outside lower center", ncols=columns)
    if columns > 1 and legend.get_window_extent().width > figure.bbox.width:
        legend.remove()
        legend_below(figure, entries, columns - 1)
    elif (more := len(shown) / columns - LEGEND_ROWS) > 0:
        row = LEGEND_ROW * matplotlib.rcParams["font.size"] / POINTS
        figure.set_figheight(figure.get_figheight() + np.ceil(more) * row)


def sample(**look: Any) -> Line2D:
    """Return a line or a mark for a legend, black by default."""
    return Line2D([], [], **{"color": "black"} | look)


# Labels next to curves. They are added last, because their positions depend on the layout.

LINE_HEIGHT = 1.3125
"""Vertical distance of labels that are next to each other, in units of the font size."""


def name_at_right(axes: Axes, names: Sequence[tuple[str, float, str]]) -> None:
    """Add labels at the right edge of a panel.

    `names` are the text, the height in data coordinates and the colour of each label, of at least
    one. Labels are moved as little as possible so that none overlap and all are next to the panel.
    Draw the figure without rendering first, because the panel needs its final size.
    """
    # SciPy is slow to import, and few figures have such labels.
    from scipy.optimize import isotonic_regression

    order = sorted(names, key=lambda name: name[1])
    ends = [(0.0, height) for _, height, _ in order]
    points = POINTS / axes.figure.dpi
    wanted = axes.transData.transform(ends)[:, 1] * points
    bottom, top = axes.get_window_extent().intervaly * points
    steps = LINE_HEIGHT * matplotlib.rcParams["font.size"] * np.arange(len(order))
    ascending = isotonic_regression(wanted - steps).x
    lowest = np.clip(ascending, bottom, max(bottom, top - steps[-1]))
    moved = lowest + steps - wanted
    look: Look = {"xycoords": axes.get_yaxis_transform(), "textcoords": "offset points"}
    for (text, height, colour), offset in zip(order, moved, strict=True):
        axes.annotate(text, (1.0, height), (4, offset), color=colour, va="center", **look)


SIDES: Sequence[tuple[tuple[float, float], str, str]] = (
    ((5, 1), "left", "bottom"),
    ((-5, -1), "right", "top"),
    ((7, 0), "left", "center"),
    ((-7, 0), "right", "center"),
    ((-5, 1), "right", "bottom"),
    ((5, -1), "left", "top"),
    ((0, 6), "center", "bottom"),
    ((0, -6), "center", "top"),
)
"""Sides of a point for its label: an offset in points, and the alignment of the text."""


def name_points(axes: Axes, names: Sequence[tuple[str, tuple[float, float], int]]) -> None:
    """Add labels next to points of a panel, so that they meet no line, mark or other label.

    `names` are the text, the point in data coordinates and the preferred side, an index of `SIDES`.
    A label that is free at no side is left out. Draw the figure without rendering first, because
    the panel needs its final size.
    """
    taken: list[Bbox] = []
    paths: list[Outline] = []
    point = axes.figure.dpi / POINTS
    for line in axes.lines:
        where = line.get_transform().transform(line.get_xydata())
        if line.get_linestyle() != "None":
            paths.append(Outline(where))
        if line.get_marker() != "None" and line.get_markevery() is None:
            half = line.get_markersize() / 2 * point
            taken += [Bbox([at - half, at + half]) for at in where[np.isfinite(where).all(axis=1)]]
    for text, at, preferred in names:
        label = axes.annotate(text, at, (0, 0), textcoords="offset points")
        for side in (SIDES[preferred], *SIDES):
            label.set(position=side[0], horizontalalignment=side[1], verticalalignment=side[2])
            box = ink(label)
            if (
                axes.bbox.contains(*box.min)
                and axes.bbox.contains(*box.max)
                and not any(box.overlaps(other) for other in taken)
                and not any(path.intersects_bbox(box, filled=False) for path in paths)
            ):
                taken.append(box)
                break
        else:
            label.remove()


def ink(text: Text) -> Bbox:
    """Return the box of a text in pixels with half a point beside its letters, and without the
    space above and below them.
    """
    point = text.figure.dpi / POINTS
    along = 0.5 * point
    across = -1.5 * point
    upright = text.get_rotation() in (90, 270)
    return text.get_window_extent().padded(*((across, along) if upright else (along, across)))


def thin(axis: Axis) -> None:
    """Leave out every second number of a horizontal axis until none meets the next.

    Draw the figure without rendering first, because the panel needs its final size.
    """
    low, high = np.sort(axis.get_view_interval())
    slack = 1e-9 * (high - low)
    while True:
        ticks = axis.get_majorticklocs()
        shown = (ticks >= low - slack) & (ticks <= high + slack)
        boxes = [
            ink(label) for label, inside in zip(axis.get_ticklabels(), shown, strict=True) if inside
        ]
        if all(one.x1 < other.x0 for one, other in pairwise(boxes)):
            return
        axis.set_ticks(ticks[shown][::2])


# Files


def on_the_same_axes(figures: Sequence[Figure]) -> list[bytes]:
    """Return figures of the same kind as PNG, each panel with limits that hold those of all, and in
    the place that it can have in all: a longer legend moves panels.
    """
    size = np.max([figure.get_size_inches() for figure in figures], axis=0)
    for figure in figures:
        figure.set_size_inches(size)
    for panels_of_all in zip(*(figure.axes for figure in figures), strict=True):
        x = [axes.get_xlim() for axes in panels_of_all]
        y = [axes.get_ylim() for axes in panels_of_all]
        for axes in panels_of_all:
            axes.set(xlim=(np.min(x), np.max(x)), ylim=(np.min(y), np.max(y)))
    for figure in figures:
        with style():
            figure.draw_without_rendering()
        figure.set_layout_engine("none")
    for panels_of_all in zip(*(figure.axes for figure in figures), strict=True):
        low, high = np.swapaxes([axes.get_position().get_points() for axes in panels_of_all], 0, 1)
        for axes in panels_of_all:
            axes.set_position(Bbox([low.max(0), high.min(0)]))
    pictures = []
    for figure in figures:
        with style(), BytesIO() as picture:
            figure.savefig(picture, format="png")
            pictures.append(picture.getvalue())
    return pictures


def save_pdf(figure: Figure, path: str | Path, own: Mapping[str, Any] | None = None) -> None:
    """Save a figure as PDF, with the settings with which it was drawn (`style`)."""
    with style(own), whole(Path(path)) as unfinished:
        figure.savefig(unfinished, format="pdf", metadata={"CreationDate": None})


def save_picture(
    figure: Figure, png: str | Path, svg: str | Path, salt: str, css: str = ""
) -> None:
    """Save a figure as PNG and SVG, which name the version of matplotlib.

    The salt, which is any word, gives the SVG the same identifiers in each run. A style sheet `css`
    may move its parts: an artist has its `gid` as identifier.
    The SVG of a figure with a label has this as its title, which a browser shows and reads aloud,
    and its texts as texts, which can be searched and depend on the fonts of the reader. The same
    figure gives the same bytes, and the file appears whole or not at all. Raises OSError if a file
    cannot be written.
    """
    metadata: dict[str, dict[str, str | None]] = {"png": {}, "svg": {"Date": None}}
    words = str(figure.get_label())
    with style():
        matplotlib.rcParams["svg.hashsalt"] = salt
        if words:
            metadata["svg"]["Title"] = words
            matplotlib.rcParams["svg.fonttype"] = "none"
        for path, kind in ((Path(png), "png"), (Path(svg), "svg")):
            with whole(path) as unfinished:
                figure.savefig(unfinished, format=kind, metadata=metadata[kind])
                if css and kind == "svg":
                    still = unfinished.read_text("utf-8")
                    moving = still.replace("</style>", f"{css}</style>", 1)
                    unfinished.write_text(moving, "utf-8", newline="\n")
            # The SVG has the layout of the PNG: sizes of texts differ a little between the two.
            figure.set_layout_engine("none")
