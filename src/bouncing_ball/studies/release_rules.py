"""What the rule that ends a contact changes (beyond the paper).

The paper ends a contact at δ = 0, where a damped contact pulls; a dry contact
ends where its force vanishes. Three things are compared along ϖ:

* the bifurcations of Table 1 under both rules;
* the 1 % thresholds of the restitution model with the r of Eq. 16;
* the same with the restitution coefficient that the force release really has.
"""

from typing import Annotated

import numpy as np
import xarray as xr
from pydantic import Strict
from scipy.optimize.elementwise import find_minimum

from bouncing_ball.accuracy.quantities import Quantity
from bouncing_ball.accuracy.thresholds import model_thresholds
from bouncing_ball.contacts.damping import damping_ratio, restitution_coefficient
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.datasets.variables import describe
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.stability import Bifurcation
from bouncing_ball.parameters import Family, LossyRestitution, Many, Parameters, Span, Tolerance
from bouncing_ball.studies.parameters import OrbitParameters


class RuleThresholds(OrbitParameters):
    """One orbit, the quantities compared on it, and the error tolerated."""

    restitution: LossyRestitution
    tolerance: Tolerance
    quantities: Many[Annotated[Quantity, Strict(False)]]
    frequency_ratio: Span


class ReleaseRules(Parameters):
    """Families whose bifurcations are followed along ϖ, and an orbit for the thresholds."""

    n: Many[Family]
    restitution: LossyRestitution
    frequency_ratio: Span
    thresholds: RuleThresholds


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
        model = SpringDamperModel(SpringDamper(np.exp(log_ratio), zeta, rule))
        return model.period_doubling(n).amplitude

    bracket = tuple(np.log(ratios[at + k]) for k in (-1, 0, 1))
    return float(np.exp(find_minimum(doubling, bracket).x))


def _bifurcations(parameters: ReleaseRules) -> xr.Dataset:
    """Both bifurcations along ϖ under each rule, and the ϖ of the lowest period doubling."""
    families, ratios = np.array(parameters.n), parameters.frequency_ratio.grid()
    zeta = float(damping_ratio(parameters.restitution))
    rules = list(Release)
    amplitudes = np.empty((len(rules), len(families), len(ratios), 2))
    turns = np.empty((len(rules), len(families)))
    for i, rule in enumerate(rules):
        model = SpringDamperModel(SpringDamper(ratios, zeta, rule))
        for j, n in enumerate(families):
            amplitudes[i, j, :, 0] = model.saddle_node(n).amplitude
            amplitudes[i, j, :, 1] = model.period_doubling(n).amplitude
            turns[i, j] = _lowest_doubling(ratios, amplitudes[i, j, :, 1], zeta, rule, n)
    dims = ("release", "n", "frequency_ratio", "bound")
    return xr.Dataset(
        {
            "bifurcation_amplitude": (dims, amplitudes),
            "period_doubling_turn": (dims[:2], turns),
            "damping_ratio": ((), zeta),
        },
        coords={
            "release": [str(rule) for rule in rules],
            "n": families,
            "frequency_ratio": ratios,
            "bound": list(Bifurcation),
        },
    )


def _thresholds(wanted: RuleThresholds) -> xr.Dataset:
    """The ϖ above which each quantity is within the tolerance, reading by reading."""
    n, lam, r = wanted.n, wanted.amplitude, wanted.restitution
    quantities = wanted.quantities
    scan, loss = wanted.frequency_ratio.grid(), float(damping_ratio(r))
    own = float(restitution_coefficient(loss, Release.FORCE))
    found = []
    for rule, reading in READINGS:

        def exact(ratio: np.ndarray, rule=rule) -> SpringDamperModel:
            return SpringDamperModel(SpringDamper(ratio, loss, rule))

        simple = RestitutionModel(own if reading.endswith("own r") else r)
        _, one = model_thresholds(exact, simple, n, lam, scan, [wanted.tolerance], quantities)
        found.append(one)
    dims = ("reading", "quantity")
    return xr.Dataset(
        {
            "error_threshold": (dims, np.array([one.ratio[:, 0] for one in found])),
            "threshold_status": (dims, np.array([one.status[:, 0] for one in found])),
            "force_restitution": ((), own),
        },
        coords={
            "reading": [reading for _, reading in READINGS],
            "quantity": [str(quantity) for quantity in quantities],
        },
    )


def release_rules(parameters: ReleaseRules) -> xr.Dataset:
    """Bifurcations and thresholds under both rules.

    Λ of the bifurcations, shape (release, n, ϖ, bound), the ϖ at which each period doubling is
    lowest, and the ϖ from which each quantity is right, shape (reading, quantity); NaN where there
    is none.
    """
    return describe(_bifurcations(parameters).merge(_thresholds(parameters.thresholds)))
