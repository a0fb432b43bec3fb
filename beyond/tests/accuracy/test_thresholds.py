"""The last crossing of a tolerance, against scans of fine grids."""

import numpy as np
import pytest

from bouncing_ball_beyond.accuracy.errors import Quantity, modulus, relative_errors
from bouncing_ball_beyond.accuracy.simple_models import search
from bouncing_ball_beyond.accuracy.thresholds import (
    ThresholdStatus,
    last_crossing,
    thresholds,
)
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import LINEAR
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper

RATIOS = np.geomspace(1.0, 1e4, 41)
FOUND, ALWAYS, NEVER = ThresholdStatus


def of(function, *tolerances):
    scanned = function(RATIOS)[np.newaxis]
    found = thresholds(lambda ratio, _: function(ratio), RATIOS, scanned, tolerances)
    return found.ratio[0], found.status[0].tolist()


def test_each_function_has_its_own_last_crossing():
    levels = np.array([0.3, 0.001, 2.0, 1e-9])

    def function(ratio, which):
        return 1 / ratio - levels[which]

    found = last_crossing(function, RATIOS, function(RATIOS, np.arange(4)[:, np.newaxis]))
    np.testing.assert_allclose(found, [1 / 0.3, 1000.0, np.nan, np.nan], rtol=1e-14)


def test_a_gap_is_no_crossing():
    scanned = np.where(RATIOS < 50, 1.0, -1.0)
    scanned[np.argmin(np.abs(RATIOS - 50))] = np.nan
    assert np.isnan(last_crossing(lambda ratio, _: 50 - ratio, RATIOS, scanned[np.newaxis])).all()


@pytest.mark.parametrize("sign", [1, -1])
def test_a_power_is_closed_to_the_last_digit(sign):
    ratio, status = of(lambda x: sign * x**-2.0, 0.01, 0.0004, 2.0, 1e-9)
    assert ratio == pytest.approx([10.0, 50.0, np.nan, np.nan], rel=1e-14, nan_ok=True)
    assert status == [FOUND, FOUND, ALWAYS, NEVER]
    # The tolerance itself is within the tolerance.
    assert of(lambda x: np.full_like(x, sign * 0.01), 0.01)[1] == [ALWAYS]


def test_the_last_of_several_crossings_counts():
    def wave(x):
        return (1.5 + np.sin(4 * np.log(x))) / x

    (ratio,), status = of(wave, 0.01)
    fine = np.geomspace(1, 1e4, 200001)
    crossings = np.nonzero(np.diff(wave(fine) > 0.01))[0]
    assert status == [FOUND] and len(crossings) == 3
    assert fine[crossings[-1]] <= ratio <= fine[crossings[-1] + 1]


@pytest.mark.parametrize("absent", [np.nan, np.inf])
def test_where_there_is_no_error_it_is_not_within_the_tolerance(absent):
    (ratio,), status = of(lambda x: np.where(x < 7, absent, 0.001), 0.01)
    assert status == [FOUND] and ratio == pytest.approx(7.0, rel=1e-12)
    (ratio,), status = of(lambda x: np.where(x > 7, absent, 0.001), 0.01)
    assert status == [NEVER] and np.isnan(ratio)


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
