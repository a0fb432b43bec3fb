"""Simulated impacts of many balls as arrays, and how the motion of each ball goes on."""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Self

import numpy as np

from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.inherited.numerics.arrays import in_words
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.models.contact import FiniteContact

RECORDED = (
    "time",
    "phase",
    "displacement",
    "relative_velocity",
    "contact_duration",
    "release_displacement",
    "relative_bounce_velocity",
    "settling",
)
"""The arrays of an :class:`ImpactSequence` with a row for each impact, in order."""


class Cycle(NamedTuple):
    """The next impact: its phase in [-π, π], δ′, δ, and the time until it.

    δ = 0 and δ′ ≤ 0, except where a contact resumes at δ < 0 with δ′ > 0. After a contact that
    never ends the state is NaN and the time infinite.
    """

    phase: np.ndarray
    relative_velocity: np.ndarray
    displacement: np.ndarray
    time: np.ndarray


@dataclass(frozen=True, repr=False)
class ImpactSequence:
    """Impacts in order: arrays of shape (impacts, ...), where ... is the shape of the balls.

    An impact is the start of a contact. The rows after a contact that does not end
    are NaN. Everything is dimensionless, and "relative" means relative to
    the table.

    Parameters
    ----------
    amplitude : array
        Λ of each ball.
    contact : FiniteContact or None
        The law of the contacts, or None if impacts are instantaneous.
    time, phase : array
        Time of the impact since the first one, and the table's phase, in [-π, π].
    displacement, relative_velocity : array
        δ and δ′ at the impact. δ = 0, except where a contact that ended by its
        force resumes below the table's level, with δ′ > 0.
    contact_duration : array
        Time until the ball leaves. It is 0 for an impact with a restitution coefficient
        unless the ball sticks, and infinite for permanent contact.
    release_displacement, relative_bounce_velocity : array
        δ and δ′ when the ball leaves.
    status : array of int
        :class:`Status` of each ball.
    settling : array
        The part of ``contact_duration`` in which infinitely many impacts of the restitution
        model are summed up before a ball sticks; 0 for the other models.
    """

    amplitude: np.ndarray
    contact: FiniteContact | None
    time: np.ndarray
    phase: np.ndarray
    displacement: np.ndarray
    relative_velocity: np.ndarray
    contact_duration: np.ndarray
    release_displacement: np.ndarray
    relative_bounce_velocity: np.ndarray
    status: np.ndarray
    settling: np.ndarray

    def __repr__(self) -> str:
        balls = f" of each of {self.status.size} balls" if self.status.ndim else ""
        least = np.min(self.impacts)
        most = np.max(self.impacts)
        count = f"{least}" if least == most else f"{least} to {most}"
        doing = (Status(int(k)).words for k in np.unique(self.status))
        head = f"ImpactSequence: {count} impacts{balls}, then {' or '.join(doing)}"
        names = ("time", "phase", "impact_velocity", "contact_duration", "bounce_velocity")
        values = (f"  {name:<22}{in_words(getattr(self, name))}" for name in names)
        return "\n".join([head, *values])

    def __getitem__(self, balls: Any) -> Self:
        """The impacts of some of the balls, by an index along the first axis of the balls.

        Examples
        --------
        >>> from bouncing_ball_beyond.models.restitution import RestitutionDynamics
        >>> dynamics = RestitutionDynamics.of(1.0, 0.0)
        >>> dynamics.simulate(0.0, [-1.0, -2.0], 2)[1].time.tolist()
        [0.0, 4.0]
        """
        return replace(
            self,
            amplitude=self.amplitude[balls],
            contact=None if self.contact is None else self.contact.take(balls),
            status=self.status[balls],
            **{name: getattr(self, name)[:, balls] for name in RECORDED},
        )

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the balls, without the axis of the impacts."""
        return self.status.shape

    @property
    def impact_velocity(self) -> np.ndarray:
        """Absolute velocity z′_i of the ball at each impact, before it."""
        return self.relative_velocity + self.amplitude * np.cos(self.phase)

    @property
    def release_phase(self) -> np.ndarray:
        """Phase of the table at each release, in [-π, π]; NaN if the contact never ends."""
        finite = np.isfinite(self.contact_duration)
        return reduce_angle(self.phase + np.where(finite, self.contact_duration, np.nan))

    @property
    def bounce_velocity(self) -> np.ndarray:
        """Absolute velocity z′_b of the ball at each release."""
        return self.relative_bounce_velocity + self.amplitude * np.cos(self.release_phase)

    @property
    def impacts(self) -> np.ndarray:
        """Number of recorded impacts of each ball."""
        return np.sum(np.isfinite(self.time), axis=0)
