"""Figure 13: Poincaré map of both models."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.render.figures.branches import draw_curve
from bouncing_ball.render.figures.style import COLOURS, RESTITUTION, canvas, number


def draw(data: xr.Dataset) -> Figure:
    """Phase and velocity at the end (above) and at the start (below) of contact.

    Each curve is traced by ϖ; a few values are marked on it.
    """
    figure, (above, below) = canvas(3.6, 4.0, rows=2, sharex=True)
    ratios = data.frequency_ratio.values
    decades = [10.0**k for k in range(-2, 9) if ratios[0] <= 10.0**k <= ratios[-1]]
    wanted = sorted({*decades, *(x for x in (2.0, 5.0) if ratios[0] <= x <= ratios[-1])})
    for k, case in enumerate(data.case.values):
        curve = data.sel(case=case)
        colour = COLOURS[1 + k % (len(COLOURS) - 1)]
        for axes, phase, velocity, limit, symbol in (
            (
                above,
                curve.release_phase,
                curve.bounce_velocity,
                data.restitution_bounce_velocity,
                r"end of contact $(\varphi+\tau_b,\,z_b^{\prime})$",
            ),
            (
                below,
                curve.phase,
                curve.impact_velocity,
                data.restitution_impact_velocity,
                r"start of contact $(\varphi,\,z_i^{\prime})$",
            ),
        ):
            label = symbol if k == 0 else None
            draw_curve(axes, phase / np.pi, velocity, curve.admissible, color=colour, label=label)
            axes.plot(
                float(curve.restitution_phase) / np.pi,
                float(limit),
                "*",
                color=RESTITUTION,
                markersize=9,
                zorder=5,
                linestyle="none",
                label="restitution model" if k == 0 else None,
            )
            for value in wanted:
                at = int(np.argmin(np.abs(ratios - value)))
                point = float(phase[at]) / np.pi, float(velocity[at])
                axes.plot(*point, "o", color=colour, markersize=3)
                if value <= 10.0:
                    axes.annotate(
                        rf"$\varpi={ratios[at]:.3g}$",
                        point,
                        xytext=(5, -1),
                        textcoords="offset points",
                        fontsize=7,
                        va="center",
                    )
    above.set_ylabel(r"velocity after contact $z_b^{\prime}$")
    below.set_ylabel(r"velocity before contact $z_i^{\prime}$")
    below.set_xlabel(r"phase of the table over $\pi$")
    for axes in (above, below):
        axes.margins(x=0.12)
    above.legend(loc="best")
    below.legend(loc="best")
    above.set_title(
        rf"$n={data.attrs['n']}$, $r={number(data.attrs['restitution'])}$, "
        + ", ".join(rf"$\Lambda={number(x)}$" for x in data.amplitude.values),
        fontsize=9,
    )
    return figure
