"""The openings of the long contact in the cascade of flights, and the shift of the cascades of
period doublings by the contact, with the errors of both simple models.
"""

from itertools import cycle

import numpy as np
import scipy
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.datasets.selection import each
from bouncing_ball.drawing.canvas import WIDE, canvas, coloured, legend_below, logarithmic
from bouncing_ball.drawing.labels import number_label, parameters
from bouncing_ball.drawing.style import COLOURS, GUIDE, MODELS, Look
from bouncing_ball.drawing.thresholds import with_zeros

_MARKS = ("v", "o", "s", "D", "^")
_OTHER_RELEASE = "openings are computed for\nthe displacement release only"
_RATIO = r"frequency ratio $\varpi$"


def cascade_of_flights(data: xr.Dataset) -> Figure:
    """ext_flights: E of the openings over ϖ for the first r, and ratios of their limits by r."""
    figure, (left, right) = canvas(WIDE, 3.2, columns=2)
    shown = data.isel(restitution=0)
    ratio = data.frequency_ratio.values
    for one, colour in zip(each(shown, "flights"), COLOURS, strict=False):
        k = int(one.flights)
        name = rf"from {k} to {k + 1}, $E_{k}$"
        # Dots, because the openings of compliant contacts undulate and jump.
        look: Look = {"color": colour, "marker": _MARKS[k % len(_MARKS)], "markersize": 1.8}
        left.plot(ratio, one.opening_excess, label=name, linestyle="none", **look)
        # Beside the axes, where no dots hide them.
        limit: Look = {"marker": "<", "markersize": 4, "color": colour, "clip_on": False}
        left.plot(1.02, one.stiff_opening, transform=left.get_yaxis_transform(), **limit)
    ylabel = r"$E=\varpi^2\,(\Lambda-\Lambda_{SD})$"
    title = rf"flights in a period, $r={number_label(float(shown.restitution))}$"
    logarithmic(left, xlabel=_RATIO, yscale="log", ylabel=ylabel, title=title)
    if shown.opening_excess.notnull().any():
        left.legend(loc="upper left", markerscale=2)
    else:
        _say(left, "no opening was found here" if _is_sought(data) else _OTHER_RELEASE)
        left.set_xlim(ratio[0], ratio[-1])
    by_restitution = coloured(data.sortby("restitution"), "restitution")
    for (one, colour), mark in zip(by_restitution, cycle(_MARKS), strict=False):
        name = number_label(float(one.restitution))
        look = {"color": colour, "marker": mark, "markersize": 3.5, "linewidth": 0.9}
        right.plot(one.opening, one.stiff_opening_ratio, label=name, **look)
    right.axhline(1, **GUIDE)
    right.set(xlabel="opening $k$", ylabel=r"$r^2 E_{k+1}/E_k$ for $\varpi\to\infty$")
    right.set(xticks=data.opening.values, title="ratios of the limits; dotted: 1")
    if _is_sought(data):
        right.legend(loc="upper right", title="$r$")
    else:
        # A logarithmic axis without a number cannot be drawn.
        left.set(yscale="linear", yticks=[])
        right.set(yticks=[])
        _say(right, _OTHER_RELEASE)
        right.set_xlim(data.flights.values[[0, -1]])
    return figure


def _say(axes: Axes, words: str) -> None:
    """Words in place of curves."""
    axes.text(0.5, 0.5, words, transform=axes.transAxes, ha="center", va="center")


def _is_sought(data: xr.Dataset) -> bool:
    """Whether the openings are those of the release for which they are computed."""
    return bool(np.any(np.isfinite(data.stiff_opening)))


_FINE = 400
_CASCADE_DASHES = ("-", (0, (6, 1.5)), (0, (4, 1.5, 1, 1.5)), (0, (2, 1)), (0, (1, 1.5)))


def cascades(data: xr.Dataset) -> Figure:
    """Errors of both models at each doubling along ϖ; K over the doublings for each r."""
    figure, (errors, law) = canvas(WIDE, 3.2, columns=2)
    shown = data.isel(restitution=data.sizes["restitution"] // 2)
    ratio = data.frequency_ratio.values
    lines = []
    for order, model in enumerate(data["model"].values, 1):
        one = shown.cascade_error.sel(model=model)
        look = MODELS[model] | {"linewidth": 0.9}
        for k in range(one.sizes["doubling"]):
            curve = one.isel(doubling=k).values
            zero = float(shown.cascade_zero[k]) if model == "restitution" else np.nan
            errors.plot(ratio, np.abs(curve), ".", color=look["color"], markersize=3)
            line = errors.plot(*_between(ratio, curve, zero), **look)
        lines += line
        if model == "restitution":
            _name_lines(errors, ratio[-1], np.abs(one.isel(frequency_ratio=-1).values))
        guide = abs(float(one.isel(doubling=-1, frequency_ratio=-1))) * (ratio[-1] / ratio) ** order
        errors.plot(ratio, guide, **GUIDE)
    logarithmic(errors, xlabel=r"frequency ratio $\varpi$", yscale="log", ylim=(1e-8, 1))
    errors.set_ylabel(r"relative error of $\Lambda$ at the period doublings")
    chosen = rf"{parameters(data, 'n')}, $r$ = {float(shown.restitution):g}"
    errors.set_title(f"{chosen}; dots: computed; dotted: slopes 1, 2")
    for r, colour, dashes in zip(data.restitution.values, COLOURS, _CASCADE_DASHES, strict=False):
        one = data.cascade_coefficient.sel(restitution=r)
        name = rf"$r$ = {r:g}"
        law.plot(data.doubling, one, "o", color=colour, linestyle=dashes, markersize=3, label=name)
    law.axhline(0, color="#8c8c8c", linewidth=0.6)
    law.set(xlabel=r"$m$ of the orbit of $2^m$ impacts", ylabel=r"$K_m$ of the error $K_m/\varpi$")
    law.set(title="$K_m$ changes less and less with $m$", xticks=data.doubling)
    law.legend(loc="best")
    legend_below(figure, lines, labels=[f"{x} model" for x in data["model"].values], ncols=2)
    return figure


# Lines whose errors differ by a smaller factor have one name together.
_APART = 1.25


def _name_lines(axes: Axes, end: float, error: np.ndarray) -> None:
    """The numbers m of lines at their ends, where neighbours that nearly coincide have one name."""
    jumps = np.abs(np.diff(np.log(error))) > np.log(_APART)
    groups = np.split(np.arange(error.size), np.flatnonzero(jumps) + 1)
    for group in groups:
        first, last = group[[0, -1]]
        name = str(first) if first == last else f"{first} to {last}"
        look: Look = {"ha": "left", "va": "top" if group is groups[-1] else "bottom", "fontsize": 6}
        axes.text(1.1 * end, error[first], f"$m=${name}" if first == 0 else name, **look)


def _between(ratio: np.ndarray, error: np.ndarray, zero: float) -> tuple[np.ndarray, np.ndarray]:
    """ϖ and the size of a signed error between its samples, of which its zero is one.

    ϖ times the error, which tends to a constant for stiff contacts, is interpolated.
    """
    ratio = np.append(ratio, zero)
    scaled = np.append(ratio[:-1] * error, 0.0)
    known = np.flatnonzero(np.isfinite(ratio) & np.isfinite(scaled))
    known = known[np.argsort(ratio[known])]
    if known.size < 2:
        # Nothing lies between samples; their dots are drawn.
        return np.empty(0), np.empty(0)
    place = np.log(ratio[known])
    fine = np.linspace(place[0], place[-1], _FINE)
    curve = scipy.interpolate.PchipInterpolator(place, scaled[known])(fine)
    return with_zeros(np.exp(fine), curve / np.exp(fine), zero)
