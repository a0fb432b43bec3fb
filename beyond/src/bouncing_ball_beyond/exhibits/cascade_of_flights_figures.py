"""The openings of stiff contacts, and the ratios of successive ones."""

from itertools import cycle

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball_beyond.inherited.drawing.canvas import WIDE, canvas, coloured
from bouncing_ball_beyond.inherited.drawing.labels import number_label
from bouncing_ball_beyond.inherited.drawing.style import GUIDE, Look

_MARKS = ("v", "o", "s", "D", "^")


def cascade_of_flights(data: xr.Dataset) -> Figure:
    """ext_flights: the limits of the openings by r, and r² times the ratios of successive ones."""
    figure, (left, right) = canvas(WIDE, 3.0, columns=2)
    by_restitution = coloured(data.sortby("restitution"), "restitution")
    for (one, colour), mark in zip(by_restitution, cycle(_MARKS), strict=False):
        name = number_label(float(one.restitution))
        look: Look = {"color": colour, "marker": mark, "markersize": 3.5, "linewidth": 0.9}
        left.plot(one.flights, one.stiff_opening, label=name, **look)
        right.plot(one.opening, one.stiff_opening_ratio, label=name, **look)
    left.set(yscale="log", xlabel="opening $k$", xticks=data.flights.values)
    left.set_ylabel(r"$E_k$, limit of $\varpi^2\,(\Lambda_k-\Lambda_{SD})$ for $\varpi\to\infty$")
    left.set(title="from $k$ to $k+1$ flights in a period")
    right.axhline(1, **GUIDE)
    right.set(xlabel="opening $k$", ylabel=r"$r^2 E_{k+1}/E_k$", xticks=data.opening.values)
    right.set(title="ratios of the limits; dotted: 1")
    right.legend(loc="upper right", title="$r$")
    return figure
