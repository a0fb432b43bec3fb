"""The table's motion, by functions whose results have the same digits on every processor."""

import numpy as np

from bouncing_ball.contacts.elementary import reduce_angle, sine_and_versine

__all__ = ["reduce_angle", "sine_and_versine", "table"]


def table(phase: np.ndarray, amplitude: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
    """Λ cos φ and Λ sin φ: the table's velocity and height, or minus its jerk and acceleration.

    Examples
    --------
    >>> [float(x) for x in table(np.zeros(()), 2.0)]
    [2.0, 0.0]
    """
    sine, versine = sine_and_versine(phase)
    return amplitude * (1 - versine), amplitude * sine
