r"""Free flight over the vibrating table, and how close the two come.

A time s after take-off at table phase τ, the gap between ball and table is ::

    f(s) = d + v s - s²/2 - Λ [sin(τ + s) - sin τ - s cos τ]

with d the gap and v the velocity relative to the table at take-off. Its
curvature ``f″ = Λ sin(τ + s) - 1`` is known: for Λ ≤ 1 the gap is concave,
and for Λ > 1 it is convex only while sin(τ + s) > 1/Λ, once in every period.
So the gap has at most one interior minimum in every period of the table, and
all of them can be found.

All quantities are dimensionless; all functions broadcast.
"""

import numpy as np
from numpy.typing import ArrayLike

# Bisections of a monotone function on an interval shorter than π: enough to
# reach the spacing of floating-point numbers.
_BISECTIONS = 54


def gap(
    time: ArrayLike,
    phase: ArrayLike,
    gap_start: ArrayLike,
    velocity: ArrayLike,
    amplitude: ArrayLike,
) -> np.ndarray:
    """Gap f(s) between ball and table.

    Parameters
    ----------
    time, phase : array_like
        s and the table's phase τ at take-off.
    gap_start, velocity : array_like
        d and v, relative to the table, at take-off.
    amplitude : array_like
        Λ.

    Examples
    --------
    >>> float(gap(2.0, 0.0, 0.0, 3.0, 0.0))
    4.0
    """
    s, tau = np.asarray(time, dtype=float), np.asarray(phase, dtype=float)
    # sin(τ+s) - sin τ as a product: exact for short flights.
    rise = 2 * np.cos(tau + s / 2) * np.sin(s / 2) - s * np.cos(tau)
    return np.asarray(gap_start) + np.asarray(velocity) * s - s * s / 2 - amplitude * rise


def gap_rate(
    time: ArrayLike, phase: ArrayLike, velocity: ArrayLike, amplitude: ArrayLike
) -> np.ndarray:
    """Rate f′(s) of the gap.

    Examples
    --------
    >>> float(gap_rate(2.0, 0.0, 3.0, 0.0))
    1.0
    """
    s, tau = np.asarray(time, dtype=float), np.asarray(phase, dtype=float)
    swing = -2 * np.sin(tau + s / 2) * np.sin(s / 2)  # cos(τ+s) - cos τ
    return np.asarray(velocity) - s - np.asarray(amplitude) * swing


def clearance(
    flight_time: ArrayLike,
    phase: ArrayLike,
    gap_start: ArrayLike,
    velocity: ArrayLike,
    amplitude: ArrayLike,
) -> np.ndarray:
    """Smallest interior minimum of the gap during a flight, infinite without one.

    Negative where the ball would have met the table before the end of the
    flight. Every interval of convexity is searched, by bisection of the rate,
    which increases there; no minimum can be missed.

    Examples
    --------
    Over a table that accelerates less than gravity the gap has no minimum:

    >>> float(clearance(6.0, 0.0, 0.0, 3.0, 0.9))
    inf
    """
    total, tau, d, v, lam = np.broadcast_arrays(
        *(np.asarray(x, float) for x in (flight_time, phase, gap_start, velocity, amplitude))
    )
    lowest = np.full(total.shape, np.inf)
    steep = lam > 1
    if not np.any(steep & (total > 0)):
        return lowest
    onset = np.arcsin(1 / np.where(steep, lam, 1.0))  # sin = 1/Λ, then convex to π - onset
    first = np.floor((tau - (np.pi - onset)) / (2 * np.pi))
    periods = int(np.nanmax(np.where(np.isfinite(total), total, 0.0)) / (2 * np.pi)) + 2
    for k in range(periods + 1):
        start = onset + 2 * np.pi * (first + k) - tau
        left = np.clip(start, 0.0, total)
        right = np.clip(start + np.pi - 2 * onset, 0.0, total)
        turning = (
            steep
            & (right > left)
            & (gap_rate(left, tau, v, lam) < 0)
            & (gap_rate(right, tau, v, lam) > 0)
        )
        if not np.any(turning):
            continue
        for _ in range(_BISECTIONS):
            middle = (left + right) / 2
            falling = gap_rate(middle, tau, v, lam) < 0
            left, right = np.where(falling, middle, left), np.where(falling, right, middle)
        lowest = np.where(turning, np.minimum(lowest, gap(left, tau, d, v, lam)), lowest)
    return lowest
