"""Texts and ranks of numbers that are the same on every processor in spite of rounding."""

import numpy as np
from numpy.typing import ArrayLike

# The rounding error of a finite difference, √ε. The digits of a number up to this size may come
# from the processor and not from the model.
ROUNDING_SIZE = float(np.sqrt(np.finfo(float).eps))
# Values that differ by less count as equal. They are in units of a last printed digit, computed to
# 1e-8 and printed to 1e-2.
_SAME = 1e-6


def levels(values: ArrayLike) -> np.ndarray:
    """For each value, the number of distinct smaller values; equal up to rounding is not distinct.

    Values are not rounded to decimals, because rounding errors would decide about a value halfway
    between two decimals.

    Examples
    --------
    >>> levels([2.0, 1.0, 1.0 + 1e-12, np.inf]).tolist()
    [1, 0, 0, 2]
    """
    values = np.asarray(values, dtype=float)
    order = np.argsort(values)
    ranked = values[order]
    # A comparison, because the difference of two infinite values, which are equal, is NaN.
    apart = ranked[1:] > ranked[:-1] + _SAME
    found = np.empty(values.shape, dtype=int)
    found[order] = np.concatenate([[0], np.cumsum(apart)])
    return found


def compared_text(value: float, bound: float, form: str = ".4g") -> str:
    """The text of a number that is compared with a bound.

    If the bound is of the size of rounding and the number is within it, the digits of the number
    depend on the processor, and the bound is printed instead. Any other number is printed.

    Examples
    --------
    >>> compared_text(4.5e-13, 1e-11), compared_text(0.0884, 1e-8)
    ('≤ 1e-11', '0.0884')
    >>> compared_text(9.834e-06, 2e-05), compared_text(0.0, 0.0)
    ('9.834e-06', '0')
    """
    if 0 < bound <= ROUNDING_SIZE and abs(value) <= bound:
        return f"≤ {bound:g}"
    return f"{value:{form}}"
