"""The comparison of every formula of the paper that can be wrong with a second computation.

Each row of the dataset gives the largest disagreement over a sample of parameters, and the
disagreement that rounding explains. The formulas are those of
:mod:`bouncing_ball.paper.claims.as_printed`. They are compared with simulated cycles, with the
multipliers of orbits, and with the equations of motion, differentiated by complex steps. These
computations use the formulas only where the comparison says so.

Each row also has the functions with which the package computes, if there are any, and their
largest disagreement with the printed form (:mod:`bouncing_ball.paper.claims.formulas_in_use`). A
formula is reproduced only if both comparisons agree.
"""

from typing import Annotated, Any

import numpy as np
import xarray as xr

from bouncing_ball.datasets.parameters import Parameters, Seed, number
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.models.model import Status
from bouncing_ball.models.restitution import RestitutionModel
from bouncing_ball.models.simulation import impacts_of, next_impact
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.paper.claims import as_printed as printed
from bouncing_ball.paper.claims.formulas_in_use import (
    InUse,
    corrected_period_doubling,
    forms_in_use,
    largest_defect,
    random_orbits,
)
from bouncing_ball.periodic.orbit import Bifurcation, Orbit, trace_and_determinant

VARIABLES = {
    "formula": Variable("printed formula"),
    "compared_with": Variable("what the formula is compared with"),
    "used": Variable("functions of the package that compute with the formula"),
    "disagreement_in_use": Variable(
        "largest disagreement of the form in use with the printed one",
        budget=1.0,
        scale="budget",
    ),
    "static_error": Variable(
        "relative error of Eq. 16 on a table at rest, with gravity", equation="Eq. 16", budget=1e-12
    ),
}
# Motions, roots and minima are exact up to rounding, 1e-16, which cancellation of their terms
# amplifies; a factor of 10⁴ covers the samples.
ROUNDING = 1e-12
# The smallest r, which is the smallest normal double.
_FAINT = float(np.finfo(float).tiny)
# An impact speed at which the weight, 1/(ϖv) of the impact force, is less than rounding.
WEIGHTLESS = 1e16
# A small ϖ, at which Λ_SD ϖ² differs from 1 by the order of ϖ².
_COMPLIANT = 1e-4
# The r and ϖ for Eq. 16 on a table at rest; the impact velocity is that of the 1-T orbit.
STATIC = {"restitution": [0.85, 0.65], "frequency_ratio": [10.0, 100.0]}
# For each formula: the comparison, the disagreement, and the disagreement that rounding explains.
Checks = dict[str, tuple[str, float, float]]


def check(comparison: str, *defects, budget: float = ROUNDING) -> tuple[str, float, float]:
    """The comparison, the largest absolute entry of all defects, and the budget.

    The largest entry is NaN if one of the defects is NaN.

    Examples
    --------
    >>> check("a root", [0.5, -2.0], 1.0, budget=1e-8)
    ('a root', 2.0, 1e-08)
    """
    return comparison, largest_defect(*defects), budget


def slopes(motion, time):
    """Derivatives of height and velocity of a motion by a complex step, exact up to rounding.

    Examples
    --------
    >>> slopes(lambda time: np.array([time**2, 2 * time]), 3.0).tolist()
    [6.0, 2.0]
    """
    step = 1e-30
    return np.imag(motion(time + 1j * step)) / step


def impact_cycle(phase, velocity, r, lam):
    """One simulated cycle of the restitution model, between states (φ, v) just after an impact.

    The result is φ and v after the next impact, and the time between the impacts; arrays broadcast.
    """
    falling = (lam * np.cos(phase) - velocity) / r
    cycle = next_impact(RestitutionModel(r), phase, falling, lam)
    bounced = lam * np.cos(cycle.phase) - r * cycle.velocity
    return cycle.phase, bounced, cycle.time


def restitution_model(rng, samples) -> Checks:
    """Checks of Eqs. 1 to 9: impacts from random states, and orbits with their stability.

    ``rng`` is the random generator and ``samples`` the number of parameter sets, also in the other
    functions of this module.
    """
    r = rng.uniform(0.1, 0.95, samples)
    return _impact_map(rng, r) | _restitution_orbits(rng, r) | _rest_on_the_table()


def _impact_map(rng, r) -> Checks:
    """Checks of Eqs. 1 to 5 on impacts from random states."""
    lam = rng.uniform(0.1, 3, r.size)
    phase = rng.uniform(-np.pi, np.pi, r.size)
    velocity = lam + rng.uniform(0.5, 6, r.size)
    landing, rebound, time = impact_cycle(phase, velocity, r, lam)
    table = lam * np.cos(landing)
    falling = table - (rebound - table) / r
    height, fallen = printed.free_flight(phase + time, phase, lam * np.sin(phase), velocity)
    map_height = printed.landing_defect(phase, velocity, time, lam)
    map_velocity = printed.bounced_velocity(phase, velocity, time, lam, r)
    simulated = "simulated flight and impact"
    return {
        "Eq. 2": check(simulated, printed.restitution_law(falling, table, r) - rebound),
        "Eq. 4": check(simulated, height - lam * np.sin(landing), fallen - falling),
        "Eq. 5": check(simulated, map_height, map_velocity - rebound),
    }


def _restitution_orbits(rng, r) -> Checks:
    """Checks of Eqs. 6 to 8 on n-T orbits, one for each r."""
    n = rng.integers(1, 6, r.size).astype(float)
    along = n * np.pi * (1 - r) / (1 + r)
    model = RestitutionModel(r)

    above = along * rng.uniform(1.01, 3, r.size)
    phase, velocity = printed.fixed_point(n, r, above)
    back_phase, back_velocity, _ = impact_cycle(phase, velocity, r, above)

    # The orbit with φ = 0, where both sides of the fold meet, exists at this Λ only.
    fold = printed.saddle_node(n, r)
    fold_phase, fold_velocity, _ = impact_cycle(0.0 * r, n * np.pi, r, fold)
    at_fold = trace_and_determinant(Orbit(model, n, fold, 0.0 * r, 0.0 * r, -n * np.pi))

    doubling = printed.period_doubling(n, r)
    corrected = corrected_period_doubling(n, r)
    turned = np.arccos(along / corrected)
    turned_orbit = Orbit(model, n, corrected, turned, 0.0 * r, -n * np.pi)
    at_doubling = trace_and_determinant(turned_orbit)
    # Holmes' map, whose next phase is φ + 2v, has the trace 1 + r - 2p and the determinant r.
    push = (1 + r) * np.sqrt(doubling**2 - along**2)
    holmes = Bifurcation.PERIOD_DOUBLING.test(1 + r - 2 * push, r)
    return {
        "Eq. 6": check(
            "one simulated cycle", reduce_angle(back_phase - phase), back_velocity - velocity
        ),
        "Eq. 7": check(
            "one simulated cycle, and a Floquet multiplier at 1",
            Bifurcation.SADDLE_NODE.test(*at_fold),
            fold_phase,
            fold_velocity - n * np.pi,
        ),
        "Eq. 8": check("the corrected form", doubling / corrected - 1),
        "Eq. 8, Holmes' map": check("multiplier at -1 of Holmes' map", holmes),
        "Eq. 8, corrected": check(
            "multiplier at -1 of the map of Eq. 5", Bifurcation.PERIOD_DOUBLING.test(*at_doubling)
        ),
    }


def _rest_on_the_table() -> Checks:
    """A ball at rest on two tables, with Λ slightly below and above the threshold of Eq. 9."""
    lam = 1 + np.array([-1, 1]) * ROUNDING
    below, above = impacts_of(RestitutionModel(0.5), lam, 0.0, lam, 1).status
    stays = below == Status.PERMANENT_CONTACT and above == Status.BOUNCING
    return {"Eq. 9": check("lift-off of a ball at rest", float(not stays))}


def measured_restitution(r, frequency_ratio, velocity):
    """Speed after a simulated impact on a table at rest, divided by the speed before this impact.

    The result is NaN where the ball stays on the table.
    """
    contact = SpringDamper(frequency_ratio, printed.damping_ratio(r))
    return next_impact(contact, 0.0, -velocity, 0.0).velocity / -velocity


def damping(rng, samples) -> Checks:
    """Checks of Eq. 16 and its limits r = 1 and r → 0."""
    r = rng.uniform(0.1, 0.99, samples)
    omega = np.exp(rng.uniform(0, 5, samples))
    # For r → 0, 1 - ζ tends to π²/(2 ln² r), but slowly; the budget is twice this value.
    slow = np.pi**2 / np.log(_FAINT) ** 2
    faint = 1 - printed.damping_ratio(_FAINT)
    impact = measured_restitution(r, omega, WEIGHTLESS) - r
    return {
        "Eq. 16": check("simulated impact, table at rest, no gravity", impact),
        "Eq. 16, r = 1": check("no damping", printed.damping_ratio(1.0)),
        "Eq. 16, r → 0": check("critical damping", faint, budget=slow),
    }


def static_error() -> xr.DataArray:
    """|r_static - r|/r of a heavy ball on a table at rest, over r and ϖ.

    The result is NaN where the ball does not rebound.
    """
    r, ratio = np.meshgrid(*STATIC.values(), indexing="ij")
    return xr.DataArray(np.abs(measured_restitution(r, ratio, np.pi) / r - 1), STATIC)


def contact_orbits(rng, samples) -> Checks:
    """Checks of the definition of ϖ, and of Eqs. 12 to 15 and 21 to 27 on orbits that repeat."""
    orbit, lam = random_orbits(rng, samples)
    contact: Any = orbit.model
    omega = contact.frequency_ratio
    zeta = contact.damping_ratio
    n = orbit.n
    phase = orbit.phase
    impact = orbit.impact_velocity
    end = orbit.contact_duration
    u = orbit.relative_impact_velocity
    again = next_impact(contact, phase, u, lam)
    repeated = reduce_angle(again.phase - phase), again.velocity - u

    def simulated(time):
        """δ, δ′, height and velocity at a time after the impact."""
        rise, rate = contact.in_contact(time, phase, u, lam)
        return rise, rate, rise + lam * np.sin(phase + time), rate + lam * np.cos(phase + time)

    time = end * rng.uniform(0.1, 1, end.size)
    rise, rate, *held = simulated(time)
    off = printed.contact_after_impact(time, omega, zeta, lam, phase, impact) - held

    # Eqs. 21-22 give A and B; the following defects are those of Eqs. 23-26.
    _, leaving, level, velocity = simulated(end)
    left = printed.contact_after_impact(end, omega, zeta, lam, phase, impact) - (level, velocity)
    landing = np.array(printed.flight(2 * np.pi * n, end, velocity, lam, phase))
    landed = landing - (lam * np.sin(phase), impact)
    thrown = printed.bounce_velocity(impact, n, end) - velocity
    aloft = printed.flight_time(n, end) - (again.time - end)
    slowed = printed.apparent_restitution(
        velocity, lam * np.cos(phase + end), impact, lam * np.cos(phase)
    )
    # Without damping Λ_SD = 1 - 1/ϖ².
    undamped = printed.relative_error(1 - omega**-2.0, 1.0) - omega**-2.0
    orbits = "orbits that repeat in the simulation"
    return _frequency_ratio(rng, rise, rate, omega, zeta) | {
        "Eqs. 12-13": check("simulated contact", off),
        "Eqs. 14-15": check(orbits, landed),
        "Eq. 17": check("simulated contact", slowed + leaving / u),
        "Eqs. 18-20": check(orbits, aloft),
        "Eqs. 21-26": check(orbits, *repeated, left, landed),
        "Eq. 27": check("simulated contact", thrown),
        "Eqs. 37-38": check("undamped permanent contact", undamped),
    }


def _frequency_ratio(rng, rise, rate, omega, zeta) -> Checks:
    """Checks of both readings of ϖ: Eq. 11 with each of them against Eq. 10.

    Eq. 10 is in metres and seconds, for a contact whose frequency is ϖ times that of the table.
    """
    gravity = 9.81
    table = rng.uniform(20, 60, omega.size)
    length = gravity / table**2
    speed = gravity / table
    force = printed.acceleration(rise * length, rate * speed, omega * table, zeta, gravity)
    physical = force / gravity

    def scaled(ratio):
        """The difference of Eq. 11 with a frequency ratio from Eq. 10, over ϖ."""
        return (printed.acceleration(rise, rate, ratio, zeta) - physical) / omega

    units = "Eq. 10 in physical units; "
    return {
        "ϖ = Ω/ω, Ω of the table": check(f"{units}one of two readings", scaled(1 / omega)),
        "ϖ = Ω/ω, Ω of the contact": check(f"{units}the other reading", scaled(omega)),
    }


def steady_amplitude(omega, zeta):
    """Amplitude of δ by Eq. 31 about its mean -1/ϖ², over Λ.

    The amplitude follows from δ at two times that are a quarter of a cycle apart.
    """
    lam = omega**-2.0
    start = printed.steady_displacement(0.0, omega, zeta, lam)
    quarter = printed.steady_displacement(np.pi / 2, omega, zeta, lam)
    return np.hypot(omega**2 * start + 1, omega**2 * quarter + 1)


def permanent_contact(rng, samples) -> Checks:
    """Checks of Eqs. 31 to 36 on permanent contact: the steady motion, Λ_SD, its inverse and
    minimum.
    """
    omega = np.exp(rng.uniform(-0.5, 2, samples))
    zeta = rng.uniform(0.02, 0.5, samples)
    return (
        _steady_motion(rng, omega, zeta) | _threshold(omega, zeta) | _inverse_threshold(rng, zeta)
    )


def _steady_motion(rng, omega, zeta) -> Checks:
    """The check of Eq. 31 against a simulated contact that starts on the steady motion."""
    lam = rng.uniform(0.1, 2, omega.size)
    begin = rng.uniform(-np.pi, np.pi, omega.size)
    end = begin + rng.uniform(0.5, 6, omega.size)

    def steady(time):
        return printed.steady_displacement(time, omega, zeta, lam)

    contact = SpringDamper(omega, zeta)
    rate = slopes(steady, begin)
    later, _ = contact.in_contact(end - begin, begin, rate, lam, steady(begin))
    return {"Eq. 31": check("simulated contact", steady(end) - later)}


def _threshold(omega, zeta) -> Checks:
    """Checks of Eq. 33 and its values at ϖ = 1 and for ϖ → 0 against the amplitude of Eq. 31."""
    at_any = omega**2 * steady_amplitude(omega, zeta)
    threshold = printed.permanent_contact_threshold(omega, zeta) * at_any - 1
    resonant = 2 * zeta * steady_amplitude(1.0, zeta) - 1
    # Λ_SD grows as 1/ϖ², with a next term of relative order ϖ².
    compliant = 1 / steady_amplitude(_COMPLIANT, zeta) - 1
    amplitude = "amplitude of Eq. 31"
    return {
        "Eq. 33": check(amplitude, threshold),
        "Eq. 33, ϖ = 1": check(amplitude, resonant),
        "Eq. 33, ϖ → 0": check(amplitude, compliant, budget=2 * _COMPLIANT**2),
    }


def _resonance_threshold(omega, zeta):
    """The Λ at which a harmonic oscillation of δ, with the response of Eq. 11, has the amplitude
    1/ϖ² of its mean; it does not use the package's Λ_SD, so that a mistake there stays there.
    """
    return np.abs(omega**2 - 1 + 2j * zeta * omega) / omega**2


def _inverse_threshold(rng, zeta) -> Checks:
    """Checks of Eqs. 34 to 36: both ϖ with a given Λ_SD, and the lowest Λ_SD.

    Λ_SD² is quadratic in 1/ϖ², so that its only stationary point is the minimum.
    """
    place = (1 - 2 * zeta**2) ** -0.5
    bottom = _resonance_threshold(place, zeta)
    flat = slopes(lambda ratio: printed.permanent_contact_threshold(ratio, zeta), place)
    # Λ between the minimum and 1, where both frequency ratios exist.
    level = bottom + (1 - bottom) * rng.uniform(0.1, 0.9, zeta.size)

    def inverse(sign):
        """Defects of a printed ϖ: in its threshold, and in its place beside the minimum."""
        ratio = printed.permanent_contact_frequency_ratio(level, zeta, sign)
        off = _resonance_threshold(ratio, zeta) / level - 1
        return check("roots of Λ_SD", off, np.sign(ratio - place) - sign)

    minimum = printed.permanent_contact_minimum(zeta) / bottom - 1
    return {
        "Eq. 34": inverse(1),
        "Eq. 35": inverse(-1),
        "Eq. 36": check("minimum of Λ_SD", minimum, flat),
    }


class Formulas(Parameters):
    """The random parameters on which the formulas are checked."""

    samples: Annotated[int, number("random parameters for each formula", ge=8, le=1000)]
    seed: Seed


def formulas(parameters: Formulas) -> xr.Dataset:
    """Disagreement of every printed formula with a second computation.

    The dataset has ``disagreement`` (formula,), the largest difference in the sample, NaN if a
    comparison found no value; ``budget`` (formula,), the difference that rounding explains; the
    text ``compared_with`` (formula,); ``disagreement_in_use`` (formula,), the largest difference of
    the functions in the text ``used`` (formula,) from the printed form; and ``static_error``
    (restitution, frequency_ratio), the relative error of r on a table at rest. All are
    dimensionless.
    """
    rng = np.random.default_rng(parameters.seed)
    checks: Checks = {}
    for part in (restitution_model, contact_orbits, damping, permanent_contact):
        checks |= part(rng, parameters.samples)
    comparison, disagreement, budget = zip(*checks.values(), strict=True)
    forms = forms_in_use(rng, parameters.samples)
    nowhere = InUse("", 0.0)
    used, in_use = zip(*(forms.get(name, nowhere) for name in checks), strict=True)
    return described(
        {
            "disagreement": ("formula", np.array(disagreement)),
            "budget": ("formula", np.array(budget)),
            "compared_with": ("formula", np.array(comparison)),
            "used": ("formula", np.array(used)),
            "disagreement_in_use": ("formula", np.array(in_use)),
            "static_error": static_error(),
        },
        coords={"formula": list(checks)},
        variables=VARIABLES,
    )
