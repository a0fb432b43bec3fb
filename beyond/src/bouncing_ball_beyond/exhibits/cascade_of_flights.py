r"""The openings of stiff contacts between permanent contact and chattering (beyond the paper).

At Λ_SD permanent contact ends. With the displacement release a T-periodic orbit with one flight per
period follows it (``docs/cascade-of-flights.md``). As Λ grows, the contact after the landing
oscillates higher, until the ball touches the level of the table. There the contact opens: above
this Λ the orbit has one more flight. The new flight begins with zero length and changes the return
map as the power 3/2 of Λ - Λ_k. Opening k, where flight k + 1 begins, is at
``E_k = ϖ² (Λ_k - Λ_SD)``. On a given contact it is the special orbit "grazing of a release" of
:func:`bouncing_ball_beyond.follow`.

For a stiff contact E_k has a limit. The ball leaves near the top of the table. Let s = ϖτ be the
time of the contact, measured from the top, δ = x/ϖ⁴ and Λ = 1 + C/ϖ². The motion is then ::

    x″ + 2ζx′ + x = C - s²/2   in contact,      x″ = C - s²/2   in flight

and does not depend on ϖ. Before the first flight the ball follows ``p(s) = E - (s - 2ζ)²/2``,
E = C + 1 - 2ζ², because the oscillation of the long contact has decayed. For large E the flights
chatter: the first landing has a speed of order E^{3/2} under an acceleration of order E, the speed
of flight k is r^k times as large, and the last flight is that whose duration is of order 1. Hence
``E_{k+1}/E_k → 1/r²``, up to a relative error of order k r^k, the ratio of the duration of k
contacts to that of the first flight.
"""

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
import scipy
import xarray as xr

from bouncing_ball_beyond.inherited.datasets.parameters import (
    LossyRestitution,
    Many,
    Parameters,
    number,
)
from bouncing_ball_beyond.inherited.datasets.variables import Variable, described
from bouncing_ball_beyond.inherited.errors import require
from bouncing_ball_beyond.models.damping import damping_ratio

VARIABLES = {
    "flights": Variable("flights of the orbit in a period", symbol="k"),
    "opening": Variable("opening that is compared with the next one", symbol="k"),
    "stiff_opening": Variable(
        "ϖ² times the distance of an opening from Λ_SD, limit for ϖ → ∞", symbol="E_k"
    ),
    "stiff_opening_ratio": Variable("r² E_{k+1}/E_k of the limits for ϖ → ∞", budget=1e-12),
}

# Number of samples of an oscillation, among which its first maximum is bracketed.
_FINE = 400
# The search for an opening goes up in steps of this factor of E.
_STEP = 1.2
# It begins at this E, and for the next opening above the last one by this fraction, where the new
# flight is resolved.
_LOWEST = 1e-3
_ABOVE = 1e-3


class Flights(Parameters):
    """Restitution coefficients of stiff contacts, and the number of openings of each."""

    restitution: Many[LossyRestitution]
    flights: Annotated[int, number("openings that are computed", ge=2, le=6)]


def cascade_of_flights(parameters: Flights) -> xr.Dataset:
    """The limits of the openings for stiff contacts.

    ``stiff_opening`` (restitution, flights) is the limit of ``E = ϖ²(Λ - Λ_SD)`` up to which the
    orbit has this number of flights, and ``stiff_opening_ratio`` (restitution, opening) is r² times
    the limit of the next opening over that of this one.
    """
    restitution = np.array(parameters.restitution)
    most = parameters.flights
    limits = np.stack([stiff_openings(float(zeta), most) for zeta in damping_ratio(restitution)])
    growth = np.square(restitution)[:, np.newaxis] * limits[:, 1:] / limits[:, :-1]
    return described(
        {
            "stiff_opening": (("restitution", "flights"), limits),
            "stiff_opening_ratio": (("restitution", "opening"), growth),
        },
        coords={
            "restitution": restitution,
            "flights": np.arange(1, most + 1),
            "opening": np.arange(1, most),
        },
        variables=VARIABLES,
    )


def stiff_openings(zeta: float, most: int) -> np.ndarray:
    """The limits of E_1, E_2, … for ϖ → ∞, shape (most,).

    Raises
    ------
    ModelError
        If ζ is not in (0, 0.9], where the oscillation after a landing can be resolved.

    Examples
    --------
    >>> stiff_openings(float(damping_ratio(0.85)), 3).round(2).tolist()
    [8.61, 22.51, 44.8]
    """
    require(0 < zeta <= 0.9, zeta, "damping ratio ζ", "in (0, 0.9]")
    found: list[float] = []

    def highest(excess: float) -> float:
        return _highest(excess, zeta, len(found) + 1)

    high = _LOWEST
    while len(found) < most:
        low = high
        while highest(high) < 0:
            low = high
            high = _STEP * high
        found.append(scipy.optimize.brentq(highest, low, high, xtol=1e-13))
        high = found[-1] * (1 + _ABOVE)
    return np.array(found)


def _highest(excess: float, zeta: float, landings: int) -> float:
    """The highest x in the contact after so many landings, at E; -1 if an earlier contact stays
    closed, or if the ball sinks throughout this one.
    """
    speed = np.sqrt(2 * excess)
    place = 2 * zeta - speed
    for landing in range(1, landings + 1):
        pull = excess + 2 * zeta * zeta - 1 - place * place / 2
        flight = _flight_time(place, pull, speed)
        speed = speed + flight * (pull - flight * (place / 2 + flight / 6))
        place = place + flight
        contact = _Contact.of(excess, zeta, place, speed)
        top = contact.first_maximum()
        if top is None:
            break
        height = float(contact.height(top))
        if landing == landings:
            return height
        if height <= 0:
            break
        duration = contact.end(top)
        speed = contact.rate(duration)
        place = place + duration
    return -1.0


def _flight_time(place: float, pull: float, speed: float) -> float:
    """Duration of a flight from s = ``place`` with x″ = ``pull`` and x′ = ``speed``."""
    # The flight rises by t (speed + pull t/2 - place t²/6 - t³/24).
    zeros = np.roots([-1 / 24, -place / 6, pull / 2, speed])
    return min(x.real for x in zeros if abs(x.imag) < 1e-9 and x.real > 0)


@dataclass(frozen=True)
class _Contact:
    """A contact from its start at t = 0: p plus Re(swing e^{root t}).

    ``aside`` is s - 2ζ at the start.
    """

    excess: float
    aside: float
    root: complex
    swing: complex

    @classmethod
    def of(cls, excess: float, zeta: float, place: float, speed: float) -> "_Contact":
        """The contact that starts at s = ``place`` with x′ = ``speed``."""
        # The root of s² + 2ζs + 1.
        root = complex(-zeta, np.sqrt((1 - zeta) * (1 + zeta)))
        aside = place - 2 * zeta
        start = aside * aside / 2 - excess
        swing = complex(start, -(speed + aside + zeta * start) / root.imag)
        return cls(excess, aside, root, swing)

    def height(self, t: Any) -> Any:
        """x at times t since the start."""
        oscillation = np.real(self.swing * np.exp(self.root * t))
        return self.excess - (self.aside + t) ** 2 / 2 + oscillation

    def rate(self, t: Any) -> Any:
        """x′ at times t since the start."""
        return -self.aside - t + np.real(self.root * self.swing * np.exp(self.root * t))

    def first_maximum(self) -> float | None:
        """The time of the first maximum of x, None if x falls throughout."""
        time = self._samples()
        slope = self.rate(time)
        turns = np.flatnonzero((slope[:-1] > 0) & (slope[1:] <= 0))
        if not turns.size:
            return None
        before = turns[0]
        return scipy.optimize.brentq(self.rate, time[before], time[before + 1], xtol=1e-14)

    def end(self, top: float) -> float:
        """The time at which x returns to 0, before the first maximum at the time ``top``."""
        time = self._samples()
        rising = time[np.argmax(self.rate(time) > 0)]
        bottom = scipy.optimize.brentq(self.rate, 0.0, rising)
        return scipy.optimize.brentq(self.height, bottom, top, xtol=1e-14)

    def _samples(self) -> np.ndarray:
        return np.linspace(0, 3 * np.pi / self.root.imag, _FINE)
