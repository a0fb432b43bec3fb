'''Claims and explanations as small functions of the datasets.

A claim is a function whose docstring says what the paper claims, in our words, and which
returns what decides it::

    @statement("Abstract and Introduction", "text")
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


def _answer(name: str, decide: Callable[[Data], Any], data: Data) -> Any:
    """What a function finds in the datasets; what it misses there is an error in one line."""
    try:
        return decide(data)
    except (ModelError, KeyError, AttributeError) as error:
        raise ModelError(f"{name!r}: {' '.join(str(error).split())}") from error


def _paragraphs(function: Callable[..., Any]) -> dict[str, str]:
    """The docstring of a claim: its statement, and its paragraphs by their first word."""
    first, *others = inspect.getdoc(function).split("\n\n")  # type: ignore[union-attr]
    parts = (" ".join(other.split()).partition(": ") for other in others)
    return {"statement": " ".join(first.split()), **{key: text for key, _, text in parts}}


@dataclass(frozen=True)
class Explanation:
    """Why claims are not reproduced, and the checks that must hold for it.

    ``checks`` takes the datasets and returns conditions by what is checked.
    """

    id: str
    text: str
    checks: Callable[[Data], Mapping[str, Finding]]

    def check(self, data: Data) -> tuple[bool, Mapping[str, Finding] | str]:
        """Whether all checks hold, and what they found, or why they were not made."""
        try:
            found = _answer(self.id, self.checks, PaperData(data))
        except NotAsked as reason:
            return False, str(reason)
        return all(one.verdict is Verdict.REPRODUCED for one in found.values()), found


@dataclass(frozen=True)
class Claim:
    """A claim of the paper, and what decides it.

    Parameters
    ----------
    id, kind, section, item, statement : str
        Name; ``number``, ``formula`` or ``statement``; its place in the paper;
        what it says, in our words.
    decide : callable
        A :class:`~bouncing_ball.claims.verdict.Finding` from the datasets, or a
        mapping of them by reading; numbers, where something is ``printed``.
    printed : str
        The number as printed, with its digits; empty if there is none.
    unit : float, optional
        Unit of its last significant digit, where the digits do not show it.
    clear : bool
        Legible as printed; else signs or letters had to be restored.
    condition, remark : str
        The decidable condition into which a statement is turned; how it was read.
    explanation : Explanation, optional
        Why it is not reproduced.
    restates : Claim, optional
        The claim that it says again; the tally counts it apart.
    table : str
        The printed table whose entry it is; empty if none.
    """

    id: str
    kind: str
    section: str
    item: str
    statement: str
    decide: Callable[[Data], Any]
    printed: str = ""
    unit: float | None = None
    clear: bool = True
    condition: str = ""
    remark: str = ""
    explanation: Explanation | None = None
    restates: "Claim | None" = None
    table: str = ""

    @property
    def group(self) -> str:
        """What it is counted as.

        A restatement apart from what stands alone, and a formula whose signs had
        to be restored apart from a number: the check shows that the restored form
        is right, not that the paper printed it.
        """
        if self.restates:
            return "restatement"
        if self.kind == "formula":
            return "statement" if self.clear else "restored formula"
        return self.kind

    def verdict(self, data: Data) -> tuple[Finding, str, list[str]]:
        """The finding, or why there is none, and the datasets that were used.

        Raises
        ------
        ModelError
            If a dataset, or what is needed of it, is missing.
        """
        asked = PaperData(data)
        try:
            found = _answer(self.id, self.decide, asked)
        except NotAsked as reason:
            return Finding(np.nan, Verdict.NOT_ASKED, self.printed), str(reason), list(asked.used)
        readings = found if isinstance(found, Mapping) else {"": found}
        if self.printed:
            readings = {
                name: against_print(value, self.printed, self.unit)
                for name, value in readings.items()
            }
        first, *others = readings.values()
        if all(other.verdict is first.verdict for other in others):
            return first, "", list(asked.used)
        words = "; ".join(f"{name}: {one.verdict}{_shown(one)}" for name, one in readings.items())
        open_ = Finding(np.nan, Verdict.UNDECIDABLE, self.printed)
        return open_, f"depends on the reading: {words}", list(asked.used)


def _shown(finding: Finding) -> str:
    """The number found, but where only its being rounding says anything."""
    return "" if 0 < finding.limit <= 1e-8 else f" ({finding.found:.4g})"


def claim(
    kind: str, section: str, item: str, id: str = "", **given: Any
) -> Callable[[Callable], Claim]:
    """Makes a claim of a function, from its docstring; its id is the function's name by default."""

    def made(function: Callable[[Data], Any]) -> Claim:
        said = _paragraphs(function)
        return Claim(
            *(id or function.__name__.replace("_", " "), kind, section, item),
            *(said["statement"], function),
            condition=said.get("Condition", ""),
            remark=said.get("Remark", ""),
            **given,
        )

    return made


def statement(section: str, item: str = "text", **given: Any) -> Callable[[Callable], Claim]:
    """A claim in words: the function returns a condition."""
    return claim("statement", section, item, **given)


def number(section: str, item: str, printed: str, **given: Any) -> Callable[[Callable], Claim]:
    """A printed number, with its digits: the function returns the computed one."""
    return claim("number", section, item, printed=printed, **given)


def formula(
    name: str, section: str, item: str, text: str, row: str = "", *, clear: bool = False, **given
) -> Claim:
    """A printed formula, decided by a row of the dataset ``formulas``; by its item if not given."""

    def decide(data: Data) -> Finding:
        return of_formula(data, row or item)

    return Claim(name, "formula", section, item, text, decide, clear=clear, **given)


def of_formula(data: Data, row: str) -> Finding:
    """That a formula disagrees with its second computation by no more than rounding."""
    one = data["formulas"].sel(formula=row)
    return at_most(one.disagreement, one.budget)


def explanation(name: str) -> Callable[[Callable[[Data], Mapping[str, Finding]]], Explanation]:
    """Makes an explanation of a function that returns its checks; the docstring is its text."""

    def made(function: Callable[[Data], Mapping[str, Finding]]) -> Explanation:
        return Explanation(name, _paragraphs(function)["statement"], function)

    return made


def defined_in(module: ModuleType, kind: type) -> Iterator[Any]:
    """The claims or explanations of a module in their order; lists of them are opened."""
    for name, value in vars(module).items():
        for one in value if isinstance(value, list) else [value]:
            # What is imported from elsewhere is not defined here.
            if isinstance(one, kind) and not name.startswith("_"):
                yield one
