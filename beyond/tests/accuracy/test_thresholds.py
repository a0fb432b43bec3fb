"""Thresholds of the restitution model for any contact, against a scan of a fine grid."""

import numpy as np
import pytest

from bouncing_ball_beyond.accuracy.errors import relative_errors
from bouncing_ball_beyond.accuracy.simple_models import search
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity, modulus
from bouncing_ball_beyond.inherited.accuracy.thresholds import ThresholdStatus
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import LINEAR
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper

RATIOS = np.geomspace(1.0, 1e4, 41)
FOUND, ALWAYS, NEVER = ThresholdStatus


@pytest.mark.parametrize("release", LINEAR)
def test_the_thresholds_of_the_restitution_model_are_those_of_a_fine_scan(release):
    zeta = np.array([0.136, 0.05])
    n = np.array([1, 2])
    amplitude = np.array([1.0, 0.9])
    tolerance = 0.01
    # The r of the restitution model is that of the first contact alone.
    found = search(
        zeta,
        release,
        n,
        amplitude,
        ratios=RATIOS,
        tolerance=[tolerance],
        quantities=tuple(Quantity),
        simple=lambda contact: [RestitutionModel(0.65)],
    )

    def errors(ratio):
        exact = ContactModel(SpringDamper(ratio, zeta, release))
        simple = RestitutionModel(0.65)
        return relative_errors(exact, [simple], n, amplitude, tuple(Quantity))[0]

    fine = np.geomspace(RATIOS[0], RATIOS[-1], 401)
    outside = modulus(np.moveaxis(errors(fine[:, np.newaxis]), 1, -1)) > tolerance
    never = outside[..., -1]
    there = outside.any(axis=-1) & ~never
    expected = np.where(never, NEVER, np.where(there, FOUND, ALWAYS))
    assert np.array_equal(found.status[0, ..., 0], expected)
    assert there.any() and np.array_equal(np.isnan(found.threshold[0, ..., 0]), ~there)
    for quantity, orbit in zip(*np.nonzero(there), strict=True):
        ratio = found.threshold[0, quantity, orbit, 0]
        # A difference of numbers of order 1.
        assert abs(errors(ratio)[quantity, orbit]) == pytest.approx(tolerance, abs=1e-12)
        last = np.flatnonzero(outside[quantity, orbit])[-1]
        assert fine[last] * (1 - 1e-12) <= ratio <= fine[last + 1] * (1 + 1e-12)
