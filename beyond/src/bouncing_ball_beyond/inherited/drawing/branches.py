"""Branches of n-T orbits with stability and bifurcations: phase of the table against Λ.

Lines are solid for stable, dashed for unstable and dotted for inadmissible orbits (Figs. 3, 8, 9,
15).
"""

from collections.abc import Sequence
from itertools import pairwise
from textwrap import fill
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball_beyond.inherited.datasets import (
    CASE,
    GRAZING_FLIGHT,
    GRAZING_RELEASE,
    PERIOD_DOUBLING,
    SADDLE_NODE,
)
from bouncing_ball_beyond.inherited.drawing.canvas import WIDE, canvas, coloured, legend_below
from bouncing_ball_beyond.inherited.drawing.labels import in_a_row, names_at_the_right, title
from bouncing_ball_beyond.inherited.drawing.style import LINES, MARKS

_GRAZING = {GRAZING_FLIGHT, GRAZING_RELEASE}
# The special orbits of the restitution model, and the beginnings of the names of their variables.
_OF_RIGID = {
    SADDLE_NODE: "saddle_node",
    PERIOD_DOUBLING: "period_doubling",
    GRAZING_FLIGHT: "grazing",
}
_ALONG = ("point", "special", "multiplier", "end")
# Relative distance below which two amplitudes differ only by rounding.
_ROUNDING = 1e-12
# Width in characters of a reason below the title.
_LINE = 110
SPECIAL = (SADDLE_NODE, PERIOD_DOUBLING, GRAZING_FLIGHT, GRAZING_RELEASE)
"""The kinds of special points at which the line of a branch may change its look."""


class SpecialPoints(NamedTuple):
    """The special points of a branch: arrays of one shape, NaN where there is no special point.

    ``kind`` is one of ``SPECIAL``, ``along`` the place on the branch in the measure of its
    points, ``amplitude`` Λ and ``phase`` the phase shown, in rad.
    """

    kind: np.ndarray
    along: np.ndarray
    amplitude: np.ndarray
    phase: np.ndarray

    def between(self, low: float, high: float, kinds: set[str]) -> np.ndarray:
        """Λ and the phase over π of the special points of some kinds on a part of the branch, in
        its order, shape (2, count).
        """
        at = np.flatnonzero(
            np.isin(self.kind, list(kinds)) & (self.along >= low) & (self.along <= high)
        )
        at = at[np.argsort(self.along[at])]
        return np.stack([self.amplitude[at], self.phase[at] / np.pi])


def draw_branch(
    axes: Axes,
    curve: xr.Dataset,
    along: np.ndarray,
    phase: xr.DataArray,
    special: SpecialPoints,
    colour: str,
) -> None:
    """A branch in pieces of one look, which meet in its special points.

    ``along`` increases along the branch, and places its points among the special points. A branch
    of which a part is drawn begins and ends at the special points beyond its points.
    """
    line = np.stack([curve.amplitude.values, phase.values / np.pi])
    if np.isnan(line).all():
        return
    stability = np.where(curve.stable, "stable", "unstable")
    kinds = np.where(curve.admissible, stability, "inadmissible")
    edges = [0, *(np.flatnonzero(kinds[1:] != kinds[:-1]) + 1), len(kinds)]
    first = special.between(-np.inf, along[0], set(SPECIAL))[:, -1:]
    for start, stop in pairwise(edges):
        last = _border(line, kinds, along, special, stop)
        x, y = np.concatenate([first, line[:, start:stop], last], axis=-1)
        axes.plot(x, y, color=colour, label=kinds[start], **LINES[kinds[start]])
        first = last


def _border(
    line: np.ndarray, kinds: np.ndarray, along: np.ndarray, special: SpecialPoints, stop: int
) -> np.ndarray:
    """Where a piece ends that begins before the point ``stop``, at most one place, shape (2, k).

    Where the look changes but no special point is known the place is the next point.
    """
    if stop == len(kinds):
        return special.between(along[-1], np.inf, set(SPECIAL))[:, :1]
    grazes = "inadmissible" in kinds[stop - 1 : stop + 1]
    possible = _GRAZING if grazes else set(SPECIAL) - _GRAZING
    found = special.between(along[stop - 1], along[stop], possible)[:, :1]
    return found if found.size else line[:, stop : stop + 1]


def mark_orbits(axes: Axes, kind: str, x: xr.DataArray, phase: xr.DataArray, colour: str) -> None:
    """The special points of a kind, if there are any."""
    if phase.notnull().any():
        axes.plot(x, phase / np.pi, color=colour, zorder=4, label=kind, **MARKS[kind])


def draw_rigid_branch(axes: Axes, curve: xr.Dataset, data: xr.Dataset, colour: str) -> None:
    """The branch of the restitution model, along which φ increases, with its special points.

    ``curve`` has the orbits, and ``data`` the numbers Λ and φ of those bifurcations and grazing
    orbits that it names.
    """
    named = [(kind, name) for kind, name in _OF_RIGID.items() if f"{name}_phase" in data]
    phase = np.array([float(data[f"{name}_phase"]) for _, name in named])
    special = SpecialPoints(
        kind=np.array([kind for kind, _ in named]),
        along=phase,
        amplitude=np.array([float(data[f"{name}_amplitude"]) for _, name in named]),
        phase=phase,
    )
    draw_branch(axes, curve, curve.phase.values, curve.phase, special, colour)
    for kind, name in named:
        mark_orbits(axes, kind, data[f"{name}_amplitude"], data[f"{name}_phase"], colour)


def phase_panels(touching: bool) -> tuple[Figure, list[Axes]]:
    """A panel for the phase of the table at which contact starts, and one for that at its end.

    Without contacts of finite duration there is only the first.
    """
    figure, panels = canvas(WIDE, 3.9, columns=1 + touching, sharex=True, sharey=True)
    panels = np.atleast_1d(panels)
    titles = (r"start of contact, $\varphi$", r"end of contact, $\varphi+\tau_b$")
    for axes, name in zip(panels, titles, strict=False):
        axes.set(xlabel=r"amplitude $\Lambda$", title=name if touching else "")
    panels[0].set_ylabel(r"phase of the table over $\pi$")
    return figure, [*panels]


def over_amplitude(data: xr.Dataset) -> Figure:
    """Branches of a labelled dataset as in Figs. 8 and 9, named by the arguments that differ."""
    rows, names = in_a_row(data, *_ALONG)
    figure, panels = phase_panels(bool((rows.contact_duration > 0).any()))
    panels[0].set_xlim(0.0, data.attrs.get("amplitude_max", data.amplitude.max()))
    named = []
    # Both phases of a curve have its colour.
    for (curve, colour), name in zip(coloured(rows, CASE), names, strict=True):
        draw_both_phases(panels, placed(curve), colour)
        named.append((name, curve, colour))
    legend_below(figure)
    head(figure, title(data), rows)
    name_branches(figure, panels, named)
    return figure


def head(figure: Figure, title: str, rows: xr.Dataset) -> None:
    """The title, and a line for each branch that cannot be followed, with the reason."""
    missing = rows.amplitude.isnull().all("point").values
    reasons = rows.end_reason.isel(end=0).values[missing]
    figure.suptitle("\n".join([title, *(fill(reason, _LINE) for reason in reasons)]))


def name_branches(
    figure: Figure, panels: Sequence[Axes], named: Sequence[tuple[str, xr.Dataset, str]]
) -> None:
    """The names of branches at the right of each panel: name, orbits and colour of each branch.

    The dashes of a line tell the stability, so that in grey only the names distinguish branches.
    A branch without a name or without an orbit is left out.
    """
    shown = [each for each in named if each[0] and each[1].amplitude.notnull().any()]
    if not shown:
        return
    # The places of the names depend on the height of the panels, which is known after the layout.
    figure.draw_without_rendering()
    for axes, phase in zip(panels, ("phase", "release_phase"), strict=False):
        ends = [(name, _last_phase(curve, phase) / np.pi, colour) for name, curve, colour in shown]
        names_at_the_right(axes, ends)


def _last_phase(curve: xr.Dataset, phase: str) -> float:
    """The phase at the end of a branch that has the larger Λ; of two equal ends, the larger phase.

    Examples
    --------
    >>> ends = {"amplitude": ("point", [1.5, 0.2, 1.5]), "phase": ("point", [-0.4, 0.0, 0.5])}
    >>> _last_phase(xr.Dataset(ends), "phase")
    0.5
    """
    known = curve[["amplitude", phase]].dropna("point")
    ends = known.isel(point=[0, -1])
    # Ends at the edge of the panel differ by rounding.
    far = ends.amplitude >= ends.amplitude.max() * (1 - _ROUNDING)
    return float(ends[phase].where(far).max())


def placed(curve: xr.Dataset) -> xr.Dataset:
    """The branch with the place of each point, as a share of its arclength: the steps are equal."""
    return curve.assign(arclength=("point", np.linspace(0.0, 1.0, curve.sizes["point"])))


def draw_both_phases(panels: Sequence[Axes], curve: xr.Dataset, colour: str) -> None:
    """The phases at the start and at the end of contact, a panel for each, with special points."""
    release = curve.special_phase + curve.special_contact_duration
    phases = ((curve.phase, curve.special_phase), (curve.release_phase, release))
    # Without contacts of finite duration there is one panel.
    for axes, (phase, special) in zip(panels, phases, strict=False):
        _draw_phase(axes, curve, phase, special, colour)


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
    for kind in SPECIAL:
        there = special.where(curve.special_kind == kind)
        mark_orbits(axes, kind, curve.special_amplitude, there, colour)
