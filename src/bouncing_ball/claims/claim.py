'''Claims and explanations as small functions of the datasets.

A claim is a function whose docstring says what the paper claims, in our words, and which
returns the finding that decides it::

    @claim("Abstract and Introduction")
    def contact_shortens(data):
        """the contact gets shorter as its stiffness increases

        Condition: the contact duration falls from every contact of Fig. 13 to the next
        """
        return below(data["fig13"].contact_duration.diff("frequency_ratio"), 0)

Its id is the function's name, unless another is given. Where a claim can be read in
several ways, the function returns a finding for each reading, by the reading's name. If it is
clear which of them the paper means, that one comes first, and the claim is ``meant``.
'''

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from types import ModuleType
from typing import Any

import numpy as np

from bouncing_ball.claims.parameters import NotAsked, PaperData
from bouncing_ball.claims.verdict import Finding, Verdict, against_print, at_most
from bouncing_ball.datasets.files import rows_beside
from bouncing_ball.errors import ModelError

Data = Mapping[str, Any]
# An explanation of claims that are not reproduced: its docstring is the text, and it returns
# checks that must hold for it.
Explanation = Callable[[Data], Mapping[str, Finding]]


def _answer(name: str, decide: Callable[[Data], Any], data: Data) -> Any:
    """The result of a function of the datasets; data that it misses are an error of one line."""
    try:
        return decide(data)
    except (ModelError, KeyError, AttributeError) as error:
        raise ModelError(f"{name!r}: {' '.join(str(error).split())}") from error


def paragraphs(function: Callable[..., Any]) -> dict[str, Any]:
    '''The first paragraph of a docstring as ``statement``, and the others by their first word.

    Examples
    --------
    >>> def stiff(data):
    ...     """the contact is stiff
    ...
    ...     Condition: ϖ is above 100
    ...     """
    >>> paragraphs(stiff)
    {'statement': 'the contact is stiff', 'condition': 'ϖ is above 100'}
    '''
    first, *others = inspect.getdoc(function).split("\n\n")  # type: ignore[union-attr]
    parts = (" ".join(other.split()).partition(": ") for other in others)
    return {"statement": " ".join(first.split()), **{key.lower(): text for key, _, text in parts}}


def name_of(function: Callable[..., Any]) -> str:
    """The name of a claim or an explanation, by default that of its function.

    Examples
    --------
    >>> name_of(name_of)
    'name of'
    """
    return function.__name__.replace("_", " ")


def checked(explanation: Explanation, data: Data) -> tuple[bool, str]:
    """Whether all checks of an explanation hold, and a text of them or why they were not made.

    Raises
    ------
    ModelError
        If a dataset, or a variable of it, is missing.
    """
    try:
        found = _answer(name_of(explanation), explanation, PaperData(data))
    except NotAsked as reason:
        return False, str(reason)
    said = (f"{name}: {one} (required {one.required})" for name, one in found.items())
    return all(one.verdict is Verdict.REPRODUCED for one in found.values()), "; ".join(said)


@dataclass(frozen=True)
class Claim:
    """A claim of the paper, and the function that decides it.

    Parameters
    ----------
    id : str
        Its name.
    kind : str
        The group in which it is counted: ``number``, ``statement`` or ``restored formula``. The
        signs of a restored formula are illegible in the text at hand, so that the check shows that
        this form is right, and not that the paper printed it.
    item, statement : str
        Its place in the paper, and what the paper says there, in our words.
    decide : callable
        A :class:`~bouncing_ball.claims.verdict.Finding` from the datasets, or a
        mapping of findings by reading; numbers, if one is ``printed``.
    printed : str
        The number as printed, with its digits; empty if there is none.
    condition, remark : str
        The decidable condition into which a statement is turned; how it was read.
    answer : str
        What its author might answer to a verdict other than reproduced.
    meant : bool
        Whether the first reading is the one that the paper means.
    explanation : callable, optional
        Why it is not reproduced: conditions on the datasets, by what is checked.
    restates : Claim, optional
        The claim that it repeats; the tally counts repetitions apart.
    """

    id: str
    kind: str
    item: str
    statement: str
    decide: Callable[[Data], Any]
    printed: str = ""
    condition: str = ""
    remark: str = ""
    answer: str = ""
    meant: bool = False
    explanation: Explanation | None = None
    restates: "Claim | None" = None

    def verdict(self, data: PaperData) -> tuple[Finding, str]:
        """The finding, and a text that gives the reason if there is none.

        Raises
        ------
        ModelError
            If a dataset, or a variable of it, is missing.
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
        if self.meant and first.verdict is Verdict.REPRODUCED:
            return replace(first, verdict=Verdict.QUALIFIED), words
        return Finding(np.nan, Verdict.UNDECIDABLE), words


def claim(item: str, id: str = "", **given: Any) -> Callable[[Callable[[Data], Any]], Claim]:
    """Decorator that makes a claim of a function and its docstring.

    Parameters
    ----------
    item : str
        Its place in the paper.
    id : str
        Its name, by default the function's.
    **given
        Further fields of :class:`Claim`. With a number as ``printed``, its digits as a text, the
        function returns the computed number.
    """
    kind = "number" if "printed" in given else "statement"

    def made(function: Callable[[Data], Any]) -> Claim:
        named = id or name_of(function)
        return Claim(named, kind, item, decide=function, **paragraphs(function), **given)

    return made


def formula(name: str, item: str, text: str, row: str = "", **given: Any) -> Claim:
    """A printed formula, decided by the row of its name in the dataset ``formulas``.

    The row is ``item`` unless ``row`` is given.
    """

    def decide(data: Data) -> Finding:
        return of_formula(data, row or item)

    return Claim(name, "restored formula", item, text, decide, **given)


def formulas(where: str) -> list[Claim]:
    """The printed formulas of a part of the paper, from the table ``claim.csv``."""
    rows = [row for row in rows_beside(__file__) if row.pop("where") == where]
    return [formula(**row) for row in rows]


def of_formula(data: Data, row: str) -> Finding:
    """The finding that a formula disagrees with its second computation by no more than rounding.

    ``row`` is its place along ``formula`` in the dataset ``formulas``.
    """
    one = data["formulas"].sel(formula=row)
    return at_most(one.disagreement, one.budget)


def defined_in(module: ModuleType) -> Iterator[Claim]:
    """The claims of a module in their order, those in lists included."""
    for value in vars(module).values():
        for one in value if isinstance(value, list) else [value]:
            if isinstance(one, Claim):
                yield one
