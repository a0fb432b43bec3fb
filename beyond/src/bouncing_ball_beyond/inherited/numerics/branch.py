"""A branch of solutions: its points, its ends with their reasons, and equal steps along it."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, auto
from typing import NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.numerics.corrector import NewtonSettings, Problem, newton, plane
from bouncing_ball_beyond.inherited.numerics.events import SpecialPoint, bend

_TINY = np.finfo(float).tiny


class ContinuationError(RuntimeError):
    """The continuation finds no solution to start from, or a branch cannot be resampled."""


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


# Number of rounds that equalise the chords between resampled points.
_EQUALISING_ROUNDS = 10
# Residuals of rounding are of one size at neighbouring points, and may be larger by this factor.
_ROUNDINGS = 10
# The largest size of a last step of Newton's method that rounding alone may cause, half the digits.
_SMALL = 1e-8


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
    at = points[k] + s * chord + bend(s, before, after)
    slope = chord + rest * (rest - 2 * s) * before - s * (2 * rest - s) * after
    return at, slope / np.linalg.norm(slope, axis=-1, keepdims=True)


def resample(
    problem: Problem,
    branch: Branch,
    count: int,
    measured: Callable[[np.ndarray], np.ndarray] = np.asarray,
) -> np.ndarray:
    """Solutions at equal distances along a branch, shape (count, N + 1).

    ``measured`` maps points to the coordinates in which the distances are equal, by default all.

    The cubic through the points of the branch with their tangents is the predictor, and Newton's
    method in the plane normal to it is the corrector; the first and last points are those of the
    branch. The same is done again at other arclengths, until the chords between neighbours are
    equal, so that the result depends on the branch and on ``count``, but not on the step control.
    Next to a singular end rounding moves the last step of Newton's method. A point is then taken if
    it satisfies the equations as well as those of the branch.

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
    satisfied = _ROUNDINGS * np.abs(problem.residual(points)).max()
    for _ in range(_EQUALISING_ROUNDS):
        guess, along = _between(wanted, arc, branch.points, branch.tangents)
        found = newton(problem, guess, plane(along, guess))
        good = found.converged | ((found.step <= _SMALL) & (found.residual <= satisfied))
        if not np.all(good):
            residual = found.residual[~good].max()
            raise ContinuationError(
                f"resampling to {count} points failed with residual {residual:.1e}"
            )
        points = found.point
        chords = np.linalg.norm(np.diff(measured(points), axis=0), axis=1)
        if np.ptp(chords) <= NewtonSettings().tolerance * chords.mean():
            break
        passed = np.concatenate([[0.0], np.cumsum(chords)])
        wanted = np.interp(np.linspace(0.0, passed[-1], count), passed, wanted)
    return points
