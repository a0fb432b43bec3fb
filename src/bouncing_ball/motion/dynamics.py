"""The interface of a model of the impact to the simulation: contacts and flights of balls in a
row.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from bouncing_ball.contacts.batch import Batch
from bouncing_ball.motion.angles import reduce_angle, table
from bouncing_ball.motion.ensembles import BLOCK
from bouncing_ball.motion.landing import Flight, land
from bouncing_ball.motion.tangent import Deviation, Jacobian


class Impact(NamedTuple):
    """Starts of contact: table phase, δ and δ′, and further results of the model about them."""

    phase: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    known: Any = None

    @classmethod
    def at_level(cls, phase: np.ndarray, velocity: np.ndarray, known: Any = None) -> "Impact":
        """Starts at the table's level, δ = 0."""
        return cls(reduce_angle(phase), np.zeros_like(phase), velocity, known)


class Departure(NamedTuple):
    """Ends of contact: table phase, the contact's duration, the flight that follows and the
    :class:`~bouncing_ball.motion.sequence.Status`.

    ``settling`` is the part of the duration in which the ball still bounces; ``aloft`` is a time
    of flight before which the ball has not landed, where the model knows a better one than
    :meth:`Flight.sure <bouncing_ball.motion.landing.Flight.sure>`.
    """

    phase: np.ndarray
    duration: np.ndarray
    flight: Flight
    status: np.ndarray
    settling: np.ndarray | float = 0.0
    aloft: np.ndarray | float = 0.0


@dataclass(frozen=True, repr=False)
class Dynamics(Batch, ABC):
    """A law of the impact on a table of amplitude Λ.

    A kind of impact is a subclass that computes the end of a contact, and the end of a flight if
    that is not the landing. All arrays are rows with an entry per ball, and ``block`` is the
    largest number of balls computed at the same time.
    """

    law: Any
    amplitude: np.ndarray

    block: ClassVar[int] = BLOCK
    forgets: ClassVar[bool] = False
    """Whether the state in which a ball leaves after sticking is independent of its past."""

    def start(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        """First impacts at the table's level, at phases φ with δ′."""
        return Impact.at_level(phase, velocity)

    def at_section(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        """The impacts with a state of :meth:`section`."""
        return self.start(phase, velocity)

    @abstractmethod
    def depart(self, impact: Impact) -> Departure:
        """The ends of the contacts that start with these impacts."""

    def fly(self, departure: Departure) -> tuple[Impact, np.ndarray]:
        """The next impact of balls that leave, and the time from the last impact to it.

        Raises
        ------
        ModelError
            If a flight is too long for floating point.
        """
        landing = land(departure.flight, departure.flight.sure())
        impact = Impact.at_level(departure.phase + landing.time, -landing.rate)
        return impact, departure.duration + landing.time

    @abstractmethod
    def jacobian(
        self, impact: Impact, departure: Departure, after: Impact, passed: np.ndarray
    ) -> Jacobian:
        """Derivative of the map from one impact to the next, on the section of :meth:`section`.

        ``passed`` is the time between the two.
        """

    @abstractmethod
    def sticks(self, impact: Impact, departure: Departure) -> np.ndarray:
        """Whether the ball stays on the table until the table recedes with more than gravity."""

    def section(self, impact: Impact) -> tuple[np.ndarray, np.ndarray]:
        """The state (phase, relative velocity) of an impact by which motions are compared."""
        return impact.phase, impact.velocity

    def landed(
        self,
        released: Iterable[Deviation],
        departure: Departure,
        after: Impact,
        passed: np.ndarray,
        lag: np.ndarray | float = 0.0,
    ) -> Jacobian:
        """The derivative whose columns are two deviations at the release, carried over the flight.

        The flight ends where δ + κ δ′ = 0 with the ``lag`` κ.
        """
        flight, end = departure.flight, table(after.phase, self.amplitude)
        time = passed - departure.duration
        columns = (x.flown((flight.x, flight.y), end, time, after.velocity, lag) for x in released)
        return Jacobian.of_columns(*columns)
