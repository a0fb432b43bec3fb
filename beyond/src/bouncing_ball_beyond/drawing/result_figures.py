"""Figures of the results of beyond's calls, by the names of the calls; they compute nothing."""

from collections.abc import Callable, Mapping
from itertools import cycle, pairwise

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from bouncing_ball_beyond.drawing.kinds import Kind
from bouncing_ball_beyond.inherited.datasets import CASE
from bouncing_ball_beyond.inherited.drawing import result_figures as root
from bouncing_ball_beyond.inherited.drawing.canvas import (
    WIDE,
    WIDTH,
    canvas,
    coloured,
    legend_below,
)
from bouncing_ball_beyond.inherited.drawing.labels import QUANTITIES, in_a_row, symbol, title
from bouncing_ball_beyond.inherited.drawing.style import COLOURS, LINES, Look

# The colours of the kinds of motion, in the order of the legend. Motions that do not repeat have
# pale colours, because they fill their bands.
_HUES = {
    Kind.ORBIT: COLOURS[0],
    Kind.SUBHARMONIC: COLOURS[1],
    Kind.LOCKED: COLOURS[2],
    Kind.PERMANENT_CONTACT: COLOURS[3],
    Kind.CHAOTIC: "#9a9a9a",
    Kind.UNDECIDED: "#d9b8d9",
}
# Basins are areas, coloured in order of their shares with light and dark colours in turn.
_AREAS = ("#3F96CC", "#000000", "#E8B04A", "#AA3A00", "#B7DDF2", "#5B5B5B", "#F4E3B5", "#D9D9D9")


def followed(data: xr.Dataset) -> Figure:
    """The phases of the impacts of a branch over its parameter, with its special orbits.

    Lines change their look at the special orbit between two points, if there is one.
    """
    figure, axes = canvas(WIDE, 3.4)
    along = data.attrs["along"]
    stability = np.where(data.stable, "stable", "unstable")
    looks = np.where(data.admissible, stability, "inadmissible")
    edges = [0, *(np.flatnonzero(looks[1:] != looks[:-1]) + 1), len(looks)]
    borders = {int(data.special_point[j]) + 1: j for j in range(data.sizes["special"])}
    # A part with one of the impacts has no axis of the impacts.
    phases = np.atleast_2d(data.phase.values.T) / np.pi
    special_phases = np.atleast_2d(data.special_phase.values.T) / np.pi
    for k, (here, there) in enumerate(zip(phases, special_phases, strict=True)):
        line = np.stack([data[along].values, here])
        special = np.stack([data[f"special_{along}"], there])
        first = line[:, :0]
        for start, stop in pairwise(edges):
            # Without a special orbit the line changes at the next point.
            j = borders.get(stop)
            last = line[:, stop : stop + 1] if j is None else special[:, j : j + 1]
            x, phase = np.concatenate([first, line[:, start:stop], last], axis=-1)
            # A phase that passes ±π goes on at the other edge.
            jumps = np.abs(np.diff(phase, prepend=phase[:1])) > 1
            look = LINES[looks[start]] | {"color": COLOURS[k % len(COLOURS)]}
            axes.plot(x, np.where(jumps, np.nan, phase), label=looks[start], **look)
            first = last
    _mark_special(axes, data, data[f"special_{along}"].values, special_phases[0])
    axes.set(
        xlabel=symbol(along), ylabel=r"phases of impact $\varphi/\pi$", title=_orbit_title(data)
    )
    legend_below(figure, ncols=4)
    return figure


def special_curve(data: xr.Dataset) -> Figure:
    """A curve of special orbits in the plane of its two parameters, with its special points."""
    figure, axes = canvas(WIDTH, 3.2)
    first, second = data.attrs["along"].split(", ")
    shown = data.admissible
    look: Look = {"color": COLOURS[1], "label": data.attrs["curve_kind"]}
    beneath: Look = {"label": None if shown.all() else "inadmissible"}
    axes.plot(data[second], data[first], **look | LINES["inadmissible"] | beneath)
    axes.plot(data[second], data[first].where(shown), **look)
    _mark_special(axes, data, data[f"special_{second}"].values, data[f"special_{first}"].values)
    axes.set(xlabel=symbol(second), ylabel=symbol(first), title=_orbit_title(data))
    legend_below(figure, ncols=3)
    return figure


def _mark_special(axes: Axes, data: xr.Dataset, x: np.ndarray, y: np.ndarray) -> None:
    """The special points of each kind."""
    kinds = dict.fromkeys(data.special_kind.values.tolist())
    for kind, marker in zip(kinds, cycle("osDv^P"), strict=False):
        here = data.special_kind.values == kind
        look: Look = {"linestyle": "none", "markersize": 5, "markerfacecolor": "none"}
        look |= {"color": "black"}
        axes.plot(x[here], y[here], marker=marker, label=kind, zorder=4, **look)


def _orbit_title(data: xr.Dataset) -> str:
    impacts = data.attrs["impacts"]
    periods = data.attrs["periods"]
    orbit = f"{impacts} impact{'s' if impacts > 1 else ''} in {periods} T"
    return ", ".join(x for x in (orbit, title(data)) if x)


def _kinds_legend(figure: Figure, found: set[str]) -> None:
    marks = [
        Line2D([], [], color=_HUES[kind], marker="o", markersize=3.5, linestyle="none", label=kind)
        for kind in _HUES
        if kind in found
    ]
    legend_below(figure, marks, ncols=len(marks))


def orbit_diagram(data: xr.Dataset) -> Figure:
    """Phase and speed of the impacts on the attractors over Λ, in the colour of their kind."""
    figure, panels = canvas(WIDE, 5.0, rows=2, sharex=True)
    lam = np.broadcast_to(data.amplitude.values[:, np.newaxis, np.newaxis], data.impact_phase.shape)
    units = {"impact_phase": np.pi, "impact_speed": 1.0}
    for axes, (name, unit) in zip(panels, units.items(), strict=True):
        for kind in reversed(_HUES):
            here = (data.kind == kind).values
            if here.any():
                fills = kind in (Kind.CHAOTIC, Kind.UNDECIDED)
                look = {"marker": ","} if fills else {"marker": "o", "markersize": 0.9, "mew": 0}
                x = lam[here].ravel()
                y = data[name].values[here].ravel() / unit
                axes.plot(x, y, color=_HUES[kind], linestyle="none", rasterized=True, **look)
    panels[0].set(ylabel=r"phase of impact $\varphi/\pi$", ylim=(-1, 1), title=title(data))
    panels[1].set(ylabel=r"speed of impact $-\delta'$", ylim=(0, None))
    panels[1].set(xlabel=r"amplitude $\Lambda$")
    if data.amplitude.size > 1:
        panels[1].set_xlim(float(data.amplitude[0]), float(data.amplitude[-1]))
    _kinds_legend(figure, set(np.unique(data.kind)))
    return figure


def motions(data: xr.Dataset) -> Figure:
    """Periods of the motions, in the colour of their kind; 0 for a motion that does not repeat."""
    return _over_argument(data, "periods", "periods until it repeats")


def exponent(data: xr.Dataset) -> Figure:
    """The largest Lyapunov exponents with their standard errors."""
    name = r"exponent $\lambda$ per period $2\pi$"
    return _over_argument(data, "lyapunov_exponent", name, "lyapunov_error")


def _over_argument(data: xr.Dataset, name: str, label: str, error: str | None = None) -> Figure:
    figure, axes = canvas(WIDTH, 2.6)
    rows, _ = in_a_row(data)
    place = np.arange(rows.sizes[CASE])
    argument = "number of the start"
    if len(data.dims) == 1:
        (along,) = data.dims
        place = data[along].values
        argument = symbol(str(along))
    for kind in _HUES:
        here = (rows.kind == kind).values & np.isfinite(rows[name].values)
        if here.any():
            bar = None if error is None else rows[error].values[here]
            look = {"color": _HUES[kind], "linestyle": "none", "markersize": 3}
            axes.errorbar(place[here], rows[name].values[here], bar, marker="o", **look)
    axes.set(xlabel=argument, ylabel=label, title=title(data))
    _kinds_legend(figure, set(np.unique(rows.kind)))
    return figure


def basins(data: xr.Dataset) -> Figure:
    """The motions on which starts end, over phase and speed; shares in the legend."""
    figure, axes = canvas(WIDE, 4.2)
    order = np.argsort(-data.share.values, kind="stable")
    shown = min(len(_AREAS), order.size)
    rank = np.empty(order.size, dtype=int)
    rank[order] = np.minimum(np.arange(order.size), shown - 1)
    axes.pcolormesh(
        data.start_phase.values / np.pi,
        data.start_speed.values,
        rank[data.destination.values],
        rasterized=True,
        cmap=ListedColormap(_AREAS[:shown]),
        vmin=-0.5,
        vmax=shown - 0.5,
    )
    axes.set(xlabel=r"phase of the first impact $\varphi/\pi$", title=title(data))
    axes.set_ylabel(r"speed of the first impact $-\delta'$")
    names = [_name(data.isel(motion=k)) for k in order[:shown]]
    if order.size > shown:
        rest = float(data.share.values[order[shown - 1 :]].sum())
        names[-1] = f"{order.size - shown + 1} others ({rest:.1%})"
    patches = [Patch(color=_AREAS[k], label=name) for k, name in enumerate(names)]
    legend_below(figure, patches, ncols=3)
    return figure


def _name(motion: xr.Dataset) -> str:
    periods = int(motion.motion_periods)
    impacts = int(motion.motion_impacts)
    words = str(motion.motion_kind.values)
    if periods and impacts:
        words += f", {periods} T, {impacts} impact{'s' if impacts > 1 else ''}"
    return f"{words} ({float(motion.share):.1%})"


def error_thresholds(data: xr.Dataset) -> Figure:
    """The ϖ from which on each error is tolerable; a ball that needs none has no mark."""
    figure, axes = canvas(WIDE, 2.8)
    rows, names = in_a_row(data, "simple", "quantity")
    place = np.arange(data.quantity.size)
    for (row, colour), name in zip(coloured(rows, CASE), names, strict=True):
        for simple, marker in (("restitution", "o"), ("corrected", "D")):
            values = row.error_threshold.sel(simple=simple)
            label = ", ".join(x for x in (f"{simple} model", name) if x)
            axes.semilogx(values, place, marker, color=colour, label=label, markersize=4)
    axes.set(yticks=place, yticklabels=[QUANTITIES[str(x)] for x in data.quantity.values])
    axes.set(xlabel=r"frequency ratio $\varpi$ of the contact", title=title(data))
    axes.invert_yaxis()
    legend_below(figure, ncols=2)
    return figure


FIGURES: Mapping[str, Callable[[xr.Dataset], Figure]] = {
    **root.FIGURES,
    "follow": followed,
    "curve": special_curve,
    "motion": motions,
    "exponent": exponent,
    "diagram": orbit_diagram,
    "basins": basins,
    "error_thresholds": error_thresholds,
}
"""The figure of the result of each command or call."""
