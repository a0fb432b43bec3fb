"""A small atlas: every rule, families, ranges of r and of the position, in a second."""

import pytest

from bouncing_ball.atlas.plan import Plan

SMALL = {
    "n": [1, 3],
    "release": ["displacement", "force"],
    "restitution": {"min": 0.05, "max": 0.95, "tiles": 3, "samples": 2},
    "position": {"tiles": 3, "samples": 4},
    "frequency_ratio": {"min": 3.0, "max": 1e4, "samples": 61},
    "tolerances": [0.1, 0.01, 0.001],
    "examined": [10.0, 100.0],
    "shards": 3,
}


@pytest.fixture(scope="session")
def small():
    """The parameters of the small atlas, some of them changed."""
    return lambda **changed: Plan(SMALL | changed)
