r"""Spectral integration along a contact whose motion is singular at its two ends.

Time in contact is ``t = D S(x)``, x from 0 to 1, with S′ proportional to
``[x (1 - x)]^{m-1}``. Near both ends t is proportional to x^m, so that a function of t^{1/m} is
analytic in x. It is represented by its values at Gauss-Legendre nodes. With ``B = D A``, the first
and the second integral of the acceleration A are each a product with one matrix ::

    p′ = v + U B,              p = D (v S + P B)                    x ≤ 1/2
    p′ = p′_e + U B,           p = p_e + D (-p′_e (1 - S) + P B)    x > 1/2

The second form starts from the end of the contact, so that p keeps its relative
accuracy where it vanishes.
"""

from functools import lru_cache
from math import comb
from typing import NamedTuple

import numpy as np


class Scheme(NamedTuple):
    """Nodes and matrices of the spectral integration.

    ``node`` is x, ``share`` and ``rest`` are S and 1 - S at the nodes, ``rate`` and ``path`` the
    matrices U and P above. Over the entire contact ``gain @ B`` is the change of p′, and
    ``D lift @ B`` is added to p. ``spectrum`` turns B into its Legendre coefficients, and ``early``
    marks x ≤ 1/2.
    """

    node: np.ndarray
    share: np.ndarray
    rest: np.ndarray
    rate: np.ndarray
    path: np.ndarray
    gain: np.ndarray
    lift: np.ndarray
    spectrum: np.ndarray
    early: np.ndarray


def share(x: np.ndarray, root: int) -> np.ndarray:
    """S(x) for m = ``root``, as a sum of positive terms, which is accurate as x → 0.

    Examples
    --------
    >>> share(np.array([0.0, 0.5, 1.0]), 2).tolist()
    [0.0, 0.5, 1.0]
    """
    degree = 2 * root - 1
    terms = (comb(degree, j) * x**j * (1 - x) ** (degree - j) for j in range(root, degree + 1))
    return sum(terms)


def share_rate(x: np.ndarray, root: int) -> np.ndarray:
    """S′(x) for m = ``root``.

    Examples
    --------
    >>> share_rate(np.array([0.0, 0.5]), 2).tolist()
    [0.0, 1.5]
    """
    degree = 2 * root - 1
    return degree * comb(degree - 1, root - 1) * (x * (1 - x)) ** (root - 1)


@lru_cache(maxsize=32)
def scheme(count: int, root: int) -> Scheme:
    """The scheme with ``count`` nodes, an even number, for a law with m = ``root``.

    Examples
    --------
    A constant acceleration:

    >>> s = scheme(8, 2)
    >>> B = np.ones(8)
    >>> bool(np.allclose(s.gain @ B, 1)), bool(np.allclose(s.lift @ B, 0.5))
    (True, True)
    """
    y, w = np.polynomial.legendre.leggauss(count)
    x, w = (y + 1) / 2, w / 2
    x = np.where(x <= 0.5, x, 1 - x[::-1])
    degrees = 2 * np.arange(count) + 1
    spectrum = (degrees * np.polynomial.legendre.legvander(y, count - 1)).T * w
    # The integrands are polynomials of degree below count + 4m, which these points integrate
    # exactly.
    points, weights = np.polynomial.legendre.leggauss(count // 2 + 2 * root)
    points, weights = (points + 1) / 2, weights / 2
    s = share(x, root)
    half = count // 2
    rate, path = np.empty((count, count)), np.empty((count, count))
    for i in range(half):
        at = x[i] * points
        basis = np.polynomial.legendre.legvander(2 * at - 1, count - 1)
        push = x[i] * weights * share_rate(at, root)
        rate[i] = (push @ basis) @ spectrum
        path[i] = ((push * (s[i] - share(at, root))) @ basis) @ spectrum
    # Integrals from the end of the contact follow by symmetry; the sign of those for p′ changes.
    rate[half:] = -rate[:half][::-1, ::-1]
    path[half:] = path[:half][::-1, ::-1]
    gain = w * share_rate(x, root)
    rest = s[::-1]
    lift = gain * rest
    return Scheme(x, s, rest, rate, path, gain, lift, spectrum, np.arange(count) < half)
