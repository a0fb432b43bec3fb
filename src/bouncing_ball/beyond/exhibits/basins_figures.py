"""The motions on which balls with many initial phases and speeds end, in three models."""

import numpy as np
import xarray as xr
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from bouncing_ball.drawing.canvas import WIDE, canvas, image, legend_below
from bouncing_ball.drawing.labels import number_label
from bouncing_ball.drawing.style import Look

# Colours in the order of the motions; they are five steps of grey.
_FILLS = ("#ffffff", "#d3e6f2", "#e0a030", "#3f7fae", "#000000")


def basins(data: xr.Dataset) -> Figure:
    """A row for each case, with a panel for each model and one for the uncertainty exponent.

    In the panel of a model each start has the colour of the motion on which the ball ends.
    """
    cases = data.sizes["case"]
    models = data["model"].values
    size: Look = {"rows": cases, "columns": len(models), "sharex": True, "sharey": True}
    figure, rows = canvas(WIDE, 0.6 + 2.5 * cases, **size, squeeze=False)
    extent = -1.0, 1.0, 0.0, data.attrs["velocity_max"]
    look: Look = {"cmap": ListedColormap(_FILLS), "vmin": -0.5, "vmax": len(_FILLS) - 0.5}
    for case, model in np.ndindex(rows.shape):
        axes = rows[case, model]
        one = data.isel(case=case, model=model)
        image(axes, one.destination, extent, **look)
        alpha = f"{float(one.uncertainty_exponent):.2f}"
        low = f"{float(one.uncertainty_exponent_low):.2f}"
        high = f"{float(one.uncertainty_exponent_high):.2f}"
        axes.set_title(rf"{models[model]}; $\alpha={alpha}$ ({low} to {high})", fontsize=8)
    for row, case in zip(rows, data.case.values, strict=True):
        place = data.sel(case=case)
        r = number_label(float(place.restitution))
        ratio = number_label(float(place.frequency_ratio))
        lam = number_label(float(place.amplitude))
        name = rf"$r={r}$, $\varpi={ratio}$, $\Lambda={lam}$"
        row[0].set_ylabel(f"{name}\nspeed of impact $-\\delta′$")
    for axes in rows[-1]:
        axes.set_xlabel(r"phase of impact $\varphi/\pi$")
    look = {"edgecolor": "#000000", "linewidth": 0.5}
    entries = zip(_FILLS, data.motion.values, strict=True)
    handles = [Patch(facecolor=fill, label=str(motion), **look) for fill, motion in entries]
    legend_below(figure, handles, ncols=len(handles), fontsize=7)
    return figure
