"""A contact with rational parameters and a family of orbits, about which something is proved."""

import math
from dataclasses import dataclass
from fractions import Fraction

from flint import arb

from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.proofs.balls import ProofError, rational
from bouncing_ball_beyond.proofs.branch import EnclosedContact

# Bits beyond the requested digits and those that stiff contacts cost by cancellation,
# about log2(ϖ²). With so many the ball is far narrower than the last decimal digit, so that the
# decimal number and its error are the same whatever the double precision of the start.
_GUARD = 160
_LOSSLESS = "without dissipation both multipliers of a saddle-node are 1, and nothing is proved"


def damping_of(restitution: Fraction) -> arb:
    """ζ as a ball (Eq. 16)."""
    decrement = -rational(restitution).log()
    return decrement / (arb.pi() ** 2 + decrement**2).sqrt()


@dataclass(frozen=True)
class RationalProblem:
    """A contact with rational parameters and a family of orbits.

    Parameters
    ----------
    frequency_ratio : Fraction
        ϖ > 0.
    restitution : Fraction
        r in (0, 1), from which ζ follows (Eq. 16).
    n : int
        Index of the family.

    Raises
    ------
    ProofError
        If a parameter is outside its range.
    """

    frequency_ratio: Fraction
    restitution: Fraction
    n: int = 1

    def __post_init__(self) -> None:
        if self.frequency_ratio <= 0:
            raise ProofError(f"frequency ratio ϖ = {self.frequency_ratio} must be above 0")
        if self.n < 1:
            raise ProofError(f"index of the family n = {self.n} must be at least 1")
        if self.restitution == 1:
            raise ProofError(f"restitution r = 1 must lie between 0 and 1: {_LOSSLESS}")
        if not 0 < self.restitution < 1:
            raise ProofError(f"restitution r = {self.restitution} must lie between 0 and 1")

    def contact(self) -> EnclosedContact:
        """The contact with balls as parameters, at the present precision."""
        return EnclosedContact(rational(self.frequency_ratio), damping_of(self.restitution))

    def approximate(self) -> SpringDamper:
        """The contact in double precision."""
        zeta = float(damping_of(self.restitution).mid())
        return SpringDamper(float(self.frequency_ratio), zeta)


def working_bits(frequency_ratio: Fraction, digits: int) -> int:
    """The precision with which a number on a contact with this ϖ is proved to so many digits."""
    stiff = max(1.0, float(frequency_ratio))
    wanted = digits * math.log2(10) + 2 * math.log2(stiff)
    return math.ceil((wanted + _GUARD) * 4 / 3)
