"""The outcomes of a comparison from the best to the worst, and the parts of a comparison."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any


class Outcome(StrEnum):
    """The result of comparing an artifact, a file or a part of a file with the record.

    The outcomes are in order from the best to the worst; a whole has the outcome of its worst part.
    """

    IDENTICAL = "identical"
    WITHIN = "within budget"
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
        return self.rank <= Outcome.WITHIN.rank

    @property
    def status(self) -> int:
        """Exit status: 0 for agreement, 1 for a difference, 2 if there was no comparison.

        Examples
        --------
        >>> [outcome.status for outcome in (Outcome.WITHIN, Outcome.DRIFTED, Outcome.UNREADABLE)]
        [0, 1, 2]
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
class ComparedItem:
    """One item of the comparison of a file: a line of a text, a variable, an attribute, or pixels.

    Parameters
    ----------
    name : str
        The number of a line, or the name of a variable.
    outcome : Outcome
    record, new : str, optional
        The content in the record and in the new file, of a variable the entry that has moved most;
        None if there is none.
    share : float
        Drift over the budget; 0 for a text.
    at : str
        Coordinates of the entry of a variable.
    note : str
    moved, beyond, entries : int
        For a variable, the number of its entries that moved, of those beyond the budget, and of
        all entries.
    title : str
        The description of a variable.
    change : float
        Relative change of the entry of a variable that moved most, with its sign.
    changes : tuple of str
        For a variable of words, each entry that changed with both contents.
    """

    name: str
    outcome: Outcome
    record: str | None = None
    new: str | None = None
    share: float = 0.0
    at: str = ""
    note: str = ""
    moved: int = 0
    beyond: int = 0
    entries: int = 0
    title: str = ""
    change: float = 0.0
    changes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Whole:
    """A file of rows, an artifact of files, or a folder of artifacts.

    Parameters
    ----------
    name : str
        For a file its path relative to either folder.
    parts : sequence
        The parts compared, worst first; those of a file are in their order. A file has none if its
        bytes are identical.
    pictures : tuple
        For a PNG file the bytes in the record and the new bytes.
    cause : str
        For an artifact that is not identical, why it differs.
    code : tuple of str
        For an artifact, the files of code that made it and that have changed since the record.
    """

    name: str
    parts: tuple[Any, ...] = ()
    pictures: tuple[bytes | None, bytes | None] = (None, None)
    cause: str = ""
    code: tuple[str, ...] = ()

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
