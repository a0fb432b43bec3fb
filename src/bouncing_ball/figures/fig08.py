"""Figure 8: existence and stability domains of the 1-T orbits."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.domains import draw_domains


def draw(data: xr.Dataset) -> Figure:
    """The domains for several frequency ratios."""
    return draw_domains(data)
