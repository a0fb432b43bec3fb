"""What the rule that ends a contact changes (beyond the paper).

The paper ends a contact at δ = 0, where a damped contact pulls; a dry contact
ends where its force vanishes. Three things are compared along ϖ:

* the bifurcations of Table 1 under both rules;
* the 1 % thresholds of the restitution model with the r of Eq. 16;
* the same with the restitution coefficient that the force release really has.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from scipy.optimize.elementwise import find_minimum

from bouncing_ball.datasets.variables import describe
from bouncing_ball.impacts.damping import damping_ratio, restitution_coefficient
from bouncing_ball.impacts.spring_damper import Contact, Release
from bouncing_ball.orbits.closed_form import branch_point
from bouncing_ball.orbits.limits import period_doubling, saddle_node
from bouncing_ball.studies.error_thresholds import Quantity, relative_error, thresholds
from bouncing_ball.studies.parameters import grid

READINGS = (
    (Release.DISPLACEMENT, "displacement release, r of Eq. 16"),
    (Release.FORCE, "force release, r of Eq. 16"),
    (Release.FORCE, "force release, its own r"),
)


def _lowest_doubling(
    ratios: np.ndarray, amplitude: np.ndarray, zeta: float, rule: Release, n: int
) -> float:
    """The ϖ at which the period doubling is lowest; NaN if that is an end of the scan."""
    at = int(np.argmin(np.where(np.isnan(amplitude), np.inf, amplitude)))
    if at in (0, len(ratios) - 1) or np.isnan(amplitude[at - 1 : at + 2]).any():
        return np.nan

    def doubling(log_ratio):
        contact = Contact(np.exp(log_ratio), zeta, rule)
        return branch_point(period_doubling(contact, n), contact, n).amplitude

    bracket = tuple(np.log(ratios[at + k]) for k in (-1, 0, 1))
    return float(np.exp(find_minimum(doubling, bracket).x))


def release_rules(parameters: Mapping[str, Any]) -> xr.Dataset:
    """Bifurcations and thresholds under both rules, from ``n``, ``restitution``,
    ``frequency_ratio``, and ``thresholds`` with its own parameters."""
    families = np.array(parameters["n"])
    ratios = grid(parameters["frequency_ratio"])
    zeta = float(damping_ratio(parameters["restitution"]))
    rules = list(Release)
    bifurcations = np.empty((len(rules), len(families), len(ratios), 2))
    turns = np.empty((len(rules), len(families)))
    for i, rule in enumerate(rules):
        contact = Contact(ratios, zeta, rule)
        for j, n in enumerate(families):
            for k, find in enumerate((saddle_node, period_doubling)):
                point = branch_point(find(contact, n), contact, n)
                bifurcations[i, j, :, k] = point.amplitude
            turns[i, j] = _lowest_doubling(ratios, bifurcations[i, j, :, 1], zeta, rule, n)

    wanted = parameters["thresholds"]
    n, lam, r = wanted["n"], wanted["amplitude"], wanted["restitution"]
    quantities = [Quantity(name) for name in wanted["quantities"]]
    scan = grid(wanted["frequency_ratio"])
    loss = float(damping_ratio(r))
    own = float(restitution_coefficient(loss, Release.FORCE))
    found = np.empty((len(READINGS), len(quantities)))
    statuses = np.empty(found.shape, dtype=object)
    for i, (rule, reading) in enumerate(READINGS):
        reference = own if reading.endswith("own r") else r
        for j, quantity in enumerate(quantities):

            def error(ratio, quantity=quantity, rule=rule, reference=reference):
                return relative_error(quantity, n, reference, lam, ratio, rule, damping=loss)

            value, status = thresholds(error, [wanted["tolerance"]], scan)
            found[i, j], statuses[i, j] = value[0], str(status[0])
    return describe(
        xr.Dataset(
            {
                "bifurcation_amplitude": (
                    ("release", "n", "frequency_ratio", "bound"),
                    bifurcations,
                ),
                "period_doubling_turn": (("release", "n"), turns),
                "error_threshold": (("reading", "quantity"), found),
                "threshold_status": (("reading", "quantity"), statuses.astype(str)),
                "damping_ratio": ((), zeta),
                "force_restitution": ((), own),
            },
            coords={
                "release": [str(rule) for rule in rules],
                "n": families,
                "frequency_ratio": ratios,
                "bound": ["saddle-node", "period doubling"],
                "reading": [reading for _, reading in READINGS],
                "quantity": [str(quantity) for quantity in quantities],
            },
        )
    )
