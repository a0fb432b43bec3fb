"""Quantities of the models, and the relative errors of the simple ones."""

import numpy as np
import pytest

from bouncing_ball_beyond.accuracy.errors import (
    OF_IMPACTS,
    OF_LIMITS,
    OF_ORBITS,
    as_deviation,
    deviation,
    paper_error,
    relative_errors,
    values,
)
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity, modulus
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t


def test_each_quantity_is_one_of_orbits_or_of_limits():
    assert OF_ORBITS + OF_LIMITS == tuple(Quantity)
    assert set(Quantity) - set(OF_IMPACTS) == {Quantity.PERMANENT_CONTACT}


def test_the_values_are_those_of_the_orbits_and_bifurcations_of_each_model():
    n, r, lam, omega = 2, 0.85, 1.0, 50.0
    exact = ContactModel(SpringDamper.from_restitution(r, omega))
    zeta = -np.log(r) / np.hypot(np.pi, np.log(r))
    half = n * np.pi
    fold = n * np.pi * (1 - r) / (1 + r)
    phi = np.arccos(fold / lam)
    flip = np.hypot(2 * (1 + r * r) / (1 + r) ** 2, fold)
    found = values(RestitutionModel(r), n, lam, Quantity)
    expected = [lam * np.sin(phi) + half**2 / 2, half, phi, r, fold, flip, 1.0]
    np.testing.assert_allclose(found, expected, rtol=1e-14)
    orbit = n_t.orbit(exact, n, lam)
    of_contact = values(exact, n, lam, Quantity)
    np.testing.assert_array_equal(of_contact[:4], [getattr(orbit, q) for q in OF_ORBITS])
    assert of_contact[4] == n_t.saddle_node(exact, n).amplitude
    assert of_contact[5] == n_t.period_doubling(exact, n).amplitude
    held = np.hypot(1 - omega**-2, 2 * zeta / omega)
    assert of_contact[6] == pytest.approx(held, rel=1e-14)
    # Eqs. 37-38, over the value of the restitution model and not of the contact.
    (found,) = relative_errors(exact, [RestitutionModel(r)], n, lam, tuple(Quantity))
    np.testing.assert_allclose(found, (of_contact - expected) / expected, rtol=1e-9)


def test_what_is_missing_is_not_right():
    # r = 0.0893: a compliant contact has no saddle-node, and a stiff one has.
    contact = SpringDamper.from_restitution(0.0893, np.array([2.592, 100.0]))
    exact = ContactModel(contact)
    simple = [RestitutionModel(0.0893)]
    ((error,),) = relative_errors(exact, simple, 1, 3.0, [Quantity.SADDLE_NODE])
    assert np.isnan(error[0]) and abs(error[1]) < 0.1
    assert modulus(error).tolist() == [np.inf, abs(error[1])]


def test_elastic_impacts_leave_nothing_to_be_relative_to():
    # r = 1: Λ_SN = 0 in the restitution model, and 0 or nearly in the contact.
    exact = ContactModel(SpringDamper(np.array([10.0, 100.0]), 0.0))
    (error,) = relative_errors(exact, [RestitutionModel(1.0)], 1, 0.8, ["saddle_node"])[0]
    assert np.all(np.isinf(modulus(error)))


def test_the_error_of_the_paper_and_the_deviation_have_other_references():
    exact = np.array([2.0, 0.5, 1.0])
    simple = np.array([1.0, 1.0, 0.0])
    error = paper_error(exact=exact, simple=simple)
    assert error.tolist() == [1.0, -0.5, np.inf]
    assert deviation(exact=exact, simple=simple).tolist() == [-0.5, 1.0, -1.0]
    assert as_deviation(error).tolist() == [-0.5, 1.0, -1.0]
