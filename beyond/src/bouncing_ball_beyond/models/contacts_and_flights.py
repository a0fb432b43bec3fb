"""What a model says of its contacts and flights, from one impact to the next.

:class:`ContactsAndFlights` is all that a model of the impact defines, in two groups: what a
simulation needs, and what the equations of periodic orbits need beside it. What follows from them,
such as the simulation, is in :mod:`bouncing_ball_beyond.models.dynamics`.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.models.flight import land, table
from bouncing_ball_beyond.inherited.numerics.arrays import Batch
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.inherited.numerics.first_zero import Zero
from bouncing_ball_beyond.models.contact import FiniteContact
from bouncing_ball_beyond.models.deviations import Deviation, Jacobian
from bouncing_ball_beyond.models.flight import Flight


class Level(NamedTuple):
    """The table's velocity w′ = Λ cos φ and height w = Λ sin φ."""

    x: np.ndarray
    y: np.ndarray


class Impact(NamedTuple):
    """Starts of contact: the table's phase, δ and δ′, and further results of the model.

    ``level`` is the table's state at this phase, if it is known. ``resumes`` tells which contacts
    resume below the level of the table, if it is known: an orbit is also computed where δ′ vanishes
    at such a start, and thus δ.
    """

    phase: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    known: Any = None
    level: Level | None = None
    resumes: np.ndarray | None = None

    @classmethod
    def at_level(cls, phase: np.ndarray, velocity: np.ndarray, known: Any = None) -> "Impact":
        """Starts at the table's level, δ = 0."""
        return cls(reduce_angle(phase), np.zeros(phase.shape), velocity, known)

    def resumed(self, lag: np.ndarray) -> "Impact":
        """The impacts at δ = -κ δ′, where the force of the contact is zero; at δ = 0 for κ = 0.

        κ is an array over the impacts, or the number 0.
        """
        if not (lag.ndim and lag.any()):
            return self
        return self._replace(displacement=-lag * self.velocity, resumes=lag != 0)

    @property
    def is_resumption(self) -> np.ndarray:
        """Whether the contacts resume; those with δ < 0 unless it is known."""
        return self.displacement < 0 if self.resumes is None else self.resumes


class DurationSlopes(NamedTuple):
    """The derivatives of the durations of contacts by their states on the section."""

    by_phase: np.ndarray
    by_velocity: np.ndarray


class Departure(NamedTuple):
    """Ends of contact: the table's phase, the duration of the contact, the flight that follows and
    the :class:`~bouncing_ball_beyond.models.sequence.Status`.

    ``settling`` is the part of the duration in which the ball still bounces.
    ``by`` has the derivatives of the contact's end, if they are computed together with it.
    ``sticks`` marks the balls that stay until the table's downward acceleration exceeds gravity;
    it is None without derivatives.
    ``slopes`` are those of the durations, of ends near given durations.
    """

    phase: np.ndarray
    duration: np.ndarray
    flight: Flight
    status: np.ndarray
    settling: np.ndarray | float = 0.0
    by: Any = None
    sticks: Any = None
    slopes: DurationSlopes | None = None


NO_LAG = np.array(0.0)
"""κ of a contact that starts at δ = 0."""


@dataclass(frozen=True)
class Section:
    """The Poincaré section of a model, from which its return map leads to itself: the starts of the
    contacts, with their phases and δ′ as states.

    Flights end on the section, where δ + κ δ′ = 0. At the table's level κ = 0. A contact that
    resumes below this level starts with the κ of its law, where the ball has been released by
    force.

    Parameters
    ----------
    dynamics : ContactsAndFlights
        The model of a row of balls.
    lag : array
        κ of the contacts that resume and 0 for others; the number 0 if there are none.
    """

    dynamics: "ContactsAndFlights"
    lag: np.ndarray

    def impact(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        """The impacts with these states."""
        return self.dynamics.start(phase, velocity).resumed(self.lag)

    def state(self, impact: Impact) -> tuple[np.ndarray, np.ndarray]:
        """The states of impacts: the phase and δ′."""
        return impact.phase, impact.velocity

    def delay(self, impact: Impact) -> np.ndarray:
        """The times from the starts of the contacts to the section, as angles."""
        return np.zeros(impact.phase.shape)

    def gap(self, impact: Impact) -> np.ndarray:
        """δ of the flights that end with these impacts, at the starts of the contacts."""
        return impact.displacement

    def reached(self, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """κ where a flight arrives with δ′, and d(κ δ′)/dδ′."""
        return self.lag, self.lag


@dataclass(frozen=True, repr=False)
class ContactsAndFlights(Batch, ABC):
    """The contacts and flights of a law of the impact on a table of amplitude Λ.

    All arrays are one-dimensional with an entry per ball. A model defines how a contact ends,
    :meth:`depart`, how a flight ends, :meth:`fly`, and the tangent map over both,
    :meth:`jacobian` and :meth:`contraction`. The other members have defaults for impacts at the
    table's level without duration:

    * ``start`` and ``within``, how a contact begins and how the ball moves in it;
    * ``section``, on which the tangent map leads from state to state;
    * ``comes_to_rest``, and ``release_function``, whose first zero is the end of a contact.

    A model that :attr:`continues` has other ends of its contacts than the first ones, those near
    given durations. They depend smoothly on the state also where an earlier end appears. Linear
    contacts have them, and the rests on the table of the instantaneous and of the corrected model.
    """

    law: Any
    amplitude: np.ndarray

    forgets: ClassVar[bool] = False
    """Whether the state in which a ball leaves after sticking is independent of earlier impacts."""
    continues: ClassVar[bool] = False
    """Whether :meth:`depart` can continue a contact or a rest beyond its first end."""

    @property
    def contact(self) -> FiniteContact | None:
        """The law of contacts of finite duration, or None if impacts are instants."""
        return None

    def start(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        """First impacts, which start at phases φ with δ′ at the table's level.

        In the paper they start at τ_i = 0 with z = Λ sin φ (Eq. 21) and z′ = z′_i (Eq. 22), that is
        with δ = 0 and δ′ = z′_i - Λ cos φ.
        """
        return self.with_table(Impact.at_level(phase, velocity))

    def with_table(self, impact: Impact) -> Impact:
        """The impacts with the state of the table, which is used several times."""
        return impact._replace(level=Level(*table(impact.phase, self.amplitude)))

    def table_at(self, impact: Impact) -> tuple[np.ndarray, np.ndarray]:
        """w′ = Λ cos φ and w = Λ sin φ at impacts."""
        return impact.level or table(impact.phase, self.amplitude)

    @abstractmethod
    def depart(
        self, impact: Impact, *, near: np.ndarray | None = None, differentiate: bool = False
    ) -> Departure:
        """The ends of the contacts that start with these impacts; with ``differentiate`` also which
        balls stick, and what :meth:`jacobian` needs.

        With ``near`` they are the ends nearest to these durations, with what :meth:`jacobian`
        needs, and with the slopes of the durations. They are the first ends unless the model
        :attr:`continues` contacts.
        """

    def comes_to_rest(self, impact: Impact) -> np.ndarray:
        """Whether the balls come to rest on the table before it lifts them off again."""
        return self.depart(impact, differentiate=True).sticks

    def within(
        self, impact: Impact, departure: Departure, time: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times 0 ≤ s ≤ D since the starts of contacts, of shape (..., contacts).

        A ball whose impact is an instant rests on the table until it leaves.
        """
        return np.zeros(time.shape), np.zeros(time.shape)

    def fly(self, departure: Departure) -> tuple[Impact, np.ndarray]:
        """The next impact of balls that leave, and the time from the last impact to it.

        Raises
        ------
        ModelError
            If a flight is too long for floating-point numbers.
        """
        flight = departure.flight
        return self.arrive(departure, land(flight, flight.earliest_landing()))

    def arrive(self, departure: Departure, landing: Zero) -> tuple[Impact, np.ndarray]:
        """The next impact after a landing, and the time from the last impact to it."""
        impact = Impact.at_level(departure.phase + landing.time, -landing.rate)
        return self.with_table(impact), departure.duration + landing.time

    def over_flight(
        self,
        released: tuple[Deviation, Deviation],
        departure: Departure,
        after: Impact,
        passed: np.ndarray,
        lag: np.ndarray | float = 0.0,
    ) -> Jacobian:
        """The derivative whose columns are the two deviations at the release after the flight.

        The flight ends where δ + κ δ′ = 0, with κ = ``lag``.
        """
        start = departure.flight.x, departure.flight.y
        end = self.table_at(after)
        time = passed - departure.duration
        both = Deviation.pair(*released)
        return Jacobian.of_columns(both.flown(start, end, time, after.velocity, lag))

    def section(self, lag: np.ndarray = NO_LAG) -> Section:
        """The Poincaré section, where contacts that resume have this κ."""
        return Section(self, lag)

    @abstractmethod
    def jacobian(
        self, impact: Impact, departure: Departure, after: Impact, passed: np.ndarray
    ) -> Jacobian:
        """Derivative of the map from one impact to the next, in states on :meth:`section`.

        ``passed`` is the time between the two impacts.
        """

    @abstractmethod
    def contraction(self, impact: Impact, departure: Departure) -> np.ndarray:
        """The factor by which the contacts multiply areas of the phase plane, which flights keep.

        The determinant of the monodromy of a periodic orbit is the product of these factors.
        Without dissipation it is exactly 1, whereas the rounding errors of the entries of the
        monodromy would decide about stability.
        """

    def release_function(
        self, impact: Impact, departure: Departure
    ) -> Callable[[np.ndarray], np.ndarray] | None:
        """δ + κ δ′ within contacts as a function of the times since their starts, of shape (...,
        contacts), whose first upward zero is the release; None if impacts are instants, and for
        laws without a κ.
        """
        return None
