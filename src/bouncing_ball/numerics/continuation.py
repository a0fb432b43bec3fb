"""Predictor-corrector continuation of a branch, with events."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bouncing_ball.numerics.corrector import NewtonSettings, Problem, newton, plane, tangent
from bouncing_ball.numerics.events import Event, SpecialPoint, locate


class ContinuationError(RuntimeError):
    """The continuation finds no solution to start from, or a branch cannot be resampled."""


@dataclass(frozen=True)
class StepControl:
    """Adaptive step in arclength.

    The step grows if the corrector needed fewer iterations than
    ``target_iterations``, and shrinks if it needed more. It is also limited such that the
    tangent turns by less than ``max_angle``, so that folds are
    resolved and the continuation does not jump to another branch.

    Parameters
    ----------
    initial, smallest, largest : float
        The initial, smallest and largest step in arclength.
    target_iterations : int
        Number of Newton iterations at which the step is unchanged.
    max_angle : float
        Largest angle in radians between the tangents of neighbouring points.
    """

    initial: float = 0.02
    smallest: float = 1e-8
    largest: float = 0.2
    target_iterations: int = 4
    max_angle: float = 0.2

    def after(self, step: float, iterations: int, angle: float) -> float:
        """The length of the next step after an accepted step.

        Examples
        --------
        >>> StepControl(largest=1.0).after(0.1, iterations=4, angle=0.0)
        0.1
        """
        factor = 2.0 ** ((self.target_iterations - iterations) / 2)
        if angle > 0:
            factor = min(factor, 0.9 * self.max_angle / angle)
        factor = min(max(factor, 0.25), 2.0)
        return min(max(step * factor, self.smallest), self.largest)


class End(NamedTuple):
    """An end of a branch.

    ``sentence`` gives the reason; it is also the text of the object. ``finished`` tells whether the
    branch really ends here. It is false if the allowed number of points was reached, or if a
    non-terminal event could not be located even with the smallest step.
    """

    sentence: str
    finished: bool = True

    def __str__(self) -> str:
        return self.sentence


STARTED = End("starting point")


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
    axis = np.zeros_like(guess)
    axis[-1] = 1.0
    found = newton(problem, guess, plane(axis, guess))
    if not found.converged:
        raise ContinuationError(
            f"no solution near the starting guess {np.array2string(guess, precision=4)}: "
            f"residual {found.residual:.1e} after {found.iterations} Newton iterations"
        )
    return found.point


class _Rejected(Exception):
    """A step that must be repeated with half its length.

    The arguments are those of the :class:`End` of the branch if the step cannot be shorter.
    """


def _located(problem, events, values, left, right):
    """The events within a step, with their points, in order, up to the first terminal event.

    ``values`` holds the values of each test function at both ends of the step; an event is present
    if their signs differ.
    """
    located, failure = [], None
    for event, (before, after) in zip(events, values, strict=True):
        if (before >= 0) != (after >= 0):
            special = locate(problem, event, left, right)
            if special:
                located.append((event, special))
            else:
                why = f"{event.name} announced near {left} could not be located"
                failure = End(event.reason or why, event.terminal)
    located.sort(key=lambda pair: float((pair[1].point - left) @ (right - left)))
    ends = [k for k, (event, _) in enumerate(located) if event.terminal]
    if failure and not ends:
        # The step may have left the domain in which the test function is defined.
        raise _Rejected(*failure)
    return located[: ends[0] + 1] if ends else located


def continue_branch(
    problem: Problem,
    start: np.ndarray,
    *,
    increasing: bool,
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
        If there is no solution near ``start``, or it lies outside the domain.

    Examples
    --------
    The circle x² + p² = 1 turns in p at (0, 1):

    >>> class Circle:
    ...     def residual(self, y):
    ...         return np.sum(y * y, axis=-1, keepdims=True) - 1
    ...
    ...     def jacobian(self, y):
    ...         return 2 * y[..., np.newaxis, :]
    >>> start, turn = np.array([1.0, 0.0]), Event("turn", lambda y: y[..., 0])
    >>> found = continue_branch(Circle(), start, increasing=True, events=[turn], max_points=30)
    >>> [np.abs(special.point.round(12)).tolist() for special in found.special]
    [[0.0, 1.0]]
    """
    y = solve_at(problem, np.asarray(start, dtype=float))
    direction = tangent(problem.jacobian(y), np.eye(y.size)[-1] * (1.0 if increasing else -1.0))
    values = [float(event.function(y)) for event in events]
    for event, value in zip(events, values, strict=True):
        if event.terminal and value < 0:
            raise ContinuationError(
                f"the start {np.array2string(y, precision=4)} lies beyond the end of the branch: "
                f"{event.reason or event.name}"
            )
    points, tangents = [y], [direction]
    special: list[SpecialPoint] = []
    length, end = control.initial, None

    def step() -> tuple[np.ndarray, np.ndarray, list[float], list, float]:
        """Predict and correct a point, and locate the events within the step."""
        predicted = y + length * direction
        found = newton(problem, predicted, plane(direction, predicted))
        if not found.converged:
            raise _Rejected(f"the corrector fails with residual {found.residual:.1e}")
        ahead = tangent(problem.jacobian(found.point), direction)
        angle = float(np.arccos(np.clip(ahead @ direction, -1.0, 1.0)))
        if not angle <= control.max_angle:
            raise _Rejected(f"the tangent turns by more than {control.max_angle} rad")
        after = [float(event.function(found.point)) for event in events]
        both = list(zip(values, after, strict=True))
        passed = _located(problem, events, both, y, found.point)
        return found.point, ahead, after, passed, control.after(length, found.iterations, angle)

    while end is None and len(points) < max_points:
        try:
            y, direction, values, passed, length = step()
        except _Rejected as rejected:
            why, *finished = rejected.args
            end = End(f"step too small ({length:.1e}): {why}", *finished)
            length /= 2
            end = None if length >= control.smallest else end
            continue
        special.extend(where for _, where in passed)
        if passed and passed[-1][0].terminal:
            last, (_, y) = passed[-1]
            direction, end = tangent(problem.jacobian(y), direction), End(last.reason or last.name)
        points.append(y)
        tangents.append(direction)
    end = end or End(f"reached the limit of {max_points} points", finished=False)
    return Branch(np.array(points), np.array(tangents), tuple(special), STARTED, end)


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
    known = np.concatenate([branch.points, branch.tangents], axis=-1)
    wanted = np.linspace(0.0, arc[-1], count)
    for _ in range(_EQUALISING_ROUNDS):
        guess, along = np.split(
            np.stack([np.interp(wanted, arc, x) for x in known.T], axis=-1), 2, axis=-1
        )
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
