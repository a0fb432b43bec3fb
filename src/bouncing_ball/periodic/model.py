"""The interface of every model of the impact.

Code that uses a model calls only the methods of this interface and never asks for its class::

    model = SpringDamperModel(SpringDamper.from_restitution(0.85, 10.0))  # or RestitutionModel(…)
    orbit = model.require_orbit(1, 0.9)                # the 1-T orbit at Λ = 0.9
    orbit.phase, orbit.contact_duration, orbit.bounce_velocity, orbit.is_stable()
    model.saddle_node(1).amplitude, model.period_doubling(1).amplitude
    model.simulate(0.9, phase=0.0, velocity=-3.0, impacts=100).phase

A new model is a subclass of :class:`ImpactModel`, and its orbits are a subclass of
:class:`Orbit`. Both inherit everything that follows from the flight alone. A model whose orbits
have no closed form is a subclass of
:class:`~bouncing_ball.periodic.continued_orbits.ContinuedModel`.
Models and orbits are arrays: their fields broadcast, and they can be indexed, ``orbit[3]``.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import fields
from enum import StrEnum
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import NoOrbitError
from bouncing_ball.models.ball import Ball
from bouncing_ball.models.dynamics import Dynamics
from bouncing_ball.models.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball.models.sequence import Cycle, ImpactSequence
from bouncing_ball.numerics.arrays import Batch
from bouncing_ball.periodic.equations import OrbitSystem
from bouncing_ball.periodic.orbit import Orbit
from bouncing_ball.periodic.stability import Side


class Absence(StrEnum):
    """Why there is no orbit on a side of the branch at some Λ."""

    NONE = "there is one"
    BELOW_SADDLE_NODE = "below the saddle-node"
    NO_OTHER_SIDE = "the branch has no saddle-node and therefore no other side"
    NOT_REACHED = "this side of the branch does not reach this Λ"
    NOT_FOUND = "none was found, but one may exist"


class ImpactModel(Batch, Ball, ABC):
    """A law of the impact together with its n-T orbits.

    A subclass is a frozen dataclass with one field, which holds the law. ``name`` is the name of
    the model in messages, ``has_closed_form`` says whether its branch is known as a formula, and
    ``orbit_type`` is the class of its orbits, with the constructor ``at``. A subclass defines
    the orbits at Λ and the bifurcations.
    """

    name: ClassVar[str]
    has_closed_form: ClassVar[bool] = True
    orbit_type: ClassVar[type[Orbit]]

    @property
    def label(self) -> str:
        """The parameters of a single model as text: the label of the law if it has one."""
        return getattr(self.impact_law, "label", repr(self.impact_law))

    def permanent_contact_threshold(self) -> np.ndarray:
        """Λ up to which the ball stays on the table, of the model's shape.

        By default the threshold is 1, its value for instantaneous impacts (Eq. 9).
        """
        return np.full(self.shape, RESTITUTION_THRESHOLD)

    def system(self, n: int | np.ndarray) -> OrbitSystem:
        """The equations of the orbits as a continuation problem in Λ."""
        orbits: Any = self.orbit_type
        return OrbitSystem(n, self.impact_law, orbits.at)

    @abstractmethod
    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE) -> Any:
        """The n-T orbits at given Λ, on one side of the saddle-node.

        Parameters
        ----------
        n : array_like of int
            Index of the family: an orbit repeats after the time 2πn.
        amplitude : array_like
            Λ = aΩ²/g.
        side : Side
            The side of the branch that is stable next to the saddle-node, or the other side.

        Returns
        -------
        Orbit
            Has the shape to which n, Λ and the model broadcast; NaN where there is no orbit.

        Raises
        ------
        ModelError
            If n is not a positive integer, or the side is unknown.
        """

    def orbits(self, n: int, amplitude: float) -> Any:
        """All n-T orbits of a single model at one Λ, in order of contact duration, shape (count,).

        By default these are the two orbits on both sides of the saddle-node, because there are no
        other orbits if the impact has no duration. At the saddle-node itself both are the same.

        Raises
        ------
        ModelError
            If n is not a positive integer.
        """
        system = self.system(n)
        y = np.array([system.point(self.orbit(n, amplitude, side)) for side in Side])
        # The orbit with the larger phase, which is on the stable side, comes first.
        y = np.unique(y[np.all(np.isfinite(y), axis=-1)], axis=0)[::-1]
        found = system.orbit(y)
        return found[np.argsort(found.contact_duration, kind="stable")]

    def absence(self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE) -> np.ndarray:
        """Why :meth:`orbit` finds no orbit: the text of an :class:`Absence` for each entry.

        Arguments and shape are those of :meth:`orbit`.
        """
        missing = ~self.orbit(n, amplitude, side).exists
        fold = self.saddle_node(n).amplitude
        other = Absence.NOT_FOUND
        if self.has_closed_form:
            # The search along the closed form is complete.
            no_fold = np.isnan(fold) & (side == Side.UNSTABLE)
            other = np.where(no_fold, Absence.NO_OTHER_SIDE, Absence.NOT_REACHED)
        why = np.where(np.asarray(amplitude) < fold, Absence.BELOW_SADDLE_NODE, other)
        return np.where(missing, why, Absence.NONE)

    @abstractmethod
    def saddle_node(self, n: ArrayLike) -> Any:
        """The orbits at the saddle-node, with the shape of n and the model; NaN where none exists.

        Raises
        ------
        ModelError
            If n is not a positive integer.
        """

    @abstractmethod
    def period_doubling(self, n: ArrayLike) -> Any:
        """The orbits at the period doubling that is nearest to the saddle-node on the stable side.

        They have the shape of n and the model; NaN where the stable side has no period doubling.

        Raises
        ------
        ModelError
            If n is not a positive integer.
        """

    def dynamics(self, amplitude: ArrayLike) -> Dynamics:
        """The contacts and flights of the model's balls on a table of amplitude Λ."""
        return self.orbit_type.dynamics(self.impact_law, amplitude)

    def simulate(
        self, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike, impacts: int
    ) -> ImpactSequence:
        """Impacts that follow a first impact at the phase φ, before which the ball has z′_i.

        The arguments are those of :meth:`.Dynamics.simulate`.
        """
        return self.dynamics(amplitude).simulate(phase, velocity, impacts)

    def cycle(self, amplitude: ArrayLike, phase: ArrayLike, relative_velocity: ArrayLike) -> Cycle:
        """The Poincaré map, from an impact (φ, δ′) to the next one.

        The arguments are those of :meth:`.Dynamics.next_impact`.
        """
        return self.dynamics(amplitude).next_impact(phase, relative_velocity)

    @property
    def impact_law(self) -> Any:
        """The law of the impact, which is the only field of the model."""
        (law,) = (getattr(self, field.name) for field in fields(self))
        return law

    def orbit_of(self, n: ArrayLike, amplitude: ArrayLike, *numbers: ArrayLike) -> Any:
        """Orbits from Λ, φ, D and z′_i, as datasets store them; see :meth:`Orbit.of`.

        They have the shape to which the arguments and the model broadcast.
        """
        return self.orbit_type.of(n, self.impact_law, amplitude, *numbers)

    def require_admissible(self, n: int, amplitude: float, side: Side = Side.STABLE) -> Orbit:
        """The orbit of :meth:`require_orbit`, provided that it is admissible.

        Raises
        ------
        NoOrbitError
            If there is no orbit, or if the orbit is inadmissible.
        """
        orbit = self.require_orbit(n, amplitude, side)
        if not orbit.is_admissible():
            raise NoOrbitError(
                f"the {n}-T orbit at Λ = {amplitude:g} for {self.label} is inadmissible: "
                "an earlier impact or release occurs"
            )
        return orbit

    def require_orbit(self, n: int, amplitude: float, side: Side = Side.STABLE) -> Orbit:
        """The orbit of a single model at Λ on one side of the saddle-node.

        Raises
        ------
        NoOrbitError
            If there is no orbit; the message gives the reason.
        """
        orbit = self.orbit(n, amplitude, side)
        if not orbit.exists:
            why = str(self.absence(n, amplitude, side))
            if why == Absence.BELOW_SADDLE_NODE:
                why = f"{why} at Λ = {float(self.saddle_node(n).amplitude):.6g}"
            raise NoOrbitError(f"no {n}-T orbit at Λ = {amplitude:g} for {self.label}: {why}")
        return orbit
