"""The table and the flight: against their formulas in many digits, and near misses."""

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball_beyond.inherited.models.flight import Flight, flight_derivative, fly, table

EPS = np.finfo(float).eps
# A gap is known to about four units in the last place of its terms, which are of order 10 here.
NOISE = 1e-14

# φ, δ, δ′ and Λ.
flights = st.tuples(st.floats(-3.2, 3.2), st.floats(0, 2), st.floats(-3, 6), st.floats(0, 4))


def rows(*numbers):
    return tuple(np.atleast_1d(np.asarray(x, dtype=float)) for x in numbers)


def over(time, phase, displacement, velocity, amplitude):
    """δ of a ball in flight: its height minus that of the table."""
    level = amplitude * (np.sin(phase + time) - np.sin(phase))
    thrown = (velocity + amplitude * np.cos(phase)) * time - time**2 / 2
    return displacement + thrown - level


@given(st.floats(-10, 10), st.floats(0, 5))
def test_the_table_has_the_velocity_and_the_height_of_a_sine(phase, amplitude):
    # Rounding of the sine of an angle of this size.
    allowed = 4 * EPS * amplitude * (1 + abs(phase))
    assert table(phase, amplitude)[0] == pytest.approx(amplitude * np.cos(phase), abs=allowed)
    assert table(phase, amplitude)[1] == pytest.approx(amplitude * np.sin(phase), abs=allowed)


@given(flights, st.floats(-9, 1).map(lambda x: 10**x))
def test_the_gap_and_its_derivatives_are_those_of_forty_digits(start, time):
    found = [float(x[0]) for x in Flight(*rows(*start)).gap(np.array([time]))]
    with mpmath.workdps(40):
        s, phase, gap, velocity, lam = map(mpmath.mpf, (time, *start))
        x = lam * mpmath.cos(phase)
        y = lam * mpmath.sin(phase)
        fall = velocity * s - s**2 / 2
        lift = y * (1 - mpmath.cos(s)) + x * (s - mpmath.sin(s))
        expected = [
            gap + fall + lift,
            velocity - s + y * mpmath.sin(s) + x * (1 - mpmath.cos(s)),
            lam * mpmath.sin(phase + s) - 1,
            lam * mpmath.cos(phase + s),
        ]
        sizes = [
            gap + abs(velocity) * s + s**2 + lam * s,
            abs(velocity) + s + lam * s,
            1 + lam,
            lam,
        ]
    # Some roundings of the largest term, also in a short flight.
    for value, exact, size in zip(found, expected, sizes, strict=True):
        assert abs(value - exact) <= 16 * EPS * size


@given(flights)
def test_the_motion_searched_is_the_gap_downwards_within_its_bounds(start):
    phase, *_, lam = start
    flight = Flight(*rows(*start))
    time = np.linspace(0, 12, 400)
    motion = flight(time)
    gap = flight.gap(time)
    for name, of_gap in zip(("value", "rate", "second", "third"), gap, strict=True):
        assert np.array_equal(getattr(motion, name), -of_gap)
    # Each bound holds for all times; the fourth derivative is the table's height.
    rounding = 1 + 1e-12
    assert np.all(motion.second <= motion.second_bound * rounding)
    assert np.all(np.abs(motion.third) <= motion.third_bound * rounding + 1e-15)
    assert np.all(lam * np.abs(np.sin(phase + time)) <= motion.fourth_bound * rounding)


@given(flights)
def test_no_ball_lands_before_the_time_at_which_the_search_begins(start):
    flight = Flight(*rows(*start))
    first = float(flight.skip(flight.earliest_landing())[0])
    sampled = np.linspace(0, 1, 4001)[1:-1] * first
    assert np.all(flight.gap(sampled)[0] >= -NOISE)
    # From the top of the table's motion on, the flight is above it until it comes down to Λ.
    assert first <= fly(*rows(*start)).time[0] + 1e-12


@given(flights)
def test_a_ball_lands_on_the_table_and_not_before(start):
    found = fly(*rows(*start))
    time = float(found.time[0])
    sampled = np.linspace(0, 1, 4001)[1:-1] * time
    # The rounding of heights of the size of the square of the velocity.
    rounding = 40 * EPS * (10 + time**2)
    assert np.all(over(sampled, *start) >= -rounding)
    assert abs(over(time, *start)) <= rounding * (1 + abs(float(found.velocity[0])))
    assert found.displacement[0] == 0 and found.velocity[0] <= 0
    phase, _, velocity, lam = start
    slowing = lam * (np.cos(phase + time) - np.cos(phase))
    expected = velocity - time - slowing
    assert float(found.velocity[0]) == pytest.approx(expected, abs=rounding)


def dips(seed=0, count=400):
    """Flights whose gap has the minimum 0 at a time s₀, and is positive before: s₀, δ″(s₀) and the
    arguments of a flight.
    """
    rng = np.random.default_rng(seed)
    lam = rng.uniform(1.5, 6.0, count)
    s0 = rng.uniform(0.2, 4.0, count)
    # Λ sin(φ + s₀) > 1: there the table falls faster than the ball.
    top = rng.uniform(np.arcsin(1 / lam) + 0.05, np.pi - np.arcsin(1 / lam) - 0.05)
    phase = top - s0
    velocity = s0 + lam * (np.cos(top) - np.cos(phase))
    height = -over(s0, phase, 0.0, velocity, lam)
    grid = np.linspace(0, 1, 4001)[:-1, None] * s0
    clear = np.all(over(grid, phase, height, velocity, lam) > 0, axis=0) & (height > 0.1)
    assert clear.sum() > 50
    return tuple(x[clear] for x in (s0, lam * np.sin(top) - 1, phase, height, velocity, lam))


@pytest.mark.parametrize("depth", [1e-12, 1e-9, 1e-6])
def test_a_flight_that_just_touches_lands_and_one_that_just_misses_flies_on(depth):
    s0, curvature, phase, height, velocity, lam = dips()
    width = np.sqrt(2 * depth / curvature)
    touched = fly(phase, height - depth, velocity, lam).time
    # Of the local parabola: the next term is the cube of the width.
    slack = 10 * lam / curvature * width**2 + 10 * NOISE / (curvature * width)
    assert np.all(np.abs(touched - (s0 - width)) < slack)
    missed = fly(phase, height + depth, velocity, lam).time
    assert np.all(missed > s0 + width)
    grid = np.linspace(0, 1, 20001)[1:-1, None] * missed
    assert np.all(over(grid, phase, height + depth, velocity, lam) > -NOISE)


@pytest.mark.parametrize("depth", [-1e-3, -1e-9, 0.0, 1e-9, 1e-3])
def test_the_lowest_minimum_of_a_flight_is_that_of_its_dip(depth):
    s0, _, phase, height, velocity, lam = dips()
    found = Flight(phase, height + depth, velocity, lam).lowest(s0 + 1e-6)
    # The gap is positive before s₀ but for another dip, which is not deeper.
    assert np.all(found <= depth + NOISE)
    grid = np.linspace(0, 1, 20001)[1:-1, None] * (s0 + 1e-6)
    sampled = over(grid, phase, height + depth, velocity, lam).min(axis=0)
    assert np.all(found <= sampled + NOISE)
    assert np.all(np.abs(found - depth) < NOISE)


def test_without_a_minimum_in_a_flight_the_lowest_is_one():
    # The dip is after the end of the flight, or the table is too slow, or the flight does not end.
    s0, _, phase, height, velocity, lam = dips()
    assert np.mean(Flight(phase, height, velocity, lam).lowest(s0 - 1e-6) == 1.0) > 0.9
    slow = Flight(*rows(0.0, 0.0, 3.0, 1.0)).lowest(np.full(1, 6.0))
    endless = Flight(*rows(0.0, 0.0, 3.0, 2.0)).lowest(np.full(1, np.inf))
    # A search over all turns would take hours.
    diverged = Flight(*rows(0.0, 0.0, 3.0, 2.0)).lowest(np.full(1, 1e12))
    assert diverged.tolist() == [1.0]
    assert slow.tolist() == endless.tolist() == [1.0]


def test_a_ball_at_rest_on_the_table_is_pressed_or_left_behind():
    phase = np.array([-0.5, 1.0])
    zero = np.zeros(2)
    pressed, thrown = fly(phase, zero, zero, np.full(2, 2.0)).time
    assert pressed == 0 and thrown > 1


@pytest.mark.parametrize("lag", [0.05, 0.4])
def test_after_a_release_by_force_a_contact_resumes_where_its_force_returns(lag):
    rng = np.random.default_rng(7)
    lam = rng.uniform(0, 3, 300)
    phase = rng.uniform(-np.pi, np.pi, 300)
    speed = rng.uniform(0.0, 0.6, 300)
    # δ + κ δ′ = 0 at the release, and it must increase.
    opens = speed + lag * (lam * np.sin(phase) - 1) > 1e-3
    lam = lam[opens]
    phase = phase[opens]
    speed = speed[opens]
    gap = -lag * speed
    found = fly(phase, gap, speed, lam, np.full(speed.size, lag))
    resumed = found.displacement < 0
    assert 20 < resumed.sum() < resumed.size - 20
    flight = Flight(phase, gap, speed, lam)
    time = np.linspace(0, 1, 4001)[1:-1, None] * found.time
    height, rate, *_ = flight.gap(time)
    # No force until then: δ + κ δ′ > 0 until δ > 0, and then δ > 0.
    below = np.logical_and.accumulate(height < 0, axis=0)
    assert np.all(np.where(below, height + lag * rate, height) > -NOISE)
    ends = flight.gap(found.time)
    assert np.all(np.abs(ends[0] + lag * ends[1])[resumed] < NOISE)
    assert np.all(np.abs(ends[0][~resumed]) < NOISE)
    assert np.array_equal(found.velocity[resumed], ends[1][resumed])
    assert np.array_equal(found.displacement[resumed], ends[0][resumed])


@pytest.mark.parametrize("lag", [0.0, 0.1])
def test_the_derivative_of_a_flight_is_its_difference_quotient(lag):
    rng = np.random.default_rng(3)
    lam = rng.uniform(0.2, 2.0, 40)
    phase = rng.uniform(-np.pi, np.pi, 40)
    speed = rng.uniform(2.0, 5.0, 40)

    def landing(of_phase, of_speed):
        found = fly(of_phase, -lag * of_speed, of_speed, lam)
        return np.array([of_phase + found.time, found.velocity]), found.time

    step = 1e-5
    (_, closing), time = landing(phase, speed)
    quotients = [
        (
            landing(phase + step * a, speed + step * b)[0]
            - landing(phase - step * a, speed - step * b)[0]
        )
        / (2 * step)
        for a, b in ((1, 0), (0, 1))
    ]
    found = flight_derivative(phase, time, closing, lam, lag)
    expected = np.array(quotients).transpose(2, 1, 0)
    # The square of the step times a third derivative, over the cube of the landing speed.
    steep = 1 + np.abs(closing) ** -5.0
    worst = np.abs(found - expected).max(axis=(-2, -1))
    assert np.all(worst < 2e-7 * steep * np.abs(expected).max(axis=(-2, -1)))


def test_flights_are_computed_one_by_one_as_in_a_row():
    _, _, *flight = dips()
    together = fly(*flight).time
    alone = [fly(*(x[k : k + 1] for x in flight)).time[0] for k in range(20)]
    assert together[:20].tolist() == alone
