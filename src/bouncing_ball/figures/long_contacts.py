"""Permanent contact and the orbits with a long contact: cascade of flights and basins."""

import numpy as np
import xarray as xr
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from bouncing_ball.datasets.selection import each
from bouncing_ball.figures.canvas import WIDE, canvas, coloured, legend_below, logarithmic
from bouncing_ball.figures.labels import number
from bouncing_ball.figures.style import COLOURS, GUIDE, Look

# Colours in the order of the motions; they are five steps of grey.
_FILLS = ("#ffffff", "#b9d7ea", "#b34a10", "#e0a030", "#000000")
_DASHES = ("-", (0, (6, 1.5)), (0, (4, 1.5, 1, 1.5)), (0, (2, 1)))
_RATIO = r"frequency ratio $\varpi$"
_ORBITS = {1: "o", 2: "^"}


def cascade_of_flights(data: xr.Dataset) -> Figure:
    """ext_rattling: E of the openings over ϖ for the first r, and their limits for all r."""
    figure, (left, right) = canvas(WIDE, 3.2, columns=2)
    shown, ratio = data.isel(restitution=0), data.frequency_ratio.values
    excess = ratio**2 * (shown.opening_amplitude - shown.threshold_amplitude)
    for one, line, colour in zip(each(shown, "flights"), excess, COLOURS, strict=False):
        k = int(one.flights)
        name = rf"from {k} to {k + 1}, $E_{k}$"
        left.plot(ratio, line, color=colour, linestyle=_DASHES[k % 4], label=name)
        left.plot(ratio[-1], one.stiff_opening, marker=5, color=colour, clip_on=False)
    ylabel = r"$E=\varpi^2\,(\Lambda-\Lambda_{SD})$"
    title = rf"flights in a period, $r={number(float(shown.restitution))}$"
    logarithmic(left, xlabel=_RATIO, yscale="log", ylabel=ylabel, title=title)
    left.legend(loc="upper left")
    for one, colour in coloured(data.sortby("restitution"), "restitution"):
        r, limits = float(one.restitution), one.stiff_opening.values
        right.plot(data.flights, limits, "o-", color=colour, markersize=3, label=number(r))
        right.plot(data.flights, limits[-1] * r ** (2 * (data.flights[-1] - data.flights)), **GUIDE)
    right.set(yscale="log", xlabel="opening $k$", ylabel=r"$E_k$ for $\varpi\to\infty$")
    right.set(xticks=data.flights.values, title=r"limits; dotted: $E_{k+1}/E_k=1/r^2$")
    right.legend(loc="upper left", title="$r$, from above")
    return figure


def basins(data: xr.Dataset) -> Figure:
    """ext_basins: a panel for each Λ, in which each start has the colour of the motion it
    leads to.
    """
    figure, row = canvas(WIDE, 3.1, columns=data.sizes["case"], sharey=True, squeeze=False)
    image: Look = {"origin": "lower", "aspect": "auto", "interpolation": "none"}
    image |= {"extent": (-1.0, 1.0, 0.0, data.attrs["velocity_max"])}
    image |= {"cmap": ListedColormap(_FILLS), "vmin": -0.5, "vmax": len(_FILLS) - 0.5}
    for one, axes in zip(each(data, "case"), row[0], strict=True):
        axes.imshow(one.destination, **image)
        for k, mark in _ORBITS.items():
            at = one.orbit_phase[k] / np.pi, one.orbit_speed[k]
            axes.plot(*at, mark, color="#000000", markerfacecolor="#ffffff", markersize=5)
        # The variable, not the attribute of this name, which is a list.
        amplitude = number(float(one["amplitude"]))
        axes.set(title=rf"$\Lambda={amplitude}$", xlabel=r"phase of impact $\varphi/\pi$")
        axes.spines[["top", "right"]].set_visible(True)
    row[0, 0].set_ylabel(r"relative speed of impact $-\delta′$")
    handles = [
        Patch(facecolor=fill, edgecolor="#000000", linewidth=0.5, label=str(motion))
        for fill, motion in zip(_FILLS, data.motion.values, strict=True)
    ]
    legend_below(figure, handles, ncols=len(handles), fontsize=7)
    return figure
