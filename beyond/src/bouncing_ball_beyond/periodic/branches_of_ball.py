"""The whole branches of n-T orbits of a ball over Λ, on both sides of their saddle-nodes."""

from functools import partial

import xarray as xr

from bouncing_ball_beyond.inherited.datasets.arguments import (
    FamilyAxis,
    Points,
    Positive,
)
from bouncing_ball_beyond.inherited.datasets.variables import describe
from bouncing_ball_beyond.inherited.errors import NoOrbitError, suggesting
from bouncing_ball_beyond.inherited.numerics.branch import ContinuationError
from bouncing_ball_beyond.inherited.periodic import branches
from bouncing_ball_beyond.models.ball import Ball
from bouncing_ball_beyond.models.docstrings import as_in
from bouncing_ball_beyond.models.given_ball import a_ball
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.periodic.branches.following import Followed
from bouncing_ball_beyond.periodic.branches.labelled import BranchDataset
from bouncing_ball_beyond.periodic.branches.observables import (
    OF_BRANCHES,
    n_t_columns,
    no_branch,
)
from bouncing_ball_beyond.periodic.one_impact.whole_branch import LARGEST_STEP, whole_branch
from bouncing_ball_beyond.periodic.orbits.saved import KEPT
from bouncing_ball_beyond.periodic.places import by_place

# The longest step along a branch is this fraction of the largest Λ, if that is large: a branch has
# some thousand points at most.
_STRIDE = 2e-3


@suggesting
@as_in(branches.branch)
def branch(
    ball: Ball, n: FamilyAxis = 1, *, amplitude_max: Positive | None = None, points: Points = 300
) -> BranchDataset:
    """The branch of n-T orbits of a ball of any model over the amplitude Λ.

    Parameters
    ----------
    ball : Ball

    Returns
    -------
    BranchDataset
        The variables of :func:`bouncing_ball_beyond.inherited.branch`. A single branch has the
        orbits themselves as well, as what :func:`bouncing_ball_beyond.follow` finds.

    Examples
    --------
    >>> from bouncing_ball_beyond import rigid
    >>> found = branch(rigid(restitution=0.85), points=50)
    >>> found.first("saddle-node").amplitude == float(found.special_amplitude[0])
    True
    """
    given = a_ball(ball)
    grid, top, count = branches.checked_branches(given.parameters, n, amplitude_max, points)

    def found(one: Ball, n: int) -> xr.Dataset:
        return n_t_columns(_branch_of(one.at_limits(n), n, top, count))

    whole = by_place(grid, given, ("n",), found, partial(no_branch, count), branches.joined)
    data = grid.unfold(describe(whole, OF_BRANCHES | KEPT)).assign_attrs(
        along="amplitude", impacts=1
    )
    if "n" in data.attrs:
        data = data.assign_attrs(periods=data.attrs["n"])
    if top is not None:
        data = data.assign_attrs(amplitude_max=top)
    return BranchDataset.of(data, "branch")


def _branch_of(model: Model, n: int, amplitude_max: float | None, points: int) -> Followed:
    """The branch of n-T orbits of a single model up to some Λ, with this number of points.

    Raises
    ------
    NoOrbitError
        If the branch begins above this Λ, or if it cannot be followed.
    """
    longest = max(LARGEST_STEP, _STRIDE * (amplitude_max or 0.0))
    try:
        return whole_branch(model, n, amplitude_max, longest).resampled(points)
    except ContinuationError as error:
        raise NoOrbitError(f"the branch of {n}-T orbits for {model.label}: {error}") from None
