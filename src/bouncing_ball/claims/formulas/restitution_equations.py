"""Eqs. 1-9 against the event-driven simulation of the restitution model.

Orbits are checked by one simulated cycle, their stability by finite
differences of one cycle.
"""

import numpy as np
from scipy.optimize.elementwise import find_root

from bouncing_ball.claims import as_printed as printed
from bouncing_ball.claims.formulas.disagreement import ROUNDING, Check, largest
from bouncing_ball.claims.formulas.flow import fall_matrix, flow, state
from bouncing_ball.motion.angles import reduce_angle
from bouncing_ball.motion.rest import lift_off_phase
from bouncing_ball.motion.restitution import impact_cycle

# Central differences over 1e-5 leave h² f‴/6 and rounding/h, both about 1e-10,
# in the trace; at the bifurcation they enter divided by its slope along φ.
DIFFERENCES = 1e-8
_STEP = 1e-5


def _exact_cycle(phase, velocity, r, lam):
    cycle = impact_cycle(r, lam, phase, velocity)
    return cycle.phase, cycle.velocity


def _holmes_cycle(phase, velocity, r, lam):
    """The high-bounce map: the flight as if it ended where it began."""
    landed = phase + 2 * velocity
    return landed, r * velocity + (1 + r) * lam * np.cos(landed)


def _stability(cycle, phase, velocity, r, lam):
    """Trace and determinant of one cycle by central differences."""
    columns = []
    for d_phase, d_velocity in ((_STEP, 0.0), (0.0, _STEP)):
        high = cycle(phase + d_phase, velocity + d_velocity, r, lam)
        low = cycle(phase - d_phase, velocity - d_velocity, r, lam)
        columns.append([(h - b) / (2 * _STEP) for h, b in zip(high, low, strict=True)])
    (tt, vt), (tv, vv) = columns
    return tt + vv, tt * vv - tv * vt


def _located_doubling(cycle, n, r):
    """Λ of the period doubling of a map, along its fixed points.

    Both maps have them at v = nπ and Λ cos φ = nπ(1 - r)/(1 + r), so that along
    them Λ = nπ(1 - r)/(1 + r)/cos φ.
    """
    along = n * np.pi * (1 - r) / (1 + r)

    def flip(phase, n, r, along):
        trace, det = _stability(cycle, phase, n * np.pi, r, along / np.cos(phase))
        return 1 + trace + det

    # From next to the saddle-node, where the function is positive, far to the right.
    bracket = (np.full_like(r, 1e-3), np.full_like(r, np.pi / 2 - 1e-3))
    return along / np.cos(find_root(flip, bracket, args=(n, r, along)).x)


def _free_flight(rng, samples) -> Check:
    """Eq. 1 in metres and seconds, by its differential equation, against Eq. 4."""
    height, velocity = rng.uniform(-1, 1, samples), rng.uniform(-6, 6, samples)
    start, flown = rng.uniform(-np.pi, np.pi, samples), rng.uniform(0.5, 6, samples)
    big_omega, gravity = rng.uniform(20, 60, samples), 9.81
    length, speed = gravity / big_omega**2, gravity / big_omega
    there = flow(
        fall_matrix(gravity), flown / big_omega, state(height * length, velocity * speed, 0.0)
    )
    z, rate = printed.free_flight(start + flown, start, height, velocity)
    return Check(
        largest(z - there[:, 0] / length, rate - there[:, 1] / speed),
        ROUNDING,
        "matrix exponential of the free fall, in metres and seconds",
    )


def _impact(r, lam, phase, velocity, cycle) -> dict[str, Check]:
    """Eqs. 2 and 3 in metres and seconds, against a simulated flight and impact."""
    big_omega, gravity = 40.0, 9.81
    speed, landing = gravity / big_omega, (phase + cycle.time) / big_omega
    start, thrown = phase / big_omega, velocity * speed
    before = printed.impact_velocity(landing, start, thrown, gravity)
    table = lam * speed * np.cos(big_omega * landing)
    after = printed.restitution_law(before, table, r)
    fallen = flow(fall_matrix(gravity), landing - start, state(0.0, thrown, 0.0))
    return {
        "Eq. 2": Check(
            largest(after / speed - cycle.velocity),
            ROUNDING,
            "simulated flight and impact, in metres and seconds",
        ),
        "Eq. 3": Check(
            largest((before - fallen[:, 1]) / speed),
            ROUNDING,
            "matrix exponential of the free fall, in metres and seconds",
        ),
    }


def restitution_checks(rng, samples) -> dict[str, Check]:
    """Checks of Eqs. 2 to 9 on random parameters."""
    r, lam = rng.uniform(0.1, 0.95, samples), rng.uniform(0.1, 3, samples)
    phase = rng.uniform(-np.pi, np.pi, samples)
    velocity = lam + rng.uniform(0.5, 6, samples)
    cycle = impact_cycle(r, lam, phase, velocity)
    bounced = printed.bounced_velocity(phase, velocity, cycle.time, lam, r)
    defect = printed.landing_defect(phase, velocity, cycle.time, lam)

    n = rng.integers(1, 6, samples).astype(float)
    fold = printed.saddle_node(n, r)
    # Orbits above the fold, wherever that is printed.
    above = n * np.pi * (1 - r) / (1 + r) * rng.uniform(1.01, 3, samples)
    phi, launch = printed.fixed_point(n, r, above)
    back = impact_cycle(r, above, phi, launch)
    returned = reduce_angle(back.phase - phi), back.velocity - launch

    # A ball at rest on tables a little below and above the threshold.
    edge = printed.restitution_threshold() + np.array([-1, 1]) * ROUNDING
    stays = np.isnan(lift_off_phase(edge))
    # The orbit at which both sides of the fold meet, φ = 0, exists at this Λ only.
    met = impact_cycle(r, fold, 0.0 * r, n * np.pi)
    trace, det = _stability(_exact_cycle, 0.0 * r, n * np.pi, r, fold)
    doubling = printed.period_doubling(n, r)
    exact, holmes = (_located_doubling(cycle, n, r) for cycle in (_exact_cycle, _holmes_cycle))
    lift = 2 * (1 + r * r) / (1 + r) ** 2
    corrected = np.hypot(lift, n * np.pi * (1 - r) / (1 + r))
    return {
        **_impact(r, lam, phase, velocity, cycle),
        "Eq. 4": _free_flight(rng, samples),
        "Eq. 5": Check(
            largest(defect, bounced - cycle.velocity), ROUNDING, "simulated flight and impact"
        ),
        "Eq. 6": Check(largest(*returned), ROUNDING, "one simulated cycle"),
        "Eq. 7": Check(
            largest(1 - trace + det, met.phase, met.velocity - n * np.pi),
            DIFFERENCES,
            "one simulated cycle, and a Floquet multiplier at 1",
        ),
        "Eq. 8": Check(
            largest(doubling / exact - 1), DIFFERENCES, "multiplier at -1 of the map of Eq. 5"
        ),
        "Eq. 8, Holmes' map": Check(
            largest(doubling / holmes - 1), DIFFERENCES, "multiplier at -1 of Holmes' map"
        ),
        "Eq. 8, corrected": Check(
            largest(corrected / exact - 1), DIFFERENCES, "multiplier at -1 of the map of Eq. 5"
        ),
        "Eq. 9": Check(
            0.0 if stays.tolist() == [True, False] else 1.0, ROUNDING, "lift-off of a ball at rest"
        ),
    }
