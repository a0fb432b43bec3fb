r"""The motion in a contact with a linear spring and damper, in relative coordinates (Eqs. 10-13).

With δ = z - w, the ball in contact obeys ::

    δ″ + 2ζϖ δ′ + ϖ² δ = -1 + Λ sin(s + φ)

where s is the time since the contact started and φ the phase of the table at
that moment. The paper writes the solution with constants A and B, which are determined
by the start of contact. Here they are eliminated: the flow is affine in
(δ₀, δ′₀, Λ cos φ, Λ sin φ), and regular at the resonance ζ = 0, ϖ = 1::

    δ(s) = δ₀ (g′ + 2ζϖ g) + δ′₀ g - G + Λ cos φ · P + Λ sin φ · Q

with g the impulse response, G the response to a constant force and Q + iP
that to e^{is}, all from :mod:`bouncing_ball.models.oscillator`.

Its integrals over a contact follow from ϖ² δ = w - 1 - δ″ - l δ′ with l = 2ζϖ and the table
w = Λ sin τ. Integration by parts gives ::

    ϖ² ∫ δ dτ = -[w′ + δ′ + l δ] - D
    (ϖ² - 1) I + l J = [w²/2 - w - δ′ w′ - δ w - l δ w′],                 I = ∫ δ w′ dτ
    (ϖ² - 1) J - l I = Λ² D/2 + [w′ - w w′/2 - δ′ w + δ w′ - l δ w],      J = ∫ δ w dτ

All quantities are dimensionless: time Ωt, length Ω²y/g.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.models.oscillator import responses, steady_response


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


def change_in_contact(values: np.ndarray) -> np.ndarray:
    """The value at the end of a contact minus the value at its start."""
    return values[1] - values[0]


def integrals(
    frequency_ratio: ArrayLike,
    damping_ratio: ArrayLike,
    amplitude: np.ndarray | float,
    duration: np.ndarray | float,
    level: Any,
    gap: np.ndarray,
    rate: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """The integrals ∫ z dτ and ∫ z′ w dτ over contacts, away from ζ = 0, ϖ = 1.

    Parameters
    ----------
    frequency_ratio, damping_ratio, amplitude, duration : array_like
        ϖ, ζ, Λ and the duration D of the contacts.
    level : tuple of array
        w′ and w, each at the start and at the end of the contacts, shape (2, ...).
    gap, rate : array, shape (2, ...)
        δ and δ′ at the start and at the end.

    Examples
    --------
    On a table at rest z = δ, and the table does no work:

    >>> still, rate = np.zeros((2, 1)), np.array([[-1.0], [1.0]])
    >>> found = integrals(2.0, 0.0, 0.0, 2.0, (still, still), still, rate)
    >>> [float(x[0]) for x in found]
    [-1.0, 0.0]
    """
    w_rate, w = level
    omega = np.asarray(frequency_ratio, dtype=float)
    stiffness = omega**2
    loss = 2 * np.asarray(damping_ratio) * omega
    # The right-hand sides of the equations for I and J: a forcing whose steady response is J + iI.
    of_rate = change_in_contact(w * w / 2 - w - rate * w_rate - gap * w - loss * gap * w_rate)
    of_level = change_in_contact(w_rate - w * w_rate / 2 - rate * w + gap * w_rate - loss * gap * w)
    of_level = of_level + np.square(amplitude) * duration / 2
    s = stiffness - 1
    _, integral_of_rate = steady_response(of_level, of_rate, s, loss, s * s + loss * loss)
    integral_of_gap = -(change_in_contact(w_rate + rate + loss * gap) + duration) / stiffness
    height = integral_of_gap - change_in_contact(w_rate)
    work = change_in_contact(gap * w + w * w / 2) - integral_of_rate
    return height, work
