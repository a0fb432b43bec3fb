"""Roots in brackets: those of scipy, bit by bit, and none where there is none."""

import numpy as np
import pytest
from scipy.optimize.elementwise import find_root

from bouncing_ball.continuation.bracketed_root import bracketed_root

RNG = np.random.default_rng(1997)
M = 200


def cubic(x, a, b):
    return (x - a) * (1 + b * (x - a) ** 2)


def flat(x, a, b):
    return np.tanh(b * (x - a) ** 3)


def pole(x, a, b):
    return b / (x - a)


def jump(x, a, b):
    return np.where(x < a, -b, np.inf)


def wave(x, a, b):
    return np.exp(-x * x) - 0.5 + 0.1 * np.sin(40 * b * (x - a))


@pytest.mark.parametrize("function", [cubic, flat, pole, jump, wave])
def test_the_same_as_scipy(function):
    a, b = RNG.uniform(-1, 1, M), 10 ** RNG.uniform(-3, 3, M)
    left, right = a - 10 ** RNG.uniform(-12, 3, M), a + 10 ** RNG.uniform(-12, 3, M)
    # Some with the root at an end, some without any, some the wrong way round.
    left[:5], right[5:10] = a[:5], a[5:10]
    left[10:20] = right[10:20] + 1
    left[20:40], right[20:40] = right[20:40], left[20:40].copy()
    with np.errstate(all="ignore"):
        expected = find_root(function, (left, right), args=(a, b)).x
        found = bracketed_root(function, left, right, (a, b))
    np.testing.assert_array_equal(found, expected)
    assert np.isfinite(found).sum() > M / 4


def test_functions_that_are_done_are_not_asked_again():
    sizes = []

    def function(x, a):
        sizes.append(x.size)
        return x**3 - a

    bracketed_root(function, np.zeros(3), np.array([1.0, 1e9, 1e9]), np.array([[1.0, 2.0, -1.0]]))
    assert sizes[0] == 3 and sizes[2] == 1 and len(sizes) < 60


def test_none():
    assert bracketed_root(np.sin, np.empty(0), np.empty(0)).shape == (0,)
