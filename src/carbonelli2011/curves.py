"""Draw what several figures of the paper share: labels, curves along ϖ and branches of orbits.

Three line styles show the kind of an orbit:

- solid: stable
- dashed: unstable
- dotted: inadmissible

Some pictures show both phases of a contact. A wide pale line is the phase φ at its start. A narrow
line is the phase φ + τ_b at its end. Where both coincide, the narrow line is within the wide line.
"""

from collections.abc import Iterable, Mapping
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter
from numpy.typing import NDArray

from paper_replication.datasets import parameters
from paper_replication.drawing import Look, latex_number, legend_below, pale, sample

TABLE = "#8c8c8c"
"""Colour of the table."""

SALT = "bouncing-ball"
"""Of the identifiers in the SVGs."""

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


# Labels

SYMBOLS = {
    "n": "n",
    "restitution": "r",
    "amplitude": r"\Lambda",
    "frequency_ratio": r"\varpi",
    "damping_ratio": r"\zeta",
}


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
    labels = [label(**{name: column[k] for name, column in rest.items()}) for k in range(count)]
    return label(**common), labels


def along_ratio(axes: Axes, ratio: xr.DataArray) -> None:
    """Format the horizontal axis as a logarithmic axis of ϖ."""
    axes.set(xscale="log", xlim=(ratio.min(), ratio.max()))
    number_ratios(axes.xaxis, ratio)
    axes.set_xlabel(r"frequency ratio $\varpi$")
    # In a column of panels, only the lowest panel has the label.
    axes.label_outer()


def number_ratios(axis: Axis, ratio: xr.DataArray) -> None:
    """Number a logarithmic axis of ϖ at powers of ten, and at each end that is far enough from
    them. Beyond 10⁴ the axis has powers of ten, which are wider.
    """
    ends = np.array([ratio.min(), ratio.max()], dtype=float)
    low, high = np.log10(ends)
    powers = np.arange(np.ceil(low), np.floor(high) + 1)
    distance = np.abs(np.log10(ends)[:, np.newaxis] - powers).min(axis=1, initial=np.inf)
    alone = ends[distance > np.where(ends < 1e4, 0.1, 0.2) * (high - low)]
    axis.set_ticks(np.sort([*10**powers, *alone]))
    powers_from = 1e4 if ends[1] > 1e4 else np.inf
    axis.set_major_formatter(
        FuncFormatter(
            lambda value, _: (
                f"${latex_number(value)}$" if value >= powers_from else f"{float(f'{value:.4g}'):g}"
            )
        )
    )
    axis.set_minor_formatter(NullFormatter())


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


def kinds_of(data: xr.Dataset, prefix: str = "") -> np.ndarray:
    """Return the kind of each orbit of a dataset, a key of `KINDS`, in the shape of its flags.

    The prefix "restitution_" selects the flags of the restitution model. A dataset of an older run
    may lack a flag, which then counts as true.
    """
    like = data["phase"].notnull() if not prefix else data["restitution_phase"].notnull()
    stable, admissible = (
        data.get(f"{prefix}{flag}", xr.ones_like(like)) for flag in ("stable", "admissible")
    )
    return np.where(admissible, np.where(stable, "stable", "unstable"), "inadmissible")


def look_of(kind: str) -> Look:
    """Return how a curve of one kind of orbit differs from the curve of stable orbits.

    Unstable curves have crosses, because some stable curves are dashed.
    """
    if kind == "stable":
        return {}
    crosses: Look = {"marker": "x", "markersize": 3, "markevery": 0.12}
    return {"linestyle": KINDS[kind], "linewidth": 0.9} | (crosses if kind == "unstable" else {})


def with_kinds(name: str, kinds: np.ndarray) -> str:
    """Return the name of a curve, with the kind of its orbits if none of them is stable.

    Examples
    --------
    >>> [with_kinds("ball", np.array(kinds)) for kinds in ("unstable", ["stable", "unstable"])]
    ['ball (unstable)', 'ball']
    """
    present = np.unique(kinds)
    return name if "stable" in present else f"{name} ({', '.join(present)})"


def curve(axes: Axes, x: NDArray, y: NDArray, kinds: np.ndarray, **look: Any) -> None:
    """Draw a line whose parts have the style of the `kinds` of their orbits.

    The first stable part has the label, and the first part of each other kind the name of this
    kind. If no part is stable, the label has the kind (`with_kinds`).
    """
    shown = [part for part in pieces(kinds) if np.isfinite(y[part]).any()]
    if not shown:  # the legend has its name
        axes.plot([], [], **look)
    # In the legend, parts of other kinds come after the stable ones.
    parts = sorted(shown, key=lambda part: [*KINDS].index(kinds[part.start]))
    labelled = {"stable"}
    for part in parts:
        kind = kinds[part.start]
        text = None if kind in labelled else kind
        if part == parts[0] and "label" in look:
            text = with_kinds(look["label"], kinds[np.isfinite(y)])
        labelled.add(kind)
        axes.plot(x[part], y[part], **(look | look_of(kind) | {"label": text}))


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
    kinds = kinds_of(branch)
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
