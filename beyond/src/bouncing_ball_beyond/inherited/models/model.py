"""What both models of the impact share: what an impact does to the phase and velocity of a ball.

A subclass of :class:`Model` defines

* :meth:`~Model.impact`, from the start of a contact to the release, with the first release found;
* :meth:`~Model.released`, the state of the ball at the end of a contact of a given duration;
* :meth:`~Model.derivative`, that of the phase and velocity at the release by those at the impact;
* :meth:`~Model.contraction`, the determinant of that derivative with the flight that follows, on a
  periodic orbit;
* :meth:`~Model.in_contact`, the motion in between;
* :meth:`~Model.permanent_contact_threshold`, and :attr:`~Model.label`, the model in a few symbols.

The flight (:mod:`bouncing_ball_beyond.inherited.models.flight`) is the same for both. Models are
arrays: their parameters broadcast, and an array of models is indexed, ``model[3]``.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from copy import copy
from dataclasses import fields
from enum import IntEnum
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np

from bouncing_ball_beyond.inherited.datasets.arguments import is_array
from bouncing_ball_beyond.inherited.errors import ParameterError, shortened
from bouncing_ball_beyond.inherited.numerics.arrays import Batch


class Status(IntEnum):
    """What a ball does after an impact."""

    BOUNCING = 0
    """It leaves the table, and another impact follows."""
    PERMANENT_CONTACT = 1
    """It stays on the table for ever."""
    UNDECIDED = 2
    """Its contact lasts for hundreds of oscillations, and was not followed to its end."""

    @property
    def words(self) -> str:
        """The status as text, such as "permanent contact"."""
        return self.name.lower().replace("_", " ")


class Departure(NamedTuple):
    """Ends of contacts: their duration, infinite for a contact that never ends, δ and δ′ of the
    ball at the release, and the :class:`Status`.
    """

    duration: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    status: np.ndarray


class Model(Batch, ABC):
    """A ball whose impacts obey one law, or an array of balls.

    In the arguments of all methods, ``phase`` φ and ``velocity`` δ′ < 0 are those at the start of
    the contact and ``amplitude`` is Λ. The velocities are relative to the table.
    """

    name: ClassVar[str]
    """The name of the model in messages and datasets."""

    @cached_property
    def parameters(self) -> Mapping[str, Any]:
        """The parameters by name, which become axes and attributes of results.

        They are those of the call that made the ball, and otherwise the fields of the model.

        Examples
        --------
        >>> from bouncing_ball_beyond.inherited.models.restitution import RestitutionModel
        >>> dict(RestitutionModel(0.5).parameters)
        {'restitution': 0.5}
        """
        found: dict[str, Any] = {}
        for each in fields(self):
            value = getattr(self, each.name)
            found[each.name] = str(value) if isinstance(value, str) else value
        arrays = [name for name, value in found.items() if is_array(value)]
        if len(arrays) > 1:
            # Imported here, because a single ball needs no labels. These arrays have one value for
            # each ball, and do not span a grid.
            from xarray import DataArray

            found |= {name: DataArray(found[name], dims="model") for name in arrays}
        return found

    def labelled(self, parameters: Mapping[str, Any]) -> Self:
        """The same ball, whose parameters are called as a user gave them."""
        ball = copy(self)
        vars(ball)["parameters"] = parameters
        return ball

    def row(self, grid: Any) -> Self:
        """The balls at the places of a
        :class:`~bouncing_ball_beyond.inherited.datasets.labelled.Grid` among whose arguments the
        parameters are, one after another; a single ball stands for all of them.
        """
        return self.take(grid.numbers_of(self.parameters))

    @property
    @abstractmethod
    def label(self) -> str:
        """The parameters of a single model as text."""

    @property
    def lag(self) -> Any:
        """κ: the contact ends where δ + κ δ′ = 0; 0 at the table's level."""
        return 0.0

    @abstractmethod
    def impact(
        self,
        phase: np.ndarray,
        velocity: np.ndarray,
        amplitude: np.ndarray,
        displacement: np.ndarray | float = 0.0,
    ) -> Departure:
        """The first release after each impact, for rows of one length.

        ``displacement`` is δ at the start of the contact, which is 0 unless a contact resumes.
        """

    @abstractmethod
    def released(
        self, duration: Any, phase: Any, velocity: Any, amplitude: Any
    ) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at the end of contacts of these durations."""

    @abstractmethod
    def derivative(self, duration: Any, phase: Any, velocity: Any, amplitude: Any) -> np.ndarray:
        """The derivative of (φ_b, δ′_b) at the release by (φ, δ′) at the impact, at releases after
        these durations, shape (..., 2, 2).
        """

    @abstractmethod
    def contraction(self, duration: Any) -> Any:
        """The factor by which contacts of these durations multiply areas of the phase plane.

        Flights keep areas, so that this is the determinant of the monodromy of a periodic orbit.
        """

    @abstractmethod
    def in_contact(
        self, time: Any, phase: Any, velocity: Any, amplitude: Any, displacement: Any = 0.0
    ) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times since the starts of contacts that have not ended before."""

    @abstractmethod
    def permanent_contact_threshold(self) -> Any:
        """The Λ up to which a ball at rest stays on the table."""


def a_ball(ball: Any) -> Model:
    """The first argument of a call, after a check of its type.

    Raises
    ------
    ParameterError
        If it is no ball.

    Examples
    --------
    >>> a_ball(0.85)
    Traceback (most recent call last):
    bouncing_ball_beyond.inherited.errors.ParameterError: the ball = 0.85 is not a ball: it is \
not made by rigid or \
spring_damper
    """
    if not isinstance(ball, Model):
        raise ParameterError(
            "the ball = {} is not a ball: it is not made by rigid or spring_damper", shortened(ball)
        )
    return ball


def a_single_ball(ball: Any) -> Model:
    """The first argument of a call that takes one ball.

    Raises
    ------
    ParameterError
        If it is no ball, or a parameter is an array.
    """
    for name, value in a_ball(ball).parameters.items():
        if is_array(value):
            raise ParameterError(f"{{{name}}} must be a single number here")
    return ball
