"""Where a branch becomes inadmissible.

Between an admissible and an inadmissible point lies a grazing orbit. It is
found by bisection of the chord between both, each point corrected onto the
branch, down to neighbouring floating-point numbers.
"""

from collections.abc import Callable

import numpy as np

from bouncing_ball.continuation.corrector import NewtonSettings, newton, plane
from bouncing_ball.continuation.problem import Problem

_BISECTIONS = 60


def grazing_points(
    problem: Problem,
    admissible_at: Callable[[np.ndarray], np.ndarray],
    points: np.ndarray,
    settings: NewtonSettings,
) -> list[np.ndarray]:
    """The last admissible points of a branch, one for every change along it.

    Parameters
    ----------
    problem : Problem
        Its solutions are the branch.
    admissible_at : callable
        Whether solutions of shape (..., N + 1) are admissible.
    points : ndarray, shape (m, N + 1)
        Solutions in order along the branch.
    settings : NewtonSettings
    """
    admissible = admissible_at(points)
    found = []
    for k in np.nonzero(admissible[:-1] != admissible[1:])[0]:
        inside, outside = (k, k + 1) if admissible[k] else (k + 1, k)
        left, right = points[inside], points[outside]
        for _ in range(_BISECTIONS):
            middle = (left + right) / 2
            normal = (right - left) / np.linalg.norm(right - left)
            corrected = newton(problem, middle, plane(normal, middle), settings)
            if not corrected.converged:
                break
            middle = corrected.point
            if np.linalg.norm(right - left) <= 4e-16 * np.linalg.norm(left):
                break
            if admissible_at(middle[np.newaxis])[0]:
                left = middle
            else:
                right = middle
        found.append(left)
    return found
