"""What every model of the impact offers.

Callers ask; none of them tests which model it has::

    model = SpringDamperModel(SpringDamper.from_restitution(0.85, 10.0))  # or RestitutionModel(…)
    orbit = model.require_orbit(1, 0.9)                # the 1-T orbit at Λ = 0.9
    orbit.phase, orbit.contact_duration, orbit.bounce_velocity, orbit.is_stable()
    model.saddle_node(1).amplitude, model.period_doubling(1).amplitude
    model.simulate(0.9, phase=0.0, velocity=-3.0, impacts=100).phase

A new model is a subclass of :class:`ImpactModel`, with its orbits as a
subclass of :class:`Orbit`: what follows from the flight alone, and by continuation, is
written once. Models and orbits are arrays: all fields broadcast, and both are indexed,
``orbit[3]``. Everything is dimensionless.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import fields
from enum import StrEnum
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.batch import Batch
from bouncing_ball.contacts.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball.contacts.signature import Instant
from bouncing_ball.errors import ModelError, NoOrbitError
from bouncing_ball.motion.sequence import Cycle, ImpactSequence
from bouncing_ball.motion.simulation import next_impact, simulate
from bouncing_ball.orbits import continued
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.stability import Bifurcation, Side
from bouncing_ball.orbits.system import ContactSystem, OrbitSystem

if TYPE_CHECKING:
    from bouncing_ball.datasets.labelled import Grid, Labelled


class Route(StrEnum):
    """Independent ways to a model's orbits."""

    CONTINUATION = "continuation"
    """Newton's method on its equations, :meth:`ImpactModel.system`."""
    FORMULA = "formula"
    """A closed form of its branch, :meth:`ImpactModel.nearest`."""
    SIMULATION = "simulation"
    """Its motion from event to event, :meth:`ImpactModel.cycle`."""


class Absence(StrEnum):
    """Why there is no orbit on a side of the branch at some Λ."""

    NONE = "there is one"
    BELOW_SADDLE_NODE = "below the saddle-node"
    NO_OTHER_SIDE = "the branch has no saddle-node, and so no other side"
    NOT_REACHED = "this side of the branch does not reach this Λ"
    NOT_FOUND = "none was found, and there may be one"


class ImpactModel(Batch, ABC):
    """A law of the impact and its n-T orbits: a frozen dataclass with one field, the law.

    ``name`` is what users call it; ``routes`` are the ways to its orbits. A model says what
    the impact is to the outside (:meth:`signature`), and what its orbits are: a type with the
    constructor ``at``, or a :meth:`system`. The orbits at Λ, their absence and bifurcations
    follow by continuation; a closed form overrides them.
    """

    name: ClassVar[str]
    routes: ClassVar[frozenset[Route]] = frozenset({Route.CONTINUATION, Route.SIMULATION})
    orbit_type: ClassVar[type[Orbit]]

    @property
    def label(self) -> str:
        """Its parameters, in words; of a single model."""
        return self._law.label

    @abstractmethod
    def signature(self, speed: ArrayLike) -> Instant:
        """What an impact of speed v > 0 is to the outside, from which searches start."""

    def permanent_contact_threshold(self) -> np.ndarray:
        """Λ up to which the ball stays on the table: 1 where impacts are instants (Eq. 9)."""
        return np.full(self.shape, RESTITUTION_THRESHOLD)

    # What follows.

    def system(self, n: int | np.ndarray) -> OrbitSystem:
        """The equations of the orbits, continued in Λ (route CONTINUATION)."""
        orbits: Any = self.orbit_type
        return ContactSystem(n, self._law, orbits.at)

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE) -> Any:
        """The n-T orbits at Λ on a side of the saddle-node; NaN where there is none."""
        return continued.orbit_at(self, n, amplitude, Side(side))

    def orbits(self, n: int, amplitude: float) -> Any:
        """All n-T orbits at one Λ, in order of contact duration, shape (count,).

        Those of both sides, one at the saddle-node: an impact that takes no time has no others.
        """
        return continued.both_sides(self, n, amplitude)

    def absence(self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE) -> np.ndarray:
        """The :class:`Absence` of each orbit that :meth:`orbit` looks for, as text."""
        missing, fold = ~self.orbit(n, amplitude, side).exists, self.saddle_node(n).amplitude
        other = Absence.NOT_FOUND
        if Route.FORMULA in self.routes:
            # The search is complete.
            no_fold = np.isnan(fold) & (side == Side.UNSTABLE)
            other = np.where(no_fold, Absence.NO_OTHER_SIDE, Absence.NOT_REACHED)
        why = np.where(np.asarray(amplitude) < fold, Absence.BELOW_SADDLE_NODE, other)
        return np.where(missing, why, Absence.NONE)

    def saddle_node(self, n: ArrayLike) -> Any:
        """The orbits at the saddle-node; NaN where the branch has none."""
        return continued.bifurcation(self, n, Bifurcation.SADDLE_NODE)

    def period_doubling(self, n: ArrayLike) -> Any:
        """The orbits at the period doubling nearest to it; NaN where there is none."""
        return continued.bifurcation(self, n, Bifurcation.PERIOD_DOUBLING)

    def nearest(self, orbit: Any) -> Any:
        """The orbits of the closed form nearest to given ones (route FORMULA).

        Raises
        ------
        ModelError
            If the model has no closed form.
        """
        raise ModelError(f"the orbits of the {self.name} model have no closed form")

    def simulate(
        self, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike, impacts: int
    ) -> ImpactSequence:
        """Impacts from a first one at phase φ, with absolute velocity z′_i before it:
        :func:`bouncing_ball.motion.simulation.simulate`."""
        return simulate(self._law, amplitude, phase, velocity, impacts)

    def history(
        self,
        amplitude: ArrayLike,
        phase: ArrayLike = 0.0,
        velocity: ArrayLike = -np.pi,
        *,
        periods: float = 10.0,
        samples: int = 200,
    ) -> Labelled:
        """A ball over time from a first impact: :func:`bouncing_ball.history`."""
        from bouncing_ball.orbits import labelled

        grid = self._grid(amplitude=amplitude, phase=phase, velocity=velocity)
        return labelled.from_impact(self, grid, labelled.instants(periods, samples))

    def drop(
        self,
        height: ArrayLike,
        amplitude: ArrayLike = 0.0,
        phase: ArrayLike = 0.0,
        *,
        periods: float = 10.0,
        samples: int = 200,
    ) -> Labelled:
        """A ball that is let go at rest: :func:`bouncing_ball.drop`."""
        from bouncing_ball.orbits import labelled

        grid = self._grid(height=height, amplitude=amplitude, phase=phase)
        return labelled.from_rest(self, grid, labelled.instants(periods, samples))

    def branch(
        self, n: ArrayLike, *, amplitude_max: float | None = None, points: int = 300
    ) -> Labelled:
        """The branch of n-T orbits over Λ: :func:`bouncing_ball.branch`."""
        from bouncing_ball.orbits import labelled

        return labelled.branches(self._grid(n=n), lambda n: self, amplitude_max, points)

    def _grid(self, **given: Any) -> Grid:
        """The arguments of a labelled result, which one model has; several have axes of names."""
        from bouncing_ball.datasets.labelled import Grid

        if self.shape:
            call = "bouncing_ball.history(…, frequency_ratio=[5, 10])"
            raise ModelError(f"several models have no labels: give their parameters to {call}")
        found = Grid(**given)
        found.attrs["model"] = self.label
        return found

    def cycle(self, amplitude: ArrayLike, phase: ArrayLike, relative_velocity: ArrayLike) -> Cycle:
        """The Poincaré map, from an impact (φ, δ′) to the next (route SIMULATION)."""
        return next_impact(self._law, amplitude, phase, relative_velocity)

    @property
    def _law(self) -> Any:
        (law,) = (getattr(self, field.name) for field in fields(self))
        return law

    def orbit_of(self, n: ArrayLike, amplitude: ArrayLike, *numbers: ArrayLike) -> Any:
        """Orbits known by Λ, φ, D and z′_i, as a dataset has them: :meth:`Orbit.of`."""
        return self.orbit_type.of(n, self._law, amplitude, *numbers)

    def require_admissible(self, n: int, amplitude: float, side: Side = Side.STABLE) -> Orbit:
        """:meth:`require_orbit`, if it is one of the ball.

        Raises
        ------
        NoOrbitError
            If there is none, or if it is inadmissible.
        """
        orbit = self.require_orbit(n, amplitude, side)
        if not orbit.is_admissible():
            raise NoOrbitError(
                f"the {n}-T orbit at Λ = {amplitude:g} for {self.label} is inadmissible: "
                "another impact or release comes first"
            )
        return orbit

    def require_orbit(self, n: int, amplitude: float, side: Side = Side.STABLE) -> Orbit:
        """The one orbit at Λ on a side of the saddle-node.

        Raises
        ------
        NoOrbitError
            If there is none, with the reason.
        """
        orbit = self.orbit(n, amplitude, side)
        if not orbit.exists:
            why = str(self.absence(n, amplitude, side))
            if why == Absence.BELOW_SADDLE_NODE:
                why = f"{why} at Λ = {float(self.saddle_node(n).amplitude):.6g}"
            raise NoOrbitError(f"no {n}-T orbit at Λ = {amplitude:g} for {self.label}: {why}")
        return orbit
