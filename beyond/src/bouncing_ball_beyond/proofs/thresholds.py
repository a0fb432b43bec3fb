"""Certified numbers of the comparison of both models: the printed thresholds of Eqs. 37 and 38.

Two equations determine ε and ϖ where the error of the greatest height has a given value: one for
the Λ of the orbit, and one for the error (Eq. 37). A step of Krawczyk's method proves that a box
contains exactly one solution. The damping ratio is fixed by r (Eq. 16). The threshold of permanent
contact (Eq. 38) follows from Eq. 34 in closed form.
"""

from dataclasses import dataclass
from fractions import Fraction

from flint import arb

from bouncing_ball_beyond.proofs.balls import ProofError, precision, rational
from bouncing_ball_beyond.proofs.branch import EnclosedContact, Point, point
from bouncing_ball_beyond.proofs.certificates import Proved, orbit_properties, orbit_start
from bouncing_ball_beyond.proofs.newton import certified_box
from bouncing_ball_beyond.proofs.problem import RationalProblem, damping_of, working_bits
from bouncing_ball_beyond.proofs.series import Series


@dataclass(frozen=True)
class CertifiedNumber:
    """A certified number: its ball, the precision in bits, and what was proved."""

    ball: arb
    bits: int
    proved: tuple[Proved, ...]


@dataclass(frozen=True)
class ComparedOrbit:
    """The orbits of one r, n and Λ, whose greatest heights in both models are compared.

    Parameters
    ----------
    restitution, amplitude : Fraction
        r in (0, 1), and Λ above the saddle-node of the restitution model.
    n : int
    """

    restitution: Fraction
    n: int
    amplitude: Fraction

    def restitution_height(self) -> arb:
        """max z of the restitution model, Λ sin φ + (nπ)²/2."""
        r = rational(self.restitution)
        launch = self.n * arb.pi()
        fold = launch * (1 - r) / (1 + r)
        return (rational(self.amplitude) ** 2 - fold**2).sqrt() + launch**2 / 2

    def start(self, frequency_ratio: float) -> float:
        """The excess angle of the contact's orbit at this ϖ in double precision."""
        problem = RationalProblem(Fraction(frequency_ratio), self.restitution, self.n)
        return orbit_start(problem.approximate(), self.n, float(self.amplitude))


def height_threshold(
    compared: ComparedOrbit, error: Fraction, start: float, digits: int = 30
) -> CertifiedNumber:
    """The certified ϖ, near a start, at which the error of the greatest height has a value.

    ``error`` is the signed value, for example -1/100, and ``start`` is ϖ in double precision.

    Raises
    ------
    ProofError
        If no box around the start is proved to contain exactly one solution, if the orbit there is
        not certified, or if the modulus of the error does not fall with rising ϖ.
    """
    bits = working_bits(Fraction(start), digits)
    with precision(bits):
        zeta = damping_of(compared.restitution)
        square = rational(compared.amplitude) ** 2
        height = compared.restitution_height()

        def equations(box: list[arb]) -> tuple[Series, Series]:
            epsilon, ratio = (Series.variable(x, k, 2) for k, x in enumerate(box))
            orbit = point(EnclosedContact(ratio, zeta), compared.n, epsilon)
            return orbit.square - square, orbit.top / height - 1 - rational(error)

        box = certified_box(equations, [compared.start(start), start])
        epsilon, ratio = box
        contact = EnclosedContact(ratio, zeta)
        proved = orbit_properties(contact, compared.n, epsilon)
        _require_apex(point(contact, compared.n, epsilon))
        _require_falling(*equations(box), error)
        return CertifiedNumber(ratio, bits, (Proved.UNIQUE, Proved.FALLS, *proved))


def _require_falling(orbit: Series, error: Series, value: Fraction) -> None:
    """Check that the modulus of the error falls with ϖ along the orbits."""
    along = orbit.coefficient(1, 0)
    volume = error.coefficient(0, 1) * along - error.coefficient(1, 0) * orbit.coefficient(0, 1)
    if not rational(value) * volume / along < 0:
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
        zeta = damping_of(restitution)
        lowest = 1 - 2 * zeta * zeta
        level = 1 - rational(tolerance)
        inside = lowest * lowest - 1 + level * level
        if not (lowest > 0 and inside > 0 and level > 0 and level < 1):
            raise ProofError("Λ_SD is not proved to fall so far below 1")
        square = lowest - inside.sqrt()
        ratio = (1 / square).sqrt()
        return CertifiedNumber(ratio, bits, (Proved.UNIQUE, Proved.FALLS, Proved.ONLY))
