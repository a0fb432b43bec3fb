"""The interface of every model of the impact.

Code that uses a model calls the methods of this interface. Its class is asked for where the closed
form or the search for its orbits is chosen (:func:`.orbits_of`), and by calls for rigid balls
alone. A model says how a ball comes into
contact, leaves the table and flies, and how small deviations grow on the way
(:class:`~bouncing_ball_beyond.models.dynamics.Dynamics`); its periodic orbits follow from that
(:mod:`bouncing_ball_beyond.periodic`)::

    model = ContactModel(SpringDamper.from_restitution(0.85, 10.0))  # or RestitutionModel(…)
    model.simulate(0.9, phase=0.0, velocity=-3.0, impacts=100).phase
    bouncing_ball_beyond.orbit(model, 1, amplitude=0.9)

A new model is a subclass of :class:`Model`. Models are arrays: the fields of their laws broadcast,
and they can be indexed, ``model[3]``.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.datasets.arguments import chosen
from bouncing_ball_beyond.inherited.errors import (
    DAMPING_RATIO,
    FREQUENCY_RATIO,
    RESTITUTION,
    ModelError,
    Range,
)
from bouncing_ball_beyond.inherited.models.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball_beyond.inherited.numerics.arrays import Batch
from bouncing_ball_beyond.models.ball import Ball
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.sequence import Cycle, ImpactSequence

RANGES: Mapping[str, Range] = {
    "frequency_ratio": FREQUENCY_RATIO,
    "restitution": RESTITUTION,
    "damping_ratio": DAMPING_RATIO,
    "damping": Range(0, np.inf, "[)"),
}
"""The ranges of the parameters of models that have one; other parameters are finite numbers."""


class Model(Batch, Ball, ABC):
    """A law of the impact, for one ball or for a row of balls.

    A subclass is a frozen dataclass whose first field holds the law.
    """

    @property
    @abstractmethod
    def name(self) -> str:
        """The name of the model in messages, which a subclass may define as a class variable."""

    @property
    def impact_law(self) -> Any:
        """The law of the impact, which is the first field of the model."""
        return getattr(self, fields(self)[0].name)

    @property
    def label(self) -> str:
        """The parameters of a single model as text: the label of the law if it has one."""
        return getattr(self.impact_law, "label", repr(self.impact_law))

    @abstractmethod
    def dynamics(self, amplitude: ArrayLike) -> Dynamics:
        """The contacts and flights of the model's balls on a table of amplitude Λ.

        Raises
        ------
        ModelError
            If Λ is not finite and ≥ 0.
        """

    @abstractmethod
    def signature(self, speed: ArrayLike) -> Instant:
        """The impact as an instant, at impact speeds v > 0.

        Raises
        ------
        ModelError
            If a contact does not release the ball.
        """

    def permanent_contact_threshold(self) -> Any:
        """Λ up to which the ball stays on the table, of the model's shape.

        By default it is that of instantaneous impacts, Λ_CR = 1 (Eq. 9).
        """
        return np.full(self.shape, RESTITUTION_THRESHOLD)[()]

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

    def numbers(self) -> dict[str, Any]:
        """The numerical parameters of the law by name, each of which can vary along a branch.

        Examples
        --------
        >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
        >>> RestitutionModel(0.5).numbers()
        {'restitution': 0.5}
        """
        return dict(self._all_numbers)

    @cached_property
    def _all_numbers(self) -> dict[str, Any]:
        # Cached, because each step along a branch asks for the names.
        return _numbers(self)

    def range_of(self, name: str) -> Range:
        """The range of a parameter along a branch; without another one it is any finite number."""
        return RANGES.get(name, Range())

    def implied(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Parameters that follow from others, of which these values are given, as ζ from r."""
        return _implied(self, values)

    def frequency_powers(self) -> dict[str, float]:
        """The powers of the frequency Ω of the table to which the numbers of a law are proportional
        if the ball, its contact and gravity stay the same; a pure number has none.

        With the units g/Ω² of lengths and 1/Ω of times, a parameter with the powers l of length and
        t of time in its unit is proportional to Ω^(2l + t).

        Raises
        ------
        ModelError
            If the law declares no unit of a parameter.

        Examples
        --------
        >>> from bouncing_ball_beyond.models.contact_model import ContactModel
        >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
        >>> ContactModel(SpringDamper(10.0, 0.1)).frequency_powers()
        {'frequency_ratio': -1}
        """
        return {name: power for name, power in _frequency_powers(self).items() if power}

    def varied(self, values: Mapping[str, Any]) -> Self:
        """The model with other values of some parameters; arrays make a row of models.

        Raises
        ------
        ModelError
            If the model has no such parameter, or if no law has these values.

        Examples
        --------
        >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
        >>> RestitutionModel(0.5).varied({"restitution": 0.75})
        RestitutionModel(restitution=0.75)
        """
        known = list(self.numbers())
        for name in values:
            chosen("parameter", name, known)
        return _with_numbers(self, {**values, **self.implied(values)})


def _is_number(value: Any) -> bool:
    # A row of laws is a sequence, of which numpy would make an array of objects one by one.
    return not is_dataclass(value) and np.asarray(value).dtype.kind in "iuf"


def _inner(law: Any) -> Iterator[Any]:
    """The laws inside of a law."""
    values = (getattr(law, field.name) for field in fields(law))
    return (value for value in values if is_dataclass(value))


def _implied(model: Any, values: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters that follow from these values by the laws inside of a model, such as ζ from r."""
    found: dict[str, Any] = {}
    for law in _inner(model):
        of_law = getattr(law, "implied", None)
        found |= _implied(law, values) if of_law is None else of_law(values)
    return found


def _numbers(law: Any) -> dict[str, Any]:
    """The numerical parameters of a law, or of the law inside of a law, by name."""
    values = {field.name: getattr(law, field.name) for field in fields(law)}
    found = {name: value for name, value in values.items() if _is_number(value)}
    for inner in _inner(law):
        found |= _numbers(inner)
    found |= _implied(law, found)
    return {name: x if np.ndim(x) else np.asarray(x).item() for name, x in found.items()}


def _frequency_powers(law: Any) -> dict[str, float]:
    """The power of Ω of each number of a law, or of the law inside of a law."""
    found: dict[str, float] = {}
    units = getattr(law, "units", {})
    for field in fields(law):
        if not _is_number(getattr(law, field.name)):
            continue
        if field.name not in units:
            kind = type(law).__name__
            raise ModelError(
                f"{kind} declares no unit of its parameter {field.name}, which tells how it "
                "follows the frequency"
            )
        unit = units[field.name]
        found[field.name] = 2 * unit.length + unit.time
    for inner in _inner(law):
        found |= _frequency_powers(inner)
    return found


def _with_numbers(law: Any, values: Mapping[str, Any]) -> Any:
    """The law with other values of its parameters."""
    changed: dict[str, Any] = {}
    for field in fields(law):
        inner = getattr(law, field.name)
        if is_dataclass(inner):
            changed[field.name] = _with_numbers(inner, values)
        elif field.name in values:
            changed[field.name] = values[field.name]
    return replace(law, **changed)
