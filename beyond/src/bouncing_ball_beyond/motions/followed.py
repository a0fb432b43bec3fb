"""The balls that are followed until their motions are known, and the results stored for each."""

from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.models.flight import table
from bouncing_ball_beyond.models.contacts_and_flights import Impact
from bouncing_ball_beyond.motions.lyapunov import Stretching
from bouncing_ball_beyond.motions.motions import Kind, Motions, Reason
from bouncing_ball_beyond.motions.recurrence import Mark

# The reasons as an array, so that a ball can hold the index of one.
REASONS = np.array(list(Reason))
NO_RECURRENCE = list(Reason).index(Reason.NO_RECURRENCE)
MARGINAL = list(Reason).index(Reason.MARGINAL)
ROUNDING = list(Reason).index(Reason.ROUNDING)


class Sticking(NamedTuple):
    """The last contact at which each ball has forgotten its earlier motion, and the stickings.

    ``impact`` is the number of the impact that began this contact, -1 if there was none, and
    ``time`` the time of the lift-off, which is only known for instantaneous impacts. ``phase`` and
    ``velocity`` are the state of the first of these impacts, from which the later motion follows.
    ``number`` is the number of contacts at which the ball stuck, and ``first_end`` the time at
    which the first of them ended, NaN if there was none.
    """

    impact: np.ndarray
    time: np.ndarray
    phase: np.ndarray
    velocity: np.ndarray
    number: np.ndarray
    first_end: np.ndarray

    @classmethod
    def of(cls, balls: int) -> Self:
        """Balls that have not stuck yet."""
        return cls(
            impact=np.full(balls, -1),
            time=np.zeros(balls),
            phase=np.zeros(balls),
            velocity=np.zeros(balls),
            number=np.zeros(balls, dtype=int),
            first_end=np.full(balls, np.nan),
        )

    def tally(self, sticks: np.ndarray, end: np.ndarray) -> None:
        """Count the contacts at which the balls stick, of those that end at these times."""
        first = sticks & (self.number == 0)
        self.first_end[first] = end[first]
        self.number[:] += sticks

    def store(self, which: np.ndarray, impact: Impact, seen: np.ndarray) -> np.ndarray:
        """Store that some balls forget after this impact; return which do so for the first time."""
        first = which[self.impact[which] < 0]
        self.phase[first] = impact.phase[first]
        self.velocity[first] = impact.velocity[first]
        self.impact[which] = seen[which]
        return first


class Tracked(NamedTuple):
    """The balls that are followed, arrays with an entry per ball."""

    # The place of the ball in the results.
    lane: np.ndarray
    amplitude: np.ndarray
    # The number of impacts, and the time, since the start.
    seen: np.ndarray
    time: np.ndarray
    # The reason for which the motion may stay undecided, as an index into the array of reasons.
    doubt: np.ndarray
    sticking: Sticking
    mark: Mark
    stretch: Stretching

    @classmethod
    def new(cls, lane: np.ndarray, amplitude: np.ndarray, impact: Impact) -> Self:
        """Balls at their first impacts, which are their first marks."""
        return cls(
            lane=lane,
            amplitude=amplitude + np.zeros(lane.size),
            seen=np.zeros(lane.size, dtype=int),
            time=np.zeros(lane.size),
            doubt=np.full(lane.size, NO_RECURRENCE),
            sticking=Sticking.of(lane.size),
            mark=Mark.at(impact),
            stretch=Stretching.of(lane.size),
        )


def concatenated(one: Any, other: Any) -> Any:
    """Join the arrays of two groups of balls; a number applies to all balls and stays a number."""
    if isinstance(one, tuple):
        parts = (concatenated(a, b) for a, b in zip(one, other, strict=True))
        return getattr(one, "_make", tuple)(parts)
    return np.concatenate([one, other]) if isinstance(one, np.ndarray) and one.ndim else one


def store(found: Motions, balls: Tracked, which: np.ndarray, **values: ArrayLike) -> None:
    """Store results of some balls, with the impacts followed, the stickings and the digits lost
    until now.
    """
    found.fill(
        balls.lane[which],
        followed=balls.seen[which],
        followed_time=balls.time[which],
        times_stuck=balls.sticking.number[which],
        first_lift_off=balls.sticking.first_end[which],
        digits_lost=balls.stretch.most[which] / np.log(10),
        **values,
    )


def store_ends(found: Motions, balls: Tracked, impact: Impact, going: np.ndarray) -> None:
    """Store the last impacts of all balls except those that continue."""
    last = np.delete(np.arange(balls.lane.size), going)
    lane = balls.lane[last]
    phase = impact.phase[last]
    relative = impact.velocity[last]
    # The computed lap of a ball that locks on an unknown period is not the true one.
    unresolved = found.is_unresolved()[lane]
    phase = np.where(unresolved, balls.sticking.phase[last], phase)
    relative = np.where(unresolved, balls.sticking.velocity[last], relative)
    phase[found.kind[lane] == Kind.PERMANENT_CONTACT] = np.nan
    velocity = absolute_velocity(phase, relative, balls.amplitude[last])
    found.fill(lane, end_phase=phase, end_velocity=velocity)


def absolute_velocity(phase: np.ndarray, relative: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """z′ of balls with δ′ at phases of the table; NaN where the phase is NaN."""
    return relative + table(phase, amplitude)[0]
