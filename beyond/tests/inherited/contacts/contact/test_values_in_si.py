"""The numbers that a verdict prints, in SI units and from dimensionless orbits."""

import math

import pytest

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited import contacts as bb

FREQUENCY = 50.0
GRAVITY = 9.80665


def test_the_quantities_of_all_models_are_those_of_their_orbits_in_si_units():
    table = bb.Table(frequency=FREQUENCY, acceleration=0.8 * GRAVITY)
    contact = bb.Contact(mass=0.02, stiffness=1e6, restitution=0.85)
    found = bb.assess_contact(table, contact)
    omega = 2 * math.pi * FREQUENCY
    height = GRAVITY / omega**2
    speed = GRAVITY / omega
    ball = bouncing_ball_beyond.spring_damper(
        restitution=0.85, frequency_ratio=math.sqrt(1e6 / 0.02) / omega
    )
    one = found.orbits[0]
    orbit = bouncing_ball_beyond.orbit(ball, n=one.n, amplitude=0.8)
    model = next(iter(one.values["max_height"]))
    assert one.values["max_height"][model] == pytest.approx(height * orbit.max_height, rel=1e-9)
    assert one.max_height == pytest.approx(height * orbit.max_height, rel=1e-9)
    bounce = one.values["bounce_velocity"][model]
    assert bounce == pytest.approx(speed * orbit.bounce_velocity, rel=1e-9)
    assert one.values["phase"][model] == pytest.approx(orbit.phase, rel=1e-9)
    assert one.impact_speed == pytest.approx(-speed * orbit.relative_impact_velocity, rel=1e-9)
    assert one.contact_duration == pytest.approx(orbit.contact_duration / omega, rel=1e-9)
