"""Observables of orbits, their distances and derivatives."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import brentq

from bouncing_ball.models.damping import damping_ratio
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.models.spring_damper_model import SpringDamperModel
from bouncing_ball.periodic.orbit import Orbit
from bouncing_ball.periodic.spring_damper_bifurcations import orbit_at
from bouncing_ball.periodic.spring_damper_branch import branch_point, orbits_of


def test_the_greatest_height_of_a_ball_released_downwards_is_in_contact():
    # A stable orbit of a compliant contact: the ball turns round before release, so
    # its greatest height lies in the contact.
    r, omega, lam = 0.1546, 0.3691, 10.5378
    orbit = orbit_at(SpringDamper(omega, float(damping_ratio(r))), 1, lam)
    assert float(orbit.bounce_velocity) < 0
    time = np.linspace(0, float(orbit.contact_duration), 201)
    k = np.argmax(orbit.contact_path(time)[0])
    top = brentq(lambda at: orbit.contact_path(at)[1], time[k - 1], time[k + 1])
    # A height of order one, with the square of the time's error.
    assert float(orbit.max_height) == pytest.approx(orbit.contact_path(top)[0], abs=1e-13)


def test_the_distance_of_orbits_is_their_largest_difference():
    contact = SpringDamper(10.0, 0.05)
    point = branch_point(0.02, contact, 1)
    base = {
        "model": SpringDamperModel(contact),
        "n": 1,
        "amplitude": point.amplitude,
        "phase": point.phase + 2 * np.pi,  # the same table
        "contact_duration": point.contact_duration,
        "impact_velocity": point.u + point.x,
    }
    orbit = orbits_of(point, contact, 1)
    assert float(Orbit.of(**base).distance(orbit)) < 1e-14
    sizes = {"amplitude": 1, "phase": 1, "contact_duration": orbit.clock, "impact_velocity": 1}
    for name, size in sizes.items():
        moved = base | {name: base[name] + 1e-3}
        found = Orbit.of(**moved).distance(orbit)
        assert float(found) == pytest.approx(size * 1e-3, rel=1e-9)


@pytest.mark.parametrize("top", [0.0, 0.01, 0.5, 0.99, 1.0])
def test_the_highest_point_of_a_contact_is_found_next_to_its_ends(top):
    contact = SimpleNamespace(
        shape=(),
        durations=np.array([1.0]),
        phases=np.zeros(1),
        _lam=np.zeros(1),
        _in_contact=lambda time: (-((time - top) ** 2), None),
    )
    assert abs(Orbit._contact_top(contact)) < 1e-13


def test_a_contact_that_only_touches_its_release_has_no_derivatives():
    # δ′ = 0 at the impact and at the release of a contact without duration.
    orbit = Orbit.of(
        SpringDamperModel(SpringDamper(10.0, 0.05)), 1, 1.0, 0.0, 0.0, impact_velocity=1.0
    )
    assert np.all(np.isnan(orbit.monodromy()))
    assert not orbit.is_stable() and not orbit.is_admissible()
