"""Errors of the restitution and of the corrected model, quantity by quantity.

Also on contacts of other laws, with Figures 8, 14 and 16 on them.
"""

from itertools import cycle
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.figures.canvas import WIDE, canvas, legend_below, logarithmic, panels
from bouncing_ball.figures.labels import QUANTITIES, number, parameters
from bouncing_ball.figures.style import CORRECTED, GUIDE, LAWS, RESTITUTION, Look
from bouncing_ball.figures.tables.rows import accidental

# Bands that differ in grey and by their hatching; lines that differ by their dashes.
_MODELS: dict[str, Look] = {
    "restitution": {"color": RESTITUTION, "linestyle": "-", "linewidth": 1.2},
    "corrected": {"color": CORRECTED, "linestyle": (0, (3, 1.5)), "linewidth": 1.2},
}
_BANDS: dict[str, Look] = {
    "restitution": {"facecolor": "#d0d0d0", "edgecolor": "none"},
    "corrected": {"facecolor": "none", "edgecolor": CORRECTED, "hatch": "////", "alpha": 0.5},
}
# The linear contact, whose threshold is smooth, comes first.
_SHAPES = ("", "o", "s", "^")


def orders(data: xr.Dataset) -> Figure:
    """Errors of both models along ϖ, with the slopes 1 and 2."""
    figure, axes_of = _by_quantity(data, 4.2, r"frequency ratio $\varpi$", "relative error")
    ratio = data.frequency_ratio.values
    for quantity, axes in axes_of.items():
        for order, (model, look) in enumerate(_MODELS.items(), 1):
            part, colour = data.sel(model=model, quantity=quantity), look["color"]
            error = part.relative_error.values
            axes.plot(ratio, error, color=colour, label=model)
            # A guide of the slope through the last point.
            axes.plot(ratio, error[-1] * (ratio[-1] / ratio) ** order, **GUIDE)
            place: Look = {"transform": axes.transAxes, "ha": "right", "va": "top"}
            text = f"order {float(part.order.median()):.2f}"
            axes.text(0.97, 1.04 - 0.11 * order, text, color=colour, fontsize=8, **place)
        logarithmic(axes, yscale="log", xlim=(ratio[0], ratio[-1]), ylim=(1e-9, 3.0))
    figure.suptitle(
        f"{parameters(data, 'n', 'restitution', 'amplitude')}; orders of "
        f"{data.sizes['sample']} random orbits, median"
    )
    legend_below(figure, ncols=2)
    return figure


def contact_laws(data: xr.Dataset) -> Figure:
    """Errors of both models on contacts of five laws, over the share of the cycle in contact."""
    label = r"share of the cycle in contact, $D/(2\pi n)$"
    figure, axes_of = _by_quantity(data, 5.0, label, "relative error")
    share = 1 / (2 * data.attrs["n"] * data.duration_ratio.values)
    for quantity, axes in axes_of.items():
        for law in data["law"].values:
            for model, name in (("restitution", str(law)), ("corrected", None)):
                error = data.relative_error.sel(law=law, quantity=quantity, model=model)
                axes.plot(share, error, linewidth=1.1, label=name, **LAWS[str(law)])
        for slope in (1, 2):
            axes.plot(share[[0, -1]], share[[0, -1]] ** slope, **GUIDE)
        axes.set(xscale="log", yscale="log")
    spare = figure.axes[len(axes_of)]
    spare.axis("off")
    title = (
        "upper five: restitution model\nlower five: corrected model\ndotted: slopes 1 and 2\n"
        + parameters(data, "n", "restitution", "amplitude")
    )
    spare.legend(*figure.axes[0].get_legend_handles_labels(), loc="upper left", title=title)
    return figure


def figures_of_laws(data: xr.Dataset) -> Figure:
    """Phase against Λ, greatest height and permanent contact against π/D."""
    figure, (branches, heights, held) = canvas(WIDE, 2.9, columns=3)
    ratio, marked = data.duration_ratio.values, []
    for law, shape in zip(data["law"].values, cycle(_SHAPES), strict=False):
        look, part = LAWS[str(law)], data.sel(law=law)
        for k in range(data.sizes["shown_ratio"]):
            one = part.isel(shown_ratio=k)
            (line,) = branches.plot(one.amplitude, one.phase / np.pi, linewidth=1.0, **look)
        heights.plot(ratio, part.max_height, linewidth=1.0, **look)
        # That of a nonlinear contact goes up and down between samples too: the line only
        # leads from one to the next, and breaks off where no threshold was found.
        drawn = {"linewidth": 0.3, "linestyle": "-"} if shape else {"linewidth": 0.8}
        marks = {"marker": shape, "markersize": 1.8}
        marked += held.plot(ratio, part.threshold_amplitude, **(look | drawn | marks))
        marked[-1:] = [(line, marked[-1])]
    heights.axhline(float(data.restitution_max_height), color=RESTITUTION, linewidth=0.6)
    held.axhline(1.0, color=RESTITUTION, linewidth=0.6)
    branches.set(xlabel=r"$\Lambda$", ylabel=r"phase $\varphi/\pi$")
    listed = ", ".join(f"{x:g}" for x in data.shown_ratio.values)
    branches.set_title(rf"{parameters(data, 'restitution')}, $\pi/D$ = {listed}", fontsize=8)
    title = rf"$r={number(data.attrs['heights__restitution'])}$"
    for axes, name, margin in (
        (heights, r"greatest height $\max\,z$", 1.0),
        (held, r"threshold of permanent contact", 1.06),
    ):
        span = ratio[0] / margin, ratio[-1] * margin
        logarithmic(axes, xlabel=r"$\pi/D$", ylabel=name, xlim=span)
        axes.set_title(title, fontsize=8)
    legend_below(figure, marked, map(str, data["law"].values), ncols=len(marked))
    return figure


def validity(data: xr.Dataset) -> Figure:
    """From which ϖ on each model is right: a band over n and Λ, and one orbit's line, over r."""
    label = rf"$\varpi$ for {100 * data.attrs['tolerance']:g} %"
    figure, axes_of = _by_quantity(data, 4.6, "restitution coefficient $r$", label)
    middle = float(data.amplitude_ratio[data.sizes["amplitude_ratio"] // 2])
    line: dict[str, Any] = {"n": int(data.n[0]), "amplitude_ratio": middle}
    handles: dict[str, Any] = {}
    for quantity, axes in axes_of.items():
        part = data.sel(quantity=quantity)
        for model, look in _MODELS.items():
            found = part.error_threshold.sel(model=model)
            lowest, highest = (f(("n", "amplitude_ratio")) for f in (found.min, found.max))
            axes.fill_between(data.restitution, lowest, highest, linewidth=0.4, **_BANDS[model])
            axes.plot(data.restitution, found.sel(line), label=model, **look)
        _ring_accidents(axes, part.sel(line))
        axes.set_yscale("log")
        axes.grid(visible=True, axis="y", linewidth=0.3)
        names = axes.get_legend_handles_labels()
        handles |= dict(zip(*reversed(names), strict=True)) | handles
    figure.suptitle(
        rf"lines: $n={line['n']}$, $\Lambda={middle:g}\,\Lambda_{{SN}}$; bands: all $n$ of "
        rf"{_listed(data.n)} and $\Lambda/\Lambda_{{SN}}$ of {_listed(data.amplitude_ratio)}"
    )
    legend_below(figure, list(handles.values()), ncols=len(handles))
    return figure


def _by_quantity(
    data: xr.Dataset, height: float, xlabel: str, ylabel: str
) -> tuple[Figure, dict[str, Axes]]:
    """Two rows of three panels, one for each quantity, named on the outside only."""
    figure, slots = panels(height, 2, 3)
    for axes in slots:
        axes.set(xlabel=xlabel, ylabel=ylabel)
        axes.label_outer()
    by_quantity = dict(zip(map(str, data["quantity"].values), slots, strict=False))
    for quantity, axes in by_quantity.items():
        axes.set_title(QUANTITIES[quantity])
    return figure, by_quantity


def _ring_accidents(axes: Axes, data: xr.Dataset) -> None:
    """Rings where the restitution model's error is small because it passes through zero."""
    there, found = accidental(data), data.error_threshold.sel(model="restitution")
    name = "restitution, within the tolerance by an accidental zero"
    look: Look = {"color": RESTITUTION, "markerfacecolor": "white", "markersize": 4.5}
    axes.plot(data.restitution[there], found[there], "o", label=name, **look)


def _listed(values: xr.DataArray) -> str:
    return ", ".join(f"{value:g}" for value in values.values)
