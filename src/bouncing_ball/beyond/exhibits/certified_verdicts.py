"""The verdicts on the printed numbers of the paper, decided by certified intervals.

The ledger of claims (:mod:`bouncing_ball.paper.claims`) compares printed numbers with numbers in
double precision. Here the same verdicts compare them with the intervals that are proved to contain
the exact numbers, so that a printed number is reproduced only if the whole interval rounds to it,
and contradicted only if nothing in it does. A difference between both ledgers stops the run.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from fractions import Fraction

import numpy as np
import xarray as xr

from bouncing_ball.errors import ModelError
from bouncing_ball.paper.claims.claim import Claim
from bouncing_ball.paper.claims.claims import CLAIMS, judged_claims
from bouncing_ball.paper.claims.parameters import Data, Digests
from bouncing_ball.paper.claims.verdict import (
    Finding,
    Verdict,
    against_print,
    agreement,
    decimals,
)

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


def interval_against_print(interval: Iterable[float], printed: str) -> Finding:
    """The finding on a number with limits between which it certainly lies, shape (3,).

    The verdict is the one that all numbers between the limits have, so that the printed number is
    reproduced only if all of them round to it and contradicted only if none does; if they have
    several verdicts, nothing is decided. Limits are compared exactly.

    Raises
    ------
    ModelError
        If the limits are infinite or do not contain the number.

    Examples
    --------
    >>> [str(interval_against_print([82.4, 82.3, x], "82").verdict) for x in (82.5, 82.6)]
    ['reproduced', 'not decided']
    """
    value, low, high = map(float, interval)
    if not -np.inf < low <= value <= high < np.inf:
        raise ModelError(f"{low} to {high} is no interval around {value}")
    unit = Fraction(1, 10 ** decimals(printed))
    least = (Fraction(low) - Fraction(printed)) / unit
    most = (Fraction(high) - Fraction(printed)) / unit
    nearest = max(least, -most, Fraction(0))
    verdict = agreement(nearest, max(-least, most), printed)
    return replace(against_print(value, printed), verdict=verdict, low=low, high=high)


def by_certificate(claim: Claim) -> Claim:
    """The claim of a printed number, decided by its certified interval."""

    def decide(data: Data) -> Finding:
        return interval_against_print(certified_interval(data, claim.id), claim.printed)

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
