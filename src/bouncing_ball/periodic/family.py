"""Balls whose parameters are known by name, so that any of them can vary along a branch."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from bouncing_ball.errors import ModelError, ParameterError, Range, did_you_mean
from bouncing_ball.models.dynamics import Dynamics, HasDynamics

AMPLITUDE = "amplitude"
"""The name of Λ, the parameter that all balls have."""
Implied = Callable[[Mapping[str, Any]], Mapping[str, Any]]
"""The values of other parameters that follow from those that vary."""


def nothing(varied: Mapping[str, Any]) -> Mapping[str, Any]:
    """The parameters are independent of each other."""
    return {}


# A branch stays away from an end of a range that is not in the range by this number.
_INSIDE = 1e-9


@dataclass(frozen=True)
class Family:
    """Balls of one kind, with the values of their parameters.

    Parameters
    ----------
    make : callable
        The model of the impact, or its law, for the parameters except Λ by name. Values that are
        arrays have one entry for each ball.
    values : mapping
        The value of each parameter that may vary, Λ included, under the name ``"amplitude"``.
    ranges : mapping
        The range of each parameter.
    implied : callable
        Parameters that are not independent of those that vary, such as the restitution coefficient
        of the damping ratio; by default none.

    Examples
    --------
    >>> from bouncing_ball.errors import RESTITUTION
    >>> from bouncing_ball.periodic.restitution_model import RestitutionModel
    >>> ranges = {"amplitude": Range(0), "restitution": RESTITUTION}
    >>> values = {"amplitude": 1.0, "restitution": 0.5}
    >>> family = Family(lambda given: RestitutionModel(given["restitution"]), values, ranges)
    >>> float(family.dynamics({"amplitude": np.array(2.0)}).amplitude)
    2.0
    """

    make: Callable[[Mapping[str, Any]], HasDynamics]
    values: Mapping[str, Any]
    ranges: Mapping[str, Range]
    implied: Implied = nothing

    def dynamics(self, varied: Mapping[str, np.ndarray]) -> Dynamics:
        """The contacts and flights of balls with these values of some parameters.

        Raises
        ------
        ModelError
            If no ball has these parameters.
        """
        given = {**self.values, **varied, **self.implied(varied)}
        amplitude = given.pop(AMPLITUDE)
        return self.make(given).dynamics(amplitude)

    def at(self, varied: Mapping[str, Any]) -> Self:
        """The same balls with other values of some parameters."""
        return replace(self, values={**self.values, **varied, **self.implied(varied)})

    def bounds(self, name: str) -> tuple[float, float]:
        """The smallest and the largest value of a parameter on a branch.

        Raises
        ------
        ParameterError
            If the balls have no such parameter.

        Examples
        --------
        >>> Family(dict, {"restitution": 0.5}, {"restitution": Range(0, 1, "(]")}).bounds("loss")
        Traceback (most recent call last):
        bouncing_ball.errors.ParameterError: these orbits have no 'loss': one of restitution
        """
        if name not in self.ranges:
            known = f"one of {', '.join(self.ranges)}{did_you_mean(name, self.ranges)}"
            raise ParameterError(f"these orbits have no {{}}: {known}", repr(name))
        allowed = self.ranges[name]
        low = allowed.low + (_INSIDE if allowed.ends[0] == "(" else 0.0)
        high = allowed.high - (_INSIDE if allowed.ends[1] == ")" else 0.0)
        return low, high


def known(
    family: Family, given: Mapping[str, np.ndarray], varied: Sequence[str]
) -> tuple[Dynamics | None, np.ndarray]:
    """The dynamics of a row of balls, and which of them are inside the ranges.

    ``given`` are values of parameters, one for each ball; those in ``varied`` may be outside their
    ranges. Such balls have the first value that is inside. The dynamics is None if there is none,
    or if the model refuses the parameters for another reason.
    """
    inside = np.ones(next(iter(given.values())).shape, dtype=bool)
    for name in varied:
        low, high = family.bounds(name)
        inside &= (given[name] >= low) & (given[name] <= high)
    if not inside.any():
        return None, inside
    safe = dict(given)
    for name in varied:
        safe[name] = np.where(inside, given[name], given[name][inside.argmax()])
    try:
        return family.dynamics(safe), inside
    except ModelError:
        return None, inside
