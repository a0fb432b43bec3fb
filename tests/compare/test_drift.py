"""The measures of drift, on curves and numbers whose drift is known."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from bouncing_ball.compare.drift import curve, pointwise, span

NUMBERS = st.floats(-1e3, 1e3)


@given(arrays(float, 7, elements=NUMBERS), st.floats(-1.0, 1.0), st.floats(0.1, 10.0))
def test_pointwise_is_the_shift_over_the_scale(values, shift, scale):
    drift = pointwise(values, values + shift, scale)
    # The sum is rounded: by half a unit in the last place of up to 1001.
    assert drift == pytest.approx(abs(shift) / scale, abs=2.3e-13 / 2 / scale * 1.01)


@pytest.mark.parametrize(
    ("record", "new", "drift"),
    [
        (np.nan, np.nan, 0.0),
        (np.inf, np.inf, 0.0),
        (np.inf, -np.inf, np.inf),
        (np.nan, 0.0, np.inf),
        (0.0, np.nan, np.inf),
        (np.inf, 0.0, np.inf),
        (np.nan, np.inf, np.inf),
    ],
)
def test_what_is_not_finite(record, new, drift):
    assert pointwise([record], [new], 1.0).tolist() == [drift]
    x = [0.0, 1.0, 2.0]
    assert curve(x, [0.0, record, 0.0], x, [0.0, new, 0.0]).tolist()[1] == drift


@pytest.mark.parametrize("scale", [0.0, np.nan])
def test_a_scale_that_is_no_scale(scale):
    assert pointwise([1.0, 2.0], [1.0, 2.5], [scale, scale]).tolist() == [0.0, np.inf]


def test_span():
    assert span([np.nan, np.inf]) == 1.0
    assert span([3, -1]) == 4.0
    assert span([True, False]) == 1.0
    assert span([-7.0, -7.0, np.nan]) == 7.0


@given(st.floats(0.0, 2 * np.pi), st.floats(0.01, 0.2), st.integers(4, 60))
def test_a_straight_line_moved_off_itself(direction, distance, count):
    # Any direction in the plane of both axes: the drift is the distance.
    t = np.linspace(0.0, 5.0, count)
    x, y = t * np.cos(direction), t * np.sin(direction)
    new_x, new_y = x - distance * np.sin(direction), y + distance * np.cos(direction)
    # Coordinates up to 5 are rounded to 4.4e-16, which three operations add up.
    assert curve(x, y, new_x, new_y) == pytest.approx(distance, abs=5e-15)


@given(st.floats(-0.9, 0.9))
def test_samples_that_slide_along_a_circle(slide):
    # Samples of the unit circle: off the chords by no more than their sagitta.
    angle = np.linspace(0.0, 2 * np.pi, 200)
    step = angle[1]
    slid = angle.copy()
    slid[1:-1] += slide * step
    drift = curve(np.cos(angle), np.sin(angle), np.cos(slid), np.sin(slid))
    sagitta = 1 - np.cos(step / 2)
    # The ends stay, so that the chords next to them are longer.
    assert drift[3:-3].max() <= sagitta * (1 + 1e-9)
    # A slide by a part s of a step is off by 4 s (1 - s) of the sagitta.
    share = abs(slide)
    # The sagitta is a difference of numbers next to 1 and of 1e-4.
    assert drift[100] == pytest.approx(4 * share * (1 - share) * sagitta, rel=1e-3, abs=1e-15)


def test_both_ways():
    # A spike in the record that the new curve lacks is seen as well.
    x, flat, spike = np.arange(5.0), np.zeros(5), np.array([0, 0, 3.0, 0, 0])
    assert curve(x, flat, x, spike).max() == curve(x, spike, x, flat).max() == 3.0


def test_a_point_does_not_slide_far():
    # The same curve, but not at its place: the samples in reverse order.
    x, y = np.arange(20.0), np.zeros(20)
    assert curve(x, y, x[::-1], y).max() > 10


def test_a_bundle_of_curves_is_that_of_each():
    rng = np.random.default_rng(1)
    x, y, new_x, new_y = rng.normal(size=(4, 3, 2, 9))
    together = curve(x, y, new_x, new_y)
    for index in np.ndindex(3, 2):
        alone = curve(x[index], y[index], new_x[index], new_y[index])
        assert np.array_equal(together[index], alone)


@pytest.mark.parametrize("count", [0, 1])
def test_curves_without_a_segment(count):
    assert curve(*np.ones((3, count)), np.full(count, 1.5)).tolist() == [0.5] * count
