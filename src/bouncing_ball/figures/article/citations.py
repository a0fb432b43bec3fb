"""Numbered citations, in the order in which they are first used."""

from collections.abc import Mapping
from typing import Any

from bouncing_ball.errors import ModelError

READ = {
    "abstract": "Read in part: an abstract or a passage.",
    "cited": "Not read: known from what others write of it.",
    "no": "Not read: cited from memory.",
}
"""How far a work could be read, in words, by the value of ``read`` in its entry."""


class Citations:
    """Numbers references as they are cited, then lists them.

    Parameters
    ----------
    references : mapping
        By key: ``text``, and ``doi`` where there is one with ``doi_checked``,
        whether another source was found that gives this DOI to this work, and
        ``read`` where it is known how far it was read, see :data:`READ`.

    Examples
    --------
    >>> cited = Citations({"a": {"text": "A, 1990."}, "b": {"text": "B, 2000."}})
    >>> cited.cite("b"), cited.cite("a"), cited.cite("b", "a")
    ('[1]', '[2]', '[1, 2]')
    >>> print(cited.listing())
    1. B, 2000. No DOI found.
    2. A, 1990. No DOI found.
    """

    def __init__(self, references: Mapping[str, Mapping[str, Any]]) -> None:
        self._references = references
        self._order: list[str] = []

    def cite(self, *keys: str) -> str:
        """The numbers of works in square brackets.

        Raises
        ------
        ModelError
            If a work is not among the references.
        """
        for key in keys:
            if key not in self._references:
                raise ModelError(f"no reference {key!r}; there are {', '.join(self._references)}")
            if key not in self._order:
                self._order.append(key)
        return f"[{', '.join(str(self._order.index(key) + 1) for key in keys)}]"

    def listing(self) -> str:
        """The works cited, as a numbered list; a DOI that was not found elsewhere says so."""
        lines = []
        for number, key in enumerate(self._order, 1):
            entry = self._references[key]
            doi = entry.get("doi")
            tail = "No DOI found." if doi is None else f"doi:{doi}"
            if doi is not None:
                tail += "." if entry["doi_checked"] else " (DOI not checked)."
            if "read" in entry:
                tail += f" {READ[entry['read']]}"
            lines.append(f"{number}. {entry['text']} {tail}")
        return "\n".join(lines)

    def uncited(self) -> list[str]:
        """Works that were never cited."""
        return [key for key in self._references if key not in self._order]
