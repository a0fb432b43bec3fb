"""The equations of the corrected model's n-T orbits for a continuation.

Unknowns (ψ, w), the phase of the instant and the velocity after it; parameter Λ.
They have the form of :mod:`bouncing_ball.orbits.corrected_branch`;
continued, they check both the continuation and the formula.
"""

from dataclasses import dataclass

import numpy as np

from bouncing_ball.contacts.corrected_map import impact
from bouncing_ball.contacts.signature import Signature
from bouncing_ball.continuation.events import Event
from bouncing_ball.orbits.branch_events import bifurcations
from bouncing_ball.orbits.corrected_orbit import CorrectedOrbit


@dataclass(frozen=True)
class CorrectedSystem:
    """n-T orbits as a :class:`~bouncing_ball.continuation.problem.Problem`.

    Parameters
    ----------
    n : int
        Index of the family.
    law : Signature

    Examples
    --------
    >>> from bouncing_ball.contacts.signature import LinearSignature
    >>> from bouncing_ball.contacts.spring_damper import SpringDamper
    >>> system = CorrectedSystem(1, LinearSignature(SpringDamper(5.0, 0.0)))
    >>> [abs(round(float(x), 12)) for x in system.residual(np.array([np.pi / 2, np.pi, 1.0]))]
    [0.0, 0.0]
    """

    n: int | np.ndarray
    law: Signature

    def orbit(self, y: np.ndarray) -> CorrectedOrbit:
        """The orbits at points y of shape (..., 3)."""
        psi, after, amplitude = (y[..., k] for k in range(3))
        arrival = after - 2 * np.pi * self.n
        instant = impact(self.law, amplitude, psi, arrival).instant
        start, phase = arrival + instant.delay, psi - instant.delay
        duration = instant.duration + 0 * psi
        return CorrectedOrbit(self.n, self.law, amplitude, phase, duration, start)

    def point(self, orbit: CorrectedOrbit) -> np.ndarray:
        """y of given orbits."""
        parts = orbit.hit.phase, orbit.bounce_velocity + orbit.after, orbit.amplitude
        return np.stack(np.broadcast_arrays(*parts), axis=-1)

    def residual(self, y: np.ndarray) -> np.ndarray:
        """Velocity defect and landing defect, shape (..., 2)."""
        return self.orbit(y).residual()

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """Exact Jacobian of the residual, shape (..., 2, 3)."""
        psi, amplitude = y[..., 0], y[..., 2]
        sine, cosine = np.sin(psi), np.cos(psi)
        hit = impact(self.law, amplitude, psi, y[..., 1] - 2 * np.pi * self.n)
        here, _ = hit.instant.tangent(hit.speed, 1 - amplitude * sine)
        r, load = here.restitution, here.load
        out = np.zeros((*y.shape[:-1], 2, 3))
        out[..., 0, 0] = -amplitude * ((1 + r) * sine + load * cosine)
        out[..., 0, 1] = -r - 1
        out[..., 0, 2] = (1 + r) * cosine - load * sine
        out[..., 1, 1] = 1
        return out

    def events(self) -> tuple[Event, ...]:
        """Saddle-node and period doubling."""
        return bifurcations(self.orbit)
