r"""Contacts with a duration, of any law: contact, release, flight, landing.

A state on the Poincaré section is (φ, δ′) at the start of contact. With a release by
vanishing force a contact may also start at δ < 0, see
:mod:`bouncing_ball.motion.resumption`; each such start is an impact.

A contact is followed by :func:`bouncing_ball.contacts.collocation.march`. That of an
underdamped spring-damper is in closed form (:mod:`bouncing_ball.motion.linear_contact`),
but for the undamped resonance: there the release is certified to be the first, and contacts
that never end are known. Landings are certified to be the first for every law.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bouncing_ball.contacts.collocation import MOST_PANELS, Start, march
from bouncing_ball.motion.angles import reduce_angle, table
from bouncing_ball.motion.dynamics import Departure, Dynamics, Impact
from bouncing_ball.motion.ensembles import BLOCK
from bouncing_ball.motion.landing import Flight, land
from bouncing_ball.motion.linear_contact import ContactMotion, release
from bouncing_ball.motion.resumption import resumption
from bouncing_ball.motion.sequence import Status


@dataclass(frozen=True, repr=False)
class ContactDynamics(Dynamics):
    """Contacts of any :class:`~bouncing_ball.contacts.contact_law.ContactLaw`, and flights."""

    # The collocation has blocks of its own; fewer here share the few contacts that last long.
    block: ClassVar[int] = 1 << 16

    def depart(self, impact: Impact) -> Departure:
        """The end of each contact, undecided where none was found."""
        one = np.ones_like(impact.phase)
        # -0 is no depth.
        depth = np.maximum(-impact.displacement, 0.0)
        start = Start(depth, -impact.velocity, impact.phase, self.amplitude * one, one)
        end = march(self.law, start, MOST_PANELS)
        phase, lost = impact.phase + end.duration, np.isnan(end.duration)
        state = -end.penetration, np.maximum(-end.rate, 0.0), *table(phase, self.amplitude)
        status = np.where(lost, Status.UNDECIDED, Status.BOUNCING)
        duration = np.where(lost, np.inf, end.duration)
        return Departure(phase, duration, Flight(*state, self.amplitude), status)

    def fly(self, departure: Departure) -> tuple[Impact, np.ndarray]:
        """The landing, or the resumption of the contact if that comes first."""
        flight = departure.flight
        start, resumed = resumption(flight, self.law)
        landing = land(flight, start)
        time, velocity, displacement = landing.time, -landing.rate, np.zeros_like(landing.time)
        if resumed.any():
            time[resumed] = start[resumed]
            displacement[resumed], velocity[resumed], *_ = (x[resumed] for x in flight.gap(time))
        impact = Impact(reduce_angle(departure.phase + time), displacement, velocity)
        return impact, departure.duration + time


@dataclass(frozen=True, repr=False)
class LinearContactDynamics(ContactDynamics):
    """The same of an underdamped :class:`~bouncing_ball.contacts.spring_damper.SpringDamper`."""

    block: ClassVar[int] = BLOCK

    def depart(self, impact: Impact) -> Departure:
        """The end of each contact, or the proof that there is none."""
        x, y = table(impact.phase, self.amplitude)
        state = impact.displacement, impact.velocity
        motion = ContactMotion(self.law, self.amplitude, *state, x, y)
        end = release(motion)
        phase = impact.phase + end.time
        x, y = table(phase, self.amplitude)
        # Rounding may leave a touch of the table's level with a falling ball.
        displacement, velocity = motion.state(np.maximum(end.rate, 0.0), y)
        status = np.where(end.ended, Status.PERMANENT_CONTACT, Status.BOUNCING)
        status[end.undecided] = Status.UNDECIDED
        forever = status != Status.BOUNCING
        if forever.any():
            displacement, velocity = (
                np.where(forever, np.nan, z) for z in (displacement, velocity)
            )
            end.time[forever] = np.inf
        return Departure(
            phase, end.time, Flight(displacement, velocity, x, y, self.amplitude), status
        )
