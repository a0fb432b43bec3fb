"""The outcomes of a comparison from the best to the worst, and of what it consists."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any


class Outcome(StrEnum):
    """The result for an artifact, a file or a part of it, and its counterpart in the record.

    In order: the outcome of a whole is that of its worst part.
    """

    IDENTICAL = "identical"
    WITHIN = "within budget"
    DRIFTED = "drifted"
    STRUCTURE = "changed structure"
    MISSING = "missing"
    EXTRA = "extra"
    UNREADABLE = "could not be compared"

    @property
    def rank(self) -> int:
        """Place in the order, 0 for ``IDENTICAL``."""
        return list(Outcome).index(self)

    @property
    def agrees(self) -> bool:
        """Whether the difference, if any, is within the budget."""
        return self.rank <= Outcome.WITHIN.rank

    @property
    def status(self) -> int:
        """Exit status: 0 for agreement, 1 for a difference, 2 if there was no comparison.

        Examples
        --------
        >>> [outcome.status for outcome in Outcome]
        [0, 0, 1, 1, 1, 1, 2]
        """
        return 2 if self is Outcome.UNREADABLE else int(not self.agrees)


def worst(outcomes: Iterable[Outcome]) -> Outcome:
    """The worst of some outcomes, ``IDENTICAL`` if there are none.

    Examples
    --------
    >>> str(worst([Outcome.WITHIN, Outcome.MISSING, Outcome.DRIFTED]))
    'missing'
    """
    return max(outcomes, key=lambda outcome: outcome.rank, default=Outcome.IDENTICAL)


@dataclass(frozen=True)
class Row:
    """A place where a file was compared: a line of a text, an entry of a variable, or the pixels.

    Parameters
    ----------
    name : str
        A line's number, or a variable's name.
    outcome : Outcome
    record, new : str, optional
        The content on both sides; None where a side has none.
    share : float
        Drift over its budget; 0 for a text.
    at : str
        Coordinates of an entry of a variable.
    note : str
    """

    name: str
    outcome: Outcome
    record: str | None = None
    new: str | None = None
    share: float = 0.0
    at: str = ""
    note: str = ""


@dataclass(frozen=True)
class Whole:
    """A file of rows, an artifact of files, or a folder of artifacts.

    Parameters
    ----------
    name : str
        For a file its path relative to either folder.
    parts : sequence
        The parts compared, worst first except for files. A file has none if its bytes are
        identical.
    pictures : tuple
        For a PNG file the bytes of the record and the new ones.
    """

    name: str
    parts: tuple[Any, ...] = ()
    pictures: tuple[bytes | None, bytes | None] = (None, None)

    @property
    def outcome(self) -> Outcome:
        """The worst outcome of the parts."""
        return worst(part.outcome for part in self.parts)

    @property
    def share(self) -> float:
        """The largest share of a budget among the parts."""
        return max((part.share for part in self.parts), default=0.0)

    @property
    def moved(self) -> list[Any]:
        """The parts that are not identical, worst first."""
        found = [part for part in self.parts if part.outcome is not Outcome.IDENTICAL]
        return sorted(found, key=lambda part: (-part.outcome.rank, -part.share))
