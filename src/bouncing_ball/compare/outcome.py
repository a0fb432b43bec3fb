"""The ladder of outcomes, from the best to the worst, and what has one: a place, and a whole."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any


class Outcome(StrEnum):
    """The result for one thing and its counterpart in the record.

    In order: a whole is as good as its worst part.
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
        """Place on the ladder, 0 for ``IDENTICAL``."""
        return list(Outcome).index(self)

    @property
    def agrees(self) -> bool:
        """Whether the new thing still says what the record says."""
        return self.rank <= Outcome.WITHIN.rank

    @property
    def status(self) -> int:
        """Exit status: 0 the same, 1 differs, 2 could not be compared.

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
    """A place where a file was compared: a line of a text, an entry of a variable, its pixels.

    Parameters
    ----------
    name : str
        A line's number, or a variable's name.
    outcome : Outcome
    record, new : str, optional
        What stands there; None where a side has nothing.
    share : float
        Drift over its budget; 0 where that is no number.
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
        Of a file its path relative to either folder.
    parts : sequence
        What was compared, worst first but for the files; of a file none where the bytes are
        the same.
    pictures : tuple
        Of a PNG file the record's and the new bytes.
    """

    name: str
    parts: tuple[Any, ...] = ()
    pictures: tuple[bytes | None, bytes | None] = (None, None)

    @property
    def outcome(self) -> Outcome:
        """The worst outcome of its parts."""
        return worst(part.outcome for part in self.parts)

    @property
    def share(self) -> float:
        """The largest share of a budget."""
        return max((part.share for part in self.parts), default=0.0)

    @property
    def moved(self) -> list[Any]:
        """The parts that are not identical, worst first."""
        found = [part for part in self.parts if part.outcome is not Outcome.IDENTICAL]
        return sorted(found, key=lambda part: (-part.outcome.rank, -part.share))
