r"""A linear spring whose damper gives at most the spring's force: Modelica's ElastoBacklash2.

``f = k p + min(c p′, k p)``, and never below zero: on the way in the damper at most doubles the
spring's force, which so grows from nothing; on the way out it at most takes it away, and the
ball is released where p + κ p′ = 0, κ = c/k. The kink is where p = κ p′, at the time κ of a short
impact. The law is homogeneous, so that the restitution is the same at every speed.

Physical parameters: ``k = m Ω² ϖ²``, ``c = 2 m Ω ζϖ``.

Source: Modelica Standard Library, ``Mechanics.Rotational.Components.ElastoBacklash2``, and its
issue 2247.
"""

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.contact_law import ContactLaw, check_damping, check_positive
from bouncing_ball.contacts.release import Release


@dataclass(frozen=True, repr=False)
class ElastoBacklash(ContactLaw):
    """A spring-damper with |damping| ≤ spring.

    Parameters
    ----------
    frequency_ratio, damping_ratio : float or array
        ϖ > 0 and ζ ≥ 0.

    Examples
    --------
    >>> law = ElastoBacklash(2.0, 0.5)
    >>> [float(law.force(1.0, rate)) for rate in (1.0, 4.0)]
    [6.0, 8.0]
    """

    frequency_ratio: float | np.ndarray
    damping_ratio: float | np.ndarray

    name: ClassVar[str] = "elasto-backlash"
    formula: ClassVar[str] = "ϖ² p + min(2ζϖ p′, ϖ² p)"
    root: ClassVar[int] = 1
    release = Release.FORCE
    has_kink: ClassVar[bool] = True

    def __post_init__(self):
        check_positive(self.frequency_ratio, "frequency ratio ϖ")
        check_damping(self.damping_ratio, "damping ratio ζ")

    @property
    def lag(self) -> np.ndarray:
        """κ = 2ζ/ϖ."""
        return 2 * np.asarray(self.damping_ratio) / self.frequency_ratio

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """ϖ² (p + κ p′), or 2ϖ² p where that is less."""
        pushed = self.lag * rate
        limited = np.where(np.real(pushed) < np.real(penetration), pushed, penetration)
        return self.frequency_ratio**2 * (penetration + limited)

    def kink(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """p - κ p′, which does not change its sign without damping."""
        return np.where(self.lag == 0, 1.0, penetration - self.lag * rate)

    @classmethod
    def of_scales(cls, group: ArrayLike, length: ArrayLike, speed: ArrayLike) -> Self:
        """ϖ = v/P, and ζ."""
        ratio = np.asarray(speed, dtype=float) / np.asarray(length, dtype=float)
        return cls(ratio, group + 0 * ratio)
