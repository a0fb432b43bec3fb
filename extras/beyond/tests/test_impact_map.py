"""The map of contacts against their integration."""

import numpy as np
import pytest

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.motions import long_term
from bouncing_ball_beyond.motions.bounces import Balls
from bouncing_ball_beyond.motions.impact_map import impact_map
from bouncing_ball_beyond.tables.table import SINE, Table

BALLS = {
    "Tsuji": (bb.tsuji(restitution=0.8, duration=0.03, speed=4.0), SINE),
    "Kuwabara and Kono": (bb.kuwabara_kono(restitution=0.7, duration=0.1, speed=4.0), SINE),
    "a damper that never pulls": (
        bb.linear(restitution=0.5, duration=0.03, speed=4.0, release="force"),
        SINE,
    ),
    "a kink": (
        bb.linear(restitution=0.5, duration=0.03, speed=4.0, release="approach"),
        SINE,
    ),
    "two frequencies": (
        bb.hunt_crossley(restitution=0.5, duration=0.03, speed=4.0),
        Table([(1, 1.0, 0.0), (3, 0.05, -1.1)]),
    ),
}


@pytest.fixture(scope="module", params=BALLS)
def case(request):
    """A map, and points on each piece of it, with more at speeds above and below."""
    ball, table = BALLS[request.param]
    contact_map = impact_map(ball, 1.2, table, 8.0)
    rng = np.random.default_rng(5)
    octave = rng.uniform(-0.5, len(contact_map.pieces) + 0.5, 200)
    return contact_map, rng.uniform(-np.pi, np.pi, 200), 8.0 * 2**-octave


def test_contacts_are_those_of_the_integration(case):
    contact_map, tau, u = case
    assert len(contact_map.pieces) >= 3
    scaled_duration, duration, gap, speed = np.array(contact_map.leaves(tau, u))
    expected = contact_map.ball.leaves(tau, u, 1.2, contact_map.table)
    # Rounding of integrations, which is some hundred times that of numbers.
    assert np.allclose(scaled_duration, expected[0], rtol=2e-13)
    assert np.allclose(duration, expected[1], rtol=2e-13)
    assert np.all(np.abs(gap - expected[2]) <= 1e-12 * duration * u)
    assert np.all(np.abs(speed - expected[3]) <= 1e-12 * u)


def test_slopes_are_those_of_the_integration(case):
    contact_map, tau, u = case
    T, *_ = contact_map.leaves(tau, u)
    slopes = contact_map.end_slopes(tau, u, T)
    expected = contact_map.ball.end_slopes(tau, u, T, 1.2, contact_map.table)
    # Differentiation of a polynomial of degree n multiplies rounding by up to n².
    allowed = 15**2 * 1e-13 * np.maximum(np.abs(expected).max(axis=2, keepdims=True), 1.0)
    assert np.all(np.abs(slopes - expected) <= allowed)
    assert u.min() < contact_map.top / 2 ** len(contact_map.pieces)


def test_slow_impacts_and_soft_contacts_are_integrated():
    soft = impact_map(bb.tsuji(restitution=0.5, duration=3.0, speed=4.0), 1.2, SINE, 4.0)
    assert soft.pieces == ()


def test_basins_are_those_of_the_integration(monkeypatch):
    ball, table = BALLS["Tsuji"]
    given = {"amplitude": 0.9, "starts": 6, "impacts": 300, "relative_velocity_max": 9.0}
    monkeypatch.setattr(long_term, "WORTH_A_MAP", 1)
    by_map = bb.basins(ball, **given, table=table)
    monkeypatch.setattr(long_term, "WORTH_A_MAP", np.inf)
    expected = bb.basins(ball, **given, table=table)
    ends = ["end_phase", "end_velocity"]
    assert by_map.drop_vars(ends).identical(expected.drop_vars(ends))
    # The motions repeat to within NEAR.
    assert np.allclose(by_map.end_velocity, expected.end_velocity, atol=1e-6, equal_nan=True)


def test_when_a_map_saves_time():
    tau = np.zeros(100)
    spring = bb.SpringDamper(20.0, restitution=0.5)
    several = bb.tsuji(stiffness=np.full(100, 1e4), damping=np.full(100, 0.1))
    one = BALLS["Tsuji"][0]
    rows = [Balls(ball, tau + 1.2, tau, tau, tau + 1.0) for ball in (spring, several, one)]
    assert [long_term.is_worth_a_map(row, 2000, 0) for row in rows] == [False, False, True]
    assert not long_term.is_worth_a_map(Balls(one, tau + np.arange(100), tau, tau, tau), 2000, 0)
    assert [long_term.is_worth_a_map(rows[-1], 100, seen) for seen in (0, 100)] == [False, True]
