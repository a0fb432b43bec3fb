r"""What follows a release by vanishing force, below the table's level.

With a release by force the ball is let go at δ_b < 0, rising, where the grip vanishes:
y = δ + κ δ′ = 0 for the laws with a lag κ. In free flight y first rises from 0. Either δ
reaches 0 first, and the flight ends by a landing like any other; or y falls back to 0
while δ < 0, and the contact resumes there, at δ < 0 and with the ball still rising.

Most balls leave fast: with G = 1 + Λ the strongest relative gravity,

    v² + 2Gδ_b > 0   and   √(v² + 2Gδ_b) ≥ κ G

are enough for δ to reach 0 with y increasing all the way. Only the rest are
followed, by the same certified steps. Where a law has no lag, κ is that of its grip's
slopes at the release, and the grip of slow balls is sampled until they are out of the
table: that it does not return between two samples is not certified.
"""

import numpy as np

from bouncing_ball.contacts.contact_law import ContactLaw
from bouncing_ball.motion.ensembles import pick
from bouncing_ball.motion.first_zero import State, first_zero
from bouncing_ball.motion.landing import Flight, Rise

# Samples of the grip of a slow ball, and bisections of its return.
_SAMPLES = 65
_BISECTIONS = 60


class _Unloaded:
    """The motion -y in free flight; it ends where δ ≥ 0."""

    def __init__(self, flight: Flight, lag):
        self.flight, self.lag = flight, lag
        self.forcing = flight.amplitude * np.sqrt(1 + lag * lag)

    def __call__(self, time: np.ndarray) -> State:
        lag, forcing = self.lag, self.forcing
        displacement, rate, second, third = self.flight.gap(time)
        # Fourth derivative of δ: minus that of the table.
        fourth = -1 - second
        y = displacement + lag * rate
        # Exactly zero at the release, which rounding must not turn into a zero.
        y = np.where(time == 0, 0.0, y)
        return State(
            -y,
            -(rate + lag * second),
            -(second + lag * third),
            -(third + lag * fourth),
            1 + forcing,
            forcing,
            forcing,
            displacement >= 0,
        )

    def take(self, which: np.ndarray) -> "_Unloaded":
        return _Unloaded(self.flight.take(which), pick(self.lag, which))

    def skip(self, time: np.ndarray, steps: int) -> np.ndarray:
        return time


def leaves_fast(flight: Flight, law: ContactLaw) -> np.ndarray:
    """Whether δ certainly reaches 0 before the force can return."""
    lag = law.lag
    if lag is None:
        slopes = law.grip_slopes(-flight.displacement, -flight.velocity)
        lag = slopes.by_rate / slopes.by_penetration
    inside = flight.room()
    return (inside > 0) & (np.sqrt(np.maximum(inside, 0.0)) >= lag * flight.gravity)


def resumption(flight: Flight, law: ContactLaw) -> tuple[np.ndarray, np.ndarray]:
    """A time without landing of balls let go below the table's level, and whether they are
    held again then."""
    if law.lag is not None:
        unloaded = _Unloaded(flight, law.lag)
        found = first_zero(unloaded, np.zeros_like(flight.velocity))
        return found.time, ~found.ended & (flight.gap(found.time)[0] < 0)

    def held(time):
        displacement, rate, _, _ = flight.gap(time)
        return law.grip(np.maximum(-displacement, 0.0), -rate) > 0

    rise = first_zero(Rise(flight), np.zeros_like(flight.velocity))
    # A ball that falls back into the table is held at its highest point at the latest.
    back = rise.ended | (rise.rate <= 0)
    share = np.linspace(0, 1, _SAMPLES)[1:-1, np.newaxis]
    now = held(share * rise.time)
    back |= now.any(axis=0)
    # The first sample that is held, and the one before it.
    right = np.where(now.any(axis=0), share[now.argmax(axis=0), 0], 1.0) * rise.time
    left = np.maximum(right - rise.time / (_SAMPLES - 1), 0.0)
    for _ in range(_BISECTIONS):
        middle = (left + right) / 2
        now = held(middle)
        left, right = np.where(now, left, middle), np.where(now, middle, right)
    time = np.where(back, right, rise.time)
    return time, back & (flight.gap(time)[0] < 0)
