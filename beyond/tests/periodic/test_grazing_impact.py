"""Where an impact disappears: its orbit ends in one with an impact less, whose flight grazes."""

from dataclasses import replace

import numpy as np
import pytest
from orbits_found import balls, first, legs_of
from scipy.optimize import brentq

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.models.flight import table
from bouncing_ball_beyond.inherited.numerics.corrector import plane
from bouncing_ball_beyond.periodic.branches.following import branch_from
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of
from bouncing_ball_beyond.periodic.orbits.orbit import orbit_of_point
from bouncing_ball_beyond.periodic.orbits.short_steps import ShortSteps, newton_short
from bouncing_ball_beyond.periodic.orbits.special import Special
from bouncing_ball_beyond.periodic.orbits.steps import STEPS

# The first orbit with the additional impact has this closing speed, and is looked for nearby.
SLOW = 3e-3
NEARBY = ShortSteps(0.01)


def touching(orbit, amplitude, duration, leaving):
    """Time and height of the lowest point of the flight, from the sum of two sines and a parabola.

    The flight begins ``duration`` after the impact of a 1-T orbit with the relative velocity
    ``leaving``, on the level of the table.
    """
    start = float(orbit.phase) + duration
    launch = leaving + amplitude * np.cos(start)

    def rate(t):
        return launch - t - amplitude * np.cos(start + t)

    # δ″ = Λ sin τ - 1 is positive around the top of the table, and nowhere else.
    half = np.arccos(1 / amplitude)
    middle = np.pi / 2 - start
    middle += 2 * np.pi * (middle < 0)
    lowest = brentq(rate, middle - half, middle + half, xtol=1e-15)
    rise = launch * lowest - lowest**2 / 2
    return lowest, rise + amplitude * (np.sin(start) - np.sin(start + lowest))


def with_a_slow_impact(orbit, amplitude, duration, leaving):
    """The orbit with two impacts beside the 1-T orbit whose flight grazes."""
    problem, _ = equations_of(orbit, "amplitude")
    aloft, _ = touching(orbit, amplitude, duration, leaving)
    phase = orbit.phase
    second = phase + duration + aloft
    pull = table(second, amplitude)[1] - 1
    whole = replace(problem, impacts=2, turns=np.array([0, 1]))
    guess = whole.point(
        np.array([phase, second - SLOW / pull]),
        np.array([float(orbit.relative_impact_velocity), -SLOW]),
        np.array([duration, 2 * SLOW / pull]),
        amplitude=amplitude,
    )
    found = newton_short(whole, guess, plane(np.eye(guess.size)[3], guess), NEARBY)
    assert found.converged
    return orbit_of_point(whole, found.point)


@pytest.mark.parametrize("restitution", [0.3, 0.5, 0.7])
def test_an_impact_grazes_where_bisection_finds_the_grazing_flight(restitution):
    model = balls("restitution", 1.3, restitution).model

    def height(amplitude):
        orbit = n_t.orbit(model, 1, amplitude, "unstable")
        leaving = -restitution * float(orbit.relative_impact_velocity)
        return touching(orbit, amplitude, 0.0, leaving)[1]

    # The first flight is above the table, and the second below it.
    amplitude = brentq(height, 2.4, 3.0, xtol=1e-15)
    orbit = n_t.orbit(model, 1, amplitude, "unstable")
    leaving = -restitution * float(orbit.relative_impact_velocity)
    slow = with_a_slow_impact(orbit, amplitude, 0.0, leaving)
    assert slow.is_admissible()
    # The orbit with two impacts exists above or below, which depends on r.
    increasing = slow.amplitude < amplitude
    found = branch_from(slow, increasing=increasing, control=replace(STEPS, initial=1e-4))
    grazing = first(found, Special.GRAZING_IMPACT)
    assert grazing.amplitude == pytest.approx(amplitude, abs=1e-12)
    assert abs(grazing.relative_impact_velocity.max()) < 1e-12
    assert str(found.branch.end).startswith("grazing of an impact")
    _is_on_its_curve(grazing, amplitude)


def _is_on_its_curve(impact, amplitude):
    """In two parameters the grazing impact is followed as the grazing flight without it."""
    curve = bouncing_ball_beyond.follow(
        impact, along=("amplitude", "restitution"), points=10
    ).to_dataset()
    assert (curve.attrs["curve_kind"], curve.attrs["impacts"]) == ("grazing of a flight", 1)
    start = int(
        np.argmin(np.abs(curve.restitution.values - float(impact.model.numbers()["restitution"])))
    )
    assert float(curve.amplitude[start]) == pytest.approx(amplitude, abs=1e-12)
    assert 0 < start < curve.sizes["point"] - 1


def test_an_impact_of_a_compliant_contact_disappears_with_its_contact():
    """Its contact becomes an instant, whose equations hold beyond the grazing as well."""
    model = balls("spring-damper", 2.0).model
    grazing = first(branch_from(n_t.orbit(model, 1, 2.0), to=0.9), Special.GRAZING_FLIGHT)
    amplitude = grazing.amplitude
    orbit = n_t.orbit(model, 1, amplitude, "unstable")
    legs = legs_of(grazing)
    duration = float(legs.duration[0])
    leaving = float(legs.departure.flight.velocity[0])
    assert abs(touching(orbit, amplitude, duration, leaving)[1]) < 1e-12
    slow = with_a_slow_impact(orbit, amplitude, duration, leaving)
    found = branch_from(slow, increasing=False, control=replace(STEPS, initial=1e-4))
    assert str(found.branch.end).startswith("grazing of an impact")
    ended = first(found, Special.GRAZING_IMPACT)
    assert ended.amplitude == pytest.approx(amplitude, abs=1e-12)
    assert abs(ended.relative_impact_velocity.max()) < 1e-12
    *before, _ = found
    closing = np.array([-each.relative_impact_velocity.max() for each in before])
    assert np.all(np.diff(closing) < 0) and closing[-1] > 0
    # What is left of the impact changes Λ by its speed's square, apart from a factor of order 1.
    assert abs(before[-1].amplitude - amplitude) < 10 * closing[-1] ** 2
    _is_on_its_curve(ended, amplitude)


def test_a_grazing_impact_without_a_grazing_flight_has_no_curve(refusal):
    both = ("amplitude", "restitution")
    # Another flight of this orbit is below the table.
    ball = bouncing_ball_beyond.rigid(restitution=0.5)
    branch = bouncing_ball_beyond.follow(
        bouncing_ball_beyond.orbit_of_motion(ball, amplitude=1.6), to=8
    )
    with refusal(NoOrbitError, "another flight is below the table by 2,"):
        bouncing_ball_beyond.follow(branch.first("grazing of an impact"), along=both)
    one = replace(bouncing_ball_beyond.orbit(ball, amplitude=1.4), kind="grazing of an impact")
    with refusal(NoOrbitError, "the only impact of the orbit grazes"):
        bouncing_ball_beyond.follow(one, along=both)
    # After a release by force below its level, the ball comes back to this level.
    ball = bouncing_ball_beyond.spring_damper(
        restitution=0.34, frequency_ratio=10.0, release="force"
    )
    two = bouncing_ball_beyond.orbit_of_motion(ball, amplitude=1.4, phase=0.0, velocity=-5.0)
    branch = bouncing_ball_beyond.follow(two, to=0.8)
    with refusal(NoOrbitError, "only just comes up to the level of the table"):
        bouncing_ball_beyond.follow(branch.first("grazing of an impact"), along=both)
