"""Derivatives of the Poincaré map against differences and against the contraction of areas."""

import numpy as np
import pytest

from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.deviations import Jacobian
from bouncing_ball_beyond.models.laws.hertzian import Tsuji, tsuji_damping
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper

LAM, STEP = 1.8, 1e-6
LAWS = [
    RestitutionModel(0.7),
    ContactModel(SpringDamper.from_restitution(0.7, 30.0)),
    ContactModel(SpringDamper.from_restitution(0.7, 30.0, "force")),
    # Here one contact in ten resumes below the table's level.
    ContactModel(SpringDamper(2.0, 0.9, "force")),
    CorrectedModel(Signature(SpringDamper.from_restitution(0.7, 30.0))),
    Tsuji(2000.0, tsuji_damping(0.7)),
    CorrectedModel(Signature(Tsuji(2000.0, tsuji_damping(0.7)))),
]


def step(law, phase, velocity):
    """The two states of a step on the section, its Jacobian and the contact's duration."""
    dynamics, *state, _ = law.dynamics(LAM).first_impacts(phase, velocity + LAM * np.cos(phase))
    impact = dynamics.start(*state)
    departure = dynamics.depart(impact, differentiate=True)
    after, passed = dynamics.fly(departure)
    jacobian = dynamics.jacobian(impact, departure, after, passed)
    states = np.array([dynamics.section().state(each) for each in (impact, after)])
    return states, jacobian, departure.duration


def starts(balls=200):
    rng = np.random.default_rng(1)
    return rng.uniform(-3, 3, balls), -rng.uniform(2, 9, balls)


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_the_jacobian_is_that_of_the_simulated_map(law):
    phase, velocity = starts()
    _, jacobian, _ = step(law, phase, velocity)
    around = [(step(law, phase + a, velocity + b)[0], step(law, phase - a, velocity - b)[0])
              for a, b in ((STEP, 0), (0, STEP))]  # fmt: skip
    # Of both ends in the start (φ, δ′): the section of the corrected model is the instant.
    slopes = [(f - b) / (2 * STEP) for f, b in around]
    first, last = np.moveaxis(slopes, (1, 0), (0, 3)).swapaxes(1, 2)
    expected = (last @ np.linalg.inv(first)).reshape(-1, 4).T
    size = np.abs(expected).max(axis=0)
    # Central differences: the rounding of the states over the step, and the step squared times
    # third derivatives, which are large next to a grazing.
    error = np.abs(np.array(jacobian) - expected) / (1 + size)
    assert np.median(error) < 1e-9
    assert np.quantile(error, 0.99) < 1e-7


def test_areas_shrink_by_the_impact_and_by_nothing_else():
    phase, velocity = starts()
    contact = SpringDamper.from_restitution(0.7, 30.0)
    for case, loss in (
        (RestitutionModel(0.7), lambda _: 0.49),
        (ContactModel(contact), lambda d: np.exp(-2 * contact.damping_ratio * 30 * d)),
    ):
        (before, after), of, duration = step(case, phase, velocity)
        # The flow keeps areas across it: a section that it crosses slowly is wide.
        expected = loss(duration) * before[1] / after[1]
        np.testing.assert_allclose(of.a * of.d - of.b * of.c, expected, rtol=1e-8)


def test_the_fixed_point_of_a_linear_map_is_one_step_away():
    matrix = np.array([[0.5, -0.7], [0.4, 0.2]])
    fixed = np.array([0.3, -1.1])
    state = np.array([2.0, 1.0])
    moved = matrix @ (state - fixed) + fixed - state
    jacobian = Jacobian(*(x[np.newaxis] for x in matrix.ravel()))
    step = np.ravel(jacobian.to_fixed_point(*(x[np.newaxis] for x in moved)))
    np.testing.assert_allclose(state + step, fixed, rtol=1e-14)
    modulus = np.abs(np.linalg.eigvals(matrix)).max()
    assert float(jacobian.spectral_radius()[0]) == pytest.approx(modulus, rel=1e-14)
