"""The start of a branch: closed branches come back to it, and a special start is not listed."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from bouncing_ball_beyond.inherited.numerics.branch import Branch, End
from bouncing_ball_beyond.inherited.numerics.corrector import plane
from bouncing_ball_beyond.inherited.numerics.events import SpecialPoint
from bouncing_ball_beyond.periodic.branches.following import Followed
from bouncing_ball_beyond.periodic.orbits.impacts import point_of
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.short_steps import newton_short
from bouncing_ball_beyond.periodic.orbits.steps import PATIENT

CLOSED = "the branch is closed: it comes back to its start"
"""Why a closed branch ends."""
# A branch that passes its start passes it within this distance, the accuracy of located orbits, and
# in the same direction up to this cosine.
_SAME = 1e-7
_DIRECTION = 0.9


def one_turn(found: Followed) -> Followed:
    """A branch that comes back to its start, up to there; any other branch as it is.

    The start lies on a step of the branch if the solution in the plane across its own direction,
    near that step, is the start itself.
    """
    y = found.branch.points
    along = found.branch.tangents
    start = y[0]
    passed = (y - start) @ along[0]
    farthest = 2 * np.linalg.norm(np.diff(y, axis=0), axis=-1).max(initial=0.0)
    near = np.linalg.norm(y - start, axis=-1) < farthest
    crosses = (passed[:-1] < 0) & (passed[1:] >= 0) & near[:-1] & near[1:]
    crosses &= along[:-1] @ along[0] > _DIRECTION
    for k in np.flatnonzero(crosses):
        share = passed[k] / (passed[k] - passed[k + 1])
        guess = y[k] + share * (y[k + 1] - y[k])
        back = newton_short(found.problem, guess, plane(along[0], start), PATIENT)
        if back.converged and np.linalg.norm(back.point - start) <= _SAME:
            return replace(found, branch=_up_to_start(found.branch, int(k) + 1))
    return found


def without_start(found: Followed, start: Orbit) -> Followed:
    """A branch without the special orbit at which it starts.

    The test function of this orbit vanishes at the start up to rounding, whose sign decides whether
    a continuation sees a change of sign there.
    """
    if not start.kind:
        return found
    here = point_of(start, found.problem.equations)
    branch = found.branch
    others = [each for each in branch.special if np.linalg.norm(each.point - here) > _SAME]
    return replace(found, branch=replace(branch, special=tuple(others)))


def _up_to_start(branch: Branch, count: int) -> Branch:
    """The first points of a closed branch, and its start once more."""
    return replace(
        branch,
        points=np.concatenate([branch.points[:count], branch.points[:1]]),
        tangents=np.concatenate([branch.tangents[:count], branch.tangents[:1]]),
        special=_first_turn(branch.special),
        end=End(CLOSED),
    )


def _first_turn(special: Sequence[SpecialPoint]) -> tuple[SpecialPoint, ...]:
    """The special points up to where the first of them comes again."""
    for number, each in enumerate(special):
        again = number > 0 and each.name == special[0].name
        if again and np.linalg.norm(each.point - special[0].point) <= _SAME:
            return tuple(special[:number])
    return tuple(special)
