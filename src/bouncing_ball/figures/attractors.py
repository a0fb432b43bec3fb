"""The motions on which balls end in the three models, side by side on the same axes."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from bouncing_ball.figures.canvas import WIDE, canvas, image, legend_below, logarithmic, stacked
from bouncing_ball.figures.labels import number, parameters
from bouncing_ball.figures.style import COLOURS, GUIDE, MODELS, Look

# The lowest period of each colour for locked motions.
_PERIODS = (1, 2, 3, 4, 5, 9, 17, 33)
_LOCKED = colormaps["viridis_r"](np.linspace(0.08, 1, len(_PERIODS)))
_OTHERS = {
    "orbit": "#ffffff",
    "subharmonic": "#d9d9d9",
    "permanent contact": "#8c8c8c",
    "chaotic": "#f3d3c1",
    "undecided": "#b5b5b5",
}
# Marks that also distinguish areas in greyscale: dots for motions that do not repeat, crosses for
# unknown motions, and strokes for other areas whose grey level is that of a period.
_DOTS: dict[str, Look] = {
    "chaotic": {"marker": ".", "markersize": 1.3, "color": "#AA3A00", "markeredgewidth": 0},
    "undecided": {"marker": "x", "markersize": 1.6, "color": "#000000", "markeredgewidth": 0.3},
    "permanent contact": {"marker": "_", "markersize": 2.5, "markeredgewidth": 0.4},
    "subharmonic": {"marker": "|", "markersize": 2.5, "markeredgewidth": 0.4},
}
# Largest number of restitution coefficients at which nodes are marked.
_MARKED = 43
_UNKNOWN = {"not at any": "#000000", "undecided": "#ffffff", "no number": "#c8c8c8"}
_MEANS = {name: (name, colour, marker) for name, colour, marker in zip(
    ("power", "height", "flights", "exponent"), COLOURS, "osv^", strict=False)}  # fmt: skip
_HATCHES = {"chaotic": "......", "undecided": "xxxx", "subharmonic": "||||||"}
_HATCHES |= dict.fromkeys(("permanent contact", "no number"), "------")
# Exponents outside of this range are drawn as its ends.
_LOWEST, _HIGHEST = -1.5, 1.5
# Colours that become lighter throughout, from blue below 0 to yellow above 0.
_FALLING = colormaps["Blues_r"](np.linspace(0, 0.65, 128))
_GROWING = colormaps["YlOrBr_r"](np.linspace(0.5, 1, 128))
_RATES = ListedColormap([*_FALLING, *_GROWING]).with_extremes(bad=_OTHERS["permanent contact"])
_LOOKS = {"all": ("all nodes", COLOURS[0], "o"), "orbit": ("n-T orbits", COLOURS[4], "s"),
          "locked, 1 to 4 T": ("locked, 1 to 4 T", COLOURS[2], "^"),
          "locked": ("locked", COLOURS[1], "D"),
          "locked, above 10 T": ("locked, above 10 T", COLOURS[3], "v")}  # fmt: skip


def locking(data: xr.Dataset) -> Figure:
    """Period of the locked orbit and largest exponent over (Λ, r) for each model; below, the share
    of nodes on which the contact agrees with each simple model along ϖ.
    """
    figure, (maps, exponents, below) = stacked(8.0, (2.8, 2.8, 2.4))
    kinds = maps.subplots(1, data.sizes["model"], sharex=True, sharey=True)
    rates = exponents.subplots(1, data.sizes["model"], sharex=True, sharey=True)
    ratio = number(float(data.frequency_ratio[0]))
    look: Look = {"cmap": _RATES, "vmin": _LOWEST, "vmax": _HIGHEST}
    for model, upper, lower in zip(data["model"].values, kinds, rates, strict=True):
        one = data.sel(model=model)
        _draw_kinds(upper, one)
        rate = one.lyapunov_exponent.values.clip(_LOWEST)
        shown = _node_map(lower, one, rate, ["permanent contact"], **look)
        upper.set_title(model if model == "restitution" else rf"{model}, $\varpi={ratio}$")
        lower.set_xlabel(r"amplitude $\Lambda$")
    kinds[0].set_ylabel("restitution coefficient $r$")
    rates[0].set_ylabel("restitution coefficient $r$")
    bar: Look = {"location": "bottom", "aspect": 60, "shrink": 0.6, "extend": "both"}
    label = r"largest Lyapunov exponent $\lambda$ per period of the table"
    exponents.colorbar(shown, ax=list(rates), label=label, **bar)
    legend_below(maps, _key(data), ncols=7, fontsize=7)
    title = "contact against the {} model"
    _draw_shares(below, data, "agreement", "motion_group", _LOOKS, title)
    below.axes[0].set_ylabel("share of nodes with the\nsame kind and period")
    return figure


def _draw_kinds(axes: Axes, one: xr.Dataset) -> None:
    place = np.searchsorted(_PERIODS, one.periods.values, side="right") - 1
    for k, kind in enumerate(_OTHERS, len(_PERIODS)):
        place[(one.kind == kind).values] = k
    colours = ListedColormap([*_LOCKED, *_OTHERS.values()])
    _node_map(axes, one, place, _DOTS, cmap=colours, vmin=-0.5, vmax=colours.N - 0.5)


def _node_map(
    axes: Axes, one: xr.Dataset, values: np.ndarray, kinds: Iterable[str], **look: Any
) -> Any:
    """Values at the nodes, with marks for some kinds of motion, and with the saddle-node (solid)
    and period doubling (dashed) of the 1-T orbit over r.
    """
    drawn = _map(axes, one, values, **look)
    for kind in kinds:
        _dot(axes, one, one.kind == kind, _DOTS[kind])
    limits = axes.get_xlim(), axes.get_ylim()
    for name, dashes in (("saddle_node", "-"), ("period_doubling", (0, (3, 1.5)))):
        lam = one[f"{name}_amplitude"]
        axes.plot(lam, one.restitution, color="#000000", linewidth=0.9, linestyle=dashes)
    axes.set(xlim=limits[0], ylim=limits[1])
    return drawn


def _dot(axes: Axes, one: xr.Dataset, chosen: xr.DataArray, look: Look) -> None:
    # On a finer grid only some nodes have marks, which would cover the colours.
    skip = -(-chosen.restitution.size // _MARKED)
    r, lam = skip * np.array(np.nonzero(chosen.values[::skip, ::skip]))
    place = one.amplitude.values[lam], one.restitution.values[r]
    drawn: Look = {"color": "#000000", "linestyle": "none", **look}
    axes.plot(*place, **drawn)


def _map(axes: Axes, one: xr.Dataset, values: np.ndarray, **look: Any) -> Any:
    nodes = one.amplitude.values, one.restitution.values
    (left, right), (low, high) = (1.5 * x[[0, -1]] - 0.5 * x[[1, -2]] for x in nodes)
    return image(axes, values, (left, right, low, high), **look)


def _key(data: xr.Dataset) -> list:
    ends = [*(low - 1 for low in _PERIODS[1:]), None]
    names = [
        f"from {low} T" if end is None else f"{low} T" if low == end else f"{low} to {end} T"
        for low, end in zip(_PERIODS, ends, strict=True)
    ]
    others = [(kind, fill) for kind, fill in _OTHERS.items() if kind in data.kind.values]
    names[0] = f"locked, {names[0]}"
    return _patches([*zip(names, _LOCKED, strict=True), *others])


def _patches(fills: Iterable[tuple[str, Any]]) -> list[Patch]:
    """Entries of a legend for areas, hatched where the areas have dots."""
    look: Look = {"edgecolor": "#000000", "linewidth": 0.4}
    return [Patch(facecolor=x, label=name, hatch=_HATCHES.get(name), **look) for name, x in fills]


def _draw_shares(
    part: Any, data: xr.Dataset, name: str, dim: str, looks: Mapping, title: str
) -> None:
    """Shares along ϖ with confidence intervals, side by side for the places along a dimension.

    There is a panel for each simple model.
    """
    for simple, axes in zip(data.simple.values, part.subplots(1, 2, sharey=True), strict=True):
        for k, (place, (text, colour, marker)) in enumerate(looks.items()):
            one = data.sel({"simple": simple, dim: place})
            ratio = one.frequency_ratio.values * 1.06 ** (k - 2)
            bars(axes, ratio, one, name, color=colour, marker=marker, label=text)
        axes.set(xlabel=r"frequency ratio $\varpi$", title=title.format(simple))
        logarithmic(axes, ylim=(0, 1.03))
    legend_below(part, ncols=len(looks), fontsize=7)


def bars(axes: Axes, place: np.ndarray, data: xr.Dataset, name: str, **look) -> None:
    """A variable at given places, with error bars between its limits ``_low`` and ``_high``."""
    middle, low, high = (data[f"{name}{end}"].values for end in ("", "_low", "_high"))
    look = {"markersize": 4, "linewidth": 0.8, "capsize": 2} | look
    axes.errorbar(place, middle, [middle - low, high - middle], **look)


def mean_motions(data: xr.Dataset) -> Figure:
    """The smallest ϖ from which on a mean of each simple model is right, over (Λ, r); below, the
    share of nodes known to be right from ϖ on.
    """
    ratios, means = data.frequency_ratio.values, data["mean"].values
    figure, (maps, below) = stacked(6.6, (4.4, 2.2))
    rows = maps.subplots(2, len(means), sharex=True, sharey=True)
    fills = [*colormaps["viridis_r"](np.linspace(0, 0.75, len(ratios))), *_UNKNOWN.values()]
    look: Look = {"cmap": ListedColormap(fills), "vmin": -0.5, "vmax": len(fills) - 0.5}
    for simple, row in zip(data.simple.values, rows, strict=True):
        for mean, axes in zip(means, row, strict=True):
            one = data.sel(simple=simple, mean=mean)
            place = np.searchsorted(ratios, one.needed_ratio.fillna(0).values)
            for k, name in enumerate(_UNKNOWN, len(ratios)):
                place[(one.decision == name).values] = k
            _map(axes, one, place, **look)
            for name, marker in {"undecided": "x", "no number": "_"}.items():
                _dot(axes, one, one.decision == name, {"marker": marker, "markersize": 3})
        row[0].set_ylabel(f"{simple} model\n$r$")
    for mean, top, bottom in zip(means, *rows, strict=True):
        top.set_title(mean)
        bottom.set_xlabel(r"amplitude $\Lambda$")
    names = [rf"$\varpi\geq{number(float(ratio))}$" for ratio in ratios]
    handles = _patches(zip([*names, *_UNKNOWN], fills, strict=True))
    legend_below(maps, handles, ncols=5, fontsize=7)
    _draw_shares(below, data, "right", "mean", _MEANS, "{} model")
    below.axes[0].set_ylabel("share of nodes known to be\nright from here on")
    return figure


def orbit_diagrams(data: xr.Dataset) -> Figure:
    """Density of the phases of impact over Λ for each model; below, the largest exponents."""
    models = data["model"].values
    ratios = [1.0] * len(models) + [0.6]
    figure, panels = canvas(WIDE, 8.0, rows=len(ratios), sharex=True, height_ratios=ratios)
    lam = data["amplitude"].values
    # The bins of the phase are all of a period.
    extent = (*(1.5 * lam[[0, -1]] - 0.5 * lam[[1, -2]]), -1.0, 1.0)
    for axes, model, sign in zip(panels, models, "ox+", strict=False):
        one = data.sel(model=model)
        # The square root of the density shows an orbit and a chaotic motion in one picture.
        shade = np.sqrt(one.phase_density.values.T)
        image(axes, shade, extent, cmap="gist_heat_r", vmin=0, vmax=0.5)
        axes.set_ylabel(r"phase of impact $\varphi/\pi$")
        shown = ["restitution"] if model == "restitution" else ["restitution", "frequency_ratio"]
        axes.set_title(f"{model} model; {parameters(data, *shown)}")
        exponent = one.lyapunov_exponent.values.clip(_LOWEST, _HIGHEST)
        # A line through the exponents of chaotic and locked motions in turn would hide them.
        look: Look = MODELS[model] | {"linestyle": "none", "markersize": 2.5}
        panels[-1].plot(lam, exponent, sign, mew=0.6, label=f"{model} model", **look)
    panels[-1].axhline(0, **GUIDE)
    panels[-1].set(xlabel=r"amplitude $\Lambda$", ylabel=r"largest $\lambda$ per $T$")
    legend_below(figure, panels[-1].get_legend_handles_labels()[0], ncols=3)
    return figure
