"""Location of events on branches that are known exactly."""

import numpy as np
import pytest

from bouncing_ball_beyond.inherited.numerics.events import Event


class Line:
    """The branch x = p."""

    def residual(self, y):
        return y[..., :1] - y[..., 1:]

    def jacobian(self, y):
        return np.broadcast_to([[1.0, -1.0]], (*y.shape[:-1], 1, 2))


def test_location_is_not_limited_by_the_gradients_differences():
    # sin(20 x) = 0.5 at x = π/120; third derivatives of 8000 spoil ∇g.
    event = Event("level", lambda y: np.sin(20 * y[..., 0]) - 0.5)
    found = event.locate(Line(), np.array([0.0, 0.0]), np.array([0.05, 0.05]))
    assert found.point == pytest.approx(np.full(2, np.pi / 120), abs=1e-15)


def test_the_zero_inside_the_bracket_is_found():
    # Seven more zeros lie outside, and the secant is flat.
    event = Event("wave", lambda y: np.sin(np.pi * y[..., 1]) * (y[..., 1] + 0.05))
    found = event.locate(Line(), np.full(2, 0.6), np.full(2, 1.9))
    assert found.point == pytest.approx(np.ones(2), abs=1e-14)


@pytest.mark.parametrize("end", [0.99, 0.9999])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_zero_beyond_the_bracket_is_not_the_one_that_was_announced(end, sign):
    # Of p³ - p the zero inside is 0; from the secant's estimate, above 0.9, Newton goes to 1.
    event = Event("cubic", lambda y: y[..., 1] ** 3 - y[..., 1])
    for ends in ((-0.6, end), (end, -0.6)):
        assert event.locate(Line(), *(np.full(2, sign * p) for p in ends)) is None


@pytest.mark.parametrize(
    "function",
    [
        lambda y: np.where(y[..., 1] < 0.3, 1.0, -1.0),
        lambda y: 1 / (y[..., 1] - 0.3),
    ],
    ids=["jump", "pole"],
)
def test_a_change_of_sign_without_a_zero_is_not_located(function):
    event = Event("no zero", function)
    assert event.locate(Line(), np.array([0.0, 0.0]), np.array([1.0, 1.0])) is None


class Parabola:
    """The branch x = p²."""

    def residual(self, y):
        return y[..., :1] - y[..., 1:] ** 2

    def jacobian(self, y):
        return np.stack([np.ones_like(y[..., 1]), -2 * y[..., 1]], axis=-1)[..., np.newaxis, :]


def test_a_short_step_next_to_a_pole_is_no_zero():
    # Newton's step of ±|p - c|^(-1/2) is 2(p - c): 2e-13 at p = 0.3, the secant's estimate.
    pole = 0.3 + 1e-13

    def condition(y):
        x = y[..., 1] - pole
        value = np.sign(x) / np.sqrt(np.abs(x))
        slope = -0.5 * np.abs(x) ** -1.5
        return value, np.stack([0 * slope, slope], axis=-1)

    event = Event("pole", lambda y: condition(y)[0], condition=condition)
    assert event.locate(Line(), np.zeros(2), np.full(2, 0.6), values=(-1.0, 1.0)) is None


class Steep(Parabola):
    """The parabola with a Jacobian that is wrong and large for p < 0."""

    def jacobian(self, y):
        return np.where(y[..., np.newaxis, 1:] < 0, 1e14, 1.0) * super().jacobian(y)


def test_an_event_at_a_point_that_is_not_on_the_branch_is_not_located():
    ends = np.array([4.0, -2.0]), np.array([0.0, 0.0])
    event = Event("level", lambda y: y[..., 1] + 1)
    assert event.locate(Steep(), *ends) is None
    found = event.locate(Parabola(), *ends)
    assert found.point == pytest.approx(np.array([1.0, -1.0]), abs=1e-15)


def test_with_tangents_the_first_estimate_is_next_to_the_curve_and_the_zero_is_the_same():
    ends = np.array([0.36, 0.6]), np.array([0.64, 0.8])
    tangents = tuple(np.array([2 * p, 1.0]) / np.hypot(2 * p, 1.0) for p in (0.6, 0.8))
    zero = np.array([0.49, 0.7])
    missed = []
    for known in (None, tangents):
        estimates = []

        def condition(y, estimates=estimates):
            estimates.append(y)
            return y[..., 1] - 0.7, np.array([0.0, 1.0])

        event = Event("level", lambda y: y[..., 1] - 0.7, condition=condition)
        found = event.locate(Parabola(), *ends, tangents=known)
        assert found.point == pytest.approx(zero, abs=1e-15)
        missed.append(abs(Parabola().residual(estimates[0]).item()))
    # The chord is 0.1² beside the parabola; the cubic misses it by the next order in the step.
    assert missed[0] == pytest.approx(0.01, abs=1e-12)
    assert missed[1] < missed[0] / 10
