"""Figures 11 and 16: thresholds of permanent contact."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.drawing.canvas import canvas, legend_below, logarithmic
from bouncing_ball.drawing.labels import parameters
from bouncing_ball.drawing.style import CONTACT, GUIDE, LIMIT, Look
from bouncing_ball.drawing.thresholds import draw_relative_error
from bouncing_ball.paper.exhibits.printed_table1 import printed_contact_ratio

# The least top of the axis of Λ, and its least ratio to the lowest threshold.
_HIGHEST = 2.0
_ROOM = 1.5
# The names of the regions below and above the threshold, and the forms in which a name is tried:
# on one line, on two, and upright on two.
# Not dotted, as the tolerance below is.
_MINIMUM: Look = GUIDE | {"linestyle": (0, (6, 2, 1, 2)), "color": "#555555"}
_PERMANENT = ("permanent", "contact")
_LEAVES = ("the ball leaves", "the table")
_FORMS = ((" ", 0), ("\n", 0), ("\n", 90))
# The space around a name, as a share of the axes, and the share of the greatest room at which a
# place is as good as the best.
_MARGIN = 0.01
_NEARLY = 0.95
# Number of places along the axis that are compared.
_PLACES = 401


def permanent_contact(data: xr.Dataset) -> Figure:
    """Fig. 11: Λ_SD and its minimum."""
    figure, axes = canvas(height=3.1)
    _draw_threshold(axes, data)
    legend_below(figure)
    # The places depend on the sizes of axes and texts, which are known after the layout.
    figure.draw_without_rendering()
    ratio = data.frequency_ratio.values
    threshold = data.threshold_amplitude.values
    lowest = np.full_like(threshold, float(data.minimum_threshold))
    _name(axes, _PERMANENT, ratio, lowest, threshold)
    _name(axes, _LEAVES, ratio, threshold, np.full_like(threshold, axes.get_ylim()[1]))
    return figure


def permanent_contact_error(data: xr.Dataset) -> Figure:
    """Fig. 16: Λ_SD and the restitution model's Λ_CR; below, the relative error."""
    figure, (axes, below) = canvas(height=4.6, rows=2, sharex=True)
    _draw_threshold(axes, data)
    limit = float(data.restitution_threshold)
    axes.axhline(limit, label=r"restitution, $\Lambda_{CR}$", **LIMIT)
    axes.set(xlabel="", ylabel=r"threshold amplitude $\Lambda$")
    given = (data.attrs[name] for name in ("restitution", "tolerance", "release"))
    printed = printed_contact_ratio(*given)
    difference = data.threshold_amplitude - limit
    draw_relative_error(below, data, difference, "PC", digits=2, printed=printed)
    legend_below(figure, ncols=2)
    return figure


def _draw_threshold(axes: Axes, data: xr.Dataset) -> None:
    """Λ_SD, or Λ_F of the force release, with its minimum."""
    force = data.attrs.get("release") == "force"
    symbol = r"$\Lambda_{F}$" if force else r"$\Lambda_{SD}$"
    name = f"spring-damper, {symbol}"
    axes.plot(data.frequency_ratio, data.threshold_amplitude, color=CONTACT, label=name)
    formula = "" if force else r", $2\zeta\sqrt{1-\zeta^2}$"
    axes.axhline(float(data.minimum_threshold), label=f"minimum{formula}", **_MINIMUM)
    ylabel = f"threshold amplitude {symbol}"
    title = rf"{parameters(data, 'restitution')}, $\zeta={float(data.damping_ratio):.4f}$"
    highest = max(_HIGHEST, _ROOM * float(data.threshold_amplitude.min()))
    logarithmic(axes, data.frequency_ratio, ylabel=ylabel, ylim=(0, highest), title=title)


def _name(
    axes: Axes,
    words: tuple[str, str],
    ratio: np.ndarray,
    below: np.ndarray,
    above: np.ndarray,
) -> None:
    """A name where the region between two curves is highest, in the first form that fits.

    A region without room for its name has none.
    """
    to_axes = axes.transData + axes.transAxes.inverted()
    place, bottom = to_axes.transform(np.stack([ratio, below], axis=1)).T
    top = to_axes.transform(np.stack([ratio, above], axis=1))[:, 1]
    across = np.linspace(0.0, 1.0, _PLACES)
    bottom = np.clip(np.interp(across, place, bottom), 0.0, 1.0)
    top = np.clip(np.interp(across, place, top), 0.0, 1.0)
    look: dict[str, Any] = {"fontsize": 8, "ha": "center", "va": "center"}
    for between, angle in _FORMS:
        text = axes.text(
            0, 0, between.join(words), rotation=angle, transform=axes.transAxes, **look
        )
        box = text.get_window_extent().transformed(axes.transAxes.inverted())
        half = box.width / 2 + _MARGIN
        centres = across[(across >= half) & (across <= 1 - half)]
        beside = np.abs(across - centres[:, np.newaxis]) <= half
        low = np.where(beside, bottom, 0.0).max(axis=1)
        high = np.where(beside, top, 1.0).min(axis=1)
        room = high - low
        fitting = np.flatnonzero(room >= max(box.height + 2 * _MARGIN, _NEARLY * room.max()))
        if fitting.size:
            best = fitting[fitting.size // 2]
            text.set_position((centres[best], (low[best] + high[best]) / 2))
            return
        text.remove()
