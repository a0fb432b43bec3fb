"""The whole branches of n-T orbits of a ball over Λ, on both sides of their saddle-nodes."""

from functools import partial

import xarray as xr

from bouncing_ball.datasets.arguments import (
    FAMILY,
    POINTS,
    POSITIVE,
    FamilyAxis,
    Points,
    checked,
    checked_number,
)
from bouncing_ball.datasets.labelled import Grid
from bouncing_ball.datasets.variables import describe
from bouncing_ball.drawing.result import Result
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.models.ball import Ball, a_ball
from bouncing_ball.models.model import Model
from bouncing_ball.numerics.continuation import ContinuationError
from bouncing_ball.periodic.branch import whole_branch
from bouncing_ball.periodic.observables import VARIABLES, branch_columns, joined, no_branch
from bouncing_ball.periodic.places import by_place

# The longest step along a branch, and as a fraction of the largest Λ, if that is large: a branch
# has some thousand points at most.
_LARGEST_STEP = 0.1
_STRIDE = 2e-3


def branch(
    ball: Ball, n: FamilyAxis = 1, *, amplitude_max: float | None = None, points: Points = 300
) -> Result:
    """The branch of n-T orbits over the amplitude Λ, on both sides of its saddle-node.

    Parameters
    ----------
    ball : Ball
    n : int or array of int
        Index n of the family.
    amplitude_max : float, optional
        Largest Λ of the branch; by default 1.4 times that of the period doubling.
    points : int
        Number of points along the branch, at equal steps of arclength.

    Returns
    -------
    Result
        ``amplitude``, ``phase`` and the other observables of each ``point``, and whether the
        orbit is ``stable`` and ``admissible``; ``special_amplitude`` and others of the
        saddle-nodes, period doublings and grazing orbits. Where one of several branches does not
        exist it is NaN, and ``end_reason`` says why.

    Raises
    ------
    NoOrbitError
        If there is no branch up to this Λ, or if it cannot be followed.
    ModelError
        If a parameter is of a wrong type or shape, or out of range.

    Examples
    --------
    >>> import math
    >>> from bouncing_ball import rigid
    >>> found = branch(rigid(restitution=0.85), points=50)
    >>> found.special_kind.values.tolist()
    ['saddle-node', 'period doubling']
    >>> round(float(found.special_amplitude[0]) / math.pi * 1.85 / 0.15, 12)
    1.0
    """
    family = checked("n", n, FAMILY)
    count = checked_number("points", points, POINTS)
    top = None
    if amplitude_max is not None:
        top = checked_number("amplitude_max", amplitude_max, POSITIVE)

    def found(one: Ball, n: int) -> xr.Dataset:
        return _branch_of(one.at_limits(n), n, top, count)

    grid = Grid(n=family, **a_ball(ball).parameters)
    whole = by_place(grid, ball, ("n",), found, partial(no_branch, count), joined)
    branches = Result.of(grid.unfold(describe(whole, VARIABLES)), "branch")
    return branches if top is None else branches.assign_attrs(amplitude_max=top)


def _branch_of(model: Model, n: int, amplitude_max: float | None, points: int) -> xr.Dataset:
    """The branch of n-T orbits of a single model up to some Λ, shape (point,).

    Raises
    ------
    NoOrbitError
        If the branch begins above this Λ, or if it cannot be followed.
    """
    longest = max(_LARGEST_STEP, _STRIDE * (amplitude_max or 0.0))
    try:
        found = whole_branch(model, n, amplitude_max, longest)
        return branch_columns(found, points)
    except ContinuationError as error:
        raise NoOrbitError(f"the branch of {n}-T orbits for {model.label}: {error}") from None
