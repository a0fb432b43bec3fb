"""The frequency ratio at which a period doubling is lowest."""

import numpy as np
import pytest

from bouncing_ball.models.damping import damping_ratio
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.paper.exhibits.lowest_period_doubling import lowest_period_doublings
from bouncing_ball.periodic.explicit import explicit_branch
from bouncing_ball.periodic.orbit import Bifurcation
from bouncing_ball.pipeline.job import typed

PARAMETERS = {
    "n": [1, 2, 3],
    "restitution": 0.85,
    "frequency_ratio": {"min": 2.0, "max": 1e3, "samples": 21},
}


def doubling(ratio, n):
    contacts = SpringDamper(ratio, damping_ratio(0.85))
    return explicit_branch(contacts).bifurcation(Bifurcation.PERIOD_DOUBLING, n).amplitude


@pytest.fixture(scope="module")
def data():
    return typed(lowest_period_doublings)(PARAMETERS, "displacement")


def test_the_lowest_period_doubling_is_that_of_a_fine_scan(data, described):
    described(data)
    coarse = np.geomspace(2.0, 40.0, 201)
    n = data.n.values[:, np.newaxis]
    scanned = doubling(coarse, n)
    lowest = np.argmin(scanned, axis=1)
    # A scan of the two intervals beside the lowest point; half a step of it is 0.08 %.
    fine = np.geomspace(coarse[lowest - 1], coarse[lowest + 1], 21, axis=-1)
    closer = doubling(fine, n)
    expected = np.take_along_axis(fine, np.argmin(closer, axis=1)[:, np.newaxis], axis=1)[:, 0]
    assert data.period_doubling_turn.values == pytest.approx(expected, rel=1e-3)
    amplitude = data.period_doubling_amplitude.values
    assert np.all(amplitude <= scanned.min(axis=1)) and np.all(amplitude <= closer.min(axis=1))


def test_a_period_doubling_rises_on_both_sides_of_the_ratio_at_which_it_is_lowest(data):
    for factor in (0.9, 1.1):
        beside = doubling(factor * data.period_doubling_turn.values, data.n.values)
        assert np.all(beside > data.period_doubling_amplitude.values)


def test_a_family_whose_period_doubling_only_rises_has_no_lowest_one():
    stiff = PARAMETERS | {"frequency_ratio": {"min": 2.0, "max": 5.0, "samples": 5}}
    found = typed(lowest_period_doublings)(stiff, "displacement")
    assert np.isnan(found.period_doubling_turn).all()
    assert np.isnan(found.period_doubling_amplitude).all()


def test_the_two_ends_of_a_scan_bound_no_lowest_period_doubling():
    """Warnings are errors in tests: no minimum is looked for without a bracket."""
    ends = PARAMETERS | {"n": [20], "frequency_ratio": {"min": 2.0, "max": 1e3, "samples": 2}}
    assert np.isnan(typed(lowest_period_doublings)(ends, "displacement").period_doubling_turn)
