"""The corrected restitution model and its n-T orbits, with the model interface."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball.contacts.signature import LinearSignature, Signature
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.motion.corrected_impacts import corrected_cycle, simulate
from bouncing_ball.motion.sequence import Cycle, ImpactSequence
from bouncing_ball.orbits import corrected_branch as formulas
from bouncing_ball.orbits.corrected_orbit import CorrectedOrbit
from bouncing_ball.orbits.corrected_system import CorrectedSystem
from bouncing_ball.orbits.model import Absence, ImpactModel, Side
from bouncing_ball.orbits.orbit import Orbit, check_index

# Rounds of tangents: Newton's method for an orbit; each gains a digit or more for a
# bifurcation, and for the nearest point.
_ROUNDS = 60
_SETTLED = 4e-16
# Of nπ, for a tangent that leads astray.
_SLOWEST = 1e-3


@dataclass(frozen=True, repr=False)
class CorrectedModel(ImpactModel):
    """A ball whose impacts are instants, at the centroid of the contact force.

    Parameters
    ----------
    law : Signature
        What the impact is to the outside. Where it is the same at every speed, as
        for a linear contact, the orbits have a closed form; else they take a few
        rounds of it.

    Examples
    --------
    >>> model = CorrectedModel.of_contact(SpringDamper.from_restitution(0.65, 10.0))
    >>> round(float(model.orbit(1, 1.0).max_height), 3)
    5.215
    """

    law: Signature

    name: ClassVar[str] = "corrected"
    orbit_type: ClassVar[type[Orbit]] = CorrectedOrbit

    @classmethod
    def of_contact(cls, contact: SpringDamper) -> "CorrectedModel":
        """The model of a spring-damper contact."""
        return cls(LinearSignature(contact))

    @property
    def label(self) -> str:
        """The law's own."""
        return self.law.label

    def _found(self, n: ArrayLike, solve: Callable, x: ArrayLike = 0.0, y: ArrayLike = 0.0):
        """Λ and ψ by a closed form that holds on a tangent of the branch.

        ``solve(instant, rest)`` gives both, and ψ = -χ for no solution. The tangent is
        first that of a constant law, and then at the last point.
        """
        half = np.asarray(n) * np.pi
        speed = half + np.asarray(x, dtype=float) + np.zeros(self.shape)
        for _ in range(1 if self.law.is_constant else _ROUNDS):
            instant, rest = self.law(speed).tangent(speed, 1 - np.asarray(y))
            lam, psi = solve(instant, 0.0 if self.law.is_constant else rest)
            before = speed
            fallback = formulas.saddle_node_phase(instant)
            at = np.where(np.isnan(psi), fallback, psi)
            level = np.where(np.isnan(lam), formulas.saddle_node(n, instant, rest), lam)
            x, y = level * np.cos(at), level * np.sin(at)
            # No impact is slower than at rest.
            speed = np.maximum(half + x, _SLOWEST * half)
            if np.all(~(np.abs(speed - before) > _SETTLED * speed)):
                break
        return lam, psi

    def _phase(self, n: ArrayLike, amplitude: ArrayLike, side: Side) -> np.ndarray:
        """ψ of the n-T orbits at Λ; NaN where there is none."""
        lam = np.asarray(amplitude, dtype=float)

        def solve(instant, rest):
            return lam, formulas.instant_phase(n, instant, lam, side == Side.STABLE, rest)

        return self._found(n, solve)[1]

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE) -> CorrectedOrbit:
        """The n-T orbits at Λ on a side of the saddle-node; NaN where there is none."""
        check_index(n)
        lam = np.asarray(amplitude, dtype=float)
        return CorrectedOrbit.at(n, self.law, lam, self._phase(n, lam, side))

    def orbits(self, n: int, amplitude: float) -> CorrectedOrbit:
        """Both n-T orbits at one Λ, the stable side first; one at the saddle-node."""
        both = np.stack([self._phase(n, amplitude, side) for side in Side])
        phases = both[np.isfinite(both) & [True, bool(both[0] != both[1])]]
        found = CorrectedOrbit.at(n, self.law, np.full_like(phases, amplitude), phases)
        return found[np.argsort(found.contact_duration, kind="stable")]

    def absence(self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE) -> np.ndarray:
        """Why :meth:`orbit` finds none."""
        missing = np.isnan(self._phase(n, amplitude, Side.STABLE))
        return np.where(missing, Absence.BELOW_SADDLE_NODE, Absence.NONE)

    def saddle_node(self, n: ArrayLike) -> CorrectedOrbit:
        """The orbits at the saddle-node, ψ = -χ; NaN where the branch has none."""
        check_index(n)

        def solve(instant, rest):
            lam, phase = formulas.saddle_node(n, instant, rest), formulas.saddle_node_phase(instant)
            return lam, np.where(np.isnan(lam), np.nan, phase)

        return CorrectedOrbit.at(n, self.law, *self._found(n, solve))

    def period_doubling(self, n: ArrayLike) -> CorrectedOrbit:
        """The orbits at the period doubling; NaN where there is none."""
        check_index(n)
        found = self._found(n, lambda instant, rest: formulas.period_doubling(n, instant, rest))
        return CorrectedOrbit.at(n, self.law, *found)

    def nearest(self, orbit: CorrectedOrbit) -> CorrectedOrbit:
        """The nearest orbits of the branch, a straight line in (Λ cos ψ, Λ sin ψ) or nearly."""
        lam, psi = orbit.amplitude, orbit.hit.phase

        def solve(instant, rest):
            return formulas.nearest(orbit.n, instant, lam, psi, rest)

        model = CorrectedModel(orbit.law)
        found = model._found(orbit.n, solve, lam * np.cos(psi), lam * np.sin(psi))
        return CorrectedOrbit.at(orbit.n, orbit.law, *found)

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
