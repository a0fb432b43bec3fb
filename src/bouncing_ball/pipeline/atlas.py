"""Names and times of the atlas's shards, for its rules.

Every job reads the rules, so that the plan is imported only when one of these functions is called.
"""

import math
from collections.abc import Mapping
from typing import Any

# Processor time of an orbit on a slow machine, with a margin.
_SECONDS_PER_ORBIT = 3e-6
_LEAST_MINUTES = 10


def shard_names(parameters: Mapping[str, Any]) -> list[str]:
    """The shards by number and count, so that a division into another number has other names.

    Examples
    --------
    >>> from bouncing_ball.configuration.yaml_file import read_yaml
    >>> section = read_yaml("config/config.yaml")["atlas"]
    >>> shard_names(section)[:2]
    ['0000-of-0020', '0001-of-0020']
    """
    from bouncing_ball.atlas.plan import Plan

    count = len(Plan(**parameters).shard_rows())
    return [f"{k:04d}-of-{count:04d}" for k in range(count)]


def shard_minutes(parameters: Mapping[str, Any]) -> int:
    """The time limit of a shard on a cluster, in minutes."""
    from bouncing_ball.atlas.plan import Plan

    plan = Plan(**parameters)
    seconds = plan.orbits / len(plan.shard_rows()) * _SECONDS_PER_ORBIT
    return _LEAST_MINUTES + math.ceil(seconds / 60)
