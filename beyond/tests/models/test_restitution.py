"""Impacts with a restitution coefficient: exact answers, chattering, sticking, lift-off."""

import numpy as np
import pytest
from bounces_in_digits import summed
from hypothesis import given, settings
from hypothesis import strategies as st

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.inherited.models.restitution import lift_off_phase
from bouncing_ball_beyond.models.history import motion_at
from bouncing_ball_beyond.models.restitution import RestitutionDynamics
from bouncing_ball_beyond.models.rigid import RestitutionModel


def test_an_elastic_ball_on_a_table_at_rest_keeps_its_energy():
    sequence = RestitutionModel(1.0).simulate(0.0, 0.3, -2.0, 1000)
    assert np.all(sequence.impact_velocity == -2) and np.all(np.diff(sequence.time) == 4)


@pytest.mark.parametrize("r", [0.1, 0.5, 0.9, 0.99])
def test_chattering_on_a_table_at_rest_is_a_geometric_series(r):
    speed = 3.0
    sequence = RestitutionModel(r).simulate(0.0, 0.0, -speed / r, 3000)
    count = int(sequence.impacts)
    assert sequence.status == Status.PERMANENT_CONTACT
    index = np.arange(count)
    # Rounding of each impact adds up, at most 1500 of them.
    np.testing.assert_allclose(
        sequence.relative_velocity[1:count], -speed * r ** index[:-1], rtol=1e-12
    )
    rest = sequence.time[count - 1] + sequence.settling[count - 1]
    assert abs(rest - 2 * speed / (1 - r)) < 1e-12 * rest


@pytest.mark.parametrize("lam", [1.0001, 1.2, 2.0, 3.0])
def test_a_ball_at_rest_lifts_off_where_the_table_falls_with_gravity(lam):
    """A ball at rest on the table leaves it where Λ sin τ = 1 on the way up."""
    sequence = RestitutionModel(0.3).simulate(lam, -0.4, lam * np.cos(-0.4), 2)
    assert abs(float(sequence.release_phase[0]) - np.arcsin(1 / lam)) < 1e-14
    assert float(sequence.contact_duration[0]) == pytest.approx(0.4 + np.arcsin(1 / lam))
    assert sequence.relative_bounce_velocity[0] == 0 and sequence.settling[0] == 0
    # It lands where free flight from there meets the table.
    start = float(lift_off_phase(lam))
    s = float(sequence.time[1] - sequence.contact_duration[0])
    gap = 1 + s * lam * np.cos(start) - s * s / 2 - lam * np.sin(start + s)
    assert s > 4 * np.cos(start) and abs(gap) < 1e-14 * (1 + s * s)


def test_a_table_below_gravity_keeps_the_ball():
    sequence = RestitutionModel(0.5).simulate([0.0, 0.5, 1.0], 0.0, -6.0, 300)
    assert np.all(sequence.status == Status.PERMANENT_CONTACT)
    assert np.all(np.isnan(sequence.relative_bounce_velocity[sequence.contact_duration > 0]))


@pytest.mark.parametrize(("r", "lam"), [(0.5, 0.8), (0.3, 1.4), (0.8, 0.0)])
def test_the_time_of_chattering_is_that_of_all_its_bounces(r, lam):
    phase = -1.0
    speed = 0.2
    sequence = RestitutionModel(r).simulate(lam, phase, lam * np.cos(phase) - speed / r, 200)
    stuck = int(np.argmax(sequence.contact_duration > 0))
    assert sequence.time[stuck] > 0
    settled = sequence.time[stuck] + sequence.settling[stuck]
    # The first term that the sum leaves out is below 1e-15.
    assert settled == pytest.approx(summed(r, lam, phase, speed), abs=1e-14)


def test_many_balls_move_exactly_as_each_of_them_alone():
    rng = np.random.default_rng(5)
    r = rng.uniform(0.1, 1.0, 15)
    lam = rng.uniform(0.0, 4.0, 15)
    phase = rng.uniform(-3.0, 3.0, 15)
    velocity = lam * np.cos(phase) - rng.uniform(0.0, 5.0, 15)
    many = RestitutionModel(r).simulate(lam, phase, velocity, 40)
    for k in range(15):
        one = RestitutionModel(r[k]).simulate(lam[k], phase[k], velocity[k], 40)
        for name in ("time", "phase", "relative_velocity", "contact_duration", "settling"):
            np.testing.assert_array_equal(getattr(one, name), getattr(many, name)[:, k], name)


@settings(max_examples=40)
@given(
    r=st.floats(0.05, 1.0),
    lam=st.floats(0.0, 6.0),
    phase=st.floats(-3.2, 3.2),
    speed=st.floats(0.0, 8.0),
)
def test_the_ball_stays_above_the_table(r, lam, phase, speed):
    sequence = RestitutionModel(r).simulate(lam, phase, lam * np.cos(phase) - speed, 25)
    last = np.max(sequence.time[np.isfinite(sequence.time)])
    dense = motion_at(sequence, np.linspace(0, last, 3000))
    # The rounding of the clock times the velocity, as for the spring-damper.
    assert np.nanmin(dense.gap) >= -1e-12
    # Each impact obeys the law and happens on the table, for flights of some length.
    flown = np.isfinite(sequence.time[1:])
    assert np.all(sequence.relative_velocity[1:][flown] <= 0)


def test_an_array_without_balls_gives_arrays_without_balls():
    model = RestitutionModel(0.5)
    phase = np.zeros((0, 2))
    assert model.simulate(1.0, phase, -1.0, 3).time.shape == (3, 0, 2)
    assert model.cycle(1.0, phase, -1.0).time.shape == (0, 2)


def test_parameters_and_states_out_of_range_are_refused_in_one_line(refusal):
    for (r, *arguments), part in (
        ((-0.1, 1.0, 0.0, 3.0, 2), "[0, 1]"),
        ((0.5, -1.0, 0.0, 3.0, 2), "amplitude"),
        ((0.5, np.inf, 0.0, 3.0, 2), "amplitude"),
        ((0.5, 1.0, 0.0, 1 + 1e-12, 2), "rises"),
        ((0.5, 1.0, np.inf, 0.5, 2), "finite"),
    ):
        with refusal(ModelError, part):
            RestitutionModel(r).simulate(*arguments)


@pytest.mark.parametrize("r", [0.05, 0.3, 0.9, 0.97])
def test_the_bound_on_the_bounces_of_a_ball_that_comes_to_rest_is_not_too_short(r, monkeypatch):
    """Without the bound each ball is followed through all its bounces."""
    rng = np.random.default_rng(5)
    lam = rng.uniform(0.5, 3.0, 2000)
    phase = rng.uniform(-np.pi, np.pi, 2000)
    speed = np.exp(rng.uniform(np.log(1e-4), np.log(2.0), 2000))
    held = np.flatnonzero((lam * np.sin(phase) < 1) & (lam > 1))
    dynamics = RestitutionDynamics.of(r, lam[held])
    impact = dynamics.start(phase[held], -speed[held])
    settles = dynamics.comes_to_rest(impact)
    monkeypatch.setattr(RestitutionDynamics, "_rests_within", lambda self, impact, left: left < 0)
    assert np.array_equal(settles, dynamics.comes_to_rest(impact))
    assert 0.4 < np.mean(settles) < 1


def longest_bounces(v, r, g, most):
    """The sum of all bounces of a ball that lands as fast as gravities in [g, most] let it."""
    whole = 0.0
    while v > 1e-12:
        whole += 2 * v / g
        v *= r * (2 * most / g - 1)
    return whole


@pytest.mark.parametrize("r", [0.3, 0.6, 0.8])
def test_the_bound_on_all_bounces_is_their_longest_sum(r):
    """Within 1.25 times the bounces at constant gravity, which may change by Λ times that."""
    lam = np.linspace(0.0, 2.5, 500)
    speed = 0.05
    dynamics = RestitutionDynamics.of(r, lam)
    impact = dynamics.start(np.zeros(500), np.full(500, -speed))
    found = dynamics._rests_within(impact, np.full(500, np.inf))
    window = 1.25 * 2 * r * speed / (1 - r)
    least, most = 1 - lam * window, 1 + lam * window
    converges = (least > 0) & (r * (2 * most / least - 1) < 1 - 1e-6)
    right = [
        bool(yes) and longest_bounces(r * speed, r, g, a) <= window
        for yes, g, a in zip(converges, least, most, strict=True)
    ]
    assert found.tolist() == right
    assert 0 < np.sum(found) < 500
