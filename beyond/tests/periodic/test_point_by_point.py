"""Curves that a yes or no gives, and that are known exactly."""

import numpy as np
import pytest

from bouncing_ball_beyond.inherited.numerics.branch import ContinuationError
from bouncing_ball_beyond.periodic.branches.point_by_point import (
    OTHER,
    AllPoints,
    AtBound,
    Lost,
    PointSteps,
    follow_points,
)

# A bisected point has some roundings.
EXACT = 1e-15
EVERYWHERE = np.array([[-np.inf, np.inf], [-np.inf, np.inf]])
STEPS = PointSteps()
# The half width of the first bracket around a guess, and how many are tried, each twice as wide.
CLOSE = 1e-6
WIDER = 16


def boundary_of(inside):
    """The point next to a guess between the points (..., x, p) inside a region and outside it."""

    def answer(guess, given, value):
        point = guess.copy()
        point[OTHER[given]] = value
        return bool(inside(*point[-2:]))

    def point_at(guess, given):
        middle = guess[OTHER[given]]
        for width in CLOSE * 2.0 ** np.arange(WIDER):
            low = middle - width
            high = middle + width
            below = answer(guess, given, low)
            if below != answer(guess, given, high):
                break
        else:
            raise ContinuationError("no boundary is near")
        while low < (half := (low + high) / 2) < high:
            if answer(guess, given, half) == below:
                low = half
            else:
                high = half
        found = guess.copy()
        found[OTHER[given]] = low
        return found

    return point_at


def in_circle(x, p):
    return x * x + p * p < 1


def left_of_line(x, p):
    return x < 2 * p


def on_circle(angle):
    return np.array([np.cos(angle), np.sin(angle)])


def test_a_circle_is_followed_round_where_it_turns_back_in_each_coordinate():
    found = follow_points(boundary_of(in_circle), on_circle(0.3), EVERYWHERE, most=150)
    assert (found.start, found.end) == (AllPoints(150), AllPoints(150))
    assert found.points.shape == (299, 2)
    np.testing.assert_allclose(np.hypot(*found.points.T), 1.0, rtol=0, atol=EXACT)
    # The last entry increases at the start, and each half goes round.
    angle = np.unwrap(np.arctan2(found.points[:, 1], found.points[:, 0]))
    angle += 0.3 - angle[149]
    assert np.all(np.diff(angle) > 0)
    assert angle[0] < 0.3 - 2 * np.pi and angle[-1] > 0.3 + 2 * np.pi
    # A step turns farther from the coordinate that is given by its own length, before this changes.
    lengths = np.linalg.norm(np.diff(found.points, axis=0), axis=-1)
    longest = lengths.max()
    assert longest <= STEPS.largest / np.cos(np.arctan(STEPS.faster) + longest)


def test_the_tangents_lead_from_point_to_point():
    found = follow_points(boundary_of(in_circle), on_circle(0.3), EVERYWHERE, most=50)
    np.testing.assert_allclose(np.linalg.norm(found.tangents, axis=-1), 1.0, rtol=0, atol=EXACT)
    chords = found.points[2:] - found.points[:-2]
    chords /= np.linalg.norm(chords, axis=-1, keepdims=True)
    np.testing.assert_allclose(found.tangents[1:-1], chords, rtol=0, atol=1e-12)
    single = follow_points(boundary_of(in_circle), on_circle(0.3), EVERYWHERE, most=1)
    assert single.points.shape == single.tangents.shape == (1, 2)
    np.testing.assert_allclose(np.linalg.norm(single.tangents), 1.0, rtol=0, atol=EXACT)


@pytest.mark.parametrize(
    ("within", "column", "upper", "at"),
    [
        ([(-2.0, 2.0), (-2.0, 0.6)], -1, True, (0.8, 0.6)),
        ([(-0.6, 2.0), (-2.0, 2.0)], -2, False, (-0.6, 0.8)),
    ],
)
def test_a_curve_ends_at_a_bound_of_the_coordinate_that_is_given(within, column, upper, at):
    """At 0.6 of the second coordinate and at -0.6 of the first one it changes faster."""
    found = follow_points(boundary_of(in_circle), on_circle(0.1), np.array(within), most=200)
    assert found.end == AtBound(column, upper, passed=False)
    assert found.points[-1, column] == at[column]
    np.testing.assert_allclose(found.points[-1], at, rtol=0, atol=EXACT)


@pytest.mark.parametrize(
    ("within", "column", "upper"),
    [
        # The circle is next to its turn in x, so that p is given, and next to its turn in p.
        ([(0.999, 2.0), (-2.0, 2.0)], -2, False),
        ([(-2.0, 2.0), (-2.0, 0.999)], -1, True),
    ],
)
def test_a_curve_ends_before_a_bound_that_the_coordinate_sought_passes(within, column, upper):
    found = follow_points(boundary_of(in_circle), on_circle(0.02), np.array(within), most=200)
    assert found.end == AtBound(column, upper, passed=True)
    low, high = within[column]
    assert np.all((found.points[:, column] >= low) & (found.points[:, column] <= high))
    bound = high if upper else low
    # It moves by a step at most, at the slope of the circle there.
    assert 0 < abs(found.points[-1, column] - bound) < 0.1 * STEPS.largest


def test_both_ends_have_their_own_reasons():
    within = np.array([[-2.0, 2.0], [-0.3, 0.6]])
    found = follow_points(boundary_of(in_circle), on_circle(0.1), within, most=200)
    assert found.start == AtBound(-1, upper=False, passed=False)
    assert found.end == AtBound(-1, upper=True, passed=False)
    assert found.points[[0, -1], 1].tolist() == [-0.3, 0.6]


def test_a_curve_is_lost_where_no_step_is_short_enough():
    """The answer is no everywhere above p = 0.3."""

    def cut(x, p):
        return p < 0.3 and in_circle(x, p)

    found = follow_points(boundary_of(cut), on_circle(0.1), EVERYWHERE, most=100)
    assert found.start == found.end == Lost("no boundary is near")
    assert found.points[0, 0] < 0 < found.points[-1, 0]
    # The last step tried was below twice the smallest.
    left = 0.3 - found.points[[0, -1], 1]
    assert np.all((left > 0) & (left < 2 * STEPS.smallest))


def test_a_step_is_twice_as_long_as_the_one_before_and_half_as_long_after_a_failure():
    tried = []

    def diagonal(guess, given):
        """The line x = p, of which no point beyond p = 0.5 is found from one before it at once."""
        tried.append(guess[given])
        if guess[given] > 0.5 and tried[-2] < 0.5:
            raise ContinuationError("not at once")
        found = guess.copy()
        found[OTHER[given]] = guess[given]
        return found

    steps = PointSteps(initial=0.1, largest=0.3)
    found = follow_points(diagonal, np.zeros(2), np.array([[-1.0, 2.0], [-0.05, 2.0]]), 5, steps)
    assert found.points[:, 0].tolist() == found.points[:, 1].tolist()
    # At 0.6 and 0.75 the first attempts fail, and at 0.6 the second one does not.
    expected = [-0.05, 0.0, 0.1, 0.3, 0.45, 0.6]
    np.testing.assert_allclose(found.points[:, 0], expected, rtol=0, atol=EXACT)
    tries = [0.0, 0.1, 0.3, 0.6, 0.45, 0.75, 0.6, -0.05]
    np.testing.assert_allclose(tried, tries, rtol=0, atol=EXACT)


def test_the_coordinate_that_is_given_changes_only_where_the_other_one_is_faster():
    given_in = {}
    for slope in (1.4, 2.0):
        columns = given_in[slope] = []

        def line(guess, given, slope=slope, columns=columns):
            columns.append(given)
            x = slope * guess[-1] if given == -1 else guess[-2]
            return np.array([x, x / slope])

        found = follow_points(line, np.zeros(2), np.array([[-0.5, 0.5], [-0.5, 0.5]]), most=100)
        assert found.end == AtBound(-2, upper=True, passed=slope < STEPS.faster)
    assert set(given_in[1.4]) == {-1}
    # The start and the first point, in either direction.
    assert given_in[2.0].count(-1) == 3


def test_the_line_through_the_last_two_points_predicts_all_entries():
    """On a line the third guess is the point itself."""
    missed = []

    def line(guess, given):
        p = guess[-1] if given == -1 else guess[-2] / 2
        found = np.array([7 - 3 * p, 2 * p, p])
        missed.append(np.linalg.norm(found - guess))
        return found

    follow_points(line, np.array([7.0, 0.0, 0.0]), EVERYWHERE, most=20)
    # The start, and then each direction in turn.
    start, *ways = missed
    assert start == 0
    for way in (ways[:19], ways[19:]):
        assert way[0] > STEPS.initial
        np.testing.assert_allclose(way[1:], 0.0, rtol=0, atol=1e-14)


def test_a_start_without_a_point_near_is_an_error():
    with pytest.raises(ContinuationError, match="no boundary is near"):
        follow_points(boundary_of(in_circle), np.array([3.0, 0.0]), EVERYWHERE, most=10)
