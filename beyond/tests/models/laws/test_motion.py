"""Impacts on the spring-damper against exact answers, orbits and a Taylor integrator."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from loaded_laws import Sharing

from bouncing_ball_beyond.inherited.models.flight import land, table
from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.inherited.periodic.orbit import Side
from bouncing_ball_beyond.models.damping import LINEAR, Release, damping_ratio
from bouncing_ball_beyond.models.flight import Flight
from bouncing_ball_beyond.models.history import motion_at
from bouncing_ball_beyond.models.laws.motion import sampled_resumption
from bouncing_ball_beyond.models.permanent_contact import permanent_contact_threshold
from bouncing_ball_beyond.models.resumption import resumption
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact.spring_damper_bifurcations import orbit_at

CASES = [
    # n, r, ϖ, Λ
    (1, 0.85, 10.0, 0.8),
    (1, 0.65, 2.0, 0.9),
    (2, 0.65, 10.0, 1.5),
    (1, 0.85, 100.0, 0.9),
    (1, 0.5, 1.5, 1.1),
    (3, 0.85, 3.0, 1.0),
]
RELEASES = LINEAR


def build(case, release, side=Side.STABLE):
    n, r, omega, lam = case
    contact = SpringDamper(omega, float(damping_ratio(r)), release)
    return contact, lam, orbit_at(contact, n, lam, side)


def turn(angle):
    """The angle reduced to [-π, π]."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


@pytest.mark.parametrize("release", RELEASES)
@pytest.mark.parametrize("case", CASES)
def test_twenty_impacts_agree_with_a_taylor_integrator(case, release, taylor_ball):
    contact, lam, orbit = build(case, release)
    phase = float(orbit.phase) + 0.1
    velocity = float(orbit.impact_velocity) - 0.05
    reference = taylor_ball(release is Release.FORCE)
    expected = reference.impacts(lam, case[2], contact.damping_ratio, phase, velocity, 20)
    got = contact.dynamics(lam).simulate(phase, velocity, 20)
    found = (got.time, got.impact_velocity, got.contact_duration, got.bounce_velocity)
    # Measured: below 6e-13. The clock of the integrator is absolute: its rounding, 1e-14,
    # is a velocity error of ϖ times that and the impact velocity.
    for a, b in zip(expected, found, strict=True):
        np.testing.assert_allclose(b, a, rtol=0, atol=2e-12)


@pytest.mark.parametrize(
    ("omega", "zeta", "factor"), [(1.4, 0.3, 1.03), (0.7, 0.5, 1.1), (2.0, 0.5, 1.01)]
)
def test_contacts_that_resume_below_the_level_agree_with_a_taylor_integrator(
    omega, zeta, factor, taylor_ball
):
    """Force release, little above the threshold of permanent contact: the table loses the
    ball and gets it back before it has come up to its level."""
    contact = SpringDamper(omega, zeta, Release.FORCE)
    lam = factor * float(permanent_contact_threshold(omega, zeta, Release.FORCE))
    got = contact.dynamics(lam).simulate(0.3, -0.2 + lam * np.cos(0.3), 20)
    resumed = got.displacement < 0
    assert resumed.sum() > 10 and np.all(got.relative_velocity[resumed] > 0)
    rows = taylor_ball(True).impacts(lam, omega, zeta, 0.3, -0.2 + lam * np.cos(0.3), 20)
    for a, b in zip(rows, (got.time, got.impact_velocity, got.contact_duration), strict=False):
        # The start of a resumed contact is a crossing of low speed.
        np.testing.assert_allclose(b, a, rtol=0, atol=1e-11)


class _Unknown(SpringDamper):
    """A spring-damper of which the release is known by its force alone."""

    lag = None

    def grip(self, penetration, rate):
        return self.force(penetration, rate)


def test_after_a_release_below_the_level_the_first_of_landing_and_resumption_is_found():
    """A ball that is let go comes up to the level, or the force returns before."""
    rng = np.random.default_rng(1)
    size = 4000
    omega = 10 ** rng.uniform(-0.5, 1, size)
    zeta, lam = rng.uniform(0.05, [[0.95], [4]], (2, size))
    x, y = table(rng.uniform(-np.pi, np.pi, size), lam)
    contact = SpringDamper(omega, zeta, Release.FORCE)
    rate = 10 ** rng.uniform(-3, 0.7, size)
    let_go = rate + contact.lag * (y - 1) > 0
    contact = contact[let_go]
    size = let_go.sum()
    flight = Flight(*(z[let_go] for z in (-2 * zeta / omega * rate, rate, x, y, lam)))
    time, resumed = resumption(flight, contact.lag)
    assert 0.1 < resumed.mean() < 0.9
    end = np.where(resumed, time, land(flight, time).time)
    # Between the samples of a flight it may come up and be unloaded: none of these does.
    height, speed, _, _ = flight.gap(np.linspace(0, 1, 801)[1:-1, np.newaxis] * end)
    below = np.logical_and.accumulate(height < 0)
    assert below[:, resumed].all() and not below[-1, ~resumed].any()
    assert np.min(height + contact.lag * speed, initial=0, where=below) > -1e-13
    height, speed, _, _ = flight.gap(time)
    assert np.all(height[resumed] < 0)
    assert np.abs(height + contact.lag * speed)[resumed].max() < 1e-12
    # Samples of the grip find the same, and miss a force that returns for a moment.
    law = _Unknown(contact.frequency_ratio, contact.damping_ratio, Release.FORCE)
    other, back = sampled_resumption(flight, law)
    assert np.mean(back != resumed) < 0.001
    assert np.abs(other - time)[back & resumed].max() < 1e-9


def test_a_contact_that_ends_at_the_level_does_not_resume_within_a_rounding_error():
    """Where a shared load lets the contact end at p = 0, the force that is left is positive."""
    phase, fall = np.random.default_rng(0).uniform([[-3], [1.5]], [[3], [5]], (2, 500))
    run = Sharing(30.0, 0.05, 0.95).dynamics(1.0).simulate(phase, -fall - 1, 40)
    assert np.sum(run.release_displacement == 0) > 500
    assert not np.any((run.displacement < 0) & (run.displacement > -1e-15))


def test_an_elastic_ball_on_a_table_at_rest_keeps_its_energy():
    """The only exact answer with many impacts: equal velocities and equal times."""
    omega, speed = 7.0, 1.5
    sequence = SpringDamper(omega, 0.0).dynamics(0.0).simulate(0.0, -speed, 1000)
    assert sequence.status == Status.BOUNCING
    # 1000 impacts with an error of a unit in the last place each.
    np.testing.assert_allclose(sequence.impact_velocity, -speed, rtol=1e-13)
    np.testing.assert_allclose(sequence.bounce_velocity, speed, rtol=1e-13)
    # Symmetric about the deepest point: tan(ϖ D/2) = -ϖ u, on the far side of π/2.
    duration = 2 / omega * (np.pi - np.arctan(omega * speed))
    np.testing.assert_allclose(sequence.contact_duration, duration, rtol=1e-13)
    np.testing.assert_allclose(np.diff(sequence.time), duration + 2 * speed, rtol=1e-12)


@pytest.mark.parametrize("release", RELEASES)
@pytest.mark.parametrize(("omega", "zeta"), [(0.7, 0.3), (2.0, 0.1), (10.0, 0.05), (30.0, 0.2)])
def test_permanent_contact_begins_and_ends_at_its_threshold(omega, zeta, release):
    contact = SpringDamper(omega, zeta, release)
    threshold = float(permanent_contact_threshold(omega, zeta, release))
    # Of the threshold some roundings are unknown.
    lam = threshold * np.array([1 - 1e-12, 1 + 1e-12])
    sequence = contact.dynamics(lam).simulate(0.2, lam * np.cos(0.2) - 1e-3, 40)
    assert sequence.status.tolist() == [Status.PERMANENT_CONTACT, Status.BOUNCING]
    last = sequence.impacts[0] - 1
    assert sequence.contact_duration[last, 0] == np.inf
    assert np.all(np.isnan(sequence.time[last + 1 :, 0]))
    assert sequence.impacts[1] == 40


def test_after_a_permanent_contact_there_is_no_next_impact():
    cycle = SpringDamper(10.0, 0.1).dynamics(0.2).next_impact([0.0, 1.0], [0.0, -50.0])
    assert np.isnan(cycle.phase[0]) and cycle.time[0] == np.inf
    assert np.isfinite(cycle.phase[1])
    # Of no ball there is no impact.
    assert SpringDamper(10.0, 0.1).dynamics(0.2).next_impact([], []).phase.shape == (0,)


@pytest.mark.parametrize("release", RELEASES)
def test_a_ball_among_many_moves_exactly_as_alone(release):
    rng = np.random.default_rng(3)
    size = 15
    lam = rng.uniform(0.5, 4.0, size)
    omega = rng.uniform(1.5, 50.0, size)
    zeta = rng.uniform(0.0, 0.4, size)
    phase = rng.uniform(-3.0, 3.0, size)
    velocity = lam * np.cos(phase) - rng.uniform(0.0, 5.0, size)
    many = SpringDamper(omega, zeta, release).dynamics(lam).simulate(phase, velocity, 30)
    for k in range(size):
        contact = SpringDamper(float(omega[k]), float(zeta[k]), release)
        one = contact.dynamics(float(lam[k])).simulate(float(phase[k]), float(velocity[k]), 30)
        assert one.status == many.status[k]
        for name in ("time", "phase", "relative_velocity", "contact_duration", "displacement"):
            np.testing.assert_array_equal(getattr(one, name), getattr(many, name)[:, k], name)


def test_the_size_of_blocks_changes_nothing():
    """More balls than a block holds, in a shape of two dimensions."""
    rng = np.random.default_rng(4)
    phase = rng.uniform(-3.0, 3.0, (2, 9000))
    contact = SpringDamper(10.0, 0.05)
    many = contact.dynamics(1.5).simulate(phase, -4.0, 5)
    assert many.phase.shape == (5, 2, 9000)
    few = contact.dynamics(1.5).simulate(phase[1, -3:], -4.0, 5)
    np.testing.assert_array_equal(many.phase[:, 1, -3:], few.phase)
    cycle = contact.dynamics(1.5).next_impact(many.phase[0], many.relative_velocity[0])
    np.testing.assert_array_equal(cycle.phase, many.phase[1])


@settings(max_examples=40)
@given(
    lam=st.floats(0.0, 6.0),
    omega=st.floats(0.3, 200.0),
    zeta=st.floats(0.02, 0.9),
    phase=st.floats(-3.2, 3.2),
    speed=st.floats(0.0, 8.0),
    release=st.sampled_from(RELEASES),
)
def test_a_ball_is_unloaded_in_flight_and_loaded_in_contact(
    lam, omega, zeta, phase, speed, release
):
    """In flight above the table or, after a release by force, unloaded; in contact below
    it or, by force, loaded."""
    contact = SpringDamper(omega, zeta, release)
    velocity = lam * np.cos(phase) - speed
    sequence = contact.dynamics(lam).simulate(phase, velocity, 15)
    last = np.max(sequence.time[np.isfinite(sequence.time)])
    dense = motion_at(sequence, np.linspace(0, last, 3000))
    lag = 2 * zeta / omega if release is Release.FORCE else 0.0
    relative = dense.velocity - lam * np.cos(phase + dense.time)
    loaded = dense.gap + lag * relative
    # δ is known to the rounding of its parts, z up to 50 and Λ/ϖ²; over a long run the
    # clock, up to 1000, moves samples near an event by 1e-13 times a velocity of 10.
    noise = 1e-12
    flying = ~dense.touching
    assert np.all(np.maximum(dense.gap, loaded)[flying] >= -noise)
    assert np.all(loaded[~flying] <= noise)


def test_a_ball_that_rides_the_table_for_thousands_of_oscillations_leaves_it():
    """A ball that hardly moves rides the table for thousands of oscillations of the contact,
    in which nothing decays, before it leaves; no zero is passed over on the way."""
    omega, lam, phase = 3000.0, 0.999, 2.0
    ride = SpringDamper(omega, 0.0).dynamics(lam).simulate(phase, lam * np.cos(phase), 1)
    assert ride.status == Status.BOUNCING and 1.0 < ride.contact_duration[0] < 10.0
    s = np.linspace(0.0, float(ride.contact_duration[0]), 400_001)[1:-1]
    steady = -1 / omega**2 + lam * np.sin(s + phase) / (omega**2 - 1)
    start = -1 / omega**2 + lam * np.sin(phase) / (omega**2 - 1)
    rate = lam * np.cos(phase) / (omega**2 - 1)
    free = -start * np.cos(omega * s) - rate / omega * np.sin(omega * s)
    # In units of the static compression; the phase ϖ s is known to 1e-12.
    assert np.all((steady + free) * omega**2 < 1e-11)


@pytest.mark.parametrize("detuning", [0.0, 1e-9, 1e-6, 1e-3])
def test_next_to_the_undamped_resonance_a_contact_ends_where_its_flow_does(detuning):
    """There the steady part is infinite, and near it all digits are lost against the transient."""
    contact = SpringDamper(1 + detuning, 0.0)
    impact = contact.dynamics(1.2).simulate(0.4, 1.2 * np.cos(0.4) - 3, 1)
    # The flow keeps its digits at the resonance too.
    end = contact.flow(impact.contact_duration[0], 0.0, -3.0, 0.4, 1.2)
    assert abs(end.displacement) < 1e-12
    assert abs(end.velocity - impact.relative_bounce_velocity[0]) < 1e-12


def test_the_cycle_has_a_smooth_limit_at_critical_damping():
    """ζ → 1: the bound by half a free period is of no use, and not needed."""
    zeta = np.array([0.99, 0.99999, 1 - 1e-9])
    cycle = SpringDamper(3.0, zeta).dynamics(2.0).next_impact(-0.5, -3.0)
    # A smooth limit: the cycle changes by as little as ζ, times 100.
    assert np.all(np.isfinite(cycle.time))
    assert abs(cycle.time[1] - cycle.time[2]) < 1e-3
