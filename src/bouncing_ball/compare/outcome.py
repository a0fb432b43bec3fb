"""The ladder of outcomes, from the best to the worst."""

from collections.abc import Iterable
from enum import StrEnum


class Outcome(StrEnum):
    """What the comparison of one thing with its counterpart in the record says.

    In order: a whole is as good as its worst part.
    """

    IDENTICAL = "identical"
    WITHIN = "within budget"
    DRIFTED = "drifted"
    STRUCTURE = "changed structure"
    MISSING = "missing"
    EXTRA = "extra"
    UNREADABLE = "unreadable"

    @property
    def rank(self) -> int:
        """Place on the ladder, 0 for ``IDENTICAL``."""
        return list(Outcome).index(self)

    @property
    def agrees(self) -> bool:
        """Whether the new thing still says what the record says."""
        return self.rank <= Outcome.WITHIN.rank


def worst(outcomes: Iterable[Outcome]) -> Outcome:
    """The worst of some outcomes, ``IDENTICAL`` if there are none.

    Examples
    --------
    >>> str(worst([Outcome.WITHIN, Outcome.MISSING, Outcome.DRIFTED]))
    'missing'
    """
    return max(outcomes, key=lambda outcome: outcome.rank, default=Outcome.IDENTICAL)


def status(outcome: Outcome) -> int:
    """Exit status: 0 the same, 1 differs, 2 could not be compared.

    Examples
    --------
    >>> [status(outcome) for outcome in Outcome]
    [0, 0, 1, 1, 1, 1, 2]
    """
    if outcome is Outcome.UNREADABLE:
        return 2
    return 0 if outcome.agrees else 1
