"""Extension: errors of both simple models on contacts of five laws."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.laws import LAWS
from bouncing_ball.figures.quantities import NAMES
from bouncing_ball.figures.style import GUIDE, WIDE, canvas, parameters


def draw(data: xr.Dataset) -> Figure:
    """One panel for each quantity, both models, over the share of the cycle in contact."""
    shown = [str(x) for x in data["quantity"].values]
    figure, panels = canvas(WIDE, 5.0, rows=2, columns=3, sharex=True, sharey=True)
    share = 1 / (2 * data.attrs["n"] * data.duration_ratio.values)
    for axes, quantity in zip(np.ravel(panels), shown, strict=False):
        for law in data["law"].values:
            part = data.relative_error.sel(law=law, quantity=quantity)
            for model in data.model.values:
                label = str(law) if model == "restitution" else None
                axes.plot(
                    share, part.sel(model=model), linewidth=1.1, label=label, **LAWS[str(law)]
                )
        for slope in (1, 2):
            axes.plot(share[[0, -1]], share[[0, -1]] ** slope, **GUIDE)
        axes.set(xscale="log", yscale="log")
        axes.set_title(NAMES[quantity], fontsize=9)
    for axes in panels[-1]:
        axes.set_xlabel(r"share of the cycle in contact, $D/(2\pi n)$")
    for axes in panels[:, 0]:
        axes.set_ylabel("relative error")
    spare = np.ravel(panels)[len(shown)]
    spare.axis("off")
    handles, labels = np.ravel(panels)[0].get_legend_handles_labels()
    note = (
        "upper five: restitution model\nlower five: corrected model\ndotted: slopes 1 and 2\n"
        + parameters(data, "n", "restitution", "amplitude")
    )
    spare.legend(handles, labels, loc="upper left", title=note, title_fontsize=8, fontsize=8)
    return figure
