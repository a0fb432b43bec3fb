r"""Contacts with a duration, of any law: contact, release, flight, landing.

A state on the Poincaré section is (φ, δ′) at the start of contact. With a release by
vanishing force a contact may also start at δ < 0, see
:mod:`bouncing_ball.motion.resumption`; each such start is an impact.

A contact is followed by :func:`bouncing_ball.contacts.collocation.march`. That of an
underdamped spring-damper is in closed form (:mod:`bouncing_ball.motion.linear_contact`),
but for the undamped resonance: there the release is certified to be the first, and contacts
that never end are known. Landings are certified to be the first for every law.
"""

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.collocation import MOST_PANELS, Start, march
from bouncing_ball.contacts.contact_law import ContactLaw
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.motion.angles import reduce_angle, table
from bouncing_ball.motion.ensembles import BLOCK, flatten, pick
from bouncing_ball.motion.follow import BELOW, Columns, Departure, Impact, follow, next_impact
from bouncing_ball.motion.landing import Flight, land
from bouncing_ball.motion.linear_contact import ContactMotion, has_closed_form, release
from bouncing_ball.motion.resumption import leaves_fast, resumption
from bouncing_ball.motion.sequence import Cycle, ImpactSequence, Status
from bouncing_ball.motion.starts import approach, check_amplitude


@dataclass(frozen=True)
class AnyContact:
    """The :class:`~bouncing_ball.motion.follow.Dynamics` of a contact law."""

    law: ContactLaw
    amplitude: np.ndarray
    # The collocation has blocks of its own; fewer here share the few contacts that last long.
    block: ClassVar[int] = 1 << 16

    @property
    def columns(self) -> Columns:
        return BELOW if np.any(self.law.lag != 0) else {}

    def take(self, which: Any) -> Self:
        return replace(self, law=self.law.take(which), amplitude=pick(self.amplitude, which))

    def start(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        return Impact.at_level(phase, velocity)

    def depart(self, impact: Impact) -> Departure:
        one = np.ones_like(impact.phase)
        # -0 is no depth.
        depth = np.maximum(-impact.displacement, 0.0)
        start = Start(depth, -impact.velocity, impact.phase, self.amplitude * one, one)
        end = march(self.law, start, MOST_PANELS)
        lost = np.isnan(end.duration)
        duration = np.where(lost, np.inf, end.duration)
        velocity = np.maximum(-end.rate, 0.0)
        status = np.where(lost, Status.UNDECIDED, Status.BOUNCING)
        return Departure(impact.phase + duration, -end.penetration, velocity, duration, status)

    def fly(self, departure: Departure) -> tuple[Impact, np.ndarray]:
        x, y = table(departure.phase, self.amplitude)
        flight = Flight(departure.displacement, departure.velocity, x, y, self.amplitude)
        start, back = flight.sure(), np.empty(0, dtype=int)
        if self.columns:
            slow = np.flatnonzero(~leaves_fast(flight, self.law))
            start[slow], held = resumption(flight.take(slow), self.law.take(slow))
            back = slow[held]
        landing = land(flight, start)
        time, velocity, displacement = landing.time, -landing.rate, np.zeros_like(landing.time)
        time[back] = start[back]
        displacement[back], velocity[back], _, _ = flight.take(back).gap(time[back])
        impact = Impact(reduce_angle(departure.phase + time), displacement, velocity)
        return impact, departure.duration + time


@dataclass(frozen=True)
class LinearContact(AnyContact):
    """That of the spring-damper, in closed form."""

    law: Any
    block: ClassVar[int] = BLOCK

    def depart(self, impact: Impact) -> Departure:
        x, y = table(impact.phase, self.amplitude)
        state = impact.displacement, impact.velocity
        motion = ContactMotion(self.law, self.amplitude, *state, x, y)
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
        return Departure(impact.phase + end.time, displacement, velocity, end.time, status)


def _prepare(law: ContactLaw, amplitude, *states):
    """The dynamics, states as flat arrays, and their shape."""
    (lam, _), states, shape = flatten([amplitude, np.zeros(law.shape)], states)
    check_amplitude(lam)
    laws = law.flat(shape)
    closed = isinstance(laws, SpringDamper) and has_closed_form(laws)
    return (LinearContact if closed else AnyContact)(laws, lam), states, shape


def simulate(
    law: ContactLaw, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike, impacts: int
) -> ImpactSequence:
    """Follow balls from an impact through a number of impacts, the first included.

    Parameters
    ----------
    law : ContactLaw
        The spring-damper or another law; arrays of parameters give each ball its own.
    amplitude : array_like
        Λ.
    phase, velocity : array_like
        Table phase φ and absolute velocity z′_i of the ball at the first impact.
    impacts : int
        Rows of the result, for every ball that does not stay in contact.

    Raises
    ------
    ModelError
        If Λ or a state is not finite, or if a ball rises from the table.

    Examples
    --------
    An elastic ball on a stiff table at rest keeps its speed:

    >>> sequence = simulate(SpringDamper(100.0, 0.0), 0.0, 0.0, -2.0, 3)
    >>> sequence.impact_velocity.round(13).tolist()
    [-2.0, -2.0, -2.0]
    """
    dynamics, (phase, velocity), shape = _prepare(law, amplitude, phase, velocity)
    state = phase, approach(phase, velocity, dynamics.amplitude)
    return follow(dynamics, state, law, amplitude, shape, impacts)


def contact_cycle(
    law: ContactLaw, amplitude: ArrayLike, phase: ArrayLike, relative_velocity: ArrayLike
) -> Cycle:
    """The Poincaré map: from one impact (φ, δ′) to the next.

    Examples
    --------
    On a table at rest an undamped ball returns with the velocity it came with:

    >>> from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley
    >>> cycle = contact_cycle(HuntCrossley(1e6, 0.0), 0.0, 0.0, -2.0)
    >>> round(float(cycle.relative_velocity), 11)
    -2.0
    """
    dynamics, state, shape = _prepare(law, amplitude, phase, relative_velocity)
    return next_impact(dynamics, state, shape)
