"""The last crossing of a tolerance, against scans of fine grids."""

import numpy as np
import pytest

from bouncing_ball_beyond.inherited import error_thresholds, rigid, spring_damper
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity, modulus, relative_errors
from bouncing_ball_beyond.inherited.accuracy.thresholds import (
    ThresholdStatus,
    last_crossing,
    search,
    thresholds,
)
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.models.damping import Release, damping_ratio
from bouncing_ball_beyond.inherited.models.restitution import RestitutionModel
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper

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
    np.testing.assert_allclose(found, [1 / 0.3, 1000.0, np.nan, np.nan], rtol=1e-13)


def test_a_gap_is_no_crossing():
    scanned = np.where(RATIOS < 50, 1.0, -1.0)
    scanned[np.argmin(np.abs(RATIOS - 50))] = np.nan
    assert np.isnan(last_crossing(lambda ratio, _: 50 - ratio, RATIOS, scanned[np.newaxis])).all()


def test_the_last_of_several_crossings_counts_and_a_sample_may_be_the_root():
    def wave(x, _=None):
        return (1.5 + np.sin(4 * np.log(x))) / x - 0.01

    found = last_crossing(wave, RATIOS, wave(RATIOS)[np.newaxis])
    fine = np.geomspace(1, 1e4, 200001)
    crossings = np.nonzero(np.diff(wave(fine) > 0))[0]
    assert len(crossings) == 3
    assert fine[crossings[-1]] <= found[0] <= fine[crossings[-1] + 1]
    at_sample = RATIOS[17]
    scanned = (at_sample - RATIOS)[np.newaxis]
    found = last_crossing(lambda x, _: at_sample - x, RATIOS, scanned)
    assert found[0] == pytest.approx(at_sample, rel=1e-13)


@pytest.mark.parametrize("sign", [1, -1])
def test_a_power_is_closed_to_the_last_digit(sign):
    ratio, status = of(lambda x: sign * x**-2.0, 0.01, 0.0004, 2.0, 1e-9)
    assert ratio == pytest.approx([10.0, 50.0, np.nan, np.nan], rel=1e-14, nan_ok=True)
    assert status == [FOUND, FOUND, ALWAYS, NEVER]
    # The tolerance itself is within the tolerance.
    assert of(lambda x: np.full_like(x, sign * 0.01), 0.01)[1] == [ALWAYS]


@pytest.mark.parametrize("absent", [np.nan, np.inf])
def test_where_there_is_no_error_it_is_not_within_the_tolerance(absent):
    (ratio,), status = of(lambda x: np.where(x < 7, absent, 0.001), 0.01)
    assert status == [FOUND] and ratio == pytest.approx(7.0, rel=1e-12)
    (ratio,), status = of(lambda x: np.where(x > 7, absent, 0.001), 0.01)
    assert status == [NEVER] and np.isnan(ratio)


@pytest.mark.parametrize("release", Release)
def test_the_thresholds_are_those_of_a_fine_scan(release):
    zeta = np.array([0.136, 0.05])
    n = np.array([1, 2])
    amplitude = np.array([1.0, 0.9])
    tolerances = [0.01, 0.002]
    quantities = list(Quantity)
    # The r of the restitution model is that of the first contact alone.
    found = search(
        zeta,
        release,
        0.65,
        n,
        amplitude,
        ratios=RATIOS,
        tolerances=tolerances,
        quantities=quantities,
    )

    def errors(ratio):
        exact = SpringDamper(ratio, zeta, release)
        return relative_errors(exact, RestitutionModel(0.65), n, amplitude, quantities)

    np.testing.assert_array_equal(found.error, np.moveaxis(errors(RATIOS[:, None]), 1, -1))
    fine = np.geomspace(RATIOS[0], RATIOS[-1], 201)
    of_fine = modulus(np.moveaxis(errors(fine[:, np.newaxis]), 1, -1))
    for k, tolerance in enumerate(tolerances):
        outside = of_fine > tolerance
        never = outside[..., -1]
        there = outside.any(axis=-1) & ~never
        expected = np.where(never, NEVER, np.where(there, FOUND, ALWAYS))
        assert np.array_equal(found.status[..., k], expected)
        assert there.any() and np.array_equal(np.isnan(found.threshold[..., k]), ~there)
        ratios = found.threshold[..., k][there]
        closed = errors(ratios[:, np.newaxis])
        for one, (quantity, orbit) in enumerate(np.argwhere(there)):
            ratio = ratios[one]
            # A difference of numbers of order 1.
            off = abs(closed[quantity, one, orbit]) - tolerance
            last = np.flatnonzero(outside[quantity, orbit])[-1]
            assert abs(off) < 1e-12 or np.isinf(of_fine[quantity, orbit, last])
            assert fine[last] * (1 - 1e-12) <= ratio <= fine[last + 1] * (1 + 1e-12)


def test_the_public_call_has_an_axis_for_each_array():
    found = error_thresholds(
        rigid(restitution=[0.65, 0.85]),
        [1, 2],
        amplitude=1.0,
        tolerance=[0.01, 0.001],
        quantities=["max_height", "permanent_contact"],
    )
    assert found.error_threshold.dims == ("n", "tolerance", "restitution", "quantity")
    one = search(
        damping_ratio(0.85),
        Release.DISPLACEMENT,
        0.85,
        2,
        1.0,
        ratios=np.geomspace(1.0, 1e6, 97),
        tolerances=[0.001],
        quantities=["max_height"],
    )
    here = found.sel({"restitution": 0.85, "n": 2, "tolerance": 0.001, "quantity": "max_height"})
    assert here.error_threshold.item() == pytest.approx(one.threshold.item(), rel=1e-12)
    assert here.threshold_status.item() == "found"
    # Λ_SD = 1 - 1 % at ϖ₊ (Eq. 35), for r = 0.65.
    held = found.sel(
        {"restitution": 0.65, "n": 1, "tolerance": 0.01, "quantity": "permanent_contact"}
    )
    assert round(held.error_threshold.item(), 2) == 9.81


def test_what_is_wrong_is_said_in_one_line(refusal):
    ball = rigid(restitution=0.65)
    with refusal(ModelError, "needs a ball made by rigid"):
        error_thresholds(spring_damper(restitution=0.65, frequency_ratio=10.0), amplitude=1.0)
    with refusal(ModelError, "quantities", "has no entries"):
        error_thresholds(ball, amplitude=1.0, quantities=[])
    with refusal(ModelError, "max_hight", "max_height"):
        error_thresholds(ball, amplitude=1.0, quantities="max_hight")
    with refusal(ModelError, "tolerance"):
        error_thresholds(ball, amplitude=1.0, tolerance=-1.0)
