"""How fast the neighbours of balls leave them: a deviation of each ball and its growth.

The deviation is carried by the derivative of the map and has the length 1 after each impact; the
logarithms of its growth add up. The Lyapunov exponent is the ratio of two means, of the growth and
of the time, over stretches of 32 impacts, so that it has a standard error.
"""

from typing import Any, NamedTuple, Self

import numpy as np

from bouncing_ball.motion.tangent import Jacobian

# Distance of a state from the orbit at which a ball is taken to be on it.
NEAR = 1e-7
# Logarithms of the growth from a rounding error to 1, and to the distance above.
DIGITS = -float(np.log(np.finfo(float).eps))
FORGOTTEN = DIGITS + float(np.log(NEAR))
# Impacts of a mean of the stretching, and means left out.
_BATCH, _TRANSIENT = 32, 2
# Error of a rate that is rounding: sums of n squares have the relative error √(n ε).
_EQUAL = 1e-6
# Stretching by less is as good as forgetting.
_TINY = 1e-300


class Stretching(NamedTuple):
    """A deviation of length 1 of each ball, and the logarithm of its growth."""

    along: np.ndarray
    across: np.ndarray
    growth: np.ndarray
    # The least that the growth has been, and the most by which it has grown: at all, the former
    # since the ball forgot its past, and since the mark.
    least: np.ndarray
    most: np.ndarray
    lowest: np.ndarray
    worst: np.ndarray
    # Growth and time at the last mean; the number of means, sums of growth and time over them and
    # of their products.
    mean_growth: np.ndarray
    mean_time: np.ndarray
    sums: np.ndarray

    @classmethod
    def of(cls, balls: int) -> Self:
        """The stretching of so many balls before their first flights."""
        columns: Any = np.eye(9, 1) + np.zeros(balls)
        return cls._make([*columns, np.zeros((balls, 6))])

    def grow(self, change: Jacobian) -> np.ndarray:
        """Carry the deviation to the next impact; the logarithm of its growth."""
        along, across = change.apply(self.along, self.across)
        length = np.sqrt(along * along + across * across)
        straight = length > _TINY
        self.along[:] = np.where(straight, along / length, 1.0)
        self.across[:] = np.where(straight, across / length, 0.0)
        # A resumption of the contact of a law without a lag has no derivative here.
        return np.where(np.isnan(length), 0.0, np.log(length))

    def add(self, grown: np.ndarray, time: np.ndarray, seen: np.ndarray) -> None:
        """Add the growth, at the time of the impact that is the ball's number ``seen``."""
        self.growth[:] += grown
        np.minimum(self.least, self.growth, out=self.least)
        np.maximum(self.most, self.growth - self.least, out=self.most)
        np.minimum(self.lowest, self.growth, out=self.lowest)
        np.maximum(self.worst, self.growth - self.lowest, out=self.worst)
        at = np.flatnonzero(seen % _BATCH == 0)
        if at.size:
            g, t = self.growth[at] - self.mean_growth[at], time[at] - self.mean_time[at]
            self.mean_growth[at], self.mean_time[at] = self.growth[at], time[at]
            terms = np.stack([np.ones_like(t), g, t, g * g, g * t, t * t], axis=1)
            self.sums[at] += terms * (seen[at] > _TRANSIENT * _BATCH)[:, np.newaxis]

    def forget(self, which: np.ndarray, grown: np.ndarray, time: np.ndarray) -> None:
        """Begin again with the balls whose later motion does not depend on the earlier one."""
        for values in (self.growth, self.least, self.lowest, self.mean_growth, grown):
            values[which] = 0
        self.mean_time[which] = time[which]

    def lost(self) -> np.ndarray:
        """Whether a rounding error has grown too much since the ball forgot its past."""
        return self.growth - self.least > FORGOTTEN

    def mark(self, which: np.ndarray) -> None:
        """Begin a new mark of some balls."""
        self.worst[which], self.lowest[which] = 0, self.growth[which]

    def exponent(self, which: np.ndarray, lap: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The growth per unit of time and its standard error, NaN where it is not known.

        The computed motion of a ball that has stuck to the table again after so many impacts, a
        ``lap``, 0 for none, is the same in each lap, so that only the means of one lap count. Means
        that are equal up to rounding are copies of one mean, which has no error.

        Examples
        --------
        Growth by 1 and by 3 in one unit of time each, and the same in four laps:

        >>> stretch = Stretching.of(1)
        >>> stretch.sums[0] = 2, 4, 2, 10, 4, 2
        >>> with np.errstate(divide="ignore"):
        ...     rate, error = stretch.exponent(np.array([0, 0]), np.array([0, 16]))
        >>> rate.tolist(), error.tolist()
        ([2.0, 2.0], [1.0, 2.0])
        """
        number, growth, time, square, product, times = self.sums[which].T
        rate = growth / time
        # The error of a ratio of means, each over a stretch of the motion.
        rest = square - 2 * rate * product + rate * rate * times
        error = np.sqrt(np.maximum(rest, 0.0) * number / (number - 1)) / time
        laps = np.where(lap > 0, number * _BATCH / lap, 1.0)
        error *= np.sqrt(np.maximum(laps, 1.0))
        return rate, np.where(error > _EQUAL * np.abs(rate), error, np.nan)
