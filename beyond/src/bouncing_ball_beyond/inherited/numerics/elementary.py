"""Elementary functions whose results have the same digits on every processor.

For its sine and exponential numpy chooses the library that is fastest on the processor, and the
results of these libraries differ in the last digit. In a chaotic motion such a difference grows.
Addition, multiplication, division and the square root are rounded in the same way on every
processor (IEEE 754). The functions here use only these operations: a reduction of the argument and
a rational approximation (S. L. Moshier, Cephes; W. J. Cody and W. Waite). Their errors are a few
units in the last place of the result, or of 1 near a zero of the function.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

# The constants are arrays without an axis, because numpy converts a Python float again in each
# operation, which takes as long as the operation on a few hundred elements.
# 2π = _TURN_HIGH + _TURN_LOW, where _TURN_HIGH has 33 significant bits, so that its product with
# any integer below 2²⁰ is exact (Cody and Waite). ln 2 is split in the same way.
_TURN_HIGH = np.array(float.fromhex("0x1.921fb544p+2"))
_TURN_LOW = np.array(float.fromhex("0x1.0b4611a626331p-32"))
_TURNS = np.array(1 / (2 * np.pi))
_LN2_HIGH = np.array(0.693145751953125)
_LN2_LOW = np.array(1.42860682030941723212e-6)
_LOG2E = np.array(1 / math.log(2))
_QUARTER = np.array(0.25)
_ZERO = np.array(0.0)
_ONE = np.array(1.0)
_TWO = np.array(2.0)
# Below the first exponent e^x is 0; above the second it is not computed.
_LEAST_EXPONENT = np.array(-746.0)
_LARGEST_EXPONENT = np.array(709.0)
# The slope above which an angle is computed from that of the diagonal, and fractions of a turn.
_STEEP = np.array(0.66)
_EIGHTH_TURN = np.array(np.pi / 4)
_QUARTER_TURN = np.array(np.pi / 2)
_HALF_TURN = np.array(np.pi)
# The bits of a double: the smallest power of two, its bias, and the number of places below it.
_LEAST_POWER = np.array(-1023.0)
_BIAS = np.array(1023)
_PLACES = np.array(52)


def _arrays(*rows: Sequence[float]) -> list[list[np.ndarray]]:
    return [[np.array(x) for x in row] for row in rows]


# Coefficients of the numerators and denominators, from the highest power down.
_TAN = _arrays(
    (-1.30936939181383734205e4, 1.15351664838587416140e6, -1.79565251976484877988e7),
    (1.0, 1.36812963470692954678e4, -1.32089234440210967447e6, 2.50083801823357915839e7,
     -5.38695755929454629881e7),
)  # fmt: skip
_EXP = _arrays(
    (1.26177193074810590878e-4, 3.02994407707441961300e-2, 9.99999999999999999910e-1),
    (3.00198505138664455042e-6, 2.52448340349684104192e-3, 2.27265548208155028766e-1, 2.0),
)
_ATAN = _arrays(
    (-8.750608600031904122785e-1, -1.615753718733365076637e1, -7.500855792314704667340e1,
     -1.228866684490136173410e2, -6.485021904942025371773e1),
    (1.0, 2.485846490142306297962e1, 1.650270098316988542046e2, 4.328810604912902668951e2,
     4.853903996359136964868e2, 1.945506571482613964425e2),
)  # fmt: skip
# Coefficients of the power series of ln((1 + f)/(1 - f))/2f in f², for |f| ≤ 3 - 2√2.
(_LOG,) = _arrays([1 / (2 * k + 1) for k in range(12, -1, -1)])


def _polynomial(coefficients: Sequence[np.ndarray], x: np.ndarray) -> np.ndarray:
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
        square * _polynomial(_TAN[0], square) / _polynomial(_TAN[1], square)
    )
    scale = _TWO / (_ONE + tangent * tangent)
    half = tangent * scale
    double = _TWO * half
    return double * (_ONE - tangent * half), double * half


def exponential(x: ArrayLike) -> np.ndarray:
    """e^x for x ≤ 709, and e^709 above; 0 where e^x is below 2^-1022.5.

    Examples
    --------
    >>> exponential([0.0, -1e3]).tolist()
    [1.0, 0.0]
    """
    clipped = np.minimum(np.maximum(x, _LEAST_EXPONENT), _LARGEST_EXPONENT)
    power = np.rint(clipped * _LOG2E)
    rest = (clipped - power * _LN2_HIGH) - power * _LN2_LOW
    square = rest * rest
    odd = rest * _polynomial(_EXP[0], square)
    value = _ONE + _TWO * (odd / (_polynomial(_EXP[1], square) - odd))
    # 2^power is assembled from its bits.
    scale = ((np.maximum(power, _LEAST_POWER).astype(np.int64) + _BIAS) << _PLACES).view(np.float64)
    return value * scale


def logarithm(x: ArrayLike) -> np.ndarray:
    """ln x for x > 0.

    Examples
    --------
    >>> logarithm([1.0, 2.0]).tolist() == [0.0, math.log(2)]
    True
    """
    fraction, power = np.frexp(np.asarray(x, dtype=float))
    low = fraction < math.sqrt(0.5)
    fraction = np.where(low, 2 * fraction, fraction)
    power = power - low
    f = (fraction - 1) / (fraction + 1)
    square = f * f
    series = 2 * f + 2 * f * square * _polynomial(_LOG[:-1], square)
    return power * _LN2_HIGH + (power * _LN2_LOW + series)


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
    angle = t + t * (square * _polynomial(_ATAN[0], square) / _polynomial(_ATAN[1], square))
    angle = np.where(steep, _EIGHTH_TURN + angle, angle)
    angle = np.where(up > along, _QUARTER_TURN - angle, angle)
    angle = np.where(np.asarray(x) < _ZERO, _HALF_TURN - angle, angle)
    return np.copysign(angle, y)
