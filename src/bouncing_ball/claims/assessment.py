"""Every claim with its verdict, as a dataset."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.claims.ledger import Claim, Criterion, Explanation, Ledger
from bouncing_ball.claims.ledger_file import parse_ledger
from bouncing_ball.claims.verdict import (
    Decision,
    Finding,
    Verdict,
    decide,
    find,
    foreign_parameter,
)
from bouncing_ball.datasets.netcdf import parameter_attributes
from bouncing_ball.datasets.rounding import compared_text
from bouncing_ball.datasets.variables import described


def _condition(claim: Claim, criterion: Criterion) -> str:
    if criterion.condition is None:
        return f"{criterion.measure} is {claim.printed}"
    bound = criterion.condition.bound
    if criterion.condition.bound_is_variable:
        bound = f"its {bound}"
    return f"{criterion.measure} {criterion.condition.relation.sign} {bound}"


def _compared(finding: Finding) -> str:
    found = compared_text(finding.value, finding.bound)
    return found if found.startswith("≤") else f"= {found}"


def _checks(
    explanation: Explanation, ledger: Ledger, data: Mapping[str, xr.Dataset]
) -> tuple[bool, str]:
    """Whether every check of an explanation is met, and each in words with its number."""
    foreign = foreign_parameter(explanation, ledger, data)
    if foreign:
        return False, foreign
    findings = [find(criterion, None, ledger, data) for criterion in explanation.criteria]
    words = [
        f"{criterion.measure} {_compared(finding)} (required {finding.required})"
        for criterion, finding in zip(explanation.criteria, findings, strict=True)
    ]
    met = all(finding.verdict is Verdict.REPRODUCED for finding in findings)
    return met, "; ".join(words)


def _row(claim: Claim, decision: Decision, holds: Mapping[str, bool]) -> dict[str, Any]:
    """What the dataset says of one claim; ``holds`` names the explanations whose checks do."""
    finding = decision.finding
    return {
        "section": claim.section,
        "item": claim.item,
        "kind": claim.kind,
        "group": claim.group,
        "restates": claim.restates,
        "statement": claim.statement,
        "printed_text": claim.printed,
        "legibility": claim.legibility,
        "remark": claim.remark,
        "condition": claim.condition_text,
        "decided_by": "; ".join(_condition(claim, criterion) for criterion in claim.criteria),
        "required": finding.required if finding else claim.printed,
        "limit": finding.bound if finding else np.nan,
        "found": finding.value if finding else np.nan,
        "deviation_units": finding.units if finding else np.nan,
        "deviation": finding.relative if finding else np.nan,
        "verdict": str(decision.verdict),
        "reason": decision.reason,
        "printed_table": claim.table,
        "explained_by": claim.explanation,
        "explained": decision.verdict in (Verdict.REPRODUCED, Verdict.NOT_ASKED)
        or holds.get(claim.explanation, False),
    }


def assess(ledger: Ledger, data: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """The verdict on each claim of a ledger.

    Parameters
    ----------
    ledger : Ledger
    data : mapping of str to xarray.Dataset
        Every dataset that the ledger names.

    Returns
    -------
    xarray.Dataset
        Over ``claim`` what the ledger says of it, the number found, its
        deviation and the verdict; over ``explanation`` whether its checks hold.
        The attributes are the paper's parameters and what counts as close.

    Raises
    ------
    ModelError
        If an input of a claim or of an explanation is missing.
    """
    checks = {part.id: _checks(part, ledger, data) for part in ledger.explanations}
    holds = {name: met for name, (met, _) in checks.items()}
    rows = [_row(claim, decide(claim, ledger, data), holds) for claim in ledger.claims]
    return described(
        {
            **{key: ("claim", np.array([row[key] for row in rows])) for key in rows[0]},
            "explanation_text": (
                "explanation",
                [explanation.text for explanation in ledger.explanations],
            ),
            "explanation_holds": ("explanation", list(holds.values())),
            "explanation_checks": ("explanation", [words for _, words in checks.values()]),
        },
        coords={"claim": [claim.id for claim in ledger.claims], "explanation": list(holds)},
    ).assign_attrs(
        close_units=ledger.close_units, **parameter_attributes(ledger.parameters, "paper.")
    )


def verdicts(data: Mapping[str, xr.Dataset], mapping: Mapping[str, Any]) -> xr.Dataset:
    """:func:`assess` as a stage, from the mapping of the ledger's file."""
    return assess(parse_ledger(mapping), data)
