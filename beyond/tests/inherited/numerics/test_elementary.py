"""Elementary functions against forty digits."""

import mpmath
import numpy as np
import pytest

from bouncing_ball_beyond.inherited.numerics import elementary

EPS = np.finfo(float).eps
RNG = np.random.default_rng(3)
ANGLES = np.concatenate([RNG.uniform(-3.2, 3.2, 400), 10.0 ** RNG.uniform(-9, 0, 200)])


def errors(found, exact, scale):
    """Errors in roundings of a scale."""
    with mpmath.workdps(40):
        off = [float(mpmath.mpf(float(a)) - b) for a, b in zip(found, exact, strict=True)]
    return np.abs(off) / (EPS * np.asarray(scale, dtype=float))


def exactly(function, x):
    with mpmath.workdps(40):
        return [function(mpmath.mpf(float(t))) for t in x]


def test_sine_and_versine_are_exact_to_a_few_roundings():
    sine, versine = elementary.sine_and_versine(ANGLES)
    small = np.minimum(np.abs(ANGLES), 1.0)
    # Some six roundings of half a unit each: of a small angle relative to it.
    assert errors(sine, exactly(mpmath.sin, ANGLES), small).max() < 3
    exact = exactly(lambda t: 2 * mpmath.sin(t / 2) ** 2, ANGLES)
    assert errors(versine, exact, exact).max() < 5


def test_a_million_turns_cost_no_digits():
    angle = RNG.uniform(-1e6, 1e6, 300)
    sine, versine = elementary.sine_and_versine(angle)
    assert errors(sine, exactly(mpmath.sin, angle), 1.0).max() < 4
    assert errors(1 - versine, exactly(mpmath.cos, angle), 1.0).max() < 5


def test_exponential_and_logarithm_are_exact_to_two_roundings():
    x = RNG.uniform(-700, 1, 400)
    exact = exactly(mpmath.exp, x)
    assert errors(elementary.exponential(x), exact, exact).max() < 2
    y = np.concatenate([RNG.uniform(0, 2, 400), 1 + 10.0 ** RNG.uniform(-15, -1, 100)])
    exact = exactly(mpmath.log, y)
    assert errors(elementary.logarithm(y), exact, np.abs(np.array(exact, float))).max() < 2


def test_the_angle_of_a_point_is_exact_to_three_roundings():
    y, x = RNG.normal(size=(2, 400))
    with mpmath.workdps(40):
        exact = [mpmath.atan2(mpmath.mpf(float(a)), float(b)) for a, b in zip(y, x, strict=True)]
    assert errors(elementary.arctangent(y, x), exact, np.abs(np.array(exact, float))).max() < 3


@pytest.mark.parametrize("point", [(0.0, 1.0), (0.0, -1.0), (-0.0, -1.0), (1.0, 0.0), (0.0, 0.0)])
def test_the_angles_of_the_axes_are_exact(point):
    assert elementary.arctangent(*point) == np.arctan2(*point)
