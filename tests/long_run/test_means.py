"""Means over motions against quadrature, the energy balance, and orders of convergence."""

from itertools import islice

import numpy as np
import pytest

from bouncing_ball.beyond.exhibits.motion_samples import three_models
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.means import means
from bouncing_ball.long_run.sampled_means import Starts, advance, start
from bouncing_ball.models.contact_model import ContactModel
from bouncing_ball.models.damping import Release
from bouncing_ball.models.laws.contact_law import ContactLaw
from bouncing_ball.models.laws.hertzian import LinearHuntCrossley
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper

RELEASE = Release.DISPLACEMENT


def found_and_means(model, amplitude, samples=100):
    velocity = amplitude * np.cos(1.0) - 9.0
    found = final_motions(model, amplitude, 1.0, velocity, impacts=250)
    return found, means(model, amplitude, found, samples)


@pytest.mark.parametrize(
    ("r", "amplitude", "ratio", "release"),
    [
        (0.85, 2.0, 3.0, Release.DISPLACEMENT),
        pytest.param(0.6, 3.0, 80.0, Release.FORCE, marks=pytest.mark.long),
    ],
)
def test_height_and_power_are_those_of_quadrature(r, amplitude, ratio, release, monkeypatch):
    """A chaotic motion and a locked one: closed forms against sums over collocation panels."""
    for model in three_models(np.array(r), ratio, release)[::2]:
        found, of = found_and_means(model, amplitude)
        monkeypatch.setattr(SpringDamper, "over_contact", ContactLaw.over_contact)
        last = Starts(np.array([found.end_phase]), np.array([found.end_velocity]))
        _, (time, *sums) = advance(*start(model, amplitude, last), int(found.impacts) or 100)
        wanted = np.ravel(sums / time)
        assert [float(x) for x in of[1:3]] == pytest.approx(wanted, rel=1e-10)
        monkeypatch.undo()


def test_on_a_locked_orbit_the_table_gives_what_impacts_dissipate():
    found, of = found_and_means(three_models(np.array(0.6), 80.0, RELEASE)[0], 3.0)
    sequence = three_models(np.array(0.6), 80.0, RELEASE)[0].simulate(
        3.0, float(found.end_phase), float(found.end_velocity), int(found.impacts) + 1
    )
    lost = (1 - 0.6**2) / 2 * np.sum(sequence.relative_velocity[:-1] ** 2)
    # What is lost in the bounces that are summed up is of the order of 1e-10.
    assert float(of[2]) == pytest.approx(lost / sequence.time[-1], abs=1e-9)
    assert np.isposinf(of[0])


def test_errors_of_the_means_are_of_first_and_of_second_order():
    """Of the restitution and the corrected model, on the 1-T orbit."""
    errors = []
    for ratio in (200.0, 400.0):
        simple, corrected, exact = (
            np.array(found_and_means(x, 1.2)[1][1:3])
            for x in three_models(np.array(0.5), ratio, RELEASE)
        )
        errors.append([simple / exact - 1, corrected / exact - 1])
    order = np.log2(np.divide(*errors))
    # The next order contributes a share of 1/ϖ, times a coefficient of some units.
    assert np.allclose(order, [[1, 1], [2, 2]], atol=0.1)


def test_the_exponent_is_the_mappers_and_a_ball_at_rest_has_no_means():
    law = RestitutionModel(np.array([0.85, 0.85]))
    found = final_motions(law, np.array([2.0, 0.9]), 0.0, np.array([-9.0, 0.0]), impacts=400)
    of = means(law, np.array([2.0, 0.9]), found, 400)
    assert abs(of[3, 0] - found.exponent[0]) < 8 * found.exponent_error[0]
    assert found.kind[1] == "permanent contact" and np.isnan(of[:, 1]).all()


def test_a_deviation_grows_as_the_product_of_the_derivatives_says():
    """Over eight impacts of a chaotic ball, from a deviation of the phase."""
    model = ContactModel(SpringDamper.from_restitution(0.85, 50.0, RELEASE))
    found, of = found_and_means(model, 2.0, samples=8)
    assert found.kind == "chaotic"
    dynamics, first, relative, _ = model.dynamics(2.0).first_impacts(
        found.end_phase, found.end_velocity
    )
    product = np.eye(2)
    time = 0.0
    for leg in islice(dynamics.legs(dynamics.start(first, relative), differentiate=True), 8):
        by = leg.jacobian()
        product = np.array([[by.a[0], by.b[0]], [by.c[0], by.d[0]]]) @ product
        time += float(leg.passed[0])
    growth = np.log(np.linalg.norm(product[:, 0]))
    assert float(of[3]) == pytest.approx(2 * np.pi * growth / time, rel=1e-12)


def test_a_law_whose_contact_is_a_spring_has_the_means_of_the_linear_contact():
    amplitude = np.array([0.7, 1.3])
    spring = ContactModel(SpringDamper(20.0, 0.0, Release.FORCE))
    found = final_motions(spring, amplitude, 0.5, -4.0, impacts=3)
    linear = means(spring, amplitude, found, 5)
    general = means(LinearHuntCrossley(400.0, 0.0), amplitude, found, 5)
    assert np.allclose(general, linear, rtol=1e-9)
