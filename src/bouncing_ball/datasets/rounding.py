"""Numbers of the size of rounding, as text that is the same on every processor."""

import numpy as np
from numpy.typing import ArrayLike

# What rounding leaves of a finite difference: √ε, the largest size at which the
# digits of a number may be those of the processor and not of the model.
ROUNDING_SIZE = float(np.sqrt(np.finfo(float).eps))

# Distances closer than this are one distance. They are given in units of a last
# printed digit, are known to 1e-8 and are printed to 1e-2.
_SAME = 1e-6


def levels(values: ArrayLike) -> np.ndarray:
    """For each value the number of distinct smaller ones, equal ones being equal to rounding.

    Where rounding falls decides nothing, as it would if decimals were cut off.

    Examples
    --------
    >>> levels([2.0, 1.0, 1.0 + 1e-12, np.inf]).tolist()
    [1, 0, 0, 2]
    """
    values = np.asarray(values, dtype=float)
    order = np.argsort(values)
    ranked = values[order]
    # Two infinite values are the same.
    apart = ranked[1:] > ranked[:-1] + _SAME
    found = np.empty(values.shape, dtype=int)
    found[order] = np.concatenate([[0], np.cumsum(apart)])
    return found


def compared_text(value: float, bound: float, form: str = ".4g") -> str:
    """A number beside the bound that it is held against.

    A number that keeps within a bound of the size of rounding is rounding
    itself: its digits change with the processor, and the bound is all that it
    says. Any other number is printed.

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
