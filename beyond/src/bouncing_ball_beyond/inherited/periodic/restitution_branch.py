r"""The branch of n-T orbits of the restitution model in closed form (Eqs. 6-8).

An n-T orbit is a fixed point of the map of Eq. 5 whose flight lasts
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
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.datasets.arguments import chosen
from bouncing_ball_beyond.inherited.errors import RIGID_RESTITUTION, NoOrbitError
from bouncing_ball_beyond.inherited.models.damping import check_restitution
from bouncing_ball_beyond.inherited.models.restitution import RestitutionModel
from bouncing_ball_beyond.inherited.periodic.orbit import (
    Bifurcation,
    Orbit,
    Side,
    check_index,
    flight_margin,
)

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


@dataclass(frozen=True)
class RestitutionBranch:
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
