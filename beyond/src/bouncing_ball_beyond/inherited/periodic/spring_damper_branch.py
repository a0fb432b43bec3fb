r"""The branch of n-T orbits of the spring-damper model in closed form.

The paper solves its six equations (Eqs. 21-26) by numerical continuation. At
a fixed contact duration τ_b they are *linear* in ::

    X = Λ cos φ,    Y = Λ sin φ,    u = δ′ at impact

Let L = 2πn - τ_b be the flight time, and I, J, Q, P the responses of the contact at the time τ_b
(see :mod:`bouncing_ball_beyond.inherited.models.spring_damper`). The equations are then

* release (Eq. 23): ``δ_b + κ δ′_b = 0`` with ``δ_b = u I + X P + Y Q - J`` and
  ``δ′_b = u I′ + X Q + Y (I - P) - I``;
* velocity (Eqs. 24, 26, 20): ``δ′_b + Λ cos(φ + τ_b) = u + X + L``;
* landing (Eqs. 25, 19): ``-κ δ′_b + Λ sin(φ + τ_b) + (u + X + L) L - L²/2 = Y``.

The solution of this 3×3 system is the orbit. τ_b is therefore a parameter of the entire branch,
saddle-node and period doubling included, with ``Λ = √(X² + Y²)`` and ``φ = atan2(Y, X)``.

For a stiff contact the branch occupies a range of τ_b of order 1/ϖ² around the free half period,
and a double has too few digits of τ_b to distinguish its points. The curve is therefore
parametrised by the *excess angle* ε, ``ϖ_d τ_b = θ₀ + ε``, where θ₀ is the angle at which the free
contact would be released, π - 2α with sin α = κϖ/2. The one sensitive coefficient, that of u in the
release condition, is then proportional to sin ε.

The branch comes from Λ → ∞ at short contacts. From there Λ falls as the contact duration grows,
until the saddle-node: this is the side that is stable next to it. The bifurcations and the orbits
at a given Λ are roots of functions of ε. A scan brackets the first root next to the saddle-node,
and Chandrupatla's method (:func:`scipy.optimize.elementwise.find_root`) reduces the bracket to the
last digit. Λ turns where ::

    ½ d(Λ²)/dτ_b = -(1 - tr + det) u (δ′_b + κ δ″_b)/det A

vanishes, with the matrix A of the three equations: at the saddle-node, and also where the ball
grazes at the impact or at the release, where no multiplier is 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.models.damping import damped_frequency
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper, responses
from bouncing_ball_beyond.inherited.numerics.arrays import blocks
from bouncing_ball_beyond.inherited.numerics.corrector import solve_linear
from bouncing_ball_beyond.inherited.periodic.orbit import (
    Bifurcation,
    Orbit,
    Side,
    check_index,
    trace_and_determinant,
)

# Points of the scan on each side of ε = 0, spaced geometrically from this small part of 1/ϖ, the
# scale of the fold, to the ends of the possible range.
SCAN = 60
SCAN_START = 1e-3
# The scan starts at contacts of a thousandth of the free duration, at which Λ exceeds 10⁶, and ends
# at contacts that fill the cycle except for a millionth of it.
_SHORTEST = 1e-3
_FULL = 1e-6
# Number of contacts searched at the same time, so that a scan takes some ten megabytes.
_BLOCK = 512
# Steps of the search for all orbits, in radians of the contact's oscillation and of the table's,
# because Λ(ε) oscillates with both; and the largest number of steps.
_FINE = 0.02
_MOST = 200_000
# Relative difference of Λ below which a change of sign is no pole of the branch.
_SAME = 1e-6
# Gauss-Newton steps to the nearest point of a branch, and the step of its differences along ε.
_ITERATIONS = 6
_DIFFERENCE = 1e-6


class BranchPoint(NamedTuple):
    """Points of the branch of the spring-damper model: their orbits, and ϖ det A."""

    orbit: Orbit
    determinant: np.ndarray

    def test(self, kind: Bifurcation) -> np.ndarray:
        """The test function of a bifurcation."""
        return kind.test(*trace_and_determinant(self.orbit))

    def slope(self) -> np.ndarray:
        """½ d(Λ²)/dτ_b, which vanishes where Λ turns; its sign changes at the poles as well."""
        orbit = self.orbit
        contact: Any = orbit.model
        closing = orbit.relative_impact_velocity
        start = orbit.phase, closing, orbit.amplitude
        opening = contact.opening_rate(orbit.contact_duration, *start)
        # The determinant has the equation of the release times ϖ.
        determinant = self.determinant / contact.frequency_ratio
        return -self.test(Bifurcation.SADDLE_NODE) * closing * opening / determinant


@np.errstate(divide="ignore", invalid="ignore", over="ignore")  # at a pole Λ is infinite
def branch_point(excess: ArrayLike, contact: SpringDamper, n: ArrayLike) -> BranchPoint:
    """The n-T orbits whose contacts last for the time ``τ_b = (θ₀ + ε)/ϖ_d``.

    Each is the solution of Eqs. 23-26, which at this τ_b are the three linear equations at the
    top of this module.

    Parameters
    ----------
    excess : array_like
        ε, an angle of the contact's damped oscillation in radians.
    contact : SpringDamper
    n : array_like of int
        Index of the family.

    Examples
    --------
    A stiff elastic contact lasts exactly half a free period when the table's acceleration balances
    gravity, Λ sin φ = 1:

    >>> found = branch_point(0.0, SpringDamper(1e6, 0.0), 1).orbit
    >>> bool(abs(found.amplitude * np.sin(found.phase) - 1) < 1e-5)
    True
    """
    eps = np.asarray(excess, dtype=float)
    omega = contact.frequency_ratio
    zeta = contact.damping_ratio
    duration = (contact.free_angle + eps) / contact.damped_frequency
    flight = 2 * np.pi * np.asarray(n) - duration
    # ϖ_d τ_b = θ₀ + ε, where sine and cosine of θ₀ = π - 2α are exact.
    alpha_sine = contact.release.sine(zeta)
    sine = 2 * alpha_sine * np.sqrt((1 - alpha_sine) * (1 + alpha_sine))
    cosine = 2 * alpha_sine * alpha_sine - 1
    swing = sine * np.cos(eps) + cosine * np.sin(eps), cosine * np.cos(eps) - sine * np.sin(eps)
    g, rate, gravity, q, p = responses(duration, omega, zeta, swing)
    # ϖ (I + κ I′), in which the terms of order 1 cancel but for sin ε.
    root = damped_frequency(zeta)
    push = -np.exp(-zeta * omega * duration) / root * np.sin(eps)
    cos_less_one = -2 * np.sin(duration / 2) ** 2
    sin_d = np.sin(duration)
    lag = contact.lag
    # Each row has the coefficients of u, X and Y, and the right side.
    table_rate = g - p
    rows = [
        [push, omega * (p + lag * q), omega * (q + lag * table_rate), omega * (gravity + lag * g)],
        [rate - 1, q + cos_less_one, table_rate - sin_d, g + flight],
        [
            flight - lag * rate,
            flight + sin_d - lag * q,
            cos_less_one - lag * table_rate,
            -flight * flight / 2 - lag * g,
        ],
    ]
    shape = np.broadcast_shapes(eps.shape, contact.shape, np.shape(n))
    system = np.stack([np.stack([np.broadcast_to(x, shape) for x in row], -1) for row in rows], -2)
    matrix = system[..., :3]
    right = system[..., 3]
    solvable = np.isfinite(system).all(axis=(-2, -1))
    matrix = np.where(solvable[..., np.newaxis, np.newaxis], matrix, np.eye(3))
    u, x, y = np.moveaxis(solve_linear(matrix, right), -1, 0)
    amplitude = np.hypot(x, y)
    known = solvable & np.isfinite(amplitude)
    of_orbit = (amplitude, np.arctan2(y, x), duration + 0 * amplitude, u + x)
    numbers = (np.where(known, values, np.nan)[()] for values in of_orbit)
    return BranchPoint(Orbit(contact, n, *numbers), np.linalg.det(matrix)[()])


def excess_angle(contact: SpringDamper, duration: ArrayLike) -> np.ndarray:
    """ε of contacts that last for the time τ_b: the inverse of ``τ_b = (θ₀ + ε)/ϖ_d``.

    Examples
    --------
    >>> contact = SpringDamper(5.0, 0.1)
    >>> found = branch_point(0.25, contact, 1).orbit
    >>> round(float(excess_angle(contact, found.contact_duration)), 12)
    0.25
    """
    return np.asarray(duration) * contact.damped_frequency - contact.free_angle


def nearest_excess(orbit: Orbit) -> np.ndarray:
    """ε of the points of the branch that are nearest to orbits in (Λ cos φ, Λ sin φ, ε).

    Comparing orbits at equal Λ would divide by zero at a fold. For a stiff contact τ_b has too few
    digits for a comparison at equal τ_b, because X and Y change rapidly with it. Elsewhere X and Y
    may hardly change along the branch. The nearest point in all three variables is well conditioned
    everywhere.

    Examples
    --------
    >>> contact = SpringDamper(5.0, 0.1)
    >>> round(float(nearest_excess(branch_point(0.25, contact, 1).orbit)), 12)
    0.25
    """
    contact: Any = orbit.model

    def plane(excess: np.ndarray) -> np.ndarray:
        found = branch_point(excess, contact, orbit.n).orbit
        return np.array([np.cos(found.phase), np.sin(found.phase)]) * found.amplitude

    excess = excess_angle(contact, orbit.contact_duration)
    wanted = np.array([np.cos(orbit.phase), np.sin(orbit.phase)]) * orbit.amplitude
    nearest = excess
    step = _DIFFERENCE / contact.frequency_ratio
    for _ in range(_ITERATIONS):
        slope = (plane(nearest + step) - plane(nearest - step)) / (2 * step)
        along = np.sum((wanted - plane(nearest)) * slope, axis=0)
        nearest = nearest + (along + excess - nearest) / (np.sum(slope * slope, axis=0) + 1)
    return nearest


def range_of_excess(contact: Any, n: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """ε of the shortest contacts, at which Λ is larger than needed, and ε for τ_b → 2πn."""
    start = contact.free_angle
    high = contact.damped_frequency * 2 * np.pi * n * (1 - _FULL) - start
    return np.minimum(-start * (1 - _SHORTEST), high), high


def scan(contact: Any, n: np.ndarray) -> np.ndarray:
    """Grids of ε between the ends of its range, geometric on both sides of 0, shape (points, k)."""
    low, high = range_of_excess(contact, n)
    small = np.minimum(SCAN_START / contact.frequency_ratio, -low / 2)
    steps = np.linspace(0, 1, SCAN).reshape(-1, 1)
    down = -small * (-low / small) ** steps[::-1]
    up = small * np.maximum(high / small, 1.0) ** steps
    # The range of a contact whose free duration exceeds the cycle ends before ε = 0.
    return np.minimum(np.concatenate([down, np.zeros((1, *low.shape)), up]), high)


class _Curves(NamedTuple):
    """The branches of a row of contacts and families, as functions of ε."""

    contact: SpringDamper
    n: np.ndarray

    def take(self, which: Any) -> _Curves:
        return _Curves(self.contact[which], self.n[which])

    def point(self, excess: np.ndarray) -> BranchPoint:
        return branch_point(excess, self.contact, self.n)

    def root(
        self,
        function: Callable[..., np.ndarray],
        grid: np.ndarray,
        values: np.ndarray,
        *more: np.ndarray,
    ) -> np.ndarray:
        """The first zero of a function of points of the branch with known values along a grid, NaN
        if there is none. ``more`` are further arguments of the function.

        A function also changes its sign at a pole. As the bracket shrinks onto a pole, the value in
        it grows beyond the values at both ends, whereas it becomes smaller at a zero. The two are
        therefore distinguished without a tolerance.
        """
        # This module of scipy is not loaded on first use, and its import takes a third of a second.
        from scipy.optimize.elementwise import find_root

        interval, found = first_change(values)
        root = np.full(interval.shape, np.nan)
        which = np.flatnonzero(found)
        if not which.size:
            return root
        left = interval[which]
        ends = values[left, which], values[left + 1, which]

        def at(excess: np.ndarray, number: np.ndarray, *others: np.ndarray) -> np.ndarray:
            return function(self.take(number).point(excess), *others)

        others = tuple(x[which] for x in more)
        # The default tolerance is four units in the last place of the root.
        bracket = grid[left, which], grid[left + 1, which]
        root[which] = find_root(at, bracket, args=(which, *others)).x
        there = at(root[which], which, *others)
        pole = ~(np.abs(there) <= np.minimum(*np.abs(ends)))
        root[which[pole]] = np.nan
        return root

    def saddle_node(self) -> np.ndarray:
        """ε of the saddle-node, the first zero of 1 - tr + det.

        dΛ/dε also vanishes at the saddle-node. It is not the test function because it vanishes
        where the ball grazes as well, and changes sign at the poles of the branch, where Λ is
        infinite; neither is a bifurcation.
        """
        grid = scan(self.contact, self.n)
        return self.root(_saddle, grid, _saddle(self.point(grid)))

    def stable_side(
        self, function: Callable[..., np.ndarray], *more: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """The grid of the scan up to the saddle-node, and the values of a function on it.

        Grid points beyond the end are replaced by the end. Without a saddle-node Λ falls along the
        whole branch, and the whole branch is the stable side.
        """
        grid = scan(self.contact, self.n)
        fold = self.saddle_node()
        grid = np.minimum(grid, np.where(np.isnan(fold), grid[-1], fold))
        return grid, function(self.point(grid), *more)

    def period_doubling(self) -> np.ndarray:
        """ε of the period doubling that is nearest to the saddle-node on the stable side."""
        grid, values = self.stable_side(_doubling)
        return self.root(_doubling, grid[::-1], values[::-1])

    def stable(self, amplitude: np.ndarray) -> np.ndarray:
        """ε of the orbit at Λ between short contacts and the saddle-node, where Λ falls with ε."""
        grid, values = self.stable_side(_deficit, amplitude)
        return self.root(_deficit, grid, values, amplitude)

    def unstable(self, amplitude: np.ndarray) -> np.ndarray:
        """ε of the orbit at Λ that is nearest to the saddle-node on its unstable side."""
        fold = self.saddle_node()
        _, high = range_of_excess(self.contact, self.n)
        scale = SCAN_START / self.contact.frequency_ratio
        steps = np.linspace(0, 1, SCAN).reshape(-1, 1)
        outward = fold + scale * np.maximum((high - fold) / scale, 1.0) ** steps
        grid = np.minimum(np.concatenate([fold[np.newaxis], outward]), high)
        # The next turning point of Λ is added to the grid, so that an orbit next to it is not
        # missed between two points.
        summit = self.root(BranchPoint.slope, grid[1:], self.point(grid[1:]).slope())
        grid = np.concatenate([grid, np.where(np.isnan(summit), high, summit)[np.newaxis]])
        grid = np.sort(grid, axis=0)
        return self.root(_deficit, grid, _deficit(self.point(grid), amplitude), amplitude)


def _saddle(point: BranchPoint) -> np.ndarray:
    return point.test(Bifurcation.SADDLE_NODE)


def _doubling(point: BranchPoint) -> np.ndarray:
    return point.test(Bifurcation.PERIOD_DOUBLING)


def _deficit(point: BranchPoint, amplitude: np.ndarray) -> np.ndarray:
    return amplitude - point.orbit.amplitude


def first_change(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Index of the first sign change along the first axis, and whether there is one.

    A change next to NaN does not count.
    """
    left = values[:-1]
    right = values[1:]
    change = ((left < 0) & (right >= 0)) | ((left >= 0) & (right < 0))
    return np.argmax(change, axis=0), np.any(change, axis=0)


@dataclass(frozen=True)
class SpringDamperBranch:
    """The branch of the spring-damper model, by the excess angle ε of the contact."""

    model: SpringDamper

    def _searched(
        self, search: Callable[..., np.ndarray], n: ArrayLike, *more: ArrayLike
    ) -> np.ndarray:
        """ε by a search among many contacts, in blocks, because each scan has 121 points."""
        check_index(n)
        contact = self.model
        columns = np.broadcast_arrays(contact.frequency_ratio, contact.damping_ratio, n, *more)
        omega, zeta, family, *rest = (np.ravel(column).astype(float) for column in columns)
        curves = _Curves(SpringDamper(omega, zeta, contact.release), family)
        found = np.empty(omega.size)
        with np.errstate(all="ignore"):
            for part in blocks(found.size, _BLOCK):
                found[part] = search(curves.take(part), *(column[part] for column in rest))
        return found.reshape(columns[0].shape)

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: str = Side.STABLE) -> Orbit:
        """The orbits at given Λ on one side of the saddle-node.

        Where the unstable side turns again, as it does for compliant contacts, it is the orbit
        nearest to the saddle-node; there may be others with longer contacts.

        Examples
        --------
        >>> found = SpringDamperBranch(SpringDamper(1e4, 0.0517)).orbit(1, 1.0)
        >>> abs(round(float(found.bounce_velocity) / np.pi, 3))
        1.0
        """
        search = _Curves.stable if Side(side) is Side.STABLE else _Curves.unstable
        return branch_point(self._searched(search, n, amplitude), self.model, n).orbit

    def bifurcation(self, kind: Bifurcation, n: ArrayLike) -> Orbit:
        """The orbits at a bifurcation: Eqs. 23-26 with a multiplier at 1 or at -1.

        Examples
        --------
        For a stiff elastic contact, the period doubling is at Λ = 1, as in the restitution model:

        >>> branch = SpringDamperBranch(SpringDamper(1e6, 0.0))
        >>> doubling = branch.bifurcation(Bifurcation.PERIOD_DOUBLING, 1)
        >>> bool(abs(doubling.amplitude - 1) < 1e-5)
        True
        """
        fold = kind is Bifurcation.SADDLE_NODE
        search = _Curves.saddle_node if fold else _Curves.period_doubling
        return branch_point(self._searched(search, n), self.model, n).orbit

    @np.errstate(all="ignore")
    def orbits(self, n: int, amplitude: float) -> Orbit:
        """All orbits of one contact at one Λ, in order of contact duration, as a row.

        These are the points of the branch with the given Λ at which the ball approaches the table
        at impact and leaves it at release; they need not be admissible. The turning points of Λ are
        added to a fine grid first, so that two orbits next to one of them are not missed. The grid
        starts at contacts of a thousandth of the free duration, at which Λ exceeds 10⁶; if n
        periods are shorter than this, no orbit is found. It ends after 2·10⁵ steps of 0.02 radians
        of ϖ_d τ_b, so that for nϖ above about 600 the longest contacts are not searched.

        Examples
        --------
        >>> found = SpringDamperBranch(SpringDamper(2.0, 0.05)).orbits(1, 0.9)
        >>> found.contact_duration.round(3).tolist(), found.stable.tolist()
        ([1.601, 2.249, 5.193], [True, False, True])
        """
        check_index(n)
        contact = self.model
        omega = np.array([contact.frequency_ratio])
        curve = _Curves(SpringDamper(omega, contact.damping_ratio, contact.release), np.array([n]))
        low, high = (float(end[0]) for end in range_of_excess(curve.contact, curve.n))
        step = _FINE * min(1.0, contact.damped_frequency)
        if low >= high:
            return branch_point(np.empty(0), contact, n).orbit
        fine = np.arange(low, min(high, low + _MOST * step), step)
        coarse = scan(curve.contact, curve.n)[:, 0]
        grid = np.unique(np.concatenate([fine, coarse[coarse <= fine[-1] + step]]))
        turns = _all_roots(contact, n, BranchPoint.slope, grid)
        grid = np.sort(np.concatenate([grid, turns[np.isfinite(turns)]]))
        found = _all_roots(contact, n, _deficit, grid, amplitude)
        orbits = branch_point(found, contact, n).orbit
        same = np.abs(orbits.amplitude - amplitude) <= _SAME * amplitude
        approaches = orbits.relative_impact_velocity < 0
        return orbits[same & approaches & (orbits.relative_bounce_velocity > 0)]


def _all_roots(
    contact: SpringDamper,
    n: int,
    function: Callable[..., np.ndarray],
    grid: np.ndarray,
    *more: float,
) -> np.ndarray:
    """The zeros of a function of points of one branch between neighbouring points of a grid, with
    NaN for the poles.
    """
    values = function(branch_point(grid, contact, n), *more)
    at = np.flatnonzero((values[:-1] < 0) != (values[1:] < 0))
    # The same contact for each root, with a grid of two points.
    omega = np.full(at.size, contact.frequency_ratio)
    row = SpringDamper(omega, contact.damping_ratio, contact.release)
    ends = np.stack([at, at + 1])
    numbers = (np.full(at.size, x) for x in more)
    return _Curves(row, np.full(at.size, n)).root(function, grid[ends], values[ends], *numbers)
