"""Old names of :meth:`Orbit.monodromy` and :meth:`Orbit.trace_and_determinant`."""

import numpy as np

from bouncing_ball.orbits.contact_orbit import ContactOrbit


def monodromy(orbit: ContactOrbit) -> np.ndarray:
    """Jacobian of the return map."""
    return orbit.monodromy()


def trace_and_contraction(orbit: ContactOrbit) -> tuple[np.ndarray, np.ndarray]:
    """Trace and determinant of the monodromy."""
    return orbit.trace_and_determinant()
