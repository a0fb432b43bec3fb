"""Elementary functions whose results have the same digits on every processor.

For its sine numpy chooses the library that is fastest on the processor, and the results of these
libraries differ in the last digit. In a chaotic motion such a difference grows.
Addition, multiplication, division and the square root are rounded in the same way on every
processor (IEEE 754). The functions here use only these operations: a reduction of the argument and
a rational approximation (S. L. Moshier, Cephes; W. J. Cody and W. Waite). Their errors are a few
units in the last place of the result, or of 1 near a zero of the function.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

# The constants are arrays without an axis, because numpy converts a Python float again in each
# operation, which takes as long as the operation on a few hundred elements.
# 2π = _TURN_HIGH + _TURN_LOW, where _TURN_HIGH has 33 significant bits, so that its product with
# any integer below 2²⁰ is exact (Cody and Waite).
_TURN_HIGH = np.array(float.fromhex("0x1.921fb544p+2"))
_TURN_LOW = np.array(float.fromhex("0x1.0b4611a626331p-32"))
_TURNS = np.array(1 / (2 * np.pi))
_QUARTER = np.array(0.25)
_ZERO = np.array(0.0)
_ONE = np.array(1.0)
_TWO = np.array(2.0)
# The slope above which an angle is computed from that of the diagonal, and fractions of a turn.
_STEEP = np.array(0.66)
_EIGHTH_TURN = np.array(np.pi / 4)
_QUARTER_TURN = np.array(np.pi / 2)
_HALF_TURN = np.array(np.pi)


def arrays(*rows: Sequence[float]) -> list[list[np.ndarray]]:
    """Rows of constants as arrays without an axis."""
    return [[np.array(x) for x in row] for row in rows]


# Coefficients of the numerators and denominators, from the highest power down.
_TAN = arrays(
    (-1.30936939181383734205e4, 1.15351664838587416140e6, -1.79565251976484877988e7),
    (1.0, 1.36812963470692954678e4, -1.32089234440210967447e6, 2.50083801823357915839e7,
     -5.38695755929454629881e7),
)  # fmt: skip
_ATAN = arrays(
    (-8.750608600031904122785e-1, -1.615753718733365076637e1, -7.500855792314704667340e1,
     -1.228866684490136173410e2, -6.485021904942025371773e1),
    (1.0, 2.485846490142306297962e1, 1.650270098316988542046e2, 4.328810604912902668951e2,
     4.853903996359136964868e2, 1.945506571482613964425e2),
)  # fmt: skip


def polynomial(coefficients: Sequence[np.ndarray], x: np.ndarray) -> np.ndarray:
    """The polynomial at x by Horner's scheme, from the coefficient of the highest power down."""
    value = coefficients[0] * x + coefficients[1]
    for coefficient in coefficients[2:]:
        value *= x
        value += coefficient
    return value


def reduce_angle(angle: np.ndarray) -> np.ndarray:
    """The angle modulo 2π, in [-π, π], accurate to the last digit up to 10⁶ turns.

    Examples
    --------
    The second result is the difference between the double nearest to 2π and 2π:

    >>> float(reduce_angle(-1.0)), round(1e16 * float(reduce_angle(2 * np.pi)), 6)
    (-1.0, -2.449294)
    """
    turns = np.rint(angle * _TURNS)
    return (angle - turns * _TURN_HIGH) - turns * _TURN_LOW


def sine_and_versine(angle: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """sin x and 1 - cos x, the latter without cancellation for small x.

    Both are computed from the tangent of x/4 by doubling the angle twice.

    Examples
    --------
    >>> sine, versine = sine_and_versine(np.array([0.0, 1e-9]))
    >>> sine.tolist(), versine.tolist()
    ([0.0, 1e-09], [0.0, 5e-19])
    """
    quarter = _QUARTER * reduce_angle(np.asarray(angle, dtype=float))
    square = quarter * quarter
    tangent = quarter + quarter * (
        square * polynomial(_TAN[0], square) / polynomial(_TAN[1], square)
    )
    scale = _TWO / (_ONE + tangent * tangent)
    half = tangent * scale
    double = _TWO * half
    return double * (_ONE - tangent * half), double * half


def arctangent(y: ArrayLike, x: ArrayLike) -> np.ndarray:
    """The angle of the point (x, y), in [-π, π].

    Examples
    --------
    >>> arctangent([1.0, -1.0, 0.0], [1.0, 0.0, -1.0]).tolist() == [np.pi / 4, -np.pi / 2, np.pi]
    True
    """
    up = np.abs(y)
    along = np.abs(x)
    large = np.maximum(up, along)
    small = np.minimum(up, along)
    steep = small > _STEEP * large
    above = np.where(steep, small - large, small)
    below = np.where(steep, small + large, large)
    t = above / np.where(below > _ZERO, below, _ONE)
    square = t * t
    angle = t + t * (square * polynomial(_ATAN[0], square) / polynomial(_ATAN[1], square))
    angle = np.where(steep, _EIGHTH_TURN + angle, angle)
    angle = np.where(up > along, _QUARTER_TURN - angle, angle)
    angle = np.where(np.asarray(x) < _ZERO, _HALF_TURN - angle, angle)
    return np.copysign(angle, y)
