"""Permanent contact of any law against the closed form, and the motion at the threshold."""

from types import SimpleNamespace

import numpy as np
import pytest
from loaded_laws import Sharing
from scipy.integrate import solve_ivp

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.laws.elasto_backlash import ElastoBacklash
from bouncing_ball_beyond.models.laws.hertzian import HuntCrossley, KuwabaraKono, Tsuji
from bouncing_ball_beyond.models.laws.law_of_impact import law_of_impact
from bouncing_ball_beyond.models.laws.scales import rest
from bouncing_ball_beyond.models.laws.steady_contact import (
    _holds,
    _Steady,
    _touching,
    holds,
    known_threshold,
    permanent_contact,
)
from bouncing_ball_beyond.models.spring_damper import SpringDamper


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

        end = 10 * 2 * np.pi
        time = np.linspace(end - 2 * np.pi, end, 4001)
        rest = (1 / float(law.stiffness)) ** (2 / 3)
        start = np.repeat([rest, 0.0], lam.size)
        run = solve_ivp(rates, (0, end), start, "DOP853", time, rtol=1e-9, atol=1e-12)
        return np.min(law.grip(*run.y.reshape(2, lam.size, -1)), axis=1) / rest

    # The grip at its least grows as the distance from the threshold, some parts of rest.
    below, next_to, above = lowest(0.999, 0.9999, 1.001)
    assert below > max(above, 0)
    assert abs(next_to) < 2e-3
    # The steady contacts at these Λ agree with the threshold.
    held = [_holds(law, share * threshold) for share in (0.999, 1.001)]
    assert held == [True, False] == [holds(law, share * threshold) for share in (0.999, 1.001)]


# It touches the surface at Λ = 0.629, but only on the resonant branch.
@pytest.mark.long
def test_a_contact_on_a_resonant_branch_is_refused():
    with pytest.raises(ModelError, match="too weakly damped"):
        permanent_contact(law_of_impact(HuntCrossley, 0.95, 0.6, 3.0))


def test_contacts_that_are_weakly_damped_have_no_threshold():
    # Whether a contact is held at a given Λ is known without its threshold.
    law = Tsuji(1e9, 1e-3)
    assert np.isnan(known_threshold(law)) and holds(law, 0.5) and not holds(law, 1.5)


def test_a_stiff_contact_has_a_threshold_next_to_that_of_a_rigid_table():
    # Shooting over one period with an integrator of high order found the same digits. From a start
    # without the delay, or with twice as long a one, the iteration ends elsewhere.
    law = law_of_impact(HuntCrossley, 0.65, 0.03, 3.0)
    assert permanent_contact(law) == pytest.approx(0.999515842332, rel=1e-10)


# A soft contact of each kind of release, and a stiff one weekly.
@pytest.mark.parametrize(
    "law",
    [
        Tsuji(10, 0.3),
        KuwabaraKono(99, 0.1),
        pytest.param(HuntCrossley(4e3, 0.08), marks=pytest.mark.long),
    ],
)
def test_more_nodes_do_not_change_a_threshold(law, monkeypatch):
    found = permanent_contact(law)
    monkeypatch.setattr("bouncing_ball_beyond.models.laws.steady_contact._TOLERANCE", 1e-9)
    # The method is of the fourth order, so that the grid has little more than half the spacing.
    assert found == pytest.approx(permanent_contact(law), rel=1e-10)


def test_a_steady_contact_has_the_threshold_of_its_closed_form():
    law = ElastoBacklash(3.0, 0.5)
    found = _touching(law, False)
    assert found == pytest.approx(permanent_contact(law), rel=1e-10)


def test_the_grip_changes_at_the_rate_that_depth_speed_and_load_give_it():
    # The grip of this law depends on the load, which changes at the rate -Λ cos φ.
    law = Sharing(5.0, 0.2, 0.9, 0.45, width=0.1)
    steady = _Steady(law, rest(law))
    z = np.array([0.3, 0.7])
    first = np.array([0.8, 0.2])
    _, rate = steady.release(first, z)
    step = 1e-6
    moved = [first + sign * step * steady.rates(0.0, first, z) for sign in (1, -1)]
    after, before = (
        steady.grip(*steady.state(sign * step, y, z))
        for sign, y in zip((1, -1), moved, strict=True)
    )
    # Central differences of values of order one: the rounding 1e-16 over the step.
    assert rate == pytest.approx((after - before) / (2 * step), rel=1e-8)


def test_a_share_by_depth_touches_the_surface_at_its_threshold():
    # Far above the width it is d_min, with a spring of the share s = 1/2.
    flat = permanent_contact(Sharing(5.0, 0.2, 0.9, 0.45, width=1e9))
    assert flat == pytest.approx(permanent_contact(Sharing(2.5, 0.2, 0.45)), rel=1e-8)
    # The lowest point of a settled motion is the surface, where the share varies.
    law = Sharing(10.0, 0.2, 0.9, 0.45, width=0.02)
    lam = permanent_contact(law) * np.array([0.99, 1.0])

    def rates(t, state):
        p, u = state.reshape(2, -1)
        load = 1 - lam * np.sin(t)
        return np.concatenate([u, load - law.under(load).force(p, u)])

    end = 5 * 2 * np.pi
    time = np.linspace(end - 2 * np.pi, end, 2001)
    run = solve_ivp(rates, (0, end), [0.01] * 2 + [0.0] * 2, "LSODA", time, rtol=1e-9, atol=1e-12)
    depth, rate = run.y.reshape(2, 2, -1)
    grip = np.minimum(depth, law.under(1 - lam[:, np.newaxis] * np.sin(time)).grip(depth, rate))
    low = grip.min(axis=1) / 0.01
    # At the threshold the parabola's lowest point is within half a sample.
    assert low[0] > 1e-3 and abs(low[1]) < 1e-5


@pytest.mark.parametrize("law", [Tsuji(1e3, 0.3), SpringDamper(2e3, 0.05, "force")])
def test_the_rounding_that_is_allowed_is_a_share_of_the_grip_at_rest(law):
    """A ball that is pulled by a thousandth of the grip at rest is not held."""
    steady = _Steady(law, rest(law))
    at_rest = np.array(steady.unit), np.array(0.0)
    assert steady.grip(*at_rest, 1.0) == pytest.approx(1.0, rel=1e-14)
    pulled = SimpleNamespace(success=True, x=0.0, y=np.array([-1e-3, 0.0]))
    assert not steady.is_held(pulled, np.zeros(2))
