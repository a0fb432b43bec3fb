"""Balls whose parameters are known by name, so that any of them can vary along a branch.

Several parameters vary together on a :class:`Path`: then its variable is one more parameter.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np

from bouncing_ball_beyond.inherited.errors import (
    AMPLITUDE,
    ModelError,
    ParameterError,
    Range,
    did_you_mean,
)
from bouncing_ball_beyond.inherited.numerics.arrays import pick
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.models.model import Model

LAMBDA = "amplitude"
"""The name of Λ, the parameter that all balls have."""
FREQUENCY = "frequency"
"""The name of the table's frequency at a fixed stroke, the variable of a path."""
LOWEST = 1e-4
"""The smallest Λ of a branch or a curve: a fold below it belongs to a nearly elastic contact, and
the steps along a branch are too long to resolve it."""
# A branch stays away from an end of a range that is not in the range by this number.
_INSIDE = 1e-9
_RANGE_OF_LAMBDA = AMPLITUDE._replace(or_zero=False)


class Path(ABC):
    """Parameters of balls as functions of one variable."""

    @property
    @abstractmethod
    def name(self) -> str:
        """The name of the variable."""

    @abstractmethod
    def moves(self, balls: Balls) -> list[str]:
        """The names of the parameters that change along the path."""

    @abstractmethod
    def parameters(self, balls: Balls, variable: Any) -> dict[str, Any]:
        """The parameters at values of the variable, on the path on which the balls are."""

    @abstractmethod
    def place(self, balls: Balls) -> Any:
        """The value of the variable at the parameters of the balls."""

    @abstractmethod
    def range(self, balls: Balls) -> Range:
        """The range of the variable, in which all parameters are inside their ranges."""


@dataclass(frozen=True)
class Balls:
    """Balls of one model on tables of amplitude Λ.

    Parameters
    ----------
    model : Model
        A single model, or an array of models.
    amplitude : float or array
        Λ.
    path : Path, optional
        The path on which parameters vary together.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> balls = Balls(RestitutionModel(0.5), 1.0)
    >>> balls.values
    {'restitution': 0.5, 'amplitude': 1.0}
    >>> float(balls.at({"amplitude": 2.0}).dynamics().amplitude)
    2.0
    """

    model: Model
    amplitude: Any
    path: Path | None = None

    @property
    def values(self) -> dict[str, Any]:
        """The value of each parameter that may vary, Λ and the variable of the path included."""
        found = {**self.model.numbers(), LAMBDA: self.amplitude}
        if self.path is not None:
            found[self.path.name] = self.path.place(replace(self, path=None))
        return found

    def moved_by(self, name: str) -> set[str]:
        """The other parameters that vary if one varies: those of the path, and those that follow
        from others.
        """
        names = {name}
        if self.path is not None and name == self.path.name:
            names = set(self.path.moves(self))
        values = self.values
        implied = self.model.implied({each: values[each] for each in names if each != LAMBDA})
        return (names | implied.keys()) - {name}

    def at(self, varied: Mapping[str, Any]) -> Self:
        """The balls with other values of some parameters; arrays have one entry for each ball.

        Raises
        ------
        ModelError
            If no ball has these parameters.
        """
        values = dict(varied)
        if self.path is not None and self.path.name in values:
            values |= self.path.parameters(self, values.pop(self.path.name))
        amplitude = values.pop(LAMBDA, self.amplitude)
        model = self.model.varied(values) if values else self.model
        return replace(self, model=model, amplitude=amplitude)

    def dynamics(self) -> Dynamics:
        """The contacts and flights of the balls."""
        return self.model.dynamics(self.amplitude)

    def row(self, shape: tuple[int, ...], each: int) -> Self:
        """The balls broadcast to a shape, in a row in which each ball stands several times."""
        model = self.model
        if model.shape:
            numbers = np.arange(model.size).reshape(model.shape)
            row = np.repeat(np.broadcast_to(numbers, shape).ravel(), each)
            model = model.flat(model.shape).take(row)
        amplitude = self.amplitude
        if np.ndim(amplitude):
            amplitude = np.repeat(np.broadcast_to(amplitude, shape).ravel(), each)
        return replace(self, model=model, amplitude=amplitude)

    def take(self, which: Any) -> Self:
        """The balls of a row with these indices."""
        amplitude = np.asarray(self.amplitude)
        return replace(self, model=self.model.take(which), amplitude=pick(amplitude, which))

    def range_of(self, name: str) -> Range:
        """The range of a parameter.

        Raises
        ------
        ParameterError
            If the balls have no such parameter.

        Examples
        --------
        >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
        >>> Balls(RestitutionModel(0.5), 1.0).range_of("loss")
        Traceback (most recent call last):
        bouncing_ball_beyond.inherited.errors.ParameterError: these orbits have no 'loss': one of \
restitution, \
amplitude, frequency
        """
        if self.path is not None and name == self.path.name:
            return self._range_of_path
        names = [*self.model.numbers(), LAMBDA, FREQUENCY]
        if name not in names[:-1]:
            known = f"one of {', '.join(names)}{did_you_mean(name, names)}"
            raise ParameterError(f"these orbits have no {{}}: {known}", repr(name))
        return _RANGE_OF_LAMBDA if name == LAMBDA else self.model.range_of(name)

    @cached_property
    def _range_of_path(self) -> Range:
        # Cached, because each step along a branch asks for it.
        assert self.path is not None
        return self.path.range(replace(self, path=None))

    def bounds(self, name: str) -> tuple[float, float]:
        """The smallest and the largest value of a parameter on a branch."""
        allowed = self.range_of(name)
        low = allowed.low + (_INSIDE if allowed.ends[0] == "(" else 0.0)
        high = allowed.high - (_INSIDE if allowed.ends[1] == ")" else 0.0)
        return low, high


def dynamics_inside(
    balls: Balls, varied: Mapping[str, np.ndarray], bounds: Mapping[str, tuple[float, float]]
) -> tuple[Dynamics | None, np.ndarray]:
    """The dynamics of a row of balls, and which of them are inside the ranges.

    ``varied`` are values of parameters, one for each ball, which may be outside their ``bounds``,
    the smallest and the largest value of each. Such balls have the first value that is inside. The
    dynamics is None if there is none, or if the model refuses the parameters for another reason.
    """
    inside = np.ones(next(iter(varied.values())).shape, dtype=bool)
    for name, (low, high) in bounds.items():
        inside &= (varied[name] >= low) & (varied[name] <= high)
    if not inside.any():
        return None, inside
    if not inside.all():
        first = inside.argmax()
        varied = {name: np.where(inside, x, x[first]) for name, x in varied.items()}
    try:
        return balls.at(varied).dynamics(), inside
    except ModelError:
        return None, inside
