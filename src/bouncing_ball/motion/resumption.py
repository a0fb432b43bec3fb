r"""What follows a release by vanishing force, below the table's level.

With the force release the ball is let go at δ_b < 0, rising. The table
pushes with ``F = max(0, -ϖ² y)``, y = δ + κ δ′, while δ < 0. In free flight y
first rises from 0. Either δ reaches 0 first, and the flight ends by a landing
like any other; or y falls back to 0 while δ < 0, and the contact resumes
there, at δ < 0 and with the ball still rising.

Most balls leave fast: with G = 1 + Λ the strongest relative gravity,

    v² + 2Gδ_b > 0   and   √(v² + 2Gδ_b) ≥ κ G

are enough for δ to reach 0 with y increasing all the way. Only the rest are
followed, by the same certified steps.
"""

from typing import NamedTuple

import numpy as np

from bouncing_ball.motion.contact_motion import Oscillator
from bouncing_ball.motion.first_zero import State, first_zero
from bouncing_ball.motion.landing import Flight


class Resumption(NamedTuple):
    """Times without landing, and whether the contact resumes then, at δ, δ′."""

    time: np.ndarray
    resumed: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray


class _Unloaded:
    """The motion -y in free flight; it ends where δ ≥ 0."""

    def __init__(self, flight: Flight, constants: Oscillator):
        self.flight, self.constants = flight, constants

    def __call__(self, time: np.ndarray) -> State:
        lag, forcing = self.constants.lag, self.constants.forcing
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
        return _Unloaded(self.flight.take(which), self.constants.take(which))

    def skip(self, time: np.ndarray, steps: int) -> np.ndarray:
        return time


def leaves_fast(flight: Flight, lag) -> np.ndarray:
    """Whether δ certainly reaches 0 before the force can return."""
    gravity = 1 + flight.amplitude
    inside = flight.velocity * flight.velocity + 2 * gravity * flight.displacement
    return (inside > 0) & (np.sqrt(np.maximum(inside, 0.0)) >= lag * gravity)


def resumption(flight: Flight, constants: Oscillator) -> Resumption:
    """What happens first to balls let go below the table's level."""
    found = first_zero(_Unloaded(flight, constants), np.zeros_like(flight.velocity))
    displacement, velocity, _, _ = flight.gap(found.time)
    return Resumption(found.time, ~found.ended & (displacement < 0), displacement, velocity)
