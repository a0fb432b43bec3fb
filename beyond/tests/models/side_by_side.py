"""Two balls side by side: the derivative of the map from impact to impact by differences."""

from typing import Any, NamedTuple

import numpy as np

# A start from which the ball of each test leaves the table again.
PHASE = 0.4
VELOCITY = -3.0
_STEP = 1e-5


class Checked(NamedTuple):
    """The impacts at the start, the leg after them, and det J of its map."""

    start: Any
    leg: Any
    determinant: np.ndarray


def checked_deviations(dynamics: Any) -> Checked:
    """Assert that the derivatives of a leg are those by differences of simulated balls."""

    def after(phase, velocity):
        leg = next(dynamics.legs(dynamics.start(np.array([phase]), np.array([velocity]))))
        impact, passed = leg.fly()
        return np.array([phase + passed[0], impact.velocity[0]])

    start = dynamics.start(np.array([PHASE]), np.array([VELOCITY]))
    leg = next(dynamics.legs(start, differentiate=True))
    leg.fly()
    a, b, c, d = (entry[0] for entry in leg.jacobian())
    right, left = (after(PHASE + sign * _STEP, VELOCITY) for sign in (1, -1))
    by_phase = (right - left) / (2 * _STEP)
    right, left = (after(PHASE, VELOCITY + sign * _STEP) for sign in (1, -1))
    by_velocity = (right - left) / (2 * _STEP)
    # The error of the difference is that of rounding, 1e-14 over the step, and of its square.
    size = 1e-8 * (1 + np.abs([a, b, c, d]).max()) ** 2
    assert np.abs(by_phase - [a, c]).max() < size
    assert np.abs(by_velocity - [b, d]).max() < size
    return Checked(start, leg, a * d - b * c)
