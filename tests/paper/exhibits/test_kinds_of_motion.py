"""A periodic, a subharmonic and a chaotic ball."""

import numpy as np
import pytest

from bouncing_ball.errors import ModelError
from bouncing_ball.models.restitution import RestitutionModel
from bouncing_ball.models.simulation import impacts_of, next_impact
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.paper.exhibits.kinds_of_motion import growth, kinds_of_motion
from bouncing_ball.periodic.explicit import explicit_branch
from bouncing_ball.pipeline.job import typed

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


def test_the_three_balls_are_periodic_subharmonic_and_chaotic(balls, described):
    described(balls)
    assert balls.impacts.values.tolist() == [1, 2, 0]
    assert balls.periods.values.tolist() == [1, 2, 0]
    assert balls.stickings.values.tolist() == [0, 0, 0]
    assert np.isnan(balls.lyapunov_exponent.values).tolist() == [True, True, False]


def test_the_periodic_ball_ends_on_the_orbit_of_the_restitution_model():
    ball = RestitutionModel(0.5)
    path = impacts_of(ball, 1.2, 1.0, 1.2 * np.cos(1.0) - 5.0, 257)
    assert path.phase[-1, 0] == pytest.approx(float(explicit_branch(ball).orbit(1, 1.2).phase))


def test_a_small_deviation_of_the_simulated_ball_grows_as_the_map_says():
    ball = RestitutionModel(0.5)
    path = impacts_of(ball, 1.75, 1.0, 1.75 * np.cos(1.0) - 5.0, 6)
    start = path.phase[0, 0], path.relative_velocity[0, 0]
    moved = np.array([start[0] + 1e-7, start[1]])
    for k in range(5):
        leg = next_impact(ball, *moved, 1.75)
        moved = np.array([leg.phase, leg.velocity])
        there = np.array([path.phase[k + 1, 0], path.relative_velocity[k + 1, 0]])
        apart = np.array([reduce_angle(moved[0] - there[0]), moved[1] - there[1]])
        # A deviation of 1e-7 has a second order of 1e-7 of it, times that of the map.
        grown = np.log(np.linalg.norm(apart) / 1e-7)
        assert grown == pytest.approx(growth(path, 0)[: k + 1].sum(), abs=1e-4)


def test_the_exponent_of_chaos_does_not_depend_on_the_start(balls):
    again = typed(kinds_of_motion)(PARAMETERS | {"amplitude": [1.75], "impact_speed": 4.8})
    both = float(balls.lyapunov_exponent[-1]), float(again.lyapunov_exponent[0])
    error = np.hypot(float(balls.lyapunov_error[-1]), float(again.lyapunov_error[0]))
    assert abs(both[0] - both[1]) < 4 * error
    assert min(both) > 5 * error


def test_a_ball_that_sticks_has_no_exponent():
    data = typed(kinds_of_motion)(PARAMETERS | {"amplitude": [1.2], "impact_speed": 6.0})
    assert data.stickings.item() > 0 and np.isnan(data.lyapunov_exponent.item())


def test_a_ball_that_has_not_reached_its_orbit_up_to_rounding_does_not_repeat():
    # Next to the period doubling a ball takes more impacts than these to lose its last 1e-11.
    parameters = PARAMETERS | {"amplitude": [1.51, 1.515]}
    assert typed(kinds_of_motion)(parameters).impacts.values.tolist() == [1, 0]
    many = typed(kinds_of_motion)(parameters | {"impacts": 1536})
    assert many.impacts.values.tolist() == many.periods.values.tolist() == [1, 1]


def test_a_ball_that_comes_to_rest_for_ever_is_refused(refusal):
    said = "comes to rest on the table after", "only above Λ = 1 does the table throw it off"
    with refusal(ModelError, "the ball at Λ = 0.5", *said):
        typed(kinds_of_motion)(PARAMETERS | {"amplitude": [1.2, 0.5]})
