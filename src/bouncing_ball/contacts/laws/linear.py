r"""The paper's spring and damper, by the interface of the other laws.

``f = ϖ² p + 2ζϖ p′``, released at p = 0, or where the force vanishes. Everything
about it is in closed form (:class:`bouncing_ball.contacts.spring_damper.SpringDamper`);
here it is what the numerical methods for the other laws are checked against.
"""

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.laws.contact_law import ContactLaw, check_damping, check_positive
from bouncing_ball.contacts.release import Release
from bouncing_ball.errors import require


@dataclass(frozen=True, repr=False)
class Linear(ContactLaw):
    """Spring and damper.

    Parameters
    ----------
    frequency_ratio, damping_ratio : float or array
        ϖ > 0 and ζ in [0, 1).
    release : Release or str
        What ends the contact.

    Examples
    --------
    >>> float(Linear(2.0, 0.5).force(3.0, 1.0))
    14.0
    """

    frequency_ratio: float | np.ndarray
    damping_ratio: float | np.ndarray
    release: Release = Release.DISPLACEMENT

    name: ClassVar[str] = "linear"
    formula: ClassVar[str] = "W² p + 2 Z W p′"
    root: ClassVar[int] = 1

    def __post_init__(self):
        check_positive(self.frequency_ratio, "frequency ratio ϖ")
        check_damping(self.damping_ratio, "damping ratio ζ")
        zeta = np.asarray(self.damping_ratio, dtype=float)
        require(zeta < 1, zeta, "damping ratio ζ", "below 1: a free contact never ends")
        object.__setattr__(self, "release", Release.of(self.release))

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """ϖ² p + 2ζϖ p′."""
        omega = self.frequency_ratio
        return omega * (omega * penetration + 2 * self.damping_ratio * rate)

    def grip(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """p + κ p′."""
        lag = 2 * self.release.sine(self.damping_ratio) / self.frequency_ratio
        return penetration + lag * rate

    @classmethod
    def of_scales(cls, group: ArrayLike, length: ArrayLike, speed: ArrayLike) -> Self:
        """ϖ = v/P and ζ = group."""
        omega = np.asarray(speed, dtype=float) / np.asarray(length, dtype=float)
        return cls(omega, np.asarray(group, dtype=float) + 0 * omega)

    @classmethod
    def group_of(cls, restitution: float) -> float:
        """ζ of a restitution coefficient, with the displacement release."""
        return float(damping_ratio(restitution))
