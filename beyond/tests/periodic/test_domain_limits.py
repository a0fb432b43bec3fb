"""The limits of a domain on branches that are known exactly."""

import numpy as np
import pytest
from circle import Circle
from one_branch import continue_branch

from bouncing_ball_beyond.periodic.orbits.domain_limits import DomainLimit, domain_limits


class Line:
    """The branch x = p."""

    def residual(self, y):
        return y[..., :1] - y[..., 1:]

    def jacobian(self, y):
        return np.broadcast_to([[1.0, -1.0]], (*y.shape[:-1], 1, 2))


def test_the_limit_of_a_sign_is_bisected():
    event = DomainLimit("jump", lambda y: np.where(y[..., 1] < 0.3, 1.0, -1.0))
    for ends in (0.0, 1.0), (1.0, 0.0):
        found = event.locate(Line(), *(np.full(2, p) for p in ends))
        assert found.point == pytest.approx(np.full(2, 0.3), abs=1e-15)


def test_the_limits_of_a_domain_are_found_to_the_last_digit():
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
