"""The end of sticking in two parameters of the restitution model.

No smooth function vanishes where sticking ends (:func:`~.special.sticking`), so that Newton's
method cannot follow such orbits. The equations of the orbit are smooth all the same. The curve is
therefore a row of limits: at each value of the second parameter the orbit is followed along the
first one from one side of the limit to the other, and the limit between them is found to rounding.
The next limit is predicted by the line through the last two.
"""

from dataclasses import replace

import numpy as np

from bouncing_ball.errors import NoOrbitError
from bouncing_ball.numerics.branch import Branch, End
from bouncing_ball.numerics.corrector import newton, plane, tangent
from bouncing_ball.numerics.events import domain_limits
from bouncing_ball.periodic.branches.following import PATIENT, Window
from bouncing_ball.periodic.orbits.problem import PeriodicOrbits
from bouncing_ball.periodic.orbits.special import sticking

# The first, the largest and the smallest step in the coordinate of the second parameter.
_FIRST = 0.005
_LARGEST = 0.05
_SMALLEST = 1e-6
# A curve that is steeper than this at the smallest step turns back: with a curvature of 1 it has a
# slope of about 1/sqrt(2 _SMALLEST), and with one of 1000 still 20.
_STEEP = 10.0
# The distance along the branch at which the limit is first looked for on both sides of its
# prediction, and how many distances are tried, each four times as long as the one before.
_APART = 1e-7
_LONGER = 10


def sticking_curve(
    orbits: PeriodicOrbits, start: np.ndarray, windows: tuple[Window, Window], most: int
) -> Branch:
    """The limits of sticking through one of them, in both directions of the second parameter.

    Parameters
    ----------
    orbits : PeriodicOrbits
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
        first = _limit(orbits, start, start[-1])
    except NoOrbitError as error:
        raise NoOrbitError(
            f"no end of sticking was found near the start of the curve: {error}"
        ) from None
    forward, end = _one_way(orbits, first, 1.0, windows, most)
    backward, begin = _one_way(orbits, first, -1.0, windows, most)
    points = np.array([*backward[:0:-1], *forward])
    slopes = np.gradient(points, axis=0) if len(points) > 1 else np.ones_like(points)
    tangents = slopes / np.linalg.norm(slopes, axis=-1, keepdims=True)
    return Branch(points, tangents, special=(), start=begin, end=end)


def _one_way(
    orbits: PeriodicOrbits,
    first: np.ndarray,
    sign: float,
    windows: tuple[Window, Window],
    most: int,
) -> tuple[list[np.ndarray], End]:
    """The points in one direction of the second parameter, and why they end."""
    along, across = orbits.along
    within, limits = (np.arcsinh(np.array(window)) for window in windows)
    last = limits[1] if sign > 0 else limits[0]
    points = [first]
    step = _FIRST
    while len(points) < most:
        here = points[-1]
        ahead = here[-1] + sign * min(step, sign * (last - here[-1]))
        slope = np.zeros_like(here)
        if len(points) > 1:
            slope = (here - points[-2]) / (here[-1] - points[-2][-1])
        guess = here + slope * (ahead - here[-1])
        try:
            found = _limit(orbits, guess, ahead)
        except NoOrbitError as error:
            step /= 2
            if step >= _SMALLEST:
                continue
            if _turns(points):
                at = f"{across.replace('_', ' ')} = {np.sinh(here[-1]):.6g}"
                why = f"the curve turns back at {at}: exchange the parameters to follow it further"
                return points, End(why)
            return points, End(f"no end of sticking was found beyond this point: {error}")
        if not within[0] <= found[-2] <= within[1]:
            bound = windows[0].high if found[-2] > within[1] else windows[0].low
            return points, End(f"{along.replace('_', ' ')} = {bound:g} is passed")
        points.append(found)
        if ahead == last:
            value = windows[1].high if sign > 0 else windows[1].low
            return points, End(f"{across.replace('_', ' ')} = {value:g} is reached")
        step = min(2 * step, _LARGEST)
    return points, End(f"reached the limit of {most} points", finished=False)


def _turns(points: list[np.ndarray]) -> bool:
    """Whether a curve turns back in the second parameter: it becomes ever steeper over it."""
    if len(points) < 3:
        return False
    along, across = np.abs(np.diff(points[-3:], axis=0))[:, -2:].T
    before, last = along / across
    return bool(last > before and last > _STEEP)


def _limit(orbits: PeriodicOrbits, guess: np.ndarray, across: float) -> np.ndarray:
    """The end of sticking at a coordinate of the second parameter, next to a guess.

    Raises
    ------
    NoOrbitError
        If there is none near.
    """
    first, second = orbits.along
    one = replace(orbits, along=(first,), balls=orbits.balls.at({second: np.sinh(across)}))
    start = guess[:-1]
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
                return np.array([*limit, across])
    raise NoOrbitError("the balls of all orbits near it come to rest, or those of none")


def _rests(orbits: PeriodicOrbits, y: np.ndarray) -> np.ndarray:
    """Whether the ball rests on the table at orbits, in one of their impacts."""
    return np.any(orbits.durations(y) > 0, axis=-1)
