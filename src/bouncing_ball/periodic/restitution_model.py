"""The restitution model, whose impacts are instants at the table's level, and its n-T orbits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.models.instant import Instant, rigid_instant
from bouncing_ball.models.restitution import RestitutionDynamics
from bouncing_ball.periodic import restitution_branch as formulas
from bouncing_ball.periodic.model import ImpactModel
from bouncing_ball.periodic.orbit import Orbit
from bouncing_ball.periodic.stability import Side


class RestitutionOrbit(Orbit):
    """n-T orbits with instantaneous impacts; ``law`` is r.

    Examples
    --------
    >>> orbit = RestitutionOrbit.of(1, 0.5, 1.2, 0.5)
    >>> float(orbit.bounce_velocity) == np.pi, float(orbit.determinant())
    (True, 0.25)
    """

    dynamics = RestitutionDynamics.of

    @classmethod
    def at(cls, n: ArrayLike, law: Any, amplitude: ArrayLike, *start: ArrayLike) -> Self:
        """The orbits with impacts at (φ, z′_i)."""
        phase, velocity = start
        return cls.of(n, law, amplitude, phase, 0.0, velocity)

    def rebound(self) -> tuple[np.ndarray, np.ndarray]:
        """r and the slope d(r v)/dv at the impact speed v; for a constant r both are r."""
        r = np.asarray(self.law, dtype=float)
        return r, r

    @property
    def restitution(self) -> np.ndarray:
        """The restitution coefficient r at the impact speed."""
        return self.rebound()[0]

    def residual(self) -> np.ndarray:
        """Velocity and landing defects of the exact map (Eq. 5), shape (..., 2)."""
        after = -self.restitution * self.relative_impact_velocity
        return np.stack(np.broadcast_arrays(*self.flight_defects(0.0, after)), axis=-1)

    def contact_jacobian(self) -> np.ndarray:
        """Jacobian of (τ_b, δ_b, δ′_b) in (τ, δ′, Λ), shape (..., 3, 3).

        For an instant at the level of the table, only ∂δ′_b/∂δ′ = -d(r v)/dv is not zero.
        """
        jacobian = np.zeros((*self.shape, 3, 3))
        jacobian[..., 2, 1] = -self.rebound()[1]
        return jacobian

    def determinant(self) -> np.ndarray:
        """r d(r v)/dv, which is r² for a constant r."""
        r, slope = self.rebound()
        return r * slope + 0 * self.phase

    def trace_and_determinant(self) -> tuple[np.ndarray, np.ndarray]:
        """Trace 1 + r s - (1 + r)(1 + s) Λ sin φ and determinant r s, where s = d(r v)/dv."""
        r, slope = self.rebound()
        lift = self.amplitude * np.sin(self.phase)
        return 1 + r * slope - (1 + r) * (1 + slope) * lift, self.determinant()


@dataclass(frozen=True, repr=False)
class RestitutionModel(ImpactModel):
    """A ball whose impacts are instants at which δ′ becomes -r δ′ (Eqs. 1-9).

    Parameters
    ----------
    restitution : float or array
        r in (0, 1].

    Raises
    ------
    ModelError
        If a value of r lies outside (0, 1].

    Examples
    --------
    >>> model = RestitutionModel(1.0)
    >>> round(float(model.orbit(1, 0.5).phase) / np.pi, 15)
    0.5
    """

    restitution: float | np.ndarray

    name: ClassVar[str] = "restitution"
    orbit_type: ClassVar[type[Orbit]] = RestitutionOrbit

    def __post_init__(self):
        formulas.check_family(1, self.restitution)

    def signature(self, speed: ArrayLike) -> Instant:
        """The constant r, without delay, load sensitivity and duration."""
        return rigid_instant(self.restitution, self.restitution, speed)

    @property
    def label(self) -> str:
        return f"r = {float(self.restitution):g}"

    def orbit(
        self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE
    ) -> RestitutionOrbit:
        """The n-T orbits at Λ on one side of the saddle-node (Eq. 6); NaN below the saddle-node.

        Arguments, shape and errors are those of :meth:`.ImpactModel.orbit`.
        """
        lam = np.asarray(amplitude, dtype=float)
        fold = formulas.saddle_node(n, self.restitution)
        exists = lam >= fold
        on_stable_side = Side(side) is Side.STABLE
        at = np.where(exists, lam, fold)
        phase = formulas.phase(n, self.restitution, at, on_stable_side)
        return self.orbit_of(n, lam, np.where(exists, phase, np.nan))

    def saddle_node(self, n: ArrayLike) -> RestitutionOrbit:
        """The orbits at the saddle-node (Eq. 7), where φ = 0, with the shape of n and the model."""
        return self.orbit_of(n, formulas.saddle_node(n, self.restitution), 0.0)

    def period_doubling(self, n: ArrayLike) -> RestitutionOrbit:
        """The orbits at the period doubling of the exact map; Eq. 8 is that of Holmes' map.

        They have the shape of n and the model.
        """
        lam = formulas.period_doubling(n, self.restitution)
        return self.orbit_of(n, lam, formulas.phase(n, self.restitution, lam))

    def nearest(self, orbit: RestitutionOrbit) -> RestitutionOrbit:
        """The points nearest to given orbits on the line Λ cos φ = Λ_SN, the closed form of the
        branch, of the shape of these orbits.
        """
        fold = formulas.saddle_node(orbit.n, orbit.restitution)
        lift = orbit.amplitude * np.sin(orbit.phase)
        return self.orbit_of(orbit.n, np.hypot(fold, lift), np.arctan2(lift, fold))
