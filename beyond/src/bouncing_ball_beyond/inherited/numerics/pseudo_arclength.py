"""Predictor-corrector continuation of branches, with events.

A round starts from a state: a point y of the branch, its tangent t with the derivative t′ along the
branch, and the values of the test functions. The predictor is ``y + h t + h² t′/2``, and Newton's
method in the plane normal to t is the corrector; t′ is the difference of the tangents over the last
step. Because an evaluation of the equations costs hardly more for ten points than for one, the next
points of a branch, at several distances h, are predicted and corrected together. They are accepted
in order, up to the first step between neighbours at which the corrector fails, at which the tangent
turns too much, or on which an event cannot be located. If this is the first of them, the next round
tries several shorter steps in its place, of which the longest one that succeeds is taken.
:class:`StepControl` chooses the steps. The branch ends at a terminal event, where no step is short
enough, or after a given number of points. A prediction beyond a terminal event that is linear in y,
such as an end of the parameter's range, is moved into the plane of this event and corrected there.

Several branches are followed side by side for the same reason. Each branch has steps of its own and
ends on its own, so that it is the same as if it were followed alone.
"""

from collections.abc import Callable, Sequence
from functools import cache
from itertools import islice
from typing import Any

import numpy as np

from bouncing_ball_beyond.inherited.numerics.branch import Branch, ContinuationError
from bouncing_ball_beyond.inherited.numerics.corrector import (
    Problem,
    failure,
    is_exact,
    newton,
    plane,
    satisfies,
    tangent,
)
from bouncing_ball_beyond.inherited.numerics.events import Event
from bouncing_ball_beyond.inherited.numerics.steps import (
    Attempt,
    State,
    StepControl,
    Way,
    WithEvents,
    end_at,
)

# A branch is steep to a plane if the sine of the angle between them is above this.
_STEEP = 0.1
# The planes of a round are normal to one tangent, so that its steps become longer as the branch
# turns. A round ends before a step that is longer than intended by this factor.
_STRETCHED = 1.25


def solve_at(problem: Problem, guess: np.ndarray) -> np.ndarray:
    """The solution with the parameter of the guess, shape (N + 1,).

    Raises
    ------
    ContinuationError
        If Newton's method does not converge from the guess.

    Examples
    --------
    The circle x² + p² = 1 at p = 0.6:

    >>> class Circle:
    ...     def residual(self, y):
    ...         return np.sum(y * y, axis=-1, keepdims=True) - 1
    ...
    ...     def jacobian(self, y):
    ...         return 2 * y[..., np.newaxis, :]
    >>> solve_at(Circle(), np.array([1.0, 0.6])).round(12).tolist()
    [0.8, 0.6]
    """
    if is_exact(problem, guess):
        return guess
    found = newton(problem, guess, plane(np.eye(guess.size)[-1], guess))
    why = failure(problem, found)
    if not why:
        return found.point
    # At a fold the parameter does not select the solution, and next to a grazing rounding errors of
    # the equations are large. There the solution is the guess.
    if satisfies(problem.residual, guess) and np.isfinite(problem.jacobian(guess)).all():
        return guess
    start = np.array2string(guess, precision=4)
    raise ContinuationError(f"no solution near the starting guess {start}: {why}")


RowsOf = Callable[[Any], WithEvents]
"""The equations of some of several branches, by an array of their indices, or of one of them, by
its index."""


def _first_state(tested: WithEvents, start: np.ndarray, towards: np.ndarray) -> State:
    """The corrected start, with the tangent that is at most at a right angle to ``towards``."""
    problem, events = tested
    point = solve_at(problem, np.asarray(start, dtype=float))
    along = tangent(problem.jacobian(point), towards)
    if not np.all(np.isfinite(along)):
        raise ContinuationError(
            f"the start {np.array2string(point, precision=4)} has no direction: the derivatives of "
            "the equations are not defined there"
        )
    values = np.array([float(event.function(point)) for event in events])
    for event, value in zip(events, values, strict=True):
        if event.terminal and value < 0:
            raise ContinuationError(
                f"the start {np.array2string(point, precision=4)} lies beyond the end of the "
                f"branch: {end_at(event)}"
            )
    return State(point, along, np.zeros_like(point), values)


def _attempts(
    tested: WithEvents,
    ways: Sequence[Way],
    plans: Sequence[tuple[np.ndarray, np.ndarray]],
    max_angle: float,
) -> list[list[Attempt]]:
    """Predict and correct the next points of each branch, with its steps and distances."""
    problem, events = tested
    counts = [len(steps) for steps, _ in plans]
    states = [way.states[-1] for way in ways]
    point = np.repeat([state.point for state in states], counts, axis=0)
    along = np.repeat([state.tangent for state in states], counts, axis=0)
    curvature = np.repeat([state.curvature for state in states], counts, axis=0)
    steps = np.concatenate([steps for steps, _ in plans])
    distance = np.concatenate([distances for _, distances in plans])
    predicted, normal, met = _predicted(events, point, along, curvature, distance)
    found = newton(problem, predicted, plane(normal, predicted))
    # A branch whose corrector failed stays where it is.
    reached = np.where(found.converged[:, np.newaxis], found.point, point)
    ahead = tangent(problem.jacobian(reached), along)
    # The point before each one is the row before, except for a first row and for shorter steps.
    first = (steps == distance)[:, np.newaxis]
    before = np.arange(len(reached)) - 1
    chord = reached - np.where(first, point, reached[before])
    behind = np.where(first, along, ahead[before])
    angle = np.maximum(_angle(ahead, behind), _angle(chord, behind))
    stretched = np.linalg.norm(chord, axis=-1) > _STRETCHED * steps
    angle[stretched] = np.inf
    values = np.full((len(reached), len(events)), np.nan)
    if np.any(found.converged & (angle <= max_angle)):
        for k, event in enumerate(events):
            values[:, k] = event.function(reached)
    columns = steps, found.converged, found.residual, found.iterations, angle
    known = (column.tolist() for column in columns)
    rows = zip(reached, ahead, values, *known, met, strict=True)
    return [[Attempt(*row) for row in islice(rows, count)] for count in counts]


def _predicted(
    events: Sequence[Event],
    point: np.ndarray,
    along: np.ndarray,
    curvature: np.ndarray,
    distance: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The predictions at some distances, none of which is beyond a limit, the normals of the planes
    of their correctors, and the limit in whose plane each prediction lies, or None.
    """

    def ahead(which: Any, distance: np.ndarray) -> np.ndarray:
        along_which = along[which] + distance[:, np.newaxis] / 2 * curvature[which]
        return point[which] + distance[:, np.newaxis] * along_which

    predicted = ahead(slice(None), distance)
    normal = along.copy()
    met = np.full(len(point), None)
    for event in events:
        if event.normal is None:
            continue
        here = event.function(point)
        slope = along @ event.normal
        # The square of the slope at the limit. A branch that runs along it is not corrected in it.
        square = slope**2 - 2 * here * (curvature @ event.normal)
        onto = (here > 0) & (event.function(predicted) < 0) & (square > _STEEP**2)
        reached = ahead(onto, 2 * here[onto] / (np.sqrt(square[onto]) - slope[onto]))
        # Rounding would leave the point beyond the limit.
        predicted[onto] = reached - event.function(reached)[:, np.newaxis] * event.normal
        normal[onto] = event.normal
        met[onto] = event
    return predicted, normal, met


def _angle(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """The angles between the rows of two arrays, the second of unit vectors; NaN at a zero."""
    with np.errstate(invalid="ignore"):
        cosine = np.sum(one * other, axis=-1) / np.linalg.norm(one, axis=-1)
    return np.arccos(np.clip(cosine, -1.0, 1.0))


def continue_branches(
    rows_of: RowsOf,
    starts: Sequence[np.ndarray],
    towards: Sequence[np.ndarray],
    control: StepControl = StepControl(),
    max_points: int = 2000,
) -> list[Branch | ContinuationError]:
    """Follow several branches side by side, each from a start in one direction.

    Parameters
    ----------
    rows_of : callable
        The equations and the events of the branches with some indices, whose unknowns have the
        shape (indices, N + 1), and of the branch with one index, whose unknowns have the shape
        (N + 1,).
    starts, towards : sequence of ndarray, shape (N + 1,)
        A solution of each problem, or an approximation to it, and a direction with which the first
        step makes at most a right angle.
    control : StepControl
    max_points : int
        Number of points after which a branch is left unfinished.

    Returns
    -------
    list of Branch or ContinuationError
        The error in place of a branch if there is no solution near its start, if the start lies
        outside the domain, or if the Jacobian is not defined there.
    """
    one = cache(rows_of)
    ways: dict[int, Way] = {}
    errors: dict[int, ContinuationError] = {}
    for k, (start, ahead) in enumerate(zip(starts, towards, strict=True)):
        try:
            first = _first_state(one(k), start, ahead)
            ways[k] = Way([first], control.initial, control.ahead)
        except ContinuationError as error:
            errors[k] = error
    before = None
    while going := [k for k, way in ways.items() if not way.end and len(way.states) < max_points]:
        plans = [ways[k].plan(control) for k in going]
        numbers = [k for k, (steps, _) in zip(going, plans, strict=True) for _ in steps]
        if numbers != before:
            tested = rows_of(np.array(numbers))
            before = numbers
        rounds = _attempts(tested, [ways[k] for k in going], plans, control.max_angle)
        for k, attempts in zip(going, rounds, strict=True):
            left = max_points - len(ways[k].states)
            ways[k].advance(attempts[:left], one(k), control)
    return [errors[k] if k in errors else ways[k].branch() for k in range(len(starts))]


def continue_all_both_ways(
    rows_of: RowsOf,
    starts: Sequence[np.ndarray],
    control: StepControl = StepControl(),
    max_points: int = 2000,
) -> list[Branch | ContinuationError]:
    """Follow several branches through their starts in both directions, each as one branch.

    A branch is oriented such that the parameter increases at its start. Arguments and results are
    those of :func:`continue_branches`.

    Examples
    --------
    The circle x² + p² = 1 turns in p at (0, 1), and with x < 0 an event ends the branch:

    >>> class Circle:
    ...     def residual(self, y):
    ...         return np.sum(y * y, axis=-1, keepdims=True) - 1
    ...
    ...     def jacobian(self, y):
    ...         return 2 * y[..., np.newaxis, :]
    >>> from bouncing_ball_beyond.inherited.numerics.events import Event
    >>> turn = Event("turn", lambda y: y[..., 0])
    >>> end = Event("end", lambda y: y[..., 0] + 0.6, terminal=True)
    >>> tested = WithEvents(Circle(), [turn, end])
    >>> (found,) = continue_all_both_ways(lambda _: tested, [np.array([1.0, 0.0])])
    >>> turns = [special.point for special in found.special if special.name == "turn"]
    >>> np.abs(turns).round(12).tolist()
    [[0.0, 1.0], [0.0, 1.0]]
    >>> found.points[[0, -1]].round(12).tolist()
    [[-0.6, -0.8], [-0.6, 0.8]]
    """
    up = [np.eye(np.size(start))[-1] for start in starts]
    halves = continue_branches(
        lambda which: rows_of(which % len(starts)),
        [*starts, *starts],
        [*(-each for each in up), *up],
        control,
        max_points,
    )
    pairs = zip(halves[: len(starts)], halves[len(starts) :], strict=True)
    return [_whole(back, ahead) for back, ahead in pairs]


def _whole(
    back: Branch | ContinuationError, ahead: Branch | ContinuationError
) -> Branch | ContinuationError:
    """A branch from its two halves, which have the same start."""
    if isinstance(back, ContinuationError):
        return back
    if isinstance(ahead, ContinuationError):
        return ahead
    points = np.concatenate([back.points[::-1], ahead.points[1:]])
    tangents = np.concatenate([-back.tangents[::-1], ahead.tangents[1:]])
    return Branch(points, tangents, back.special[::-1] + ahead.special, back.end, ahead.end)
