"""Observables of an orbit of the spring-damper model."""

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
        "n": 1,
        "law": contact,
        "amplitude": point.amplitude,
        "phase": point.phase + 2 * np.pi,  # the same table
        "contact_duration": point.contact_duration,
        "impact_velocity": point.u + point.x,
    }
    orbit = orbits_of(point, contact, 1)
    assert float(Orbit(**base).distance(orbit)) < 1e-14
    sizes = {"amplitude": 1, "phase": 1, "contact_duration": 10, "impact_velocity": 1}
    for name, size in sizes.items():
        moved = base | {name: base[name] + 1e-3}
        found = Orbit(**moved).distance(orbit)
        assert float(found) == pytest.approx(size * 1e-3, rel=1e-9)


@pytest.mark.parametrize("top", [0.0, 0.01, 0.5, 0.99, 1.0])
def test_the_highest_point_of_a_contact_is_found_next_to_its_ends(top):
    contact = SimpleNamespace(
        shape=(), contact_duration=np.array(1.0), contact_path=lambda time: (-((time - top) ** 2),)
    )
    assert abs(Orbit._contact_top(contact)) < 1e-13


def test_a_contact_that_only_touches_its_release_has_no_derivatives():
    # δ′ = 0 at the impact and at the release of a contact without duration.
    orbit = Orbit.of(
        SpringDamperModel(SpringDamper(10.0, 0.05)), 1, 1.0, 0.0, 0.0, impact_velocity=1.0
    )
    assert np.all(np.isnan(orbit.contact_jacobian()[0]))
    assert not orbit.is_stable() and not orbit.is_admissible()
