"""The largest Lyapunov exponent: a deviation of each ball and its growth.

The deviation is multiplied by the derivative of the map and normalised to length 1 after each
impact; the logarithms of its growth are added up. The Lyapunov exponent is the ratio of the mean
growth to the mean time, over sections of 32 impacts, so that its standard error can be computed.
"""

from typing import NamedTuple, Self

import numpy as np

from bouncing_ball.paper.motion.deviations import Jacobian

# Distance of a state from the orbit within which a ball is regarded as being on the orbit.
NEAR = 1e-7
# Logarithms of the growth from a rounding error to 1, and to the distance NEAR.
DIGITS = -float(np.log(np.finfo(float).eps))
FORGOTTEN = DIGITS + float(np.log(NEAR))
# Number of impacts of each mean of the growth.
_BATCH = 32
# Number of first means that are left out.
_TRANSIENT = 2
# Relative error of a rate that is due to rounding: sums of n squares give the error √(n ε).
_EQUAL = 1e-6
# If a deviation shrinks to less than this length in one impact, a new deviation is started.
_TINY = 1e-300


class Stretching(NamedTuple):
    """A deviation of length 1 of each ball, and the logarithm of its growth."""

    # The parts dφ and dδ′ of the deviation.
    along: np.ndarray
    across: np.ndarray
    growth: np.ndarray
    # The smallest growth since the last sticking, after which the motion does not depend on earlier
    # impacts, and the largest rise of the growth above it, at any time so far.
    least: np.ndarray
    most: np.ndarray
    # The smallest growth since the mark, and the largest rise of the growth above it since then.
    lowest: np.ndarray
    worst: np.ndarray
    # Growth and time at the last mean.
    mean_growth: np.ndarray
    mean_time: np.ndarray
    # The number of means, and the sums over them of the growth g, the time t, g², g t and t²,
    # shape (balls, 6).
    sums: np.ndarray

    @classmethod
    def of(cls, balls: int) -> Self:
        """The deviations of a number of balls before their first flights."""
        return cls(
            along=np.ones(balls),
            across=np.zeros(balls),
            growth=np.zeros(balls),
            least=np.zeros(balls),
            most=np.zeros(balls),
            lowest=np.zeros(balls),
            worst=np.zeros(balls),
            mean_growth=np.zeros(balls),
            mean_time=np.zeros(balls),
            sums=np.zeros((balls, 6)),
        )

    def grow(self, change: Jacobian) -> np.ndarray:
        """Carry the deviation to the next impact, and return the logarithm of its growth."""
        along, across = change.apply(self.along, self.across)
        length = np.sqrt(along * along + across * across)
        straight = length > _TINY
        self.along[:] = np.where(straight, along / length, 1.0)
        self.across[:] = np.where(straight, across / length, 0.0)
        # A resumption of the contact of a law without a lag has no derivative here.
        return np.where(np.isnan(length), 0.0, np.log(length))

    def add(self, grown: np.ndarray, time: np.ndarray, seen: np.ndarray) -> None:
        """Add the growth at an impact; ``time`` and ``seen`` are its time and its number."""
        self.growth[:] += grown
        np.minimum(self.least, self.growth, out=self.least)
        np.maximum(self.most, self.growth - self.least, out=self.most)
        np.minimum(self.lowest, self.growth, out=self.lowest)
        np.maximum(self.worst, self.growth - self.lowest, out=self.worst)
        at = np.flatnonzero(seen % _BATCH == 0)
        if at.size:
            g = self.growth[at] - self.mean_growth[at]
            t = time[at] - self.mean_time[at]
            self.mean_growth[at] = self.growth[at]
            self.mean_time[at] = time[at]
            terms = np.stack([np.ones_like(t), g, t, g * g, g * t, t * t], axis=1)
            counts = seen[at] > _TRANSIENT * _BATCH
            self.sums[at] += terms * counts[:, np.newaxis]

    def forget(self, which: np.ndarray, grown: np.ndarray, time: np.ndarray) -> None:
        """Begin again for balls whose later motion does not depend on earlier impacts."""
        for values in (self.growth, self.least, self.lowest, self.mean_growth, grown):
            values[which] = 0
        self.mean_time[which] = time[which]

    def lost(self) -> np.ndarray:
        """Whether a rounding error has grown too much since the motion last became independent of
        earlier impacts.
        """
        return self.growth - self.least > FORGOTTEN

    def mark(self, which: np.ndarray) -> None:
        """Begin a new mark of some balls."""
        self.worst[which] = 0
        self.lowest[which] = self.growth[which]

    def exponent(self, which: np.ndarray, lap: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The growth per unit of time, and its standard error, NaN where the error is not known.

        ``lap`` is the number of impacts after which a ball has stuck to the table again, 0 if it
        has not. The computed motion is the same in each lap, so that only the means of one lap are
        independent. Means that are equal up to rounding are copies of one mean and give no error.

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
        number, growth, time, growth_squares, products, time_squares = self.sums[which].T
        rate = growth / time
        # The standard error of a ratio of means, where each mean is over a section of the motion.
        residual = growth_squares - 2 * rate * products + rate * rate * time_squares
        error = np.sqrt(np.maximum(residual, 0.0) * number / (number - 1)) / time
        laps = np.where(lap > 0, number * _BATCH / lap, 1.0)
        error *= np.sqrt(np.maximum(laps, 1.0))
        return rate, np.where(error > _EQUAL * np.abs(rate), error, np.nan)
