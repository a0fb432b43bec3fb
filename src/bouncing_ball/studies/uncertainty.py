"""The share of starts, or of parameters, whose result changes if they are changed by ε.

For a boundary of dimension D in a plane this share is proportional to ε^α, where α = 2 - D is the
uncertainty exponent (C. Grebogi, S. W. McDonald, E. Ott and J. A. Yorke, 1983).
"""

import numpy as np

_RESAMPLED, _SEED = 400, 1


def exponent(changes: np.ndarray, size: np.ndarray, confidence: float) -> np.ndarray:
    """α with its lower and upper limit, from independent results that change or do not change.

    α is the slope of the least-squares line of the logarithm of the share over ln ε, weighted with
    the number of changes, because the variance of the logarithm of a small count is about the
    inverse of the count. Its interval is that of a bootstrap. A share of 0 counts as half a change.

    Parameters
    ----------
    changes : array of bool, shape (results, sizes)
        Whether each result changes with each size ε of the change.
    size : array, shape (sizes,)
        At least two different ε > 0.
    confidence : float
        The probability with which the interval contains α, in (0, 1).

    Returns
    -------
    array, shape (3,)
        α, its lower limit and its upper limit.

    Examples
    --------
    >>> changes = np.arange(1000)[:, np.newaxis] < [100, 10]
    >>> round(float(exponent(changes, np.array([1e-2, 1e-4]), 0.95)[0]), 9)
    0.5
    """
    count = len(changes)
    drawn = np.random.default_rng(_SEED).integers(count, size=(_RESAMPLED, count))
    drawn[0] = np.arange(count)
    share = np.maximum(changes[drawn].mean(axis=1), 0.5 / count)
    slope = np.polyfit(np.log(size), np.log(share).T, 1, w=np.sqrt(share[0]))[0]
    return np.array([slope[0], *np.quantile(slope, [(1 - confidence) / 2, (1 + confidence) / 2])])
