"""Certificates: a bifurcation, or an orbit at a given Λ, in a ball that contains exactly one.

A search in double precision gives a start, and an interval Newton step the proof of existence and
uniqueness (:mod:`bouncing_ball_beyond.proofs.newton`). The functions ``*_properties`` then prove
for the ball what else belongs to a bifurcation or to an orbit.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from typing import Any

from flint import arb

from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import spring_damper_bifurcations as double
from bouncing_ball_beyond.proofs.admissibility import contact_holds, flight_is_free
from bouncing_ball_beyond.proofs.balls import (
    NoStartError,
    ProofError,
    decimal_with_bound,
    precision,
    rational,
)
from bouncing_ball_beyond.proofs.branch import EnclosedContact, Point, point
from bouncing_ball_beyond.proofs.newton import certified_zero
from bouncing_ball_beyond.proofs.problem import RationalProblem, working_bits
from bouncing_ball_beyond.proofs.series import Series

# Precision of the proofs that a function keeps its sign, which need no digits.
_COARSE = 80


class Proved(StrEnum):
    """A property that a certificate proves."""

    UNIQUE = "exactly one solution"
    FOLD = "quadratic fold"
    CROSSING = "multiplier crosses -1"
    INSIDE = "other multiplier inside the unit circle"
    STABLE = "both multipliers inside the unit circle"
    ADMISSIBLE = "admissible"
    FALLS = "the error falls through the tolerance"
    ONLY = "the error stays below at every larger ϖ"
    FORMULA = "value of a closed formula"


@dataclass(frozen=True)
class Certificate:
    """A proved orbit: balls of ε and of the orbit's numbers, and what was proved.

    ``amplitude`` is the ball of Λ, ``bits`` the precision with which it was computed.
    """

    excess: arb
    orbit: Point
    amplitude: arb
    proved: tuple[Proved, ...]
    bits: int

    def texts(self, digits: int = 30) -> tuple[str, str]:
        """Λ as a decimal number of so many digits, and a bound of its error, as texts."""
        with precision(self.bits):
            return decimal_with_bound(self.amplitude, digits)


# The equations that vanish at a bifurcation, as series in ε of order 1.


def fold_test(contact: EnclosedContact, n: int, excess: Series) -> Series:
    """½ dΛ²/dε."""
    return point(contact, n, excess).square.derivative() / 2


def doubling_test(contact: EnclosedContact, n: int, excess: Series) -> Series:
    """1 + tr + det, from ``1 - tr + det = -(det A/(u δ′_b)) ½ dΛ²/dD`` (docs/closed-form.md)."""
    found = point(contact, n, excess)
    factor = found.matrix * contact.damped / (found.u * found.rate)
    along = found.square.derivative() / 2
    determinant = (-2 * contact.decay * found.duration).exp()
    return 2 * (determinant.truncated(along.order) + 1) + factor.truncated(along.order) * along


# The certificates.


def saddle_node(problem: RationalProblem, digits: int = 30) -> Certificate:
    """The certified saddle-node of the family.

    Raises
    ------
    ProofError
        If no saddle-node is found, or if a part of the proof fails; the message names it.
    """
    start = _start(problem, double.saddle_node, "saddle-node")
    return _certified(problem, digits, fold_test, start, saddle_node_properties, "saddle-node")


def period_doubling(problem: RationalProblem, digits: int = 30) -> Certificate:
    """The certified period doubling nearest to the saddle-node.

    Raises
    ------
    ProofError
        If no period doubling is found, or if a part of the proof fails; the message names it.
    """
    what = "period doubling"
    start = _start(problem, double.period_doubling, what)
    return _certified(problem, digits, doubling_test, start, period_doubling_properties, what)


def certified_orbit(problem: RationalProblem, amplitude: Fraction, digits: int = 30) -> Certificate:
    """The certified orbit at a rational Λ, on the stable side of the saddle-node.

    Raises
    ------
    ProofError
        If no orbit is found there, or if a part of the proof fails; the message names it.
    """
    start = orbit_start(problem.approximate(), problem.n, float(amplitude))

    def test(contact: EnclosedContact, n: int, excess: Series) -> Series:
        return (point(contact, n, excess).square - rational(amplitude) ** 2).truncated(1)

    what = f"orbit at Λ = {amplitude}"
    return _certified(problem, digits, test, start, orbit_properties, what)


Test = Callable[[EnclosedContact, int, Series], Series]
"""A function of the branch that vanishes at the solution, as a series in ε of order 1."""

Properties = Callable[[EnclosedContact, int, arb], list[Proved]]
"""What is proved for all orbits whose ε lies in a ball; a :class:`ProofError` if that fails."""


def _certified(
    problem: RationalProblem,
    digits: int,
    test: Test,
    start: float,
    properties: Properties,
    what: str,
) -> Certificate:
    bits = working_bits(problem.frequency_ratio, digits)
    with precision(bits):
        contact = problem.contact()
        try:
            excess = certified_zero(lambda e: test(contact, problem.n, e), start)
            proved = properties(contact, problem.n, excess)
            orbit = point(contact, problem.n, excess)
            amplitude = _amplitude(orbit)
        except ProofError as error:
            raise ProofError(f"the {what} is not certified: {error}") from error
        return Certificate(excess, orbit, amplitude, (Proved.UNIQUE, *proved), bits)


def _amplitude(orbit: Point) -> arb:
    found = orbit.square.sqrt()
    if not found.is_finite() or found.contains(0):
        raise ProofError("Λ may be 0 or infinite")
    return found


def _start(problem: RationalProblem, search: Callable, what: str) -> float:
    found = float(search(problem.approximate(), problem.n))
    if not math.isfinite(found):
        raise NoStartError(f"no {what} of the {problem.n}-T orbit was found to start from")
    return found


def orbit_start(contact: SpringDamper, n: int, amplitude: float) -> float:
    """The excess angle ε of the orbit at Λ in double precision.

    Raises
    ------
    NoStartError
        If there is no such orbit.
    """
    found = double.orbit_at(contact, n, amplitude)
    excess = found.contact_duration * contact.damped_frequency - contact.free_angle
    if not math.isfinite(float(excess)):
        raise NoStartError(f"no {n}-T orbit was found at Λ = {amplitude:g} to start from")
    return float(excess)


# What is proved for a ball that contains exactly one solution.


def saddle_node_properties(contact: EnclosedContact, n: int, excess: arb) -> list[Proved]:
    """The properties of a saddle-node, where one multiplier is 1: a quadratic fold of Λ."""
    orbit = point(contact, n, excess)
    _require_regular(orbit)
    if fold_test(contact, n, Series.variable(excess, 0, 2)).coefficient(1, 0).contains(0):
        raise ProofError("the second derivative of Λ² along the branch may vanish")
    _require_admissible(contact, orbit)
    return [Proved.FOLD, _other_multiplier(contact, orbit), Proved.ADMISSIBLE]


def period_doubling_properties(contact: EnclosedContact, n: int, excess: arb) -> list[Proved]:
    """The properties of a period doubling: a multiplier crosses -1."""
    orbit = point(contact, n, excess)
    _require_regular(orbit)
    series = Series.variable(excess, 0, 2)
    # The slopes of 1 + tr + det and of Λ² along the branch; their ratio is the speed of crossing.
    speed = doubling_test(contact, n, series).coefficient(1, 0)
    if speed.contains(0) or fold_test(contact, n, series).value.contains(0):
        raise ProofError("the multiplier may touch -1 without crossing it")
    inside = _other_multiplier(contact, orbit)
    _require_admissible(contact, orbit)
    return [inside, Proved.CROSSING, Proved.ADMISSIBLE]


def orbit_properties(contact: EnclosedContact, n: int, excess: arb) -> list[Proved]:
    """The properties of an orbit: admissible, and stable if that is certain."""
    orbit = point(contact, n, excess)
    _require_regular(orbit)
    _require_admissible(contact, orbit)
    determinant = _determinant(contact, orbit)
    plus = doubling_test(contact, n, Series.variable(excess, 0, 1)).value
    minus = 2 * (1 + determinant) - plus
    if plus > 0 and minus > 0 and determinant < 1:
        return [Proved.STABLE, Proved.ADMISSIBLE]
    return [Proved.ADMISSIBLE]


def _determinant(contact: EnclosedContact, orbit: Point) -> Any:
    """The product of both multipliers, exp(-2ζϖD)."""
    return (-2 * contact.decay * orbit.duration).exp()


def _other_multiplier(contact: EnclosedContact, orbit: Point) -> Proved:
    """Check that the product of both multipliers, of which one is 1 or -1, is below 1."""
    if not _determinant(contact, orbit) < 1:
        raise ProofError("the other multiplier may lie on the unit circle")
    return Proved.INSIDE


def _require_regular(orbit: Point) -> None:
    """Check that an orbit is no pole, does not graze, and has a contact and a flight."""
    checks = {
        "the linear system of the branch may be singular": not orbit.matrix.contains(0),
        "the contact's duration may vanish": bool(orbit.duration > 0),
        "the flight time may vanish": bool(orbit.flight > 0),
        "the ball may not approach the table at the impact": bool(orbit.u < 0),
        "the ball may not leave the table at the release": bool(orbit.rate > 0),
    }
    for reason, holds in checks.items():
        if not holds:
            raise ProofError(f"{reason}: the orbit is not proved to be regular")


def _require_admissible(contact: EnclosedContact, orbit: Point) -> None:
    with precision(_COARSE):
        admissible = contact_holds(contact, orbit) and flight_is_free(orbit)
    if not admissible:
        raise ProofError(
            "an earlier release or impact is not excluded: the orbit may be inadmissible"
        )
