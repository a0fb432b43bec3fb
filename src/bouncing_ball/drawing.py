"""Draw what the figures share: style, labels, branches of orbits, legends and picture files.

All figures have the width `WIDTH` and texts of 8 points. Colours differ in lightness, and curves
also differ in dashes, width or marks. Readers need neither colour vision nor a colour printer.

Three line styles show the kind of an orbit:

- solid: stable
- dashed: unstable
- dotted: inadmissible

Some pictures show both phases of a contact. A wide pale line is the phase φ at its start. A narrow
line is the phase φ + τ_b at its end. Where both coincide, the narrow line is within the wide line.

The pictures are independent of the user's settings: `style` starts from matplotlib's defaults.
"""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import AbstractContextManager
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Annotation
from matplotlib.ticker import FuncFormatter

from bouncing_ball.datasets import parameters, whole

Look = dict[str, Any]
"""Keyword arguments of a line, a mark or a text."""

WIDTH = 3.5
"""Width of all figures in inches: one column of a journal."""

SETTINGS: Look = {
    "font.size": 8,
    "axes.titlesize": "medium",
    "figure.labelsize": "medium",
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
    # A fixed salt gives each run the same identifiers. Letters are paths, because the layout is
    # computed for one font, which the reader of an SVG may not have.
    "svg.hashsalt": "bouncing-ball",
    "svg.fonttype": "path",
}

# Neighbours also differ in grey. Each colour has a contrast of at least 3:1 with white.
COLOURS = ("#000000", "#0072b2", "#c77c00", "#8a2f62", "#3f96cc")
TABLE = "#8c8c8c"
# In points. Each pattern begins and ends with a whole dash on the 18 points of a legend's line.
DASHES = (
    "-",
    (0, (5, 1.5)),
    (0, (7, 1.5, 1, 1.5)),
    (0, (2, 1.2)),
    (0, (6, 1.2, 1.2, 1.2, 1.2, 1.2)),
)
GUIDE: Look = {"color": "#777777", "linewidth": 0.8, "linestyle": (0, (1, 1.6)), "zorder": 1}
KINDS: Mapping[str, Any] = {
    "stable": "-",
    "unstable": (0, (4.5, 2.25)),
    "inadmissible": (0, (1, 2)),
}
"""Line style of each kind of orbit."""

MARKS: Mapping[str, Look] = {
    "saddle-node": {"marker": "o", "markersize": 3.4},
    "period doubling": {"marker": "s", "markersize": 3.4},
    "grazing": {"marker": "^", "markersize": 3.4},
    "period doubling, Eq. 8": {"marker": "x", "markersize": 5.5},
    "joins permanent contact": {"marker": "D", "markersize": 3.4, "fillstyle": "full"},
    "end of the branch": {"marker": "h", "markersize": 3.4, "fillstyle": "full"},
}
"""Mark of each special orbit. Larger marks would hide short stable ranges between two marks."""

WIDE, NARROW = 3.4, 1.1
"""Line widths of the phases at the start and at the end of a contact."""


def style() -> AbstractContextManager:
    """Context for drawing and saving figures: matplotlib's defaults, updated by `SETTINGS`."""
    settings: Any = matplotlib.rcParamsDefault | SETTINGS
    return matplotlib.rc_context(settings)


# Labels

SYMBOLS = {
    "n": "n",
    "restitution": "r",
    "amplitude": r"\Lambda",
    "frequency_ratio": r"\varpi",
    "damping_ratio": r"\zeta",
}


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


def label(**values: float) -> str:
    r"""Return the symbols and values of parameters in LaTeX.

    Examples
    --------
    >>> label(n=1, restitution=0.85, frequency_ratio=2.0)
    '$n=1$, $r=0.85$, $\\varpi=2$'
    """
    return ", ".join(f"${SYMBOLS[name]}={latex_number(value)}$" for name, value in values.items())


def title(data: xr.Dataset, *names: str) -> str:
    """Return the symbols and values of the named parameters of a dataset in LaTeX."""
    given = parameters(data)
    return label(**{name: given[name] for name in names})


def parted(values: Mapping[str, Iterable[float]]) -> tuple[str, list[str]]:
    r"""Separate the parameters that all curves share from those that differ.

    Returns a label of the shared parameters, and for each curve a label of its other parameters.
    The label of a single curve is empty.

    Examples
    --------
    >>> parted({"restitution": [0.85, 0.85], "amplitude": [1.1, 0.6]})
    ('$r=0.85$', ['$\\Lambda=1.1$', '$\\Lambda=0.6$'])
    """
    lists = {name: [float(value) for value in column] for name, column in values.items()}
    common = {name: column[0] for name, column in lists.items() if len(set(column)) == 1}
    rest = {name: column for name, column in lists.items() if name not in common}
    count = max(len(column) for column in lists.values())
    each = [label(**{name: column[k] for name, column in rest.items()}) for k in range(count)]
    return label(**common), each


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


def panels(
    height: float, rows: int = 1, columns: int = 1, width: float = WIDTH, **options: Any
) -> tuple[Figure, Any]:
    """Create a figure of a height and a width in inches, and its panel or panels."""
    figure = Figure(figsize=(width, height))
    # This canvas keeps its renderer. Otherwise each measurement of a text would create one.
    FigureCanvasAgg(figure)
    return figure, figure.subplots(rows, columns, **options)


def along_ratio(axes: Axes, ratio: xr.DataArray) -> None:
    """Format the horizontal axis as a logarithmic axis of ϖ with plain numbers.

    The axis has numbers at powers of ten. It also has a number at each end that is far enough from
    a power of ten.
    """
    ends = np.array([ratio.min(), ratio.max()], dtype=float)
    low, high = np.log10(ends)
    powers = np.arange(np.ceil(low), np.floor(high) + 1)
    distance = np.abs(np.log10(ends)[:, np.newaxis] - powers).min(axis=1, initial=np.inf)
    alone = ends[distance > 0.1 * (high - low)]
    axes.set(xscale="log", xlim=ends, xticks=np.sort([*10**powers, *alone]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(FuncFormatter(lambda value, _: ""))
    axes.set_xlabel(r"frequency ratio $\varpi$")
    # In a column of panels, only the lowest panel has the label.
    axes.label_outer()


def legend_below(
    figure: Figure, entries: Mapping[str, Any] | None = None, columns: int = 2
) -> None:
    """Add a legend below the panels.

    `entries` are the handles by label; the default is all labelled artists of the panels. A legend
    that is wider than the figure gets fewer columns.
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


def sample(**look: Any) -> Line2D:
    """Return a line or a mark for a legend, black by default."""
    return Line2D([], [], **{"color": "black"} | look)


def mark_look(kind: str) -> Look:
    """Return the look of a mark of `MARKS` without a line."""
    return {"fillstyle": "none", "linestyle": "none", "markeredgewidth": 1.0} | MARKS[kind]


# Curves


def pieces(kinds: np.ndarray) -> list[slice]:
    """Split a line into parts of one kind; a part ends at the first point of the next part.

    Examples
    --------
    >>> pieces(np.array(["stable", "stable", "unstable"]))
    [slice(0, 3, None), slice(2, 4, None)]
    """
    edges = [0, *(np.flatnonzero(kinds[1:] != kinds[:-1]) + 1), len(kinds)]
    return [slice(int(start), int(stop) + 1) for start, stop in pairwise(edges)]


def curve(
    axes: Axes, x: xr.DataArray, y: xr.DataArray, admissible: xr.DataArray, **look: Any
) -> None:
    """Draw a line with dotted inadmissible parts.

    The first admissible part has the label, or the first of all if none is admissible. Of the
    others, the first dotted one is labelled as inadmissible.
    """
    inadmissible = look | {"linestyle": KINDS["inadmissible"], "linewidth": 0.9}
    kinds = admissible.values
    # In the legend, the inadmissible part comes after the admissible one.
    parts = sorted(pieces(kinds), key=lambda part: not kinds[part.start])
    dotted = ~kinds & np.isfinite(y.values)
    others = [part for part in parts[1:] if dotted[part].any() and not kinds[part.start]]
    for part in parts:
        chosen = look if kinds[part.start] else inadmissible
        label_of_part = look.get("label") if part == parts[0] else None
        if part in others[:1]:
            label_of_part = "inadmissible"
        axes.plot(x.values[part], y.values[part], **(chosen | {"label": label_of_part}))


# Branches of orbits. A branch is a dataset with two dimensions:
# - `point`: amplitude, phase, release_phase, stable, admissible, and `along`, which increases.
# - `special`: special_kind, special_along, special_amplitude, special_phase and
#   special_release_phase.


def spring_damper_branch(data: xr.Dataset) -> xr.Dataset:
    """Branch of the spring-damper model at one ϖ. Its points have equal steps of arclength."""
    return data.assign(
        along=("point", np.linspace(0.0, 1.0, data.sizes["point"])),
        special_along=data.special_arclength,
        special_release_phase=data.special_phase + data.special_contact_duration,
    )


def restitution_branch(curve: xr.Dataset, bifurcations: xr.Dataset) -> xr.Dataset:
    """Branch of the restitution model. The impact height Λ sin φ increases along it.

    The impact is instantaneous, so the release phase equals the phase φ. `bifurcations` contains Λ
    and φ of the saddle-node, of the period doubling, and optionally of the grazing orbit. The
    result also contains Λ and φ of the period doubling of Eq. 8.
    """
    kinds = {
        "saddle-node": "saddle_node",
        "period doubling": "period_doubling",
        "grazing": "grazing",
    }
    known = {kind: name for kind, name in kinds.items() if f"{name}_phase" in bifurcations}
    amplitudes = np.array([bifurcations[f"{name}_amplitude"].item() for name in known.values()])
    phases = np.array([bifurcations[f"{name}_phase"].item() for name in known.values()])
    # Bifurcations beyond the range of Λ are not shown.
    largest = curve.amplitude.max().item()
    amplitudes[~(amplitudes <= largest)] = np.nan
    phases[np.isnan(amplitudes)] = np.nan
    # All orbits satisfy Λ cos φ = Λ_SN (Eqs. 6, 7). Eq. 8 gives Λ² = 1 + Λ_SN².
    saddle_node = bifurcations.saddle_node_amplitude
    holmes = np.hypot(1, saddle_node)
    return curve.assign(
        release_phase=curve.phase,
        along=curve.amplitude * np.sin(curve.phase),
        holmes_amplitude=holmes,
        holmes_phase=np.arctan2(1, saddle_node).where(holmes <= largest),
        special_kind=("special", list(known)),
        special_along=("special", amplitudes * np.sin(phases)),
        special_amplitude=("special", amplitudes),
        special_phase=("special", phases),
        special_release_phase=("special", phases),
    )


def draw_branch(axes: Axes, branch: xr.Dataset, phase: str, colour: str, width: float) -> None:
    """Draw one phase of a branch against Λ. The line style changes at special points.

    `phase` is "phase" or "release_phase".
    """
    known = np.flatnonzero(branch.special_amplitude.notnull())
    special = branch.isel(special=known).sortby("special_along")
    place = np.searchsorted(branch.along, special.special_along)
    stability = np.where(branch.stable, "stable", "unstable")
    kinds = np.where(branch.admissible, stability, "inadmissible")
    # A special point gets the kind of the next orbit, or of the last orbit at the end.
    kinds = np.insert(kinds, place, kinds[np.minimum(place, kinds.size - 1)])
    amplitude = np.insert(branch.amplitude.values, place, special.special_amplitude)
    angle = np.insert(branch[phase].values, place, special[f"special_{phase}"]) / np.pi
    for part in pieces(kinds):
        kind = kinds[part.start]
        look: Look = {"linestyle": KINDS[kind], "linewidth": width, "color": colour}
        # Narrow lines must be above the wide lines of all branches.
        axes.plot(amplitude[part], angle[part], label=kind, zorder=3 - width / 10, **look)


def mark(axes: Axes, kind: str, amplitude: xr.DataArray, phase: xr.DataArray, colour: str) -> None:
    """Mark the special orbits of one kind, if there are any."""
    if phase.notnull().any():
        look = mark_look(kind)
        axes.plot(amplitude, phase / np.pi, color=colour, zorder=4, label=kind, **look)


def mark_special(axes: Axes, branch: xr.Dataset, phase: str, colour: str) -> None:
    """Mark the special points of a branch, and its ends inside the range of Λ."""
    for kind in MARKS:
        there = branch[f"special_{phase}"].where(branch.special_kind == kind)
        mark(axes, kind, branch.special_amplitude, there, colour)
    if "holmes_phase" in branch:
        mark(axes, "period doubling, Eq. 8", branch.holmes_amplitude, branch.holmes_phase, colour)
    for kind, point in inner_ends(branch):
        end = branch.isel(point=point)
        mark(axes, kind, end.amplitude, end[phase], colour)


def inner_ends(branch: xr.Dataset) -> list[tuple[str, int]]:
    """Kind and point of each end of a branch that is not an end of the range of Λ."""
    known = np.flatnonzero(branch.amplitude.notnull())
    if "end_kind" not in branch or not known.size:
        return []
    marks = {"permanent contact": "joins permanent contact", "inside": "end of the branch"}
    ends = zip(branch.end_kind.values, (known[0], known[-1]), strict=True)
    return [(marks[kind], int(point)) for kind, point in ends if kind in marks]


def right_end(branch: xr.Dataset, phase: str) -> float:
    """Return a phase divided by π at the largest Λ of a branch.

    Both ends of a branch often have the largest Λ, within rounding. Then the last end counts.
    """
    far = branch.amplitude >= branch.amplitude.max() * (1 - 1e-9)
    return float(branch[phase][np.flatnonzero(far)[-1]]) / np.pi


def branch_legend(figure: Figure, both_phases: bool) -> None:
    """Add a legend of the line styles, widths and marks that occur in a figure."""
    drawn = {line.get_label() for axes in figure.axes for line in axes.lines}
    kinds = {kind: look for kind, look in KINDS.items() if kind in drawn}
    marks = {kind: sample(**mark_look(kind)) for kind in MARKS if kind in drawn}
    if not both_phases:
        legend_below(figure, {kind: sample(linestyle=kinds[kind]) for kind in kinds} | marks)
        return
    wide: Look = {"linewidth": WIDE, "color": pale("#000000")}
    phases = {
        r"start of contact, $\varphi$": sample(**wide),
        r"end of contact, $\varphi+\tau_b$": sample(linewidth=NARROW),
    }
    # Each line style occurs with both widths.
    lines: dict[str, Any] = {
        kind: (sample(linestyle=look, **wide), sample(linestyle=look, linewidth=NARROW))
        for kind, look in kinds.items()
    }
    legend_below(figure, phases | lines | marks)


# Numbers as text


def share_text(share: float) -> str:
    """Return a share in percent with one decimal, or as "< 0.1 %" instead of "0.0 %".

    Examples
    --------
    >>> share_text(0.1222), share_text(0.0004), share_text(0.0), share_text(float("nan"))
    ('12.2 %', '< 0.1 %', 'none', 'unknown')
    """
    if np.isnan(share):
        return "unknown"
    if share == 0:
        return "none"
    return f"{100 * share:.1f} %" if share >= 0.0005 else "< 0.1 %"


# Labels next to curves. They are added last, because their positions depend on the layout.

POINTS = 72
"""Points in an inch. Sizes of texts, sizes of marks and offsets are in points."""

LINE_HEIGHT = 10.5
"""Vertical distance of labels that are next to each other, in points."""

MARK_RADIUS = 3
"""Half the size of a mark, in points."""


def ascending(values: np.ndarray) -> np.ndarray:
    """Return the ascending numbers that are closest to some values in the least-squares sense.

    This is isotonic regression by the min-max formula.

    Examples
    --------
    >>> ascending(np.array([3.0, 1.0, 4.0])).tolist()
    [2.0, 2.0, 4.0]
    """
    count = range(len(values))
    means = [[values[j : k + 1].mean() for k in count[j:]] for j in count]
    return np.array([max(min(means[j][i - j :]) for j in count[: i + 1]) for i in count])


def name_at_right(axes: Axes, names: Sequence[tuple[str, float, str]]) -> None:
    """Add labels at the right edge of a panel.

    `names` are the text, the height in data coordinates and the colour of each label. Labels are
    moved as little as possible so that none overlap and all are next to the panel. Draw the figure
    without rendering first, because the panel needs its final size.
    """
    if not names:
        return
    order = sorted(names, key=lambda name: name[1])
    ends = [(0.0, height) for _, height, _ in order]
    points = POINTS / axes.figure.dpi
    wanted = axes.transData.transform(ends)[:, 1] * points
    bottom, top = axes.get_window_extent().intervaly * points
    steps = LINE_HEIGHT * np.arange(len(order))
    lowest = np.clip(ascending(wanted - steps), bottom, max(bottom, top - steps[-1]))
    moved = lowest + steps - wanted
    look: Look = {"xycoords": axes.get_yaxis_transform(), "textcoords": "offset points"}
    for (text, height, colour), offset in zip(order, moved, strict=True):
        axes.annotate(text, (1.0, height), (4, offset), color=colour, va="center", **look)


def name_beside(axes: Axes, text: str, point: tuple[float, float]) -> None:
    """Add a label next to a point, given in data coordinates, and a line that joins them.

    The label is at the position where it hides the fewest curves, marks and labels. Among equally
    good positions the nearest is chosen. Draw the figure without rendering first, because the panel
    needs its final size.
    """
    labels = [other.get_window_extent() for other in axes.texts]
    note = axes.annotate(text, point, (0, 0), textcoords="offset points")
    paths = [(line, line.get_transform().transform_path(line.get_path())) for line in axes.lines]
    curves = [path for line, path in paths if line.get_linestyle() != "None"]
    marks = [path.vertices for line, path in paths if line.get_linestyle() == "None"]
    inside = axes.get_window_extent()

    def hidden(place: tuple[float, float]) -> int:
        move(note, place)
        box = note.get_window_extent().padded(axes.figure.dpi / POINTS)
        corners = np.array([box.min, box.max])
        outside = inside.count_contains(corners) < len(corners)
        covered = sum(path.intersects_bbox(box, filled=False) for path in curves)
        covered += sum(
            box.padded(MARK_RADIUS * axes.figure.dpi / POINTS).count_contains(points)
            for points in marks
        )
        return covered + box.count_overlaps(labels) + outside

    sides = [(1, 1), (-1, -1), (1, -1), (-1, 1), (1, 0), (-1, 0), (0, 1), (0, -1)]
    places = [(far * x, far * y) for far in (8, 12, 16, 20) for x, y in sides]
    place = min(places, key=hidden)
    move(note, place)
    line: Look = {"arrowstyle": "-", "linewidth": 0.6, "shrinkA": 0, "shrinkB": MARK_RADIUS}
    axes.annotate("", point, place, textcoords="offset points", arrowprops=line)


def move(note: Annotation, place: tuple[float, float]) -> None:
    """Move a label to an offset in points, with its nearest edge or corner towards its point."""
    x, y = np.sign(place).astype(int)
    horizontal = ("center", "left", "right")[x]
    vertical = ("center", "bottom", "top")[y]
    note.set(position=place, ha=horizontal, va=vertical)


# Files


def save_picture(figure: Figure, png: str | Path, svg: str | Path) -> None:
    """Save a figure as PNG and SVG, which name the version of matplotlib.

    The SVG of a figure with a label has this as its title, which a browser shows and reads aloud,
    and its texts as texts, which can be searched and depend on the fonts of the reader. The same
    figure gives the same bytes, and the file appears whole or not at all. Raises OSError if a file
    cannot be written.
    """
    metadata: dict[str, dict[str, str | None]] = {"png": {}, "svg": {"Date": None}}
    words = str(figure.get_label())
    with style():
        if words:
            metadata["svg"]["Title"] = words
            matplotlib.rcParams["svg.fonttype"] = "none"
        for path, kind in ((Path(png), "png"), (Path(svg), "svg")):
            with whole(path) as unfinished:
                figure.savefig(unfinished, format=kind, metadata=metadata[kind])
            # The SVG has the layout of the PNG: sizes of texts differ a little between the two.
            figure.set_layout_engine("none")
