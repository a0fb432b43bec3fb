"""Impacts from heights and from the times of impacts, against flights that scipy integrates."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_contacts.contact.units import STANDARD_GRAVITY
from bouncing_ball_contacts.measured.curves import curve_named
from bouncing_ball_contacts.measured.fit import fit_contact
from bouncing_ball_contacts.measured.flights import (
    drag_length,
    drop_speeds,
    flight_speeds,
    heard,
    together,
)
from bouncing_ball_contacts.measured.law_fit import MeasuredPoints, fit_law

PRECISE = {"rtol": 1e-12, "atol": 1e-14, "method": "DOP853"}
# A table-tennis ball, for which the drag is large: 2.7 g and 40 mm.
LENGTH = drag_length(2.7e-3, 0.04)


def flight(up, length):
    """Duration, speed of return and greatest height of a flight."""

    def motion(t, y):
        return y[1], -STANDARD_GRAVITY - y[1] * abs(y[1]) / length

    def top(t, y):
        return y[1]

    def floor(t, y):
        return y[0] if t > 0 else 1.0

    floor.terminal = True
    floor.direction = -1
    path = solve_ivp(motion, (0, 10), (0.0, up), events=(top, floor), **PRECISE)
    return path.t_events[1][0], -path.y_events[1][0][1], path.y_events[0][0][0]


@pytest.mark.parametrize("length", [LENGTH, 70.0, 1e6])
@pytest.mark.parametrize("up", [0.5, 2.0, 6.0])
def test_flights_with_drag_are_those_of_an_integration(up, length):
    time, down, height = flight(up, length)
    speeds = flight_speeds(time, length)
    np.testing.assert_allclose(speeds, (up, down), rtol=1e-9)
    # The same heights in a drop test: the fall from the top, and the rise to it.
    fallen = drop_speeds(height, height / 2, length)[0]
    risen = drop_speeds(2 * height, height, length)[1]
    np.testing.assert_allclose((fallen, risen), (down, up), rtol=1e-9)


def test_without_drag_the_formulas_are_their_limits():
    far = 1e9
    np.testing.assert_allclose(flight_speeds(0.7, far), flight_speeds(0.7), rtol=1e-8)
    np.testing.assert_allclose(drop_speeds(2.0, 1.0, far), drop_speeds(2.0, 1.0), rtol=1e-8)
    assert drop_speeds(2.0, 1.0)[0] == pytest.approx(math.sqrt(4 * STANDARD_GRAVITY))


def recording(restitution, first, count, length=math.inf):
    """The intervals of a ball that leaves with a speed, by a law r(v) of the impact speed."""
    up = first
    intervals = []
    for _ in range(count):
        time, down, _ = flight(up, length)
        intervals += [time]
        up = restitution(down) * down
    return np.array(intervals)


@pytest.mark.parametrize("length", [LENGTH, 1e6])
def test_a_simulated_recording_gives_the_restitution_of_each_bounce(length):
    def restitution(v):
        return 0.9 - 0.02 * v

    found = heard(recording(restitution, 4.0, 7, length), length=length)
    np.testing.assert_allclose(found.restitutions, restitution(found.speeds), atol=1e-9)
    # Without the drag removed, e would be too small by what is shown.
    np.testing.assert_allclose(found.ratios, found.restitutions + found.drag_bias, atol=1e-15)
    if length == LENGTH:
        assert np.all(found.drag_bias < -0.001)


def test_the_contact_time_is_no_part_of_a_flight():
    intervals = recording(lambda v: 0.8, 3.0, 4) + 5e-3
    found = heard(intervals, contact_time=5e-3)
    np.testing.assert_allclose(found.restitutions, 0.8, atol=1e-9)


@pytest.fixture(scope="module")
def noisy():
    """Ratios and restitution coefficients of many recordings whose times have errors of 5 ms, two
    with opposite errors each, and the exact recording.
    """
    generator = np.random.default_rng(3)
    intervals = 0.4 * 0.8 ** np.arange(4)
    times = np.concatenate([[0.0], np.cumsum(intervals)])
    sigma = 5e-3
    errors = sigma * generator.standard_normal((5_000, times.size))
    found = [
        [heard(np.diff(times + sign * each), resolution=sigma) for sign in (1, -1)]
        for each in errors
    ]
    ratios = np.array([[one.ratios for one in pair] for pair in found])
    e = np.array([[one.restitutions for one in pair] for pair in found])
    return ratios, e, heard(intervals, resolution=sigma)


def test_the_bias_of_the_resolution_is_removed(noisy):
    ratios, e, exact = noisy
    # The mean of a pair with opposite errors has no error of the first order.
    biased = ratios.mean(axis=1)
    free = e.mean(axis=1)
    error = biased.std(axis=0) / math.sqrt(len(biased))
    # What is shown as the bias differs from that of the ratio by terms of the fourth order in σ/T,
    # of which the shortest interval has (σ/T)⁴ = 4·10⁻⁷ with factors below 20.
    fourth = 1e-5
    assert np.all((biased.mean(axis=0) - 0.8) / error > 10)
    assert np.all(abs(biased.mean(axis=0) - 0.8 - exact.resolution_bias) < 4 * error + fourth)
    assert np.all(abs(free.mean(axis=0) - 0.8) < 4 * error + fourth)


def test_the_covariance_is_that_of_many_recordings(noisy):
    _, e, exact = noisy
    spread = np.cov(e[:, 0].T)
    sizes = np.sqrt(np.diag(spread)), np.sqrt(np.diag(exact.covariance))
    # A standard deviation of 5,000 numbers has an error of 1 %; the second order in σ/T is 0.1 %.
    np.testing.assert_allclose(*sizes, rtol=0.04)
    shares = [
        matrix[0, 1] / np.sqrt(matrix[0, 0] * matrix[1, 1]) for matrix in (spread, exact.covariance)
    ]
    assert shares[1] < -0.3 and shares[0] == pytest.approx(shares[1], abs=4 / math.sqrt(5_000))


def test_simulated_recordings_recover_the_law():
    """A Kuwabara-Kono ball that is heard with errors of 0.1 ms."""
    curve = curve_named("kuwabara-kono")
    theta = curve.parameter(0.85)

    def restitution(v):
        return float(curve.restitution(theta, v))

    intervals = recording(restitution, 5.0, 9, LENGTH)
    generator = np.random.default_rng(11)
    times = np.concatenate([[0.0], np.cumsum(intervals)]) + 1e-4 * generator.standard_normal(10)
    found = heard(np.diff(times), resolution=1e-4, length=LENGTH)
    fit = fit_contact(found.speeds, found.restitutions, uncertainties=found.covariance)
    assert fit.best.law == "kuwabara-kono"
    low, high = fit.best.interval
    assert low < restitution(fit.best.speed) < high
    assert fit.best.p_value > 1e-3
    assert fit.law("linear").p_value < 1e-3


def held(law, count, seed=50):
    """In how many of some experiments, each of three recordings with errors of 1 ms, the 95 %
    interval holds the exact r at the middle of the speeds.
    """
    curve = curve_named(law)
    theta = curve.parameter(0.85)

    def restitution(v):
        return float(curve.restitution(theta, v))

    sigma = 1e-3
    exact = [np.cumsum([0.0, *recording(restitution, up, 6, LENGTH)]) for up in (3.0, 4.0, 5.0)]
    generator = np.random.default_rng(seed)
    found = 0
    for _ in range(count):
        noisy = [times + sigma * generator.standard_normal(times.size) for times in exact]
        one = together([heard(np.diff(t), resolution=sigma, length=LENGTH) for t in noisy])
        fit = fit_law(curve, MeasuredPoints(one.speeds, one.restitutions, one.covariance))
        low, high = fit.interval
        found += low <= restitution(fit.speed) <= high
    return found


@pytest.mark.slow
@pytest.mark.parametrize("law", ["tsuji", pytest.param("kuwabara-kono", marks=pytest.mark.long)])
def test_intervals_hold_what_several_recordings_heard(law):
    # Exact intervals hold it fewer than 87 times of 100 with a probability of 5e-4.
    assert 87 <= held(law, 100)


@pytest.mark.parametrize(
    ("given", "part"),
    [
        (dict(intervals=[0.5]), "1 interval: two are needed"),
        (dict(intervals=[0.5, -0.4]), "interval = -0.4"),
        (dict(intervals=[0.5, 0.4], contact_time=0.45), "longer than the contact"),
        (dict(intervals=[0.4, 0.5]), "ratio of successive intervals = 1.25"),
    ],
)
def test_intervals_that_no_ball_has_get_one_line(refusal, given, part):
    with refusal(ModelError, part):
        heard(**given)


def test_heights_that_no_ball_has_get_one_line(refusal):
    with refusal(ModelError, "rebound height = 1.5", "at most the drop height"):
        drop_speeds(1.0, 1.5)
    with refusal(ModelError, "drop height = nan"):
        drop_speeds(math.nan, 1.5)
