r"""Contacts of finite duration, with any law: contact, release, flight, landing.

A state on the Poincaré section is (φ, δ′) at the start of contact. If the release is
where the force vanishes, a contact may also start at δ < 0, see
:mod:`bouncing_ball.paper.motion.resumption`; each such start counts as an impact.

The motion in contact is computed by :func:`bouncing_ball.beyond.laws.collocation.march`; for an
underdamped spring-damper it has a closed form (:mod:`bouncing_ball.paper.motion.linear_contact`).
A contact without a release in two periods of the table, or in hundreds of oscillations, is
permanent if a steady contact at Λ does not release the ball, which is no proof, and undecided
otherwise. Landings are proved to be the first for every law.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bouncing_ball.beyond.corrected.signature import Signature
from bouncing_ball.beyond.laws.collocation import MOST_PANELS, Start, march
from bouncing_ball.beyond.laws.permanent_contact import holds
from bouncing_ball.beyond.laws.scales import rest
from bouncing_ball.paper.motion.deviations import Deviation, Jacobian
from bouncing_ball.paper.motion.dynamics import Departure, Impact
from bouncing_ball.paper.motion.flight import Flight, table
from bouncing_ball.paper.motion.resumption import ResumingDynamics
from bouncing_ball.paper.motion.sequence import Status

# Panels of two periods of the table on a contact with up to some twenty oscillations in one, and
# the depth of the ball at rest, over g/Ω², from which on a contact has so few.
_SOME_PANELS, _COMPLIANT = 400, 1 / 400


@dataclass(frozen=True, repr=False)
class ContactDynamics(ResumingDynamics):
    """Contacts of any :class:`~bouncing_ball.paper.contact.law.ContactLaw`, and flights."""

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
