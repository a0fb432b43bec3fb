r"""The ends of a branch of periodic orbits: where it ends, and the reason in words.

Each kind of end has a test function and a sentence:

* the grazing of an impact, a lost release and the end of sticking are special orbits
  (:mod:`~bouncing_ball_beyond.periodic.orbits.special`);
* where the flight of an orbit with one impact vanishes, the orbit merges with permanent contact, as
  an orbit with a rest does where all of its flights vanish;
* a parameter reaches an end of its range.

A branch also ends where no step is short enough. :func:`explained` says what is there. It is the
same for all unknowns in which orbits are followed.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from bouncing_ball_beyond.inherited.models.flight import table
from bouncing_ball_beyond.inherited.models.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball_beyond.inherited.numerics.branch import Branch, End, EndKind
from bouncing_ball_beyond.inherited.numerics.events import Event, SpecialPoint, limit
from bouncing_ball_beyond.periodic.orbits.domain_limits import DomainLimit
from bouncing_ball_beyond.periodic.orbits.lost_release import lost_release
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations
from bouncing_ball_beyond.periodic.orbits.special import (
    MEANINGS,
    Coordinates,
    Special,
    impact_margin,
    opening_rate,
    passed_by,
    sticking,
)

# The end of a branch of orbits with one impact lies at this speed of the impact or this flight
# time, and not at 0. Where the orbit merges with permanent contact both vanish together, and the
# equations are singular: rounding errors of 1e-16 are divided by both of them, and the margin
# limits each to about 1e-12. Up to 0 such a branch could only be followed with ever shorter steps,
# as :func:`events_along` has it. The grazing of an impact, where a flight remains, is regular.
_MARGIN = 1e-4
# Where starts of contacts fold, rounding errors are divided by what is left.
_FOLD = 1e-2
CLOSE = 1e-2
"""How small the function of an event is where a branch with too short steps ends next to it. Close
to an event the functions are of the order of the square root of the distance."""
# A parameter this close to the end of its range is the reason of too short steps.
_AT_BOUND = 1e-6
# The name of the end of a branch at an end of the range of its parameter.
_BOUND = "bound"
# Next to the threshold of permanent contact the lift-off moves as the root of the distance, so that
# the steps become short at this distance.
_AT_THRESHOLD = 1e-4
# A step must not pass over the last bounce before a rest, and errs by its third power. It is fifty
# times shorter if this bounce is shorter than the first one by this factor.
_SHORTEST = 1e-5
# The speed of an impact is a power of the flight time next to permanent contact. The exponent is at
# most this one, and a straight line over logarithms has the same slope on two pieces, up to a
# tenth. On each of them the speed becomes larger by this factor at least.
_EXPONENT = 3
_STRAIGHT = 0.1
_FASTER = 1.05
# A curve whose points accumulate is continued linearly from these last points, up to this distance.
# The error of the place is of the order of the square of the distance.
_LAST = 17
_AHEAD = 0.2

ENDS = (Special.GRAZING_IMPACT, Special.RELEASE_LOST, Special.STICKING)
"""The special orbits at which a branch ends: an impact, a flight or a rest disappears there."""
MERGES = "the flight vanishes: the orbit merges with permanent contact"
"""Why a branch of orbits with one impact ends where their contact fills the whole cycle."""
ALL_VANISH = "the flights vanish: the orbit merges with permanent contact"
"""Why a branch of orbits with several impacts and a rest ends where the rest fills the cycle."""
_FOLDS = "the start of a contact begins to have two instants, of which the model takes one"
_HELD = "permanent contact: at a smaller Λ a ball at rest stays on the table"
_CORNER = "the branch has a corner, where the map of the model has no derivative"
_PLACES = {kind: f"a {kind}" for kind in Special} | {
    Special.STICKING: "the end of sticking",
    Special.RELEASE_LOST: "a release without speed",
}


class AtMargin(StrEnum):
    """The ends of a branch with one impact at a margin, whose orbits are no special ones yet."""

    IMPACT = "contact lost"
    FLIGHT = "flight lost"


@dataclass(frozen=True)
class Window:
    """The range of a parameter in which a branch or a curve is followed.

    ``behind`` is the end of it that is as far behind the start as the other end, which was asked
    for, is ahead; None if there is none.
    """

    low: float
    high: float
    behind: float | None = None


def reason_at(kind: Special) -> str:
    """Why a branch ends at a special orbit."""
    return f"{kind}: {MEANINGS[kind]}"


def flight_time(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """The shortest flight of each orbit, of the leading shape of y."""
    return (equations.intervals(y) - equations.legs(y).duration).min(axis=-1)


def release_lost(equations: OrbitEquations) -> Event:
    """The end of a branch where a contact no longer opens.

    The release is a double zero there and its time is not a smooth function of the state, so that a
    branch approaches this end up to the shortest step. The place itself is located by
    :mod:`~bouncing_ball_beyond.periodic.orbits.lost_release`.
    """
    return _end(Special.RELEASE_LOST, lambda y: opening_rate(equations, y))


def impact_lost(equations: OrbitEquations) -> Event:
    """The end of a branch or a curve where the ball lands with the speed of the table."""
    return _end(Special.GRAZING_IMPACT, lambda y: impact_margin(equations, y))


def end_of_sticking(equations: OrbitEquations) -> Event:
    """The end of a branch where a ball just stays on the table after an impact, or just leaves."""
    reason = reason_at(Special.STICKING)
    return DomainLimit(Special.STICKING, lambda y: sticking(equations, y), True, reason)


def _end(kind: Special, left: Callable[[np.ndarray], np.ndarray]) -> Event:
    """The end of a branch at a special orbit, where nothing of a quantity is left."""
    return Event(kind, left, terminal=True, reason=reason_at(kind))


def events_along(equations: OrbitEquations) -> list[Event]:
    """The special orbits along any branch: those that it passes by, and those at which it ends."""
    return [
        *passed_by(equations),
        impact_lost(equations),
        end_of_sticking(equations),
        release_lost(equations),
    ]


def ends_of_one_impact(equations: OrbitEquations) -> list[Event]:
    """The ends of a whole branch of orbits with one impact: the impact, the release or the flight
    vanishes, of which the first and the last are met at a margin, or the ball just stays on the
    table.

    On such a branch an orbit that is not admissible is followed as well, so that it does not end
    where it grazes.
    """
    impact = Event(
        AtMargin.IMPACT,
        lambda y: impact_margin(equations, y) - _MARGIN,
        terminal=True,
        reason=reason_at(Special.GRAZING_IMPACT),
    )
    flight = Event(
        AtMargin.FLIGHT,
        lambda y: flight_time(equations, y) - _MARGIN,
        terminal=True,
        reason=MERGES,
    )
    return [impact, release_lost(equations), flight, end_of_sticking(equations)]


def flights_vanish(equations: OrbitEquations, start: np.ndarray) -> list[Event]:
    """The end of a branch of orbits of the restitution models with a rest on the table where the
    rest fills nearly the whole period, or next to the threshold of permanent contact if the last
    bounces are far shorter than the first one; empty for other orbits.

    All flights vanish together there, and the bounces before the rest are so much slower than the
    first one that rounding errors decide on them, before the steps become short.
    """
    legs = equations.compared(start).here
    if equations.impacts == 1 or legs.departure is None or not legs.dynamics.forgets:
        return []
    if not np.any(legs.departure.sticks):
        return []

    def aloft(y: np.ndarray) -> np.ndarray:
        return np.sum(equations.intervals(y) - equations.durations(y), axis=-1)

    def above(y: np.ndarray) -> np.ndarray:
        return _above_threshold(equations, y)

    near = min(CLOSE, float(aloft(start)) / 2)
    vanish = Event(ALL_VANISH, lambda y: aloft(y) - near, terminal=True, reason=ALL_VANISH)
    _, velocity = equations.states(start)
    if above(start) > 0 and velocity.max() > _SHORTEST * velocity.min():
        return [vanish, Event(_HELD, above, terminal=True, reason=_HELD)]
    return [vanish]


def starts_fold(equations: OrbitEquations) -> list[Event]:
    """The end of a branch of the corrected model whose delay depends on the speed, where two
    instants begin to have the same start of contact; empty for other orbits.

    The start at ``φ = ψ - t_c(v)`` determines the instant as long as the determinant of the state
    there by that at the instant, ``1 - t_c′(v) a`` with the load a, is positive.
    """
    lag, slope = equations.balls.model.dynamics(1.0).section().reached(np.array(-1.0))
    if np.all(slope == lag):
        return []

    def left(y: np.ndarray) -> np.ndarray:
        dynamics = equations.legs(y).dynamics
        phase, velocity = equations.states(y)
        if dynamics is None:
            return np.full(y.shape[:-1], np.nan)
        speed = velocity.ravel()
        lag, slope = dynamics.section().reached(speed)
        _, level = table(phase.ravel(), dynamics.amplitude)
        # -t_c′(v), because κ = -t_c(-δ′).
        by_speed = (slope - lag) / speed
        return (1 - by_speed * (1 - level)).reshape(velocity.shape).min(axis=-1) - _FOLD

    return [Event(_FOLDS, left, terminal=True, reason=_FOLDS)]


def bound_in_words(name: str, bound: float) -> str:
    """A parameter at an end of its range.

    Examples
    --------
    >>> bound_in_words("frequency_ratio", 2.0)
    'frequency ratio = 2'
    """
    return f"{name.replace('_', ' ')} = {bound:g}"


def limits_of(equations: OrbitEquations, *ranges: Window) -> list[Event]:
    """The ends of a branch or a curve at the finite ends of the ranges of its parameters."""
    found = []
    for j, (name, within) in enumerate(zip(equations.along, ranges, strict=True)):
        axis = np.eye(equations.size + len(ranges))[equations.size + j]
        for bound, sign in ((within.low, 1.0), (within.high, -1.0)):
            if np.isfinite(bound):
                reason = f"{bound_in_words(name, bound)} is reached"
                if bound == within.behind:
                    reason += ", as far behind the start as the given value is ahead of it"
                at = _coordinate(within, bound, sign)
                found.append(limit(_BOUND, sign * axis, sign * at, reason))
    return found


def _coordinate(within: Window, bound: float, sign: float) -> float:
    """The coordinate of an end of a range, of which rounding does not lead out of the range."""
    at = float(np.arcsinh(bound))
    while not within.low <= np.sinh(at) <= within.high:
        at = float(np.nextafter(at, sign * np.inf))
    return at


def with_explained_ends(
    problem: Coordinates, branch: Branch, limits: Sequence[Event] = ()
) -> Branch:
    """A branch along one parameter with the reasons for its ends, and with the orbits at which a
    release is lost, which the steps approach but do not reach.

    Parameters
    ----------
    problem : Coordinates
        The equations in the unknowns of the branch.
    branch : Branch
    limits : sequence of Event
        The ends of the range of the parameter, in the unknowns of ``problem.equations``.
    """
    if not any(map(_is_unexplained, (branch.start, branch.end))):
        return branch
    tests = events_along(problem.equations)

    def explained_at(end: End, points: np.ndarray) -> tuple[End, list[SpecialPoint]]:
        inner = problem.inner(points)
        found = explained(problem.equations, end, inner, tests, limits)
        if not (end.stuck and found.event == Special.RELEASE_LOST):
            return found, []
        place = lost_release(problem.equations, problem.inner(points[0]))
        if place is None:
            return found, []
        lost = SpecialPoint(Special.RELEASE_LOST, problem.outer(place))
        return End(reason_at(Special.RELEASE_LOST), event=Special.RELEASE_LOST), [lost]

    # The functions of some events divide by what vanishes there.
    with np.errstate(all="ignore"):
        start, first = explained_at(branch.start, branch.points)
        end, last = explained_at(branch.end, branch.points[::-1])
    return replace(branch, special=(*first, *branch.special, *last), start=start, end=end)


def _is_unexplained(end: End) -> bool:
    """Whether no step was short enough at an end, or if it lies at a margin."""
    return end.stuck or end.event in list(AtMargin)


def explained(
    equations: OrbitEquations,
    end: End,
    points: np.ndarray,
    tests: Sequence[Event],
    limits: Sequence[Event] = (),
) -> End:
    """An end of a branch or a curve with its reason, if no step was short enough or if it lies at a
    margin; otherwise the same end.

    Parameters
    ----------
    equations : OrbitEquations
    end : End
    points : ndarray, shape (m, N + parameters)
        The points in order from this end on.
    tests : sequence of Event
        The special orbits that may be near.
    limits : sequence of Event
        The ends of the ranges of the parameters.

    Returns
    -------
    End
        Its ``event`` is the nearest one. It is not finished if an event on the last step could not
        be located; where the flight vanishes, the sentence has this event as well.
    """
    if not _is_unexplained(end):
        return end
    at_margin = end.event in list(AtMargin)
    last = points[0]
    nearest = Special.GRAZING_IMPACT if at_margin else next_to(tests, last)
    if _merges(equations, points, nearest):
        sentence = MERGES if end.finished else f"{MERGES}; {end}"
        return End(sentence, end.finished, event=AtMargin.FLIGHT)
    if at_margin:
        return end
    for each in limits:
        if abs(float(each.function(last))) < _AT_BOUND:
            return End(each.reason)
    if _at_threshold(equations, last):
        return End(_HELD)
    if nearest is None:
        return End(_CORNER) if end.kind is EndKind.CORNER and tests else end
    sentence = f"the orbit is next to {_PLACES[nearest]}, where its equations are not smooth"
    return End(sentence, end.finished, event=nearest)


def _at_threshold(equations: OrbitEquations, y: np.ndarray) -> bool:
    """Whether a ball rests on the table next to the Λ below which it would stay there."""
    legs = equations.legs(y)
    if legs.dynamics is None or not (legs.dynamics.forgets and np.any(legs.departure.sticks)):
        return False
    return bool(_above_threshold(equations, y) < 0)


def _above_threshold(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """Positive where Λ is farther above Λ_CR, the threshold of permanent contact of instantaneous
    impacts, than _AT_THRESHOLD.
    """
    return (equations.amplitude(y) / RESTITUTION_THRESHOLD - 1) / _AT_THRESHOLD - 1


def next_to(tests: Sequence[Event], y: np.ndarray) -> Special | None:
    """The kind of special orbit next to a point at which the steps of a branch became too short,
    None if there is none: one at which branches end, if one is near.
    """
    near = {k: abs(float(event.function(y))) for k, event in enumerate(tests)}
    close = [k for k, value in near.items() if value < CLOSE]
    if not close:
        return None
    return Special(tests[min(close, key=lambda k: (not tests[k].terminal, near[k]))].name)


def _merges(equations: OrbitEquations, points: np.ndarray, nearest: Special | None) -> bool:
    """Whether the flight of an orbit with one impact vanishes at the end of a branch, by the points
    from this end on and the nearest special orbit.

    Where the only flight vanishes, so do the speeds of the impact and of the release. Where a
    release by force is below the level of the table, a ball may return to this level without speed
    after a flight. The speed of the impact is a power of the flight time next to permanent contact,
    with the exponent 1, or 3 without damping. Its logarithm is then a straight line over that of
    the flight time, whereas at the grazing of an impact a flight remains.
    """
    if equations.impacts > 1:
        return False
    if float(flight_time(equations, points[0])) < CLOSE:
        return True
    if nearest is not Special.GRAZING_IMPACT:
        return False
    speed = impact_margin(equations, points)
    rows = [0]
    for row, here in enumerate(speed):
        if here > _FASTER * speed[rows[-1]]:
            rows.append(row)
    if len(rows) < 3 or not speed[0] > 0:
        return False
    flight = flight_time(equations, points[rows[:3]])
    first, second = np.diff(np.log(flight)) / np.diff(np.log(speed[rows[:3]]))
    straight = abs(first - second) < _STRAIGHT * first
    return bool(straight and first > (1 - _STRAIGHT) / _EXPONENT)


def accumulation(
    equations: OrbitEquations, end: End, points: np.ndarray, ranges: dict[str, Window], creep: float
) -> End:
    """An end of a curve in two parameters whose points accumulate, with what lies ahead of it; the
    same end if nothing is found.

    Parameters
    ----------
    equations : OrbitEquations
    end : End
    points : ndarray, shape (m, N + 2)
        The points in order from this end on.
    ranges : mapping
        The ranges of the two parameters by name.
    creep : float
        The distance to which the steps of the curve accumulate.
    """
    last = points[0]
    for (name, within), at in zip(ranges.items(), last[-2:], strict=True):
        for bound in (within.low, within.high):
            if abs(np.arcsinh(bound) - at) < creep:
                shown = bound_in_words(name, bound)
                return End(f"the points accumulate next to {shown}, the end of its range")
    if equations.impacts == 1:
        if _zero_ahead(points, lambda y: flight_time(equations, y)) is not None:
            return End(MERGES)
    place = _zero_ahead(points, lambda y: opening_rate(equations, y))
    if place is None:
        return end
    where = places_in_words(equations, place)
    sentence = (
        f"the orbit is next to {_PLACES[Special.RELEASE_LOST]}, at about {where}, where its "
        "equations are not smooth"
    )
    return End(sentence, event=Special.RELEASE_LOST)


def places_in_words(equations: OrbitEquations, y: np.ndarray) -> str:
    """The parameters of an orbit, such as "amplitude = 1.71, frequency ratio = 3.06"."""
    return ", ".join(
        f"{name.replace('_', ' ')} = {x:.3g}" for name, x in equations.values(y).items()
    )


def _zero_ahead(
    points: np.ndarray, function: Callable[[np.ndarray], np.ndarray]
) -> np.ndarray | None:
    """The point ahead of a curve, whose points are in order from its end on, at which a function
    vanishes if it goes on falling linearly as over the last points; None if there is none near.
    """
    last = points[0]
    before = points[min(_LAST, len(points)) - 1]
    here = float(function(last))
    falls = float(function(before)) - here
    if not (here > 0 and falls > 0):
        return None
    step = here / falls * (last - before)
    return last + step if np.linalg.norm(step) < _AHEAD else None
