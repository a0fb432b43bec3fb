"""Damping and restitution of contacts that the root lacks: overdamped, or damped on approach."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from bouncing_ball_beyond import contact_law
from bouncing_ball_beyond.inherited.models import damping as linear
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import Release, damping_ratio, restitution_coefficient
from bouncing_ball_beyond.models.spring_damper import SpringDamper

EPS = np.finfo(float).eps


def test_elastic_contact_is_exactly_undamped():
    zeta = float(damping_ratio(1.0, "approach"))
    assert zeta == 0.0
    assert np.copysign(1.0, zeta) == 1.0
    assert float(restitution_coefficient(0.0, "approach")) == 1.0


def test_restitution_and_damping_are_inverse_functions():
    r = np.concatenate([np.geomspace(0.368, 1.0, 40), [0.5, 0.85]])
    zeta = damping_ratio(r, "approach")
    # d(ln r)/dζ is at most π/(1 - ζ²)^(3/2): a rounding of ζ is amplified by that much.
    slope = np.pi * zeta / ((1 - zeta) * (1 + zeta)) ** 1.5
    error = np.abs(restitution_coefficient(zeta, "approach") / r - 1)
    assert np.all(error <= 4 * EPS * (1 + slope))


def test_a_damper_on_approach_takes_half_the_logarithm_of_the_force_release():
    r = np.concatenate([np.linspace(0.37, 1.0, 40), 1 - np.geomspace(1e-12, 1e-3, 10)])
    # Squaring r has a rounding, which next to 1 is large beside ln r = -ζ π/2.
    expected = linear.damping_ratio(r * r, "force")
    np.testing.assert_allclose(damping_ratio(r, "approach"), expected, rtol=8 * EPS, atol=EPS)


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
