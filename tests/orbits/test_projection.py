"""The nearest point of the explicit branch."""

import numpy as np
import pytest

from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.orbits.projection import nearest_excess
from bouncing_ball.orbits.spring_damper_branch import branch_point
from bouncing_ball.orbits.spring_damper_limits import saddle_node
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit


@pytest.mark.parametrize("release", list(Release))
@pytest.mark.parametrize("omega", [2.0, 10.0, 1e4])
def test_points_of_the_branch_are_their_own_nearest(omega, release):
    contact = SpringDamper(omega, 0.05, release)
    excess = float(saddle_node(contact, 2)) + np.linspace(-1, 1, 11) / omega
    point = branch_point(excess, contact, 2)
    orbit = SpringDamperOrbit.from_branch(point, contact, 2)
    found = nearest_excess(orbit)
    # Also at the fold. ε to the rounding of X and Y over the speed along ε.
    assert found == pytest.approx(excess, abs=1e-14)
    again = SpringDamperOrbit.from_branch(branch_point(found, contact, 2), contact, 2)
    assert orbit.distance(again).max() < 1e-12


def test_distance_is_the_largest_difference():
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
    orbit = SpringDamperOrbit.from_branch(point, contact, 1)
    assert float(SpringDamperOrbit(**base).distance(orbit)) < 1e-14
    sizes = {"amplitude": 1, "phase": 1, "contact_duration": 10, "impact_velocity": 1}
    for name, size in sizes.items():
        moved = base | {name: base[name] + 1e-3}
        found = SpringDamperOrbit(**moved).distance(orbit)
        assert float(found) == pytest.approx(size * 1e-3, rel=1e-9)


def test_an_orbit_beside_the_branch():
    contact = SpringDamper(10.0, 0.05)
    point = branch_point(0.02, contact, 1)
    # One step normal to the curve in the plane (Λ cos φ, Λ sin φ).
    normal = np.array([-point.d_y, point.d_x]) / np.hypot(point.d_x, point.d_y)
    x, y = point.x + 1e-4 * normal[0], point.y + 1e-4 * normal[1]
    orbit = SpringDamperOrbit(
        1, contact, np.hypot(x, y), np.arctan2(y, x), point.contact_duration, point.u + point.x
    )
    assert float(nearest_excess(orbit)) == pytest.approx(0.02, abs=1e-9)
