r"""Flight below the table's level, after a release by vanishing force.

Such a release has δ_b < 0 and a rising ball: the grip vanishes, which is y = δ + κ δ′ = 0 for the
laws with a lag κ. In the free flight y first rises from 0. Either δ reaches 0 first, and the
flight ends with a landing as usual, or y falls back to 0 while δ < 0. The contact then resumes
at δ < 0, while the ball is still rising.

Most balls leave fast. With G = 1 + Λ, the strongest relative gravity, the conditions ::

    v² + 2Gδ_b > 0   and   √(v² + 2Gδ_b) ≥ κ G

are sufficient for δ to reach 0 while y increases. The other balls are followed by the certified
steps of :mod:`bouncing_ball.numerics.first_zero`. A ball that meets no force at p = 0, because the
load pulls it, is followed in the same way while it sinks. If a law has no lag, κ follows from the
slopes of its grip at the release, and the grip of slow balls is sampled until they are above the
table; a return of the grip between two samples would be missed.
"""

import numpy as np

from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.numerics.first_zero import Motion, State, first_zero
from bouncing_ball.paper.contact.law import ContactLaw, slopes_of
from bouncing_ball.paper.motion.dynamics import Departure, Dynamics, Impact
from bouncing_ball.paper.motion.flight import Flight, Rise, land

# Number of samples of the grip of a slow ball, and of bisections for the time of its return.
_SAMPLES = 65
_BISECTIONS = 60


class _Unloaded(Motion):
    """The motion -y in free flight; the search ends where δ ≥ 0."""

    def __init__(self, flight: Flight, lag):
        self.flight, self.lag = flight, lag
        self.forcing = flight.amplitude * np.sqrt(1 + lag * lag)

    def __call__(self, time: np.ndarray) -> State:
        lag, forcing = self.lag, self.forcing
        displacement, rate, second, third = self.flight.gap(time)
        # At the release y = 0 but for rounding; this zero is not the one that is searched for.
        y = np.where(time == 0, 0.0, displacement + lag * rate)
        # The fourth derivative of δ is minus that of the table: δ⁗ = -Λ sin τ = -(1 + δ″).
        falls = -(rate + lag * second), -(second + lag * third), -(third - lag * (1 + second))
        return State(-y, *falls, 1 + forcing, forcing, forcing, displacement >= 0)


def resumption(flight: Flight, law: ContactLaw) -> tuple[np.ndarray, np.ndarray]:
    """A time before which released balls have certainly not landed, and whether contact resumes.

    If a ball's contact resumes, it does so at this time.
    """
    time, resumed = flight.sure(), np.zeros(flight.velocity.shape, dtype=bool)
    if np.any(law.lag != 0):
        slow = np.flatnonzero(~_leaves_fast(flight, law))
        if slow.size:
            find = _sampled if law.lag is None else _certified
            part = flight.take(slow)
            time[slow], back = find(part, law.take(slow))
            resumed[slow] = back & (part.gap(time[slow])[0] < 0)
    return time, resumed


def _leaves_fast(flight: Flight, law: ContactLaw) -> np.ndarray:
    """Whether δ certainly reaches 0 before the grip can return."""
    lag, late = law.lag, 0.0
    if lag is None:
        state = -flight.displacement, -flight.velocity
        slopes = slopes_of(law.grip, *state)
        lag = slopes.by_rate / slopes.by_penetration
        # A grip that depends on the load also changes with it; |a′| is at most Λ.
        late = (law.loaded_grip(*state, 1.0) - law.loaded_grip(*state, 0.0)) / slopes.by_penetration
    inside, table = flight.room(), flight.amplitude
    return (
        (inside > 0)
        & (flight.velocity >= 0)
        & (np.sqrt(np.maximum(inside, 0.0)) >= lag * (1 + table) + late * table)
    )


def _certified(flight: Flight, law: ContactLaw) -> tuple[np.ndarray, np.ndarray]:
    """The time at which y falls back to 0 or δ reaches 0, and whether y falls back first."""
    found = first_zero(_Unloaded(flight, law.lag), np.zeros_like(flight.velocity))
    return found.time, ~found.ended


def _sampled(flight: Flight, law: ContactLaw) -> tuple[np.ndarray, np.ndarray]:
    """The time at which the grip returns or δ reaches 0, and whether the grip returns first."""

    def held(time):
        displacement, rate, second, _ = flight.gap(time)
        return law.loaded_grip(np.maximum(-displacement, 0.0), -rate, -second) > 0

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
        left, right = np.where(now, left, middle), np.where(now, middle, right)
    # For a ball that falls back before it reaches δ = 0 the grip returns at its top at the latest.
    back = found | rise.ended | (rise.rate <= 0)
    return np.where(back, right, rise.time), back


class ResumingDynamics(Dynamics):
    """The dynamics of contacts of finite duration, whose flights may end by a resumption."""

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
