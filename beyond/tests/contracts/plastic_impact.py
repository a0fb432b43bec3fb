"""An example of a user's model: restitution that falls with the speed.

Plastic spheres keep ``r = (c/v)^¼`` of a speed v above the yield speed c, and
all of a lower one (K. L. Johnson, Contact Mechanics, 1985, §11.5). The law is all that such a model
needs: its orbits, their stability and bifurcations, and its simulation follow.
"""

from dataclasses import dataclass

import numpy as np

from bouncing_ball_beyond.models.restitution_by_speed import RestitutionLaw, RestitutionLawModel


@dataclass(frozen=True, repr=False)
class PlasticImpact(RestitutionLaw):
    """r(v) = (c/v)^¼, and 1 below the yield speed c."""

    yield_speed: float | np.ndarray

    def restitution(self, speed):
        return np.minimum(1.0, (self.yield_speed / speed) ** 0.25)


MODEL = RestitutionLawModel(PlasticImpact(0.7))
