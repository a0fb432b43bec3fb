"""The corrected restitution model and its n-T orbits, with the model interface."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import ModelError
from bouncing_ball.impacts.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball.impacts.signature import Instant, LinearSignature, Signature
from bouncing_ball.impacts.spring_damper import Contact
from bouncing_ball.motion.corrected_impacts import corrected_cycle, simulate
from bouncing_ball.motion.sequence import Cycle, ImpactSequence
from bouncing_ball.orbits import corrected_branch as formulas
from bouncing_ball.orbits.corrected_orbit import CorrectedOrbit
from bouncing_ball.orbits.corrected_system import CorrectedSystem
from bouncing_ball.orbits.interface import Absence, ImpactModel, Orbit, Side, check_index


@dataclass(frozen=True, repr=False)
class CorrectedModel(ImpactModel):
    """A ball whose impacts are instants, at the centroid of the contact force.

    Parameters
    ----------
    law : Signature
        What the impact is to the outside; its orbits have a closed form where
        it is the same at every speed, as for a linear contact.

    Raises
    ------
    ModelError
        If the law depends on the impact speed.

    Examples
    --------
    >>> model = CorrectedModel.of_contact(Contact.from_restitution(0.65, 10.0))
    >>> round(float(model.orbit(1, 1.0).max_height), 3)
    5.215
    """

    law: Signature

    name: ClassVar[str] = "corrected"
    orbit_type: ClassVar[type[Orbit]] = CorrectedOrbit

    def __post_init__(self):
        if not self.law.is_constant:
            raise ModelError("orbits in closed form need a law that is the same at every speed")

    @classmethod
    def of_contact(cls, contact: Contact) -> "CorrectedModel":
        """The model of a spring-damper contact."""
        return cls(LinearSignature(contact))

    @property
    def instant(self) -> Instant:
        """The signature of every impact."""
        return self.law(np.ones(self.shape))

    @property
    def label(self) -> str:
        """r, t_c and σ."""
        instant = self.instant
        return (
            f"r = {float(instant.restitution):.4g}, t_c = {float(instant.delay):.4g}, "
            f"σ = {float(instant.load):.4g}"
        )

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE) -> CorrectedOrbit:
        """The n-T orbits at Λ on a side of the saddle-node; NaN where there is none."""
        check_index(n)
        lam = np.asarray(amplitude, dtype=float)
        phase = formulas.instant_phase(n, self.instant, lam, side == Side.STABLE)
        return CorrectedOrbit.at(n, self.law, lam, phase)

    def orbits(self, n: int, amplitude: float) -> CorrectedOrbit:
        """Both n-T orbits at one Λ, the stable side first; one at the saddle-node."""
        both = np.stack(
            [
                formulas.instant_phase(n, self.instant, amplitude, side == Side.STABLE)
                for side in Side
            ]
        )
        phases = both[np.isfinite(both) & [True, bool(both[0] != both[1])]]
        return CorrectedOrbit.at(n, self.law, np.full_like(phases, amplitude), phases)

    def absence(self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE) -> np.ndarray:
        """Why :meth:`orbit` finds none."""
        missing = np.isnan(formulas.instant_phase(n, self.instant, amplitude))
        return np.where(missing, Absence.BELOW_SADDLE_NODE, Absence.NONE)

    def saddle_node(self, n: ArrayLike) -> CorrectedOrbit:
        """The orbits at the saddle-node, ψ = -χ; NaN where the branch has none."""
        check_index(n)
        lam = formulas.saddle_node(n, self.instant)
        phase = formulas.saddle_node_phase(self.instant)
        return CorrectedOrbit.at(n, self.law, lam, np.where(np.isnan(lam), np.nan, phase))

    def period_doubling(self, n: ArrayLike) -> CorrectedOrbit:
        """The orbits at the period doubling; NaN where there is none."""
        check_index(n)
        lam, phase = formulas.period_doubling(n, self.instant)
        return CorrectedOrbit.at(n, self.law, lam, phase)

    def nearest(self, orbit: CorrectedOrbit) -> CorrectedOrbit:
        """The nearest orbits of the closed form, a straight line in (Λ cos ψ, Λ sin ψ)."""
        lam, psi = formulas.nearest(orbit.n, orbit.instant, orbit.amplitude, orbit.hit.phase)
        return CorrectedOrbit.at(orbit.n, orbit.law, lam, psi)

    def system(self, n: int | np.ndarray) -> CorrectedSystem:
        """The equations of the orbits, continued in Λ."""
        return CorrectedSystem(n, self.law)

    def simulate(
        self, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike, impacts: int
    ) -> ImpactSequence:
        """Impacts from a first one at phase φ, with absolute velocity z′_i before it."""
        return simulate(self.law, amplitude, phase, velocity, impacts)

    def cycle(self, amplitude: ArrayLike, phase: ArrayLike, relative_velocity: ArrayLike) -> Cycle:
        """The Poincaré map, from a start of contact (φ, δ′) to the next."""
        return corrected_cycle(self.law, amplitude, phase, relative_velocity)

    def permanent_contact_threshold(self) -> np.ndarray:
        """Λ = 1, as in the restitution model: no impact, nothing to correct."""
        return np.full(self.shape, RESTITUTION_THRESHOLD)
