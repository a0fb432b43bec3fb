"""Both theorems of the article for tables of any waveform, by an integrator of this file.

Nothing of the library is used. The contact ends at δ = 0; it is the linear one if nothing else is
said.
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


def linear(depth, rate):
    """The force of the linear contact by the scaled penetration and its rate."""
    return depth + 2 * ZETA * rate


def contact(table, phase, u, amplitude, ratio, force=linear):
    """Duration and relative speed at the end, by an integration of ϖδ over ϖτ."""

    def rates(s, state):
        load = 1 + amplitude * table.at(phase + s / ratio, 2)
        return [state[1], force(-state[0], -state[1]) - load / ratio]

    def released(s, state):
        return state[0]

    released.direction = 1
    released.terminal = True
    options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13}
    end = solve_ivp(rates, (0, 5), [0.0, -u], events=released, **options)
    return end.t_events[0][0] / ratio, end.y_events[0][0, 1]


def orbit(table, phase, ratio, force=linear):
    """Λ and the greatest height of the orbit that touches at a phase, by Newton's method."""

    def residuals(unknowns):
        amplitude, u = unknowns
        duration, w = contact(table, phase, u, amplitude, ratio, force)
        bounce = w + amplitude * table.at(phase + duration, 1)
        flight = 2 * np.pi - duration
        leaves = amplitude * table.at(phase + duration)
        landing = leaves + bounce * flight - flight**2 / 2 - amplitude * table.at(phase)
        speed = bounce - flight + u - amplitude * table.at(phase, 1)
        return np.array([landing, speed]), leaves + bounce**2 / 2

    unknowns = np.array([C / table.at(phase, 1), SPEED])
    value, _ = residuals(unknowns)
    # The differences are good enough for all steps, which gain two digits each or more.
    steps = 1e-4 * np.eye(2)
    matrix = np.array([(residuals(unknowns + step)[0] - value) / 1e-4 for step in steps]).T
    for _ in range(8):
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


# The theorem on the instant, and Eq. 6


def landing(table, leaves, height, velocity, amplitude):
    """Phase and closing speed of the landing of a flight that leaves the table."""

    def gap(t):
        return height + velocity * t - t**2 / 2 - amplitude * table.at(leaves + t)

    times = np.linspace(0.5, 30, 3001)
    gaps = gap(times)
    first = np.flatnonzero((gaps[:-1] > 0) & (gaps[1:] <= 0))[0]
    time = brentq(gap, times[first], times[first + 1], xtol=1e-14)
    return np.array([leaves + time, amplitude * table.at(leaves + time, 1) - velocity + time])


def release(table, touch, amplitude, ratio):
    """Time, height and velocity at the end of the contact after a touch."""
    phase, u = touch
    duration, w = contact(table, phase, u, amplitude, ratio)
    leaves = phase + duration
    return leaves, amplitude * table.at(leaves), w + amplitude * table.at(leaves, 1)


def on_contact(table, touch, amplitude, ratio):
    """The return map of the contact."""
    return landing(table, *release(table, touch, amplitude, ratio), amplitude)


def in_corrected_model(table, touch, amplitude, ratio):
    """The return map of the corrected model from touch to touch."""
    phase, u = touch
    start = amplitude * table.at(phase)
    velocity = amplitude * table.at(phase, 1) - u
    delay = CENTROID / ratio

    def fall(t):
        return start + velocity * t - t**2 / 2

    def speed(t):
        return amplitude * table.at(phase + t, 1) - velocity + t

    def excess(t):
        return amplitude * table.at(phase + t) - fall(t) - speed(t) * delay

    t = brentq(excess, 0, 3 * delay, xtol=1e-16)
    load = 1 + amplitude * table.at(phase + t, 2)
    impulse = (1 + R) * speed(t) + SHIFT * (1 + R) / ratio * load
    return landing(table, phase + t, fall(t), velocity - t + impulse, amplitude)


def derivative(function, place, step=1e-4):
    """The Jacobian by central differences, with errors of some 1e-8 of the step's square."""
    moved = [(function(place + h) - function(place - h)) / (2 * step) for h in step * np.eye(2)]
    return np.transpose(moved)


@pytest.mark.parametrize("touch", [(0.3, 4.0), (-0.7, 3.5), (1.5, 5.0)])
def test_return_maps_differ_by_second_order_in_c1(touch):
    """Times ϖ² the differences of the maps and of their derivatives tend to constants."""
    table = Table("three harmonics")
    scaled = []
    for ratio in (100, 200, 400):

        def apart(place, ratio=ratio):
            maps = (on_contact, in_corrected_model)
            contact_map, corrected = (return_map(table, place, 1.1, ratio) for return_map in maps)
            return contact_map - corrected

        place = np.array(touch)
        both = np.append(apart(place), derivative(apart, place))
        scaled.append(ratio**2 * both)
    # What is left is of the order 1/ϖ, which halves; the largest constant is 10.
    first, second = np.diff(scaled, axis=0)
    assert np.abs(scaled[-1]).max() < 12
    np.testing.assert_allclose(first, 2 * second, atol=0.03 + 0.1 * np.abs(first).max())


def test_one_less_trace_plus_determinant_is_the_slope_of_the_balance():
    """1 - tr + det = -(2πn/u) ∂(v, ψ)/∂(u, φ) B′(ψ) on an orbit, at a compliant contact."""
    table = Table("three harmonics")
    ratio = 12.0
    phase = table.steepest + 0.1
    amplitude, _ = orbit(table, phase, ratio)
    velocity = SPEED

    def closing(place):
        return on_contact(table, place, amplitude, ratio)

    # The orbit: the speed at which the ball lands with the same speed a period later.
    velocity = brentq(lambda u: closing([phase, u])[1] - u, SPEED - 0.8, SPEED + 0.8, xtol=1e-13)
    place = np.array([phase, velocity])
    assert closing(place) == pytest.approx(place + np.array([2 * np.pi, 0]), abs=1e-8)

    def instant(place):
        """ψ and v, and the impulse, from both flights continued to where they meet."""
        start = amplitude * table.at(place[0])
        falls = amplitude * table.at(place[0], 1) - place[1]
        leaves, height, rises = release(table, place, amplitude, ratio)
        duration = leaves - place[0]
        impulse = rises - falls + duration
        before = start + falls * duration - duration**2 / 2
        time = duration - (height - before) / impulse
        return np.array([place[0] + time, amplitude * table.at(place[0] + time, 1) - falls + time])

    def impulse(place):
        leaves, _, rises = release(table, place, amplitude, ratio)
        falls = amplitude * table.at(place[0], 1) - place[1]
        return np.array([rises - falls + leaves - place[0]])

    map_slope = derivative(closing, place)
    to_instant = derivative(instant, place)
    by_psi, by_v = (derivative(impulse, place) @ np.linalg.inv(to_instant))[0]
    psi, _ = instant(place)
    slope = by_psi + by_v * amplitude * table.at(psi, 2)
    expected = -2 * np.pi / velocity * np.linalg.det(to_instant) * slope
    characteristic = 1 - np.trace(map_slope) + np.linalg.det(map_slope)
    assert abs(expected) > 0.1
    assert characteristic == pytest.approx(expected, abs=1e-5)


# What a phase tells


def hertzian(depth, rate):
    """A Hertz contact after Hunt and Crossley, whose r falls with the speed."""
    return 2.0 * np.maximum(depth, 0) ** 1.5 * (1 + 0.12 * rate)


def free_impact(force, speed, load=0.0):
    """Duration, r, delay and impulse of an impact under a constant load, in units of 1/ϖ."""

    def rates(s, state):
        return [state[1], force(-state[0], -state[1]) - load]

    def released(s, state):
        return state[0]

    released.direction = 1
    released.terminal = True
    options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13}
    end = solve_ivp(rates, (0, 9), [0.0, -speed], events=released, **options)
    duration = end.t_events[0][0]
    leaves = end.y_events[0][0, 1]
    impulse = leaves + speed + load * duration
    delay = duration - (speed * duration + load * duration**2 / 2) / impulse
    return duration, leaves / speed, delay, impulse


@pytest.mark.parametrize(("force", "within"), [(linear, 0.002), (hertzian, 0.005)])
def test_touches_tell_the_angle_the_restitution_and_the_duration(force, within):
    """From four phases on a sine: θ, r and D of contacts that last 2 % of the period."""
    speed = brentq(lambda v: (1 + free_impact(force, v)[1]) * v - 2 * np.pi, 2.5, 6, xtol=1e-12)
    duration, r, delay, _ = free_impact(force, speed)
    h = 1e-4
    leaving = [free_impact(force, v)[1] * v for v in (speed - h, speed + h)]
    slope = (leaving[1] - leaving[0]) / (2 * h)
    by_load = [free_impact(force, speed, a)[3] for a in (-h, h)]
    at_touch = (by_load[1] - by_load[0]) / (2 * h)
    shift = (at_touch - delay * (1 + slope)) / (1 + slope)
    ratio = duration / (0.02 * 2 * np.pi)
    touches = np.array([0.3, 0.45, 0.6, 0.75])
    amplitudes = np.array([orbit(Table("sine"), phase, ratio, force)[0] for phase in touches])
    tangent, start = np.polyfit(amplitudes * np.sin(touches), amplitudes * np.cos(touches), 1)
    angle = np.arctan(tangent)
    level = start * np.cos(angle)
    assert ratio * angle == pytest.approx(shift + delay, rel=within)
    assert level == pytest.approx(speed - np.pi - shift / ratio, abs=5e-4)

    # r and D are those of the linear contact with this level and angle.
    def linear_with(r):
        zeta = -np.log(r) / np.hypot(np.pi, np.log(r))
        lasts = np.pi / np.sqrt(1 - zeta**2)
        share = (1 - r) / (1 + r) * lasts - 2 * zeta
        scale = angle / (share + r * lasts / (1 + r))
        return np.pi * (1 - r) / (1 + r) - share * scale, lasts * scale

    restitution = brentq(lambda r: linear_with(r)[0] - level, 0.1, 0.99, xtol=1e-12)
    assert restitution == pytest.approx(r, abs=0.003)

    assert ratio * linear_with(restitution)[1] == pytest.approx(duration, rel=0.03)
