r"""Special orbits on a branch: where the orbit changes its stability, or meets another contact.

Each event except the last is a zero of a smooth function along the branch, which is located
together with the equations of the orbit, to the accuracy of Newton's method:

* a saddle-node and a period doubling, where a multiplier is 1 or -1;
* the grazing of a flight: the ball touches the table in flight, at a local minimum of the height δ;
* the grazing of an impact: the ball lands with δ′ = 0, so that this impact appears or disappears;
* the grazing of a release: within a contact the release function y = δ + κ δ′ touches 0, at a local
  maximum, so that the contact opens there;
* the end of sticking in the restitution model: the ball comes to rest just when the table leaves it
  behind, so that it would no longer stick. It is bisected along the branch to the last digit.

A minimum of δ in flight is unique in each interval in which Λ sin τ > 1, because δ″ = Λ sin τ - 1
is positive there and nowhere else. All minima are therefore found.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from enum import StrEnum
from typing import Protocol

import numpy as np

from bouncing_ball import datasets
from bouncing_ball.numerics.arrays import pick
from bouncing_ball.numerics.branch import Branch, End
from bouncing_ball.numerics.corrector import Problem
from bouncing_ball.numerics.events import Event, SpecialPoint
from bouncing_ball.periodic.orbits.legs import Legs
from bouncing_ball.periodic.orbits.lost_release import lost_release, rise_of_release
from bouncing_ball.periodic.orbits.problem import OrbitEquations
from bouncing_ball.periodic.orbits.release import release_condition, release_margin
from bouncing_ball.periodic.orbits.stability import Bifurcation

# Rounding errors of 1e-16 are divided by the impact speed and by the flight time where both vanish:
# the margin limits each of them to about 1e-12.
_MARGIN = 1e-4
CLOSE = 1e-2
"""How small the function of an event is where a branch with too short steps ends next to it. Close
to an event the functions are of the order of the square root of the distance."""
# The value of a function where there is no minimum or maximum, and thus no event near.
_FAR = 1.0


class Coordinates(Problem, Protocol):
    """The equations of orbits in some unknowns y: those of
    :class:`~bouncing_ball.periodic.orbits.problem.OrbitEquations`, or those of the paper.
    """

    @property
    def equations(self) -> OrbitEquations:
        """The equations in their own unknowns."""

    def inner(self, y: np.ndarray) -> np.ndarray:
        """The unknowns of :attr:`equations` at y."""

    def outer(self, inner: np.ndarray) -> np.ndarray:
        """y at unknowns of :attr:`equations`."""

    def event(self, event: Event) -> Event:
        """An event of :attr:`equations` as a function of y."""


class LossOfContact(StrEnum):
    """Where an orbit with one impact ceases to exist, besides :attr:`Special.RELEASE_LOST`."""

    IMPACT = "contact lost"
    FLIGHT = "flight lost"


class Special(StrEnum):
    """The kinds of special orbits."""

    SADDLE_NODE = datasets.SADDLE_NODE
    PERIOD_DOUBLING = datasets.PERIOD_DOUBLING
    GRAZING_FLIGHT = datasets.GRAZING_FLIGHT
    GRAZING_IMPACT = "grazing of an impact"
    GRAZING_RELEASE = datasets.GRAZING_RELEASE
    RELEASE_LOST = "release lost"
    STICKING = "end of sticking"
    PERIOD_HALVING = "period halving"


MEANINGS = {
    Special.SADDLE_NODE: "a multiplier is 1: two orbits merge",
    Special.PERIOD_DOUBLING: "a multiplier is -1: an orbit of twice the period branches off",
    Special.GRAZING_FLIGHT: "a flight touches the table: beyond it there is one impact more",
    Special.GRAZING_IMPACT: "the ball lands with the speed of the table: an impact disappears",
    Special.GRAZING_RELEASE: "a contact touches its release: beyond it there is one flight more",
    Special.PERIOD_HALVING: "the orbit merges with one of half its period, whose period doubles",
    Special.RELEASE_LOST: "the ball no longer leaves the table as the contact ends",
    Special.STICKING: "the ball comes to rest as the table leaves it behind",
}
"""What each kind of special orbit is."""
MERGES = "the flight vanishes: the orbit merges with permanent contact"
"""Why a branch of orbits with one impact ends where their contact fills the whole cycle."""


def _reason(kind: Special) -> str:
    """Why a branch ends at a special orbit."""
    return f"{kind}: {MEANINGS[kind]}"


def flight_margin(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """The smallest local minimum of δ in flight over the legs of each orbit, of the leading shape
    of y; 1 where there is none.
    """
    legs = equations.legs(y)
    if legs.departure is None:
        return np.full(y.shape[:-1], np.nan)
    flight = legs.departure.flight
    duration = np.where(np.isfinite(legs.duration.ravel()), legs.departure.duration, np.nan)
    with np.errstate(all="ignore"):
        lowest = flight.lowest(legs.landing.passed - duration)
    return lowest.reshape(legs.duration.shape).min(axis=-1)


def impact_margin(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """The smallest speed of the impacts of each orbit, -v, or v where a contact resumes while the
    ball rises; of the leading shape of y.
    """
    _, velocity = equations.states(y)
    return np.where(equations.resuming, velocity, -velocity).min(axis=-1)


def sticking(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """1 for orbits whose balls come to rest wherever the equations say so, also for those without a
    rest, and -1 for others; of the leading shape of y.

    Next to the end of sticking the rest vanishes as a power of the distance with an exponent that
    is no whole number, and infinitely many bounces precede it. No function of the state is smooth
    there, whereas the equations of the orbit are, because the lift-off depends on Λ alone.
    """
    if not np.any(equations.durations(y) > 0):
        return np.ones(y.shape[:-1])
    legs = equations.legs(y)
    dynamics, inside = equations.dynamics(y)
    if dynamics is None:
        return np.ones(y.shape[:-1])
    rests = np.flatnonzero(inside & (equations.durations(y).ravel() > 0))
    settles = np.ones(inside.shape, dtype=bool)
    settles[rests] = dynamics.take(rests).settles(pick(legs.impact, rests))
    return np.where(settles.reshape(legs.duration.shape).all(axis=-1), 1.0, -1.0)


def _at_point(legs: Legs, values: np.ndarray) -> np.ndarray:
    """Flat values of the legs at y and beside it, for those at y, shape (..., k)."""
    return np.reshape(values, legs.duration.shape)[0]


def loss_of_release(equations: OrbitEquations) -> Event:
    """The rate δ′ + κ δ″ with which a contact opens relative to the speed of its impact, the
    smallest of an orbit.

    Where it vanishes, a flight disappears. The release then is a double zero and its time is not a
    smooth function of the state, so that the place is the end of a branch, which is located by
    :mod:`~bouncing_ball.periodic.orbits.lost_release`. An impact that grazes also has a slow
    release, but their ratio tends to 1.
    """

    def share(y: np.ndarray) -> np.ndarray:
        legs = equations.beside(y)
        if legs.departure is None:
            return np.full(y.shape[:-1], np.nan)
        _, closing = equations.states(y)
        velocity = _at_point(legs, rise_of_release(legs))
        approach = np.where(equations.resuming, closing, -closing)
        with np.errstate(divide="ignore", invalid="ignore"):
            lowest = (velocity / approach).min(axis=-1)
        if not legs.dynamics.forgets:
            return lowest
        # The bounces before a rest on the table become arbitrarily slow.
        rests = _at_point(legs, legs.departure.sticks).any(axis=-1)
        return np.where(rests, _FAR, lowest)

    return Event(Special.RELEASE_LOST, share, terminal=True, reason=_reason(Special.RELEASE_LOST))


def halves(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """The differences of the second half of each orbit to the first: those of the times from half
    the period after an impact to the impact that is k/2 later, and those of the velocities.

    They all vanish for an orbit that repeats after half its period, and change continuously along a
    branch. Their shape is (..., k), with an axis of length 0 if k or m is odd: such orbits do not
    repeat after half their period.
    """
    half, odd = divmod(equations.impacts, 2)
    if odd or np.any(np.asarray(equations.periods) % 2):
        return np.empty((*y.shape[:-1], 0))
    interval = equations.intervals(y)
    begun = np.cumsum(interval, axis=-1) - interval
    of_half = np.pi * np.asarray(equations.periods)[..., np.newaxis]
    later = begun[..., half:] - begun[..., :half] - of_half
    _, velocity = equations.states(y)
    faster = velocity[..., half:] - velocity[..., :half]
    return np.concatenate([later, faster], axis=-1)


def turns_apart(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """The distance of the two halves of each orbit, the root of the mean square over its impacts.

    It vanishes for an orbit that repeats after half its period; 1 where no orbit does.
    """
    apart = halves(equations, y)
    if not apart.shape[-1]:
        return np.full(y.shape[:-1], _FAR)
    return np.sqrt(np.sum(apart**2, axis=-1) * 2 / equations.impacts)


def bifurcations(equations: OrbitEquations) -> list[Event]:
    """The saddle-node and the period doubling."""

    def bifurcation(kind: Bifurcation) -> Event:
        return Event(
            Special(kind),
            lambda y: kind.test(*equations.trace_and_determinant(y)),
            condition=lambda y: equations.bifurcation(kind, y),
        )

    return [bifurcation(kind) for kind in Bifurcation]


def passed_by(equations: OrbitEquations) -> list[Event]:
    """The bifurcations and the grazing orbits beyond which a branch goes on."""
    return [
        *bifurcations(equations),
        Event(Special.GRAZING_FLIGHT, lambda y: flight_margin(equations, y)),
        Event(
            Special.GRAZING_RELEASE,
            lambda y: release_margin(equations, y),
            condition=lambda y: release_condition(equations, y),
        ),
    ]


def events(equations: OrbitEquations) -> Sequence[Event]:
    """The events along a branch, which ends where an impact grazes and where sticking ends."""

    def end(kind: Special, margin) -> Event:
        return Event(kind, lambda y: margin(equations, y), terminal=True, reason=_reason(kind))

    return (
        *passed_by(equations),
        end(Special.GRAZING_IMPACT, impact_margin),
        replace(end(Special.STICKING, sticking), is_sign=True),
    )


def flight_time(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """The shortest flight of each orbit, of the leading shape of y."""
    return (equations.intervals(y) - equations.beside(y).duration[0]).min(axis=-1)


def ends_of_contact(equations: OrbitEquations) -> list[Event]:
    """Where an orbit with one impact ceases to exist: the ball no longer approaches the table at
    impact, it no longer leaves the table at the end of contact, or its flight time vanishes.

    On such a branch an orbit that is not admissible is followed as well, so that it does not end
    where it grazes. The relative impact velocity and the flight time vanish together where an orbit
    merges with permanent contact, and the equations are singular there.
    """

    def end(name: str, why: str, left: Callable[[np.ndarray], np.ndarray]) -> Event:
        return Event(name, left, terminal=True, reason=f"{name}: {why}")

    def released(y: np.ndarray) -> np.ndarray:
        legs = equations.beside(y)
        if legs.departure is None:
            return np.full(y.shape[:-1], np.nan)
        return _at_point(legs, rise_of_release(legs)).min(axis=-1)

    return [
        end(
            LossOfContact.IMPACT,
            "the ball no longer closes in on the table at impact",
            lambda y: impact_margin(equations, y) - _MARGIN,
        ),
        end(Special.RELEASE_LOST, MEANINGS[Special.RELEASE_LOST], released),
        end(
            LossOfContact.FLIGHT,
            "the contact fills the whole cycle",
            lambda y: flight_time(equations, y) - _MARGIN,
        ),
    ]


def next_to(tests: Sequence[Event], y: np.ndarray) -> Event | None:
    """The event next to a point at which the steps of a branch became too short, None if there is
    none: one at which branches end, if one is near.
    """
    near = {k: abs(float(event.function(y))) for k, event in enumerate(tests)}
    close = [k for k, value in near.items() if value < CLOSE]
    if not close:
        return None
    return tests[min(close, key=lambda k: (not tests[k].terminal, near[k]))]


def with_ends(problem: Coordinates, branch: Branch) -> Branch:
    """A branch with its ends of contact where the steps became too short.

    Where the ball no longer leaves the table, the time of the release is not a smooth function of
    the state, so that a branch approaches this end up to the shortest step. The special point is
    found by :mod:`~bouncing_ball.periodic.orbits.lost_release`, or else it is the last point.
    """
    ends = ends_of_contact(problem.equations)
    start, first = _end_near(problem, branch.start, branch.points[0], ends)
    end, last = _end_near(problem, branch.end, branch.points[-1], ends)
    return replace(branch, special=(*first, *branch.special, *last), start=start, end=end)


def _end_near(
    problem: Coordinates, end: End, point: np.ndarray, ends: Sequence[Event]
) -> tuple[End, list[SpecialPoint]]:
    """The end of contact next to a point at which the steps became too short, with its point."""
    if not end.stuck:
        return end, []
    inner = problem.inner(point)
    nearest = next_to(ends, inner)
    if nearest is None:
        return end, []
    place = lost_release(problem.equations, inner) if nearest.name == Special.RELEASE_LOST else None
    there = point if place is None else problem.outer(place)
    return End(nearest.reason, event=nearest.name), [SpecialPoint(nearest.name, there)]
