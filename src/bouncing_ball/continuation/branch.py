"""Predictor-corrector continuation of a branch, with events."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum, auto
from typing import NamedTuple

import numpy as np

from bouncing_ball.continuation.corrector import NewtonSettings, newton, null_vector, plane, tangent
from bouncing_ball.continuation.events import Event, LocationError, SpecialPoint, locate
from bouncing_ball.continuation.problem import Problem
from bouncing_ball.continuation.step_control import StepControl


class ContinuationError(RuntimeError):
    """No point to start from."""


class Ending(Enum):
    """How a branch can end."""

    START = auto()
    """Where it was started."""
    EVENT = auto()
    """At a terminal event, or where one comes so close that it cannot be located."""
    STEP = auto()
    """Where no step is short enough."""
    POINTS = auto()
    """Unfinished, after as many points as were allowed."""


@dataclass(frozen=True)
class End:
    """An end of a branch: how, and a sentence that says why, as which it prints."""

    kind: Ending
    sentence: str

    def __str__(self) -> str:
        return self.sentence


STARTED = End(Ending.START, "starting point")


@dataclass(frozen=True)
class Branch:
    """Points of a solution branch in order of arclength.

    Parameters
    ----------
    points, tangents : ndarray, shape (m, N + 1)
        y = (x, p) and the unit tangents.
    special : tuple of SpecialPoint
        Located events, in order.
    start, end : End
        Why the branch ends where it does, at either side.
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

    def reversed(self) -> "Branch":
        """The same branch run through the other way."""
        points, tangents, special = self.points[::-1], -self.tangents[::-1], self.special[::-1]
        return Branch(points, tangents, special, start=self.end, end=self.start)

    def named(self, name: str) -> list[np.ndarray]:
        """The points of all located events of one name."""
        return [special.point for special in self.special if special.name == name]


def solve_at(
    problem: Problem, guess: np.ndarray, settings: NewtonSettings = NewtonSettings()
) -> np.ndarray:
    """The solution at the guess's own parameter.

    Raises
    ------
    ContinuationError
        If Newton's method does not converge from the guess.
    """
    axis = np.zeros_like(guess)
    axis[-1] = 1.0
    found = newton(problem, guess, plane(axis, guess), settings)
    if not found.converged:
        raise ContinuationError(
            f"no solution near the starting guess {np.array2string(guess, precision=4)}: "
            f"residual {found.residual:.1e} after {found.iterations} Newton iterations"
        )
    return found.point


class _Step(NamedTuple):
    """A corrected point one step along the branch, and its end if that is one."""

    point: np.ndarray
    direction: np.ndarray
    values: list[float]
    special: list[SpecialPoint]
    next_length: float
    end: End | None = None


class _Rejected(Exception):
    """A step that must be shorter; ``end`` is why the branch ends if it cannot be.

    With a cause, an error that no shorter step has cured, that is raised instead.
    """

    def __init__(self, kind: Ending, sentence: str, cause: Exception | None = None):
        super().__init__(sentence)
        self.end, self.cause = End(kind, sentence), cause


@dataclass(frozen=True)
class _Walk:
    """What stays the same along a branch."""

    problem: Problem
    events: Sequence[Event]
    control: StepControl
    settings: NewtonSettings

    def values(self, point: np.ndarray) -> list[float]:
        return [float(event.function(point)) for event in self.events]

    def step(self, y: np.ndarray, along: np.ndarray, values: list[float], length: float) -> _Step:
        """Predict, correct, and locate the events on the way, up to a terminal one.

        Raises
        ------
        _Rejected
            If the corrector fails, the tangent turns by too much, or an event
            cannot be located.
        """
        predicted, limit = y + length * along, self.control.max_angle
        found = newton(self.problem, predicted, plane(along, predicted), self.settings)
        small = f"step too small ({length:.1e})"
        if not found.converged:
            failed = f"{small}: the corrector fails with residual {found.residual:.1e}"
            raise _Rejected(Ending.STEP, failed)
        direction = tangent(self.problem.jacobian(found.point), along)
        angle = float(np.arccos(np.clip(direction @ along, -1.0, 1.0)))
        if not angle <= limit:
            turns = f"{small}: the tangent turns by more than {limit} rad"
            raise _Rejected(Ending.STEP, turns)
        after = self.values(found.point)
        located = self._locate(y, found.point, values, after, length)
        located.sort(key=lambda pair: float((pair[1].point - y) @ along))
        special = [point for _, point in located]
        for k, (event, point) in enumerate(located):
            if event.terminal:
                at_end = tangent(self.problem.jacobian(point.point), along)
                end = End(Ending.EVENT, event.reason or event.name)
                return _Step(point.point, at_end, after, special[: k + 1], length, end)
        longer = self.control.after_success(length, found.iterations, angle)
        return _Step(found.point, direction, after, special, longer)

    def _locate(self, y, point, before, after, length) -> list[tuple[Event, SpecialPoint]]:
        """The events whose test functions change sign between two points."""
        located, failure = [], None
        for event, left, right in zip(self.events, before, after, strict=True):
            if (left >= 0) != (right >= 0):
                try:
                    located.append((event, locate(self.problem, event, y, point, self.settings)))
                except LocationError as error:
                    failure = event, error
        if failure and not any(event.terminal for event, _ in located):
            # The step may have left the domain in which the event makes sense.
            event, error = failure
            ending = f"{event.reason or event.name} (within {length:.0e})"
            raise _Rejected(Ending.EVENT, ending, None if event.terminal else error)
        return located


def continue_branch(
    problem: Problem,
    start: np.ndarray,
    *,
    increasing: bool,
    events: Sequence[Event] = (),
    control: StepControl = StepControl(),
    settings: NewtonSettings = NewtonSettings(),
    max_points: int = 2000,
) -> Branch:
    """Follow the branch through ``start`` in one direction.

    Parameters
    ----------
    problem : Problem
    start : ndarray, shape (N + 1,)
        A solution, or close to one: it is corrected at its own parameter.
    increasing : bool
        Whether the parameter increases at the start.
    events : sequence of Event
        Those to locate; terminal ones end the branch exactly on their zero.
    control, settings : StepControl, NewtonSettings
    max_points : int
        The branch ends after so many points.

    Returns
    -------
    Branch
        With the reason why it ends.

    Raises
    ------
    ContinuationError
        If there is no solution near ``start``, or it lies outside the domain.
    LocationError
        If an announced event cannot be located, down to the smallest step.
    """
    walk = _Walk(problem, events, control, settings)
    y = solve_at(problem, np.asarray(start, dtype=float), settings)
    direction = null_vector(problem.jacobian(y)) * (1.0 if increasing else -1.0)
    values = walk.values(y)
    for event, value in zip(events, values, strict=True):
        if event.terminal and value < 0:
            raise ContinuationError(
                f"the start {np.array2string(y, precision=4)} lies beyond the end of the branch: "
                f"{event.reason or event.name}"
            )
    points, tangents, special = [y], [direction], []
    length, end = control.initial, End(Ending.POINTS, f"reached the limit of {max_points} points")
    while len(points) < max_points:
        try:
            step = walk.step(y, direction, values, length)
        except _Rejected as rejected:
            shorter = control.after_failure(length)
            if shorter is not None:
                length = shorter
                continue
            if rejected.cause:
                raise rejected.cause from None
            end = rejected.end
            break
        y, direction, values, passed, length, last = step
        points.append(y)
        tangents.append(direction)
        special += passed
        if last:
            end = last
            break
    return Branch(np.array(points), np.array(tangents), tuple(special), STARTED, end)


def continue_both_ways(problem: Problem, start: np.ndarray, **options) -> Branch:
    """Follow the branch through ``start`` to both sides, as one branch.

    The parameter increases at ``start``. Options are those of
    :func:`continue_branch`, but for ``increasing``.
    """
    back = continue_branch(problem, start, increasing=False, **options).reversed()
    ahead = continue_branch(problem, start, increasing=True, **options)
    points = np.concatenate([back.points, ahead.points[1:]])
    tangents = np.concatenate([back.tangents, ahead.tangents[1:]])
    return Branch(points, tangents, back.special + ahead.special, back.start, ahead.end)


# Rounds of equalising the chords between resampled points; each gains two to
# four digits, and the corrector's own rounding is reached after five or six.
_EQUALISING_ROUNDS = 8


def resample(
    problem: Problem, branch: Branch, count: int, settings: NewtonSettings = NewtonSettings()
) -> np.ndarray:
    """Solutions at equal distances along a branch, shape (count, N + 1).

    Cubic Hermite interpolation between the points of the branch predicts, the
    corrector corrects; the first and last points are those of the branch. The
    chords between neighbours are made equal, so that the result is a matter of
    the branch and of ``count``, and not of the step control.

    Raises
    ------
    ContinuationError
        If the corrector fails, on a branch followed with too long steps, or if
        the branch has a single point.
    """
    arc = branch.arclength
    if len(arc) < 2:
        raise ContinuationError(f"a branch of one point has no length: {branch.end}")
    wanted = np.linspace(0.0, arc[-1], count)
    for _ in range(_EQUALISING_ROUNDS):
        points = _interpolated(problem, branch, arc, wanted, settings)
        chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
        if np.ptp(chords) <= settings.tolerance * chords.mean():
            break
        reached = np.concatenate([[0.0], np.cumsum(chords)])
        wanted = np.interp(np.linspace(0.0, reached[-1], count), reached, wanted)
    return points


def _interpolated(problem, branch, arc, wanted, settings) -> np.ndarray:
    """Solutions near given chord lengths from the branch's first point."""
    left = np.clip(np.searchsorted(arc, wanted, side="right") - 1, 0, len(arc) - 2)
    width = (arc[left + 1] - arc[left])[:, np.newaxis]
    t = (wanted[:, np.newaxis] - arc[left][:, np.newaxis]) / width
    rest = 1 - t
    guess = (
        (1 + 2 * t) * rest**2 * branch.points[left]
        + t * rest**2 * width * branch.tangents[left]
        + (1 + 2 * rest) * t**2 * branch.points[left + 1]
        - rest * t**2 * width * branch.tangents[left + 1]
    )
    normal = branch.points[left + 1] - branch.points[left]
    normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    found = newton(problem, guess, plane(normal, guess), settings)
    if not np.all(found.converged):
        raise ContinuationError(
            f"resampling to {len(wanted)} points failed with residual {found.residual.max():.1e}"
        )
    return found.point
