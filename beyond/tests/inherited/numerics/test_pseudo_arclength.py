"""Continuation of problems whose branches are known exactly."""

import numpy as np
import pytest
from bounds_of_branches import parameter_bound
from one_branch import continue_both_ways, continue_branch

from bouncing_ball_beyond.inherited.numerics.branch import (
    STARTED,
    Branch,
    ContinuationError,
    resample,
)
from bouncing_ball_beyond.inherited.numerics.branch import _between as hermite
from bouncing_ball_beyond.inherited.numerics.events import Event, limit
from bouncing_ball_beyond.inherited.numerics.pseudo_arclength import solve_at
from bouncing_ball_beyond.inherited.numerics.steps import StepControl

# Newton's last step is below 1e-12 and converges quadratically, so points are
# exact to a few roundings; 1e-12 has a wide margin.
EXACT = 1e-12


class Scalar:
    """One equation f(x, p) = 0 with its derivatives."""

    def __init__(self, f, f_x, f_p):
        self.f = f
        self.parts = (f_x, f_p)

    def residual(self, y):
        return self.f(y[..., 0], y[..., 1])[..., np.newaxis]

    def jacobian(self, y):
        x = y[..., 0]
        p = y[..., 1]
        parts = [np.broadcast_to(part(x, p), x.shape) for part in self.parts]
        return np.stack(parts, axis=-1)[..., np.newaxis, :]


CIRCLE = Scalar(lambda x, p: x**2 + p**2 - 1, lambda x, p: 2 * x, lambda x, p: 2 * p)
CUBIC = Scalar(lambda x, p: x**3 - x + p, lambda x, p: 3 * x**2 - 1, lambda x, p: 1.0)
LINE = Scalar(lambda x, p: x - 2 * p, lambda x, p: 1.0, lambda x, p: -2.0)


def fold(problem):
    return Event("fold", lambda y: problem.jacobian(y)[..., 0, 0])


def named(branch, name):
    return [special.point for special in branch.special if special.name == name]


def along(problem, *start, **given):
    """A branch towards larger parameters."""
    return continue_branch(problem, np.array(start), increasing=True, **given)


def test_a_closed_branch_is_followed_round_until_the_limit_of_points():
    branch = along(CIRCLE, 1.0, 0.0, events=[fold(CIRCLE)], max_points=120)
    assert str(branch.start) == "starting point"
    assert str(branch.end) == "reached the limit of 120 points"
    assert len(branch.points) == 120
    assert np.hypot(*branch.points.T) == pytest.approx(np.ones(120), abs=EXACT)
    angle = np.unwrap(np.arctan2(branch.points[:, 1], branch.points[:, 0]))
    assert np.all(np.diff(angle) > 0)
    turned = angle[-1]
    assert turned > 2 * np.pi  # round and on, over the start
    # Each fold every time it is passed, in turn at p = 1 and p = -1.
    passes = int((turned - np.pi / 2) // np.pi) + 1
    expected = np.array([[0.0, (-1.0) ** k] for k in range(passes)])
    assert np.array(named(branch, "fold")) == pytest.approx(expected, abs=EXACT)


def test_no_step_turns_the_tangent_by_more_than_the_largest_angle():
    control = StepControl(initial=0.01, largest=0.15, max_angle=0.1)
    branch = along(CIRCLE, 1.0, 0.0, control=control, max_points=80)
    assert np.hypot(*(branch.points[1] - branch.points[0])) == pytest.approx(0.01, rel=1e-3)
    # On the unit circle the tangent turns by the angle run through.
    angle = np.diff(np.unwrap(np.arctan2(branch.points[:, 1], branch.points[:, 0])))
    assert angle.max() <= 0.1 * (1 + 1e-12)
    assert angle.max() > 0.08  # and the steps do grow that far
    # The tangents are those of the circle, in the direction of the steps.
    normal = np.stack([-branch.points[:, 1], branch.points[:, 0]], axis=-1)
    assert branch.tangents == pytest.approx(normal, abs=EXACT)


def test_both_folds_of_a_cubic_are_located_in_the_order_of_the_branch():
    # p = x - x³ has its extrema at x = ±1/√3.
    events = [
        fold(CUBIC),
        parameter_bound(3.0, True, "too large"),
        parameter_bound(-3.0, False, "too small"),
    ]
    branch = continue_both_ways(CUBIC, np.array([0.0, 0.0]), events=events)
    x = 1 / np.sqrt(3)
    # The parameter increases at the start, so the start is passed upwards.
    assert np.array(named(branch, "fold")) == pytest.approx(
        np.array([[-x, -2 * x / 3], [x, 2 * x / 3]]), abs=EXACT
    )
    assert (str(branch.start), str(branch.end)) == ("too large", "too small")
    assert branch.points[[0, -1], 1] == pytest.approx([3.0, -3.0], abs=EXACT)
    assert CUBIC.residual(branch.points) == pytest.approx(
        np.zeros((len(branch.points), 1)), abs=EXACT
    )
    # One sequence: no point twice, no jump, tangents along it.
    steps = np.diff(branch.points, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    assert lengths.min() > 0
    # A round ends before a step that is longer by a quarter, because the branch turns.
    assert lengths.max() <= StepControl().largest * 1.25
    assert np.all(np.sum(steps * branch.tangents[:-1], axis=1) > 0.9 * lengths)
    # The special points come in the order of the branch.
    order = [np.argmin(np.linalg.norm(branch.points - s.point, axis=1)) for s in branch.special]
    assert order == sorted(order)
    assert [s.name for s in branch.special] == [
        "parameter bound",
        "fold",
        "fold",
        "parameter bound",
    ]


def test_a_branch_ends_exactly_at_the_bound_of_its_parameter():
    events = [parameter_bound(1.0, True, "window")]
    branch = along(LINE, 0.0, 0.0, events=events)
    assert str(branch.end) == "window"
    assert branch.points[-1] == pytest.approx(np.array([2.0, 1.0]), abs=EXACT)
    assert branch.arclength[-1] == pytest.approx(np.sqrt(5), abs=EXACT)
    assert np.all(branch.points[:-1, 1] < 1.0)
    assert branch.tangents == pytest.approx(
        np.broadcast_to(np.array([2, 1]) / np.sqrt(5), branch.points.shape), abs=EXACT
    )
    # Straight and linear: the step grows to the largest and stays.
    steps = np.diff(branch.arclength)
    assert steps.max() == pytest.approx(StepControl().largest, rel=EXACT)


def in_a_plane(bound):
    """The end of a branch at p = ``bound``, as a limit."""
    return limit("parameter bound", np.array([0.0, -1.0]), -bound, "window")


def test_a_step_ends_in_the_plane_of_a_linear_event():
    """The point there is that which is located after a step beyond it, with other events
    located before it and none beyond it.
    """
    before, beyond = (Event(str(p), lambda y, p=p: p - y[..., 1]) for p in (0.59, 0.61))
    control = StepControl(largest=0.1)
    found, located = (
        along(CIRCLE, 1.0, 0.0, events=[before, beyond, end], control=control)
        for end in (in_a_plane(0.6), parameter_bound(0.6, True, "window"))
    )
    for branch in (found, located):
        assert str(branch.end) == "window"
        assert [special.name for special in branch.special] == ["0.59", "parameter bound"]
        assert branch.points[-1] == pytest.approx(np.array([0.8, 0.6]), abs=EXACT)
        assert branch.tangents[-1] == pytest.approx(np.array([-0.6, 0.8]), abs=EXACT)
    assert len(found.points) == len(located.points)


def test_a_branch_that_runs_along_a_plane_is_not_corrected_in_it():
    """At p = 1 - 1e-4 the circle makes an angle of 0.014 with the line p = constant."""
    bound = 1 - 1e-4
    start = np.array([np.sqrt(1 - (1 - 2e-4) ** 2), 1 - 2e-4])
    branch = along(CIRCLE, *start, events=[in_a_plane(bound)])
    assert str(branch.end) == "window"
    assert branch.points[-1] == pytest.approx(np.array([np.sqrt(1 - bound**2), bound]), abs=1e-10)


def test_events_of_one_step_come_in_order_and_none_after_the_end():
    # All within one step of 0.2, given out of order; the last is behind the end.
    def at(p, name, terminal=False):
        return Event(name, lambda y: p - y[..., 1], terminal=terminal)

    control = StepControl(initial=0.2)
    events = [at(0.06, "c"), at(0.05, "end", True), at(0.01, "a"), at(0.02, "b")]
    branch = along(LINE, 0.0, 0.0, events=events, control=control)
    assert [s.name for s in branch.special] == ["a", "b", "end"]
    assert [s.point[1] for s in branch.special] == pytest.approx([0.01, 0.02, 0.05], abs=EXACT)
    assert len(branch.points) == 2


def test_an_event_on_a_point_of_the_branch_is_found_once():
    # Steps of exactly 0.25 in p: the zero at 0.5 is hit exactly.
    step = 0.25 * np.sqrt(5)
    control = StepControl(initial=step, largest=step)
    for sign in (1.0, -1.0):
        event = Event("half", lambda y, sign=sign: sign * (y[..., 1] - 0.5))
        end = parameter_bound(0.9, True, "end")
        branch = along(LINE, 0.0, 0.0, events=[event, end], control=control)
        assert np.array(named(branch, "half")) == pytest.approx(np.array([[1.0, 0.5]]), abs=EXACT)


def test_the_branch_ends_where_the_corrector_fails_with_the_smallest_step():
    # x = p, undefined beyond p = 1.
    problem = Scalar(
        lambda x, p: np.where(p > 1, np.nan, x - p), lambda x, p: 1.0, lambda x, p: -1.0
    )
    control = StepControl(smallest=1e-6)
    branch = along(problem, 0.0, 0.0, control=control)
    assert str(branch.end).startswith("step too small (")
    assert str(branch.end).endswith("the corrector fails with residual nan")
    assert branch.end.finished
    # The last step tried was below twice the smallest.
    assert 1 - 2 * np.sqrt(2) * 1e-6 < branch.points[-1, 1] <= 1


def test_a_corner_ends_the_branch():
    # x = max(p, 0): the tangent turns by half a right angle at once.
    problem = Scalar(
        lambda x, p: x - np.maximum(p, 0), lambda x, p: 1.0, lambda x, p: np.where(p < 0, 0.0, -1.0)
    )
    branch = along(problem, 0.0, -0.5)
    assert str(branch.end).startswith("step too small (")
    assert str(branch.end).endswith("the tangent turns by more than 0.2 rad")
    assert branch.points[-1] == pytest.approx(np.zeros(2), abs=1e-7)


def jump(terminal, reason=""):
    """A test function that changes its sign without a zero, at p = 0.3."""
    return Event("jump", lambda y: np.where(y[..., 1] < 0.3, 1.0, -1.0), terminal, reason)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("event", "reason"),
    [
        (jump(True, "the edge"), "the edge"),
        (jump(True), "jump announced near"),
        (jump(False), "jump announced near"),
    ],
)
def test_an_event_without_a_zero_ends_the_branch_close_to_it(event, reason):
    control = StepControl(smallest=1e-6)
    branch = along(LINE, 0.0, 0.0, events=[event], control=control)
    assert str(branch.end).startswith("step too small (") and reason in str(branch.end)
    assert branch.end.finished == event.terminal
    # The last step tried was below twice the smallest.
    assert 0.3 - 2e-6 < branch.points[-1, 1] < 0.3
    assert branch.special == ()


@pytest.mark.parametrize("root", [0.11, 0.3, 0.93])
def test_the_step_gets_shorter_where_newton_leaves_it(root):
    # Newton's method for the arc tangent diverges unless it starts within 1.39/200 of the zero.
    events = [
        Event("steep", lambda y: np.arctan(200 * (y[..., 1] - root))),
        parameter_bound(2.0, True, "end"),
    ]
    branch = along(LINE, 0.0, 0.0, events=events)
    assert np.array(named(branch, "steep")) == pytest.approx(
        np.array([[2 * root, root]]), abs=EXACT
    )


def test_an_event_that_cannot_be_located_gives_way_to_the_end():
    # The end, at p = 0.29, is met in the same step as the jump at 0.3.
    end = parameter_bound(0.29, True, "window")
    control = StepControl(initial=1.0, largest=1.0)
    branch = along(LINE, 0.0, 0.0, events=[jump(False), end], control=control)
    assert str(branch.end) == "window"
    assert branch.points[-1] == pytest.approx(np.array([0.58, 0.29]), abs=EXACT)


def test_a_start_without_a_solution_nearby_is_refused(refusal):
    with refusal(
        ContinuationError,
        "no solution near the starting guess [1. 2.]",
        "residual",
        "8 Newton iterations",
    ):
        solve_at(CIRCLE, np.array([1.0, 2.0]))
    with pytest.raises(ContinuationError):
        along(CIRCLE, 1.0, 2.0)


def test_a_start_beyond_a_terminal_event_is_refused(refusal):
    for bound, upper in ((0.5, True), (0.7, False)):
        events = [parameter_bound(bound, upper, "the window")]
        with refusal(
            ContinuationError, "the start [0.8 0.6] lies beyond the end of the branch: the window"
        ):
            along(CIRCLE, 0.8, 0.6, events=events)


def test_a_start_without_derivatives_is_refused(refusal):
    # The equation has solutions at p ≤ 0.6, and its derivatives end before.
    def slope(x, p):
        return np.where(p < 0.6, 1.0, np.nan)

    line = Scalar(lambda x, p: x - 2 * p, lambda x, p: 1.0, slope)
    with refusal(
        ContinuationError, "near the starting guess [1.2 0.6]", "the derivatives", "not defined"
    ):
        along(line, 1.2, 0.6)
    # The last Newton step, which is short enough, leads to a place without derivatives.
    corner = Scalar(
        lambda x, p: (x - 1) * (x + 1),
        lambda x, p: np.where(np.abs(x - 1) < 1e-12, np.nan, 2 * x),
        lambda x, p: 0.0,
    )
    with refusal(ContinuationError, "has no direction: the derivatives", "not defined"):
        along(corner, 1 + 1.5e-12, 0.0)


def test_the_start_is_corrected_at_a_fixed_parameter():
    assert solve_at(CIRCLE, np.array([0.9, 0.6])) == pytest.approx([0.8, 0.6], abs=EXACT)
    branch = along(CIRCLE, 0.9, 0.6, max_points=3)
    assert branch.points[0] == pytest.approx(np.array([0.8, 0.6]), abs=EXACT)


def test_a_branch_may_start_at_a_fold():
    start = np.array([0.0, 1.0])
    assert solve_at(CIRCLE, start).tolist() == start.tolist()


def circle_arc(control):
    event = Event("end", lambda y: y[..., 0] + 0.5, terminal=True)
    return along(CIRCLE, 1.0, 0.0, events=[event], control=control)


COARSE = StepControl()
FINE = StepControl(initial=0.003, largest=0.03, max_angle=0.05)


@pytest.mark.parametrize("count", [2, 17, 400])
def test_resampled_points_are_solutions_from_end_to_end(count):
    branch = circle_arc(COARSE)
    points = resample(CIRCLE, branch, count)
    assert points.shape == (count, 2)
    assert CIRCLE.residual(points) == pytest.approx(np.zeros((count, 1)), abs=EXACT)
    assert points[[0, -1]] == pytest.approx(branch.points[[0, -1]], abs=EXACT)
    angle = np.arctan2(points[:, 1], points[:, 0])
    assert np.all(np.diff(angle) > 0)


def test_the_predictor_of_resampled_points_has_its_derivative_as_direction():
    """On a cubic it is exact: (t, t² - t³) between t = -1, 0 and 2."""
    time = np.array([-1.0, 0.0, 2.0])
    points = np.stack([time, time**2 - time**3], axis=-1)
    rates = np.stack([np.ones(3), 2 * time - 3 * time**2], axis=-1)
    wanted = np.array([-0.75, 0.5, 1.75])
    at, direction = hermite(wanted, time, points, rates)
    np.testing.assert_allclose(at, np.stack([wanted, wanted**2 - wanted**3], -1), atol=1e-14)
    slope = 2 * wanted - 3 * wanted**2
    np.testing.assert_allclose(direction[:, 1] / direction[:, 0], slope, rtol=0, atol=1e-13)


def test_resampled_points_do_not_depend_on_the_step_control():
    # The true arclength of the circle is its angle: equal steps of 2π/3 / 20.
    expected = np.linspace(0.0, 2 * np.pi / 3, 21)
    for control in (COARSE, FINE):
        points = resample(CIRCLE, circle_arc(control), 21)
        angle = np.arctan2(points[:, 1], points[:, 0])
        assert angle == pytest.approx(expected, abs=1e-10)


def test_resampling_where_there_is_no_solution_is_refused(refusal):
    # The planes across this chord miss the circle.
    ends = np.array([[1.0, 0.0], [3.0, 0.0]])
    tangents = np.array([[1.0, 0.0], [1.0, 0.0]])
    branch = Branch(ends, tangents, (), STARTED, STARTED)
    with refusal(ContinuationError, "resampling to 5 points failed with residual"):
        resample(CIRCLE, branch, 5)


# The step after an accepted step.

STEPS = StepControl(initial=0.02, smallest=1e-3, largest=1.0, target_iterations=4, max_angle=0.2)


@pytest.mark.parametrize(
    ("iterations", "factor"),
    # √2 per iteration, within [1/4, 2].
    [(4, 1.0), (3, 2**0.5), (2, 2.0), (1, 2.0), (5, 2**-0.5), (6, 0.5), (8, 0.25), (12, 0.25)],
)
def test_the_step_changes_by_the_root_of_two_for_each_iteration(iterations, factor):
    assert STEPS.after(0.1, iterations, 0.0) == pytest.approx(0.1 * factor, rel=1e-15)


def test_the_step_is_bounded_by_the_angle_of_the_tangents():
    # Turning 0.3 in one step: the next is to turn 0.9 · 0.2.
    assert STEPS.after(0.1, 2, 0.3) == pytest.approx(0.1 * 0.6, rel=1e-15)
    # A small angle leaves the iterations to decide.
    assert STEPS.after(0.1, 3, 1e-6) == pytest.approx(0.1 * 2**0.5, rel=1e-15)
    # Never below a quarter at once.
    assert STEPS.after(0.1, 2, 100.0) == pytest.approx(0.025, rel=1e-15)


def test_the_step_stays_between_the_smallest_and_the_largest():
    assert STEPS.after(0.9, 1, 0.0) == 1.0
    assert STEPS.after(2e-3, 12, 0.0) == 1e-3
