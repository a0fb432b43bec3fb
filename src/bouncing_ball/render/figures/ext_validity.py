"""Extension: the frequency ratio from which each model is right."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.render.figures.style import COLOURS, WIDE, canvas

_LOOKS = ("-", (0, (4, 1.5)), (0, (1, 1.2)), "-.", (0, (6, 1, 1, 1)))


def draw(data: xr.Dataset) -> Figure:
    """One panel for each quantity: thick the restitution model, thin the corrected one."""
    figure, panels = canvas(WIDE, 4.4, rows=2, columns=3, sharex=True, sharey=True)
    for axes, quantity in zip(np.ravel(panels), data.quantity.values, strict=True):
        for n, colour in zip(data.n.values, COLOURS, strict=False):
            for place, look in zip(data.amplitude_ratio.values, _LOOKS, strict=False):
                for model, width in (("restitution", 1.9), ("corrected", 0.9)):
                    found = data.error_threshold.sel(
                        model=model, quantity=quantity, n=n, amplitude_ratio=place
                    )
                    axes.plot(
                        data.restitution, found, color=colour, linestyle=look, linewidth=width
                    )
        axes.set_yscale("log")
        axes.set_title(str(quantity).replace("_", " "), fontsize=9)
        axes.grid(visible=True, axis="y", linewidth=0.3)
    for axes in panels[-1]:
        axes.set_xlabel("restitution coefficient $r$")
    for axes in panels[:, 0]:
        axes.set_ylabel(rf"$\varpi$ for {100 * data.attrs['tolerance']:g} %")
    first = panels[0, 0]
    handles = [
        *(
            first.plot([], [], color=colour, label=f"$n={n}$")[0]
            for n, colour in zip(data.n.values, COLOURS, strict=False)
        ),
        *(
            first.plot(
                [],
                [],
                color="#5f5f5f",
                linestyle=look,
                label=rf"$\Lambda={place:g}\,\Lambda_{{SN}}$",
            )[0]
            for place, look in zip(data.amplitude_ratio.values, _LOOKS, strict=False)
        ),
        first.plot([], [], color="#5f5f5f", linewidth=1.9, label="restitution")[0],
        first.plot([], [], color="#5f5f5f", linewidth=0.9, label="corrected")[0],
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=4)
    return figure
