"""The ledger: every claim of the paper, and every statement of ours, with its verdict."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict

import numpy as np
import xarray as xr

from bouncing_ball.claims import evidence, parameters, whole_motion
from bouncing_ball.claims.claim import Claim, checked, defined_in, name_of, paragraphs
from bouncing_ball.claims.paper import (
    apparent_restitution,
    both_models,
    introduction,
    orbits,
    permanent_contact,
    restitution_model,
    spring_damper_model,
)
from bouncing_ball.claims.parameters import PaperData
from bouncing_ball.claims.verdict import CLOSE_UNITS, Verdict
from bouncing_ball.datasets.variables import described

_SECTIONS = (
    *(introduction, restitution_model, spring_damper_model, apparent_restitution),
    *(orbits, permanent_contact, both_models),
)
CLAIMS: tuple[Claim, ...] = tuple(claim for section in _SECTIONS for claim in defined_in(section))
"""Every claim of the paper that can be decided, in the order of the paper."""


def _row(claim: Claim, data: Mapping[str, xr.Dataset], holding: set[str]) -> dict[str, object]:
    """The entries of the dataset for one claim; ``holding`` names the explanations that hold."""
    asked = PaperData(data)
    finding, reason = claim.verdict(asked)
    why = name_of(claim.explanation) if claim.explanation else ""
    said = ("item", "statement", "remark", "condition", "answer")
    return {
        **{key: getattr(claim, key) for key in said},
        "group": "restatement" if claim.restates else claim.kind,
        "restates": claim.restates.id if claim.restates else "",
        "printed_text": claim.printed,
        "decided_by": ", ".join(asked.used),
        **asdict(finding),
        "reason": reason,
        "printed_table": "Table 1" if claim.item == "Table 1" and claim.printed else "",
        "explained_by": why,
        "explained": finding.verdict not in (Verdict.CLOSE, Verdict.CONTRADICTED) or why in holding,
    }


def assess(claims: Sequence[Claim], data: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """The verdict on each claim, over ``claim``, and the explanations whose checks hold, over
    ``explanation``.

    Raises
    ------
    ModelError
        If a dataset that decides a claim or an explanation, or a variable of it, is missing.
    """
    why = {name_of(one.explanation): one.explanation for one in claims if one.explanation}
    checks = {name: checked(explanation, data) for name, explanation in why.items()}
    holding = {name for name, (holds, _) in checks.items() if holds}
    rows = [_row(claim, data, holding) for claim in claims]
    return described(
        {
            **{key: ("claim", np.array([row[key] for row in rows])) for key in rows[0]},
            "explanation_text": ("explanation", [paragraphs(x)["statement"] for x in why.values()]),
            "explanation_holds": ("explanation", [holds for holds, _ in checks.values()]),
            "explanation_checks": ("explanation", [found for _, found in checks.values()]),
        },
        coords={"claim": [one.id for one in claims], "explanation": list(why)},
    )


def ledger(data: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """The verdict on every claim of the paper, and the numbers that the article prints with them.

    Parameters
    ----------
    data : mapping of str to xarray.Dataset
        The datasets that decide the claims, by name: those of ``parameters.yaml``.

    Returns
    -------
    xarray.Dataset
        The dataset of :func:`assess`, and results of :mod:`bouncing_ball.claims.evidence` under
        the names of the functions. The attributes are the paper's limits and the bound within which
        a number is close.

    Raises
    ------
    ModelError
        If a dataset, or a variable of it, is missing.
    """
    printed = (
        evidence.stiff_orbit_error,
        evidence.short_of_lift,
        evidence.inadmissible_orbits,
        evidence.range_error,
        evidence.printed_slight_move,
        evidence.period_doubling_lowest,
        evidence.permanent_contact_error,
    )
    numbers = {one.__name__: xr.DataArray(one(data)).reset_coords(drop=True) for one in printed}
    return xr.merge([assess(CLAIMS, data), described(numbers)]).assign_attrs(
        close_units=CLOSE_UNITS,
        tolerance=parameters.TOLERANCE,
        stiff_frequency_ratio=parameters.STIFF,
        permanent_contact_frequency_ratio=parameters.PERMANENT_CONTACT,
    )


def statements(data: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """The verdict on each of our statements about the whole motion.

    The arguments, the dataset and the errors are those of :func:`assess`. Each number has the unit
    of the variable from which its statement takes it.
    """
    return assess([*defined_in(whole_motion)], data)
