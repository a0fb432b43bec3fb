"""The sum of both Lyapunov exponents."""

import math

import numpy as np
import pytest

import bouncing_ball_beyond


@pytest.mark.parametrize("amplitude", [1.4, 1.6])
def test_the_exponents_of_an_orbit_are_those_of_its_multipliers(amplitude):
    ball = bouncing_ball_beyond.spring_damper(restitution=0.5, frequency_ratio=40.0)
    orbit = bouncing_ball_beyond.orbit_of_motion(
        ball, amplitude=amplitude, phase=1.0, velocity=-3.0
    )
    found = bouncing_ball_beyond.lyapunov_exponent(
        ball, amplitude=amplitude, phase=1.0, velocity=-3.0
    )
    expected = np.log(np.abs(orbit.multipliers())) / orbit.periods
    # The ball is within 1e-7 of the orbit, see motions.lyapunov.NEAR.
    assert float(found.lyapunov_exponent) == pytest.approx(expected[0], abs=1e-6)
    assert float(found.second_exponent) == pytest.approx(expected[1], abs=1e-6)
    assert float(found.exponent_sum) == pytest.approx(
        math.log(orbit.trace_and_determinant()[1]) / orbit.periods, abs=1e-6
    )


def test_the_sum_of_the_exponents_of_a_chaotic_ball_counts_its_impacts():
    """In the restitution model areas shrink by r² at each impact, so that the sum is 2 ln r times
    the number of impacts per period; the number comes from a simulation of its own.
    """
    ball = bouncing_ball_beyond.rigid(restitution=0.98)
    found = bouncing_ball_beyond.lyapunov_exponent(ball, amplitude=2.0, impacts=400)
    assert found.kind.item() == "chaotic"
    words = found.in_words.item()
    assert words.startswith("chaotic in all 400 impacts for which it was followed")
    assert "more may show a long transient" in words
    motion = bouncing_ball_beyond.motion_of(ball, amplitude=2.0, impacts=400)
    start = {"phase": float(motion.end_phase), "velocity": float(motion.end_velocity)}
    followed = bouncing_ball_beyond.simulate(ball, amplitude=2.0, impacts=401, **start)
    rate = 400 / (float(followed.time[-1]) / (2 * math.pi))
    assert float(found.exponent_sum) == pytest.approx(2 * math.log(0.98) * rate, rel=1e-12)
    total = float(found.lyapunov_exponent + found.second_exponent)
    assert total == pytest.approx(float(found.exponent_sum), rel=1e-14)


@pytest.mark.parametrize("impacts", [400, 2000])
def test_a_transient_has_no_exponent(impacts):
    """Another start at r = 0.9 and Λ = 2.5 comes to rest on the table after 11,268 impacts."""
    ball = bouncing_ball_beyond.rigid(restitution=[0.6, 0.9])
    found = bouncing_ball_beyond.lyapunov_exponent(ball, amplitude=2.5, impacts=impacts)
    locked, transient = (found.sel(restitution=r) for r in (0.6, 0.9))
    assert locked.kind.item() == "locked" and locked.reason.item() == ""
    assert transient.kind.item() == "undecided" and "transient" in transient.reason.item()
    for name in ("lyapunov_exponent", "lyapunov_error", "second_exponent"):
        assert np.isnan(transient[name]) and not np.isnan(locked[name])
    motion = bouncing_ball_beyond.motion_of(ball, amplitude=2.5, impacts=impacts)
    assert motion.kind.values.tolist() == ["locked", "chaotic"]
    assert 0.3 < float(motion.lyapunov_exponent.sel(restitution=0.9)) < 0.5


def test_a_ball_that_forgets_has_two_exponents_of_minus_infinity():
    found = bouncing_ball_beyond.lyapunov_exponent(
        bouncing_ball_beyond.rigid(restitution=0.6), amplitude=3.0
    )
    assert found.kind.item() == "locked"
    assert float(found.second_exponent) == float(found.exponent_sum) == -np.inf
