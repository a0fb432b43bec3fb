"""Quantities of the models, and the relative errors of the restitution model (Eqs. 37-38)."""

import numpy as np
import pytest

from bouncing_ball_beyond.inherited.accuracy.errors import (
    Quantity,
    modulus,
    relative_errors,
    values,
)
from bouncing_ball_beyond.inherited.models.restitution import RestitutionModel
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper
from bouncing_ball_beyond.inherited.periodic.explicit import explicit_branch, required_orbit
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation


def test_the_values_are_those_of_the_orbits_and_bifurcations_of_each_model():
    n, r, lam, omega = 2, 0.85, 1.0, 50.0
    exact = SpringDamper.from_restitution(r, omega)
    zeta = -np.log(r) / np.hypot(np.pi, np.log(r))
    half = n * np.pi
    fold = n * np.pi * (1 - r) / (1 + r)
    phi = np.arccos(fold / lam)
    flip = np.hypot(2 * (1 + r * r) / (1 + r) ** 2, fold)
    found = values(RestitutionModel(r), n, lam, list(Quantity))
    expected = [lam * np.sin(phi) + half**2 / 2, half, phi, r, fold, flip, 1.0]
    np.testing.assert_allclose(found, expected, rtol=1e-14)
    branch = explicit_branch(exact)
    orbit = required_orbit(branch.model, n, lam)
    of_contact = values(exact, n, lam, list(Quantity))
    names = "max_height", "bounce_velocity", "phase", "apparent_restitution"
    assert of_contact[:4].tolist() == [float(getattr(orbit, name)) for name in names]
    limits = [float(branch.bifurcation(kind, n).amplitude) for kind in Bifurcation]
    assert of_contact[4:6].tolist() == limits
    held = np.hypot(1 - omega**-2, 2 * zeta / omega)
    assert of_contact[6] == pytest.approx(held, rel=1e-14)
    # Over the value of the restitution model and not of the contact.
    found = relative_errors(exact, RestitutionModel(r), n, lam, list(Quantity))
    np.testing.assert_allclose(found, (of_contact - expected) / expected, rtol=1e-9)


def test_each_quantity_has_the_shape_to_which_all_arguments_broadcast():
    exact = SpringDamper(np.array([[10.0], [50.0]]), 0.05)
    found = relative_errors(exact, RestitutionModel(0.85), [1, 1, 2], 1.0, ["phase", "saddle_node"])
    assert found.shape == (2, 2, 3)
    alone = relative_errors(exact[1, 0], RestitutionModel(0.85), 2, 1.0, ["saddle_node"])
    assert found[1, 1, 2] == alone[0]


def test_what_a_model_lacks_is_not_accurate():
    # r = 0.0893: a compliant contact has no saddle-node, and a stiff one has.
    exact = SpringDamper.from_restitution(0.0893, np.array([2.592, 100.0]))
    (error,) = relative_errors(exact, RestitutionModel(0.0893), 1, 3.0, ["saddle_node"])
    assert np.isnan(error[0]) and abs(error[1]) < 0.1
    assert modulus(error).tolist() == [np.inf, abs(error[1])]


def test_elastic_impacts_leave_nothing_to_be_relative_to():
    # r = 1: Λ_SN = 0 in the restitution model, and 0 or nearly in the contact.
    exact = SpringDamper(np.array([10.0, 100.0]), 0.0)
    (error,) = relative_errors(exact, RestitutionModel(1.0), 1, 0.8, ["saddle_node"])
    assert np.all(np.isinf(modulus(error)))


@pytest.mark.parametrize("quantity", Quantity)
def test_the_error_of_a_stiff_contact_falls_with_the_frequency_ratio(quantity):
    exact = SpringDamper.from_restitution(0.7, np.array([1e3, 1e4, 1e5]))
    (error,) = relative_errors(exact, RestitutionModel(0.7), 1, 1.0, [quantity])
    size = np.abs(error)
    assert size[1] < size[0] / 5 and size[2] < size[1] / 5
