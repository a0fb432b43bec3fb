"""What a model says of its contacts and flights, from one impact to the next.

:class:`ContactsAndFlights` is all that a model of the impact defines, in two groups: what a
simulation needs, and what the equations of periodic orbits need beside it. What follows from them,
such as the simulation, is in :mod:`bouncing_ball.models.dynamics`.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from bouncing_ball.models.contact import FiniteContact
from bouncing_ball.models.deviations import Deviation, Jacobian
from bouncing_ball.models.flight import land
from bouncing_ball.models.sequence import Status
from bouncing_ball.models.setting import PAPER, Setting
from bouncing_ball.numerics.arrays import Batch
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.numerics.first_zero import Zero, first_zero


class Level(NamedTuple):
    """The table's velocity w′ and height w, in the paper Λ cos φ and Λ sin φ."""

    x: np.ndarray
    y: np.ndarray


class Impact(NamedTuple):
    """Starts of contact: the table's phase, δ and δ′, and further results of the model.

    ``level`` is the table's state at this phase, if it is known.
    """

    phase: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    known: Any = None
    level: Level | None = None

    @classmethod
    def at_level(cls, phase: np.ndarray, velocity: np.ndarray, known: Any = None) -> "Impact":
        """Starts at the table's level, δ = 0."""
        return cls(reduce_angle(phase), np.zeros(phase.shape), velocity, known)


class Departure(NamedTuple):
    """Ends of contact: the table's phase, the duration of the contact, the flight that follows and
    the :class:`~bouncing_ball.models.sequence.Status`.

    ``settling`` is the part of the duration in which the ball still bounces. ``aloft`` is a time of
    flight before which the ball has not landed; it is used if it exceeds
    :meth:`.Flight.earliest_landing`.
    ``by`` has the derivatives of the contact's end, if they are computed together with it.
    ``sticks`` marks the balls that stay until the table's downward acceleration exceeds gravity;
    it is None without derivatives.
    """

    phase: np.ndarray
    duration: np.ndarray
    flight: Any
    status: np.ndarray
    settling: np.ndarray | float = 0.0
    aloft: np.ndarray | float = 0.0
    by: Any = None
    sticks: Any = None

    def with_landings(self, which: np.ndarray, start: np.ndarray) -> "Departure":
        """The departures with the times of the landings of the balls with these indices, and with
        those of their flights marked that never end; before ``start`` the balls have not landed.
        """
        found = first_zero(self.flight.take(which), start)
        status = self.status.copy()
        status[which[found.ended]] = Status.ALOFT
        status[which[found.undecided]] = Status.UNDECIDED
        aloft = np.zeros(status.shape)
        aloft[which] = found.time
        return self._replace(status=status, aloft=aloft)


@dataclass(frozen=True, repr=False)
class ContactsAndFlights(Batch, ABC):
    """The contacts and flights of a law of the impact on a table of amplitude Λ.

    All arrays are one-dimensional with an entry per ball. A model defines ``depart``, ``jacobian``
    and ``contraction``. A simulation also asks for ``start``, ``fly`` and ``within``, of which the
    defaults are those of impacts at the table's level without duration.

    The equations of periodic orbits ask for more (:mod:`bouncing_ball.periodic`), with defaults for
    a model whose impacts begin on the section, at the table's level, and whose contacts are known
    up to their first ends:

    * ``section``, ``at_section``, ``section_lag`` and ``gap_at_start``, if the states of orbits are
      others than those at the starts of contacts. Only the corrected model has them, whose section
      is at the instants.
    * ``depart_after``, ``selects``, ``settles`` and ``duration_slopes``, if the model
      :attr:`continues` a contact or a rest beyond its first end. Then a duration is an unknown of
      an orbit wherever ``selects`` says so, and the orbit changes smoothly also where an earlier
      end appears. Linear contacts have them, and the rests on the table of the instantaneous and
      of the corrected model.
    * ``after``, the motion beyond the end of a contact, and ``release_function``, whose first zero
      is the end, to locate releases that are lost or too early.
    """

    law: Any
    amplitude: np.ndarray
    setting: Setting = PAPER

    forgets: ClassVar[bool] = False
    """Whether the state in which a ball leaves after sticking is independent of earlier impacts."""
    continues: ClassVar[bool] = False
    """Whether :meth:`depart_after` can continue a contact or a rest beyond its first end."""

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
        return impact._replace(level=Level(*self.setting.level(impact.phase, self.amplitude)))

    def table_at(self, impact: Impact) -> tuple[np.ndarray, np.ndarray]:
        """w′ and w at impacts, in the paper Λ cos φ and Λ sin φ."""
        return impact.level or self.setting.level(impact.phase, self.amplitude)

    @abstractmethod
    def depart(self, impact: Impact, *, differentiate: bool = False) -> Departure:
        """The ends of the contacts that start with these impacts; with ``differentiate`` also which
        balls stick, and what :meth:`jacobian` needs.
        """

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
        start = departure.flight.earliest_landing()
        if departure.flight.may_miss:
            start = np.maximum(start, departure.aloft)
        return self.arrive(departure, land(departure.flight, start))

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
        end = self.table_at(after)
        time = passed - departure.duration
        both = Deviation.pair(*released)
        return Jacobian.of_columns(departure.flight.carried(both, end, time, after.velocity, lag))

    def section(self, impact: Impact) -> tuple[np.ndarray, np.ndarray]:
        """The state of an impact on the Poincaré section: a phase and a relative velocity."""
        return impact.phase, impact.velocity

    @abstractmethod
    def jacobian(
        self, impact: Impact, departure: Departure, after: Impact, passed: np.ndarray
    ) -> Jacobian:
        """Derivative of the map from one impact to the next, in the coordinates of :meth:`section`.

        ``passed`` is the time between the two impacts.
        """

    @abstractmethod
    def contraction(self, impact: Impact, departure: Departure) -> np.ndarray:
        """The factor by which the contacts multiply areas of the phase plane. Free flights keep
        them, and others multiply them by :meth:`.Setting.contraction`.

        The determinant of the monodromy of a periodic orbit is the product of these factors.
        Without dissipation it is exactly 1, whereas the rounding errors of the entries of the
        monodromy would decide about stability.
        """

    @property
    def clock(self) -> Any:
        """Frequency of the contacts over that of the table, 1 for instants. Durations of contacts
        times the clock are of order one.
        """
        return 1.0

    # For periodic orbits only.

    def at_section(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        """The impacts with these states, in the coordinates of :meth:`section`."""
        return self.start(phase, velocity)

    def section_lag(self, velocity: np.ndarray) -> tuple[np.ndarray | float, np.ndarray | float]:
        """κ of the section, where flights have δ + κ δ′ = 0 if they arrive with δ′, and
        d(κ δ′)/dδ′; both are 0 if the section is the table's level.
        """
        return 0.0, 0.0

    def gap_at_start(self, impact: Impact) -> np.ndarray:
        """δ of the flight that ends with each impact, at the start of the contact."""
        return impact.displacement

    def depart_after(self, impact: Impact, duration: np.ndarray) -> Departure:
        """The ends of the contacts nearest to given durations, with their derivatives.

        They are the first ends, as in :meth:`depart`, unless the model :attr:`continues` contacts.
        """
        return self.depart(impact, differentiate=True)

    def selects(self, impact: Impact, duration: np.ndarray) -> bool:
        """Whether :meth:`depart_after` must be told these durations of contacts, because their
        ends, or their rests on the table, follow from them.
        """
        return self.continues and bool(np.any(duration > 0))

    def settles(self, impact: Impact, duration: np.ndarray) -> np.ndarray:
        """Whether balls rest on the table after these impacts where :meth:`depart_after` says so
        for these durations, and nowhere else; always, if there is no rest.
        """
        return np.ones(impact.phase.shape, dtype=bool)

    def duration_slopes(
        self, impact: Impact, departure: Departure
    ) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of the durations of contacts with respect to φ and δ′ at their starts.

        They are needed only where the model :attr:`continues` contacts.
        """
        raise NotImplementedError(f"{type(self).__name__} does not continue its contacts")

    def after(self, impact: Impact, duration: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ a time after the starts of contacts, whether they have ended or not.

        They are needed only of linear contacts, whose motion goes on beyond its end.
        """
        raise NotImplementedError(f"{type(self).__name__} does not continue its contacts")

    def release_function(
        self, impact: Impact, departure: Departure
    ) -> Callable[[np.ndarray], np.ndarray] | None:
        """δ + κ δ′ within contacts as a function of the times since their starts, of shape (...,
        contacts); None if impacts are instants, and for laws without a κ.
        """
        return None
