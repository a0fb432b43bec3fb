"""The highest point within a contact and its gradient, and differences in given units."""

from dataclasses import replace

import numpy as np
import pytest
from orbits_found import balls, known_orbit

from bouncing_ball_beyond.models.damping import damping_ratio
from bouncing_ball_beyond.models.laws.motion import ContactDynamics
from bouncing_ball_beyond.models.linear_contact import LinearContactDynamics
from bouncing_ball_beyond.models.permanent_contact import permanent_contact_threshold
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.motions.orbit_of_motion import of_motion
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of
from bouncing_ball_beyond.periodic.orbits.special import release_condition, release_margin


def long_contact(ratio, excess):
    """The orbit with one long contact at E = ``excess`` above permanent contact."""
    lam = float(permanent_contact_threshold(ratio, damping_ratio(0.85))) + excess / ratio**2
    phase = np.pi / 2 + 3 / ratio
    velocity = lam * np.cos(phase) - 0.1 / ratio**2
    return of_motion(balls("spring-damper", lam, 0.85, ratio).model, lam, phase, velocity)


@pytest.mark.parametrize("along", ["amplitude", "frequency_ratio"])
@pytest.mark.parametrize("excess", [4.0, 15.0])
def test_the_gradient_of_the_highest_point_is_that_of_differences(excess, along):
    """With one and with two impacts; the highest point is that of the last contact."""
    orbit = long_contact(20.0, excess)
    problem, y = equations_of(orbit, along)
    value, gradient = release_condition(problem, y)
    assert value == release_margin(problem, y) and 0 < value < 1e-2
    step = 1e-6
    moved = [release_margin(problem, y + sign * step * np.eye(y.size)) for sign in (1, -1)]
    slopes = (moved[0] - moved[1]) / (2 * step)
    assert np.abs(gradient - slopes).max() < 1e-6 * np.abs(slopes).max()


def test_without_a_contact_that_lasts_there_is_no_highest_point():
    _, problem, y = known_orbit("restitution", 1.3)
    value, gradient = release_condition(problem, y)
    assert value == 1 and np.isnan(gradient).any()


def test_differences_are_accurate_on_a_stiff_contact():
    """At E = 4 the speed of the impact is 50 ϖ⁻³, at ϖ = 400 less than a step of 6e-6; the steps
    are shorter where an impact is slow.
    """
    ratio = 400.0
    power = np.array([1.0, 3.0, 1.0, 2.0])
    orbit = long_contact(20.0, 4.0)
    problem, here = equations_of(orbit, "amplitude")
    ratios = np.array([20.0, ratio])
    held = permanent_contact_threshold(ratios, damping_ratio(0.85))
    limit, origin = (np.array([np.pi / 2, 0, 2 * np.pi, np.arcsinh(lam)]) for lam in held)
    unit = ratio**-power
    here[2] = np.sinh(here[2]) / 20.0
    y = origin + unit * 20.0**power * (here - limit)
    y[2] = np.arcsinh(ratio * y[2])
    stiff = replace(problem, balls=problem.balls.at({"frequency_ratio": ratio}))
    # With D = 2π, arsinh ϖD changes by dD/2π.
    step = 1e-5 * unit / np.array([1.0, 1.0, 2 * np.pi, 1.0])
    moved = [stiff.residual(y + sign * np.diag(step)) for sign in (1, -1)]
    slopes = (moved[0] - moved[1]).T / (2 * step)

    with np.errstate(all="ignore"):
        off = (stiff.jacobian(y) - slopes) * unit
    # Relative to the largest term of each equation.
    assert np.abs(off / np.abs(slopes * unit).max(axis=1, keepdims=True)).max() < 1e-4


@pytest.mark.parametrize("kind", [LinearContactDynamics, ContactDynamics])
@pytest.mark.parametrize("release", ["displacement", "force"])
def test_the_release_function_is_the_displacement_and_the_lag_times_the_velocity(kind, release):
    """At many times within two contacts, against the flow of the linear contact."""
    law = SpringDamper(np.array([7.3, 25.0]), 0.12, release)
    dynamics = kind.of(law, 1.3)
    start = np.array([1.9, 2.3]), np.array([-0.3, -0.05])
    impact = dynamics.start(*start)
    departure = dynamics.depart(impact)
    time = np.linspace(0, 1, 50)[:, np.newaxis] * departure.duration
    found = dynamics.release_function(impact, departure)(time)
    flow = law.flow(time, 0.0, start[1], start[0], 1.3)
    exact = flow.displacement + law.lag * flow.velocity
    # Ten roundings of the terms, which are as large as the deepest penetration.
    assert np.all(np.abs(found - exact).max(axis=0) < 2e-15 * np.abs(exact).max(axis=0))
