"""Small helpers of the studies."""

import numpy as np
import pytest

from bouncing_ball.studies.parameters import grid


def test_grid_is_logarithmic_and_meets_its_ends():
    points = grid({"min": 0.5, "max": 50.0, "samples": 21})
    assert points[[0, -1]].tolist() == [0.5, 50.0]
    # Equal ratios, to the roundings of a power.
    assert points[1:] / points[:-1] == pytest.approx(np.full(20, 100 ** (1 / 20)), rel=1e-14)
