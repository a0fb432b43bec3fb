"""The verdicts on the printed numbers of the paper, decided by certified intervals.

The ledger of claims (:mod:`bouncing_ball.paper.claims`) compares printed numbers with numbers in
double precision. Here the same verdict compares them with the intervals that are proved to contain
the exact numbers, so that a printed number is reproduced only if the whole interval rounds to it,
and contradicted only if nothing in it does. A difference between both ledgers stops the run.
"""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

import numpy as np
import xarray as xr

from bouncing_ball.errors import ModelError
from bouncing_ball.paper.claims.claim import Claim, Data
from bouncing_ball.paper.claims.claims import CLAIMS, judged_claims
from bouncing_ball.paper.claims.parameters import Digests
from bouncing_ball.paper.claims.verdict import Verdict

PARAMETERS: Digests = {
    "ext_proofs": ("6c52359c", "n", "restitution", "frequency_ratio", "thresholds", "apparent"),
}
"""The digest of the parameters with which the certified numbers are those that the paper prints."""


def certified_interval(data: Data, claim: str) -> np.ndarray:
    """The certified number of a claim and limits that certainly contain it, shape (3,).

    The limits are the double-precision numbers next to those of the interval, on its outside.

    Raises
    ------
    ModelError
        If there is no certificate for this claim.
    """
    proofs = data["ext_proofs"]
    found = proofs.isel(certificate=np.flatnonzero(proofs.certified_claim.values == claim))
    if found.sizes["certificate"] != 1:
        raise ModelError(f"{found.sizes['certificate']} certificates instead of one")
    text, radius, reason = (
        found[name].item() for name in ("certified", "certified_radius", "certified_what")
    )
    if not text:
        raise ModelError(f"not certified: {reason}")
    low = float(Fraction(text) - Fraction(radius))
    high = float(Fraction(text) + Fraction(radius))
    return np.array([float(text), np.nextafter(low, -np.inf), np.nextafter(high, np.inf)])


def by_certificate(claim: Claim) -> Claim:
    """The claim of a printed number, decided by its certified interval."""

    def decide(data: Data) -> np.ndarray:
        return certified_interval(data, claim.id)

    return replace(claim, decide=decide, explanation=None)


def require_agreement(certified: xr.Dataset, ledger: xr.Dataset) -> None:
    """Check that no certified verdict differs from that of the ledger of claims.

    Claims that were not asked in one of both are left out.

    Raises
    ------
    ModelError
        If a verdict differs.
    """
    for name in map(str, certified.claim.values):
        pair = [each.verdict.sel(claim=name).item() for each in (certified, ledger)]
        if pair[0] != pair[1] and Verdict.NOT_ASKED not in pair:
            raise ModelError(
                f"{name!r}: {pair[0]} by its certified interval, but {pair[1]} in the ledger"
            )


def certified_verdicts(data: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """The verdict on every printed number by its certified interval, over ``claim``.

    Parameters
    ----------
    data : mapping of str to xarray.Dataset
        ``ext_proofs`` with the certificates, and ``claims``, the ledger of claims.

    Returns
    -------
    xarray.Dataset
        That of :func:`~bouncing_ball.paper.claims.claims.judged_claims`; ``low`` and ``high`` are
        limits between which the exact number lies.

    Raises
    ------
    ModelError
        If a printed number has no certificate, or another verdict than in the ledger.
    """
    printed = [by_certificate(claim) for claim in CLAIMS if claim.printed]
    certified = judged_claims(printed, {"ext_proofs": data["ext_proofs"]}, PARAMETERS)
    require_agreement(certified, data["claims"])
    return certified
