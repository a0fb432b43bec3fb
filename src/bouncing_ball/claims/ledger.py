"""The ledger: every claim of the paper with its verdict, as a dataset."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict

import numpy as np
import xarray as xr

from bouncing_ball.claims import evidence
from bouncing_ball.claims.claim import Claim, Explanation, defined_in
from bouncing_ball.claims.paper import (
    apparent_restitution,
    both_models,
    explanations,
    introduction,
    orbits,
    permanent_contact,
    restitution_model,
    spring_damper_model,
)
from bouncing_ball.claims.parameters import PARAMETERS, PERMANENT_CONTACT, STIFF, TOLERANCE
from bouncing_ball.claims.verdict import CLOSE_UNITS, Finding, Verdict
from bouncing_ball.datasets.rounding import compared_text
from bouncing_ball.datasets.variables import described

_SECTIONS = (
    *(introduction, restitution_model, spring_damper_model, apparent_restitution),
    *(orbits, permanent_contact, both_models),
)
CLAIMS: tuple[Claim, ...] = tuple(
    claim for section in _SECTIONS for claim in defined_in(section, Claim)
)
"""Every claim of the paper that can be decided, in the order of the paper."""
EXPLANATIONS: tuple[Explanation, ...] = tuple(defined_in(explanations, Explanation))
"""Why some of them are not reproduced."""
READS = tuple(PARAMETERS)
"""The datasets that decide them."""


def _words(found: Mapping[str, Finding] | str) -> str:
    """Each check of an explanation with its number, or why there are none."""
    if isinstance(found, str):
        return found
    parts = []
    for name, one in found.items():
        text = compared_text(one.found, one.limit)
        text = text if text.startswith("≤") else f"= {text}"
        parts.append(f"{name} {text} (required {one.required})")
    return "; ".join(parts)


def _row(claim: Claim, data: Mapping[str, xr.Dataset], holding: set[str]) -> dict[str, object]:
    """What the dataset says of one claim; ``holding`` names the explanations that hold."""
    finding, reason, used = claim.verdict(data)
    why = claim.explanation.id if claim.explanation else ""
    settled = finding.verdict in (Verdict.REPRODUCED, Verdict.NOT_ASKED)
    said = ("section", "item", "kind", "group", "statement", "remark", "condition")
    return {
        **{key: getattr(claim, key) for key in said},
        "restates": claim.restates.id if claim.restates else "",
        "printed_text": claim.printed,
        "legibility": "clear" if claim.clear else "damaged",
        "decided_by": ", ".join(used),
        **asdict(finding),
        "reason": reason,
        "printed_table": claim.table,
        "explained_by": why,
        "explained": settled or why in holding,
    }


def assess(
    claims: Sequence[Claim], why: Sequence[Explanation], data: Mapping[str, xr.Dataset]
) -> xr.Dataset:
    """The verdict on each claim over ``claim``; over ``explanation`` whether its checks hold.

    Raises
    ------
    ModelError
        If a dataset that decides a claim or an explanation, or what is needed of it,
        is missing.
    """
    checks = [explanation.check(data) for explanation in why]
    holding = {one.id for one, (holds, _) in zip(why, checks, strict=True) if holds}
    rows = [_row(claim, data, holding) for claim in claims]
    return described(
        {
            **{key: ("claim", np.array([row[key] for row in rows])) for key in rows[0]},
            "explanation_text": ("explanation", [one.text for one in why]),
            "explanation_holds": ("explanation", [holds for holds, _ in checks]),
            "explanation_checks": ("explanation", [_words(found) for _, found in checks]),
        },
        coords={"claim": [one.id for one in claims], "explanation": [one.id for one in why]},
    )


def ledger(data: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """The verdict on every claim of the paper, and the numbers that the article prints with them.

    Parameters
    ----------
    data : mapping of str to xarray.Dataset
        The datasets of :data:`READS`, by name.

    Returns
    -------
    xarray.Dataset
        That of :func:`assess`, and functions of :mod:`bouncing_ball.claims.evidence` by
        their names. The attributes are the paper's limits and what counts as close.
    """
    printed = (
        evidence.stiff_orbit_error,
        evidence.apparent_restitution_law_error,
        evidence.short_of_lift,
        evidence.inadmissible_orbits,
        evidence.range_error,
        evidence.printed_slight_move,
        evidence.period_doubling_lowest,
        evidence.permanent_contact_error,
    )
    numbers = {one.__name__: xr.DataArray(one(data)).reset_coords(drop=True) for one in printed}
    return xr.merge([assess(CLAIMS, EXPLANATIONS, data), described(numbers)]).assign_attrs(
        close_units=CLOSE_UNITS,
        tolerance=TOLERANCE,
        stiff_frequency_ratio=STIFF,
        permanent_contact_frequency_ratio=PERMANENT_CONTACT,
    )
