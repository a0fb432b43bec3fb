"""Elementary functions against forty digits."""

import mpmath
import numpy as np

from bouncing_ball_beyond.models import elementary

EPS = np.finfo(float).eps
RNG = np.random.default_rng(3)


def errors(found, exact, scale):
    """Errors in roundings of a scale."""
    with mpmath.workdps(40):
        off = [float(mpmath.mpf(float(a)) - b) for a, b in zip(found, exact, strict=True)]
    return np.abs(off) / (EPS * np.asarray(scale, dtype=float))


def exactly(function, x):
    with mpmath.workdps(40):
        return [function(mpmath.mpf(float(t))) for t in x]


def test_a_million_turns_cost_no_digits():
    angle = RNG.uniform(-1e6, 1e6, 300)
    sine, cosine = elementary.sine_and_cosine(angle)
    assert errors(sine, exactly(mpmath.sin, angle), 1.0).max() < 4
    assert errors(cosine, exactly(mpmath.cos, angle), 1.0).max() < 5


def test_exponential_and_logarithm_are_exact_to_two_roundings():
    x = RNG.uniform(-700, 1, 400)
    exact = exactly(mpmath.exp, x)
    assert errors(elementary.exponential(x), exact, exact).max() < 2
    y = np.concatenate([RNG.uniform(0, 2, 400), 1 + 10.0 ** RNG.uniform(-15, -1, 100)])
    exact = exactly(mpmath.log, y)
    assert errors(elementary.logarithm(y), exact, np.abs(np.array(exact, float))).max() < 2
