"""One orbit followed along ϖ, curve by curve (Figs. 5, 6, 10, 13)."""

from itertools import cycle

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from bouncing_ball.drawing.canvas import canvas, coloured, draw_curve, legend_below, logarithmic
from bouncing_ball.drawing.labels import note_beside, number_label, parameters
from bouncing_ball.drawing.style import DASHES, GUIDE, RESTITUTION, Look

# Above this frequency ratio the points are close to the point of the restitution model, and share
# a name.
_NAMED_UP_TO = 10.0
_LIMIT: Look = {"markersize": 9, "zorder": 5, "linestyle": "none", "color": RESTITUTION}
_MARK: Look = {"color": RESTITUTION, "marker": "o", "markersize": 4}
_START: Look = _MARK | {"linestyle": (0, (4, 1.5)), "markerfacecolor": "white"}
_END: Look = _MARK | {"linestyle": "-"}
# The mark of a colour in a legend: starts and ends of the contact have lines of their own.
_COLOUR: Look = {"marker": "s", "markersize": 7, "linestyle": "none"}


def apparent_restitution(data: xr.Dataset) -> Figure:
    """Figs. 5 and 6: a curve for each (r, Λ), with the restitution coefficients as guides."""
    figure, axes = canvas(height=3.2)
    _draw_cases(axes, data, "apparent_restitution", "apparent restitution $r_a$")
    for restitution in data.restitution.values:
        axes.axhline(restitution, label="restitution model, $r$", **GUIDE)
    legend_below(figure, ncols=2)
    return figure


def bounce_velocity(data: xr.Dataset) -> Figure:
    """Fig. 10: a curve for each Λ, with the restitution model's nπ as a guide."""
    figure, axes = canvas(height=3.0)
    _draw_cases(axes, data, "bounce_velocity", r"bouncing-off velocity $z′_b$")
    limit = float(data.restitution_bounce_velocity)
    axes.axhline(limit, label=r"restitution model, $n\pi$", **GUIDE)
    legend_below(figure, ncols=2)
    return figure


def poincare_map(data: xr.Dataset) -> Figure:
    """Fig. 13: phase and velocity, over π, at the start and at the end of contact.

    Each curve is parametrised by ϖ, and a few values of ϖ are marked.
    """
    figure, axes = canvas(4.4, 4.4)
    cases = []
    for curve, colour in coloured(data, "case"):
        end: Look = _END | {"color": colour, "markerfacecolor": colour}
        start: Look = _START | {"color": colour}
        _draw_trace(axes, curve, curve.release_phase, curve.bounce_velocity, end)
        _draw_trace(axes, curve, curve.phase, curve.impact_velocity, start)
        phase = curve.restitution_phase / np.pi
        limits = data.restitution_bounce_velocity, data.restitution_impact_velocity
        axes.plot([phase] * 2, np.array(limits) / np.pi, "*", **_LIMIT | {"color": colour})
        name = rf"$\Lambda={number_label(float(curve['amplitude']))}${_absence(curve)}"
        cases.append(Line2D([], [], **_COLOUR, color=colour, label=name))
    axes.set(xlabel=r"phase of the table over $\pi$", ylabel=r"velocity of the ball, $z′/\pi$")
    title = parameters(data, "n", "restitution")
    axes.margins(x=0.14, y=0.08)
    kinds = [
        Line2D([], [], label=r"start of contact, $(\varphi,\,z′_i)$", **_START),
        Line2D([], [], label=r"end of contact, $(\varphi+\tau_b,\,z′_b)$", **_END),
        Line2D([], [], marker="*", label="restitution model", **_LIMIT),
    ]
    # Colours need names only if there are several.
    if len(cases) == 1:
        axes.set_title(f"{title}, {cases[0].get_label()}")
        legend_below(figure, kinds)
    else:
        axes.set_title(title)
        legend_below(figure, cases, kinds)
    # The names on the curves of all cases would overlap.
    shown = data.isel(case=int(data.phase.notnull().any("frequency_ratio").argmax("case")))
    figure.draw_without_rendering()
    _name_ratios(axes, shown, shown.release_phase, shown.bounce_velocity)
    _name_ratios(axes, shown, shown.phase, shown.impact_velocity)
    return figure


def _absence(curve: xr.Dataset) -> str:
    """The words for a curve that has no orbit at any ϖ; otherwise empty."""
    return " (no orbit)" if curve.phase.isnull().all() else ""


def _draw_cases(axes: Axes, data: xr.Dataset, name: str, ylabel: str) -> None:
    """One curve of a variable for each case, named by its r and Λ."""
    for (one, colour), dashes in zip(coloured(data, "case"), cycle(DASHES), strict=False):
        r = number_label(float(one["restitution"]))
        lam = number_label(float(one["amplitude"]))
        label = rf"$r={r}$, $\Lambda={lam}${_absence(one)}"
        look: Look = {"color": colour, "linestyle": dashes, "label": label}
        draw_curve(axes, one.frequency_ratio, one[name], one.admissible, **look)
    logarithmic(axes, data.frequency_ratio, ylabel=ylabel, title=parameters(data, "n"))


def _draw_trace(
    axes: Axes, curve: xr.Dataset, phase: xr.DataArray, velocity: xr.DataArray, look: Look
) -> None:
    """Phase and velocity over π as ϖ varies; round values of ϖ are marked."""
    marked = np.flatnonzero(curve.labelled.values).tolist()
    draw_curve(axes, phase / np.pi, velocity / np.pi, curve.admissible, **look, markevery=marked)


def _name_ratios(
    axes: Axes, curve: xr.Dataset, phase: xr.DataArray, velocity: xr.DataArray
) -> None:
    """The names of the round values of ϖ beside their marks; the large values share one."""
    marked = np.flatnonzero(curve.labelled.values & phase.notnull().values)
    ratios = curve.frequency_ratio.values
    small = marked[ratios[marked] <= _NAMED_UP_TO]
    large = marked[ratios[marked] > _NAMED_UP_TO]
    relation = "=" if large.size == 1 else r"\geq"
    for at, sign in [(at, "=") for at in small] + [(at, relation) for at in large[:1]]:
        place = float(phase[at]) / np.pi, float(velocity[at]) / np.pi
        note_beside(axes, rf"$\varpi{sign}{number_label(ratios[at])}$", place, fontsize=8)
