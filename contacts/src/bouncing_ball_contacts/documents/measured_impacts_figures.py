"""Measured restitution coefficients over the speed with the laws, and the verdicts."""

from collections.abc import Iterable

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball_beyond.drawing.laws_and_models import LAW_NAMES, LAWS, law_name
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.datasets.selection import each
from bouncing_ball_beyond.inherited.drawing.canvas import WIDE, canvas, legend_below
from bouncing_ball_beyond.inherited.drawing.style import COLOURS, Look
from bouncing_ball_beyond.inherited.drawing.tables import (
    Column,
    Columns,
    TextTable,
    at,
    text,
    text_table,
    value,
    words,
)

# Laws with the same r(v) have one line: all with a constant r, and both of Hunt and Crossley.
_DRAWN: dict[str, tuple[str, Look]] = {
    "restitution": ("constant r, of both models of the paper", LAWS["linear"]),
    "kuwabara-kono": (LAW_NAMES["kuwabara-kono"], LAWS["kuwabara-kono"]),
    "hunt-crossley": (LAW_NAMES["hunt-crossley"], LAWS["hunt-crossley"]),
}
# The law of a constant r(v) where a law of force is needed.
_CONSTANT = "linear"
# Below this a probability is only bounded.
_LEAST = 1e-3
_POINTS: Look = {
    "marker": "o",
    "markersize": 3.6,
    "markeredgewidth": 0.9,
    "linestyle": "none",
    "color": COLOURS[0],
    "zorder": 4,
}
# Full points have the uncertainties of the experiment, and open ones those of a scatter.
_GIVEN: Look = {"label": "measured, with the uncertainties of the experiment", "elinewidth": 0.9}
_BY_SCATTER: Look = {
    "label": "measured, with the scatter about a smooth curve",
    "markerfacecolor": "white",
    "elinewidth": 0.5,
    "capsize": 1.6,
    "capthick": 0.5,
}
_COLUMNS = 3
# Ticks of panels whose speeds differ by more and by less than the factor of _WIDE_RANGE.
_WIDE_RANGE = 5
_FEW_TICKS = (0.1, 0.2, 0.5, 1, 2, 5)
_MANY_TICKS = (0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1, 1.5, 2, 3, 5)


def measured_impacts(data: xr.Dataset) -> Figure:
    """A panel for each experiment with several speeds."""
    several = _with_several_speeds(data)
    if not several.sizes["experiment"]:
        figure, axes = canvas()
        axes.text(0.5, 0.5, "no experiment has several speeds", ha="center", va="center")
        axes.axis("off")
        return figure
    rows = -(-several.sizes["experiment"] // _COLUMNS)
    figure, axes = canvas(WIDE, 2.0 * rows + 0.6, rows=rows, columns=_COLUMNS, squeeze=False)
    count = several.sizes["experiment"]
    for empty in axes.flat[count:]:
        empty.axis("off")
    for panel, one in zip(axes.flat, each(several, "experiment"), strict=False):
        _panel(panel, one)
    for row in axes:
        row[0].set_ylabel("restitution $e$, $r(v)$")
    for lowest in axes.flat[max(count - _COLUMNS, 0) : count]:
        lowest.set_xlabel("impact speed in m/s")
    legend_below(figure, _handles(axes.flat[:count]), ncols=2)
    return figure


def _handles(panels: Iterable[Axes]) -> list[Artist]:
    """A handle for each label of the panels, in the order in which the labels appear."""
    found: dict[str, Artist] = {}
    for panel in panels:
        handles, labels = panel.get_legend_handles_labels()
        found = dict(zip(labels, handles, strict=True)) | found
    return sorted(found.values(), key=lambda each: str(each.get_label()).startswith("measured"))


def _panel(axes: Axes, one: xr.Dataset) -> None:
    for law, (name, look) in _DRAWN.items():
        fitted = one.sel(fitted_law=law)
        axes.plot(one.curve_speed, fitted.fitted_restitution, label=name, linewidth=1.2, **look)
        axes.fill_between(
            one.curve_speed,
            fitted.fitted_low,
            fitted.fitted_high,
            color=look["color"],
            alpha=0.13,
            linewidth=0,
        )
    is_given = bool(one.errors_given)
    axes.errorbar(
        one.measured_speed,
        one.experiment_restitution,
        yerr=one.measured_uncertainty if is_given else one.measured_scatter,
        **_POINTS,
        **(_GIVEN if is_given else _BY_SCATTER),
    )
    axes.set(xscale="log", title=one.experiment_title.item())
    slowest = float(one.curve_speed[0])
    fastest = float(one.curve_speed[-1])
    places = _FEW_TICKS if fastest > _WIDE_RANGE * slowest else _MANY_TICKS
    ticks = [tick for tick in places if slowest <= tick <= fastest]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xticks([], minor=True)
    axes.set_xlim(slowest, fastest)
    # The scale is that of the points; the worst law may leave the panel.
    low = float(one.experiment_restitution.min())
    high = float(one.experiment_restitution.max())
    room = 0.7 * (high - low)
    axes.set_ylim(low - room, high + room)


def _with_several_speeds(data: xr.Dataset) -> xr.Dataset:
    """The experiments that can tell one law from another."""
    count = data.measured_speed.count("measured_impact")
    return data.isel(experiment=np.flatnonzero(count > 1))


def measured_table(data: xr.Dataset) -> TextTable:
    """The verdict on each law and experiment of several speeds, with the errors of its predictions.

    A single impact is met by every law.
    """
    columns: Columns = {
        "experiment": text("experiment_title"),
        "impacts": lambda part: str(int(part.measured_speed.count())),
        "errors": lambda part: "given" if part.errors_given.item() else "scatter",
        "size": value("errors_size", "z.4f"),
        "law": law_name("fitted_law"),
        "verdict": text("law_verdict"),
        "needed": value("errors_needed", "z.4f"),
        "rms": value("fit_rms", "z.4f"),
        "left out": value("left_out_rms", "z.4f"),
        "p": _probability("left_out_probability"),
        "extrapolated": value("extrapolation_rms", "z.4f"),
        "p of it": _probability("extrapolation_probability"),
    }
    shown = _with_several_speeds(data).sel(fitted_law=list(_DRAWN))
    return text_table(each(shown, "experiment", "fitted_law"), columns)


def _probability(name: str) -> Column:
    """A column of probabilities, in which the smallest are only bounded."""
    shown = value(name, ".2g")
    return lambda part: f"< {_LEAST:g}" if float(part[name]) < _LEAST else shown(part)


def shaker_table(data: xr.Dataset) -> TextTable:
    """The balls of the experiments on shakers, and the errors of the restitution model there.

    A ball has no rows if nothing can be said of its errors: its r is constant and its contact time
    is not known.

    The columns of the first family have the errors by the duration, and that of the period doubling
    by the constant r, which has no other error there; those of the other families have the errors
    by this constant r.
    """
    first, *others = data.n.values
    columns: Columns = {
        "experiment": text("experiment_title"),
        "Hz": value("shaker_frequency", "g"),
        "law": law_name("shaker_law"),
        **_orbits(first),
        "ϖ": at(value("shaker_ratio", ".3g"), n=first),
        "η": at(value("shaker_small", ".2g"), n=first),
    }
    for quantity in data["quantity"].values:
        columns[f"{words(quantity)}, by the duration"] = _by_duration(quantity, first)
    doubling = Quantity.PERIOD_DOUBLING
    columns[f"{words(doubling)}, by the constant r"] = _error("by_constant", doubling, first)
    for n in others:
        columns |= _orbits(n)
        for quantity in data["quantity"].values:
            name = f"{words(quantity)}, n = {n}, by the constant r"
            columns[name] = _error("by_constant", quantity, n)
    varies = data.shaker_law != _CONSTANT
    timed = data.shaker_ratio.notnull().any(["n", "shaker_frequency"])
    shown = data.isel(experiment=np.flatnonzero(varies | timed))
    return text_table(each(shown, "experiment", "shaker_frequency"), columns)


def _orbits(n: int) -> Columns:
    """The columns of the impact speed of n-T orbits, whether it was measured, and r(v)."""
    return {
        f"v in m/s, n = {n}": at(value("shaker_speed", ".3g"), n=n),
        f"measured, n = {n}": lambda part: "yes" if part.shaker_within.sel(n=n).item() else "no",
        f"r(v), n = {n}": at(value("shaker_restitution", ".4f"), n=n),
    }


def _error(name: str, quantity: str, n: int) -> Column:
    return at(value(name, "+z.4f"), quantity=quantity, n=n)


def _by_duration(quantity: str, n: int) -> Column:
    """The errors by the error law, empty for contacts that are too compliant for it."""
    column = _error("by_duration", quantity, n)

    def where_useful(part: xr.Dataset) -> str:
        return column(part) if part.shaker_small.sel(n=n) <= part.useful_below else "–"

    return where_useful
