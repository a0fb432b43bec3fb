"""What a model of the impact is to the simulation: the contacts and flights of balls in a row."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from bouncing_ball.contacts.batch import Batch
from bouncing_ball.motion.angles import reduce_angle
from bouncing_ball.motion.ensembles import BLOCK
from bouncing_ball.motion.landing import Flight, land
from bouncing_ball.motion.tangent import Jacobian


class Impact(NamedTuple):
    """Starts of contact: table phase, δ and δ′, and what a model has found out with them."""

    phase: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    known: Any = None

    @classmethod
    def at_level(cls, phase: np.ndarray, velocity: np.ndarray, known: Any = None) -> "Impact":
        """Starts at the table's level, δ = 0."""
        return cls(reduce_angle(phase), np.zeros_like(phase), velocity, known)


class Departure(NamedTuple):
    """Ends of contact: table phase, the contact's duration, the flight from then on and the
    :class:`~bouncing_ball.motion.sequence.Status`.

    ``settling`` is the part of the duration in which the ball still bounces; ``aloft`` is a time
    of flight by which the ball has not landed, where more is known than the flight itself says.
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

    A kind of impact is a subclass that says how a contact ends, and where a flight does if
    that is not simply the landing. ``block`` is how many balls are worked on at once, at most.
    """

    law: Any
    amplitude: np.ndarray

    block: ClassVar[int] = BLOCK
    forgets: ClassVar[bool] = False
    """Whether a ball that sticks leaves in one state, whatever it did before."""

    def start(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        """First impacts at the table's level, at phases φ with δ′."""
        return Impact.at_level(phase, velocity)

    def at_section(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        """The impacts with a state of :meth:`section`."""
        return self.start(phase, velocity)

    @abstractmethod
    def depart(self, impact: Impact) -> Departure:
        """The ends of the contacts that start so."""

    def fly(self, departure: Departure) -> tuple[Impact, np.ndarray]:
        """The next impact of balls that leave, and the time until it from the last."""
        landing = land(departure.flight, departure.flight.sure())
        impact = Impact.at_level(departure.phase + landing.time, -landing.rate)
        return impact, departure.duration + landing.time

    @abstractmethod
    def jacobian(
        self, impact: Impact, departure: Departure, after: Impact, passed: np.ndarray
    ) -> Jacobian:
        """Derivative of the map from one impact to the next on the section of :meth:`section`."""

    @abstractmethod
    def sticks(self, impact: Impact, departure: Departure) -> np.ndarray:
        """Whether the ball stays on the table until that lets it go."""

    def section(self, impact: Impact) -> tuple[np.ndarray, np.ndarray]:
        """The state (phase, relative velocity) of an impact by which motions are compared."""
        return impact.phase, impact.velocity
