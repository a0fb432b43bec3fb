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
enough, or after a given number of points.

Several branches are followed side by side for the same reason. Each branch has steps of its own and
ends on its own, so that it is the same as if it were followed alone.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import Enum, auto
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.numerics.corrector import (
    NewtonSettings,
    Problem,
    newton,
    plane,
    solution_at,
    tangent,
)
from bouncing_ball.numerics.events import Event, SpecialPoint, changes_of_sign, locate_all

_TINY = np.finfo(float).tiny
# Number of steps after which a branch whose points accumulate ends.
_CREEPING = 16
# The planes of a round are normal to one tangent, so that its steps become longer as the branch
# turns. A round ends before a step that is longer than intended by this factor.
_STRETCHED = 1.25


class ContinuationError(RuntimeError):
    """The continuation finds no solution to start from, or a branch cannot be resampled."""


@dataclass(frozen=True)
class StepControl:
    """Adaptive step in arclength.

    The step grows if the corrector needed fewer iterations than ``target_iterations``, and shrinks
    if it needed more. It is also limited such that the tangent turns by less than ``max_angle``, so
    that folds are resolved and the continuation does not jump to another branch. Within a round of
    ``ahead`` points each step is twice as long as the one before, up to the largest.

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
    ahead : int
        Number of points that are predicted from one state.
    """

    initial: float = 0.02
    smallest: float = 1e-8
    largest: float = 0.2
    target_iterations: int = 3
    max_angle: float = 0.2
    creep: float = 0.0
    ahead: int = 8

    def steps(self, first: np.ndarray) -> np.ndarray:
        """The steps of a round, of the shape of the first steps and ``ahead``.

        Examples
        --------
        >>> StepControl(largest=0.3, ahead=4).steps(np.array(0.1)).tolist()
        [0.1, 0.2, 0.3, 0.3]
        """
        growing = np.asarray(first)[..., np.newaxis] * 2.0 ** np.arange(self.ahead)
        return np.minimum(growing, self.largest)

    def shorter(self, failed: np.ndarray) -> np.ndarray:
        """The steps that are tried in place of those that failed, of their shape and ``ahead``.

        Examples
        --------
        >>> StepControl(smallest=0.03, ahead=4).shorter(np.array(0.2)).tolist()
        [0.1, 0.05, 0.03, 0.03]
        """
        halved = np.asarray(failed)[..., np.newaxis] * 0.5 ** np.arange(1, self.ahead + 1)
        return np.maximum(halved, self.smallest)

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
    point, why = solution_at(problem, guess)
    if why:
        raise ContinuationError(
            f"no solution near the starting guess {np.array2string(guess, precision=4)}: {why}"
        )
    return point


class WithEvents(NamedTuple):
    """The equations of one or several branches, and the events on them."""

    problem: Problem
    events: Sequence[Event]


RowsOf = Callable[[Any], WithEvents]
"""The equations of some of several branches, by an array of their indices, or of one of them, by
its index."""


class _State(NamedTuple):
    """A point of a branch, its unit tangent and the derivative of the tangent along the branch, and
    the values of the test functions at the point.
    """

    point: np.ndarray
    tangent: np.ndarray
    curvature: np.ndarray
    values: np.ndarray


class _Attempt(NamedTuple):
    """A corrected next point of a branch, with the tangent and the values of the test functions.

    ``step`` is the one from the point before. ``angle`` is the larger one of those that the tangent
    and the chord make with the tangent there, NaN if the Jacobian is not defined.
    """

    point: np.ndarray
    tangent: np.ndarray
    values: np.ndarray
    step: float
    converged: bool
    residual: float
    iterations: int
    angle: float


class _Rejected(Exception):
    """A step that must be repeated with a shorter length.

    If the step cannot be shorter, the branch ends, for the reason ``why``. ``finished`` and
    ``kind`` are those of this :class:`End`.
    """

    def __init__(self, why: str, finished: bool = True, kind: EndKind = EndKind.SHORTEST_STEP):
        super().__init__(why)
        self.why = why
        self.finished = finished
        self.kind = kind


@dataclass
class _Followed:
    """A branch that is being followed: its states, its events, its end, and the length of the next
    step, or of the step that ``failed``.
    """

    states: list[_State]
    length: float
    failed: bool = False
    special: list[SpecialPoint] = field(default_factory=list)
    end: End | None = None

    def advance(
        self, attempts: Sequence[_Attempt], tested: WithEvents, control: StepControl
    ) -> None:
        """Accept the next points up to the first step that fails, or the longest one of several
        shorter steps in place of one that failed, or end the branch.
        """
        if self.failed:
            self._retry(attempts, tested, control)
            return
        for number, attempt in enumerate(attempts):
            why = self._refused(attempt, tested, control)
            if why:
                self.failed = number == 0
                return
            # Far points need more iterations because they are far.
            self.length = control.after(attempt.step, attempts[0].iterations, attempt.angle)
            if self.end:
                return

    def _retry(
        self, attempts: Sequence[_Attempt], tested: WithEvents, control: StepControl
    ) -> None:
        """Accept the longest of several steps from the last point, or end the branch."""
        for attempt in attempts:
            why = self._refused(attempt, tested, control)
            if not why:
                self.failed = False
                self.length = control.after(attempt.step, attempt.iterations, attempt.angle)
                return
            self.length = attempt.step
            if self.length <= control.smallest:
                sentence = f"step too small ({self.length:.1e}): {why.why}"
                self.end = End(sentence, why.finished, why.kind)
                return

    def _refused(
        self, attempt: _Attempt, tested: WithEvents, control: StepControl
    ) -> "_Rejected | None":
        """Accept a point, unless it is rejected."""
        try:
            reached, end = self._step(attempt, tested, control.max_angle)
        except _Rejected as rejected:
            return rejected
        self.states.append(reached)
        self.end = end or _creeping(self.states, control.creep)
        return None

    def _step(
        self, attempt: _Attempt, tested: WithEvents, max_angle: float
    ) -> tuple[_State, End | None]:
        """The next state with the events on the way to it, and the end of the branch if the last of
        them is terminal.

        Raises
        ------
        _Rejected
            If the corrector failed, the tangent turns by more than ``max_angle``, or an event
            cannot be located.
        """
        state = self.states[-1]
        if not attempt.converged:
            raise _Rejected(f"the corrector fails with residual {attempt.residual:.1e}")
        if np.isnan(attempt.angle):
            raise _Rejected("the Jacobian is not defined there")
        if not attempt.angle <= max_angle:
            why = f"the tangent turns by more than {max_angle} rad"
            raise _Rejected(why, kind=EndKind.CORNER)
        moved = np.linalg.norm(attempt.point - state.point)
        curvature = (attempt.tangent - state.tangent) / moved
        reached = _State(attempt.point, attempt.tangent, curvature, attempt.values)
        problem, events = tested
        changed = changes_of_sign(events, state.values, attempt.values)
        if not changed:
            return reached, None
        passage = locate_all(problem, changed, state.point, attempt.point)
        if passage.missed is not None:
            # The step may have left the domain in which the test function is defined.
            event = passage.missed
            why = f"{event.name} announced near {state.point} could not be located"
            raise _Rejected(event.reason or why, event.terminal)
        self.special.extend(passage.special)
        if passage.terminal is None:
            return reached, None
        point = passage.special[-1].point
        matrix = problem.jacobian(point)
        # At the end of its domain the derivative may be undefined; the branch keeps its direction.
        defined = np.all(np.isfinite(matrix))
        ahead = tangent(matrix, attempt.tangent) if defined else attempt.tangent
        return _State(point, ahead, curvature, np.empty(0)), _end_at(passage.terminal)

    def branch(self) -> Branch:
        """The branch; without an end it is left unfinished."""
        sentence = f"reached the limit of {len(self.states)} points"
        return Branch(
            points=np.array([state.point for state in self.states]),
            tangents=np.array([state.tangent for state in self.states]),
            special=tuple(self.special),
            start=STARTED,
            end=self.end or End(sentence, finished=False, kind=EndKind.POINTS),
        )


def _end_at(event: Event) -> End:
    return End(event.reason or event.name, event=event.name)


def _creeping(states: Sequence[_State], creep: float) -> End | None:
    """The end of a branch whose last steps lead no farther than ``creep``; None if they do."""
    if len(states) <= _CREEPING:
        return None
    way = float(np.linalg.norm(states[-1].point - states[-1 - _CREEPING].point))
    if way >= creep:
        return None
    return End(f"step too small: {_CREEPING} steps lead {way:.1e}", kind=EndKind.SHORTEST_STEP)


def _first_state(tested: WithEvents, start: np.ndarray, towards: np.ndarray) -> _State:
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
                f"branch: {_end_at(event)}"
            )
    return _State(point, along, np.zeros_like(point), values)


def _attempts(
    tested: WithEvents, ways: Sequence[_Followed], control: StepControl
) -> list[list[_Attempt]]:
    """Predict and correct the next points of each branch, in rows of the same length."""
    problem, events = tested
    count = control.ahead
    states = [way.states[-1] for way in ways]
    point = np.repeat([state.point for state in states], count, axis=0)
    along = np.repeat([state.tangent for state in states], count, axis=0)
    curvature = np.repeat([state.curvature for state in states], count, axis=0)
    failed = np.array([[way.failed] for way in ways])
    length = np.array([way.length for way in ways])
    steps = np.where(failed, control.shorter(length), control.steps(length))
    distance = np.where(failed, steps, np.cumsum(steps, axis=-1)).reshape(-1, 1)
    predicted = point + distance * (along + distance / 2 * curvature)
    found = newton(problem, predicted, plane(along, predicted))
    # A branch whose corrector failed stays where it is.
    reached = np.where(found.converged[:, np.newaxis], found.point, point)
    ahead = tangent(problem.jacobian(reached), along)
    # The point before each one is the row before, except for a first row and for shorter steps.
    first = (failed | (np.arange(count) == 0)).reshape(-1, 1)
    chord = reached - np.where(first, point, np.roll(reached, 1, axis=0))
    behind = np.where(first, along, np.roll(ahead, 1, axis=0))
    angle = np.maximum(_angle(ahead, behind), _angle(chord, behind))
    stretched = np.linalg.norm(chord, axis=-1) > _STRETCHED * steps.ravel()
    angle[stretched] = np.inf
    values = np.full((len(reached), len(events)), np.nan)
    if np.any(found.converged & (angle <= control.max_angle)):
        for k, event in enumerate(events):
            values[:, k] = event.function(reached)
    columns = steps.ravel(), found.converged, found.residual, found.iterations, angle
    rows = zip(reached, ahead, values, *(column.tolist() for column in columns), strict=True)
    attempts = [_Attempt(*row) for row in rows]
    return [attempts[k : k + count] for k in range(0, len(attempts), count)]


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
    ways: dict[int, _Followed] = {}
    errors: dict[int, ContinuationError] = {}
    for k, (start, ahead) in enumerate(zip(starts, towards, strict=True)):
        try:
            ways[k] = _Followed([_first_state(one(k), start, ahead)], control.initial)
        except ContinuationError as error:
            errors[k] = error
    before: list[int] = []
    while going := [k for k, way in ways.items() if not way.end and len(way.states) < max_points]:
        if going != before:
            tested = rows_of(np.repeat(going, control.ahead))
            before = going
        rounds = _attempts(tested, [ways[k] for k in going], control)
        for k, attempts in zip(going, rounds, strict=True):
            left = max_points - len(ways[k].states)
            ways[k].advance(attempts[:left], one(k), control)
    return [errors[k] if k in errors else ways[k].branch() for k in range(len(starts))]


def _branch(found: Branch | ContinuationError) -> Branch:
    """A branch, unless it is an error, which is raised."""
    if isinstance(found, ContinuationError):
        raise found
    return found


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
    tested = WithEvents(problem, events)
    (found,) = continue_branches(lambda _: tested, [start], [towards], control, max_points)
    return _branch(found)


def continue_all_both_ways(
    rows_of: RowsOf,
    starts: Sequence[np.ndarray],
    control: StepControl = StepControl(),
    max_points: int = 2000,
) -> list[Branch | ContinuationError]:
    """Follow several branches through their starts in both directions, each as one branch.

    A branch is oriented such that the parameter increases at its start. Arguments and results are
    those of :func:`continue_branches`.
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


def continue_both_ways(
    problem: Problem,
    start: np.ndarray,
    *,
    events: Sequence[Event] = (),
    control: StepControl = StepControl(),
    max_points: int = 2000,
) -> Branch:
    """Follow the branch through ``start`` in both directions, as one branch.

    The branch is oriented such that the parameter increases at ``start``. Arguments and errors are
    those of :func:`continue_branch`.
    """
    tested = WithEvents(problem, events)
    (found,) = continue_all_both_ways(lambda _: tested, [start], control, max_points)
    return _branch(found)


# Number of rounds that equalise the chords between resampled points.
_EQUALISING_ROUNDS = 10


def _between(
    wanted: np.ndarray, arc: np.ndarray, points: np.ndarray, tangents: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Points and directions at arclengths between those of known points with unit tangents, by
    Hermite's cubic.
    """
    k = np.clip(np.searchsorted(arc, wanted, side="right") - 1, 0, len(arc) - 2)
    width = np.maximum(arc[k + 1] - arc[k], _TINY)[:, np.newaxis]
    s = (wanted - arc[k])[:, np.newaxis] / width
    chord = points[k + 1] - points[k]
    before = width * tangents[k] - chord
    after = width * tangents[k + 1] - chord
    rest = 1 - s
    at = points[k] + s * chord + s * rest * (rest * before - s * after)
    slope = chord + rest * (rest - 2 * s) * before - s * (2 * rest - s) * after
    return at, slope / np.linalg.norm(slope, axis=-1, keepdims=True)


def resample(problem: Problem, branch: Branch, count: int) -> np.ndarray:
    """Solutions at equal distances along a branch, shape (count, N + 1).

    The cubic through the points of the branch with their tangents is the predictor, and Newton's
    method in the plane normal to it is the corrector; the first and last points are those of the
    branch. The same is done again at other arclengths, until the chords between neighbours are
    equal, so that the result depends on the branch and on ``count``, but not on the step control.

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
    points = branch.points
    for _ in range(_EQUALISING_ROUNDS):
        guess, along = _between(wanted, arc, branch.points, branch.tangents)
        found = newton(problem, guess, plane(along, guess))
        if not np.all(found.converged):
            residual = found.residual.max()
            raise ContinuationError(
                f"resampling to {count} points failed with residual {residual:.1e}"
            )
        points = found.point
        chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
        if np.ptp(chords) <= NewtonSettings().tolerance * chords.mean():
            break
        passed = np.concatenate([[0.0], np.cumsum(chords)])
        wanted = np.interp(np.linspace(0.0, passed[-1], count), passed, wanted)
    return points
