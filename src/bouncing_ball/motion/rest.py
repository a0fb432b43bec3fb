r"""When a ball that stays on the table leaves it: where the table recedes with more than gravity.

It is at rest on the table while g = 1 - Λ sin τ > 0. It leaves at Λ sin τ = 1 on the way
up, or at once where g ≤ 0 already, and never if Λ ≤ 1.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.motion.angles import reduce_angle, table


class LiftOff(NamedTuple):
    """The time until a ball leaves, the table's phase then with Λ cos and Λ sin of it, and
    a time of flight by which the ball has not landed."""

    wait: np.ndarray
    phase: np.ndarray
    x: np.ndarray
    y: np.ndarray
    flown: np.ndarray


def lift_off_phase(amplitude: ArrayLike) -> np.ndarray:
    """Phase arcsin(1/Λ) at which a ball at rest leaves the table; NaN for Λ ≤ 1.

    Examples
    --------
    >>> bool(np.isclose(lift_off_phase(2.0), np.pi / 6))
    True
    """
    lam = np.asarray(amplitude, dtype=float)
    return np.where(lam > 1, np.arcsin(1 / np.maximum(lam, 1.0)), np.nan)


def pressed(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Whether a ball at rest stays, where Λ cos τ = x and Λ sin τ = y."""
    return (y < 1) | ((y == 1) & (x <= 0))


def lift_off(phase: np.ndarray, amplitude: np.ndarray) -> LiftOff:
    """How a ball leaves that lies on the table at a phase, for Λ > 1.

    From rest at Λ sin τ = y ≥ 1 with x = Λ cos τ, ``δ ≥ (y - 1) s²/2 + x s³/6 - Λ s⁴/24``.

    Examples
    --------
    >>> leaving = lift_off(np.array(0.0), np.array(2.0))
    >>> bool(np.isclose(leaving.wait, np.pi / 6)), float(leaving.y)
    (True, 1.0)
    """
    x, y = table(phase, amplitude)
    stays = pressed(x, y)
    top = np.maximum(amplitude, 1.0)
    lift = np.arcsin(1 / top)
    wait = np.where(stays, np.mod(reduce_angle(lift - phase), 2 * np.pi), 0.0)
    # Rounding must not turn a lift-off that is due now into one a turn later.
    wait = np.where(wait > 2 * np.pi - 1e-9, 0.0, wait)
    # At lift-off Λ sin τ = 1 exactly.
    away = np.sqrt((top - 1) * (top + 1))
    x, y = np.where(stays, away, x), np.where(stays, 1.0, y)
    excess = y - 1
    steep = np.minimum(excess / np.maximum(np.abs(x), 1e-300), np.sqrt(3 * excess / top))
    return LiftOff(wait, np.where(stays, lift, phase), x, y, np.maximum(steep, 4 * x / top))
