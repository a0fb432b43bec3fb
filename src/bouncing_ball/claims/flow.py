r"""The contact's equation of motion by the matrix exponential.

With the table's sine and cosine as states of their own it is linear::

    (z, z′, 1, cos τ, sin τ)′ = M (z, z′, 1, cos τ, sin τ)

so that nothing of the paper's closed forms enters.
"""

import numpy as np
from scipy.linalg import expm


def matrix(stiffness, loss, gravity, amplitude, frequency=1.0):
    """M of z″ = -g - c (z′ - w′) - k (z - w), w = a sin Ωt; shape (..., 5, 5)."""
    k, c, g, a, big_omega = np.broadcast_arrays(stiffness, loss, gravity, amplitude, frequency)
    m = np.zeros((*k.shape, 5, 5))
    m[..., 0, 1] = 1
    m[..., 1, 0], m[..., 1, 1], m[..., 1, 2] = -k, -c, -g
    m[..., 1, 3], m[..., 1, 4] = c * a * big_omega, k * a
    m[..., 3, 4], m[..., 4, 3] = -big_omega, big_omega
    return m


def contact_matrix(frequency_ratio, damping_ratio, amplitude, gravity=1.0):
    """M of Eq. 11: k = ϖ², c = 2ζϖ, a = Λ, Ω = 1, and a gravity of 1 or none."""
    loss = 2 * np.asarray(damping_ratio) * frequency_ratio
    return matrix(np.square(frequency_ratio), loss, gravity, amplitude)


def fall_matrix(gravity=1.0):
    """M of the free fall, z″ = -g."""
    return matrix(0.0, 0.0, gravity, 0.0)


def state(height, velocity, phase):
    """The state at a phase of the table, shape (..., 5)."""
    return np.stack(
        np.broadcast_arrays(height, velocity, 1.0, np.cos(phase), np.sin(phase)), axis=-1
    ).astype(float)


def flow(m, time, start):
    """The state after a time, e^{Mt} times the start.

    Examples
    --------
    A ball thrown up at 3 is back after 6, falling as fast:

    >>> round(float(flow(fall_matrix(), 6.0, state(0.0, 3.0, 0.0))[1]), 12)
    -3.0
    """
    time = np.asarray(time)[..., np.newaxis, np.newaxis]
    return np.squeeze(expm(m * time) @ start[..., np.newaxis], -1)
