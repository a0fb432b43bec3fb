"""The threshold of permanent contact, its inverse and its minimum (Eqs. 28-36)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar
from steady_contacts import a_period_after, exact_threshold, just_reaches_its_release

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.models.damping import Release
from bouncing_ball_beyond.inherited.models.permanent_contact import (
    permanent_contact_frequency_ratios,
    permanent_contact_minimum,
    permanent_contact_threshold,
)
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper, force

EPS = np.finfo(float).eps


@given(st.floats(1e-3, 1e4), st.floats(0, 0.999))
def test_the_threshold_is_the_root_of_gamma_over_the_stiffness(omega, zeta):
    exact = exact_threshold(omega, zeta)
    # 1 - 1/ϖ² loses digits next to ϖ = 1, to the rounding of 1/ϖ² ≈ 1.
    computed = float(permanent_contact_threshold(omega, zeta))
    assert abs(computed - exact) <= 6 * EPS * max(exact, 1.0)


@pytest.mark.parametrize("release", Release)
@pytest.mark.parametrize("zeta", [0.05, 0.4, 0.95])
@pytest.mark.parametrize("omega", [0.7, 1.0, 3.0, 20.0])
def test_at_the_threshold_the_steady_oscillation_just_reaches_the_release(omega, zeta, release):
    lam = float(permanent_contact_threshold(omega, zeta, release))
    t = a_period_after(zeta * omega)
    flow = SpringDamper(omega, zeta).flow(t, 0.0, 0.0, lam)
    if release is Release.FORCE:
        reserve = force(omega, zeta, -flow.displacement, -flow.velocity)
    else:
        reserve = -(omega**2) * flow.displacement
    just_reaches_its_release(reserve)


@pytest.mark.parametrize(
    ("zeta", "release"),
    [(z, rule) for z in (0.05, 0.136, 0.4, 0.65) for rule in Release] + [(0.9, Release.FORCE)],
)
def test_the_minimum_is_that_of_a_numerical_minimiser(zeta, release):
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


@pytest.mark.parametrize("zeta", [0.0, 0.05166, 0.136, 0.4, 0.7])
def test_both_frequency_ratios_have_the_threshold_and_enclose_the_minimum(zeta):
    lowest = permanent_contact_minimum(zeta)
    share = np.array([1e-3, 0.1, 0.5, 0.9, 1 - 1e-6])
    threshold = lowest.threshold + share * (1 - lowest.threshold)
    ratios = permanent_contact_frequency_ratios(threshold, zeta)
    assert np.all(ratios.lower < lowest.frequency_ratio)
    assert np.all(lowest.frequency_ratio < ratios.upper)
    for ratio in ratios:
        # Next to the minimum the difference of the squares of Λ loses three digits.
        found = permanent_contact_threshold(ratio, zeta)
        assert found == pytest.approx(threshold, rel=1e-12)


@pytest.mark.parametrize("zeta", [0.0, 0.136, 0.7072, 0.95])
def test_a_threshold_above_one_belongs_to_the_lower_frequency_ratio_alone(zeta):
    threshold = np.array([1 + 1e-6, 1.1, 3.0, 1e4])
    ratios = permanent_contact_frequency_ratios(threshold, zeta)
    assert np.all(np.isnan(ratios.upper))
    found = permanent_contact_threshold(ratios.lower, zeta)
    assert found == pytest.approx(threshold, rel=1e-9 if zeta > 0.7 else 1e-13)


def test_at_a_threshold_of_one_the_upper_frequency_ratio_is_infinite():
    ratios = permanent_contact_frequency_ratios(1.0, 0.136)
    assert float(ratios.upper) == np.inf
    assert float(permanent_contact_threshold(ratios.lower, 0.136)) == pytest.approx(1, rel=4 * EPS)


@pytest.mark.parametrize(("threshold", "zeta"), [(0.2, 0.136), (0.999, 0.7072), (1.0, 0.8)])
def test_a_threshold_that_is_never_reached_has_no_frequency_ratio(threshold, zeta):
    assert np.all(np.isnan(permanent_contact_frequency_ratios(threshold, zeta)))


def test_the_frequency_ratios_of_an_impossible_threshold_are_refused(refusal):
    with refusal(ModelError, "Λ = 0.0", "> 0"):
        permanent_contact_frequency_ratios(0.0, 0.1)
    with refusal(ModelError, "ζ = -0.1", "[0, 1)"):
        permanent_contact_frequency_ratios(0.5, -0.1)


@pytest.mark.parametrize("release", Release)
def test_undamped_minimum_is_zero_at_resonance(release):
    lowest = permanent_contact_minimum(0.0, release)
    assert (float(lowest.threshold), float(lowest.frequency_ratio)) == (0.0, 1.0)


@pytest.mark.parametrize("zeta", [0.7072, 1.0, -0.1, np.nan])
def test_a_damping_without_a_minimum_is_refused(zeta, refusal):
    with refusal(ModelError, f"ζ = {zeta}", "[0, 1"):
        permanent_contact_minimum(zeta)


def test_a_frequency_ratio_or_damping_out_of_range_is_refused(refusal):
    with refusal(ModelError, "ϖ = 0.0", "> 0"):
        permanent_contact_threshold(0.0, 0.1)
    with refusal(ModelError, "ζ = -0.1", "[0, 1)"):
        permanent_contact_threshold(1.0, -0.1)
