"""Impacts with a restitution coefficient: flight, impact, chattering, sticking.

An impact turns δ′ into ``-r δ′`` (Eq. 5). While the relative gravity g = 1 - Λ sin τ is
positive, infinitely many ever smaller bounces take a finite time T. Let v be δ′ after an impact,
and ``g′ = -Λ cos τ`` the rate of change of g. Then ::

    T = T₀ (1 - g′ T₀/(3g) + ...),    T₀ = 2v/(g (1 - r))

This sum replaces the bounces once Λ T₀ and T₀ are below 10⁻⁵ g, where the
next term is below 10⁻¹⁵. The ball then sticks to the table until it lifts off
when Λ sin τ rises through 1; for Λ ≤ 1 it never lifts off.
"""

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import require
from bouncing_ball.paper.motion.deviations import Deviation, Jacobian
from bouncing_ball.paper.motion.dynamics import Departure, Dynamics, Impact
from bouncing_ball.paper.motion.flight import Flight, table
from bouncing_ball.paper.motion.sticking import lifted, pressed, stay

# Bound of Λ T₀/g and T₀/g below which chattering is summed up.
_CHATTER = 1e-5
# Where g is tiny (Λ near 1), chattering is also summed up if T₀ is below rounding.
_INSTANT = np.finfo(float).eps


@dataclass(frozen=True, repr=False)
class RestitutionDynamics(Dynamics):
    """Impacts and flights of the restitution model; ``law`` holds numbers r."""

    forgets: ClassVar[bool] = True

    @classmethod
    def of(cls, law: Any, amplitude: ArrayLike) -> Self:
        """The dynamics of restitution coefficients r at Λ.

        Raises
        ------
        ModelError
            If r or Λ is outside its range.
        """
        r = np.asarray(law, dtype=float)
        require((r > 0) & (r <= 1), r, "restitution coefficient r", "in (0, 1]")
        return super().of(r, amplitude)

    def rebound(self, speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """r and d(r v)/dv at impact speeds v > 0; for a constant r both are r."""
        return self.law, self.law

    def depart(self, impact: Impact, *, differentiate: bool = False) -> Departure:
        """The flight after each impact, or the rest on the table after chattering."""
        amplitude = self.amplitude
        r = self._rebound_of(impact)[0]
        velocity = -r * impact.velocity
        x, y = table(impact.phase, amplitude)
        gravity, down = 1 - y, pressed(x, y)
        # T₀ has no meaning where the relative gravity is not positive, or for r = 1.
        loss = gravity * (1 - r)
        usable = down & (loss > 0)
        total = np.where(usable, 2 * velocity, 0.0) / np.where(usable, loss, 1.0)
        limit = np.maximum(_CHATTER * gravity / np.maximum(amplitude, 1.0), _INSTANT)
        short = usable & (total <= limit)
        sticks = short | (down & (velocity == 0))
        none = np.zeros_like(x)
        flight = Flight(none, velocity, x, y, amplitude)
        if not sticks.any():
            departure = Departure(impact.phase, none, flight, none)
            return lifted(departure, amplitude) if differentiate else departure
        correction = np.where(short, x * total, 0.0) / np.where(short, 3 * gravity, 1.0)
        settling = np.where(sticks, total * (1 + correction), 0.0)
        settled = Departure(impact.phase + settling, settling, flight, none, settling)
        departure = stay(settled, sticks, amplitude)
        return lifted(departure, amplitude) if differentiate else departure

    def jacobian(
        self, impact: Impact, departure: Departure, after: Impact, passed: np.ndarray
    ) -> Jacobian:
        """Derivative of the map over impact and flight.

        It is zero if the ball sticks, because its later motion does not depend on the impact.
        """
        slope = self._rebound_of(impact)[1]
        none, free = np.zeros_like(passed), np.where(departure.sticks, 0.0, 1.0)
        released = Deviation(free, none, none), Deviation(none, none, -slope * free)
        return self.landed(released, departure, after, passed)

    def _rebound_of(self, impact: Impact) -> tuple[np.ndarray, np.ndarray]:
        return self.rebound(np.maximum(-impact.velocity, np.finfo(float).tiny))
