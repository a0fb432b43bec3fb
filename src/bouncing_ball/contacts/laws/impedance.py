r"""MuJoCo's contact with a constant impedance d: it takes a part of the load off the ball.

MuJoCo gives the acceleration ``a₁ = (1 - d) a₀ - d (b v + κ x)`` to a contact, a₀ that of all
other forces. With direct ``solref``, d is divided out of stiffness and damping, and is left in
the load alone ::

    p″ = (1 - d) a - ϖ² p - 2ζϖ p′,   force  ϖ² p + 2ζϖ p′ + d a ≥ 0

The ball is released where this force vanishes, or where p = 0 if that comes first. Without load
the impact is that of the spring-damper with its force release: t_c, r and D are the same. With
it the ball in contact moves by 1 - d of what the spring-damper's does, and where it is released,
at p + κ p′ = -d a/ϖ², its acceleration without load is zero, so that ∂p′_e/∂a is 1 - d of the
spring-damper's too, while the flights outside feel all of a. Hence, with κ = 2ζ/ϖ, ::

    σ_d = (1 - r) D - (2 - d) κ r = σ + d κ r

The steady contact without a flight needs both p and the force to stay positive ::

    Λ ≤ |ϖ² - 1 + 2iζϖ| / max(ϖ², |ϖ² - d + 2iζϖ|)

Source: MuJoCo's documentation, *Solver parameters*, read with the engine itself.
"""

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.contact_law import ContactLaw
from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.instant import Instant
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import require


@dataclass(frozen=True, repr=False)
class Impedance(ContactLaw):
    """A spring-damper that feels the part 1 - d of the load.

    Parameters
    ----------
    frequency_ratio, damping_ratio : float or array
        ϖ > 0 and ζ in [0, 1).
    share : float or array
        d in [0, 1); 0.95 below the depth ``width`` is MuJoCo's default.

    Examples
    --------
    >>> law = Impedance(2.0, 0.5, 0.75)
    >>> float(law.grip(1.0, -2.0)), float(law.loaded_grip(1.0, -2.0, 4.0))
    (0.0, 0.75)
    """

    frequency_ratio: float | np.ndarray
    damping_ratio: float | np.ndarray
    share: float | np.ndarray = 0.95

    name: ClassVar[str] = "impedance"
    formula: ClassVar[str] = "ϖ² p + 2ζϖ p′ and d of the load"
    root: ClassVar[int] = 1
    release = Release.FORCE
    lag: ClassVar[None] = None

    def __post_init__(self):
        # It knows the ranges of ϖ and ζ.
        _ = self._spring.signature
        d = np.asarray(self.share, dtype=float)
        require((d >= 0) & (d < 1), d, "impedance d", "in [0, 1)")

    @property
    def _spring(self) -> SpringDamper:
        return SpringDamper(self.frequency_ratio, self.damping_ratio, Release.FORCE)

    @property
    def impedance(self) -> Any:
        """d."""
        return self.share

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """ϖ² p + 2ζϖ p′, to which d of the load is added."""
        return self._spring.force(penetration, rate)

    def grip(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """p + κ p′, without load."""
        return penetration + self._spring.lag * rate

    def loaded_grip(self, penetration: np.ndarray, rate: np.ndarray, load: Any) -> np.ndarray:
        """p + κ p′ + d a/ϖ²."""
        held = self.share * load / np.asarray(self.frequency_ratio) ** 2
        return self.grip(penetration, rate) + held

    @property
    def signature(self) -> Instant:
        """That of the spring-damper, with another σ."""
        free, spring = self._spring.signature, self._spring
        return free._replace(load=free.load + self.share * spring.lag * free.restitution)

    @property
    def permanent_contact(self) -> np.ndarray:
        """Λ up to which a steady contact is held."""
        omega, zeta = np.asarray(self.frequency_ratio), np.asarray(self.damping_ratio)
        stiffness, loss = omega * omega, 2 * zeta * omega
        held = np.maximum(stiffness, np.hypot(stiffness - self.share, loss))
        return np.hypot(stiffness - 1, loss) / held

    @classmethod
    def of_scales(cls, group: ArrayLike, length: ArrayLike, speed: ArrayLike) -> Self:
        """ϖ = v/P, and ζ."""
        ratio = np.asarray(speed, dtype=float) / np.asarray(length, dtype=float)
        return cls(ratio, group + 0 * ratio)

    @classmethod
    def group_of(cls, restitution: float) -> float:
        """ζ of a restitution coefficient."""
        return float(damping_ratio(restitution, Release.FORCE))
