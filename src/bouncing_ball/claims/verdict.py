"""The verdict on a claim, or that it was not asked."""

import json
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.claims.digits import distance_in_units
from bouncing_ball.claims.ledger import (
    Claim,
    Condition,
    Criterion,
    Explanation,
    Ledger,
    Measure,
    Relation,
)
from bouncing_ball.claims.measure import measured
from bouncing_ball.datasets.netcdf import attribute_name
from bouncing_ball.errors import ModelError

# Rounding must not decide what lies exactly on a bound.
_ROUNDING = 1e-9
# A digit that rounds to the printed one.
_HALF = 0.5 + _ROUNDING


class Verdict(StrEnum):
    """From the best to the worst, and no verdict at all."""

    REPRODUCED = "reproduced"
    """Within half a unit of the last printed digit; a condition that holds."""
    CLOSE = "close"
    """A number farther away, by no more units than the ledger's ``close_units``."""
    CONTRADICTED = "contradicted"
    UNDECIDABLE = "undecidable"
    """Depends on how the claim is read."""
    NOT_ASKED = "not asked"
    """The datasets were not computed with the paper's parameters."""


@dataclass(frozen=True)
class Finding:
    """What one criterion of a claim gave.

    ``units`` and ``relative`` are the deviation from a printed number, in units
    of its last digit and as a share of it; NaN for a condition, which holds or
    does not. ``bound`` is that of the condition, NaN for a printed number;
    ``required`` is the printed number, or the condition in signs.
    """

    verdict: Verdict
    value: float
    units: float
    relative: float
    bound: float
    required: str


@dataclass(frozen=True)
class Decision:
    """The verdict on a claim with the finding that it rests on, or why there is none."""

    verdict: Verdict
    finding: Finding | None
    reason: str = ""


def _relative(difference: float, reference: float) -> float:
    return difference / abs(reference) if reference else float("nan")


def judge_number(value: float, printed: str, unit: float | None, close_units: float) -> Finding:
    """A computed number against a printed one.

    Examples
    --------
    >>> str(judge_number(82.177, "82", None, 2).verdict)
    'reproduced'
    >>> str(judge_number(0.2395, "0.238", None, 2).verdict)
    'close'
    >>> str(judge_number(9.81, "6", None, 2).verdict)
    'contradicted'
    """
    units = distance_in_units(value, printed, unit)
    relative = _relative(value - float(printed), float(printed))
    if abs(units) <= _HALF:
        verdict = Verdict.REPRODUCED
    elif abs(units) <= close_units + _ROUNDING:
        verdict = Verdict.CLOSE
    else:
        verdict = Verdict.CONTRADICTED
    return Finding(verdict, value, units, relative, float("nan"), printed)


def judge_condition(value: float, condition: Condition, bound: float) -> Finding:
    """A computed number against the bound of a condition, which holds or does not.

    Examples
    --------
    >>> one_percent = Condition(Relation.AT_MOST, "0.01")
    >>> [str(judge_condition(x, one_percent, 0.01).verdict) for x in (0.009, 0.011)]
    ['reproduced', 'contradicted']
    """
    slack = _ROUNDING * abs(bound)
    holds = {
        Relation.AT_MOST: value <= bound + slack,
        Relation.AT_LEAST: value >= bound - slack,
        Relation.BELOW: value < bound,
        Relation.ABOVE: value > bound,
    }[condition.relation]
    verdict = Verdict.REPRODUCED if holds else Verdict.CONTRADICTED
    nothing = float("nan")
    required = f"{condition.relation.sign} {bound:g}"
    return Finding(verdict, value, nothing, nothing, bound, required)


def _beside(measure: Measure, variable: str, data: Mapping[str, xr.Dataset]) -> Measure:
    """Another variable of the same dataset, at the same place as far as it has one."""
    dims = data[measure.dataset][variable].dims if variable in data[measure.dataset] else ()
    at = tuple((name, wanted) for name, wanted in measure.at if name in dims)
    return replace(measure, variable=variable, at=at)


def find(criterion: Criterion, claim: Claim | None, ledger: Ledger, data: Mapping[str, xr.Dataset]):
    """The :class:`Finding` of one criterion.

    Raises
    ------
    ModelError
        If an input is missing.
    """
    value = measured(criterion.measure, data)
    if criterion.condition is None:
        assert claim is not None
        return judge_number(value, claim.printed, claim.unit, ledger.close_units)
    if criterion.condition.bound_is_variable:
        beside = _beside(criterion.measure, criterion.condition.bound, data)
        bound = measured(beside, data)
    else:
        bound = float(criterion.condition.bound)
    return judge_condition(value, criterion.condition, bound)


def _plain(value: Any) -> Any:
    """An attribute as numbers, texts and lists: arrays and JSON undone."""
    if isinstance(value, str) and value[:1] in ("[", "{"):
        # Nested parameters are JSON among a dataset's attributes.
        with suppress(ValueError, RecursionError):
            return json.loads(value)
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


def _agrees(given: Any, paper: Any) -> bool:
    if isinstance(paper, Mapping):
        # What is of another kind, a text for a number, is not the paper's.
        with suppress(TypeError):
            limits = (given >= paper.get("at_least", given), given <= paper.get("at_most", given))
            return all(limits) and set(paper.get("includes", [])) <= set(_listed(given))
        return False
    # A list of one number is that number among the attributes.
    return _listed(given) == _listed(paper)


def _listed(value: Any) -> list:
    return value if isinstance(value, list) else [value]


def _words(paper: Any) -> str:
    if not isinstance(paper, Mapping):
        return str(paper)
    named = {"at_least": "at least", "at_most": "at most", "includes": "all of"}
    return " and ".join(f"{named[key]} {value}" for key, value in paper.items())


def foreign_parameter(
    part: Claim | Explanation, ledger: Ledger, data: Mapping[str, xr.Dataset]
) -> str:
    """The first parameter of the datasets used that is not the paper's, in words; or "".

    The ledger writes a parameter as the configuration does. It requires those
    under ``every`` of all datasets that have them, those under
    ``dataset.variable`` only for what that variable decides. A mapping with
    ``at_least``, ``at_most`` or ``includes`` requires no more than that.

    Raises
    ------
    ModelError
        If a dataset is missing, or a parameter that the ledger gives for it.
    """
    common = ledger.parameters.get("every", {})
    for name in part.uses:
        if name not in data:
            raise ModelError(f"{part.id!r} uses the unknown dataset {name}")
        attributes = data[name].attrs
        own = dict(ledger.parameters.get(name, {}))
        for measure in (criterion.measure for criterion in part.criteria):
            if measure.dataset == name:
                own |= ledger.parameters.get(f"{name}.{measure.variable}", {})
        absent = next((key for key in own if attribute_name(key) not in attributes), None)
        if absent is not None:
            raise ModelError(
                f"{part.id!r} needs {absent} = {_words(own[absent])}, but dataset {name} has no "
                f"parameter {absent}"
            )
        for key, paper in {**common, **own}.items():
            given = _plain(attributes.get(attribute_name(key)))
            if given is not None and not _agrees(given, paper):
                required = _words(paper)
                return f"{name} was computed with {key} = {given}; the claim requires {required}"
    return ""


def _number(criterion: Criterion, finding: Finding) -> str:
    """The number found, but where only its being rounding says anything."""
    if criterion.condition is not None and criterion.condition.bound_is_variable:
        return ""
    return f" ({finding.value:.4g})"


def decide(claim: Claim, ledger: Ledger, data: Mapping[str, xr.Dataset]) -> Decision:
    """The decision on a claim.

    Not asked if the datasets were not computed with the paper's parameters,
    undecidable if the verdict depends on how the claim is read.

    Raises
    ------
    ModelError
        If an input is missing.
    """
    foreign = foreign_parameter(claim, ledger, data)
    if foreign:
        return Decision(Verdict.NOT_ASKED, None, foreign)
    findings = [find(criterion, claim, ledger, data) for criterion in claim.criteria]
    verdicts = {finding.verdict for finding in findings}
    if len(verdicts) > 1:
        pairs = zip(claim.criteria, findings, strict=True)
        readings = "; ".join(
            f"{c.reading}: {finding.verdict}{_number(c, finding)}" for c, finding in pairs
        )
        return Decision(Verdict.UNDECIDABLE, None, f"depends on the reading: {readings}")
    return Decision(findings[0].verdict, findings[0])
