"""Sine, cosine and reduction of angles, for large arrays.

With t = tan(x/2), ``sin x = 2t/(1 + t²)`` and ``1 - cos x = 2t²/(1 + t²)``, so that
one tangent replaces a sine and a cosine. NumPy computes it with vector
instructions where the processor has them, which it does not do for the sine
in double precision; elsewhere it costs no more than the two calls.
"""

import numpy as np

# 2π = _TURN_HIGH + _TURN_LOW, of which the first has 33 significant bits, so that its
# product with any integer below 2²⁰ is exact (Cody and Waite).
_TURN_HIGH = float.fromhex("0x1.921fb544p+2")
_TURN_LOW = float.fromhex("0x1.0b4611a626331p-32")
_TURNS = 1 / (2 * np.pi)


def sine_and_versine(angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """sin x and 1 - cos x, the latter without cancellation for small x.

    Examples
    --------
    >>> sine, versine = sine_and_versine(np.array([0.0, 1e-9]))
    >>> sine.tolist(), versine.tolist()
    ([0.0, 1e-09], [0.0, 5e-19])
    """
    tangent = np.tan(0.5 * angle)
    square = tangent * tangent
    scale = 2 / (1 + square)
    return tangent * scale, square * scale


def table(phase: np.ndarray, amplitude: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
    """Λ cos φ and Λ sin φ: velocity and height of the table, and minus its jerk and acceleration.

    Examples
    --------
    >>> [float(x) for x in table(np.zeros(()), 2.0)]
    [2.0, 0.0]
    """
    sine, versine = sine_and_versine(phase)
    return amplitude * (1 - versine), amplitude * sine


def reduce_angle(angle: np.ndarray) -> np.ndarray:
    """The angle modulo 2π, in [-π, π], to the last digit up to 10⁶ turns.

    Examples
    --------
    The second result is the difference between 2π and the double nearest to it:

    >>> float(reduce_angle(-1.0)), round(1e16 * float(reduce_angle(2 * np.pi)), 6)
    (-1.0, -2.449294)
    """
    turns = np.rint(angle * _TURNS)
    return (angle - turns * _TURN_HIGH) - turns * _TURN_LOW
