"""A ball that stays on its contact: the threshold in 50 digits, and the force over the weight."""

import mpmath
import numpy as np
import pytest


def exact_threshold(omega: float, zeta: float) -> float:
    """√γ/ϖ² (Eq. 33)."""
    with mpmath.workdps(50):
        w = mpmath.mpf(omega)
        z = mpmath.mpf(zeta)
        gamma = (w * w - 1) ** 2 + (2 * z * w) ** 2
        return float(mpmath.sqrt(gamma) / w**2)


def a_period_after(slowest: float) -> np.ndarray:
    """Times over a period of the table, once a transient that decays at this rate has gone."""
    settled = 2 * np.pi * np.ceil(40 / slowest / (2 * np.pi))
    return settled + np.linspace(0, 2 * np.pi, 20001)


def just_reaches_its_release(reserve: np.ndarray) -> None:
    """At the threshold the steady displacement touches zero from below, or the force from above.

    In units of the weight, both oscillate about one with amplitude one; the sample nearest to the
    extremum is within (2π/40000)²/2 of it.
    """
    assert abs(reserve.min()) < 2e-8
    assert reserve.max() == pytest.approx(2.0, abs=2e-8)
