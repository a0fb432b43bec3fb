"""The formulas of the paper in the form in which the package uses them, against the printed form.

The printed form (:mod:`~bouncing_ball.paper.claims.as_printed`) is compared with second
computations in :mod:`~bouncing_ball.paper.claims.formulas`. The stages compute with other
functions, which are written so that they lose no digits. Here each of those is compared with the
printed form, so that a mistake in one of them is a disagreement in the row of its formula.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.accuracy.errors import Quantity, relative_errors
from bouncing_ball.accuracy.thresholds import search
from bouncing_ball.models import permanent_contact as threshold
from bouncing_ball.models.damping import Release, damping_ratio, restitution_coefficient
from bouncing_ball.models.flight import Flight
from bouncing_ball.models.restitution import RestitutionModel
from bouncing_ball.models.simulation import impacts_of, next_impact
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.models.spring_damper import force as force_of
from bouncing_ball.paper.claims import as_printed as printed
from bouncing_ball.periodic import restitution_branch
from bouncing_ball.periodic.continuation import PaperEquations
from bouncing_ball.periodic.explicit import explicit_branch
from bouncing_ball.periodic.orbit import Bifurcation, Orbit, flight_path, trace_and_determinant
from bouncing_ball.periodic.restitution_branch import ImpactMap

# A grid on which the threshold of an undamped contact, ϖ = 10 for 1 %, is found.
_RATIOS = np.geomspace(1.0, 1e3, 31)
_TOLERANCE = 0.01
# The functions that solve Eqs. 21-26, from the contact to the bifurcations of its orbits.
_OF_ORBITS = (
    "models.spring_damper.SpringDamper.impact",
    "periodic.continuation.PaperEquations.residual",
    "periodic.spring_damper_branch.branch_point",
    "periodic.spring_damper_branch.SpringDamperBranch.bifurcation",
)


class InUse(NamedTuple):
    """The functions of the package for a formula, and their largest difference from its form."""

    functions: str
    disagreement: float


Rows = dict[str, InUse]


def _used(*functions: str, defects: tuple) -> InUse:
    """A row from the names of functions and from the defects of all of them."""
    return InUse(", ".join(functions), largest_defect(*defects))


def largest_defect(*defects) -> float:
    """The largest modulus among the entries of all defects, NaN if one of them is NaN or has none.

    Examples
    --------
    >>> largest_defect([0.5, -2.0], 1.0), largest_defect([0.5], float("nan"))
    (2.0, nan)
    >>> largest_defect([0.5], [])
    nan
    """
    moduli = [np.abs(x) for x in defects]
    return float(np.max([np.max(x) if np.size(x) else np.nan for x in moduli]))


def random_orbits(rng: np.random.Generator, samples: int) -> tuple[Orbit, np.ndarray]:
    """Stable n-T orbits of random contacts, at random Λ somewhat above their saddle-nodes.

    There are at most ``samples``, because a compliant contact with strong damping may have no
    saddle-node.
    """
    omega = np.exp(rng.uniform(0.7, 5, samples))
    zeta = rng.uniform(0.01, 0.5, samples)
    n = rng.integers(1, 4, samples)
    branch = explicit_branch(SpringDamper(omega, zeta))
    fold = branch.bifurcation(Bifurcation.SADDLE_NODE, n).amplitude
    there = np.isfinite(fold)
    lam = fold[there] + rng.uniform(0.05, 0.5, np.sum(there))
    return explicit_branch(SpringDamper(omega[there], zeta[there])).orbit(n[there], lam), lam


def corrected_period_doubling(n, r):
    """Λ of the period doubling of the map of Eq. 5, in place of Eq. 8::

        Λ² = [2(1 + r²)/(1 + r)²]² + [nπ (1 - r)/(1 + r)]²

    Examples
    --------
    >>> float(corrected_period_doubling(3, 1.0))
    1.0
    """
    along = n * np.pi * (1 - r) / (1 + r)
    return np.hypot(2 * (1 + r * r) / (1 + r) ** 2, along)


def forms_in_use(rng: np.random.Generator, samples: int) -> Mapping[str, InUse]:
    """The comparison of each formula that the package uses, by the row of the formula.

    ``samples`` is the number of random parameter sets.
    """
    r = rng.uniform(0.1, 0.95, samples)
    rows = _impacts(rng, r) | _restitution_orbits(rng, r) | _contact(rng, samples)
    orbit, lam = random_orbits(rng, samples)
    rows |= _motions(rng, orbit, lam) | _orbit_equations(orbit, lam)
    return rows | _permanent_contact(rng, samples) | _errors(rng, samples)


def _impacts(rng, r) -> Rows:
    """Eqs. 1 to 5 and 9: flights, impacts and rest on the table."""
    lam = rng.uniform(0.1, 3, r.size)
    phase = rng.uniform(-np.pi, np.pi, r.size)
    velocity = lam + rng.uniform(0.5, 6, r.size)
    x = lam * np.cos(phase)
    y = lam * np.sin(phase)

    time = rng.uniform(0.1, 2, r.size)
    rise, rate, *_ = Flight(phase, 0.0 * x, velocity - x, lam).gap(time)
    held = rise + lam * np.sin(phase + time), rate + lam * np.cos(phase + time)
    flight = np.array(printed.free_flight(phase + time, phase, y, velocity)) - held

    model = RestitutionModel(r)
    before = x - (velocity - x) / r
    left = model.impact(phase, before - x, lam).velocity + x
    cycle = next_impact(model, phase, before - x, lam)
    rebound = lam * np.cos(cycle.phase) - r * cycle.velocity
    landing = printed.landing_defect(phase, velocity, cycle.time, lam)
    bounced = printed.bounced_velocity(phase, velocity, cycle.time, lam, r) - rebound

    # At lift-off the table's downward acceleration, Λ sin φ, is that of gravity.
    above = 1 + lam
    at_rest = impacts_of(model, above, 0.0, above, 1)
    lift = above * np.sin(at_rest.contact_duration[0]) - 1
    return {
        "Eq. 2": _used(
            "models.restitution.RestitutionModel.impact",
            defects=(printed.restitution_law(before, x, r) - left,),
        ),
        "Eq. 4": _used("models.flight.Flight", defects=(flight,)),
        "Eq. 5": _used("models.simulation.next_impact", defects=(landing, bounced)),
        "Eq. 9": _used(
            "models.restitution.lift_off_phase",
            "models.permanent_contact.RESTITUTION_THRESHOLD",
            defects=(lift, threshold.RESTITUTION_THRESHOLD - 1),
        ),
    }


def _restitution_orbits(rng, r) -> Rows:
    """Eqs. 6 to 8: the n-T orbits of the restitution model and their bifurcations."""
    n = rng.integers(1, 6, r.size)
    along = n * np.pi * (1 - r) / (1 + r)
    fold = printed.saddle_node(n, r)
    lam = along * rng.uniform(1.01, 3, r.size)
    phase, velocity = printed.fixed_point(n, r, lam)
    branch = explicit_branch(RestitutionModel(r))
    orbit = branch.orbit(n, lam)
    corrected = corrected_period_doubling(n, r)
    node, doubling = (branch.bifurcation(kind, n).amplitude for kind in Bifurcation)
    holmes = restitution_branch.restitution_period_doubling(n, r, ImpactMap.HOLMES)
    return {
        "Eq. 6": _used(
            "periodic.restitution_branch.RestitutionBranch.orbit",
            defects=(orbit.phase - phase, orbit.bounce_velocity - velocity),
        ),
        "Eq. 7": _used(
            "periodic.restitution_branch.restitution_saddle_node",
            defects=(restitution_branch.restitution_saddle_node(n, r) - fold, node - fold),
        ),
        "Eq. 8, Holmes' map": _used(
            "periodic.restitution_branch.restitution_period_doubling",
            defects=(holmes - printed.period_doubling(n, r),),
        ),
        "Eq. 8, corrected": _used(
            "periodic.restitution_branch.restitution_period_doubling",
            defects=(
                restitution_branch.restitution_period_doubling(n, r) - corrected,
                doubling - corrected,
            ),
        ),
    }


def _contact(rng, samples) -> Rows:
    """Eqs. 10 and 11, 16: the force of the contact, and its damping."""
    omega = np.exp(rng.uniform(0.7, 5, samples))
    zeta = rng.uniform(0.01, 0.5, samples)
    rise = -rng.uniform(0.1, 1, samples) / omega
    rate = rng.uniform(-3, 3, samples)
    force = force_of(omega, zeta, -rise, -rate)
    r = rng.uniform(0.1, 0.99, samples)
    damping = printed.damping_ratio(r)
    return {
        "ϖ = Ω/ω, Ω of the contact": _used(
            "models.spring_damper.force",
            # The force over ϖ is of the order of the velocity.
            defects=((printed.acceleration(rise, rate, omega, zeta) + 1 - force) / omega,),
        ),
        "Eq. 16": _used(
            "models.damping.damping_ratio",
            "models.damping.restitution_coefficient",
            defects=(
                damping_ratio(r) - damping,
                SpringDamper.from_restitution(r, omega).damping_ratio - damping,
                restitution_coefficient(damping) - r,
            ),
        ),
    }


def _motions(rng, orbit, lam) -> Rows:
    """Eqs. 12 to 15: the motions in contact and in flight, at random times within orbits."""
    contact: Any = orbit.model
    phase = orbit.phase
    impact = orbit.impact_velocity
    end = orbit.contact_duration

    time = end * rng.uniform(0.1, 1, end.size)
    closing = impact - lam * np.cos(phase)
    rise, rate = contact.in_contact(time, phase, closing, lam)
    held = rise + lam * np.sin(phase + time), rate + lam * np.cos(phase + time)
    omega = contact.frequency_ratio
    zeta = contact.damping_ratio
    flow = printed.contact_after_impact(time, omega, zeta, lam, phase, impact) - held

    aloft = end + orbit.flight_time * rng.uniform(0, 1, end.size)
    flown = np.array(printed.flight(aloft, end, orbit.bounce_velocity, lam, phase))
    return {
        "Eqs. 12-13": _used("models.spring_damper.flow", defects=(flow,)),
        "Eqs. 14-15": _used(
            "periodic.orbit.flight_path", defects=(flown - flight_path(orbit, aloft),)
        ),
    }


def _orbit_equations(orbit, lam) -> Rows:
    """Eqs. 17 to 27: what holds on orbits, how they are solved, and their bifurcations."""
    contact: Any = orbit.model
    n = orbit.n
    phase = orbit.phase
    impact = orbit.impact_velocity
    bounce = orbit.bounce_velocity
    end = orbit.contact_duration
    apparent = printed.apparent_restitution(
        bounce, lam * np.cos(phase + end), impact, lam * np.cos(phase)
    )

    # The release (Eq. 23), after a contact that starts by Eqs. 21 and 22.
    omega = contact.frequency_ratio
    zeta = contact.damping_ratio
    height, _ = printed.contact_after_impact(end, omega, zeta, lam, phase, impact)
    level = lam * np.sin(phase + end)
    ended = contact.impact(phase, impact - lam * np.cos(phase), lam).duration

    equations = PaperEquations(contact, n)
    limits = [explicit_branch(contact).bifurcation(kind, n) for kind in Bifurcation]
    pairs = zip(Bifurcation, limits, strict=True)
    tests = np.array([kind.test(*trace_and_determinant(each)) for kind, each in pairs])
    return {
        "Eq. 17": _used(
            "periodic.orbit.Orbit.apparent_restitution",
            defects=(orbit.apparent_restitution - apparent,),
        ),
        "Eqs. 18-20": _used(
            "periodic.orbit.Orbit.flight_time",
            defects=(orbit.flight_time - printed.flight_time(n, end),),
        ),
        "Eqs. 21-26": _used(
            *_OF_ORBITS,
            defects=(
                height - level,
                ended - end,
                equations.residual(equations.point(orbit)),
                # Some of these contacts have no period doubling.
                tests[np.isfinite(tests)],
            ),
        ),
        "Eq. 27": _used(
            "periodic.orbit.Orbit.bounce_velocity",
            defects=(bounce - printed.bounce_velocity(impact, n, end),),
        ),
    }


def _permanent_contact(rng, samples) -> Rows:
    """Eqs. 33 to 36: the threshold of permanent contact, its inverse and its minimum."""
    omega = np.exp(rng.uniform(-0.5, 2, samples))
    zeta = rng.uniform(0.02, 0.5, samples)
    lowest = 2 * zeta * np.sqrt(1 - zeta**2)
    level = lowest + (1 - lowest) * rng.uniform(0.1, 0.9, samples)
    lower, upper = threshold.permanent_contact_frequency_ratios(level, zeta)
    found = threshold.permanent_contact_threshold(omega, zeta)
    inverse = "models.permanent_contact.permanent_contact_frequency_ratios"
    return {
        "Eq. 33": _used(
            "models.permanent_contact.permanent_contact_threshold",
            defects=(found / printed.permanent_contact_threshold(omega, zeta) - 1,),
        ),
        "Eq. 34": _used(
            inverse,
            defects=(upper / printed.permanent_contact_frequency_ratio(level, zeta, 1) - 1,),
        ),
        "Eq. 35": _used(
            inverse,
            defects=(lower / printed.permanent_contact_frequency_ratio(level, zeta, -1) - 1,),
        ),
        "Eq. 36": _used(
            "models.permanent_contact.permanent_contact_minimum",
            defects=(
                threshold.permanent_contact_minimum(zeta).threshold
                / printed.permanent_contact_minimum(zeta)
                - 1,
            ),
        ),
    }


def _errors(rng, samples) -> Rows:
    """Eqs. 37 and 38: greatest heights, errors of the restitution model, and their thresholds."""
    r = rng.uniform(0.5, 0.95, samples)
    omega = np.exp(rng.uniform(2, 5, samples))
    lam = np.pi * (1 - r) / (1 + r) + rng.uniform(0.05, 0.5, samples)
    exact = SpringDamper.from_restitution(r, omega)
    simple = RestitutionModel(r)
    compared = [Quantity.MAX_HEIGHT, Quantity.PERMANENT_CONTACT]
    errors = np.abs(relative_errors(exact, simple, 1, lam, compared))
    contact, impact = (explicit_branch(model).orbit(1, lam) for model in (exact, simple))
    limits = exact.permanent_contact_threshold(), simple.permanent_contact_threshold()
    thrown = [
        orbit.max_height - printed.greatest_height(orbit.bounce_velocity, orbit.bounce_height)
        for orbit in (contact, impact)
    ]
    # Without damping Λ_SD = 1 - 1/ϖ², which differs from Λ_CR = 1 by 1 % at ϖ = 10.
    found = search(
        0.0,
        Release.DISPLACEMENT,
        1.0,
        1,
        1.0,
        ratios=_RATIOS,
        tolerances=[_TOLERANCE],
        quantities=[Quantity.PERMANENT_CONTACT],
    )
    return {
        "Eqs. 37-38": _used(
            "periodic.orbit.Orbit.max_height",
            "accuracy.errors.relative_errors",
            "accuracy.thresholds.search",
            defects=(
                *thrown,
                errors[0] - printed.relative_error(contact.max_height, impact.max_height),
                errors[1] - printed.relative_error(*limits),
                found.threshold[0] * np.sqrt(_TOLERANCE) - 1,
            ),
        ),
    }
