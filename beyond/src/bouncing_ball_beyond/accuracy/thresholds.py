r"""The frequency ratio ϖ above which an error stays within a tolerance (Eqs. 37-38).

The paper calls the errors of the greatest height h and of the threshold of permanent contact PC

    |h_SD(ϖ) - h_CR| / h_CR    (Eq. 37),        |Λ_SD(ϖ) - Λ_CR| / Λ_CR    (Eq. 38),

and ϖ_h,1% and ϖ_PC,1% the values of ϖ at which they are 1 %. Here the threshold of any quantity is
the largest ϖ in a scanned range at which the modulus of its error crosses the tolerance. Where a
model lacks the quantity, the error is infinite. The functions here find the thresholds and zeros of
any errors; :func:`~bouncing_ball_beyond.accuracy.simple_models.search` finds those of simple
models.
"""

from collections.abc import Callable, Sequence
from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.accuracy.errors import OF_ORBITS, modulus

Numbered = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Values, at ratios ϖ, of the functions with given numbers; all three arrays have one shape."""

ErrorsAtRatios = Callable[[np.ndarray, np.ndarray, Sequence[str]], np.ndarray]
"""Signed errors of quantities, shape (quantity, m), at ratios ϖ of rows, shape (m,)."""
RATIOS = np.geomspace(1.0, 1e6, 97)
"""ϖ at which errors are scanned, from contacts that last a considerable part of the table's period
to contacts stiffer than those of any simulation. The steps are fine, so that two crossings hardly
fall between neighbours.
"""
# Errors are bounded for the root finder, because they may be zero or infinite.
_SMALLEST, _LARGEST = 1e-300, 1e3
# Tolerance of ln ϖ: rounding an error of 0.1 % moves its threshold by about this much.
_CLOSE = 1e-13


class ThresholdStatus(StrEnum):
    """Outcome of the search for a threshold: found, within the tolerance at every ϖ scanned, or
    outside it at the largest.
    """

    FOUND = "found"
    ALWAYS_WITHIN = "within"
    NEVER_WITHIN = "outside"


class Thresholds(NamedTuple):
    """Thresholds and the outcomes of the searches for them, arrays of one shape."""

    ratio: np.ndarray
    """ϖ; NaN where the status is not ``FOUND``."""
    status: np.ndarray


def last_crossing(function: Numbered, ratios: np.ndarray, scanned: np.ndarray) -> np.ndarray:
    """The largest ϖ at which each function changes its sign.

    The last change between two samples is located to the last digit; an even
    number of changes between two samples is not noticed.

    Parameters
    ----------
    function : callable
        Values, at ratios ϖ, of the functions with given numbers; see :data:`Numbered`.
    ratios : ndarray, shape (N,)
        Increasing grid.
    scanned : ndarray, shape (k, N)
        The k functions on the grid; a change next to a NaN does not count.

    Returns
    -------
    ndarray, shape (k,)
        NaN for a function that does not change its sign.

    Examples
    --------
    >>> grid, levels = np.geomspace(1, 1e4, 9), np.array([0.01, 2.0])
    >>> scanned = 1 / grid - levels[:, np.newaxis]
    >>> last_crossing(lambda ratio, which: 1 / ratio - levels[which], grid, scanned)
    array([100.,  nan])
    """
    known = np.isfinite(scanned)
    turns = (scanned[:, 1:] > 0) != (scanned[:, :-1] > 0)
    turns &= known[:, 1:] & known[:, :-1]
    which = np.flatnonzero(turns.any(axis=1))
    last = turns.shape[1] - 1 - np.argmax(turns[which, ::-1], axis=1)
    found = np.full(len(scanned), np.nan)
    if which.size:
        # This module of scipy is not loaded on first use, and its import takes a third of a second.
        from scipy.optimize.elementwise import find_root

        bracket = (np.log(ratios[last]), np.log(ratios[last + 1]))
        with np.errstate(invalid="ignore"):  # from an interpolation that find_root rejects
            root = find_root(
                lambda x, k: function(np.exp(x), k.astype(int)),
                bracket,
                args=(which,),
                tolerances={"xatol": _CLOSE},
            )
        # If a sample lies at the root, rounding may change its sign; the root is then the sample.
        values_at_ends = np.abs(root.f_bracket)
        end = np.where(values_at_ends[0] < values_at_ends[1], *bracket)
        found[which] = np.exp(np.where(root.success, root.x, end))
    return found


def last_zero(function: Numbered, ratios: np.ndarray, scanned: np.ndarray) -> np.ndarray:
    """The largest ϖ at which each function changes its sign and is zero, shape (k,).

    The arguments are those of :func:`last_crossing`. Where the function changes its sign through
    infinity there is no zero, and the result is NaN.

    Examples
    --------
    >>> grid = np.geomspace(1, 1e4, 8)
    >>> functions = lambda ratio, which: (ratio - 100) ** np.where(which == 0, 1.0, -1.0)
    >>> last_zero(functions, grid, functions(grid, np.array([[0], [1]])))
    array([100.,  nan])
    """
    found = last_crossing(function, ratios, scanned)
    known = np.flatnonzero(np.isfinite(found))
    if known.size:
        there = np.abs(function(found[known], known))
        place = np.searchsorted(ratios, found[known])
        beside = np.abs(scanned[known, np.clip([place - 1, place], 0, ratios.size - 1)])
        # At a zero that is located to the last digits the function is smaller than at its sides,
        # and next to infinity larger.
        found[known[there > beside.max(axis=0)]] = np.nan
    return found


def thresholds(
    error: Numbered, ratios: np.ndarray, scanned: np.ndarray, tolerances: ArrayLike
) -> Thresholds:
    """The ϖ above which each error stays within each tolerance, shape (k, m).

    Parameters
    ----------
    error : callable
        Signed relative errors.
    ratios : ndarray, shape (N,)
        Increasing grid.
    scanned : ndarray, shape (k, N)
        The k errors on the grid.
    tolerances : array_like, shape (m,)

    Examples
    --------
    >>> grid = np.geomspace(1, 1e4, 50)
    >>> thresholds(lambda ratio, _: 1 / ratio, grid, 1 / grid[np.newaxis], [0.01, 2.0]).ratio
    array([[100.,  nan]])
    """
    level = np.atleast_1d(np.asarray(tolerances, dtype=float))
    size = modulus(scanned)[:, np.newaxis]
    tolerance = level[:, np.newaxis]

    def excess(error: np.ndarray, tolerance: np.ndarray) -> np.ndarray:
        # ln(error/tolerance) is nearly a straight line in ln ϖ.
        return np.log(np.clip(modulus(error), _SMALLEST, _LARGEST) / tolerance)

    def crossing(ratio: np.ndarray, number: np.ndarray) -> np.ndarray:
        which, place = np.divmod(number, level.size)
        return excess(error(ratio, which), level[place])

    outside = size > tolerance
    rows = excess(size, tolerance).reshape(-1, ratios.size)
    found = last_crossing(crossing, ratios, rows).reshape(outside.shape[:2])
    never = outside[..., -1]
    always = ~outside.any(axis=-1)
    within = np.where(always, ThresholdStatus.ALWAYS_WITHIN, ThresholdStatus.FOUND)
    status = np.where(never, ThresholdStatus.NEVER_WITHIN, within)
    return Thresholds(np.where(never, np.nan, found), status)


def by_quantity(errors: ErrorsAtRatios, quantities: Sequence[str], rows: int) -> Numbered:
    """Errors of several quantities as one set of numbered functions, ``rows`` for each quantity.

    The function of number q·rows + k is quantity q of row k. The quantities of an orbit are
    computed together, because one search finds the orbit for all of them.
    """
    of_orbit = np.isin(quantities, OF_ORBITS)
    groups = [np.flatnonzero(of_orbit), *np.flatnonzero(~of_orbit)[:, np.newaxis]]

    def numbered(ratio: np.ndarray, number: np.ndarray) -> np.ndarray:
        which, row = np.divmod(number, rows)
        found = np.empty(ratio.shape)
        for group in groups:
            there = np.isin(which, group)
            if there.any():
                each = errors(ratio[there], row[there], [quantities[k] for k in group])
                place = np.searchsorted(group, which[there])
                found[there] = np.take_along_axis(each, place[np.newaxis], axis=0)[0]
        return found

    return numbered
