"""Curves along ϖ for several amplitudes, distinguished by dashes too (Figs. 6 and 10)."""

import xarray as xr
from matplotlib.axes import Axes

from bouncing_ball.figures.branches import draw_curve
from bouncing_ball.figures.style import COLOURS, logarithmic, number

_LOOKS = ("-", (0, (5, 1.5)), (0, (1, 1)), (0, (5, 1.5, 1, 1.5)))


def draw_amplitudes(axes: Axes, data: xr.Dataset, variable: str) -> None:
    """One curve for each case, labelled by its Λ."""
    for k, case in enumerate(data.case.values):
        curve = data.sel(case=case)
        draw_curve(
            axes,
            curve.frequency_ratio,
            curve[variable],
            curve.admissible,
            color=COLOURS[k % len(COLOURS)],
            linestyle=_LOOKS[k % len(_LOOKS)],
            label=rf"$\Lambda={number(float(curve.amplitude))}$",
        )
    logarithmic(axes, data.frequency_ratio)
