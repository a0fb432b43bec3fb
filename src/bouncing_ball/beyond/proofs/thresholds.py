"""Certified thresholds: the frequency ratio ϖ at which an error of a simple model has a value.

Two equations determine ε and ϖ: one for the orbit (its Λ, or the bifurcation), and one for the
error of a quantity (Eq. 37). A step of Krawczyk's method proves that a box contains exactly one
solution. The damping ratio is fixed by r (Eq. 16), and the contact ends with the displacement
release. The threshold of permanent contact (Eq. 38) follows from Eq. 34 in closed form.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from flint import arb

from bouncing_ball.beyond.proofs.balls import ProofError, precision, rational
from bouncing_ball.beyond.proofs.branch import EnclosedContact, Point, point
from bouncing_ball.beyond.proofs.certificates import (
    Properties,
    Proved,
    doubling_test,
    fold_test,
    orbit_properties,
    orbit_start,
    period_doubling_properties,
    saddle_node_properties,
)
from bouncing_ball.beyond.proofs.newton import certified_box
from bouncing_ball.beyond.proofs.problem import RationalProblem, damping_of, working_bits
from bouncing_ball.beyond.proofs.series import Series, angle
from bouncing_ball.beyond.proofs.simple_models import SimpleModel
from bouncing_ball.periodic.one_impact import spring_damper_bifurcations as double


@dataclass(frozen=True)
class CertifiedNumber:
    """A certified number: its ball, the precision in bits, and what was proved."""

    ball: arb
    bits: int
    proved: tuple[Proved, ...]


@dataclass(frozen=True)
class Comparison:
    """A quantity whose relative error ``(q_SD - q)/q`` of a simple model is followed along ϖ.

    Parameters
    ----------
    quantity : str
        One of :data:`MEASURED`.
    restitution, amplitude : Fraction
        r in (0, 1), and Λ of the orbit; the bifurcations do not depend on Λ.
    n : int
    corrected : bool
        Whether the simple model is the corrected one, and not the restitution model.
    """

    quantity: str
    restitution: Fraction
    n: int
    amplitude: Fraction
    corrected: bool = False

    def error(self, contact: EnclosedContact, orbit: Point) -> Series:
        """The signed error of Eq. 37 for an orbit of the contact."""
        make = SimpleModel.corrected if self.corrected else SimpleModel.restitution_model
        simple = make(contact, rational(self.restitution), self.n)
        wanted = getattr(simple, self.quantity)(rational(self.amplitude))
        return MEASURED[self.quantity](orbit) / wanted - 1

    def condition(self, contact: EnclosedContact, excess: Series) -> Series:
        """The function that vanishes on the orbits that are compared."""
        if self.quantity == "saddle_node":
            return fold_test(contact, self.n, excess)
        if self.quantity == "period_doubling":
            return doubling_test(contact, self.n, excess)
        return point(contact, self.n, excess).square - rational(self.amplitude) ** 2

    @property
    def properties(self) -> Properties:
        """What else is proved for the orbits that are compared."""
        if self.quantity == "saddle_node":
            return saddle_node_properties
        if self.quantity == "period_doubling":
            return period_doubling_properties
        return orbit_properties

    def start(self, frequency_ratio: float) -> float:
        """The excess angle of the orbit at this ϖ in double precision."""
        problem = RationalProblem(Fraction(frequency_ratio), restitution=self.restitution, n=self.n)
        approximate = problem.approximate()
        if self.quantity in ("saddle_node", "period_doubling"):
            return float(getattr(double, self.quantity)(approximate, self.n))
        return orbit_start(approximate, self.n, float(self.amplitude))


MEASURED: dict[str, Callable[[Point], Series]] = {
    "max_height": lambda orbit: orbit.top,
    "bounce_velocity": lambda orbit: orbit.bounce_velocity,
    "phase": lambda orbit: angle(orbit.x, orbit.y),
    "apparent_restitution": lambda orbit: -orbit.rate / orbit.u,
    "saddle_node": lambda orbit: orbit.square.sqrt(),
    "period_doubling": lambda orbit: orbit.square.sqrt(),
}
"""The quantities of Eq. 37 as functions of an orbit of the contact."""


def error_threshold(
    comparison: Comparison, error: Fraction, start: float, digits: int = 30
) -> CertifiedNumber:
    """The certified ϖ, near a start, at which the error of a simple model has a signed value.

    ``error`` is the value, for example -1/100, and 0 where the error changes its sign; ``start`` is
    ϖ in double precision.

    Raises
    ------
    ProofError
        If no box around the start is proved to contain exactly one solution, if the orbit there is
        not certified, or if the modulus of the error does not fall with rising ϖ.
    """
    bits = working_bits(Fraction(start), digits)
    with precision(bits):
        value = rational(error)
        zeta = damping_of(comparison.restitution)

        def equations(box: list[arb]) -> tuple[Series, Series]:
            epsilon, ratio = (Series.variable(x, k, 2) for k, x in enumerate(box))
            contact = EnclosedContact(ratio, zeta, arb(0))
            first = comparison.condition(contact, epsilon)
            second = comparison.error(contact, point(contact, comparison.n, epsilon)) - value
            return first, second

        box = certified_box(equations, [comparison.start(start), start])
        epsilon, ratio = box
        contact = EnclosedContact(ratio, zeta, arb(0))
        proved = comparison.properties(contact, comparison.n, epsilon)
        if comparison.quantity == "max_height":
            _require_apex(point(contact, comparison.n, epsilon))
        crossing = _crossing(*equations(box), error)
        return CertifiedNumber(ratio, bits, (Proved.UNIQUE, crossing, *proved))


def _crossing(orbit: Series, error: Series, value: Fraction) -> Proved:
    """How the error passes its value: its derivative with respect to ϖ along the orbits."""
    along = orbit.coefficient(1, 0)
    volume = error.coefficient(0, 1) * along - error.coefficient(1, 0) * orbit.coefficient(0, 1)
    slope = volume / along
    if value == 0 and not slope.contains(0):
        return Proved.SIGN
    if rational(value) * slope < 0:
        return Proved.FALLS
    raise ProofError("the modulus of the error is not proved to fall with rising ϖ")


def _require_apex(orbit: Point) -> None:
    """Check that the apex lies in the flight and above the table's largest height.

    During the contact the ball is below the level of the table, which never exceeds Λ.
    """
    rise = orbit.bounce_velocity
    if not (rise > 0 and rise < orbit.flight and orbit.top > orbit.square.sqrt()):
        raise ProofError("the apex of the flight is not proved to be the greatest height")


def apparent_restitution(problem: RationalProblem, excess: arb) -> arb:
    """The apparent restitution -δ′_b/δ′ (Eq. 17) of a certified orbit."""
    orbit = point(problem.contact(), problem.n, excess)
    return -orbit.rate / orbit.u


def permanent_contact_threshold(
    restitution: Fraction, tolerance: Fraction, digits: int = 30
) -> CertifiedNumber:
    """The largest ϖ at which Λ_SD is below 1 by a tolerance (Eqs. 34 and 38), in closed form.

    Λ_SD² = 1 - 2(1 - 2ζ²) t + t² with t = 1/ϖ² falls with t below its minimum at 1 - 2ζ², so that
    the smaller root t of ``Λ_SD = 1 - tolerance`` is the largest ϖ, and the error is smaller at
    every larger one.

    Raises
    ------
    ProofError
        If Λ_SD is nowhere below 1 by this tolerance.
    """
    bits = working_bits(Fraction(1), digits)
    with precision(bits):
        half = _least_at(restitution)
        level = 1 - rational(tolerance)
        inside = half * half - 1 + level * level
        if not (inside > 0 and level > 0 and level < 1):
            raise ProofError("Λ_SD is not proved to fall so far below 1")
        square = half - inside.sqrt()
        ratio = (1 / square).sqrt()
        return CertifiedNumber(ratio, bits, (Proved.UNIQUE, Proved.FALLS, Proved.ONLY))


def permanent_contact_minimum(restitution: Fraction, digits: int = 30) -> CertifiedNumber:
    """The smallest Λ_SD over ϖ, 2ζ√(1 - ζ²) (Eq. 36, Fig. 11).

    Raises
    ------
    ProofError
        If Λ_SD has no minimum at a finite ϖ.
    """
    bits = working_bits(Fraction(1), digits)
    with precision(bits):
        _least_at(restitution)
        zeta = damping_of(restitution)
        return CertifiedNumber(2 * zeta * (1 - zeta * zeta).sqrt(), bits, (Proved.LEAST,))


def _least_at(restitution: Fraction) -> arb:
    """1 - 2ζ², the value of 1/ϖ² at which Λ_SD is least."""
    zeta = damping_of(restitution)
    least = 1 - 2 * zeta * zeta
    if not least > 0:
        raise ProofError("Λ_SD has no minimum at a finite ϖ, because ζ ≥ 1/√2")
    return least
