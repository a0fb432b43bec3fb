"""Limits of a domain along a branch of a problem whose solution is known."""

import numpy as np
import pytest

from bouncing_ball.numerics.continuation import continue_branch
from bouncing_ball.numerics.events import domain_limits


class Circle:
    """The branch x² + p² = 1."""

    def residual(self, y):
        return np.sum(y * y, axis=-1, keepdims=True) - 1

    def jacobian(self, y):
        return 2 * y[..., np.newaxis, :]


def test_changes_are_found_to_the_last_digit():
    # Round the circle once; admissible where x > 0.3 or p < -0.9.
    branch = continue_branch(Circle(), np.array([1.0, 0.0]), increasing=True, max_points=60)

    def admissible(y):
        return (y[..., 0] > 0.3) | (y[..., 1] < -0.9)

    found = np.array(domain_limits(Circle(), admissible, branch.points))
    low = np.sqrt(1 - 0.81)
    expected = [[0.3, np.sqrt(0.91)], [-low, -0.9]]
    assert found[:2] == pytest.approx(np.array(expected), abs=4e-16)
    # Each is the last admissible point on its side.
    assert admissible(found).all()
