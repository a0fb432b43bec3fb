r"""Contacts of finite duration, with any law: contact, release, flight, landing.

A state on the Poincaré section is (φ, δ′) at the start of contact. If the release is
where the force vanishes, a contact may also start at δ < 0, see
:mod:`bouncing_ball.motion.resumption`; each such start counts as an impact.

The motion in contact is computed by :func:`bouncing_ball.contacts.collocation.march`. For an
underdamped spring-damper it has a closed form (:mod:`bouncing_ball.motion.linear_contact`),
except at the undamped resonance. With the closed form the release is proved to be the first,
and a contact that never ends is proved to be permanent. With any other law a contact without a
release in two periods of the table, or in hundreds of oscillations, is permanent if a steady
contact at Λ does not release the ball, which is no proof, and undecided otherwise. Landings are
proved to be the first for every law.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bouncing_ball.contacts.collocation import MOST_PANELS, Start, march
from bouncing_ball.contacts.contact_scales import rest
from bouncing_ball.contacts.elementary import exponential
from bouncing_ball.contacts.permanent_contact import holds
from bouncing_ball.contacts.signature import Signature
from bouncing_ball.motion.angles import reduce_angle, sine_and_versine, table
from bouncing_ball.motion.dynamics import Departure, Dynamics, Impact
from bouncing_ball.motion.ensembles import BLOCK
from bouncing_ball.motion.first_zero import first_zero
from bouncing_ball.motion.landing import Flight, land
from bouncing_ball.motion.linear_contact import ContactMotion
from bouncing_ball.motion.resumption import resumption
from bouncing_ball.motion.sequence import Status
from bouncing_ball.motion.tangent import Deviation, Jacobian

# Panels of two periods of the table on a contact with up to some twenty oscillations in one, and
# the depth of the ball at rest, over g/Ω², from which on a contact has so few.
_SOME_PANELS, _COMPLIANT = 400, 1 / 400


@dataclass(frozen=True, repr=False)
class ContactDynamics(Dynamics):
    """Contacts of any :class:`~bouncing_ball.contacts.contact_law.ContactLaw`, and flights."""

    # The collocation divides its contacts into blocks itself. Large blocks here cost less, because
    # the few long contacts are then computed together.
    block: ClassVar[int] = 1 << 16

    def depart(self, impact: Impact, *, differentiate: bool = False) -> Departure:
        """The end of each contact. Where no end was found, the contact is permanent if a steady
        contact at Λ holds the ball, and the status is undecided otherwise.

        If the force depends on the load and the load pulls, a slow ball meets no force at p = 0.
        Its contact then has the duration 0, and the ball continues its flight below p = 0.
        """
        one = np.ones_like(impact.phase)
        # Without the maximum a displacement of 0 gives the depth -0.
        depth = np.maximum(-impact.displacement, 0.0)
        load = 1 - table(impact.phase, self.amplitude)[1]
        grip = self.law.loaded_grip(depth, -impact.velocity, load)
        free = (depth == 0) & (grip < 0) & self.law.feels_load
        # No contact is computed for these balls, because none of its panels would be accepted.
        rate = np.where(free, np.nan, -impact.velocity)
        start = Start(depth, rate, impact.phase, self.amplitude * one, one)
        compliant = not self.law.shape and rest(self.law) > _COMPLIANT
        for panels in (_SOME_PANELS, MOST_PANELS)[not compliant :]:
            end = march(self.law, start, panels, differentiate=differentiate)
            lost = np.flatnonzero(np.isnan(end.duration) & ~free)
            held = [k for k in lost if holds(self.law.take(k), float(start.amplitude[k]))]
            if len(held) == lost.size:
                break
        # A ball that is released below the table's level may move down, if the load pulls it.
        rate = np.where(end.penetration > 0, -end.rate, np.maximum(-end.rate, 0.0))
        for column, value in zip(end[:3], (0 * depth, depth, -impact.velocity), strict=True):
            column[free] = value[free]
        rate = np.where(free, impact.velocity, rate)
        phase, lost = impact.phase + end.duration, np.isnan(end.duration)
        state = -end.penetration, rate, *table(phase, self.amplitude)
        status = np.where(lost, Status.UNDECIDED, Status.BOUNCING)
        status[held] = Status.PERMANENT_CONTACT
        duration = np.where(lost, np.inf, end.duration)
        flight = Flight(*state, self.amplitude)
        departure = Departure(phase, duration, flight, status, by=end.jacobian)
        if not differentiate:
            return departure
        # An undamped linear contact that starts at zero speed under a constant load lasts exactly
        # twice as long as a free impact. A longer contact therefore ends because the load changes.
        free = Signature(self.law)(np.maximum(-impact.velocity, np.finfo(float).tiny)).duration
        return departure._replace(sticks=duration > 2 * free)

    def fly(self, departure: Departure) -> tuple[Impact, np.ndarray]:
        """The landing or an earlier resumption, and the time from the last impact to it."""
        flight = departure.flight
        start, resumed = resumption(flight, self.law)
        landing = land(flight, start)
        time, velocity, displacement = landing.time, -landing.rate, np.zeros_like(landing.time)
        if resumed.any():
            time[resumed] = start[resumed]
            displacement[resumed], velocity[resumed], *_ = (x[resumed] for x in flight.gap(time))
        impact = Impact(reduce_angle(departure.phase + time), displacement, velocity)
        return impact, departure.duration + time

    def jacobian(
        self, impact: Impact, departure: Departure, after: Impact, passed: np.ndarray
    ) -> Jacobian:
        """Derivative of the map over contact and flight; NaN if either impact is a resumption, or
        if the ball meets no force.
        """
        known, by = (impact.displacement >= 0) & (after.displacement >= 0), departure.by
        after = after._replace(velocity=np.where(known, after.velocity, np.nan))
        released = (
            Deviation(k + sign * by[:, 0, c], -sign * by[:, 1, c], -sign * by[:, 2, c])
            for c, k, sign in ((0, 1, 1), (1, 0, -1))
        )
        return self.landed(released, departure, after, passed)


@dataclass(frozen=True, repr=False)
class LinearContactDynamics(ContactDynamics):
    """The dynamics of an underdamped
    :class:`~bouncing_ball.contacts.spring_damper.SpringDamper`.
    """

    block: ClassVar[int] = BLOCK

    def depart(self, impact: Impact, *, differentiate: bool = False) -> Departure:
        """The end of each contact, or permanent contact if it is proved never to end."""
        x, y = table(impact.phase, self.amplitude)
        state = impact.displacement, impact.velocity
        motion = ContactMotion(self.law, self.amplitude, *state, x, y)
        # Where the search ended without a release, the contact is permanent.
        end = first_zero(motion, motion.sure())
        phase = impact.phase + end.time
        x, y = table(phase, self.amplitude)
        # If the ball just reaches the table's level, rounding may give it a downward velocity.
        displacement, velocity = motion.state(np.maximum(end.rate, 0.0), y)
        status = np.where(end.ended, Status.PERMANENT_CONTACT, Status.BOUNCING)
        status[end.undecided] = Status.UNDECIDED
        forever = status != Status.BOUNCING
        displacement[forever] = velocity[forever] = np.nan
        end.time[forever] = np.inf
        flight = Flight(displacement, velocity, x, y, self.amplitude)
        # An undamped contact that starts at zero speed under a constant load lasts exactly one
        # oscillation. A longer contact therefore ends because the load changes.
        sticks = end.time * self.law.damped_frequency > 2 * np.pi
        return Departure(phase, end.time, flight, status, sticks=sticks)

    def jacobian(
        self, impact: Impact, departure: Departure, after: Impact, passed: np.ndarray
    ) -> Jacobian:
        """Derivative of the map over contact and flight, in closed form."""
        contact, flight, duration = self.law, departure.flight, departure.duration
        omega, damped, lag = contact.frequency_ratio, contact.damped_frequency, contact.lag
        stiffness, loss = omega**2, 2 * contact.damping_ratio * omega
        sine, versine = sine_and_versine(damped * duration)
        decay = exponential(-loss / 2 * duration)
        impulse = decay * sine / damped
        impulse_rate = decay * (1 - versine) - loss / 2 * impulse
        level = impulse_rate + loss * impulse
        depth, rate = impact.displacement, impact.velocity
        _, y = table(impact.phase, self.amplitude)
        first = (y - 1) - loss * rate - stiffness * depth
        left, speed = flight.displacement, flight.velocity
        last = (flight.y - 1) - loss * speed - stiffness * left
        # A deviation along the motion changes only the time.
        fall = speed - level * rate - impulse * first
        pull = last + stiffness * impulse * rate - impulse_rate * first
        before, held = (np.where(x < 0, lag, 0.0) for x in (depth, after.displacement))
        by_rate = impulse - before * level, impulse_rate + before * stiffness * impulse
        one = np.ones_like(passed)
        moved = Deviation(one, fall, pull), Deviation(0 * one, *by_rate)
        released = (x.to_event(speed, last, lag) for x in moved)
        return self.landed(released, departure, after, passed, held)
