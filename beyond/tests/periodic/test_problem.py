"""Orbits with k impacts: against closed forms, differences, and shooting with an integrator."""

import numpy as np
import pytest
import shooting
from orbits_found import FOUND, balls, first, found_orbit, known_orbit

from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation
from bouncing_ball_beyond.periodic.branches.following import branch_from, point_near
from bouncing_ball_beyond.periodic.orbits.halves import twice
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of
from bouncing_ball_beyond.periodic.orbits.simulation import is_admissible
from bouncing_ball_beyond.periodic.orbits.special import Special, flight_margin, opening_rate

CLOSED = ["restitution", "spring-damper", "force release", "corrected"]
ALL = [*CLOSED, "tsuji"]
ALONG = [
    (name, along)
    for name in CLOSED
    for along in ("amplitude", "restitution", "frequency_ratio")
    if along != "frequency_ratio" or name != "restitution"
]


@pytest.fixture(params=FOUND, ids=lambda case: f"{case[0]}-{case[1]}-{case[2]}")
def case(request):
    return request.param


@pytest.mark.parametrize(("name", "along"), ALONG)
def test_an_orbit_with_one_impact_is_that_of_the_closed_form(name, along):
    orbit, problem, y = known_orbit(name, 1.3, (along,))
    assert np.abs(problem.residual(y)).max() < 1e-13
    ours = problem.trace_and_determinant(y)
    assert np.abs(np.subtract(ours, orbit.trace_and_determinant())).max() < 1e-12
    assert is_admissible(problem, y) == orbit.is_admissible()


def test_the_functions_of_special_orbits_are_not_defined_outside_the_range_of_a_parameter():
    _, problem, inside = known_orbit("restitution", 1.3, ("restitution",))
    outside = inside.copy()
    outside[-1] = np.arcsinh(1.5)
    several = np.stack([outside, outside, outside])
    for function in (flight_margin, opening_rate):
        assert np.isfinite(function(problem, inside))
        one = function(problem, outside)
        assert one.shape == () and np.isnan(one)
        values = function(problem, several)
        assert values.shape == (3,) and np.all(np.isnan(values))


@pytest.mark.parametrize("name", CLOSED)
def test_newtons_method_comes_back_to_the_closed_form(name):
    _, problem, y = known_orbit(name, 1.3)
    moved = y.copy()
    moved[:2] += [1e-3, -2e-3]
    assert np.abs(point_near(problem, moved) - y).max() < 1e-12


@pytest.mark.parametrize("name", ALL)
def test_the_jacobian_is_that_of_differences(name):
    _, problem, y = known_orbit(name, 1.3)
    whole, y = twice(problem, y)
    step = 1e-6
    moved = [whole.residual(y + sign * step * np.eye(y.size)) for sign in (1, -1)]
    slopes = (moved[0] - moved[1]).T / (2 * step)
    # The residuals are of order one; central differences of both kinds have errors of 1e-9.
    assert np.abs(whole.jacobian(y) - slopes).max() < 1e-7


@pytest.mark.parametrize("later", [-1e-6, 1e-6])
def test_the_jacobian_is_that_of_differences_on_both_sides_of_a_contact_without_speed(later):
    """A contact resumes with δ′ = 0 at the level of the table; beside it δ′ and δ have both signs,
    and the flight before it still ends where δ + κ δ′ vanishes.
    """
    orbit = found_orbit(FOUND[-2])
    grazing = first(branch_from(orbit, "frequency_ratio", 20.0), Special.GRAZING_IMPACT)
    problem, y = equations_of(grazing, "frequency_ratio")
    assert problem.resuming.tolist() == [False, True]
    assert abs(y[3]) < 1e-12
    y[2] += later
    rise = problem.legs(y).landing.velocity[0]
    # δ″ is about -1 there.
    assert rise == pytest.approx(-later, rel=0.1)
    step = 1e-6
    moved = [problem.residual(y + sign * step * np.eye(y.size)) for sign in (1, -1)]
    slopes = (moved[0] - moved[1]).T / (2 * step)
    # The residuals at y are of the order of its distance from the orbit, and so is the error.
    assert np.abs(problem.jacobian(y) - slopes).max() < 10 * abs(later)


@pytest.mark.parametrize("kind", list(Bifurcation))
@pytest.mark.parametrize("name", CLOSED)
def test_the_gradient_of_a_bifurcation_is_that_of_differences(name, kind):
    _, problem, y = known_orbit(name, 1.3, ("amplitude", "restitution"))
    value, gradient = problem.bifurcation(kind, y)
    assert value == pytest.approx(float(kind.test(*problem.trace_and_determinant(y))), abs=1e-13)
    step = 1e-5
    moved = [problem.bifurcation(kind, y + sign * step * np.eye(y.size))[0] for sign in (1, -1)]
    assert np.abs(gradient - (moved[0] - moved[1]) / (2 * step)).max() < 1e-6


def test_an_orbit_with_several_impacts_is_that_of_shooting_with_another_integrator(case):
    name, impacts, periods, r, ratio, amplitude, phase, velocity = case
    orbit = found_orbit(case)
    ball = (name, r, ratio, amplitude)
    expected = shooting.orbit(phase, velocity, impacts, periods, *ball)
    relative = expected[1] - amplitude * np.cos(expected[0])
    assert orbit.phase[0] == pytest.approx(expected[0], abs=1e-8)
    assert orbit.relative_impact_velocity[0] == pytest.approx(relative, abs=1e-8)
    assert orbit.defect() < 1e-12 and orbit.is_admissible() and orbit.is_stable()


def test_the_determinant_of_the_return_map_is_that_of_the_closed_form(case):
    name, impacts, _, r, ratio, *_ = case
    orbit = found_orbit(case)
    determinant = orbit.trace_and_determinant()[1]
    if name == "restitution":
        expected = r ** (2 * impacts)
    else:
        zeta = -np.log(r) / np.hypot(np.pi, np.log(r))
        expected = np.exp(-2 * zeta * ratio * orbit.contact_duration.sum())
    # The determinant is a difference of products of the entries of the monodromy.
    (a, b), (c, d) = orbit.monodromy()
    assert abs(determinant - expected) < 1e-13 * (abs(a * d) + abs(b * c) + 1)


def test_parameters_outside_their_ranges_have_no_residual():
    problem, y = known_orbit("restitution", 1.3, ("restitution",))[1:]
    beyond = y.copy()
    beyond[-1] = np.arcsinh(1.1)
    assert np.isnan(problem.residual(beyond)).any()
    rows = problem.residual(np.stack([y, beyond]))
    assert np.abs(rows[0]).max() < 1e-13 and np.isnan(rows[1]).any()


def test_an_unknown_parameter_is_refused(refusal):
    with refusal(ValueError, "these orbits have no 'stiffness': one of"):
        balls("restitution", 1.0).range_of("stiffness")
