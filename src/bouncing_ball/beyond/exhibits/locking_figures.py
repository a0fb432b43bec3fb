"""The motions on which balls end in two models, side by side on the same axes."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from bouncing_ball.beyond.exhibits.motion_maps import (
    DOTS,
    HIGHEST_RATE,
    LOCKED,
    LOWEST_RATE,
    OTHER_COLOURS,
    PERIODS,
    RATES,
    curves_of_bifurcations,
    kinds_shown,
    legend_of_kinds,
    node_map,
    stacked_shares,
)
from bouncing_ball.drawing.canvas import legend_below, stacked
from bouncing_ball.drawing.labels import number_label
from bouncing_ball.drawing.style import Look

# The corrected model's maps look like those of the restitution model; its shares are below.
_SHOWN = ("restitution", "spring-damper")
_GROUPS = {
    "orbit": "orbits",
    "locked, 1 to 4 T": "locked,\n1 to 4 T",
    "locked, above 10 T": "locked,\nabove 10 T",
    "all": "all nodes",
}


def locking(data: xr.Dataset) -> Figure:
    """Period of the locked orbit and largest exponent over (Λ, r) for the restitution model and for
    the contact; below, the shares of nodes on which the contact agrees with each simple model.
    """
    data = data.assign(kind=kinds_shown(data))
    figure, (maps, exponents, below) = stacked(9.5, (3.6, 3.4, 2.5))
    kinds = maps.subplots(1, len(_SHOWN), sharex=True, sharey=True)
    rates = exponents.subplots(1, len(_SHOWN), sharex=True, sharey=True)
    ratio = number_label(float(data.frequency_ratio[0]))
    look: Look = {"cmap": RATES, "vmin": LOWEST_RATE, "vmax": HIGHEST_RATE}
    for model, upper, lower in zip(_SHOWN, kinds, rates, strict=True):
        one = data.sel(model=model)
        _draw_kinds(upper, one)
        # The colour bar has a pointed end for all exponents beyond, which include -∞.
        rate = one.lyapunov_exponent.values.clip(LOWEST_RATE)
        shown = node_map(lower, one, rate, ["permanent contact"], **look)
        upper.set_title(model if model == "restitution" else rf"{model}, $\varpi={ratio}$")
        upper.set_xlabel(r"amplitude $\Lambda$")
        lower.set_xlabel(r"amplitude $\Lambda$")
    kinds[0].set_ylabel("restitution coefficient $r$")
    rates[0].set_ylabel("restitution coefficient $r$")
    bar: Look = {"location": "bottom", "aspect": 60, "shrink": 0.6, "extend": "both"}
    label = r"largest Lyapunov exponent $\lambda$ per $T$; grey: permanent contact"
    exponents.colorbar(shown, ax=list(rates), label=label, **bar)
    legend_below(maps, [*legend_of_kinds(data), *curves_of_bifurcations()], ncols=5, fontsize=7)
    stacked_shares(below, data, _GROUPS, "contact against the {} model")
    below.axes[0].set_ylabel("share of nodes")
    return figure


def _draw_kinds(axes: Axes, one: xr.Dataset) -> None:
    place = np.searchsorted(PERIODS, one.periods.values, side="right") - 1
    for k, kind in enumerate(OTHER_COLOURS, len(PERIODS)):
        place[(one.kind == kind).values] = k
    colours = ListedColormap([*LOCKED, *OTHER_COLOURS.values()])
    node_map(axes, one, place, DOTS, cmap=colours, vmin=-0.5, vmax=colours.N - 0.5)
