"""Stiffness and damping from every sufficient set, by two ways each."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from bouncing_ball.calculator.case import Case, Table
from bouncing_ball.calculator.contact_data import hertz, stiffness_and_damping
from bouncing_ball.contacts.law_signature import free_impact
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import contact_flow
from bouncing_ball.errors import ModelError

MASS = 0.02
ROUNDING = 1e-12


def found(release=Release.DISPLACEMENT, **given):
    return stiffness_and_damping(MASS, given, release)


@pytest.mark.parametrize("release", Release)
def test_every_set_gives_the_contact_it_was_taken_from(release):
    k, c = 1e6, 20.0
    case = Case(MASS, Table(300.0, 1e-4, 9.81), k, c, release)
    zeta, time = c / (2 * math.sqrt(k * MASS)), case.contact_time
    own, printed = (
        float(case.contact.restitution),
        math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2)),
    )
    for given in (
        {"stiffness": k, "damping": c},
        {"stiffness": k, "damping_ratio": zeta},
        {"stiffness": k, "restitution": printed},
        {"stiffness": k, "measured_restitution": own},
        {"stiffness": k, "drop_height": 2.0, "rebound_height": 2.0 * own**2},
        {"contact_time": time, "restitution": printed},
        {"contact_time": time, "measured_restitution": own},
        {"contact_time": time, "drop_height": 0.5, "rebound_height": 0.5 * own**2},
    ):
        assert found(release, **given) == pytest.approx((k, c), rel=ROUNDING), given


@pytest.mark.parametrize("release", Release)
def test_the_contact_time_is_that_of_the_flow(release):
    k, c = found(release, contact_time=1e-3, restitution=0.6)
    # In seconds, without table and gravity: the flow is linear in the speed, and
    # so large a one leaves the weight below rounding.
    omega = math.sqrt(k / MASS)
    zeta = c / (2 * math.sqrt(k * MASS))
    end = contact_flow(1e-3, 0.0, -1e12, 0.0, 0.0, omega, zeta)
    held = end.displacement + (c / k) * end.velocity * (release is Release.FORCE)
    assert abs(held) < 1e-9 * end.velocity / omega


def test_the_hertz_contact_is_that_of_the_energy():
    # Without damping ½ m v² = ½ m x′² + (8/15) E* √R x^{5/2}; there and back.
    table, m, modulus, radius, v = Table(300.0, 1e-4, 9.81), 0.02, 1.15e11, 5e-3, 0.4
    rigid = 4 / 3 * modulus * math.sqrt(radius)
    deepest = (5 * m * v * v / (4 * rigid)) ** 0.4
    # x = deepest (1 - s²) takes the root out of the integrand.
    integral, _ = quad(lambda s: 2 * s / math.sqrt(1 - (1 - s * s) ** 2.5), 0, 1)
    law = hertz(m, modulus, radius, 1.0, table)
    found = float(free_impact(law, v / table.speed).duration) * table.time
    assert found == pytest.approx(2 * deepest / v * integral, rel=1e-9)
    # The constant that simulators print.
    printed = 2.868 * (m**2 / (radius * modulus**2 * v)) ** 0.2
    assert found == pytest.approx(printed, rel=2e-4)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"stiffness": 1e6}, "how much the contact loses is missing"),
        ({"stiffness": 1e6, "restitution": 0.5, "damping": 1.0}, "contradict each other"),
        ({"stiffness": 1e6, "contact_time": 1e-3, "restitution": 0.5}, "contradict each other"),
        ({"contact_time": 1e-3, "damping": 1.0}, "damping needs stiffness"),
        ({"stiffness": 1e6, "damping": 1e6}, "not below the critical"),
        ({"stiffness": 1e6, "damping_ratio": 1.0}, "below 1"),
        ({"stiffness": 1e6, "rebound_height": 0.5}, "needed together"),
        ({"reduced_modulus": 1e11, "restitution": 0.5}, "needed together"),
        ({"stiffness": 1e6, "drop_height": 0.5, "rebound_height": 1.0}, "above drop_height"),
    ],
)
def test_what_does_not_suffice_or_contradicts(given, says):
    with pytest.raises(ModelError) as error:
        found(**given)
    assert says in str(error.value)


def test_a_drop_test_without_loss():
    assert np.all(np.array(found(stiffness=1e6, drop_height=1.0, rebound_height=1.0)) == (1e6, 0))
