"""Balls whose r scatters: moments in closed form, the balance of energy, and a second code."""

import numpy as np
import pytest
from scipy.optimize import brentq

import bouncing_ball
from bouncing_ball import rigid
from bouncing_ball.errors import ModelError

# A mean is farther than this many standard errors from its expectation once in 10⁶ times.
_ERRORS = 5.0


def test_without_noise_all_balls_are_the_simulated_one():
    ball = rigid(restitution=0.7)
    found = bouncing_ball.ensemble(ball, amplitude=1.4, noise=0.0, balls=3, impacts=30)
    known = ball.simulate(1.4, 0.0, -np.pi, 30)
    # The mean of three equal numbers is rounded.
    assert np.abs(found.time_mean - known.time).max() < 1e-13 * known.time.max()
    assert np.abs(found.speed_mean + known.relative_velocity).max() < 1e-14
    assert np.array_equal(found.speed_quantile[:, 0], found.speed_quantile[:, 2])


def test_small_noise_moves_the_means_of_a_stable_orbit_by_its_square():
    ball = rigid(restitution=0.5)
    one = bouncing_ball.orbit(ball, amplitude=1.2)
    start = {"amplitude": 1.2, "phase": one.phase, "velocity": one.impact_velocity}
    spread = []
    for noise in (0.02, 0.01):
        found = bouncing_ball.ensemble(ball, noise=noise, balls=4000, impacts=40, **start)
        last = found.isel(impact=-1)
        spread.append(float(last.speed_square - last.speed_mean**2) ** 0.5)
        error = _ERRORS * float(last.speed_error)
        assert abs(float(last.speed_mean) + one.relative_impact_velocity) < error + 20 * noise**2
    # The scatter itself is linear; that of 4000 balls is known to a few percent.
    assert abs(spread[0] / spread[1] - 2) < 0.15


@pytest.mark.parametrize("noise", [0.05, 0.2])
def test_moments_on_a_table_at_rest(noise):
    r, speed, many = 0.7, 3.0, 20_000
    found = bouncing_ball.ensemble(
        rigid(restitution=r), amplitude=0.0, noise=noise, balls=many, impacts=5, velocity=-speed
    )
    for k in range(5):
        here = found.isel(impact=k)
        assert abs(float(here.speed_mean) - speed * r**k) <= _ERRORS * float(here.speed_error)
        second = (r * r + noise**2) ** k
        assert abs(float(here.speed_square) / speed**2 / second - 1) < 0.1 * (k > 0) + 1e-14
        # The ball loses v²(1 - r²)/2, and no work is done on it.
        assert here.work_mean == 0
        lost = (1 - r * r - noise**2) * float(here.speed_square) / 2
        assert abs(float(here.loss_mean) - lost) < _ERRORS * float(here.loss_error)
        # A flight with the speed u lasts for 2u.
        time = 2 * speed * sum(r**j for j in range(1, k + 1))
        assert abs(float(here.time_mean) - time) <= 0.02 * time


def test_the_work_of_the_table_is_what_the_impacts_lose():
    found = bouncing_ball.ensemble(
        rigid(restitution=0.8), amplitude=3.0, noise=0.1, balls=2000, impacts=120
    )
    late = found.isel(impact=slice(60, None))
    error = np.sqrt(float((late.work_error**2 + late.loss_error**2).mean() / 60))
    assert abs(float(late.work_mean.mean() - late.loss_mean.mean())) < _ERRORS * error
    # r is independent of the speed.
    lost = (1 - 0.8**2 - 0.1**2) / 2 * float(late.speed_square.mean())
    assert abs(float(late.loss_mean.mean()) - lost) < _ERRORS * error


def _second_code(amplitude, mean, noise, balls, impacts, rng):
    """The speeds of the impacts of balls, by the room's coordinates and scipy's root finder."""
    weight = mean * (1 - mean) / noise**2 - 1
    found = np.zeros((balls, impacts))
    for ball in found:
        time, velocity = 0.0, -np.pi
        for k in range(impacts):
            rate = amplitude * np.cos(time)
            ball[k] = rate - velocity
            r = rng.beta(weight * mean, weight * (1 - mean))
            up = rate + r * ball[k]
            level = amplitude * np.sin(time)
            begun = time

            def height(s, begun=begun, level=level, up=up):
                return level + up * s - s * s / 2 - amplitude * np.sin(begun + s)

            step = 1e-3 * r * ball[k]
            last = step
            while height(last) > 0:
                last += 0.01
            flown = brentq(height, max(last - 0.01, step / 2), last, xtol=1e-13)
            time += flown
            velocity = up - flown
    return found


def test_means_are_those_of_a_second_code():
    numbers = {"amplitude": 2.0, "noise": 0.1, "impacts": 4}
    found = bouncing_ball.ensemble(rigid(restitution=0.6), balls=20_000, seed=7, **numbers)
    other = _second_code(2.0, 0.6, 0.1, 300, 4, np.random.default_rng(11))
    error = np.hypot(other.std(axis=0, ddof=1) / np.sqrt(300), found.speed_error)
    apart = np.abs(other.mean(axis=0) - found.speed_mean)
    assert np.all(apart <= _ERRORS * error + 1e-12)
    assert error[-1] > 0


def test_seeds():
    def speeds(seed, balls=50):
        return bouncing_ball.ensemble(
            rigid(restitution=0.6), amplitude=2.0, noise=0.1, balls=balls, impacts=20, seed=seed
        )

    assert speeds(3).identical(speeds(3))
    assert not np.array_equal(speeds(3).speed_mean, speeds(4).speed_mean)


def test_balls_that_stay_on_the_table_have_no_further_impacts():
    found = bouncing_ball.ensemble(
        rigid(restitution=0.3), amplitude=0.5, noise=0.1, balls=50, impacts=200
    )
    assert found.balls_bouncing[0] == 50 and found.balls_bouncing[-1] < 50
    assert found.sizes["impact"] < 200


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"noise": 0.4}, "noise = 0.4 is too large"),
        ({"noise": -0.1}, "noise"),
        ({"seed": -1}, "seed"),
    ],
)
def test_refusals(given, words):
    numbers = {"amplitude": 1.0, "noise": 0.1} | given
    with pytest.raises(ModelError, match=words):
        bouncing_ball.ensemble(rigid(restitution=0.9), **numbers)


def test_only_rigid_balls():
    ball = bouncing_ball.spring_damper(restitution=0.9, frequency_ratio=5.0)
    with pytest.raises(ModelError, match="rigid balls"):
        bouncing_ball.ensemble(ball, amplitude=1.0, noise=0.1)
