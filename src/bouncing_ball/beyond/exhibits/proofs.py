"""Certified numbers of the paper: Table 1, thresholds of Figs. 14 and 16, and what is proved."""

from collections.abc import Iterator
from fractions import Fraction
from typing import Annotated, Any, NamedTuple

import numpy as np
import xarray as xr
from flint import arb

from bouncing_ball.beyond.corrected.errors import search
from bouncing_ball.beyond.proofs.certificates import (
    Problem,
    ProofError,
    decimal,
    exactly,
    period_doubling,
    precision,
    saddle_node,
)
from bouncing_ball.beyond.proofs.thresholds import (
    CONDITIONS,
    error_threshold,
    permanent_contact_minimum,
    permanent_contact_threshold,
)
from bouncing_ball.datasets.parameters import (
    Amplitude,
    Family,
    FrequencyRatio,
    LossyRestitution,
    Many,
    Parameters,
    Tolerance,
    number,
)
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.paper.contact.damping import Release, damping_ratio
from bouncing_ball.paper.exhibits.printed_table1 import AXES, RESTITUTION, printed_text
from bouncing_ball.paper.orbits.stability import Bifurcation

VARIABLES = {
    "certificate": Variable("what is certified"),
    "certified": Variable("decimal number in the certified interval"),
    "certified_radius": Variable("bound of the distance of the exact number from the decimal one"),
    "certified_bits": Variable("bits of the balls in the proof"),
    "certified_what": Variable("what the proof shows"),
    "certified_approximation": Variable("the certified number in double precision"),
    "certified_print": Variable("what the certified interval says of the printed number"),
    "certified_printed_text": Variable("the number that the paper prints, as a text"),
}

# The grid of ϖ in which the thresholds are first sought in double precision.
_GRID = np.geomspace(1.0, 1e4, 101)


class Thresholds(Parameters):
    """The orbit whose error decides the thresholds, and the error that is tolerated."""

    n: Family
    restitution: LossyRestitution
    amplitude: Amplitude
    tolerance: Tolerance


class Proofs(Parameters):
    """The ends of stability ranges, and the orbit of the thresholds."""

    n: Many[Family]
    restitution: LossyRestitution
    frequency_ratio: Many[FrequencyRatio]
    thresholds: Thresholds
    digits: Annotated[int, number("certified decimal digits of each number", ge=10, le=100)]


class Row(NamedTuple):
    """One certified number; its ball, or the reason why there is none."""

    name: str
    ball: arb | None
    bits: int
    what: str
    printed: str = ""


def ends_of_table_1(parameters: Proofs) -> Iterator[Row]:
    """The saddle-nodes and period doublings of all contacts and families."""
    certify = {Bifurcation.SADDLE_NODE: saddle_node, Bifurcation.PERIOD_DOUBLING: period_doubling}
    for ratio in parameters.frequency_ratio:
        for n in parameters.n:
            problem = Problem(exactly(ratio), restitution=exactly(parameters.restitution), n=n)
            for kind, proof in certify.items():
                name = f"Λ of the {kind}, ϖ = {ratio:g}, n = {n}"
                printed = _printed(parameters.restitution, ratio, n, kind)
                try:
                    found = proof(problem, parameters.digits)
                except ProofError as error:
                    yield Row(name, None, 0, str(error), printed)
                    continue
                yield Row(name, found.amplitude, found.bits, "; ".join(found.proved), printed)


def _printed(restitution: float, ratio: float, n: int, kind: Bifurcation) -> str:
    there = ratio in AXES["frequency_ratio"] and n in AXES["n"] and restitution == RESTITUTION
    return printed_text(ratio, n, kind) if there else ""


def thresholds(parameters: Thresholds, digits: int) -> Iterator[Row]:
    """The ϖ at which the errors of the restitution model fall to the tolerance (Eqs. 37, 38)."""
    r, lam = exactly(parameters.restitution), exactly(parameters.amplitude)
    tolerance, n = exactly(parameters.tolerance), parameters.n
    names = list(CONDITIONS)
    zeta, rule = damping_ratio(parameters.restitution), Release.DISPLACEMENT
    starts = search(zeta, rule, n, float(lam), _GRID, float(tolerance), names).threshold[0, :, 0]
    for quantity, start in zip(names, starts, strict=True):
        name = f"ϖ for {float(tolerance):.0%} of {quantity.replace('_', ' ')}"
        printed = "82" if quantity == "max_height" else ""
        yield _threshold(name, quantity, r, n, lam, tolerance, float(start), digits, printed)
    try:
        found = permanent_contact_threshold(r, tolerance, digits)
    except ProofError as error:
        yield Row("ϖ of permanent contact", None, 0, str(error), "6")
    else:
        what = "root of Eq. 34"
        yield Row("ϖ of permanent contact", found.frequency_ratio, found.bits, what, "6")
    problem = Problem(Fraction(10), restitution=r)
    least = permanent_contact_minimum(problem, digits)
    yield Row("least Λ of permanent contact", least, 0, "Eq. 36")


def _threshold(
    name: str,
    quantity: str,
    r: Fraction,
    n: int,
    lam: Fraction,
    tolerance: Fraction,
    start: float,
    digits: int,
    printed: str,
) -> Row:
    """The threshold of one quantity, for the sign of the error with which a solution is proved."""
    reason = "no threshold was found to start from"
    for sign in (-1, 1) if np.isfinite(start) else ():
        try:
            found = error_threshold(quantity, r, n, lam, sign * tolerance, start, digits)
        except ProofError as error:
            reason = str(error)
            continue
        what = "exactly one solution"
        return Row(name, found.frequency_ratio, found.bits, what, printed)
    return Row(name, None, 0, reason, printed)


def judged(ball: arb, printed: str) -> str:
    """What an interval says of a printed number, whose last digit is rounded.

    Examples
    --------
    >>> judged(arb("82.17"), "82"), judged(arb("9.81"), "6"), judged(arb("0.2385"), "0.238")
    ('reproduced', 'contradicted', 'not decided')
    """
    unit = arb(10) ** -len(printed.partition(".")[2])
    low, high = arb(printed) - unit / 2, arb(printed) + unit / 2
    if ball > low and ball < high:
        return "reproduced"
    if ball < low or ball > high:
        return "contradicted"
    return "not decided"


def proofs(parameters: Proofs) -> xr.Dataset:
    """Certified numbers as decimal texts with their radii, over ``certificate``.

    ``certified_what`` says what was proved, or why nothing was; ``certified_print`` is "reproduced"
    if all numbers of the interval round to the printed one, "contradicted" if none does.
    """
    rows = [*ends_of_table_1(parameters), *thresholds(parameters.thresholds, parameters.digits)]
    columns: dict[str, Any] = {name: [] for name in VARIABLES if name != "certificate"}
    for row in rows:
        text = radius = verdict = ""
        with precision(max(row.bits, 256)):
            if row.ball is not None:
                text, radius = decimal(row.ball, parameters.digits)
                verdict = judged(row.ball, row.printed) if row.printed else ""
        columns["certified"].append(text)
        columns["certified_radius"].append(radius)
        columns["certified_bits"].append(row.bits)
        columns["certified_what"].append(row.what)
        columns["certified_approximation"].append(float(text) if text else np.nan)
        columns["certified_print"].append(verdict)
        columns["certified_printed_text"].append(row.printed)
    return described(
        {name: ("certificate", np.array(values)) for name, values in columns.items()},
        coords={"certificate": [row.name for row in rows]},
        variables=VARIABLES,
    )
