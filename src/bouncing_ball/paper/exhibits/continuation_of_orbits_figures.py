"""The branches of Figs. 8, 9 and 15, and Table 1."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.datasets import SADDLE_NODE
from bouncing_ball.datasets.selection import each
from bouncing_ball.drawing.branches import (
    draw_both_phases,
    draw_rigid_branch,
    label_branch_axes,
    name_curves,
    over_amplitude,
    placed,
    say_what_is_missing,
)
from bouncing_ball.drawing.canvas import canvas, legend_below
from bouncing_ball.drawing.labels import parameters
from bouncing_ball.drawing.style import COLOURS
from bouncing_ball.drawing.tables import Columns, TextTable, entry_of, table, text, value


def domains(data: xr.Dataset) -> Figure:
    """Figs. 8 and 9: the spring-damper model's branch for each ϖ, in one panel."""
    figure = over_amplitude(data.drop_attrs(), shown=up_to_second_saddle_node)
    title = parameters(data, "n", "restitution")
    figure.axes[0].set(title=title, xlim=(0.0, data.attrs["amplitude_max"]))
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
    name_curves(axes, names)
    draw_rigid_branch(axes, rigid, data, COLOURS[0])
    curve = data.squeeze("frequency_ratio")
    draw_both_phases(axes, placed(curve), COLOURS[1], COLOURS[2])
    # If the contact has no such branch, all its values are NaN.
    lowest = float(curve.amplitude.fillna(data.saddle_node_amplitude).min())
    title = parameters(data, "n", "restitution", "frequency_ratio")
    label_branch_axes(axes, data, r"phase of the table over $\pi$", title, left=0.9 * lowest)
    say_what_is_missing(axes, data)
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


def table1(data: xr.Dataset) -> TextTable:
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
