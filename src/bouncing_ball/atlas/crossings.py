r"""The last ϖ at which an error exceeds each tolerance, coming down from stiff contacts.

The threshold of an error is the ϖ from which on it stays within a tolerance: the first
crossing that a walk from the largest ϖ to the smallest meets. It is known to lie
within one step of the walk, and interpolated there: in logarithms, in which the error
is nearly a straight line, or along the error itself where that changes its sign. An
excursion beyond the tolerance between two ϖ is seen by the parabola through the
nearest three. So thresholds of all orbits are found without keeping any error.
"""

import numpy as np

# The error is bounded for the interpolation, as one of the models may have no orbit.
_LARGEST = 1e3
_SMALLEST = 1e-300

Events = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Indices of the ϖ, of the tolerances and the entries, and ln ϖ of what is met there."""


class LastCrossings:
    """Thresholds of many errors, found as the walk comes down.

    Parameters
    ----------
    tolerances : ndarray, shape (m,)
    shape : tuple of int
        Shape of the errors at one ϖ, with one dimension at least.

    Examples
    --------
    An error 1/ϖ is within 1 % from ϖ = 100 on, and never within 0.01 %:

    >>> found = LastCrossings(np.array([0.5, 0.01, 0.0001]), (1,))
    >>> for ratios in np.geomspace(3.0, 1e3, 20)[::-1].reshape(-1, 4):
    ...     found.meet(ratios, 1 / ratios[:, np.newaxis])
    >>> found.thresholds()[:, 0].round(9).tolist()
    [3.0, 100.0, inf]
    """

    def __init__(self, tolerances: np.ndarray, shape: tuple[int, ...]):
        self._tolerances = tolerances.reshape(-1, *(1,) * len(shape))
        self._open = np.ones((len(tolerances), *shape), dtype=bool)
        self._found = np.full(self._open.shape, -np.inf)
        # ln ϖ and errors of the last two ϖ.
        self._along, self._errors = np.empty(0), np.empty((0, *shape))

    def meet(self, ratios: np.ndarray, errors: np.ndarray) -> None:
        """The signed errors, shape (ϖ, ...), at the next smaller ϖ, which decrease.

        Those that are not a number are infinite.
        """
        past = len(self._along)
        along = np.concatenate([self._along, np.log(ratios)])
        errors = np.concatenate([self._errors, np.where(np.isnan(errors), np.inf, errors)])
        # Which ϖ, which entry, and where between the ϖ; at one ϖ an excursion before it is first.
        events = zip(
            _peaks(along, errors, self._tolerances, self._open),
            self._crossings(along, errors, past),
            strict=True,
        )
        step, place, value = (np.concatenate(both, axis=-1) for both in events)
        # Of several events of an entry the first one counts: it is written last.
        order = np.argsort(step, kind="stable")[::-1]
        place = tuple(place[:, order])
        self._found[place] = value[order]
        self._open[place] = False
        self._along, self._errors = along[-2:], errors[-2:]

    def thresholds(self) -> np.ndarray:
        """ϖ of each tolerance, shape (m, ...).

        Infinite where the error exceeds it at the largest ϖ met, and the smallest ϖ met
        where it never does.
        """
        return np.exp(np.where(self._open, self._along[-1], self._found))

    def _crossings(self, x: np.ndarray, errors: np.ndarray, past: int) -> Events:
        """Errors within their tolerances that come to exceed them."""
        size = np.abs(errors[past:])
        place = np.nonzero((np.max(size, axis=0) > self._tolerances) & self._open)
        tolerance, entry = np.ravel(self._tolerances)[place[0]], place[1:]
        step = past + np.argmax(size[:, *entry] > tolerance, axis=0)
        # Nothing is known beyond the largest ϖ.
        first = step == 0
        left = np.where(first, 1.0, errors[step - 1, *entry])
        right = errors[step, *entry]
        turned = (left * right < 0) & np.isfinite(right)
        level = np.log(np.minimum(np.abs(right), _LARGEST) / tolerance)
        before = np.log(np.maximum(np.abs(left), _SMALLEST) / tolerance)
        fall = np.where(turned, 1.0, level - before)
        share = np.where(fall > 0, level / np.where(fall > 0, fall, 1.0), 0.0)
        straight = np.where(turned, right - left, 1.0)
        share = np.where(turned, (right - np.sign(right) * tolerance) / straight, share)
        value = x[step] + share * (x[step - 1] - x[step])
        return step, np.array(place), np.where(first, np.inf, value)


def _peaks(x: np.ndarray, errors: np.ndarray, tolerances: np.ndarray, within: np.ndarray) -> Events:
    """Excursions beyond their tolerances between each three ϖ."""
    e0, e1, e2 = errors[:-2], errors[1:-1], errors[2:]
    with np.errstate(invalid="ignore"):
        highest = (e1 * (e1 - e0) >= 0) & (e1 * (e1 - e2) > 0) & np.any(within, axis=0)
    found = np.nonzero(highest & np.isfinite(e0) & np.isfinite(e1) & np.isfinite(e2))
    step, entry = found[0], found[1:]
    sign = np.sign(e1[found])
    f0, f1, f2 = (sign * e[found] for e in (e0, e1, e2))
    x0, x1, x2 = x[step], x[step + 1], x[step + 2]
    first, second = (f1 - f0) / (x1 - x0), (f2 - f1) / (x2 - x1)
    bend = (second - first) / (x2 - x0)
    slope = first + bend * (x1 - x0)
    bent = bend < 0
    curve = np.where(bent, bend, -1.0)
    top, height = x1 - slope / (2 * curve), f1 - slope * slope / (4 * curve)
    each = tolerances.reshape(-1, 1)
    there = bent & (f1 <= each) & (each < height) & np.moveaxis(within, 0, -1)[entry].T
    which, at = np.nonzero(there)
    width = np.sqrt((height[at] - each[which, 0]) / -curve[at])
    place = np.array([which, *(index[at] for index in entry)])
    return step[at] + 2, place, np.minimum(top[at] + width, x0[at])
