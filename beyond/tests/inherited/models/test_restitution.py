"""Impacts with a restitution coefficient: exact answers, chattering, rest, lift-off."""

import numpy as np
import pytest
from bounces_in_digits import summed
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball_beyond.inherited import limits, orbit, rigid, simulate
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.inherited.models.restitution import (
    RestitutionModel,
    chattering,
    lift_off_phase,
)
from bouncing_ball_beyond.inherited.models.simulation import impacts_of, motion_at

EPS = np.finfo(float).eps


def test_an_elastic_ball_on_a_table_at_rest_keeps_its_energy():
    found = impacts_of(RestitutionModel(1.0), 0.0, 0.3, -2.0, 1000)
    assert np.all(found.impact_velocity == -2) and np.all(np.diff(found.time, axis=0) == 4)


@pytest.mark.parametrize("r", [0.1, 0.5, 0.9, 0.99])
def test_chattering_on_a_table_at_rest_is_a_geometric_series(r):
    speed = 3.0
    found = impacts_of(RestitutionModel(r), 0.0, 0.0, -speed / r, 3000)
    count = int(np.sum(np.isfinite(found.time)))
    assert found.status == Status.PERMANENT_CONTACT and count > 4
    index = np.arange(count - 1)
    # Rounding of each impact adds up, of at most 1500 of them.
    np.testing.assert_allclose(
        found.relative_velocity[1:count, 0], -speed * r**index, rtol=1500 * EPS
    )
    # The rest of the bounces is summed up from the last impact.
    rest = -2 * r * found.relative_velocity[count - 1, 0] / (1 - r)
    whole = found.time[count - 1, 0] + rest
    assert whole == pytest.approx(2 * speed / (1 - r), rel=1500 * EPS)


@pytest.mark.parametrize(
    ("r", "lam", "phase"), [(0.5, 0.8, -1.0), (0.3, 1.4, -1.0), (0.8, 0.0, 0.3), (0.6, 3.0, 2.9)]
)
def test_the_time_of_chattering_is_that_of_all_its_bounces(r, lam, phase):
    gravity = 1 - lam * np.sin(phase)
    speed = 4e-6 * (1 - r) * gravity**2 / max(lam, 1)
    x, y = lam * np.cos(phase), lam * np.sin(phase)
    rows = (np.full(1, each) for each in (speed, r, x, y, lam))
    sticks, time = chattering(*rows)
    assert sticks[0]
    exact = summed(r, lam, phase, speed)
    # The first term that the sum leaves out is some 1e-10 of the whole, far below the second.
    assert time[0] == pytest.approx(exact, rel=1e-9)
    first = 2 * speed / (gravity * (1 - r))
    if abs(x) > 0.1:
        assert abs(time[0] - exact) < 1e-3 * abs(first - exact)


@pytest.mark.parametrize("lam", [1.0001, 1.2, 2.0, 3.0])
def test_a_ball_at_rest_lifts_off_where_the_table_falls_with_gravity(lam):
    found = impacts_of(RestitutionModel(0.3), lam, -0.4, lam * np.cos(-0.4), 2)
    duration = float(found.contact_duration[0, 0])
    assert duration == pytest.approx(0.4 + np.arcsin(1 / lam), abs=1e-14)
    assert found.relative_bounce_velocity[0, 0] == 0
    # It lands where the free flight from there meets the table.
    start = float(lift_off_phase(lam))
    s = float(found.time[1, 0]) - duration
    gap = 1 + s * lam * np.cos(start) - s * s / 2 - lam * np.sin(start + s)
    assert s > 4 * np.cos(start) and abs(gap) < 1e-14 * (1 + s * s)


def test_a_table_below_gravity_keeps_the_ball():
    found = impacts_of(RestitutionModel(0.5), [0.0, 0.5, 1.0], 0.0, -6.0, 300)
    assert np.all(found.status == Status.PERMANENT_CONTACT)
    assert np.sum(np.isinf(found.contact_duration), axis=0).tolist() == [1, 1, 1]
    assert np.all(np.isnan(found.relative_bounce_velocity[np.isinf(found.contact_duration)]))


@given(st.floats(0.05, 1.0), st.floats(0.0, 6.0), st.floats(-3.2, 3.2), st.floats(0.0, 8.0))
def test_the_ball_stays_above_the_table_and_each_impact_obeys_the_law(r, lam, phase, speed):
    found = impacts_of(RestitutionModel(r), lam, phase, lam * np.cos(phase) - speed, 25)
    last = np.max(found.time[np.isfinite(found.time)])
    motion = motion_at(found, 0, np.linspace(0, last, 3000))
    # The rounding of the clock, of up to some hundred units, times the velocity.
    assert np.nanmin(motion.height - motion.table) >= -1e-12
    bounced = found.contact_duration == 0
    expected = -r * found.relative_velocity[bounced]
    assert np.array_equal(found.relative_bounce_velocity[bounced], expected)
    going = np.isfinite(found.relative_velocity)
    assert np.all(found.relative_velocity[going] <= 0)


def test_the_derivative_of_an_impact_and_its_determinant():
    model = RestitutionModel([0.3, 0.9])
    found = model.derivative(0.0, np.zeros(2), np.array([-1.0, -2.0]), 1.0)
    assert found.tolist() == [[[1.0, 0.0], [0.0, -0.3]], [[1.0, 0.0], [0.0, -0.9]]]
    assert model.contraction(0.0) == pytest.approx([0.09, 0.81], rel=4 * EPS)


@pytest.mark.parametrize("value", ["x", "0.5", True, None, ["1"], [[0.5], [0.5, 0.6]], -0.1, 1.01])
def test_what_is_no_restitution_coefficient_is_refused_where_the_model_is_made(value, refusal):
    with refusal(ModelError, f"restitution coefficient r = {value!r} is not in [0, 1]"):
        RestitutionModel(value)


def test_without_restitution_a_ball_stays_on_the_table_after_its_first_impact():
    """A textbook case. The ball rests until Λ sin τ = 1, and all later flights are the same."""
    amplitude = 1.5
    lift = np.arcsin(1 / amplitude)
    found = simulate(rigid(restitution=0.0), amplitude=amplitude, phase=-0.5, impacts=6)
    of_table = amplitude * np.cos(found.impact_phase + found.contact_duration)
    assert found.bounce_velocity.values == pytest.approx(of_table.values, abs=1e-14)
    leaves = np.mod(found.impact_phase + found.contact_duration, 2 * np.pi)
    assert leaves.values == pytest.approx(lift, abs=1e-14)
    assert np.diff(found.time.values)[1:] == pytest.approx(2 * np.pi, abs=1e-14)
    # On a table at rest it never leaves.
    still = simulate(rigid(restitution=0.0), amplitude=0.0, impacts=6)
    assert still.status.item() == "permanent contact"


def test_without_restitution_an_orbit_that_never_rests_begins_where_it_lifts_off_at_once():
    """Λ cos φ = π at the impact (Eq. 6), and Λ sin φ ≥ 1, at least as steep as the fall of a ball.

    The trace is 1 - Λ sin φ and the determinant 0, so that the period doubles at Λ sin φ = 2.
    """
    ball = rigid(restitution=0.0)
    fold, doubling = limits(ball)
    assert fold.amplitude == np.pi
    assert doubling.amplitude == pytest.approx(np.hypot(2, np.pi), rel=4 * EPS)
    first = np.hypot(1, np.pi)
    below, above = (orbit(ball, amplitude=first + side * 1e-4) for side in (-1, 1))
    assert not below.admissible and above.admissible and above.stable
    assert orbit(ball, amplitude=3.72).stable and not orbit(ball, amplitude=3.73).stable
