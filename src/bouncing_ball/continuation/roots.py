"""Roots of many functions of one variable in brackets, all at the same time.

Chandrupatla's method (T. R. Chandrupatla, Advances in Engineering Software 28, 1997): inverse
quadratic interpolation where it is safe, otherwise bisection. :mod:`scipy.optimize` has the same
method; importing it takes as long as all roots of a figure.
"""

from collections.abc import Callable

import numpy as np

_EPSILON = float(np.finfo(float).eps)


def bracketed_roots(
    function: Callable[[np.ndarray, np.ndarray], np.ndarray],
    low: np.ndarray,
    high: np.ndarray,
    close: float = 0.0,
) -> np.ndarray:
    """The root of each function between two points at which its sign differs.

    Parameters
    ----------
    function : callable
        Values, at points x, of the functions with given numbers; both have the shape (m,).
    low, high : ndarray, shape (k,)
    close : float
        Absolute error allowed, beside four units in the last place.

    Returns
    -------
    ndarray, shape (k,)
        Where the sign does not differ, the end with the smaller value.

    Examples
    --------
    >>> squares = np.array([1.0, 2.0, 9.0])
    >>> bracketed_roots(lambda x, k: x * x - squares[k], np.zeros(3), np.full(3, 2.0)).round(12)
    array([1.        , 1.41421356, 2.        ])
    """
    which = np.arange(low.size)
    a, b = (np.array(x, dtype=float) for x in (low, high))
    c, value_a, value_b = a, function(a, which), function(b, which)
    value_c, found = value_a, np.where(np.abs(value_a) < np.abs(value_b), a, b)
    left, share = np.flatnonzero((value_a > 0) != (value_b > 0)), np.full(low.size, 0.5)
    while left.size:
        which, share = which[left], share[left]
        a, b, value_a, value_b = (x[left] for x in (a, b, value_a, value_b))
        x = a + share * (b - a)
        value = function(x, which)
        same = (value > 0) == (value_a > 0)
        c, value_c = np.where(same, (a, value_a), (b, value_b))
        b, value_b = np.where(same, (b, value_b), (a, value_a))
        a, value_a = x, value
        best = np.where(np.abs(value_a) < np.abs(value_b), a, b)
        found[which] = best
        width, least = np.abs(b - a), 2 * _EPSILON * np.abs(best) + close / 2
        left = np.flatnonzero((value != 0) & (width > 2 * least))
        with np.errstate(all="ignore"):
            place, level = (a - b) / (c - b), (value_a - value_b) / (value_c - value_b)
            safe = (level**2 < place) & ((1 - level) ** 2 < 1 - place)
            quadratic = value_a / (value_b - value_a) * value_c / (value_b - value_c)
            quadratic += (
                (c - a) / (b - a) * value_a / (value_c - value_a) * value_b / (value_c - value_b)
            )
            edge = least / width
            share = np.clip(np.where(safe, quadratic, 0.5), edge, 1 - edge)
    return found
