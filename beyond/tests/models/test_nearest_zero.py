"""The zero of a motion near a time."""

import numpy as np

from bouncing_ball_beyond.models.linear_contact import nearest_zero


class Line:
    """y = s - s₀."""

    def __init__(self, zero):
        self.zero = zero

    def up_to_second(self, time):
        return time - self.zero, np.ones_like(time), np.zeros_like(time)


def test_a_zero_at_the_time_zero_is_its_own_nearest_zero():
    found = nearest_zero(Line(np.zeros(2)), np.array([0.0, -0.1]))
    assert found.time.tolist() == [0.0, 0.0] and not found.undecided.any()
