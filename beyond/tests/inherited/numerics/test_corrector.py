"""Newton's method on an extended system, and tangents."""

import numpy as np
import pytest
from circle import Circle

from bouncing_ball_beyond.inherited.numerics.corrector import (
    NewtonSettings,
    failure,
    newton,
    plane,
    solve,
    solve_linear,
    tangent,
)

EPS = np.finfo(float).eps


def test_newton_converges_to_the_intersection_with_a_plane():
    # The line x = 2p meets the circle at p = 1/√5.
    normal = np.array([1.0, -2.0])
    found = newton(Circle(), np.array([1.0, 0.6]), plane(normal, np.zeros(2)))
    assert found.converged
    assert found.point == pytest.approx(np.array([2.0, 1.0]) / np.sqrt(5), abs=4 * EPS)
    assert found.iterations <= 6
    # The next step would be a rounding error.
    assert found.step**2 <= EPS


def test_convergence_is_quadratic():
    # With the exact Jacobian each residual is about the square of the last.
    residuals = []
    for count in (1, 2, 3, 4):
        settings = NewtonSettings(tolerance=0.0, max_iterations=count)
        condition = plane(np.array([1.0, -2.0]), np.zeros(2))
        residuals.append(newton(Circle(), np.array([1.0, 0.6]), condition, settings).residual)
    # residuals[0] is that of the guess; the plane is met after one step.
    assert residuals[2] < residuals[1] ** 2
    assert residuals[3] < residuals[2] ** 2


def test_many_guesses_converge_together():
    angles = np.linspace(0.1, 6.0, 11)
    guess = 1.1 * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    normals = np.stack([-np.sin(angles), np.cos(angles)], axis=-1)
    found = newton(Circle(), guess, plane(normals, guess))
    assert found.converged.all()
    assert found.point == pytest.approx(guess / 1.1, abs=4 * EPS)


def test_a_guess_that_fails_leaves_the_others_alone():
    # One converges, one meets a singular matrix, and one misses the circle.
    guess = np.array([[1.0, 0.6], [0.0, 0.0], [1.0, 2.0]])
    normals = np.array([[1.0, -2.0], [1.0, -2.0], [0.0, 1.0]])
    through = np.array([[0.0, 0.0], [0.0, 0.0], [1.0, 2.0]])
    found = newton(Circle(), guess, plane(normals, through))
    assert found.converged.tolist() == [True, False, False]
    assert found.point[0] == pytest.approx(np.array([2.0, 1.0]) / np.sqrt(5), abs=4 * EPS)
    assert found.point[1].tolist() == [0.0, 0.0]


def test_a_step_too_long_for_its_square_stops_the_iteration_at_the_guess():
    # A slope of 10⁻²⁰⁰: the step to the root of 10⁻²⁰⁰ x - 1 is finite, and its square is not.
    slope = np.array([[1e-200], [1.0]])

    def lines(y):
        return slope * y - 1, slope[..., np.newaxis]

    found = solve(lines, np.full((2, 1), 2.0))
    assert found.converged.tolist() == [False, True]
    assert found.point.ravel().tolist() == [2.0, 1.0]


def test_a_singular_matrix_stops_the_iteration_at_the_guess():
    # ∇F = 0 at the centre.
    found = newton(Circle(), np.zeros(2), plane(np.array([1.0, 0.0]), np.zeros(2)))
    assert not found.converged
    assert (found.iterations, found.residual, found.step) == (1, 1.0, np.inf)
    assert found.point.tolist() == [0.0, 0.0]


def test_tangent_is_the_unit_null_vector_on_the_given_side():
    rng = np.random.default_rng(3)
    for size in (1, 2, 5):
        jacobian = rng.normal(size=(size, size + 1))
        along = rng.normal(size=size + 1)
        vector = tangent(jacobian, along)
        # Condition numbers below 1e3 for these seeds.
        assert np.linalg.norm(vector) == pytest.approx(1.0, abs=4 * EPS)
        assert jacobian @ vector == pytest.approx(np.zeros(size), abs=1e-12)
        assert vector @ along > 0
        assert tangent(jacobian, -along) == pytest.approx(-vector, abs=1e-12)


@pytest.mark.parametrize("cosine", [0.0, 1e-9, 1e-4])
def test_a_tangent_nearly_at_a_right_angle_to_its_direction_keeps_its_digits(cosine):
    """Beside it a row whose linear system is regular has the same bits as alone."""
    jacobian = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    along = np.array([1.0, 0.0, cosine])
    expected = np.array([0.0, 0.0, 1.0])
    assert np.abs(tangent(jacobian, along)) == pytest.approx(expected, abs=4 * EPS)
    both = tangent(np.array([jacobian, jacobian]), np.array([along, [0.0, 0.6, 0.8]]))
    alone = tangent(jacobian, np.array([0.0, 0.6, 0.8]))
    assert np.array_equal(both[1], alone) and alone == pytest.approx(expected, abs=4 * EPS)


def test_the_tangent_is_unknown_only_where_the_jacobian_is_not_finite():
    matrices = np.array([[[1.0, 1.0]], [[np.nan, 1.0]], [[np.inf, 1.0]]])
    found = tangent(matrices, np.array([0.0, -1.0]))
    assert found[0] == pytest.approx(np.array([1.0, -1.0]) / np.sqrt(2), abs=4 * EPS)
    assert np.all(np.isnan(found[1:]))


class Steep:
    """x = p, with the slopes of 10¹³ (x - p) for p < 0."""

    def residual(self, y):
        return y[..., :1] - y[..., 1:]

    def jacobian(self, y):
        slope = np.where(y[..., 1:] < 0, 1e13, 1.0)
        return np.stack([slope, -slope], axis=-1)


def test_a_short_step_to_a_point_that_is_no_solution_has_not_converged():
    guess = np.array([[1.0, -1.0], [-1.0, -1.0], [2.0, 1.0]])
    found = newton(Steep(), guess, plane(np.array([0.0, 1.0]), guess))
    assert (found.step <= NewtonSettings().tolerance).all()
    assert found.converged.tolist() == [False, True, True]
    assert found.point[1:] == pytest.approx(np.array([[-1.0, -1.0], [1.0, 1.0]]), abs=EPS)
    one = newton(Steep(), guess[0], plane(np.array([0.0, 1.0]), guess[0]))
    assert failure(Steep(), one) == "residual 2.0e+00 after 1 Newton iterations"


class Broken:
    """x p = 0 for p > 0, without derivatives at p = 0."""

    def residual(self, y):
        return y[..., :1] * y[..., 1:]

    def jacobian(self, y):
        return np.where(y[..., np.newaxis, 1:] > 0, y[..., np.newaxis, ::-1], np.nan)


def test_a_point_without_derivatives_is_no_solution_although_its_equations_are_satisfied():
    for start, why in (
        (0.0, "the derivatives of the equations are not defined after 1 Newton iterations"),
        (1.0, ""),
    ):
        guess = np.array([0.0, start])
        found = newton(Broken(), guess, plane(np.array([0.0, 1.0]), guess))
        assert found.residual == 0
        assert failure(Broken(), found) == why


def _of_legs(legs, rng):
    """A matrix like that of an orbit: each leg joins two states, and one row has all unknowns."""
    matrix = np.zeros((2 * legs + 1, 2 * legs + 1))
    for j in range(legs):
        rows = slice(2 * j, 2 * j + 2)
        after = 2 * ((j + 1) % legs)
        matrix[rows, rows] = 3 * rng.normal(size=(2, 2))
        matrix[rows, after : after + 2] = -np.eye(2)
    matrix[:, -1] = rng.normal(size=2 * legs + 1)
    matrix[-1] = rng.normal(size=2 * legs + 1)
    return matrix


@pytest.mark.parametrize("legs", [3, 49, 50, 120])
def test_systems_of_few_and_of_many_unknowns_have_their_solutions(legs):
    rng = np.random.default_rng(legs)
    matrices = np.array([_of_legs(legs, rng) for _ in range(4)])
    expected = rng.normal(size=(4, 2 * legs + 1))
    right = np.einsum("bij,bj->bi", matrices, expected)
    # A singular system does not disturb the others.
    matrices[1, 0] = 0.0
    found = solve_linear(matrices, right)
    assert np.isnan(found[1]).all()
    regular = [0, 2, 3]
    lost = np.linalg.cond(matrices[regular])[:, np.newaxis] * np.abs(expected[regular]).max()
    assert np.all(np.abs(found[regular] - expected[regular]) < 1e-15 * lost)


def test_a_known_solution_stays_as_it_is():
    """Also beside an unknown that is so large that all steps are short against the vector."""

    def equations(y):
        values = np.stack([y[..., 0] ** 2 - 2, y[..., 1] - 1e6], axis=-1)
        zero = np.zeros(y.shape[:-1])
        rows = [[2 * y[..., 0], zero], [zero, zero + 1]]
        return values, np.moveaxis(np.array(rows), (0, 1), (-2, -1))

    # The double nearest to the root of 2, the one beside it, and one that is off by much more than
    # rounding, but by little against the second unknown.
    root = np.sqrt(2.0)
    beside = np.nextafter(root, 2.0)
    guess = np.array([[root, 1e6], [beside, 1e6], [root + 1e-11, 1e6]])
    found = solve(equations, guess)
    assert found.converged.all()
    assert found.point[:2, 0].tolist() == [root, beside]
    assert abs(found.point[2, 0] - root) <= 2 * EPS
