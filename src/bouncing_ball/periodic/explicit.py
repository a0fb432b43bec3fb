r"""The branch of n-T orbits in closed form, for both models.

*Restitution model* (Eqs. 6-8). An n-T orbit is a fixed point of the map of Eq. 5 whose flight lasts
for the time 2πn::

    τ₁ = τ₀ + 2πn,    v = -r (v - 2πn) + (1 + r) Λ cos(τ₀ + 2πn)        (6)

Together with the first line of Eq. 5 the solution is v = nπ and ``Λ cos φ = nπ (1 - r)/(1 + r)``.
Two maps of the impact are in use. They have the same fixed points and differ in stability:

===============  =============================  ========
map              trace                          det
===============  =============================  ========
exact (Eq. 5)    1 + r² - (1 + r)² Λ sin φ      r²
Holmes'          1 + r - 2 (1 + r) Λ sin φ      r
===============  =============================  ========

The period doublings are therefore at Λ sin φ = 2(1 + r²)/(1 + r)² for the exact map and at
Λ sin φ = 1 for Holmes' map. Eq. 8 of the paper is that of Holmes' map, although its Eq. 5 is the
exact map.

*Spring-damper model*. The paper solves its six equations (Eqs. 21-26) by numerical continuation. At
a fixed contact duration D they are *linear* in ::

    X = Λ cos φ,    Y = Λ sin φ,    u = δ′ at impact

Let T = 2πn - D be the flight time, and g, G, Q, P the responses of the contact at the time D (see
:mod:`bouncing_ball.models.spring_damper`). The equations are then

* release (Eq. 23): ``δ_b + κ δ′_b = 0`` with ``δ_b = u g + X P + Y Q - G`` and
  ``δ′_b = u g′ + X Q + Y (g - P) - g``;
* velocity (Eqs. 24, 26, 20): ``δ′_b + Λ cos(φ + D) = u + X + T``;
* landing (Eqs. 25, 19): ``-κ δ′_b + Λ sin(φ + D) + (u + X + T) T - T²/2 = Y``.

The solution of this 3×3 system is the orbit. D is therefore a parameter of the entire branch,
saddle-node and period doubling included, with ``Λ = √(X² + Y²)`` and ``φ = atan2(Y, X)``.

For a stiff contact the branch occupies a range of D of order 1/ϖ² around the free half period, and
a double has too few digits of D to distinguish its points. The curve is therefore parametrised by
the *excess angle* ε, ``ϖ_d D = θ₀ + ε``, where θ₀ is the angle at which the free contact would be
released, π - 2α with sin α = κϖ/2. The one sensitive coefficient, that of u in the release
condition, is then proportional to sin ε.

The branch comes from Λ → ∞ at short contacts. From there Λ falls as the contact duration grows,
until the saddle-node: this is the side that is stable next to it. The bifurcations and the orbits
at a given Λ are roots of functions of ε. A scan brackets the first root next to the saddle-node,
and Chandrupatla's method (:func:`scipy.optimize.elementwise.find_root`) reduces the bracket to the
last digit. Λ turns where ::

    ½ d(Λ²)/dD = -(1 - tr + det) u (δ′_b + κ δ″_b)/det A

vanishes, with the matrix A of the three equations: at the saddle-node, and also where the ball
grazes at the impact or at the release, where no multiplier is 1.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.datasets.arguments import chosen
from bouncing_ball.errors import RIGID_RESTITUTION, NoOrbitError
from bouncing_ball.models.damping import check_restitution, damped_frequency
from bouncing_ball.models.model import Model
from bouncing_ball.models.restitution import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper, responses
from bouncing_ball.numerics.arrays import blocks
from bouncing_ball.numerics.corrector import solve_linear
from bouncing_ball.periodic.orbit import (
    Bifurcation,
    Orbit,
    Side,
    check_index,
    flight_margin,
    trace_and_determinant,
)

# The restitution model.

# Each round of so many samples divides the bracket of a grazing orbit; the last one is a rounding.
_GRAZING_SAMPLES = 401
_GRAZING_ROUNDS = 7


class ImpactMap(StrEnum):
    """The map of the restitution model's impact that determines the stability."""

    EXACT = "exact"
    """Eq. 5, in which the time of flight depends on the table's displacement."""
    HOLMES = "holmes"
    """The high-bounce approximation, to which the printed Eq. 8 belongs."""


def restitution_saddle_node(n: ArrayLike, restitution: ArrayLike) -> np.ndarray:
    """Λ at which the n-T orbits appear, nπ(1 - r)/(1 + r) (Eq. 7).

    Raises
    ------
    ModelError
        Unless n is a positive integer and 0 ≤ r ≤ 1.

    Examples
    --------
    >>> bool(np.isclose(restitution_saddle_node(1, 0.5), np.pi / 3))
    True
    """
    check_index(n)
    r = check_restitution(restitution, RIGID_RESTITUTION)
    return np.asarray(n) * np.pi * (1 - r) / (1 + r)


def period_doubling_lift(
    restitution: ArrayLike, impact_map: ImpactMap = ImpactMap.EXACT
) -> np.ndarray:
    """Λ sin φ at the period doubling: 2(1 + r²)/(1 + r)², or 1 for Holmes' map.

    Raises
    ------
    ModelError
        Unless 0 ≤ r ≤ 1, or if there is no such map.

    Examples
    --------
    >>> float(period_doubling_lift(1.0)), float(period_doubling_lift(0.5, ImpactMap.HOLMES))
    (1.0, 1.0)
    """
    r = check_restitution(restitution, RIGID_RESTITUTION)
    if chosen("impact_map", impact_map, list(ImpactMap)) == ImpactMap.HOLMES:
        return np.ones_like(r)
    return 2 * (1 + r * r) / (1 + r) ** 2


def restitution_period_doubling(
    n: ArrayLike, restitution: ArrayLike, impact_map: ImpactMap = ImpactMap.EXACT
) -> np.ndarray:
    """Λ of the period doubling; Eq. 8 as printed is that of Holmes' map::

        Λ² = 1 + [nπ (1 - r)/(1 + r)]²                      (8)

    For the exact map the 1 is replaced by [2(1 + r²)/(1 + r)²]².

    Raises
    ------
    ModelError
        Unless n is a positive integer and 0 ≤ r ≤ 1.

    Examples
    --------
    >>> round(float(restitution_period_doubling(1, 0.85)), 4)
    1.0383
    >>> round(float(restitution_period_doubling(1, 0.85, ImpactMap.HOLMES)), 4)
    1.0319
    """
    level = restitution_saddle_node(n, restitution)
    return np.hypot(period_doubling_lift(restitution, impact_map), level)


class Absence(StrEnum):
    """Why there is no orbit on a side of the branch at some Λ."""

    NONE = "there is one"
    BELOW_SADDLE_NODE = "below the saddle-node"
    NO_OTHER_SIDE = "the branch has no saddle-node and therefore no other side"
    NOT_REACHED = "this side of the branch does not reach this Λ"


class Branch(ABC):
    """The branch of n-T orbits of a model in closed form.

    n and Λ are arrays that broadcast with the model; orbits that do not exist have NaN.
    """

    model: Model

    @abstractmethod
    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: str = Side.STABLE) -> Orbit:
        """The orbits at given Λ, on one side of the saddle-node."""

    @abstractmethod
    def orbits(self, n: int, amplitude: float) -> Orbit:
        """All orbits of a single model at one Λ, in order of contact duration, as a row."""

    @abstractmethod
    def bifurcation(self, kind: Bifurcation, n: ArrayLike) -> Orbit:
        """The orbits at the saddle-node, or at the period doubling that is nearest to it on the
        stable side.
        """

    def absence(self, n: ArrayLike, amplitude: ArrayLike, side: str = Side.STABLE) -> np.ndarray:
        """Why :meth:`orbit` finds no orbit: the text of an :class:`Absence` for each entry."""
        exists = self.orbit(n, amplitude, side).exists
        fold = self.bifurcation(Bifurcation.SADDLE_NODE, n).amplitude
        alone = np.isnan(fold) & (side == Side.UNSTABLE)
        other = np.where(alone, Absence.NO_OTHER_SIDE, Absence.NOT_REACHED)
        why = np.where(np.asarray(amplitude) < fold, Absence.BELOW_SADDLE_NODE, other)
        return np.where(exists, Absence.NONE, why)

    def required(self, n: int, amplitude: float, side: str = Side.STABLE) -> Orbit:
        """The orbit of a single model at Λ on one side of the saddle-node.

        Raises
        ------
        NoOrbitError
            If there is no orbit; the message gives the reason.
        """
        found = self.orbit(n, amplitude, side)
        if not found.exists:
            why = str(self.absence(n, amplitude, side))
            if why == Absence.BELOW_SADDLE_NODE:
                fold = self.bifurcation(Bifurcation.SADDLE_NODE, n).amplitude
                why = f"{why} at Λ = {float(fold):.6g}"
            label = self.model.label
            raise NoOrbitError(f"no {n}-T orbit at Λ = {amplitude:g} for {label}: {why}")
        return found


def explicit_branch(model: Model) -> Branch:
    """The branch of n-T orbits of a model.

    Examples
    --------
    >>> from bouncing_ball import rigid
    >>> found = explicit_branch(rigid(restitution=1.0)).orbit(1, 0.5)
    >>> round(float(found.phase) / np.pi, 15)
    0.5
    """
    if isinstance(model, RestitutionModel):
        return RestitutionBranch(model)
    if isinstance(model, SpringDamper):
        return SpringDamperBranch(model)
    raise TypeError(f"{type(model).__name__} has no branch in closed form")


@dataclass(frozen=True)
class RestitutionBranch(Branch):
    """The branch of the restitution model (Eqs. 6-8)."""

    model: RestitutionModel

    def at(self, n: ArrayLike, lift: ArrayLike) -> Orbit:
        """The orbits with these values of Λ sin φ, where Λ cos φ = nπ(1 - r)/(1 + r)."""
        level = restitution_saddle_node(n, self.model.restitution)
        amplitude = np.hypot(level, lift)[()]
        phase = np.arctan2(lift, level)[()]
        return self._with(n, amplitude, np.where(np.isnan(lift), np.nan, phase)[()])

    def _with(self, n: ArrayLike, amplitude: ArrayLike, phase: ArrayLike) -> Orbit:
        speed = np.where(np.isnan(phase), np.nan, np.asarray(n) * np.pi)[()]
        return Orbit(self.model, np.asarray(n)[()], amplitude, phase, 0 * speed, -speed)

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: str = Side.STABLE) -> Orbit:
        """The orbits of Eq. 6 with the phase in [-π/2, π/2].

        The phase is positive on the side that is stable next to the saddle-node, and negative on
        the other side.

        Examples
        --------
        >>> found = RestitutionBranch(RestitutionModel(0.85)).orbit(1, [0.1, 1.0])
        >>> found.phase.round(4).tolist()
        [nan, 1.3132]
        """
        level = restitution_saddle_node(n, self.model.restitution)
        lam = np.asarray(amplitude, dtype=float)
        sign = 1 if Side(side) is Side.STABLE else -1
        with np.errstate(invalid="ignore"):  # below the saddle-node
            lift = sign * np.sqrt((lam - level) * (lam + level))
        return self._with(n, (lam + 0 * lift)[()], np.arctan2(lift, level)[()])

    def orbits(self, n: int, amplitude: float) -> Orbit:
        sides = [self.orbit(n, amplitude, side) for side in Side]
        both = Orbit(
            self.model,
            n,
            np.full(2, amplitude),
            np.array([each.phase for each in sides]),
            np.zeros(2),
            np.full(2, -n * np.pi),
        )
        # At the saddle-node both are one.
        distinct = both.exists & (both.phase != np.array([np.inf, sides[0].phase]))
        return both[np.flatnonzero(distinct)]

    def bifurcation(self, kind: Bifurcation, n: ArrayLike) -> Orbit:
        lift = 0.0 * np.asarray(self.model.restitution)
        if kind is Bifurcation.PERIOD_DOUBLING:
            lift = period_doubling_lift(self.model.restitution)
        return self.at(n, lift)

    def along(self, n: ArrayLike, amplitude_max: float, points: int) -> Orbit:
        """The orbits up to ``amplitude_max``, of shape (..., points), for a single r.

        They run from the unstable side to the stable side at equal steps of Λ sin φ. This parameter
        remains valid for r = 1, where the saddle-node is at Λ = 0.

        Raises
        ------
        NoOrbitError
            If ``amplitude_max`` lies below a saddle-node.

        Examples
        --------
        >>> found = RestitutionBranch(RestitutionModel(0.5)).along(1, 2.0, 3)
        >>> found.amplitude.round(4).tolist(), found.phase.round(4).tolist()
        ([2.0, 1.0472, 2.0], [-1.0197, 0.0, 1.0197])
        """
        level = restitution_saddle_node(n, self.model.restitution)
        below = ~(amplitude_max >= level)
        if np.any(below):
            family, least = (x[below][0] for x in np.broadcast_arrays(n, level))
            raise NoOrbitError(
                f"no {family}-T orbit up to Λ = {amplitude_max:g}: below the saddle-node at "
                f"Λ = {least:.6g}"
            )
        end = np.sqrt((amplitude_max - level) * (amplitude_max + level))
        column = np.asarray(n)[..., np.newaxis]
        return self.at(column, end[..., np.newaxis] * np.linspace(-1.0, 1.0, points))

    def grazing(self, n: int, amplitude_max: float) -> Orbit:
        """The orbit of a single model on the unstable side that is nearest to the saddle-node among
        those whose flight grazes the table: beyond it there is an earlier impact. NaN if there is
        none up to ``amplitude_max``.

        Examples
        --------
        >>> found = RestitutionBranch(RestitutionModel(0.2)).grazing(1, 4.0)
        >>> float(found.amplitude) < 4, bool(found.admissible)
        (True, True)
        """
        level = restitution_saddle_node(n, self.model.restitution)
        end = np.sqrt(np.maximum((amplitude_max - level) * (amplitude_max + level), 0.0))
        lifts = np.linspace(0.0, -end, _GRAZING_SAMPLES)
        for _ in range(_GRAZING_ROUNDS):
            inside = flight_margin(self.at(np.full(lifts.size, n), lifts)) > 0
            first = int(np.argmin(inside))
            if inside[first] or first == 0:
                return self.at(n, np.nan)
            # Between the last orbit without an earlier impact and the first one with it.
            lifts = np.linspace(lifts[first - 1], lifts[first], _GRAZING_SAMPLES)
        return self.at(n, lifts[0])


# The spring-damper model.

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
        """½ d(Λ²)/dD, which vanishes where Λ turns; its sign changes at the poles as well."""
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
    """The n-T orbits whose contacts last for the time ``D = (θ₀ + ε)/ϖ_d``.

    Each is the solution of Eqs. 23-26, which at this τ_b = D are the three linear equations at the
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
    omega, zeta = contact.frequency_ratio, contact.damping_ratio
    duration = (contact.free_angle + eps) / contact.damped_frequency
    flight = 2 * np.pi * np.asarray(n) - duration
    # ϖ_d D = θ₀ + ε, where sine and cosine of θ₀ = π - 2α are exact.
    alpha_sine = contact.release.sine(zeta)
    sine = 2 * alpha_sine * np.sqrt((1 - alpha_sine) * (1 + alpha_sine))
    cosine = 2 * alpha_sine * alpha_sine - 1
    swing = sine * np.cos(eps) + cosine * np.sin(eps), cosine * np.cos(eps) - sine * np.sin(eps)
    g, rate, gravity, q, p = responses(duration, omega, zeta, swing)
    # ϖ (g + κ g′), in which the terms of order 1 cancel but for sin ε.
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
    matrix, right = system[..., :3], system[..., 3]
    solvable = np.isfinite(system).all(axis=(-2, -1))
    matrix = np.where(solvable[..., np.newaxis, np.newaxis], matrix, np.eye(3))
    u, x, y = np.moveaxis(solve_linear(matrix, right), -1, 0)
    amplitude = np.hypot(x, y)
    known = solvable & np.isfinite(amplitude)
    of_orbit = (amplitude, np.arctan2(y, x), duration + 0 * amplitude, u + x)
    numbers = (np.where(known, values, np.nan)[()] for values in of_orbit)
    return BranchPoint(Orbit(contact, n, *numbers), np.linalg.det(matrix)[()])


def excess_angle(contact: SpringDamper, duration: ArrayLike) -> np.ndarray:
    """ε of contacts that last for the time D: the inverse of ``D = (θ₀ + ε)/ϖ_d``.

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

    Comparing orbits at equal Λ would divide by zero at a fold. For a stiff contact D has too few
    digits for a comparison at equal D, because X and Y change rapidly with D. Elsewhere X and Y may
    hardly change along the branch. The nearest point in all three variables is well conditioned
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
    """ε of the shortest contacts, at which Λ is larger than needed, and ε for D → 2πn."""
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
        fold = self.root(_saddle, grid, _saddle(self.point(grid)))
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
class SpringDamperBranch(Branch):
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
        """The orbits at a bifurcation.

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
        of ϖ_d D, so that for nϖ above about 600 the longest contacts are not searched.

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
