"""Flights in air, beside an integration of v′ = -g - D v |v|."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from bouncing_ball_contacts.fits import fit
from bouncing_ball_contacts.flights import drag_of, heights_of, impact_of, speeds_of
from bouncing_ball_contacts.units import STANDARD_GRAVITY as G

# 1/m: none, a tennis ball, one of table tennis, more than a beach ball.
DRAGS = [0.0, 0.017, 0.13, 0.4]


def falls(drag, start, speed):
    """Integrate from a height at a speed upwards to the ground."""

    def touch(t, state):
        return state[0] if t > 1e-6 else 1.0

    touch.terminal = True
    touch.direction = -1
    return solve_ivp(
        lambda _, state: [state[1], -G - drag * state[1] * abs(state[1])],
        (0, 10),
        [start, speed],
        events=touch,
        rtol=1e-11,
        atol=1e-12,
        dense_output=True,
    )


def bounces(drag, restitution, height, until):
    """Return the impact times, and the positions at times, of a ball that is dropped."""
    t = np.arange(0, until, 1 / 60)
    y = np.full(len(t), np.nan)
    begin = 0.0
    speed = 0.0
    impacts = []
    while begin < until:
        flight = falls(drag, height, speed)
        during = (t >= begin) & (t < begin + flight.t[-1])
        y[during] = flight.sol(t[during] - begin)[0]
        begin += flight.t[-1]
        impacts.append(begin)
        height = 0.0
        speed = -restitution * flight.y[1, -1]
    return np.array(impacts), t, y


@pytest.mark.parametrize("drag", DRAGS)
def test_a_flight_lasts_rises_and_lands_as_an_integrated_one(drag):
    flight = falls(drag, 0.0, 4.0)
    height = heights_of(flight.t[-1:], drag)
    down, up = speeds_of(height, drag)
    # The event and the integration have errors of about 1e-10.
    assert up == pytest.approx(4.0, rel=1e-8)
    assert down == pytest.approx(-flight.y[1, -1], rel=1e-8)


@pytest.mark.parametrize("drag", DRAGS)
def test_an_impact_of_a_track_has_the_speeds_of_the_integrated_one(drag):
    """Also the first one, before which the ball only falls."""
    impacts, t, y = bounces(drag, 0.85, 1.5, 2.0)
    edges = [-1.0, *impacts]
    for first, at, last in zip(edges, impacts, edges[2:], strict=False):
        near = (t > first) & (t < last)
        track = np.column_stack([t[near], 100 * y[near], t[near] > at])
        down, up, gravity, misfit, time, floor = impact_of(track, drag)
        assert time == pytest.approx(at, abs=1e-6) and abs(floor) < 1e-3
        assert up / down == pytest.approx(0.85, abs=1e-6)
        assert gravity == pytest.approx(100 * G, rel=1e-6)
        assert misfit < 1e-4


def test_the_drag_is_removed_from_a_track(tmp_path):
    """Parabolas alone gave 0.848 for 0.88."""
    drag = drag_of(2.7e-3, 0.04)
    _, t, y = bounces(drag, 0.88, 0.8, 3.0)
    columns = {"time (s)": t, "y (m)": y}
    found = fit(columns, mass="2.7 g", diameter="40 mm")
    assert found.restitution == pytest.approx(0.88, abs=1e-4)
    assert any("the drag of the air is removed" in note for note in found.notes)
    plain = fit(columns)
    assert plain.restitution < 0.86
    assert any("the drag of the air is not removed" in note for note in plain.notes)
