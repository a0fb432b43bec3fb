"""Periods and Lyapunov exponents against multipliers, and against motions side by side."""

import numpy as np
import pytest

from bouncing_ball.claims.formulas import impact_cycle
from bouncing_ball.motion.angles import reduce_angle
from bouncing_ball.motion.regularity import Stretching, exact_map_jacobian, period, stretching
from bouncing_ball.motion.simulation import simulate
from bouncing_ball.orbits.restitution_model import RestitutionModel

R = 0.85


def beside(amplitude, impacts, balls=1, displacement=1e-3):
    """Balls that start beside the 1-T orbit."""
    orbit = RestitutionModel(R).orbit(1, amplitude)
    phase = orbit.phase + displacement * np.arange(1, balls + 1) / balls
    before = amplitude * np.cos(phase) + orbit.relative_impact_velocity
    return simulate(R, amplitude, phase, before, impacts)


@pytest.mark.parametrize("amplitude", [0.5, 0.8, 1.0])
def test_the_exponent_of_a_stable_orbit_is_that_of_its_multiplier(amplitude):
    modulus = np.abs(RestitutionModel(R).orbit(1, amplitude).multipliers()).max()
    exponent, _ = stretching(beside(amplitude, 601), R, 300).exponent()
    # With complex multipliers the stretching turns, bounded, over 300 impacts.
    assert exponent == pytest.approx(np.log(modulus), abs=0.01)


def test_neighbours_part_at_the_rate_of_the_exponent():
    """Two simulations side by side, the distance set back after every impact."""
    lam, tiny, skip = 2.0, 1e-7, 20
    one = beside(lam, 121, balls=20)
    parting = stretching(one, R, skip)
    logarithm = np.zeros(20)
    phase, velocity = one.phase[0], one.bounce_velocity[0]
    a, b = phase + tiny, velocity + 0
    for k in range(120):
        here = impact_cycle(one.phase[k], one.bounce_velocity[k], R, lam)
        there = impact_cycle(a, b, R, lam)
        shift = reduce_angle(there[0] - here[0]), there[1] - here[1]
        distance = np.hypot(*shift)
        if k >= skip:
            logarithm += np.log(distance / tiny)
        a, b = (x + y * tiny / distance for x, y in zip(here[:2], shift, strict=True))
    whole = (one.contact_duration[:-1] == 0).all(axis=0) & (parting.impacts == 100)
    assert whole.sum() > 10
    # Of first order in the distance, and a landing at grazing is far from linear.
    rates = parting.logarithm[whole] / 100
    assert np.median(np.abs(logarithm[whole] / 100 - rates)) < 1e-4
    assert (rates > 0.5).all()


def test_what_comes_after_sticking_is_not_counted():
    # A ball dropped from low sticks, and is thrown at Λ sin τ = 1.
    sequence = simulate(0.2, 1.2, [-np.pi / 2], -0.5, 30)
    stuck = np.flatnonzero(sequence.contact_duration > 0)[0]
    assert 0 <= stuck < 20
    assert stretching(sequence, 0.2, 0).impacts.item() == stuck
    assert np.isnan(stretching(sequence, 0.2, 29).exponent()).all()
    # On a table at rest a ball that is late stays as late, from the first impact on.
    assert abs(stretching(simulate(0.5, 0.0, 0.0, [-8.0], 3), 0.5, 0).logarithm.item()) < 1e-15


def test_the_error_of_the_mean_is_that_of_independent_balls():
    rng = np.random.default_rng(5)
    growth = rng.normal(100.0, 10.0, 4000)
    mean, error = Stretching(growth, np.full(4000, 100)).exponent()
    assert mean == pytest.approx(1.0, abs=0.01)
    assert error == pytest.approx(0.1 / np.sqrt(4000), rel=0.05)


@pytest.mark.parametrize(("amplitude", "length"), [(1.0, 1), (1.1, 2), (1.2, 4), (2.0, 0)])
def test_the_cascade(amplitude, length):
    assert period(beside(amplitude, 1200), 16, 1e-6).item() == length


def test_a_short_sequence_shows_no_long_period():
    with pytest.raises(ValueError, match="30 impacts are too few to find a period of 16"):
        period(beside(1.0, 30), 16, 1e-6)


@pytest.mark.parametrize("r", [0.1, 0.7, 1.0])
def test_the_jacobian_is_that_of_the_simulated_map(r):
    lam, phase, velocity, step = 1.3, 0.4, 3.0, 1e-5
    around = step * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])
    *after, time = impact_cycle(phase + around[:, 0], velocity + around[:, 1], r, lam)
    after = np.array(after)
    columns = [(after[:, k] - after[:, k + 1]) / (2 * step) for k in (1, 3)]
    expected = exact_map_jacobian(time[0], phase, velocity, lam, r)
    # Central differences: step² times third derivatives of order 10.
    np.testing.assert_allclose(np.transpose(columns), expected, rtol=0, atol=1e-8)
