"""The data drawn on the page of a design: the validity chart and the motion."""

import numpy as np
import xarray as xr

from bouncing_ball_beyond.accuracy.errors import as_deviation
from bouncing_ball_beyond.accuracy.simple_models import SIMPLE, search
from bouncing_ball_beyond.inherited.accuracy.thresholds import RATIOS, ThresholdStatus
from bouncing_ball_beyond.inherited.contacts.contact.assess import Assessment
from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_beyond.periodic.one_impact import n_t

# Number of restitution coefficients of the chart, enough for smooth lines, and the smallest
# coefficient, because an underdamped contact that only pushes has r > e⁻².
_CHART = 33
_LEAST = {Release.DISPLACEMENT: 0.05, Release.FORCE: 0.15}
_SAMPLES = 1201
# Contact times that the enlargement shows before the contact, and in all.
_BEFORE, _SHOWN = 0.75, 3.0


def chart_and_motion(design: Assessment) -> xr.Dataset:
    """The validity chart over r, heights over one cycle, and the gap in one contact, in SI units.

    The dataset has ``needed`` (simple, restitution), the ϖ from which on a model deviates from the
    contact by the tolerance at most; ``table`` (time,) and ``ball`` (model, time); and ``gap``
    (model, since). Values are NaN where there is no orbit or threshold.
    """
    table = design.case.table
    rule = design.case.equivalent.linear.release
    # The smallest r is that at which Λ is the saddle-node, unless the r of the contact is smaller.
    half = design.n * np.pi
    lam = table.amplitude
    least = (half - lam) / (half + lam)
    least = min(max(least, _LEAST[rule]), design.corrected.restitution)
    chart = np.linspace(least, 1.0, _CHART)
    asked = design.needed
    zeta = damping_ratio(chart, rule)
    found = search(
        zeta,
        rule,
        n=design.n,
        amplitude=lam,
        ratios=RATIOS,
        tolerance=asked.tolerance,
        quantities=(asked.quantity,),
        measure=as_deviation,
    )
    always = found.status == ThresholdStatus.ALWAYS_WITHIN
    from_there_on = np.where(always, RATIOS[0], found.threshold)[:, 0]
    # One cycle from phase 0 of the table, and a quarter of a period more.
    angle = np.linspace(0.0, 2 * np.pi * (design.n + 0.25), _SAMPLES)
    orbits = {name: n_t.orbit(model, design.n, lam) for name, model in design.case.models.items()}
    # Around the impact in the exact model, or in the first model that has an orbit.
    start = next(float(orbit.phase) for orbit in orbits.values() if orbit.exists)
    duration = float(design.case.equivalent.free_duration)
    since = np.linspace(-_BEFORE * duration, (_SHOWN - _BEFORE) * duration, _SAMPLES)

    def heights(at: np.ndarray) -> np.ndarray:
        """Dimensionless heights at phases of the table, shape (model, phase)."""
        return np.array([orbit.path(at - orbit.phase)[0] for orbit in orbits.values()])

    gap = heights(start + since) - lam * np.sin(start + since)
    return xr.Dataset(
        {
            "needed": (("simple", "restitution"), from_there_on),
            "time": ("time", angle * table.time),
            "table": ("time", table.table_amplitude * np.sin(angle)),
            "ball": (("model", "time"), heights(angle) * table.length),
            "since": ("since", since * table.time),
            "gap": (("model", "since"), gap * table.length),
        },
        coords={"simple": list(SIMPLE), "restitution": chart, "model": list(orbits)},
    )
