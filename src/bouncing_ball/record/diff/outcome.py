"""The ladder of verdicts, from the best to the worst."""

from collections.abc import Iterable
from enum import StrEnum


class Verdict(StrEnum):
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
        return list(Verdict).index(self)

    @property
    def agrees(self) -> bool:
        """Whether the new thing still says what the record says."""
        return self.rank <= Verdict.WITHIN.rank


def worst(verdicts: Iterable[Verdict]) -> Verdict:
    """The worst of some verdicts, ``IDENTICAL`` if there are none.

    Examples
    --------
    >>> str(worst([Verdict.WITHIN, Verdict.MISSING, Verdict.DRIFTED]))
    'missing'
    """
    return max(verdicts, key=lambda verdict: verdict.rank, default=Verdict.IDENTICAL)


def status(verdict: Verdict) -> int:
    """Exit status: 0 the same, 1 differs, 2 could not be compared.

    Examples
    --------
    >>> [status(verdict) for verdict in Verdict]
    [0, 0, 1, 1, 1, 1, 2]
    """
    if verdict is Verdict.UNREADABLE:
        return 2
    return 0 if verdict.agrees else 1
