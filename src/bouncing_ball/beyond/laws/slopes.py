"""Partial derivatives of the functions of a contact law, by imaginary steps."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

# The imaginary step, relative to p and absolute for p′; its square is lost in rounding.
_IMAGINARY = 1e-20


class Slopes(NamedTuple):
    """Partial derivatives of a function of (p, p′), arrays of the shape of the arguments."""

    by_penetration: np.ndarray
    by_rate: np.ndarray


def slopes_of(function: Callable, penetration: ArrayLike, rate: ArrayLike) -> Slopes:
    """Partial derivatives by imaginary steps, exact up to rounding for an analytic function.

    Examples
    --------
    >>> slopes = slopes_of(lambda p, u: p**1.5 * u, 4.0, 3.0)
    >>> round(float(slopes.by_penetration), 12), round(float(slopes.by_rate), 12)
    (9.0, 8.0)
    """
    p = np.asarray(penetration, dtype=float)
    u = np.asarray(rate, dtype=float)
    small = _IMAGINARY * np.where(p > 0, p, 1.0)
    by_penetration = np.imag(function(p + 1j * small, u)) / small
    by_rate = np.imag(function(p, u + 1j * _IMAGINARY)) / _IMAGINARY
    return Slopes(by_penetration, by_rate)
