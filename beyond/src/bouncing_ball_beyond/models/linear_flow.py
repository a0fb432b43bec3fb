r"""The motion in a contact with a linear spring and damper, in relative coordinates (Eqs. 10-13).

With δ = z - w, the ball in contact obeys ::

    δ″ + 2ζϖ δ′ + ϖ² δ = -1 + Λ sin(s + φ)

where s is the time since the contact started and φ the phase of the table at
that moment. The paper writes the solution with constants A and B, which are determined
by the start of contact. Here they are eliminated: the flow is affine in
(δ₀, δ′₀, Λ cos φ, Λ sin φ), and regular at the resonance ζ = 0, ϖ = 1::

    δ(s) = δ₀ (g′ + 2ζϖ g) + δ′₀ g - G + Λ cos φ · P + Λ sin φ · Q

with g the impulse response, G the response to a constant force and Q + iP
that to e^{is}, all from :mod:`bouncing_ball_beyond.models.oscillator`.

All quantities are dimensionless: time Ωt, length Ω²y/g.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.models.oscillator import responses


class ContactFlow(NamedTuple):
    """δ, δ′ and δ″ after a time in contact, arrays of one shape."""

    displacement: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray


def flow(
    frequency_ratio: ArrayLike,
    damping_ratio: ArrayLike,
    time: ArrayLike,
    displacement: ArrayLike,
    velocity: ArrayLike,
    phase: ArrayLike,
    amplitude: ArrayLike,
) -> ContactFlow:
    """The relative state of the ball a time s after (δ₀, δ′₀), in contact (Eqs. 12-13).

    Parameters
    ----------
    frequency_ratio, damping_ratio : array_like
        ϖ and ζ.
    time, displacement, velocity, phase, amplitude : array_like
        s, δ₀, δ′₀, the table's phase φ at the start, and Λ.

    Returns
    -------
    ContactFlow
        Its fields have the shape to which the arguments broadcast.
    """
    state = time, displacement, velocity, phase, amplitude
    columns = (*state, frequency_ratio, damping_ratio)
    rows = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in columns))
    s, d0, v0, phi, lam, omega, zeta = rows
    loss = 2 * zeta * omega
    stiffness = omega * omega
    g, G, h = responses(s, omega, zeta)
    drive = lam * np.exp(1j * phi)
    d = d0 * (g.rate + loss * g.value) + v0 * g.value - G.value + np.imag(drive * h.value)
    v = v0 * g.rate - d0 * stiffness * g.value - G.rate + np.imag(drive * h.rate)
    acc = lam * np.sin(s + phi) - 1 - loss * v - stiffness * d
    return ContactFlow(d, v, acc)
