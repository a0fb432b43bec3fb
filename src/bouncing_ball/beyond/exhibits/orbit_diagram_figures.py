"""Orbit diagrams of all three models, with Lyapunov exponents."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.beyond.exhibits.motion_maps import HIGHEST_RATE, LOWEST_RATE
from bouncing_ball.drawing.canvas import WIDE, canvas, legend_below
from bouncing_ball.drawing.labels import parameters
from bouncing_ball.drawing.style import GUIDE, MODELS, Look

# Area of a point in square points, and the largest share of the impacts whose point is not black.
_POINT = 0.25
_DARK = 0.1


def orbit_diagrams(data: xr.Dataset) -> Figure:
    """Phases of impact over Λ for each model, as points that are the darker the larger their share;
    below, the largest exponents.
    """
    models = data["model"].values
    ratios = [1.0] * len(models) + [0.6]
    figure, panels = canvas(WIDE, 8.0, rows=len(ratios), sharex=True, height_ratios=ratios)
    lam = data["amplitude"].values
    for axes, model, sign in zip(panels, models, "ox+", strict=False):
        one = data.sel(model=model)
        _draw_phases(axes, one)
        shown = ["restitution"] if model == "restitution" else ["restitution", "frequency_ratio"]
        axes.set_title(f"{model} model; {parameters(data, *shown)}")
        exponent = one.lyapunov_exponent.values.clip(LOWEST_RATE, HIGHEST_RATE)
        # A line through the exponents of chaotic and locked motions in turn would hide them.
        look: Look = MODELS[model] | {"linestyle": "none", "markersize": 1.5}
        panels[-1].plot(lam, exponent, sign, mew=0.4, label=f"{model} model", **look)
    panels[-1].axhline(0, **GUIDE)
    panels[-1].set(xlabel=r"amplitude $\Lambda$", ylabel=r"largest $\lambda$ per $T$")
    panels[-1].set_xlim(lam[0], lam[-1])
    legend_below(figure, panels[-1].get_legend_handles_labels()[0], ncols=3)
    return figure


def _draw_phases(axes: Axes, one: xr.Dataset) -> None:
    """A point at each Λ and each range of phases that has impacts."""
    density = one.phase_density.transpose("bin_phase", "amplitude").values
    phase, lam = density.nonzero()
    # The square root of the density shows an orbit and a chaotic motion in one picture.
    shade = np.sqrt(np.minimum(density[phase, lam] / _DARK, 1.0))
    axes.scatter(
        one.amplitude.values[lam],
        one.bin_phase.values[phase] / np.pi,
        s=_POINT,
        c=shade,
        cmap="binary",
        vmin=-0.5,
        vmax=1.0,
        linewidths=0,
        rasterized=True,
    )
    axes.set(ylabel=r"phase of impact $\varphi/\pi$", ylim=(-1, 1))
