"""The summary of answers made by hand, by hand."""

import numpy as np
import pytest
import xarray as xr

from bouncing_ball.accuracy.error_law import coefficients
from bouncing_ball.atlas.plan import AtlasParameters
from bouncing_ball.atlas.summary import summary
from bouncing_ball.contacts.damping import damping_ratio

BINS = [0.0, 1.0, 10.0, 100.0, np.inf]
RANGES = {"tiles": 2, "samples": 2}
PLAN = {
    "n": [2],
    "release": ["displacement"],
    "restitution": {"min": 0.5, "max": 0.9} | RANGES,
    "position": RANGES,
    "frequency_ratio": {"min": 3.0, "max": 300.0, "samples": 3},
    "tolerances": [0.01],
    "examined": [10.0, 100.0],
    "shards": 1,
    "summary": {"tolerance": 0.01, "rule_of_thumb": 100.0},
}


def of_tiles(values, *dims):
    """Answers of the four tiles, r by r, for the only rule, n and model."""
    array = np.array(values)
    shape = (1, 1, 2, 2, *array.shape[1:])
    return ("release", "n", "restitution", "position", *dims), array.reshape(shape)


@pytest.fixture(scope="module")
def made():
    # 4 nodes in each of 4 tiles. One quantity, one model, one tolerance.
    one, each = ("model", "quantity", "tolerance"), ("model", "quantity", "frequency_ratio")
    atlas = xr.Dataset(
        {
            "largest_threshold": of_tiles(np.reshape([5.0, 200.0, 70.0, 90.0], (4, 1, 1, 1)), *one),
            "threshold_counts": of_tiles(
                np.reshape(
                    [[0, 4, 0, 0, 0], [0, 2, 1, 1, 0], [0, 1, 3, 0, 0], [0, 1, 3, 0, 0]],
                    (4, 1, 1, 1, 5),
                ),
                *one,
                "threshold_bin",
            ),
            "holding": of_tiles(
                np.reshape([[4, 4], [2, 3], [1, 4], [1, 4]], (4, 1, 1, 1, 2)),
                *one,
                "frequency_ratio",
            ),
            "exceeding": of_tiles(
                np.reshape([[0, 0], [2, 1], [3, 0], [2, 0]], (4, 1, 1, 1, 2)),
                *one,
                "frequency_ratio",
            ),
            "largest_error": of_tiles(
                np.reshape([[0.1, 0.001], [0.2, 0.02], [0.3, np.nan], [0.4, 0.003]], (4, 1, 1, 2)),
                *each,
            ),
            "worst_restitution": of_tiles(np.full((4, 1, 1, 2), 0.6), *each),
            "worst_amplitude": of_tiles(
                np.reshape([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0], [7.0, 8.0]], (4, 1, 1, 2)), *each
            ),
            "law_stated": of_tiles(
                np.reshape([[1, 2], [1, 2], [0, 2], [1, 4]], (4, 1, 2)), "quantity", each[-1]
            ),
            "law_exceeding": of_tiles(
                np.reshape([[0, 0], [1, 0], [0, 0], [1, 0]], (4, 1, 2)), "quantity", each[-1]
            ),
            "unstable": of_tiles([[0, 1], [2, 0], [0, 0], [0, 3]], each[-1]),
            "sought": of_tiles([0, 3, 0, 2]),
            "farthest": of_tiles([1e-9, 2e-9, 5e-8, 0.0]),
            "limit_needed": (
                ("release", "n", "restitution", "model", "limit_quantity", "tolerance"),
                np.reshape([7.0, 8.0], (1, 1, 2, 1, 1, 1)),
            ),
        },
        coords={
            "release": ["displacement"],
            "n": [2],
            "restitution": [0.6, 0.8],
            "position": [0.25, 0.75],
            "model": ["restitution"],
            "tolerance": [0.01],
            "frequency_ratio": [10.0, 100.0],
            "threshold_bin": BINS,
        },
    )
    # The same for all quantities.
    atlas = atlas.isel(quantity=[0] * 4, limit_quantity=[0] * 3)
    return summary(AtlasParameters(**PLAN), atlas)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("needed", [[5.0, 200.0], [70.0, 90.0]]),
        ("limit_needed", [7.0, 8.0]),
        # 8 and 15 of the 16 nodes are right from there on; 7 and 1 are wrong there.
        ("holding_share", [8 / 16, 15 / 16]),
        ("exceeding_share", [7 / 16, 1 / 16]),
        # 8 of 16 in bins up to 10, 15 up to 100; the last lies in the bin from 100 on.
        ("needed_quantile", [10.0, 100.0, 200.0, 200.0]),
        # The only tile on which the rule fails: r from 0.5 to 0.7, position from 0.5 to 1.
        ("failing_restitution", 0.7),
        ("failing_position", 1.0),
        ("unstable_share", [2 / 16, 4 / 16]),
        ("law_stated", [3, 10]),
        ("law_exceeding", [2, 0]),
        ("worst_error", 0.02),
        ("worst_restitution", 0.6),
        ("worst_amplitude", 4.0),
        ("sought_orbits", 5),
        ("farthest", 5e-8),
        ("orbits", 16 * 5),
        ("rule_of_thumb", 100.0),
        ("summary_tolerance", 0.01),
        ("restitution_edge", [0.5, 0.7, 0.9]),
        ("position_edge", [0.0, 0.5, 1.0]),
    ],
)
def test_by_hand(made, name, expected):
    one = made[name].isel(quantity=0, limit_quantity=0, missing_dims="ignore")
    assert np.allclose(np.squeeze(one.values), expected, rtol=1e-7)


def test_what_the_charts_draw_follows_from_the_law(made, described):
    described(made)
    # In the middle of the second range of r and of the first of the positions.
    middle = 2 * np.pi * 0.2 / 1.8
    top = np.hypot(2 * (1 + 0.64) / 1.8**2, middle)
    law = coefficients(2, damping_ratio(0.8), middle + (top - middle) / 4)
    one = made.sel(restitution=0.8, release="displacement", n=2)
    found = one.law_coefficient.isel(position=0, quantity=2)
    assert float(found) == pytest.approx(abs(float(law["phase"])), rel=1e-6)
    needed = [abs(float(law[q])) / 0.01 for q in ("saddle_node", "period_doubling")]
    zeta = float(damping_ratio(0.8))
    np.testing.assert_allclose(
        one.limit_law_needed, [*needed, np.sqrt((1 - 2 * zeta**2) / 0.01)], rtol=1e-12
    )
