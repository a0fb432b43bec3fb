"""Further elementary functions whose results have the same digits on every processor.

They are made like those of :mod:`bouncing_ball.numerics.elementary`, which says why.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.numerics.elementary import arrays, polynomial, sine_and_versine

# ln 2 = _LN2_HIGH + _LN2_LOW, of which the product of the first with an exponent is exact.
_LN2_HIGH = np.array(0.693145751953125)
_LN2_LOW = np.array(1.42860682030941723212e-6)
_LOG2E = np.array(1 / math.log(2))
_ONE = np.array(1.0)
_TWO = np.array(2.0)
# Below the first exponent e^x is 0; above the second it is not computed.
_LEAST_EXPONENT = np.array(-746.0)
_LARGEST_EXPONENT = np.array(709.0)
# The bits of a double: the smallest power of two, its bias, and the number of places below it.
_LEAST_POWER = np.array(-1023.0)
_BIAS = np.array(1023)
_PLACES = np.array(52)
# Coefficients of the numerator and denominator, from the highest power down.
_EXP = arrays(
    (1.26177193074810590878e-4, 3.02994407707441961300e-2, 9.99999999999999999910e-1),
    (3.00198505138664455042e-6, 2.52448340349684104192e-3, 2.27265548208155028766e-1, 2.0),
)
# Coefficients of the power series of ln((1 + f)/(1 - f))/2f in f², for |f| ≤ 3 - 2√2.
(_LOG,) = arrays([1 / (2 * k + 1) for k in range(12, -1, -1)])


def sine_and_cosine(angle: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """sin x and cos x; the cosine has an absolute error of the order of rounding.

    Examples
    --------
    >>> sine, cosine = sine_and_cosine([0.0, np.pi])
    >>> abs(sine.round(15)).tolist(), cosine.tolist()
    ([0.0, 0.0], [1.0, -1.0])
    """
    sine, versine = sine_and_versine(angle)
    return sine, _ONE - versine


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
    odd = rest * polynomial(_EXP[0], square)
    value = _ONE + _TWO * (odd / (polynomial(_EXP[1], square) - odd))
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
    series = 2 * f + 2 * f * square * polynomial(_LOG[:-1], square)
    return power * _LN2_HIGH + (power * _LN2_LOW + series)
