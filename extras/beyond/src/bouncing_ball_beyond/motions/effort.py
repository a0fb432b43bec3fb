"""Limit the work of a search, and report its progress."""

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field

EVALUATIONS = 300_000
"""Number of contacts of one ball after which a search for orbits ends.

A search for all orbits with 4 impacts in 4 periods takes about 33,000."""

EVERY = 2.0
"""Time between two reports of progress in s."""


class SearchEnded(RuntimeError):
    """Raised if a search has used its evaluations. The message says what was tried."""


@dataclass
class Effort:
    """Work of one search.

    Attributes
    ----------
    what : str
        Name of the search.
    evaluations : float
        Number of contacts for each ball after which the search raises `SearchEnded`.
    progress : callable, optional
        Function that receives a line of text, between steps that are `EVERY` seconds apart. By
        default the lines go to the standard error if it is a terminal.
    spent : int
        Number of contacts so far.
    balls : int
        Number of balls that are searched at once.
    tried : list of str
        Steps of the search so far. The last one is under way.
    """

    what: str
    evaluations: float
    progress: Callable[[str], object] | None = None
    spent: int = 0
    balls: int = 1
    tried: list[str] = field(default_factory=list)
    told: float = field(default_factory=time.monotonic)

    def __post_init__(self) -> None:
        if not (self.progress is None or callable(self.progress)):
            raise ValueError(
                f"progress = {self.progress!r:.60}: must be a function of a line of text, such as"
                " print"
            )

    def spend(self, contacts: int, step: str = "") -> None:
        """Count contacts before they are computed. A text begins a step of the search."""
        if step:
            self.tried.append(step)
        self.spent += contacts
        if self.spent > self.evaluations * self.balls:
            raise SearchEnded(
                f"{self.what}: no answer after {self.evaluations:,.0f} evaluations; tried:"
                f" {', '.join(self.tried)}; give more evaluations"
            )
        if time.monotonic() - self.told >= EVERY:
            self.report(f"{self.tried[-1]}, {self.spent:,} evaluations")

    def report(self, text: str) -> None:
        """Report a line of progress now."""
        self.told = time.monotonic()
        if self.progress:
            self.progress(f"{self.what}: {text}")
        elif sys.stderr.isatty():
            print(f"{self.what}: {text}", file=sys.stderr)
