"""The limits of a domain on a branch, which a truth value alone gives, by bisection."""

from collections.abc import Callable
from typing import Any

import numpy as np

from bouncing_ball_beyond.inherited.numerics.corrector import Problem, newton, plane
from bouncing_ball_beyond.inherited.numerics.events import Event, SpecialPoint

# A chord is divided at these shares, at points that are computed together, which costs hardly more
# than one point does; and the largest number of such divisions.
_SHARES = np.linspace(0.0, 1.0, 17)[1:-1, np.newaxis]
_ROUNDS = 15
# A chord is divided until its length relative to the point is at most this rounding error.
_ROUNDING = 4e-16
_TINY = np.finfo(float).tiny


class DomainLimit(Event):
    """An event whose test function is only a sign: positive inside a domain, negative outside."""

    def locate(
        self, problem: Problem, left: np.ndarray, right: np.ndarray, *_: Any, **known: Any
    ) -> SpecialPoint:
        """The last point inside between a point inside and one outside."""
        ends = np.stack([left, right])
        (last,) = domain_limits(problem, lambda y: self.function(y) > 0, ends)
        return SpecialPoint(self.name, last)


def domain_limits(
    problem: Problem, inside_at: Callable[[np.ndarray], np.ndarray], points: np.ndarray
) -> np.ndarray:
    """The last points of a branch inside a domain, one for each of the limits that it crosses.

    A limit lies between a point inside and a point outside. The chord between the two points is
    divided into 16 parts, again and again, where each point is corrected onto the branch, until the
    two points agree to rounding.

    Parameters
    ----------
    problem : Problem
        Its solutions are the branch.
    inside_at : callable
        Tells for solutions of shape (..., N + 1) whether they are inside.
    points : ndarray, shape (m, N + 1)
        Solutions in order along the branch.

    Returns
    -------
    ndarray, shape (k, N + 1)
        One point for each of the k limits, in order along the branch.
    """
    known = inside_at(points)
    at = np.flatnonzero(known[:-1] != known[1:])
    inside = points[np.where(known[at], at, at + 1)]
    outside = points[np.where(known[at], at + 1, at)]
    if not at.size:
        return inside
    row = np.arange(at.size)
    for _ in range(_ROUNDS):
        normal = outside - inside
        length = np.linalg.norm(normal, axis=-1, keepdims=True)
        if np.all(length[:, 0] <= _ROUNDING * np.linalg.norm(inside, axis=-1)):
            break
        between = inside[:, np.newaxis] + _SHARES * normal[:, np.newaxis]
        across = np.broadcast_to((normal / np.maximum(length, _TINY))[:, np.newaxis], between.shape)
        found = newton(problem, between, plane(across, between))
        # The limit lies after the last of the first points that are inside, and before the next.
        reached = np.where(found.converged[..., np.newaxis], found.point, inside[:, np.newaxis])
        good = inside_at(reached) & found.converged
        count = np.cumprod(good, axis=-1).sum(axis=-1)
        known = np.concatenate([inside[:, np.newaxis], reached, outside[:, np.newaxis]], axis=1)
        solved = np.pad(found.converged, ((0, 0), (1, 1)), constant_values=True)
        inside = known[row, count]
        outside = np.where(solved[row, count + 1, np.newaxis], known[row, count + 1], outside)
    return inside
