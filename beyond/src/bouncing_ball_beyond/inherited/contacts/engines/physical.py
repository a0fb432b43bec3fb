"""A ball and its linear contact with a wall, in SI units."""

import math
from functools import lru_cache
from typing import NamedTuple

from bouncing_ball_beyond.models.damping import Release, restitution_coefficient
from bouncing_ball_beyond.models.spring_damper import SpringDamper


class Physical(NamedTuple):
    """A ball of mass m and the linear contact k p + c p′ between it and a wall, in SI units.

    Examples
    --------
    >>> contact = Physical(mass=2.0, stiffness=200.0, damping=4.0)
    >>> contact.angular_frequency, contact.damping_ratio
    (10.0, 0.1)
    """

    mass: float
    stiffness: float
    damping: float

    @property
    def angular_frequency(self) -> float:
        """ω = √(k/m) of the contact, in rad/s."""
        return math.sqrt(self.stiffness / self.mass)

    @property
    def damping_ratio(self) -> float:
        """ζ = c/(2mω) of the contact."""
        return self.damping / (2 * self.mass * self.angular_frequency)

    def holds(self, release: Release) -> bool:
        """Whether the damper pulls until the table's level, which the ball never reaches again.

        Examples
        --------
        >>> ball = Physical(mass=1.0, stiffness=100.0, damping=20.0)
        >>> ball.holds(Release.DISPLACEMENT), ball.holds(Release.FORCE)
        (True, False)
        """
        if release is not Release.DISPLACEMENT:
            return False
        # Just below the critical damping r is too small for a number.
        return self.damping_ratio >= 1 or self.restitution(release) == 0

    def restitution(self, release: Release) -> float:
        """r of a free impact under a release rule.

        Raises
        ------
        ModelError
            If ζ ≥ 1 with the displacement release, under which the ball does not come back.
        """
        return float(restitution_coefficient(self.damping_ratio, release))

    def contact_time(self, release: Release) -> float:
        """Duration of a free impact under a release rule, in s.

        Raises
        ------
        ModelError
            If ζ ≥ 1 with the displacement release.
        """
        return free_duration(self.damping_ratio, release) / self.angular_frequency


# The searches for a number of steps ask for it again and again.
@lru_cache(maxsize=4)
def free_duration(damping_ratio: float, release: Release) -> float:
    """The duration of a free impact, in units of 1/ω.

    Raises
    ------
    ModelError
        If ζ ≥ 1 with the displacement release.
    """
    return float(SpringDamper(1.0, damping_ratio, release).free_duration)
