"""A small atlas: every rule, families, ranges of r and of the position, in a second."""

import numpy as np
import pytest

from bouncing_ball.beyond.atlas import shards
from bouncing_ball.beyond.atlas.plan import Plan

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
    """The small atlas, with some of its parameters changed."""
    return lambda **changed: Plan(**(SMALL | changed))


@pytest.fixture(scope="session")
def every_node():
    return lambda plan, row: plan.nodes(row, np.arange(plan.nodes_per_row))


@pytest.fixture(scope="session")
def parts(small):
    return [shards.shard(small(), k) for k in range(3)]


@pytest.fixture(scope="session")
def limits(small):
    return shards.limit_shard(small())


@pytest.fixture(scope="session")
def atlas(small, parts, limits):
    return shards.merge(small(), iter(parts), limits)
