"""Newton's method in short steps."""

import numpy as np
import pytest
from circle import Circle

from bouncing_ball_beyond.inherited.numerics.corrector import newton, plane
from bouncing_ball_beyond.periodic.orbits.short_steps import (
    ShortSteps,
    newton_short,
    solution_near,
)

EPS = np.finfo(float).eps


def test_no_step_is_longer_than_the_longest_and_its_direction_stays():
    guess = np.array([3.0, 1.0])
    direction = np.array([1.0, -2.0])
    condition = plane(direction, np.zeros(2))
    short = newton_short(Circle(), guess, condition, ShortSteps(0.1, max_iterations=1)).point
    values = np.array([9.0, guess @ direction])
    step = -np.linalg.solve(np.array([2 * guess, direction]), values)
    assert short - guess == pytest.approx(0.1 * step / np.linalg.norm(step), abs=4 * EPS)


def test_in_short_steps_the_same_solution_is_found():
    guess = np.array([[3.0, 1.0], [0.7, 0.7]])
    condition = plane(np.array([1.0, -2.0]), np.zeros((2, 2)))
    short = newton_short(Circle(), guess, condition, ShortSteps(0.3))
    known = newton(Circle(), guess, condition)
    assert short.converged.all()
    # 3 to 0.9 in steps of 0.3.
    assert short.iterations[0] > known.iterations[0]
    assert short.point == pytest.approx(known.point, abs=4 * EPS)


def test_a_fold_is_a_solution_although_the_parameter_does_not_select_it():
    point, why = solution_near(Circle(), np.array([1e-9, 1.0]), ShortSteps(0.3))
    assert why == "" and point == pytest.approx(np.array([0.0, 1.0]), abs=1e-8)
    _, why = solution_near(Circle(), np.array([0.5, 1.5]), ShortSteps(0.3))
    assert "Newton iterations" in why
