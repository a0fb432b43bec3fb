"""Legs from impact to impact: against the simulation, the Poincaré map and side-by-side balls."""

from itertools import islice

import numpy as np
import pytest

from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.models.restitution import RestitutionDynamics
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t

CONTACT = SpringDamper.from_restitution(0.6, 30.0, Release.FORCE)
MODELS = [RestitutionModel(0.6), ContactModel(CONTACT), CorrectedModel.of_contact(CONTACT)]


@pytest.mark.parametrize("model", MODELS)
def test_legs_are_the_impacts_of_the_simulation(model):
    lam = np.array([0.4, 1.7, 3.0])
    velocity = lam - 4.0
    path = model.simulate(lam, 0.0, velocity, 40)
    dynamics, phase, relative, _ = model.dynamics(lam).first_impacts(np.zeros(3), velocity)
    ball = np.arange(3)
    time = np.zeros(3)
    left = []
    for k, leg in enumerate(islice(dynamics.legs(dynamics.start(phase, relative)), 40)):
        assert leg.impact.phase.tolist() == path.phase[k, ball].tolist()
        assert leg.departure.duration.tolist() == path.contact_duration[k, ball].tolist()
        assert time.tolist() == path.time[k, ball].tolist()
        ball, time = leg.keep(leg.bouncing(), ball, time)
        time = time + leg.fly()[1]
        left.append(ball.size)
    # The first ball comes to rest on the slow table; the others are followed to the end.
    assert (left[0], left[-1]) == (3, 2) and path.impacts[0] < 40


def test_without_balls_there_are_no_more_legs():
    dynamics = RestitutionDynamics.of(0.5, 0.0)
    first = dynamics.start(np.zeros(2), np.full(2, -1.0))
    seen = []
    for leg in dynamics.legs(first):
        leg.keep(leg.bouncing())
        seen.append(leg.fly()[0].phase.size)
    assert seen[0] == 2 and seen[-1] == 0 and len(seen) < 30


def test_after_the_flight_the_balls_kept_begin_the_next_leg_with_the_impacts_given():
    dynamics = RestitutionDynamics.of(1.0, np.zeros(3))
    legs = dynamics.legs(dynamics.start(np.zeros(3), np.array([-1.0, -2.0, -3.0])))
    leg = next(legs)
    after, passed = leg.fly()
    assert passed.tolist() == [2.0, 4.0, 6.0]
    (name,) = leg.keep(np.array([0, 2]), np.array(["a", "b", "c"]))
    assert name.tolist() == ["a", "c"]
    leg.after = leg.after._replace(velocity=2 * leg.after.velocity)
    assert next(legs).fly()[1].tolist() == [4.0, 12.0]
    assert after.phase.size == 3


def test_a_simulation_computes_no_flight_after_its_last_impact(monkeypatch):
    flights = []
    monkeypatch.setattr(
        RestitutionDynamics,
        "fly",
        lambda self, departure: flights.append(1) or Dynamics.fly(self, departure),
    )
    RestitutionModel(0.5).simulate(2.0, 0.0, -3.0, 4)
    assert len(flights) == 3


def test_next_to_an_orbit_a_deviation_grows_by_its_floquet_multiplier():
    # Next to the period doubling the multipliers are real, and the larger one decides.
    orbit = n_t.orbit(RestitutionModel(0.5), 1, 1.52)
    multiplier = np.abs(orbit.multipliers()).max()
    dynamics = RestitutionDynamics.of(0.5, 1.52)
    first = dynamics.start(np.array([orbit.phase]), np.array([-4.5]))
    deviation = np.ones(1), np.zeros(1)
    growth = []
    for leg in islice(dynamics.legs(first, differentiate=True), 2048):
        along, across = leg.jacobian().apply(*deviation)
        length = np.hypot(along, across)
        deviation = along / length, across / length
        growth.append(float(np.log(length[0])))
    assert np.mean(growth[64:]) == pytest.approx(np.log(multiplier), rel=1e-3)


@pytest.mark.parametrize("model", MODELS)
def test_two_neighbours_separate_as_the_product_of_the_derivatives_says(model):
    near = 1e-9
    dynamics = model.dynamics(1.75)
    states = []
    deviation = np.ones(2), np.zeros(2)
    first = dynamics.section().impact(np.array([1.0, 1.0 + near]), np.full(2, -5.0))
    for leg in islice(dynamics.legs(first, differentiate=True), 5):
        deviation = leg.jacobian().apply(*deviation)
        states.append(np.array(dynamics.section().state(leg.after)))
    apart = states[-1][:, 1] - states[-1][:, 0]
    assert apart / near == pytest.approx([x[0] for x in deviation], rel=1e-3)
