"""Paths of balls: several parameters that change together, as functions of one variable.

The variable takes the place of a parameter along a branch: it is a coordinate of the equations of
an orbit, and :class:`~bouncing_ball_beyond.periodic.orbits.balls.Balls` has the parameters of its
values. A shaker that sweeps its frequency at a fixed stroke is such a path (:class:`Sweep`), and
:class:`ParameterPath` is one of a user.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy

from bouncing_ball_beyond.inherited.datasets.arguments import checked_number
from bouncing_ball_beyond.inherited.errors import NoOrbitError, ParameterError, Range, shortened
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.periodic.orbits.balls import FREQUENCY, LAMBDA, Balls, Path

# The values of a user's path at which its parameters must be inside their ranges.
_SAMPLES = 65
# A ball is on a path if its parameters are those of the path up to this part. A place on the path
# is known to rounding, and the located orbits that are followed to 1e-12.
_ON_PATH = 1e-9


@dataclass(frozen=True)
class Sweep(Path):
    """A table whose frequency changes at a fixed stroke a, below the same ball and contact.

    The variable is the frequency Ω over √(g/a). Then Λ is its square, and a parameter of the
    contact that is proportional to a power of Ω (:meth:`.Model.frequency_powers`) changes by it::

        Λ = f²,    ϖ ∝ 1/f

    Examples
    --------
    >>> from bouncing_ball_beyond.models.contact_model import ContactModel
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> from bouncing_ball_beyond.periodic.orbits.balls import Balls
    >>> balls = Balls(ContactModel(SpringDamper(10.0, 0.1)), 1.0)
    >>> {name: float(x) for name, x in Sweep().parameters(balls, 2.0).items()}
    {'amplitude': 4.0, 'frequency_ratio': 5.0}
    """

    name = FREQUENCY

    def moves(self, balls: Balls) -> list[str]:
        return [LAMBDA, *balls.model.frequency_powers()]

    def parameters(self, balls: Balls, variable: Any) -> dict[str, Any]:
        values = balls.model.numbers()
        faster = variable / self.place(balls)
        powers = balls.model.frequency_powers().items()
        moved = {name: values[name] * faster**power for name, power in powers}
        return {LAMBDA: variable * variable, **moved}

    def place(self, balls: Balls) -> Any:
        return np.sqrt(balls.amplitude)

    @np.errstate(divide="ignore", invalid="ignore")
    def range(self, balls: Balls) -> Range:
        here = self.place(balls)
        values = balls.values
        low, high = np.sqrt(balls.bounds(LAMBDA))
        for name, power in balls.model.frequency_powers().items():
            # A parameter keeps its sign, and one that is 0 stays there: NaN bounds nothing.
            shares = np.multiply.outer(balls.bounds(name), 1 / np.asarray(values[name]))
            ends = here * np.maximum(shares, 0.0) ** (1 / power)
            low = np.fmax(low, np.min(ends, axis=0)).max()
            high = np.fmin(high, np.max(ends, axis=0)).min()
        return Range(float(low), float(high), "[]")


class ParameterPath(Path):
    """Parameters of a ball as functions of one variable, along which an orbit can be followed.

    The orbit must be on the path: the first function tells at which value of the variable it is,
    so that it must rise or fall throughout.

    Parameters
    ----------
    name : str
        The name of the variable in results.
    low, high : float
        Its range.
    **functions : callable
        For each parameter that changes, such as ``amplitude`` or ``frequency_ratio``, a function of
        the variable, which takes floats and arrays.

    Raises
    ------
    ParameterError
        If there is no function, or if the range is none.

    Examples
    --------
    A shaker with a stroke of 0.5 mm below a ball on a contact of 500 Hz, in hertz:

    >>> import bouncing_ball_beyond
    >>> hertz = ParameterPath(
    ...     "hertz",
    ...     low=15.0,
    ...     high=30.0,
    ...     amplitude=lambda f: 0.5e-3 * (2 * np.pi * f) ** 2 / 9.80665,
    ...     frequency_ratio=lambda f: 500.0 / f,
    ... )
    >>> ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=500.0 / 20.0)
    >>> lam = 0.5e-3 * (2 * np.pi * 20.0) ** 2 / 9.80665
    >>> start = bouncing_ball_beyond.orbit(ball, amplitude=lam)
    >>> found = bouncing_ball_beyond.follow(start, along=hertz, to=25.0)
    >>> found.to_dataset().special_hertz.values.round(4).tolist()
    [22.701]
    """

    def __init__(
        self, name: str, *, low: float, high: float, **functions: Callable[[Any], Any]
    ) -> None:
        if not isinstance(name, str) or not name.isidentifier():
            raise ParameterError("{name} = {} is no name of a variable", shortened(name))
        if not functions or not all(callable(each) for each in functions.values()):
            raise ParameterError(
                "a path needs a function for each parameter that changes: amplitude=lambda x: …"
            )
        if name in functions:
            raise ParameterError("{name} = {} is also that of a parameter", shortened(name))
        self._name = name
        first = checked_number("low", low, Range())
        self._range = Range(first, checked_number("high", high, Range(first, ends="()")), "[]")
        self.functions: Mapping[str, Callable[[Any], Any]] = functions

    def __repr__(self) -> str:
        moves = ", ".join(self.functions)
        return f"ParameterPath({self.name!r}, {self._range.interval}, {moves})"

    @property
    def name(self) -> str:
        return self._name

    def moves(self, balls: Balls) -> list[str]:
        return list(self.functions)

    def parameters(self, balls: Balls, variable: Any) -> dict[str, Any]:
        return {name: function(variable) for name, function in self.functions.items()}

    def place(self, balls: Balls) -> Any:
        """The value of the variable at the parameters of single balls.

        Raises
        ------
        NoOrbitError
            If the balls are not on the path.
        """
        first, function = next(iter(self.functions.items()))
        wanted = float(balls.values[first])

        def missing(variable: float) -> float:
            return float(function(variable)) - wanted

        ends = np.array([missing(self._range.low), missing(self._range.high)])
        if ends[0] * ends[1] > 0:
            values = wanted + np.sort(ends)
            raise NoOrbitError(
                f"{first} = {wanted:g} of the orbit is not on the path, whose {first} is between "
                f"{values[0]:g} and {values[1]:g}"
            )
        found = scipy.optimize.brentq(missing, self._range.low, self._range.high)
        for name, value in self.parameters(balls, found).items():
            here = float(balls.values[name])
            if not abs(float(value) - here) <= _ON_PATH * abs(here):
                raise NoOrbitError(
                    f"the orbit is not on the path: {name} = {here:g}, and {float(value):g} on the "
                    f"path where {first} = {wanted:g}"
                )
        return found

    def range(self, balls: Balls) -> Range:
        """The range that was given.

        Raises
        ------
        ParameterError
            If a parameter is outside its own range there.
        """
        samples = np.linspace(self._range.low, self._range.high, _SAMPLES)
        for name, values in self.parameters(balls, samples).items():
            allowed = balls.range_of(name)
            given = np.broadcast_to(values, samples.shape)
            wrong = next((x for x in given.tolist() if x not in allowed), None)
            if wrong is not None:
                raise ParameterError(f"on the path {name} = {{}} is not {allowed}", f"{wrong:g}")
        return self._range


def balls_along(model: Model, amplitude: Any, *along: Any) -> tuple[Balls, tuple[str, ...]]:
    """Balls, with the path on which they move if one of the things along which they change is one,
    and the names of all of these.

    Parameters
    ----------
    model : Model
    amplitude : float or array
    *along : str or Path
        Names of parameters, :data:`.FREQUENCY`, or a path.

    Raises
    ------
    ParameterError
        If the balls have no such parameter, or if one of them follows from another.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> balls, names = balls_along(RestitutionModel(0.5), 4.0, "frequency")
    >>> names, float(balls.values["frequency"])
    (('frequency',), 2.0)
    """
    balls = Balls(model, amplitude)
    paths = [each for each in map(_path_of, along) if each and each.name not in balls.values]
    if len(paths) > 1:
        raise ParameterError("{along} has two paths: one of them can be a parameter")
    if paths:
        balls = replace(balls, path=paths[0])
    names = tuple(map(name_of, along))
    for name in names:
        if name != LAMBDA:
            balls.range_of(name)
        moved = balls.moved_by(name)
        for other in names:
            if other in moved:
                raise ParameterError(f"{other} follows from {name}: both cannot vary")
    return balls, names


def name_of(along: str | Path) -> str:
    """The name of a parameter, or of the variable of a path."""
    return along.name if isinstance(along, Path) else along


def place_along(model: Model, amplitude: Any, along: str | Path) -> float:
    """The value of a parameter, or of the variable of a path, at a single ball."""
    balls, (name,) = balls_along(model, amplitude, along)
    return float(balls.values[name])


def _path_of(along: Any) -> Path | None:
    """A path that is given, or the one that is meant by its name."""
    if isinstance(along, Path):
        return along
    return Sweep() if along == FREQUENCY else None
