"""Extension: the frequency ratio from which each model is right."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.figures.accidents import accidental
from bouncing_ball.figures.quantities import NAMES
from bouncing_ball.figures.style import COLOURS, RESTITUTION, WIDE, Look, canvas

# Bands that differ in grey and by their hatching; lines that differ by their dashes.
_MODELS: dict[str, tuple[str, Look]] = {
    "restitution": (RESTITUTION, {"linestyle": "-", "linewidth": 1.2}),
    "corrected": (COLOURS[3], {"linestyle": (0, (3, 1.5)), "linewidth": 1.2}),
}


def draw(data: xr.Dataset) -> Figure:
    """One panel for each quantity: a band over n and Λ for each model, and one orbit's line."""
    figure, panels = canvas(WIDE, 4.6, rows=2, columns=3, sharex=True, sharey=True)
    middle = float(data.amplitude_ratio[data.sizes["amplitude_ratio"] // 2])
    line: dict[str, Any] = {"n": int(data.n[0]), "amplitude_ratio": middle}
    for axes, quantity in zip(np.ravel(panels), data["quantity"].values, strict=True):
        for model, (colour, look) in _MODELS.items():
            part = data.error_threshold.sel(quantity=quantity, model=model)
            _band(axes, part, colour, hatch="////" if model == "corrected" else None)
            axes.plot(data.restitution, part.sel(line), color=colour, label=model, **look)
        _accidents(axes, data.sel({"quantity": quantity} | line))
        axes.set_yscale("log")
        axes.set_title(NAMES[str(quantity)], fontsize=9)
        axes.grid(visible=True, axis="y", linewidth=0.3)
    for axes in panels[-1]:
        axes.set_xlabel("restitution coefficient $r$")
    for axes in panels[:, 0]:
        axes.set_ylabel(rf"$\varpi$ for {100 * data.attrs['tolerance']:g} %")
    figure.suptitle(
        rf"lines: $n={line['n']}$, $\Lambda={middle:g}\,\Lambda_{{SN}}$; bands: all $n$ of "
        rf"{_listed(data.n)} and $\Lambda/\Lambda_{{SN}}$ of {_listed(data.amplitude_ratio)}",
        fontsize=9,
    )
    handles = dict(_handles(np.ravel(panels)))
    figure.legend(
        list(handles.values()), list(handles), loc="outside lower center", ncols=len(handles)
    )
    return figure


def _band(axes: Axes, found: xr.DataArray, colour: str, hatch: str | None) -> None:
    over = ("n", "amplitude_ratio")
    axes.fill_between(
        found.restitution,
        found.min(over),
        found.max(over),
        facecolor="none" if hatch else "#d0d0d0",
        edgecolor=colour if hatch else "none",
        hatch=hatch,
        linewidth=0.4,
        alpha=0.5 if hatch else 1.0,
    )


def _accidents(axes: Axes, data: xr.Dataset) -> None:
    """Rings where the restitution model's error is small because it passes through zero."""
    there = accidental(data)
    axes.plot(
        data.restitution[there],
        data.error_threshold.sel(model="restitution")[there],
        "o",
        color=RESTITUTION,
        markerfacecolor="white",
        markersize=4.5,
        label="restitution, within the tolerance by an accidental zero",
    )


def _handles(panels) -> Iterator[tuple[str, Artist]]:
    for axes in panels:
        handles, labels = axes.get_legend_handles_labels()
        yield from zip(labels, handles, strict=True)


def _listed(values: xr.DataArray) -> str:
    return ", ".join(f"{value:g}" for value in values.values)
