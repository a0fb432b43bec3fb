"""Orbits on a linear contact whose table moves with any waveform, as an explicit curve.

The table moves as ΛW(τ), where W is a sum of harmonics a sin(kτ + p). At a given phase φ of the
touch, the conditions of velocity and of landing are linear in Λ and in the closing speed u, and the
condition of release, δ = 0, gives the duration D of the contact. For a sine this is the branch by
which the article computes exact values.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.optimize.elementwise import find_root

from bouncing_ball_beyond.balls import SpringDamper


@dataclass(frozen=True)
class Waveform:
    """W(τ) = Σ a sin(kτ + p) by its harmonics (k, a, p)."""

    harmonics: tuple[tuple[int, float, float], ...]

    def __call__(self, time: NDArray | float, order: int = 0) -> NDArray:
        """W or a derivative of it.

        >>> round(float(Waveform(((1, 1.0, 0.0),))(0.0, 1)), 9)
        1.0
        """
        turned = order * np.pi / 2
        parts = [a * k**order * np.sin(k * time + p + turned) for k, a, p in self.harmonics]
        return np.sum(parts, axis=0)

    @property
    def steepest(self) -> float:
        """The phase at which W′ is largest."""
        grid = np.linspace(-np.pi, np.pi, 721)
        start = grid[self(grid, 1).argmax()]
        return float(brentq(lambda time: self(time, 2), start - 0.1, start + 0.1, xtol=1e-15))

    def falling(self, slope: NDArray) -> NDArray:
        """The phases after the steepest one at which W′ has fallen to given values."""
        start = np.full(np.shape(slope), self.steepest)
        # The waveforms below fall at least that far in a radian.
        return find_root(lambda time, s: self(time, 1) - s, (start, start + 1), args=(slope,)).x


WAVEFORMS = {
    "sine": Waveform(((1, 1.0, 0.0),)),
    "three harmonics": Waveform(((1, 1.0, 0.0), (2, 0.17, 0.8), (3, 0.05, -1.1))),
    "skewed": Waveform(((1, 1.0, 0.0), (2, 0.25, 2.5))),
}
"""Tables whose W′ has one nondegenerate maximum."""


class ContactOrbits(NamedTuple):
    """Orbits on a contact: arrays over the phase of the touch."""

    amplitude: NDArray
    closing_speed: NDArray
    duration: NDArray
    max_height: NDArray


def contact_orbits(waveform: Waveform, phase: NDArray, ball: SpringDamper, n: int) -> ContactOrbits:
    """The orbits of period 2πn whose contacts start at given phases and end at δ = 0.

    With the responses g and G of δ″ + 2ζϖδ′ + ϖ²δ to a unit impulse and a unit force, and ΛA to the
    table, δ = -ug - G + ΛA.
    """
    ratio = ball.frequency_ratio
    zeta = ball.zeta
    free = ball.signature(1.0).duration
    here = waveform(phase), waveform(phase, 1)

    def solved(duration: NDArray, phase: NDArray, height: NDArray, slope: NDArray):
        """Λ, u, and the gap at the end of a contact of a given duration."""
        g, g_rate, load, drive, drive_rate = responses(waveform, duration, phase, ratio, zeta)
        flight = 2 * np.pi * n - duration
        # Velocity: u (1 - g′) + Λ (A′ + W′(φ + D) - W′(φ)) = g + L.
        speed_part = 1 - g_rate
        table_part = drive_rate + waveform(phase + duration, 1) - slope
        gained = g + flight
        # Landing: -uL + Λ (W(φ + D) - W(φ) + W′(φ) L) = -L²/2.
        risen = waveform(phase + duration) - height + slope * flight
        determinant = speed_part * risen + table_part * flight
        u = (gained * risen + table_part * flight**2 / 2) / determinant
        amplitude = (gained * flight - speed_part * flight**2 / 2) / determinant
        return amplitude, u, -u * g - load + amplitude * drive

    bracket = np.full(phase.shape, 0.8 * free), np.full(phase.shape, 1.2 * free)
    given = (phase, *here)
    duration = find_root(lambda *values: solved(*values)[2], bracket, args=given).x
    amplitude, u, _ = solved(duration, *given)
    bounce = amplitude * here[1] - u + 2 * np.pi * n - duration
    height = amplitude * waveform(phase + duration) + bounce**2 / 2
    return ContactOrbits(amplitude, u, duration, height)


def responses(waveform: Waveform, time: NDArray, phase: NDArray, ratio, zeta) -> tuple:
    """g, g′, G, A and A′ a time after rest; A is the response to -W″(φ + τ)."""
    loss = 2 * zeta * ratio
    omega = ratio * np.sqrt((1 - zeta) * (1 + zeta))
    decay = np.exp(-zeta * ratio * time)
    g = decay * np.sin(omega * time) / omega
    rate = decay * np.cos(omega * time) - zeta * ratio * g
    second = -loss * rate - ratio**2 * g
    drive = drive_rate = 0.0
    for k, a, p in waveform.harmonics:
        turn = np.exp(1j * k * time)
        scale = ratio**2 - k**2 + 1j * k * loss
        strength = a * k**2 * np.exp(1j * (k * phase + p)) / scale
        drive += np.imag(strength * (turn - rate - (1j * k + loss) * g))
        drive_rate += np.imag(strength * (1j * k * turn - second - (1j * k + loss) * rate))
    return g, rate, (1 - rate - loss * g) / ratio**2, drive, drive_rate
