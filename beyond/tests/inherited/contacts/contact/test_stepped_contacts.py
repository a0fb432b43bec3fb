"""Contacts of Adams and Simscape in SI units, for a wanted r, against scipy with their formulas."""

import math

import numpy as np
import pytest
from asked_contacts import answered
from scipy.integrate import solve_ivp

G = 9.80665
MASS, TIME, R, SPEED = 0.5, 5e-3, 0.75, 3.0


def force(law, x, rate):
    """N, of arrays; by the formulas of the manuals, with the cubic STEP of Adams."""
    k, c, d = (law[name] for name in ("stiffness", "damping", "depth"))
    x = np.maximum(x, 0.0)
    part = np.minimum(x / d, 1.0)
    step = 3 * part**2 - 2 * part**3
    if law["name"] == "simscape-contact":
        return np.maximum(0.0, step * (k * x + c * rate))
    e = 1.5 if law["name"] == "adams-impact" else 1.0
    return np.maximum(0.0, k * x**e + step * c * rate)


def impact(law, speed, gravity):
    """The impact until the ball is back at the surface: the ratio of speeds, depth and force."""

    def left(t, y):
        return y[0] if t > 0 else 1.0

    left.terminal = True
    left.direction = -1
    run = solve_ivp(
        lambda t, y: (y[1], gravity - force(law, *y) / MASS), (0.0, 1.0), [0.0, speed],
        events=left, dense_output=True, method="DOP853", rtol=1e-10, atol=1e-14,
        max_step=TIME / 500,
    )  # fmt: skip
    x, rate = run.sol(np.linspace(0.0, run.t[-1], 20_001))
    return -run.y[1, -1] / speed, x.max(), force(law, x, rate).max()


@pytest.mark.parametrize("name", ["adams-impact", "adams-impact-linear", "simscape-contact"])
def test_a_law_with_the_wanted_r_has_it_in_its_formula(name):
    found = answered(mass=MASS, law=name, contact_time=TIME, restitution=R, speed=SPEED)
    law = found.found.law
    r, _, _ = impact(law, SPEED, 0.0)
    assert r == pytest.approx(R, abs=1e-7)
    # With gravity: the ball leaves at the surface, or above it where its force has vanished before.
    r, depth, hardest = impact(law, SPEED, G)
    dropped = found.dropped
    assert dropped.greatest_compression == pytest.approx(depth, rel=1e-6)
    assert dropped.peak_force == pytest.approx(hardest, rel=1e-6)
    assert math.sqrt(dropped.rebound_height / dropped.drop_height) == pytest.approx(r, abs=1e-6)
