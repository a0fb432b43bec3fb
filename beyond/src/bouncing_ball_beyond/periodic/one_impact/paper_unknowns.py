"""The equations of n-T orbits in the unknowns of the paper (Eqs. 21-26).

Of the paper's six unknowns φ, z′_i, τ_b, z′_b, A and B, three are eliminated, all linearly: A and B
by the start of contact (Eqs. 21-22) and z′_b by the periodicity (Eq. 27). The remaining ones are
scaled to order one, ``y = (φ, z′_i, ϖ τ_b, Λ)``; an impact that is an instant has no τ_b. The
equations are those of :mod:`~bouncing_ball_beyond.periodic.orbits.problem` with one impact, whose
unknowns are ``(φ, δ′, arsinh ϖD, arsinh Λ)``: only the length of a step along a branch depends on
this choice.
"""

from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from bouncing_ball_beyond.inherited.numerics.corrector import Condition
from bouncing_ball_beyond.inherited.numerics.events import Event
from bouncing_ball_beyond.periodic.orbits.balls import LAMBDA
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of, point_of
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations


@dataclass(frozen=True)
class PaperUnknowns:
    """The equations as a :class:`~bouncing_ball_beyond.inherited.numerics.corrector.Problem`, with
    Λ as the last entry of y.

    They are those of :mod:`bouncing_ball_beyond.inherited.periodic.continuation`, here of an orbit
    of any model.

    Parameters
    ----------
    equations : OrbitEquations
        The equations with one impact, along Λ.

    Examples
    --------
    The elastic orbit with φ = π/2, whose velocity after the impact is π:

    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> problem = PaperUnknowns.of(Orbit.of(RestitutionModel(1.0), 1, 1.0, np.pi / 2))
    >>> defects = problem.residual(np.array([np.pi / 2, -np.pi, 1.0]))
    >>> [abs(round(float(x), 12)) for x in defects]
    [0.0, 0.0]
    """

    equations: OrbitEquations

    @classmethod
    def of(cls, orbit: Orbit) -> "PaperUnknowns":
        """The equations of given n-T orbits."""
        equations, _ = equations_of(orbit, LAMBDA)
        return cls(equations)

    def take(self, which: Any) -> Self:
        """The equations of some orbits of a row."""
        return replace(self, equations=self.equations.take(which))

    def inner(self, y: np.ndarray) -> np.ndarray:
        """The unknowns (φ, δ′, arsinh ϖD, arsinh Λ) of y."""
        inner = np.array(y, dtype=float)
        lam = y[..., -1]
        inner[..., 1] -= lam * np.cos(y[..., 0])
        inner[..., -1] = np.arcsinh(lam)
        if self.equations.oscillates:
            inner[..., 2] = np.arcsinh(y[..., 2])
        return inner

    def _slopes(self, y: np.ndarray) -> np.ndarray:
        """Derivatives of :meth:`inner` by y, shape (..., N + 1, N + 1)."""
        lam = y[..., -1]
        size = y.shape[-1]
        slopes = np.zeros((*y.shape, size))
        slopes[..., 0, 0] = 1
        slopes[..., 1, 0] = lam * np.sin(y[..., 0])
        slopes[..., 1, 1] = 1
        slopes[..., 1, -1] = -np.cos(y[..., 0])
        if self.equations.selects:
            slopes[..., 2, 2] = 1
        if self.equations.oscillates:
            slopes[..., 2, 2] /= np.hypot(1, y[..., 2])
        slopes[..., -1, -1] = 1 / np.hypot(1, lam)
        return slopes

    def point(self, orbit: Orbit) -> np.ndarray:
        """y of n-T orbits, shape (..., N + 1)."""
        return self.outer(point_of(orbit, self.equations))

    def outer(self, inner: np.ndarray) -> np.ndarray:
        """y at the unknowns (φ, δ′, arsinh ϖD, arsinh Λ)."""
        lam = np.sinh(inner[..., -1])
        y = inner.copy()
        y[..., 1] += lam * np.cos(inner[..., 0])
        y[..., -1] = lam
        if self.equations.oscillates:
            y[..., 2] = np.sinh(inner[..., 2])
        return y

    def residual(self, y: np.ndarray) -> np.ndarray:
        """The defects of the equations, shape (..., N)."""
        return self.equations.residual(self.inner(y))

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """The Jacobian of the residual, shape (..., N, N + 1)."""
        # The duration of a contact that touches its release has infinite derivatives.
        with np.errstate(invalid="ignore"):
            return self.equations.jacobian(self.inner(y)) @ self._slopes(y)

    def event(self, event: Event) -> Event:
        """An event of the equations as a function of these unknowns."""
        known = event.condition
        return replace(
            event,
            function=lambda y: event.function(self.inner(y)),
            condition=None if known is None else self.condition(known),
            normal=None,
        )

    def condition(self, known: Condition) -> Condition:
        """A condition of the equations as a function of these unknowns."""

        def condition(y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            value, gradient = known(self.inner(y))
            return value, (gradient[..., np.newaxis, :] @ self._slopes(y))[..., 0, :]

        return condition
