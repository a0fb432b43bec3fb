"""The end of sticking in two parameters of the restitution model.

No smooth function vanishes where sticking ends (:func:`~.special.sticking`), so that Newton's
method cannot follow such orbits. The equations of the orbit are smooth all the same. The curve is
therefore a row of limits: at each value of one parameter the orbit is followed along the other one
from one side of the limit to the other, and the limit between them is found to rounding. The next
limit is predicted by the line through the last two, and it is sought at the value of the parameter
that changes faster along this line, so that a curve may turn back in each of them.
"""

from dataclasses import replace

import numpy as np

from bouncing_ball.errors import NoOrbitError
from bouncing_ball.numerics.branch import Branch, End
from bouncing_ball.numerics.corrector import newton, plane, tangent
from bouncing_ball.numerics.events import domain_limits
from bouncing_ball.periodic.orbits.ends import Window, bound_in_words
from bouncing_ball.periodic.orbits.problem import OrbitEquations
from bouncing_ball.periodic.orbits.special import sticking
from bouncing_ball.periodic.orbits.steps import PATIENT

# The first, the largest and the smallest step in the coordinate of the parameter that is given.
_FIRST = 0.005
_LARGEST = 0.05
_SMALLEST = 1e-6
# The parameter that is given changes if the other one moves faster by this factor, so that it does
# not change at each point of a curve along the diagonal.
_FASTER = 1.5
# The distance along the branch at which the limit is first looked for on both sides of its
# prediction, and how many distances are tried, each four times as long as the one before.
_APART = 1e-7
_LONGER = 10
# The columns of the two parameters, each with the other one.
_OTHER = {-1: -2, -2: -1}


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
    try:
        first = _limit(equations, start, -1)
    except NoOrbitError as error:
        raise NoOrbitError(
            f"no end of sticking was found near the start of the curve: {error}"
        ) from None
    forward, end = _one_way(equations, first, 1.0, windows, most)
    backward, begin = _one_way(equations, first, -1.0, windows, most)
    points = np.array([*backward[:0:-1], *forward])
    slopes = np.gradient(points, axis=0) if len(points) > 1 else np.ones_like(points)
    tangents = slopes / np.linalg.norm(slopes, axis=-1, keepdims=True)
    return Branch(points, tangents, special=(), start=begin, end=end)


def _one_way(
    equations: OrbitEquations,
    first: np.ndarray,
    sign: float,
    windows: tuple[Window, Window],
    most: int,
) -> tuple[list[np.ndarray], End]:
    """The points in one direction, in which the second parameter first rises if the sign is
    positive, and why they end.
    """
    within = np.arcsinh([(each.low, each.high) for each in windows])
    points = [first]
    step = _FIRST
    # The column of the parameter that is given, and the direction in which it goes.
    given = -1
    heading = sign
    while len(points) < most:
        here = points[-1]
        low, high = within[given]
        last = high if heading > 0 else low
        ahead = here[given] + heading * min(step, heading * (last - here[given]))
        slope = np.zeros_like(here)
        if len(points) > 1:
            change = here - points[-2]
            slope = change / change[given]
        guess = here + slope * (ahead - here[given])
        guess[given] = ahead
        try:
            found = _limit(equations, guess, given)
        except NoOrbitError as error:
            step /= 2
            if step >= _SMALLEST:
                continue
            return points, End(f"no end of sticking was found beyond this point: {error}")
        other = _OTHER[given]
        if not within[other][0] <= found[other] <= within[other][1]:
            window = windows[other]
            bound = window.high if found[other] > within[other][1] else window.low
            return points, End(f"{bound_in_words(equations.along[other], bound)} is passed")
        points.append(found)
        if ahead == last:
            value = windows[given].high if heading > 0 else windows[given].low
            return points, End(f"{bound_in_words(equations.along[given], value)} is reached")
        step = min(2 * step, _LARGEST)
        change = found - here
        if abs(change[other]) > _FASTER * abs(change[given]):
            # The next step along the line is as long as it would have been.
            step = min(step * abs(change[other] / change[given]), _LARGEST)
            given = other
            heading = float(np.sign(change[other]))
    return points, End(f"reached the limit of {most} points", finished=False)


def _limit(equations: OrbitEquations, guess: np.ndarray, given: int) -> np.ndarray:
    """The end of sticking next to a guess, with its coordinate of one parameter, by its column.

    Raises
    ------
    NoOrbitError
        If there is none near.
    """
    free = _OTHER[given]
    value = {equations.along[given]: np.sinh(guess[given])}
    one = replace(equations, along=(equations.along[free],), balls=equations.balls.at(value))
    start = np.array([*guess[:-2], guess[free]])
    with np.errstate(all="ignore"):
        # Along the branch, because its states change much faster than the parameter.
        ahead = tangent(one.jacobian(start), np.eye(start.size)[-1])
        for apart in _APART * 4.0 ** np.arange(_LONGER):
            beside = start + apart * np.array([-1.0, 1.0])[:, np.newaxis] * ahead
            found = newton(one, beside, plane(np.stack([ahead, ahead]), beside), PATIENT)
            if not found.converged.all():
                raise NoOrbitError("Newton's method finds no orbit there")
            if not _rests(one, found.point).all():
                raise NoOrbitError("Newton's method leads to orbits whose balls never rest")
            signs = sticking(one, found.point)
            if signs[0] != signs[1]:
                (limit,) = domain_limits(one, lambda y: sticking(one, y) > 0, found.point)
                there = guess.copy()
                there[:-2] = limit[:-1]
                there[free] = limit[-1]
                return there
    raise NoOrbitError("the balls of all orbits near it come to rest, or those of none")


def _rests(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """Whether the ball rests on the table at orbits, in one of their impacts."""
    return np.any(equations.durations(y) > 0, axis=-1)
