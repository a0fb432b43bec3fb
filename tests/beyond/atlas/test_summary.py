"""The summary of an atlas with answers made by hand, against numbers computed by hand."""

import numpy as np
import pytest
import xarray as xr

from bouncing_ball.accuracy.error_law import coefficients
from bouncing_ball.beyond.atlas import summary as suprema
from bouncing_ball.beyond.atlas.plan import Plan
from bouncing_ball.beyond.atlas.summary import summary
from bouncing_ball.models.damping import damping_ratio

RANGES = {"tiles": 2, "samples": 2}
PLAN = Plan(
    n=[2, 3],
    release=["displacement"],
    restitution={"min": 0.5, "max": 0.9} | RANGES,
    position=RANGES,
    frequency_ratio={"min": 3.0, "max": 300.0, "samples": 3},
    tolerances=[0.01],
    examined=[10.0, 100.0],
    shards=1,
)
# Of four tiles with four nodes each, r by r; at two ϖ, or in five bins of thresholds.
TWO = ("frequency_ratio",)
BINS = ("threshold_bin",)
MODEL = ("model", "quantity")
TOLERANCE = ("model", "quantity", "tolerance")
MADE = {
    "largest_threshold": ([5.0, 200.0, 70.0, 90.0], TOLERANCE, ()),
    "threshold_counts": ([[0, 4, 0, 0], [0, 2, 1, 1], [0, 1, 3, 0], [0, 1, 3, 0]], TOLERANCE, BINS),
    "holding": ([[4, 4], [2, 3], [1, 4], [1, 4]], TOLERANCE, TWO),
    "exceeding": ([[0, 0], [2, 1], [3, 0], [2, 0]], TOLERANCE, TWO),
    "law_stated": ([[1, 2], [1, 2], [0, 2], [1, 4]], ("quantity",), TWO),
    "law_exceeding": ([[0, 0], [1, 0], [0, 0], [1, 0]], ("quantity",), TWO),
    "unstable": ([[0, 1], [2, 0], [0, 0], [0, 3]], (), TWO),
    "sought": ([0, 3, 0, 2], (), ()),
}
EXPECTED = {
    "needed": [[5.0, 200.0], [70.0, 90.0]],
    "limit_needed": [7.0, 8.0],
    # 8 and 15 of the 16 nodes are right from there on; 7 and 1 are wrong there.
    "holding_share": [8 / 16, 15 / 16],
    "exceeding_share": [7 / 16, 1 / 16],
    # 8 of 16 in bins up to 10, 15 up to 100; the last lies in the bin from 100 on.
    "needed_quantile": [10.0, 100.0, 200.0],
    "unstable_share": [2 / 16, 4 / 16],
    # Of both families.
    "law_stated": [6, 20],
    "law_exceeding": [4, 0],
    # The largest error is 0.7/(rϖ), with r from 0.5 on.
    "supremum": 0.014,
    "supremum_restitution": 0.5,
    "supremum_position": 0.0,
    "supremum_needed": 140.0,
    "needed_restitution": 0.5,
    "failing_restitution": 0.7,
    "sought_orbits": 10,
    "orbits": 2 * 16 * 5,
    "restitution_edge": [0.5, 0.7, 0.9],
    "position_edge": [0.0, 0.5, 1.0],
}


def error_by_hand(_, row, kind, ratio, low, high=0.0):
    """The error 0.7/(rϖ), which is largest at the smallest r."""
    return suprema.Largest(0.7 / low / ratio, low, 0.0)


@pytest.fixture(scope="module")
def made():
    data = {
        name: (
            ("release", "n", "restitution", "position", *own, *last),
            np.reshape(values, (1, 1, 2, 2, *(1 for _ in own), *np.shape(values)[1:])),
        )
        for name, (values, own, last) in MADE.items()
    }
    limit = ("release", "n", "restitution", "model", "limit_quantity", "tolerance")
    data["limit_needed"] = limit, np.reshape([7.0, 8.0], (1, 1, 2, 1, 1, 1))
    coords = {"tolerance": [0.01], "frequency_ratio": [10.0, 100.0], "position": [0.25, 0.75]}
    coords |= {"restitution": [0.6, 0.8], "threshold_bin": [0.0, 1.0, 10.0, 100.0]}
    # The same for all quantities, and for both families.
    atlas = xr.Dataset(data, coords).isel(quantity=[0] * 4, limit_quantity=[0] * 3, n=[0, 0])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(suprema, "largest_error", error_by_hand)
        return summary(PLAN, atlas.isel(model=[0, 0]))


@pytest.mark.parametrize("name", EXPECTED)
def test_the_summary_is_the_one_computed_by_hand(made, name):
    first = dict.fromkeys(("quantity", "limit_quantity", "supremum_quantity", "model", "n"), 0)
    one = made[name].isel(first, missing_dims="ignore")
    assert np.allclose(np.squeeze(one.values), EXPECTED[name], rtol=1e-7)


def test_what_the_charts_draw_follows_from_the_law(made, described):
    described(made)
    # In the middle of the second range of r and of the first of the positions.
    fold = 2 * np.pi * 0.2 / 1.8
    flip = np.hypot(2 * (1 + 0.64) / 1.8**2, fold)
    zeta = float(damping_ratio(0.8))
    law = coefficients(2, zeta, fold + (flip - fold) / 4)
    one = made.isel(restitution=1, release=0, n=0)
    found = one.law_coefficient.isel(position=0)
    quantities = ("max_height", "bounce_velocity", "phase", "apparent_restitution")
    np.testing.assert_allclose(found, [abs(law[q]) for q in quantities], rtol=1e-6)
