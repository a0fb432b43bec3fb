"""Observables of orbits, their distances and derivatives."""

import numpy as np
import pytest
from orbits_found import FOUND, found_orbit
from scipy.optimize import brentq

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.numerics.corrector import solve
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import damping_ratio
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact.spring_damper_bifurcations import orbit_at
from bouncing_ball_beyond.periodic.one_impact.spring_damper_branch import (
    branch_point,
    orbits_of_points,
)
from bouncing_ball_beyond.periodic.orbits import motion
from bouncing_ball_beyond.periodic.orbits.highest import about_highest
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of
from bouncing_ball_beyond.periodic.orbits.motion import contact_path, in_contacts
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit


def test_the_greatest_height_of_a_ball_released_downwards_is_in_contact():
    # A stable orbit of a compliant contact: the ball turns round before release, so
    # its greatest height lies in the contact.
    r, omega, lam = 0.1546, 0.3691, 10.5378
    orbit = orbit_at(SpringDamper(omega, float(damping_ratio(r))), 1, lam)
    assert float(orbit.bounce_velocity) < 0
    time = np.linspace(0, float(orbit.contact_duration), 201)
    k = np.argmax(contact_path(orbit, time)[0])
    top = brentq(lambda at: contact_path(orbit, at)[1], time[k - 1], time[k + 1])
    # A height of order one, with the square of the time's error.
    assert float(orbit.max_height) == pytest.approx(contact_path(orbit, top)[0], abs=1e-13)


@pytest.mark.parametrize("case", [case for case in FOUND if case[1] > 1], ids=str)
def test_a_ball_leaves_each_contact_where_the_flight_to_the_next_impact_begins(case):
    # Also before a contact that resumes below the table's level.
    orbit = found_orbit(case)
    gap, _ = in_contacts(orbit, orbit.durations)
    released = gap + orbit.amplitude * np.sin(orbit.phases + orbit.durations)
    # The starts of the orbits have eight digits.
    assert orbit.bounce_height == pytest.approx(released, abs=1e-6)


def test_the_distance_of_orbits_is_their_largest_difference():
    contact = SpringDamper(10.0, 0.05)
    point = branch_point(0.02, contact, 1)
    base = {
        "model": ContactModel(contact),
        "n": 1,
        "amplitude": point.amplitude,
        "phase": point.phase + 2 * np.pi,  # the same table
        "contact_duration": point.contact_duration,
        "impact_velocity": point.u + point.x,
    }
    orbit = orbits_of_points(point, contact, 1)
    assert float(Orbit.of(**base).distance(orbit)) < 1e-14
    for name in ("amplitude", "phase", "contact_duration", "impact_velocity"):
        moved = Orbit.of(**base | {name: base[name] + 1e-3})
        size = np.pi / moved.contact_duration if name == "contact_duration" else 1.0
        assert moved.distance(orbit) == pytest.approx(size * 1e-3, rel=1e-9)


@pytest.mark.parametrize("top", [0.0, 0.01, 0.5, 0.99, 1.0])
def test_the_highest_point_of_a_contact_is_found_next_to_its_ends(top):
    def height(time):
        return -((time - top) ** 2)

    heights, *_ = about_highest(height, np.zeros(1), np.ones(1), motion._SAMPLES, motion._ROUNDS)
    assert abs(heights.max()) < 1e-13


def test_a_contact_that_only_touches_its_release_has_no_derivatives():
    # δ′ = 0 at the impact and at the release of a contact without duration.
    orbit = Orbit.of(ContactModel(SpringDamper(10.0, 0.05)), 1, 1.0, 0.0, 0.0, impact_velocity=1.0)
    assert np.all(np.isnan(orbit.monodromy()))
    assert not orbit.is_stable() and not orbit.is_admissible()


def test_an_orbit_with_a_small_defect_may_have_few_digits():
    """Rounding Λ up moves the states of an orbit of 28 impacts by 5e-4: 4 digits are certain."""
    ball = bouncing_ball_beyond.spring_damper(
        restitution=0.3, frequency_ratio=50.0, release="force"
    )
    start = {"phase": 1.0, "velocity": -3.0}
    one = bouncing_ball_beyond.orbit_of_motion(ball, amplitude=3.3, **start)
    other = bouncing_ball_beyond.orbit_of_motion(ball, amplitude=np.nextafter(3.3, 4.0), **start)
    assert one.impacts == other.impacts == 28 and one.defect() < 1e-13
    turned = [np.abs(np.roll(other.velocities, k) - one.velocities).max() for k in range(28)]
    shared = np.log10(np.abs(one.velocities).max() / min(turned))
    assert shared < 5 and abs(one.digits_left() - shared) < 1.5


def test_errors_of_the_equations_move_an_orbit_by_what_its_digits_tell():
    ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0)
    orbit = bouncing_ball_beyond.orbit(ball, amplitude=1.0)
    assert 14 < orbit.digits_left() < 16
    problem, y = equations_of(orbit)
    left, _, _ = np.linalg.svd(problem.jacobian(y))
    found = solve(lambda x: (problem.residual(x) - 1e-13 * left[:, -1], problem.jacobian(x)), y)
    moved = np.log10(np.abs(y).max() / np.abs(found.point - y).max())
    # Rounding errors of the equations are below 1e-13.
    assert 0 < orbit.digits_left() - moved < 3


def test_where_there_is_no_orbit_no_digit_is_certain():
    none = Orbit.of(ContactModel(SpringDamper(10.0, 0.05)), 1, [1.0, 1.1], np.nan)
    assert np.isnan(none.digits_left()).all()


@pytest.mark.parametrize(
    ("ball", "amplitude"),
    [
        (bouncing_ball_beyond.rigid(restitution=0.5), 1.6),
        (bouncing_ball_beyond.spring_damper(restitution=0.5, frequency_ratio=20.0), 1.6),
    ],
)
def test_the_history_of_an_orbit_is_that_of_a_simulated_ball(ball, amplitude):
    """Two impacts in two periods; a stable orbit keeps the roundings of the simulation small."""
    orbit = bouncing_ball_beyond.orbit_of_motion(ball, amplitude=amplitude)
    found = orbit.history(samples=50)
    start = {"phase": orbit.phase[0], "velocity": orbit.impact_velocity[0]}
    simulated = bouncing_ball_beyond.history(
        ball, amplitude=amplitude, periods=2.0, samples=50, **start
    )
    assert orbit.impacts == 2
    for name in ("ball", "table"):
        np.testing.assert_allclose(found[name], simulated[name], rtol=0, atol=1e-12)
    # At the last sample the next contact begins, before or after it by a rounding.
    np.testing.assert_array_equal(found.contact[:-1], simulated.contact[:-1])


def test_an_orbit_draws_itself_and_a_row_of_orbits_is_refused(tmp_path, refusal):
    ball = bouncing_ball_beyond.rigid(restitution=0.85)
    orbit = bouncing_ball_beyond.orbit(ball, n=1, amplitude=1.0)
    figure = orbit.plot(tmp_path / "orbit.png")
    assert (tmp_path / "orbit.png").is_file()
    drawn = {line.get_label(): line.get_ydata() for line in figure.axes[0].lines}
    assert drawn["ball $z$"].max() == pytest.approx(orbit.max_height, rel=1e-4)
    row = Orbit.of(orbit.model, 1, np.array([1.0, 1.0]), np.array([1.0, 1.1]))
    with refusal(ModelError, "history", "one orbit"):
        row.plot()
