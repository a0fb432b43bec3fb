"""Permanent contact of any law against the closed form, and the motion at the threshold."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from bouncing_ball.contacts.law_choice import law_of_impact
from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley
from bouncing_ball.contacts.laws.kuwabara_kono import KuwabaraKono
from bouncing_ball.contacts.laws.tsuji import Tsuji
from bouncing_ball.contacts.permanent_contact import permanent_contact
from bouncing_ball.errors import ModelError


@pytest.mark.parametrize("kind", [HuntCrossley, Tsuji, KuwabaraKono])
def test_a_contact_below_the_threshold_is_held_and_above_it_is_not(kind):
    law = law_of_impact(kind, 0.65, 0.6, 3.8)
    threshold = permanent_contact(law)

    def lowest(*shares):
        """The smallest grip in the last period of settled motions, at shares of the threshold."""
        lam = threshold * np.array(shares)

        def rates(t, state):
            p, u = state.reshape(2, -1)
            force = law.force(np.maximum(p, 1e-300), u)
            return np.concatenate([u, 1 - lam * np.sin(t) - force])

        end = 40 * 2 * np.pi
        time = np.linspace(end - 2 * np.pi, end, 4001)
        rest = (1 / float(law.stiffness)) ** (2 / 3)
        start = np.repeat([rest, 0.0], lam.size)
        run = solve_ivp(rates, (0, end), start, "DOP853", time, rtol=1e-9, atol=1e-12)
        return np.min(law.grip(*run.y.reshape(2, lam.size, -1)), axis=1) / rest

    # The grip at its least grows as the distance from the threshold, some parts of rest.
    below, next_to, above = lowest(0.999, 0.9999, 1.001)
    assert below > max(above, 0)
    assert abs(next_to) < 2e-3


def test_it_tends_to_gravity_for_a_hard_contact():
    soft, hard = (
        permanent_contact(law_of_impact(KuwabaraKono, 0.65, duration, 3.8))
        for duration in (0.4, 0.2)
    )
    assert 1 - hard < (1 - soft) / 2


def test_a_contact_that_rings_is_refused():
    with pytest.raises(ModelError, match="weakly damped, it rings"):
        permanent_contact(Tsuji(1e9, 1e-3))


@pytest.mark.parametrize("law", [Tsuji(10.0, 0.3), Tsuji(100.0, 0.03), KuwabaraKono(1e3, 0.03)])
def test_more_nodes_change_nothing(law, monkeypatch):
    found = permanent_contact(law)
    monkeypatch.setattr("bouncing_ball.contacts.permanent_contact._LEVELS", (192,))
    # The square of what is left of the path, 1e-5, would be 1e-10.
    assert found == pytest.approx(permanent_contact(law), rel=5e-12)
