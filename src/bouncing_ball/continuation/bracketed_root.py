"""Roots in brackets, of many functions of one variable at once.

The method of T. R. Chandrupatla (Adv. Eng. Softw. 28, 145-149, 1997): the parabola
through three points where it is safe, else the middle of the bracket. Steps and
tolerances are those of :func:`scipy.optimize.elementwise.find_root`, whose roots these
are bit by bit; without what it does for other kinds of arrays, which took longer than
our functions themselves, and without the import of ``scipy.optimize``, a fifth of a second.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

_FLOAT = np.finfo(float)
# Halving the widest bracket of numbers to the narrowest takes as many.
_MOST = int(_FLOAT.maxexp - _FLOAT.minexp + 1)


class _Bracket(NamedTuple):
    """The newest point, the other end of the bracket, and the point before them."""

    x1: np.ndarray
    f1: np.ndarray
    x2: np.ndarray
    f2: np.ndarray
    x3: np.ndarray
    f3: np.ndarray

    def take(self, which: np.ndarray) -> "_Bracket":
        return _Bracket(*(x[which] for x in self))

    def with_point(self, x: np.ndarray, f: np.ndarray) -> "_Bracket":
        """The bracket that a point within leaves."""
        same = np.sign(f) == np.sign(self.f1)
        return _Bracket(
            x,
            f,
            np.where(same, self.x2, self.x1),
            np.where(same, self.f2, self.f1),
            np.where(same, self.x1, self.x2),
            np.where(same, self.f1, self.f2),
        )

    def share(self) -> np.ndarray:
        """Where the next point is, from the newest one to the other end."""
        x1, f1, x2, f2, x3, f3 = self
        xi, phi = (x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2)
        safe = ((1 - np.sqrt(1 - xi)) < phi) & (phi < np.sqrt(xi))
        alpha = (x3 - x1) / (x2 - x1)
        parabola = f1 / (f1 - f2) * f3 / (f3 - f2) - alpha * f1 / (f3 - f1) * f2 / (f2 - f3)
        return np.where(safe, parabola, 0.5)


def bracketed_root(
    function: Callable[..., np.ndarray],
    left: np.ndarray,
    right: np.ndarray,
    args: Sequence[np.ndarray] = (),
) -> np.ndarray:
    """A root of each function between two points at which its signs differ.

    Parameters
    ----------
    function : callable
        Values at an array of points, given the arguments of the functions that are left.
    left, right : ndarray, shape (m,)
        The brackets.
    args : sequence of ndarray, shape (m,)
        Arguments of the m functions.

    Returns
    -------
    ndarray, shape (m,)
        To four units in the last place; NaN where the signs do not differ.

    Examples
    --------
    >>> squares = np.array([4.0, 9.0, -1.0])
    >>> bracketed_root(lambda x, s: x * x - s, np.zeros(3), np.full(3, 10.0), (squares,))
    array([ 2.,  3., nan])
    """
    root = np.full(np.shape(left), np.nan)
    now, args = np.arange(root.size), tuple(args)
    f1, f2 = function(left, *args), function(right, *args)
    at = _Bracket(left, f1, right, f2, right, f2)
    with np.errstate(all="ignore"):
        for step in range(_MOST):
            nearer = np.abs(at.f1) < np.abs(at.f2)
            best = np.where(nearer, at.x1, at.x2)
            zero = np.abs(np.where(nearer, at.f1, at.f2)) <= _FLOAT.smallest_normal
            valid = (np.sign(at.f1) != np.sign(at.f2)) & np.isfinite(at.x1) & np.isfinite(at.x2)
            valid &= ~(np.isnan(at.f1) & np.isnan(at.f2))
            width = np.abs(at.x2 - at.x1)
            within = np.abs(best) * 4 * _FLOAT.eps + 4 * _FLOAT.smallest_normal
            found = zero | (valid & (width < within))
            root[now[found]] = best[found]
            left_over = valid & ~found
            if not left_over.any():
                break
            if not left_over.all():
                at, now = at.take(left_over), now[left_over]
                args = tuple(x[left_over] for x in args)
                width, within = width[left_over], within[left_over]
            least = 0.5 * within / width
            share = np.clip(at.share(), least, 1 - least) if step else 0.5
            x = at.x1 + share * (at.x2 - at.x1)
            at = at.with_point(x, function(x, *args))
    return root
