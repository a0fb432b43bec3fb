"""Free flight over the table: the gap and its minima."""

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from bouncing_ball.motion.gap import clearance, gap, gap_rate

EPS = np.finfo(float).eps


@pytest.mark.parametrize("s", [1e-10, 1e-3, 0.5, 20.0])
def test_gap_and_rate_against_fifty_digits(s):
    tau, d, v, lam = 0.7, 0.0, 2.5, 1.8
    with mpmath.workdps(50):
        s_, tau_, v_, lam_ = map(mpmath.mpf, (s, tau, v, lam))
        swing = mpmath.sin(tau_ + s_) - mpmath.sin(tau_) - s_ * mpmath.cos(tau_)
        exact = float(v_ * s_ - s_**2 / 2 - lam_ * swing)
        rate = float(v_ - s_ - lam_ * (mpmath.cos(tau_ + s_) - mpmath.cos(tau_)))
    # Roundings of terms of size v s, s²/2 and Λ s, and of the phase.
    assert abs(float(gap(s, tau, d, v, lam)) - exact) <= 8 * EPS * s * (v + s + lam)
    assert abs(float(gap_rate(s, tau, v, lam)) - rate) <= 8 * EPS * (v + s + lam)


def test_flight_of_the_ball_itself():
    # Ball and table from their own formulas.
    s, tau, d, v, lam = np.linspace(0, 6, 50), 0.4, -0.1, 3.0, 1.3
    ball = lam * np.sin(tau) + d + (v + lam * np.cos(tau)) * s - s**2 / 2
    expected = ball - lam * np.sin(tau + s)
    assert gap(s, tau, d, v, lam) == pytest.approx(expected, abs=50 * EPS)


@given(
    st.floats(0.5, 20), st.floats(-7, 7), st.floats(-0.5, 0.5), st.floats(-1, 8), st.floats(1.01, 8)
)
def test_clearance_is_the_lowest_interior_minimum(total, tau, d, v, lam):
    s = np.linspace(0, total, 20001)
    values = gap(s, tau, d, v, lam)
    minima = np.nonzero((values[1:-1] < values[:-2]) & (values[1:-1] <= values[2:]))[0] + 1
    found = float(clearance(total, tau, d, v, lam))
    step = s[1]
    if not len(minima):
        # A minimum nearer to an end than a step is not seen on the grid.
        assert found == np.inf or min(abs(found - values[[0, -1]])) <= step**2 * lam
        return
    k = minima[np.argmin(values[minima])]
    refined = minimize_scalar(
        lambda x: float(gap(x, tau, d, v, lam)),
        bounds=(s[k - 1], s[k + 1]),
        method="bounded",
        options={"xatol": 1e-12},
    ).fun
    # A minimum at an end, seen by one of the two only, is no deeper than a step.
    assert found == pytest.approx(refined, abs=1e-11 * (1 + total**2)) or (
        min(abs(found - values[0]), abs(found - values[-1])) <= step**2 * lam
    )


def test_no_minimum_over_a_gentle_table():
    assert np.all(np.isinf(clearance(20.0, np.linspace(0, 6, 30), 0.0, 5.0, 1.0)))
    assert float(clearance(20.0, 0.3, 0.0, 5.0, 0.0)) == np.inf


def test_clearance_broadcasts_and_skips_missing_flights():
    total = np.array([[6.0], [np.nan]])
    result = clearance(total, np.array([0.5, 1.5, 2.5]), 0.0, 3.0, 3.0)
    assert result.shape == (2, 3)
    assert float(result[0, 2]) == float(clearance(6.0, 2.5, 0.0, 3.0, 3.0))
