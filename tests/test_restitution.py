"""The restitution model against flights that are found independently, and derivatives of these."""

import math

import numpy as np
import pytest
from tests import independent

from bouncing_ball import continuation, errors, restitution

# The tolerance of what takes some hundred roundings: a few hundred units of 1e-16.
ROUNDING = 1e-12


def bounce(r, amplitude, time, velocity, duration):
    """Eq. 5 after a flight whose duration is known for nearby, also complex, arguments."""
    for _ in range(3):
        table = amplitude * np.sin(time) - amplitude * np.sin(time + duration)
        gap = table + velocity * duration - duration**2 / 2
        rate = velocity - duration - amplitude * np.cos(time + duration)
        duration = duration - gap / rate
    table_velocity = amplitude * np.cos(time + duration)
    after = table_velocity - r * (velocity - duration - table_velocity)
    return np.array([time + duration, after])


@pytest.mark.parametrize("seed", range(6))
def test_the_map_and_its_derivative_are_those_of_an_independent_flight(seed):
    rng = np.random.default_rng(seed)
    r = rng.uniform(0.05, 1)
    amplitude = rng.uniform(0.1, 6)
    time = rng.uniform(0, 40)
    velocity = amplitude * np.cos(time) + rng.uniform(0.2, 8)
    height = amplitude * np.sin(time)
    duration = independent.first_landing(amplitude, time, height, velocity)
    expected = bounce(r, amplitude, time, velocity, duration)
    # With an imaginary step this small there is neither a truncation nor a cancellation.
    step = 1e-40j
    by_time = bounce(r, amplitude, time + step, velocity, duration).imag / step.imag
    by_velocity = bounce(r, amplitude, time, velocity + step, duration).imag / step.imag
    following, after, derivative = restitution.impact_map(r, amplitude, time, velocity)
    # A flat landing magnifies rounding errors by the inverse of its relative velocity.
    landing = abs(velocity - duration - amplitude * np.cos(time + duration))
    np.testing.assert_allclose([following, after], expected, rtol=ROUNDING / min(1, landing))
    np.testing.assert_allclose(
        derivative, np.stack([by_time, by_velocity], axis=1), rtol=ROUNDING / min(1, landing**2)
    )


def test_a_dip_below_the_table_between_two_steps_of_the_search_ends_a_flight():
    # The 3-T orbit of r = 0.9 touches the table at the grazing height; just below it, its flight
    # ends there, after a dip that is shorter than a step.
    impact_height = restitution.grazing_height(3, 0.9)
    x = restitution.saddle_node(3, 0.9)
    for change, whole in ((1e-5, True), (-1e-5, False)):
        amplitude = np.hypot(x, impact_height + change)
        phase = np.arctan2(impact_height + change, x)
        flight = restitution.flight_time(amplitude, phase, 3 * np.pi)
        assert (abs(flight - 6 * np.pi) < 1e-9) == whole


@pytest.mark.parametrize(("n", "r"), [(1, 0.85), (2, 0.85), (2, 0.05), (4, 0.3), (5, 0.99)])
def test_the_flight_at_the_grazing_height_touches_the_table_without_crossing_it(n, r):
    impact_height = restitution.grazing_height(n, r)
    s = np.linspace(0, 2 * np.pi * n, 400_001)[100:-100]
    table = n * np.pi * (1 - r) / (1 + r) * np.sin(s) + impact_height * np.cos(s)
    height = impact_height + n * np.pi * s - s**2 / 2 - table
    # Between samples the lowest point is missed by the square of their distance, some 1e-9.
    assert -1e-11 * n < height.min() < 1e-8


def test_next_to_the_saddle_node_a_flight_passes_through_the_table_for_small_r_only():
    assert restitution.grazing_height(1, 0.02) > 0 > restitution.grazing_height(1, 0.021)


@pytest.mark.parametrize(("n", "r"), [(1, 0.85), (2, 0.65), (3, 0.95)])
def test_fixed_points_and_their_multipliers(n, r):
    x = restitution.saddle_node(n, r)
    impact_heights = {
        "stable": 0.5 * restitution.period_doubling_height(r),
        "period doubling": restitution.period_doubling_height(r),
        "saddle-node": 0.0,
        "unstable": max(-0.02, restitution.grazing_height(n, r) / 2),
    }
    multipliers = {}
    for name, impact_height in impact_heights.items():
        amplitude = np.hypot(x, impact_height)
        phase = np.arctan2(impact_height, x)
        following, after, derivative = restitution.impact_map(r, amplitude, phase, n * np.pi)
        assert following == pytest.approx(phase + 2 * np.pi * n, rel=ROUNDING)
        assert after == pytest.approx(n * np.pi, rel=ROUNDING)
        assert restitution.impact_phase(n, r, amplitude) == pytest.approx(abs(phase), abs=1e-7)
        # Products of terms of up to 1e2 cancel in the determinant.
        assert restitution.trace(r, impact_height) == pytest.approx(np.trace(derivative), abs=1e-10)
        assert np.linalg.det(derivative) == pytest.approx(r**2, abs=1e-10)
        multipliers[name] = np.linalg.eigvals(derivative)
        inside = np.abs(multipliers[name]).max() < 1 - 1e-6
        assert restitution.stable(r, impact_height) == inside == (name == "stable")
    assert np.abs(multipliers["period doubling"] + 1).min() < 1e-9
    # At the saddle-node the phase is 0, of which multipliers depend on the square root of errors.
    assert np.abs(multipliers["saddle-node"] - 1).min() < 1e-6
    assert restitution.saddle_node(n, r) == pytest.approx(x)
    assert restitution.period_doubling(n, r) == np.hypot(x, impact_heights["period doubling"])
    assert np.isnan(restitution.impact_phase(n, r, 0.999 * x))


def test_stability_is_that_of_the_eigenvalues():
    rng = np.random.default_rng(1)
    matrices = rng.uniform(-1.5, 1.5, (500, 2, 2))
    trace = np.trace(matrices, axis1=1, axis2=2)
    inside = np.abs(np.linalg.eigvals(matrices)).max(axis=1) < 1
    assert 100 < inside.sum() < 400
    np.testing.assert_array_equal(restitution.is_stable(trace, np.linalg.det(matrices)), inside)


def test_an_orbit_within_rounding_errors_of_a_bifurcation_is_not_stable():
    for trace, determinant in ((1.25, 0.25), (-1.25, 0.25), (2.0, 1.0)):
        assert not restitution.is_stable(trace, determinant - 1e-10)
        assert restitution.is_stable(trace * (1 - 1e-7), determinant)
    assert not restitution.is_stable(0.3, 1 + 1e-8)


def test_height_and_velocity_over_a_cycle():
    n, r, amplitude = 2, 0.65, 1.5
    phase = restitution.impact_phase(n, r, amplitude)
    impact_height = amplitude * np.sin(phase)
    s = np.linspace(0, 4 * np.pi, 2001)[:-1]
    height = restitution.height(n, impact_height, s)
    np.testing.assert_allclose(height, impact_height + 2 * np.pi * s - s**2 / 2)
    np.testing.assert_allclose(restitution.velocity(n, s), 2 * np.pi - s)
    for function in (
        lambda t: restitution.height(n, impact_height, t),
        lambda t: restitution.velocity(n, t),
    ):
        np.testing.assert_allclose(function(s[1:] + 4 * np.pi), function(s[1:]), atol=1e-12)
    assert restitution.max_height(n, r, amplitude) == pytest.approx(height.max(), rel=ROUNDING)


def test_a_simulation_is_that_of_an_independent_search_for_impacts():
    r, amplitude, impacts = 0.8, 2.0, 10
    path = restitution.iterate(r, amplitude, 0.7, 6.0, impacts)
    time, velocity = 0.7, 6.0
    deviation = np.array([1.0, 0.0])
    growth = []
    for k in range(impacts):
        # Rounding errors grow as deviations do.
        tolerance = 1e-12 * max(1.0, np.exp(np.sum(growth)))
        assert path.time[k] == pytest.approx(time, rel=tolerance)
        assert path.velocity[k] == pytest.approx(velocity, abs=10 * tolerance)
        if k == impacts - 1:
            break
        height = amplitude * np.sin(time)
        flight = independent.first_landing(amplitude, time, height, velocity)
        step = 1e-40j
        by_time = bounce(r, amplitude, time + step, velocity, flight).imag / step.imag
        by_velocity = bounce(r, amplitude, time, velocity + step, flight).imag / step.imag
        deviation = by_time * deviation[0] + by_velocity * deviation[1]
        growth.append(np.log(np.hypot(*deviation)))
        deviation = deviation / np.hypot(*deviation)
        time, velocity = bounce(r, amplitude, time, velocity, flight)
    np.testing.assert_allclose(path.growth, growth, atol=1e-7)
    assert path.stickings == 0


def test_the_lyapunov_exponent_of_a_periodic_ball_is_that_of_its_largest_multiplier():
    n, r = 2, 0.65
    x = restitution.saddle_node(n, r)
    impact_height = 0.02
    trace = 1 + r**2 - (1 + r) ** 2 * impact_height
    largest = trace / 2 + np.sqrt(trace**2 / 4 - r**2)
    path = restitution.iterate(
        r, np.hypot(x, impact_height), np.arctan2(impact_height, x), n * np.pi, 400
    )
    exponent, error = restitution.lyapunov_exponent(path)
    # The other multiplier is smaller by a factor of two and is gone after a quarter of the impacts.
    assert exponent == pytest.approx(np.log(largest) / n, abs=1e-11)
    assert error < 1e-11
    assert restitution.repetition(path) == (1, 2)


def test_the_error_of_the_lyapunov_exponent_is_that_of_a_ratio_of_means():
    rng = np.random.default_rng(5)
    growth = rng.normal(0.3, 1.0, 640)
    time = np.cumsum(rng.uniform(3, 9, 641))
    # What is left out does not matter.
    growth[:160] = np.nan
    path = restitution.Impacts(time, time, growth, 0)
    grown = growth[160:].reshape(15, 32).sum(axis=1)
    passed = (time[192::32] - time[160:-32:32]) / (2 * np.pi)
    expected = grown.mean() / passed.mean()
    scatter = np.std(grown - expected * passed, ddof=1)
    exponent, error = restitution.lyapunov_exponent(path, block=32)
    assert exponent == pytest.approx(expected, rel=ROUNDING)
    assert error == pytest.approx(scatter / np.sqrt(15) / passed.mean(), rel=ROUNDING)


def test_motions_repeat_after_a_period_doubling_and_not_in_chaos():
    r = 0.65
    doubled = 1.01 * restitution.period_doubling(1, r)
    assert restitution.repetition(restitution.iterate(r, doubled, 0.8, np.pi, 2000)) == (2, 2)
    chaos = restitution.iterate(0.8, 3.5, 0.7, 6.0, 800)
    assert restitution.repetition(chaos) == (0, 0)
    assert restitution.lyapunov_exponent(chaos)[0] > 0.1


def test_repetition_needs_phases_and_velocities_of_the_last_quarter_of_the_impacts():
    # 49 impacts that take 51 periods: the most that fit twice into the last 100 of 400.
    turns = np.cumsum(np.full(400, 51 / 49))
    time = 2 * np.pi * turns + np.sin(2 * np.pi * np.arange(400) / 49)
    velocity = np.cos(2 * np.pi * np.arange(400) / 49)
    growth = np.zeros(399)
    settled = restitution.Impacts(time, velocity, growth, 0)
    assert restitution.repetition(settled) == (49, 51)
    # What happened before does not matter.
    late = np.where(np.arange(400) < 300, velocity + 1, velocity)
    assert restitution.repetition(restitution.Impacts(time, late, growth, 0)) == (49, 51)
    for k in (300, 399):
        moved = np.where(np.arange(400) == k, 1e-6, 0)
        for other in (
            restitution.Impacts(time + moved, velocity, growth, 0),
            restitution.Impacts(time, velocity + moved, growth, 0),
        ):
            assert restitution.repetition(other) == (0, 0)


# After the smaller amplitude the ball lands within half a radian.
@pytest.mark.parametrize("amplitude", [1.01, 1.1])
def test_a_ball_that_sticks_leaves_the_table_where_it_falls_faster(amplitude):
    r = 0.2
    path = restitution.iterate(r, amplitude, 0.7, 2.0, 400)
    assert path.stickings > 2
    assert np.isnan(path.growth).sum() == path.stickings
    leaving = np.arcsin(1 / amplitude)
    speed = amplitude * np.cos(leaving)
    flight = independent.first_landing(amplitude, leaving, 1.0, speed)
    after = bounce(r, amplitude, leaving, speed, flight)
    for k in np.flatnonzero(np.isnan(path.growth)):
        # It sticks when its relative velocity is below 1e-9, and then leaves within a period.
        assert path.velocity[k] - amplitude * np.cos(path.time[k]) <= restitution.STICKING
        assert 0 < path.time[k + 1] - flight - path.time[k] < 2 * np.pi
        # A landing from the table is at the third power of time from its departure.
        assert math.remainder(path.time[k + 1] - after[0], 2 * np.pi) == pytest.approx(0, abs=1e-9)
        assert path.velocity[k + 1] == pytest.approx(after[1], abs=1e-9)


def test_the_departure_from_the_table_is_the_next_time_at_which_its_force_would_pull():
    amplitude = 1.3
    for time in np.linspace(-7, 20, 61):
        leaves = restitution.departure(amplitude, time)
        assert time <= leaves < time + 2 * np.pi
        assert amplitude * np.sin(leaves) >= 1 - ROUNDING
        before = np.linspace(time, leaves, 500)[:-1]
        assert leaves == time or np.all(amplitude * np.sin(before) < 1)


def test_a_ball_comes_to_rest_on_a_table_with_a_small_amplitude():
    with pytest.raises(ValueError, match=r"Λ = 0.9 comes to rest: Λ must exceed 1 \(Eq. 9\)"):
        restitution.iterate(0.3, 0.9, 0.7, 1.0, 500)


@pytest.mark.parametrize("before_the_end", [1e-4, 1e-3, 1e-2])
def test_a_short_flight_from_a_table_that_begins_to_hold_the_ball_again(before_the_end):
    """Without relative velocity the height is (Λ sin τ - 1)s²/2 + Λ cos τ s³/6 + O(s⁴)."""
    amplitude = 1.2
    time = np.pi - np.arcsin(1 / amplitude) - before_the_end
    flight = restitution.flight_time(amplitude, time, amplitude * np.cos(time))
    expected = 3 * (amplitude * np.sin(time) - 1) / (-amplitude * np.cos(time))
    # The next order is the square of this time.
    assert flight == pytest.approx(expected, abs=expected**2)


@pytest.mark.parametrize(
    ("amplitude", "time", "velocity", "words"),
    [
        (1.0, 0.0, 0.5, "velocity is 0.5: give at least Λ cos τ = 1"),
        (0.5, 0.0, 0.5, "the ball rests"),
        (1.0, 0.0, np.nan, "velocity is nan: give finite velocity"),
        (np.nan, 0.0, 1.0, "Λ is nan"),
    ],
)
def test_a_flight_that_does_not_exist_is_refused(amplitude, time, velocity, words):
    for function, given in ((restitution.flight_time, ()), (restitution.impact_map, (0.85,))):
        with pytest.raises(ValueError, match=words):
            function(*given, amplitude, time, velocity)


def test_arguments_of_another_kind_are_named():
    with pytest.raises(ValueError, match="impacts is 0"):
        restitution.iterate(0.5, 1.2, 1.0, 3.0, 0)
    for ratios in ([], ["10"], [[10.0, 20.0]]):
        with pytest.raises(ValueError, match="ϖ is "):
            errors.errors(["max_height"], 1, 0.65, 1.0, ratios)
    with pytest.raises(ValueError, match=r"r is '0\.65'"):
        errors.errors(["max_height"], 1, "0.65", 1.0, [10.0])


def test_stable_orbits_are_stable():
    amplitudes = continuation.stable_orbits(1, 0.65, [1.0, 1.5], [100.0])[0, :, 0]
    np.testing.assert_array_equal(amplitudes, [1.0, np.nan])
    assert continuation.upper_orbits(1, 0.65, 1.5, 100.0)[0] == 1.5
