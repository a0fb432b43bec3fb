"""The printed equations against the models where both should agree, and where not."""

import numpy as np
import pytest

from bouncing_ball.claims import as_printed as printed
from bouncing_ball.contacts import damping, permanent_contact
from bouncing_ball.contacts import restitution_map as restitution
from bouncing_ball.contacts.spring_damper import contact_flow
from bouncing_ball.orbits import restitution_orbit as orbits
from bouncing_ball.orbits.restitution_orbit import ImpactMap

RNG = np.random.default_rng(5)
N = np.arange(1, 6)[:, np.newaxis]
R = np.array([0.1, 0.5, 0.85, 1.0])


def close(a, b, rel=1e-13):
    assert a == pytest.approx(b, rel=rel, abs=1e-14)


def test_flight():
    # Thrown from 2 at the time 1 with 3: at the top after 3, 4.5 higher.
    assert printed.free_flight(4.0, 1.0, 2.0, 3.0) == (6.5, 0.0)
    # Eqs. 14-15 start at the table, Λ sin(τ_b + φ).
    height, velocity = printed.flight(4.0, 1.0, 3.0, 2.0, np.pi / 2 - 1)
    assert (height, velocity) == (6.5, 0.0)


def test_the_impact_map():
    phase, velocity, flight = RNG.uniform(-3, 3, 20), RNG.uniform(1, 5, 20), RNG.uniform(1, 6, 20)
    gap = restitution.landing_gap(flight, phase, velocity, 0.7)
    close(printed.landing_defect(phase, velocity, flight, 0.7), -gap, rel=1e-12)
    bounced = restitution.bounce(flight, phase, velocity, 0.7, 0.6)
    close(printed.bounced_velocity(phase, velocity, flight, 0.7, 0.6), bounced)


def test_the_orbits_of_the_restitution_model():
    close(printed.saddle_node(N, R), orbits.saddle_node(N, R))
    amplitude = orbits.saddle_node(N, R) + 0.3
    phase, velocity = printed.fixed_point(N, R, amplitude)
    # arccos loses half of the digits next to the fold, not at 0.3 above it.
    close(phase, orbits.phase(N, R, amplitude), rel=1e-12)
    close(velocity, np.broadcast_to(N * np.pi, phase.shape))


def test_the_period_doubling_is_that_of_holmes_map():
    found = printed.period_doubling(N, R)
    close(found, orbits.period_doubling(N, R, ImpactMap.HOLMES))
    # At r = 1 both maps agree; elsewhere the exact one is above.
    exact = orbits.period_doubling(N, R, ImpactMap.EXACT)
    close(found[:, -1], exact[:, -1])
    assert np.all(exact[:, :-1] > found[:, :-1] * 1.0001)
    # The stiffest row of Table 1, to its three digits.
    assert printed.period_doubling(np.arange(1, 4), 0.85).round(3).tolist() == [1.032, 1.122, 1.259]


def test_the_contact():
    omega, zeta = np.exp(RNG.uniform(0.3, 5, 30)), RNG.uniform(0, 0.9, 30)
    lam, phase, impact = RNG.uniform(0.1, 2, (3, 30)) * [[1], [2], [-3]]
    time = np.pi / omega * RNG.uniform(0, 1, 30)
    a, b = RNG.uniform(-1, 1, (2, 30))
    start = printed.contact(0.0, omega, zeta, lam, phase, a, b)
    height, velocity = printed.contact(time, omega, zeta, lam, phase, a, b)
    flow = contact_flow(
        time,
        start[0] - lam * np.sin(phase),
        start[1] - lam * np.cos(phase),
        phase,
        lam,
        omega,
        zeta,
    )
    # Velocities are ϖ times heights: rounding of either side is of that size.
    scale = omega * (1 + np.abs(impact))
    assert np.abs(flow.displacement + lam * np.sin(phase + time) - height).max() < 1e-13
    assert (np.abs(flow.velocity + lam * np.cos(phase + time) - velocity) / scale).max() < 1e-14


def test_the_velocity_is_the_slope_of_the_height():
    # Fourth-order differences over h: h⁴ z⁗′/30 and rounding over h.
    h, args = 1e-3, (2.0, 0.2, 1.1, 0.4, 0.3, -0.8)
    z = [printed.contact(0.7 + k * h, *args)[0] for k in (-2, -1, 1, 2)]
    slope = (z[0] - 8 * z[1] + 8 * z[2] - z[3]) / (12 * h)
    assert printed.contact(0.7, *args)[1] == pytest.approx(slope, abs=1e-11)


def test_the_damping():
    close(printed.damping_ratio(R), damping.damping_ratio(R))
    assert [round(float(printed.damping_ratio(r)), 3) for r in (0.85, 0.65)] == [0.052, 0.136]


def test_the_velocity_balance():
    # A contact that takes no time: n-T orbits of the restitution model.
    assert printed.bounce_velocity(-np.pi, 1, 0.0) == np.pi
    assert printed.bounce_velocity(-2 * np.pi, 2, 0.5) == 2 * np.pi - 0.5


def test_permanent_contact():
    omega, zeta = np.exp(RNG.uniform(-1, 5, 30)), RNG.uniform(0, 0.7, 30)
    found = printed.permanent_contact_threshold(omega, zeta)
    # Printed as a sum of terms that cancel near the resonance.
    close(found, permanent_contact.permanent_contact_threshold(omega, zeta), rel=1e-11)
    close(
        printed.resonant_threshold(zeta), permanent_contact.permanent_contact_threshold(1.0, zeta)
    )
    lowest = permanent_contact.permanent_contact_minimum(zeta)
    close(printed.permanent_contact_minimum(zeta), lowest.threshold)
    level = lowest.threshold + (1 - lowest.threshold) * RNG.uniform(0.1, 0.9, 30)
    for sign in (-1, 1):
        ratio = printed.permanent_contact_frequency_ratio(level, zeta, sign)
        close(permanent_contact.permanent_contact_threshold(ratio, zeta), level, rel=1e-12)
    assert printed.restitution_threshold() == permanent_contact.RESTITUTION_THRESHOLD


def test_the_steady_response_is_the_contact_without_its_transient():
    time, omega, zeta, lam = np.linspace(0, 6, 9), 1.7, 0.3, 0.8
    height, _ = printed.contact(time, omega, zeta, lam, 0.4, 0.0, 0.0)
    steady = printed.steady_displacement(time + 0.4, omega, zeta, lam)
    close(steady, height - lam * np.sin(time + 0.4))
