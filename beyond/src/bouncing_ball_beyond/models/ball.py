"""Balls, which all public functions take: models of the impact, with their parameters as labels.

Every model is a ball (:class:`~bouncing_ball_beyond.models.model.Model`), also an array of models.
The parameters of a contact law may be unknown, and given instead by the restitution r and the
duration D of one free impact. These depend on the impact speed, so that such a ball has a model
only once this speed is chosen, by one of the methods ``at_…``. A ball whose parameters are known is
itself the model at every speed.
"""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import fields, is_dataclass
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.datasets.arguments import is_array
from bouncing_ball_beyond.models.attributes import Suggesting


class Ball(Suggesting):
    """One ball, or several if parameters are arrays, whose impacts obey one model."""

    is_known: ClassVar[bool] = True
    """Whether the model is known without a speed."""

    @cached_property
    def parameters(self) -> Mapping[str, Any]:
        """The parameters by name, which become axes and attributes of results.

        They are those of the function that made the ball, and otherwise the fields of its law.
        Several fields that are arrays share an axis "model", because they have one value for each
        model.

        Examples
        --------
        >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
        >>> from bouncing_ball_beyond.models.contact_model import ContactModel
        >>> dict(ContactModel(SpringDamper(10.0, 0.1)).parameters)
        {'frequency_ratio': 10.0, 'damping_ratio': 0.1, 'release': 'displacement'}
        """
        found = _fields_of(self)
        arrays = [name for name, value in found.items() if is_array(value)]
        if len(arrays) < 2:
            return found
        # Imported here, because a single orbit needs no labels.
        from xarray import DataArray

        return found | {name: DataArray(found[name], dims="model") for name in arrays}

    def labelled(self, parameters: Mapping[str, Any]) -> Self:
        """The same ball with other parameters as labels: those that were given by a user.

        It is equal to the ball without them, because they change no number but only the names of
        the axes of a result.
        """
        ball = copy(self)
        vars(ball)["parameters"] = parameters
        return ball

    def at_speed(self, speed: ArrayLike) -> Any:
        """The model of a ball whose free impact has the given r and D at this impact speed."""
        return self

    def at_orbit(self, n: int, amplitude: float, side: str = "stable") -> Any:
        """The model of a ball whose free impact has the given r and D at the impact speed of this
        n-T orbit.

        Raises
        ------
        NoOrbitError
            If the law depends on the orbit and there is none.
        """
        return self

    def at_limits(self, n: ArrayLike) -> Any:
        """The model of a ball whose free impact has the given r and D at the impact speed of the
        restitution model's n-T orbits, 2πn/(1 + r).
        """
        return self

    def take(self, which: Any) -> Any:
        """The balls of a row with these indices; a single ball is unchanged."""
        raise NotImplementedError

    def row(self, grid: Any) -> Any:
        """The balls at the places of a
        :class:`~bouncing_ball_beyond.inherited.datasets.labelled.Grid` of which the parameters are
        arguments, one after another.
        """
        return self.take(grid.numbers_of(self.parameters))


def _fields_of(law: Any) -> dict[str, Any]:
    """The fields of a law, or of the law inside of it, by name."""
    found: dict[str, Any] = {}
    for field in fields(law):
        value = getattr(law, field.name)
        if is_dataclass(value):
            found |= _fields_of(value)
        elif isinstance(value, str):
            found[field.name] = str(value)
        else:
            found[field.name] = value if np.ndim(value) else np.asarray(value).item()
    return found
