"""The steps of engines against closed forms, an integration and measured bounces."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from bouncing_ball_contacts.schemes import (
    Bullet,
    Capped,
    Hertz,
    HuntCrossley,
    Impedance,
    Implicit,
    Linear,
    SemiImplicit,
    drop,
    exact,
    offsets,
)

AT = exact(offsets(11))
# Implicit steps damp as a ratio of ωh/2 does: in 2000 steps of a contact, ωh = π/2000, r falls by
# the factor exp(-π²/4000), and other errors of first order are no larger.
FINE = 1 - math.exp(-(math.pi**2) / 4000) + 1e-4


def fine(law, scheme, gravity=0.0, speed=1.0):
    return float(drop(law, scheme, math.pi / 100 / 2000, speed, gravity, AT).mean)


def linear(ratio):
    return Linear(np.asarray(1e4), np.asarray(2 * ratio * 100.0))


def by_force(z):
    """Return r of a contact that never pulls."""
    if z < 1:
        return math.exp(-z * (math.pi - 2 * math.asin(z)) / math.sqrt(1 - z * z))
    return math.exp(-2 * z * math.acosh(z) / math.sqrt(z * z - 1))


@pytest.mark.parametrize("scheme", [Bullet, Capped])
def test_springs_of_solvers_have_implicit_steps(scheme):
    """What the engines' formulas of v⁺ come to if nothing else is set."""
    k = np.asarray(3e4)
    c = np.asarray(20.0)
    law = scheme(k, c)
    drops = drop(law, Implicit(), 1e-3, 2.0, 9.81, AT)
    implicit = drop(Linear(k, c), Implicit(), 1e-3, 2.0, 9.81, AT)
    assert drops.restitution == pytest.approx(implicit.restitution, rel=1e-9)
    assert law.rest(9.81) == pytest.approx(Linear(k, c).rest(9.81), rel=1e-9)


@pytest.mark.parametrize(
    "law",
    [
        Linear(np.asarray(3e4), np.asarray(20.0)),
        HuntCrossley(np.asarray(3e4), np.asarray(0.3)),
        Hertz(np.asarray(3e6), np.asarray(0.1)),
        Impedance(np.asarray(3e4), np.asarray(20.0), points=4, low=0.99, high=0.99),
        Impedance(np.asarray(3e4), np.asarray(20.0), low=0.1, high=0.95, width=0.01),
    ],
    ids=["linear", "Hunt and Crossley", "Hertz", "impedance", "rising impedance"],
)
def test_a_body_at_rest_is_carried_by_the_contact(law):
    depth = law.rest(9.81)
    push = law.push(np.asarray(depth), np.asarray(0.0), np.asarray(9.81))
    assert push == pytest.approx(9.81, rel=1e-9)


def test_linear_damping_limits_the_speed_of_a_fall():
    """A body falls with v of D v (1 + v) = g at most, and rises against the same drag."""
    terminal = math.sqrt(0.25 + 9.80665 / 0.04) - 0.5
    # Of a hard contact without damping.
    law = Bullet(np.asarray(1e10), np.asarray(0.0), drag=0.04)
    r = drop(replace(law, drag=0.0), Implicit(), 1e-7, terminal, 9.80665, AT).restitution.mean()
    fast = drop(law, Implicit(), 1e-7, 300.0, 9.80665, AT)

    def slower(time, state):
        speed = state[1]
        return [speed, -9.80665 - 0.04 * speed * (1 + speed)]

    rise = solve_ivp(slower, (0, 3), [0, r * terminal], rtol=1e-8, dense_output=True)
    height = rise.sol(np.linspace(0, 3, 3001))[0].max()
    expected = math.sqrt(height / (300.0**2 / (2 * 9.80665)))
    assert fast.mean == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize("ratio", [0.0, 0.05, 0.2, 0.6, 0.95, 1.4, 2.5])
@pytest.mark.parametrize("scheme", [SemiImplicit(), Implicit(), Implicit(ahead=True)])
def test_a_spring_and_a_damper_that_never_pull(ratio, scheme):
    assert fine(linear(ratio), scheme) == pytest.approx(by_force(ratio), abs=FINE)


@pytest.mark.parametrize("ratio", [0.05, 0.2, 0.6])
def test_a_damper_that_pulls_has_the_restitution_of_equation_16(ratio):
    expected = math.exp(-math.pi * ratio / math.sqrt(1 - ratio**2))
    assert fine(linear(ratio), SemiImplicit(pulls=True)) == pytest.approx(expected, abs=FINE)


def test_a_strong_damper_that_pulls_stops_the_body():
    assert fine(linear(1.5), SemiImplicit(pulls=True)) == 0


@pytest.mark.parametrize("ratio", [0.05, 0.2, 0.6])
def test_a_damper_on_approach_has_the_root(ratio):
    expected = math.sqrt(by_force(ratio))
    assert fine(linear(ratio), SemiImplicit(approach=True)) == pytest.approx(expected, abs=FINE)


@pytest.mark.parametrize("e", [0.3, 0.7, 0.95])
@pytest.mark.parametrize("speed", [0.1, 3.0])
def test_the_damper_of_tsuji_has_one_restitution_at_every_speed(e, speed):
    beta = -math.log(e) / math.hypot(math.pi, math.log(e))
    law = Hertz.of_depth(np.asarray(1e-3), np.asarray(beta), speed)
    step = float(law.duration(speed)) / 2000
    drops = drop(law, SemiImplicit(pulls=True), step, speed, 0.0, AT)
    # Near the end the damper is stronger than the spring, and the last part of it takes long.
    assert float(drops.mean) == pytest.approx(e, abs=3 * FINE)


@pytest.mark.parametrize("x", [0.1, 0.5, 2.0])
def test_the_damper_of_hunt_and_crossley_has_its_implicit_formula(x):
    law = HuntCrossley.of_depth(np.asarray(0.01), np.asarray(x), 2.0)
    r = float(drop(law, Implicit(), math.pi * 0.005 / 3000, 2.0, 0.0, AT).mean)
    # x (1 + r) = ln((1 + x)/(1 - x r)); the left side has the slope of order 1.
    assert x * (1 + r) == pytest.approx(math.log((1 + x) / (1 - x * r)), abs=4 * FINE)


def test_gravity_in_a_contact_is_that_of_an_integration():
    k, c, g, v = 2500.0, 12.0, 9.81, 1.5

    def motion(t, y):
        return [y[1], max(-k * y[0] - c * y[1], 0.0) - g]

    def leaves(t, y):
        return y[0] if t > 1e-6 else -1.0

    leaves.terminal = True
    leaves.direction = 1
    run = solve_ivp(motion, (0, 5), [0.0, -v], events=leaves, rtol=1e-9, max_step=1e-3)
    law = Linear(np.asarray(k), np.asarray(c))
    drops = drop(law, SemiImplicit(), math.pi / 50 / 2500, v, g, AT)
    assert float(drops.mean) == pytest.approx(run.y[1, -1] / v, abs=FINE)
    assert drops.depth.max() == pytest.approx(-run.y[0].min(), rel=3e-3)


def test_implicit_steps_with_contacts_ahead_bounce_as_physx():
    """PhysX 5.6.1 for JavaScript: 10⁴ N/m without damping, 0.5 kg, 1 m/s, no gravity."""
    measured = {1 / 240: 0.4156, 1 / 1000: 0.8014, 1 / 4000: 0.9460, 1 / 20000: 0.9890}
    law = Linear(np.asarray(2e4), np.asarray(0.0))
    for step, r in measured.items():
        drops = drop(law, Implicit(ahead=True), step, 1.0, 0.0, AT)
        low, high = drops.restitution.min(), drops.restitution.max()
        assert low - 3e-4 <= r <= high + 3e-4


def test_the_sum_of_energies_is_kept_by_semi_implicit_steps_on_average():
    law = Linear(np.asarray(1e4), np.asarray(0.0))
    r = drop(law, SemiImplicit(), math.pi / 100 / 8, 1.0, 0.0, exact(offsets(401))).restitution
    # (z² k + v² + h k z v) is conserved, so that r² has the mean 1 over the instants.
    assert np.mean(r**2) == pytest.approx(1.0, abs=0.02)
    assert r.min() < 1.0 < r.max()


def test_a_drop_is_that_of_a_ball_that_starts_from_rest():
    """All steps of the fall, the contact and the rise, one by one."""
    height, g, h, k, c = 0.1, 9.81, 5e-3, 3e3, 20.0
    z, v, force = height, 0.0, 0.0
    heights = []
    for _ in range(200):
        force = max(-k * z - c * v, 0.0) if z < 0 else 0.0
        v += h * (force - g)
        z += h * v
        heights.append(z)
    heights = np.array(heights)
    first = int(np.argmax(heights < 0))
    speed = (heights[first - 1] - heights[first]) / h
    offset = -heights[first] / (speed * h)
    after = heights[first:]
    out = int(np.argmax(after >= 0))
    law = Linear(np.asarray(k), np.asarray(c))
    drops = drop(law, SemiImplicit(), h, math.sqrt(2 * g * height), g, exact(np.array([offset])))
    assert float(drops.depth[0]) == pytest.approx(-after[:out].min(), rel=1e-9)
    assert float(drops.restitution[0]) ** 2 * height == pytest.approx(after[out:].max(), rel=1e-9)


def test_a_fall_that_is_shorter_than_a_step_is_no_rebound():
    """The rise before it was counted as one: r was up to 1.16 for a body that stays."""
    law = Linear(np.asarray(2000.0), np.asarray(50.0))
    drops = drop(law, SemiImplicit(), 1 / 60, math.sqrt(2 * 9.81 * 1e-3), 9.81, exact(offsets(20)))
    assert drops.restitution.max() == 0


def test_a_step_beyond_the_limit_of_stability_throws_the_body_out():
    law = Linear(np.asarray(1e6), np.asarray(0.0))
    assert drop(law, SemiImplicit(), 2.2e-3, 1.0, 0.0, AT).restitution.max() > 1.5


def test_a_compliant_contact_at_a_fine_step_is_computed_to_its_end():
    """A tenth of a millisecond of steps in a contact of three seconds: no limit cuts it off."""
    law = Linear(np.asarray(1.0), np.asarray(0.2))
    drops = drop(law, SemiImplicit(), 1e-6, 1.0, 0.0, AT)
    assert float(drops.mean) == pytest.approx(by_force(0.1), abs=FINE)


def test_contacts_side_by_side_are_those_one_by_one():
    k = np.array([1e3, 1e4, 1e5])
    c = np.array([5.0, 20.0, 40.0])
    steps = np.array([1e-3, 5e-4, 1e-4])
    both = drop(Linear(k, c), SemiImplicit(), steps, 2.0, 9.81, AT)
    for i in range(3):
        one = drop(Linear(k[i], c[i]), SemiImplicit(), steps[i], 2.0, 9.81, AT)
        assert np.allclose(both.restitution[i], one.restitution, rtol=1e-12)
        assert np.allclose(both.depth[i], one.depth, rtol=1e-12)


@pytest.mark.parametrize("power", [1.0, 2.0, 3.5])
@pytest.mark.parametrize("middle", [0.2, 0.5, 0.7])
def test_the_power_curve_of_an_impedance_is_continuous_through_its_middle(power, middle):
    """At the middle x of the width the share of the rise is x itself, from both sides.

    For other x the curve is x^p/m^(p-1) below, and its mirror image above; MuJoCo's documentation.
    """
    law = Impedance(np.asarray(0.0), np.asarray(0.0), 1, 0.1, 0.9, 1e-3, middle, power)

    def impedance(x):
        # Without a spring and a damper a contact takes this share of gravity.
        return float(law.push(np.asarray(x * 1e-3), np.asarray(0.0), np.asarray(1.0)))

    for x in (middle - 1e-12, middle + 1e-12):
        assert impedance(x) == pytest.approx(0.1 + 0.8 * middle, rel=1e-9)
    half = impedance(middle / 2)
    assert half == pytest.approx(0.1 + 0.8 * middle * 0.5**power, rel=1e-12)
    above = impedance((1 + middle) / 2)
    assert above == pytest.approx(0.9 - 0.8 * (1 - middle) * 0.5**power, rel=1e-12)
