"""A law of an instantaneous impact: a restitution coefficient that depends on the speed."""

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.batch import Batch

# Of the imaginary step, in parts of the speed: its square is lost in rounding.
_IMAGINARY = 1e-20


class RestitutionLaw(Batch, ABC):
    """r(v), as a frozen dataclass of its parameters.

    A law of one's own defines :meth:`restitution`, of numpy functions that are analytic in
    v (or piecewise so); its derivative follows.
    """

    @abstractmethod
    def restitution(self, speed: np.ndarray) -> np.ndarray:
        """r of impacts with speeds v > 0."""

    def slope(self, speed: np.ndarray) -> np.ndarray:
        """d(r v)/dv, by an imaginary step."""
        v = np.asarray(speed, dtype=float)
        # Not a number where there is no impact.
        with np.errstate(invalid="ignore"):
            moved = v * (1 + 1j * _IMAGINARY)
            return np.imag(self.restitution(moved) * moved) / (_IMAGINARY * v)


def rebound(law: RestitutionLaw | ArrayLike, speed: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """r and d(r v)/dv of a law, or of a number r, for which both are the same.

    Examples
    --------
    >>> [float(x) for x in rebound(0.5, 3.0)]
    [0.5, 0.5]
    """
    if isinstance(law, RestitutionLaw):
        v = np.asarray(speed, dtype=float)
        return law.restitution(v), law.slope(v)
    r = np.asarray(law, dtype=float)
    return r, r
