"""Branches of n-T orbits with stability and bifurcations: phase of the table against Λ.

Solid where stable, dashed where unstable, dotted where inadmissible (Figs. 3, 8, 9, 15).
"""

from itertools import cycle, pairwise
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from bouncing_ball.datasets.selection import each
from bouncing_ball.figures.canvas import WIDE, canvas, legend_below
from bouncing_ball.figures.labels import number, parameters
from bouncing_ball.figures.style import COLOURS, END, LINES, MARKS, RESTITUTION, Look

_KEYS = "#5f5f5f"
_TABLE_PHASE = r"phase of the table over $\pi$"


def restitution_families(data: xr.Dataset) -> Figure:
    """Fig. 3: the restitution model's branch for each family."""
    figure, axes = canvas(4.2, height=3.6)
    names = []
    for family in each(data, "n"):
        _draw_branch(axes, family, family.phase, RESTITUTION)
        _draw_named_points(axes, family.sel(impact_map="exact"))
        names.append(_upper_end(family.amplitude, family.phase, f"$n={family.n:d}$"))
    title = parameters(data, "restitution")
    _name_axes(axes, data, r"phase $\varphi/\pi$", title)
    axes.set_ylim(-0.52, 0.52)
    _label_ends(axes, names, 0.055)
    _explain(figure, bool(data.admissible.all()), colour="black", ncols=4)
    return figure


def domains(data: xr.Dataset) -> Figure:
    """Figs. 8 and 9: the spring-damper model's branch for each ϖ, in one panel."""
    figure, axes = canvas(WIDE, 4.2)
    curves = [up_to_second_saddle_node(curve) for curve in each(data, "frequency_ratio")]
    names = []
    for curve, colour in zip(curves, cycle(COLOURS), strict=False):
        ratio = number(float(curve.frequency_ratio))
        _draw_spring_damper(axes, curve, colour, colour)
        for symbol, phase in ((r"\varphi", curve.phase), (r"\varphi+\tau_b", curve.release_phase)):
            name = rf"$\varpi={ratio}$: ${symbol}$"
            names.append((float(curve.amplitude[-1]), float(phase[-1]) / np.pi, name))
    _name_axes(axes, data, _TABLE_PHASE, parameters(data, "n", "restitution"))
    _label_ends(axes, names, 0.05)
    admissible = all(curve.admissible.all() for curve in curves)
    _explain(figure, admissible, ended=any(len(_ends(curve)) for curve in curves))
    return figure


def both_domains(data: xr.Dataset) -> Figure:
    """Fig. 15: the branch of both models."""
    figure, axes = canvas(5.6, 3.4)
    of_branch = ("amplitude", "phase", "stable", "admissible")
    rigid = xr.Dataset({name: data[f"restitution_{name}"] for name in of_branch})
    _draw_branch(axes, rigid, rigid.phase, RESTITUTION)
    _draw_named_points(axes, data)
    curve = data.squeeze("frequency_ratio")
    _draw_spring_damper(axes, curve, COLOURS[1], COLOURS[2])
    # The contact may have no such branch.
    lowest = float(curve.amplitude.fillna(data.saddle_node_amplitude).min())
    title = parameters(data, "n", "restitution", "frequency_ratio")
    _name_axes(axes, data, _TABLE_PHASE, title, left=0.9 * lowest)
    names = [
        _upper_end(curve.amplitude, curve.release_phase, r"spring-damper, $\varphi+\tau_b$"),
        _upper_end(rigid.amplitude, rigid.phase, r"restitution, $\varphi$"),
        _upper_end(curve.amplitude, curve.phase, r"spring-damper, $\varphi$"),
    ]
    _label_ends(axes, names, 0.07)
    _explain(figure, bool(data.admissible.all()), ncols=4, columnspacing=1.0)
    return figure


def up_to_second_saddle_node(curve: xr.Dataset) -> xr.Dataset:
    """The branch from its other end to the saddle-node at which its unstable side turns back.

    Beyond it the contact is longer than at it. A branch whose unstable side
    does not turn back is returned as it is.
    """
    durations = curve.special_contact_duration.values[curve.special_kind.values == "saddle-node"]
    if len(durations) < 2:
        return curve
    longest = np.sort(durations)[1]
    part = curve.isel(
        point=curve.contact_duration.values <= longest,
        special=curve.special_contact_duration.values <= longest,
    )
    # Cut there, it does not end there.
    stable_side = part.end_reason.values[-1]
    return part.assign(end_reason=("end", ["left the window of the figure", stable_side]))


def draw_curve(axes: Axes, x: Any, y: Any, admissible: Any, **look: Any) -> None:
    """A curve of orbits in its own look, dotted where they are inadmissible."""
    x, y, shown = np.asarray(x), np.asarray(y), np.asarray(admissible, dtype=bool)
    axes.plot(x, np.where(shown, y, np.nan), **look)
    if not np.all(shown):
        axes.plot(x, np.where(shown, np.nan, y), color=look["color"], **LINES["inadmissible"])


def _name_axes(axes: Axes, data: xr.Dataset, ylabel: str, title: str, left: float = 0.0) -> None:
    axes.set(xlabel=r"amplitude $\Lambda$", ylabel=ylabel, title=title)
    axes.set_xlim(left, data.attrs["amplitude_max"])


def _draw_branch(axes: Axes, curve: xr.Dataset, phase: xr.DataArray, colour: str) -> None:
    """A branch in runs of one look, each reaching to the next one's first point."""
    x, y = curve.amplitude.values, phase.values / np.pi
    kinds = np.where(curve.admissible, np.where(curve.stable, "stable", "unstable"), "inadmissible")
    edges = [0, *(np.flatnonzero(kinds[1:] != kinds[:-1]) + 1), len(kinds)]
    for start, stop in pairwise(edges):
        run = slice(start, stop + 1)
        axes.plot(x[run], y[run], color=colour, **LINES[kinds[start]])


def _draw_named_points(axes: Axes, data: xr.Dataset) -> None:
    """The bifurcations and grazings of the restitution model that a dataset has by name."""
    for kind, mark in MARKS.items():
        name = kind.replace("-", "_").replace(" ", "_")
        if f"{name}_phase" in data:
            at = data[f"{name}_amplitude"], data[f"{name}_phase"] / np.pi
            axes.plot(*at, color=RESTITUTION, zorder=4, **mark)


def _draw_spring_damper(axes: Axes, curve: xr.Dataset, start: str, end: str) -> None:
    """The phases at the start and at the end of contact, with special points and ends."""
    special = curve.special_phase
    for phase, place, colour in (
        (curve.phase, special, start),
        (curve.release_phase, special + curve.special_contact_duration, end),
    ):
        _draw_branch(axes, curve, phase, colour)
        for kind, mark in MARKS.items():
            at = curve.special_kind.values == kind
            x, y = curve.special_amplitude[at], place[at] / np.pi
            axes.plot(x, y, color=colour, zorder=4, **mark)
        for point in _ends(curve):
            axes.plot(curve.amplitude[point], phase[point] / np.pi, color=colour, **END)


def _ends(curve: xr.Dataset) -> np.ndarray:
    """The first and the last point, where the branch ends inside the window."""
    inside = [not str(reason).startswith("left the window") for reason in curve.end_reason.values]
    return np.array([0, -1])[inside]


def _upper_end(x: xr.DataArray, phase: xr.DataArray, name: str) -> tuple[float, float, str]:
    """Where a curve is highest, to be named there; a branch may run either way, or be nowhere."""
    at = int(np.nanargmax(phase)) if phase.notnull().any() else 0
    return float(x[at]), float(phase[at]) / np.pi, name


def _apart(values: np.ndarray, gap: float) -> np.ndarray:
    """Increasing values moved as little as keeps them ``gap`` apart.

    Examples
    --------
    >>> _apart(np.array([0.0, 1.0, 1.0]), 0.5).tolist()
    [0.0, 0.75, 1.25]
    """
    steps = gap * np.arange(len(values))
    above = np.maximum.accumulate(values - steps)
    below = np.minimum.accumulate((values - steps)[::-1])[::-1]
    return (above + below) / 2 + steps


def _label_ends(axes: Axes, ends: list[tuple[float, float, str]], gap: float) -> None:
    """Names of curves right of the axes, each with a line to its end (x, y).

    ``gap`` is the least distance of two names, in parts of the axes' height.
    """
    found = sorted((end for end in ends if np.isfinite(end[1])), key=lambda end: end[1])
    low, high = axes.get_ylim()
    places = _apart(np.array([y for _, y, _ in found]), gap * (high - low))
    line = {"arrowstyle": "-", "color": _KEYS, "linewidth": 0.5, "shrinkB": 1}
    look: Look = {"va": "center", "fontsize": 8, "annotation_clip": False, "arrowprops": line}
    right = axes.get_yaxis_transform()
    for (x, y, name), place in zip(found, places, strict=True):
        axes.annotate(name, (x, y), xytext=(1.045, place), textcoords=right, **look)


def _explain(
    figure: Figure, admissible: bool, *, ended: bool = False, colour: str = _KEYS, **options: Any
) -> None:
    """The legend of lines and marks; of inadmissible orbits and of ends if there are any."""
    looks = {**LINES, **MARKS, "end of branch": END}
    labels = ["stable", "unstable", "saddle-node", "period doubling"]
    labels += ["inadmissible", "grazing"] * (not admissible) + ["end of branch"] * ended
    handles = [Line2D([], [], color=colour, label=name, **looks[name]) for name in labels]
    spacing: Look = {"ncols": len(handles), "columnspacing": 1.2, "handletextpad": 0.5}
    legend_below(figure, handles, **spacing | options)
