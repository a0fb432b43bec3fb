"""The claims as objects, from the mapping that ``config/claims.yaml`` holds.

The mapping is taken to satisfy ``config/claims.schema.yaml``; the pipeline
checks that before.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import product
from typing import Any

from bouncing_ball.audit.claims.digits import is_number_text
from bouncing_ball.errors import ModelError


class Relation(StrEnum):
    """How a number must stand to the bound of a condition."""

    AT_MOST = "at_most"
    AT_LEAST = "at_least"
    BELOW = "below"
    ABOVE = "above"

    @property
    def sign(self) -> str:
        """As it stands between two numbers."""
        return {"at_most": "≤", "at_least": "≥", "below": "<", "above": ">"}[self]


@dataclass(frozen=True)
class Measure:
    """One number of a dataset: where it stands and how it is made one.

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
        Name; ``number``, ``formula`` or ``statement``; where it stands; what it
        says, in our words.
    printed : str
        The number as printed, with its digits; empty if there is none.
    unit : float or None
        Unit of the last significant digit, where the digits do not tell.
    legibility, remark : str
        How legible it is in the text at hand; how it was read.
    condition_text : str
        The decidable condition that stands for a statement in words.
    criteria : tuple of Criterion
        One, or one for each reading.
    uses : tuple of str
        Datasets that must have been computed with the paper's parameters.
    explanation : str
        Name of the explanation if it is not reproduced; empty if none.
    table : str
        The printed table whose entry it is; empty if none.
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


@dataclass(frozen=True)
class Explanation:
    """Why claims are not reproduced, and the conditions that must hold for it."""

    id: str
    text: str
    criteria: tuple[Criterion, ...]
    uses: tuple[str, ...]


@dataclass(frozen=True)
class Ledger:
    """All claims and explanations, and the paper's parameters by dataset."""

    close_units: float
    parameters: Mapping[str, Mapping[str, Any]]
    claims: tuple[Claim, ...]
    explanations: tuple[Explanation, ...]


def _criterion(entry: Mapping[str, Any]) -> Criterion:
    source = entry["decided_by"]
    measure = Measure(
        source["dataset"],
        source["variable"],
        tuple(source.get("at", {}).items()),
        source.get("reduce", "value"),
    )
    condition = None
    if "condition" in entry:
        given = entry["condition"]
        relation = next(relation for relation in Relation if relation in given)
        bound = given[relation]
        if isinstance(bound, Mapping):
            condition = Condition(relation, bound["variable"], bound_is_variable=True)
        else:
            condition = Condition(relation, bound)
    return Criterion(measure, condition, entry.get("reading", ""))


def _criteria(entry: Mapping[str, Any]) -> tuple[Criterion, ...]:
    return tuple(_criterion(part) for part in entry.get("readings", [entry]))


def _uses(entry: Mapping[str, Any], criteria: tuple[Criterion, ...]) -> tuple[str, ...]:
    return tuple(dict.fromkeys([*(c.measure.dataset for c in criteria), *entry.get("uses", [])]))


def _claim(entry: Mapping[str, Any]) -> Claim:
    criteria = _criteria(entry)
    return Claim(
        id=entry["id"],
        kind=entry["kind"],
        section=entry["section"],
        item=entry["item"],
        statement=entry["statement"],
        printed=entry.get("printed", ""),
        unit=entry.get("unit"),
        legibility=entry["legibility"],
        remark=entry.get("remark", ""),
        condition_text=entry.get("condition", {}).get("text", ""),
        criteria=criteria,
        uses=_uses(entry, criteria),
        explanation=entry.get("explanation", ""),
        table=entry.get("table", ""),
    )


def _entry(entry: Mapping[str, Any], place) -> str:
    """The printed number at a place, ((axis, index, value), ...) from the outermost axis."""
    printed: Any = entry["printed"]
    passed: list[str] = []
    for axis, index, value in place:
        expected = len(entry["over"][axis])
        if not isinstance(printed, list) or len(printed) != expected:
            at = f" at {', '.join(passed)}" if passed else ""
            raise ModelError(
                f"table {entry['id']!r}: printed{at} is not a list of {expected}, one for each "
                f"{axis}"
            )
        printed = printed[index]
        passed.append(f"{axis} = {value}")
    if not is_number_text(printed):
        raise ModelError(
            f"table {entry['id']!r}: printed at {', '.join(passed)} is {printed!r}, not a number "
            "as a text"
        )
    return printed


def _chosen_explanation(entry: Mapping[str, Any], at: Mapping[str, Any]) -> str:
    """The first explanation of a table whose ``where`` fits; empty if none does."""
    for rule in entry["explanation"]:
        where = rule.get("where", {})
        strange = next((key for key in where if key not in at), None)
        if strange is not None:
            raise ModelError(
                f"table {entry['id']!r}: the explanation {rule['name']!r} is for {strange}, which "
                f"is not one of {', '.join(at)}"
            )
        if all(at[key] == value for key, value in where.items()):
            return rule["name"]
    return ""


def _cells(entry: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """One entry for each number of a printed table."""
    axes = entry["over"]
    labelled = ([(axis, *pair) for pair in enumerate(values)] for axis, values in axes.items())
    for place in product(*labelled):
        at = {axis: value for axis, _, value in place}
        labels = (f"{x:g}" if isinstance(x, float) else str(x) for x in at.values())
        try:
            statement = entry["statement"].format(**at)
        except (LookupError, ValueError) as error:
            raise ModelError(
                f"table {entry['id']!r}: the statement {entry['statement']!r} may name only "
                f"{', '.join(axes)}"
            ) from error
        source = entry["decided_by"]
        yield {
            **{key: entry[key] for key in ("section", "item", "legibility")},
            "id": f"{entry['id']}: {', '.join(labels)}",
            "table": entry["id"],
            "kind": "number",
            "statement": statement,
            "printed": _entry(entry, place),
            "remark": entry.get("remark", ""),
            "decided_by": {**source, "at": {**source.get("at", {}), **at}},
            "explanation": _chosen_explanation(entry, at),
            "uses": entry.get("uses", []),
        }


def printed_table(entry: Mapping[str, Any]) -> dict[str, Any]:
    """Axes and numbers of a printed table, as a stage takes them.

    Examples
    --------
    >>> printed_table({"over": {"n": [1, 2]}, "printed": ["0.5", "0.75"]})
    {'n': [1, 2], 'values': [0.5, 0.75]}
    """

    def numbers(part):
        return [numbers(x) for x in part] if isinstance(part, list) else float(part)

    return {**entry["over"], "values": numbers(entry["printed"])}


def _explanation(entry: Mapping[str, Any]) -> Explanation:
    criteria = _criteria({"readings": entry["checks"]})
    return Explanation(entry["id"], entry["text"], criteria, _uses(entry, criteria))


def _once(kind: str, names: Sequence[str]) -> None:
    for name in names:
        if names.count(name) > 1:
            raise ModelError(f"{kind} {name!r} stands twice in the ledger")


def parse_ledger(mapping: Mapping[str, Any]) -> Ledger:
    """The ledger from its mapping; tables become one claim for each number.

    Raises
    ------
    ModelError
        If a name stands twice, a claim names an explanation that there is not,
        or a printed table does not have the shape of its axes.
    """
    explanations = tuple(_explanation(entry) for entry in mapping["explanations"])
    _once("explanation", [explanation.id for explanation in explanations])
    _once("claim", [entry["id"] for entry in mapping["claims"]])
    claims: list[Claim] = []
    for entry in mapping["claims"]:
        parts = _cells(entry) if entry["kind"] == "table" else [entry]
        claims += [_claim(part) for part in parts]
    _once("claim", [claim.id for claim in claims])
    known = {explanation.id for explanation in explanations}
    for claim in claims:
        if claim.explanation and claim.explanation not in known:
            raise ModelError(
                f"claim {claim.id!r} names the explanation {claim.explanation!r}, which is not one "
                f"of {', '.join(sorted(known))}"
            )
    return Ledger(mapping["close_units"], mapping["parameters"], tuple(claims), explanations)
