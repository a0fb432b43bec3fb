r"""Means over time of motions that do not repeat, from many balls that are followed together.

The mean of a quantity over time is E q / E t, where q is its integral from one impact to the next
and t the time between them. If N balls have the sums Q_j and T_j, the estimate and its standard
error to first order in 1/N are ::

    m = Σ Q_j / Σ T_j,      s² = N/(N - 1) Σ (Q_j - m T_j)² / (Σ T_j)²

Its bias is of the order 1/(N k) for k impacts of each ball. The mean of the ratios Q_j/T_j has a
bias of the order 1/k, because k impacts take longer if they are high. Many balls with few impacts
therefore give the same information as few balls with many, and they take less time, because a step
of a thousand balls takes hardly longer than one of a hundred.

The balls start beside impacts of one ball that has been followed before, so that they are on its
motion at once. The first impacts are left out, until the balls have separated and the sum of what
this ball did by chance is forgotten: an impact multiplies the energy by about r².

With instantaneous impacts, balls that stick to the table leave it in one state. They would follow
one another on one lap from then on, and would not be independent. The velocity of the next impact
of a ball that sticks is therefore increased by a fraction of 10⁻⁹ or less, a different one for each
ball. This is far above rounding errors, which otherwise choose the lap if it is long. A contact of
finite stiffness only brings balls nearer to each other, and they are left as they are.

The means are examined several times while the sample grows. If the sample is the share x of the
largest one, an error probability of α x² has been spent in all, where α = 0.05. Each interval takes
what has been added since the last examination, so that by the inequality of Boole all of them
together contain the mean with the probability 1 - α (K. K. G. Lan and D. L. DeMets, Biometrika 70,
1983, for the spending of α).
"""

import math
from collections.abc import Iterator, Sequence
from itertools import islice
from typing import NamedTuple

import numpy as np
import scipy

from bouncing_ball.long_run.means import over_leg
from bouncing_ball.models.contacts_and_flights import Impact
from bouncing_ball.models.dynamics import Dynamics, HasDynamics
from bouncing_ball.models.flight import table
from bouncing_ball.numerics.arrays import BLOCK

# The largest relative change of an impact after sticking, with instantaneous impacts.
_APART = 1e-9
# The probability with which one of the intervals does not contain its mean.
_ALPHA = 0.05


class Starts(NamedTuple):
    """First impacts: phases of the table and absolute velocities of the balls."""

    phase: np.ndarray
    velocity: np.ndarray

    @classmethod
    def of_path(cls, path: np.ndarray, amplitude: float) -> "Starts":
        """The impacts of a path, an array of phases and of velocities.

        A contact that resumes below the table's level, where the ball rises relative to the table,
        is left out.
        """
        phase, velocity = path
        falls = velocity < table(phase, amplitude)[0]
        return cls(phase[falls], velocity[falls])

    def first(self) -> "Starts":
        """The first of these impacts."""
        return Starts(self.phase[:1], self.velocity[:1])

    def last(self) -> "Starts":
        """The last of these impacts."""
        return Starts(self.phase[-1:], self.velocity[-1:])

    def beside(self, balls: int, amplitude: float, apart: float) -> "Starts":
        """Starts of a number of balls beside these impacts, in turn, with speeds relative to the
        table that are larger by up to the fraction ``apart``.
        """
        number = np.arange(balls)
        phase = self.phase[number % self.phase.size]
        w_rate, _ = table(phase, amplitude)
        relative = self.velocity[number % self.phase.size] - w_rate
        return Starts(phase, w_rate + relative * (1 + apart * (number + 1) / balls))


class SampleSize(NamedTuple):
    """A size of the sample at which the means are examined.

    ``level`` is the probability with which the interval may miss the mean.
    """

    balls: int
    impacts: int
    level: float


def sample_sizes(balls: int, first: int, impacts: Sequence[int]) -> list[SampleSize]:
    """Growing samples of up to a number of balls, followed for up to ``impacts[-1]`` impacts.

    The first balls are followed on and on; then more balls are added, as many as there are so far.

    Examples
    --------
    >>> [(each.balls, each.impacts) for each in sample_sizes(500, 200, (50, 100))]
    [(200, 50), (200, 100), (400, 100), (500, 100)]
    >>> round(sum(each.level for each in sample_sizes(500, 200, (50, 100))), 12)
    0.05
    """
    now = min(first, balls)
    sizes = [(now, each) for each in impacts]
    while now < balls:
        now = min(now + min(now, BLOCK), balls)
        sizes.append((now, impacts[-1]))
    shares = np.array([a * b for a, b in sizes]) / (balls * impacts[-1])
    levels = np.diff(_ALPHA * shares**2, prepend=0.0)
    return [SampleSize(*size, level) for size, level in zip(sizes, levels.tolist(), strict=True)]


def sums_at(
    samples: Sequence[SampleSize], starts: Starts, model: HasDynamics, amplitude: float, before: int
) -> Iterator[np.ndarray]:
    """The sums of each ball at each look: time, ∫ z dτ and work, shape (3, balls).

    The first impacts, a number ``before``, are left out. The sums are NaN if a ball comes to rest.
    """
    finished = np.empty((3, 0))
    sums = np.empty((3, 0))
    for look in samples:
        begun = finished.shape[1] + sums.shape[1]
        if look.balls > begun:
            finished = np.concatenate([finished, sums], axis=1)
            part = Starts(*(each[begun : look.balls] for each in starts))
            dynamics, impact = start(model, amplitude, part)
            number = np.arange(begun + 1, look.balls + 1)
            apart = dynamics.forgets * _APART * number / samples[-1].balls
            impact, _ = advance(dynamics, impact, before, apart)
            sums = np.zeros((3, look.balls - begun))
            done = 0
        impact, more = advance(dynamics, impact, look.impacts - done, apart)
        sums = sums + more
        done = look.impacts
        yield np.concatenate([finished, sums], axis=1)


def start(model: HasDynamics, amplitude: float, starts: Starts) -> tuple[Dynamics, Impact]:
    """The dynamics and the first impacts of balls."""
    dynamics, phase, relative, _ = model.dynamics(amplitude).first_impacts(*starts)
    return dynamics, dynamics.start(phase, relative)


def advance(
    dynamics: Dynamics, impact: Impact, impacts: int, apart: np.ndarray | float = 0.0
) -> tuple[Impact, np.ndarray]:
    """Follow balls through a number of further impacts.

    In a model whose balls forget their past by sticking the velocity of the impact after it is
    increased by the fraction ``apart``.

    Returns
    -------
    tuple
        The last impact; and time, ∫ z dτ and work of the table up to it, shape (3, balls), NaN if
        a ball comes to rest on the way.

    Examples
    --------
    The mean height of an elastic ball on a table at rest is two thirds of its greatest height, and
    the ball receives no power:

    >>> from bouncing_ball.models.rigid import RestitutionModel
    >>> once = Starts(np.zeros(1), np.full(1, -2.0))
    >>> _, (time, height, work) = advance(*start(RestitutionModel(1.0), 0.0, once), 5)
    >>> (height / time).round(12).tolist(), work.tolist()
    ([1.333333333333], [0.0])
    """
    sums = np.zeros((3, impact.phase.size))
    # No derivative is needed, but these models tell only then which balls stick.
    for leg in islice(dynamics.legs(impact, differentiate=dynamics.forgets), impacts):
        departure = leg.departure
        if np.any(departure.status):
            return leg.impact, np.full_like(sums, np.nan)
        impact, _ = leg.fly()
        sums += over_leg(leg)
        if dynamics.forgets:
            faster = impact.velocity * (1 + apart * departure.sticks)
            leg.after = impact = impact._replace(velocity=faster)
    return impact, sums


def sections(dynamics: Dynamics, impact: Impact, impacts: int) -> np.ndarray:
    """The sums of one ball over about √k sections of k impacts, shape (3, sections).

    Sections of √k impacts are so long that they are hardly correlated, and so many that their
    scatter gives the error of the mean.

    Examples
    --------
    >>> from bouncing_ball.models.rigid import RestitutionModel
    >>> once = Starts(np.zeros(1), np.full(1, -2.0))
    >>> sections(*start(RestitutionModel(1.0), 0.0, once), 7)[0].tolist()
    [8.0, 8.0, 12.0]
    """
    number = math.isqrt(impacts - 1) + 1
    edges = np.linspace(0, impacts, number + 1, dtype=int)
    found = []
    for length in np.diff(edges).tolist():
        impact, sums = advance(dynamics, impact, length)
        found.append(sums)
    return np.concatenate(found, axis=1)


class Estimate(NamedTuple):
    """Means over time of the height and of the power, shape (2,), their standard errors, and the
    degrees of freedom of the errors, infinite if there is no error.
    """

    mean: np.ndarray
    error: np.ndarray
    freedom: float

    @classmethod
    def of(cls, sums: np.ndarray) -> "Estimate":
        """The ratios of the sums of balls or of sections, shape (3, ...).

        The sums of one repetition of a motion that repeats have no error.

        Examples
        --------
        >>> found = Estimate.of(np.array([[1.0, 3.0], [1.0, 3.0], [1.0, 5.0]]))
        >>> found.mean.tolist(), found.error.tolist(), found.freedom
        ([1.0, 1.5], [0.0, 0.25], 1)
        """
        time, *integrals = sums
        total = time.sum()
        mean = np.sum(integrals, axis=1) / total
        if time.size == 1:
            return cls(mean, np.zeros(2), math.inf)
        residual = integrals - mean[:, np.newaxis] * time
        freedom = time.size - 1
        error = np.sqrt(np.sum(residual**2, axis=1) * time.size / freedom) / total
        return cls(mean, error, freedom)


def quantile(level: float, freedom: float) -> float:
    """The half-width of an interval over the standard error: that of Student's distribution.

    Examples
    --------
    >>> round(quantile(0.05, 100), 3), round(quantile(0.05, math.inf), 3)
    (1.984, 1.96)
    """
    return float(scipy.special.stdtrit(freedom, 1 - level / 2))
