"""Floquet multipliers and Jury's conditions."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball_beyond.periodic.orbits.stability import is_stable, multipliers

EPS = np.finfo(float).eps
# Rounded, to keep subnormal numbers away.
entries = st.floats(-3, 3).map(lambda x: round(x, 9))


@given(entries, entries, entries, entries)
def test_multipliers_are_the_eigenvalues(a, b, c, d):
    matrix = np.array([[a, b], [c, d]])
    trace = a + d
    det = a * d - b * c
    found = multipliers(trace, det)
    assert abs(found[0]) >= abs(found[1]) * (1 - 4 * EPS)
    expected = np.linalg.eigvals(matrix)
    # A double eigenvalue splits by the square root of a rounding of the
    # matrix's squared entries, at most 18.
    for value in found:
        assert np.min(np.abs(expected - value)) <= np.sqrt(40 * EPS * 18)
    # Vieta holds to roundings.
    assert abs(found.sum() - trace) <= 20 * EPS * (1 + abs(trace) + abs(found[0]))
    assert abs(found[0] * found[1] - det) <= 20 * EPS * (1 + abs(det) + abs(found[0]) ** 2)


@given(st.floats(-4, 4), st.floats(-2, 2))
def test_an_orbit_is_stable_if_its_multipliers_are_inside_the_unit_circle(trace, det):
    roots = np.roots([1.0, -trace, det])
    largest = np.abs(roots).max() if len(roots) else 0.0
    if abs(largest - 1) > 1e-7:  # a double root is that uncertain
        assert bool(is_stable(trace, det)) == (largest < 1)


def test_the_smaller_multiplier_keeps_its_digits():
    found = multipliers(1e8, 1.0)
    # The roots of x² - 10⁸ x + 1: the small one is 1e-8 (1 + 1e-16).
    assert found[1].real == pytest.approx(1e-8, rel=4 * EPS)
    found = multipliers(-1e8, 1.0)
    assert found[1].real == pytest.approx(-1e-8, rel=4 * EPS)


def test_multipliers_of_zero_and_on_the_unit_circle_are_exact():
    assert multipliers(0.0, 0.0).tolist() == [0, 0]
    assert multipliers(2.0, 0.0).tolist() == [2, 0]
    assert sorted(multipliers(0.0, 1.0).imag.tolist()) == [-1, 1]


def test_marginal_orbits_are_not_stable():
    for trace, det in ((0.5, 1.0), (2.0, 1.0), (1.5, 0.5), (-1.5, 0.5), (0.0, -1.0)):
        assert not bool(is_stable(trace, det))
    assert not bool(is_stable(np.nan, np.nan))
