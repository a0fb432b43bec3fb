"""Errors of the restitution and of the corrected model, quantity by quantity.

The errors are drawn for linear contacts (ext_orders), for contacts of other laws (ext_laws) and
together with those of physics engines (ext_engines).
"""

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.datasets.selection import each
from bouncing_ball.figures.canvas import WIDE, canvas, legend_below, logarithmic
from bouncing_ball.figures.labels import QUANTITIES, number, parameters
from bouncing_ball.figures.style import COLOURS, GUIDE, LAWS, MODELS, Look

_IMPLICIT: Look = {"color": COLOURS[2], "linestyle": (0, (6, 1.5, 1, 1.5))}
# Dashes distinguish the schemes of time stepping, and markers the engines.
_SCHEMES: dict[str, Look] = {
    "semi-implicit Euler": {"color": COLOURS[1], "linewidth": 1.3},
    "implicit Euler": _IMPLICIT | {"linewidth": 0.6},
    "compensated implicit Euler": _IMPLICIT | {"linewidth": 1.3},
}
_ENGINES = "osxD"
_MARKED: Look = {"linestyle": "none", "color": "black", "markerfacecolor": "none", "markersize": 4}


def orders(data: xr.Dataset) -> Figure:
    """ext_orders: errors of both models along ϖ, with the slopes 1 and 2."""
    figure, axes_of = _by_quantity(data, 4.2, r"frequency ratio $\varpi$")
    ratio = data.frequency_ratio.values
    for quantity, axes in axes_of.items():
        for order, model in enumerate(data["model"].values, 1):
            part, look = data.sel(model=model, quantity=quantity), MODELS[model]
            error = part.relative_error.values
            axes.plot(ratio, error, label=model, **look)
            # A guide with this slope through the last point.
            axes.plot(ratio, error[-1] * (ratio[-1] / ratio) ** order, **GUIDE)
            name = f"order {float(part.order.median()):.2f}"
            place: Look = {"transform": axes.transAxes, "ha": "right", "va": "top"}
            axes.text(0.97, 1.04 - 0.11 * order, name, color=look["color"], fontsize=8, **place)
        logarithmic(axes, yscale="log", xlim=(ratio[0], ratio[-1]), ylim=(1e-9, 3.0))
    figure.suptitle(
        f"{parameters(data, 'n', 'restitution', 'amplitude')}; orders of "
        f"{data.sizes['sample']} random orbits, median"
    )
    legend_below(figure, ncols=2)
    return figure


def contact_laws(data: xr.Dataset) -> Figure:
    """ext_laws: errors of both models for five laws, over D + κ as a share of the cycle."""
    figure, axes_of = _by_quantity(data, 5.0, r"share of the cycle, $(D+\kappa)/(2\pi n)$")
    share = 1 / (2 * data.attrs["n"] * data.centroid_ratio.values)
    for quantity, axes in axes_of.items():
        for law in data["law"].values:
            errors = data.relative_error.sel(law=law, quantity=quantity)
            axes.plot(share, errors.transpose(..., "model"), linewidth=1.1, **LAWS[law])
        for slope in (1, 2):
            axes.plot(share[[0, -1]], share[[0, -1]] ** slope, **GUIDE)
        axes.set(xscale="log", yscale="log")
    spare = figure.axes[len(axes_of)]
    spare.axis("off")
    title = (
        "upper five: restitution model\nlower five: corrected model\ndotted: slopes 1 and 2\n"
        + parameters(data, "n", "restitution", "amplitude")
    )
    # Each law has two lines; the legend takes the first.
    lines = figure.axes[0].lines[: 2 * data.sizes["law"] : 2]
    spare.legend(lines, data["law"].values, loc="upper left", title=title)
    return figure


def engines(data: xr.Dataset) -> Figure:
    """Draw the errors of a bounce's height over the time steps in a period (ext_engines).

    There is a panel for each ϖ, with a line for each scheme of time stepping, markers of the
    engines, and a level for each model without steps. A note gives the number of steps that one
    corrected impact saves.
    """
    figure, slots = canvas(
        WIDE, 3.3, columns=data.sizes["frequency_ratio"], sharex=True, sharey=True
    )
    shown = data.sel({name: data.attrs[name] for name in ("n", "restitution", "release")})
    for axes, part in zip(slots, each(shown, "frequency_ratio"), strict=True):
        for scheme in map(str, data.scheme.values):
            _draw_steps(axes, part.sel(scheme=scheme), scheme)
        for one, shape in zip(each(part, "engine"), _ENGINES, strict=True):
            look = _MARKED | {"marker": shape, "label": one.engine.item()}
            axes.plot(one.bounce_steps, one.bounce_error, **look)
            alone = {"markerfacecolor": "black", "label": "_single bounces"}
            axes.plot(one.single_bounce, one.single_error, **look | alone)
        # The error of the event-driven simulation is rounding, far below the panel.
        look = MODELS["spring-damper"] | {"transform": axes.transAxes}
        axes.plot([0, 1], [0.025, 0.025], label="event-driven, no steps: rounding", **look)
        for model in ("restitution", "corrected"):
            level = abs(float(part.sel(model=model).model_error))
            axes.axhline(level, label=f"{model} model, no steps", **MODELS[model])
            look = {"va": "bottom", "fontsize": 8, "transform": axes.get_yaxis_transform()}
            axes.text(0.02, level, f"{100 * level:.2g} %", **look)
        title = rf"$\varpi={part.frequency_ratio.item():g}$"
        axes.set(xscale="log", yscale="log", xlabel="time steps in a period", title=title)
    slots[0].set(
        ylabel="error of the height of a bounce", ylim=(0.25 * slots[0].get_ylim()[0], None)
    )
    figure.suptitle(f"{parameters(data, 'n', 'restitution')}, {data.attrs['release']} release")
    legend_below(figure, ncols=3)
    return figure


def _draw_steps(axes: Axes, part: xr.Dataset, scheme: str) -> None:
    """The error of a scheme over its steps, with a mark where it equals the corrected model's."""
    axes.plot(part.steps_in_bounce, part.step_error, label=scheme, **_SCHEMES[scheme])
    end, level = float(part.equal_steps), abs(float(part.model_error.sel(model="corrected")))
    axes.plot(end, level, marker="|", markersize=9, color="black")
    if scheme == "semi-implicit Euler":
        name = f"${number(float(f'{end:.2g}'))}$ times fewer steps"
        axes.text(0.04, 0.06, f"corrected: {name}", transform=axes.transAxes, fontsize=8)


def _by_quantity(data: xr.Dataset, height: float, xlabel: str) -> tuple[Figure, dict[str, Axes]]:
    """Two rows of three panels, one for the errors of each quantity, with labels at the outside."""
    figure, slots = canvas(WIDE, height, 2, 3, sharex=True, sharey=True)
    for axes in slots.flat:
        axes.set(xlabel=xlabel, ylabel="relative error")
        axes.label_outer()
    by_quantity = dict(zip(map(str, data["quantity"].values), slots.flat, strict=False))
    for quantity, axes in by_quantity.items():
        axes.set_title(QUANTITIES[quantity])
    return figure, by_quantity
