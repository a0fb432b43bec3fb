"""Every formula of the paper that can be wrong, against a second computation.

Each row of the dataset gives the largest disagreement over a sample of parameters and
what rounding accounts for. The formulas are those of :mod:`bouncing_ball.claims.as_printed`;
what they are compared with uses none of them: the restitution model is compared with
simulated cycles and their finite differences, the contact with the matrix exponential of
its equation of motion, the orbits with the event-driven simulation.
"""

from typing import Annotated

import numpy as np
import xarray as xr
from scipy.linalg import expm
from scipy.optimize.elementwise import find_minimum

from bouncing_ball.claims import as_printed as printed
from bouncing_ball.claims.flow import contact_matrix, fall_matrix, flow, matrix, state
from bouncing_ball.contacts.permanent_contact import permanent_contact_threshold
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.datasets.variables import described
from bouncing_ball.motion.angles import reduce_angle
from bouncing_ball.motion.rest import lift_off_phase
from bouncing_ball.motion.simulation import next_impact
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit
from bouncing_ball.orbits.stability import Bifurcation
from bouncing_ball.parameters import Parameters, Seed, number

# Flow, roots and minima are right to rounding, 1e-16, amplified by the terms
# that cancel in them: 10⁴ covers the samples.
ROUNDING = 1e-12
# Central differences over 1e-5 leave h² f‴/6 and rounding/h, both about 1e-10,
# in the trace; at the bifurcation they enter divided by its slope along φ.
DIFFERENCES = 1e-8
_STEP = 1e-5
# The faintest rebound that a double can hold.
_FAINT = float(np.finfo(float).tiny)
# An impact so fast that the weight, 1/(ϖv) of its force, is less than rounding.
WEIGHTLESS = 1e16
# A contact so soft that Λ_SD ϖ² is 1 but for ϖ².
_SOFT = 1e-4
# The equations in metres and seconds.
_GRAVITY = 9.81
# Eq. 16 on a table at rest: r and ϖ, with the impact velocity of the 1-T orbit.
STATIC = {"restitution": [0.85, 0.65], "frequency_ratio": [10.0, 100.0]}

_CYCLE, _METRES = "simulated flight and impact", ", in metres and seconds"
_FLOW, _FALL = "matrix exponential of Eq. 11", "matrix exponential of the free fall"
_ORBITS, _PERIOD = "orbits that repeat in the simulation", "period of the flow"
_FLIP = "multiplier at -1 of "

# By formula: with what it is compared, the disagreement, and what rounding allows.
Checks = dict[str, tuple[str, float, float]]


def check(comparison: str, *defects, budget: float = ROUNDING) -> tuple[str, float, float]:
    """With the largest absolute entry of all defects; NaN if one is NaN.

    Examples
    --------
    >>> check("a root", [0.5, -2.0], 1.0, budget=1e-8)
    ('a root', 2.0, 1e-08)
    """
    return comparison, float(np.max([np.max(np.abs(x)) for x in defects])), budget


# Eqs. 1-9: the restitution model.


def impact_cycle(phase, velocity, r, lam):
    """One simulated cycle from after an impact: (φ, v) after the next, and the time until it."""
    cycle = next_impact(r, lam, phase, (lam * np.cos(phase) - velocity) / r)
    bounced = lam * np.cos(cycle.phase) - r * cycle.relative_velocity
    return cycle.phase, bounced, cycle.time


def exact_cycle(phase, velocity, r, lam):
    """(φ, v) of the same."""
    return impact_cycle(phase, velocity, r, lam)[:2]


def holmes_cycle(phase, velocity, r, lam):
    """The high-bounce map: the flight as if it ended where it began."""
    landed = phase + 2 * velocity
    return landed, r * velocity + (1 + r) * lam * np.cos(landed)


def stability(cycle, phase, velocity, r, lam):
    """Trace and determinant of one cycle by central differences."""
    columns = []
    for d_phase, d_velocity in ((_STEP, 0.0), (0.0, _STEP)):
        high = cycle(phase + d_phase, velocity + d_velocity, r, lam)
        low = cycle(phase - d_phase, velocity - d_velocity, r, lam)
        columns.append([(h - b) / (2 * _STEP) for h, b in zip(high, low, strict=True)])
    (tt, vt), (tv, vv) = columns
    return tt + vv, tt * vv - tv * vt


def doubled(cycle, n, r, lam):
    """1 + tr + det of a map at its n-T orbit, zero at the period doubling.

    Holmes' map and that of Eq. 5 have the orbits v = nπ and Λ cos φ = nπ(1 - r)/(1 + r).
    """
    phase = np.arccos(n * np.pi * (1 - r) / (1 + r) / lam)
    return Bifurcation.PERIOD_DOUBLING.test(*stability(cycle, phase, n * np.pi, r, lam))


def restitution_model(rng, samples) -> Checks:
    """Eqs. 1 to 9: impacts from random states, and orbits with their stability."""
    r, lam = rng.uniform(0.1, 0.95, samples), rng.uniform(0.1, 3, samples)
    phase = rng.uniform(-np.pi, np.pi, samples)
    velocity = lam + rng.uniform(0.5, 6, samples)
    _, rebound, time = impact_cycle(phase, velocity, r, lam)
    bounced = printed.bounced_velocity(phase, velocity, time, lam, r)
    landed = printed.landing_defect(phase, velocity, time, lam)
    # Eqs. 2 and 3 in metres and seconds.
    speed, landing = _GRAVITY / 40.0, (phase + time) / 40.0
    start, thrown = phase / 40.0, velocity * speed
    before = printed.impact_velocity(landing, start, thrown, _GRAVITY)
    after = printed.restitution_law(before, lam * speed * np.cos(40.0 * landing), r)
    fallen = flow(fall_matrix(_GRAVITY), landing - start, state(0.0, thrown, 0.0))

    n = rng.integers(1, 6, samples).astype(float)
    fold = printed.saddle_node(n, r)
    # Orbits above the fold, wherever that is printed.
    above = n * np.pi * (1 - r) / (1 + r) * rng.uniform(1.01, 3, samples)
    phi, launch = printed.fixed_point(n, r, above)
    back_phase, back_velocity = exact_cycle(phi, launch, r, above)
    # The orbit at which both sides of the fold meet, φ = 0, exists at this Λ only.
    met_phase, met_velocity = exact_cycle(0.0 * r, n * np.pi, r, fold)
    multiplier = Bifurcation.SADDLE_NODE.test(*stability(exact_cycle, 0.0 * r, n * np.pi, r, fold))
    doubling = printed.period_doubling(n, r)
    corrected = np.hypot(2 * (1 + r * r) / (1 + r) ** 2, n * np.pi * (1 - r) / (1 + r))
    exact, holmes = doubled(exact_cycle, n, r, corrected), doubled(holmes_cycle, n, r, doubling)
    # A ball at rest on tables a little below and above the threshold.
    edge = printed.restitution_threshold() + np.array([-1, 1]) * ROUNDING
    stays = np.isnan(lift_off_phase(edge)).tolist() == [True, False]

    folds = multiplier, met_phase, met_velocity - n * np.pi
    fixed = reduce_angle(back_phase - phi), back_velocity - launch
    one, of = "one simulated cycle", _FLIP + "the map of Eq. 5"
    return {
        "Eq. 2": check(_CYCLE + _METRES, after / speed - rebound),
        "Eq. 3": check(_FALL + _METRES, (before - fallen[:, 1]) / speed),
        "Eq. 4": check(_FALL + _METRES, free_flight(rng, samples)),
        "Eq. 5": check(_CYCLE, landed, bounced - rebound),
        "Eq. 6": check(one, *fixed),
        "Eq. 7": check(f"{one}, and a Floquet multiplier at 1", *folds, budget=DIFFERENCES),
        "Eq. 8": check(of, doubling / corrected - 1, budget=DIFFERENCES),
        "Eq. 8, Holmes' map": check(_FLIP + "Holmes' map", holmes, budget=DIFFERENCES),
        "Eq. 8, corrected": check(of, exact, budget=DIFFERENCES),
        "Eq. 9": check("lift-off of a ball at rest", float(not stays)),
    }


def free_flight(rng, samples) -> np.ndarray:
    """Defects of Eq. 4 against Eq. 1, its differential equation in metres and seconds."""
    height, velocity = rng.uniform(-1, 1, samples), rng.uniform(-6, 6, samples)
    start, flown = rng.uniform(-np.pi, np.pi, samples), rng.uniform(0.5, 6, samples)
    big_omega = rng.uniform(20, 60, samples)
    length, speed = _GRAVITY / big_omega**2, _GRAVITY / big_omega
    begin = state(height * length, velocity * speed, 0.0)
    there = flow(fall_matrix(_GRAVITY), flown / big_omega, begin)
    found = printed.free_flight(start + flown, start, height, velocity)
    return np.array(found) - there[:, :2].T / (length, speed)


# Eqs. 10-17 and 21-27: the contact, its damping and its orbits.


def printed_contact(time, omega, zeta, lam, phase, impact):
    """Eqs. 12-13 from an impact; A and B are linear in it (Eqs. 21-22)."""
    zero, rate = printed.contact(0.0, omega, zeta, lam, phase, 0.0, 0.0)
    a = lam * np.sin(phase) - zero
    b = (impact - rate + zeta * omega * a) / (omega * np.sqrt(1 - zeta**2))
    return np.array(printed.contact(time, omega, zeta, lam, phase, a, b))


def contact_and_flight(rng, samples) -> Checks:
    """The definition of ϖ and Eqs. 12 to 15."""
    omega, zeta = np.exp(rng.uniform(0.2, 3, samples)), rng.uniform(0, 0.6, samples)
    lam, phase = rng.uniform(0.1, 2, samples), rng.uniform(-np.pi, np.pi, samples)
    impact = -rng.uniform(1, 6, samples)
    time = np.pi / omega * rng.uniform(0.2, 1, samples)
    start = state(lam * np.sin(phase), impact, phase)
    there = flow(contact_matrix(omega, zeta, lam), time, start)
    in_contact = printed_contact(time, omega, zeta, lam, phase, impact) - there[:, :2].T

    # Eq. 10 in metres and seconds: k/m = ω², c/m = 2ζω, gravity g, table a sin Ωt.
    big_omega = rng.uniform(20, 60, samples)
    natural = omega * big_omega
    length, speed = _GRAVITY / big_omega**2, _GRAVITY / big_omega
    physical = matrix(natural**2, 2 * zeta * natural, _GRAVITY, lam * length, big_omega)
    at_impact = state(lam * np.sin(phase) * length, impact * speed, phase)
    fallen = flow(physical, time / big_omega, at_impact)[:, 0] / length

    def scaled(ratio):
        """Eq. 11 with a frequency ratio, against Eq. 10."""
        return (flow(contact_matrix(ratio, zeta, lam), time, start)[:, 0] - fallen) / impact

    thrown, since = rng.uniform(1, 6, samples), rng.uniform(0.5, 6, samples)
    flown = flow(fall_matrix(), since, state(lam * np.sin(time + phase), thrown, 0.0))
    flight = printed.flight(time + since, time, thrown, lam, phase)
    units = "Eq. 10 in physical units; "
    return {
        "ϖ = Ω/ω, Ω of the table": check(f"{units}one of two readings", scaled(1 / omega)),
        "ϖ = Ω/ω, Ω of the contact": check(f"{units}the other reading", scaled(omega)),
        "Eqs. 12-13": check(_FLOW, in_contact / impact),
        "Eqs. 14-15": check(_FALL, np.array(flight) - flown[:, :2].T),
    }


def measured_restitution(r, frequency_ratio, velocity):
    """Velocity after a simulated impact over that before it, on a table at rest.

    NaN where the ball stays on the table.
    """
    contact = SpringDamper(frequency_ratio, printed.damping_ratio(r))
    return next_impact(contact, 0.0, 0.0, -velocity).relative_velocity / -velocity


def damping(rng, samples) -> Checks:
    """Eq. 16 and its limits."""
    r, omega = rng.uniform(0.1, 0.99, samples), np.exp(rng.uniform(0, 5, samples))
    # For r → 0, 1 - ζ tends to π²/(2 ln² r), slowly; twice that leaves room.
    slow, faint = np.pi**2 / np.log(_FAINT) ** 2, 1 - printed.damping_ratio(_FAINT)
    impact = measured_restitution(r, omega, WEIGHTLESS) - r
    return {
        "Eq. 16": check("simulated impact, table at rest, no gravity", impact),
        "Eq. 16, r = 1": check("no damping", printed.damping_ratio(1.0)),
        "Eq. 16, r → 0": check("critical damping", faint, budget=slow),
    }


def static_error() -> xr.DataArray:
    """|r_static - r|/r of a heavy ball on a table at rest, over r and ϖ; NaN where it is held."""
    r, ratio = np.meshgrid(*STATIC.values(), indexing="ij")
    return xr.DataArray(np.abs(measured_restitution(r, ratio, np.pi) / r - 1), STATIC)


def contact_orbits(rng, samples) -> Checks:
    """Eqs. 21 to 27 on orbits that repeat in the simulation."""
    omega, zeta = np.exp(rng.uniform(1, 5, samples)), rng.uniform(0.01, 0.3, samples)
    n = rng.integers(1, 4, samples)
    model = SpringDamperModel(SpringDamper(omega, zeta))
    lam = model.saddle_node(n).amplitude + rng.uniform(0.05, 0.5, samples)
    orbit = model.orbit(n, lam)
    phase, impact, end = orbit.phase, orbit.impact_velocity, orbit.contact_duration
    u, period = orbit.relative_impact_velocity, 2 * np.pi * n
    again = orbit.cycle(phase, u)
    repeated = reduce_angle(again.phase - phase), again.relative_velocity - u
    start = state(lam * np.sin(phase), impact, phase)
    released = flow(contact_matrix(omega, zeta, lam), end, start)[:, 1]
    thrown = printed.bounce_velocity(impact, n, end)
    at_release = printed_contact(end, omega, zeta, lam, phase, impact)
    # Eq. 24 gives z′_b; Eqs. 21-22 give A and B, and Eqs. 23-26 are left.
    at_impact = np.array(printed.flight(period, end, at_release[1], lam, phase))
    release, landing = (lam * np.sin(phase + end), released), (lam * np.sin(period + phase), impact)
    # Eqs. 16 and 17 give numbers, no motion: the contact would last to the next impact.
    held = printed_contact(period, omega, zeta, lam, phase, impact)
    return {
        "Eqs. 21-26": check(_ORBITS, *repeated, at_release - release, at_impact - landing),
        "Eqs. 21-26 by Eqs. 12, 13, 16, 17": check(_ORBITS, held - landing),
        "Eq. 27": check(_FLOW, thrown - released),
    }


def points_with_one_impact(rng, points: int) -> int:
    """How many of so many random points of the explicit curve are orbits of the ball.

    The curve asks that a contact ends after D and that the ball is back after a
    flight, not that it touched the table in between, or left it.
    """
    omega, zeta = np.exp(rng.uniform(0, 5, points)), rng.uniform(0.01, 0.3, points)
    n = rng.integers(1, 6, points)
    contact = SpringDamper(omega, zeta)
    # From half a free contact to two, or to the whole cycle.
    longest = np.minimum(2.0, 2 * np.pi * n * contact.damped_frequency / np.pi)
    duration = np.pi / contact.damped_frequency * rng.uniform(0.5, longest)
    excess = duration * contact.damped_frequency - contact.free_angle
    return int(np.sum(SpringDamperOrbit.on_branch(excess, contact, n).is_admissible()))


# Eqs. 29-36: permanent contact.


def steady_amplitude(frequency_ratio, damping_ratio):
    """Amplitude of δ for Λ = 1: the orbit of period 2π of the flow."""
    m = contact_matrix(frequency_ratio, damping_ratio, 1.0, gravity=0.0)
    period = expm(m * 2 * np.pi)
    drive = period[..., :2, 3]  # from cos 0 = 1
    orbit = np.linalg.solve(np.eye(2) - period[..., :2, :2], drive[..., np.newaxis])[..., 0]
    start = state(orbit[..., 0], orbit[..., 1], 0.0)
    # δ = z - sin τ at τ = 0 and π/2, a quarter apart.
    return np.hypot(start[..., 0], flow(m, np.pi / 2, start)[..., 0] - 1)


def permanent_contact(rng, samples) -> Checks:
    """Eqs. 29 to 36."""
    omega, zeta = np.exp(rng.uniform(-0.5, 2, samples)), rng.uniform(0.02, 0.5, samples)
    lam, begin = rng.uniform(0.1, 2, samples), rng.uniform(-np.pi, np.pi, samples)
    end = begin + rng.uniform(0.5, 6, samples)
    now, quarter, later = (
        printed.steady_displacement(time, omega, zeta, lam)
        for time in (begin, begin + np.pi / 2, end)
    )
    # z = δ + w; the velocity of the printed solution a quarter of a cycle away.
    rate = quarter + 1 / omega**2 + lam * np.cos(begin)
    start = state(now + lam * np.sin(begin), rate, begin)
    moved = flow(contact_matrix(omega, zeta, lam), end - begin, start)[:, 0]
    steady = moved - lam * np.sin(end) - later
    threshold = 1 / (omega**2 * steady_amplitude(omega, zeta))
    at_any = printed.permanent_contact_threshold(omega, zeta) / threshold - 1
    resonant = printed.resonant_threshold(zeta) * steady_amplitude(1.0, zeta) - 1
    # Λ_SD grows as 1/ϖ², with a next term of relative order ϖ².
    soft = 1 / steady_amplitude(_SOFT, zeta) - 1

    def at_inverse_square(x, zeta):
        return permanent_contact_threshold(x**-0.5, zeta)

    bracket = (0 * zeta + 1e-3, 1 - 2 * zeta**2, 0 * zeta + 10)
    lowest = find_minimum(at_inverse_square, bracket, args=(zeta,))
    bottom, place = lowest.f_x, lowest.x**-0.5
    # Λ between the minimum and 1, where both frequency ratios exist.
    level = bottom + (1 - bottom) * rng.uniform(0.1, 0.9, samples)

    def inverse(sign):
        """The printed ϖ has this threshold, on its side of the lowest one."""
        ratio = printed.permanent_contact_frequency_ratio(level, zeta, sign)
        astray = np.sign(ratio - place) != sign
        off = permanent_contact_threshold(ratio, zeta) / level - 1
        return check("roots of Λ_SD", off, astray.astype(float))

    minimum = printed.permanent_contact_minimum(zeta) / bottom - 1
    return {
        "Eq. 31": check(_FLOW, steady),
        "Eq. 33": check(_PERIOD, at_any),
        "Eq. 33, ϖ = 1": check(_PERIOD, resonant),
        "Eq. 33, ϖ → 0": check(_PERIOD, soft, budget=2 * _SOFT**2),
        "Eq. 34": inverse(1),
        "Eq. 35": inverse(-1),
        "Eq. 36": check("minimum of Λ_SD", minimum),
    }


class Formulas(Parameters):
    """The random parameters on which the formulas are tried."""

    samples: Annotated[int, number("random parameters for each formula", ge=8, le=1000)]
    curve_points: Annotated[int, number("random points of the explicit curve", ge=8, le=100_000)]
    seed: Seed


def formulas(parameters: Formulas) -> xr.Dataset:
    """Disagreement of every printed formula, over ``samples`` random parameters, (formula,)."""
    rng = np.random.default_rng(parameters.seed)
    checks: Checks = {}
    for part in (restitution_model, contact_and_flight, damping, contact_orbits, permanent_contact):
        checks |= part(rng, parameters.samples)
    comparison, disagreement, budget = zip(*checks.values(), strict=True)
    return described(
        {
            "disagreement": ("formula", np.array(disagreement)),
            "budget": ("formula", np.array(budget)),
            "compared_with": ("formula", np.array(comparison)),
            "static_error": static_error(),
            "curve_points": ((), parameters.curve_points),
            "curve_points_admissible": ((), points_with_one_impact(rng, parameters.curve_points)),
        },
        coords={"formula": list(checks)},
    )
