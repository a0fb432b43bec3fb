"""The ladder of outcomes, from the best to the worst, and a place with its outcome."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum


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
    where : str
        A line's number, or a variable's name.
    outcome : Outcome
    record, new : str, optional
        What stands there; None where a side has nothing.
    share : float, optional
        Drift over its budget.
    at : str
        Coordinates of an entry of a variable.
    note : str
    """

    where: str
    outcome: Outcome
    record: str | None = None
    new: str | None = None
    share: float | None = None
    at: str = ""
    note: str = ""
