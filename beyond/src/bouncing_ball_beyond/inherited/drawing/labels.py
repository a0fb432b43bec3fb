"""The texts on figures: quantities, parameters, notes."""

from collections.abc import Sequence
from typing import Any, NamedTuple, Self

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.path import Path
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox

from bouncing_ball_beyond.inherited.datasets import CASE
from bouncing_ball_beyond.inherited.drawing.style import GUIDE

QUANTITIES = {
    "phase": r"phase of impact $\varphi$",
    "max_height": r"greatest height $\max\,z$",
    "bounce_velocity": r"bouncing-off velocity $z′_b$",
    "apparent_restitution": r"apparent restitution $r_a$",
    "saddle_node": r"saddle-node $\Lambda_{SN}$",
    "period_doubling": r"period doubling $\Lambda_{PD}$",
    "permanent_contact": "permanent contact",
}
"""The titles of the quantities compared between the models."""

_POINTS_PER_INCH = 72.0
# Height of a line of text with an exponent, in points; and offsets of a text from its point, in
# points and sides.
_LINE_HEIGHT = 11.0
_DISTANCES = (4.0, 8.0, 14.0)
_SIDES = ((1, 1), (-1, 1), (1, -1), (-1, -1), (0, 1.5), (0, -1.5), (1.5, 0), (-1.5, 0))

# Parameters in the order in which a title lists them.
_SYMBOLS = {
    "n": "n",
    "restitution": "r",
    "measured_restitution": "r",
    "amplitude": r"\Lambda",
    "frequency_ratio": r"\varpi",
    "damping_ratio": r"\zeta",
    "duration": "D",
    "height": "h",
    "phase": r"\varphi",
    "velocity": "z′_i",
}


def number_label(value: float) -> str:
    r"""A parameter as text for a label, with a power of ten in LaTeX from 10⁴ on.

    Examples
    --------
    >>> number_label(0.85), number_label(10000.0), number_label(250000.0)
    ('0.85', '10^{4}', '2.5\\times 10^{5}')
    """
    if value >= 1e4:
        mantissa, exponent = f"{value:e}".split("e")
        factor = "" if float(mantissa) == 1 else rf"{float(mantissa):g}\times "
        return f"{factor}10^{{{int(exponent)}}}"
    return f"{value:g}"


def parameters(data: xr.Dataset, *names: str) -> str:
    """Parameters of a dataset as text for a title.

    Examples
    --------
    >>> parameters(xr.Dataset(attrs={"n": 1, "restitution": 0.85}), "n", "restitution")
    '$n=1$, $r=0.85$'
    """
    return ", ".join(f"${_SYMBOLS[name]}={number_label(data.attrs[name])}$" for name in names)


def symbol(name: str) -> str:
    """The symbol of a parameter, or its name in words if it has no symbol."""
    return f"${_SYMBOLS[name]}$" if name in _SYMBOLS else name.replace("_", " ")


def title(data: xr.Dataset) -> str:
    """A title of a labelled dataset: its model and its law, and the parameters among its attributes
    and its coordinates without an axis, such as those of a part of a result. A parameter with
    several values names the curves and not the figure.
    """
    fixed = {name: each.item() for name, each in data.coords.items() if not each.dims}
    data = data.assign_attrs(fixed)
    known = [name for name in _SYMBOLS if name in data.attrs and np.ndim(data.attrs[name]) == 0]
    words = [str(data.attrs[name]) for name in ("model", "law") if name in data.attrs]
    return ", ".join(x for x in (*words, parameters(data, *known)) if x)


def in_a_row(data: xr.Dataset, *kept: str) -> tuple[xr.Dataset, list[str]]:
    """A labelled dataset with the axes of its arguments merged into one, "case", and labels.

    The dimensions ``kept`` remain. The label of a case has its arguments.

    Examples
    --------
    >>> data = xr.Dataset({"ball": (("n", "time"), [[0.0], [1.0]])}, {"n": [1, 2]})
    >>> in_a_row(data, "time")[1]
    ['$n=1$', '$n=2$']
    """
    axes = [dim for dim in data.dims if dim not in kept]
    # xarray merges no axes of arrays that have no entries, such as those of special points: they
    # have one while the axes are merged.
    empty = [dim for dim, size in data.sizes.items() if size == 0]
    varied = [name for name in data.coords if name in _SYMBOLS and data[name].dims]
    labels = [name for name in varied if set(data[name].dims) <= {*axes}]
    filled = data.pad(dict.fromkeys(empty, (0, 1))) if empty else data
    rows = filled.stack({CASE: axes}, create_index=False) if axes else filled.expand_dims(CASE)
    rows = rows.isel(dict.fromkeys(empty, slice(0)))
    told = [{name: rows[name].values[k] for name in labels} for k in range(rows.sizes[CASE])]
    names = [
        ", ".join(f"${_SYMBOLS[x]}={number_label(v)}$" for x, v in one.items()) for one in told
    ]
    return rows.transpose(CASE, ...), names


def note(axes: Axes, text: str, point: Any, offset: Any, **look: Any) -> None:
    """A text at an offset in points from a point of the data."""
    axes.annotate(text, point, xytext=offset, textcoords="offset points", **look)


def _ascending(values: np.ndarray) -> np.ndarray:
    """The ascending numbers that are nearest to some values by least squares.

    These are the values of isotonic regression by their min-max formula, for a few values: the
    import of scipy.optimize takes longer than the drawing.

    Examples
    --------
    >>> _ascending(np.array([3.0, 1.0, 4.0])).tolist()
    [2.0, 2.0, 4.0]
    """
    count = range(len(values))
    means = [[values[j : k + 1].mean() for k in count[j:]] for j in count]
    return np.array([max(min(means[j][i - j :]) for j in count[: i + 1]) for i in count])


def names_at_the_right(axes: Axes, ends: Sequence[tuple[str, float, str]]) -> None:
    """Names of lines that end at the right edge: name, height and colour of each.

    Each name is as near to its line as the height of the others and of the panel allows, so that
    this comes after the layout of the panel.
    """

    places = axes.transData.transform([(0.0, height) for _, height, _ in ends])[:, 1]
    places *= _POINTS_PER_INCH / axes.figure.dpi
    order = np.argsort(places)
    steps = _LINE_HEIGHT * np.arange(len(ends))
    low, high = axes.get_window_extent().intervaly * _POINTS_PER_INCH / axes.figure.dpi
    spread = steps + _ascending(places[order] - steps).clip(low, max(low, high - steps[-1]))
    moved = np.empty_like(places)
    moved[order] = spread - places[order]
    for (name, height, colour), offset in zip(ends, moved, strict=True):
        look = {"va": "center", "color": colour, "xycoords": axes.get_yaxis_transform()}
        note(axes, name, (1.0, height), (3, offset), **look)


def note_beside(axes: Axes, text: str, point: tuple[float, float], **look: Any) -> None:
    """A text beside a point of the data, where it hides the least of the lines, marks and texts.

    The limits and the place of the panel must be known, so that this comes after its layout.
    """
    others = _Content.of(axes)
    written = axes.annotate(text, point, xytext=(0, 0), textcoords="offset points", **look)

    def hidden(place: tuple[float, float]) -> float:
        _move(written, place)
        return others.hidden_by(written.get_window_extent().padded(1.0))

    places = [(far * x, far * y) for far in _DISTANCES for x, y in _SIDES]
    _move(written, min(places, key=hidden))


def _move(text: Annotation, place: tuple[float, float]) -> None:
    """Put a text at an offset in points, aligned with its point on the near side."""
    x, y = place
    text.set(
        position=place,
        ha="center" if x == 0 else "left" if x > 0 else "right",
        va="center" if y == 0 else "bottom" if y > 0 else "top",
    )


class _Content(NamedTuple):
    """What a panel shows, in pixels: its own box, texts, arrows, lines with what hiding each of
    them costs, and marks with their radius.
    """

    inside: Bbox
    texts: list[Bbox]
    arrows: list[Path]
    lines: list[tuple[Path, float]]
    marks: list[tuple[Path, float]]

    @classmethod
    def of(cls, axes: Axes) -> Self:
        """The content of a panel whose limits and place are known."""
        texts = [x.get_window_extent() for x in axes.texts if x.get_text()]
        patches = [x.arrow_patch for x in axes.texts if isinstance(x, Annotation) and x.arrow_patch]
        arrows = [x.get_transform().transform_path(x.get_path()) for x in patches]
        lines = []
        marks = []
        for line in axes.lines:
            path = line.get_transform().transform_path(line.get_path())
            if line.get_linestyle() != "None":
                lines.append((path.cleaned(), 1.0 if line.get_color() == GUIDE["color"] else 2.0))
            if line.get_marker() != "None":
                reach = line.get_markersize() / 2 * axes.figure.dpi / _POINTS_PER_INCH
                marks.append((path, reach))
        return cls(axes.get_window_extent(), texts, arrows, lines, marks)

    def hidden_by(self, box: Bbox) -> float:
        """How much of it a text hides: a text more than a curve, and a curve more than a guide."""
        inside = self.inside
        cost = 0.0 if inside.x0 <= box.x0 and box.x1 <= inside.x1 else 8.0
        cost += 0.0 if inside.y0 <= box.y0 and box.y1 <= inside.y1 else 8.0
        cost += 4.0 * sum(box.overlaps(other) for other in self.texts)
        cost += 2.0 * sum(path.intersects_bbox(box, filled=False) for path in self.arrows)
        cost += sum(each for path, each in self.lines if path.intersects_bbox(box, filled=False))
        for path, reach in self.marks:
            cost += 2.0 * min(1, box.padded(reach).count_contains(path.vertices))
        return cost
