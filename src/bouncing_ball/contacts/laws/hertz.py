"""Base class of the contact laws of a sphere: Hertz' stiffness and a damping parameter."""

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.contact_law import ContactLaw, Unit, check_damping, check_positive


@dataclass(frozen=True, repr=False)
class Hertz(ContactLaw):
    """``f = K p^ν`` plus a damping force, by default with Hertz' power ν = 3/2.

    Parameters
    ----------
    stiffness, damping : float or array
        K > 0 and C ≥ 0.

    Raises
    ------
    ModelError
        If K or C is outside its range.
    """

    power: ClassVar[float] = 1.5
    stiffness: float | np.ndarray
    damping: float | np.ndarray

    units: ClassVar[dict[str, Unit]] = {"stiffness": Unit("N/m^1.5", 1, -0.5, -2)}

    def __post_init__(self):
        super().__post_init__()
        check_positive(self.stiffness, "stiffness K")
        check_damping(self.damping, "damping C")

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """f(p, p′), by :meth:`root_force`, which is a polynomial in the root q = √p."""
        return self.root_force(np.sqrt(penetration), rate)

    @abstractmethod
    def root_force(self, root: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """f as a function of q = p^{1/m} and p′."""

    @classmethod
    def of_scales(cls, group: ArrayLike, length: ArrayLike, speed: ArrayLike) -> Self:
        """The law with K = v²/P^{1+ν}, ν the power of p, and C = ``group`` :meth:`damping_unit`."""
        scale, v = np.asarray(length, dtype=float), np.asarray(speed, dtype=float)
        stiffness = v * v / scale ** (1 + cls.power)
        return cls(stiffness, group * cls.damping_unit(scale, v) + 0 * stiffness)

    @staticmethod
    def damping_unit(length: np.ndarray, speed: np.ndarray) -> Any:
        """The unit of C in terms of the scales P and v; 1 by default, where C is a number."""
        return 1.0
