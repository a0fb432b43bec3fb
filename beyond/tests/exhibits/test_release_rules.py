"""Both release rules side by side."""

import numpy as np
import pytest

from bouncing_ball_beyond.exhibits.release_rules import release_rules
from bouncing_ball_beyond.inherited.accuracy.thresholds import ThresholdStatus
from bouncing_ball_beyond.inherited.pipeline.job import typed
from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact.spring_damper_bifurcations import saddle_node
from bouncing_ball_beyond.periodic.one_impact.spring_damper_branch import branch_point

PARAMETERS = {
    "n": [1, 2],
    "restitution": 0.85,
    "frequency_ratio": {"min": 2.0, "max": 1e3, "samples": 11},
    "thresholds": {
        "n": 1,
        "restitution": 0.65,
        "amplitude": 1.0,
        "tolerance": 0.01,
        "quantities": ["max_height", "apparent_restitution", "permanent_contact"],
        "frequency_ratio": {"min": 1.0, "max": 1e4, "samples": 81},
    },
}


@pytest.mark.slow
def test_values_are_those_of_the_orbits():
    data = typed(release_rules)(PARAMETERS)
    contact = SpringDamper(1e3, float(damping_ratio(0.85)), Release.FORCE)
    expected = branch_point(saddle_node(contact, 2), contact, 2).amplitude
    cell = data.bifurcation_amplitude.sel(release="force", n=2, bound="saddle-node")
    assert float(cell[-1]) == pytest.approx(float(expected), rel=1e-13)
    paper, same_r, own_r = data.reading.values
    found = data.error_threshold.sel(quantity="apparent_restitution")
    # The force release never comes within 1 % of the r of Eq. 16, but of its own.
    assert np.isnan(found.sel(reading=same_r)) and np.isfinite(found.sel(reading=own_r))
    status = data.threshold_status.sel(reading=same_r, quantity="apparent_restitution").item()
    assert status == ThresholdStatus.NEVER_WITHIN
    height = float(data.error_threshold.sel(reading=paper, quantity="max_height"))
    assert height == pytest.approx(82.17735912, abs=1e-6)
