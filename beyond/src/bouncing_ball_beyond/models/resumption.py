r"""Flight below the table's level, after a release by vanishing force.

Such a release has δ_b < 0 and a rising ball: y = δ + κ δ′ = 0. In the free flight y first rises
from 0. Either δ reaches 0 first, and the flight ends with a landing as usual, or y falls back to 0
while δ < 0. The contact then resumes at δ < 0, while the ball is still rising.

Most balls leave fast. With G = 1 + Λ, the strongest relative gravity, the conditions ::

    v² + 2Gδ_b > 0   and   √(v² + 2Gδ_b) ≥ κ G

are sufficient for δ to reach 0 while y increases. The other balls are followed by the certified
steps of :mod:`bouncing_ball_beyond.inherited.numerics.first_zero`.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from bouncing_ball_beyond.inherited.models.flight import Unloaded, land
from bouncing_ball_beyond.inherited.numerics.arrays import pick
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.inherited.numerics.first_zero import first_zero
from bouncing_ball_beyond.models.contact import FiniteContact
from bouncing_ball_beyond.models.contacts_and_flights import Departure, Impact
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.models.flight import Flight


def resumption(flight: Flight, lag: Any) -> tuple[np.ndarray, np.ndarray]:
    """A time before which released balls have certainly not landed, and whether contact resumes.

    ``lag`` is κ. If a ball's contact resumes, it does so at this time.
    """

    def certified(slow: Flight, which: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The time at which y falls back to 0 or δ reaches 0, and whether y falls back first."""
        found = first_zero(Unloaded(slow, pick(lag, which)), np.zeros_like(slow.velocity))
        return found.time, ~found.ended

    if not np.any(lag):
        return flight.earliest_landing(), np.zeros(flight.velocity.shape, dtype=bool)
    return of_slow_balls(flight, np.flatnonzero(~leaves_fast(flight, lag)), certified)


def leaves_fast(flight: Flight, lag: Any, lag_of_load: Any = 0.0) -> np.ndarray:
    """Whether δ certainly reaches 0 before the grip δ + κ δ′ + κ_a a can return.

    ``lag`` is κ, and ``lag_of_load`` is κ_a, for a grip that depends on the load a, which is -δ″.

    Examples
    --------
    At Λ = 1 and κ = 0.1 a ball that rises fast leaves, and one that rises slowly or falls may not:

    >>> speeds = np.array([2.0, 0.1, -2.0])
    >>> leaves_fast(Flight(np.full(3, -0.01), speeds, 1.0, 0.0, 1.0), 0.1).tolist()
    [True, False, False]
    """
    square = flight.level_speed_squared()
    turned = lag * (1 + flight.amplitude) + lag_of_load * flight.amplitude
    return (square > 0) & (flight.velocity >= 0) & (np.sqrt(np.maximum(square, 0.0)) >= turned)


def of_slow_balls(
    flight: Flight,
    slow: np.ndarray,
    search: Callable[[Flight, np.ndarray], tuple[np.ndarray, np.ndarray]],
) -> tuple[np.ndarray, np.ndarray]:
    """The result of :func:`resumption` if only the balls with the indices ``slow`` may resume.

    ``search`` takes the flights of these balls and their indices. It returns the times at which
    they reach δ = 0 or their grip returns, and whether the grip returns first.
    """
    time = flight.earliest_landing()
    resumed = np.zeros(flight.velocity.shape, dtype=bool)
    if slow.size:
        part = flight.take(slow)
        time[slow], back = search(part, slow)
        resumed[slow] = back & (part.gap(time[slow])[0] < 0)
    return time, resumed


class ResumingDynamics(Dynamics):
    """The dynamics of contacts of finite duration, whose flights may end by a resumption."""

    @property
    def contact(self) -> FiniteContact:
        """The law of the contacts."""
        return self.law

    def resumption(self, flight: Flight) -> tuple[np.ndarray, np.ndarray]:
        """A time before which the balls have not landed, and whether their contact resumes then."""
        return resumption(flight, self.law.lag)

    def fly(self, departure: Departure) -> tuple[Impact, np.ndarray]:
        """The landing or an earlier resumption, and the time from the last impact to it."""
        flight = departure.flight
        start, resumed = self.resumption(flight)
        landing = land(flight, start)
        time = landing.time
        velocity = -landing.rate
        displacement = np.zeros(time.shape)
        if resumed.any():
            time[resumed] = start[resumed]
            displacement[resumed], velocity[resumed], *_ = (x[resumed] for x in flight.gap(time))
        impact = Impact(reduce_angle(departure.phase + time), displacement, velocity)
        return self.with_table(impact), departure.duration + time
