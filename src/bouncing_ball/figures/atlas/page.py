"""One page to print: which model for which contact."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from bouncing_ball.figures.canvas import WIDE, canvas
from bouncing_ball.figures.style import GUIDE, QUANTITIES, Look

NEAR = 1
"""Ranges of positions next to the saddle-node that the colours leave out."""
_RIGHT, _CORRECTED, _NEITHER = "#ffffff", "#b9d7ea", "#7f7f7f"
_HIGHEST = 1e3
# Not dotted, as the rule of thumb is.
_BESIDE: dict[str, Look] = {
    "restitution": {"color": "black", "linestyle": "--", "linewidth": 0.8},
    "corrected": {"color": "black", "linestyle": "-.", "linewidth": 0.8},
}


def draw(data: xr.Dataset, release: str = "displacement") -> Figure:
    """A panel for each quantity: for a contact (r, ϖ) the simplest model that is right.

    Right for all families and all positions, but for the one range next to the
    saddle-node; a line shows what that range needs.
    """
    figure, panels = canvas(WIDE, 9.2, rows=4, columns=2, sharex=True, sharey=True)
    one = data.sel(release=release)
    slots = list(np.ravel(panels))
    for axes, quantity in zip(slots, data["quantity"].values, strict=False):
        needed = one.needed.sel(quantity=quantity).max("n")
        away = needed.isel(position=slice(NEAR, None)).max("position")
        _panel(axes, away, needed.isel(position=slice(NEAR)).max("position"))
        axes.set_title(QUANTITIES[str(quantity)], fontsize=9)
    for axes, limit in zip(slots[4:], data.limit_quantity.values, strict=False):
        where = {"limit_quantity": limit, "tolerance": float(data.summary_tolerance)}
        _panel(axes, one.limit_needed.sel(where).max("n"), None)
        axes.set_title(QUANTITIES[str(limit)], fontsize=9)
    for axes in slots[:-1]:
        axes.axhline(float(data.rule_of_thumb), **GUIDE)
    for axes in slots[-3:-1]:
        axes.set_xlabel("restitution coefficient $r$")
        axes.tick_params(labelbottom=True)
    for axes in panels[:, 0]:
        axes.set_ylabel(r"frequency ratio $\varpi$")
    _legend(slots[-1], data)
    percent, last = 100 * float(data.summary_tolerance), int(data.n.max())
    figure.suptitle(
        f"Which model for which contact: errors below {percent:g} %, families $n=1$ to {last}, "
        f"{release} release",
        fontsize=10,
    )
    return figure


def _panel(axes: Axes, needed: xr.DataArray, near: xr.DataArray | None) -> None:
    r = needed.restitution.values
    low, high = 3.0, _HIGHEST
    simple, corrected = (
        np.clip(needed.sel(model=model).values, low, high) for model in ("restitution", "corrected")
    )
    axes.fill_between(r, low, high, color=_RIGHT)
    axes.fill_between(r, low, simple, color=_CORRECTED, linewidth=0)
    axes.fill_between(r, low, np.minimum(simple, corrected), color=_NEITHER, linewidth=0)
    axes.plot(r, simple, color="black", linewidth=0.8)
    if near is not None:
        for model, look in _BESIDE.items():
            axes.plot(r, np.clip(near.sel(model=model).values, low, high), **look)
    axes.set_yscale("log")
    axes.set_ylim(low, high)
    axes.set_xlim(float(r.min()), float(r.max()))


def _legend(axes: Axes, data: xr.Dataset) -> None:
    axes.set_axis_off()
    share = 100 * float(data.position_edge[NEAR])
    handles = [
        Patch(facecolor=_RIGHT, edgecolor="black", linewidth=0.5, label="restitution model"),
        Patch(facecolor=_CORRECTED, label="corrected model"),
        Patch(facecolor=_NEITHER, label="compute the contact"),
        *(
            Line2D([], [], label=f"{model} model, next to the saddle-node", **look)
            for model, look in _BESIDE.items()
        ),
        Line2D([], [], linestyle="none", label=f"(first {share:g} % of the stable range)"),
        Line2D([], [], **GUIDE, label=rf"rule of thumb, $\varpi={float(data.rule_of_thumb):g}$"),
    ]
    axes.legend(handles=handles, loc="center", title="the simplest that is right")
