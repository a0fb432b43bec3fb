"""The interface between the models of the impact and the simulation: the contacts and flights of
many balls.
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
    """Starts of contact: the table's phase, δ and δ′, and further results of the model."""

    phase: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    known: Any = None

    @classmethod
    def at_level(cls, phase: np.ndarray, velocity: np.ndarray, known: Any = None) -> "Impact":
        """Starts at the table's level, δ = 0."""
        return cls(reduce_angle(phase), np.zeros_like(phase), velocity, known)


class Departure(NamedTuple):
    """Ends of contact: the table's phase, the duration of the contact, the flight that follows and
    the :class:`~bouncing_ball.motion.sequence.Status`.

    ``settling`` is the part of the duration in which the ball still bounces. ``aloft`` is a time
    of flight before which the ball has not landed; it is used if it exceeds
    :meth:`Flight.sure <bouncing_ball.motion.landing.Flight.sure>`. ``by`` has the derivatives of
    the contact's end, if they are computed together with it. ``sticks`` marks the balls that stay
    until the table's downward acceleration exceeds gravity, and is None without derivatives.
    """

    phase: np.ndarray
    duration: np.ndarray
    flight: Flight
    status: np.ndarray
    settling: np.ndarray | float = 0.0
    aloft: np.ndarray | float = 0.0
    by: Any = None
    sticks: Any = None


@dataclass(frozen=True, repr=False)
class Dynamics(Batch, ABC):
    """A law of the impact on a table of amplitude Λ.

    Each model is a subclass, which computes the ends of contacts, and the ends of flights if these
    are not landings. All arrays are one-dimensional with an entry per ball, and ``block`` is the
    largest number of balls computed at the same time.
    """

    law: Any
    amplitude: np.ndarray

    block: ClassVar[int] = BLOCK
    forgets: ClassVar[bool] = False
    """Whether the state in which a ball leaves after sticking is independent of earlier impacts."""

    def start(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        """First impacts, which start at phases φ with δ′ at the table's level."""
        return Impact.at_level(phase, velocity)

    def at_section(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        """The impacts with these states, in the coordinates of :meth:`section`."""
        return self.start(phase, velocity)

    @abstractmethod
    def depart(self, impact: Impact, *, differentiate: bool = False) -> Departure:
        """The ends of the contacts that start with these impacts; with ``differentiate`` also which
        balls stick, and what :meth:`jacobian` needs.
        """

    def fly(self, departure: Departure) -> tuple[Impact, np.ndarray]:
        """The next impact of balls that leave, and the time from the last impact to it.

        Raises
        ------
        ModelError
            If a flight is too long for floating-point numbers.
        """
        landing = land(departure.flight, departure.flight.sure())
        impact = Impact.at_level(departure.phase + landing.time, -landing.rate)
        return impact, departure.duration + landing.time

    @abstractmethod
    def jacobian(
        self, impact: Impact, departure: Departure, after: Impact, passed: np.ndarray
    ) -> Jacobian:
        """Derivative of the map from one impact to the next, in the coordinates of :meth:`section`.

        ``passed`` is the time between the two impacts.
        """

    def section(self, impact: Impact) -> tuple[np.ndarray, np.ndarray]:
        """The state of an impact on the Poincaré section: a phase and a relative velocity."""
        return impact.phase, impact.velocity

    def landed(
        self,
        released: Iterable[Deviation],
        departure: Departure,
        after: Impact,
        passed: np.ndarray,
        lag: np.ndarray | float = 0.0,
    ) -> Jacobian:
        """The derivative whose columns are the two deviations at the release after the flight.

        The flight ends where δ + κ δ′ = 0, with κ = ``lag``.
        """
        flight, end = departure.flight, table(after.phase, self.amplitude)
        time = passed - departure.duration
        columns = (x.flown((flight.x, flight.y), end, time, after.velocity, lag) for x in released)
        return Jacobian.of_columns(*columns)
