r"""The first upward zero of a smooth function, which no step can pass over.

Let y(s) < 0, with y″ ≤ K and \|y‴\| ≤ J from s on. Then ::

    y(s + h) ≤ y + y′ h + K h²/2

so that no zero lies before the positive root h₀ of this parabola. Up to 2h₀
the second derivative is at most ``K₁ = min(K, y″ + 2J h₀)``, which gives a
longer step, limited to 2h₀. Steps of this kind approach a simple zero
from the left with third order, and slow down, but do not fail, where two
zeros lie close together or the function only touches zero. They are taken until

* ``2K \|y\| ≤ θ y′²``, y′ > 0: the next zero is then simple and near (Newton
  and Kantorovich), and
* ``J h₀² ≤ κ y′``: one more step by the function's own parabola, without
  the safeguard, reaches the last digit; its error is below κ⁴ h₀/6.

Flight and contact are both *motions* of this kind, see :class:`Motion`.
"""

from typing import NamedTuple, Protocol

import numpy as np

# θ and κ above.
_SIMPLE = 0.25
_CLOSE = 3e-4
# Steps after which a zero is given up as undecided. Each is a good part of the
# shorter of the function's time scales, so this is hundreds of oscillations.
_MAX_STEPS = 3000
_TINY = 1e-300


class State(NamedTuple):
    """y and its derivatives at one time, and bounds from this time on.

    ``ended`` marks where the search may stop without a zero, ``None`` for
    nowhere.
    """

    value: np.ndarray
    rate: np.ndarray
    second: np.ndarray
    third: np.ndarray
    second_bound: np.ndarray
    third_bound: np.ndarray
    rapidity: np.ndarray | float
    ended: np.ndarray | None = None


class Motion(Protocol):
    """An array of functions of time whose first upward zeros are wanted."""

    def __call__(self, time: np.ndarray) -> State: ...

    def take(self, which: np.ndarray) -> "Motion":
        """The motions at some positions of the array."""
        ...

    def skip(self, time: np.ndarray) -> np.ndarray:
        """A later time up to which there is certainly no zero, or the time itself."""
        ...


class Zero(NamedTuple):
    """First upward zeros: time and y′ there, and where there is none.

    ``ended`` are those whose motion said so, ``undecided`` those given up.
    """

    time: np.ndarray
    rate: np.ndarray
    ended: np.ndarray
    undecided: np.ndarray


def safe_step(state: State) -> tuple[np.ndarray, np.ndarray]:
    """The longest certified step, and whether the zero is within reach after it.

    Examples
    --------
    Exact for a parabola, here y = s² - 1 seen from s = 0:

    >>> one = np.ones(1)
    >>> step, _ = safe_step(State(-one, 0 * one, 2 * one, 0 * one, 2.0, 0.0, 1.0))
    >>> step.tolist()
    [1.0]
    """
    y, v, a, third, bound, jerk, rapidity, _ = state
    # Rounding may put y above zero where it touches it from below.
    twice = -2 * np.minimum(y, 0.0)
    square, rising = v * v, v > 0
    pressed = bound * twice
    root = np.sqrt(square + pressed)
    first = np.where(rising, twice / (v + root + _TINY), (root - v) / bound)
    step = first
    terms = (v, rising, square, twice, a, third, bound, jerk * rapidity)
    part, now, which = terms, step, slice(None)
    while True:
        reach = REACH * now
        longer = np.minimum(_step_within(reach, *part), reach)
        further = np.flatnonzero((longer == reach) & (longer > now))
        now = np.maximum(now, longer)
        if isinstance(which, slice):
            step = now.copy()
        else:
            step[which] = now
        if not further.size:
            break
        which = further if isinstance(which, slice) else which[further]
        part = tuple(x[further] if np.ndim(x) else x for x in part)
        now = now[further]
    # Falling faster and faster from y = y′ = 0: y ≤ y″ h²/2 + J h³/6.
    step = np.maximum(step, np.where(rising, 0.0, -3 * a / (jerk + _TINY)))
    third = np.abs(third) + rapidity * jerk * first
    done = (third * (first * first) <= _CLOSE * v) & (pressed <= _SIMPLE * square) & rising
    return step, done


def _step_within(reach, v, rising, square, twice, a, third, bound, fourth):
    """Root of the parabola that bounds y up to ``reach``, if it lies before."""
    growth = np.maximum(third, 0.0) + 0.25 * fourth * reach
    local = np.minimum(a + reach * growth * (1 / 3), bound)
    root = np.sqrt(np.maximum(square + local * twice, 0.0))
    return np.where(rising, twice / (v + root + _TINY), (root - v) / np.maximum(local, _TINY))


PASSES, REACH = 1, 4.0


def first_zero(motion: Motion, start: np.ndarray) -> Zero:
    """First upward zero of each motion after a time that precedes it.

    There is no zero between 0 and ``start``, where the function may be zero
    itself: if it rises there, that is the zero. One-dimensional arrays.
    """
    time = np.array(start, dtype=float)
    ended = np.zeros(time.shape, dtype=bool)
    active, part, now = slice(None), motion, time
    for _ in range(_MAX_STEPS):
        state = part(now)
        step, done = safe_step(state)
        later = part.skip(now + step)
        # Zeros that are here: at the start, or where y touches zero to rounding.
        rate = state.rate
        here = (state.value >= 0) & ((rate > 0) | ((rate == 0) & (state.second >= 0)))
        if state.ended is not None:
            stop = state.ended & ~(done | here)
            ended[active] = stop
            here |= stop
        later = np.where(here, now, later)
        done |= later == now
        time[active] = later
        left = np.flatnonzero(~done)
        if left.size == 0:
            break
        active = left if isinstance(active, slice) else active[left]
        part, now = part.take(left), later[left]
    undecided = np.zeros(time.shape, dtype=bool)
    if left.size:
        undecided[active] = True
    return _to_the_last_digit(motion, time, ended, undecided)


def _to_the_last_digit(motion, time, ended, undecided) -> Zero:
    """One step of the function's own parabola, and the rate of change after it."""
    state = motion(time)
    v, acceleration = state.rate, state.second
    twice = -2 * state.value
    square = v * v
    root = np.sqrt(np.maximum(square + acceleration * twice, 0.0))
    # Where the zero is not certainly simple (a touch), the time stays as it is.
    simple = (v > 0) & (state.second_bound * np.abs(twice) <= square)
    step = np.where(simple, twice / (v + root), 0.0)
    rate = v + step * (acceleration + 0.5 * step * state.third)
    return Zero(time + step, rate, ended, undecided)
