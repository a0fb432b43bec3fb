"""A branch of periodic orbits, followed along a parameter from one orbit to a value or an end.

Every branch along one parameter is followed by :func:`branches_through_points`, which is given the
events on it and the range of the parameter. :func:`branch_from` follows any orbit, and whole
branches and searches of n-T orbits are in :mod:`bouncing_ball_beyond.periodic.one_impact`.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np

from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.numerics.branch import Branch, ContinuationError, End, resample
from bouncing_ball_beyond.inherited.numerics.corrector import is_exact, tangent
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.inherited.numerics.events import Event, SpecialPoint
from bouncing_ball_beyond.inherited.numerics.pseudo_arclength import (
    continue_all_both_ways,
    continue_branches,
)
from bouncing_ball_beyond.inherited.numerics.steps import StepControl, WithEvents
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation
from bouncing_ball_beyond.periodic.orbits.balls import LAMBDA, Path
from bouncing_ball_beyond.periodic.orbits.ends import (
    Window,
    events_along,
    flights_vanish,
    limits_of,
    reason_at,
    starts_fold,
    with_explained_ends,
)
from bouncing_ball_beyond.periodic.orbits.halves import halves, turns_apart, turns_of_half, twice
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit, orbit_of_point
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations
from bouncing_ball_beyond.periodic.orbits.short_steps import newton_short, solution_near
from bouncing_ball_beyond.periodic.orbits.special import Coordinates, Degenerate, Special
from bouncing_ball_beyond.periodic.orbits.steps import PATIENT, STEPS, STEPS_OF_DECADES

# A branch is followed up to this distance of the two turns of an orbit before they become equal.
# If there is no period doubling near, it is followed up to a smaller distance, several times.
_NEAR = 0.1
_CLOSER = 0.1
_TRIES = 4
_HALVES = "the two turns of the orbit become nearly equal"
# The duration of a contact is that of the release near the unknown one, of which Newton's method
# finds twelve digits; a release at another time is another one.
_SAME_DURATION = 1e-6
# Without a value at which a branch ends, it ends at this multiple of the first value of the
# parameter, or of 1, if the range of the parameter has no end.
_FARTHEST = 10.0
_KINDS = (*Special, *Degenerate)


def orbits_on(problem: Coordinates, y: np.ndarray, kind: str = "") -> Orbit:
    """The orbits at points y, with phases in [-π, π].

    Where a release is lost, which is a double zero, the duration among the unknowns is the one that
    is known.
    """
    equations = problem.equations
    inner = problem.inner(y)
    found = orbit_of_point(equations, inner, kind)
    if not equations.selects:
        return found
    unknown = equations.durations(inner)
    same = np.abs(found.durations - unknown) <= _SAME_DURATION
    return replace(found, durations=np.where(same, found.durations, unknown))


def unrolled(problem: Coordinates, y: np.ndarray, found: Orbit) -> Orbit:
    """The orbits found at points y, with phases that pass ±π continuously along a branch."""
    equations = problem.equations
    phase, _ = equations.states(problem.inner(y))
    turned = np.round((phase - found.phases) / (2 * np.pi))
    turns = np.broadcast_to(equations.turns, phase.shape)
    return replace(found, phases=found.phases + 2 * np.pi * turned, turns=turns)


@dataclass(frozen=True)
class Followed:
    """Orbits in order, one after another: a branch along one parameter, or a curve of special
    orbits in two.

    ``problem`` gives the unknowns a meaning, and ``branch`` has the points in order and the special
    points; ``branch.end`` gives the reason why the branch ends, in words.
    """

    problem: Coordinates
    branch: Branch

    def __len__(self) -> int:
        return len(self.branch.points)

    def __iter__(self) -> Iterator[Orbit]:
        return (self._one(y) for y in self.branch.points)

    def _one(self, y: np.ndarray, kind: str = "") -> Orbit:
        return orbits_on(self.problem, y, kind)

    @cached_property
    def with_special(self) -> Orbit:
        """The orbits, and after them those at :attr:`special_points`, as one row, because its
        equations cost hardly more than those of a part of it.
        """
        return orbits_on(self.problem, self.points_with_special)

    @property
    def points_with_special(self) -> np.ndarray:
        """The points of the branch, and after them those of the special orbits."""
        return np.stack([*self.branch.points, *(each.point for each in self.special_points)])

    @cached_property
    def special_points(self) -> list[SpecialPoint]:
        """The special points in order along the branch, without the ends that have a point but no
        kind.
        """
        found = [each for each in self.branch.special if each.name in _KINDS]
        _, arclength = places([each.point for each in found], self.branch.points)
        return [found[k] for k in np.argsort(arclength, kind="stable")]

    @property
    def special(self) -> list[Orbit]:
        """The special orbits in order, with their kinds."""
        return [self._one(each.point, each.name) for each in self.special_points]

    def resampled(self, count: int) -> Self:
        """The same orbits at ``count`` points with equal steps of arclength.

        Raises
        ------
        ContinuationError
            If the steps along the branch were too long for it to be resampled.
        """
        y = resample(self.problem, self.branch, count)
        tangents = tangent(self.problem.jacobian(y), np.gradient(y, axis=0))
        return replace(self, branch=replace(self.branch, points=y, tangents=tangents))


def places(special: Sequence[np.ndarray], y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The number of the last point of a branch before each special point, and the arclength up to
    the special point over that of the whole branch.

    A special point lies between the two neighbours to which it makes the smallest detour.

    Examples
    --------
    >>> y = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    >>> before, share = places([np.array([0.5, 0.0]), np.array([1.0, 1.0])], y)
    >>> before.tolist(), share.tolist()
    ([0, 1], [0.25, 1.0])
    """
    if len(y) < 2 or not special:
        return np.zeros(len(special), dtype=int), np.zeros(len(special))
    distance = np.linalg.norm(np.stack(special)[:, np.newaxis] - y, axis=-1)
    step = np.linalg.norm(np.diff(y, axis=0), axis=-1)
    before = np.argmin(distance[:, :-1] + distance[:, 1:] - step, axis=-1)
    row = np.arange(len(special))
    behind = distance[row, before]
    ahead = distance[row, before + 1]
    passed = np.concatenate([[0.0], np.cumsum(step)])
    return before, (passed[before] + step[before] * behind / (behind + ahead)) / passed[-1]


def branches_through_points(
    problem: Coordinates,
    points: Sequence[np.ndarray],
    events: Callable[[OrbitEquations], list[Event]],
    within: Window,
    *,
    towards: Sequence[np.ndarray] = (),
    control: StepControl = STEPS,
    most: int = 2000,
) -> list[Followed | ContinuationError]:
    """The branches through orbits, side by side, each to both sides of its orbit or to one.

    Parameters
    ----------
    problem : Coordinates
        The equations of a row of orbits, one for each branch, or of a single orbit for all of them,
        in the unknowns in whose space the steps are measured.
    points : sequence of ndarray, shape (N + 1,)
        The orbits, or approximations to them.
    events : callable
        The events along a branch of these equations, in their own unknowns.
    within : Window
        The range of the parameter in which the branches are followed.
    towards : sequence of ndarray, shape (N + 1,), optional
        A direction for each branch, which is followed to this side only.
    control : StepControl
    most : int
        Number of points to one side after which a branch is left unfinished.

    Returns
    -------
    list of Followed or ContinuationError
        Each branch with its special orbits and the reasons for its ends, or the error of
        :func:`.continue_branches` in its place.
    """

    def tested(which: Any) -> WithEvents:
        part = problem.take(which)
        equations = part.equations
        tests = [*events(equations), *limits_of(equations, within), *starts_fold(equations)]
        return WithEvents(part, [part.event(each) for each in tests])

    if towards:
        found = continue_branches(tested, points, towards, control, most)
    else:
        found = continue_all_both_ways(tested, points, control, most)
    return [_explained(problem.take(k), branch, within) for k, branch in enumerate(found)]


def _explained(
    problem: Coordinates, branch: Branch | ContinuationError, within: Window
) -> Followed | ContinuationError:
    """A branch with the reasons for its ends, or the error in its place."""
    if isinstance(branch, ContinuationError):
        return branch
    limits = limits_of(problem.equations, within)
    return Followed(problem, with_explained_ends(problem, branch, limits))


def point_near(problem: OrbitEquations, guess: np.ndarray) -> np.ndarray:
    """The point of the orbit at the parameters of an approximate one.

    Raises
    ------
    NoOrbitError
        If Newton's method does not converge.
    """
    if is_exact(problem, guess):
        return guess
    with np.errstate(all="ignore"):
        point, why = solution_near(problem, guess, PATIENT)
    if why:
        k = problem.impacts
        raise NoOrbitError(
            f"no orbit with {k} impact{'s' if k > 1 else ''} was found near this motion: {why}"
        )
    return point


def range_ahead(equations: OrbitEquations, start: np.ndarray, to: float | None) -> Window:
    """The range of the parameter on a branch: up to the value ``to``, and as far beyond the start.

    Without such a value it is the range of the parameter. If this has no largest value, the largest
    one is ten times that at the start, and at least 10.
    """
    (name,) = equations.along
    low, high = equations.balls.bounds(name)
    here = float(equations.values(start)[name])
    if to is not None:
        back = 2 * here - to
        behind = back if back != to else None
        return Window(max(low, min(to, back)), min(high, max(to, back)), behind)
    return Window(low, min(high, _FARTHEST * max(abs(here), 1.0)))


def _in_decades(equations: OrbitEquations, start: np.ndarray) -> bool:
    """Whether the parameter is one of the law, and large."""
    ((name, value),) = equations.values(start).items()
    return name in equations.balls.model.numbers() and bool(value > 1)


def branch_from(
    start: Orbit,
    along: str | Path = LAMBDA,
    to: float | None = None,
    *,
    increasing: bool | None = None,
    towards: np.ndarray | None = None,
    within: Window | None = None,
    control: StepControl | None = None,
    most: int = 2000,
) -> Followed:
    """Follow an orbit along a parameter, up to a value, the end of the branch or of the range.

    Parameters
    ----------
    start : Orbit
        An orbit, or an approximation to one.
    along : str or Path
        The parameter, or a path of parameters.
    to : float, optional
        The value at which the branch ends. The parameter first moves towards it. Behind a
        saddle-node it moves back, at most as far beyond the start as the value is before it.
    increasing : bool, optional
        The direction at the start; by default towards ``to``, and otherwise up.
    towards : ndarray, optional
        The direction at the start as one of the unknowns. At a saddle-node, where the parameter
        stands still, it chooses the side.
    within : Window, optional
        The range of the parameter; by default that of :func:`range_ahead`.
    control : StepControl, optional
        By default :data:`.STEPS`, or :data:`.STEPS_OF_DECADES` along a parameter of the law that is
        above 1 at the start, where arsinh is a logarithm.
    most : int
        Number of points after which the branch is left unfinished.

    Raises
    ------
    NoOrbitError
        If there is no orbit near the start.
    ParameterError
        If the balls have no such parameter.
    """
    equations, guess = equations_of(start, along)
    here = point_near(equations, guess)
    if increasing is None:
        increasing = to is None or bool(to > equations.values(here)[equations.along[0]])
    if towards is None:
        towards = np.eye(here.size)[-1] * (1.0 if increasing else -1.0)
    if within is None:
        within = range_ahead(equations, here, to)
    if control is None:
        control = STEPS_OF_DECADES if _in_decades(equations, here) else STEPS
    near = min(_NEAR, float(turns_apart(equations, here)) / 2)
    with np.errstate(all="ignore"):
        branch = _up_to_equal_turns(
            equations, here, within, near=near, towards=towards, control=control, most=most
        )
        for _ in range(_TRIES):
            if branch.end.event != _HALVES:
                break
            whole = _up_to_halving(equations, branch)
            if whole is not None:
                branch = whole
                break
            near *= _CLOSER
            further = _up_to_equal_turns(
                equations,
                branch.points[-1],
                within,
                near=near,
                towards=branch.tangents[-1],
                control=control,
                most=most - len(branch.points) + 1,
            )
            branch = _joined(branch, further)
        return Followed(equations, branch)


def through_start(back: Branch, ahead: Branch) -> Branch:
    """The branch through an orbit, from the branches to its two sides."""
    return Branch(
        points=np.concatenate([back.points[:0:-1], ahead.points]),
        tangents=np.concatenate([-back.tangents[:0:-1], ahead.tangents]),
        special=back.special[::-1] + ahead.special,
        start=back.end,
        end=ahead.end,
    )


def _joined(branch: Branch, further: Branch) -> Branch:
    """A branch and its continuation from its last point on."""
    return replace(
        branch,
        points=np.concatenate([branch.points, further.points[1:]]),
        tangents=np.concatenate([branch.tangents, further.tangents[1:]]),
        special=(*branch.special, *further.special),
        end=further.end,
    )


def _up_to_equal_turns(
    equations: OrbitEquations,
    start: np.ndarray,
    within: Window,
    *,
    near: float,
    towards: np.ndarray,
    control: StepControl,
    most: int,
) -> Branch:
    """The branch from a solution on, at most up to where its turns are so near to each other."""

    def two_turns(y: np.ndarray) -> np.ndarray:
        return turns_apart(equations, y) - near

    # The first steps must not pass over a place nearby where the turns are equal. If a later step
    # does, the branch is cut off there.
    initial = min(control.initial, near * np.sqrt(2 * equations.impacts) / 2)
    equal_turns = Event(_HALVES, two_turns, terminal=True, reason=_HALVES)
    events = [*events_along(equations), equal_turns, *flights_vanish(equations, start)]
    limits = limits_of(equations, within)
    tested = WithEvents(equations, [*events, *limits, *starts_fold(equations)])
    steps = replace(control, initial=initial)
    (branch,) = continue_branches(lambda _: tested, [start], [towards], steps, most)
    if isinstance(branch, ContinuationError):
        raise NoOrbitError(str(branch))
    return _cut_off(equations, with_explained_ends(equations, branch, limits))


def _cut_off(equations: OrbitEquations, branch: Branch) -> Branch:
    """The branch up to the first step on which the difference of the two turns is reversed."""
    difference = halves(equations, branch.points)
    reversed_at = np.flatnonzero(np.sum(difference[1:] * difference[:-1], axis=-1) < 0)
    if not reversed_at.size:
        return branch
    count = int(reversed_at[0]) + 1
    last = branch.points[count - 1]
    before = [x for x in branch.special if (x.point - last) @ branch.tangents[count - 1] <= 0]
    return replace(
        branch,
        points=branch.points[:count],
        tangents=branch.tangents[:count],
        special=tuple(before),
        end=End(_HALVES, event=_HALVES),
    )


def _up_to_halving(equations: OrbitEquations, branch: Branch) -> Branch | None:
    """The branch up to the period halving, which is a period doubling of the orbit of half the
    period; None if there is none near the end of the branch.

    At the halving the equations have two directions of solutions, so that Newton's method fails.
    """
    k = equations.impacts // 2
    last = branch.points[-1]
    phase, velocity = equations.states(last)
    first = phase[:k]
    turned = np.concatenate([first, first + reduce_angle(phase[k:] - first)])
    turns = turns_of_half(equations.turns, phase)
    half = replace(equations, impacts=k, turns=turns, resumes=equations.resuming[:k])
    rows = (turned, velocity, equations.durations(last))
    means = (row.reshape(2, k).mean(axis=0) for row in rows)
    guess = half.point(*means, **equations.values(last))
    kind = Bifurcation.PERIOD_DOUBLING
    found = newton_short(half, guess, lambda y: half.bifurcation(kind, y), PATIENT)
    if not (found.converged and np.linalg.norm(found.point - guess) < _NEAR):
        return None
    _, halving = twice(half, found.point)
    kind_here = Special.PERIOD_HALVING
    special = SpecialPoint(kind_here, halving)
    along = halving - last
    return Branch(
        points=np.concatenate([branch.points, [halving]]),
        tangents=np.concatenate([branch.tangents, [along / np.linalg.norm(along)]]),
        special=(*branch.special, special),
        start=branch.start,
        end=End(reason_at(kind_here), event=kind_here),
    )
