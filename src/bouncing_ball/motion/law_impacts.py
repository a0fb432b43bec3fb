r"""Impacts on a contact of any law: contact, release, flight, landing.

The contact is integrated (:mod:`bouncing_ball.motion.law_motion`), the flight and
its landing are those of every model, the landing certified to be the first.

A law that lets go where its force vanishes may take hold again while the ball is
still below the table's level. With κ = -dp/dp′ along the vanishing grip that
cannot happen to a ball that leaves fast against κ; this is certain for a grip linear in
p and p′. The grip of slower balls is sampled until they are out of the table: that
it does not return between two samples is not certified.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.laws.contact_law import ContactLaw
from bouncing_ball.contacts.release import Release
from bouncing_ball.motion import law_motion
from bouncing_ball.motion.angles import reduce_angle, table
from bouncing_ball.motion.corrected_impacts import Rise
from bouncing_ball.motion.ensembles import flatten, pick
from bouncing_ball.motion.first_zero import first_zero
from bouncing_ball.motion.follow import BELOW, Columns, Departure, Impact, follow, next_impact
from bouncing_ball.motion.landing import Flight, land
from bouncing_ball.motion.law_table import ReleaseTable
from bouncing_ball.motion.resumption import Resumption, leaves_fast
from bouncing_ball.motion.sequence import Cycle, ImpactSequence, Status
from bouncing_ball.motion.starts import approach, check_amplitude

# Samples of the grip of a slow ball, and bisections of its return.
_SAMPLES = 65
_BISECTIONS = 60


class _Contact(NamedTuple):
    """The :class:`~bouncing_ball.motion.follow.Dynamics` of a contact law."""

    law: ContactLaw
    amplitude: np.ndarray
    table: ReleaseTable | None = None
    # The release has blocks of its own; fewer here share the few contacts that last long.
    block: int = 1 << 16

    @property
    def below(self) -> bool:
        return self.law.release is not Release.DISPLACEMENT

    @property
    def columns(self) -> Columns:
        return BELOW if self.below else {}

    def take(self, which: Any) -> "_Contact":
        return self._replace(law=self.law.take(which), amplitude=pick(self.amplitude, which))

    def start(self, phase: np.ndarray, velocity: np.ndarray) -> Impact:
        return Impact.at_level(phase, velocity)

    def depart(self, impact: Impact) -> Departure:
        # -0 is no depth.
        depth = np.maximum(-impact.displacement, 0.0)
        touch = law_motion.Touch(depth, -impact.velocity, impact.phase, self.amplitude)
        end = self.table.release(touch) if self.table else law_motion.release(self.law, touch)
        status = np.where(end.undecided, Status.UNDECIDED, Status.BOUNCING)
        duration = np.where(end.undecided, np.inf, end.duration)
        velocity = np.maximum(-end.rate, 0.0)
        return Departure(impact.phase + duration, -end.depth, velocity, duration, status)

    def fly(self, departure: Departure) -> tuple[Impact, np.ndarray]:
        x, y = table(departure.phase, self.amplitude)
        flight = Flight(departure.displacement, departure.velocity, x, y, self.amplitude)
        start = flight.sure()
        below = np.zeros_like(start)
        back = np.empty(0, dtype=int)
        if self.below:
            depth, rate = -departure.displacement, -departure.velocity
            slopes = self.law.grip_slopes(depth, rate)
            lag = slopes.by_rate / slopes.by_penetration
            slow = np.flatnonzero(~leaves_fast(flight, lag))
            if slow.size:
                again = _return(self.law.take(slow), flight.take(slow))
                start[slow] = again.time
                back = slow[again.resumed]
        landing = land(flight, start)
        time, velocity = landing.time, -landing.rate
        if back.size:
            time[back] = again.time[again.resumed]
            below[back] = again.displacement[again.resumed]
            velocity[back] = again.velocity[again.resumed]
        impact = Impact(reduce_angle(departure.phase + time), below, velocity)
        return impact, departure.duration + time


def _return(law: ContactLaw, flight: Flight) -> Resumption:
    """What happens first to slow balls: out of the table, or held again."""
    rise = first_zero(Rise(flight), np.zeros_like(flight.velocity))

    def grip(time, which=slice(None)):
        part = flight if isinstance(which, slice) else flight.take(which)
        displacement, rate, _, _ = part.gap(time)
        return law.take(which).grip(np.maximum(-displacement, 0.0), -rate)

    out = ~rise.ended & (rise.rate > 0)
    # A ball that falls back into the table is held at its highest point at the latest.
    left, right = np.zeros_like(rise.time), rise.time.copy()
    held = ~out
    for share in np.linspace(0, 1, _SAMPLES)[1:-1][::-1]:
        time = share * rise.time
        now = grip(time) > 0
        held |= now
        right = np.where(now, time, right)
    # The first sample that is held, and the one before it.
    left = np.maximum(right - rise.time / (_SAMPLES - 1), 0.0)
    for _ in range(_BISECTIONS):
        middle = (left + right) / 2
        now = grip(middle) > 0
        left, right = np.where(now, left, middle), np.where(now, middle, right)
    time = np.where(held, right, rise.time)
    displacement, velocity, _, _ = flight.gap(time)
    return Resumption(time, held & (displacement < 0), displacement, velocity)


def _prepare(law: ContactLaw, amplitude, *states):
    lam = np.asarray(amplitude, dtype=float)
    check_amplitude(lam)
    (lam, _), states, shape = flatten([lam, np.zeros(law.shape)], states)
    table = None if law.shape or np.ndim(lam) else ReleaseTable(law, float(lam))
    return _Contact(law.flat(shape), lam, table), states, shape


def simulate(
    law: ContactLaw, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike, impacts: int
) -> ImpactSequence:
    """As :func:`bouncing_ball.motion.contacts.simulate`, on contacts of any law.

    Parameters
    ----------
    law : ContactLaw
        One law, or one for each ball.
    amplitude, phase, velocity, impacts
        As there.

    Raises
    ------
    ModelError
        If Λ or a state is not finite, or if a ball rises from the table.

    Examples
    --------
    An elastic ball on a hard table at rest keeps its speed:

    >>> from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley
    >>> sequence = simulate(HuntCrossley(1e6, 0.0), 0.0, 0.0, -2.0, 3)
    >>> sequence.impact_velocity.round(11).tolist()
    [-2.0, -2.0, -2.0]
    """
    balls, (phase, velocity), shape = _prepare(law, amplitude, phase, velocity)
    state = phase, approach(phase, velocity, balls.amplitude)
    return follow(balls, state, law, amplitude, shape, impacts)


def law_cycle(
    law: ContactLaw, amplitude: ArrayLike, phase: ArrayLike, relative_velocity: ArrayLike
) -> Cycle:
    """The Poincaré map: from one impact (φ, δ′) to the next.

    Examples
    --------
    >>> from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley
    >>> cycle = law_cycle(HuntCrossley(1e6, 0.0), 0.0, 0.0, -2.0)
    >>> round(float(cycle.relative_velocity), 11)
    -2.0
    """
    balls, state, shape = _prepare(law, amplitude, phase, relative_velocity)
    return next_impact(balls, state, shape)
