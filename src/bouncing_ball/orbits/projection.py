"""The point of the explicit branch that is nearest to a given orbit.

Comparing at equal Λ or equal D would divide by zero at a fold or where D has
too few digits; the nearest point in the plane (Λ cos φ, Λ sin φ) is well
conditioned everywhere on the branch.
"""

import numpy as np

from bouncing_ball.orbits.closed_form import BranchPoint, branch_point, free_release_angle
from bouncing_ball.orbits.contact_orbit import ContactOrbit

# Gauss-Newton from a start that is right to rounding of D converges at once.
_ITERATIONS = 4


def nearest_excess(orbit: ContactOrbit) -> np.ndarray:
    """Excess angle ε of the nearest point of the branch."""
    contact = orbit.contact
    zeta = np.asarray(contact.damping_ratio)
    angle = orbit.duration * contact.frequency_ratio * np.sqrt((1 - zeta) * (1 + zeta))
    excess = angle - free_release_angle(contact)
    x, y = orbit.amplitude * np.cos(orbit.phase), orbit.amplitude * np.sin(orbit.phase)
    for _ in range(_ITERATIONS):
        point = branch_point(excess, contact, orbit.n)
        along = (x - point.x) * point.d_x + (y - point.y) * point.d_y
        excess = excess + along / (point.d_x * point.d_x + point.d_y * point.d_y)
    return excess


def distance(orbit: ContactOrbit, point: BranchPoint) -> np.ndarray:
    """Largest difference in Λ, φ, ϖτ_b and z′_i."""
    turn = np.angle(np.exp(1j * (orbit.phase - point.phase)))
    angle = (orbit.duration - point.duration) * orbit.contact.frequency_ratio
    impact = orbit.impact_velocity - (point.u + point.x)
    differences = (orbit.amplitude - point.amplitude, turn, angle, impact)
    return np.max(np.abs(np.broadcast_arrays(*differences)), axis=0)
