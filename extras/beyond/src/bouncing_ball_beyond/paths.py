"""Along what orbits change, by numbers, arrays or complex steps of one variable."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bouncing_ball_beyond.balls import Ball
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


def path_of(along: str, ball: Ball, table: Table = SINE) -> Path:
    """The path of a name; ValueError if there is no such parameter."""
    allowed = ["amplitude", "frequency", *ball.parameters, *table.parameters]
    if along in allowed:
        return Frequency() if along == "frequency" else Path(along)
    if isinstance(along, str) and along in vars(ball):
        raise ValueError(
            f"along = {along!r}: the ball is given by {' and '.join(ball.parameters)}; start from"
            f" the orbit of a ball that is given by its {along}"
        )
    raise ValueError(f"along = {along!r}: must be one of {', '.join(allowed)}")


def usual_range(path: Path, value: float, least: float, greatest: float) -> tuple[float, float]:
    """Where a curve ends if nothing is said, within the limits: after a turn of a phase; else at a
    tenth and at ten times a value or at 10, and as much below zero if it is not positive."""
    if path.name.startswith("phase_"):
        return value - np.pi, value + np.pi
    far = max(10.0, 10 * abs(value))
    low = value / 10 if value > 0 else -far
    return max(least, low), min(greatest, far)
