"""A single branch, of problems whose last unknown is the parameter itself."""

import numpy as np

from bouncing_ball_beyond.inherited.numerics.branch import ContinuationError
from bouncing_ball_beyond.inherited.numerics.pseudo_arclength import (
    continue_all_both_ways,
    continue_branches,
)
from bouncing_ball_beyond.inherited.numerics.steps import StepControl, WithEvents


def continue_branch(
    problem, start, *, increasing=True, events=(), control=StepControl(), max_points=2000
):
    """The branch from ``start`` on, where the parameter increases or decreases at first."""
    towards = np.eye(np.size(start))[-1] * (1.0 if increasing else -1.0)
    tested = WithEvents(problem, events)
    (found,) = continue_branches(lambda _: tested, [start], [towards], control, max_points)
    if isinstance(found, ContinuationError):
        raise found
    return found


def continue_both_ways(problem, start, *, events=(), control=StepControl(), max_points=2000):
    """The branch through ``start``, on which the parameter increases there."""
    tested = WithEvents(problem, events)
    (found,) = continue_all_both_ways(lambda _: tested, [start], control, max_points)
    if isinstance(found, ContinuationError):
        raise found
    return found
