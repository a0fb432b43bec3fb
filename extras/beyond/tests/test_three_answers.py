"""Whether a linear contact bounces, is stable and bounces as high, by a code that shares nothing.

Contacts and flights are the closed solutions of δ″ + 2ζϖδ′ + ϖ²δ = -1 + Λ sin τ and of δ″ = -1 +
Λ sin τ, and their ends are bracketed. Multipliers are eigenvalues of differences.
"""

import numpy as np
import pytest
from scipy.optimize import brentq, root

from bouncing_ball_beyond import SpringDamper, free_impact, law_errors, limits, orbit


def contact(start, speed, zeta, ratio, table):
    """δ and δ′ as a function of the time since a touch at δ = 0 with δ′ = -speed."""
    response = table / (ratio**2 - 1 + 2j * zeta * ratio)

    def steady(t):
        turning = response * np.exp(1j * (start + t))
        return turning.imag - 1 / ratio**2, turning.real

    decay = zeta * ratio
    beat = ratio * np.sqrt(1 - zeta**2)
    away, rate = steady(0.0)
    cosine = -away
    sine = (-speed - rate + decay * cosine) / beat

    def at(t):
        gap, slope = steady(t)
        wave = cosine * np.cos(beat * t) + sine * np.sin(beat * t)
        change = beat * (sine * np.cos(beat * t) - cosine * np.sin(beat * t))
        fading = np.exp(-decay * t)
        return gap + fading * wave, slope + fading * (change - decay * wave)

    return at


def bounce(start, speed, zeta, ratio, table, periods):
    """The next touch, periods later, and its speed; and the greatest height of the flight."""
    at = contact(start, speed, zeta, ratio, table)
    lasts = np.pi / (ratio * np.sqrt(1 - zeta**2))
    ends = brentq(lambda t: at(t)[0], 0.5 * lasts, 1.5 * lasts, xtol=1e-15, rtol=1e-15)
    leaves = start + ends
    velocity = at(ends)[1] + table * np.cos(leaves)

    def gap(t):
        return table * np.sin(leaves) + (velocity - t / 2) * t - table * np.sin(leaves + t)

    middle = 2 * np.pi * periods
    lands = brentq(gap, 0.6 * middle, 1.4 * middle, xtol=1e-14, rtol=1e-15)
    arrives = table * np.cos(leaves + lands) - velocity + lands
    return np.array([leaves + lands - middle, arrives]), table * np.sin(leaves) + velocity**2 / 2


def orbit_of(r, n, ratio, table, phase):
    """Phase and speed of the orbit with one impact, its greatest height and its multipliers."""
    # By Eq. 16: the speed decays by r in half an oscillation.
    zeta = -np.log(r) / np.hypot(np.pi, np.log(r))
    known = zeta, ratio, table, n
    start = [phase, 2 * n * np.pi / (1 + r)]
    touch = root(lambda x: bounce(*x, *known)[0] - x, start, tol=1e-13).x
    steps = 1e-5 * np.eye(2)
    after = [(bounce(*(touch + h), *known)[0] - bounce(*(touch - h), *known)[0]) for h in steps]
    return touch, bounce(*touch, *known)[1], np.linalg.eigvals(np.array(after).T / 2e-5)


def test_a_contact_bounces_below_the_saddle_node_of_the_restitution_model():
    line = np.pi * 0.35 / 1.65
    table = 0.664394
    assert table < line
    touch, _, multipliers = orbit_of(0.65, 1, 100.0, table, 0.04)
    assert np.abs(multipliers).max() < 1
    periodic_orbit = orbit(SpringDamper(100.0, restitution=0.65), amplitude=table)
    assert periodic_orbit.phase == pytest.approx(touch[0], abs=1e-9)
    assert periodic_orbit.stable and periodic_orbit.admissible
    # The width of this window is s/C, at any ϖ.
    errors = []
    for ratio in (1e3, 1e4):
        ball = SpringDamper(ratio, restitution=0.65)
        exact = limits(ball).saddle_node.amplitude / line - 1
        errors.append(ratio**2 * (exact - law_errors(ball, amplitude=1.0)["saddle_node"]))
    assert errors[1] == pytest.approx(errors[0], rel=0.01)


def test_a_height_is_right_where_the_contact_has_doubled():
    n, r, ratio = 3, 0.2, 100 / 3
    line = n * np.pi * (1 - r) / (1 + r)
    doubling = np.hypot(line, 2 * (1 + r**2) / (1 + r) ** 2)
    table = line + 0.8 * (doubling - line)
    lift = np.sqrt(table**2 - line**2)
    _, height, multipliers = orbit_of(r, n, ratio, table, np.arccos(line / table) - 0.03)
    assert height / (lift + (n * np.pi) ** 2 / 2) - 1 == pytest.approx(-0.0079, abs=5e-5)
    assert multipliers.real.min() == pytest.approx(-1.0457, abs=5e-5)
    periodic_orbit = orbit(SpringDamper(ratio, restitution=r), amplitude=table, n=n)
    assert periodic_orbit.multipliers.real.min() == pytest.approx(multipliers.real.min(), abs=1e-7)


def test_the_law_of_the_stability_is_right_to_second_order():
    n, r = 3, 0.2
    line = n * np.pi * (1 - r) / (1 + r)
    doubling = np.hypot(line, 2 * (1 + r**2) / (1 + r) ** 2)
    impact = free_impact(SpringDamper(1.0, restitution=r), n)
    first = law_errors(impact.stretched(1e-6), amplitude=doubling)["period_doubling"] * 1e6
    apart = []
    for position in (0.95, 0.975):
        table = line + position * (doubling - line)
        phase = np.arccos(line / table)

        def excess(ratio, table=table, phase=phase):
            return orbit_of(r, n, ratio, table, phase - 1 / ratio)[2].real.min() + 1

        by_law = -first / (1 - table / doubling)
        exact = brentq(excess, 0.8 * by_law, 1.2 * by_law, rtol=1e-10)
        apart.append((by_law / exact - 1) * exact)
    # The share by which they differ is of the order of 1/ϖ, which is half as large at the second.
    assert apart[1] == pytest.approx(apart[0], rel=0.05)
