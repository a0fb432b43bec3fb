r"""The equations of the n-T orbits on a contact of any law, for a continuation.

Unknowns (φ, z′_i), the phase and the velocity at the impact; parameter Λ. The contact
that starts so is solved for inside, so that two equations are left: velocity and
height of the flight that follows (Eqs. 24-25). All are of order one however short
the contact is.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from bouncing_ball.contacts.contact_law import ContactLaw
from bouncing_ball.continuation.events import Event
from bouncing_ball.orbits.branch_events import branch_events
from bouncing_ball.orbits.law_orbit import LawOrbit


@lru_cache(maxsize=64)
def _orbit(kind: Any, values: tuple, n: int, phase: float, impact: float, amplitude: float):
    """One orbit: a step along a branch asks for its residual, Jacobian and events in turn."""
    return LawOrbit.at(n, kind(*values), amplitude, phase, impact)


@dataclass(frozen=True)
class LawSystem:
    """n-T orbits as a :class:`~bouncing_ball.continuation.problem.Problem`.

    Parameters
    ----------
    n : int
        Index of the family. It and the law's parameters may be arrays along the
        leading axis of y.
    law : ContactLaw
    """

    n: int | np.ndarray
    law: ContactLaw

    def orbit(self, y: np.ndarray) -> LawOrbit:
        """The orbits at points y = (φ, z′_i, Λ) of shape (..., 3)."""
        if y.ndim == 1 and not self.law.shape and not np.ndim(self.n):
            kind: Any = type(self.law)
            return _orbit(kind, tuple(self.law.fields()), int(self.n), *y.tolist())
        phase, impact, amplitude = (y[..., k] for k in range(3))
        return LawOrbit.at(self.n, self.law, amplitude, phase, impact)

    def point(self, orbit: LawOrbit) -> np.ndarray:
        """y of given orbits."""
        parts = orbit.phase, orbit.impact_velocity, orbit.amplitude
        return np.stack(np.broadcast_arrays(*parts), axis=-1)

    def residual(self, y: np.ndarray) -> np.ndarray:
        """Velocity defect and landing defect, shape (..., 2)."""
        return self.orbit(y).residual()[..., 1:]

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """Exact Jacobian of the residual, shape (..., 2, 3)."""
        return self.linearised(y)[1]

    def linearised(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Residual and its Jacobian, from one contact."""
        o = self.orbit(y)
        lam, end = o.amplitude[..., np.newaxis], o.release_phase[..., np.newaxis]
        phase, flight = o.phase[..., np.newaxis], o.flight_time[..., np.newaxis]
        bounce = o.bounce_velocity[..., np.newaxis]
        # Derivatives along (φ, z′_i, Λ), the last axis.
        d_phase, d_impact, d_lam = np.eye(3)
        d_speed = np.cos(phase) * d_lam - lam * np.sin(phase) * d_phase - d_impact
        by = o.contact.jacobian

        def along(row):
            by_phase, by_speed, by_lam = (by[..., row, k, np.newaxis] for k in range(3))
            return by_phase * d_phase + by_speed * d_speed + by_lam * d_lam

        d_duration, d_depth, d_rate = (along(row) for row in range(3))
        d_end, d_bounce = d_phase + d_duration, d_impact - d_duration
        velocity = np.cos(end) * d_lam - lam * np.sin(end) * d_end - d_rate - d_bounce
        landing = (
            (np.sin(end) - np.sin(phase)) * d_lam
            + lam * (np.cos(end) * d_end - np.cos(phase) * d_phase)
            - d_depth
            + flight * d_bounce
            - (bounce - flight) * d_duration
        )
        return o.residual()[..., 1:], np.stack([velocity, landing], axis=-2)

    def events(self) -> tuple[Event, ...]:
        """Bifurcations, and the ends of the domain in which an orbit makes sense."""
        return branch_events(self.orbit, LawOrbit.trace_and_determinant)
