r"""Contacts of finite duration, with any law: contact, release, flight, landing.

A state on the Poincaré section is (φ, δ′) at the start of contact. If the release is
where the force vanishes, a contact may also start at δ < 0, see
:mod:`bouncing_ball_beyond.models.resumption`; each such start counts as an impact. If a law has no
lag κ, κ follows from the slopes of its grip at the release, and the grip of slow balls is sampled
until they are above the table; a return of the grip between two samples would be missed. A ball
that meets no force at p = 0, because the load pulls it, is followed in the same way while it sinks.

The motion in contact is computed by :func:`bouncing_ball_beyond.models.laws.march.march`; for an
underdamped spring-damper it has a closed form (:mod:`bouncing_ball_beyond.models.linear_contact`).
A contact without a release in twenty periods of the table, or in hundreds of oscillations, is
permanent if a steady contact at Λ does not release the ball, which is no proof, and undecided
otherwise. Landings are proved to be the first for every law.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bouncing_ball_beyond.inherited.models.flight import table
from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.inherited.numerics.arrays import pick
from bouncing_ball_beyond.inherited.numerics.first_zero import first_zero
from bouncing_ball_beyond.models.contact import ContactSpan
from bouncing_ball_beyond.models.contacts_and_flights import Departure, Impact
from bouncing_ball_beyond.models.deviations import Deviation, Jacobian
from bouncing_ball_beyond.models.flight import Flight, Rise
from bouncing_ball_beyond.models.laws.force_law import ForceLaw
from bouncing_ball_beyond.models.laws.loaded import LoadedLaw, under
from bouncing_ball_beyond.models.laws.march import MOST_PANELS, ContactEnds, march
from bouncing_ball_beyond.models.laws.panel import Start, slopes_of
from bouncing_ball_beyond.models.laws.scales import rest
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.laws.steady_contact import holds
from bouncing_ball_beyond.models.resumption import (
    ResumingDynamics,
    leaves_fast,
    of_slow_balls,
)

# Panels of two periods of the table on a contact with up to some twenty oscillations in one, and
# the depth of the ball at rest, over g/Ω², from which on a contact has so few.
_SOME_PANELS = 400
_COMPLIANT = 1 / 400
# The time after which a contact is not followed any further. A contact that oscillates for so long
# has more panels than are tried, so that its ball lies on the table.
_LASTING = 20 * 2 * np.pi
# The speed of an impact, over the strongest gravity, above which a flight lasts for thousands of
# periods of the table.
_FASTEST = 3e4
# Number of samples of the grip of a slow ball, and of bisections for the time of its return.
_SAMPLES = 65
_BISECTIONS = 60


@dataclass(frozen=True, repr=False)
class ContactDynamics(ResumingDynamics):
    """Contacts of any :class:`.ContactLaw`, and flights."""

    # The collocation divides its contacts into blocks itself. Large blocks here cost less, because
    # the few long contacts are then computed together.
    block: ClassVar[int] = 1 << 16

    def depart(
        self, impact: Impact, *, near: np.ndarray | None = None, differentiate: bool = False
    ) -> Departure:
        """The end of each contact. Where no end was found, the contact is permanent if a steady
        contact at Λ holds the ball, and the status is undecided otherwise.

        If the contact also ends at p = 0, a slow ball that the load pulls meets no force there. Its
        contact then has the duration 0, and the ball continues its flight below p = 0.

        The ends are the first ones also near given durations. Which balls stick is not computed
        then, because it costs a second contact.
        """
        if near is not None:
            return self._departed(self._not_too_fast(impact), differentiate=True)
        departure = self._departed(impact, differentiate)
        return self._with_sticking(impact, departure) if differentiate else departure

    def _not_too_fast(self, impact: Impact) -> Impact:
        """The impacts without the speeds, to which Newton's method leaps next to an end of a
        branch, at which damped contacts take thousands of panels.
        """
        strongest = 1 + self.amplitude
        known = np.abs(impact.velocity) <= _FASTEST * strongest
        return impact._replace(velocity=np.where(known, impact.velocity, np.nan))

    def _departed(self, impact: Impact, differentiate: bool) -> Departure:
        """The ends of the contacts, without the marks of the balls that stick."""
        # Without the maximum a displacement of 0 gives the depth -0.
        depth = np.maximum(-impact.displacement, 0.0)
        free = self._meets_no_force(impact, depth)
        end, held = self._ends(impact, depth, free, differentiate)
        duration = np.where(free, 0.0, end.duration)
        displacement = np.where(free, -depth, -end.penetration)
        # A ball that is released below the table's level may move down, if the load pulls it.
        velocity = np.where(end.penetration > 0, -end.rate, np.maximum(-end.rate, 0.0))
        velocity = np.where(free, impact.velocity, velocity)
        phase = impact.phase + duration
        flight = Flight(displacement, velocity, *table(phase, self.amplitude), self.amplitude)
        no_end = np.isnan(duration)
        status = np.where(no_end, Status.UNDECIDED, Status.BOUNCING)
        status[held] = Status.PERMANENT_CONTACT
        return Departure(
            phase=phase,
            duration=np.where(no_end, np.inf, duration),
            flight=flight,
            status=status,
            by=end,
        )

    def within(
        self, impact: Impact, departure: Departure, time: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times 0 ≤ s ≤ D since the starts of contacts, of shape (..., contacts)."""
        which = np.broadcast_to(np.arange(impact.phase.size), time.shape).ravel()
        spans = ContactSpan(
            displacement=impact.displacement,
            velocity=impact.velocity,
            phase=impact.phase,
            amplitude=np.broadcast_to(self.amplitude, impact.phase.shape),
            duration=departure.duration,
            release_displacement=departure.flight.displacement,
            release_velocity=departure.flight.velocity,
        )
        found = self.law.take(which).during(pick(spans, which), time.ravel())
        displacement, velocity = (x.reshape(time.shape) for x in found)
        return displacement, velocity

    def release_function(
        self, impact: Impact, departure: Departure
    ) -> Callable[[np.ndarray], np.ndarray] | None:
        """δ + κ δ′ within contacts, by the motion of the law; None for a law without a κ."""
        if self.law.lag is None:
            return None
        lag = self.law.lag

        def at(time: np.ndarray) -> np.ndarray:
            displacement, velocity = self.within(impact, departure, time)
            return displacement + lag * velocity

        return at

    def _meets_no_force(self, impact: Impact, depth: np.ndarray) -> np.ndarray:
        """Whether a ball at the surface meets no force, because the load pulls it."""
        if not isinstance(self.law, LoadedLaw):
            return np.zeros_like(depth, dtype=bool)
        load = 1 - table(impact.phase, self.amplitude)[1]
        grip = self.law.under(load).grip(depth, -impact.velocity)
        return (depth == 0) & (grip < 0)

    def _ends(
        self, impact: Impact, depth: np.ndarray, free: np.ndarray, differentiate: bool
    ) -> tuple[ContactEnds, list[int]]:
        """The ends of the contacts, and the indices of those that are permanent."""
        one = np.ones_like(impact.phase)
        start = Start(
            depth=depth,
            # No contact is computed for free balls, because none of its panels would be accepted.
            rate=np.where(free, np.nan, -impact.velocity),
            phase=impact.phase,
            amplitude=self.amplitude * one,
            weight=one,
        )
        compliant = not self.law.shape and rest(self.law) > _COMPLIANT
        attempts = (_SOME_PANELS, MOST_PANELS) if compliant else (MOST_PANELS,)
        for panels in attempts:
            end = march(self.law, start, panels, differentiate=differentiate, longest=_LASTING)
            lost = np.flatnonzero(np.isnan(end.duration) & ~free)
            held = [int(k) for k in lost if holds(self.law.take(k), float(start.amplitude[k]))]
            if len(held) == lost.size:
                break
        return end, held

    def _with_sticking(self, impact: Impact, departure: Departure) -> Departure:
        """The departures with the balls marked whose contact ends because the load changes.

        An undamped linear contact that starts at zero speed under a constant load lasts exactly
        twice as long as a free impact; the contact of these balls lasts longer.
        """
        speed = np.maximum(-impact.velocity, np.finfo(float).tiny)
        # A signature is tabulated for a single law only.
        impact_of = self.law.signature(speed) if self.law.shape else Signature(self.law)(speed)
        of_free_impact = impact_of.duration
        return departure._replace(sticks=departure.duration > 2 * of_free_impact)

    def resumption(self, flight: Flight) -> tuple[np.ndarray, np.ndarray]:
        """A time before which the balls have not landed, and whether their contact resumes then."""
        if self.law.lag is not None:
            return super().resumption(flight)
        return sampled_resumption(flight, self.law)

    def jacobian(
        self, impact: Impact, departure: Departure, after: Impact, passed: np.ndarray
    ) -> Jacobian:
        """Derivative of the map over contact and flight; NaN if either impact is a resumption, or
        if the ball meets no force.
        """
        known = ~(impact.is_resumption | after.is_resumption)
        after = after._replace(velocity=np.where(known, after.velocity, np.nan))
        by_phase = departure.by.jacobian[:, :, 0]
        # v = -δ′, so that the derivatives with respect to δ′ have the other sign.
        by_speed = departure.by.jacobian[:, :, 1]
        released = (
            Deviation(1 + by_phase[:, 0], -by_phase[:, 1], -by_phase[:, 2]),
            Deviation(-by_speed[:, 0], by_speed[:, 1], by_speed[:, 2]),
        )
        return self.over_flight(released, departure, after, passed)

    def contraction(self, impact: Impact, departure: Departure) -> np.ndarray:
        """exp(-∫ ∂f/∂p′ dτ) over each contact.

        If the law depends on the speed at the start, it follows from the derivative of the contact:
        with p′ = u at the release, the determinant of (φ + D, u) by (φ, v), times u/v.
        """
        if not self.law.feels_start_speed:
            return departure.by.contraction
        by_phase, by_speed = (departure.by.jacobian[:, :, k] for k in range(2))
        determinant = (1 + by_phase[:, 0]) * by_speed[:, 2] - by_speed[:, 0] * by_phase[:, 2]
        return np.abs(determinant * departure.by.rate / impact.velocity)


def sampled_resumption(flight: Flight, law: ForceLaw) -> tuple[np.ndarray, np.ndarray]:
    """The result of :func:`~bouncing_ball_beyond.models.resumption.resumption` for a law without a
    lag, whose grip is sampled along the flights of slow balls.
    """
    depth = -flight.displacement
    rate = -flight.velocity
    slopes = slopes_of(law.grip, depth, rate)
    lag = slopes.by_rate / slopes.by_penetration
    by_load = under(law, 1.0).grip(depth, rate) - law.grip(depth, rate)
    fast = leaves_fast(flight, lag, by_load / slopes.by_penetration)
    return of_slow_balls(
        flight, np.flatnonzero(~fast), lambda slow, which: _sampled(slow, law.take(which))
    )


def _sampled(flight: Flight, law: ForceLaw) -> tuple[np.ndarray, np.ndarray]:
    """The time at which the grip returns or δ reaches 0, and whether the grip returns first."""

    def held(time):
        displacement, rate, second, _ = flight.gap(time)
        return under(law, -second).grip(np.maximum(-displacement, 0.0), -rate) > 0

    rise = first_zero(Rise(flight), np.zeros_like(flight.velocity))
    share = np.linspace(0, 1, _SAMPLES)[1:-1, np.newaxis]
    now = held(share * rise.time)
    found = now.any(axis=0)
    # The first sample with a positive grip, and the sample before it.
    right = np.where(found, share[now.argmax(axis=0), 0], 1.0) * rise.time
    left = np.maximum(right - rise.time / (_SAMPLES - 1), 0.0)
    for _ in range(_BISECTIONS):
        middle = (left + right) / 2
        now = held(middle)
        left = np.where(now, left, middle)
        right = np.where(now, middle, right)
    # For a ball that falls back before it reaches δ = 0 the grip returns at its top at the latest.
    back = found | rise.ended | (rise.rate <= 0)
    return np.where(back, right, rise.time), back
