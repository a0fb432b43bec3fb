"""The restitution model, whose impacts are instants at the table's level (Eqs. 1-5)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import RIGID_RESTITUTION, Range
from bouncing_ball_beyond.inherited.models.damping import check_restitution
from bouncing_ball_beyond.models.instant import Instant, rigid_instant
from bouncing_ball_beyond.models.laws.force_law import NUMBER, Unit
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.models.restitution import RestitutionDynamics


@dataclass(frozen=True, repr=False)
class RestitutionModel(Model):
    """The inherited ball of the same name, with simulations and orbits of this house.

    Examples
    --------
    A ball that is thrown up from a table at rest comes back with its speed, and half of it is left:

    >>> RestitutionModel(0.5).simulate(0.0, phase=0.0, velocity=-2.0, impacts=3).time.tolist()
    [0.0, 2.0, 3.0]
    """

    restitution: float | np.ndarray
    """r in [0, 1]."""

    name: ClassVar[str] = "restitution"
    units: ClassVar[dict[str, Unit]] = {"restitution": NUMBER}

    def __post_init__(self):
        given = check_restitution(self.restitution, RIGID_RESTITUTION)
        if np.ndim(self.restitution):
            object.__setattr__(self, "restitution", given)

    @property
    def label(self) -> str:
        return f"r = {float(self.restitution):g}"

    def range_of(self, name: str) -> Range:
        """[0, 1] for r."""
        return RIGID_RESTITUTION if name == "restitution" else super().range_of(name)

    def dynamics(self, amplitude: ArrayLike) -> RestitutionDynamics:
        """The impacts and flights of these balls on a table of amplitude Λ."""
        r = np.asarray(self.restitution, dtype=float)
        return RestitutionDynamics.of(r, amplitude)

    def signature(self, speed: ArrayLike) -> Instant:
        """The restitution r, without delay, load sensitivity and duration."""
        return rigid_instant(self.restitution, self.restitution, speed)
