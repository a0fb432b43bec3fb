"""Damping ratio and restitution coefficient (Eq. 16)."""

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from bouncing_ball.errors import ModelError
from bouncing_ball.models import damping as linear
from bouncing_ball_beyond import contact_law
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import (
    LINEAR,
    Release,
    damping_ratio,
    restitution_coefficient,
)
from bouncing_ball_beyond.models.spring_damper import SpringDamper

EPS = np.finfo(float).eps


@pytest.mark.parametrize("r", [1e-300, 1e-12, 0.05, 0.1, 0.65, 0.85, 0.999999, 1 - 2**-53])
def test_the_damping_ratio_agrees_with_fifty_digits(r):
    with mpmath.workdps(50):
        log = mpmath.log(mpmath.mpf(r))
        exact = float(-log / mpmath.sqrt(mpmath.pi**2 + log**2))
    # log, hypot and one division: three roundings.
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


@pytest.mark.parametrize("release", LINEAR)
def test_a_linear_contact_has_the_damping_and_the_angles_of_the_root(release):
    rule = linear.Release(release)
    r = np.linspace(0.14, 1.0, 50)
    zeta = damping_ratio(r, release)
    # The root has ζ = sin α; here ζ = cos β, of which β next to π/2 has the rounding EPS.
    expected = linear.damping_ratio(r, rule)
    np.testing.assert_allclose(zeta, expected, rtol=8 * EPS, atol=EPS)
    found = restitution_coefficient(zeta, release)
    np.testing.assert_allclose(found, linear.restitution_coefficient(zeta, rule), rtol=8 * EPS)
    np.testing.assert_allclose(release.free_angle(zeta), rule.free_angle(zeta), rtol=8 * EPS)
    np.testing.assert_array_equal(release.sine(zeta), rule.sine(zeta))


@pytest.mark.parametrize("r", [0.0, -0.1, 1.1, np.nan, np.inf])
def test_a_restitution_coefficient_outside_its_range_is_refused(r, refusal):
    with refusal(ModelError, f"r = {r}", "(0, 1]"):
        damping_ratio(r)


@pytest.mark.parametrize("r", [np.exp(-2), 0.1])
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


@pytest.mark.parametrize("release", [Release.FORCE, Release.APPROACH])
@pytest.mark.parametrize("zeta", [0.999, 1.0, 1.0001, 1.5, 4.0])
def test_an_overdamped_ball_rebounds_where_its_force_vanishes(release, zeta):
    def motion(time, state):
        rate = state[1] if release.is_linear else max(state[1], 0.0)
        return [state[1], -state[0] - 2 * zeta * rate]

    def ends(time, state):
        return state[0] + 2 * zeta * state[1] if release.is_linear else state[0] + (time == 0)

    def turns(time, state):
        return state[1]

    ends.terminal = turns.terminal = True
    ends.direction = turns.direction = -1
    precise = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-14}
    # The force of a damper on approach has a kink at the turn, where the integration starts anew.
    down = solve_ivp(motion, (0.0, 20.0), [0.0, 1.0], events=turns, **precise)
    turn = down.t[-1]
    up = solve_ivp(motion, (turn, 40.0), [down.y[0, -1], -1e-300], events=ends, **precise)
    contact = SpringDamper(1.0, zeta, release)
    assert float(contact.free_duration) == pytest.approx(up.t[-1], rel=1e-9)
    assert float(contact.restitution) == pytest.approx(-up.y[1, -1], rel=1e-9)
    assert float(SpringDamper(2.0, zeta, release).free_duration) == pytest.approx(up.t[-1] / 2)
    many = SpringDamper(1.0, np.array([0.1, zeta]), release)
    assert many.free_duration[1] == contact.free_duration


def test_a_contact_without_closed_form_has_a_ball():
    # With the release "displacement" a contact with ζ ≥ 1 ends because the table goes down.
    for contact in (
        SpringDamper(10.0, 1.2),
        SpringDamper(10.0, 1.2, "force"),
        SpringDamper(10.0, 0.2, "approach"),
    ):
        law = {"frequency_ratio": 10.0, "damping_ratio": float(contact.damping_ratio)}
        made = contact_law("linear", **law, release=str(contact.release))
        assert made == ContactModel(contact) and made.name == "contact-law"
