r"""n-T orbits of the corrected restitution model, in closed form.

Impacts are instants at the phase ψ. They are the time 2πn apart and at equal heights,
so that the ball has the velocities ∓nπ there, as in the restitution model. With
X = Λ cos ψ, Y = Λ sin ψ, the speed v = nπ + X and the load a = 1 - Y, the
impact ``nπ - X = r v + σ a`` is a straight line in the plane of (X, Y)::

    (1 + r) X - σ Y = nπ (1 - r) - σ
    R Λ cos(ψ + χ) = nπ (1 - r) - σ,      R = √((1 + r)² + σ²),  tan χ = σ/(1 + r)

which is Eq. 6 for σ = 0. Λ is smallest at the saddle-node, ψ = -χ. The contact
starts at φ = ψ - t_c and lasts for the time D, and ::

    z′_i = -(nπ - t_c),   z′_b = nπ - (D - t_c),   max z = Y - v t_c + (nπ)²/2

Let ``W = -(1 + r) Y - σX`` be the derivative of the velocity after the impact with
respect to the phase ψ, and ``u = v - a t_c`` the speed at the start of contact.
Linearising one cycle at the instants gives ::

    tr  = 1 - r + [(2πn - t_c)(W + r) - t_c]/u
    det = -r + [(2πn - t_c) r - t_c - t_c W]/u

Therefore ``1 - tr + det = -2πn W/u`` vanishes at the saddle-node, and
``1 + tr + det = 0`` is a second straight line, which meets the first at the
period doubling::

    (nπ - t_c) [(1 + r) Y + σX] - (1 - r)(X + t_c Y) = nπ (1 + r) - 2t_c

If the signature depends on the speed, the curve ``nπ - X = r(v) v + σ(v) a`` takes the place
of the line, and its tangent at each point has the same form
(:meth:`~bouncing_ball_beyond.models.instant.Instant.tangent`) with b in place of r and e
in place of t_c. The linearised cycle is that of the tangent, and trace and
determinant are as above. Points of the curve have no closed form. Searches for orbits, of this
model and of any other, start from the line for the signature at the restitution model's speed.

All quantities are dimensionless; all functions broadcast.
"""

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.models.instant import Instant


def _level(n: ArrayLike, instant: Instant) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The right side nπ(1 - r) - σ of the line, R and χ."""
    r = np.asarray(instant.restitution)
    load = np.asarray(instant.load)
    side = np.asarray(n) * np.pi * (1 - r) - load
    return side, np.hypot(1 + r, load), np.arctan2(load, 1 + r)


def saddle_node(n: ArrayLike, instant: Instant) -> np.ndarray:
    """Λ at which the n-T orbits appear, (nπ(1 - r) - σ)/R.

    NaN where σ is so large that the line passes on the other side of Λ = 0.

    Examples
    --------
    >>> float(saddle_node(1, Instant(0.0, 1.0, 0.0, 0.0)))
    0.0
    """
    side, radius, _ = _level(n, instant)
    return np.where(side >= 0, side, np.nan) / radius


def saddle_node_phase(instant: Instant) -> np.ndarray:
    """Phase ψ = -χ of the instants at the saddle-node.

    Examples
    --------
    >>> abs(float(saddle_node_phase(Instant(0.0, 1.0, 0.0, 0.0))))
    0.0
    """
    return -np.arctan2(instant.load, 1 + np.asarray(instant.restitution))


def instant_phase(
    n: ArrayLike, instant: Instant, amplitude: ArrayLike, stable_side: bool = True
) -> np.ndarray:
    """Phase ψ of the instants on one side of the saddle-node; NaN if Λ is below the saddle-node.

    Examples
    --------
    >>> float(instant_phase(1, Instant(0.0, 1.0, 0.0, 0.0), 1.0)) == np.pi / 2
    True
    """
    side, radius, turned = _level(n, instant)
    across = radius * np.asarray(amplitude, dtype=float)
    there = across >= np.abs(side)
    lift = np.sqrt(np.where(there, (across - side) * (across + side), np.nan))
    return np.arctan2(lift if stable_side else -lift, side) - turned


def period_doubling(n: ArrayLike, instant: Instant) -> tuple[np.ndarray, np.ndarray]:
    """Λ and ψ of the period doubling; NaN where the stable side has no period doubling.

    Examples
    --------
    >>> amplitude, phase = period_doubling(1, Instant(0.0, 1.0, 0.0, 0.0))
    >>> float(amplitude), float(phase) == np.pi / 2
    (1.0, True)
    """
    delay, r, load = (np.asarray(x, dtype=float) for x in instant[:3])
    half = np.asarray(n) * np.pi
    lever = half - delay
    # The lines a X + b Y = s of the orbits and c X + d Y = t of the period doubling.
    a = 1 + r
    b = -load
    s = half * (1 - r) - load
    c = lever * load - (1 - r)
    d = lever * (1 + r) - (1 - r) * delay
    t = half * (1 + r) - 2 * delay
    determinant = a * d - b * c
    x = (s * d - b * t) / determinant
    y = (a * t - s * c) / determinant
    stable_side = ((1 + r) * y + load * x > 0) & (lever > 0)
    amplitude = np.where(stable_side, np.hypot(x, y), np.nan)
    return amplitude, np.where(stable_side, np.arctan2(y, x), np.nan)
