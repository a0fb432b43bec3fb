"""Extension: where balls end, by the phase and the speed of their first impact."""

import numpy as np
import xarray as xr
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from bouncing_ball.figures.style import WIDE, Look, canvas, number

# In the order of the motions; five steps of grey.
_FILLS = ("#ffffff", "#b9d7ea", "#b34a10", "#e0a030", "#000000")
_ORBIT: Look = {
    "linestyle": "none",
    "color": "#000000",
    "markerfacecolor": "#ffffff",
    "markersize": 5,
    "zorder": 3,
}
_MARKS = ("", "o", "^", "", "")


def draw(data: xr.Dataset) -> Figure:
    """One panel for each Λ; each start has the colour of the motion it leads to."""
    columns = data.sizes["case"]
    figure, panels = canvas(WIDE, 3.1, columns=columns, sharey=True, squeeze=False)
    top = data.attrs["velocity_max"]
    for case, axes in zip(data.case.values, panels[0], strict=True):
        one = data.sel(case=case)
        axes.imshow(
            one.destination,
            origin="lower",
            extent=(-1.0, 1.0, 0.0, top),
            aspect="auto",
            interpolation="none",
            cmap=ListedColormap(_FILLS),
            vmin=-0.5,
            vmax=len(_FILLS) - 0.5,
        )
        for k, mark in enumerate(_MARKS):
            if mark and np.isfinite(one.orbit_phase[k]):
                axes.plot(one.orbit_phase[k] / np.pi, one.orbit_speed[k], marker=mark, **_ORBIT)
        # Not the attribute of this name, which is a list.
        amplitude = number(float(one["amplitude"]))
        axes.set_title(rf"$\Lambda={amplitude}$", fontsize=9)
        axes.set_xlabel(r"phase of impact $\varphi/\pi$")
        for side in ("top", "right"):
            axes.spines[side].set_visible(True)
    panels[0, 0].set_ylabel(r"relative speed of impact $-\delta′$")
    handles = [
        Patch(facecolor=fill, edgecolor="#000000", linewidth=0.5, label=str(motion))
        for fill, motion in zip(_FILLS, data.motion.values, strict=True)
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), fontsize=7)
    return figure
