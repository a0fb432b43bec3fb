"""Saddle-node, period doubling and orbits at a given Λ, on the explicit branch.

Scalar root finding along the branch of :mod:`bouncing_ball.orbits.spring_damper_branch`,
for arrays of contacts at once: a scan brackets the first root next to the
fold, Chandrupatla's method (:func:`scipy.optimize.elementwise.find_root`)
closes the bracket to the last digit.

The branch comes from Λ → ∞ at short contacts, where Λ falls with the contact
duration until the saddle-node: that is the side which is stable next to the
fold. Entries for which the quantity does not exist are NaN.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.motion.ensembles import blocks
from bouncing_ball.orbits.orbit import check_index
from bouncing_ball.orbits.spring_damper_branch import BranchPoint, branch_point
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit
from bouncing_ball.orbits.stability import Bifurcation, Side

# Points of the scan on each side of ε = 0, spaced geometrically from a small
# part of 1/ϖ, the scale of the fold, to the ends of the admissible range.
_SCAN = 60
_SCAN_START = 1e-3
# The scan's ends: contacts of a thousandth of the free one, at which Λ exceeds
# 10⁶, and contacts that fill the cycle but for a millionth.
_SHORTEST = 1e-3
_FULL = 1e-6
# Contacts searched at once: as many as keep a scan in some ten megabytes.
_BLOCK = 1024
# Steps of the search for all orbits, in radians of the contact's oscillation and
# of the table's, which Λ(ε) follows; and how many are taken at most.
_FINE = 0.02
_MOST = 200_000


def _fold(point: BranchPoint) -> np.ndarray:
    return point.fold


def _surplus(point: BranchPoint, amplitude: np.ndarray) -> np.ndarray:
    return point.amplitude - amplitude


class _Curves(NamedTuple):
    """Branches along ε, of contacts and families in a row."""

    release: Release
    omega: np.ndarray
    zeta: np.ndarray
    n: np.ndarray

    def point(self, excess: np.ndarray) -> BranchPoint:
        return branch_point(excess, SpringDamper(self.omega, self.zeta, self.release), self.n)

    def ends(self) -> tuple[np.ndarray, np.ndarray]:
        """ε at short contacts, where Λ is beyond any use, and at D → 2πn."""
        contact = SpringDamper(self.omega, self.zeta, self.release)
        start = contact.free_angle
        high = contact.damped_frequency * 2 * np.pi * self.n * (1 - _FULL) - start
        return np.minimum(-start * (1 - _SHORTEST), high), high

    def scan(self) -> np.ndarray:
        """Grid between the ends, geometric on both sides of 0, shape (points, ...)."""
        low, high = self.ends()
        small = np.minimum(_SCAN_START / self.omega, -low / 2)
        steps = np.linspace(0, 1, _SCAN).reshape(-1, 1)
        down = -small * (-low / small) ** steps[::-1]
        up = small * np.maximum(high / small, 1.0) ** steps
        # A contact softer than the cycle is long ends before ε = 0.
        return np.minimum(np.concatenate([down, np.zeros((1, *low.shape)), up]), high)

    def close(self, of: Callable, left, right, found, *more: np.ndarray) -> np.ndarray:
        """Roots of a function of the branch's points in brackets, NaN where there is none."""
        # Imported here: it takes a third of a second, and not every run asks for limits.
        from scipy.optimize.elementwise import find_root

        def function(excess, omega, zeta, n, *more):
            return of(_Curves(self.release, omega, zeta, n).point(excess), *more)

        result = np.full(found.shape, np.nan)
        if np.any(found):
            args = tuple(x[found] for x in (self.omega, self.zeta, self.n, *more))
            # The default tolerance is four units in the last place of the root.
            result[found] = find_root(function, (left[found], right[found]), args=args).x
        return result

    def zero(
        self, test: Callable, grid: np.ndarray, points: BranchPoint, *, last: bool = False
    ) -> np.ndarray:
        """First, or last, zero of a test function along a grid; NaN where there is none.

        A test function would change sign at a pole as well. Closed upon, its value
        is then larger than at both ends of the bracket, and at a zero smaller: no
        tolerance decides that it is one.
        """
        values = test(points)
        index, found = _bracket(values, last=last)
        root = self.close(test, _at(grid, index), _at(grid, index + 1), found)
        size = np.abs(values)
        smallest = np.minimum(_at(size, index), _at(size, index + 1))
        return np.where(np.abs(test(self.point(root))) <= smallest, root, np.nan)

    def fold(self, grid: np.ndarray, points: BranchPoint) -> np.ndarray:
        """ε of the saddle-node, the first among the points of the scan's grid."""
        return self.zero(lambda point: point.saddle_node, grid, points)


def _bracket(values, *, last=False):
    """Index of the first, or last, sign change along the first axis, and whether
    there is one. Not-a-number has no sign."""
    left, right = values[:-1], values[1:]
    change = ((left < 0) & (right >= 0)) | ((left >= 0) & (right < 0))
    found = np.any(change, axis=0)
    at = np.argmax(change[::-1] if last else change, axis=0)
    return (len(change) - 1 - at if last else at), found


def _at(grid, index):
    return np.take_along_axis(grid, index[np.newaxis], axis=0)[0]


def _searched(search: Callable, contact: SpringDamper, n: ArrayLike, *more: ArrayLike):
    """A search for many contacts, few at a time: the scan of each has 121 points."""
    check_index(n)
    arrays = (contact.frequency_ratio, contact.damping_ratio, n, *more)
    columns = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in arrays))
    omega, zeta, n, *rest = (np.ravel(column) for column in columns)
    found = np.empty(omega.size)
    for part in blocks(found.size, _BLOCK):
        curves = _Curves(contact.release, omega[part], zeta[part], n[part])
        found[part] = search(curves, *(column[part] for column in rest))
    return found.reshape(columns[0].shape)


def saddle_node(contact: SpringDamper, n: ArrayLike) -> np.ndarray:
    """Excess angle ε of the saddle-node, the first zero of 1 - tr + det.

    dΛ/dε vanishes there too, but also where the ball grazes, and changes sign at
    the poles of the branch, where Λ is infinite; neither is a bifurcation.

    Returns
    -------
    numpy.ndarray
        To be given to :func:`~bouncing_ball.orbits.spring_damper_branch.branch_point`.
        NaN where the branch has no fold.

    Examples
    --------
    >>> contact = SpringDamper(1e4, 0.05)
    >>> bool(abs(branch_point(saddle_node(contact, 1), contact, 1).phase) < 1e-3)
    True
    """
    return _searched(_saddle_node, contact, n)


def _saddle_node(curves: _Curves) -> np.ndarray:
    grid = curves.scan()
    return curves.fold(grid, curves.point(grid))


def period_doubling(contact: SpringDamper, n: ArrayLike) -> np.ndarray:
    """Excess angle ε of the period doubling nearest to the saddle-node.

    NaN where the stable side has none.
    """
    return _searched(_period_doubling, contact, n)


def _period_doubling(curves: _Curves) -> np.ndarray:
    grid, fold = curves.scan(), _saddle_node(curves)
    # The part of the scan on the stable side; its points beyond collapse there.
    grid = np.minimum(grid, np.where(np.isnan(fold), grid[-1], fold))

    def test(point: BranchPoint) -> np.ndarray:
        return Bifurcation.PERIOD_DOUBLING.test(point.trace, point.determinant)

    return curves.zero(test, grid, curves.point(grid), last=True)


def _stable_side(curves: _Curves, lam: np.ndarray) -> np.ndarray:
    """ε of the orbit at Λ between short contacts and the saddle-node.

    One scan brackets both: Λ falls along it.
    """
    grid = curves.scan()
    points = curves.point(grid)
    fold = curves.fold(grid, points)
    # Without a fold Λ falls all the way, and the whole branch is this side.
    end = np.where(np.isnan(fold), grid[-1], fold)
    lowest = curves.point(end).amplitude
    at, found = _bracket(lam - np.where(grid < end, points.amplitude, lowest))
    left, right = (np.minimum(_at(grid, k), end) for k in (at, at + 1))
    return curves.close(_surplus, left, right, found, lam)


def _unstable_side(curves: _Curves, lam: np.ndarray) -> np.ndarray:
    """ε of the orbit at Λ beyond the saddle-node that is nearest to it."""
    fold, (_, high) = _saddle_node(curves), curves.ends()
    scale = _SCAN_START / curves.omega
    steps = np.linspace(0, 1, _SCAN).reshape(-1, 1)
    outward = fold + scale * np.maximum((high - fold) / scale, 1.0) ** steps
    grid = np.minimum(np.concatenate([fold[np.newaxis], outward]), high)
    # The next turn of Λ is a point of the grid, so that no orbit next to it
    # is missed between two points.
    turn, turns = _bracket(curves.point(grid[1:]).fold)
    summit = curves.close(_fold, _at(grid[1:], turn), _at(grid[1:], turn + 1), turns)
    grid = np.sort(np.concatenate([grid, np.where(turns, summit, high)[np.newaxis]]), axis=0)
    index, found = _bracket(_surplus(curves.point(grid), lam))
    return curves.close(_surplus, _at(grid, index), _at(grid, index + 1), found, lam)


def orbit_at(
    contact: SpringDamper, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE
) -> SpringDamperOrbit:
    """The n-T orbits at given Λ; NaN entries where there is none.

    Parameters
    ----------
    contact : SpringDamper
        ϖ and ζ, scalars or arrays, and the release rule.
    n, amplitude : array_like
        Index of the family and Λ.
    side : Side
        Side of the saddle-node. Where the unstable side turns again, as it
        does for soft contacts, the orbit nearest to the saddle-node is meant;
        there may be others with longer contacts.

    Examples
    --------
    >>> orbit = orbit_at(SpringDamper(1e4, 0.0517), 1, 1.0)
    >>> abs(round(float(orbit.bounce_velocity) / np.pi, 3))
    1.0
    """
    search = _stable_side if side is Side.STABLE else _unstable_side
    return SpringDamperOrbit.on_branch(_searched(search, contact, n, amplitude), contact, n)


def orbits_at(contact: SpringDamper, n: int, amplitude: float) -> SpringDamperOrbit:
    """All n-T orbits of one contact at one Λ, in order of contact duration.

    Every root of Λ(ε) = Λ at which the ball comes in and leaves. The turns of Λ
    between the points of a fine grid are found first, so that two orbits next
    to a turn are not missed. For ϖ above some 10³ the search does not reach
    contacts longer than 2·10⁵ steps.

    Examples
    --------
    >>> orbits = orbits_at(SpringDamper(2.0, 0.05), 1, 0.9)
    >>> orbits.contact_duration.round(3).tolist(), orbits.is_stable().tolist()
    ([1.601, 2.249, 5.193], [True, False, True])
    """
    check_index(n)
    omega, zeta = float(contact.frequency_ratio), float(contact.damping_ratio)
    one = _Curves(contact.release, *(np.array([x]) for x in (omega, zeta, float(n))))
    low, high = (float(x[0]) for x in one.ends())
    step = _FINE * min(1.0, float(contact.damped_frequency))
    fine = np.arange(low, min(high, low + _MOST * step), step)
    scan = one.scan()[:, 0]
    grid = np.unique(np.concatenate([fine, scan[scan <= fine[-1] + step]]))

    def roots(of: Callable, grid: np.ndarray, *more: float) -> np.ndarray:
        values = of(one.point(grid), *more)
        at = np.nonzero((values[:-1] < 0) != (values[1:] < 0))[0]
        every = (np.full(at.shape, x) for x in (omega, zeta, float(n)))
        rest = (np.full(at.shape, x) for x in more)
        curves, found = _Curves(contact.release, *every), np.full(at.shape, True)
        return curves.close(of, grid[at], grid[at + 1], found, *rest)

    grid = np.sort(np.concatenate([grid, roots(_fold, grid)]))
    found = SpringDamperOrbit.on_branch(roots(_surplus, grid, amplitude), contact, n)
    # A sign change at a pole of the branch is not a root.
    real = np.abs(found.amplitude - amplitude) <= 1e-6 * amplitude
    return found[real & (found.relative_impact_velocity < 0) & (found.relative_bounce_velocity > 0)]
