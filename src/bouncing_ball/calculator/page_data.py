"""What the page of a design shows, computed: the validity chart and the motion."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.errors import SIMPLE
from bouncing_ball.accuracy.thresholds import ThresholdStatus, search
from bouncing_ball.calculator.needed import RATIOS
from bouncing_ball.calculator.results import Design
from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.release import Release
from bouncing_ball.orbits.orbit import Orbit

# Restitution coefficients of the chart: as many as make the lines smooth, and from
# which on. A linear contact that only pushes has r > e⁻².
_CHART = 33
_LEAST = {Release.DISPLACEMENT: 0.05, Release.FORCE: 0.15}
_SAMPLES = 1201
# Of the enlarged contact: how many contact times are shown before it and in all.
_BEFORE, _SHOWN = 0.75, 3.0


def page(design: Design) -> xr.Dataset:
    """The validity chart over r, one cycle, and one contact, in SI units.

    Variables are NaN where there is no orbit or no threshold.
    """
    table, rule = design.case.table, design.case.release
    # Below the first r the family does not exist at Λ; the contact's own r is shown.
    half, lam = design.n * np.pi, table.amplitude
    least = (half - lam) / (half + lam)
    least = min(max(least, _LEAST[rule]), design.corrected.restitution)
    chart = np.linspace(least, 1.0, _CHART)
    asked = design.needed
    zeta = damping_ratio(chart, rule)
    found = search(zeta, rule, design.n, lam, RATIOS, asked.tolerance, (asked.quantity,))
    always = found.status == ThresholdStatus.ALWAYS_WITHIN
    from_there_on = np.where(always, RATIOS[0], found.threshold)[:, 0]
    of = design.case.models
    orbits = {name: model.orbit(design.n, table.amplitude) for name, model in of.items()}
    return xr.Dataset(
        {
            "needed": (("simple", "restitution"), from_there_on),
            **_motion(orbits, design),
            **_contact(orbits, design),
        },
        coords={"simple": list(SIMPLE), "restitution": chart, "model": list(orbits)},
    )


def _motion(orbits: Mapping[str, Orbit], design: Design) -> dict:
    """Heights of table and ball over one cycle from the table's phase 0, and a bit of the next."""
    table = design.case.table
    angle = np.linspace(0.0, 2 * np.pi * (design.n + 0.25), _SAMPLES)
    heights = [orbit.path(angle - orbit.phase)[0] for orbit in orbits.values()]
    return {
        "time": ("time", angle * table.time),
        "table": ("time", table.height * np.sin(angle)),
        "ball": (("model", "time"), np.array(heights) * table.length),
    }


def _contact(orbits: Mapping[str, Orbit], design: Design) -> dict:
    """Distance from the table about the contact of the exact model, or of the first there is."""
    table = design.case.table
    start = next(float(orbit.phase) for orbit in orbits.values() if orbit.exists)
    duration = float(design.case.contact.free_duration)
    since = np.linspace(-_BEFORE * duration, (_SHOWN - _BEFORE) * duration, _SAMPLES)
    gaps = [
        orbit.path(start + since - orbit.phase)[0] - table.amplitude * np.sin(start + since)
        for orbit in orbits.values()
    ]
    return {
        "since": ("since", since * table.time),
        "gap": (("model", "since"), np.array(gaps) * table.length),
    }
