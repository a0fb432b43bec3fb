"""The reference numbers of bounces: against an independent integration."""

import math

import pytest
from scipy.integrate import solve_ivp

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_contacts.documents.certified_bounces import enclosed_rebounds, hard, rounded_ball

G = 9.81


def integrated(rule, k, c, height):
    """Duration of the contact and height of the rebound of a ball of 1 kg, with scipy's steps."""

    def force(x, rate):
        if rule == "approach":
            rate = max(rate, 0.0)
        return k * x + c * rate

    def end(_, state):
        return force(*state) if rule == "force" else state[0]

    def turn(_, state):
        return state[1]

    end.terminal = turn.terminal = True
    end.direction = turn.direction = -1
    time = 0.0
    state = [0.0, math.sqrt(2 * G * height)]
    for event in (turn, end):
        run = solve_ivp(
            lambda _, s: [s[1], G - force(*s)], (0, 1), state, events=event,
            method="DOP853", rtol=1e-13, atol=1e-15,
        )  # fmt: skip
        time += run.t[-1]
        state = run.y[:, -1]
    return time, state[1] ** 2 / (2 * G) - state[0]


@pytest.mark.parametrize("rule", [str(rule) for rule in Release])
@pytest.mark.parametrize(("k", "c"), [("1e4", "20"), ("1e4", "60"), ("1e6", "200")])
def test_certified_bounces_are_those_of_an_integration(rule, k, c):
    height = 1.0
    for bounce in enclosed_rebounds(rule, ("1", k, c), "1", "9.81", 3):
        duration, rise = integrated(rule, float(k), float(c), height)
        assert float(bounce.release - bounce.impact) == pytest.approx(duration, abs=1e-12)
        assert float(bounce.height) == pytest.approx(rise, rel=1e-10)
        assert float(bounce.top - bounce.release) == pytest.approx(
            math.sqrt(2 * (rise + (duration_depth(rule, k, c, bounce))) / G), rel=1e-9
        )
        height = rise


def duration_depth(rule, k, c, bounce):
    """How deep the ball is where the force vanishes: c/k times its speed, from its rise."""
    if rule != "force":
        return 0.0
    lag = float(c) / float(k)
    # u²/(2g) - lag u = rise
    rise = float(bounce.height)
    u = G * (lag + math.sqrt(lag * lag + 2 * rise / G))
    return u * u / (2 * G) - rise


def test_a_ball_that_does_not_leave_has_no_certificate():
    with pytest.raises(ModelError, match="does not leave"):
        list(enclosed_rebounds("displacement", ("1", "1e4", "60"), "0.00001", "9.81", 1))


def test_a_hard_ball_loses_the_square_of_r():
    first, second = hard("0.5", "2", "9.81", 2)
    assert (rounded_ball(first.height, 3), rounded_ball(second.height, 3)) == ("0.500", "0.125")
    assert float(second.impact - first.impact) == pytest.approx(2 * math.sqrt(2 * 0.5 / G))
