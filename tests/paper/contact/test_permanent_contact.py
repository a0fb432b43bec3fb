"""Permanent contact of the spring-damper: its threshold and the minimum of that (Eqs. 28-36)."""

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from bouncing_ball.errors import ModelError
from bouncing_ball.paper.contact.damping import Release
from bouncing_ball.paper.contact.permanent_contact import (
    permanent_contact_minimum,
    permanent_contact_threshold,
)
from bouncing_ball.paper.contact.spring_damper import SpringDamper

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
    flow = SpringDamper(omega, zeta).flow(t, 0.0, 0.0, 0.0, lam)
    # In units of the weight, both oscillate about one with amplitude one; the
    # sample nearest to the extremum is within (2π/40000)²/2 of it.
    if release is Release.FORCE:
        reserve = SpringDamper(omega, zeta).force(-flow.displacement, -flow.velocity)
    else:
        reserve = -(omega**2) * flow.displacement
    assert abs(reserve.min()) < 2e-8
    assert reserve.max() == pytest.approx(2.0, abs=2e-8)


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


@pytest.mark.parametrize("zeta", [0.7072, 1.0, -0.1, np.nan])
def test_minimum_outside_its_range(zeta, refusal):
    with refusal(ModelError, f"ζ = {zeta}", "[0, 1/√2)"):
        permanent_contact_minimum(zeta)


def test_threshold_outside_its_range(refusal):
    with refusal(ModelError, "ϖ = 0.0", "> 0"):
        permanent_contact_threshold(0.0, 0.1)
    with refusal(ModelError, "ζ = -0.1", "≥ 0"):
        permanent_contact_threshold(1.0, -0.1)
