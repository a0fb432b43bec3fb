"""Certified numbers: those that the paper prints, and what is proved of each.

A number whose parameters are the paper's has the name of the claim of the paper that prints it.
"""

from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import product
from typing import Annotated, Any, NamedTuple

import numpy as np
import xarray as xr
from flint import arb

from bouncing_ball.accuracy.errors import Quantity
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
from bouncing_ball.periodic.orbit import Bifurcation
from bouncing_ball_beyond.accuracy.simple_models import errors, search
from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.proofs.balls import ProofError, decimal_with_bound, exactly, precision
from bouncing_ball_beyond.proofs.certificates import (
    Proved,
    certified_orbit,
    period_doubling,
    saddle_node,
)
from bouncing_ball_beyond.proofs.problem import RationalProblem, damping_of, working_bits
from bouncing_ball_beyond.proofs.thresholds import (
    CertifiedNumber,
    ComparedOrbit,
    apparent_restitution,
    height_threshold,
    permanent_contact_threshold,
)

VARIABLES = {
    "certificate": Variable("what is certified"),
    "certified": Variable("decimal number in the certified interval"),
    "certified_radius": Variable("bound of the distance of the exact number from the decimal one"),
    "certified_bits": Variable("bits of the balls in the proof"),
    "certified_what": Variable("what the proof shows, or why there is none"),
    "certified_approximation": Variable("the certified number in double precision"),
    "certified_claim": Variable("claim of the paper whose number it is"),
}
# The parameters with which the numbers are those that the paper prints.
_TABLE_1 = 0.85
_DAMPINGS = (0.85, 0.65)
_APPARENT = {"n": 1, "restitution": 0.65, "amplitude": 1.2, "frequency_ratio": 1.0}
_THRESHOLDS = {"n": 1, "restitution": 0.65, "amplitude": 1.0, "tolerance": 0.01}

# The grid of ϖ in which the threshold is first sought in double precision.
_GRID = np.geomspace(1.0, 1e4, 101)


class ToleratedError(Parameters):
    """The orbit whose error decides the thresholds, and the error that is tolerated."""

    n: Family
    restitution: LossyRestitution
    amplitude: Amplitude
    tolerance: Tolerance


class Apparent(Parameters):
    """The orbit whose apparent restitution is certified."""

    n: Family
    restitution: LossyRestitution
    amplitude: Amplitude
    frequency_ratio: FrequencyRatio


class Proofs(Parameters):
    """The ends of stability ranges, the orbit of the thresholds, and a compliant orbit."""

    n: Many[Family]
    restitution: LossyRestitution
    frequency_ratio: Many[FrequencyRatio]
    thresholds: ToleratedError
    apparent: Apparent
    digits: Annotated[int, number("certified decimal digits of each number", ge=10, le=100)]


class CertifiedRow(NamedTuple):
    """One certified number; its ball, or the reason why there is none."""

    name: str
    ball: arb | None
    bits: int
    what: str
    claim: str


def _row(name: str, prove: Callable[[], CertifiedNumber], claim: str = "") -> CertifiedRow:
    try:
        found = prove()
    except ProofError as error:
        return CertifiedRow(name, None, 0, str(error), claim)
    return CertifiedRow(name, found.ball, found.bits, "; ".join(found.proved), claim)


def _claim(name: str, parameters: Parameters, printed: dict[str, float]) -> str:
    """The claim of this name, if the parameters are those of the printed number."""
    return name if parameters.model_dump() == printed else ""


def ends_of_table_1(parameters: Proofs) -> Iterator[CertifiedRow]:
    """The saddle-nodes and period doublings of all contacts and families."""
    certify = {Bifurcation.SADDLE_NODE: saddle_node, Bifurcation.PERIOD_DOUBLING: period_doubling}
    r = exactly(parameters.restitution)
    for ratio, n, kind in product(parameters.frequency_ratio, parameters.n, certify):
        problem = RationalProblem(exactly(ratio), r, n)

        def prove(problem: RationalProblem = problem, kind: Bifurcation = kind) -> CertifiedNumber:
            found = certify[kind](problem, parameters.digits)
            return CertifiedNumber(found.amplitude, found.bits, found.proved)

        name = f"Λ of the {kind}, ϖ = {ratio:g}, n = {n}"
        printed = f"Table 1: {ratio:g}, {n}, {kind}" if parameters.restitution == _TABLE_1 else ""
        yield _row(name, prove, printed)


def dampings(parameters: Proofs) -> Iterator[CertifiedRow]:
    """ζ of both restitution coefficients (Eq. 16)."""
    bits = working_bits(Fraction(1), parameters.digits)
    for r in (parameters.restitution, parameters.thresholds.restitution):

        def prove(r: float = r) -> CertifiedNumber:
            with precision(bits):
                return CertifiedNumber(damping_of(exactly(r)), bits, (Proved.FORMULA,))

        yield _row(f"ζ of r = {r:g}", prove, f"damping of {r:g}" if r in _DAMPINGS else "")


def certified_apparent(parameters: Apparent, digits: int) -> CertifiedRow:
    """The apparent restitution of an orbit at a given Λ."""
    ratio = exactly(parameters.frequency_ratio)
    r = exactly(parameters.restitution)
    lam = parameters.amplitude
    problem = RationalProblem(ratio, r, parameters.n)

    def prove() -> CertifiedNumber:
        found = certified_orbit(problem, exactly(lam), digits=digits)
        with precision(found.bits):
            ball = apparent_restitution(problem, found.excess)
        return CertifiedNumber(ball, found.bits, found.proved)

    name = (
        f"apparent restitution of r = {parameters.restitution:g}, ϖ = {float(ratio):g}, Λ = {lam:g}"
    )
    return _row(name, prove, _claim(f"compliant end of {lam:g}", parameters, _APPARENT))


def certified_thresholds(parameters: ToleratedError, digits: int) -> Iterator[CertifiedRow]:
    """The ϖ of Eq. 37, of the greatest height, and that of Eq. 38, of permanent contact."""
    yield _row(
        f"ϖ for {parameters.tolerance:.0%} of max height",
        lambda: _threshold_of_height(parameters, digits),
        _claim("height threshold", parameters, _THRESHOLDS),
    )
    r = exactly(parameters.restitution)
    tolerance = exactly(parameters.tolerance)
    yield _row(
        "ϖ of permanent contact",
        lambda: permanent_contact_threshold(r, tolerance, digits),
        _claim("permanent contact threshold", parameters, _THRESHOLDS),
    )


def _threshold_of_height(parameters: ToleratedError, digits: int) -> CertifiedNumber:
    """The threshold of the height, from that of double precision and the sign of its error."""
    zeta = damping_ratio(parameters.restitution)
    n = parameters.n
    lam = parameters.amplitude
    height = [Quantity.MAX_HEIGHT]
    found = search(
        zeta,
        Release.DISPLACEMENT,
        n=n,
        amplitude=lam,
        ratios=_GRID,
        tolerance=parameters.tolerance,
        quantities=height,
    )
    start = float(found.threshold[0, 0, 0])
    if not np.isfinite(start):
        raise ProofError("no threshold was found to start from")
    sign = int(np.sign(errors(SpringDamper(start, zeta), n, lam, height)[0, 0]))
    compared = ComparedOrbit(exactly(parameters.restitution), n, exactly(lam))
    return height_threshold(compared, sign * exactly(parameters.tolerance), start, digits)


def proofs(parameters: Proofs) -> xr.Dataset:
    """Certified numbers as decimal texts with their radii, over ``certificate``.

    ``certified_what`` says what was proved, or why nothing was; ``certified_claim`` is the name of
    the claim of the paper whose number it is, or empty.
    """
    digits = parameters.digits
    rows = [
        *ends_of_table_1(parameters),
        *dampings(parameters),
        certified_apparent(parameters.apparent, digits),
        *certified_thresholds(parameters.thresholds, digits),
    ]
    columns: dict[str, Any] = {name: [] for name in VARIABLES if name != "certificate"}
    for row in rows:
        text = radius = ""
        if row.ball is not None:
            with precision(row.bits):
                text, radius = decimal_with_bound(row.ball, digits)
        columns["certified"].append(text)
        columns["certified_radius"].append(radius)
        columns["certified_bits"].append(row.bits)
        columns["certified_what"].append(row.what)
        columns["certified_approximation"].append(float(text) if text else np.nan)
        columns["certified_claim"].append(row.claim)
    return described(
        {name: ("certificate", np.array(values)) for name, values in columns.items()},
        coords={"certificate": [row.name for row in rows]},
        variables=VARIABLES,
    )
