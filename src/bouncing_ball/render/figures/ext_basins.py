"""Extension: where balls end, by the phase and the speed of their first impact."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from bouncing_ball.render.figures.style import WIDE, Look, canvas, number

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
# Of the starts so many are one cell of the picture along each axis: all of them as
# vectors would be three megabytes.
_EVERY = 2


def _cells(where: np.ndarray, top: float) -> Path:
    """Rectangles over the runs of true cells in each row, in units of the axes."""
    rows, columns = where.shape
    edges = np.diff(where.astype(np.int8), axis=1, prepend=0, append=0)
    row, begin = np.nonzero(edges > 0)
    _, end = np.nonzero(edges < 0)
    left, right = 2 * begin / columns - 1, 2 * end / columns - 1
    low, high = top * row / rows, top * (row + 1) / rows
    corners = np.array([[left, low], [right, low], [right, high], [left, high], [left, low]])
    codes = [Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY]
    return Path(corners.transpose(2, 0, 1).reshape(-1, 2), np.tile(codes, row.size))


def _draw_map(axes: Axes, destination: np.ndarray, top: float) -> None:
    """One shape for each motion, on the colour of the most frequent one."""
    axes.set(xlim=(-1.0, 1.0), ylim=(0.0, top))
    frequent = int(np.bincount(destination.ravel(), minlength=len(_FILLS)).argmax())
    axes.set_facecolor(_FILLS[frequent])
    for kind, fill in enumerate(_FILLS):
        where = destination == kind
        if kind == frequent or not where.any():
            continue
        axes.add_patch(
            PathPatch(_cells(where, top), facecolor=fill, linewidth=0, antialiased=False)
        )


def draw(data: xr.Dataset) -> Figure:
    """One panel for each Λ; each start has the colour of the motion it leads to."""
    columns = data.sizes["case"]
    figure, panels = canvas(WIDE, 3.1, columns=columns, sharey=True, squeeze=False)
    top = data.attrs["velocity_max"]
    for case, axes in zip(data.case.values, panels[0], strict=True):
        one = data.sel(case=case)
        _draw_map(axes, one.destination.values[::_EVERY, ::_EVERY], top)
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
