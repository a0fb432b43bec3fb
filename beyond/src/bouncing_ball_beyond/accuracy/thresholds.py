"""Zeros of the errors along ϖ, and errors of several quantities as one set of functions.

The thresholds of any errors are those of the inherited library
(:mod:`bouncing_ball_beyond.inherited.accuracy.thresholds`, Eqs. 37-38);
:func:`~bouncing_ball_beyond.accuracy.simple_models.search` finds those of simple models.
"""

from collections.abc import Callable, Sequence

import numpy as np

from bouncing_ball_beyond.accuracy.errors import OF_ORBITS
from bouncing_ball_beyond.inherited.accuracy.thresholds import Numbered, last_crossing

ErrorsAtRatios = Callable[[np.ndarray, np.ndarray, Sequence[str]], np.ndarray]
"""Signed errors of quantities, shape (quantity, m), at ratios ϖ of rows, shape (m,)."""


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
