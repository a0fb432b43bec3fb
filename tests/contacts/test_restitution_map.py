"""The impact map (Eq. 5) and Holmes' approximation."""

import mpmath
import numpy as np
import pytest
from scipy.optimize import brentq

from bouncing_ball.contacts.restitution_map import bounce, exact_map_jacobian, landing_gap

EPS = np.finfo(float).eps
STATES = [(0.3, 3.0, 0.9, 0.85), (1.2, 4.1, 1.4, 0.5), (-0.4, 2.2, 0.3, 1.0), (2.0, 6.0, 2.6, 0.1)]


def first_landing(tau, v, lam):
    """First positive zero of the gap, from a fine scan."""
    s = np.linspace(0.05, 2 * v + 5, 4000)
    gap = landing_gap(s, tau, v, lam)
    k = int(np.argmax(gap < 0))
    assert k > 0
    return brentq(lambda x: float(landing_gap(x, tau, v, lam)), s[k - 1], s[k], xtol=1e-15)


def exact_map(tau, v, lam, r):
    s = first_landing(tau, v, lam)
    return np.array([tau + s, float(bounce(s, tau, v, lam, r))])


@pytest.mark.parametrize("s", [1e-12, 1e-6, 0.3, 5.0])
def test_landing_gap_keeps_its_digits_for_short_flights(s):
    tau, v, lam = 0.4, 3.0, 0.9
    with mpmath.workdps(50):
        s_, tau_, v_, lam_ = map(mpmath.mpf, (s, tau, v, lam))
        exact = s_ * v_ - s_**2 / 2 - lam_ * (mpmath.sin(tau_ + s_) - mpmath.sin(tau_))
    # Roundings of terms of size s v and Λ s.
    assert abs(float(landing_gap(s, tau, v, lam)) - float(exact)) <= 8 * EPS * s * (v + lam + s)


def test_bounce_reverses_the_relative_velocity_times_r():
    s, tau, v, lam, r = 4.0, 0.2, 3.0, 1.1, 0.7
    table = lam * np.cos(tau + s)
    before, after = v - s - table, float(bounce(s, tau, v, lam, r)) - table
    assert after == pytest.approx(-r * before, rel=10 * EPS)


@pytest.mark.parametrize("state", STATES)
def test_exact_jacobian_against_differences_of_the_solved_map(state):
    tau, v, lam, r = state
    h = 1e-3
    columns = []
    for step in ((h, 0), (0, h)):
        values = [exact_map(tau + k * step[0], v + k * step[1], lam, r) for k in (-2, -1, 1, 2)]
        columns.append(np.array([1, -8, 8, -1]) / 12 @ np.array(values) / h)
    computed = exact_map_jacobian(first_landing(tau, v, lam), tau, v, lam, r)
    # h⁴ times a fifth derivative of order 1 to 100, and 1e-15/h from brentq.
    assert computed == pytest.approx(np.array(columns).T, abs=2e-10)


@pytest.mark.parametrize("state", STATES)
def test_determinant_of_the_exact_map(state):
    tau, v, lam, r = state
    s = first_landing(tau, v, lam)
    launch, closing = v - lam * np.cos(tau), v - s - lam * np.cos(tau + s)
    det = np.linalg.det(exact_map_jacobian(s, tau, v, lam, r))
    # Volume shrinks by r at the impact and by r in the section's time change.
    assert det == pytest.approx(-r * launch / closing, rel=1e-13)
    after = float(bounce(s, tau, v, lam, r)) - lam * np.cos(tau + s)
    assert det == pytest.approx(r * r * launch / after, rel=1e-13)


def test_jacobians_broadcast():
    assert exact_map_jacobian(np.full((3, 1), 6.0), 0.0, np.full(2, 3.0), 0.5, 0.8).shape == (
        3,
        2,
        2,
        2,
    )
