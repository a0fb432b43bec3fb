"""Paths: parameters along which orbits are followed.

A value on a path is a number, an array, or a complex step.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bouncing_ball_beyond.contacts.balls import Ball
from bouncing_ball_beyond.tables.table import SINE, Table

LIMITS = {
    "amplitude": (1e-12, 1e8),
    "restitution": (0.0, 1.0),
    "frequency_ratio": (0.0, 1e8),
    "damping_ratio": (0.0, 1e4),
}
"""Minimum and maximum of parameters. The default is 0 and infinity; see `Path.limits`."""

OF_TABLES = ("harmonic_", "phase_")
"""Prefixes of the names of the parameters of tables."""


@dataclass(frozen=True)
class Path:
    """A path along the parameter "amplitude" (Λ), or a parameter of the ball or of the table."""

    name: str

    def apply(
        self, value: Any, ball: Ball, amplitude: Any, table: Table
    ) -> tuple[Ball, Any, Table]:
        """Return the ball, Λ and the table after the parameter is set to ``value``."""
        if self.name == "amplitude":
            return ball, value, table
        if self.name.startswith(OF_TABLES):
            return ball, amplitude, table.at(**{self.name: value})
        return ball.at(**{self.name: value}), amplitude, table

    def place(self, ball: Ball, amplitude: Any, table: Table = SINE) -> Any:
        """Return the value of the parameter for a ball, an amplitude and a table."""
        return {"amplitude": amplitude, **ball.parameters, **table.parameters}[self.name]

    def limits(self, ball: Ball, amplitude: Any) -> tuple[float, float]:
        """Return the minimum and the maximum of the parameter."""
        least = -np.inf if self.name.startswith(OF_TABLES) else 0.0
        return LIMITS.get(self.name, (least, np.inf))


AMPLITUDE = Path("amplitude")


@dataclass(frozen=True)
class Frequency(Path):
    """A path along the frequency Ω of the table at a fixed displacement amplitude a.

    The variable is Ω/√(g/a) = √Λ. Parameters of the ball change with the powers of Ω in
    `Ball.frequency_powers`.
    """

    name: str = "frequency"

    def apply(
        self, value: Any, ball: Ball, amplitude: Any, table: Table
    ) -> tuple[Ball, Any, Table]:
        """Return the ball, Λ = value² and the table after the frequency is set to ``value``."""
        times = value / np.sqrt(amplitude)
        old = ball.parameters
        powers = ball.frequency_powers.items()
        new = ball.at(**{name: old[name] * times**power for name, power in powers})
        return new, value**2, table

    def place(self, ball: Ball, amplitude: Any, table: Table = SINE) -> Any:
        """Return √Λ."""
        return np.sqrt(amplitude)

    def limits(self, ball: Ball, amplitude: Any) -> tuple[float, float]:
        """Return the square roots of the limits of Λ."""
        low, high = LIMITS["amplitude"]
        return np.sqrt(low), np.sqrt(high)


def path_of(along: str, ball: Ball, table: Table = SINE) -> Path:
    """Return the path with a name. Raises ValueError if ball and table have no such parameter."""
    allowed = ["amplitude", "frequency", *ball.parameters, *table.parameters]
    if along in allowed:
        return Frequency() if along == "frequency" else Path(along)
    if isinstance(along, str) and vars(ball).get(along, along) is None:
        raise ValueError(
            f"along = {along!r}: the ball has {' and '.join(ball.parameters)} as parameters; make"
            f" it with {along} instead, and start from its orbit"
        )
    raise ValueError(f"along = {along!r}: must be one of {', '.join(allowed)}")


def usual_range(path: Path, value: float, least: float, greatest: float) -> tuple[float, float]:
    """Return the default range of a parameter, cut off at its limits ``least`` and ``greatest``.

    A phase covers one turn: value ± π. For other parameters the upper end is the larger of 10 and
    10 |value|. The lower end is value/10 if value > 0, and otherwise minus the upper end.
    """
    if path.name.startswith("phase_"):
        return value - np.pi, value + np.pi
    far = max(10.0, 10 * abs(value))
    low = value / 10 if value > 0 else -far
    return max(least, low), min(greatest, far)
