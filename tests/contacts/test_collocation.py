"""Single contacts: exact answers, and starts without a contact. See also the contract of all
laws.
"""

import numpy as np
import pytest
from scipy.special import beta

from bouncing_ball.contacts.collocation import contacts, path
from bouncing_ball.contacts.contact_law import ContactLaw
from bouncing_ball.contacts.law_choice import law_of_impact
from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley
from bouncing_ball.contacts.laws.impedance import Impedance
from bouncing_ball.contacts.laws.kuwabara_kono import KuwabaraKono
from bouncing_ball.contacts.laws.tsuji import Tsuji, tsuji_damping
from bouncing_ball.contacts.signature import free_impact
from bouncing_ball.errors import ModelError


@pytest.mark.parametrize("law", [HuntCrossley(50.0, 0.0), Tsuji(50.0, 0.0), KuwabaraKono(50.0, 0)])
def test_the_elastic_hertz_impact(law):
    # (2/5) K p^{5/2} = v²/2 at the greatest penetration, and D = (4/5) B(2/5, 1/2) p/v.
    v = 2.0
    deepest = (5 * v * v / (4 * 50.0)) ** 0.4
    end = contacts(law, v, weight=0.0)
    assert float(end.duration) == pytest.approx(0.8 * beta(0.4, 0.5) * deepest / v, rel=1e-13)
    assert float(end.rate) == pytest.approx(-v, rel=1e-13)
    # Inside, the path is as exact as its coefficients have fallen.
    assert float(path(law, end, end.duration / 2, v, weight=0.0)[0]) == pytest.approx(
        deepest, rel=1e-9
    )


@pytest.mark.parametrize("restitution", [0.95, 0.65, 0.3, 0.1])
def test_tsujis_damping_gives_its_restitution_at_every_speed(restitution):
    law = Tsuji(300.0, tsuji_damping(restitution))
    speed = np.array([1e-3, 1.0, 50.0])
    end = contacts(law, speed, weight=0.0)
    np.testing.assert_allclose(-end.rate / speed, restitution, rtol=1e-12)


def test_a_load_holds_an_undamped_impedance_up_to_the_level():
    # p = b sin ωt + c (1 - cos ωt), b = v/ω, c = (1 - d)/ω²: zero where tan(ωt/2) = -b/c.
    end = contacts(Impedance(3.0, 0.0, 0.5), 2.0)
    np.testing.assert_allclose(end.rate, -2.0, rtol=1e-13)
    assert abs(end.penetration) < 1e-14
    expected = 2 * (np.pi - np.arctan2(2 / 3, 0.5 / 9)) / 3
    np.testing.assert_allclose(end.duration, expected, rtol=1e-13)


def test_a_contact_is_found_whatever_its_neighbours():
    law = HuntCrossley(np.array([1e2, 1e5, 1e8]), 0.1)
    together = contacts(law, [3.0, np.nan, 2.0], 0.5, 0.9)
    assert np.isnan(together.duration[1])
    for k in (0, 2):
        alone = contacts(law[k], [3.0, 0, 2.0][k], 0.5, 0.9)
        assert float(together.duration[k]) == pytest.approx(float(alone.duration), rel=1e-14)


def test_what_does_not_end_is_no_contact():
    # A ball put down slowly on a table at rest stays.
    assert np.isnan(contacts(HuntCrossley(100.0, 0.5), 0.01).duration)
    # No speed, no impact.
    assert np.all(np.isnan(contacts(Tsuji(100.0, 0.5), [0.0, -1.0]).duration))


class _Pulling(ContactLaw):
    name = "pulling"

    def force(self, penetration, rate):
        return -penetration


class _Sinking(ContactLaw):
    """Overdamped: a free ball takes an infinite time to return to the table's level."""

    name = "sinking"

    def force(self, penetration, rate):
        return penetration + 4 * rate


def test_what_a_law_cannot_do_is_said():
    with pytest.raises(ModelError, match="sinking: a free impact of speed 2 does not end"):
        free_impact(_Sinking(), 2.0)
    with pytest.raises(ModelError, match="pulling does not stop the ball"):
        contacts(_Pulling(), 1.0)
    for r in (0.95, 1.0):
        with pytest.raises(ModelError, match="pulling is given by its parameters, not by rest"):
            law_of_impact(_Pulling, r, 0.3, 1.0)
    for value in (0.0, -1.0, np.inf):
        with pytest.raises(ModelError, match=r"contact duration D = .* is not a finite number > 0"):
            law_of_impact(HuntCrossley, 0.65, value, 3.8)
