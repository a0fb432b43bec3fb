"""Eqs. 10-17 and 21-27: the contact, its damping and its orbits.

The printed solutions are checked against the matrix exponential, the orbits
against the event-driven simulation.
"""

from typing import Annotated

import numpy as np
import xarray as xr
from scipy.optimize.elementwise import find_root

from bouncing_ball.claims import as_printed as printed
from bouncing_ball.claims.formulas.disagreement import ROUNDING, Check, largest
from bouncing_ball.claims.formulas.flow import contact_matrix, fall_matrix, flow, matrix, state
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.motion.angles import reduce_angle
from bouncing_ball.motion.contact import contact_cycle
from bouncing_ball.orbits.spring_damper_branch import branch_point
from bouncing_ball.orbits.spring_damper_limits import orbit_at, saddle_node
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit
from bouncing_ball.parameters import FrequencyRatio, LossyRestitution, Many, Parameters, number

# The faintest rebound that a double can hold.
_FAINT = float(np.finfo(float).tiny)


def _printed_contact(time, omega, zeta, lam, phase, impact):
    """Eqs. 12-13 from an impact; A and B are linear in it (Eqs. 21-22)."""
    zero, rate = printed.contact(0.0, omega, zeta, lam, phase, 0.0, 0.0)
    a = lam * np.sin(phase) - zero
    b = (impact - rate + zeta * omega * a) / (omega * np.sqrt(1 - zeta**2))
    return printed.contact(time, omega, zeta, lam, phase, a, b)


def motion_checks(rng, samples) -> dict[str, Check]:
    """Checks of the definition of ϖ and of Eqs. 12 to 15 on random parameters."""
    omega, zeta = np.exp(rng.uniform(0.2, 3, samples)), rng.uniform(0, 0.6, samples)
    lam, phase = rng.uniform(0.1, 2, samples), rng.uniform(-np.pi, np.pi, samples)
    impact = -rng.uniform(1, 6, samples)
    time = np.pi / omega * rng.uniform(0.2, 1, samples)
    start = state(lam * np.sin(phase), impact, phase)
    there = flow(contact_matrix(omega, zeta, lam), time, start)
    scale = np.abs(impact)
    height, velocity = _printed_contact(time, omega, zeta, lam, phase, impact)

    # Eq. 10 in metres and seconds: k/m = ω², c/m = 2ζω, gravity g, table a sin Ωt.
    big_omega, gravity = rng.uniform(20, 60, samples), 9.81
    natural = omega * big_omega
    length, speed = gravity / big_omega**2, gravity / big_omega
    physical = matrix(natural**2, 2 * zeta * natural, gravity, lam * length, big_omega)
    at_impact = state(lam * np.sin(phase) * length, impact * speed, phase)
    fallen = flow(physical, time / big_omega, at_impact)[:, 0] / length

    def scaled(ratio):
        """Eq. 11 with a frequency ratio, against Eq. 10."""
        moved = flow(contact_matrix(ratio, zeta, lam), time, start)[:, 0]
        return largest((moved - fallen) / scale)

    release, thrown = time, rng.uniform(1, 6, samples)
    since = rng.uniform(0.5, 6, samples)
    flown = flow(fall_matrix(), since, state(lam * np.sin(release + phase), thrown, 0.0))
    flight = printed.flight(release + since, release, thrown, lam, phase)
    return {
        "ϖ = Ω/ω, Ω of the table": Check(
            scaled(1 / omega), ROUNDING, "Eq. 10 in physical units; one of two readings"
        ),
        "ϖ = Ω/ω, Ω of the contact": Check(
            scaled(omega), ROUNDING, "Eq. 10 in physical units; the other reading"
        ),
        "Eqs. 12-13": Check(
            largest((height - there[:, 0]) / scale, (velocity - there[:, 1]) / scale),
            ROUNDING,
            "matrix exponential of Eq. 11",
        ),
        "Eqs. 14-15": Check(
            largest(flight[0] - flown[:, 0], flight[1] - flown[:, 1]),
            ROUNDING,
            "matrix exponential of the free fall",
        ),
    }


def orbit_checks(rng, samples) -> dict[str, Check]:
    """Checks of Eqs. 21 to 27 on orbits that repeat in the simulation."""
    omega, zeta = np.exp(rng.uniform(1, 5, samples)), rng.uniform(0.01, 0.3, samples)
    n = rng.integers(1, 4, samples)
    contact = SpringDamper(omega, zeta)
    fold = branch_point(saddle_node(contact, n), contact, n).amplitude
    lam = fold + rng.uniform(0.05, 0.5, samples)
    orbit = orbit_at(contact, n, lam)
    phase, impact, end = orbit.phase, orbit.impact_velocity, orbit.contact_duration
    period = 2 * np.pi * n
    again = contact_cycle(contact, lam, phase, orbit.relative_impact_velocity)
    repeated = (
        reduce_angle(again.phase - phase),
        again.relative_velocity - orbit.relative_impact_velocity,
    )

    start = state(lam * np.sin(phase), impact, phase)
    released = flow(contact_matrix(omega, zeta, lam), end, start)[:, 1]
    thrown = printed.bounce_velocity(impact, n, end)
    at_release = _printed_contact(end, omega, zeta, lam, phase, impact)
    # Eq. 24 gives z′_b.
    at_impact = printed.flight(period, end, at_release[1], lam, phase)
    table = lam * np.sin(phase + end), lam * np.sin(period + phase)
    # Eqs. 16 and 17 give numbers, no motion: the contact would last to the next impact.
    held = _printed_contact(period, omega, zeta, lam, phase, impact)
    return {
        # Eqs. 21-22 give A and B; Eqs. 23-26 are left.
        "Eqs. 21-26": Check(
            largest(
                *repeated,
                at_release[0] - table[0],
                at_release[1] - released,
                at_impact[0] - table[1],
                at_impact[1] - impact,
            ),
            ROUNDING,
            "orbits that repeat in the simulation",
        ),
        "Eqs. 21-26 by Eqs. 12, 13, 16, 17": Check(
            largest(held[0] - table[1], held[1] - impact),
            ROUNDING,
            "orbits that repeat in the simulation",
        ),
        "Eq. 27": Check(largest(thrown - released), ROUNDING, "matrix exponential of Eq. 11"),
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
    orbit = SpringDamperOrbit.from_branch(branch_point(excess, contact, n), contact, n)
    return int(np.sum(orbit.is_admissible()))


def _measured_restitution(r, frequency_ratio, velocity, gravity):
    """-δ′ at release over δ′ at impact on a table at rest, by root finding.

    NaN where the ball has not come off after one and a half weightless contacts.
    """
    zeta = printed.damping_ratio(r)
    m = contact_matrix(frequency_ratio, zeta, 0.0, gravity)
    start = state(0.0, -np.asarray(velocity, dtype=float) + 0 * r, 0.0)

    def displacement(time, row):
        # The rows whose roots are still looked for.
        rows = row.astype(int)
        return flow(m[rows], time, start[rows])[:, 0]

    half = np.pi / (frequency_ratio * np.sqrt(1 - zeta**2))
    # The first return to δ = 0; gravity prolongs the contact.
    bracket = (half / 2, 1.5 * half)
    found = find_root(displacement, bracket, args=(np.arange(float(r.size)),))
    end = np.where(found.success, found.x, 0.0)
    return np.where(found.success, flow(m, end, start)[:, 1] / velocity, np.nan)


def damping_checks(rng, samples) -> dict[str, Check]:
    """Checks of Eq. 16 and its limits on random parameters."""
    r, omega = rng.uniform(0.1, 0.99, samples), np.exp(rng.uniform(0, 5, samples))
    weightless = _measured_restitution(r, omega, 1.0, 0.0)
    return {
        "Eq. 16": Check(
            largest(weightless - r), ROUNDING, "simulated impact, table at rest, no gravity"
        ),
        "Eq. 16, r = 1": Check(largest(printed.damping_ratio(1.0)), ROUNDING, "no damping"),
        # For r → 0, 1 - ζ tends to π²/(2 ln² r), slowly; twice that leaves room.
        "Eq. 16, r → 0": Check(
            largest(1 - printed.damping_ratio(_FAINT)),
            np.pi**2 / np.log(_FAINT) ** 2,
            "critical damping",
        ),
    }


class Static(Parameters):
    """Impacts of a heavy ball on a table at rest."""

    restitution: Many[LossyRestitution]
    frequency_ratio: Many[FrequencyRatio]
    velocity: Annotated[float, number("velocity at impact", gt=0)]


def static_error(static: Static) -> xr.DataArray:
    """|r_static - r|/r of a heavy ball on a table at rest, over r and ϖ.

    NaN where the contact is so soft, or the impact so weak, that the weight
    holds the ball for more than half as long again as without.
    """
    r, ratio = np.array(static.restitution), np.array(static.frequency_ratio)
    rows, columns = (x.ravel() for x in np.meshgrid(r, ratio, indexing="ij"))
    heavy = _measured_restitution(rows, columns, static.velocity, 1.0)
    error = np.abs(heavy / rows - 1).reshape(r.size, ratio.size)
    return xr.DataArray(error, {"restitution": r, "frequency_ratio": ratio})
