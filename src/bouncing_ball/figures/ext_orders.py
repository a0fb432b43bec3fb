"""Extension: relative errors of the restitution and the corrected model along ϖ."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.quantities import NAMES
from bouncing_ball.figures.style import (
    COLOURS,
    GUIDE,
    RESTITUTION,
    WIDE,
    canvas,
    logarithmic,
    parameters,
)

_CORRECTED = COLOURS[3]


def draw(data: xr.Dataset) -> Figure:
    """One panel for each quantity, with the slopes 1 and 2."""
    figure, panels = canvas(WIDE, 4.2, rows=2, columns=3, sharex=True, sharey=True)
    ratio = data.frequency_ratio.values
    for axes, quantity in zip(np.ravel(panels), data.quantity.values, strict=True):
        for model, colour in (("restitution", RESTITUTION), ("corrected", _CORRECTED)):
            error = data.relative_error.sel(model=model, quantity=quantity).values
            axes.plot(ratio, error, color=colour, label=model)
            order = int(model == "corrected") + 1
            middle = np.nanmedian(data.order.sel(model=model, quantity=quantity).values)
            # A guide of the slope through the last point.
            axes.plot(ratio, error[-1] * (ratio[-1] / ratio) ** order, **GUIDE)
            axes.text(
                0.97,
                0.93 - 0.11 * (order - 1),
                f"order {middle:.2f}",
                transform=axes.transAxes,
                ha="right",
                va="top",
                color=colour,
                fontsize=8,
            )
        logarithmic(axes)
        axes.set_yscale("log")
        axes.set_title(NAMES[str(quantity)], fontsize=9)
        axes.set(xlim=(ratio[0], ratio[-1]), ylim=(1e-9, 3.0))
    for axes in panels[-1]:
        axes.set_xlabel(r"frequency ratio $\varpi$")
    for axes in panels[:, 0]:
        axes.set_ylabel("relative error")
    figure.suptitle(
        f"{parameters(data, 'n', 'restitution', 'amplitude')}; orders of "
        f"{data.sizes['sample']} random orbits, median",
        fontsize=9,
    )
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure
