"""Figure 13: Poincaré map of both models."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball.render.figures.branches import draw_curve
from bouncing_ball.render.figures.style import COLOURS, RESTITUTION, Look, canvas, number


def _marked(ratios: np.ndarray) -> list[float]:
    """The decades of ϖ in the range, and 2 and 5."""
    marked = {*(10.0**k for k in range(-2, 9)), 2.0, 5.0}
    return sorted(value for value in marked if ratios[0] <= value <= ratios[-1])


def _draw_trace(axes: Axes, ratios: np.ndarray, phase, velocity, admissible, **look) -> None:
    """Phase and velocity as ϖ varies, a few of its values marked, the small ones named."""
    draw_curve(axes, phase / np.pi, velocity, admissible, **look)
    for value in _marked(ratios):
        at = int(np.argmin(np.abs(ratios - value)))
        point = float(phase[at]) / np.pi, float(velocity[at])
        axes.plot(*point, "o", color=look["color"], markersize=3)
        if value <= 10.0:
            axes.annotate(
                rf"$\varpi={ratios[at]:.3g}$",
                point,
                xytext=(5, -1),
                textcoords="offset points",
                fontsize=7,
                va="center",
            )


def _draw_limit(axes: Axes, phase, velocity, label: str | None) -> None:
    """The point of the restitution model."""
    look: Look = {"markersize": 9, "zorder": 5, "linestyle": "none", "color": RESTITUTION}
    axes.plot(float(phase) / np.pi, float(velocity), "*", label=label, **look)


def draw(data: xr.Dataset) -> Figure:
    """Phase and velocity at the end (above) and at the start (below) of contact.

    Each curve is traced by ϖ; a few values are marked on it.
    """
    figure, (above, below) = canvas(3.6, 4.0, rows=2, sharex=True)
    ratios = data.frequency_ratio.values
    for k, case in enumerate(data.case.values):
        curve = data.sel(case=case)
        end = (above, curve.release_phase, curve.bounce_velocity, data.restitution_bounce_velocity)
        start = (below, curve.phase, curve.impact_velocity, data.restitution_impact_velocity)
        for (axes, phase, velocity, limit), symbol in (
            (end, r"end of contact $(\varphi+\tau_b,\,z_b^{\prime})$"),
            (start, r"start of contact $(\varphi,\,z_i^{\prime})$"),
        ):
            # Named once for all cases.
            labels = (symbol, "restitution model") if k == 0 else (None, None)
            look = {"color": COLOURS[1 + k % (len(COLOURS) - 1)], "label": labels[0]}
            _draw_trace(axes, ratios, phase, velocity, curve.admissible, **look)
            _draw_limit(axes, curve.restitution_phase, limit, labels[1])
    above.set_ylabel(r"velocity after contact $z_b^{\prime}$")
    below.set_ylabel(r"velocity before contact $z_i^{\prime}$")
    below.set_xlabel(r"phase of the table over $\pi$")
    for axes in (above, below):
        axes.margins(x=0.12)
    above.legend(loc="best")
    below.legend(loc="best")
    above.set_title(
        rf"$n={data.attrs['n']}$, $r={number(data.attrs['restitution'])}$, "
        + ", ".join(rf"$\Lambda={number(x)}$" for x in data["amplitude"].values),
        fontsize=9,
    )
    return figure
