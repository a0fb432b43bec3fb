"""Saddle-node, period doubling and orbits at a given Λ, on the explicit branch.

These are roots of functions of one variable, the excess angle ε, along the branch of
:mod:`bouncing_ball_beyond.periodic.one_impact.spring_damper_branch`, computed for arrays of
contacts at the same time. A scan brackets the first root next to the fold, and Chandrupatla's
method (:func:`scipy.optimize.elementwise.find_root`) reduces the bracket to the last digit.

The branch comes from Λ → ∞ at short contacts. From there Λ falls as the contact
duration grows, until the saddle-node: this is the side that is stable next to the
fold. Entries for which the quantity does not exist are NaN.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.numerics.arrays import blocks
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation, Side, check_index
from bouncing_ball_beyond.inherited.periodic.spring_damper_branch import (
    SCAN,
    SCAN_START,
    first_change,
    range_of_excess,
    scan,
)
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact.spring_damper_branch import (
    BranchPoint,
    branch_point,
    orbits_on_branch,
)
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit

# A value of a test function that is a rounding error: those of compliant contacts are 1e-13. At
# the end of the scan a test function may be the fourth power of the flight time, and a zero may lie
# at a point of the scan.
_ROUNDING = 1e-12
# Number of contacts searched at the same time, so that a scan takes some ten megabytes.
_BLOCK = 1024
# Steps of the search for all orbits, in radians of the contact's oscillation and of the
# table's, because Λ(ε) oscillates with both; and the largest number of steps.
_FINE = 0.02
_MOST = 200_000


# Functions of points of the branch, whose zeros are searched for. The first two vanish at the
# bifurcations, the third where Λ turns, and the last at a given Λ.
def _saddle(point: BranchPoint) -> np.ndarray:
    return point.saddle_node


def _doubling(point: BranchPoint) -> np.ndarray:
    return Bifurcation.PERIOD_DOUBLING.test(point.trace, point.determinant)


def _fold(point: BranchPoint) -> np.ndarray:
    return point.fold


def _deficit(point: BranchPoint, amplitude: np.ndarray) -> np.ndarray:
    return amplitude - point.amplitude


class _Curves(NamedTuple):
    """The branches of several contacts and families, as functions of ε; one-dimensional arrays."""

    contact: SpringDamper
    n: np.ndarray

    def take(self, which: Any) -> "_Curves":
        return _Curves(self.contact[which], self.n[which])

    def point(self, excess: np.ndarray) -> BranchPoint:
        return branch_point(excess, self.contact, self.n)

    def root(
        self,
        function: Callable,
        grid: np.ndarray,
        interval: np.ndarray,
        found: np.ndarray,
        *more: np.ndarray,
    ) -> np.ndarray:
        """Roots of a function of points of the branch, each in one interval of the grid.

        ``interval`` holds the index of the interval for each contact, and ``more`` further
        arguments of the function. The root is NaN where ``found`` is False.
        """
        # This module of scipy is not loaded on first use, and its import takes a third of a second.
        from scipy.optimize.elementwise import find_root

        def at_excess(excess, which, *more):
            return function(self.take(which).point(excess), *more)

        root = np.full(interval.shape, np.nan)
        which = np.flatnonzero(found)
        if which.size:
            left = interval[which]
            bracket = grid[left, which], grid[left + 1, which]
            # The default tolerance is four units in the last place of the root.
            args = (which, *(x[which] for x in more))
            root[which] = find_root(at_excess, bracket, args=args).x
        return root

    def zero(self, test: Callable, grid: np.ndarray, values: np.ndarray) -> np.ndarray:
        """First zero of a test function with known values along a grid, or NaN.

        A test function also changes sign at a pole. As the bracket shrinks onto a pole, the value
        in it grows beyond the values at both ends, whereas it becomes smaller at a zero, or a
        rounding error. At the end of the range a rounding error is no change of sign.
        """
        _, end = range_of_excess(self.contact, self.n)
        values = np.where((grid >= end) & (np.abs(values) <= _ROUNDING), np.nan, values)
        interval, found = first_change(values)
        root = self.root(test, grid, interval, found)
        contacts = np.arange(self.n.size)
        left = np.abs(values[interval, contacts])
        right = np.abs(values[interval + 1, contacts])
        smaller = np.maximum(np.minimum(left, right), _ROUNDING)
        is_zero = np.abs(test(self.point(root))) <= smaller
        return np.where(is_zero, root, np.nan)

    def fold(self) -> np.ndarray:
        """ε of the saddle-node."""
        grid = scan(self.contact, self.n)
        return self.zero(_saddle, grid, _saddle(self.point(grid)))

    def stable_side(self, function: Callable, *more: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The grid of the scan up to the fold, and the values of a function on it.

        The function is negative at the shortest contacts. If it is positive again at the last
        grid point before the fold, no zero of it is between that point and the fold, and the fold
        itself is not computed. Grid points beyond the end are replaced by the end. Without a fold
        Λ falls along the whole branch, and the whole branch is the stable side.
        """
        grid = scan(self.contact, self.n)
        points = self.point(grid)
        values = function(points, *more)
        saddle = _saddle(points)
        before_fold, has_fold = first_change(saddle)
        contacts = np.arange(self.n.size)
        # Λ has a minimum in the interval, and not a pole.
        falls = points.fold[before_fold, contacts] < 0
        rises = points.fold[before_fold + 1, contacts] >= 0
        positive = values[before_fold, contacts] >= 0
        end = np.where(has_fold, grid[before_fold, contacts], grid[-1])
        near = np.flatnonzero(has_fold & ~(falls & rises & positive))
        fold = self.take(near).zero(_saddle, grid[:, near], saddle[:, near])
        end[near] = np.where(np.isnan(fold), grid[-1, near], fold)
        values = np.where(grid < end, values, function(self.point(end), *more))
        return np.minimum(grid, end), values


def _searched(
    search: Callable, contact: SpringDamper, n: ArrayLike, *more: ArrayLike
) -> np.ndarray:
    """The results of a search for many contacts, in blocks, because each scan has 121 points."""
    check_index(n)
    columns = np.broadcast_arrays(contact.frequency_ratio, contact.damping_ratio, n, *more)
    omega, zeta, n, *rest = (np.ravel(column).astype(float) for column in columns)
    curves = _Curves(SpringDamper(omega, zeta, contact.release), n)
    found = np.empty(omega.size)
    for part in blocks(found.size, _BLOCK):
        found[part] = search(curves.take(part), *(column[part] for column in rest))
    return found.reshape(columns[0].shape)


def saddle_node(contact: SpringDamper, n: ArrayLike) -> np.ndarray:
    """Excess angle ε of the saddle-node, the first zero of 1 - tr + det.

    dΛ/dε also vanishes at the saddle-node. It is not the test function because it vanishes where
    the ball grazes as well, and changes sign at the poles of the branch, where Λ is infinite;
    neither is a bifurcation.

    Parameters
    ----------
    contact : SpringDamper
        ϖ, ζ < 1 and the release rule.
    n : array_like of int
        Index of the family.

    Returns
    -------
    ndarray
        ε for :func:`~bouncing_ball_beyond.periodic.one_impact.spring_damper_branch.branch_point`,
        of the shape to which the contact and n broadcast. NaN where the branch has no fold.

    Raises
    ------
    ModelError
        If n is not a positive integer, or ζ ≥ 1.

    Examples
    --------
    >>> contact = SpringDamper(1e4, 0.05)
    >>> bool(abs(branch_point(saddle_node(contact, 1), contact, 1).phase) < 1e-3)
    True
    """
    return _searched(_Curves.fold, contact, n)


def period_doubling(contact: SpringDamper, n: ArrayLike) -> np.ndarray:
    """Excess angle ε of the period doubling nearest to the saddle-node, on the stable side.

    ε is NaN where the stable side has no period doubling. Arguments, shape and errors are those
    of :func:`saddle_node`.

    Examples
    --------
    For a stiff elastic contact, the period doubling is at Λ = 1, as in the restitution model:

    >>> contact = SpringDamper(1e6, 0.0)
    >>> bool(abs(branch_point(period_doubling(contact, 1), contact, 1).amplitude - 1) < 1e-5)
    True
    """

    def search(curves: _Curves) -> np.ndarray:
        grid, values = curves.stable_side(_doubling)
        return curves.zero(_doubling, grid[::-1], values[::-1])

    return _searched(search, contact, n)


def _stable_side(curves: _Curves, lam: np.ndarray) -> np.ndarray:
    """ε of the orbit at Λ between short contacts and the saddle-node, where Λ falls with ε."""
    grid, deficit = curves.stable_side(_deficit, lam)
    interval, found = first_change(deficit)
    return curves.root(_deficit, grid, interval, found, lam)


def _unstable_side(curves: _Curves, lam: np.ndarray) -> np.ndarray:
    """ε of the orbit at Λ that is nearest to the saddle-node on its unstable side."""
    fold = curves.fold()
    _, high = range_of_excess(curves.contact, curves.n)
    scale = SCAN_START / curves.contact.frequency_ratio
    steps = np.linspace(0, 1, SCAN).reshape(-1, 1)
    outward = fold + scale * np.maximum((high - fold) / scale, 1.0) ** steps
    grid = np.minimum(np.concatenate([fold[np.newaxis], outward]), high)
    # The next turning point of Λ is added to the grid, so that an orbit next to it
    # is not missed between two points.
    turn, turns = first_change(curves.point(grid[1:]).fold)
    summit = curves.root(_fold, grid[1:], turn, turns)
    grid = np.sort(np.concatenate([grid, np.where(turns, summit, high)[np.newaxis]]), axis=0)
    interval, found = first_change(-_deficit(curves.point(grid), lam))
    return curves.root(_deficit, grid, interval, found, lam)


def orbit_at(
    contact: SpringDamper, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE
) -> Orbit:
    """The n-T orbits at given Λ; NaN entries where there is no orbit.

    Parameters
    ----------
    contact : SpringDamper
        ϖ and ζ < 1, scalars or arrays, and the release rule.
    n, amplitude : array_like
        Index of the family and Λ.
    side : Side
        Side of the saddle-node. Where the unstable side turns again, as it does for
        compliant contacts, the result is the orbit nearest to the saddle-node; there may be
        others with longer contacts.

    Returns
    -------
    Orbit
        Of the shape to which the arguments broadcast.

    Raises
    ------
    ModelError
        If n is not a positive integer, ζ ≥ 1, or the side is unknown.

    Examples
    --------
    >>> orbit = orbit_at(SpringDamper(1e4, 0.0517), 1, 1.0)
    >>> abs(round(float(orbit.bounce_velocity) / np.pi, 3))
    1.0
    """
    search = _stable_side if Side(side) is Side.STABLE else _unstable_side
    excess = _searched(search, contact, n, amplitude)
    return orbits_on_branch(excess, contact, n)


def orbits_at(contact: SpringDamper, n: int, amplitude: float) -> Orbit:
    """All n-T orbits of one contact at one Λ, in order of contact duration, shape (count,).

    These are the points of the branch with the given Λ at which the ball approaches the table at
    impact and leaves it at release; they need not be admissible. The turning points of Λ are
    added to a fine grid first, so that two orbits next to one of them are not missed. The grid
    starts at contacts of a thousandth of the free duration, at which Λ exceeds 10⁶; if n periods
    are shorter than this, no orbit is found. It ends after 2·10⁵ steps of 0.02 radians of ϖ_d D,
    so that for nϖ above about 600 the longest contacts are not searched.

    Raises
    ------
    ModelError
        If n is not a positive integer, or ζ ≥ 1.

    Examples
    --------
    >>> orbits = orbits_at(SpringDamper(2.0, 0.05), 1, 0.9)
    >>> orbits.contact_duration.round(3).tolist(), orbits.is_stable().tolist()
    ([1.601, 2.249, 5.193], [True, False, True])
    """
    check_index(n)
    omega = np.atleast_1d(contact.frequency_ratio)
    curve = _Curves(replace(contact, frequency_ratio=omega), np.array([float(n)]))
    low, high = range_of_excess(curve.contact, curve.n)
    # Even a contact that fills the cycle may be shorter than the shortest one of the branch.
    if _is_too_soft(contact, n, amplitude) or low >= high:
        return orbits_on_branch(np.empty(0), contact, n)
    grid = _fine_grid(curve, float(contact.damped_frequency))
    turns = _all_roots(curve, _fold, grid)
    grid = np.sort(np.concatenate([grid, turns]))
    found = orbits_on_branch(_all_roots(curve, _deficit, grid, amplitude), contact, n)
    # A sign change at a pole of the branch is not a root.
    at_amplitude = np.abs(found.amplitude - amplitude) <= 1e-6 * amplitude
    approaches = found.relative_impact_velocity < 0
    leaves = found.relative_bounce_velocity > 0
    return found[at_amplitude & approaches & leaves]


def _is_too_soft(contact: SpringDamper, n: int, amplitude: float) -> bool:
    """Whether a contact is certainly too soft for any n-T orbit at Λ.

    The force carries the weight for n periods, 2πn, in a contact of D ≤ 2πn, so that the largest
    compression y = δ + κδ′ is at least 1/ϖ². As the contact starts at δ = 0, ends at y = 0 and
    |δ″| ≤ ϖ²|y| + 1 + Λ, it is at most q/ϖ² (ϖ²|y| + 1 + Λ), where q = θ (θ + 2ζ) with θ = 2πnϖ.
    There is no orbit if q (2 + Λ) < 1; the displacement release needs a larger q.
    """
    angle = 2 * np.pi * n * float(contact.frequency_ratio)
    softness = angle * (angle + 2 * float(contact.damping_ratio))
    return softness * (2 + amplitude) < 1


def _fine_grid(curve: _Curves, damped_frequency: float) -> np.ndarray:
    """Values of ε of one contact in small steps, with those of the scan."""
    low, high = (float(end[0]) for end in range_of_excess(curve.contact, curve.n))
    step = _FINE * min(1.0, damped_frequency)
    fine = np.arange(low, min(high, low + _MOST * step), step)
    coarse = scan(curve.contact, curve.n)[:, 0]
    return np.unique(np.concatenate([fine, coarse[coarse <= fine[-1] + step]]))


def _all_roots(curve: _Curves, function: Callable, grid: np.ndarray, *more: float) -> np.ndarray:
    """The roots of a function of points of one branch between neighbouring points of the grid."""
    values = function(curve.point(grid), *more)
    at = np.flatnonzero((values[:-1] < 0) != (values[1:] < 0))
    # The same contact for each root, with a grid of two points.
    contact = np.zeros_like(at)
    brackets = np.stack([grid[at], grid[at + 1]])
    numbers = (np.full(at.shape, x) for x in more)
    found = np.ones(at.shape, dtype=bool)
    return curve.take(contact).root(function, brackets, contact, found, *numbers)
