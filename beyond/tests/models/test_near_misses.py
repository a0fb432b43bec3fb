"""Landings and releases next to which the ball nearly misses the table, or nearly leaves it."""

import numpy as np
import pytest

from bouncing_ball_beyond.inherited.models.flight import land, table
from bouncing_ball_beyond.models.damping import LINEAR, Release
from bouncing_ball_beyond.models.flight import Flight
from bouncing_ball_beyond.models.linear_contact import LinearContactDynamics
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact.spring_damper_branch import orbits_on_branch

# A gap function is known to about four units in the last place of its terms,
# which are of order 10 here.
NOISE = 1e-14


def gap(s, height, velocity, phase, lam):
    return height + velocity * s - s * s / 2 - lam * np.sin(phase + s)


def landing(height, velocity, phase, lam):
    """When balls in flight land."""
    x, y = table(phase, lam)
    flight = Flight(np.maximum(height - y, 0.0), velocity - x, x, y, lam)
    return land(flight, flight.earliest_landing()).time


def dips(least, seed=0, count=400):
    """Flights whose gap has a minimum of a given value at a time s₀, positive before.

    Returns s₀, δ″(s₀), z, z′, φ, Λ.
    """
    rng = np.random.default_rng(seed)
    lam = rng.uniform(1.5, 6.0, count)
    s0 = rng.uniform(0.2, 4.0, count)
    # Λ sin(φ + s₀) > 1: the table rises towards the ball more slowly than before.
    top = rng.uniform(np.arcsin(1 / lam) + 0.05, np.pi - np.arcsin(1 / lam) - 0.05)
    phase = top - s0
    velocity = s0 + lam * np.cos(top)
    height = least - gap(s0, 0.0, velocity, phase, lam)
    grid = np.linspace(0, 1, 4001)[:-1, None] * s0
    clear = np.all(gap(grid, height, velocity, phase, lam) > least, axis=0)
    clear &= gap(0.0, height, velocity, phase, lam) > 0.1
    assert clear.sum() > 50
    return tuple(x[clear] for x in (s0, lam * np.sin(top) - 1, height, velocity, phase, lam))


def test_a_flight_that_dips_below_the_table_for_a_millionth():
    s0, curvature, *flight = dips(0.0)
    z, v, phase, lam = flight
    # Roots at s₀ ± 5e-7.
    z = z - curvature * (5e-7) ** 2 / 2
    found = landing(z, v, phase, lam)
    # The rounding of the gap over its slope at the zero.
    assert np.all(np.abs(found - (s0 - 5e-7)) < 10 * NOISE / (curvature * 5e-7))


@pytest.mark.parametrize("depth", [1e-12, 1e-9, 1e-6])
def test_a_flight_that_just_touches_lands_and_one_that_just_misses_flies_on(depth):
    s0, curvature, z, v, phase, lam = dips(0.0)
    width = np.sqrt(2 * depth / curvature)
    touched = landing(z - depth, v, phase, lam)
    # Of the local parabola: the next term is the cube of the width.
    slack = 10 * lam / curvature * width**2 + 10 * NOISE / (curvature * width)
    assert np.all(np.abs(touched - (s0 - width)) < slack)
    missed = landing(z + depth, v, phase, lam)
    assert np.all(missed > s0 + width)
    # It lands at the next zero, with no other before.
    grid = np.linspace(0, 1, 20001)[1:-1, None] * missed
    assert np.all(gap(grid, z + depth, v, phase, lam) > -NOISE)
    assert np.all(np.abs(gap(missed, z + depth, v, phase, lam)) < 100 * NOISE)


def peaks(release, seed=0):
    """Contacts that rise to zero at s₀ and no further: s₀, y″, φ, ϖ, ζ, and u, Λ as
    functions of the value of y there."""
    rng = np.random.default_rng(seed)
    omega, zeta = 3.0, 0.1
    lag = 2 * zeta / omega if release is Release.FORCE else 0.0
    made = []
    for _ in range(60):
        phase = rng.uniform(-np.pi, np.pi)
        s0 = rng.uniform(1.2, 6.0)

        def observed(u, lam, s=s0, phase=phase):
            flow = SpringDamper(omega, zeta).flow(s, 0.0, u, phase, lam)
            d = flow.displacement
            v = flow.velocity
            a = flow.acceleration
            jerk = -2 * zeta * omega * a - omega**2 * v + lam * np.cos(s + phase)
            return d + lag * v, v + lag * a, a + lag * jerk

        zero = np.array(observed(0.0, 0.0)[:2])
        matrix = np.array(
            [np.array(observed(1.0, 0.0)[:2]) - zero, np.array(observed(0.0, 1.0)[:2]) - zero]
        ).T

        def state(value, matrix=matrix, zero=zero):
            return np.linalg.solve(matrix, np.array([value, 0.0]) - zero)

        u, lam = state(0.0)
        grid = np.linspace(0, 1, 2001)[1:-3] * s0
        curvature = float(observed(u, lam)[2])
        if u < -0.1 and 0 < lam < 20 and curvature < -0.1:
            if np.all(observed(u, lam, grid)[0] < 0):
                made.append((s0, -curvature, phase, omega, zeta, state, observed))
    assert len(made) > 3
    return made


def duration(contact, lam, phase, u):
    """How long a contact lasts that starts with the relative velocity u."""
    sequence = LinearContactDynamics.of(contact, lam).simulate(phase, u + lam * np.cos(phase), 1)
    return sequence.contact_duration[0]


@pytest.mark.parametrize("release", LINEAR)
@pytest.mark.parametrize("height", [1.25e-13, 1e-12, 1e-9, 1e-6])
def test_a_contact_that_just_reaches_its_release_ends_and_one_that_just_misses_it_lasts(
    release, height
):
    """The first height has its zeros 1e-6 apart when the curvature is one."""
    for s0, curvature, phase, omega, zeta, state, observed in peaks(release):
        contact = SpringDamper(omega, zeta, release)
        width = np.sqrt(2 * height / curvature)
        u, lam = state(height)
        ended = duration(contact, lam, phase, u)
        slack = 100 * width**2 + 10 * NOISE / (curvature * width)
        assert abs(ended - (s0 - width)) < slack
        u, lam = state(-height)
        later = duration(contact, lam, phase, u)
        assert later > s0 + width
        if np.isfinite(later):
            grid = np.linspace(0, 1, 5001)[1:-1] * later
            assert np.all(observed(u, lam, grid)[0] < NOISE)
            assert abs(observed(u, lam, later)[0]) < NOISE


def test_a_ball_at_rest_on_the_table_starts_at_once():
    """δ = δ′ = 0: pressed against the table, or left behind by it."""
    phase = np.array([-0.5, 1.0])
    x, y = table(phase, 2.0)
    pressed, thrown = landing(y, x, phase, 2.0)
    assert pressed == 0
    assert thrown > 1
    cycle = LinearContactDynamics.of(SpringDamper(10.0, 0.1), 2.0).next_impact(1.0, 0.0)
    # The contact of no duration changes nothing.
    assert abs(float(cycle.time) - thrown) < 1e-12


def test_a_release_that_is_due_now_is_not_put_off_by_a_turn():
    # Long contacts whose steady part alone decides: the 1-T orbit of each is a contact of nearly
    # a period, and by rounding a step may lie on the crossing itself.
    ratio = np.linspace(60.0, 70.0, 2000)
    contact = SpringDamper.from_restitution(0.65, ratio)
    excess = (2 * np.pi - 0.19) * contact.damped_frequency - contact.free_angle
    orbit = orbits_on_branch(excess, contact, 1)
    cycle = orbit.model.cycle(orbit.amplitude, orbit.phase, orbit.relative_impact_velocity)
    good = orbit.is_stable()
    assert good.sum() > 1000
    np.testing.assert_allclose(cycle.time[good], 2 * np.pi, rtol=1e-9)
