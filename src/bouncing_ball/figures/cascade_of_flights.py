"""The cascade of flights: openings of the long contact over ϖ, and their limits."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.datasets.selection import each
from bouncing_ball.figures.canvas import WIDE, canvas, coloured, logarithmic
from bouncing_ball.figures.labels import number
from bouncing_ball.figures.style import COLOURS, GUIDE

_DASHES = ("-", (0, (6, 1.5)), (0, (4, 1.5, 1, 1.5)), (0, (2, 1)))
_RATIO = r"frequency ratio $\varpi$"


def cascade_of_flights(data: xr.Dataset) -> Figure:
    """ext_flights: E of the openings over ϖ for the first r, and their limits for all r."""
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
