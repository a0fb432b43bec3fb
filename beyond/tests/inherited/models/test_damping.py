"""Damping ratio and restitution coefficient (Eq. 16)."""

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.models.damping import (
    Release,
    check_positive,
    damping_ratio,
    restitution_coefficient,
)

EPS = np.finfo(float).eps


@pytest.mark.parametrize("r", [1e-300, 1e-12, 0.05, 0.1, 0.65, 0.85, 0.999999, 1 - 2**-53])
def test_the_damping_ratio_agrees_with_fifty_digits(r):
    with mpmath.workdps(50):
        log = mpmath.log(mpmath.mpf(r))
        exact = float(-log / mpmath.sqrt(mpmath.pi**2 + log**2))
    # The logarithm, the root and one division: three roundings.
    assert float(damping_ratio(r)) == pytest.approx(exact, rel=3 * EPS, abs=0)


@pytest.mark.parametrize("release", Release)
def test_elastic_contact_is_exactly_undamped(release):
    zeta = float(damping_ratio(1.0, release))
    assert zeta == 0.0
    assert np.copysign(1.0, zeta) == 1.0
    assert float(restitution_coefficient(0.0, release)) == 1.0


@pytest.mark.parametrize(("release", "least"), [("displacement", 1e-8), ("force", 0.1354)])
def test_restitution_and_damping_are_inverse_functions(release, least):
    r = np.concatenate([np.geomspace(least, 1.0, 40), [0.5, 0.85]])
    release = Release(release)
    zeta = damping_ratio(r, release)
    # d(ln r)/dζ is at most π/(1 - ζ²)^(3/2): a rounding of ζ is amplified by that much.
    slope = np.pi * zeta / ((1 - zeta) * (1 + zeta)) ** 1.5
    error = np.abs(restitution_coefficient(zeta, release) / r - 1)
    assert np.all(error <= 4 * EPS * (1 + slope))


@pytest.mark.parametrize("r", [0.0, -0.1, 1.1, np.nan, np.inf])
def test_a_restitution_coefficient_outside_its_range_is_refused(r, refusal):
    with refusal(ModelError, f"r = {r}", "(0, 1]"):
        damping_ratio(r)


def test_next_to_the_limits_of_restitution_the_damping_is_critical():
    """ζ = cos β is 1 - β²/2 with 1 - β²/3 = -ln r/2 for the force release."""
    r = np.exp(-2) * (1 + EPS * np.array([2.0, 4.0, 100.0, 1e6, 1e10]))
    expected = 1 - 0.75 * np.log1p(np.exp(2) * (r - np.exp(-2)))
    # The logarithm has one rounding, and terms of fourth order are left out.
    assert damping_ratio(r, Release.FORCE) == pytest.approx(expected, abs=1e-11)


@pytest.mark.parametrize("r", [0.135335, 0.1])
def test_no_contact_released_at_zero_force_has_so_little_restitution(r, refusal):
    with refusal(ModelError, f"r = {r}", "(e⁻², 1]"):
        damping_ratio(r, Release.FORCE)


@pytest.mark.parametrize("zeta", [1.0, -1e-9, 2.0, np.nan])
def test_the_restitution_of_an_overdamped_contact_is_refused(zeta, refusal):
    with refusal(ModelError, f"ζ = {zeta}", "[0, 1)", "overdamped"):
        restitution_coefficient(zeta)


def test_one_bad_value_among_many_is_reported_on_one_line(refusal):
    # A sweep hands over arrays; numpy breaks a long one into many lines.
    with refusal(ModelError, "(0, 1]"):
        damping_ratio(np.linspace(0.0, 1.0, 60))


@pytest.mark.parametrize("release", Release)
def test_a_release_given_by_its_name_gives_the_same_damping(release):
    assert damping_ratio(0.65, str(release)) == damping_ratio(0.65, release)
    assert restitution_coefficient(0.1, str(release)) == restitution_coefficient(0.1, release)


@pytest.mark.parametrize("release", Release)
@pytest.mark.parametrize("zeta", [0.0, 0.05, 0.6, 0.95])
def test_a_free_contact_rebounds_after_the_free_angle_with_its_restitution(release, zeta):
    def motion(time, state):
        return [state[1], -state[0] - 2 * zeta * state[1]]

    def ends(time, state):
        # At the start the displacement vanishes as well.
        force = state[0] + (2 * zeta * state[1] if release is Release.FORCE else 0.0)
        return force if time > 0.01 else 1.0

    ends.terminal = True
    precise = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-14}
    end = solve_ivp(motion, (0.0, 20.0), [0.0, 1.0], events=ends, **precise)
    # The tolerance of the integration, over some hundred steps.
    near = {"rel": 1e-9}
    assert float(release.free_angle(zeta)) == pytest.approx(
        end.t[-1] * np.sqrt(1 - zeta * zeta), **near
    )
    assert float(restitution_coefficient(zeta, release)) == pytest.approx(-end.y[1, -1], **near)


@pytest.mark.parametrize("release", ["x", True, None, 1, ["force"]])
def test_an_unknown_release_is_refused_with_the_names_that_are_known(release, refusal):
    with refusal(ModelError, f"unknown release {release!r}", "displacement, force"):
        damping_ratio(0.5, release)


@pytest.mark.parametrize("value", ["x", "2.0", True, None, [True], ["1", "2"], [[1.0], [2.0, 3.0]]])
def test_what_is_no_number_is_refused(value, refusal):
    with refusal(ModelError, f"frequency ratio ϖ = {value!r} is not a finite number > 0"):
        check_positive(value, "frequency ratio ϖ")
    with refusal(ModelError, f"damping ratio ζ = {value!r} is not in [0, 1)"):
        restitution_coefficient(value)
    with refusal(ModelError, f"restitution coefficient r = {value!r} is not in (0, 1]"):
        damping_ratio(value)


@pytest.mark.parametrize("omega", [0.0, -1.0, np.nan, np.inf])
def test_a_parameter_that_must_be_positive_is(omega, refusal):
    with refusal(ModelError, f"ϖ = {omega}", "> 0"):
        check_positive(omega, "frequency ratio ϖ")
