r"""Impacts of the corrected restitution model: instant, release, flight, landing.

The impact is that of :mod:`bouncing_ball.contacts.corrected_map`; the flight that
follows is looked at from the end of the contact on, D - t_c after the
instant. There the ball leaves if it rises and comes above the table's level.
If not, the impact was too weak for its load, v of the order of a D, and the
ball stays: until the table recedes with more than gravity, at Λ sin τ = 1 on
the way up, or for ever if Λ ≤ 1.

The landing on the table's level is found as in both other models, certified to
be the first. From there to the instant, where the ball is h = v t_c(v) deep, a
few steps of Newton's method on the continued flight lead, from the solution
for a constant load.

A state on the Poincaré section is (φ, δ′) at the start of contact, t_c before
the instant. There the continued flight meets the table's level but for a t_c²/2.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.corrected_map import Hit, impact, meeting, start_of
from bouncing_ball.contacts.signature import Signature
from bouncing_ball.motion.angles import reduce_angle, table
from bouncing_ball.motion.ensembles import BLOCK, flatten, pick
from bouncing_ball.motion.first_zero import first_zero
from bouncing_ball.motion.follow import BELOW, Columns, follow, next_impact
from bouncing_ball.motion.landing import Flight, Rise, land
from bouncing_ball.motion.rest import lift_off
from bouncing_ball.motion.sequence import Cycle, ImpactSequence, Status
from bouncing_ball.motion.starts import approach, check_amplitude, check_impact

# Newton steps from the landing to the instant: the start is right to the third
# order in t_c, and each step doubles that.
_DESCENT = 4


class _Impact(NamedTuple):
    """Starts of contact, at the table's level, and the instants that follow."""

    phase: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    hit: Hit


class _Departure(NamedTuple):
    """Ends of contact, with the flight from then on, and a time of flight by which
    the ball has not landed."""

    phase: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    duration: np.ndarray
    status: np.ndarray
    start: np.ndarray
    flight: Flight

    def take(self, which: Any) -> "_Departure":
        fields: Any = self
        return _Departure(*(x.take(which) for x in fields))


def _leaves(flight: Flight) -> tuple[np.ndarray, np.ndarray]:
    """Whether balls come above the table, and a time by which they have not landed."""
    rising, start = flight.velocity > 0, flight.sure()
    unsure = np.flatnonzero(rising & (flight.room() <= 0))
    if unsure.size:
        part = flight.take(unsure)
        rise = first_zero(Rise(part), np.zeros(unsure.size))
        rising[unsure] = ~(rise.ended | rise.undecided) & (rise.rate > 0)
        # From the table's level on, against the strongest relative gravity.
        start[unsure] = rise.time + 2 * rise.rate / part.gravity
    return rising, start


def _descend(phase, relative, law: Signature, amplitude):
    """Time from landings (phase, δ′) on the table's level to the instants.

    There ``δ + h(-δ′) = 0``. With a constant load a and delay t_c,
    ``a s²/2 + (u - a t_c) s = u t_c`` for the landing speed u = -δ′.
    """
    x, y = table(phase, amplitude)
    fall = Flight(np.zeros_like(relative), relative, x, y, amplitude)
    delay = law(-relative).delay
    pull = (1 - y) * delay
    ahead = -relative - pull
    both = ahead + np.sqrt(relative * relative + pull * pull)
    time = np.where(both > 0, -2 * delay * relative / np.where(both > 0, both, 1.0), 2 * delay)
    for _ in range(_DESCENT):
        displacement, rate, acceleration, _ = fall.gap(time)
        here = law(-rate)
        by_time = rate - (here.delay - here.d_delay * rate) * acceleration
        missing = displacement - rate * here.delay
        time = time - np.where(by_time < 0, missing / np.where(by_time < 0, by_time, -1.0), 0.0)
    return time


class _Corrected(NamedTuple):
    """The :class:`~bouncing_ball.motion.follow.Dynamics` of the corrected model."""

    law: Signature
    amplitude: np.ndarray
    block: int = BLOCK

    @property
    def columns(self) -> Columns:
        # Contacts start at the level of the table and may end elsewhere.
        return {"release_displacement": BELOW["release_displacement"]}

    def take(self, which: Any) -> "_Corrected":
        return _Corrected(self.law.take(which), pick(self.amplitude, which))

    def start(self, phase: np.ndarray, velocity: np.ndarray) -> _Impact:
        arrival = velocity + self.amplitude * np.cos(phase)
        instant = meeting(self.law, self.amplitude, phase, arrival)
        hit = impact(self.law, self.amplitude, *instant)
        return _Impact(phase, np.zeros_like(phase), velocity, hit)

    def depart(self, impact: _Impact) -> _Departure:
        hit, amplitude = impact.hit, self.amplitude
        x, y = table(hit.phase, amplitude)
        law = hit.instant
        rest = law.duration - law.delay
        whole = Flight(hit.height - y, hit.velocity - x, x, y, amplitude)
        displacement, velocity, _, _ = whole.gap(rest)
        end = hit.phase + rest
        x, y = table(end, amplitude)
        flight = Flight(displacement, velocity, x, y, amplitude)
        duration = law.duration + np.zeros_like(end)
        leaves, start = _leaves(flight)
        status = np.zeros(end.shape, dtype=np.int8)
        if leaves.all():
            return _Departure(end, displacement, velocity, duration, status, start, flight)
        rest = lift_off(end, amplitude)
        forever = ~leaves & (amplitude <= 1)
        status[forever] = Status.PERMANENT_CONTACT
        wait = np.where(forever, np.inf, rest.wait)
        still = np.where(forever, np.nan, 0.0)
        pairs = ((displacement, still), (velocity, still), (x, rest.x), (y, rest.y))
        pairs += ((start, rest.flown), (end, rest.phase), (duration, duration + wait))
        displacement, velocity, x, y, start, end, duration = (
            np.where(leaves, a, b) for a, b in pairs
        )
        flight = Flight(displacement, velocity, x, y, amplitude)
        return _Departure(end, displacement, velocity, duration, status, start, flight)

    def fly(self, departure: _Departure) -> tuple[_Impact, np.ndarray]:
        landing = land(departure.flight, departure.start)
        at_level = departure.phase + landing.time
        flown = landing.time + _descend(at_level, -landing.rate, self.law, self.amplitude)
        phase = reduce_angle(departure.phase + flown)
        hit = impact(self.law, self.amplitude, phase, departure.flight.thrown - flown)
        phase, velocity = start_of(self.amplitude, hit)
        passed = departure.duration + flown - hit.instant.delay
        return _Impact(reduce_angle(phase), np.zeros_like(phase), velocity, hit), passed


def _prepare(signature: Signature, amplitude, phase, relative):
    like_law = np.zeros(signature.shape)
    (lam, _), (phase, relative), shape = flatten([amplitude, like_law], [phase, relative])
    check_amplitude(lam)
    check_impact(phase, relative)
    return _Corrected(signature.flat(shape), lam), (reduce_angle(phase), relative), shape


def simulate(
    signature: Signature, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike, impacts: int
) -> ImpactSequence:
    """As :func:`bouncing_ball.motion.contact.simulate`, with contacts that are instants.

    Parameters
    ----------
    signature : Signature
        The contact law, seen from outside.
    amplitude, phase, velocity, impacts
        As there; the first impact is the start of a contact.

    Raises
    ------
    ModelError
        If Λ or a state is not finite, or if a ball rises from the table.

    Examples
    --------
    An elastic ball on a table at rest keeps its speed:

    >>> from bouncing_ball.contacts.signature import LinearSignature
    >>> from bouncing_ball.contacts.spring_damper import SpringDamper
    >>> law = LinearSignature(SpringDamper(100.0, 0.0))
    >>> simulate(law, 0.0, 0.0, -2.0, 3).impact_velocity.round(13).tolist()
    [-2.0, -2.0, -2.0]
    """
    balls, (phase, velocity), shape = _prepare(signature, amplitude, phase, velocity)
    state = phase, approach(phase, velocity, balls.amplitude)
    return follow(balls, state, None, amplitude, shape, impacts)


def corrected_cycle(
    signature: Signature, amplitude: ArrayLike, phase: ArrayLike, relative_velocity: ArrayLike
) -> Cycle:
    """The Poincaré map: from one start of contact (φ, δ′) to the next.

    Examples
    --------
    >>> from bouncing_ball.contacts.signature import LinearSignature
    >>> from bouncing_ball.contacts.spring_damper import SpringDamper
    >>> law = LinearSignature(SpringDamper(100.0, 0.0))
    >>> round(float(corrected_cycle(law, 0.0, 0.0, -2.0).relative_velocity), 13)
    -2.0
    """
    balls, state, shape = _prepare(signature, amplitude, phase, relative_velocity)
    return next_impact(balls, state, shape)
