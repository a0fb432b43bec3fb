"""Orbit diagrams of all three models, with Lyapunov exponents."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.beyond.exhibits.motion_maps import LOWEST_RATE
from bouncing_ball.drawing.canvas import WIDE, canvas, image, legend_below
from bouncing_ball.drawing.labels import parameters
from bouncing_ball.drawing.style import GUIDE, MODELS, Look

# Ranges of the phase that are drawn as one, the largest share of the impacts whose range is not
# black, and the lightest grey of a range with impacts.
_TOGETHER = 4
_DARK = 0.15
_LIGHTEST = 0.25
# The place of exponents below all others, in λ below the lowest finite one.
_GAP = 0.5


def orbit_diagrams(data: xr.Dataset) -> Figure:
    """Phases of impact over Λ for each model, the darker the larger their share; below, the largest
    exponents.
    """
    models = data["model"].values
    ratios = [1.0] * len(models) + [1.0]
    figure, panels = canvas(WIDE, 8.6, rows=len(ratios), sharex=True, height_ratios=ratios)
    lam = data["amplitude"].values
    for axes, model in zip(panels, models, strict=False):
        one = data.sel(model=model)
        _draw_phases(axes, one)
        shown = ["restitution"] if model == "restitution" else ["restitution", "frequency_ratio"]
        axes.set_title(f"{model} model; {parameters(data, *shown)}")
    _draw_exponents(panels[-1], data)
    panels[-1].set(xlabel=r"amplitude $\Lambda$", xlim=(lam[0], lam[-1]))
    legend_below(figure, markerscale=2.5)
    return figure


def _draw_exponents(axes: Axes, data: xr.Dataset) -> None:
    """The largest exponents; those of orbits that lock, below the lowest rate, have a line of marks
    for each model at the bottom.
    """
    finite = data.lyapunov_exponent.where(data.lyapunov_exponent >= LOWEST_RATE)
    for k, (model, sign) in enumerate(zip(data["model"].values, "ox+", strict=False)):
        one = data.lyapunov_exponent.sel(model=model)
        # A line through the exponents of chaotic and locked motions in turn would hide them.
        look: Look = MODELS[model] | {"linestyle": "none", "markersize": 1.8, "mew": 0.4}
        place = one.where(one >= LOWEST_RATE, LOWEST_RATE - _GAP * (1 + k / 2))
        axes.plot(data["amplitude"], place, sign, label=f"{model} model", **look)
    axes.axhline(0, **GUIDE)
    axes.axhline(LOWEST_RATE - _GAP / 2, color="black", linewidth=0.5)
    ticks = [*np.arange(np.ceil(LOWEST_RATE), np.floor(float(finite.max())) + 1)]
    lowest = LOWEST_RATE - _GAP * (1 + (data.sizes["model"] - 1) / 4)
    names = [f"${tick:g}$" for tick in ticks] + [f"below ${LOWEST_RATE:g}$"]
    axes.set_yticks([*ticks, lowest], names)
    axes.set_ylabel(r"largest $\lambda$ per $T$")


def _draw_phases(axes: Axes, one: xr.Dataset) -> None:
    """The share of the impacts at each Λ and in each range of phases."""
    bins = one.bin_phase.size // _TOGETHER
    density = one.phase_density.transpose("bin_phase", "amplitude").values
    density = density[: bins * _TOGETHER].reshape(bins, _TOGETHER, -1).sum(axis=1)
    # The square root of the density shows an orbit and a chaotic motion in one picture.
    shade = _LIGHTEST + (1 - _LIGHTEST) * np.sqrt(np.minimum(density / _DARK, 1.0))
    lam = one.amplitude.values
    half = (lam[1] - lam[0]) / 2
    shown = np.where(density > 0, shade, 0.0)
    extent = lam[0] - half, lam[-1] + half, -1.0, 1.0
    image(axes, shown, extent, cmap="binary", vmin=0.0, vmax=1.0)
    axes.set(ylabel=r"phase of impact $\varphi/\pi$", ylim=(-1, 1))
