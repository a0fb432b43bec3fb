"""Orbits, multipliers and bifurcations against a code that shares nothing with the package."""

import numpy as np
import pytest
from own_return_map import differences, returned, solved

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.errors import NoOrbitError

# Balls, each with a Λ at which its 1-T orbit is stable.
BALLS = [
    (bouncing_ball_beyond.rigid(restitution=0.5), 1.2),
    (bouncing_ball_beyond.rigid(restitution=0.85), 0.9),
    (bouncing_ball_beyond.spring_damper(restitution=0.6, frequency_ratio=7.0), 1.1),
    (
        bouncing_ball_beyond.spring_damper(restitution=0.8, frequency_ratio=15.0, release="force"),
        0.9,
    ),
]


def state_of(orbit):
    """The phase and the velocity of the first impact."""
    return np.array([np.ravel(orbit.phase)[0], np.ravel(orbit.impact_velocity)[0]])


def own_map(orbit, amplitude):
    """The return map of the ball of an orbit on another table."""
    return lambda state: returned(orbit.model, amplitude, state, orbit.impacts, orbit.periods)


@pytest.mark.long
@pytest.mark.parametrize(("ball", "stable_at"), BALLS)
@pytest.mark.parametrize("impacts", [1, 2, 3])
def test_orbits_and_multipliers_are_those_of_plain_equations_of_motion(ball, stable_at, impacts):
    rng = np.random.default_rng(impacts)
    compared = 0
    for amplitude in stable_at * rng.uniform(1.0, 2.0, 4):
        try:
            found = bouncing_ball_beyond.orbits(
                ball, impacts=impacts, periods=impacts, amplitude=amplitude
            )
        except NoOrbitError:
            continue
        for orbit in found:
            closing = np.abs(orbit.relative_impact_velocity)
            # Errors of the second code grow by the multiplier, and at slow impacts.
            expected = orbit.multipliers()
            if not orbit.is_admissible() or closing.min() < 0.05 or abs(expected[0]) > 100:
                continue
            image = own_map(orbit, amplitude)
            guess = state_of(orbit) + rng.uniform(-1e-5, 1e-5, 2)
            state = solved(lambda x, image=image: image(x) - x, guess, 1e-4)
            assert np.abs(state - state_of(orbit)).max() < 1e-9
            own = np.linalg.eigvals(differences(image, state, 2e-4))
            own = own[np.argsort(-np.abs(own))]
            apart = min(np.abs(own - expected).max(), np.abs(own[::-1] - expected).max())
            assert apart < 1e-5 * max(1.0, abs(expected[0]))
            compared += 1
    assert compared > 0


@pytest.mark.long
@pytest.mark.parametrize(("ball", "stable_at"), BALLS)
@pytest.mark.parametrize(
    ("kind", "multiplier", "to"), [("saddle-node", 1.0, 0.05), ("period doubling", -1.0, 6.0)]
)
def test_bifurcations_are_where_the_own_return_map_has_them(ball, stable_at, kind, multiplier, to):
    start = bouncing_ball_beyond.orbit(ball, amplitude=stable_at)
    assert start.is_stable()
    orbit = bouncing_ball_beyond.follow(start, to=to).first(kind)

    def equations(unknowns):
        image = own_map(orbit, unknowns[2])
        matrix = differences(image, unknowns[:2], 1e-3)
        bifurcates = np.linalg.det(matrix - multiplier * np.eye(2))
        return np.array([*(image(unknowns[:2]) - unknowns[:2]), bifurcates])

    guess = np.array([*state_of(orbit), orbit.amplitude]) + 1e-5
    found = solved(equations, guess, 3e-4)
    assert found[2] == pytest.approx(orbit.amplitude, abs=1e-8)
    assert np.abs(found[:2] - state_of(orbit)).max() < 1e-6
