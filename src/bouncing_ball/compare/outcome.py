"""The ladder of outcomes, from the best to the worst."""

from collections.abc import Iterable
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
