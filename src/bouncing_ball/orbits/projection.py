"""The point of the explicit branch that is nearest to a given orbit.

Comparing at equal Λ would divide by zero at a fold. At a stiff contact D has too
few digits to compare at equal D, as Λ cos φ = X and Λ sin φ = Y change ϖ times
as fast; elsewhere both may nearly stand still. The nearest point in the space
(X, Y, ε) is well conditioned everywhere.
"""

import numpy as np

from bouncing_ball.orbits.spring_damper_branch import branch_point
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit

# Gauss-Newton from a start that is right to rounding of D converges at once.
_ITERATIONS = 4


def nearest_excess(orbit: SpringDamperOrbit) -> np.ndarray:
    """Excess angle ε of the point of the branch that is nearest in (X, Y, ε)."""
    contact = orbit.contact
    own = excess = orbit.contact_duration * contact.damped_frequency - contact.free_angle
    x, y = orbit.amplitude * np.cos(orbit.phase), orbit.amplitude * np.sin(orbit.phase)
    for _ in range(_ITERATIONS):
        point = branch_point(excess, contact, orbit.n)
        along = (x - point.x) * point.d_x + (y - point.y) * point.d_y
        square = point.d_x * point.d_x + point.d_y * point.d_y
        excess = excess + (along + own - excess) / (square + 1)
    return excess
