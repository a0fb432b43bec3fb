r"""The amplitude up to which a ball stays on a contact whose damper acts on approach only.

Less its depth at rest, y = δ + 1/ϖ², the motion of a ball that is held throughout is ::

    y″ = Λ sin t - ϖ² y - 2ζϖ min(y′, 0)

The damper's force is proportional to a positive factor of y, too, so that the steady motion is
proportional to Λ, and its highest place at Λ = 1 gives the threshold: ``Λ max y = 1/ϖ²``. Between
two turns, y′ = 0, the motion is that of a linear oscillator with or without damper, in closed form.
The force is continuous at a turn, so that the derivative of the map over one period is the product
of those between the turns, and Newton's method finds the start that repeats itself.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
import scipy

from bouncing_ball_beyond.models.oscillator import impulse_response

_PERIOD = 2 * np.pi
# Samples of half an oscillation between which a turn is found, and the turns in one period.
_FINE = 32
_TURNS = 2000
# Rounds of Newton's method, and the last step over the depth at rest from which rounding is near.
_ROUNDS = 60
_LAST = 1e-10
# Beside the resonance of the undamped part the steady motion has no digits.
_RESONANCE = 1e-6


class _Part(NamedTuple):
    """The oscillator between two turns: ϖ and its damping ratio, below 1, at Λ = 1."""

    omega: float
    zeta: float

    def steady(self, time: np.ndarray) -> np.ndarray:
        """y and y′ of the forced oscillation, shape (2, time)."""
        wave = np.exp(1j * np.asarray(time)) / (self.omega**2 - 1 + 2j * self.zeta * self.omega)
        return np.array([wave.imag, wave.real])

    def free(self, time: np.ndarray) -> np.ndarray:
        """The matrix of (y, y′) over a time without forcing, shape (2, 2, time)."""
        g, g_rate = impulse_response(time, self.omega, self.zeta)
        level = g_rate + 2 * self.zeta * self.omega * g
        return np.array([[level, g], [-(self.omega**2) * g, g_rate]])

    def after(self, start: float, state: np.ndarray, time: np.ndarray) -> np.ndarray:
        """y and y′ a time after a state at ``start``, shape (2, time)."""
        moved = np.einsum("ij...,j->i...", self.free(time), state - self.steady(np.array(start)))
        return moved + self.steady(start + time)


class _Period(NamedTuple):
    """The state after one period, its derivative by the first state, and the greatest y."""

    state: np.ndarray
    slopes: np.ndarray
    top: float


def _over_a_period(omega: float, zeta: float, first: np.ndarray) -> _Period | None:
    """The motion from a first state at t = 0; None if it turns too often."""
    step = np.pi / _FINE / max(omega, 1.0)
    time = 0.0
    state = first
    slopes = np.eye(2)
    top = -np.inf
    for _ in range(_TURNS):
        # After a turn the acceleration decides in which part the ball is.
        push = np.sin(time) - omega**2 * state[0]
        is_up = bool(state[1] > 0 or (state[1] == 0 and push > 0))
        part = _Part(omega, 0.0 if is_up else zeta)
        left = _PERIOD - time
        grid = np.append(np.arange(step, left, step), left)
        sign = 1 if is_up else -1
        against = sign * part.after(time, state, grid)[1] < 0
        turn = left
        if against.any():
            k = int(np.argmax(against))
            turn = _turn(part, time, state, (float(grid[k - 1]) if k else 0.0, float(grid[k])))
        top = max(top, float(state[0]))
        state = part.after(time, state, np.array(turn))
        slopes = part.free(np.array(turn)) @ slopes
        top = max(top, float(state[0]))
        if turn >= left:
            return _Period(state, slopes, top)
        state = np.array([state[0], 0.0])
        time += turn
    return None


def _turn(part: _Part, time: float, state: np.ndarray, between: tuple[float, float]) -> float:
    """The time to the next turn, which lies between two times."""

    def rate(after: float) -> float:
        return float(part.after(time, state, np.array(after))[1])

    low, high = between
    if rate(low) * rate(high) >= 0:
        # The ball turns back within the first sample after a turn.
        return high
    return float(scipy.optimize.brentq(rate, low, high, xtol=1e-16, rtol=1e-15))


@lru_cache(maxsize=1024)
def approach_threshold(frequency_ratio: float, damping_ratio: float) -> float:
    """Λ up to which a ball stays on the table; NaN if no steady motion was found.

    Examples
    --------
    With little damping it is 1 - 1/ϖ² above the resonance (Eq. 33):

    >>> round(approach_threshold(4.5, 1e-6) * 4.5**2, 3)
    19.25
    >>> round(approach_threshold(200.0, 0.1), 8)
    0.99997355
    """
    omega = frequency_ratio
    if not damping_ratio < 1 or abs(omega - 1) < _RESONANCE:
        return np.nan
    level = 1 / omega**2
    # The start is that of a table so slow that the ball moves as the load does.
    state = np.array([0.0, level])
    closest = np.inf
    found = np.nan
    for _ in range(_ROUNDS):
        period = _over_a_period(omega, damping_ratio, state)
        if period is None:
            return np.nan
        missed = period.state - state
        size = float(np.hypot(missed[0], missed[1] / omega)) / level
        # Rounding is reached where the steps, which are quadratic, no longer shrink.
        if size >= closest / 2 and closest < _LAST:
            return found
        closest = min(size, closest)
        found = level / period.top
        state = state + np.linalg.solve(np.eye(2) - period.slopes, missed)
    return np.nan
