"""Errors of physics engines over their time steps, beside those of the models."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball_beyond.drawing.laws_and_models import MODELS
from bouncing_ball_beyond.inherited.datasets.selection import each
from bouncing_ball_beyond.inherited.drawing.canvas import WIDE, canvas, legend_below
from bouncing_ball_beyond.inherited.drawing.labels import number_label, parameters
from bouncing_ball_beyond.inherited.drawing.style import COLOURS, Look
from bouncing_ball_beyond.inherited.drawing.tables import (
    Columns,
    TextTable,
    at,
    entry_of,
    text,
    text_table,
    value,
)

_IMPLICIT: Look = {"color": COLOURS[2], "linestyle": (0, (6, 1.5, 1, 1.5))}
# Dashes distinguish the schemes of time stepping, and markers the engines.
_SCHEMES: dict[str, Look] = {
    "semi-implicit Euler": {"color": COLOURS[1], "linewidth": 1.3},
    "implicit Euler": _IMPLICIT | {"linewidth": 0.6},
    "compensated implicit Euler": _IMPLICIT | {"linewidth": 1.3},
}
_ENGINES = "osxD"
_MARKED: Look = {"linestyle": "none", "color": "black", "markerfacecolor": "none", "markersize": 4}


def engines(data: xr.Dataset) -> Figure:
    """Draw the errors of a bounce's height over the time steps in a period.

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
    end = float(part.equal_steps)
    level = abs(float(part.model_error.sel(model="corrected")))
    axes.plot(end, level, marker="|", markersize=9, color="black")
    if scheme == "semi-implicit Euler":
        name = f"${number_label(float(f'{end:.2g}'))}$ times fewer steps"
        axes.text(0.04, 0.06, f"corrected: {name}", transform=axes.transAxes, fontsize=8)


# Columns that the models do not have.
_OF_ENGINES = ("free_steps", "measured_restitution", "contact_steps", "height_scatter")


def engines_table(data: xr.Dataset) -> TextTable:
    """Physics engines and models: restitution, steps, and the heights of orbits.

    Errors are the mean of the bounces ± their scatter. Times are relative to that of the
    event-driven simulation.
    """
    tolerance = data.tolerance.max()
    columns: Columns = {
        "engine or model": text("engine"),
        "release": text("release"),
        "r": value("restitution", "g"),
        "n": value("n", "g"),
        f"steps in a contact for {100 * tolerance.item():g} % in r": value("free_steps", ".0f"),
        "r got": value("measured_restitution", ".4f"),
        "steps in a contact": lambda part: entry_of(part.contact_steps.max(), ".0f"),
        **{
            f"height error, ϖ = {ratio:g}": at(_error, frequency_ratio=ratio)
            for ratio in data.frequency_ratio.values
        },
        f"time of a bounce, ϖ = {_listed(data.frequency_ratio, 'g')}": lambda part: _listed(
            part.bounce_time, ".1f"
        ),
    }
    # A dictionary, because the keyword tolerance is another argument of sel.
    shown = data.sel({"tolerance": tolerance})
    parts: list[xr.Dataset] = []
    for case in each(shown, "release", "restitution", "n"):
        parts += [one for one in each(case, "engine") if np.isfinite(one.free_steps)]
        for one in each(case, "model"):
            of_model = {
                "engine": f"{one.model.item()} model",
                "height_error": one.model_error,
                "bounce_time": one.model_time,
            }
            blank = dict.fromkeys(_OF_ENGINES, np.nan)
            parts.append(one.isel(engine=0, drop=True).assign(blank | of_model))
    return text_table(parts, columns)


def _listed(values: xr.DataArray, form: str) -> str:
    """The numbers that are not NaN, in one cell."""
    return ", ".join(f"{x:{form}}" for x in values.values.ravel() if np.isfinite(x))


def _error(part: xr.Dataset) -> str:
    """The mean error of a height and its scatter, in per cent."""
    error = 100 * float(part.height_error)
    scatter = 100 * float(part.height_scatter)
    if not np.isfinite(error):
        return "–"
    # Adding 0.0 removes the sign of a zero that results from rounding.
    mean = f"{round(error, 3) + 0.0:+.3f}"
    return f"{mean} ± {scatter:.2f} %" if np.isfinite(scatter) else f"{mean} %"
