"""Following a curve point by point, where no equation with derivatives gives its points.

Some curves are given by a yes or no alone: a point is the limit between two answers, and a search
finds the limit that has one given coordinate. Such a curve is followed in two coordinates, the last
two entries of its points. The next point is predicted by the line through the last two points, and
it is sought at the value of the coordinate that changes faster along this line, so that the curve
may turn back in each of them. A step is twice as long as the one before, and half as long where no
point is found. The curve ends at a bound of a coordinate, where no step is short enough, or after a
given number of points.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.numerics.branch import ContinuationError

OTHER = {-1: -2, -2: -1}
"""The two coordinates as columns of the points, each with the other one."""


@dataclass(frozen=True)
class PointSteps:
    """The steps in the coordinate that is given.

    Parameters
    ----------
    initial, smallest, largest : float
        The initial, smallest and largest step.
    faster : float
        The coordinate that is given changes if the other one moves faster by this factor. It is
        above 1, so that it does not change at each point of a curve along the diagonal.
    """

    initial: float = 0.005
    smallest: float = 1e-6
    largest: float = 0.05
    faster: float = 1.5


PointAt = Callable[[np.ndarray, int], np.ndarray]
"""Maps a guess, shape (N + 2,), and the column of the coordinate that is given, -2 or -1, to the
point of the curve next to the guess that has this coordinate of the guess, to the last digit. It
raises :class:`.ContinuationError` if there is none."""


class AtBound(NamedTuple):
    """The curve ends at a bound of the coordinate with this column, the upper or the lower one.

    The bound is ``passed`` beyond the last point if the coordinate is the one that was sought;
    otherwise the last point lies on it.
    """

    column: int
    upper: bool
    passed: bool


class Lost(NamedTuple):
    """No point was found beyond the last one, even with the smallest step, for this reason."""

    why: str


class AllPoints(NamedTuple):
    """The curve is left unfinished after the allowed number of points."""

    most: int


Stop = AtBound | Lost | AllPoints
"""Why a curve that is followed point by point has no further point."""


class PointCurve(NamedTuple):
    """Points of a curve in order, shape (m, N + 2), with the reasons for its two ends."""

    points: np.ndarray
    start: Stop
    end: Stop

    @property
    def tangents(self) -> np.ndarray:
        """The unit directions from point to point, shape (m, N + 2)."""
        if len(self.points) == 1:
            slopes = np.ones_like(self.points)
        else:
            slopes = np.gradient(self.points, axis=0)
        return slopes / np.linalg.norm(slopes, axis=-1, keepdims=True)


def follow_points(
    point_at: PointAt,
    start: np.ndarray,
    within: np.ndarray,
    most: int,
    steps: PointSteps = PointSteps(),
) -> PointCurve:
    """Follow the curve through ``start`` in both directions.

    Parameters
    ----------
    point_at : callable
        Finds the point of the curve next to a guess that has one coordinate of the guess.
    start : ndarray, shape (N + 2,)
        A point of the curve or an approximation to it, which is corrected at a fixed last entry.
    within : ndarray, shape (2, 2)
        The lowest and the highest value of the last but one and of the last entry of the points.
    most : int
        Number of points in each direction after which the curve is left unfinished.
    steps : PointSteps

    Returns
    -------
    PointCurve
        Oriented such that the last entry increases at ``start``.

    Raises
    ------
    ContinuationError
        If there is no point near the start.

    Examples
    --------
    The boundary between the points (x, p) inside the circle x² + p² = 1 and those outside turns
    back in x at (1, 0), and ends where p reaches ±0.6:

    >>> def boundary(guess, given):
    ...     inside = guess.copy()
    ...     inside[OTHER[given]] = 0.0
    ...     outside = guess.copy()
    ...     outside[OTHER[given]] = 2.0
    ...     for _ in range(60):
    ...         middle = (inside + outside) / 2
    ...         if np.hypot(*middle) < 1:
    ...             inside = middle
    ...         else:
    ...             outside = middle
    ...     return inside
    >>> within = np.array([[-2.0, 2.0], [-0.6, 0.6]])
    >>> found = follow_points(boundary, np.array([0.9, 0.0]), within, most=100)
    >>> found.points[[0, -1]].round(12).tolist()
    [[0.8, -0.6], [0.8, 0.6]]
    >>> found.end
    AtBound(column=-1, upper=True, passed=False)
    """
    first = point_at(start, -1)
    forward, end = _one_way(point_at, first, 1.0, within, most, steps)
    backward, begin = _one_way(point_at, first, -1.0, within, most, steps)
    return PointCurve(np.array([*backward[:0:-1], *forward]), begin, end)


def _one_way(
    point_at: PointAt,
    first: np.ndarray,
    sign: float,
    within: np.ndarray,
    most: int,
    steps: PointSteps,
) -> tuple[list[np.ndarray], Stop]:
    """The points in one direction, in which the last entry first rises if the sign is positive, and
    why they end.
    """
    points = [first]
    step = steps.initial
    # The column of the coordinate that is given, and the direction in which it goes.
    given = -1
    heading = sign
    while len(points) < most:
        here = points[-1]
        low, high = within[given]
        last = high if heading > 0 else low
        ahead = here[given] + heading * min(step, heading * (last - here[given]))
        try:
            found = point_at(_predicted(points, given, ahead), given)
        except ContinuationError as error:
            step /= 2
            if step >= steps.smallest:
                continue
            return points, Lost(str(error))
        other = OTHER[given]
        low, high = within[other]
        if not low <= found[other] <= high:
            return points, AtBound(other, bool(found[other] > high), passed=True)
        points.append(found)
        if ahead == last:
            return points, AtBound(given, heading > 0, passed=False)
        step = min(2 * step, steps.largest)
        change = found - here
        if abs(change[other]) > steps.faster * abs(change[given]):
            # The next step along the line is as long as it would have been.
            step = min(step * abs(change[other] / change[given]), steps.largest)
            given = other
            heading = float(np.sign(change[other]))
    return points, AllPoints(most)


def _predicted(points: list[np.ndarray], given: int, ahead: float) -> np.ndarray:
    """The point of the line through the last two points, or of the line through the first one along
    the given coordinate, at which this coordinate has the value ``ahead``.
    """
    here = points[-1]
    guess = here.copy()
    if len(points) > 1:
        change = here - points[-2]
        guess += change / change[given] * (ahead - here[given])
    guess[given] = ahead
    return guess
