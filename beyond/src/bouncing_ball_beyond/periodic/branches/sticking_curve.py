"""The end of sticking in two parameters of the restitution model.

No function with known derivatives vanishes where sticking ends (:func:`~.special.sticking`), so
that Newton's method cannot follow such orbits. The equations of the orbit are smooth all the same.
The curve is therefore a row of limits: at each value of one parameter the orbit is followed along
the other one from one side of the limit to the other, and the limit between them is found to
rounding. The row is followed by :mod:`~bouncing_ball_beyond.periodic.branches.point_by_point`.
"""

from dataclasses import replace

import numpy as np

from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.numerics.branch import Branch, ContinuationError, End
from bouncing_ball_beyond.inherited.numerics.corrector import plane, tangent
from bouncing_ball_beyond.periodic.branches.point_by_point import (
    OTHER,
    AllPoints,
    AtBound,
    Lost,
    Stop,
    follow_points,
)
from bouncing_ball_beyond.periodic.orbits.domain_limits import domain_limits
from bouncing_ball_beyond.periodic.orbits.ends import Window, bound_in_words
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations
from bouncing_ball_beyond.periodic.orbits.short_steps import newton_short
from bouncing_ball_beyond.periodic.orbits.special import sticking
from bouncing_ball_beyond.periodic.orbits.steps import PATIENT

# The distance along the branch at which the limit is first looked for on both sides of its
# prediction, and how many distances are tried, each four times as long as the one before.
_APART = 1e-7
_LONGER = 10


def sticking_curve(
    equations: OrbitEquations, start: np.ndarray, windows: tuple[Window, Window], most: int
) -> Branch:
    """The limits of sticking through one of them, in both directions.

    Parameters
    ----------
    equations : OrbitEquations
        The equations, with the two parameters.
    start : ndarray, shape (N + 2,)
        An orbit at the end of sticking.
    windows : tuple of Window
        The ranges of the two parameters.
    most : int
        Number of points in each direction.

    Raises
    ------
    NoOrbitError
        If there is no end of sticking near the start.
    """
    within = np.arcsinh([(each.low, each.high) for each in windows])
    try:
        row = follow_points(
            lambda guess, given: _limit(equations, guess, given), start, within, most
        )
    except ContinuationError as error:
        raise NoOrbitError(
            f"no end of sticking was found near the start of the curve: {error}"
        ) from None
    begin, end = (_in_words(equations, windows, stop) for stop in (row.start, row.end))
    return Branch(row.points, row.tangents, special=(), start=begin, end=end)


def _in_words(equations: OrbitEquations, windows: tuple[Window, Window], stop: Stop) -> End:
    """The reason for an end of the curve as a sentence."""
    match stop:
        case AtBound(column, upper, passed):
            bound = windows[column].high if upper else windows[column].low
            where = bound_in_words(equations.along[column], bound)
            return End(f"{where} is {'passed' if passed else 'reached'}")
        case Lost(why):
            return End(f"no end of sticking was found beyond this point: {why}")
        case AllPoints(most):
            return End(f"reached the limit of {most} points", finished=False)


def _limit(equations: OrbitEquations, guess: np.ndarray, given: int) -> np.ndarray:
    """The end of sticking next to a guess, with its coordinate of one parameter, by its column.

    Raises
    ------
    ContinuationError
        If there is none near.
    """
    free = OTHER[given]
    value = {equations.along[given]: np.sinh(guess[given])}
    one = replace(equations, along=(equations.along[free],), balls=equations.balls.at(value))
    start = np.array([*guess[:-2], guess[free]])
    with np.errstate(all="ignore"):
        # Along the branch, because its states change much faster than the parameter.
        ahead = tangent(one.jacobian(start), np.eye(start.size)[-1])
        for apart in _APART * 4.0 ** np.arange(_LONGER):
            beside = start + apart * np.array([-1.0, 1.0])[:, np.newaxis] * ahead
            found = newton_short(one, beside, plane(np.stack([ahead, ahead]), beside), PATIENT)
            if not found.converged.all():
                raise ContinuationError("Newton's method finds no orbit there")
            if not _rests(one, found.point).all():
                raise ContinuationError("Newton's method leads to orbits whose balls never rest")
            signs = sticking(one, found.point)
            if signs[0] != signs[1]:
                (limit,) = domain_limits(one, lambda y: sticking(one, y) > 0, found.point)
                there = guess.copy()
                there[:-2] = limit[:-1]
                there[free] = limit[-1]
                return there
    raise ContinuationError("the balls of all orbits near it come to rest, or those of none")


def _rests(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """Whether the ball rests on the table at orbits, in one of their impacts."""
    return np.any(equations.durations(y) > 0, axis=-1)
