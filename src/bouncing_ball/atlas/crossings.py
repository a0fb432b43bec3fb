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


class LastCrossings:
    """Thresholds of many errors, found as the walk comes down.

    Parameters
    ----------
    tolerances : ndarray, shape (m,)
    shape : tuple of int
        Shape of the errors, with one dimension at least.

    Examples
    --------
    An error 1/ϖ is within 1 % from ϖ = 100 on, and never within 0.01 %:

    >>> found = LastCrossings(np.array([0.5, 0.01, 0.0001]), (1,))
    >>> for ratio in np.geomspace(3.0, 1e3, 20)[::-1]:
    ...     found.meet(ratio, np.array([1 / ratio]))
    >>> found.thresholds()[:, 0].round(9).tolist()
    [3.0, 100.0, inf]
    """

    def __init__(self, tolerances: np.ndarray, shape: tuple[int, ...]):
        self._tolerances = tolerances.reshape(-1, *(1,) * len(shape))
        self._open = np.ones((len(tolerances), *shape), dtype=bool)
        self._found = np.full(self._open.shape, -np.inf)
        self._past: list[tuple[float, np.ndarray]] = []

    def meet(self, frequency_ratio: float, error: np.ndarray) -> None:
        """The signed errors at the next smaller ϖ; those that are not a number are infinite."""
        x, error = float(np.log(frequency_ratio)), np.asarray(error, dtype=float)
        error = np.where(np.isnan(error), np.inf, error)
        if len(self._past) == 2:
            self._peaks(x, error)
        beyond = (np.abs(error) > self._tolerances) & self._open
        if np.any(beyond):
            place = np.nonzero(beyond)
            self._found[place] = self._crossing(x, error, place)
            self._open &= ~beyond
        self._past = [*self._past[-1:], (x, error)]

    def thresholds(self) -> np.ndarray:
        """ϖ of each tolerance, shape (m, ...).

        Infinite where the error exceeds it at the largest ϖ met, and the smallest ϖ met
        where it never does.
        """
        return np.exp(np.where(self._open, self._past[-1][0], self._found))

    def _crossing(self, x, error, place) -> np.ndarray:
        """ln ϖ at which errors within their tolerances come to exceed them."""
        tolerance, entry = np.ravel(self._tolerances)[place[0]], place[1:]
        if not self._past:
            return np.full(tolerance.shape, np.inf)
        stiffer, last = self._past[-1]
        left, right = last[entry], error[entry]
        turned = (left * right < 0) & np.isfinite(right)
        level = np.log(np.minimum(np.abs(right), _LARGEST) / tolerance)
        before = np.log(np.maximum(np.abs(left), _SMALLEST) / tolerance)
        fall = np.where(turned, 1.0, level - before)
        share = np.where(fall > 0, level / np.where(fall > 0, fall, 1.0), 0.0)
        straight = np.where(turned, right - left, 1.0)
        share = np.where(turned, (right - np.sign(right) * tolerance) / straight, share)
        return x + share * (stiffer - x)

    def _peaks(self, x2, e2) -> None:
        """Thresholds of excursions between the last three ϖ."""
        (x0, e0), (x1, e1) = self._past
        with np.errstate(invalid="ignore"):
            highest = (e1 * (e1 - e0) >= 0) & (e1 * (e1 - e2) > 0) & np.any(self._open, axis=0)
        entry = np.nonzero(highest & np.isfinite(e0) & np.isfinite(e1) & np.isfinite(e2))
        sign = np.sign(e1[entry])
        f0, f1, f2 = sign * e0[entry], sign * e1[entry], sign * e2[entry]
        first, second = (f1 - f0) / (x1 - x0), (f2 - f1) / (x2 - x1)
        bend = (second - first) / (x2 - x0)
        slope = first + bend * (x1 - x0)
        bent = bend < 0
        curve = np.where(bent, bend, -1.0)
        top, height = x1 - slope / (2 * curve), f1 - slope * slope / (4 * curve)
        for k, tolerance in enumerate(np.ravel(self._tolerances)):
            there = bent & (f1 <= tolerance) & (tolerance < height) & self._open[k][entry]
            if np.any(there):
                place = (k, *(index[there] for index in entry))
                width = np.sqrt((height - tolerance)[there] / -curve[there])
                self._found[place] = np.minimum(top[there] + width, x0)
                self._open[place] = False
