'''Claims and explanations as small functions of the datasets.

A claim is a function whose docstring says what the paper claims, in our words, and which
returns what decides it::

    @claim("Abstract and Introduction")
    def contact_shortens(data):
        """the contact gets shorter as its stiffness increases

        Condition: the contact duration falls from every contact of Fig. 13 to the next
        """
        return below(data["fig13"].contact_duration.diff("frequency_ratio"), 0)

Its id is the function's name, unless another is given. Where a claim can be read in
several ways, the function returns what decides each reading, by the reading's name.
'''

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np

from bouncing_ball.claims.parameters import NotAsked, PaperData
from bouncing_ball.claims.verdict import Finding, Verdict, against_print, at_most
from bouncing_ball.errors import ModelError

Data = Mapping[str, Any]
# Why claims are not reproduced: a text, its docstring, and checks that must hold for it.
Explanation = Callable[[Data], Mapping[str, Finding]]


def _answer(name: str, decide: Callable[[Data], Any], data: Data) -> Any:
    """What a function finds in the datasets; what it misses there is an error in one line."""
    try:
        return decide(data)
    except (ModelError, KeyError, AttributeError) as error:
        raise ModelError(f"{name!r}: {' '.join(str(error).split())}") from error


def paragraphs(function: Callable[..., Any]) -> dict[str, Any]:
    """A docstring: its statement, and its further paragraphs by their first word."""
    first, *others = inspect.getdoc(function).split("\n\n")  # type: ignore[union-attr]
    parts = (" ".join(other.split()).partition(": ") for other in others)
    return {"statement": " ".join(first.split()), **{key.lower(): text for key, _, text in parts}}


def name_of(function: Callable[..., Any]) -> str:
    """What a claim or an explanation is called, by default.

    Examples
    --------
    >>> name_of(name_of)
    'name of'
    """
    return function.__name__.replace("_", " ")


def checked(explanation: Explanation, data: Data) -> tuple[bool, str]:
    """Whether all checks hold, and each with its number, or why they were not made."""
    try:
        found = _answer(name_of(explanation), explanation, PaperData(data))
    except NotAsked as reason:
        return False, str(reason)
    said = (f"{name}: {one} (required {one.required})" for name, one in found.items())
    return all(one.verdict is Verdict.REPRODUCED for one in found.values()), "; ".join(said)


@dataclass(frozen=True)
class Claim:
    """A claim of the paper, and what decides it.

    Parameters
    ----------
    id, kind, item, statement : str
        Name; what it is counted as, ``number``, ``statement`` or ``restored formula``, the
        signs of which had to be restored, so that the check shows that this form is right,
        not that the paper printed it; its place in the paper; what it says, in our words.
    decide : callable
        A :class:`~bouncing_ball.claims.verdict.Finding` from the datasets, or a
        mapping of them by reading; numbers, where something is ``printed``.
    printed : str
        The number as printed, with its digits; empty if there is none.
    condition, remark : str
        The decidable condition into which a statement is turned; how it was read.
    explanation : callable, optional
        Why it is not reproduced: conditions from the datasets, by what is checked.
    restates : Claim, optional
        The claim that it says again; the tally counts it apart.
    """

    id: str
    kind: str
    item: str
    statement: str
    decide: Callable[[Data], Any]
    printed: str = ""
    condition: str = ""
    remark: str = ""
    explanation: Explanation | None = None
    restates: "Claim | None" = None

    def verdict(self, data: PaperData) -> tuple[Finding, str]:
        """The finding, and why there is none.

        Raises
        ------
        ModelError
            If a dataset, or what is needed of it, is missing.
        """
        try:
            found = _answer(self.id, self.decide, data)
        except NotAsked as reason:
            return Finding(np.nan, Verdict.NOT_ASKED, self.printed), str(reason)
        if self.printed:
            found = against_print(found, self.printed)
        readings = {"": found} if isinstance(found, Finding) else found
        first, *others = readings.values()
        if all(other.verdict is first.verdict for other in others):
            return first, ""
        words = "; ".join(f"{name}: {one.verdict} ({one})" for name, one in readings.items())
        return Finding(np.nan, Verdict.UNDECIDABLE), f"depends on the reading: {words}"


def claim(item: str, id: str = "", **given: Any) -> Callable[[Callable[[Data], Any]], Claim]:
    """Makes a claim of a function, from its docstring; its id is the function's name by default.

    With a number as ``printed``, its digits as a text, the function returns the computed one.
    """
    kind = "number" if "printed" in given else "statement"

    def made(function: Callable[[Data], Any]) -> Claim:
        named = id or name_of(function)
        return Claim(named, kind, item, decide=function, **paragraphs(function), **given)

    return made


def formula(name: str, item: str, text: str, row: str = "", **given: Any) -> Claim:
    """A printed formula, decided by a row of the dataset ``formulas``; by its item if not given."""

    def decide(data: Data) -> Finding:
        return of_formula(data, row or item)

    return Claim(name, "restored formula", item, text, decide, **given)


def of_formula(data: Data, row: str) -> Finding:
    """That a formula disagrees with its second computation by no more than rounding."""
    one = data["formulas"].sel(formula=row)
    return at_most(one.disagreement, one.budget)


def defined_in(module: ModuleType) -> Iterator[Claim]:
    """The claims of a module in their order; lists of them are opened."""
    for value in vars(module).values():
        for one in value if isinstance(value, list) else [value]:
            if isinstance(one, Claim):
                yield one
