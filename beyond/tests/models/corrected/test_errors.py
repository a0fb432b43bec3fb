"""Errors of both simple models, and their thresholds against scans of fine grids."""

import numpy as np
import pytest

from bouncing_ball_beyond.accuracy.errors import relative_errors
from bouncing_ball_beyond.accuracy.simple_models import (
    SIMPLE,
    errors,
    exact_and_simple_models,
    search,
)
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity, modulus
from bouncing_ball_beyond.inherited.accuracy.thresholds import ThresholdStatus
from bouncing_ball_beyond.models.damping import LINEAR, Release
from bouncing_ball_beyond.models.spring_damper import SpringDamper

RATIOS = np.geomspace(1.0, 1e4, 41)
FOUND, ALWAYS, _ = ThresholdStatus


# The search is one; the errors of both releases are compared below.
@pytest.mark.parametrize(
    "release", [Release.DISPLACEMENT, pytest.param(Release.FORCE, marks=pytest.mark.long)]
)
def test_the_thresholds_of_contacts_are_those_of_a_fine_scan(release):
    zeta = np.array([0.136, 0.05])
    n = np.array([1, 2])
    lam = np.array([1.0, 0.9])
    tolerance = 0.01
    found = search(
        zeta=zeta,
        rule=release,
        n=n,
        amplitude=lam,
        ratios=RATIOS,
        tolerance=tolerance,
        quantities=tuple(Quantity),
    )
    fine = np.geomspace(RATIOS[0], RATIOS[-1], 401)
    contact = SpringDamper(fine[:, np.newaxis], zeta, release)
    scanned = np.moveaxis(errors(contact, n, lam, Quantity), 2, -1)
    outside = modulus(scanned) > tolerance
    there = outside.any(axis=-1)
    # All are within the tolerance at last: no contact is as stiff as 10⁴.
    assert np.array_equal(found.status, np.where(there, FOUND, ALWAYS))
    assert there.any() and not there.all()
    assert np.array_equal(np.isnan(found.threshold), ~there)
    # Each at its own thresholds.
    at = np.where(there, found.threshold, 1.0)
    own = errors(SpringDamper(at, zeta, release), n, lam, Quantity)
    for index in zip(*np.nonzero(there), strict=True):
        # A difference of numbers of order 1.
        assert abs(float(own[*index[:2], *index])) == pytest.approx(tolerance, abs=1e-12)
        last = np.flatnonzero(outside[index])[-1]
        low, high = fine[last : last + 2]
        assert low * (1 - 1e-12) <= found.threshold[index] <= high * (1 + 1e-12)
    for index in np.ndindex(found.zero.shape[1:]):
        signed = scanned[0][index]
        zero = found.zero[0][index]
        turns = np.flatnonzero(signed[1:] * signed[:-1] < 0)
        low, high = (fine[turns[-1] + k] if turns.size else np.nan for k in (0, 1))
        assert (low <= zero <= high) if turns.size else np.isnan(zero)


@pytest.mark.parametrize("release", LINEAR)
def test_errors_are_those_of_the_models_one_by_one(release):
    contact = SpringDamper(np.array([[3.0], [30.0]]), np.array([0.05, 0.2]), release)
    n = np.array([1, 2])
    lam = np.array([0.9, 2.0])
    found = errors(contact, n, lam, tuple(Quantity))
    assert found.shape == (len(SIMPLE), len(Quantity), 2, 2)
    for i, j in np.ndindex(2, 2):
        exact, *simple = exact_and_simple_models(contact[i, j])
        assert float(simple[0].restitution) == float(contact[i, j].restitution)
        for k, model in enumerate(simple):
            (one,) = relative_errors(exact, [model], n[j], lam[j], tuple(Quantity))
            np.testing.assert_allclose(found[k, :, i, j], one, rtol=1e-9, atol=1e-13)
