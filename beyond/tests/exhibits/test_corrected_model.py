"""The datasets of the corrected model: errors, orders and thresholds, and where they stand."""

import numpy as np
import pytest

from bouncing_ball_beyond.accuracy.simple_models import errors
from bouncing_ball_beyond.exhibits import corrected_model as study
from bouncing_ball_beyond.exhibits.random_orbits import random_orbits
from bouncing_ball_beyond.inherited.pipeline.job import typed
from bouncing_ball_beyond.models.damping import LINEAR, Release, damping_ratio
from bouncing_ball_beyond.models.spring_damper import SpringDamper

SPAN = {"min": 1.0, "max": 1e4, "samples": 41}
ORBIT = {"n": 1, "restitution": 0.65, "amplitude": 1.0}
RELEASES = LINEAR


@pytest.fixture(scope="module", params=RELEASES)
def orders(request):
    random = {"seed": 3, "samples": 200, "law_samples": 300}
    parameters = {**ORBIT, "tolerance": 0.01, "frequency_ratio": SPAN, **random}
    return typed(study.orders)(parameters, request.param)


@pytest.mark.parametrize("orders", [Release.DISPLACEMENT], indirect=True)
def test_the_table_of_the_error_law_has_the_coefficients_and_thresholds(described, orders):
    data = described(orders)
    exact = data.error_threshold.sel(model="restitution")
    # The thresholds of the replication's own table.
    assert float(exact.sel(quantity="max_height")) == pytest.approx(82.177, abs=1e-3)
    assert float(data.permanent_threshold) == pytest.approx(9.812, abs=1e-3)
    # The law is right to 1 % where the threshold lies at a stiff contact.
    stiff = exact > 50
    assert stiff.sum() >= 4
    assert np.all(np.abs(data.law_threshold / exact - 1)[stiff] < 0.01)
    corrected = data.error_threshold.sel(model="corrected")
    assert np.all(corrected < exact) and float(corrected.sel(quantity="max_height")) < 3
    # The second order at a contact ten times as stiff, but for the third, of 1/ϖ beside it.
    contact = SpringDamper(5000.0, float(damping_ratio(0.65)))
    stiff = 5000.0**2 * errors(contact, 1, 1.0)[1]
    np.testing.assert_allclose(data.second_order, stiff, rtol=2e-3)
    # The accident that makes the restitution model look better than it is.
    assert float(data.error_zero.sel(quantity="period_doubling")) == pytest.approx(1.9, abs=0.1)


def test_the_errors_of_random_orbits_have_the_orders_one_and_two(described, orders):
    data = described(orders)
    middle = data.order.sel(quantity="max_height").median("sample")
    np.testing.assert_allclose(middle, [1, 2], atol=0.01)
    assert np.all(data.law_remainder.max("law_sample") < 1)


def test_random_orbits_are_in_the_stable_range():
    n, zeta, lam, _ = random_orbits(500, 1, Release.FORCE)
    contact = SpringDamper(1.0, zeta, Release.FORCE)
    assert np.all((contact.restitution > 0.14) & (contact.restitution < 0.99))
    assert np.all((n >= 1) & (n <= 5)) and np.all(lam > 0)
