"""A periodic, a subharmonic and a chaotic ball."""

import numpy as np
import pytest

from bouncing_ball.errors import ModelError
from bouncing_ball.models.restitution import RestitutionDynamics
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.paper.exhibits.kinds_of_motion import (
    Path,
    follow,
    growth_rate,
    impacts_until_repetition,
    kinds_of_motion,
)
from bouncing_ball.periodic import n_t
from bouncing_ball.pipeline.configuration import typed

PARAMETERS = {
    "restitution": 0.5,
    "amplitude": [1.2, 1.6, 1.75],
    "phase": 1.0,
    "impact_speed": 5.0,
    "impacts": 512,
}


@pytest.fixture(scope="module")
def balls():
    return typed(kinds_of_motion)(PARAMETERS)


def dynamics(*amplitudes):
    return RestitutionDynamics.of(np.full(len(amplitudes), 0.5), np.array(amplitudes))


def test_the_three_balls_are_periodic_subharmonic_and_chaotic(balls, described):
    described(balls)
    assert balls.impacts.values.tolist() == [1, 2, 0]
    assert balls.periods.values.tolist() == [1, 2, 0]
    assert balls.stickings.values.tolist() == [0, 0, 0]
    assert np.isnan(balls.lyapunov_exponent.values).tolist() == [True, True, False]


def test_the_periodic_ball_ends_on_the_orbit_of_the_restitution_model():
    path = follow(dynamics(1.2), 1.0, 5.0, 256)
    assert path.phase[-1, 0] == pytest.approx(float(n_t.orbit(RestitutionModel(0.5), 1, 1.2).phase))


def test_next_to_an_orbit_a_deviation_grows_by_its_floquet_multiplier():
    # At the period doubling the multipliers are real beyond it, and the larger one decides.
    amplitude = 1.52
    orbit = n_t.orbit(RestitutionModel(0.5), 1, amplitude)
    multiplier = np.abs(orbit.multipliers()).max()
    rate, _ = growth_rate(follow(dynamics(amplitude), float(orbit.phase), 4.5, 2048))
    assert rate[0] == pytest.approx(np.log(multiplier), rel=1e-3)


def test_two_neighbours_of_the_chaotic_ball_separate_as_the_derivative_says():
    near = 1e-11
    path = follow(dynamics(1.75), 1.0, 5.0, 40)
    moved = follow(dynamics(1.75), 1.0 + near, 5.0, 40)
    apart = np.hypot(moved.phase[-1] - path.phase[-1], moved.velocity[-1] - path.velocity[-1])
    assert np.log(apart / near) == pytest.approx(path.growth.sum(axis=0), abs=1e-2)


def test_the_exponent_of_chaos_does_not_depend_on_the_start(balls):
    again = typed(kinds_of_motion)(PARAMETERS | {"amplitude": [1.75], "impact_speed": 4.8})
    both = float(balls.lyapunov_exponent[-1]), float(again.lyapunov_exponent[0])
    error = np.hypot(float(balls.lyapunov_error[-1]), float(again.lyapunov_error[0]))
    assert abs(both[0] - both[1]) < 4 * error
    assert min(both) > 5 * error


def test_a_ball_that_sticks_has_no_exponent():
    data = typed(kinds_of_motion)(PARAMETERS | {"amplitude": [1.2], "impact_speed": 6.0})
    assert data.stickings.item() > 0 and np.isnan(data.lyapunov_exponent.item())


def test_states_that_differ_by_more_than_rounding_do_not_repeat():
    phase = np.tile([[0.5], [0.7]], (100, 1))
    drift = phase + 1e-9 * np.arange(200)[:, np.newaxis]
    assert impacts_until_repetition(Path(drift, phase, phase, phase, phase)).tolist() == [0]


def test_a_ball_that_comes_to_rest_for_ever_is_refused(refusal):
    said = "comes to rest on the table after", "only above Λ = 1 does the table throw it off"
    with refusal(ModelError, "the ball at Λ = 0.5", *said):
        typed(kinds_of_motion)(PARAMETERS | {"amplitude": [1.2, 0.5]})
