"""The branches of Figs. 8, 9 and 15, and Table 1."""

from collections.abc import Callable
from itertools import cycle
from textwrap import fill

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.datasets import CASE, SADDLE_NODE
from bouncing_ball.datasets.selection import each
from bouncing_ball.drawing.branches import (
    SpecialPoints,
    draw_branch,
    draw_rigid_branch,
    label_branch_axes,
    mark_orbits,
)
from bouncing_ball.drawing.canvas import WIDE, canvas, coloured, legend_below
from bouncing_ball.drawing.labels import in_a_row, parameters, title
from bouncing_ball.drawing.style import COLOURS, MARKS
from bouncing_ball.drawing.tables import Columns, Table, entry_of, table, text, value

# Width in characters of a reason inside of a panel.
_LINE = 80


def domains(data: xr.Dataset) -> Figure:
    """Figs. 8 and 9: the spring-damper model's branch for each ϖ, in one panel."""
    figure = over_amplitude(data.drop_attrs(), shown=up_to_second_saddle_node)
    title = parameters(data, "n", "restitution")
    figure.axes[0].set(title=title, xlim=(0.0, data.attrs["amplitude_max"]))
    return figure


def over_amplitude(
    data: xr.Dataset, shown: Callable[[xr.Dataset], xr.Dataset] = lambda curve: curve
) -> Figure:
    """Branches of a labelled dataset as in Figs. 8 and 9, named by the arguments that differ.

    ``shown`` is the part of each branch that is drawn; by default it is the whole branch.
    """
    figure, axes = canvas(WIDE, 4.2)
    rows, names = in_a_row(data, "point", "special", "multiplier", "end")
    _name_curves(axes, [name for name in names if name])
    # Both phases of a curve have its colour.
    for curve, colour in coloured(rows, CASE):
        _draw_spring_damper(axes, shown(_placed(curve)), colour, colour)
    touching = bool((rows.contact_duration > 0).any())
    above = r", and above it $\varphi+\tau_b$" if touching else ""
    axes.set(xlabel=r"amplitude $\Lambda$", title=title(data), xlim=(0.0, data.amplitude.max()))
    axes.set(ylabel=rf"phase of the table over $\pi$: $\varphi${above}")
    _say_what_is_missing(axes, rows)
    legend_below(figure, ncols=7)
    return figure


def both_domains(data: xr.Dataset) -> Figure:
    """Fig. 15: the branches of both models."""
    figure, axes = canvas(5.6, 3.4)
    of_branch = ("amplitude", "phase", "stable", "admissible")
    rigid = xr.Dataset({name: data[f"restitution_{name}"] for name in of_branch})
    names = [
        r"restitution, $\varphi$",
        r"spring-damper, $\varphi$",
        r"spring-damper, $\varphi+\tau_b$",
    ]
    _name_curves(axes, names)
    draw_rigid_branch(axes, rigid, data, COLOURS[0])
    curve = data.squeeze("frequency_ratio")
    _draw_spring_damper(axes, _placed(curve), COLOURS[1], COLOURS[2])
    # If the contact has no such branch, all its values are NaN.
    lowest = float(curve.amplitude.fillna(data.saddle_node_amplitude).min())
    title = parameters(data, "n", "restitution", "frequency_ratio")
    label_branch_axes(axes, data, r"phase of the table over $\pi$", title, left=0.9 * lowest)
    _say_what_is_missing(axes, data)
    legend_below(figure, ncols=4)
    return figure


def up_to_second_saddle_node(curve: xr.Dataset) -> xr.Dataset:
    """The branch from its short contacts to the saddle-node at which its unstable side turns back.

    Beyond that saddle-node the contacts are longer. A branch whose unstable side does not turn back
    is returned unchanged.
    """
    durations = curve.special_contact_duration.values[curve.special_kind.values == SADDLE_NODE]
    if len(durations) < 2:
        return curve
    longest = np.sort(durations)[1]
    return curve.isel(
        point=curve.contact_duration.values <= longest,
        special=curve.special_contact_duration.values <= longest,
    )


def _say_what_is_missing(axes: Axes, rows: xr.Dataset) -> None:
    """The reasons for the branches that cannot be followed, in the panel, a line for each."""
    missing = rows.amplitude.isnull().all("point").values
    reasons = rows.end_reason.isel(end=0).values[missing]
    if reasons.size:
        text = "\n".join(fill(reason, _LINE) for reason in reasons)
        axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", fontsize=7)


def _name_curves(axes: Axes, names: list[str]) -> None:
    """Entries of the legend, in the order of the colours."""
    for name, colour in zip(names, cycle(COLOURS), strict=False):
        axes.plot([], [], color=colour, label=name)


def _placed(curve: xr.Dataset) -> xr.Dataset:
    """The branch with the place of each point, as a share of its arclength: the steps are equal."""
    return curve.assign(arclength=("point", np.linspace(0.0, 1.0, curve.sizes["point"])))


def _draw_spring_damper(axes: Axes, curve: xr.Dataset, start: str, end: str) -> None:
    """The phases at the start and at the end of contact, with the special points."""
    _draw_phase(axes, curve, curve.phase, curve.special_phase, start)
    special_release = curve.special_phase + curve.special_contact_duration
    _draw_phase(axes, curve, curve.release_phase, special_release, end)


def _draw_phase(
    axes: Axes, curve: xr.Dataset, phase: xr.DataArray, special: xr.DataArray, colour: str
) -> None:
    """One phase along a branch, and the same phase of its special points."""
    points = SpecialPoints(
        kind=curve.special_kind.values,
        along=curve.special_arclength.values,
        amplitude=curve.special_amplitude.values,
        phase=special.values,
    )
    draw_branch(axes, curve, curve.arclength.values, phase, points, colour)
    for kind in MARKS:
        there = special.where(curve.special_kind == kind)
        mark_orbits(axes, kind, curve.special_amplitude, there, colour)


def table1(data: xr.Dataset) -> Table:
    """Stability ranges over Λ: each end of each range computed, printed, and their difference.

    Differences are in Λ. The rows of the restitution model have no printed values.
    """
    ends: Columns = {"n": text("n"), "bound": text("bound")}
    contacts: Columns = {
        "ϖ": value("frequency_ratio", "g"),
        **ends,
        "computed": value("computed", ".5f"),
        "printed": value("printed", ".3f", ""),
        "difference": lambda part: entry_of(part.computed - part.printed, "+.5f", ""),
    }
    header, body = table(each(data, "frequency_ratio", *ends), contacts)
    for part in each(data, "impact_map", *ends):
        place = [column(part) for column in ends.values()]
        name = f"restitution ({part.impact_map.item()} map)"
        body.append([name, *place, entry_of(part.restitution_range, ".5f"), "", ""])
    return header, body
