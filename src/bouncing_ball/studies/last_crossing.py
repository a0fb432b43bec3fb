"""Where functions of the frequency ratio last pass through zero."""

from collections.abc import Callable

import numpy as np
from scipy.optimize.elementwise import find_root


def last_crossing(
    function: Callable[[np.ndarray, np.ndarray], np.ndarray], ratios: np.ndarray, values: np.ndarray
) -> np.ndarray:
    """The largest ϖ at which each function changes its sign.

    The last change between two samples is closed to the last digit; an even
    number of changes between two samples goes unseen.

    Parameters
    ----------
    function : callable
        Values at ratios ϖ of the functions with given numbers, both arrays.
    ratios : ndarray, shape (N,)
        Increasing grid.
    values : ndarray, shape (m, N)
        The m functions on the grid; next to a NaN no change counts.

    Returns
    -------
    ndarray, shape (m,)
        NaN for a function that changes nowhere.

    Examples
    --------
    >>> grid, levels = np.geomspace(1, 1e4, 9), np.array([0.01, 2.0])
    >>> values = 1 / grid - levels[:, np.newaxis]
    >>> last_crossing(lambda ratio, which: 1 / ratio - levels[which], grid, values)
    array([100.,  nan])
    """
    known = np.isfinite(values)
    turns = (values[:, 1:] > 0) != (values[:, :-1] > 0)
    turns &= known[:, 1:] & known[:, :-1]
    which = np.flatnonzero(turns.any(axis=1))
    last = turns.shape[1] - 1 - np.argmax(turns[which, ::-1], axis=1)
    found = np.full(len(values), np.nan)
    if which.size:
        bracket = np.log(ratios[last]), np.log(ratios[last + 1])
        with np.errstate(invalid="ignore"):  # of an interpolation that is then not taken
            root = find_root(
                lambda x, k: function(np.exp(x), k.astype(int)), bracket, args=(which,)
            )
        # On a sample rounding may turn the sign back: the root is that sample.
        values_at_ends = np.abs(root.f_bracket)
        end = np.where(values_at_ends[0] < values_at_ends[1], *bracket)
        found[which] = np.exp(np.where(root.success, root.x, end))
    return found
