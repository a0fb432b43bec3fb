"""The simulation of balls from impact to impact, by the contacts and flights of any model.

A subclass of :class:`Dynamics` defines its contacts and flights
(:mod:`bouncing_ball_beyond.models.contacts_and_flights`); the simulation follows from them.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Any, ClassVar, Protocol, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import ModelError, require
from bouncing_ball_beyond.inherited.models.flight import table
from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.inherited.numerics.arrays import BLOCK, as_numbers, blocks, pick
from bouncing_ball_beyond.models.contacts_and_flights import ContactsAndFlights, Departure, Impact
from bouncing_ball_beyond.models.deviations import Jacobian
from bouncing_ball_beyond.models.sequence import RECORDED, Cycle, ImpactSequence

# Rounding may give a ball at rest on the table a small upward velocity.
_ROUNDING = 8 * np.finfo(float).eps


@dataclass(frozen=True, repr=False)
class Dynamics(ContactsAndFlights):
    """A law of the impact on a table of amplitude Λ, with what follows from it.

    Each model is a subclass, which defines its contacts and flights. ``block`` is the largest
    number of balls computed at the same time.
    """

    block: ClassVar[int] = BLOCK

    @classmethod
    def of(cls, law: Any, amplitude: ArrayLike) -> Self:
        """The dynamics of a law at Λ.

        Raises
        ------
        ModelError
            If Λ is not finite and ≥ 0.
        """
        name = "amplitude Λ"
        allowed = "finite and ≥ 0"
        lam = as_numbers(amplitude, name, allowed)
        require((lam >= 0) & np.isfinite(lam), lam, name, allowed)
        return cls(law, lam)

    def in_a_row(self, *states: ArrayLike) -> tuple[Self, list[np.ndarray], tuple[int, ...]]:
        """The dynamics and states of balls, flattened, and the shape to which they broadcast."""
        arrays = [np.asarray(x, dtype=float) for x in states]
        shape = np.broadcast_shapes(self.shape, *(x.shape for x in arrays))
        return self.flat(shape), [np.broadcast_to(x, shape).reshape(-1) for x in arrays], shape

    def legs(self, impact: Impact, *, differentiate: bool = False) -> "Iterator[Leg]":
        """The legs of a row of balls that begin with these impacts, one after the other.

        There is no end to them unless no balls are left: :meth:`Leg.keep` leaves out balls, also
        those that stay on the table, which have no flight. With ``differentiate`` the legs can be
        differentiated. A flight is computed when it is asked for, or for the next leg.

        Examples
        --------
        >>> from itertools import islice
        >>> from bouncing_ball_beyond.models.restitution import RestitutionDynamics
        >>> elastic = RestitutionDynamics.of(1.0, 0.0)
        >>> first = elastic.start(np.zeros(2), np.array([-1.0, -2.0]))
        >>> [leg.fly()[1].tolist() for leg in islice(elastic.legs(first), 2)]
        [[2.0, 4.0], [2.0, 4.0]]
        """
        dynamics = self
        while impact.phase.size:
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
        of_table = table(start, flat.amplitude)[0]
        relative = before - of_table
        rises = ~(relative <= _ROUNDING * (np.abs(before) + flat.amplitude))
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
        return Cycle(*(values.reshape(shape)[()] for values in cycle))


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
