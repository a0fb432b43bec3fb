"""Permanent contact (Eqs. 28-36)."""

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from bouncing_ball.errors import ModelError
from bouncing_ball.impacts.damping import damping_ratio
from bouncing_ball.impacts.permanent_contact import (
    RESTITUTION_THRESHOLD,
    permanent_contact_frequency_ratios,
    permanent_contact_minimum,
    permanent_contact_threshold,
)
from bouncing_ball.impacts.spring_damper import Release, contact_flow, contact_force

EPS = np.finfo(float).eps


@given(st.floats(1e-3, 1e4), st.floats(0, 2))
def test_threshold_against_the_papers_formula(omega, zeta):
    with mpmath.workdps(50):
        w, z = mpmath.mpf(omega), mpmath.mpf(zeta)
        gamma = (w * w - 1) ** 2 + (2 * z * w) ** 2
        exact = float(mpmath.sqrt(gamma) / w**2)
    # 1 - 1/ϖ² loses digits next to ϖ = 1, to the rounding of 1/ϖ² ≈ 1.
    computed = float(permanent_contact_threshold(omega, zeta))
    assert abs(computed - exact) <= 6 * EPS * max(exact, 1.0)


@pytest.mark.parametrize("release", list(Release))
@pytest.mark.parametrize("zeta", [0.05, 0.4, 1.3])
@pytest.mark.parametrize("omega", [0.7, 1.0, 3.0, 20.0])
def test_steady_oscillation_just_reaches_the_release(omega, zeta, release):
    # At the threshold the steady displacement touches zero from below, or the
    # force from above: the flow, once the transient has gone, over a period.
    lam = float(permanent_contact_threshold(omega, zeta, release))
    slowest = omega * (zeta - np.sqrt(max(zeta**2 - 1, 0)))
    settled = 2 * np.pi * np.ceil(40 / slowest / (2 * np.pi))
    t = settled + np.linspace(0, 2 * np.pi, 20001)
    flow = contact_flow(t, 0.0, 0.0, 0.0, lam, omega, zeta)
    # In units of the weight, both oscillate about one with amplitude one; the
    # sample nearest to the extremum is within (2π/40000)²/2 of it.
    if release is Release.FORCE:
        reserve = contact_force(flow.displacement, flow.velocity, omega, zeta)
    else:
        reserve = -(omega**2) * flow.displacement
    assert abs(reserve.min()) < 2e-8
    assert reserve.max() == pytest.approx(2.0, abs=2e-8)


def test_limits():
    assert RESTITUTION_THRESHOLD == 1.0
    for zeta in (0.0, 0.136, 0.5):
        # Λ_SD - 1 → (2ζ² - 1)/ϖ², the next term a factor 1/ϖ² smaller.
        for omega in (1e2, 1e3):
            slope = (float(permanent_contact_threshold(omega, zeta)) - 1) * omega**2
            assert slope == pytest.approx(2 * zeta**2 - 1, abs=2 / omega**2 + 2 * EPS * omega**2)
        # Λ_SD ϖ² → 1, off by (2ζ² - 1) ϖ².
        for omega in (1e-3, 1e-5):
            scaled = float(permanent_contact_threshold(omega, zeta)) * omega**2
            assert scaled == pytest.approx(1.0, abs=2 * omega**2 + 4 * EPS)
        assert float(permanent_contact_threshold(1.0, zeta)) == 2 * zeta


@pytest.mark.parametrize(
    ("zeta", "release"),
    [(z, rule) for z in (0.05, 0.136, 0.4, 0.65) for rule in Release] + [(1.5, Release.FORCE)],
)
def test_minimum_against_a_minimiser(zeta, release):
    lowest = permanent_contact_minimum(zeta, release)
    found = minimize_scalar(
        lambda w: float(permanent_contact_threshold(w, zeta, release)),
        bounds=(0.5, 10.0),
        method="bounded",
        options={"xatol": 1e-10},
    )
    # A minimum locates to the square root of eps, its value to eps.
    assert float(lowest.frequency_ratio) == pytest.approx(found.x, rel=1e-6)
    assert float(lowest.threshold) == pytest.approx(found.fun, rel=1e-12)
    at = float(permanent_contact_threshold(lowest.frequency_ratio, zeta, release))
    assert float(lowest.threshold) == pytest.approx(at, rel=10 * EPS)


@pytest.mark.parametrize("release", list(Release))
def test_undamped_minimum_is_zero_at_resonance(release):
    lowest = permanent_contact_minimum(0.0, release)
    assert (float(lowest.threshold), float(lowest.frequency_ratio)) == (0.0, 1.0)


def test_releases_agree_without_damping_and_differ_with_it():
    omega = np.array([0.3, 1.0, 2.0, 50.0])
    assert np.array_equal(
        permanent_contact_threshold(omega, 0.0),
        permanent_contact_threshold(omega, 0.0, Release.FORCE),
    )
    # A damper pulls before the displacement is zero: less is permanent contact.
    assert np.all(
        permanent_contact_threshold(omega, 0.2, Release.FORCE)
        < permanent_contact_threshold(omega, 0.2)
    )


@given(st.floats(0.02, 100), st.floats(0, 2))
def test_inverse_for_the_force_release(omega, zeta):
    lam = float(permanent_contact_threshold(omega, zeta, Release.FORCE))
    found = permanent_contact_frequency_ratios(lam, zeta, Release.FORCE)
    # Λ² of both, with the roundings of the sums of squares; next to the
    # minimum Λ may round below it.
    size = 1 + lam**2 * (1 + 4 * zeta**2) ** 2
    noise = 64 * EPS * size**2
    finite = [float(w) for w in found if np.isfinite(w)]
    for w in finite:
        again = float(permanent_contact_threshold(w, zeta, Release.FORCE))
        assert abs(again**2 - lam**2) <= noise
    lowest = permanent_contact_minimum(zeta, Release.FORCE)
    if lam**2 - float(lowest.threshold) ** 2 > noise:
        # And ϖ itself is one of them, unless the slope is flat there.
        assert finite
        nearest = min(abs(w / omega - 1) for w in finite)
        slope = 2 * abs(1 - 2 * zeta**2 * (1 - lam**2) - omega**-2) * omega**-2
        assert nearest * slope <= noise + nearest**2 * (1 + omega**-4) * 4


@given(st.floats(0.02, 300), st.floats(0, 2))
def test_inverse_is_the_inverse(omega, zeta):
    lam = float(permanent_contact_threshold(omega, zeta))
    low, high = (float(x) for x in permanent_contact_frequency_ratios(lam, zeta))
    # x = 1/ϖ² from Λ²: d(Λ²)/dx = 2(x - 1 + 2ζ²). The roundings of Λ² and of
    # the sum under the root are of size Λ² + 1; next to the minimum the
    # square root of that remains.
    x, centre = omega**-2, 1 - 2 * zeta**2
    noise = 16 * EPS * (lam**2 + 1 + centre**2)
    allowed = min(noise / max(abs(x - centre), 1e-300), 2 * np.sqrt(noise)) + 8 * EPS * x
    roots = [w**-2 for w in (low, high) if not np.isnan(w)]
    if not roots:  # Λ rounded below the minimum
        assert (x - centre) ** 2 <= noise
    else:
        assert min(abs(root - x) for root in roots) <= allowed
    for w in (low, high):
        if np.isfinite(w):
            # Both are solutions: the same noise, now in Λ².
            again = float(permanent_contact_threshold(w, zeta))
            assert abs(again**2 - lam**2) <= 2 * noise


@pytest.mark.parametrize("zeta", [0.0, 0.136, 0.6])
def test_inverse_at_exactly_one(zeta):
    low, high = permanent_contact_frequency_ratios(1.0, zeta)
    assert float(low) ** -2 == pytest.approx(2 * (1 - 2 * zeta**2), rel=8 * EPS)
    assert float(high) == np.inf


def test_inverse_just_off_one_has_no_cancellation():
    # x₋ = (1 - Λ²)/x₊, of order 1e-12, to full precision.
    lam = 1 - 2.0**-40
    for zeta in (0.0, 0.3):
        with mpmath.workdps(50):
            centre = 1 - 2 * mpmath.mpf(zeta) ** 2
            inner = centre - mpmath.sqrt(centre**2 + mpmath.mpf(lam) ** 2 - 1)
            exact = float(1 / mpmath.sqrt(inner))
        high = float(permanent_contact_frequency_ratios(lam, zeta)[1])
        assert high == pytest.approx(exact, rel=8 * EPS)


def test_inverse_where_there_is_none():
    zeta = 0.3
    below = 0.99 * float(permanent_contact_minimum(zeta).threshold)
    assert np.isnan(permanent_contact_frequency_ratios(below, zeta)).all()
    # Above one only the soft side remains.
    low, high = permanent_contact_frequency_ratios(1.5, zeta)
    assert np.isfinite(low) and np.isnan(high)
    # Strong damping: below one there is none at all.
    assert np.isnan(permanent_contact_frequency_ratios(0.9, 0.8)).all()


def test_no_frequency_ratio_has_a_negative_threshold():
    assert np.isnan(permanent_contact_frequency_ratios(-0.5, 0.1)).all()


def test_one_percent_threshold_of_the_permanent_contact():
    # Λ_SD = 0.99 at the larger ϖ. Figure 16's r = 0.65.
    high = float(permanent_contact_frequency_ratios(0.99, damping_ratio(0.65))[1])
    assert high == pytest.approx(9.81177, abs=5e-6)


@pytest.mark.parametrize("zeta", [0.7072, 1.0, -0.1, np.nan])
def test_minimum_outside_its_range(zeta, one_line):
    with pytest.raises(ModelError) as error:
        permanent_contact_minimum(zeta)
    one_line(error, f"ζ = {zeta}", "[0, 1/√2)")


def test_threshold_outside_its_range(one_line):
    with pytest.raises(ModelError) as error:
        permanent_contact_threshold(0.0, 0.1)
    one_line(error, "ϖ = 0.0", "positive")
    with pytest.raises(ModelError) as error:
        permanent_contact_threshold(1.0, -0.1)
    one_line(error, "ζ = -0.1", "≥ 0")
