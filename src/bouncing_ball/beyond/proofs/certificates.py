"""Certificates: a bifurcation, or an orbit at a given Λ, in a ball that contains exactly one.

A search in double precision gives a start, Newton's method with long numbers a midpoint, and an
interval Newton step the proof: if the step ``m - F(m)/F′(I)`` of a ball I with midpoint m lies
in the interior of I, the ball contains exactly one zero of F. The derivative F′(I) encloses the
derivatives at all points of the ball.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction

from flint import arb, ctx, fmpq

from bouncing_ball.beyond.proofs.admissibility import contact_holds, flight_is_free
from bouncing_ball.beyond.proofs.branch import Contact, Point, point
from bouncing_ball.beyond.proofs.return_map import ReturnMap, flip_coefficient, return_map
from bouncing_ball.beyond.proofs.series import Series
from bouncing_ball.errors import ModelError
from bouncing_ball.paper.contact.damping import Release
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.orbits import spring_damper_bifurcations as double
from bouncing_ball.paper.orbits.stability import Side

# Bits beyond the requested digits and those that stiff contacts cost by cancellation,
# about log2(ϖ²). With so many the ball is far narrower than the last decimal digit, so that the
# decimal number and its error are the same whatever the double precision of the start.
_GUARD = 160
# Largest number of Newton steps with long numbers: each doubles the digits of the start.
_STEPS = 12
# The ball of the proof is the last Newton step times these factors, tried in turn.
_WIDER = (2**8, 2**16, 2**24)
# Precision of the proofs that a function keeps its sign, which need no digits.
_COARSE = 80


class ProofError(ModelError):
    """A number or an orbit cannot be certified; the message gives the reason."""


class Proved(StrEnum):
    """A property that a certificate proves."""

    UNIQUE = "exactly one solution"
    FOLD = "quadratic fold"
    CROSSING = "multiplier crosses -1"
    INSIDE = "other multiplier inside the unit circle"
    SUPERCRITICAL = "supercritical"
    SUBCRITICAL = "subcritical"
    ADMISSIBLE = "admissible"


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
            return decimal(self.amplitude, digits)


def decimal(ball: arb, digits: int) -> tuple[str, str]:
    """A decimal number near the middle of a ball, and a bound of its distance to the ball's points.

    Examples
    --------
    >>> with precision(100):
    ...     text, radius = decimal(arb(2).sqrt(), 20)
    >>> text, float(radius) < 1e-19
    ('1.4142135623730950488', True)
    """
    text = arb(ball.mid()).str(digits, radius=False)
    # Twice the bound covers the rounding of its text to three digits.
    error = 2 * (arb(text) - ball).abs_upper()
    return text, arb(error).str(3, radius=False)


class precision:
    """The number of bits of all balls within a ``with`` block."""

    def __init__(self, bits: int) -> None:
        self.bits = bits

    def __enter__(self) -> None:
        self.before = ctx.prec
        ctx.prec = self.bits

    def __exit__(self, *_: object) -> None:
        ctx.prec = self.before


@dataclass(frozen=True)
class Problem:
    """A contact with rational parameters and a family of orbits.

    Parameters
    ----------
    frequency_ratio : Fraction
        ϖ > 0.
    restitution, damping_ratio : Fraction, optional
        One of r in (0, 1) (Eq. 16) and ζ in [0, 1).
    n : int
        Index of the family.
    release : Release

    Raises
    ------
    ProofError
        If a parameter is outside its range, or if not one of r and ζ is given.
    """

    frequency_ratio: Fraction
    restitution: Fraction | None = None
    damping_ratio: Fraction | None = None
    n: int = 1
    release: Release = Release.DISPLACEMENT

    def __post_init__(self) -> None:
        if (self.restitution is None) == (self.damping_ratio is None):
            raise ProofError("give either the restitution r or the damping ratio ζ")
        if self.frequency_ratio <= 0:
            raise ProofError(f"frequency ratio ϖ = {self.frequency_ratio} must be above 0")
        if self.n < 1:
            raise ProofError(f"index of the family n = {self.n} must be at least 1")
        if self.restitution is not None and not 0 < self.restitution < 1:
            raise ProofError(
                f"restitution r = {self.restitution} must lie between 0 and 1: without dissipation "
                "both multipliers of a saddle-node are 1, and nothing is proved"
            )
        if self.damping_ratio is not None and not 0 < self.damping_ratio < 1:
            raise ProofError(
                f"damping ratio ζ = {self.damping_ratio} must lie between 0 and 1: without "
                "dissipation both multipliers of a saddle-node are 1, and nothing is proved"
            )

    def damping(self) -> arb:
        """ζ as a ball (Eq. 16)."""
        if self.damping_ratio is not None:
            return rational(self.damping_ratio)
        decrement = -rational(self.restitution).log()
        return decrement / (arb.pi() ** 2 + decrement**2).sqrt()

    def contact(self) -> Contact:
        """The contact with balls as parameters, at the present precision."""
        zeta = self.damping()
        sine = zeta if self.release is Release.FORCE else arb(0)
        return Contact(rational(self.frequency_ratio), zeta, sine)

    def approximate(self) -> SpringDamper:
        """The contact in double precision."""
        return SpringDamper(float(self.frequency_ratio), float(self.damping().mid()), self.release)


def exactly(number: float) -> Fraction:
    """The fraction that the shortest decimal text of a number means.

    Examples
    --------
    >>> exactly(0.85)
    Fraction(17, 20)
    """
    return Fraction(repr(float(number)))


def rational(value: Fraction | None) -> arb:
    assert value is not None
    return arb(fmpq(value.numerator, value.denominator))


Test = Callable[[Contact, int, Series], Series]
"""A function of the branch that vanishes at the solution, as a series in ε of order 1."""


def fold_test(contact: Contact, n: int, excess: Series) -> Series:
    """½ dΛ²/dε."""
    return point(contact, n, excess).square.derivative() / 2


def doubling_test(contact: Contact, n: int, excess: Series) -> Series:
    """1 + tr + det, from ``1 - tr + det = -(det A/(u R_D)) ½ dΛ²/dD`` (docs/closed-form.md)."""
    found = point(contact, n, excess)
    x = found.x
    y = found.y
    sine, cosine = found.duration.sin_cos()
    acceleration = contact.acceleration(found.gap, found.rate, x * sine + y * cosine)
    pace = found.rate + contact.lag * acceleration
    factor = found.matrix * contact.damped / (found.u * pace)
    along = found.square.derivative() / 2
    determinant = (-2 * contact.decay * found.duration).exp()
    return 2 * (determinant.truncated(along.order) + 1) + factor.truncated(along.order) * along


def saddle_node(problem: Problem, digits: int = 30) -> Certificate:
    """The certified saddle-node of the family.

    Raises
    ------
    ProofError
        If no saddle-node is found, or if a part of the proof fails; the message names it.
    """
    start = _start(problem, double.saddle_node, "saddle-node")
    bits = working_bits(problem, digits)
    with precision(bits):
        contact = problem.contact()
        excess = certified_zero(lambda e: fold_test(contact, problem.n, e), start)
        # The derivative of ½ dΛ²/dε is not 0 on the ball, because its reciprocal was used.
        orbit = point(contact, problem.n, excess)
        proved = [Proved.UNIQUE, Proved.FOLD, *_regular(contact, orbit)]
        _require_multiplier(contact, orbit, return_map(contact, orbit, 1), 1)
        return _certificate(contact, excess, orbit, proved, bits)


def period_doubling(problem: Problem, digits: int = 30) -> Certificate:
    """The certified period doubling nearest to the saddle-node, with its criticality.

    Raises
    ------
    ProofError
        If no period doubling is found, or if a part of the proof fails; the message names it.
    """
    start = _start(problem, double.period_doubling, "period doubling")
    bits = working_bits(problem, digits)
    with precision(bits):
        contact = problem.contact()
        excess = certified_zero(lambda e: doubling_test(contact, problem.n, e), start)
        orbit = point(contact, problem.n, excess)
        proved = [Proved.UNIQUE, *_regular(contact, orbit)]
        along = fold_test(contact, problem.n, Series.variable(excess, 0, 2)).value
        if along.contains(0):
            raise ProofError("Λ may turn at the period doubling: its crossing is not proved")
        proved.append(Proved.CROSSING)
        proved.append(criticality(contact, orbit))
        return _certificate(contact, excess, orbit, proved, bits)


def criticality(contact: Contact, orbit: Point) -> Proved:
    """Whether a period doubling is super- or subcritical.

    Raises
    ------
    ProofError
        If the sign of the coefficient is not certain.
    """
    found = return_map(contact, orbit)
    determinant = _require_multiplier(contact, orbit, found, -1)
    coefficient = flip_coefficient(found, determinant)
    if coefficient > 0:
        return Proved.SUPERCRITICAL
    if coefficient < 0:
        return Proved.SUBCRITICAL
    raise ProofError("the sign of the period doubling's cubic coefficient is not certain")


def _require_multiplier(contact: Contact, orbit: Point, found: ReturnMap, multiplier: int) -> arb:
    """The determinant, after a check that the return map has it and the multiplier 1 or -1.

    The return map is a second derivation: it shares only the flow with the equations of the branch.
    """
    determinant = (-2 * contact.decay * orbit.duration).exp()
    (a, b), (c, d) = found.monodromy
    if not (a * d - b * c).overlaps(determinant):
        raise ProofError("the return map contradicts the determinant exp(-2ζϖD)")
    if not (1 - multiplier * (a + d) + determinant).contains(0):
        raise ProofError(f"the return map contradicts the multiplier {multiplier}")
    return determinant


def orbit_at(
    problem: Problem, amplitude: Fraction, side: str = "stable", digits: int = 30
) -> Certificate:
    """The certified orbit at a rational Λ, on one side of the saddle-node.

    Raises
    ------
    ProofError
        If no orbit is found there, or if a part of the proof fails; the message names it.
    """
    approximate = problem.approximate()
    found = double.orbit_at(approximate, problem.n, float(amplitude), Side(side))
    start = float(found.contact_duration) * float(approximate.damped_frequency)
    start -= float(approximate.free_angle)
    if not math.isfinite(start):
        raise ProofError(f"no {problem.n}-T orbit was found at Λ = {amplitude} to start from")
    bits = working_bits(problem, digits)
    with precision(bits):
        contact = problem.contact()
        square = rational(amplitude) ** 2

        def test(excess: Series) -> Series:
            return (point(contact, problem.n, excess).square - square).truncated(1)

        excess = certified_zero(test, start)
        orbit = point(contact, problem.n, excess)
        proved = [Proved.UNIQUE, *_regular(contact, orbit, multiplier=False)]
        return _certificate(contact, excess, orbit, proved, bits)


def certified_zero(test: Callable[[Series], Series], start: float) -> arb:
    """A ball that is proved to contain exactly one zero of a function, near a start.

    Raises
    ------
    ProofError
        If Newton's method does not converge, or if no ball is mapped into its own interior.
    """
    middle = arb(start)
    step = arb(1)
    for _ in range(_STEPS):
        found = test(Series.variable(middle, 0, 2))
        step = found.value / found.coefficient(1, 0)
        if not step.is_finite():
            raise ProofError("Newton's method met a singular point of the branch")
        middle = arb((middle - step).mid())
        if step.abs_upper() < _resolution(middle):
            break
    else:
        raise ProofError("Newton's method did not converge from the start of double precision")
    value = test(Series.variable(middle, 0, 2)).value
    least = arb(step.abs_upper()) + arb(value.abs_upper()) + _resolution(middle)
    for factor in _WIDER:
        radius = least * factor
        ball = (middle - radius).union(middle + radius)
        slope = test(Series.variable(ball, 0, 2)).coefficient(1, 0)
        if not slope.is_finite() or slope.contains(0):
            continue
        image = middle - value / slope
        if ball.contains_interior(image):
            return image
    raise ProofError(
        "no ball around the solution is mapped into its interior: it may be a tangency"
    )


def _resolution(middle: arb) -> arb:
    """The size of a Newton step after which rounding dominates."""
    return (abs(middle) + 1) * arb(2) ** (-ctx.prec * 3 // 4)


def working_bits(problem: Problem, digits: int) -> int:
    stiff = max(1.0, float(problem.frequency_ratio))
    wanted = digits * math.log2(10) + 2 * math.log2(stiff)
    return math.ceil((wanted + _GUARD) * 4 / 3)


def _start(problem: Problem, search: Callable, what: str) -> float:
    found = float(search(problem.approximate(), problem.n))
    if not math.isfinite(found):
        raise ProofError(f"no {what} of the {problem.n}-T orbit was found to start from")
    return found


def _regular(contact: Contact, orbit: Point, *, multiplier: bool = True) -> list[Proved]:
    """Check that an orbit is no pole and does not graze, and that the determinant is below 1."""
    checks = {
        "the linear system of the branch may be singular": not orbit.matrix.contains(0),
        "the ball may not approach the table at the impact": bool(orbit.u < 0),
        "the flight time may vanish": bool(orbit.flight > 0),
        "the ball may not leave the table at the release": bool(orbit.rate > 0),
    }
    for reason, holds in checks.items():
        if not holds:
            raise ProofError(f"{reason}: the orbit is not proved to be regular")
    if not multiplier:
        return []
    if not (contact.decay * orbit.duration > 0):
        raise ProofError("the other multiplier may lie on the unit circle")
    return [Proved.INSIDE]


def _certificate(
    contact: Contact, excess: arb, orbit: Point, proved: list[Proved], bits: int
) -> Certificate:
    with precision(_COARSE):
        admissible = contact_holds(contact, orbit) and flight_is_free(contact, orbit)
    if not admissible:
        raise ProofError(
            "an earlier release or impact is not excluded: the orbit may be inadmissible"
        )
    amplitude = orbit.square.sqrt()
    if not amplitude.is_finite() or amplitude.contains(0):
        raise ProofError("Λ may be 0 or infinite")
    return Certificate(excess, orbit, amplitude, (*proved, Proved.ADMISSIBLE), bits)
