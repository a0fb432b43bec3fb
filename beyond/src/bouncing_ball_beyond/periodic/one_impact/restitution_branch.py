"""Phase and speed of the impacts of the restitution model's n-T orbits.

Its saddle-node and period doublings are the inherited
(:mod:`bouncing_ball_beyond.inherited.periodic.restitution_branch`).
"""

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.models import restitution as rigid
from bouncing_ball_beyond.inherited.periodic.orbit import Side
from bouncing_ball_beyond.inherited.periodic.restitution_branch import (
    RestitutionBranch,
    restitution_saddle_node,
)


def rigid_speed(n: ArrayLike, restitution: ArrayLike) -> np.ndarray:
    """Impact speed 2πn/(1 + r) of the restitution model's n-T orbits, at every Λ.

    Examples
    --------
    >>> bool(rigid_speed(2, 1.0) == 2 * np.pi)
    True
    """
    return 2 * np.pi * np.asarray(n) / (1 + np.asarray(restitution, dtype=float))


def phase(
    n: ArrayLike, restitution: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE
) -> np.ndarray:
    """Phase φ of the impact, in [-π/2, π/2]: that of the inherited :class:`.RestitutionBranch`.

    Raises
    ------
    NoOrbitError
        If a value of Λ lies below the saddle-node.

    Examples
    --------
    >>> round(float(phase(1, 1.0, 0.5)) / np.pi, 15)
    0.5
    """
    fold = restitution_saddle_node(n, restitution)
    lam = np.asarray(amplitude, dtype=float)
    below = ~(lam >= fold)
    if np.any(below):
        family, at, least = (x[below][0] for x in np.broadcast_arrays(n, lam, fold))
        raise NoOrbitError(
            f"no {family}-T orbit at Λ = {at:g}: below the saddle-node at Λ = {least:.6g}"
        )
    branch = RestitutionBranch(rigid.RestitutionModel(restitution))
    return np.asarray(branch.orbit(n, lam, side).phase)
