"""A whole n-T branch with its bifurcations, from the formula alone."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from bouncing_ball.impacts.spring_damper import Contact
from bouncing_ball.orbits.closed_form import BranchPoint, branch_point
from bouncing_ball.orbits.stability import period_doubling_function


@dataclass(frozen=True)
class ExplicitBranch:
    """Points of a branch in order of contact duration, and its bifurcations.

    Parameters
    ----------
    excess : ndarray, shape (points,)
        ε of the points.
    points : BranchPoint
        The points themselves, arrays of shape (points,).
    saddle_nodes, period_doublings : ndarray
        ε of every bifurcation in the range, to rounding.
    """

    excess: np.ndarray
    points: BranchPoint
    saddle_nodes: np.ndarray
    period_doublings: np.ndarray


def _roots(function, excess: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Roots between neighbouring points of opposite sign, by Brent's method."""
    at = np.nonzero((values[:-1] < 0) != (values[1:] < 0))[0]
    scale = np.finfo(float).tiny
    tightest = 4 * np.finfo(float).eps
    return np.array(
        [brentq(function, excess[k], excess[k + 1], xtol=scale, rtol=tightest) for k in at]
    )


def explicit_branch(
    contact: Contact, n: int, low: float, high: float, points: int = 365
) -> ExplicitBranch:
    """The branch for ε from ``low`` to ``high``, at equal steps.

    Parameters
    ----------
    contact : Contact
        One contact, with ζ < 1.
    n : int
        Index of the family.
    low, high : float
        Range of the excess angle; the fold is at ε of order 1/ϖ.
    points : int
        Two bifurcations of one kind within one step are missed.

    Examples
    --------
    >>> branch = explicit_branch(Contact(1e4, 0.05), 1, -3e-4, 3e-4)
    >>> len(branch.saddle_nodes), len(branch.period_doublings)
    (1, 1)
    """
    excess = np.linspace(low, high, points)
    curve = branch_point(excess, contact, n)

    def fold(eps: float) -> float:
        return float(branch_point(eps, contact, n).fold)

    def flip(eps: float) -> float:
        point = branch_point(eps, contact, n)
        return float(period_doubling_function(point.trace, point.determinant))

    return ExplicitBranch(
        excess,
        curve,
        _roots(fold, excess, curve.fold),
        _roots(flip, excess, period_doubling_function(curve.trace, curve.determinant)),
    )
