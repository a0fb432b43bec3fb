r"""Viscoelastic Hertz contact, of Kuwabara and Kono, and of Brilliantov et al.

``f = K (p^{3/2} + C √p p′)``, released where the force vanishes, p + C p′ = 0, because the
surfaces do not adhere; the contact is still deformed when the ball leaves. The
restitution coefficient depends on C v^{1/5} K^{2/5} alone and falls with the speed, as
1 - 1.15 C K^{2/5} v^{1/5} for a slow impact.

Physical parameters: a ball of mass m with the force ``k (x^{3/2} + (3/2) A √x ẋ)``, where A is
a time that describes the dissipation, has ``K = k √g/(m Ω³)`` and ``C = (3/2) A Ω``.

Sources: G. Kuwabara and K. Kono, Japanese Journal of Applied Physics 26 (1987)
1230-1233, as quoted by the CGNS standard (``HertzKuwabaraKono``; the last page from
memory); N. V. Brilliantov, F. Spahn, J.-M. Hertzsch and T. Pöschel, Physical Review E
53 (1996) 5382-5392, as quoted by LAMMPS (``pair_style gran/hooke``); for the release
T. Schwager and T. Pöschel, Physical Review E 78 (2008) 051304, as quoted by the toolbox
ChattAbhi/Approx-ViscoElastic-CoR.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bouncing_ball.contacts.contact_law import Unit
from bouncing_ball.contacts.laws.hertz import Hertz
from bouncing_ball.contacts.release import Release


@dataclass(frozen=True, repr=False)
class KuwabaraKono(Hertz):
    """Viscoelastic Hertz contact that does not pull.

    Parameters
    ----------
    stiffness, damping : float or array
        K > 0 and C ≥ 0.

    Examples
    --------
    >>> law = KuwabaraKono(2.0, 0.5)
    >>> float(law.force(4.0, 1.0)), float(law.grip(4.0, -8.0))
    (18.0, 0.0)
    """

    name: ClassVar[str] = "kuwabara-kono"
    release = Release.FORCE

    units: ClassVar[dict[str, Unit]] = Hertz.units | {"damping": Unit("s", 0, 0, 1)}

    def root_force(self, root: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """K q (q² + C p′)."""
        return self.stiffness * root * (root * root + self.damping * rate)

    @property
    def lag(self) -> float | np.ndarray:
        """C, because the force vanishes where p + C p′ = 0."""
        return self.damping

    @staticmethod
    def damping_unit(length: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """The unit P/v of C."""
        return length / speed
