"""Balls whose parameters are known by name, so that any of them can vary along a branch."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from bouncing_ball.errors import AMPLITUDE, ModelError, ParameterError, Range, did_you_mean
from bouncing_ball.numerics.arrays import pick
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.models.model import Model

LAMBDA = "amplitude"
"""The name of Λ, the parameter that all balls have."""
LOWEST = 1e-4
"""The smallest Λ of a branch or a curve: a fold below it belongs to a nearly elastic contact, and
the steps along a branch are too long to resolve it."""
# A branch stays away from an end of a range that is not in the range by this number.
_INSIDE = 1e-9
_RANGE_OF_LAMBDA = AMPLITUDE._replace(or_zero=False)


@dataclass(frozen=True)
class Balls:
    """Balls of one model on tables of amplitude Λ.

    Parameters
    ----------
    model : Model
        A single model, or an array of models.
    amplitude : float or array
        Λ.

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

    @property
    def values(self) -> dict[str, Any]:
        """The value of each parameter that may vary, Λ included."""
        return {**self.model.numbers(), LAMBDA: self.amplitude}

    def at(self, varied: Mapping[str, Any]) -> Self:
        """The balls with other values of some parameters; arrays have one entry for each ball.

        Raises
        ------
        ModelError
            If no ball has these parameters.
        """
        rest = {name: value for name, value in varied.items() if name != LAMBDA}
        model = self.model.varied(rest) if rest else self.model
        return type(self)(model, varied.get(LAMBDA, self.amplitude))

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
        return type(self)(model, amplitude)

    def take(self, which: Any) -> Self:
        """The balls of a row with these indices."""
        amplitude = np.asarray(self.amplitude)
        return type(self)(self.model.take(which), pick(amplitude, which))

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
        bouncing_ball.errors.ParameterError: these orbits have no 'loss': one of restitution, \
amplitude
        """
        names = list(self.values)
        if name not in names:
            known = f"one of {', '.join(names)}{did_you_mean(name, names)}"
            raise ParameterError(f"these orbits have no {{}}: {known}", repr(name))
        return self._allowed(name)

    def _allowed(self, name: str) -> Range:
        return _RANGE_OF_LAMBDA if name == LAMBDA else self.model.range_of(name)

    def bounds(self, name: str) -> tuple[float, float]:
        """The smallest and the largest value of a parameter on a branch."""
        allowed = self._allowed(name)
        low = allowed.low + (_INSIDE if allowed.ends[0] == "(" else 0.0)
        high = allowed.high - (_INSIDE if allowed.ends[1] == ")" else 0.0)
        return low, high


def dynamics_inside(
    balls: Balls, varied: Mapping[str, np.ndarray], along: Sequence[str]
) -> tuple[Dynamics | None, np.ndarray]:
    """The dynamics of a row of balls, and which of them are inside the ranges.

    ``varied`` are values of the parameters in ``along``, one for each ball, which may be outside
    their ranges. Such balls have the first value that is inside. The dynamics is None if there is
    none, or if the model refuses the parameters for another reason.
    """
    inside = np.ones(next(iter(varied.values())).shape, dtype=bool)
    for name in along:
        low, high = balls.bounds(name)
        inside &= (varied[name] >= low) & (varied[name] <= high)
    if not inside.any():
        return None, inside
    if not inside.all():
        first = inside.argmax()
        varied = {name: np.where(inside, varied[name], varied[name][first]) for name in along}
    try:
        return balls.at(varied).dynamics(), inside
    except ModelError:
        return None, inside
