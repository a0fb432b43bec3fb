"""The charts of the atlas, the ϖ above which each model is accurate, and its table: how often the
rule of thumb holds, and the suprema of the errors.
"""

from collections.abc import Iterator

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from bouncing_ball.datasets.selection import each
from bouncing_ball.drawing.canvas import WIDE, canvas, legend_below
from bouncing_ball.drawing.labels import QUANTITIES
from bouncing_ball.drawing.style import CORRECTED, GUIDE, Look
from bouncing_ball.drawing.tables import TextTable, words

LEVELS = (3, 5, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 200, 500, 1000)
"""Bounds between the colours; the last colour is for larger values."""

_PALEST = 0.12
# The error law is drawn where it is right within this factor: it fails next to the saddle-node.
_LAW_HOLDS = 1.25
_LAW: Look = {"colors": CORRECTED, "linewidths": 1.0, "linestyles": "--"}
NEAR = 1
"""Ranges of positions next to the saddle-node, which the colours of the page do not include."""

_RIGHT, _CORRECTED, _NEITHER = "#ffffff", "#b9d7ea", "#7f7f7f"
_SPAN = 3.0, 1e3
# Neither line is dotted, because the rule of thumb is dotted.
_BESIDE = {"restitution": "--", "corrected": "-."}
_LINE: Look = {"color": "black", "linewidth": 0.8}


def charts(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """All charts with their names: the page, and a map for each quantity but the greatest height,
    whose map is the figure ext_atlas.
    """
    yield "page", page(data)
    for quantity in data["quantity"].drop_sel(quantity="max_height").values:
        yield str(quantity), over_range(data, str(quantity))


def page(data: xr.Dataset, release: str = "displacement") -> Figure:
    """A panel for each quantity with the simplest accurate model over the contacts (r, ϖ).

    A model must be accurate for all families and for all positions in the stable range except those
    nearest to the saddle-node; for these, lines show the ϖ needed.
    """
    figure, grid = canvas(WIDE, 9.2, 4, 2, sharex=True, sharey=True)
    slots = list(grid.flat)
    tolerance = float(data.summary_tolerance)
    one = data.sel({"release": release, "tolerance": tolerance})
    for axes, quantity in zip(slots, data["quantity"].values, strict=False):
        needed = one.needed.sel(quantity=quantity).max("n")
        _draw_simplest(axes, needed.isel(position=slice(NEAR, None)).max("position"))
        near = needed.isel(position=slice(NEAR)).max("position")
        for model, dashes in _BESIDE.items():
            line = near.sel(model=model).clip(*_SPAN)
            axes.plot(near.restitution, line, linestyle=dashes, **_LINE)
        axes.set_title(QUANTITIES[str(quantity)])
    for axes, limit in zip(slots[4:], data.limit_quantity.values, strict=False):
        _draw_simplest(axes, one.limit_needed.sel(limit_quantity=limit).max("n"))
        axes.set_title(QUANTITIES[str(limit)])
    for axes in slots[:-1]:
        axes.axhline(float(data.rule_of_thumb), **GUIDE)
    for axes in slots[-3:-1]:
        axes.set_xlabel("restitution coefficient $r$")
        axes.tick_params(labelbottom=True)
    for axes in slots[::2]:
        axes.set_ylabel(r"frequency ratio $\varpi$")
    _explain_page(slots[-1], data)
    figure.suptitle(
        f"Which model for which contact: errors below {100 * tolerance:g} %, families $n=1$ to "
        f"{int(data.n.max())}, {release} release",
        fontsize=10,
    )
    return figure


def over_range(data: xr.Dataset, quantity: str = "max_height", n: int = 1) -> Figure:
    """The ϖ needed over r and the position of Λ in the stable range, by rule and model.

    The error law's |K|/ε is drawn as lines over the map of the restitution model, at the borders of
    its colours, where it is right within a quarter.
    """
    figure, slots = canvas(WIDE, 5.4, rows=2, columns=2, sharex=True, sharey=True)
    tolerance = float(data.summary_tolerance)
    # The palest bin is darker than paper, and what is not computed is hatched.
    shades = ListedColormap(colormaps["Blues"](np.linspace(_PALEST, 1.0, 256)))
    norm = BoundaryNorm(LEVELS, shades.N, extend="max")
    for row, release in zip(slots, data.release.values, strict=True):
        for axes, model in zip(row, _BESIDE, strict=True):
            part = data.sel(n=n, quantity=quantity, release=release, model=model)
            edges = part.restitution_edge, part.position_edge
            needed = part.needed.transpose("position", "restitution").clip(LEVELS[0], 1e6)
            mesh = axes.pcolormesh(*edges, needed, cmap=shades, norm=norm, rasterized=True)
            axes.patch.set(facecolor="white", edgecolor=GUIDE["color"], hatch="////", linewidth=0)
            axes.set(xlabel="restitution coefficient $r$", ylabel="position in the range")
            axes.label_outer()
            axes.set_title(f"{model} model, {release}", fontsize=8)
        law = data.law_coefficient.sel(n=n, quantity=quantity, release=release) / tolerance
        middle = (data.position_edge[1:].values + data.position_edge[:-1].values) / 2
        simple = data.needed.sel(n=n, quantity=quantity, release=release, model="restitution")
        ratio = np.maximum(law / simple, simple / law)
        # From the period doubling down; next to the saddle-node it may be right by chance.
        right = (ratio <= _LAW_HOLDS).astype(int).sortby("position", ascending=False)
        holds = right.cumprod("position").sortby("position") > 0
        shown = law.where(holds).transpose("position", "restitution")
        if shown.notnull().any():
            row[0].contour(data.restitution, middle, shown, levels=LEVELS, **_LAW)
    bar = figure.colorbar(mesh, ax=slots, ticks=LEVELS, format="%g", pad=0.02, shrink=0.8)
    bar.set_label(rf"$\varpi$ from which the error is below {100 * tolerance:g} %")
    figure.suptitle(rf"{QUANTITIES[quantity]}: how stiff a contact must be, $n={n}$", fontsize=10)
    line = Line2D([], [], color=CORRECTED, linestyle="--", linewidth=1.0)
    absent = Patch(facecolor="white", edgecolor=GUIDE["color"], hatch="////")
    name = (
        r"error law, $|K|/\varepsilon$ at the borders of the colours, where it is within a quarter"
    )
    legend_below(figure, [line, absent], labels=[name, "not computed"])
    return figure


def _draw_simplest(axes: Axes, needed: xr.DataArray) -> None:
    """The regions of (r, ϖ) in which the restitution or the corrected model is accurate."""
    r = needed.restitution.values
    low, _ = _SPAN
    simple, corrected = (needed.sel(model=model).clip(*_SPAN).values for model in _BESIDE)
    axes.set_facecolor(_RIGHT)
    axes.fill_between(r, low, simple, color=_CORRECTED, linewidth=0)
    axes.fill_between(r, low, np.minimum(simple, corrected), color=_NEITHER, linewidth=0)
    axes.plot(r, simple, **_LINE)
    axes.set(yscale="log", ylim=_SPAN, xlim=(r.min(), r.max()))


def _explain_page(axes: Axes, data: xr.Dataset) -> None:
    axes.set_axis_off()
    share = 100 * float(data.position_edge[NEAR])
    fills = {"restitution model": _RIGHT, "corrected model": _CORRECTED}
    for name, fill in {**fills, "compute the contact": _NEITHER}.items():
        axes.fill_between([], [], facecolor=fill, edgecolor="black", linewidth=0.5, label=name)
    for model, dashes in _BESIDE.items():
        name = f"{model} model, first {share:g} % of the stable range"
        axes.plot([], [], linestyle=dashes, label=name, **_LINE)
    axes.plot([], [], label=rf"rule of thumb, $\varpi={float(data.rule_of_thumb):g}$", **GUIDE)
    axes.legend(loc="center", title="the simplest that is right")


def shares(data: xr.Dataset) -> TextTable:
    """Accuracy of the models on all nodes, by release rule and quantity; header and rows.

    Shares refer to nodes, so that a limit of the families has no share; suprema refer to all
    orbits.
    """
    rule = float(data.rule_of_thumb)
    tolerance = float(data.summary_tolerance)
    header = [
        "release",
        "quantity",
        f"nodes right from ϖ = {rule:g} on",
        f"ϖ for {100 * tolerance:g} %: half of the nodes",
        "99 % of the nodes",
        f"supremum of the error at ϖ = {rule:g}",
        f"ϖ for {100 * tolerance:g} %: all orbits",
        "all orbits, corrected model",
    ]
    body = []
    at = data.sel({"tolerance": tolerance})  # the keyword is another argument of sel
    # Without a threshold, an error is tolerated at every ϖ, or at no ϖ if it is not at the rule's.
    never = at.supremum_needed.isnull() & (at.supremum > tolerance)
    at = at.assign(supremum_needed=at.supremum_needed.where(~never, np.inf))
    for one in each(at.sel(frequency_ratio=rule), "release"):
        for part in each(one.max("n"), "supremum_quantity"):
            name = part.supremum_quantity.item()
            nodes = ["", "", ""]
            if name in one["quantity"]:
                simple = one.sel(model="restitution", quantity=name)
                most = [simple.needed_quantile.sel(share=share).max() for share in (0.5, 0.99)]
                # The mean of the shares is that of all nodes, because every n has equally many.
                nodes = [f"{100 * float(simple.holding_share.mean()):.2f} %", *map(_ratio, most)]
            error = 100 * float(part.supremum[0])
            largest = f"{error:.3g} %" if np.isfinite(error) else "unbounded"
            every = map(_ratio, part.supremum_needed.values)
            body.append([one.release.item(), words(name), *nodes, largest, *every])
    return header, body


def _ratio(value: float | xr.DataArray) -> str:
    """A frequency ratio, rounded up so that the contact is stiff enough."""
    number = float(value)
    if not np.isfinite(number):
        return "none"
    unit = 10.0 ** (np.floor(np.log10(number)) - 1)
    return f"{np.ceil(number / unit * (1 - 1e-12)) * unit:g}"
