"""The error law for tables of any waveform, by an integrator and Newton's method of this file.

Nothing of the library is used. The contact is the linear one, which ends at δ = 0.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

R = 0.65
ZETA = -np.log(R) / np.hypot(np.pi, np.log(R))
SPEED = 2 * np.pi / (1 + R)
C = SPEED - np.pi
# Duration, delay of the centroid and load coefficient of a free impact at ϖ = 1.
DURATION = np.pi / np.sqrt(1 - ZETA**2)
CENTROID = R * DURATION / (1 + R)
SHIFT = ((1 - R) * DURATION - 2 * ZETA * (1 + R)) / (1 + R)
HARMONICS = {
    "sine": [(1, 1.0, 0.0)],
    "three harmonics": [(1, 1.0, 0.0), (2, 0.17, 0.8), (3, 0.05, -1.1)],
}


class Table:
    """ΛW(τ) with a sum W of harmonics a sin(kτ + p), and the place of its steepest rise."""

    def __init__(self, name):
        self.harmonics = HARMONICS[name]
        grid = np.linspace(-np.pi, np.pi, 361)
        start = grid[np.argmax(self.at(grid, 1))]
        self.steepest = brentq(lambda t: self.at(t, 2), start - 0.1, start + 0.1, xtol=1e-14)
        self.largest = self.at(self.steepest, 1)

    def at(self, time, order=0):
        return sum(
            a * k**order * np.sin(k * time + p + order * np.pi / 2) for k, a, p in self.harmonics
        )

    def with_slope(self, slope):
        """The phase after the steepest one at which W′ has a given value."""
        places = self.steepest, self.steepest + 1
        return brentq(lambda t: self.at(t, 1) - slope, *places, xtol=1e-15)


def contact(table, phase, u, amplitude, ratio):
    """Duration and relative speed at the end, by an integration of ϖδ over ϖτ."""

    def rates(s, state):
        load = 1 + amplitude * table.at(phase + s / ratio, 2)
        return [state[1], -2 * ZETA * state[1] - state[0] - load / ratio]

    def released(s, state):
        return state[0]

    released.direction = 1
    released.terminal = True
    options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13}
    end = solve_ivp(rates, (0, 5), [0.0, -u], events=released, **options)
    return end.t_events[0][0] / ratio, end.y_events[0][0, 1]


def orbit(table, phase, ratio):
    """Λ and the greatest height of the orbit that touches at a phase, by Newton's method."""

    def residuals(unknowns):
        amplitude, u = unknowns
        duration, w = contact(table, phase, u, amplitude, ratio)
        bounce = w + amplitude * table.at(phase + duration, 1)
        flight = 2 * np.pi - duration
        leaves = amplitude * table.at(phase + duration)
        landing = leaves + bounce * flight - flight**2 / 2 - amplitude * table.at(phase)
        speed = bounce - flight + u - amplitude * table.at(phase, 1)
        return np.array([landing, speed]), leaves + bounce**2 / 2

    unknowns = np.array([C / table.at(phase, 1), SPEED])
    value, _ = residuals(unknowns)
    # The differences are good enough for all steps, which gain three digits each.
    steps = 1e-4 * np.eye(2)
    matrix = np.array([(residuals(unknowns + step)[0] - value) / 1e-4 for step in steps]).T
    for _ in range(6):
        unknowns = unknowns - np.linalg.solve(matrix, value)
        value, height = residuals(unknowns)
    assert np.abs(value).max() < 1e-11
    return unknowns[0], height


def remainders(table, phase, ratio):
    """What the law leaves of the phase and of the height of an orbit."""
    amplitude, height = orbit(table, phase, ratio)
    turned = table.with_slope((C - SHIFT / ratio) / amplitude)
    instant = turned - SHIFT / ratio
    by_law = amplitude * table.at(instant) - SPEED * CENTROID / ratio + np.pi**2 / 2
    return np.array([phase - (instant - CENTROID / ratio), height - by_law])


def saddle_node(table, ratio):
    """The least Λ, from a parabola through three orbits around it, which lie near in √γ."""
    middle = table.steepest - (SHIFT + CENTROID) / ratio
    places = np.array([-0.003, 0.0, 0.003])
    bend, slope, least = np.polyfit(places, [orbit(table, middle + x, ratio)[0] for x in places], 2)
    return least - slope**2 / (4 * bend)


@pytest.mark.parametrize("name", HARMONICS)
def test_remainders_are_of_second_order(name):
    """Times ϖ² they tend to constants: as ϖ doubles, their distance from the limit halves."""
    table = Table(name)
    scaled = [
        ratio**2 * remainders(table, table.steepest + 0.2, ratio) for ratio in (100, 200, 400)
    ]
    assert np.abs(scaled[2]).min() > 0.1
    assert (scaled[1] - scaled[0]) / (scaled[2] - scaled[1]) == pytest.approx([2, 2], rel=0.15)


@pytest.mark.parametrize("name", HARMONICS)
def test_at_the_saddle_node_they_are_of_order_three_halves(name):
    """Where max w′ = C, times ϖ^1.5 they tend to a constant, with a rest of the order ϖ^-1/2."""
    table = Table(name)
    amplitude = C / table.largest
    scaled = []
    for ratio in (100, 400, 1600):
        high = table.steepest + 2 / np.sqrt(ratio)
        low = table.steepest + 0.2 / np.sqrt(ratio)

        def excess(phase, ratio=ratio):
            return orbit(table, phase, ratio)[0] - amplitude

        phase = brentq(excess, low, high, xtol=1e-9)
        scaled.append(ratio**1.5 * remainders(table, phase, ratio)[0])
    first, second = np.diff(scaled)
    assert 0.1 < abs(scaled[2]) < 1
    assert 1.5 < first / second < 2.8


def test_the_saddle_node_is_shifted_as_for_a_sine():
    """ϖ times the relative shift of max w′, exactly and by the law, -s/C."""
    table = Table("three harmonics")
    shift = 1e3 * (saddle_node(table, 1e3) * table.largest / C - 1)
    assert shift == pytest.approx(-0.60124, abs=5e-6)
    assert -SHIFT / C == pytest.approx(-0.60164, abs=5e-6)
