"""Certified thresholds: the frequency ratio ϖ at which an error of the restitution model is 1 %.

Two equations determine ε and ϖ: one for the orbit (its Λ, or the bifurcation), and one for the
error of a quantity (Eq. 37). A step of Krawczyk's method that maps a box into its own interior
proves that it contains exactly one solution. The damping ratio is fixed by r (Eq. 16). The
threshold of permanent contact (Eq. 38) follows from Eq. 34 in closed form.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from flint import arb, ctx

from bouncing_ball.beyond.proofs.branch import Contact, Point, point
from bouncing_ball.beyond.proofs.certificates import (
    Problem,
    ProofError,
    doubling_test,
    fold_test,
    precision,
    rational,
    working_bits,
)
from bouncing_ball.beyond.proofs.series import Series
from bouncing_ball.paper.orbits import spring_damper_bifurcations as double


@dataclass(frozen=True)
class Threshold:
    """A certified ϖ at which the error of a quantity has a given modulus, and its precision."""

    quantity: str
    frequency_ratio: arb
    bits: int


Condition = Callable[[Point], Series]
"""A function of an orbit that vanishes at the threshold."""


def height_condition(level: arb) -> Condition:
    """The apex of the flight is at a level."""
    return lambda orbit: orbit.top - level


def velocity_condition(level: arb) -> Condition:
    """The bouncing-off velocity z′_b has a value."""
    return lambda orbit: orbit.bounce_velocity - level


def phase_condition(level: arb) -> Condition:
    """The phase of impact has a value: (X, Y) is parallel to its direction."""
    sine, cosine = level.sin_cos()
    return lambda orbit: orbit.x * sine - orbit.y * cosine


def restitution_condition(level: arb) -> Condition:
    """The apparent restitution -δ′_b/u has a value (Eq. 17)."""
    return lambda orbit: orbit.rate + orbit.u * level


def amplitude_condition(level: arb) -> Condition:
    """Λ has a value."""
    return lambda orbit: orbit.square - level * level


CONDITIONS: dict[str, Callable[[arb], Condition]] = {
    "max_height": height_condition,
    "bounce_velocity": velocity_condition,
    "phase": phase_condition,
    "apparent_restitution": restitution_condition,
    "saddle_node": amplitude_condition,
    "period_doubling": amplitude_condition,
}
"""The condition at the threshold of each quantity, for the value that the quantity then has."""


def restitution_values(restitution: arb, n: int, amplitude: arb) -> dict[str, arb]:
    """The quantities of the restitution model (Eqs. 6-8, with the exact map's period doubling)."""
    r = restitution
    fold = n * arb.pi() * (1 - r) / (1 + r)
    phase = (fold / amplitude).acos()
    height = amplitude * phase.sin() + (n * arb.pi()) ** 2 / 2
    doubling = ((2 * (1 + r * r) / (1 + r) ** 2) ** 2 + fold * fold).sqrt()
    return {
        "max_height": height,
        "bounce_velocity": n * arb.pi(),
        "phase": phase,
        "apparent_restitution": r,
        "saddle_node": fold,
        "period_doubling": doubling,
    }


def error_threshold(
    quantity: str,
    restitution: Fraction,
    n: int,
    amplitude: Fraction,
    error: Fraction,
    start: float,
    digits: int = 30,
) -> Threshold:
    """The certified ϖ, near a start, at which the restitution model's error has a signed value.

    Parameters
    ----------
    quantity : str
        One of :data:`CONDITIONS`.
    restitution, amplitude : Fraction
        r in (0, 1), and Λ of the orbit; the bifurcations do not depend on Λ.
    n : int
    error : Fraction
        The signed error ``(q_SD - q)/q`` of Eq. 37, for example -1/100.
    start : float
        ϖ in double precision.

    Raises
    ------
    ProofError
        If no box around the start is proved to contain exactly one solution.
    """
    problem = Problem(Fraction(start), restitution=restitution, n=n)
    approximate = problem.approximate()
    if quantity in ("saddle_node", "period_doubling"):
        excess = float(getattr(double, quantity)(approximate, n))
    else:
        orbit = double.orbit_at(approximate, n, float(amplitude))
        excess = float(orbit.contact_duration) * float(approximate.damped_frequency)
        excess -= float(approximate.free_angle)
    bits = working_bits(problem, digits)
    with precision(bits):
        r = rational(restitution)
        square = rational(amplitude) ** 2
        wanted = restitution_values(r, n, rational(amplitude))[quantity]
        condition = CONDITIONS[quantity](wanted * (1 + rational(error)))
        zeta = problem.damping()

        def equations(box: list[arb]) -> tuple[Series, Series]:
            epsilon, ratio = (Series.variable(x, k, 2) for k, x in enumerate(box))
            contact = Contact(ratio, zeta, arb(0))
            if quantity == "saddle_node":
                first = fold_test(contact, n, epsilon)
            elif quantity == "period_doubling":
                first = doubling_test(contact, n, epsilon)
            else:
                first = point(contact, n, epsilon).square - square
            return first, condition(point(contact, n, epsilon))

        epsilon, ratio = certified_box(equations, [excess, start])
        found = point(Contact(ratio, zeta, arb(0)), n, epsilon)
        if quantity == "max_height" and not found.top > found.square.sqrt():
            raise ProofError("the ball may rise highest during the contact")
        return Threshold(quantity, ratio, bits)


Equations = Callable[[list[arb]], tuple[Series, Series]]
"""Two functions of two unknowns, as series about a box or a point."""

# Largest number of Newton steps with long numbers: each doubles the digits of the start.
_STEPS = 12
# The box of the proof is the last Newton step times these factors, tried in turn.
_WIDER = (2**8, 2**16, 2**24)


def certified_box(equations: Equations, start: list[float]) -> list[arb]:
    """A box that is proved to contain exactly one solution of two equations.

    Krawczyk's method: the image ``m - Y F(m) + (I - Y J(B)) (B - m)`` of a box B with midpoint m
    lies in its interior, where Y is an approximate inverse of the Jacobian and J(B) encloses the
    Jacobians at all points of B.

    Raises
    ------
    ProofError
        If Newton's method does not converge, or if no box is mapped into its interior.
    """
    middle = _solved(equations, [arb(x) for x in start])
    step, inverse = _newton_step(equations, middle)
    for factor in _WIDER:
        box = []
        for center, change in zip(middle, step, strict=True):
            radius = factor * (arb(change.abs_upper()) + _resolution(center))
            box.append((center - radius).union(center + radius))
        image = _krawczyk(equations, box, middle, step, inverse)
        if all(b.contains_interior(x) for b, x in zip(box, image, strict=True)):
            return image
    raise ProofError("no box around the solution is mapped into its interior")


def _solved(equations: Equations, middle: list[arb]) -> list[arb]:
    """The solution near a start by Newton's method, without a proof."""
    for _ in range(_STEPS):
        step, _ = _newton_step(equations, middle)
        if not all(change.is_finite() for change in step):
            raise ProofError("Newton's method met a singular point")
        middle = [arb((m - change).mid()) for m, change in zip(middle, step, strict=True)]
        pairs = zip(step, middle, strict=True)
        if all(change.abs_upper() < _resolution(center) for change, center in pairs):
            return middle
    raise ProofError("Newton's method did not converge from the start of double precision")


def _newton_step(equations: Equations, middle: list[arb]) -> tuple[list[arb], list[list[arb]]]:
    """The step Y F(m), and the approximate inverse Y of the Jacobian."""
    values, slopes = _linearised(equations(middle))
    inverse = _inverse([[arb(x.mid()) for x in row] for row in slopes])
    return [_scalar_product(row, values) for row in inverse], inverse


def _krawczyk(
    equations: Equations,
    box: list[arb],
    middle: list[arb],
    step: list[arb],
    inverse: list[list[arb]],
) -> list[arb]:
    """The image of a box under Krawczyk's operator."""
    _, slopes = _linearised(equations(box))
    away = [b - m for b, m in zip(box, middle, strict=True)]
    image = []
    for k in (0, 1):
        contraction = []
        for j in (0, 1):
            column = [slopes[0][j], slopes[1][j]]
            contraction.append((1 if k == j else 0) - _scalar_product(inverse[k], column))
        image.append(middle[k] - step[k] + _scalar_product(contraction, away))
    return image


def _resolution(center: arb) -> arb:
    """The size of a Newton step after which rounding dominates."""
    return (abs(center) + 1) * arb(2) ** (-ctx.prec * 3 // 4)


def _scalar_product(left: list[arb], right: list[arb]) -> arb:
    """The scalar product of two pairs."""
    return left[0] * right[0] + left[1] * right[1]


def _linearised(found: tuple[Series, Series]) -> tuple[list[arb], list[list[arb]]]:
    values = [f.value for f in found]
    return values, [[f.coefficient(1, 0), f.coefficient(0, 1)] for f in found]


def _inverse(rows: list[list[arb]]) -> list[list[arb]]:
    (a, b), (c, d) = rows
    volume = a * d - b * c
    inverse = [[d / volume, -b / volume], [-c / volume, a / volume]]
    return [[arb(x.mid()) for x in row] for row in inverse]


def permanent_contact_threshold(
    restitution: Fraction, tolerance: Fraction, digits: int = 30
) -> Threshold:
    """The largest ϖ at which Λ_SD is below 1 by a tolerance (Eqs. 34 and 38), in closed form.

    Λ_SD² = 1 - 2(1 - 2ζ²) t + t² with t = 1/ϖ² rises with ϖ above its minimum, so that the smaller
    root t of ``Λ_SD = 1 - tolerance`` is the largest ϖ.

    Raises
    ------
    ProofError
        If Λ_SD is nowhere below 1 by this tolerance.
    """
    problem = Problem(Fraction(10), restitution=restitution)
    bits = working_bits(problem, digits)
    with precision(bits):
        zeta = problem.damping()
        level = 1 - rational(tolerance)
        half = 1 - 2 * zeta * zeta
        inside = half * half - 1 + level * level
        if not inside > 0 or not half > 0:
            raise ProofError("Λ_SD is not proved to fall so far below 1")
        square = half - inside.sqrt()
        return Threshold("permanent_contact", (1 / square).sqrt(), bits)


def permanent_contact_minimum(damping: Problem, digits: int = 30) -> arb:
    """The smallest Λ_SD over ϖ, 2ζ√(1 - ζ²) (Eq. 36), as a ball."""
    with precision(working_bits(damping, digits)):
        zeta = damping.damping()
        return 2 * zeta * (1 - zeta * zeta).sqrt()
