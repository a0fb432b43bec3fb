"""A law whose force depends on the load and, if wanted, has a kink."""

from copy import copy
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from bouncing_ball_beyond.models.laws.contact_law import OscillatorLaw
from bouncing_ball_beyond.models.laws.loaded import LoadedLaw


@dataclass(frozen=True, repr=False)
class Sharing(LoadedLaw, OscillatorLaw):
    """A spring and a damper, and a share d of the load: f + d a, f = s (ϖ² s p + 2ζϖ p′).

    d grows with the depth as a parabola, from ``at_surface`` to ``share`` at the ``width``, its
    vertex, and s is d over ``share``. By default d is constant.
    """

    share: float | np.ndarray = 0.95
    at_surface: Any = None
    width: float | np.ndarray = 1.0

    name: ClassVar[str] = "sharing"
    # Where the formula for depths below the width holds at all depths, for a continued law.
    _shallow: ClassVar[Any] = None

    def __post_init__(self):
        super().__post_init__()
        if self.at_surface is None:
            object.__setattr__(self, "at_surface", self.share)

    @property
    def has_kink(self):
        return bool(np.any(np.not_equal(self.share, self.at_surface)))

    def kink(self, penetration, rate):
        return np.where(np.not_equal(self.share, self.at_surface), penetration - self.width, 1.0)

    def continued(self, penetration, side):
        law = copy(self)
        object.__setattr__(law, "_shallow", side < 0)
        return law

    def _ratio(self, penetration):
        shallow = self._shallow
        if shallow is None:
            shallow = np.real(penetration) < self.width
        least = self.at_surface / np.asarray(self.share)
        missing = (1 - least) * (1 - penetration / self.width) ** 2
        return np.where(shallow, 1 - missing, 1.0)

    def force(self, penetration, rate):
        s = self._ratio(penetration)
        omega = self.frequency_ratio
        spring = omega * (omega * (s * penetration) + 2 * self.damping_ratio * rate)
        return s * (spring + self.share * self.load)

    def grip(self, penetration, rate):
        """What the force is a positive multiple of."""
        lag = 2 * np.asarray(self.damping_ratio) / self.frequency_ratio
        held = self.share / np.asarray(self.frequency_ratio) ** 2 * self.load
        return self._ratio(penetration) * penetration + lag * rate + held
