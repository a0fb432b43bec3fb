"""The locked orbits of the restitution model on contacts, and the time until balls stick."""

from itertools import cycle

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from bouncing_ball.beyond.exhibits.motion_maps import bars
from bouncing_ball.datasets.selection import each
from bouncing_ball.drawing.canvas import legend_below, logarithmic, stacked
from bouncing_ball.drawing.labels import number_label
from bouncing_ball.drawing.style import COLOURS, Look

# The restitution model has a solid black line. The stiffer a contact, the shorter are its dashes,
# and the lighter is its colour.
_DASHES = ((0, (8, 1.5)), (0, (5, 1.5)), (0, (3, 1.2)), (0, (1.8, 1)), (0, (0.9, 0.9)))
# The lowest share of the balls that is drawn: one of the thousand.
_LOWEST = 1e-3
_LIGHTEST = 0.75
_LOOK: Look = {"color": COLOURS[1], "marker": "o"}


def locked_orbits(data: xr.Dataset) -> Figure:
    """The share with the same period over ϖ, and the share next to a discontinuity; below, the
    survival of transients for each case.
    """
    figure, (above, below) = stacked(5.4, (1.0, 1.1))
    by_ratio, jumps = above.subplots(1, 2)
    bars(by_ratio, data.frequency_ratio.values, data, "same", **_LOOK, label="known to be the same")
    most = data.same + 1 - data.same_known
    look: Look = {"color": COLOURS[0], "linewidth": 0.9, "label": "if all not known were the same"}
    by_ratio.plot(data.frequency_ratio, most, "--", **look)
    by_ratio.legend(loc="lower right", fontsize=7)
    logarithmic(by_ratio, xlabel=r"frequency ratio $\varpi$", ylim=(0, 1.03))
    by_ratio.set_ylabel("share with the same\nlocked period")
    by_ratio.set_title("by frequency ratio")
    _draw_jumps(jumps, data)
    _draw_survival(below, data)
    return figure


def _draw_jumps(jumps: Axes, data: xr.Dataset) -> None:
    """The share with another period after a change of Λ, over the change."""
    bars(jumps, data["shift"].values, data, "jump_share", **_LOOK)
    jumps.set(xlabel=r"change of $\Lambda$", xscale="log", yscale="log")
    jumps.yaxis.set_minor_formatter("{x:g}")
    jumps.set(title="next to a discontinuity", ylabel="share with another\nlocked period")


def _draw_survival(part: SubFigure, data: xr.Dataset) -> None:
    """The share of the balls that have not stuck yet, over time, in a panel for each case."""
    panels = part.subplots(1, data.sizes["case"], sharex=True, sharey=True, squeeze=False)[0]
    for axes, k in zip(panels, range(data.sizes["case"]), strict=True):
        one = data.isel(case=k)
        contacts = one.isel(life_ratio=slice(None, -1))
        shades = colormaps["plasma"](np.linspace(0.15, _LIGHTEST, contacts.sizes["life_ratio"]))
        _draw_curve(axes, one.isel(life_ratio=-1), "restitution model", color=COLOURS[0])
        for curve, shade, dashes in zip(
            each(contacts, "life_ratio"), shades, cycle(_DASHES), strict=False
        ):
            name = rf"$\varpi={number_label(float(curve.life_ratio))}$"
            _draw_curve(axes, curve, name, color=shade, linestyle=dashes)
        r, lam = (number_label(float(one[f"case_{x}"])) for x in ("restitution", "amplitude"))
        axes.set(xlabel=r"time in $T$", title=rf"transients, $r={r}$, $\Lambda={lam}$")
    panels[0].set(xscale="log", yscale="log", ylim=(_LOWEST, 1.3))
    panels[0].set_ylabel("share of balls not stuck")
    legend_below(part)


def _draw_curve(axes: Axes, curve: xr.Dataset, name: str, **look) -> None:
    """The survival in one model, up to its last value above zero."""
    share = curve.survival.where(curve.survival > 0)
    axes.step(curve.life, share, where="post", linewidth=1.1, label=name, **look)
