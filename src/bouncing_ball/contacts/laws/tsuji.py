r"""Hertz contact with Tsuji's damping, which codes for granular matter use.

``f = K p^{3/2} + C √K p^{1/4} p′``, released at p = 0. With q = p^{5/4} and
ds = p^{1/4} dt a free impact is linear, ::

    d²q/ds² + C √K dq/ds + (5/4) K q = 0

so that the restitution coefficient does not depend on the speed, and
``C = √5 (-ln r)/√(π² + ln² r)`` exactly; for C ≥ √5 the ball does not leave.

Physical parameters: a ball of mass m with the force ``k x^{3/2} + α √(m k) x^{1/4} ẋ``
has ``K = k √g/(m Ω³)`` and C = α.

Sources: Y. Tsuji, T. Tanaka and T. Ishida, Powder Technology 71 (1992) 239-250, as
quoted by LAMMPS (``pair_style granular``); D. Antypov and J. A. Elliott, *On an
analytical solution for the damped Hertzian spring*, Europhysics Letters 94 (2011)
50004, as quoted by Yade (``doc/references.bib``; its sources give the formula as Eq. 17).
Y. T. Feng, arXiv:2603.27764 (2026), gives the same change of variable
and the formula for any power (only its abstract was read).
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.laws.hertz import Hertz
from bouncing_ball.errors import require


def tsuji_damping(restitution: ArrayLike) -> np.ndarray:
    """``C = √5 (-ln r)/√(π² + ln² r)`` for r in (0, 1]; the range of r is not checked.

    Examples
    --------
    >>> float(tsuji_damping(1.0))
    0.0
    """
    decrement = -np.log(np.asarray(restitution, dtype=float)) + 0.0
    return np.sqrt(5) * decrement / np.hypot(np.pi, decrement)


@dataclass(frozen=True, repr=False)
class Tsuji(Hertz):
    """Hertz contact whose restitution coefficient is the same at every speed.

    Parameters
    ----------
    stiffness, damping : float or array
        K > 0 and C in [0, √5).

    Raises
    ------
    ModelError
        If K or C is outside its range.

    Examples
    --------
    >>> float(Tsuji(4.0, 0.5).force(16.0, 1.0))
    258.0
    """

    name: ClassVar[str] = "tsuji"
    root: ClassVar[int] = 4

    def __post_init__(self):
        super().__post_init__()
        c = self.damping
        require(c < np.sqrt(5), c, "damping C", "below √5: with more the ball does not leave")

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """K p^{3/2} + C √K p^{1/4} p′."""
        root = np.sqrt(penetration)
        loss = self.damping * np.sqrt(self.stiffness) * rate
        return self.stiffness * penetration * root + loss * np.sqrt(root)

    def root_force(self, root: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """K q⁶ + C √K q p′."""
        square = root * root
        loss = self.damping * np.sqrt(self.stiffness)
        return (self.stiffness * (square * square * square)) + loss * root * rate

    @classmethod
    def group_of(cls, restitution: float) -> float:
        """C that gives a restitution coefficient r in (0, 1]."""
        return float(tsuji_damping(restitution))
