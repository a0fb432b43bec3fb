"""The branches of Figs. 8, 9 and 15, and Table 1."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.datasets.selection import each
from bouncing_ball.drawing.branches import (
    draw_both_phases,
    draw_rigid_branch,
    head,
    name_branches,
    over_amplitude,
    phase_panels,
    placed,
)
from bouncing_ball.drawing.canvas import legend_below
from bouncing_ball.drawing.labels import parameters
from bouncing_ball.drawing.style import COLOURS
from bouncing_ball.drawing.tables import Columns, TextTable, entry_of, text, text_table, value

domains = over_amplitude
"""Figs. 8 and 9: the spring-damper model's branches for each ϖ; a panel for each phase."""


def both_domains(data: xr.Dataset) -> Figure:
    """Fig. 15: the branches of both models, on the axes of Figs. 8 and 9.

    In the restitution model the contact ends when it starts.
    """
    figure, panels = phase_panels(touching=True)
    panels[0].set_xlim(0.0, data.attrs["amplitude_max"])
    of_branch = ("amplitude", "phase", "stable", "admissible")
    rigid = xr.Dataset({name: data[f"restitution_{name}"] for name in of_branch})
    rigid = rigid.assign(release_phase=rigid.phase)
    curve = placed(data.squeeze("frequency_ratio"))
    draw_both_phases(panels, curve, COLOURS[1])
    for axes in panels:
        draw_rigid_branch(axes, rigid, data, COLOURS[0])
    legend_below(figure)
    title = parameters(data, "n", "restitution", "frequency_ratio")
    head(figure, title, data)
    named = [("restitution", rigid, COLOURS[0]), ("spring-damper", curve, COLOURS[1])]
    name_branches(figure, panels, named)
    return figure


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
    header, body = text_table(each(data, "frequency_ratio", *ends), contacts)
    for part in each(data, "impact_map", *ends):
        place = [column(part) for column in ends.values()]
        name = f"restitution ({part.impact_map.item()} map)"
        body.append([name, *place, entry_of(part.restitution_range, ".5f"), "", ""])
    return header, body
