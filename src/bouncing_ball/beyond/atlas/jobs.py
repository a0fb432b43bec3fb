"""The names and the time limits of the atlas's shards, for the rules.

Every job reads the rules. The plan of the atlas is therefore imported only when it is needed.
"""

import math
from collections.abc import Mapping
from typing import Any

# Processor time for one orbit on a slow machine, with a margin.
_SECONDS_PER_ORBIT = 3e-6
_LEAST_MINUTES = 10


def names(parameters: Mapping[str, Any]) -> list[str]:
    """The names of the atlas's shards."""
    from bouncing_ball.beyond.atlas.plan import Plan

    count = len(Plan(**parameters).shard_rows())
    return [f"{k:04d}-of-{count:04d}" for k in range(count)]


def minutes(parameters: Mapping[str, Any]) -> int:
    """The time limit of a shard on a cluster, in minutes."""
    from bouncing_ball.beyond.atlas.plan import Plan

    plan = Plan(**parameters)
    seconds = plan.orbit_count / len(plan.shard_rows()) * _SECONDS_PER_ORBIT
    return _LEAST_MINUTES + math.ceil(seconds / 60)
