r"""Impacts on the spring-damper: contact, release, flight, landing.

A state on the Poincaré section is (φ, δ′) at the start of contact. With the
force release a contact may also start at δ < 0, see
:mod:`bouncing_ball.motion.resumption`; each such start is an impact.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.motion.angles import reduce_angle, table
from bouncing_ball.motion.contact_motion import ContactMotion, Oscillator, oscillator, release
from bouncing_ball.motion.ensembles import BLOCK, flatten
from bouncing_ball.motion.follow import BELOW, Columns, Departure, Impact, follow, next_impact
from bouncing_ball.motion.landing import Flight, land
from bouncing_ball.motion.resumption import leaves_fast, resumption
from bouncing_ball.motion.sequence import Cycle, ImpactSequence, Status
from bouncing_ball.motion.starts import approach


class _SpringDamper(NamedTuple):
    """The :class:`~bouncing_ball.motion.follow.Dynamics` of the spring-damper."""

    constants: Oscillator
    block: int = BLOCK

    @property
    def below(self) -> bool:
        return bool(np.any(self.constants.lag))

    @property
    def columns(self) -> Columns:
        return BELOW if self.below else {}

    def take(self, which: Any) -> "_SpringDamper":
        return _SpringDamper(self.constants.take(which))

    def start(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        return Impact.at_level(phase, velocity)

    def depart(self, impact: Impact) -> Departure:
        amplitude = self.constants.amplitude
        x, y = table(impact.phase, amplitude)
        motion = ContactMotion(self.constants, impact.displacement, impact.velocity, x, y)
        end = release(motion)
        _, lift = table(impact.phase + end.time, amplitude)
        # Rounding may leave a touch of the table's level with a falling ball.
        displacement, velocity = motion.state(np.maximum(end.rate, 0.0), lift)
        status = np.where(end.ended, Status.PERMANENT_CONTACT, Status.BOUNCING)
        status[end.undecided] = Status.UNDECIDED
        forever = status != Status.BOUNCING
        if forever.any():
            velocity[forever] = np.nan
            displacement = np.where(forever, np.nan, displacement)
            end.time[forever] = np.inf
        return Departure(impact.phase + end.time, displacement, velocity, end.time, status)

    def fly(self, departure: Departure) -> tuple[Impact, np.ndarray]:
        constants = self.constants
        x, y = table(departure.phase, constants.amplitude)
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
        impact = Impact(reduce_angle(departure.phase + time), displacement, velocity)
        return impact, departure.duration + time


def _prepare(contact: SpringDamper, amplitude, *states):
    """Constants of the contacts, states as flat arrays, and their shape."""
    parameters = (contact.frequency_ratio, contact.damping_ratio, amplitude)
    (omega, zeta, lam), states, shape = flatten(parameters, states)
    constants = oscillator(SpringDamper(omega, zeta, contact.release), lam)
    return _SpringDamper(constants), states, shape


def simulate(
    contact: SpringDamper, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike, impacts: int
) -> ImpactSequence:
    """Follow balls from an impact through a number of impacts, the first included.

    Parameters
    ----------
    contact : SpringDamper
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

    >>> sequence = simulate(SpringDamper(100.0, 0.0), 0.0, 0.0, -2.0, 3)
    >>> sequence.impact_velocity.round(13).tolist()
    [-2.0, -2.0, -2.0]
    """
    dynamics, (phase, velocity), shape = _prepare(contact, amplitude, phase, velocity)
    state = phase, approach(phase, velocity, dynamics.constants.amplitude)
    return follow(dynamics, state, contact, amplitude, shape, impacts)


def contact_cycle(
    contact: SpringDamper, amplitude: ArrayLike, phase: ArrayLike, relative_velocity: ArrayLike
) -> Cycle:
    """The Poincaré map: from one impact (φ, δ′) to the next.

    Examples
    --------
    On a table at rest an undamped ball returns with the velocity it came with:

    >>> cycle = contact_cycle(SpringDamper(100.0, 0.0), 0.0, 0.0, -2.0)
    >>> round(float(cycle.relative_velocity), 13)
    -2.0
    """
    dynamics, state, shape = _prepare(contact, amplitude, phase, relative_velocity)
    return next_impact(dynamics, state, shape)
