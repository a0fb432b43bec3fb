"""Instantaneous impacts with a restitution coefficient that depends on the impact speed."""

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.batch import Batch

# The imaginary step relative to the speed; its square is lost in rounding.
_IMAGINARY = 1e-20


class RestitutionLaw(Batch, ABC):
    """A restitution coefficient r(v), as a frozen dataclass of its parameters.

    A subclass defines :meth:`restitution` with numpy functions that are analytic in v, or piecewise
    analytic; :meth:`slope` differentiates it.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True, repr=False)
    ... class Slowing(RestitutionLaw):
    ...     scale: float
    ...
    ...     def restitution(self, speed):
    ...         return 1 / (1 + speed / self.scale)
    >>> float(Slowing(2.0).restitution(2.0)), round(float(Slowing(2.0).slope(2.0)), 12)
    (0.5, 0.25)
    """

    @abstractmethod
    def restitution(self, speed: np.ndarray) -> np.ndarray:
        """r at impact speeds v > 0, of the shape of the speeds."""

    def slope(self, speed: np.ndarray) -> np.ndarray:
        """d(r v)/dv at impact speeds v > 0, by an imaginary step, exact up to rounding."""
        v = np.asarray(speed, dtype=float)
        # The speed is NaN where there is no impact.
        with np.errstate(invalid="ignore"):
            moved = v * (1 + 1j * _IMAGINARY)
            return np.imag(self.restitution(moved) * moved) / (_IMAGINARY * v)


def rebound(law: RestitutionLaw | ArrayLike, speed: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """r and d(r v)/dv at impact speeds v > 0; for a constant r both are r.

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
