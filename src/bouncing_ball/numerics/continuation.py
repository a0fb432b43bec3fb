"""Predictor-corrector continuation of a branch, with events.

A step starts from a state: a point y of the branch, its tangent t with the derivative t′ along the
branch, and the values of the test functions. The predictor is ``y + h t + h² t′/2``, and Newton's
method in the plane normal to t is the corrector; t′ is the difference of the tangents over the last
step. Events within the step are then located, and :class:`StepControl` chooses the next h. A
step is repeated with half its length if the corrector fails, if the tangent turns too much, or if
an event cannot be located. The branch ends at a terminal event, where no step is short enough, or
after a given number of points.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum, auto
from typing import NamedTuple

import numpy as np

from bouncing_ball.numerics.corrector import (
    NewtonSettings,
    Problem,
    corrected,
    newton,
    plane,
    tangent,
)
from bouncing_ball.numerics.events import Event, SpecialPoint, changes_of_sign, locate_all

# Number of steps after which a branch whose points accumulate ends.
_CREEPING = 16


class ContinuationError(RuntimeError):
    """The continuation finds no solution to start from, or a branch cannot be resampled."""


@dataclass(frozen=True)
class StepControl:
    """Adaptive step in arclength.

    The step grows if the corrector needed fewer iterations than ``target_iterations``, and shrinks
    if it needed more. It is also limited such that the tangent turns by less than ``max_angle``, so
    that folds are resolved and the continuation does not jump to another branch.

    Parameters
    ----------
    initial, smallest, largest : float
        The initial, smallest and largest step in arclength.
    target_iterations : int
        Number of Newton iterations at which the step is unchanged.
    max_angle : float
        Largest angle in radians between the tangents of neighbouring points.
    creep : float
        A branch whose last 16 steps lead no farther than this ends; by default it goes on.
    """

    initial: float = 0.02
    smallest: float = 1e-8
    largest: float = 0.2
    target_iterations: int = 3
    max_angle: float = 0.2
    creep: float = 0.0

    def after(self, step: float, iterations: int, angle: float) -> float:
        """The length of the next step after an accepted step.

        Examples
        --------
        >>> StepControl(largest=1.0).after(0.1, iterations=3, angle=0.0)
        0.1
        """
        factor = 2.0 ** ((self.target_iterations - iterations) / 2)
        if angle > 0:
            factor = min(factor, 0.9 * self.max_angle / angle)
        factor = min(max(factor, 0.25), 2.0)
        return min(max(step * factor, self.smallest), self.largest)


class EndKind(Enum):
    """Why a branch has no further point."""

    START = auto()
    EVENT = auto()
    SHORTEST_STEP = auto()
    CORNER = auto()
    POINTS = auto()


class End(NamedTuple):
    """An end of a branch.

    ``sentence`` gives the reason; it is also the text of the object. ``finished`` tells whether the
    branch really ends here. It is false if the allowed number of points was reached, or if a
    non-terminal event could not be located even with the smallest step. ``kind`` is one of a
    starting point, a terminal event, whose name is ``event``, no step that is short enough, a
    tangent that turns by a finite angle in the shortest step, and the allowed number of points.
    """

    sentence: str
    finished: bool = True
    kind: EndKind = EndKind.EVENT
    event: str = ""

    @property
    def stuck(self) -> bool:
        """Whether no step was short enough."""
        return self.kind in (EndKind.SHORTEST_STEP, EndKind.CORNER)

    def __str__(self) -> str:
        return self.sentence


STARTED = End("starting point", kind=EndKind.START)


@dataclass(frozen=True)
class Branch:
    """Points of a solution branch in order of arclength.

    Parameters
    ----------
    points, tangents : ndarray, shape (m, N + 1)
        y = (x, p) and the unit tangents.
    special : tuple of SpecialPoint
        Located events, in order along the branch.
    start, end : End
        The two ends of the branch, with their reasons.
    """

    points: np.ndarray
    tangents: np.ndarray
    special: tuple[SpecialPoint, ...]
    start: End
    end: End

    @property
    def arclength(self) -> np.ndarray:
        """Chord length from the first point, shape (m,)."""
        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])


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
    point, why = corrected(problem, guess)
    if why:
        raise ContinuationError(
            f"no solution near the starting guess {np.array2string(guess, precision=4)}: {why}"
        )
    return point


class _State(NamedTuple):
    """A point of a branch, its unit tangent and the derivative of the tangent along the branch, and
    the values of the test functions at the point.
    """

    point: np.ndarray
    tangent: np.ndarray
    curvature: np.ndarray
    values: list[float]


class _Step(NamedTuple):
    """An accepted step.

    ``reached`` is the state after the step, ``special`` holds the events on the way, and ``end`` is
    the end of the branch if the last of these events is terminal. ``iterations`` is the number of
    iterations of the corrector, and ``angle`` the angle by which the tangent turns.
    """

    reached: _State
    special: tuple[SpecialPoint, ...]
    end: End | None
    iterations: int
    angle: float


class _Rejected(Exception):
    """A step that must be repeated with half its length.

    If the step cannot be shorter, the branch ends, for the reason ``why``. ``finished`` and
    ``kind`` are those of this :class:`End`.
    """

    def __init__(self, why: str, finished: bool = True, kind: EndKind = EndKind.SHORTEST_STEP):
        super().__init__(why)
        self.why = why
        self.finished = finished
        self.kind = kind


def _values(events: Sequence[Event], point: np.ndarray) -> list[float]:
    return [float(event.function(point)) for event in events]


def _end_at(event: Event) -> End:
    return End(event.reason or event.name, event=event.name)


def _first_state(
    problem: Problem, start: np.ndarray, towards: np.ndarray, events: Sequence[Event]
) -> _State:
    """The corrected start, with the tangent that is at most at a right angle to ``towards``."""
    point = solve_at(problem, np.asarray(start, dtype=float))
    along = tangent(problem.jacobian(point), towards)
    if not np.all(np.isfinite(along)):
        raise ContinuationError(
            f"the start {np.array2string(point, precision=4)} has no direction: the derivatives of "
            "the equations are not defined there"
        )
    state = _State(point, along, np.zeros_like(point), _values(events, point))
    for event, value in zip(events, state.values, strict=True):
        if event.terminal and value < 0:
            raise ContinuationError(
                f"the start {np.array2string(point, precision=4)} lies beyond the end of the "
                f"branch: {_end_at(event)}"
            )
    return state


def _step(
    problem: Problem, events: Sequence[Event], state: _State, length: float, max_angle: float
) -> _Step:
    """Predict and correct the next point, and locate the events on the way to it.

    Raises
    ------
    _Rejected
        If the corrector fails, the tangent turns by more than ``max_angle``, or an event cannot be
        located.
    """
    predicted = state.point + length * (state.tangent + length / 2 * state.curvature)
    corrected = newton(problem, predicted, plane(state.tangent, predicted))
    if not corrected.converged:
        raise _Rejected(f"the corrector fails with residual {corrected.residual:.1e}")
    point = corrected.point
    matrix = problem.jacobian(point)
    if not np.all(np.isfinite(matrix)):
        raise _Rejected("the Jacobian is not defined there")
    ahead = tangent(matrix, state.tangent)
    angle = float(np.arccos(np.clip(ahead @ state.tangent, -1.0, 1.0)))
    if not angle <= max_angle:
        raise _Rejected(f"the tangent turns by more than {max_angle} rad", kind=EndKind.CORNER)
    curvature = (ahead - state.tangent) / np.linalg.norm(point - state.point)
    reached = _State(point, ahead, curvature, _values(events, point))
    changed = changes_of_sign(events, state.values, reached.values)
    passage = locate_all(problem, changed, state.point, point)
    if passage.missed is not None:
        # The step may have left the domain in which the test function is defined.
        event = passage.missed
        why = f"{event.name} announced near {state.point} could not be located"
        raise _Rejected(event.reason or why, event.terminal)
    end = None
    if passage.terminal is not None:
        end = _end_at(passage.terminal)
        point = passage.special[-1].point
        matrix = problem.jacobian(point)
        # At the end of its domain the derivative may be undefined; the branch keeps its direction.
        if np.all(np.isfinite(matrix)):
            ahead = tangent(matrix, ahead)
        reached = _State(point, ahead, curvature, [])
    return _Step(reached, passage.special, end, corrected.iterations, angle)


def _creeping(states: Sequence[_State], creep: float) -> End | None:
    """The end of a branch whose last steps lead no farther than ``creep``; None if they do."""
    if len(states) <= _CREEPING:
        return None
    way = float(np.linalg.norm(states[-1].point - states[-1 - _CREEPING].point))
    if way >= creep:
        return None
    return End(f"step too small: {_CREEPING} steps lead {way:.1e}", kind=EndKind.SHORTEST_STEP)


def continue_branch(
    problem: Problem,
    start: np.ndarray,
    *,
    increasing: bool = True,
    towards: np.ndarray | None = None,
    events: Sequence[Event] = (),
    control: StepControl = StepControl(),
    max_points: int = 2000,
) -> Branch:
    """Follow the branch through ``start`` in one direction.

    Parameters
    ----------
    problem : Problem
    start : ndarray, shape (N + 1,)
        A solution or an approximation to it, which is corrected at fixed parameter.
    increasing : bool
        Whether the parameter increases at the start.
    towards : ndarray, shape (N + 1,), optional
        A direction in place of ``increasing``: the first step makes at most a right angle with it.
        At a fold, where the parameter stands still, only this decides.
    events : sequence of Event
        Events to be located; a terminal event ends the branch exactly at its zero.
    control : StepControl
    max_points : int
        Number of points after which the branch is left unfinished.

    Returns
    -------
    Branch
        The branch from ``start`` on, with the reason for its end.

    Raises
    ------
    ContinuationError
        If there is no solution near ``start``, if it lies outside the domain, or if the Jacobian is
        not defined there.

    Examples
    --------
    The circle x² + p² = 1 turns in p at (0, 1):

    >>> class Circle:
    ...     def residual(self, y):
    ...         return np.sum(y * y, axis=-1, keepdims=True) - 1
    ...
    ...     def jacobian(self, y):
    ...         return 2 * y[..., np.newaxis, :]
    >>> turn = Event("turn", lambda y: y[..., 0])
    >>> start = np.array([1.0, 0.0])
    >>> found = continue_branch(Circle(), start, increasing=True, events=[turn], max_points=30)
    >>> [np.abs(special.point.round(12)).tolist() for special in found.special]
    [[0.0, 1.0]]
    """
    if towards is None:
        towards = np.eye(np.size(start))[-1] * (1.0 if increasing else -1.0)
    state = _first_state(problem, start, towards, events)
    states = [state]
    special: list[SpecialPoint] = []
    length = control.initial
    end: End | None = None
    while end is None and len(states) < max_points:
        try:
            step = _step(problem, events, state, length, control.max_angle)
        except _Rejected as rejected:
            if length / 2 < control.smallest:
                sentence = f"step too small ({length:.1e}): {rejected.why}"
                end = End(sentence, rejected.finished, rejected.kind)
            length /= 2
            continue
        state = step.reached
        states.append(state)
        special.extend(step.special)
        end = step.end or _creeping(states, control.creep)
        length = control.after(length, step.iterations, step.angle)
    if end is None:
        sentence = f"reached the limit of {max_points} points"
        end = End(sentence, finished=False, kind=EndKind.POINTS)
    points = np.array([state.point for state in states])
    tangents = np.array([state.tangent for state in states])
    return Branch(points, tangents, tuple(special), STARTED, end)


def continue_both_ways(problem: Problem, start: np.ndarray, **options) -> Branch:
    """Follow the branch through ``start`` in both directions, as one branch.

    The branch is oriented such that the parameter increases at ``start``. Options and errors are
    those of :func:`continue_branch`, except ``increasing``.
    """
    back = continue_branch(problem, start, increasing=False, **options)
    ahead = continue_branch(problem, start, increasing=True, **options)
    points = np.concatenate([back.points[::-1], ahead.points[1:]])
    tangents = np.concatenate([-back.tangents[::-1], ahead.tangents[1:]])
    return Branch(points, tangents, back.special[::-1] + ahead.special, back.end, ahead.end)


# Number of rounds that equalise the chords between resampled points. Each round gains two to
# four digits, and the rounding of the corrector is reached after five or six rounds.
_EQUALISING_ROUNDS = 8


def _interpolated(wanted: np.ndarray, arc: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Rows that are known at the arclengths ``arc``, interpolated linearly at those wanted."""
    return np.stack([np.interp(wanted, arc, column) for column in rows.T], axis=-1)


def resample(problem: Problem, branch: Branch, count: int) -> np.ndarray:
    """Solutions at equal distances along a branch, shape (count, N + 1).

    Linear interpolation between the points of the branch and between their tangents is the
    predictor, and Newton's method in the plane normal to the tangent is the corrector; the first
    and last points are those of the branch. The chords between neighbours are made equal, so that
    the result depends on the branch and on ``count``, but not on the step control.

    Raises
    ------
    ContinuationError
        If the corrector fails, because the steps along the branch are too long, or if
        the branch has a single point.
    """
    arc = branch.arclength
    if len(arc) < 2:
        raise ContinuationError(f"a branch of one point has no length: {branch.end}")
    wanted = np.linspace(0.0, arc[-1], count)
    for _ in range(_EQUALISING_ROUNDS):
        guess = _interpolated(wanted, arc, branch.points)
        along = _interpolated(wanted, arc, branch.tangents)
        found = newton(problem, guess, plane(along, guess))
        if not np.all(found.converged):
            residual = found.residual.max()
            raise ContinuationError(
                f"resampling to {count} points failed with residual {residual:.1e}"
            )
        chords = np.linalg.norm(np.diff(found.point, axis=0), axis=1)
        if np.ptp(chords) <= NewtonSettings().tolerance * chords.mean():
            break
        reached = np.concatenate([[0.0], np.cumsum(chords)])
        wanted = np.interp(np.linspace(0.0, reached[-1], count), reached, wanted)
    return found.point
