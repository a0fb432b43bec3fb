"""Answers: the bounce that parameters give, what to paste, and what to know."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_contacts.bounces import Bounce
from bouncing_ball_contacts.units import MOST_WARNINGS, Array, holding, show, span

TOLERANCE = 0.02
"""Largest deviation of r from the one that is wanted."""


class Range(NamedTuple):
    """Smallest, mean and largest restitution coefficient over all instants within a step."""

    low: float
    mean: float
    high: float

    @classmethod
    def of(cls, restitutions: Array) -> "Range":
        """Return the range of drops."""
        return cls(*(float(f(restitutions)) for f in (np.min, np.mean, np.max)))

    def deviation(self, wanted: float) -> float:
        """Return the largest distance from the r that is wanted."""
        return max(wanted - self.low, self.high - wanted)

    def __str__(self) -> str:
        # Ends that differ by rounding are the same.
        return f"{self.mean:.3f} ({span(round(self.low, 6), round(self.high, 6))})"


@dataclass(frozen=True)
class Outcome:
    """What a contact does in the steps of an engine, over all instants of the impact.

    Attributes
    ----------
    restitution : Range
    depth : tuple of float
        Smallest and largest penetration in m; empty if it is not computed.
    rest : float, optional
        Depth at rest in m; None if the body never lies still, or lies less deep than the engine
        resolves.
    force : tuple of float
        Smallest and largest force in N; empty if it is not computed.
    """

    restitution: Range
    depth: tuple[float, ...] = ()
    rest: float | None = None
    force: tuple[float, ...] = ()


@dataclass(frozen=True, repr=False)
class Answer:
    """The bounce of a body in an engine.

    ``print(answer)`` is the short answer of the command, and ``answer.explained`` all of it.

    Attributes
    ----------
    engine : str
    ran : str
        In which version the engine was run, or "not run" and whose rule it borrows.
    bounce : Bounce
    time_step : float
        In s.
    parameters : mapping
        What is written, or what was given with the defaults of the engine.
    outcome : Outcome
    snippet : str
        What to paste; empty if nothing changes.
    warnings : tuple of str
        What changes r, then what the depth does; the severest first.
    not_for : tuple of str
        Scenes in which r is another one.
    remarks : tuple of str
        What else to know, what was given and what was assumed.
    also : tuple of Answer
        The same bounce at other steps.
    change : Answer
        The least change with which r is the wanted one; None if there is none.
    lost : str
        Why the engine loses the body; empty if it does not.
    numbers : mapping
        Further numbers: of a contact of springs ``stiffness`` in N/m and ``damping_ratio`` of all
        points together, if its spring is linear, and of a diagnosis ``limit``, r in short steps,
        and ``free``, the same without gravity.
    """

    engine: str
    ran: str
    bounce: Bounce
    time_step: float
    parameters: Mapping[str, Any]
    outcome: Outcome
    snippet: str = ""
    asked_step: float | None = None
    warnings: tuple[str, ...] = ()
    not_for: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()
    also: "tuple[Answer, ...]" = ()
    change: "Answer | None" = None
    gives: str = ""
    lost: str = ""
    numbers: Mapping[str, float] = field(default_factory=dict)

    @property
    def is_kept(self) -> bool:
        """Whether r is within the tolerance of the wanted one."""
        wanted = self.bounce.restitution
        return wanted is None or self.outcome.restitution.deviation(wanted) <= TOLERANCE

    @property
    def result(self) -> str:
        """The engine, the step, r with its range, and the depth beside the size of the body."""
        bounce = self.bounce
        is_other = self.asked_step is not None and self.time_step != self.asked_step
        step = show(self.time_step, "s") + is_other * f" (not {show(self.asked_step or 0, 's')})"
        depth = self.outcome.depth
        said = [
            (self.lost, f"lost, because {self.lost}"),
            (not self.lost, f"r = {self.outcome.restitution}"),
            (not self.is_kept, f"{bounce.restitution or 0:.4g} is wanted"),
            (
                depth and not self.lost,
                f"sinks {show(max(depth, default=0.0), 'm')} of {show(bounce.size, 'm')}",
            ),
        ]
        return f"{self.engine}, {step}: {', '.join(holding(said))}"

    def _lines(self, most: int, explain: bool = False) -> list[str]:
        """Return the lines of the answer with so many warnings, and the others behind them."""
        not_for = [f"Not for: {', '.join(self.not_for)}."] * bool(self.not_for)
        change = self.change
        paste = [change.snippet if change else self.snippet]
        also = []
        for answer in self.also:
            depth = show(max(answer.outcome.depth, default=0.0), "m")
            does = f"gives r = {answer.outcome.restitution}" if answer.gives else f"sinks {depth}"
            step = show(answer.time_step, "s").replace(" ", "")
            also.append(f"Also good: --time-step {step} {does}.")
            # Another step has lines of its own.
            also.append(answer.snippet if explain or not any(paste) else "")
        least = [f"Least change: {change.gives}."] if change else []
        warnings = [f"! {warning}" for warning in self.warnings]
        first = [*warnings[: most - bool(not_for)], *not_for]
        more = [*warnings[most - bool(not_for) :], *(f"{remark}." for remark in self.remarks)]
        not_run = [f"! {self.ran}"] * self.ran.startswith("not run")
        return [self.result, *not_run, *least, *filter(None, [*paste, *also]), *first, *more]

    @property
    def explained(self) -> str:
        """All of the answer."""
        return "\n".join(self._lines(len(self.warnings) + 1, explain=True))

    def __str__(self) -> str:
        lines = self._lines(MOST_WARNINGS)
        count = len(self.remarks) + max(len(self.warnings) + bool(self.not_for) - MOST_WARNINGS, 0)
        if not count:
            return "\n".join(lines)
        named = "1 more remark" if count == 1 else f"{count} more remarks"
        return "\n".join([*lines[:-count], f"{named}: --explain"])

    __repr__ = __str__
