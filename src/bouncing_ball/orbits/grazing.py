"""Grazing points, at which a branch becomes inadmissible.

A grazing orbit lies between an admissible and an inadmissible point of a branch. It is found by
bisection of the chord between the two points, where each midpoint is corrected onto the branch,
until the two points agree to rounding.
"""

from collections.abc import Callable

import numpy as np

from bouncing_ball.continuation.corrector import Problem, newton, plane

_BISECTIONS = 60
_TINY, _ROUNDING = np.finfo(float).tiny, 4e-16


def grazing_points(
    problem: Problem, admissible_at: Callable[[np.ndarray], np.ndarray], points: np.ndarray
) -> np.ndarray:
    """The last admissible points of a branch, one for each change of admissibility along it.

    Parameters
    ----------
    problem : Problem
        Its solutions are the branch.
    admissible_at : callable
        Tells for solutions of shape (..., N + 1) whether they are admissible.
    points : ndarray, shape (m, N + 1)
        Solutions in order along the branch.

    Returns
    -------
    ndarray, shape (k, N + 1)
        One point for each of the k changes, in order along the branch.
    """
    admissible = admissible_at(points)
    at = np.flatnonzero(admissible[:-1] != admissible[1:])
    inside, outside = points[at + ~admissible[at]], points[at + admissible[at]]
    for _ in range(_BISECTIONS if at.size else 0):
        middle, normal = (inside + outside) / 2, outside - inside
        length = np.linalg.norm(normal, axis=-1, keepdims=True)
        found = newton(problem, middle, plane(normal / np.maximum(length, _TINY), middle))
        good = admissible_at(found.point)
        closer = found.converged & (length[:, 0] > _ROUNDING * np.linalg.norm(inside, axis=-1))
        inside[closer & good] = found.point[closer & good]
        outside[closer & ~good] = found.point[closer & ~good]
    return inside
