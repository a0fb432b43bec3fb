"""Contacts whose force is stepped over a depth, against an integrator and their limits."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.damping import Release, restitution_coefficient
from bouncing_ball_beyond.models.laws.law_of_impact import law_of_impact
from bouncing_ball_beyond.models.laws.stepped import (
    AdamsImpact,
    LinearAdamsImpact,
    SimscapeContact,
)

K, C, D = 400.0, 5.0, 0.02
KINDS = (AdamsImpact, LinearAdamsImpact, SimscapeContact)


# Of the cubic polynomial with the values 0 and 1 and the slopes 0 and 0 at 0 and 1.
CUBIC = np.linalg.solve(
    [[1, 0, 0, 0], [1, 1, 1, 1], [0, 1, 0, 0], [0, 1, 2, 3]], [0.0, 1.0, 0.0, 0.0]
).tolist()


def cubic_step(x):
    return 1.0 if x >= 1 else CUBIC[0] + x * (CUBIC[1] + x * (CUBIC[2] + x * CUBIC[3]))


def force(kind, p, rate, k=K, c=C, d=D):
    step = cubic_step(p / d)
    if kind is SimscapeContact:
        return max(0.0, step * (k * p + c * rate))
    return max(0.0, k * p ** (1.5 if kind is AdamsImpact else 1.0) + step * c * rate)


def by_integration(kind, speed, **parameters):
    """r of a free impact: the rate at the surface, where no force acts any more."""

    def rates(_, state):
        return [state[1], -force(kind, max(state[0], 0.0), state[1], **parameters)]

    def surface(t, state):
        return state[0] if t > 0 else 1.0

    surface.terminal, surface.direction = True, -1
    options = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-13, "max_step": 1e-4}
    found = solve_ivp(rates, (0.0, 100.0), [0.0, speed], events=surface, **options)
    return -found.y[1, -1] / speed


@pytest.mark.parametrize("kind", KINDS)
# Impacts that do not reach d, and that go far beyond it; the last damper would pull for long.
@pytest.mark.parametrize(("speed", "damping"), [(0.05, C), (3.0, C), (3.0, 40.0)])
def test_the_restitution_is_that_of_an_integrator(kind, speed, damping):
    found = float(kind(K, damping, D).signature(speed).restitution)
    # The integrator steps over the kinks of the force, in steps of at most 1e-4.
    assert found == pytest.approx(by_integration(kind, speed, c=damping), abs=1e-8)


@pytest.mark.parametrize("kind", KINDS[1:])
def test_without_a_depth_it_is_a_spring_and_a_damper_released_by_the_force(kind):
    exact = float(restitution_coefficient(C / (2 * np.sqrt(K)), Release.FORCE))
    error = [
        abs(float(kind(K, C, d).signature(1.0).restitution) - exact) for d in (1e-3, 1e-4, 1e-5)
    ]
    assert error[2] < 2e-4
    # What the step leaves out of the impact falls with the depth.
    assert error[0] / error[1] == pytest.approx(10, rel=0.2)
    assert error[1] / error[2] == pytest.approx(10, rel=0.2)


def test_without_damping_nothing_is_lost_and_the_stepped_spring_is_stepped():
    for kind in KINDS:
        assert float(kind(K, 0.0, D).signature(2.0).restitution) == pytest.approx(1, abs=1e-12)
    # Much less deep than d: s = 3x², a spring 3K p³/d², whose energy is 3K p⁴/(4d²).
    speed = 1e-6
    law = SimscapeContact(K, 0.0, D)
    deepest = (speed**2 / 2 * 4 * D**2 / (3 * K)) ** 0.25
    now = law.signature(speed)
    # The period of a quartic well: 4 ∫ dp/√(2(E - V)), of which a contact is a half.
    quarter = 1.31102877714605990523 * deepest / speed
    assert float(now.duration) == pytest.approx(2 * quarter, rel=1e-3)


@pytest.mark.parametrize(("kind", "power"), [*zip(KINDS, (1.4, 2.0, 0.5), strict=True)])
def test_a_shallow_impact_loses_as_the_square_of_its_depth_tells(kind, power):
    # The damping force over that of the spring, at the scale of the depth, with s = 3x².
    law = kind(K, C, 10.0)
    slow, fast = (1 - float(law.signature(v).restitution) for v in (1e-2, 1e-1))
    # The loss itself, and the next order of the step, are some 0.005.
    assert np.log10(fast / slow) == pytest.approx(power, abs=0.005)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("r", [0.3, 0.75, 0.95])
def test_a_law_with_an_r_has_it_by_integration(kind, r):
    law = law_of_impact(kind, r, 0.1, 3.0)
    impact = law.signature(3.0)
    assert (float(impact.restitution), float(impact.duration)) == pytest.approx((r, 0.1), rel=1e-12)
    values = {"k": float(law.stiffness), "c": float(law.damping), "d": float(law.depth)}
    assert by_integration(kind, 3.0, **values) == pytest.approx(r, abs=1e-8)


def test_a_ball_that_leaves_is_pushed_close_to_the_surface_again():
    law = LinearAdamsImpact(K, 40.0, D)
    rate = -3.0 * float(law.signature(3.0).restitution)
    inside = np.linspace(0.0, 0.2, 2001)[1:]
    pushes = law.force(inside, np.full_like(inside, rate)) > 0
    # The spring is stronger close to the surface, and where the damper of this rate is weak.
    assert pushes[0] and not pushes.all() and pushes[-1]


@pytest.mark.parametrize("kind", KINDS)
def test_a_depth_must_be_positive(kind, refusal):
    with refusal(ModelError, "depth d = 0.0 is not a finite number > 0"):
        kind(K, C, 0.0)
