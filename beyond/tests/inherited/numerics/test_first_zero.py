"""First zeros of functions whose zeros are known, and which touch zero or nearly do."""

import numpy as np
import pytest

from bouncing_ball_beyond.inherited.numerics.first_zero import Derivatives, Motion, first_zero

EPS = np.finfo(float).eps


class Waves(Motion):
    """y = cos(s - s₀) - 1 + h, with two zeros around each top, or none for h < 0."""

    def __init__(self, top, height, patience=np.inf):
        self.top = top
        self.height = height
        self.patience = patience

    def __call__(self, time):
        sine = np.sin(time - self.top)
        cosine = np.cos(time - self.top)
        return Derivatives(
            value=(cosine - 1) + self.height,
            rate=-sine,
            second=-cosine,
            third=sine,
            second_bound=1.0,
            third_bound=1.0,
            fourth_bound=1.0,
            ended=time > self.patience,
        )


TOPS = np.linspace(0.5, 6.0, 50)


@pytest.mark.parametrize("height", [1e-12, 1e-6, 1e-2, 0.1])
def test_the_first_of_two_close_zeros_is_found(height):
    heights = np.full_like(TOPS, height)
    found = first_zero(Waves(TOPS, heights), np.zeros_like(TOPS))
    half_distance = np.arccos(1 - height)
    # The rounding of y over its slope at the zero; the differences of times lose a rounding of s.
    allowed = 8 * EPS / np.sin(half_distance) + 8 * EPS * TOPS
    assert np.all(np.abs(found.time - (TOPS - half_distance)) <= allowed)
    assert np.all(found.rate > 0)
    assert not np.any(found.ended | found.undecided)


@pytest.mark.parametrize("height", [1e-12, 1e-6])
def test_a_top_just_below_zero_is_passed(height):
    # The second top is higher by 0.1 than the first.
    class Rising(Waves):
        def __call__(self, time):
            state = super().__call__(time)
            slope = 0.1 / (2 * np.pi)
            value = state.value + slope * (time - self.top)
            return state._replace(value=value, rate=state.rate + slope)

    slope = 0.1 / (2 * np.pi)
    # The first top is at sin(s - s₀) = slope, where y is this much higher than h.
    excess = np.sqrt(1 - slope**2) - 1 + slope * np.arcsin(slope)
    heights = np.full_like(TOPS, -height - excess)
    found = first_zero(Rising(TOPS, heights), np.zeros_like(TOPS))
    assert np.all(found.time > TOPS + np.pi)
    assert np.all(found.time < TOPS + 2 * np.pi)


def test_a_search_without_a_zero_ends_when_the_function_allows_it():
    heights = np.full_like(TOPS, -0.1)
    found = first_zero(Waves(TOPS, heights, patience=20.0), np.zeros_like(TOPS))
    assert np.all(found.ended) and np.all(found.time > 20)
    found = first_zero(Waves(TOPS, heights), np.zeros_like(TOPS))
    assert np.all(found.undecided) and not np.any(found.ended)


def test_a_zero_at_the_start_counts_if_the_function_rises():
    start = np.array([5.0 - np.arccos(0.9), 5.0 + np.arccos(0.9)])
    found = first_zero(Waves(np.full(2, 5.0), np.full(2, 0.1)), start)
    assert found.time[0] == pytest.approx(start[0], rel=4 * EPS)
    # From the second zero the function falls, and the next zero is before the next top.
    assert found.time[1] == pytest.approx(start[0] + 2 * np.pi, rel=8 * EPS)


class Cubic(Motion):
    """y = h + a s + b s²/2 + c s³/6 from s = 0 on, which is not followed and has no later zero."""

    def __init__(self, height, rate, second, third):
        self.height = height
        self.rate = rate
        self.second = second
        self.third = third

    def __call__(self, time):
        return Derivatives(
            value=self.height
            + time * (self.rate + time * (self.second + time * self.third / 3) / 2),
            rate=self.rate + time * (self.second + time * self.third / 2),
            second=self.second + time * self.third,
            third=self.third,
            second_bound=10.0,
            third_bound=1.0,
            fourth_bound=0.0,
            ended=np.ones(time.shape, dtype=bool),
        )

    def skip(self, time, steps):
        return np.maximum(time, 5.0)


@pytest.mark.parametrize("height", [0.0, EPS])
def test_a_function_at_zero_counts_by_the_first_derivative_that_does_not_vanish(height):
    # Rising by the rate, though it bends down; by the second and by the third derivative; falling.
    rate = np.array([0.5, 0.5, 0.0, 0.0, 0.0, -0.5])
    second = np.array([0.5, -0.5, 0.5, 0.0, -0.5, 0.5])
    third = np.array([0.0, 0.0, 0.0, 1.0, 1.0, 0.0])
    rises = [True, True, True, True, False, False]
    found = first_zero(Cubic(np.full(6, height), rate, second, third), np.zeros(6))
    assert (~found.ended).tolist() == rises
    assert np.all(found.time[rises] == 0)
