"""Old names of :meth:`Orbit.is_admissible`."""

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.orbits.contact_orbit import ContactOrbit
from bouncing_ball.orbits.restitution_orbit import RestitutionOrbit


def restitution_is_admissible(n: ArrayLike, amplitude: ArrayLike, phase: ArrayLike) -> np.ndarray:
    """Whether the ball of the restitution model's n-T orbit stays above the table."""
    return RestitutionOrbit.at(n, 1.0, amplitude, phase).is_admissible()


def is_admissible(orbit: ContactOrbit) -> np.ndarray:
    """Whether each orbit is one of the ball."""
    return orbit.is_admissible()
