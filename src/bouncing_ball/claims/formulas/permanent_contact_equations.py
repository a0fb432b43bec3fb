"""Eqs. 29-36 against the periodic orbit of the contact's flow."""

import numpy as np
from scipy.linalg import expm
from scipy.optimize.elementwise import find_minimum, find_root

from bouncing_ball.claims import as_printed as printed
from bouncing_ball.claims.formulas.disagreement import ROUNDING, Check, largest
from bouncing_ball.claims.formulas.flow import contact_matrix, flow, state

# A contact so soft that Λ_SD ϖ² is 1 but for ϖ².
_SOFT = 1e-4


def _steady_amplitude(frequency_ratio, damping_ratio):
    """Amplitude of δ for Λ = 1: the orbit of period 2π of the flow."""
    matrix = contact_matrix(frequency_ratio, damping_ratio, 1.0, gravity=0.0)
    period = expm(matrix * 2 * np.pi)
    eye = np.eye(2)
    drive = period[..., :2, 3]  # from cos 0 = 1
    orbit = np.squeeze(np.linalg.solve(eye - period[..., :2, :2], drive[..., np.newaxis]), -1)
    start = state(orbit[..., 0], orbit[..., 1], 0.0)
    quarter = flow(matrix, np.pi / 2, start)
    # δ = z - sin τ at τ = 0 and π/2, a quarter apart.
    return np.hypot(start[..., 0], quarter[..., 0] - 1)


def _threshold(x, zeta):
    """Λ_SD at x = 1/ϖ²: √[(1 - x)² + 4ζ²x], for roots and minima of Eq. 33."""
    return np.hypot(1 - x, 2 * zeta * np.sqrt(x))


def _steady_motion(rng, samples, omega, zeta) -> Check:
    """Eq. 31 against the flow from one of its own states."""
    lam, begin = rng.uniform(0.1, 2, samples), rng.uniform(-np.pi, np.pi, samples)

    def steady(time):
        return printed.steady_displacement(time, omega, zeta, lam)

    # z = δ + w; the velocity of the printed solution a quarter of a cycle away.
    mean = -1 / omega**2
    rate = steady(begin + np.pi / 2) - mean + lam * np.cos(begin)
    later = rng.uniform(0.5, 6, samples)
    start = state(steady(begin) + lam * np.sin(begin), rate, begin)
    there = flow(contact_matrix(omega, zeta, lam), later, start)
    defect = there[:, 0] - lam * np.sin(begin + later) - steady(begin + later)
    return Check(largest(defect), ROUNDING, "matrix exponential of Eq. 11")


def _crossing(level, zeta, low, high):
    """The ϖ at which the threshold has the level, between two x = 1/ϖ²."""
    found = find_root(
        lambda x, level, zeta: _threshold(x, zeta) - level, (low, high), args=(level, zeta)
    )
    return 1 / np.sqrt(found.x)


def _minimum(rng, samples, zeta) -> dict[str, Check]:
    """Eqs. 34 to 36: the minimum of the threshold, and where it has a level above."""
    bracket = 0 * zeta + 1e-3, 1 - 2 * zeta**2, 0 * zeta + 10
    lowest = find_minimum(_threshold, bracket, args=(zeta,))
    # Λ between the minimum and 1, where both frequency ratios exist.
    bottom, place = lowest.f_x, lowest.x
    level = bottom + (1 - bottom) * rng.uniform(0.1, 0.9, samples)
    found = {}
    for equation, sign, low, high in (
        ("Eq. 34", 1, 0 * place + 1e-8, place),
        ("Eq. 35", -1, place, 0 * place + 1e4),
    ):
        ratio = printed.permanent_contact_frequency_ratio(level, zeta, sign)
        defect = ratio / _crossing(level, zeta, low, high) - 1
        found[equation] = Check(largest(defect), ROUNDING, "roots of Λ_SD")
    defect = printed.permanent_contact_minimum(zeta) / bottom - 1
    return {**found, "Eq. 36": Check(largest(defect), ROUNDING, "minimum of Λ_SD")}


def permanent_contact_checks(rng, samples) -> dict[str, Check]:
    """Checks of Eqs. 29 to 36 on random parameters."""
    omega, zeta = np.exp(rng.uniform(-0.5, 2, samples)), rng.uniform(0.02, 0.5, samples)
    steady = _steady_motion(rng, samples, omega, zeta)
    threshold = 1 / (omega**2 * _steady_amplitude(omega, zeta))
    at_any = printed.permanent_contact_threshold(omega, zeta) / threshold - 1
    resonant = printed.resonant_threshold(zeta) * _steady_amplitude(1.0, zeta) - 1
    # Λ_SD grows as 1/ϖ², with a next term of relative order ϖ².
    soft = 1 / _steady_amplitude(_SOFT, zeta) - 1
    period = "period of the flow"
    return {
        "Eq. 31": steady,
        "Eq. 33": Check(largest(at_any), ROUNDING, period),
        "Eq. 33, ϖ = 1": Check(largest(resonant), ROUNDING, period),
        "Eq. 33, ϖ → 0": Check(largest(soft), 2 * _SOFT**2, period),
        **_minimum(rng, samples, zeta),
    }
