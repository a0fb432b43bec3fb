r"""Hertz contact with Hunt and Crossley's damping.

``f = K p^{3/2} (1 + C p′)``, released at p = 0, where the force vanishes too. The force never
pulls a free ball, because the ball leaves with p′ > -1/C. The restitution coefficient
depends on C v alone and falls with the speed, as 1 - (2/3) C v for a slow impact.

Physical parameters: a ball of mass m on a plane with the force
``k x^{3/2} (1 + λ ẋ)``, k = (4/3) E* √R, on a table of frequency Ω under gravity g,
has ``K = k √g/(m Ω³)`` and ``C = λ g/Ω``.

Source: K. H. Hunt and F. R. E. Crossley, *Coefficient of restitution
interpreted as damping in vibroimpact*, Journal of Applied Mechanics 42 (1975) 440-445,
as quoted by Simbody (``HuntCrossleyContact.h``: k xⁿ (1 + (3/2) c v), n = 3/2 for a
sphere, and e = 1 - c v at low speed; its c is (2/3) λ).
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bouncing_ball.contacts.contact_law import Unit
from bouncing_ball.contacts.laws.hertz import Hertz


@dataclass(frozen=True, repr=False)
class HuntCrossley(Hertz):
    """Hertz contact with damping proportional to the elastic force.

    Parameters
    ----------
    stiffness, damping : float or array
        K > 0 and C ≥ 0.

    Examples
    --------
    >>> float(HuntCrossley(2.0, 0.5).force(4.0, 1.0))
    24.0
    """

    name: ClassVar[str] = "hunt-crossley"

    units: ClassVar[dict[str, Unit]] = Hertz.units | {"damping": Unit("s/m", 0, -1, 1)}

    def root_force(self, root: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """K q³ (1 + C p′)."""
        return self.stiffness * (root * root * root) * (1 + self.damping * rate)

    @staticmethod
    def damping_unit(length: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """The unit 1/v of C."""
        return 1 / speed


@dataclass(frozen=True, repr=False)
class LinearHuntCrossley(HuntCrossley):
    """A linear spring with Hunt and Crossley's damping, as in Drake's point contact.

    The restitution coefficient does not depend on the power of p.

    Parameters
    ----------
    stiffness, damping : float or array
        K > 0 and C ≥ 0.

    Examples
    --------
    >>> float(LinearHuntCrossley(2.0, 0.5).force(4.0, 1.0))
    12.0
    """

    name: ClassVar[str] = "hunt-crossley-linear"
    root: ClassVar[int] = 1
    power: ClassVar[float] = 1.0
    units: ClassVar[dict[str, Unit]] = HuntCrossley.units | {"stiffness": Unit("N/m", 1, 0, -2)}

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """K p (1 + C p′)."""
        return self.stiffness * penetration * (1 + self.damping * rate)
