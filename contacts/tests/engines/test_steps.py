"""One step of an engine's ball in contact, and impacts and drops as uses of it."""

import math

import numpy as np
import pytest

from bouncing_ball_beyond.models.damping import LINEAR, Release
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_contacts.engines.drop_in_steps import drop_in_steps
from bouncing_ball_contacts.engines.impacts import restitution_in_steps
from bouncing_ball_contacts.engines.scheme import Scheme
from bouncing_ball_contacts.engines.steps import (
    HuntCrossleyStep,
    LinearStep,
    patience,
    steps_inside,
    until_outside,
)

CASES = [(scheme, rule) for scheme in Scheme for rule in LINEAR]


@pytest.mark.parametrize(("scheme", "release"), [*CASES, (Scheme.SEMI_IMPLICIT, Release.APPROACH)])
@pytest.mark.parametrize("zeta", [0.0, 0.2, 0.7])
def test_powers_are_the_steps_one_by_one(scheme, release, zeta):
    fraction = np.linspace(0.013, 0.987, 40)
    found = restitution_in_steps(scheme, zeta, release, 300, fraction)
    h = float(SpringDamper(1.0, zeta, release).free_duration) / 300
    step = LinearStep.of(scheme, 1.0, 2 * zeta, release, h)
    x, v = until_outside(step, h * (scheme.is_ahead - fraction), np.full(40, -1.0), patience(300))
    # Rounding errors of 300 steps.
    assert np.all(x >= 0) and found == pytest.approx(v, rel=300 * 1e-15)


@pytest.mark.parametrize("h", [0.01, 0.3, 2.0])
def test_without_damping_a_hunt_crossley_step_is_one_of_implicit_euler(h):
    rng = np.random.default_rng(2)
    x = -rng.uniform(0.0, 2.0, 200)
    v = rng.uniform(-2.0, 2.0, 200)
    linear = LinearStep.of(Scheme.IMPLICIT, 3.0, 0.0, Release.FORCE, h)
    found = HuntCrossleyStep(3.0, 0.0, h).velocity(x, v, v - 0.1)
    assert found == pytest.approx(linear.velocity(x, v, v - 0.1), rel=1e-13, abs=1e-14)


@pytest.mark.parametrize("damping", [0.0, 0.4])
def test_the_force_of_a_hunt_crossley_step_is_that_of_its_end(damping):
    rng = np.random.default_rng(4)
    x = -rng.uniform(0.0, 2.0, 500)
    free = rng.uniform(-4.0, 8.0, 500)
    h, k = 0.2, 5.0
    after = HuntCrossleyStep(k, damping, h).velocity(x, free, free)
    force = k * np.maximum(-x - h * after, 0.0) * np.maximum(1 - damping * after, 0.0)
    assert after == pytest.approx(free + h * force, rel=1e-13, abs=1e-13)


def test_a_drop_on_a_hunt_crossley_contact_in_small_steps_rises_as_the_work_of_its_damper_allows():
    # A stiff contact hardly feels gravity: (1 - rD) exp(D (1 + r)) = 1 + D at its impact speed.
    speed, damping, omega, g = 2.0, 0.25, 2e4, 9.81
    step = HuntCrossleyStep(omega**2, damping, 1e-7)
    drop = drop_in_steps(
        step, 1.0, speed**2 / (2 * g), g, math.pi / omega / 1e-7, 0.6, half_steps=False
    )
    d = damping * speed
    for height in drop.rise:
        r = math.sqrt(2 * g * height) / speed
        # Errors of first order in ωΔt = 2e-3, and of the weight over the force, g/(ωV).
        assert (1 - r * d) * math.exp(d * (1 + r)) == pytest.approx(1 + d, abs=2e-3)


@pytest.mark.parametrize("scheme", [one for one in Scheme if one.is_implicit])
@pytest.mark.parametrize("h", [0.1, 0.6, 2.0])
def test_a_ball_that_is_known_to_stay_stays_in_all_later_steps(scheme, h):
    # Slow impacts and gravity: some balls leave the contact, and some do not.
    speeds = np.linspace(0.1, 12.0, 100)
    of = (scheme, 1.0, 0.3, Release.FORCE, h)
    for step in (LinearStep.of(*of), HuntCrossleyStep(1.0, 0.3, h)):
        start = (-0.5 * h * speeds, -speeds)
        *_, (last, _, _) = steps_inside(step, *start, 2000, 1.0)
        x, v = until_outside(step, *start, 2000, 1.0)
        assert np.array_equal(x >= 0, last >= 0) and np.array_equal(x[x >= 0], last[x >= 0])
        kept = step.keeps(x, v, 1.0) & (x < 0)
        assert np.array_equal(kept, x < 0) and 0 < np.count_nonzero(kept)
