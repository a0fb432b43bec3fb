"""A contact whose force stays below the weight has no n-T orbit, and none is searched for."""

import numpy as np
import pytest

from bouncing_ball_beyond.inherited.contacts.contact.families import can_carry
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.laws.hertzian import HuntCrossley, KuwabaraKono, Tsuji
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.orbits.motion import contact_motion


def tsuji(k):
    return Tsuji(k, 0.1)


def hunt_crossley(k):
    return HuntCrossley(k, 0.05)


def kuwabara_kono(k):
    return KuwabaraKono(k, 0.1)


LAWS = [tsuji, hunt_crossley, kuwabara_kono]


@pytest.mark.parametrize("of", LAWS)
@pytest.mark.parametrize("n", [1, 2])
def test_orbits_that_exist_are_within_the_bounds(of, n):
    lam = 1.5
    found = False
    for k in (0.5, 2.0):
        law = of(k)
        orbit = n_t.orbit(ContactModel(law), n, lam)
        if not orbit.exists:
            continue
        found = True
        assert can_carry(law, np.array([n]), lam).all()
        time = np.linspace(0.0, float(orbit.contact_duration), 401)
        displacement, velocity = contact_motion(orbit, time)
        period = 2 * np.pi * n
        assert -displacement.min() <= period**2 / 4 + 2 * lam
        assert np.abs(velocity).max() <= period + lam
        assert law.force(np.maximum(-displacement, 0.0), -velocity).max() >= 1
    assert found


@pytest.mark.parametrize("of", LAWS)
def test_a_contact_that_cannot_carry_the_ball_has_no_orbit(of):
    law = of(1e-4)
    assert not can_carry(law, np.array([1]), 0.9).any()
    assert not n_t.orbit(ContactModel(law), 1, 0.9).exists


def test_the_bound_is_that_of_the_linear_contact():
    """Without damping the force is ϖ² p, and p is at most π² + 2Λ for n = 1."""
    edge = 1 / np.sqrt(np.pi**2 + 1)
    for ratio, carries in ((0.999 * edge, False), (1.001 * edge, True)):
        assert can_carry(SpringDamper(ratio, 0.0), np.array([1]), 0.5).tolist() == [carries]
