"""The smallest ϖ for means, against the orbit's own errors."""

import numpy as np
import pytest

from bouncing_ball.beyond.exhibits.means import (
    DECISIONS,
    MEANS,
    MeanMotions,
    mean_motions,
    needed_index,
)
from bouncing_ball.models.damping import Release
from bouncing_ball.pipeline.configuration import typed

RATIOS = [10.0, 30.0, 100.0, 1000.0]


def grid(low, high):
    return {"min": low, "max": high, "samples": 2}


def test_every_larger_ratio_must_be_right():
    # A column for each case, with a margin of the fifth.
    rows = [0.2, 1e-3, 1e-3, 1e-3, 0.2, 0.2], [0.02, 0.02, -1e-3, 1e-3, 0.011, np.nan]
    error = np.array([*rows, [1e-3, 1e-3, 1e-3, -0.02, 1e-3, 1e-3]])
    place, known = needed_index(error, np.tile([0, 0, 0, 0, 0.005, 0], (3, 1)), 0.01)
    assert place.tolist() == [2, 2, 0, 3, 2, 2] and np.all(known[:2] == 0)
    assert [DECISIONS[k] for k in known[2:]] == list(DECISIONS)


def test_errors_on_a_locked_orbit_decide_by_themselves():
    """All balls lock with the period 3 T here, and the power errs by K/ϖ."""
    given = {"amplitude": grid(3.4, 3.5), "restitution": grid(0.2, 0.22), "impacts": 200}
    sizes = {"starts": 3, "samples": 50, "tolerance": 0.01, "confidence": 0.95, "seed": 7}
    data = typed(mean_motions)(given | sizes | {"frequency_ratio": RATIOS}, Release.DISPLACEMENT)
    one = data.sel(mean="power", simple="restitution")
    node = {"restitution": 0, "amplitude": 0}
    assert np.all(one.mean_margin.isel(node) == data.mean_margin.min())
    error = np.abs(one.mean_error.isel(node).values)
    assert one.needed_ratio.isel(node) == RATIOS[np.flatnonzero(error > 0.01).max() + 1]
    # The next order contributes a share of 1/ϖ, times a coefficient of some units.
    assert error[2] / error[3] == pytest.approx(10, rel=0.1)


def test_the_share_of_right_nodes_counts_the_nodes_that_have_a_number():
    """Four nodes: one without a number, one right from the second ϖ on, one never, one always."""
    given = {"amplitude": grid(1.0, 2.0), "restitution": grid(0.2, 0.4), "impacts": 200}
    sizes = {"starts": 3, "samples": 50, "tolerance": 0.01, "confidence": 0.95, "seed": 7}
    ratios = [10.0, 100.0, 1000.0]
    errors = np.array([[np.nan, 0.2, 0.2, 1e-3], *[[1e-3, 1e-3, 0.2, 1e-3]] * 2])
    found = {
        "mean_error": np.tile(errors, (2, len(MEANS), 1, 1)),
        "mean_margin": np.zeros((2, len(MEANS), 3, 4)),
    }
    parameters = MeanMotions(**given, **sizes, frequency_ratio=ratios)
    data = mean_motions(parameters, Release.DISPLACEMENT, found)
    assert np.all(data.right_nodes == 3)
    assert data.right_low.values[0, 0] == pytest.approx([1 / 3, 2 / 3, 2 / 3])
    assert np.all(data.right_high == data.right_low)
    words = data.decision.values[0, 0].ravel().tolist()
    assert words == ["no number", "from this on", "not at any", "from this on"]
    least = data.needed_ratio.values[0, 0].ravel()
    np.testing.assert_array_equal(least, [np.nan, 100.0, np.nan, 10.0])
    # With an interval that contains the tolerance at the errors of 0.2 only, they may be right.
    found["mean_margin"] = np.where(np.abs(found["mean_error"]) > 0.1, 0.3, 0.0)
    data = mean_motions(parameters, Release.DISPLACEMENT, found)
    assert data.right_low.values[0, 0] == pytest.approx([1 / 3, 2 / 3, 2 / 3])
    assert np.all(data.right_high == 1)
