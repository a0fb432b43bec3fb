'''Claims and explanations as small functions of the datasets.

A claim is a function whose docstring states the claim of the paper in our words, and which
returns the finding that decides the claim::

    @claim("Abstract and Introduction")
    def contact_shortens(data):
        """the contact gets shorter as its stiffness increases

        Compared: the largest change of the contact duration

        Condition: the contact duration falls from every contact of Fig. 13 to the next
        """
        return below(data["fig13"].contact_duration.diff("frequency_ratio"), 0)

The id of a claim is the name of the function, unless another id is given. If a claim can be read in
several ways, the function returns a mapping from the name of each reading to its finding. The claim
is reproduced *in one reading* if it holds in at least one of them and not in another. If the claim
depends on something that the text at hand does not have, such as the difference that counts as
visible, this is named as ``missing``, the readings are values tried for it, and the claim is
*undecidable* if their verdicts differ. A statement that cannot fail, whatever the equations are, is
a ``definition``.
'''

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from types import ModuleType
from typing import Any

import numpy as np

from bouncing_ball.errors import ModelError
from bouncing_ball.paper.claims.paper_parameters import Data, NotAsked, PaperData
from bouncing_ball.paper.claims.verdict import Finding, Verdict, against_print, at_most

# An explanation of claims that are not reproduced is a function whose docstring is the text, and
# which returns checks, all of which must hold.
Explanation = Callable[[Data], Mapping[str, Finding]]


def _answer(name: str, decide: Callable[[Data], Any], data: Data) -> Any:
    """The result of a function of the datasets; missing data are an error with one line."""
    try:
        return decide(data)
    except (ValueError, KeyError, AttributeError) as error:
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
    first, *others = (inspect.getdoc(function) or "").split("\n\n")
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


def checks_hold(explanation: Explanation, data: PaperData) -> tuple[bool, str]:
    """Whether all checks of an explanation hold, and a text: the checks, or why none were made.

    Raises
    ------
    ModelError
        If a dataset, or a variable of it, is missing.
    """
    try:
        found = _answer(name_of(explanation), explanation, data)
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
        The name of the claim.
    kind : str
        The group in which the claim is counted: ``number``, ``statement`` or ``restored formula``.
        The signs of a restored formula are illegible in the text at hand, so that the check shows
        that this form is right, and not that the paper printed it.
    item, statement : str
        The place in the paper, and the statement there in our words.
    decide : callable
        A function of the datasets that returns a
        :class:`~bouncing_ball.paper.claims.verdict.Finding`, or a mapping of findings by reading;
        with ``printed``, it may return the number instead.
    printed : str
        The number with the digits that the paper prints; empty if the claim is not a number.
    compared : str
        What the number found is, which is compared with the printed number or with a bound.
    at : mapping of str to float or str
        The parameters at which the number is found, by their names in the datasets, where these
        have more: of one entry of a table, for example, or a text such as ``random numbers``.
    condition, remark : str
        The decidable condition that stands for the statement, and a remark on its reading.
    answer : str
        A possible answer of the authors to a verdict other than reproduced.
    missing : str
        What the verdict depends on and the text at hand does not have; empty if it has everything.
    definition : bool
        Whether the statement follows from the meaning of its words. It is checked as all others,
        but its verdict is no evidence and is not counted as reproduced.
    explanation : callable, optional
        The reason why the claim is not reproduced: named conditions on the datasets.
    restates : Claim, optional
        The claim that this claim repeats, with other digits or in words.
    """

    id: str
    kind: str
    item: str
    statement: str
    decide: Callable[[Data], Any]
    printed: str = ""
    compared: str = ""
    at: Mapping[str, float | str] = field(default_factory=dict)
    condition: str = ""
    remark: str = ""
    answer: str = ""
    missing: str = ""
    definition: bool = False
    explanation: Explanation | None = None
    restates: "Claim | None" = None

    def verdict(self, data: PaperData) -> tuple[Finding, str]:
        """The finding, and a text that gives the reason if the claim has no verdict.

        Raises
        ------
        ModelError
            If a dataset, or a variable of it, is missing.
        """
        try:
            found = _answer(self.id, self.decide, data)
        except NotAsked as reason:
            return Finding(np.nan, Verdict.NOT_ASKED, self.printed), str(reason)
        if isinstance(found, Finding):
            readings = {"": found}
        elif self.printed:
            readings = {"": against_print(found, self.printed)}
        else:
            readings = found
        best = min(readings.values(), key=lambda one: list(Verdict).index(one.verdict))
        holds = best.verdict is Verdict.REPRODUCED
        if all(one.verdict is best.verdict for one in readings.values()):
            if self.definition and holds:
                return replace(best, verdict=Verdict.DEFINITION), ""
            return best, ""
        words = "; ".join(f"{name}: {one.verdict} ({one})" for name, one in readings.items())
        if self.missing:
            return Finding(np.nan, Verdict.UNDECIDABLE), words
        return (replace(best, verdict=Verdict.IN_ONE_READING) if holds else best), words


DISAGREEMENT = "the largest disagreement with a second computation"
"""What is compared with a bound where a formula is decided."""


def claim(item: str, id: str = "", **given: Any) -> Callable[[Callable[[Data], Any]], Claim]:
    """Decorator that makes a claim of a function and its docstring.

    Parameters
    ----------
    item : str
        The place of the claim in the paper.
    id : str
        The name of the claim, by default the name of the function.
    **given
        Further fields of :class:`Claim`. With the digits of a number as ``printed``, the function
        returns the computed number.
    """
    kind = "number" if "printed" in given else "statement"

    def made(function: Callable[[Data], Any]) -> Claim:
        named = id or name_of(function)
        return Claim(named, kind, item, decide=function, **paragraphs(function), **given)

    return made


def formula(name: str, item: str, text: str, *rows: str, **given: Any) -> Claim:
    """The claim that a printed formula is right, decided by rows of the dataset ``formulas``.

    The name of the row is ``item`` unless ``rows`` are given.
    """
    rows = rows or (item,)
    given = {"compared": DISAGREEMENT, **given}
    kind = "restored formula"
    return Claim(name, kind, item, text, lambda data: of_formula(data, *rows), **given)


def of_formula(data: Data, *rows: str) -> Finding:
    """The finding that formulas agree with their second computations up to rounding, and that the
    package computes with the same formulas.

    ``rows`` are labels along ``formula`` in the dataset ``formulas``. The finding is that of the
    first comparison that fails, or of the first one if none does.
    """
    found = []
    for row in rows:
        one = data["formulas"].sel(formula=row)
        for each in (one.disagreement, one.disagreement_in_use):
            # A comparison that finds no value is no agreement.
            found.append(at_most(each.fillna(np.inf), one.budget))
    failed = [one for one in found if one.verdict is not Verdict.REPRODUCED]
    return [*failed, *found][0]


def defined_in(module: ModuleType) -> Iterator[Claim]:
    """The claims of a module in their order, including claims in lists."""
    for value in vars(module).values():
        for one in value if isinstance(value, list) else [value]:
            if isinstance(one, Claim):
                yield one
