"""Location of events on a branch."""

import numpy as np
import pytest

from bouncing_ball.numerics.events import Event, locate


class Line:
    """The branch x = p."""

    def residual(self, y):
        return y[..., :1] - y[..., 1:]

    def jacobian(self, y):
        return np.broadcast_to([[1.0, -1.0]], (*y.shape[:-1], 1, 2))


def test_location_is_not_limited_by_the_gradients_differences():
    # sin(20 x) = 0.5 at x = π/120; third derivatives of 8000 spoil ∇g.
    event = Event("level", lambda y: np.sin(20 * y[..., 0]) - 0.5)
    found = locate(Line(), event, np.array([0.0, 0.0]), np.array([0.05, 0.05]))
    assert found.point == pytest.approx(np.full(2, np.pi / 120), abs=1e-15)


def test_the_zero_inside_the_bracket_is_found():
    # Seven more zeros lie outside, and the secant is flat.
    event = Event("wave", lambda y: np.sin(np.pi * y[..., 1]) * (y[..., 1] + 0.05))
    found = locate(Line(), event, np.full(2, 0.6), np.full(2, 1.9))
    assert found.point == pytest.approx(np.ones(2), abs=1e-14)


@pytest.mark.parametrize("end", [0.99, 0.9999])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_zero_beyond_the_bracket_is_not_the_one_that_was_announced(end, sign):
    # Of p³ - p the zero inside is 0; from the secant's estimate, above 0.9, Newton goes to 1.
    event = Event("cubic", lambda y: y[..., 1] ** 3 - y[..., 1])
    for ends in ((-0.6, end), (end, -0.6)):
        assert locate(Line(), event, *(np.full(2, sign * p) for p in ends)) is None


@pytest.mark.parametrize(
    "function",
    [
        lambda y: np.where(y[..., 1] < 0.3, 1.0, -1.0),
        lambda y: 1 / (y[..., 1] - 0.3),
    ],
    ids=["jump", "pole"],
)
def test_what_changes_sign_without_a_zero(function):
    event = Event("no zero", function)
    assert locate(Line(), event, np.array([0.0, 0.0]), np.array([1.0, 1.0])) is None
