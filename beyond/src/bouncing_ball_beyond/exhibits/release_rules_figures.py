"""Stiffness, damping and restitution of a contact, and how they depend on each other."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball_beyond.inherited.drawing.canvas import WIDE, canvas, legend_below
from bouncing_ball_beyond.inherited.drawing.labels import note
from bouncing_ball_beyond.inherited.drawing.style import COLOURS, TABLE, Look

_LOOKS: dict[str, Look] = {
    "displacement": {"color": COLOURS[0], "linestyle": "-", "linewidth": 1.4},
    "force": {"color": COLOURS[1], "linestyle": (0, (4, 1.5)), "linewidth": 1.8},
}
# The place of the text r beside each end of the contact, in points.
_PLACES: dict[str, dict[str, Any]] = {
    "displacement": {"offset": (-7, 0), "ha": "right", "va": "center"},
    "force": {"offset": (2, 6), "ha": "left", "va": "bottom"},
}


def free_impacts(data: xr.Dataset) -> Figure:
    """ext_impact: the force in one contact with both ends; restitution and duration over ζ."""
    figure, (force, restitution, duration) = canvas(WIDE, 2.6, columns=3)
    load = data.free_force
    force.axhline(0, color=TABLE, linewidth=0.7)
    force.plot(data.time, load, color=COLOURS[0], linewidth=1.4)
    force.fill_between(
        data.time, load.where(load <= 0), facecolor="#e6e6e6", hatch="////", edgecolor=TABLE
    )
    # The displacement release is at the end of the contact; the force release, where the force is
    # zero.
    for (rule, look), height in zip(_LOOKS.items(), (float(load[-1]), 0.0), strict=True):
        one = data.sel(release=rule)
        restitution.plot(data.damping_ratio, one.restitution, label=f"{rule} release", **look)
        duration.plot(data.damping_ratio, one.contact_duration / np.pi, **look)
        end = (float(one.contact_end), height)
        force.plot(*end, "o", color=look["color"], markersize=5, zorder=5)
        text = f"$r={float(one.end_restitution):.2f}$"
        note(force, text, end, color=look["color"], fontsize=8, **_PLACES[rule])
    name = r"damping ratio $\zeta = c\,/\,(2\sqrt{km})$"
    force.set(xlabel=r"time $\omega t$,  $\omega = \sqrt{k/m}$", ylabel=r"force $/\,(m\omega v)$")
    force.set_xticks(np.pi * np.arange(3) / 2, ["0", r"$\pi/2$", r"$\pi$"])
    force.set_title("one contact; hatched: the wall pulls")
    force.margins(y=0.12)
    restitution.set(xlabel=name, ylabel="$r$", title="restitution coefficient", ylim=(0, 1.05))
    duration.set(xlabel=name, ylabel=r"$t_c\,\omega/\pi$", title="contact time", ylim=(0, 1.3))
    legend_below(figure, restitution.get_lines(), ncols=2)
    return figure
