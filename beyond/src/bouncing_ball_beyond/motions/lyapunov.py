"""The largest Lyapunov exponent: a deviation of each ball and its growth.

The deviation is multiplied by the derivative of the map and normalised to length 1 after each
impact; the logarithms of its growth are added up. The Lyapunov exponent is the ratio of the mean
growth to the mean time, over sections of 32 impacts, so that its standard error can be computed.

The speed of a nearly elastic ball changes slowly. An impact multiplies its energy by r² and adds
what the table gives, so that the difference of the mean energy from its stationary value falls by
the factor e in a relaxation length of 1/(1 - r²) impacts. For every model the contraction of areas
stands for r²: a relaxation length is the number of impacts in which areas contract by e. Therefore:

* What the ball does in its first five relaxation lengths does not belong to the exponent, which is
  that of the sections after them.
* Sections that are no farther apart than some relaxation lengths are not independent. The standard
  error is also computed for blocks of 2, 4, 8, … sections (Flyvbjerg and Petersen, J. Chem. Phys.
  91, 461, 1989), and the largest one is taken. Because few blocks tell their scatter badly, it is
  multiplied by the ratio of the quantiles 0.975 of Student's and of the normal distribution.
* Sections over less than twenty relaxation lengths do not tell their scatter: the error of the
  exponent is not known. If the ball is followed for less than the first five, its exponent is that
  of all sections but two.

The exponent of the first sections, between a quarter and a half of them, is also compared with that
of the others. If they differ by more than three standard errors, the exponent drifts, and its error
is at least the difference.

The digits that a motion has lost follow from the same growth. They are counted anew when the ball
forgets: when a contact shrinks the deviation so far that less than a rounding error is left of its
growth. The exponent contains these contractions, except for the first, because what was before it
does not belong to the motion on which the ball ends.
"""

from typing import NamedTuple, Self

import numpy as np
import scipy

from bouncing_ball_beyond.models.deviations import Jacobian

# Distance of a state from the orbit within which a ball is regarded as being on the orbit.
NEAR = 1e-7
# Logarithms of the growth from a rounding error to 1, and to the distance NEAR.
DIGITS = -float(np.log(np.finfo(float).eps))
FORGOTTEN = DIGITS + float(np.log(NEAR))
# Number of impacts of each section, over which a mean of the growth is taken.
_BATCH = 32
# Number of first sections that are left out.
_TRANSIENT = 2
# The numbers of relaxation lengths that are left out, and of those that tell the error.
_SETTLED = 5.0
_TELLING = 20.0
# The exponent drifts if that of the first sections differs by this number of standard errors from
# that of the others, which happens by chance once in four hundred.
_DRIFTS = 3.0
# The number of lengths of blocks, and the least number of blocks of more than one section.
_LEVELS = 10
_BLOCKS = 4
# The quantile that an interval of 95 % has on both sides.
_QUANTILE = 0.975
# Relative error of a rate that is due to rounding: sums of n squares give the error √(n ε).
_EQUAL = 1e-6
# If a deviation shrinks to less than this length in one impact, a new deviation is started.
_TINY = np.array(1e-300)


class Stretching(NamedTuple):
    """A deviation of length 1 of each ball, and the logarithm of its growth."""

    # The parts dφ and dδ′ of the deviation.
    along: np.ndarray
    across: np.ndarray
    # The growth since the ball last forgot, the smallest growth since then, and the largest rise of
    # the growth above it, at any time so far.
    growth: np.ndarray
    least: np.ndarray
    most: np.ndarray
    # The smallest growth since the mark, and the largest rise of the growth above it since then.
    lowest: np.ndarray
    worst: np.ndarray
    # The growth in the present section, and the time at which the section began.
    section_growth: np.ndarray
    section_start: np.ndarray
    # The number of sections, and the sums over them of the growth g, the time t, g², g t and t²,
    # shape (balls, 6).
    sums: np.ndarray
    # The sums of the sections before the motion had settled, whether it has, and the logarithm of
    # the contraction of areas since then, or since the start.
    unsettled: np.ndarray
    settled: np.ndarray
    contraction: np.ndarray
    # The same for blocks of 2, 4, 8, … sections, shape (balls, levels, 6), and g and t of the last
    # section or block that is the first one of a pair, shape (balls, levels, 2).
    of_blocks: np.ndarray
    unpaired: np.ndarray
    # The sums at the last number of sections that was a power of two, and at the power before.
    latest: np.ndarray
    first: np.ndarray

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
            section_growth=np.zeros(balls),
            section_start=np.zeros(balls),
            sums=np.zeros((balls, 6)),
            unsettled=np.zeros((balls, 6)),
            settled=np.zeros(balls, dtype=bool),
            contraction=np.zeros(balls),
            of_blocks=np.zeros((balls, _LEVELS, 6)),
            unpaired=np.zeros((balls, _LEVELS, 2)),
            latest=np.zeros((balls, 6)),
            first=np.zeros((balls, 6)),
        )

    def grow(self, change: Jacobian) -> np.ndarray:
        """Carry the deviation to the next impact, and return the logarithm of its growth."""
        along, across = change.apply(self.along, self.across)
        length = np.sqrt(along * along + across * across)
        straight = length > _TINY
        if straight.all():
            self.along[:] = along / length
            self.across[:] = across / length
            return np.log(length)
        self.along[:] = np.where(straight, along / length, 1.0)
        self.across[:] = np.where(straight, across / length, 0.0)
        # A resumption of the contact of a law without a lag has no derivative here.
        return np.where(np.isnan(length), 0.0, np.log(length))

    def forgetting(self, grown: np.ndarray, sticks: np.ndarray) -> np.ndarray:
        """The indices of the balls that forget in an impact with this growth, as they stick."""
        if not sticks.any():
            return np.flatnonzero(sticks)
        return np.flatnonzero(sticks & (self.growth + grown < self.least - DIGITS))

    def add(
        self,
        grown: np.ndarray,
        contraction: np.ndarray,
        forgot: np.ndarray,
        time: np.ndarray,
        seen: np.ndarray,
    ) -> None:
        """Add the growth at an impact, and the factor by which areas contract on the way to it.

        ``forgot`` are the indices of the balls that forget there, ``time`` and ``seen`` the time of
        the impact and its number.
        """
        with np.errstate(divide="ignore"):
            self.contraction[:] += np.log(np.abs(contraction))
        self.section_growth[:] += grown
        self.growth[:] += grown
        if forgot.size:
            for values in (self.growth, self.least, self.lowest):
                values[forgot] = 0
        np.minimum(self.least, self.growth, out=self.least)
        np.maximum(self.most, self.growth - self.least, out=self.most)
        np.minimum(self.lowest, self.growth, out=self.lowest)
        np.maximum(self.worst, self.growth - self.lowest, out=self.worst)
        (at,) = (seen % _BATCH == 0).nonzero()
        if at.size:
            g = self.section_growth[at]
            t = time[at] - self.section_start[at]
            self.section_growth[at] = 0
            self.section_start[at] = time[at]
            counts = seen[at] > _TRANSIENT * _BATCH
            self._settle(at)
            self.sums[at[counts]] += _terms(g, t)[counts]
            self._pair(at[counts], g[counts], t[counts])
            number = self.sums[at, 0].astype(int)
            (doubled,) = (counts & (number & (number - 1) == 0)).nonzero()
            if doubled.size:
                balls = at[doubled]
                self.first[balls] = self.latest[balls]
                self.latest[balls] = self.sums[balls]

    def _settle(self, balls: np.ndarray) -> None:
        """Begin the sums again for balls whose motion has just settled."""
        new = balls[(self.contraction[balls] <= -_SETTLED) & ~self.settled[balls]]
        self.settled[new] = True
        self.contraction[new] = 0
        self.unsettled[new] = self.sums[new]
        for sums in (self.sums, self.latest, self.first, self.of_blocks):
            sums[new] = 0

    def _pair(self, balls: np.ndarray, growth: np.ndarray, time: np.ndarray) -> None:
        """Join new sections of some balls with those before them to blocks of 2, 4, 8, … sections.

        Of two blocks of one length the second completes a block of twice the length.
        """
        number = self.sums[balls, 0]
        for level in range(_LEVELS):
            second = number % 2 == 0
            first = ~second
            self.unpaired[balls[first], level] = np.stack([growth[first], time[first]], axis=1)
            if not second.any():
                return
            balls = balls[second]
            before = self.unpaired[balls, level]
            growth = growth[second] + before[:, 0]
            time = time[second] + before[:, 1]
            number = number[second] / 2
            self.of_blocks[balls, level] += _terms(growth, time)

    def restart(self, which: np.ndarray, time: np.ndarray) -> None:
        """Begin the exponent again for balls that have forgotten for the first time."""
        self.section_growth[which] = 0
        self.section_start[which] = time[which]
        for sums in (self.sums, self.unsettled, self.latest, self.first, self.of_blocks):
            sums[which] = 0

    def lost(self) -> np.ndarray:
        """Whether a rounding error has grown too much since the ball last forgot."""
        return self.growth - self.least > FORGOTTEN

    def mark(self, which: np.ndarray) -> None:
        """Begin a new mark of some balls."""
        self.worst[which] = 0
        self.lowest[which] = self.growth[which]

    def exponent(self, which: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The growth per unit of time, and its standard error, NaN where the error is not known.

        Sections that are equal up to rounding are copies of one section and give no error.

        Examples
        --------
        Growth by 1 and by 3 in one unit of time each:

        >>> stretch = Stretching.of(1)
        >>> stretch.sums[0] = 2, 4, 2, 10, 4, 2
        >>> rate, error = stretch.exponent(np.array([0]))
        >>> rate.tolist(), error.tolist()
        ([2.0], [1.0])
        """
        rate, error = _rate(self.of_motion(which))
        return rate, np.where(error > _EQUAL * np.abs(rate), error, np.nan)

    def of_motion(self, which: np.ndarray) -> np.ndarray:
        """The sums of some balls over the sections of their motions, shape (balls, 6); those before
        they had settled if there are no two others.
        """
        few = (self.sums[which, 0] < 2) & (self.unsettled[which, 0] >= 2)
        return np.where(few[:, np.newaxis], self.unsettled[which], self.sums[which])

    def uncertainty(self, which: np.ndarray) -> np.ndarray:
        """The error of the exponent: an interval of twice the error on both sides has about 95 %;
        NaN if the motion was followed for too few relaxation lengths to tell it.

        Examples
        --------
        Sixteen sections, of which eight have the growth 1 and then eight the growth 3:

        >>> stretch = Stretching.of(1)
        >>> stretch.settled[:], stretch.contraction[:] = True, -100.0
        >>> for g in 8 * [1.0] + 8 * [3.0]:
        ...     stretch.sums[0] += 1, g, 1, g * g, g, 1
        ...     stretch._pair(np.array([0]), np.array([g]), np.ones(1))
        >>> error = stretch.exponent(np.array([0]))[1]
        >>> (stretch.uncertainty(np.array([0])) / error).round(1).tolist()
        [3.6]
        """
        with np.errstate(invalid="ignore", divide="ignore"):
            found = self.drift(which)
        every = [self.sums[which], *np.moveaxis(self.of_blocks[which], 1, 0)]
        for level, sums in enumerate(every):
            enough = sums[:, 0] >= (_BLOCKS if level else 2)
            freedom = np.where(enough, sums[:, 0] - 1, 1.0)
            wider = scipy.special.stdtrit(freedom, _QUANTILE) / scipy.special.ndtri(_QUANTILE)
            with np.errstate(invalid="ignore", divide="ignore"):
                error = np.where(enough, wider * _rate(sums)[1], 0.0)
            found = np.fmax(found, error)
        tells = self.settled[which] & (self.contraction[which] <= -_TELLING)
        return np.where(tells, found, np.nan)

    def drift(self, which: np.ndarray) -> np.ndarray:
        """The change of the exponent from the first sections to the others, 0 if it is within the
        errors.

        Examples
        --------
        >>> stretch = Stretching.of(1)
        >>> stretch.first[0] = 4, 8, 4, 16.1, 8, 4
        >>> stretch.sums[0] = 12, 16, 12, 24.2, 16, 12
        >>> stretch.drift(np.array([0])).tolist()
        [1.0]
        """
        early, error = _rate(self.first[which])
        late, other = _rate(self.sums[which] - self.first[which])
        change = np.abs(late - early)
        return np.where(change > _DRIFTS * np.hypot(error, other), change, 0.0)


def _terms(growth: np.ndarray, time: np.ndarray) -> np.ndarray:
    """What sections or blocks add to the sums, shape (balls, 6)."""
    squares = growth * growth, growth * time, time * time
    return np.stack([np.ones_like(time), growth, time, *squares], axis=1)


def _rate(sums: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The growth per unit of time of sums over sections, shape (balls, 6), and its error."""
    number, growth, time, growth_squares, products, time_squares = sums.T
    rate = growth / time
    # The standard error of a ratio of means, where each mean is over a section of the motion.
    residual = growth_squares - 2 * rate * products + rate * rate * time_squares
    return rate, np.sqrt(np.maximum(residual, 0.0) * number / (number - 1)) / time
