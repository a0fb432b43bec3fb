r"""Special orbits on a branch: where the orbit changes its stability, or meets another contact.

Each of them except the last two is a zero of a smooth function along the branch, which is located
together with the equations of the orbit, to the accuracy of Newton's method:

* a saddle-node and a period doubling, where a multiplier is 1 or -1;
* the grazing of a flight: the ball touches the table in flight, at a local minimum of the height δ;
* the grazing of an impact: the ball lands with δ′ = 0, so that this impact appears or disappears;
* the grazing of a release: within a contact the release function y = δ + κ δ′ touches 0, at a local
  maximum, so that the contact opens there;
* a lost release: the rate with which a contact opens falls to 0, so that a flight disappears. It is
  located by :mod:`~bouncing_ball_beyond.periodic.orbits.lost_release`;
* the end of sticking: in the restitution model the ball comes to rest just when the table leaves it
  behind, so that it would no longer stick; in the corrected model it just leaves the table at the
  end of a contact, or just stays on it. It is bisected along the branch to the last digit.

A minimum of δ in flight is unique in each interval in which Λ sin τ > 1, because δ″ = Λ sin τ - 1
is positive there and nowhere else. All minima are therefore found.

Which of them end a branch is said in :mod:`~bouncing_ball_beyond.periodic.orbits.ends`.
"""

from enum import StrEnum
from typing import Any, Protocol, Self

import numpy as np

from bouncing_ball_beyond.inherited import datasets
from bouncing_ball_beyond.inherited.numerics.arrays import pick
from bouncing_ball_beyond.inherited.numerics.corrector import Problem
from bouncing_ball_beyond.inherited.numerics.events import Event
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation
from bouncing_ball_beyond.periodic.orbits.highest import heights_within
from bouncing_ball_beyond.periodic.orbits.legs import rests_as_expected
from bouncing_ball_beyond.periodic.orbits.lost_release import rise_of_release
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations

# The value of a function where there is no minimum or maximum, and thus no event near.
_FAR = 1.0


class Coordinates(Problem, Protocol):
    """The equations of orbits in some unknowns y: those of
    :class:`~bouncing_ball_beyond.periodic.orbits.problem.OrbitEquations`, or those of the paper.
    """

    @property
    def equations(self) -> OrbitEquations:
        """The equations in their own unknowns."""

    def take(self, which: Any) -> Self:
        """The equations of some orbits of a row; those of a single orbit are its own."""

    def inner(self, y: np.ndarray) -> np.ndarray:
        """The unknowns of :attr:`equations` at y."""

    def outer(self, inner: np.ndarray) -> np.ndarray:
        """y at unknowns of :attr:`equations`."""

    def event(self, event: Event) -> Event:
        """An event of :attr:`equations` as a function of y."""


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


class Degenerate(StrEnum):
    """The kinds of points that are special on a curve of special orbits in two parameters."""

    CUSP = "cusp"
    ONE_TO_ONE = "1:1 resonance"
    ONE_TO_TWO = "1:2 resonance"
    GENERALIZED = "generalized period doubling"


MEANINGS = {
    Special.SADDLE_NODE: "a multiplier is 1: two orbits merge",
    Special.PERIOD_DOUBLING: "a multiplier is -1: an orbit of twice the period branches off",
    Special.GRAZING_FLIGHT: "a flight touches the table: beyond it there is one impact more",
    Special.GRAZING_IMPACT: "the ball lands with the speed of the table: an impact disappears",
    Special.GRAZING_RELEASE: "a contact touches its release: beyond it there is one flight more",
    Special.PERIOD_HALVING: "the orbit merges with one of half its period, whose period doubles",
    Special.RELEASE_LOST: "the ball no longer leaves the table as the contact ends",
    Special.STICKING: "the ball just stays on the table after an impact, or just leaves it",
}
"""What each kind of special orbit is."""


def flight_margin(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """The smallest local minimum of δ in flight over the legs of each orbit, of the leading shape
    of y; 1 where there is none.
    """
    return equations.compared(y).legs.lowest[0].min(axis=-1)


def impact_margin(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """The smallest speed of the impacts of each orbit, -v, or v where a contact resumes while the
    ball rises; of the leading shape of y.
    """
    _, velocity = equations.states(y)
    return np.where(equations.resuming, velocity, -velocity).min(axis=-1)


def sticking(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """1 for orbits whose balls come to rest where the equations say so and nowhere else, and -1 for
    others; of the leading shape of y.

    Next to the end of sticking of the restitution model the rest vanishes as a power of the
    distance with an exponent that is no whole number, and infinitely many bounces precede it. No
    function of the state is smooth there, whereas the equations of the orbit are, because the
    lift-off depends on Λ alone. In the corrected model there is a flight or a rest of finite length
    on both sides, and the equations have the one of this orbit beyond the end as well.
    """
    legs = equations.legs(y)
    dynamics = legs.dynamics
    if dynamics is None or not dynamics.forgets:
        return np.ones(y.shape[:-1])
    known = np.flatnonzero(np.isfinite(legs.duration.ravel()))
    alike = np.ones(legs.duration.shape, dtype=bool)
    durations = equations.durations(y).ravel()[known]
    there = dynamics.take(known)
    alike.ravel()[known] = rests_as_expected(there, pick(legs.impact, known), durations)
    return np.where(alike.all(axis=-1), 1.0, -1.0)


def opening_rate(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """The rate δ′ + κ δ″ with which a contact opens relative to the speed of its impact, the
    smallest of each orbit, of the leading shape of y.

    Where it vanishes, a flight disappears. An impact that grazes also has a slow release, but their
    ratio tends to 1.
    """
    legs = equations.legs(y)
    if legs.departure is None:
        return np.full(y.shape[:-1], np.nan)
    _, closing = equations.states(y)
    velocity = rise_of_release(legs).reshape(closing.shape)
    approach = np.where(equations.resuming, closing, -closing)
    with np.errstate(divide="ignore", invalid="ignore"):
        lowest = (velocity / approach).min(axis=-1)
    if not legs.dynamics.forgets:
        return lowest
    # The bounces before a rest on the table become arbitrarily slow.
    rests = legs.departure.sticks.reshape(closing.shape).any(axis=-1)
    return np.where(rests, _FAR, lowest)


def release_margin(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """Minus the largest local maximum of δ + κ δ′ within the contacts of each orbit, of the leading
    shape of y; 1 where there is none, where impacts are instants, and for laws without a κ.
    """
    return -equations.compared(y).tops.height.max(axis=-1)


def release_condition(equations: OrbitEquations, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The margin and its gradient, of the leading shape and of the shape of y.

    Because the derivative with respect to the time vanishes at a maximum, the gradient is that at
    the fixed time of the maximum.
    """
    compared = equations.compared(y, everywhere=True)
    legs = compared.legs
    shape = legs.duration.shape
    tops = compared.tops
    # Only the contact with the largest maximum counts.
    counts = np.arange(equations.impacts) == tops.height.argmax(axis=-1)[..., np.newaxis]
    which = np.flatnonzero(np.broadcast_to(counts, shape))
    time = np.broadcast_to(tops.time, shape).ravel()[which]
    height = np.zeros(shape)
    height.ravel()[which] = heights_within(legs, which, time)
    change = height[2::2] - height[1::2]
    return -tops.height.max(axis=-1), equations.gradient(y, change)


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
