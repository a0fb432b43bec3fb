"""What the laws of a ball share: Hertz' stiffness, and a number for the damping."""

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.contact_law import ContactLaw, check_damping, check_positive


@dataclass(frozen=True, repr=False)
class Hertz(ContactLaw):
    """``f = K p^{3/2}`` and a damping.

    Parameters
    ----------
    stiffness, damping : float or array
        K > 0 and C ≥ 0.
    """

    stiffness: float | np.ndarray
    damping: float | np.ndarray

    def __post_init__(self):
        check_positive(self.stiffness, "stiffness K")
        check_damping(self.damping, "damping C")

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """f(p, p′) by the root, of which the force is a polynomial."""
        root = np.sqrt(penetration)
        return self.root_force(np.sqrt(root) if self.root == 4 else root, rate)

    @abstractmethod
    def root_force(self, root: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """f as a function of q = p^{1/m} and p′."""

    @classmethod
    def of_scales(cls, group: ArrayLike, length: ArrayLike, speed: ArrayLike) -> Self:
        """K = v²/P^{5/2}, and C = group in its own unit."""
        scale, v = np.asarray(length, dtype=float), np.asarray(speed, dtype=float)
        stiffness = v * v / scale**2.5
        return cls(stiffness, group * cls.damping_unit(scale, v) + 0 * stiffness)

    @staticmethod
    def damping_unit(length: np.ndarray, speed: np.ndarray) -> Any:
        """What C is 1 for in units of the scales P and P/v; C is a number by default."""
        return 1.0
