r"""The first upward zero of a smooth function, by steps that cannot pass over a zero.

Let y(s) < 0, with y″ ≤ K and \|y‴\| ≤ J from s on. Then ::

    y(s + h) ≤ y + y′ h + K h²/2

Hence no zero lies before the positive root h₀ of this parabola. For steps h ≤ H
the bound K may be replaced by a local bound, with \|y⁗\| ≤ L ::

    K_H = min(K, y″ + H max(y‴, 0)/3 + L H²/12)

and the step is the longest that H = 4h₀, 16h₀, ... allows. Such steps
approach a simple zero from the left with third order. Where two zeros lie close
together, or the function only touches zero, they become slow but do not fail. They are
taken until both

* ``2K \|y\| ≤ θ y′²`` and y′ > 0, so that the next zero is simple and near (Newton
  and Kantorovich), and
* ``(\|y‴\| + L h₀) h₀² ≤ κ y′``, so that one more step, to the zero of the function's
  parabola, reaches the last digit; its error is of order κ⁴ h₀.

A row of such functions is a *motion*, see :class:`Motion`.
"""

from abc import ABC, abstractmethod
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.numerics.arrays import Row, pick

# θ and κ above. All constants are arrays without an axis, as in
# :mod:`bouncing_ball_beyond.inherited.numerics.elementary`.
_SIMPLE = np.array(0.25)
_CLOSE = np.array(3e-4)
# Ratio of successive H.
_REACH = np.array(4.0)
# Number of steps after which the search ends as undecided. Each step is a considerable part of
# the shortest time scale of the function, so that these are hundreds of oscillations.
_MAX_STEPS = 3000
_ZERO = np.array(0.0)
_HALF = np.array(0.5)
_QUARTER = np.array(0.25)
_THIRD = np.array(1 / 3)
# Added to what is divided by; rates of up to 1e28 do not overflow over it.
_TINY = np.array(1e-280)
_MINUS_TWO = np.array(-2.0)


class Derivatives(NamedTuple):
    """y and its derivatives at one time, and the bounds K, J, L from this time on.

    ``ended`` marks the functions for which the search may stop without a zero; ``None`` means
    that there are no such functions.
    """

    value: np.ndarray
    rate: np.ndarray
    second: np.ndarray
    third: np.ndarray
    second_bound: np.ndarray
    third_bound: np.ndarray
    fourth_bound: np.ndarray
    ended: np.ndarray | None = None


class Motion(Row, ABC):
    """A row of functions of time whose first upward zeros are computed."""

    @abstractmethod
    def __call__(self, time: np.ndarray) -> Derivatives:
        """Each function and its derivatives at its time."""

    def skip(self, time: np.ndarray, steps: int) -> np.ndarray:
        """A later time before which there is certainly no zero, or the time itself.

        ``steps`` is the number of steps taken so far, because an expensive bound is worth its cost
        only after several steps.
        """
        return time


class Zero(NamedTuple):
    """First upward zeros: their times, and y′ there.

    ``ended`` marks the functions whose search stopped without a zero (see :class:`Derivatives`),
    and ``undecided`` those for which it took too many steps.
    """

    time: np.ndarray
    rate: np.ndarray
    ended: np.ndarray
    undecided: np.ndarray


class _Start(NamedTuple):
    """The start of a step: y′, whether y′ > 0, y′², and -2y ≥ 0."""

    rate: np.ndarray
    rising: np.ndarray
    square: np.ndarray
    twice: np.ndarray

    @classmethod
    def of(cls, at: Derivatives) -> "_Start":
        rate = at.rate
        # If y touches zero from below, rounding may give a positive value.
        twice = _MINUS_TWO * np.minimum(at.value, _ZERO)
        return cls(rate, rate > _ZERO, rate * rate, twice)

    def root(self, bound: np.ndarray) -> np.ndarray:
        """Positive root h of y + y′ h + (bound) h²/2; a long step if there is none."""
        root = np.sqrt(np.maximum(self.square + bound * self.twice, _ZERO))
        falling = (root - self.rate) / np.maximum(bound, _TINY)
        return np.where(self.rising, self.twice / (self.rate + root + _TINY), falling)


class _Bounds(NamedTuple):
    """y″ and y‴ at the start of a step, and the bounds K and L."""

    second: np.ndarray
    third: np.ndarray
    second_bound: np.ndarray
    fourth_bound: np.ndarray

    def within(self, reach: np.ndarray) -> np.ndarray:
        """K_H, the bound of y″ in steps h ≤ H."""
        growth = np.maximum(self.third, _ZERO) + _QUARTER * self.fourth_bound * reach
        return np.minimum(self.second + reach * growth * _THIRD, self.second_bound)


def safe_step(at: Derivatives) -> tuple[np.ndarray, np.ndarray]:
    """The longest step that certainly passes no zero, and whether it may be the last.

    Examples
    --------
    The step is exact for a parabola, here y = s² - 1 at s = 0:

    >>> one = np.ones(1)
    >>> step, _ = safe_step(Derivatives(-one, 0 * one, 2 * one, 0 * one, 2.0, 0.0, 0.0))
    >>> step.tolist()
    [1.0]
    """
    start = _Start.of(at)
    first = start.root(at.second_bound)
    step = _prolonged(first, start, at)
    # From y = y′ = 0 with y″ < 0 on, y ≤ y″ h²/2 + J h³/6.
    if not start.rising.all():
        sinking = -3 * at.second / (at.third_bound + _TINY)
        step = np.maximum(step, np.where(start.rising, _ZERO, sinking))
    bend = (np.abs(at.third) + at.fourth_bound * first) * (first * first)
    simple = at.second_bound * start.twice <= _SIMPLE * start.square
    return step, (bend <= _CLOSE * at.rate) & simple & start.rising


def _prolonged(first: np.ndarray, start: _Start, at: Derivatives) -> np.ndarray:
    """Certified steps, at least as long as the ``first`` ones, with the local bounds K_H."""
    step = first.copy()
    now = first
    which: Any = slice(None)
    bounds = _Bounds(at.second, at.third, at.second_bound, at.fourth_bound)
    while True:
        reach = _REACH * now
        longer = np.minimum(start.root(bounds.within(reach)), reach)
        # If the reach limited the step, a longer reach is tried.
        further = ((longer == reach) & (longer > now)).nonzero()[0]
        now = np.maximum(now, longer)
        step[which] = now
        if not further.size:
            return step
        if further.size < now.size:
            which = further if isinstance(which, slice) else which[further]
            now = now[further]
            start = pick(start, further)
            bounds = pick(bounds, further)


def first_zero(motion: Motion, start: np.ndarray) -> Zero:
    """First upward zero of each motion, searched from the time ``start`` on.

    The caller guarantees that no zero lies between 0 and ``start``. If the function is zero at
    ``start`` and rises, ``start`` is the result. The arrays are one-dimensional.
    """
    time = np.array(start, dtype=float)
    ended = np.zeros(time.shape, dtype=bool)
    undecided = np.zeros(time.shape, dtype=bool)
    active: Any = slice(None)
    part = motion
    now = time.copy()
    for steps in range(_MAX_STEPS):
        at = part(now)
        step, last = safe_step(at)
        here = _zero_here(at)
        if at.ended is not None:
            if at.ended.any():
                stop = at.ended & ~(last | here)
                ended[active] = stop
                here |= stop
        later = part.skip(now + step, steps)
        if here.any():
            later = np.where(here, now, later)
        done = last | (later == now)
        time[active] = later
        left = (~done).nonzero()[0]
        if left.size == 0:
            break
        if left.size < now.size:
            active = left if isinstance(active, slice) else active[left]
            part = part.take(left)
            later = later[left]
        now = later
    undecided[active] = left.size > 0
    time, rate = _to_the_last_digit(motion, time)
    return Zero(np.maximum(time, start), rate, ended, undecided)


def _zero_here(at: Derivatives) -> np.ndarray:
    """Whether y is zero and rises: at the start, or where y touches zero up to rounding."""
    here = at.value >= _ZERO
    if here.any():
        rate = at.rate
        here &= (rate > 0) | ((rate == 0) & (at.second >= 0))
    return here


def _to_the_last_digit(motion: Motion, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The times, improved by one step to the zero of the function's parabola, and y′ there."""
    at = motion(time)
    rate = at.rate
    acceleration = at.second
    twice = _MINUS_TWO * at.value
    square = rate * rate
    root = np.sqrt(np.maximum(square + acceleration * twice, _ZERO))
    # If the zero may be multiple, because y touches zero, the time is not changed.
    simple = (rate > _ZERO) & (at.second_bound * np.abs(twice) <= square)
    step = np.where(simple, twice / (rate + root + _TINY), _ZERO)
    return time + step, rate + step * (acceleration + _HALF * step * at.third)
