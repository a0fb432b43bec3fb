"""The restitution-coefficient model and its n-T orbits, with the model interface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball.errors import ModelError
from bouncing_ball.motion.restitution import section_cycle, simulate
from bouncing_ball.motion.sequence import Cycle, ImpactSequence
from bouncing_ball.orbits import restitution_orbit as formulas
from bouncing_ball.orbits.model import Absence, ImpactModel, Side
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_orbit import RestitutionOrbit
from bouncing_ball.orbits.restitution_system import RestitutionSystem


@dataclass(frozen=True, repr=False)
class RestitutionModel(ImpactModel):
    """A ball whose impacts are instants: δ′ becomes -r δ′.

    Parameters
    ----------
    restitution : float or array
        r in (0, 1].

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

    @property
    def label(self) -> str:
        """r."""
        return f"r = {float(self.restitution):g}"

    def orbit(
        self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE
    ) -> RestitutionOrbit:
        """The n-T orbits at Λ on a side of the saddle-node; NaN where there is none."""
        fold, lam = formulas.saddle_node(n, self.restitution), np.asarray(amplitude, dtype=float)
        there = lam >= fold
        phase = formulas.phase(n, self.restitution, np.where(there, lam, fold), side == Side.STABLE)
        return self.orbit_of(n, lam, np.where(there, phase, np.nan))

    def orbits(self, n: int, amplitude: float) -> RestitutionOrbit:
        """Both n-T orbits at one Λ, the stable side first; one at the saddle-node."""
        both = np.stack([self.orbit(n, amplitude, side).phase for side in Side])
        distinct = np.isfinite(both) & [True, bool(both[0] != both[1])]
        phases = both[distinct]
        return self.orbit_of(n, np.full_like(phases, amplitude), phases)

    def absence(self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE) -> np.ndarray:
        """Why :meth:`orbit` finds none."""
        missing = np.asarray(amplitude) < formulas.saddle_node(n, self.restitution)
        return np.where(missing, Absence.BELOW_SADDLE_NODE, Absence.NONE)

    def saddle_node(self, n: ArrayLike) -> RestitutionOrbit:
        """The orbits at the saddle-node, φ = 0."""
        return self.orbit_of(n, formulas.saddle_node(n, self.restitution), 0.0)

    def period_doubling(self, n: ArrayLike) -> RestitutionOrbit:
        """The orbits at the period doubling of the exact map."""
        lam = formulas.period_doubling(n, self.restitution)
        return self.orbit_of(n, lam, formulas.phase(n, self.restitution, lam))

    def nearest(self, orbit: RestitutionOrbit) -> RestitutionOrbit:
        """The nearest orbits of the closed form, the line Λ cos φ = Λ_SN."""
        fold = formulas.saddle_node(orbit.n, orbit.restitution)
        lift = orbit.amplitude * np.sin(orbit.phase)
        lam, phase = np.hypot(fold, lift), np.arctan2(lift, fold)
        return self.orbit_of(orbit.n, lam, phase)

    def system(self, n: int | np.ndarray) -> RestitutionSystem:
        """The fixed points of the exact map, continued in Λ."""
        return RestitutionSystem(n, self.restitution)

    def simulate(
        self, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike, impacts: int
    ) -> ImpactSequence:
        """Impacts from a first one at phase φ, with absolute velocity z′_i before it.

        Raises
        ------
        ModelError
            If the ball rises from the table.
        """
        r, velocity = np.asarray(self.restitution), np.asarray(velocity, dtype=float)
        table = np.asarray(amplitude) * np.cos(phase)
        if np.any(velocity > table):
            raise ModelError("a ball that rises from the table has no impact: z′ > w′")
        after = -r * velocity + (1 + r) * table
        return simulate(r, amplitude, phase, after, impacts)

    def cycle(self, amplitude: ArrayLike, phase: ArrayLike, relative_velocity: ArrayLike) -> Cycle:
        """The Poincaré map, from an impact (φ, δ′) to the next."""
        return section_cycle(self.restitution, amplitude, phase, relative_velocity)

    def permanent_contact_threshold(self) -> np.ndarray:
        """Λ_CR = 1 (Eq. 9)."""
        return np.full(self.shape, RESTITUTION_THRESHOLD)
