"""Orbits on a linear contact whose touch has a given phase, on tables of three waveforms.

At a given phase of the touch, the amplitude Λ is an unknown beside the closing speed and the
duration of the contact. For a sine this is the branch by which the article computes exact values.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.contacts.balls import SpringDamper
from bouncing_ball_beyond.periodic.equations import OrbitEquations
from bouncing_ball_beyond.periodic.march import newton
from bouncing_ball_beyond.tables.table import SINE, Table

WAVEFORMS: dict[str, Table] = {
    "sine": SINE,
    "three harmonics": Table([(1, 1.0, 0.0), (2, 0.17, 0.8), (3, 0.05, -1.1)]),
    "skewed": Table([(1, 1.0, 0.0), (2, 0.25, 2.5)]),
}
"""Tables whose W′ has one nondegenerate maximum."""


class ContactOrbits(NamedTuple):
    """Orbits on a contact: arrays over the phase of the touch."""

    amplitude: NDArray
    closing_speed: NDArray
    duration: NDArray
    max_height: NDArray


def contact_orbits(table: Table, phase: NDArray, ball: SpringDamper, n: int) -> ContactOrbits:
    """The orbits of period 2πn whose contacts start at given phases, by Newton's method.

    NaN where it does not converge.

    >>> ball = SpringDamper(1e4, restitution=0.5)
    >>> round(float(contact_orbits(SINE, np.array([0.5]), ball, 1).amplitude[0]), 3)
    1.193
    """
    signature = ball.signature(1.0)
    speed = 2 * np.pi * n / (1 + signature.restitution)
    amplitude = (speed - np.pi * n) / table(phase + signature.centroid, 1)
    columns = np.broadcast_arrays(phase, speed, ball.free(speed), amplitude)
    equations = OrbitEquations(ball, 1, n, table=table)
    at_phase = np.zeros((len(phase), 4))
    at_phase[:, 0] = 1.0
    solution = newton(equations, np.stack(columns, axis=-1), at_phase, iterations=40)
    z = np.where(solution.converged[:, np.newaxis], solution.z, np.nan)
    height = equations.max_height(z)
    return ContactOrbits(z[:, 3], z[:, 1], z[:, 2] / ball.frequency_ratio, height)
