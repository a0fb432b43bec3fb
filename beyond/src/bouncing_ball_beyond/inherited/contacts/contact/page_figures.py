"""The answer of ``bouncing-ball design`` about a contact, as one page to print."""

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter

from bouncing_ball_beyond.drawing.laws_and_models import CORRECTED, MODELS
from bouncing_ball_beyond.inherited.drawing.labels import QUANTITIES
from bouncing_ball_beyond.inherited.drawing.style import COLOURS, CONTACT, RESTITUTION, TABLE

# A4 upright, in inches.
_PAGE = 8.27, 11.69


def draw(design: Mapping[str, Any], data: xr.Dataset, values: Sequence[tuple[str, str]]) -> Figure:
    """The page, A4 upright.

    Parameters
    ----------
    design : mapping
        The answer under the keys of its JSON.
    data : Dataset
        Chart and motion (:mod:`bouncing_ball_beyond.inherited.contacts.contact.page_data`).
    values : sequence of (str, str)
        The numbers to list, by name, as texts.
    """
    figure = Figure(figsize=_PAGE)
    # Room for the titles of the panels.
    top = min(0.86, _title(figure, design) - 0.045)
    grid = figure.add_gridspec(
        3, 2, left=0.12, right=0.95, top=top, bottom=0.06, hspace=0.34, wspace=0.52,
        height_ratios=(1.0, 1.05, 1.05),
    )  # fmt: skip
    _chart(figure.add_subplot(grid[0, 0]), design, data)
    _errors(figure.add_subplot(grid[0, 1]), design)
    motion = figure.add_subplot(grid[1, :])
    _curves(motion, data.time, data.ball, f"the {design['n']}-T orbit")
    motion.plot(data.time, data.table, color=TABLE, label="table")
    motion.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=4)
    contact = figure.add_subplot(grid[2, 0])
    _curves(contact, data.since, data.gap, "one contact: height above the table")
    contact.axhline(0.0, color=TABLE, linewidth=0.8)
    _numbers(figure.add_subplot(grid[2, 1]), values)
    return figure


def _title(figure: Figure, design: Mapping[str, Any]) -> float:
    """Write motion, verdict, reason and notes; the result is the height below these texts."""
    top = 0.972
    notes = [(f"Note: {note}.", 128, 8, "normal", 0.015) for note in design["notes"]]
    for text, width, size, weight, step in (
        (design["headline"], 112, 9.5, "normal", 0.0175),
        (design["verdict"], 88, 12, "bold", 0.0215),
        (f"Reason: {design['reason']}.", 112, 9.5, "normal", 0.0175),
        *notes,
    ):
        # A number and its percent sign stay in one line.
        lines = textwrap.wrap(text.replace(" %", "\u00a0%"), width)
        figure.text(0.06, top, "\n".join(lines), fontsize=size, weight=weight, va="top")
        top -= step * len(lines) + 0.006
    return top


def _chart(axes: Axes, design: Mapping[str, Any], data: xr.Dataset) -> None:
    """The ϖ from which on each simple model is accurate, over r, with the case as a star."""
    for name in data["simple"].values:
        axes.plot(data["restitution"], data.needed.sel(simple=name), label=name, **MODELS[name])
    ours = design["corrected"]["restitution"], design["frequency_ratio"]
    axes.plot(*ours, "*", color=CONTACT, markersize=13, label="this contact", clip_on=False)
    need = design["needed"]
    axes.set(xlabel="restitution coefficient $r$", ylabel=r"frequency ratio $\varpi$", yscale="log")
    axes.set_title(
        f"right to {100 * need['tolerance']:g} % above the line:\n{QUANTITIES[need['quantity']]}, "
        rf"$n={design['n']}$, $\Lambda={design['amplitude']:.3g}$"
    )
    axes.grid(visible=True, axis="y", linewidth=0.3)
    axes.legend(loc="best")


def _errors(axes: Axes, design: Mapping[str, Any]) -> None:
    """The errors of the case, quantity by quantity."""
    one = next(each for each in design["orbits"] if each["n"] == design["n"])
    names = [QUANTITIES[each] for each in one["errors"]]
    for key, name, marker, colour, size in (
        ("errors", "restitution", "o", RESTITUTION, 6),
        # Small, because both models have the same error in the permanent contact.
        ("corrected_errors", "corrected", "D", CORRECTED, 3.5),
        ("law_errors", "error law", "|", COLOURS[2], 13),
    ):
        values = [abs(error) if error else np.nan for error in one[key].values()]
        axes.plot(values, names, marker, color=colour, label=name, markersize=size)
    axes.axvline(design["needed"]["tolerance"], color=TABLE, linewidth=0.8, linestyle="--")
    # The first quantity is at the top, and those without an error have their rows, too.
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.set(
        xscale="log",
        title=f"relative errors, without sign, {design['n']}-T orbit (dashed: tolerance)",
    )
    axes.grid(visible=True, axis="x", linewidth=0.3)
    axes.legend(loc="upper center", bbox_to_anchor=(0.35, -0.1), ncols=3, columnspacing=1.0)


def _curves(axes: Axes, time: xr.DataArray, heights: xr.DataArray, title: str) -> None:
    """The curves of all models in one panel, in seconds and metres with a prefix."""
    for name in heights["model"].values:
        if heights.sel(model=name).notnull().any():
            # A contact with another law has the look of the spring-damper model.
            look = MODELS.get(name, MODELS["spring-damper"])
            axes.plot(time, heights.sel(model=name), label=name, **look)
    axes.xaxis.set_major_formatter(EngFormatter("s"))
    axes.yaxis.set_major_formatter(EngFormatter("m"))
    axes.set(xlabel="time", ylabel="height", title=title)


def _numbers(axes: Axes, values: Sequence[tuple[str, str]]) -> None:
    axes.axis("off")
    for row, (name, value) in enumerate(values):
        height = 1.0 - row / len(values)
        for x, text, side in ((-0.1, name.replace("t_c", "$t_c$"), "left"), (1.02, value, "right")):
            axes.text(x, height, text, fontsize=8, va="top", ha=side, transform=axes.transAxes)
