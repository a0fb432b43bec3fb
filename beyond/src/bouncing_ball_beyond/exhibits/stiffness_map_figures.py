"""How stiff a contact must be for the greatest height, as contours over r and Λ."""

from itertools import cycle

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from bouncing_ball_beyond.inherited.datasets.selection import each
from bouncing_ball_beyond.inherited.drawing.canvas import WIDE, canvas, legend_below
from bouncing_ball_beyond.inherited.drawing.labels import QUANTITIES
from bouncing_ball_beyond.inherited.drawing.style import GUIDE, Look

# Contours of ϖ where the model predicts a larger height than the contact has, and a smaller one.
_LEVELS = {-1: (15, 20, 25, 30, 40, 50, 60, 70, 80, 90), 1: (200, 1000)}
_POSITIONS = (0, 0.01, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1)
_LINE: Look = {"colors": "black", "linewidths": 0.7}
_RULE: Look = {"colors": "black", "linewidths": 2.0}
_JUMP: Look = {"colors": "black", "linewidths": 1.0, "linestyles": [(0, (1, 1.5))]}
_FAILS = "#b9d7ea"
_ABSENT: Look = {"facecolor": "white", "edgecolor": GUIDE["color"], "hatch": "////", "linewidth": 0}
_DIFFERS: Look = {"facecolor": "white", "edgecolor": "#b2182b", "hatch": "....", "linewidth": 0}
# Heights of the labels of neighbouring contours, as shares of the heights of the contours.
_SHARES = (0.4, 0.65)
# Above every ϖ.
_END = 1e9


def stiffness_map(data: xr.Dataset) -> Figure:
    """Contours of the ϖ that the height needs, over r and the position of Λ in the stable range.

    Above they are those of the explicit branch, below those of the error law. The axis of positions
    is even in √p. Where the rule of thumb ϖ ≥ 1/(nε) fails, the map is shaded; where the contact
    has no stable orbit at the ϖ that is needed, the upper map is hatched. The ϖ jumps at the line
    across which the error reaches the tolerance with the other sign. The lower map is dotted where
    its ϖ differs from that of the branch by more than a tenth.
    """
    figure, slots = canvas(WIDE, 5.8, rows=2, columns=data.sizes["n"], sharex=True, sharey=True)
    panels = np.reshape(slots, (2, -1))
    for column, one in zip(panels.T, each(data, "n"), strict=True):
        family = one.transpose("position", "restitution")
        _draw_family(column[0], family)
        _draw_law(column[1], family)
        column[0].set_title(rf"$n={one.n.item()}$")
        column[1].set_xlabel("restitution coefficient $r$")
    for row, name in zip(panels, ("explicit branch", "error law"), strict=True):
        row[0].set_yticks(np.sqrt(_POSITIONS), [f"{p:g}" for p in _POSITIONS])
        row[0].set_ylim(0, 1)
        row[0].set_ylabel(f"{name}\n$\\Lambda$ from saddle-node (0)\nto period doubling (1)")
    percent = 100 * data.attrs["tolerance"]
    figure.suptitle(
        rf"{QUANTITIES['max_height']}: $\varpi$ from which on the error is within {percent:g} %",
        fontsize=10,
    )
    line = Line2D([], [], color="black", linewidth=_RULE["linewidths"])
    jump = Line2D([], [], color="black", linewidth=1.0, linestyle=_JUMP["linestyles"][0])
    apart = 100 * data.law_differs_above.item()
    entries = {
        r"rule of thumb, $\varpi = 1/(n\varepsilon)$": line,
        r"a larger $\varpi$ is needed": Patch(facecolor=_FAILS),
        "the error changes its sign": jump,
        r"orbit not stable at this $\varpi$": Patch(**_ABSENT),
        f"the law differs by more than {apart:g} %": Patch(**_DIFFERS),
    }
    legend_below(figure, list(entries.values()), labels=list(entries))
    return figure


def _draw_family(axes: Axes, one: xr.Dataset) -> None:
    """The map of one n; its contours end where the ϖ jumps because the error changes its sign."""
    axes.patch.set(**_ABSENT)
    sign = np.sign(one.rule_product)
    _draw_ratios(axes, one, one.error_threshold, sign)
    axes.contour(one.restitution, np.sqrt(one.position), sign, levels=[0], **_JUMP)


def _draw_law(axes: Axes, one: xr.Dataset) -> None:
    """The map of one n by the error law, and where it differs from the branch."""
    _draw_ratios(axes, one, one.threshold_by_law, np.sign(one.rule_product))
    differs = np.abs(one.threshold_by_law / one.error_threshold - 1) > one.law_differs_above
    with plt.rc_context({"hatch.color": _DIFFERS["edgecolor"]}):
        places = one.restitution, np.sqrt(one.position)
        axes.contourf(*places, differs, levels=[0.5, 2], colors="none", hatches=["...."])


def _draw_ratios(axes: Axes, one: xr.Dataset, needed: xr.DataArray, sign: xr.DataArray) -> None:
    """Contours of ϖ, of each sign of the error for itself, and where the rule of thumb fails."""
    places = one.restitution, np.sqrt(one.position)
    rule = 1 / (one.n.item() * one.attrs["tolerance"])
    axes.contourf(*places, needed, levels=[0, rule, _END], colors=["white", _FAILS])
    for side, levels in _LEVELS.items():
        of_side = needed.where(sign == side)
        if of_side.notnull().any():
            lines = axes.contour(*places, of_side, levels=levels, **_LINE)
            axes.clabel(lines, fontsize=7, fmt="%g", manual=_label_points(lines))
    axes.contour(*places, needed, levels=[rule], **_RULE)


def _label_points(lines: ContourSet) -> list[np.ndarray]:
    """A point on the longest line of each level, away from the edges and from its neighbours."""
    longest = [max(of_level, key=len, default=np.empty(0)) for of_level in lines.allsegs]
    found = []
    for share, line in zip(cycle(_SHARES), filter(len, longest)):
        height = line[:, 1]
        wanted = height.min() + share * np.ptp(height)
        found.append(line[np.argmin(np.abs(height - wanted))])
    return found
