r"""Contact of any law from its start to its release, by extrapolated midpoint steps.

With ``p = q^m`` and ``dt = m q^{m-1} ds`` the equations of a law with m roots, ::

    dq/ds = p′,    dp′/ds = m q^{m-1} (a - f),    dt/ds = m q^{m-1}

are smooth up to the ends of the contact, so that the method of Gragg, Bulirsch and
Stoer keeps its order there: midpoint rules of 2, 4, ... 12 steps, extrapolated to order 12.
The step is that of each ball, so that the last extrapolation changes nothing above
10⁻¹². The release is met exactly, by a change of the independent variable
(Hénon): the last steps go along ``g = grip/q^{m-1}``, from its value to 0.

What is certified: the size of the error of each step, as an estimate. What is
not: that the grip has not vanished and come back within one step, a good part of an
oscillation; and no contact is proved to last for ever.
"""

from typing import NamedTuple

import numpy as np

from bouncing_ball.impacts.contact_scales import scales
from bouncing_ball.impacts.laws.contact_law import ContactLaw
from bouncing_ball.impacts.release import Release
from bouncing_ball.motion.ensembles import pick

_MIDPOINTS = (2, 4, 6, 8, 10, 12)
_TOLERANCE = 1e-12
# First step in parts of P/V, and bounds of the change from one to the next.
_FIRST = 1.0
_SHORTER, _LONGER, _SAFETY = 0.2, 2.0, 0.8
_ORDER = 2 * len(_MIDPOINTS) - 1
# The change to the grip as independent variable: it must end within so many steps.
_WITHIN = 1.2
# Steps, some hundreds of oscillations.
_MOST = 2000
# A ball at rest, in parts of V: its start is slow in s, and this fast enough.
_AT_REST = 1e-9
_TINY = 1e-300


class Touch(NamedTuple):
    """Starts of contact, one-dimensional: p, p′, the table's phase and Λ."""

    depth: np.ndarray
    rate: np.ndarray
    phase: np.ndarray
    amplitude: np.ndarray

    def take(self, which) -> "Touch":
        """Some of them."""
        return Touch(*(pick(x, which) for x in self))


class Departure(NamedTuple):
    """Ends of contact: duration, p, p′; NaN and ``undecided`` where none was found."""

    duration: np.ndarray
    depth: np.ndarray
    rate: np.ndarray
    undecided: np.ndarray


def _power(q, exponent: int):
    result = np.ones_like(q) if exponent == 0 else q
    for _ in range(exponent - 1):
        result = result * q
    return result


class _Motion:
    """The right sides, for the balls of one block."""

    def __init__(self, law: ContactLaw, touch: Touch):
        self.law, self.phase, self.amplitude = law, touch.phase, touch.amplitude
        self.held = law.release is not Release.DISPLACEMENT

    def take(self, which) -> "_Motion":
        part = object.__new__(_Motion)
        part.law, part.held = self.law.take(which), self.held
        part.phase, part.amplitude = pick(self.phase, which), pick(self.amplitude, which)
        return part

    def _parts(self, state):
        """p, p′, m q^{m-1} and p″."""
        root, rate, time = state
        m = self.law.root
        q = np.maximum(root, _TINY)
        before = _power(q, m - 1)
        p = before * q
        push = 1 - self.amplitude * np.sin(self.phase + time) - self.law.force(p, rate)
        return p, rate, m * before, push

    def _grip(self, p, rate, lever, push):
        """g, and its rate along s."""
        m, law = self.law.root, self.law
        slopes, grip = law.grip_slopes(p, rate), law.grip(p, rate)
        change = m * (slopes.by_penetration * rate + slopes.by_rate * push)
        return m * grip / lever, change - (m - 1) * grip / p * rate

    def grip(self, state):
        """g, and its rate along s: for a release at p = 0, q and p′."""
        return self._grip(*self._parts(state)) if self.held else (state[0], state[1])

    def along_time(self, state):
        """Derivatives of q, p′ and t in s."""
        _, rate, lever, push = self._parts(state)
        out = np.empty_like(state)
        out[0], out[2] = rate, lever
        np.multiply(lever, push, out=out[1])
        return out

    def along_grip(self, state):
        """Derivatives in s divided by -dg/ds."""
        p, rate, lever, push = self._parts(state)
        fall = -self._grip(p, rate, lever, push)[1] if self.held else -rate
        out = np.empty_like(state)
        out[0], out[1], out[2] = rate, lever * push, lever
        return np.divide(out, fall, out=out)


def _step(rates, state, length):
    """States one step later, and the change by the last extrapolation."""
    first = rates(state)
    row: list[np.ndarray] = []
    for k, count in enumerate(_MIDPOINTS):
        h = length / count
        before, now = state, state + h * first
        double = 2 * h
        for _ in range(count - 1):
            change = rates(now)
            change *= double
            change += before
            before, now = now, change
        column = [now]
        for j in range(k):
            ratio = (count / _MIDPOINTS[k - j - 1]) ** 2 - 1
            column.append(column[j] + (column[j] - row[j]) / ratio)
        row = column
    return row[-1], row[-1] - row[-2]


def _both_steps(motion: _Motion, state, along, grip, length):
    """One step of each ball, along s or to the end of the grip."""
    if not np.any(along):
        return _step(motion.along_time, state, length)
    if np.all(along):
        return _step(motion.along_grip, state, grip)
    after, change = np.empty_like(state), np.empty_like(state)
    for which, taken in ((np.flatnonzero(~along), length), (np.flatnonzero(along), grip)):
        part = motion.take(which)
        rates = part.along_time if taken is length else part.along_grip
        after[:, which], change[:, which] = _step(rates, state[:, which], taken[which])
    return after, change


def release(law: ContactLaw, touch: Touch) -> Departure:
    """The release of each ball.

    Examples
    --------
    >>> from bouncing_ball.impacts.laws.linear import Linear
    >>> zero, two = np.zeros(1), np.full(1, 2.0)
    >>> end = release(Linear(1e3, 0.0), Touch(zero, two, zero, zero))
    >>> end.rate.round(12).tolist()
    [-2.0]
    """
    size = touch.rate.size
    motion = _Motion(law, touch)
    scale = scales(law, np.abs(touch.rate), 1 + np.abs(touch.amplitude) + 0 * touch.rate)
    unit = np.stack([scale.length ** (1 / law.root), scale.speed, scale.length / scale.speed])
    state = np.stack([touch.depth ** (1 / law.root), touch.rate, np.zeros(size)])
    slow = (touch.depth == 0) & (touch.rate < _AT_REST * scale.speed)
    state[1] = np.where(slow, _AT_REST * scale.speed, state[1])
    length = _FIRST * unit[0] / unit[1]
    out, undecided = np.full((3, size), np.nan), np.zeros(size, dtype=bool)
    active = np.arange(size)
    for _ in range(_MOST):
        grip, rate = motion.grip(state)
        along = (state[1] < 0) & (rate < 0) & (grip > 0) & (grip <= -_WITHIN * length * rate)
        after, change = _both_steps(motion, state, along, grip, length)
        error = np.max(np.abs(change) / unit, axis=0) / _TOLERANCE
        factor = _SAFETY * np.maximum(error, _TINY) ** (-1 / _ORDER)
        factor = np.where(np.isfinite(error), np.clip(factor, _SHORTER, _LONGER), _SHORTER)
        held, _ = motion.grip(after)
        # Beyond the release the motion is not that of a contact: come nearer first.
        beyond = ~along & (held < 0)
        good = (error <= 1) & ~beyond
        ended = good & along
        state = np.where(good, after, state)
        length = np.where(along & good, length, length * np.where(beyond, 0.5, factor))
        if np.any(ended):
            out[:, active[ended]] = state[:, ended]
            going = np.flatnonzero(~ended)
            active = active[going]
            if not active.size:
                break
            state, length, unit = state[:, going], length[going], unit[:, going]
            motion = motion.take(going)
    undecided[active] = True
    out[:, active] = np.nan
    depth = np.zeros(size) if not motion.held else np.maximum(out[0], 0.0) ** law.root
    return Departure(out[2], np.where(undecided, np.nan, depth), out[1], undecided)
