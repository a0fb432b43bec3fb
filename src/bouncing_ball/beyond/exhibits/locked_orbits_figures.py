"""The locked orbits of the restitution model on contacts, and the time until balls stick."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from bouncing_ball.beyond.exhibits.motion_maps import bars
from bouncing_ball.drawing.canvas import coloured, legend_below, logarithmic, stacked
from bouncing_ball.drawing.labels import number
from bouncing_ball.drawing.style import COLOURS, Look

_DASHES = ("-", (0, (4, 1.5)), (0, (1, 1.2)), (0, (6, 1.5, 1, 1.5)))
_LOOK: Look = {"color": COLOURS[1], "marker": "o"}


def locked_orbits(data: xr.Dataset) -> Figure:
    """The share with the same period over ϖ, and the share next to a discontinuity; below, the
    survival of transients for each case.
    """
    figure, (above, below) = stacked(5.4, (1.0, 1.1))
    by_ratio, jumps = above.subplots(1, 2)
    bars(by_ratio, data.frequency_ratio.values, data, "same", **_LOOK, label="known")
    most = data.same + 1 - data.same_known
    look: Look = {"color": COLOURS[0], "linewidth": 0.9, "label": "known or not known"}
    by_ratio.plot(data.frequency_ratio, most, "--", **look)
    by_ratio.legend(loc="upper left", fontsize=7)
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
        for (curve, colour), dashes in zip(coloured(one, "life_ratio"), _DASHES, strict=False):
            ratio = float(curve.life_ratio)
            name = "restitution" if np.isinf(ratio) else rf"$\varpi={number(ratio)}$"
            look: Look = {"color": colour, "linestyle": dashes, "where": "post", "linewidth": 1.1}
            axes.step(data.life, curve.survival, label=name, **look)
        r, lam = (number(float(one[f"case_{x}"])) for x in ("restitution", "amplitude"))
        axes.set(xlabel="table periods", title=rf"transients, $r={r}$, $\Lambda={lam}$")
    panels[0].set(xscale="log", yscale="log", ylim=(0.01, 1.3))
    panels[0].set_ylabel("share of balls not stuck")
    legend_below(part)
