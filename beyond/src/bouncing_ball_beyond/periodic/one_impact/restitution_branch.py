"""n-T orbits of the restitution-coefficient model, in closed form (Eqs. 6-8).

There is one impact every n table periods. The absolute velocities are ∓nπ before and after it,
and Λ cos φ = nπ (1 - r)/(1 + r). Two maps of the impact are in use. They have the same fixed
points and differ in stability:

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

from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.datasets.arguments import chosen
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.models.damping import check_restitution
from bouncing_ball.periodic.orbit import Side, check_index


class ImpactMap(StrEnum):
    """The map of the impact that determines the stability."""

    EXACT = "exact"
    """Eq. 5, in which the time of flight depends on the table's displacement."""
    HOLMES = "holmes"
    """The high-bounce approximation, to which the printed Eq. 8 belongs."""


def check_family(n: ArrayLike, restitution: ArrayLike) -> None:
    """Raise :class:`ModelError` unless n is a positive integer and 0 < r ≤ 1.

    Examples
    --------
    >>> check_family(1, 1.5)
    Traceback (most recent call last):
    ...
    bouncing_ball.errors.ModelError: restitution coefficient r = 1.5 is not in (0, 1]
    """
    check_index(n)
    check_restitution(restitution)


def saddle_node(n: ArrayLike, restitution: ArrayLike) -> np.ndarray:
    """Λ at which the n-T orbits appear, nπ(1 - r)/(1 + r) (Eq. 7).

    Raises
    ------
    ModelError
        Unless n is a positive integer and 0 < r ≤ 1.

    Examples
    --------
    >>> bool(np.isclose(saddle_node(1, 0.5), np.pi / 3))
    True
    """
    check_family(n, restitution)
    r = np.asarray(restitution, dtype=float)
    return np.asarray(n) * np.pi * (1 - r) / (1 + r)


def rigid_speed(n: ArrayLike, restitution: ArrayLike) -> np.ndarray:
    """Impact speed 2πn/(1 + r) of the restitution model's n-T orbits, at every Λ.

    Examples
    --------
    >>> bool(rigid_speed(2, 1.0) == 2 * np.pi)
    True
    """
    return 2 * np.pi * np.asarray(n) / (1 + np.asarray(restitution, dtype=float))


def period_doubling_lift(
    restitution: ArrayLike, impact_map: ImpactMap = ImpactMap.EXACT
) -> np.ndarray:
    """Λ sin φ at the period doubling: 2(1 + r²)/(1 + r)², or 1 for Holmes' map.

    Raises
    ------
    ModelError
        Unless 0 < r ≤ 1, or if there is no such map.

    Examples
    --------
    >>> float(period_doubling_lift(1.0)), float(period_doubling_lift(0.5, ImpactMap.HOLMES))
    (1.0, 1.0)
    """
    check_family(1, restitution)
    r = np.asarray(restitution, dtype=float)
    if chosen("impact_map", impact_map, list(ImpactMap)) == ImpactMap.HOLMES:
        return np.ones_like(r)
    return 2 * (1 + r * r) / (1 + r) ** 2


def period_doubling(
    n: ArrayLike, restitution: ArrayLike, impact_map: ImpactMap = ImpactMap.EXACT
) -> np.ndarray:
    """Λ of the period doubling; Eq. 8 as printed is that of Holmes' map::

        Λ² = 1 + [nπ (1 - r)/(1 + r)]²                      (8)

    For the exact map the 1 is replaced by [2(1 + r²)/(1 + r)²]².

    Raises
    ------
    ModelError
        Unless n is a positive integer and 0 < r ≤ 1.

    Examples
    --------
    >>> round(float(period_doubling(1, 0.85)), 4)
    1.0383
    >>> round(float(period_doubling(1, 0.85, ImpactMap.HOLMES)), 4)
    1.0319
    """
    return np.hypot(period_doubling_lift(restitution, impact_map), saddle_node(n, restitution))


def phase(
    n: ArrayLike, restitution: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE
) -> np.ndarray:
    """Phase φ of the impact, in [-π/2, π/2], where the velocity v after the impact is nπ.

    An n-T orbit is a fixed point of the map, whose flight lasts for the time 2πn::

        τ₁ = τ₀ + 2πn,    v = -r (v - 2πn) + (1 + r) Λ cos(τ₀ + 2πn)        (6)

    Together with the first line of Eq. 5 the solution is v = nπ and, with φ = τ₀,
    ``cos φ = nπ/Λ (1 - r)/(1 + r)``. The phase is positive on the side that is stable next to the
    saddle-node, and negative on the other side.

    Raises
    ------
    NoOrbitError
        If a value of Λ lies below the saddle-node.

    Examples
    --------
    >>> round(float(phase(1, 1.0, 0.5)) / np.pi, 15)
    0.5
    """
    fold = saddle_node(n, restitution)
    lam = np.asarray(amplitude, dtype=float)
    below = ~(lam >= fold)
    if np.any(below):
        family, at, least = (x[below][0] for x in np.broadcast_arrays(n, lam, fold))
        raise NoOrbitError(
            f"no {family}-T orbit at Λ = {at:g}: below the saddle-node at Λ = {least:.6g}"
        )
    lift = np.sqrt((lam - fold) * (lam + fold))
    return np.arctan2(lift if Side(side) is Side.STABLE else -lift, fold)


def branch_points(
    n: ArrayLike, restitution: ArrayLike, amplitude_max: float, points: int
) -> tuple[np.ndarray, np.ndarray]:
    """Λ and φ along the branch up to ``amplitude_max``, each of shape (..., points).

    The points run from the unstable side to the stable side at equal steps of Λ sin φ. This
    parameter remains valid for r = 1, where the saddle-node is at Λ = 0.

    Raises
    ------
    NoOrbitError
        If ``amplitude_max`` lies below the saddle-node.

    Examples
    --------
    >>> amplitude, angle = branch_points(1, 0.5, 2.0, 3)
    >>> amplitude.round(4).tolist(), angle.round(4).tolist()
    ([2.0, 1.0472, 2.0], [-1.0197, 0.0, 1.0197])
    """
    end = phase(n, restitution, amplitude_max)
    lift = amplitude_max * np.sin(end)[..., np.newaxis] * np.linspace(-1.0, 1.0, points)
    level = saddle_node(n, restitution)[..., np.newaxis]
    return np.hypot(level, lift), np.arctan2(lift, level)
