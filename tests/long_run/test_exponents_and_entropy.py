"""The sum of both Lyapunov exponents, and the basin entropy of maps that are known."""

import math

import numpy as np
import pytest
import xarray as xr

import bouncing_ball
from bouncing_ball.errors import ModelError


@pytest.mark.parametrize("amplitude", [1.4, 1.6])
def test_the_exponents_of_an_orbit_are_those_of_its_multipliers(amplitude):
    ball = bouncing_ball.spring_damper(restitution=0.5, frequency_ratio=40.0)
    orbit = bouncing_ball.orbit_of_motion(ball, amplitude=amplitude, phase=1.0, velocity=-3.0)
    found = bouncing_ball.lyapunov_exponent(ball, amplitude=amplitude, phase=1.0, velocity=-3.0)
    expected = np.log(np.abs(orbit.multipliers())) / orbit.periods
    # The ball is within 1e-7 of the orbit, see long_run.lyapunov.NEAR.
    assert float(found.lyapunov_exponent) == pytest.approx(expected[0], abs=1e-6)
    assert float(found.second_exponent) == pytest.approx(expected[1], abs=1e-6)
    assert float(found.exponent_sum) == pytest.approx(
        math.log(orbit.determinant()) / orbit.periods, abs=1e-6
    )


def test_the_sum_of_the_exponents_of_a_chaotic_ball_counts_its_impacts():
    """In the restitution model areas shrink by r² at each impact, so that the sum is 2 ln r times
    the number of impacts per period; the number comes from a simulation of its own.
    """
    ball = bouncing_ball.rigid(restitution=0.9)
    found = bouncing_ball.lyapunov_exponent(ball, amplitude=2.5, impacts=400)
    assert found.kind.item() == "chaotic"
    motion = bouncing_ball.motion_of(ball, amplitude=2.5, impacts=400)
    start = {"phase": float(motion.end_phase), "velocity": float(motion.end_velocity)}
    followed = bouncing_ball.simulate(ball, amplitude=2.5, impacts=401, **start)
    rate = 400 / (float(followed.time[-1]) / (2 * math.pi))
    assert float(found.exponent_sum) == pytest.approx(2 * math.log(0.9) * rate, rel=1e-12)
    total = float(found.lyapunov_exponent + found.second_exponent)
    assert total == pytest.approx(float(found.exponent_sum), rel=1e-14)


def test_a_ball_that_forgets_has_two_exponents_of_minus_infinity():
    found = bouncing_ball.lyapunov_exponent(bouncing_ball.rigid(restitution=0.6), amplitude=3.0)
    assert found.kind.item() == "locked"
    assert float(found.second_exponent) == float(found.exponent_sum) == -np.inf


def _map(which):
    return xr.Dataset({"destination": (("start_speed", "start_phase"), np.asarray(which))})


def test_the_basin_entropy_of_known_maps():
    one = bouncing_ball.basin_entropy(_map(np.zeros((10, 10), int)))
    assert (one.entropy, one.boundary_boxes) == (0.0, 0) and math.isnan(one.boundary_entropy)
    # Any box of a map at random has the entropy of its shares: with three motions in equal parts
    # the expectation is below ln 3 by (3 - 1)/(2 · 25) in the first order (Miller's correction).
    rng = np.random.default_rng(1)
    mixed = bouncing_ball.basin_entropy(_map(rng.integers(0, 3, (500, 500))), box=5)
    error = 0.05 / math.sqrt(mixed.boxes)
    assert mixed.boundary_boxes == mixed.boxes == 10_000 and mixed.is_fractal
    assert mixed.entropy == pytest.approx(math.log(3) - 2 / 50, abs=3 * error + 1 / 25**2)
    # A straight boundary along a diagonal: only boxes on the diagonal have two motions, and a
    # box of 4 × 4 has 6 starts below the diagonal and 10 on it or above.
    smooth = bouncing_ball.basin_entropy(_map(np.triu(np.ones((40, 40), int))), box=4)
    share = np.array([6, 10]) / 16
    expected = -np.sum(share * np.log(share))
    assert smooth.boundary_boxes == 10 and not smooth.is_fractal
    assert smooth.boundary_entropy == pytest.approx(expected, rel=1e-14)
    assert smooth.entropy == pytest.approx(expected / 10, rel=1e-14)


def test_starts_beyond_whole_boxes_are_left_out_and_mistakes_are_one_line(refusal):
    found = bouncing_ball.basins(bouncing_ball.rigid(restitution=0.5), amplitude=1.2, starts=11)
    entropy = bouncing_ball.basin_entropy(found)
    assert entropy.boxes == 4 and 0 < entropy.entropy <= entropy.boundary_entropy
    with refusal(ModelError, "box = 12 is not a whole number from 2 to 11"):
        bouncing_ball.basin_entropy(found, box=12)
    with refusal(ModelError, "basin_entropy needs the result of basins"):
        bouncing_ball.basin_entropy(found[["share"]])
