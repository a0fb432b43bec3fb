"""The verdicts on the printed numbers of the paper, decided by certified intervals.

The ledger of claims, a dataset of the replication, compares printed numbers with numbers in double
precision. Here the same verdicts compare them with the intervals that are proved to contain the
exact numbers, so that a printed number is reproduced only if the whole interval rounds to it, and
contradicted only if nothing in it does. A difference from the ledger stops the run; a printed
number without a certificate is listed as such.
"""

from collections.abc import Iterable, Mapping
from enum import StrEnum
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.datasets.selection import each
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.errors import ModelError

VARIABLES = {
    "claim": Variable("claim of the paper"),
    "item": Variable("figure, table or equation of the paper"),
    "statement": Variable("what the claim says"),
    "printed_text": Variable("the number as printed"),
    "verdict": Variable(
        "reproduced, differs in the last digits, contradicted, not decided or not certified"
    ),
    "found": Variable("decimal number in the certified interval"),
    "low": Variable("lower limit of the certified interval"),
    "high": Variable("upper limit of the certified interval"),
    "deviation_units": Variable("deviation in units of the last printed digit"),
    "deviation": Variable("relative deviation"),
}
# Variables of the ledger that are those of the verdicts as well.
_OF_CLAIM = ("item", "statement", "printed_text")
_ROUNDED = Fraction(1, 2)


class Verdict(StrEnum):
    """The verdicts on a printed number, and the two absences of a verdict."""

    REPRODUCED = "reproduced"
    """The whole interval is within half a unit of the last printed digit."""
    DIFFERS = "differs in the last digits"
    """The whole interval is farther away, but within the share ``last_digits`` of the ledger."""
    CONTRADICTED = "contradicted"
    """The whole interval is farther away than that."""
    NOT_DECIDED = "not decided"
    """A part of the interval has another verdict than the rest."""
    NOT_CERTIFIED = "not certified"
    """There is no certificate of this number."""


class Certified(NamedTuple):
    """A certified number, and limits in double precision between which it certainly lies."""

    found: float
    low: float
    high: float


def certified_interval(proofs: xr.Dataset, claim: str) -> Certified | None:
    """The certified number of a claim; None if there is no certificate of it.

    The limits are the double-precision numbers next to those of the interval, on its outside.

    Raises
    ------
    ModelError
        If several certificates are of this claim.
    """
    found = proofs.isel(certificate=np.flatnonzero(proofs.certified_claim.values == claim))
    if found.sizes["certificate"] > 1:
        raise ModelError(f"{claim!r} has {found.sizes['certificate']} certificates")
    # A proof that fails leaves its row without a number.
    if not found.sizes["certificate"] or not found.certified.item():
        return None
    text = found.certified.item()
    radius = Fraction(found.certified_radius.item())
    low = float(Fraction(text) - radius)
    high = float(Fraction(text) + radius)
    return Certified(float(text), np.nextafter(low, -np.inf), np.nextafter(high, np.inf))


def interval_against_print(interval: Iterable[float], printed: str, last_digits: float) -> Verdict:
    """The verdict that all numbers between two limits have; the limits are compared exactly.

    Parameters
    ----------
    interval : iterable of float
        A number, and the limits between which it certainly lies.
    printed : str
        The number as printed.
    last_digits : float
        The largest relative distance from the printed number at which only last digits differ.

    Raises
    ------
    ModelError
        If the limits are infinite or do not contain the number.

    Examples
    --------
    >>> [str(interval_against_print([82.4, 82.3, x], "82", 0.01)) for x in (82.5, 82.6)]
    ['reproduced', 'not decided']
    """
    value, low, high = map(float, interval)
    if not -np.inf < low <= value <= high < np.inf:
        raise ModelError(f"{low} to {high} is no interval around {value}")
    unit = _last_digit(printed)
    least = (Fraction(low) - Fraction(printed)) / unit
    most = (Fraction(high) - Fraction(printed)) / unit
    nearest = max(least, -most, Fraction(0))
    farthest = max(-least, most)
    if farthest <= _ROUNDED:
        return Verdict.REPRODUCED
    bound = Fraction(str(last_digits)) * abs(Fraction(printed)) / unit
    if nearest > _ROUNDED and farthest <= bound:
        return Verdict.DIFFERS
    if nearest > max(bound, _ROUNDED):
        return Verdict.CONTRADICTED
    return Verdict.NOT_DECIDED


def _last_digit(printed: str) -> Fraction:
    """One unit of the last printed digit."""
    return Fraction(1, 10 ** len(printed.partition(".")[2]))


def _decided(claim: xr.Dataset, proofs: xr.Dataset, last_digits: float) -> dict[str, Any]:
    """The entries of the dataset for one printed number."""
    name = claim.claim.item()
    printed = claim.printed_text.item()
    row = {key: claim[key].item() for key in _OF_CLAIM}
    interval = certified_interval(proofs, name)
    if interval is None:
        missing = dict.fromkeys((*Certified._fields, "deviation_units", "deviation"), np.nan)
        return row | missing | {"verdict": str(Verdict.NOT_CERTIFIED)}
    verdict = interval_against_print(interval, printed, last_digits)
    ledger = claim.verdict.item()
    if verdict != ledger:
        raise ModelError(
            f"{name!r}: {verdict} by its certified interval, but {ledger} in the ledger"
        )
    distance = interval.found - float(printed)
    return (
        row
        | interval._asdict()
        | {
            "deviation_units": distance / float(_last_digit(printed)),
            "deviation": distance / abs(float(printed)),
            "verdict": str(verdict),
        }
    )


def certified_verdicts(data: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """The verdict on every printed number by its certified interval, over ``claim``.

    Parameters
    ----------
    data : mapping of str to xarray.Dataset
        ``ext_proofs`` with the certificates, and ``claims``, the ledger of the replication.

    Returns
    -------
    xarray.Dataset
        ``printed_text``, ``verdict``, ``found`` with the limits ``low`` and ``high`` between which
        the exact number lies, ``deviation_units`` and ``deviation``; NaN without a certificate.

    Raises
    ------
    ModelError
        If a printed number has another verdict than in the ledger.
    """
    ledger = data["claims"]
    printed = ledger.isel(claim=np.flatnonzero(ledger.printed_text.values != ""))
    last_digits = float(ledger.attrs["last_digits"])
    rows = [_decided(one, data["ext_proofs"], last_digits) for one in each(printed, "claim")]
    return described(
        {name: ("claim", np.array([row[name] for row in rows])) for name in rows[0]},
        coords={"claim": printed.claim.values},
        variables=VARIABLES,
    )
