r"""MuJoCo's contact with a constant impedance d, which reduces the load on the ball.

MuJoCo gives a contact the acceleration ``a₁ = (1 - d) a₀ - d (b v + κ x)``, with a₀ that of all
other forces. With direct ``solref``, d cancels in stiffness and damping, and affects
the load alone ::

    p″ = (1 - d) a - ϖ² p - 2ζϖ p′,   force  ϖ² p + 2ζϖ p′ + d a ≥ 0

The ball is released where this force vanishes, or where p = 0 if that comes first. Without load
the impact is that of the spring-damper with its force release, with the same t_c, r and D. A load
a moves the ball in contact by the share 1 - d of its effect on the spring-damper. At the release,
where p + κ p′ = -d a/ϖ², the acceleration without load is zero, so that ∂p′_e/∂a is also 1 - d of
that of the spring-damper, whereas the flights outside feel all of a. Hence, with κ = 2ζ/ϖ, ::

    σ_d = (1 - r) D - (2 - d) κ r = σ + d κ r

The steady contact without a flight needs both p and the force to stay positive ::

    Λ ≤ |ϖ² - 1 + 2iζϖ| / max(ϖ², |ϖ² - d + 2iζϖ|)

Source: MuJoCo's documentation, *Solver parameters*, read with the engine itself.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from bouncing_ball.contacts.contact_law import Oscillator
from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.instant import Instant
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import require


@dataclass(frozen=True, repr=False)
class Impedance(Oscillator):
    """A spring-damper on which only the share 1 - d of the load acts.

    Parameters
    ----------
    frequency_ratio, damping_ratio : float or array
        ϖ > 0 and ζ in [0, 1).
    share : float or array
        d in [0, 1); 0.95 below the depth ``width`` is MuJoCo's default.

    Raises
    ------
    ModelError
        If ϖ, ζ or d is outside its range.

    Examples
    --------
    >>> law = Impedance(2.0, 0.5, 0.75)
    >>> float(law.grip(1.0, -2.0)), float(law.loaded_grip(1.0, -2.0, 4.0))
    (0.0, 0.75)
    """

    share: float | np.ndarray = 0.95

    name: ClassVar[str] = "impedance"
    formula: ClassVar[str] = "ϖ² p + 2ζϖ p′ and d of the load"
    release = Release.FORCE
    lag: ClassVar[None] = None

    def __post_init__(self) -> None:
        # The spring-damper checks the ranges of ϖ and ζ.
        _ = self._spring.signature
        d = np.asarray(self.share, dtype=float)
        require((d >= 0) & (d < 1), d, "impedance d", "in [0, 1)")

    @property
    def _spring(self) -> SpringDamper:
        return SpringDamper(self.frequency_ratio, self.damping_ratio, Release.FORCE)

    @property
    def impedance(self) -> Any:
        """The impedance d, by the name that all laws have."""
        return self.share

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """ϖ² p + 2ζϖ p′, the force over the weight without the share d of the load."""
        return self._spring.force(penetration, rate)

    def grip(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """p + κ p′, the grip without load."""
        return penetration + self._spring.lag * rate

    def loaded_grip(self, penetration: np.ndarray, rate: np.ndarray, load: Any) -> np.ndarray:
        """p + κ p′ + d a/ϖ², the grip with a load a."""
        held = self.share * load / np.asarray(self.frequency_ratio) ** 2
        return self.grip(penetration, rate) + held

    @property
    def signature(self) -> Instant:
        """The signature of the spring-damper with σ_d in place of σ.

        Raises
        ------
        ModelError
            If ζ ≥ 1.
        """
        free, spring = self._spring.signature, self._spring
        return free._replace(load=free.load + self.share * spring.lag * free.restitution)

    @property
    def permanent_contact(self) -> np.ndarray:
        """Λ up to which a steady contact never releases the ball, of the law's shape."""
        omega, zeta = np.asarray(self.frequency_ratio), np.asarray(self.damping_ratio)
        stiffness, loss = omega * omega, 2 * zeta * omega
        held = np.maximum(stiffness, np.hypot(stiffness - self.share, loss))
        return np.hypot(stiffness - 1, loss) / held

    @classmethod
    def group_of(cls, restitution: float) -> float:
        """ζ of a restitution coefficient r in (e⁻², 1], with the force release."""
        return float(damping_ratio(restitution, Release.FORCE))
