"""The verdict on every claim of the paper, and the number of claims with each verdict."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict

import numpy as np
import xarray as xr

from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.errors import ModelError
from bouncing_ball.paper.claims import (
    both_models,
    evidence,
    impact_models,
    periodic_orbits,
)
from bouncing_ball.paper.claims.claim import Claim, checks_hold, defined_in, name_of, paragraphs
from bouncing_ball.paper.claims.paper_parameters import PAPER, Data, Digests, PaperData
from bouncing_ball.paper.claims.parameter_texts import parameters_of
from bouncing_ball.paper.claims.verdict import LAST_DIGITS, Verdict
from bouncing_ball.paper.exhibits.printed_table1 import PERMANENT_CONTACT

VARIABLES = {
    "item": Variable("figure, table or equation of the paper"),
    "orbit": Variable("orbit along the frequency ratio, curve of a figure"),
    "measure": Variable("quantity compared along these orbits"),
    "stiff_orbit_error": Variable(
        "largest relative error of an orbit among stiff contacts", budget=1e-12
    ),
    "short_of_lift": Variable("smallest 1 - Λ sin φ of Fig. 6, with φ of Eq. 6", budget=1e-11),
    "inadmissible_orbits": Variable(
        "orbits in our versions of the figures that do not have one impact per period"
    ),
    "range_error": Variable("relative error of the ends of the stability range", budget=1e-12),
    "printed_slight_move": Variable(
        "largest relative move of a printed end from the stiffest row to the next",
        equation="Table 1",
    ),
    "period_doubling_lowest": Variable(
        "ϖ at which the period doubling is lowest", symbol="ϖ", budget=1e-05
    ),
    "amplitude_matters_below": Variable(
        "ϖ below which the velocities of Fig. 10 differ by more than the tolerance",
        symbol="ϖ",
        budget=1e-09,
    ),
    "permanent_contact_error": Variable(
        "relative error of Λ_CR at the printed threshold", equation="Eq. 38"
    ),
    "claim": Variable("claim of the paper"),
    "group": Variable("what the claim is counted as"),
    "restates": Variable("claim that it says again"),
    "statement": Variable("what the claim says"),
    "printed_text": Variable("the number as printed"),
    "remark": Variable("how the claim was read"),
    "condition": Variable("condition that decides a statement in words"),
    "compared": Variable("what the number found is"),
    "parameters": Variable("r, n, Λ, ϖ and ζ at which the number is found"),
    "missing": Variable("what the verdict depends on and the text does not have"),
    "answer": Variable("what its author might answer to the verdict"),
    "decided_by": Variable("datasets that decide"),
    "required": Variable("the number as printed, or the bound to be met"),
    "low": Variable("lower limit of the confidence interval of the number found", budget=math.inf),
    "high": Variable("upper limit of the confidence interval of the number found", budget=math.inf),
    "limit": Variable("the bound to be met, as a number", budget=math.inf),
    "found": Variable("the number found", budget=math.inf),
    "deviation_units": Variable("deviation in units of the last printed digit", budget=math.inf),
    "deviation": Variable("relative deviation", budget=math.inf),
    "verdict": Variable(
        "reproduced, definition, in one reading, differs in the last digits, contradicted, "
        "undecidable or not asked"
    ),
    "printed_table": Variable("the printed table whose entry the claim is"),
    "explained_by": Variable("name of the explanation"),
    "explained": Variable("needs no explanation, or is explained by checks that hold"),
    "explanation": Variable(
        "explanation of claims that are contradicted or differ in the last digits"
    ),
    "explanation_text": Variable("the explanation in words"),
    "explanation_checks": Variable(
        "the checks of the explanation, with the numbers found", budget=math.inf
    ),
    "explanation_holds": Variable("whether the checks of the explanation hold"),
}
_CHAPTERS = (impact_models, periodic_orbits, both_models)
CLAIMS: tuple[Claim, ...] = tuple(claim for chapter in _CHAPTERS for claim in defined_in(chapter))
"""Every claim of the paper that can be decided, in the order of the paper."""


def _row(
    claim: Claim,
    asked: PaperData,
    holding: set[str],
) -> dict[str, object]:
    """The entries of the dataset for one claim; ``holding`` names the explanations that hold."""
    finding, reason = claim.verdict(asked)
    explained_by = name_of(claim.explanation) if claim.explanation else ""
    needs_none = finding.verdict not in (Verdict.DIFFERS, Verdict.CONTRADICTED)
    return {
        # First, as the comparison of two datasets tells their words in this order.
        "verdict": finding.verdict,
        "item": claim.item,
        "statement": claim.statement,
        "remark": claim.remark,
        "condition": claim.condition,
        "compared": claim.compared,
        "parameters": parameters_of({name: asked[name] for name in asked.used}, claim.at),
        "missing": claim.missing,
        "answer": claim.answer,
        "group": claim.kind,
        "restates": claim.restates.id if claim.restates else "",
        "printed_text": claim.printed,
        "decided_by": ", ".join(asked.used),
        **asdict(finding),
        "reason": reason,
        "printed_table": "Table 1" if claim.item == "Table 1" and claim.printed else "",
        "explained_by": explained_by,
        "explained": needs_none or explained_by in holding,
    }


def judged_claims(
    claims: Sequence[Claim],
    data: Data,
    required: Digests = PAPER,
) -> xr.Dataset:
    """The verdict on each claim, over ``claim``, and the explanations whose checks hold, over
    ``explanation``. A claim is not asked if a dataset that it reads has other parameters than
    ``required``, by default the paper's.

    Raises
    ------
    ModelError
        If a dataset that decides a claim or an explanation, or a variable of it, is missing.
    """
    why = {name_of(one.explanation): one.explanation for one in claims if one.explanation}
    checks = {name: checks_hold(one, PaperData(data, required)) for name, one in why.items()}
    holding = {name for name, (holds, _) in checks.items() if holds}
    rows = [_row(claim, PaperData(data, required), holding) for claim in claims]
    return described(
        {
            **{key: ("claim", np.array([row[key] for row in rows])) for key in rows[0]},
            "explanation_text": ("explanation", [paragraphs(x)["statement"] for x in why.values()]),
            "explanation_holds": ("explanation", [holds for holds, _ in checks.values()]),
            "explanation_checks": ("explanation", [found for _, found in checks.values()]),
        },
        coords={"claim": [one.id for one in claims], "explanation": list(why)},
        variables=VARIABLES,
    )


def claims(data: Data) -> xr.Dataset:
    """The verdict on every claim of the paper, and the numbers that the article prints with them.

    Parameters
    ----------
    data : mapping of str to xarray.Dataset
        The datasets that decide the claims, by name.

    Returns
    -------
    xarray.Dataset
        The dataset of :func:`judged_claims`, and results of
        :mod:`~bouncing_ball.paper.claims.evidence` under the names of the functions. The
        attributes are the paper's limits and the relative difference up to which a number differs
        in its last digits.

    Raises
    ------
    ModelError
        If a dataset, or a variable of it, is missing, or two claims have one name.
    """
    names = Counter(claim.id for claim in CLAIMS)
    if twice := [name for name, number in names.items() if number > 1]:
        raise ModelError(f"{twice[0]!r} is the name of two claims: figures/claims.md has all names")
    printed = (
        evidence.stiff_orbit_error,
        evidence.short_of_lift,
        evidence.inadmissible_orbits,
        evidence.range_error,
        evidence.printed_slight_move,
        evidence.period_doubling_lowest,
        evidence.amplitude_matters_below,
        evidence.permanent_contact_error,
    )
    numbers = {one.__name__: xr.DataArray(one(data)).reset_coords(drop=True) for one in printed}
    verdicts = judged_claims(CLAIMS, data)
    evident = described(numbers, variables=VARIABLES)
    return xr.merge([verdicts, evident]).assign_attrs(
        last_digits=LAST_DIGITS,
        tolerance=evidence.TOLERANCE,
        stiff_frequency_ratio=evidence.STIFF,
        permanent_contact_frequency_ratio=PERMANENT_CONTACT,
    )


_GROUPS = {
    "restored formula": "formulas",
    "number": "printed numbers",
    "statement": "statements",
}


def tally(decided: xr.Dataset) -> str:
    """The numbers of claims and of verdicts, one line for each group.

    Groups are not added up, because a formula, a number and a statement are not of equal weight.

    Parameters
    ----------
    decided : Dataset
        ``verdict``, ``group`` and ``explained`` over ``claim``.

    Examples
    --------
    >>> decided = xr.Dataset({"verdict": ("claim", ["contradicted", "reproduced", "reproduced"]),
    ...                       "group": ("claim", ["number", "number", "statement"]),
    ...                       "explained": ("claim", [False, True, True])})
    >>> print(tally(decided))
    2 printed numbers: 1 reproduced, 1 contradicted, 1 without explanation
    1 statements: 1 reproduced
    """
    lines = []
    for group, words in _GROUPS.items():
        of_group = decided.isel(claim=decided.group.values == group)
        if of_group.sizes["claim"]:
            lines.append(f"{of_group.sizes['claim']} {words}: {_counted(of_group)}")
    return "\n".join(lines)


def _counted(decided: xr.Dataset) -> str:
    """How many claims have each verdict, and how many have no explanation."""
    verdicts = decided.verdict.values
    found = [one for one in Verdict if str(one) in verdicts]
    numbers = [int(np.sum(verdicts == str(one))) for one in found]
    counts = [
        f"{number} {one if number == 1 else one.replace('differs', 'differ')}"
        for number, one in zip(numbers, found, strict=True)
    ]
    unexplained = int(np.sum(~decided.explained.values.astype(bool)))
    counts += [f"{unexplained} without explanation"] if unexplained else []
    return ", ".join(counts)
