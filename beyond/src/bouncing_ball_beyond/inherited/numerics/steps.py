"""The steps of a branch that is followed: how long they are, and which points are accepted."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.numerics.branch import STARTED, Branch, End, EndKind
from bouncing_ball_beyond.inherited.numerics.corrector import Problem, tangent
from bouncing_ball_beyond.inherited.numerics.events import (
    Event,
    SpecialPoint,
    changes_of_sign,
    locate_all,
)

# Number of steps after which a branch whose points accumulate ends.
_CREEPING = 16
# Number of shorter steps that are tried together.
_TRIED = 4


@dataclass(frozen=True)
class StepControl:
    """Adaptive step in arclength.

    The step grows if the corrector needed fewer iterations than ``target_iterations``, and shrinks
    if it needed more. It is also limited such that the tangent turns by less than ``max_angle``, so
    that folds are resolved and the continuation does not jump to another branch. Within a round
    each step is twice as long as the one before, up to the largest.

    Parameters
    ----------
    initial, smallest, largest : float
        The initial, smallest and largest step in arclength.
    target_iterations : int
        Number of Newton iterations at which the step is unchanged.
    max_angle : float
        Largest angle in radians between the tangents of neighbouring points.
    creep : float
        A branch whose last 16 steps lead no farther than this ends: its points accumulate.
    ahead : int
        The largest number of points that are predicted from one state.
    """

    initial: float = 0.02
    smallest: float = 1e-8
    largest: float = 0.2
    target_iterations: int = 3
    max_angle: float = 0.2
    creep: float = 1e-6
    ahead: int = 8

    def steps(self, first: float, count: int) -> np.ndarray:
        """The steps of a round of so many points.

        Examples
        --------
        >>> StepControl(largest=0.3).steps(0.1, 4).tolist()
        [0.1, 0.2, 0.3, 0.3]
        """
        return np.minimum(first * 2.0 ** np.arange(count), self.largest)

    def shorter(self, failed: float) -> np.ndarray:
        """The steps that are tried in place of one that failed.

        Examples
        --------
        >>> StepControl(smallest=0.03).shorter(0.2).tolist()
        [0.1, 0.05, 0.03, 0.03]
        """
        return np.maximum(failed * 0.5 ** np.arange(1, _TRIED + 1), self.smallest)

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


class WithEvents(NamedTuple):
    """The equations of one or several branches, and the events on them."""

    problem: Problem
    events: Sequence[Event]


class State(NamedTuple):
    """A point of a branch, its unit tangent and the derivative of the tangent along the branch, and
    the values of the test functions at the point.
    """

    point: np.ndarray
    tangent: np.ndarray
    curvature: np.ndarray
    values: np.ndarray


class Attempt(NamedTuple):
    """A corrected next point of a branch, with the tangent and the values of the test functions.

    ``step`` is the one from the point before. ``angle`` is the larger one of those that the tangent
    and the chord make with the tangent there, NaN if the Jacobian is not defined. ``limit`` is the
    event in whose plane the point lies, which ends the branch there, or None.
    """

    point: np.ndarray
    tangent: np.ndarray
    values: np.ndarray
    step: float
    converged: bool
    residual: float
    iterations: int
    angle: float
    limit: Event | None


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
class Way:
    """A branch that is being followed: its states, its events and its end, the ``length`` of the
    next step, or of the step that ``failed``, and the number of points of the next round.
    """

    states: list[State]
    length: float
    ahead: int
    failed: bool = False
    special: list[SpecialPoint] = field(default_factory=list)
    end: End | None = None

    def plan(self, control: StepControl) -> tuple[np.ndarray, np.ndarray]:
        """The steps of the next round, and the distances of its points from the last state."""
        if self.failed:
            steps = control.shorter(self.length)
            return steps, steps
        steps = control.steps(self.length, self.ahead)
        return steps, np.cumsum(steps)

    def advance(
        self, attempts: Sequence[Attempt], tested: WithEvents, control: StepControl
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
                self.ahead = number + 1
                return
            # Far points need more iterations because they are far.
            self.length = control.after(attempt.step, attempts[0].iterations, attempt.angle)
            if self.end:
                return
        self.ahead = min(2 * self.ahead, control.ahead)

    def _retry(self, attempts: Sequence[Attempt], tested: WithEvents, control: StepControl) -> None:
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
        self, attempt: Attempt, tested: WithEvents, control: StepControl
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
        self, attempt: Attempt, tested: WithEvents, max_angle: float
    ) -> tuple[State, End | None]:
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
        reached = State(attempt.point, attempt.tangent, curvature, attempt.values)
        problem, events = tested
        earlier = None
        if len(self.states) > 1:
            before = self.states[-2]
            earlier = before.values, float(np.linalg.norm(state.point - before.point) / moved)
        changes = changes_of_sign(events, state.values, attempt.values, earlier)
        changed = [change for change in changes if change.event is not attempt.limit]
        tangents = state.tangent, attempt.tangent
        passage = locate_all(problem, changed, state.point, attempt.point, tangents)
        if passage.missed is not None:
            # The step may have left the domain in which the test function is defined.
            event = passage.missed
            why = f"{event.name} announced near {state.point} could not be located"
            raise _Rejected(event.reason or why, event.terminal)
        self.special.extend(passage.special)
        if passage.terminal is None:
            if attempt.limit is None:
                return reached, None
            self.special.append(SpecialPoint(attempt.limit.name, attempt.point))
            return reached, end_at(attempt.limit)
        point = passage.special[-1].point
        matrix = problem.jacobian(point)
        # At the end of its domain the derivative may be undefined; the branch keeps its direction.
        defined = np.all(np.isfinite(matrix))
        ahead = tangent(matrix, attempt.tangent) if defined else attempt.tangent
        return State(point, ahead, curvature, np.empty(0)), end_at(passage.terminal)

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


def end_at(event: Event) -> End:
    return End(event.reason or event.name, event=event.name)


def _creeping(states: Sequence[State], creep: float) -> End | None:
    """The end of a branch whose last steps lead no farther than ``creep``; None if they do."""
    if len(states) <= _CREEPING:
        return None
    way = float(np.linalg.norm(states[-1].point - states[-1 - _CREEPING].point))
    if way >= creep:
        return None
    return End(f"step too small: {_CREEPING} steps lead {way:.1e}", kind=EndKind.SHORTEST_STEP)
