"""The frequency ratio at which a period doubling is lowest."""

import numpy as np
import pytest
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t

from bouncing_ball.paper.exhibits.lowest_period_doubling import (
    lowest_along_ratio,
    lowest_period_doublings,
)
from bouncing_ball.pipeline.configuration import typed

PARAMETERS = {
    "n": [1, 2],
    "restitution": 0.85,
    "frequency_ratio": {"min": 2.0, "max": 1e3, "samples": 21},
}


def test_the_lowest_period_doubling_is_that_of_a_fine_scan():
    # That of the third family is lowest at the end of this scan, where nothing is said.
    fine = np.geomspace(2.0, 40.0, 2001)
    n = np.array([1, 2, 3])
    model = ContactModel(SpringDamper(fine, 0.0517))
    amplitude = n_t.period_doubling(model, n[:, np.newaxis]).amplitude
    coarse = slice(None, None, 100)
    found = lowest_along_ratio(fine[coarse], amplitude[:, coarse], 0.0517, Release.DISPLACEMENT, n)
    assert found == pytest.approx(fine[np.nanargmin(amplitude, axis=1)], rel=2e-3)


def test_a_period_doubling_rises_on_both_sides_of_the_ratio_at_which_it_is_lowest(described):
    data = described(typed(lowest_period_doublings)(PARAMETERS, "displacement"))
    zeta = float(damping_ratio(0.85))
    lowest = data.period_doubling_amplitude.values
    for factor in (0.9, 1.1):
        contact = SpringDamper(factor * data.period_doubling_turn.values, zeta)
        beside = n_t.period_doubling(ContactModel(contact), data.n.values).amplitude
        assert np.all(beside > lowest)


def test_a_family_whose_period_doubling_only_rises_has_no_lowest_one():
    stiff = PARAMETERS | {"frequency_ratio": {"min": 2.0, "max": 5.0, "samples": 5}}
    data = typed(lowest_period_doublings)(stiff, "displacement")
    assert np.isnan(data.period_doubling_turn).all()
    assert np.isnan(data.period_doubling_amplitude).all()


def test_the_two_ends_of_a_scan_bound_no_lowest_period_doubling():
    """Warnings are errors in tests: no minimum is looked for without a bracket."""
    ends = PARAMETERS | {"n": [20], "frequency_ratio": {"min": 2.0, "max": 1e3, "samples": 2}}
    assert np.isnan(typed(lowest_period_doublings)(ends, "displacement").period_doubling_turn)
