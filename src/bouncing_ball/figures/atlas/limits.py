"""The ϖ needed for the limits of a family: saddle-node, period doubling, permanent contact."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.figures.canvas import WIDE, canvas
from bouncing_ball.figures.style import COLOURS, GUIDE, QUANTITIES, Look

_LOOK: dict[str, Look] = {
    "restitution": {"linestyle": "-", "linewidth": 1.2},
    "corrected": {"linestyle": (0, (4, 1.5)), "linewidth": 1.2},
}
_LAW: Look = {"linestyle": ":", "linewidth": 1.0}
_SHOWN = 3
"""Families, spread over those of the atlas."""
# Three levels of grey.
_BY_FAMILY = (COLOURS[0], COLOURS[3], COLOURS[4])


def draw(data: xr.Dataset) -> Figure:
    """Panels for the rules and the limits: ϖ over r, line by model and colour by n."""
    figure, panels = canvas(WIDE, 5.0, rows=2, columns=3, sharex=True, sharey=True)
    families = data.n.values[np.linspace(0, data.sizes["n"] - 1, _SHOWN).round().astype(int)]
    for line, release in zip(panels, data.release.values, strict=True):
        for axes, quantity in zip(line, data.limit_quantity.values, strict=True):
            part = data.sel(release=release, limit_quantity=quantity)
            _panel(axes, part, families)
            axes.set_title(f"{QUANTITIES[str(quantity)]}, {release}", fontsize=8)
    for axes in panels[-1]:
        axes.set_xlabel("restitution coefficient $r$")
    for axes in panels[:, 0]:
        percent = 100 * float(data.summary_tolerance)
        axes.set_ylabel(rf"$\varpi$ for {percent:g} %")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=_SHOWN)
    figure.suptitle("limits of the families: how stiff a contact must be", fontsize=10)
    return figure


def _panel(axes: Axes, part: xr.Dataset, families: np.ndarray) -> None:
    tolerance, smallest = float(part.summary_tolerance), float(part.limit_needed.min())
    for n, colour in zip(families, _BY_FAMILY, strict=False):
        own = part.sel(n=n)
        for model, look in _LOOK.items():
            found = own.limit_needed.sel({"model": model, "tolerance": tolerance})
            axes.plot(part.restitution, found, color=colour, label=f"{model}, $n={n}$", **look)
        law = np.maximum(own.limit_law_needed, smallest)
        axes.plot(
            part.restitution, law, color=colour, label=rf"law $|K|/\varepsilon$, $n={n}$", **_LAW
        )
    axes.axhline(float(part.rule_of_thumb), **GUIDE)
    axes.set_yscale("log")
