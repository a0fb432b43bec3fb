"""The outcomes of a comparison from the best to the worst, and the parts of a comparison."""

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from bouncing_ball_beyond.inherited.pipeline.artifact_files import DATASET


class Outcome(StrEnum):
    """The result of comparing an artifact, a file or a part of a file with the record.

    The outcomes are in order from the best to the worst; a whole has the outcome of its worst part.
    What is within its budget is rounding.
    """

    IDENTICAL = "identical"
    ROUNDING = "rounding"
    DRIFTED = "drifted"
    STRUCTURE = "changed structure"
    PARAMETERS = "changed parameters"
    STALE = "stale"
    MISSING = "missing"
    EXTRA = "extra"
    NOT_MADE = "not made"
    UNREADABLE = "could not be compared"

    @property
    def rank(self) -> int:
        """Place in the order, 0 for ``IDENTICAL``."""
        return list(Outcome).index(self)

    @property
    def agrees(self) -> bool:
        """Whether the difference, if any, is within the budget."""
        return self.rank <= Outcome.ROUNDING.rank

    @property
    def status(self) -> int:
        """Exit status: 0 for agreement, 1 for a difference, 2 if there was no comparison.

        Examples
        --------
        >>> [outcome.status for outcome in (Outcome.ROUNDING, Outcome.STALE, Outcome.UNREADABLE)]
        [0, 1, 2]
        """
        return 2 if self is Outcome.UNREADABLE else int(not self.agrees)


@dataclass(frozen=True)
class Row:
    """A difference in a file: of a variable, a parameter, an attribute, a line, or of pixels.

    ``name`` is that of the variable, or the number of the line, and ``told`` says the difference in
    words. Rows of words, such as verdicts, come first, and those of numbers by the ``size`` of
    their relative change; ``share`` is the drift over the budget.
    """

    name: str
    outcome: Outcome
    told: str = ""
    size: float = math.inf
    share: float = 0.0
    is_words: bool = False

    @property
    def place(self) -> tuple[bool, int, float]:
        """The place among other rows: words, then the worst outcome, then the largest change."""
        return not self.is_words, -self.outcome.rank, -self.size


@dataclass(frozen=True)
class Whole:
    """A file of rows, an artifact of files, or a folder of artifacts.

    An artifact that differs has its ``cause`` in words, and the files of ``code`` in which it may
    be. A PNG file has its ``pictures``, the bytes in the record and the new ones.
    """

    name: str
    parts: tuple[Any, ...] = ()
    pictures: tuple[bytes, ...] = ()
    cause: str = ""
    code: tuple[str, ...] = ()

    @property
    def outcome(self) -> Outcome:
        """The worst outcome of the parts, ``IDENTICAL`` if there are none.

        Examples
        --------
        >>> rows = Row("a", Outcome.ROUNDING), Row("b", Outcome.MISSING), Row("c", Outcome.DRIFTED)
        >>> str(Whole("", rows).outcome)
        'missing'
        """
        outcomes = (part.outcome for part in self.parts)
        return max(outcomes, key=lambda outcome: outcome.rank, default=Outcome.IDENTICAL)

    @property
    def place(self) -> tuple[bool, int, float]:
        """The place among others, which is that of the first part that is told."""
        return self.told[0].place

    @property
    def told(self) -> list[Any]:
        """The parts whose differences are told: of an artifact its dataset, if this differs,
        because pictures and tables say the same.
        """
        return [part for part in self.moved if part.name.endswith(DATASET)] or self.moved

    @property
    def moved(self) -> list[Any]:
        """The parts that do not agree with the record, in the order in which they are told.

        Examples
        --------
        >>> rows = Row("a", Outcome.DRIFTED, size=1.0), Row("b", Outcome.DRIFTED, is_words=True)
        >>> [row.name for row in Whole("", rows).moved]
        ['b', 'a']
        """
        found = [part for part in self.parts if not part.outcome.agrees]
        return sorted(found, key=lambda part: part.place)
