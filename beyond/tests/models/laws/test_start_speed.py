"""Laws whose damping is set by the speed at the start: energy, a second code, and derivatives."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from side_by_side import VELOCITY, checked_deviations

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.laws.collocation import contacts
from bouncing_ball_beyond.models.laws.law_of_impact import law_of_impact
from bouncing_ball_beyond.models.laws.start_speed import Flores, LankaraniNikravesh

KINDS = (LankaraniNikravesh, Flores)
STIFFNESS = 800.0


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("nominal", [0.95, 0.6, 0.3])
def test_restitution_is_that_of_the_energy_balance(kind, nominal):
    c = {
        LankaraniNikravesh: 3 * (1 - nominal**2) / 4,
        Flores: 8 * (1 - nominal) / (5 * nominal),
    }[kind]

    def balance(r):
        # ∫ u du/(1 + C u) over the way in and over the way out are equal.
        return c * (1 + r) - np.log((1 + c) / (1 - r * c))

    known = brentq(balance, 1e-9, min(1.0, 1 / c) - 1e-9, xtol=1e-15)
    found = bouncing_ball_beyond.contact_law(kind(STIFFNESS, nominal)).signature(
        np.array([0.01, 1.0, 30.0])
    )
    assert np.abs(found.restitution - known).max() < 1e-11


@pytest.mark.parametrize(("kind", "slope"), [(LankaraniNikravesh, 1.0), (Flores, 16 / 15)])
def test_losses_of_nearly_elastic_contacts(kind, slope):
    # For small c the loss is 1 - r = 2c/3, and c is 3(1 - e)/2 or 8(1 - e)/5.
    apart = []
    for gone in (0.02, 0.01):
        ball = bouncing_ball_beyond.contact_law(kind(STIFFNESS, 1 - gone))
        lost = 1 - float(ball.signature(2.0).restitution)
        apart.append(abs(lost / gone - slope))
    # The error of the ratio is of the order of 1 - e.
    assert apart[0] < 0.05 and abs(apart[0] / apart[1] - 2) < 0.1


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("speed", [0.3, 3.0])
def test_contacts_are_those_of_a_second_code(kind, speed):
    law = kind(STIFFNESS, 0.7)
    lam, phase = 1.3, 0.4
    c = float(law.factor)

    def rates(t, y):
        p = max(y[0], 0.0)
        force = STIFFNESS * p**1.5 * (1 + c * y[1] / speed)
        return [y[1], 1 - lam * np.sin(phase + t) - force]

    def ends(t, y):
        return y[0]

    ends.terminal = True
    ends.direction = -1
    known = solve_ivp(
        rates, (0, 9), [0.0, speed], events=ends, rtol=1e-12, atol=1e-14, method="DOP853"
    )
    dynamics = bouncing_ball_beyond.contact_law(law).dynamics(lam)
    found = dynamics.depart(dynamics.start(np.array([phase]), np.array([-speed])))
    # The integrator loses its order at p = 0.
    assert abs(found.duration[0] - known.t_events[0][0]) < 1e-8
    assert abs(found.flight.velocity[0] + known.y_events[0][0][1]) < 1e-8


@pytest.mark.parametrize("kind", KINDS)
def test_a_deviation_grows_as_side_by_side_balls_do(kind):
    ball = bouncing_ball_beyond.contact_law(kind(STIFFNESS, 0.6))
    dynamics = ball.dynamics(1.7)
    start, leg, found = checked_deviations(dynamics)
    determinant = dynamics.contraction(start, leg.departure)[0] * VELOCITY / leg.after.velocity[0]
    assert abs(found - determinant) < 1e-11 * (1 + abs(determinant))


@pytest.mark.parametrize("kind", KINDS)
def test_orbits_are_where_balls_end(kind):
    ball = bouncing_ball_beyond.contact_law(kind(2000.0, 0.6))
    one = bouncing_ball_beyond.orbit(ball, amplitude=1.0)
    assert one.is_stable() and one.is_admissible()
    assert abs(one.trace_and_determinant()[1] - np.linalg.det(one.monodromy())) < 1e-12
    ended = bouncing_ball_beyond.orbit_of_motion(
        ball, amplitude=1.0, phase=one.phase + 0.01, velocity=one.impact_velocity
    )
    assert one.distance(ended) < 1e-6


@pytest.mark.parametrize("kind", KINDS)
def test_law_of_a_free_impact(kind):
    law = law_of_impact(kind, 0.8, 0.1, 3.0)
    found = bouncing_ball_beyond.contact_law(law).signature(3.0)
    assert abs(found.restitution - 0.8) < 1e-12 and abs(found.duration - 0.1) < 1e-12


def test_refusals():
    with pytest.raises(ModelError, match="nominal restitution e"):
        Flores(100.0, 0.0)
    # Lankarani and Nikravesh have c < 3/4.
    with pytest.raises(ModelError, match="too small"):
        law_of_impact(LankaraniNikravesh, 0.3, 0.1, 3.0)


@pytest.mark.parametrize("kind", KINDS)
def test_a_contact_without_a_start_leaves_the_others_of_its_row_as_they_are(kind):
    law = kind(100.0, 0.8)
    alone = float(contacts(law, 1.0).duration)
    assert contacts(law, [1.0, -1.0, np.nan]).duration == pytest.approx(
        [alone, np.nan, np.nan], rel=1e-14, nan_ok=True
    )
