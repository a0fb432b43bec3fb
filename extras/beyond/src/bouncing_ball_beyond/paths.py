"""Along what orbits change, by numbers, arrays or complex steps of one variable."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bouncing_ball_beyond.balls import Ball, check_analytic
from bouncing_ball_beyond.tables import SINE, Table

LIMITS = {
    "amplitude": (1e-12, 1e8),
    "restitution": (0.0, 1.0),
    "frequency_ratio": (0.0, 1e8),
    "damping_ratio": (0.0, 1e4),
}
"""The least and the greatest value of parameters; of all others, they are 0 and infinite."""

OF_TABLES = ("harmonic_", "phase_")
"""How the names of the parameters of tables begin."""


@dataclass(frozen=True)
class Path:
    """One parameter: "amplitude" is Λ, all others are those of the ball or of the table."""

    name: str

    def apply(
        self, value: Any, ball: Ball, amplitude: Any, table: Table
    ) -> tuple[Ball, Any, Table]:
        """The ball, Λ and the table at a value of the variable, from those at another one."""
        if self.name == "amplitude":
            return ball, value, table
        if self.name.startswith(OF_TABLES):
            return ball, amplitude, table.at(**{self.name: value})
        return ball.at(**{self.name: value}), amplitude, table

    def place(self, ball: Ball, amplitude: Any, table: Table = SINE) -> Any:
        """The value of the variable at a ball, an amplitude and a table."""
        return {"amplitude": amplitude, **ball.parameters, **table.parameters}[self.name]

    def limits(self, ball: Ball, amplitude: Any) -> tuple[float, float]:
        """The least and the greatest value of the variable."""
        least = -np.inf if self.name.startswith(OF_TABLES) else 0.0
        return LIMITS.get(self.name, (least, np.inf))


AMPLITUDE = Path("amplitude")


@dataclass(frozen=True)
class Frequency(Path):
    """A table that changes its frequency Ω at a fixed stroke a, by Ω/√(g/a) = √Λ; parameters of the
    ball change by their `Ball.frequency_powers`."""

    name: str = "frequency"

    def apply(
        self, value: Any, ball: Ball, amplitude: Any, table: Table
    ) -> tuple[Ball, Any, Table]:
        """The ball and Λ = value², from those at another frequency."""
        times = value / np.sqrt(amplitude)
        old = ball.parameters
        powers = ball.frequency_powers.items()
        new = ball.at(**{name: old[name] * times**power for name, power in powers})
        return new, value**2, table

    def place(self, ball: Ball, amplitude: Any, table: Table = SINE) -> Any:
        """√Λ."""
        return np.sqrt(amplitude)

    def limits(self, ball: Ball, amplitude: Any) -> tuple[float, float]:
        """The frequencies at which Λ is within its limits."""
        low, high = LIMITS["amplitude"]
        return np.sqrt(low), np.sqrt(high)


@dataclass(frozen=True, init=False)
class ParameterPath(Path):
    """Parameters as functions of one variable, along which orbits are followed.

    Parameters
    ----------
    name : str
        The name of the variable, which is in [low, high].
    **functions : callable
        For each parameter that changes, an analytic function of the variable that takes arrays,
        also complex ones. The first one tells where an orbit is, and must rise or fall throughout.

    The shaker of docs/orbits.md, in hertz, is an example.
    """

    low: float
    high: float
    functions: Mapping[str, Callable] = field(compare=False)

    def __init__(self, name: str, *, low: float, high: float, **functions: Callable) -> None:
        if not low < high:
            raise ValueError(f"low = {low:g}, high = {high:g}: low must be below high")
        if not functions:
            raise ValueError(f"the path {name} needs a function for each parameter that changes")
        samples = np.linspace(low, high, 33)
        for parameter, function in functions.items():
            between = (samples[1:] + samples[:-1]) / 2
            check_analytic(f"{parameter}: the function", function, between)
        first, function = next(iter(functions.items()))
        steps = np.diff(function(samples))
        if not (np.all(steps > 0) or np.all(steps < 0)):
            raise ValueError(f"{first} must rise or fall throughout the path {name}")
        vars(self).update(name=name, low=low, high=high, functions=functions)

    def apply(
        self, value: Any, ball: Ball, amplitude: Any, table: Table
    ) -> tuple[Ball, Any, Table]:
        """The ball, Λ and the table at a value of the variable."""
        values = {name: function(value) for name, function in self.functions.items()}
        amplitude = values.pop("amplitude", amplitude)
        of_table = {name: values.pop(name) for name in table.parameters if name in values}
        return ball.at(**values), amplitude, table.at(**of_table) if of_table else table

    def place(self, ball: Ball, amplitude: Any, table: Table = SINE) -> Any:
        """The value of the variable; ValueError if the parameters are not those of the path."""
        # Only paths of one's own need this module, which takes long to import.
        from scipy.optimize import brentq

        here = {**ball.parameters, **table.parameters, "amplitude": amplitude}
        name, function = next(iter(self.functions.items()))
        ends = np.sort([function(self.low), function(self.high)])
        if not ends[0] <= here[name] <= ends[1]:
            raise ValueError(
                f"the orbit is not on the path {self.name}: its {name} is {here[name]:.10g}, and on"
                f" the path it is in [{ends[0]:g}, {ends[1]:g}]"
            )
        place = brentq(lambda x: function(x) - here[name], self.low, self.high, xtol=1e-15)
        for name, function in self.functions.items():
            # Numbers that differ by rounding are on the path.
            if not np.isclose(function(place), here[name], rtol=1e-9, atol=0):
                raise ValueError(
                    f"the orbit is not on the path {self.name}: its {name} is {here[name]:.10g},"
                    f" and {function(place):.10g} on the path"
                )
        return place

    def limits(self, ball: Ball, amplitude: Any) -> tuple[float, float]:
        """The range of the variable."""
        return self.low, self.high


def path_of(along: str | Path, ball: Ball, table: Table = SINE) -> Path:
    """The path of a name, or a path itself; ValueError if there is no such parameter."""
    allowed = ["amplitude", *ball.parameters, *table.parameters]
    if not isinstance(along, str):
        unknown = [name for name in getattr(along, "functions", ()) if name not in allowed]
        if unknown:
            raise ValueError(
                f"the path {along.name} has {unknown[0]!r}: must be one of {', '.join(allowed)}"
            )
        return along
    allowed.insert(1, "frequency")
    if along in allowed:
        return Frequency() if along == "frequency" else Path(along)
    if along in vars(ball):
        raise ValueError(
            f"along = {along!r}: the ball is given by {' and '.join(ball.parameters)}; start from"
            f" the orbit of a ball that is given by its {along}"
        )
    raise ValueError(f"along = {along!r}: must be one of {', '.join(allowed)} or a path")


def usual_range(path: Path, value: float, least: float, greatest: float) -> tuple[float, float]:
    """Where a curve ends if nothing is said, within the limits: after a turn of a phase; else at a
    tenth and at ten times a value or at 10, and as much below zero if it is not positive."""
    if path.name.startswith("phase_"):
        return value - np.pi, value + np.pi
    far = max(10.0, 10 * abs(value))
    low = value / 10 if value > 0 else -far
    return max(least, low), min(greatest, far)
