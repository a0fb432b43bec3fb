"""Orbit diagrams of all three models, with Lyapunov exponents."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.beyond.exhibits.motion_maps import HIGHEST_RATE, LOWEST_RATE
from bouncing_ball.drawing.canvas import WIDE, canvas, image, legend_below
from bouncing_ball.drawing.labels import parameters
from bouncing_ball.drawing.style import GUIDE, MODELS, Look


def orbit_diagrams(data: xr.Dataset) -> Figure:
    """Density of the phases of impact over Λ for each model; below, the largest exponents."""
    models = data["model"].values
    ratios = [1.0] * len(models) + [0.6]
    figure, panels = canvas(WIDE, 8.0, rows=len(ratios), sharex=True, height_ratios=ratios)
    lam = data["amplitude"].values
    # The bins of the phase are all of a period.
    extent = (*(1.5 * lam[[0, -1]] - 0.5 * lam[[1, -2]]), -1.0, 1.0)
    for axes, model, sign in zip(panels, models, "ox+", strict=False):
        one = data.sel(model=model)
        # The square root of the density shows an orbit and a chaotic motion in one picture.
        shade = np.sqrt(one.phase_density.values.T)
        image(axes, shade, extent, cmap="gist_heat_r", vmin=0, vmax=0.5)
        axes.set_ylabel(r"phase of impact $\varphi/\pi$")
        shown = ["restitution"] if model == "restitution" else ["restitution", "frequency_ratio"]
        axes.set_title(f"{model} model; {parameters(data, *shown)}")
        exponent = one.lyapunov_exponent.values.clip(LOWEST_RATE, HIGHEST_RATE)
        # A line through the exponents of chaotic and locked motions in turn would hide them.
        look: Look = MODELS[model] | {"linestyle": "none", "markersize": 2.5}
        panels[-1].plot(lam, exponent, sign, mew=0.6, label=f"{model} model", **look)
    panels[-1].axhline(0, **GUIDE)
    panels[-1].set(xlabel=r"amplitude $\Lambda$", ylabel=r"largest $\lambda$ per $T$")
    legend_below(figure, panels[-1].get_legend_handles_labels()[0], ncols=3)
    return figure
