"""Numbers of the size of rounding, as text that is the same on every processor."""

import numpy as np
from numpy.typing import ArrayLike

# The rounding error of a finite difference, √ε: at most at this size the digits of a number
# may come from the processor and not from the model.
ROUNDING_SIZE = float(np.sqrt(np.finfo(float).eps))

# Distances that differ by less are equal. They are given in units of a last
# printed digit, computed to 1e-8 and printed to 1e-2.
_SAME = 1e-6


def levels(values: ArrayLike) -> np.ndarray:
    """For each value the number of distinct smaller ones; values equal up to rounding count as one.

    Decimals are not cut off, because rounding would then decide about values near a decimal.

    Examples
    --------
    >>> levels([2.0, 1.0, 1.0 + 1e-12, np.inf]).tolist()
    [1, 0, 0, 2]
    """
    values = np.asarray(values, dtype=float)
    order = np.argsort(values)
    ranked = values[order]
    # Two infinite values are equal, which their difference would not show.
    apart = ranked[1:] > ranked[:-1] + _SAME
    found = np.empty(values.shape, dtype=int)
    found[order] = np.concatenate([[0], np.cumsum(apart)])
    return found


def compared_text(value: float, bound: float, form: str = ".4g") -> str:
    """The text of a number that is compared with a bound.

    A number within a bound of the size of rounding is rounding itself: its digits change with the
    processor, and only the bound is printed. Any other number is printed.

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
