"""A periodic, a subharmonic and a chaotic ball."""

import numpy as np
import pytest
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.periodic.one_impact import n_t

from bouncing_ball.errors import ModelError
from bouncing_ball.paper.exhibits.kinds_of_motion import kinds_of_motion
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


def test_the_three_balls_are_periodic_subharmonic_and_chaotic(balls, described):
    described(balls)
    assert balls.impacts.values.tolist() == [1, 2, 0]
    assert balls.periods.values.tolist() == [1, 2, 0]
    assert balls.stickings.values.tolist() == [0, 0, 0]
    assert np.isnan(balls.lyapunov_exponent.values).tolist() == [True, True, False]


def test_the_periodic_ball_ends_on_the_orbit_of_the_restitution_model():
    path = RestitutionModel(0.5).simulate(1.2, 1.0, 1.2 * np.cos(1.0) - 5.0, 257)
    assert path.phase[-1] == pytest.approx(float(n_t.orbit(RestitutionModel(0.5), 1, 1.2).phase))


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
    many = typed(kinds_of_motion)(parameters | {"impacts": 4096})
    assert many.impacts.values.tolist() == many.periods.values.tolist() == [1, 1]


def test_a_ball_that_comes_to_rest_for_ever_is_refused(refusal):
    said = "comes to rest on the table after", "only above Λ = 1 does the table throw it off"
    with refusal(ModelError, "the ball at Λ = 0.5", *said):
        typed(kinds_of_motion)(PARAMETERS | {"amplitude": [1.2, 0.5]})
