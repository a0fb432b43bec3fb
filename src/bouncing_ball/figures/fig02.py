"""Figure 2: 1-T response of the restitution-coefficient model."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.style import RESTITUTION, TABLE, canvas, parameters


def draw(data: xr.Dataset) -> Figure:
    """Ball and table against time in periods of the table."""
    figure, axes = canvas(height=2.4)
    periods = data.time / (2 * np.pi)
    axes.plot(periods, data.ball, color=RESTITUTION, label="ball $z$")
    axes.plot(periods, data.table, color=TABLE, label="table $w$")
    axes.set(xlabel=r"time $\tau/2\pi$", ylabel="$z$, $w$", xlim=(0, float(periods[-1])))
    axes.set_title(parameters(data, "n", "restitution", "amplitude"), fontsize=9)
    axes.set_ylim(top=1.25 * float(data.ball.max()))
    axes.legend(loc="upper center", ncols=2)
    return figure
