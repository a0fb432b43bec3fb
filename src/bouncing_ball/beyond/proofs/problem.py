"""A contact with rational parameters and a family of orbits, about which something is proved."""

import math
from dataclasses import dataclass
from fractions import Fraction

from flint import arb

from bouncing_ball.beyond.proofs.balls import ProofError, rational
from bouncing_ball.beyond.proofs.branch import EnclosedContact
from bouncing_ball.models.damping import Release
from bouncing_ball.models.spring_damper import SpringDamper

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
    restitution, damping_ratio : Fraction, optional
        One of r and ζ (Eq. 16), both in (0, 1).
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
        if self.restitution is not None:
            _require_loss("restitution r", self.restitution, lossless=1)
        if self.damping_ratio is not None:
            _require_loss("damping ratio ζ", self.damping_ratio, lossless=0)

    def damping(self) -> arb:
        """ζ as a ball (Eq. 16)."""
        if self.damping_ratio is not None:
            return rational(self.damping_ratio)
        assert self.restitution is not None
        return damping_of(self.restitution)

    def contact(self) -> EnclosedContact:
        """The contact with balls as parameters, at the present precision."""
        zeta = self.damping()
        sine = zeta if self.release is Release.FORCE else arb(0)
        return EnclosedContact(rational(self.frequency_ratio), zeta, sine)

    def approximate(self) -> SpringDamper:
        """The contact in double precision."""
        return SpringDamper(float(self.frequency_ratio), float(self.damping().mid()), self.release)


def _require_loss(name: str, value: Fraction, lossless: int) -> None:
    if value == lossless:
        raise ProofError(f"{name} = {value} must lie between 0 and 1: {_LOSSLESS}")
    if not 0 < value < 1:
        raise ProofError(f"{name} = {value} must lie between 0 and 1")


def working_bits(frequency_ratio: Fraction, digits: int) -> int:
    """The precision with which a number on a contact with this ϖ is proved to so many digits."""
    stiff = max(1.0, float(frequency_ratio))
    wanted = digits * math.log2(10) + 2 * math.log2(stiff)
    return math.ceil((wanted + _GUARD) * 4 / 3)
