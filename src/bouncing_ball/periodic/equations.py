"""The equations of n-T orbits as a continuation problem.

If a contact is determined by its start, the unknowns are (φ, z′_i), the phase and the velocity
at the impact, and the parameter is Λ. The contact then gives its duration and the state at its
end, and two equations remain, for the velocity and the height of the flight that follows
(Eqs. 24-25). Both are of order one however short the contact is.

A linear contact may also pass the release and end at a later one, as on some orbits that are not
admissible. Its duration is therefore a third unknown, ϖ τ_b, and its release (Eq. 23) a third
equation. Of the paper's six unknowns, A and B follow from the start of contact (Eqs. 21-22) and
z′_b from the periodicity (Eq. 27), all linearly.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from bouncing_ball.numerics.events import Event, domain_limits
from bouncing_ball.periodic.stability import Bifurcation

# The relative impact velocity and the flight time vanish together where an orbit merges with
# permanent contact. The equations are singular there, and rounding errors of 1e-16 are divided
# by each of the two: the margin limits each of them to about 1e-12.
_MARGIN = 1e-4


@dataclass(frozen=True)
class OrbitSystem:
    """A model's equations as a :class:`~bouncing_ball.numerics.corrector.Problem`.

    The last axis of y holds the N unknowns and, as its last entry, the continuation parameter Λ.

    Parameters
    ----------
    n : int
        Index of the family. The index and the parameters of the law may be arrays along the
        leading axis of y.
    law : Batch
        The law of the impact.
    at : callable
        The orbits ``at(n, law, Λ, …)`` with these :attr:`~.Orbit.unknowns`.

    Examples
    --------
    >>> from bouncing_ball.periodic.restitution_model import RestitutionOrbit
    >>> system = OrbitSystem(1, 1.0, RestitutionOrbit.at)
    >>> defects = system.residual(np.array([np.pi / 2, -np.pi, 1.0]))
    >>> [abs(round(float(x), 12)) for x in defects]
    [0.0, 0.0]
    """

    n: int | np.ndarray
    law: Any
    at: Callable

    @cached_property
    def _known(self) -> Callable:
        # Orbits are cached because a step along a branch evaluates the residual, the Jacobian and
        # the events at the same points.
        def orbit(shape: tuple[int, ...], entries: bytes) -> Any:
            *unknowns, amplitude = np.moveaxis(np.frombuffer(entries).reshape(shape), -1, 0)
            return self.at(self.n, self.law, amplitude, *unknowns)

        return lru_cache(maxsize=4)(orbit)

    def orbit(self, y: np.ndarray) -> Any:
        """The orbits at points y of shape (..., N + 1)."""
        return self._known(y.shape, y.tobytes())

    def point(self, orbit: Any) -> np.ndarray:
        """The unknowns of the orbits, followed by Λ, shape (..., N + 1)."""
        return np.stack(np.broadcast_arrays(*orbit.unknowns, orbit.amplitude), axis=-1)

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """Exact Jacobian of the residual, shape (..., N, N + 1)."""
        return self.orbit(y).system_jacobian()

    def residual(self, y: np.ndarray) -> np.ndarray:
        """The last N defects of the orbits, shape (..., N).

        These are the velocity and landing defects if the contact is determined by its start.
        """
        return self.orbit(y).residual()[..., 1 - y.shape[-1] :]

    def events(self) -> tuple[Event, ...]:
        """Events along a branch: the bifurcations, and the ends of the domain in which orbits
        exist.

        Three events are terminal: the ball no longer approaches the table at impact, it no longer
        leaves the table at the end of contact, or its flight time vanishes.
        """

        def bifurcation(kind: Bifurcation) -> Event:
            return Event(kind, lambda y: kind.test(*self.orbit(y).trace_and_determinant()))

        def end(name: str, why: str, left: Callable[[Any], np.ndarray]) -> Event:
            reason = f"{name}: {why}"
            return Event(name, lambda y: left(self.orbit(y)), terminal=True, reason=reason)

        return (
            bifurcation(Bifurcation.SADDLE_NODE),
            bifurcation(Bifurcation.PERIOD_DOUBLING),
            end(
                "contact lost",
                "the ball no longer closes in on the table at impact",
                lambda orbit: -orbit.relative_impact_velocity - _MARGIN,
            ),
            end(
                "release lost",
                "the ball no longer leaves the table as the contact ends",
                lambda orbit: orbit.relative_bounce_velocity,
            ),
            end(
                "flight lost",
                "the contact fills the whole cycle",
                lambda orbit: orbit.flight_time - _MARGIN,
            ),
        )

    def grazing(self, y: np.ndarray) -> np.ndarray:
        """The last admissible points along a branch, one for each change of admissibility.

        ``y`` holds points in order along the branch, shape (m, N + 1). The orbits at the k results,
        shape (k, N + 1), graze the table.
        """
        return domain_limits(self, lambda z: self.orbit(z).is_admissible(), y)
