"""Shared by all tests: the hypothesis profile and reference implementations.

The references use nothing of the package: a matrix exponential, Brent's
method and the textbook formulas of the table and of free flight.
"""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import HealthCheck, settings
from scipy.linalg import expm
from scipy.optimize import brentq

settings.register_profile(
    "deterministic",
    derandomize=True,
    deadline=None,
    max_examples=60,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
settings.load_profile("deterministic")


def _contact_state(s, d0, v0, phase, lam, omega, zeta):
    """(δ, δ′) after a time s in contact, by the exponential of a 5 × 5 matrix.

    The state (ϖδ, δ′, 1, sin τ, cos τ) makes the equation autonomous; the
    factor ϖ balances the matrix.
    """
    matrix = np.zeros((5, 5))
    matrix[0, 1] = omega
    matrix[1] = [-omega, -2 * zeta * omega, -1.0, lam, 0.0]
    matrix[3, 4], matrix[4, 3] = 1.0, -1.0
    start = [omega * d0, v0, 1.0, np.sin(phase), np.cos(phase)]
    scaled_d, v, *_ = expm(matrix * s) @ start
    return scaled_d / omega, v


def _cycle(phase, u, n, lam, omega, zeta, duration, force_release=False):
    """One cycle from the start of contact: (landing phase, relative landing velocity).

    ``duration`` is a guess of the contact time; both events are bracketed
    around the guesses and closed by Brent's method to the last digits.
    """

    def release(s):
        d, v = _contact_state(s, 0.0, u, phase, lam, omega, zeta)
        return omega * d + (2 * zeta * v if force_release else 0.0)

    s = brentq(release, 0.97 * duration, 1.03 * duration, xtol=1e-300, rtol=4e-16)
    d, v = _contact_state(s, 0.0, u, phase, lam, omega, zeta)
    z = d + lam * np.sin(phase + s)
    zdot = v + lam * np.cos(phase + s)
    flight = 2 * np.pi * n - duration

    def gap(t):
        return z + zdot * t - t * t / 2 - lam * np.sin(phase + s + t)

    t = brentq(gap, 0.97 * flight, 1.03 * flight, xtol=1e-300, rtol=4e-16)
    return phase + s + t, zdot - t - lam * np.cos(phase + s + t)


@pytest.fixture(scope="session")
def reference():
    """Independent implementations: ``contact_state`` and ``cycle``."""
    return SimpleNamespace(contact_state=_contact_state, cycle=_cycle)


@pytest.fixture(scope="session")
def one_line():
    """Asserts that an exception's message is one line with the given parts."""

    def check(error, *parts):
        message = str(error.value)
        assert "\n" not in message, message
        for part in parts:
            assert part in message, message

    return check


@pytest.fixture(scope="session")
def continuation_settings():
    """The ``continuation`` section of the configuration."""
    return {
        "newton_tolerance": 1e-12,
        "max_newton_iterations": 8,
        "initial_step": 0.02,
        "smallest_step": 1e-8,
        "largest_step": 0.2,
        "max_angle": 0.2,
        "stiff_frequency_ratio": 1e4,
    }
