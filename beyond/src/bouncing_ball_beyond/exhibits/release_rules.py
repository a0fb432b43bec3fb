"""The influence of the rule that ends a contact (beyond the paper).

The paper ends a contact at δ = 0, where a damped contact pulls; a dry contact ends where its force
vanishes. Three things are compared along ϖ:

* the bifurcations of Table 1 under both rules;
* the 1 % thresholds of the restitution model with the r of Eq. 16;
* the same with the restitution coefficient that the force release really has.

Under both rules, r and the duration of a free impact are computed over the damping ratio. Without
gravity the impact depends on k, c and m only through ω = √(k/m) and ζ = c/(2√(km)), which users of
physics engines need to know. Times are ωt, which are the times of a contact with ϖ = 1.
"""

import numpy as np
import xarray as xr

from bouncing_ball_beyond.accuracy.simple_models import Search, search
from bouncing_ball_beyond.exhibits.orbit_parameters import ComparedQuantities
from bouncing_ball_beyond.inherited.datasets.parameters import (
    Family,
    LossyRestitution,
    Many,
    Parameters,
    Samples,
    Span,
)
from bouncing_ball_beyond.inherited.datasets.variables import Variable, describe, described
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import (
    LINEAR,
    Release,
    damping_ratio,
    restitution_coefficient,
)
from bouncing_ball_beyond.models.oscillator import responses
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t

VARIABLES = {
    "bifurcation_amplitude": Variable("excitation amplitude of the bifurcation", symbol="Λ"),
    "force_restitution": Variable("restitution coefficient of the force release", symbol="r_F"),
    "free_force": Variable(
        "force of a free contact, over mω times the impact speed", symbol="F/(mωv)"
    ),
    "contact_end": Variable("when a free contact ends, in units of 1/ω", symbol="ωt_c"),
    "end_restitution": Variable(
        "restitution coefficient of a free impact by the release", symbol="r"
    ),
}


class ReleaseRules(Parameters):
    """Families whose bifurcations are followed along ϖ, and an orbit for the thresholds."""

    n: Many[Family]
    restitution: LossyRestitution
    frequency_ratio: Span
    thresholds: ComparedQuantities


def _bifurcations(parameters: ReleaseRules, rule: Release) -> xr.Dataset:
    """Both bifurcations along ϖ under a rule, and the ϖ of the lowest period doubling."""
    families = np.array(parameters.n)
    ratios = parameters.frequency_ratio.grid()
    zeta = float(damping_ratio(parameters.restitution))
    model = ContactModel(SpringDamper(ratios, zeta, rule))
    saddle_nodes = n_t.saddle_node(model, families[:, np.newaxis]).amplitude
    doublings = n_t.period_doubling(model, families[:, np.newaxis]).amplitude
    ends = np.stack([saddle_nodes, doublings], axis=-1)
    turns = _turns(ratios, doublings, zeta, rule, families)
    return xr.Dataset(
        {
            "bifurcation_amplitude": (("n", "frequency_ratio", "bound"), ends),
            "period_doubling_turn": ("n", turns),
        },
        coords={
            "n": families,
            "frequency_ratio": ratios,
            "bound": list(Bifurcation),
            "release": str(rule),
        },
    )


def _turns(
    ratios: np.ndarray, amplitude: np.ndarray, zeta: float, rule: Release, n: np.ndarray
) -> np.ndarray:
    """The ϖ at which the period doubling of each family is lowest, shape (n,).

    With falling ϖ the period doubling first moves to smaller Λ, turns, and then moves to larger Λ.
    ``amplitude`` has its Λ on the grid of ϖ, shape (n, ϖ), and NaN where there is none. The result
    is NaN for a family whose period doubling is lowest at an end of the grid.
    """
    # This module of scipy is not loaded on first use, and its import takes a third of a second.
    from scipy.optimize.elementwise import find_minimum

    def doubling(log_ratio: np.ndarray, n: np.ndarray) -> np.ndarray:
        model = ContactModel(SpringDamper(np.exp(log_ratio), zeta, rule))
        return n_t.period_doubling(model, n).amplitude

    lowest = np.argmin(np.where(np.isnan(amplitude), np.inf, amplitude), axis=-1)
    # Elsewhere the neighbours of the lowest sample are no bracket of a minimum.
    inside = np.flatnonzero((lowest > 0) & (lowest < ratios.size - 1))
    turns = np.full(lowest.shape, np.nan)
    if inside.size:
        bracket = tuple(np.log(ratios[lowest[inside] + k]) for k in (-1, 0, 1))
        found = find_minimum(doubling, bracket, args=(n[inside],))
        turns[inside] = np.where(found.success, np.exp(found.x), np.nan)
    return turns


def _search(wanted: ComparedQuantities, rule: Release, restitution: float) -> Search:
    """Thresholds of the restitution model with this r, for contacts with r by Eq. 16."""

    def simple(contact: SpringDamper) -> list[RestitutionModel]:
        return [RestitutionModel(restitution)]

    return search(
        damping_ratio(wanted.restitution),
        rule,
        wanted.n,
        wanted.amplitude,
        ratios=wanted.frequency_ratio.grid(),
        tolerance=wanted.tolerance,
        quantities=wanted.quantities,
        simple=simple,
    )


def _thresholds(wanted: ComparedQuantities) -> xr.Dataset:
    """The ϖ above which each quantity is within the tolerance, for each reading of r."""
    r = wanted.restitution
    force_restitution = float(restitution_coefficient(damping_ratio(r), Release.FORCE))
    readings = {
        "displacement release, r of Eq. 16": (Release.DISPLACEMENT, r),
        "force release, r of Eq. 16": (Release.FORCE, r),
        "force release, its own r": (Release.FORCE, force_restitution),
    }
    found = [_search(wanted, rule, simple) for rule, simple in readings.values()]
    # There is one simple model, and one orbit.
    dims = ("reading", "quantity")
    return xr.Dataset(
        {
            "error_threshold": (dims, [each.threshold[0, :, 0] for each in found]),
            "threshold_status": (dims, [each.status[0, :, 0] for each in found]),
            "force_restitution": force_restitution,
        },
        coords={"reading": list(readings), "quantity": list(map(str, wanted.quantities))},
    )


def release_rules(parameters: ReleaseRules) -> xr.Dataset:
    """Bifurcations and thresholds under both release rules.

    The dataset has ``bifurcation_amplitude`` (release, n, ϖ, bound), values of Λ;
    ``period_doubling_turn`` (release, n), the ϖ at which each period doubling is lowest;
    ``error_threshold``, a ϖ, and ``threshold_status`` (reading, quantity), where a reading is a
    release rule with an r of the restitution model; and the numbers ``damping_ratio`` and
    ``force_restitution``. NaN where there is none.
    """
    dataset = xr.concat([_bifurcations(parameters, rule) for rule in LINEAR], "release")
    dataset["damping_ratio"] = float(damping_ratio(parameters.restitution))
    return describe(dataset.merge(_thresholds(parameters.thresholds)), variables=VARIABLES)


class FreeImpacts(Parameters):
    """The contact whose force is drawn over time, and the smallest r of the curves over ζ."""

    restitution: LossyRestitution
    restitution_min: LossyRestitution
    samples: Samples


def free_impacts(parameters: FreeImpacts) -> xr.Dataset:
    """Free impacts by release rule and ζ, and the force during one contact.

    The dataset has ``restitution`` and ``contact_duration``, in units of 1/ω, over (release,
    damping_ratio); ``free_force`` over ``time``, for the contact with r by the displacement
    release, divided by mω times the impact speed; ``contact_end``, the time at which each release
    ends that contact, and ``end_restitution``, over ``release``.
    """
    zeta = np.linspace(0.0, damping_ratio(parameters.restitution_min), parameters.samples)
    along = [SpringDamper(1.0, zeta, rule) for rule in LINEAR]
    shown_zeta = float(damping_ratio(parameters.restitution))
    shown = [SpringDamper(1.0, shown_zeta, rule) for rule in LINEAR]
    paper_release = SpringDamper(1.0, shown_zeta, Release.DISPLACEMENT)
    time = np.linspace(0.0, float(paper_release.free_duration), parameters.samples)
    penetration, rate = responses(time, 1.0, shown_zeta).impulse
    dims = ("release", "damping_ratio")
    return described(
        {
            "restitution": (dims, [contact.restitution for contact in along]),
            "contact_duration": (dims, [contact.free_duration for contact in along]),
            "free_force": ("time", paper_release.force(penetration, rate)),
            "contact_end": ("release", [float(contact.free_duration) for contact in shown]),
            "end_restitution": ("release", [float(contact.restitution) for contact in shown]),
        },
        coords={"release": [str(rule) for rule in LINEAR], "damping_ratio": zeta, "time": time},
        variables=VARIABLES,
    )
