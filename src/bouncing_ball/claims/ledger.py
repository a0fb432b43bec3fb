"""The ledger: what the paper claims, and what decides each claim."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from bouncing_ball.errors import ModelError


class Relation(StrEnum):
    """How a number compares with the bound of a condition."""

    AT_MOST = "at_most"
    AT_LEAST = "at_least"
    BELOW = "below"
    ABOVE = "above"

    @property
    def sign(self) -> str:
        """The sign between two numbers."""
        return {"at_most": "≤", "at_least": "≥", "below": "<", "above": ">"}[self]


@dataclass(frozen=True)
class Measure:
    """One number of a dataset: its place, and how several become one.

    Parameters
    ----------
    dataset, variable : str
    at : tuple of (coordinate, value)
        Labels to select; numbers are matched to rounding.
    reduce : str
        ``max``, ``min`` or ``sum`` over what is left, or ``value``: one number
        must be left.
    """

    dataset: str
    variable: str
    at: tuple[tuple[str, Any], ...] = ()
    reduce: str = "value"

    def __str__(self) -> str:
        place = ", ".join(f"{key} = {value}" for key, value in self.at)
        text = f"{self.dataset}: {self.variable}" + (f" at {place}" if place else "")
        return text if self.reduce == "value" else f"{self.reduce} of {text}"


@dataclass(frozen=True)
class Condition:
    """``relation`` to a bound, which is a printed number or a variable beside the
    measured one."""

    relation: Relation
    bound: str
    bound_is_variable: bool = False


@dataclass(frozen=True)
class Criterion:
    """A measure with the condition it must meet; none for a printed number.

    ``reading`` names it where a claim can be read in several ways.
    """

    measure: Measure
    condition: Condition | None = None
    reading: str = ""


@dataclass(frozen=True)
class Claim:
    """A claim of the paper, and what decides it.

    Parameters
    ----------
    id, kind, section, item, statement : str
        Name; ``number``, ``formula`` or ``statement``; its place in the paper;
        what it says, in our words.
    printed : str
        The number as printed, with its digits; empty if there is none.
    unit : float or None
        Unit of the last significant digit, where the digits do not show it.
    legibility, remark : str
        How legible it is in the text at hand; how it was read.
    condition_text : str
        The decidable condition into which a statement in words is turned.
    criteria : tuple of Criterion
        One, or one for each reading.
    uses : tuple of str
        Datasets that must have been computed with the paper's parameters.
    explanation : str
        Name of the explanation if it is not reproduced; empty if none.
    table : str
        The printed table whose entry it is; empty if none.
    restates : str
        Id of the claim that it says again; empty if it stands alone.
    """

    id: str
    kind: str
    section: str
    item: str
    statement: str
    printed: str
    unit: float | None
    legibility: str
    remark: str
    condition_text: str
    criteria: tuple[Criterion, ...]
    uses: tuple[str, ...]
    explanation: str
    table: str = ""
    restates: str = ""

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
            return "statement" if self.legibility == "clear" else "restored formula"
        return self.kind


@dataclass(frozen=True)
class Explanation:
    """Why claims are not reproduced, and the conditions that must hold for it."""

    id: str
    text: str
    criteria: tuple[Criterion, ...]
    uses: tuple[str, ...]


@dataclass(frozen=True)
class Ledger:
    """All claims and explanations, and the paper's parameters by dataset.

    ``tables`` are the printed tables by name, each with its axes, its
    ``values`` as numbers, and the paper's other parameters of the dataset that
    decides it. ``source`` is the mapping that all this was read from.
    """

    close_units: float
    parameters: Mapping[str, Mapping[str, Any]]
    claims: tuple[Claim, ...]
    explanations: tuple[Explanation, ...]
    tables: Mapping[str, Mapping[str, Any]]
    source: Mapping[str, Any]

    @property
    def datasets(self) -> list[str]:
        """Names of the datasets that decide something, sorted."""
        used = [part.uses for part in self.claims] + [part.uses for part in self.explanations]
        return sorted({name for names in used for name in names})

    def table(self, name: str) -> Mapping[str, Any]:
        """A printed table, as a stage takes it.

        Raises
        ------
        ModelError
            If the ledger has no such table.
        """
        if name not in self.tables:
            raise ModelError(f"unknown table {name!r}; known: {', '.join(self.tables) or 'none'}")
        return self.tables[name]
