"""The equations of the restitution model's n-T orbits for a continuation.

The exact map (Eq. 5) with a flight of 2πn: unknowns (φ, v), parameter Λ. They
have the closed form of :mod:`bouncing_ball.orbits.restitution_orbit`; continued,
they check both the continuation and the formula.
"""

from dataclasses import dataclass

import numpy as np

from bouncing_ball.contacts.restitution_map import exact_map_jacobian
from bouncing_ball.continuation.events import Event
from bouncing_ball.orbits.branch_events import bifurcations
from bouncing_ball.orbits.restitution_orbit import RestitutionOrbit
from bouncing_ball.orbits.stability import trace_and_determinant


@dataclass(frozen=True)
class RestitutionSystem:
    """n-T orbits as a :class:`~bouncing_ball.continuation.problem.Problem`.

    Parameters
    ----------
    n : int
        Index of the family.
    restitution : float
        r.

    Examples
    --------
    >>> system = RestitutionSystem(1, 1.0)
    >>> defects = system.residual(np.array([np.pi / 2, np.pi, 1.0]))
    >>> [abs(round(float(x), 12)) for x in defects]
    [0.0, 0.0]
    """

    n: int | np.ndarray
    restitution: float | np.ndarray

    def orbit(self, y: np.ndarray) -> RestitutionOrbit:
        """The orbits at points y of shape (..., 3)."""
        phase, velocity, amplitude = (y[..., k] for k in range(3))
        impact = velocity - 2 * np.pi * self.n
        return RestitutionOrbit(self.n, self.restitution, amplitude, phase, 0 * phase, impact)

    def point(self, orbit: RestitutionOrbit) -> np.ndarray:
        """y of given orbits."""
        parts = orbit.phase, orbit.bounce_velocity, orbit.amplitude
        return np.stack(np.broadcast_arrays(*parts), axis=-1)

    def residual(self, y: np.ndarray) -> np.ndarray:
        """Landing gap and velocity defect after 2πn, shape (..., 2)."""
        return self.orbit(y).residual()

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """Exact Jacobian of the residual, shape (..., 2, 3).

        The table is back at its phase after 2πn, so that the gap depends on v
        alone, but for rounding.
        """
        phase, amplitude = y[..., 0], y[..., 2]
        r = self.restitution
        out = np.zeros((*y.shape[:-1], 2, 3))
        out[..., 0, 1] = 2 * np.pi * self.n
        out[..., 1, 0] = -(1 + r) * amplitude * np.sin(phase)
        out[..., 1, 1] = -r - 1
        out[..., 1, 2] = (1 + r) * np.cos(phase)
        return out

    def _trace_and_determinant(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        phase, velocity, amplitude = (y[..., k] for k in range(3))
        period = np.full_like(phase, 2 * np.pi * self.n)
        matrix = exact_map_jacobian(period, phase, velocity, amplitude, self.restitution)
        return trace_and_determinant(matrix)

    def events(self) -> tuple[Event, ...]:
        """Saddle-node and period doubling."""
        return bifurcations(self._trace_and_determinant)
