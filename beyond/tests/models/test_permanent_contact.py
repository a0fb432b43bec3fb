"""The threshold of permanent contact of overdamped contacts, and of the root's below ζ = 1."""

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball.errors import ModelError
from bouncing_ball.models import damping as linear
from bouncing_ball.models import permanent_contact as root
from bouncing_ball_beyond.models.damping import LINEAR, Release
from bouncing_ball_beyond.models.permanent_contact import permanent_contact_threshold
from bouncing_ball_beyond.models.spring_damper import SpringDamper

EPS = np.finfo(float).eps


@given(st.floats(1e-3, 1e4), st.floats(0, 2))
def test_the_threshold_is_the_root_of_gamma_over_the_stiffness(omega, zeta):
    with mpmath.workdps(50):
        w = mpmath.mpf(omega)
        z = mpmath.mpf(zeta)
        gamma = (w * w - 1) ** 2 + (2 * z * w) ** 2
        exact = float(mpmath.sqrt(gamma) / w**2)
    # 1 - 1/ϖ² loses digits next to ϖ = 1, to the rounding of 1/ϖ² ≈ 1.
    computed = float(permanent_contact_threshold(omega, zeta))
    assert abs(computed - exact) <= 6 * EPS * max(exact, 1.0)


@pytest.mark.parametrize("release", LINEAR)
@pytest.mark.parametrize("omega", [0.7, 1.0, 3.0, 20.0])
def test_at_the_threshold_the_oscillation_of_an_overdamped_contact_just_reaches_the_release(
    omega, release
):
    # At the threshold the steady displacement touches zero from below, or the
    # force from above: the flow, once the transient has gone, over a period.
    zeta = 1.3
    lam = float(permanent_contact_threshold(omega, zeta, release))
    slowest = omega * (zeta - np.sqrt(zeta**2 - 1))
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


@pytest.mark.parametrize("release", LINEAR)
def test_an_underdamped_contact_has_the_threshold_of_the_root(release):
    omega = np.geomspace(0.1, 1e6, 50)
    zeta = np.array([0.0, 0.05, 0.4, 0.95])[:, np.newaxis]
    expected = root.permanent_contact_threshold(omega, zeta, linear.Release(release))
    np.testing.assert_array_equal(permanent_contact_threshold(omega, zeta, release), expected)


def test_a_frequency_ratio_or_damping_out_of_range_is_refused(refusal):
    with refusal(ModelError, "ϖ = 0.0", "> 0"):
        permanent_contact_threshold(0.0, 0.1)
    with refusal(ModelError, "ζ = -0.1", "≥ 0"):
        permanent_contact_threshold(1.0, -0.1)
