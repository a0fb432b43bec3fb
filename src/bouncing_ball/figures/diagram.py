"""Figures of the motions on which balls end: over Λ, over another argument, and over starts.

The datasets are those of :mod:`bouncing_ball.attractors.labelled`.
"""

import numpy as np
import xarray as xr
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from bouncing_ball.datasets import CASE
from bouncing_ball.figures.canvas import WIDE, WIDTH, canvas, legend_below
from bouncing_ball.figures.labels import in_a_row, symbol, title
from bouncing_ball.figures.style import COLOURS, Look

KINDS = ("orbit", "subharmonic", "locked", "permanent contact", "chaotic", "undecided")
"""The kinds of motion in the order of their colours."""

# Motions that do not repeat have pale colours, because they fill their bands.
_HUES = dict(zip(KINDS, (*COLOURS[:4], "#9a9a9a", "#d9b8d9"), strict=True))
# Basins are areas, coloured in order of their shares with light and dark colours in turn.
_AREAS = ("#3F96CC", "#000000", "#E8B04A", "#AA3A00", "#B7DDF2", "#5B5B5B", "#F4E3B5", "#D9D9D9")


def _kinds_legend(figure: Figure, found: set[str]) -> None:
    marks = [
        Line2D([], [], color=_HUES[kind], marker="o", markersize=3.5, linestyle="none", label=kind)
        for kind in KINDS
        if kind in found
    ]
    legend_below(figure, marks, ncols=len(marks))


def orbit_diagram(data: xr.Dataset) -> Figure:
    """Phase and speed of the impacts on the attractors over Λ, in the colour of their kind."""
    figure, panels = canvas(WIDE, 5.0, rows=2, sharex=True)
    lam = np.broadcast_to(data.amplitude.values[:, np.newaxis, np.newaxis], data.impact_phase.shape)
    units = {"impact_phase": np.pi, "impact_speed": 1.0}
    for axes, (name, unit) in zip(panels, units.items(), strict=True):
        for kind in reversed(KINDS):
            here = (data.kind == kind).values
            if here.any():
                fills = kind in ("chaotic", "undecided")
                look = {"marker": ","} if fills else {"marker": "o", "markersize": 0.9, "mew": 0}
                x, y = lam[here].ravel(), data[name].values[here].ravel() / unit
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
    place, argument = np.arange(rows.sizes[CASE]), "number of the start"
    if len(data.dims) == 1:
        (along,) = data.dims
        place, argument = data[along].values, symbol(str(along))
    for kind in KINDS:
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
    place = data.start_phase.values / np.pi, data.start_speed.values, rank[data.destination.values]
    look: Look = {"cmap": ListedColormap(_AREAS[:shown]), "vmin": -0.5, "vmax": shown - 0.5}
    axes.pcolormesh(*place, rasterized=True, **look)
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
    periods, impacts = int(motion.motion_periods), int(motion.motion_impacts)
    words = str(motion.motion_kind.values)
    if periods and impacts:
        words += f", {periods} T, {impacts} impact{'s' if impacts > 1 else ''}"
    return f"{words} ({float(motion.share):.1%})"
