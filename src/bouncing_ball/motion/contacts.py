r"""Impacts on the spring-damper: contact, release, flight, landing.

A state on the Poincaré section is (φ, δ′) at the start of contact. With the
force release a contact may also start at δ < 0, see
:mod:`bouncing_ball.motion.resumption`; each such start is an impact.
"""

from typing import Any, NamedTuple, Protocol, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.impacts.spring_damper import Contact
from bouncing_ball.motion.angles import reduce_angle, table
from bouncing_ball.motion.contact_motion import ContactMotion, Oscillator, oscillator, release
from bouncing_ball.motion.ensembles import BLOCK, blocks, flatten, pick
from bouncing_ball.motion.landing import Flight, land
from bouncing_ball.motion.resumption import leaves_fast, resumption
from bouncing_ball.motion.sequence import Cycle, ImpactSequence, Status
from bouncing_ball.motion.starts import approach


class Impact(NamedTuple):
    """Starts of contact: table phase, δ and δ′."""

    phase: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray


class Departure(NamedTuple):
    """Ends of contact: duration, δ and δ′, and the :class:`Status`."""

    duration: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    status: np.ndarray


class Dynamics(Protocol):
    """The contacts and flights of balls in a row, whatever the contact's law.

    ``below`` says whether a contact may start or end below the table's level.
    ``block`` is how many are worked on at once, at most.
    """

    @property
    def block(self) -> int:
        """Balls in a block."""

    @property
    def amplitude(self) -> np.ndarray:
        """Λ, of all balls or of each."""

    @property
    def below(self) -> bool:
        """Whether δ is not always 0 at the ends of a contact."""

    def take(self, which: Any) -> Self:
        """Those of some of the balls."""

    def depart(self, impact: Impact) -> Departure:
        """The ends of the contacts that start so."""

    def fly(self, phase: np.ndarray, departure: Departure) -> tuple[Impact, np.ndarray]:
        """The next impact of balls that leave at a phase, and the time of flight."""


class _SpringDamper(NamedTuple):
    """Of the spring-damper."""

    constants: Oscillator
    block: int = BLOCK

    @property
    def amplitude(self) -> np.ndarray:
        return self.constants.amplitude

    @property
    def below(self) -> bool:
        return bool(np.any(self.constants.lag))

    def take(self, which: Any) -> "_SpringDamper":
        return _SpringDamper(self.constants.take(which))

    def depart(self, impact: Impact) -> Departure:
        x, y = table(impact.phase, self.amplitude)
        motion = ContactMotion(self.constants, impact.displacement, impact.velocity, x, y)
        end = release(motion)
        _, lift = table(impact.phase + end.time, self.amplitude)
        # Rounding may leave a touch of the table's level with a falling ball.
        displacement, velocity = motion.state(np.maximum(end.rate, 0.0), lift)
        status = np.where(end.ended, Status.PERMANENT_CONTACT, Status.BOUNCING)
        status[end.undecided] = Status.UNDECIDED
        forever = status != Status.BOUNCING
        if forever.any():
            velocity[forever] = np.nan
            displacement = np.where(forever, np.nan, displacement)
            end.time[forever] = np.inf
        return Departure(end.time, displacement, velocity, status)

    def fly(self, phase: np.ndarray, departure: Departure) -> tuple[Impact, np.ndarray]:
        constants = self.constants
        x, y = table(phase, constants.amplitude)
        flight = Flight(departure.displacement, departure.velocity, x, y, constants.amplitude)
        start, resumed = flight.sure(), None
        if self.below:
            slow = np.flatnonzero(~leaves_fast(flight, constants.lag))
            if slow.size:
                resumed = resumption(flight.take(slow), constants.take(slow))
                start[slow] = resumed.time
        landing = land(flight, start)
        time, velocity = landing.time, -landing.rate
        displacement = np.zeros_like(time)
        if resumed is not None:
            back = slow[resumed.resumed]
            time[back] = resumed.time[resumed.resumed]
            displacement[back] = resumed.displacement[resumed.resumed]
            velocity[back] = resumed.velocity[resumed.resumed]
        return Impact(reduce_angle(phase + time), displacement, velocity), time


def _prepare(contact: Contact, amplitude, *states):
    """Constants of the contacts, states as flat arrays, and their shape."""
    parameters = (contact.frequency_ratio, contact.damping_ratio, amplitude)
    (omega, zeta, lam), states, shape = flatten(parameters, states)
    constants = oscillator(Contact(omega, zeta, contact.release), lam)
    return _SpringDamper(constants), states, shape


def simulate(
    contact: Contact,
    amplitude: ArrayLike,
    phase: ArrayLike,
    velocity: ArrayLike,
    impacts: int,
) -> ImpactSequence:
    """Follow balls from an impact through a number of impacts, the first included.

    Parameters
    ----------
    contact : Contact
        ϖ, ζ < 1 and the release rule; arrays give each ball its own.
    amplitude : array_like
        Λ.
    phase, velocity : array_like
        Table phase φ and absolute velocity z′_i of the ball at the first impact.
    impacts : int
        Rows of the result, for every ball that does not stay in contact.

    Raises
    ------
    ModelError
        If ζ ≥ 1, at the undamped resonance, or if a ball rises from the table.

    Examples
    --------
    An elastic ball on a stiff table at rest keeps its speed:

    >>> sequence = simulate(Contact(100.0, 0.0), 0.0, 0.0, -2.0, 3)
    >>> sequence.impact_velocity.round(13).tolist()
    [-2.0, -2.0, -2.0]
    """
    dynamics, (phase, velocity), shape = _prepare(contact, amplitude, phase, velocity)
    return follow(dynamics, contact, np.asarray(amplitude, float), phase, velocity, shape, impacts)


def follow(dynamics: Dynamics, law, amplitude, phase, velocity, shape, impacts) -> ImpactSequence:
    """The impacts of balls in a row, given back in a shape; see :func:`simulate`.

    Raises
    ------
    ModelError
        If a state is not finite, or a ball rises from the table.
    """
    relative = approach(phase, velocity, dynamics.amplitude)
    size = phase.size
    tables = np.empty((5, impacts, size))
    gaps = np.empty((2, impacts, size)) if dynamics.below else None
    status = np.zeros(size, dtype=np.int8)
    for part in blocks(size, dynamics.block):
        _run(
            Impact(reduce_angle(phase[part]), np.zeros_like(phase[part]), relative[part]),
            dynamics.take(part),
            tables[:, :, part],
            None if gaps is None else gaps[:, :, part],
            status[part],
        )

    time, angle, speed, duration, thrown = tables.reshape(5, impacts, *shape)
    if gaps is None:
        below = np.where(np.isfinite(time), 0.0, np.nan)
        left_below = np.where(np.isfinite(thrown), 0.0, np.nan)
    else:
        below, left_below = gaps.reshape(2, impacts, *shape)
    return ImpactSequence(
        amplitude=np.broadcast_to(amplitude, shape),
        contact=law,
        time=time,
        phase=angle,
        displacement=below,
        relative_velocity=speed,
        contact_duration=duration,
        release_displacement=left_below,
        relative_release_velocity=thrown,
        status=status.reshape(shape),
    )


def _run(impact: Impact, dynamics: Dynamics, tables, gaps, status) -> None:
    """Fill the tables of one block, impact by impact."""
    time = np.zeros_like(impact.phase)
    alive = slice(None)
    impacts = tables.shape[1]
    for row in range(impacts):
        departure = dynamics.depart(impact)
        record = (time, impact.phase, impact.velocity, departure.duration, departure.velocity)
        for array, values in zip(tables, record, strict=True):
            array[row, alive] = values
        if gaps is not None:
            gaps[0, row, alive], gaps[1, row, alive] = impact.displacement, departure.displacement
        if np.any(departure.status):
            status[alive] = departure.status
            going = np.flatnonzero(departure.status == Status.BOUNCING)
            indices = np.arange(len(status))[alive]
            stopped = np.setdiff1d(indices, indices[going])
            for array in (tables, *(() if gaps is None else (gaps,))):
                array[:, row + 1 :, stopped] = np.nan
            alive = indices[going]
            dynamics, time = dynamics.take(going), time[going]
            departure = Departure(*(pick(x, going) for x in departure))
            impact = Impact(*(x[going] for x in impact))
        if row == impacts - 1 or not len(impact.phase):
            break
        impact, flown = dynamics.fly(impact.phase + departure.duration, departure)
        time = time + (departure.duration + flown)


def contact_cycle(
    contact: Contact, amplitude: ArrayLike, phase: ArrayLike, relative_velocity: ArrayLike
) -> Cycle:
    """The Poincaré map: from one impact (φ, δ′) to the next.

    Examples
    --------
    On a table at rest an undamped ball returns with the velocity it came with:

    >>> cycle = contact_cycle(Contact(100.0, 0.0), 0.0, 0.0, -2.0)
    >>> round(float(cycle.relative_velocity), 13)
    -2.0
    """
    dynamics, (phase, u), shape = _prepare(contact, amplitude, phase, relative_velocity)
    return next_impact(dynamics, phase, u, shape)


def next_impact(dynamics: Dynamics, phase, relative_velocity, shape) -> Cycle:
    """The Poincaré map of balls in a row, given back in a shape."""
    u = relative_velocity
    out = np.full((4, phase.size), np.nan)
    out[3] = np.inf
    for part in blocks(phase.size, dynamics.block):
        here = dynamics.take(part)
        impact = Impact(reduce_angle(phase[part]), np.zeros_like(u[part]), u[part])
        departure = here.depart(impact)
        going = np.flatnonzero(departure.status == Status.BOUNCING)
        if not going.size:
            continue
        departure = Departure(*(pick(x, going) for x in departure))
        left = impact.phase[going] + departure.duration
        landed, flown = here.take(going).fly(left, departure)
        rows = (landed.phase, landed.velocity, landed.displacement, departure.duration + flown)
        for row, values in zip(out, rows, strict=True):
            row[part.start + going] = values
    return Cycle(*(row.reshape(shape) for row in out))
