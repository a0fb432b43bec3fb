"""The ledger from ``config/claims.yaml``, checked."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import product
from pathlib import Path
from string import Formatter
from typing import Any

from bouncing_ball.claims.digits import is_number_text
from bouncing_ball.claims.ledger import (
    Claim,
    Condition,
    Criterion,
    Explanation,
    Ledger,
    Measure,
    Relation,
)
from bouncing_ball.configuration.conformity import check_schema
from bouncing_ball.configuration.yaml_file import ConfigurationError, read_yaml
from bouncing_ball.datasets.variables import VARIABLES
from bouncing_ball.errors import ModelError


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
        restates=entry.get("restates", ""),
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


def _by_place(entry: Mapping[str, Any], key: str, at: Mapping[str, Any]) -> str:
    """The first name under a key of a table whose ``where`` fits; empty if none does."""
    for rule in entry.get(key, []):
        where = rule.get("where", {})
        strange = next((axis for axis in where if axis not in at), None)
        if strange is not None:
            raise ModelError(
                f"table {entry['id']!r}: the {key} {rule['name']!r} is for {strange}, which is "
                f"not one of {', '.join(at)}"
            )
        if all(at[axis] == value for axis, value in where.items()):
            return rule["name"]
    return ""


def _statement(entry: Mapping[str, Any], at: Mapping[str, Any]) -> str:
    """The statement at a place; its fields are names of axes, plain or as ``{name:g}``."""
    text, where = entry["statement"], f"table {entry['id']!r}: the statement"
    try:
        fields = [field for field in Formatter().parse(text) if field[1] is not None]
    except ValueError as error:
        raise ModelError(f"{where} {text!r} has a brace that does not match") from error
    for _, name, form, conversion in fields:
        if name is None or name not in at:
            raise ModelError(f"{where} may name only {', '.join(at)}; it names {name!r}")
        number = isinstance(at[name], int | float)
        if conversion or form not in ("", "g") or (form and not number):
            raise ModelError(
                f"{where} may write {name} as {{{name}}}{f' or {{{name}:g}}' * number}"
            )
    return text.format(**at)


def _cells(entry: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """One entry for each number of a printed table."""
    axes = entry["over"]
    labelled = ([(axis, *pair) for pair in enumerate(values)] for axis, values in axes.items())
    for place in product(*labelled):
        at = {axis: value for axis, _, value in place}
        labels = (f"{x:g}" if isinstance(x, float) else str(x) for x in at.values())
        source = entry["decided_by"]
        yield {
            **{key: entry[key] for key in ("section", "item", "legibility")},
            "id": f"{entry['id']}: {', '.join(labels)}",
            "table": entry["id"],
            "kind": "number",
            "statement": _statement(entry, at),
            "printed": _entry(entry, place),
            "remark": entry.get("remark", ""),
            "decided_by": {**source, "at": {**source.get("at", {}), **at}},
            "explanation": _by_place(entry, "explanation", at),
            "restates": _by_place(entry, "restates", at),
            "uses": entry.get("uses", []),
        }


def _table(entry: Mapping[str, Any], parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Axes and numbers of a printed table, and the paper's parameters behind it."""

    def numbers(part):
        return [numbers(x) for x in part] if isinstance(part, list) else float(part)

    own = parameters.get("every", {}) | parameters.get(entry["decided_by"]["dataset"], {})
    fixed = {key: value for key, value in own.items() if not isinstance(value, dict)}
    return {**fixed, **entry["over"], "values": numbers(entry["printed"])}


def _explanation(entry: Mapping[str, Any]) -> Explanation:
    criteria = _criteria({"readings": entry["checks"]})
    return Explanation(entry["id"], entry["text"], criteria, _uses(entry, criteria))


def _once(kind: str, names: Sequence[str]) -> None:
    for name in names:
        if names.count(name) > 1:
            raise ModelError(f"{kind} {name!r} is defined twice in the ledger")


def _check_restatements(claims: Sequence[Claim]) -> None:
    alone = [claim.id for claim in claims if not claim.restates]
    for claim in claims:
        if claim.restates and claim.restates not in alone:
            raise ModelError(
                f"claim {claim.id!r} restates {claim.restates!r}, which is not an independent claim"
            )


def parse_ledger(mapping: Mapping[str, Any]) -> Ledger:
    """The ledger from its mapping; tables become one claim for each number.

    Raises
    ------
    ModelError
        If a name is defined twice, a claim names an unknown explanation or
        restates one that does not stand alone, or a printed table does not have
        the shape of its axes.
    """
    explanations = tuple(_explanation(entry) for entry in mapping["explanations"])
    _once("explanation", [explanation.id for explanation in explanations])
    _once("claim", [entry["id"] for entry in mapping["claims"]])
    claims: list[Claim] = []
    for entry in mapping["claims"]:
        parts = _cells(entry) if entry["kind"] == "table" else [entry]
        claims += [_claim(part) for part in parts]
    _once("claim", [claim.id for claim in claims])
    _check_restatements(claims)
    known = {explanation.id for explanation in explanations}
    for claim in claims:
        if claim.explanation and claim.explanation not in known:
            raise ModelError(
                f"claim {claim.id!r}: unknown explanation {claim.explanation!r}; known: "
                f"{', '.join(sorted(known))}"
            )
    tables = {
        entry["id"]: _table(entry, mapping["parameters"])
        for entry in mapping["claims"]
        if entry["kind"] == "table"
    }
    return Ledger(
        close_units=mapping["close_units"],
        parameters=mapping["parameters"],
        claims=tuple(claims),
        explanations=explanations,
        tables=tables,
        source=mapping,
    )


def _check_names(ledger: Ledger) -> None:
    """Raise unless what decides a claim has the name of a variable of some dataset."""
    parts: list[Claim | Explanation] = [*ledger.claims, *ledger.explanations]
    for part in parts:
        for criterion in part.criteria:
            bound = criterion.condition
            names = [criterion.measure.variable, *(axis for axis, _ in criterion.measure.at)]
            names += [bound.bound] if bound and bound.bound_is_variable else []
            for name in names:
                if name not in VARIABLES:
                    raise ConfigurationError(
                        f"{part.id!r}: unknown variable {name}; "
                        "src/bouncing_ball/datasets/variables.py has all names"
                    )


def read_ledger(folder: str | Path, made: Iterable[str] | None = None) -> Ledger:
    """The ledger of ``claims.yaml`` in a folder, checked against its schema.

    Parameters
    ----------
    folder : path
    made : iterable of str, optional
        The datasets that the pipeline makes; the ledger may use no other.

    Raises
    ------
    ModelError
        One line for the first mistake.
    """
    names = ("claims.yaml", "claims.schema.yaml")
    mapping, schema = (read_yaml(Path(folder, name)) for name in names)
    check_schema(mapping, schema)
    ledger = parse_ledger(mapping)
    _check_names(ledger)
    if made is None:
        return ledger
    with_parameters = {name.partition(".")[0] for name in ledger.parameters} - {"every"}
    known = sorted(made)
    for name in [*ledger.datasets, *sorted(with_parameters)]:
        if name not in known:
            raise ConfigurationError(f"unknown dataset {name}; known: {', '.join(known)}")
    return ledger
