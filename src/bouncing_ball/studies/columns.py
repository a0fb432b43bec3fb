"""The quantities that the datasets contain of every orbit."""

import numpy as np

from bouncing_ball.orbits.orbit import Orbit

OBSERVED = (
    "phase",
    "contact_duration",
    "release_phase",
    "impact_velocity",
    "bounce_velocity",
    "apparent_restitution",
)
PLACE = ("amplitude", "phase", "contact_duration")
"""The quantities that the datasets contain of special orbits."""


def columns(orbit: Orbit, *names: str) -> dict[str, np.ndarray]:
    """The named quantities of orbits, with their stability and their admissibility.

    The arrays have the orbits' shape.

    Examples
    --------
    >>> from bouncing_ball.orbits.restitution_model import RestitutionModel
    >>> found = columns(RestitutionModel(1.0).orbit(1, 0.5), "phase")
    >>> {name: x.item() for name, x in found.items()}
    {'phase': 1.5707963267948966, 'stable': False, 'admissible': True}
    """
    return {
        **{name: getattr(orbit, name) for name in names},
        "stable": orbit.is_stable(),
        "admissible": orbit.is_admissible(),
    }
