"""States from which a simulation may start, the same for every model."""

import numpy as np

from bouncing_ball.errors import ModelError
from bouncing_ball.motion.angles import table

# A ball at rest on the table may come out of rounding as moving by a little.
_ROUNDING = 8 * np.finfo(float).eps


def check_amplitude(amplitude: np.ndarray) -> None:
    """Raise :class:`ModelError` unless Λ is finite and not negative.

    Examples
    --------
    >>> check_amplitude(np.array(-1.0))
    Traceback (most recent call last):
    ...
    bouncing_ball.errors.ModelError: amplitude Λ = -1.0 is not finite and ≥ 0
    """
    if not np.all((amplitude >= 0) & np.isfinite(amplitude)):
        raise ModelError(f"amplitude Λ = {np.asarray(amplitude)} is not finite and ≥ 0")


def check_impact(phase: np.ndarray, velocity: np.ndarray) -> None:
    """Raise :class:`ModelError` unless a state is finite."""
    if not np.all(np.isfinite(phase) & np.isfinite(velocity)):
        raise ModelError("the phase and the velocity of the impact must be finite")


def approach(phase: np.ndarray, velocity: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """δ′ ≤ 0 of balls that come to the table with an absolute velocity.

    Raises
    ------
    ModelError
        If a state is not finite, or if a ball rises from the table.

    Examples
    --------
    >>> approach(np.zeros(1), np.array([-2.0]), np.array(1.0)).tolist()
    [-3.0]
    """
    check_impact(phase, velocity)
    relative = velocity - table(phase, amplitude)[0]
    if not np.all(relative <= _ROUNDING * (np.abs(velocity) + amplitude)):
        raise ModelError("a ball that rises from the table has no impact: z′ > w′")
    return np.minimum(relative, 0.0)
