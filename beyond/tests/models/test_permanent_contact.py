"""The threshold of permanent contact of overdamped contacts, and of the root's below ζ = 1."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from steady_contacts import a_period_after, exact_threshold, just_reaches_its_release

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.models import damping as linear
from bouncing_ball_beyond.inherited.models import permanent_contact as root
from bouncing_ball_beyond.models.damping import LINEAR, Release
from bouncing_ball_beyond.models.permanent_contact import permanent_contact_threshold
from bouncing_ball_beyond.models.spring_damper import SpringDamper

EPS = np.finfo(float).eps


@given(st.floats(1e-3, 1e4), st.floats(1, 2))
def test_the_threshold_of_an_overdamped_contact_has_the_same_form(omega, zeta):
    # Two more roundings than in the root, of the elastic threshold and of its square.
    found = float(permanent_contact_threshold(omega, zeta))
    assert found == pytest.approx(exact_threshold(omega, zeta), rel=6 * EPS)


@pytest.mark.parametrize("release", LINEAR)
@pytest.mark.parametrize("omega", [0.7, 1.0, 3.0, 20.0])
def test_at_the_threshold_the_oscillation_of_an_overdamped_contact_just_reaches_the_release(
    omega, release
):
    zeta = 1.3
    lam = float(permanent_contact_threshold(omega, zeta, release))
    slowest = omega * (zeta - np.sqrt(zeta**2 - 1))
    t = a_period_after(slowest)
    flow = SpringDamper(omega, zeta).flow(t, 0.0, 0.0, 0.0, lam)
    if release is Release.FORCE:
        reserve = SpringDamper(omega, zeta).force(-flow.displacement, -flow.velocity)
    else:
        reserve = -(omega**2) * flow.displacement
    just_reaches_its_release(reserve)


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
