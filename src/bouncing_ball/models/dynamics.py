"""The simulation of balls from impact to impact, by the contacts and flights of any model.

A subclass of :class:`Dynamics` computes the ends of contacts and their derivatives; the simulation
follows from them.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Any, ClassVar, NamedTuple, Protocol, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import ModelError, require
from bouncing_ball.models.contact import FiniteContact
from bouncing_ball.models.deviations import Deviation, Jacobian
from bouncing_ball.models.flight import land
from bouncing_ball.models.sequence import RECORDED, Cycle, ImpactSequence, Status
from bouncing_ball.models.setting import PAPER, Setting
from bouncing_ball.numerics.arrays import BLOCK, Batch, as_numbers, blocks, pick
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.numerics.first_zero import Zero

# Rounding may give a ball at rest on the table a small upward velocity.
_ROUNDING = 8 * np.finfo(float).eps


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


@dataclass(frozen=True, repr=False)
class Dynamics(Batch, ABC):
    """A law of the impact on a table of amplitude Λ.

    Each model is a subclass, which computes the ends of contacts, and the ends of flights if these
    are not landings. All arrays are one-dimensional with an entry per ball, and ``block`` is the
    largest number of balls computed at the same time.
    """

    law: Any
    amplitude: np.ndarray
    setting: Setting = PAPER

    block: ClassVar[int] = BLOCK
    forgets: ClassVar[bool] = False
    """Whether the state in which a ball leaves after sticking is independent of earlier impacts."""
    continues: ClassVar[bool] = False
    """Whether :meth:`depart_after` can continue a contact or a rest beyond its first end."""

    @classmethod
    def of(cls, law: Any, amplitude: ArrayLike, setting: Setting = PAPER) -> Self:
        """The dynamics of a law at Λ, in the setting of the paper or in another one.

        Raises
        ------
        ModelError
            If Λ is not finite and ≥ 0.
        """
        name = "amplitude Λ"
        allowed = "finite and ≥ 0"
        lam = as_numbers(amplitude, name, allowed)
        require((lam >= 0) & np.isfinite(lam), lam, name, allowed)
        return cls(law, lam, setting)

    @property
    def contact(self) -> FiniteContact | None:
        """The law of contacts of finite duration, or None if impacts are instants."""
        return None

    def start(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        """First impacts, which start at phases φ with δ′ at the table's level (Eqs. 21, 22)."""
        return self.with_table(Impact.at_level(phase, velocity))

    def with_table(self, impact: Impact) -> Impact:
        """The impacts with the state of the table, which is used several times."""
        return impact._replace(level=Level(*self.setting.level(impact.phase, self.amplitude)))

    def table_at(self, impact: Impact) -> tuple[np.ndarray, np.ndarray]:
        """w′ and w at impacts, in the paper Λ cos φ and Λ sin φ."""
        return impact.level or self.setting.level(impact.phase, self.amplitude)

    def at_section(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        """The impacts with these states, in the coordinates of :meth:`section`."""
        return self.start(phase, velocity)

    @abstractmethod
    def depart(self, impact: Impact, *, differentiate: bool = False) -> Departure:
        """The ends of the contacts that start with these impacts; with ``differentiate`` also which
        balls stick, and what :meth:`jacobian` needs.
        """

    def depart_after(self, impact: Impact, duration: np.ndarray) -> Departure:
        """The ends of the contacts nearest to given durations, with their derivatives.

        They are the first ends, as in :meth:`depart`, unless the model :attr:`continues` contacts.
        """
        return self.depart(impact, differentiate=True)

    def release_function(
        self, impact: Impact, departure: Departure
    ) -> Callable[[np.ndarray], np.ndarray] | None:
        """δ + κ δ′ within contacts as a function of the times since their starts, of shape (...,
        contacts); None if impacts are instants, and for laws without a κ.
        """
        return None

    def duration_slopes(
        self, impact: Impact, departure: Departure
    ) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of the durations of contacts with respect to φ and δ′ at their starts.

        They are needed only where the model :attr:`continues` contacts.
        """
        raise NotImplementedError(f"{type(self).__name__} does not continue its contacts")

    @property
    def clock(self) -> Any:
        """Frequency of the contacts over that of the table, 1 for instants. Durations of contacts
        times the clock are of order one.
        """
        return 1.0

    def within(
        self, impact: Impact, departure: Departure, time: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times 0 ≤ s ≤ D since the starts of contacts, of shape (..., contacts).

        A ball whose impact is an instant rests on the table until it leaves.
        """
        return np.zeros(time.shape), np.zeros(time.shape)

    def gap_at_start(self, impact: Impact) -> np.ndarray:
        """δ of the flight that ends with each impact, at the start of the contact."""
        return impact.displacement

    @abstractmethod
    def contraction(self, impact: Impact, departure: Departure) -> np.ndarray:
        """The factor by which the contacts multiply areas of the phase plane. Free flights keep
        them, and others multiply them by :meth:`.Setting.contraction`.

        The determinant of the monodromy of a periodic orbit is the product of these factors.
        Without dissipation it is exactly 1, whereas the rounding errors of the entries of the
        monodromy would decide about stability.
        """

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

    def section_lag(self, velocity: np.ndarray) -> tuple[np.ndarray | float, np.ndarray | float]:
        """κ of the section, where flights have δ + κ δ′ = 0 if they arrive with δ′, and
        d(κ δ′)/dδ′; both are 0 if the section is the table's level.
        """
        return 0.0, 0.0

    def landed(
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

    def in_a_row(self, *states: ArrayLike) -> tuple[Self, list[np.ndarray], tuple[int, ...]]:
        """The dynamics and states of balls, flattened, and the shape to which they broadcast."""
        arrays = [np.asarray(x, dtype=float) for x in states]
        shape = np.broadcast_shapes(self.shape, *(x.shape for x in arrays))
        return self.flat(shape), [np.broadcast_to(x, shape).reshape(-1) for x in arrays], shape

    def legs(
        self,
        impact: Impact,
        *,
        differentiate: bool = False,
        renewed: Callable[[Any], Any] | None = None,
    ) -> "Iterator[Leg]":
        """The legs of a row of balls that begin with these impacts, one after the other.

        There is no end to them unless no balls are left: :meth:`Leg.keep` leaves out balls, also
        those that stay on the table, which have no flight. With ``differentiate`` the legs can be
        differentiated. A flight is computed when it is asked for, or for the next leg; an impact
        :attr:`Leg.after` that is changed is the start of the next leg. Each leg obeys the dynamics
        that ``renewed`` makes of those of the balls left, for example with a law drawn anew.

        Examples
        --------
        >>> from itertools import islice
        >>> from bouncing_ball.models.restitution import RestitutionDynamics
        >>> elastic = RestitutionDynamics.of(1.0, 0.0)
        >>> first = elastic.start(np.zeros(2), np.array([-1.0, -2.0]))
        >>> [leg.fly()[1].tolist() for leg in islice(elastic.legs(first), 2)]
        [[2.0, 4.0], [2.0, 4.0]]
        """
        dynamics = self
        while impact.phase.size:
            if renewed:
                dynamics = renewed(dynamics)
            leg = Leg(dynamics, impact, dynamics.depart(impact, differentiate=differentiate))
            yield leg
            impact, _ = leg.fly()
            dynamics = leg.dynamics

    def kept(self, which: np.ndarray | slice, *rows: Any) -> tuple:
        """The dynamics and the rows of the balls with these indices."""
        return self.take(which), *(pick(x, which) for x in rows)

    def first_impacts(
        self, phase: ArrayLike, velocity: ArrayLike
    ) -> tuple[Self, np.ndarray, np.ndarray, tuple[int, ...]]:
        """The dynamics of balls, and φ and δ′ ≤ 0 of their first impacts, flattened; their shape.

        Raises
        ------
        ModelError
            If a state is not finite, or if a ball rises from the table.
        """
        flat, (start, before), shape = self.in_a_row(phase, velocity)
        if not np.all(np.isfinite(start) & np.isfinite(before)):
            raise ModelError("the phase and the velocity of the impact must be finite")
        of_table = flat.setting.level(start, flat.amplitude)[0]
        relative = before - of_table
        fastest = flat.amplitude * flat.setting.waveform.fastest
        rises = ~(relative <= _ROUNDING * (np.abs(before) + fastest))
        if np.any(rises):
            k = int(np.argmax(rises))
            raise ModelError(
                "a ball that rises from the table has no impact: its velocity "
                f"z′ = {before[k]:g} is above that of the table, w′ = {of_table[k]:g}"
            )
        return flat, start, np.minimum(relative, 0.0), shape

    def simulate(self, phase: ArrayLike, velocity: ArrayLike, impacts: int) -> ImpactSequence:
        """Follow balls from an impact through a number of impacts, the first included.

        Parameters
        ----------
        phase, velocity : array_like
            The table's phase φ and the absolute velocity z′_i just before the first impact.
        impacts : int
            Number of impacts. The bounces that are summed up before a ball sticks are not counted.
            Balls that remain on the table have fewer impacts.

        Returns
        -------
        ImpactSequence
            Its rows have the shape to which the arguments and the dynamics broadcast.

        Raises
        ------
        ModelError
            If a state is not finite, or if a ball rises from the table.
        """
        flat, start, relative, shape = self.first_impacts(phase, velocity)
        rows = {name: np.full((impacts, start.size), np.nan) for name in RECORDED}
        status = np.zeros(start.size, dtype=np.int8)
        for part in blocks(start.size, self.block):
            of_block = {name: values[:, part] for name, values in rows.items()}
            dynamics = flat.take(part)
            first = dynamics.start(start[part], relative[part])
            dynamics._record(first, of_block, status[part])
        return ImpactSequence(
            amplitude=np.broadcast_to(self.amplitude, shape),
            contact=self.contact,
            setting=self.setting,
            status=status.reshape(shape),
            **{name: values.reshape(impacts, *shape) for name, values in rows.items()},
        )

    def _record(self, first: Impact, rows: dict[str, np.ndarray], status: np.ndarray) -> None:
        """Fill the rows, shape (impacts, balls), and the status of one block of balls.

        The rows of balls that do not bounce any more remain NaN.
        """
        time = np.zeros_like(first.phase)
        bouncing: Any = slice(None)
        impacts = len(rows["time"])
        for row, leg in enumerate(islice(self.legs(first), impacts)):
            for name, values in _recorded(time, leg).items():
                rows[name][row, bouncing] = values
            if np.any(leg.departure.status):
                status[bouncing] = leg.departure.status
                going = leg.bouncing()
                bouncing = np.arange(len(status))[bouncing][going]
                (time,) = leg.keep(going, time)
            if row + 1 < impacts:
                _, passed = leg.fly()
                time = time + passed

    def next_impact(self, phase: ArrayLike, relative_velocity: ArrayLike) -> Cycle:
        """The Poincaré map from one impact (φ, δ′) to the next, for arguments that broadcast.

        Raises
        ------
        ModelError
            If a flight is too long for floating-point numbers.
        """
        flat, (start, velocity), shape = self.in_a_row(phase, relative_velocity)
        cycle = Cycle(
            phase=np.full(start.size, np.nan),
            relative_velocity=np.full(start.size, np.nan),
            displacement=np.full(start.size, np.nan),
            time=np.full(start.size, np.inf),
        )
        for part in blocks(start.size, self.block):
            dynamics = flat.take(part)
            leg = next(dynamics.legs(dynamics.start(start[part], velocity[part])))
            going = leg.bouncing()
            leg.keep(going)
            landed, passed = leg.fly()
            balls = part.start + going
            cycle.phase[balls] = landed.phase
            cycle.relative_velocity[balls] = landed.velocity
            cycle.displacement[balls] = landed.displacement
            cycle.time[balls] = passed
        return Cycle(*(values.reshape(shape) for values in cycle))


@dataclass(eq=False)
class Leg:
    """The contacts of a row of balls, and the flights after them up to the next impacts.

    A contact begins with ``impact`` and ends with ``departure``. The flight ends with the impact
    ``after``, and ``passed`` is the time between the two impacts; both are None before :meth:`fly`.
    """

    dynamics: Dynamics
    impact: Impact
    departure: Departure
    after: Any = None
    passed: Any = None

    def bouncing(self) -> np.ndarray:
        """The indices of the balls whose contacts end, so that they fly."""
        return np.flatnonzero(self.departure.status == Status.BOUNCING)

    def keep(self, which: np.ndarray, *rows: Any) -> tuple:
        """Leave out all balls but those with these indices, from here on.

        After the flight only the next impacts are restricted to these balls, because the leg is
        over. The result are the entries of these balls in further ``rows``.
        """
        self.dynamics = self.dynamics.take(which)
        if self.after is None:
            self.impact = pick(self.impact, which)
            self.departure = pick(self.departure, which)
        else:
            self.after = pick(self.after, which)
        return tuple(pick(x, which) for x in rows)

    def fly(self) -> tuple[Impact, np.ndarray]:
        """The next impacts, and the times from the last ones to them.

        Raises
        ------
        ModelError
            If a flight is too long for floating-point numbers.
        """
        if self.after is None:
            self.after, self.passed = self.dynamics.fly(self.departure)
        return self.after, self.passed

    def jacobian(self) -> Jacobian:
        """The derivative of the map over this leg, if its departures are differentiated."""
        after, passed = self.fly()
        return self.dynamics.jacobian(self.impact, self.departure, after, passed)


def _recorded(time: np.ndarray, leg: Leg) -> dict[str, Any]:
    """The values of :data:`.RECORDED` for impacts at these times since the first ones."""
    impact = leg.impact
    departure = leg.departure
    return {
        "time": time,
        "phase": impact.phase,
        "displacement": impact.displacement,
        "relative_velocity": impact.velocity,
        "contact_duration": departure.duration,
        "release_displacement": departure.flight.displacement,
        "relative_bounce_velocity": departure.flight.velocity,
        "settling": departure.settling,
    }


class HasDynamics(Protocol):
    """A model or a law of the impact, which determines how balls move."""

    def dynamics(self, amplitude: ArrayLike) -> Dynamics:
        """The contacts and flights of balls on a table of amplitude Λ."""
