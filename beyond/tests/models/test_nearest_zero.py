"""The zero of a motion near a time."""

import numpy as np

from bouncing_ball.numerics.first_zero import Derivatives, Motion
from bouncing_ball_beyond.models.linear_contact import nearest_zero


class Line(Motion):
    """y = s - s₀."""

    def __init__(self, zero):
        self.zero = zero

    def __call__(self, time):
        one = np.ones_like(time)
        return Derivatives(time - self.zero, one, 0 * one, 0 * one, 0.0, 0.0, 0.0)


def test_a_zero_at_the_time_zero_is_its_own_nearest_zero():
    found = nearest_zero(Line(np.zeros(2)), np.array([0.0, -0.1]))
    assert found.time.tolist() == [0.0, 0.0] and not found.undecided.any()
