"""Instantaneous impacts with a restitution coefficient that depends on the impact speed."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.numerics.arrays import Batch
from bouncing_ball_beyond.models.instant import Instant, rigid_instant
from bouncing_ball_beyond.models.laws.analytic import compare
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.models.restitution import RestitutionDynamics

# The imaginary step relative to the speed; its square is lost in rounding.
_IMAGINARY = 1e-20
# The speeds at which r(v) is examined.
_SPEEDS = 0.937 * np.geomspace(1e-3, 30.0, 12)


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


def require_analytic_restitution(law: RestitutionLaw) -> None:
    """Raise :class:`ModelError` if the slope of a law by an imaginary step is not that by a
    difference; a law with a :meth:`RestitutionLaw.slope` of its own is not examined.
    """
    if type(law).slope is not RestitutionLaw.slope:
        return
    one = law.flat(law.shape).take(0)
    compare(f"r(v) of {type(law).__name__}", "v", one.restitution, _SPEEDS)


class RestitutionLawDynamics(RestitutionDynamics):
    """Impacts and flights with a restitution coefficient r(v); ``law`` is the
    :class:`RestitutionLaw`.
    """

    is_constant: ClassVar[bool] = False

    def rebound(self, speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """r and d(r v)/dv at impact speeds v > 0."""
        return self.law.restitution(speed), self.law.slope(speed)


@dataclass(frozen=True, repr=False)
class RestitutionLawModel(Model):
    """A ball whose impacts are instants with a restitution coefficient r(v).

    Parameters
    ----------
    law : RestitutionLaw
        The law r(v).

    Raises
    ------
    ModelError
        If the derivative of r by an imaginary step is not that by a difference.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True, repr=False)
    ... class Slowing(RestitutionLaw):
    ...     scale: float
    ...
    ...     def restitution(self, speed):
    ...         return 1 / (1 + speed / self.scale)
    >>> found = RestitutionLawModel(Slowing(2.0)).simulate(0.0, 0.0, -2.0, 3)
    >>> found.time.round(12).tolist()
    [0.0, 2.0, 3.333333333333]
    """

    law: RestitutionLaw

    name: ClassVar[str] = "restitution-law"

    def __post_init__(self) -> None:
        require_analytic_restitution(self.law)

    def dynamics(self, amplitude: ArrayLike) -> RestitutionLawDynamics:
        """The impacts and flights of these balls on a table of amplitude Λ."""
        return RestitutionLawDynamics.of(self.law, amplitude)

    def signature(self, speed: ArrayLike) -> Instant:
        """The restitution r(v), without delay, load sensitivity and duration."""
        v = np.asarray(speed, dtype=float)
        return rigid_instant(self.law.restitution(v), self.law.slope(v), v)
