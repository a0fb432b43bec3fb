"""The thresholds of both simple models, against scans of fine grids."""

import numpy as np
import pytest

from bouncing_ball.beyond.corrected.errors import errors, search
from bouncing_ball.paper.comparison.errors import Quantity, modulus
from bouncing_ball.paper.comparison.thresholds import ThresholdStatus
from bouncing_ball.paper.contact.damping import Release
from bouncing_ball.paper.contact.spring_damper import SpringDamper

RATIOS = np.geomspace(1.0, 1e4, 41)
FOUND, ALWAYS, _ = ThresholdStatus


@pytest.mark.parametrize("release", list(Release))
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
    for index in np.ndindex(found.zero.shape):
        signed = scanned[0][index]
        zero = found.zero[index]
        turns = np.flatnonzero(signed[1:] * signed[:-1] < 0)
        low, high = (fine[turns[-1] + k] if turns.size else np.nan for k in (0, 1))
        assert (low <= zero <= high) if turns.size else np.isnan(zero)
