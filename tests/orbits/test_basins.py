"""Traps and destinations against plain simulation."""

from types import SimpleNamespace

import numpy as np
import pytest

from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.motion.angles import reduce_angle
from bouncing_ball.orbits.basins import ELSEWHERE, PERMANENT, destinations, trap
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel

SOFT = SpringDamperModel(SpringDamper.from_restitution(0.85, 2.0))


def stable(model, families, amplitude):
    for n in families:
        found = model.orbits(n, amplitude)
        kept = found[found.is_stable() & found.is_admissible()]
        yield from (kept[k] for k in range(kept.shape[0]))


@pytest.mark.parametrize(
    ("model", "amplitude"), [(SOFT, 0.9), (SOFT, 1.05), (RestitutionModel(0.85), 0.9)]
)
def test_no_ball_leaves_a_trap_and_all_come_to_the_orbit(model, amplitude):
    rng = np.random.default_rng(3)
    for orbit in stable(model, (1, 2), amplitude):
        disk = trap(model, orbit)
        assert disk.radius > 0.01
        phase = disk.phase + rng.uniform(-0.5, 0.5, 4000)
        velocity = np.minimum(disk.velocity + rng.uniform(-0.5, 0.5, 4000), -1e-3)
        inside = disk.distance(phase, velocity) < disk.radius
        assert inside.sum() > 10
        phase, velocity = phase[inside], velocity[inside]
        for _ in range(150):
            cycle = model.cycle(amplitude, phase, velocity)
            phase, velocity = cycle.phase, cycle.relative_velocity
            assert (disk.distance(phase, velocity) < disk.radius).all()
            assert (abs(cycle.time - 2 * np.pi * orbit.n) < 2.0).all()
        assert disk.distance(phase, velocity).max() < 1e-6


@pytest.mark.parametrize(
    ("velocity", "grows", "radius"),
    [(-0.5, (9.0, 9.0), 0.5), (-5.0, (0.1, 0.2), 0.1), (-5.0, (9.0, 9.0), 4.0)],
    ids=["balls that rise", "a ring that grows", "the greatest"],
)
def test_the_radius_of_a_trap(velocity, grows, radius):
    """A map that halves the distance from its fixed point, except in a ring where it grows.

    The trap ends where the ring begins, although the map shrinks wider circles again; it also ends
    at states that are not impacts, δ′ > 0.
    """

    def cycle(amplitude, phase, speed):
        here = np.hypot(phase, speed - velocity)
        factor = np.where((grows[0] < here) & (here < grows[1]), 1.5, 0.5)
        return SimpleNamespace(
            phase=factor * phase, relative_velocity=velocity + factor * (speed - velocity)
        )

    orbit = SimpleNamespace(
        amplitude=1.0, phase=0.0, relative_impact_velocity=velocity, monodromy=lambda: np.eye(2) / 2
    )
    # The next smaller of the radii that are tried, at steps of a quarter of an octave.
    assert radius / 2**0.26 < trap(SimpleNamespace(cycle=cycle), orbit).radius < radius


@pytest.mark.parametrize("amplitude", [0.72, 0.9])
def test_destinations_are_where_long_simulations_end(amplitude):
    rng = np.random.default_rng(4)
    phase, velocity = rng.uniform(-np.pi, np.pi, 300), -rng.uniform(0.01, 8, 300)
    orbits = list(stable(SOFT, (1, 2, 3), amplitude))
    found = destinations(SOFT, amplitude, orbits, phase, velocity, 80)
    thrown = velocity + amplitude * np.cos(phase)
    sequence = SOFT.simulate(amplitude, phase, thrown, 400)
    still = np.isfinite(sequence.time[-1])
    assert ((found.orbit == PERMANENT) == ~still).all()
    for k, orbit in enumerate(orbits):
        ends = found.orbit == k
        assert abs(sequence.relative_velocity[-1, ends] / orbit.relative_impact_velocity - 1).max(
            initial=0
        ) < 1e-9  # fmt: skip
        assert abs(reduce_angle(sequence.phase[-1, ends] - orbit.phase)).max(initial=0) < 1e-9
    assert (found.orbit != ELSEWHERE).all() and np.unique(found.orbit).size == 3


def test_a_ball_that_needs_longer_is_given_up():
    start = np.array([3.0]), np.array([-5.0])
    orbits = list(stable(SOFT, (1,), 0.9))
    assert destinations(SOFT, 0.9, orbits, *start, 1).orbit.tolist() == [ELSEWHERE]
    assert destinations(SOFT, 0.9, orbits, *start, 80).orbit[0] >= 0


def test_without_any_stable_orbit():
    found = destinations(SOFT, 0.1, [], np.zeros(2), np.array([-1.0, -2.0]), 200)
    assert found.orbit.tolist() == [PERMANENT, PERMANENT]
    assert np.isnan(found.phase).all()
