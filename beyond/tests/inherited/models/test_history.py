"""Balls over time: legs, sequences of impacts and histories, against a second simulation."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import bouncing_ball_beyond.inherited
from bouncing_ball_beyond.inherited import rigid, spring_damper
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.models import simulation
from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.inherited.models.restitution import RestitutionModel
from bouncing_ball_beyond.inherited.models.simulation import (
    impacts_of,
    impacts_until,
    motion_at,
    next_impact,
)
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper, force

MODELS = [
    RestitutionModel(0.6),
    SpringDamper.from_restitution(0.6, 30.0),
    SpringDamper.from_restitution(0.6, 30.0, "force"),
    SpringDamper(4.0, 0.2, "force"),
]
every_model = pytest.mark.parametrize("model", MODELS, ids=lambda model: model.label)


def integrated(model, amplitude, phase, velocity, end):
    """Height and velocity at a time, by an integrator that switches between contact and flight."""

    def relative(time, state):
        return state[0] - amplitude * np.sin(phase + time), state[1] - amplitude * np.cos(
            phase + time
        )

    def motion(time, state):
        gap, rate = relative(time, state)
        pushed = force(model.frequency_ratio, model.damping_ratio, -gap, -rate) if touching else 0.0
        return [state[1], pushed - 1]

    def switches(time, state):
        gap, rate = relative(time, state)
        force_is_gone = gap + model.lag * rate
        if time - began < 1e-6:
            return -1.0  # the event that led here
        if touching:
            return force_is_gone
        # A contact begins at the table's level, or below it where its force returns.
        return -force_is_gone if gap < 0 else -gap

    switches.terminal = True
    switches.direction = 1
    precise = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13, "max_step": 0.02}
    began = 0.0
    touching = True
    state = np.array([amplitude * np.sin(phase), velocity])
    while began < end:
        found = solve_ivp(motion, (began, end), state, events=switches, **precise)
        began, state = found.t[-1], found.y[:, -1]
        touching = not touching
    return state


@pytest.mark.parametrize("model", MODELS[1:], ids=lambda model: str(model))
def test_a_history_is_that_of_an_integrator_with_events(model):
    for amplitude, phase, velocity in ((0.4, 0.2, -2.0), (1.3, -1.0, -3.0), (2.2, 2.0, -2.5)):
        end = 9.0
        found = impacts_until(model, *(np.full(1, x) for x in (amplitude, phase, velocity, end)))
        assert np.sum(np.isfinite(found.time)) > 1
        motion = motion_at(found, 0, np.array([end]))
        expected = integrated(model, amplitude, phase, velocity, end)
        # Each event adds the error of its time, some 1e-11, and a few events multiply it.
        assert motion.height[0] == pytest.approx(expected[0], abs=1e-7)
        assert motion.velocity[0] == pytest.approx(expected[1], abs=1e-7)


@every_model
def test_many_balls_move_exactly_as_each_of_them_alone(model):
    rng = np.random.default_rng(5)
    lam = rng.uniform(0.0, 3.0, 12)
    phase = rng.uniform(-3.0, 3.0, 12)
    velocity = lam * np.cos(phase) - rng.uniform(0.1, 5.0, 12)
    many = impacts_of(model, lam, phase, velocity, 20)
    for k in range(12):
        one = impacts_of(model, lam[k], phase[k], velocity[k], 20)
        assert one.status[0] == many.status[k]
        for name in ("time", "phase", "relative_velocity", "contact_duration", "displacement"):
            np.testing.assert_array_equal(getattr(one, name)[:, 0], getattr(many, name)[:, k], name)


@every_model
def test_a_sequence_joins_contacts_and_flights_without_jumps(model):
    found = impacts_of(model, 1.9, 0.4, -3.0, 12)
    impacts = found.time[:, 0]
    assert np.isfinite(impacts).all()
    near = 1e-9
    for time in impacts[1:-1]:
        motion = motion_at(found, 0, np.array([time - near, time + near]))
        # The height changes by the velocities, which are below 6, in this time.
        assert abs(np.diff(motion.height)[0]) < 20 * near
        if not isinstance(model, RestitutionModel):
            assert abs(np.diff(motion.velocity)[0]) < 2e4 * near
    released = impacts[:-1] + found.contact_duration[:-1, 0]
    at = motion_at(found, 0, released + near)
    assert at.velocity == pytest.approx(found.bounce_velocity[:-1, 0], abs=20 * near)
    before = motion_at(found, 0, impacts[1:] - near)
    assert before.velocity == pytest.approx(found.impact_velocity[1:, 0], abs=20 * near)
    of_table = 1.9 * np.sin(0.4 + impacts)
    assert motion_at(found, 0, impacts).table == pytest.approx(of_table, abs=1e-12)


def test_after_a_release_by_force_a_slow_ball_resumes_its_contact_below_the_table():
    model = SpringDamper(2.0, 0.5, "force")
    found = impacts_of(model, np.linspace(0.3, 3.0, 60), 0.0, -1.0, 30)
    resumed = found.displacement < 0
    assert resumed.any()
    lag = model.lag
    ends = found.displacement + lag * found.relative_velocity
    assert np.abs(ends[resumed]).max() < 1e-13
    releases = found.release_displacement + lag * found.relative_bounce_velocity
    assert np.nanmax(np.abs(releases)) < 1e-13


def test_before_the_first_impact_and_after_the_last_contact_nothing_is_known():
    found = impacts_of(RestitutionModel(1.0), 0.0, 0.0, -2.0, 2)
    motion = motion_at(found, 0, np.array([-1.0, 1.0, 4.0, 5.0]))
    assert np.isnan(motion.height[[0, 3]]).all() and motion.height[1:3].tolist() == [1.5, 0.0]
    assert motion.touching.tolist() == [False, False, True, False]


def test_a_ball_that_rises_at_first_and_a_wrong_start_are_refused(refusal):
    with refusal(ModelError, "rises"):
        impacts_of(RestitutionModel(0.5), 1.0, 0.0, 1 + 1e-12, 2)
    with refusal(ModelError, "velocity"):
        bouncing_ball_beyond.inherited.simulate(
            rigid(restitution=0.5), amplitude=1.0, velocity="down"
        )
    with refusal(ModelError, "amplitude"):
        bouncing_ball_beyond.inherited.simulate(rigid(restitution=0.5), amplitude=-1.0)
    with refusal(ModelError, "above the table"):
        bouncing_ball_beyond.inherited.drop(
            rigid(restitution=0.5), height=0.5, amplitude=1.0, phase=1.5
        )


def test_a_sequence_of_too_many_impacts_is_refused(refusal, monkeypatch):
    monkeypatch.setattr(simulation, "_MOST", 50)
    elastic = rigid(restitution=1.0)
    with refusal(ModelError, "more than 50 impacts in this time: use fewer periods"):
        bouncing_ball_beyond.inherited.history(
            elastic, amplitude=0.0, velocity=-1.0, periods=20.0, samples=1
        )
    found = bouncing_ball_beyond.inherited.history(
        elastic, amplitude=0.0, velocity=-1.0, periods=15.0, samples=1
    )
    assert np.isfinite(found.ball).all()


def test_the_next_impact_has_the_shape_of_its_arguments():
    phase = np.zeros((0, 2))
    assert next_impact(RestitutionModel(0.5), phase, -1.0, 1.0).time.shape == (0, 2)
    lam = np.array([[0.5], [2.0]])
    found = next_impact(RestitutionModel([0.5, 0.7, 0.9]), 0.3, -1.0, lam)
    assert found.time.shape == found.departure.status.shape == (2, 3)
    assert next_impact(RestitutionModel(0.5), 0.3, -1.0, 0.5).time.shape == ()


def test_simulations_are_labelled_by_their_arguments():
    ball = spring_damper(frequency_ratio=[10.0, 20.0], restitution=0.7)
    found = bouncing_ball_beyond.inherited.simulate(ball, amplitude=[0.5, 1.5, 2.5], impacts=5)
    assert dict(found.sizes) == {"amplitude": 3, "frequency_ratio": 2, "impact": 5}
    one = impacts_of(SpringDamper.from_restitution(0.7, 20.0), 1.5, 0.0, -np.pi, 5)
    here = found.sel(amplitude=1.5, frequency_ratio=20.0)
    assert here.time.values.tolist() == one.time[:, 0].tolist()
    assert here.impact_velocity.values.tolist() == one.impact_velocity[:, 0].tolist()
    assert here.status.item() == Status(int(one.status[0])).words


def test_a_dropped_ball_falls_freely_and_its_history_goes_on_as_from_its_impact():
    ball = rigid(restitution=0.5)
    found = bouncing_ball_beyond.inherited.drop(
        ball, height=3.0, amplitude=0.8, phase=0.4, periods=3.0, samples=50
    )
    time = found.time.values
    landing = brentq(lambda at: 3.0 - at**2 / 2 - 0.8 * np.sin(0.4 + at), 0.0, 3.0)
    falling = time < landing
    fall = time[falling]
    assert found.ball.values[falling] == pytest.approx(3.0 - fall**2 / 2, abs=1e-14)
    assert found.ball_velocity.values[falling].tolist() == (-fall).tolist()
    assert found.table.values == pytest.approx(0.8 * np.sin(0.4 + time), abs=1e-13)
    # After the impact, Eq. 2, it flies on.
    of_table = 0.8 * np.cos(0.4 + landing)
    bounced = of_table - 0.5 * (-landing - of_table)
    after = int(np.sum(falling))
    speed = bounced - (time[after] - landing)
    assert found.ball_velocity.values[after] == pytest.approx(speed, abs=1e-12)
    again = bouncing_ball_beyond.inherited.history(
        ball, amplitude=0.8, phase=0.4, velocity=-2.0, periods=1.0
    )
    assert again.ball.values[0] == pytest.approx(0.8 * np.sin(0.4), abs=1e-15)
