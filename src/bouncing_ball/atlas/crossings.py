"""The last ϖ at which an error exceeds each tolerance, from stiff contacts downwards.

The threshold of an error is the ϖ above which the error stays within a tolerance. It is the
first crossing on a walk from the largest ϖ to the smallest. The threshold is interpolated
within one step of the walk, in logarithms, because ln(error) is nearly a straight line in
ln ϖ, or along the error itself if the error changes its sign. An excursion beyond the tolerance
between two ϖ is detected by the parabola through the nearest three ϖ.
"""

from itertools import pairwise

import numpy as np

# The error is bounded for the interpolation, because it is infinite where a model has no orbit.
_LARGEST = 1e3
_SMALLEST = 1e-300


def last_crossings(ratios: np.ndarray, errors: np.ndarray, tolerances: np.ndarray) -> np.ndarray:
    """The thresholds of many errors, for each of several tolerances.

    Parameters
    ----------
    ratios : ndarray, shape (k,)
        ϖ, decreasing.
    errors : ndarray, shape (k, ...)
        The signed errors at these ϖ, with at least one more dimension. NaN counts as infinite.
    tolerances : ndarray, shape (m,)

    Returns
    -------
    ndarray, shape (m, ...)
        ϖ; infinite where the error exceeds the tolerance at the largest ϖ, and the smallest ϖ
        where it never exceeds the tolerance.

    Examples
    --------
    An error 1/ϖ is within 1 % above ϖ = 100, and is not within 0.01 % at any ϖ of the grid:

    >>> ratios = np.geomspace(1e3, 3.0, 20)
    >>> found = last_crossings(ratios, 1 / ratios[:, np.newaxis], np.array([0.5, 0.01, 0.0001]))
    >>> found[:, 0].round(9).tolist()
    [3.0, 100.0, inf]
    """
    x, errors = np.log(ratios), np.where(np.isnan(errors), np.inf, errors)
    # The running maximum from the largest ϖ downwards; this is four times as fast as accumulate.
    largest = np.abs(errors)
    for above, here in pairwise(largest):
        np.maximum(above, here, out=here)
    step, entry, inside, height, top, curve = _peaks(x, errors)
    found = np.full((len(tolerances), *errors.shape[1:]), x[-1])
    for one, tolerance in zip(found, tolerances, strict=True):
        # The index of the first ϖ at which the error exceeds the tolerance.
        first = np.count_nonzero(largest <= tolerance, axis=0)
        crosses = np.nonzero(first < len(x))
        one[crosses] = _crossing(x, errors, (first[crosses], *crosses), tolerance)
        # If there are several excursions before the crossing, the first is the threshold. It is
        # therefore written last.
        seen = (inside <= tolerance) & (tolerance < height) & (step <= first[entry])
        seen = np.flatnonzero(seen)[::-1]
        width = np.sqrt((height[seen] - tolerance) / -curve[seen])
        ends = np.minimum(top[seen] + width, x[step[seen] - 2])
        one[tuple(index[seen] for index in entry)] = ends
    return np.exp(found)


def _crossing(x: np.ndarray, errors: np.ndarray, at: tuple, tolerance: float) -> np.ndarray:
    """ln ϖ at which errors reach the tolerance, within the step that ends at the indices ``at``."""
    step, *entry = at
    # Beyond the largest ϖ no crossing can be located.
    start = step == 0
    left, right = np.where(start, 1.0, errors[step - 1, *entry]), errors[at]
    turned = (left * right < 0) & np.isfinite(right)
    level = np.log(np.minimum(np.abs(right), _LARGEST) / tolerance)
    before = np.log(np.maximum(np.abs(left), _SMALLEST) / tolerance)
    fall = np.where(turned, 1.0, level - before)
    share = np.where(fall > 0, level / np.where(fall > 0, fall, 1.0), 0.0)
    straight = np.where(turned, right - left, 1.0)
    share = np.where(turned, (right - np.sign(right) * tolerance) / straight, share)
    return np.where(start, np.inf, x[step] + share * (x[step - 1] - x[step]))


def _peaks(x: np.ndarray, errors: np.ndarray) -> tuple:
    """Parabolas through three neighbouring ϖ whose apex lies between them.

    Returns the indices of the last of the three ϖ and of the entries, the modulus of the error at
    the middle ϖ and at the apex, ln ϖ of the apex, and half the second derivative.
    """
    e0, e1, e2 = errors[:-2], errors[1:-1], errors[2:]
    with np.errstate(invalid="ignore"):
        highest = (e1 * (e1 - e0) >= 0) & (e1 * (e1 - e2) > 0)
    found = np.nonzero(highest & np.isfinite(e0) & np.isfinite(e1) & np.isfinite(e2))
    step = found[0]
    sign = np.sign(e1[found])
    f0, f1, f2 = (sign * e[found] for e in (e0, e1, e2))
    x0, x1, x2 = x[step], x[step + 1], x[step + 2]
    first, second = (f1 - f0) / (x1 - x0), (f2 - f1) / (x2 - x1)
    bend = (second - first) / (x2 - x0)
    slope = first + bend * (x1 - x0)
    top, height = x1 - slope / (2 * bend), f1 - slope * slope / (4 * bend)
    return step + 2, found[1:], f1, height, top, bend
