"""Predictors of the stiffness at which a contact has the restitution model's locked orbit."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.beyond.exhibits.motion_maps import bars
from bouncing_ball.drawing.canvas import WIDE, canvas, coloured, logarithmic
from bouncing_ball.drawing.labels import number
from bouncing_ball.drawing.style import COLOURS, GUIDE, Look

_DASHES = ("-", (0, (4, 1.5)), (0, (1, 1.2)), (0, (6, 1.5, 1, 1.5)))
_BEYOND = 1e15
_LOOK: Look = {"color": COLOURS[1], "marker": "o"}


def locked_orbits(data: xr.Dataset) -> Figure:
    """The share with the same period by ϖ over its scale and by ϖ, the share next to a
    discontinuity, and the survival of transients.
    """
    figure, ((by_place, by_ratio), (jumps, lives)) = canvas(WIDE, 5.4, rows=2, columns=2)
    _draw_predictions(by_place, by_ratio, data)
    _draw_jumps(jumps, data)
    _draw_survival(lives, data)
    return figure


def _draw_predictions(by_place: Axes, by_ratio: Axes, data: xr.Dataset) -> None:
    """The share with the same period, by the prediction for all ϖ together and by ϖ."""
    bars(by_place, data.predicted.values, data, "same_by_prediction", **_LOOK)
    by_place.axvline(1.0, **GUIDE)
    logarithmic(by_place, xlabel=r"$\varpi\,/\max(S/W, P)$", ylim=(0, 1.03))
    by_place.set_ylabel("share with the same\nlocked period")
    by_place.set_title(r"all $\varpi$ together, by the prediction")
    scale = np.maximum(data.sensitivity / data.wait, data.peak)
    wanted = np.sort(scale.dropna("node").values)
    share = np.arange(1, wanted.size + 1) / wanted.size
    by_ratio.plot(wanted, share, color=COLOURS[3], label=r"$\varpi\geq\max(S/W, P)$")
    bars(by_ratio, data.frequency_ratio.values, data, "same", label="contact", **_LOOK, ls="none")
    by_ratio.set(
        xlabel=r"frequency ratio $\varpi$", ylim=(0, 1.03), xlim=(1, _BEYOND), xscale="log"
    )
    by_ratio.set_title("by frequency ratio")
    by_ratio.legend(loc="lower right")


def _draw_jumps(jumps: Axes, data: xr.Dataset) -> None:
    """The share with another period after a change of Λ, over the change."""
    bars(jumps, data["shift"].values, data, "jump_share", **_LOOK)
    jumps.set(xlabel=r"change of $\Lambda$", xscale="log", yscale="log")
    jumps.yaxis.set_minor_formatter("{x:g}")
    jumps.set(title="next to a discontinuity", ylabel="share with another\nlocked period")


def _draw_survival(lives: Axes, data: xr.Dataset) -> None:
    """The share of the balls that are not locked yet, over time."""
    for one, colour in coloured(data, "case"):
        r, lam = (number(float(one[f"case_{x}"])) for x in ("restitution", "amplitude"))
        lives.plot([], [], color=colour, label=rf"$r={r}$, $\Lambda={lam}$")
        for curve, dashes in zip(one.survival.values, _DASHES, strict=False):
            lives.step(data.life, curve, color=colour, linestyle=dashes, where="post", linewidth=1)
    for ratio, dashes in zip(data.life_ratio.values, _DASHES, strict=False):
        name = "restitution" if np.isinf(ratio) else rf"$\varpi={number(float(ratio))}$"
        lives.plot([], [], color="#8c8c8c", linestyle=dashes, label=name)
    lives.set(xlabel="table periods", ylabel="share of balls not locked", title="transients")
    lives.set(xscale="log", yscale="log", ylim=(0.01, 6))
    lives.legend(fontsize=6, ncols=2, loc="upper right")
