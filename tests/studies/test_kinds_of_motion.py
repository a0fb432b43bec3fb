"""Kinds of motion of balls that start beside the 1-T orbit."""

import numpy as np
import pytest

from bouncing_ball.configuration.study import typed
from bouncing_ball.studies.kinds_of_motion import kinds_of_motion

kinds_of_motion = typed(kinds_of_motion)

SMALL = {
    "n": 1,
    "restitution": 0.85,
    "amplitude": [1.0, 1.1, 2.0],
    "ensemble": {
        "balls": 40,
        "displacement": 0.01,
        "transient": 200,
        "impacts": 200,
        "longest_period": 8,
    },
}


def test_period_one_two_and_chaos():
    motions = kinds_of_motion(SMALL)
    assert motions.motion_period.values.tolist() == [1, 2, 0]
    # Complex multipliers of modulus r, of both orbits.
    assert motions.lyapunov_exponent.values[:2] == pytest.approx(np.log(0.85), abs=0.005)
    assert motions.lyapunov_error.values[0] < 1e-4
    # By the mapper, from 300 balls elsewhere of 1500 impacts each: 0.6042 ± 0.0011.
    error = motions.lyapunov_error.values[2]
    assert 0.005 < error < 0.05
    assert abs(motions.lyapunov_exponent.values[2] - 0.6042) < 5 * error


def test_balls_that_go_different_ways_share_no_period():
    # From farther away some reach the orbit of period 3.
    far = SMALL | {"ensemble": SMALL["ensemble"] | {"displacement": 1.0}}
    assert kinds_of_motion(far | {"amplitude": [1.0]}).motion_period.values.tolist() == [0]


def test_balls_beside_an_orbit_from_which_the_table_falls():
    # At the start the table is 400 times as fast as the ball, and not toward it.
    far = {"balls": 8, "displacement": 1.0, "transient": 10, "impacts": 100, "longest_period": 2}
    motions = kinds_of_motion(SMALL | {"amplitude": [1000.0], "ensemble": far})
    assert np.all(np.isfinite(motions.lyapunov_exponent))
