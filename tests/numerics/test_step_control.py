"""The adaptive step: its change with the iterations and the angle, and its bounds."""

import pytest

from bouncing_ball.numerics.continuation import StepControl

CONTROL = StepControl(initial=0.02, smallest=1e-3, largest=1.0, target_iterations=4, max_angle=0.2)


@pytest.mark.parametrize(
    ("iterations", "factor"),
    # √2 per iteration, within [1/4, 2].
    [(4, 1.0), (3, 2**0.5), (2, 2.0), (1, 2.0), (5, 2**-0.5), (6, 0.5), (8, 0.25), (12, 0.25)],
)
def test_iterations_set_the_step(iterations, factor):
    assert CONTROL.after(0.1, iterations, 0.0) == pytest.approx(0.1 * factor, rel=1e-15)


def test_the_angle_bounds_the_step():
    # Turning 0.3 in one step: the next is to turn 0.9 · 0.2.
    assert CONTROL.after(0.1, 2, 0.3) == pytest.approx(0.1 * 0.6, rel=1e-15)
    # A small angle leaves the iterations to decide.
    assert CONTROL.after(0.1, 3, 1e-6) == pytest.approx(0.1 * 2**0.5, rel=1e-15)
    # Never below a quarter at once.
    assert CONTROL.after(0.1, 2, 100.0) == pytest.approx(0.025, rel=1e-15)


def test_bounds():
    assert CONTROL.after(0.9, 1, 0.0) == 1.0
    assert CONTROL.after(2e-3, 12, 0.0) == 1e-3
