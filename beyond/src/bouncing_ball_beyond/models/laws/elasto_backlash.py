r"""A linear spring whose damping force is at most the spring's: Modelica's ElastoBacklash2.

``f = k p + min(c p′, k p)``, and never negative. During compression the damper at most doubles the
force of the spring, so that the force grows from zero. During restitution it at most cancels that
force, and the ball is released where p + κ p′ = 0, κ = c/k. The force has a kink where p = κ p′,
at a time of about κ after the start of a weakly damped impact. The law is homogeneous, so that r
is the same at every speed.

In a steady contact without a flight, as long as the force is linear, p is a sinusoid about the
depth at rest. Then p + κ p′, whose zero is the release, and p - κ p′, whose zero is the kink, have
the same minimum. Up to the threshold of permanent contact the force is therefore linear, and the
threshold is that of the spring-damper with the force release.

Physical parameters: ``k = m Ω² ϖ²``, ``c = 2 m Ω ζϖ``.

Source: Modelica Standard Library, ``Mechanics.Rotational.Components.ElastoBacklash2``, and its
issue 2247.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.contact_law import OscillatorLaw
from bouncing_ball_beyond.models.permanent_contact import permanent_contact_threshold


@dataclass(frozen=True, repr=False)
class ElastoBacklash(OscillatorLaw):
    """A spring-damper whose damping force is at most that of the spring.

    Parameters
    ----------
    frequency_ratio, damping_ratio : float or array
        ϖ > 0 and ζ ≥ 0.

    Raises
    ------
    ModelError
        If ϖ or ζ is outside its range.

    Examples
    --------
    >>> law = ElastoBacklash(2.0, 0.5)
    >>> [float(law.force(1.0, rate)) for rate in (1.0, 4.0)]
    [6.0, 8.0]
    """

    name: ClassVar[str] = "elasto-backlash"
    release = Release.FORCE
    has_kink: ClassVar[Any] = True

    @property
    def lag(self) -> np.ndarray:
        """κ = 2ζ/ϖ, because the force vanishes where p + κ p′ = 0."""
        return 2 * np.asarray(self.damping_ratio) / self.frequency_ratio

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """ϖ² (p + κ p′) or 2ϖ² p, whichever is smaller."""
        pushed = self.lag * rate
        limited = np.where(np.real(pushed) < np.real(penetration), pushed, penetration)
        return self.frequency_ratio**2 * (penetration + limited)

    def kink(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """p - κ p′, whose zero is the kink; 1 without damping, because the force is then smooth."""
        return np.where(self.lag == 0, 1.0, penetration - self.lag * rate)

    @property
    def permanent_contact(self) -> np.ndarray:
        """Λ_F(ϖ), the threshold of the spring-damper with the force release."""
        return permanent_contact_threshold(self.frequency_ratio, self.damping_ratio, Release.FORCE)
