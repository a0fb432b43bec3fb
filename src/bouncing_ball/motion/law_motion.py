r"""Contact of any law from its start to its release, panel by panel, to rounding.

A panel is a part of the contact over which the motion is analytic in the panel's own
variable, so that Gauss' 16 nodes know it to rounding:

* the first panel goes along ``q = p^{1/m}`` from 0, with ``w = p′²/2``, ::

      dw/dq = m q^{m-1} (a - f),    dt/dq = m q^{m-1}/p′

* the next go along the time, p″ = a - f, where p is not small;
* the last goes along q again, down to 0, or for a force release along the grip g,
  which is its variable to the end (Hénon): it meets the release exactly.

The equations of a panel are integral ones, solved by Picard's iteration for many balls at
once; each sweep is a few products with one small matrix. The length of a panel is each
ball's own, so that the last Legendre coefficients of what is integrated are small. The
error of the end falls about twice as fast as they do (Gauss); measured against the
collocation of the whole contact it is below 10⁻¹² of D, and mostly at rounding.

What is checked: the coefficients, and that the ball is held at all nodes. What is not
certified: that the grip has not vanished and come back between two nodes, a small part
of an oscillation; and no contact is proved to last for ever.
"""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.contacts.contact_scales import scales
from bouncing_ball.contacts.laws.contact_law import ContactLaw
from bouncing_ball.contacts.quadrature import scheme
from bouncing_ball.contacts.release import Release
from bouncing_ball.motion.ensembles import pick

_NODES = 16
# Sweeps at most, and their last change in parts of V: the next would be a tenth of it.
_SWEEPS, _SETTLED = 14, 3e-13
# Last Legendre coefficients of what is integrated, over V or P/V.
_SPECTRUM, _TAIL = 1e-6, 2
# The first panel's depth in parts of P, and the second's length in parts of P/V.
_DEEP, _LONG = 0.6, 0.9
# Bounds of the change from one length to the next, and of that of a refused panel.
_SHORTER, _LONGER, _SAFETY, _AGAIN = 0.3, 2.0, 0.9, 0.6
# Longest panel in time: as an angle of the oscillation, so that the sweeps converge, and in parts
# of the time that is left to the release.
_TURN, _SURE = 1.8, 0.8
# The last panel must change p′² by less than this factor, or take this part of a turn.
_FAST, _NEAR = 0.2, 0.5
# Balls worked on at once: their nodes fit into the cache.
_POOL = 2048
# Panels, some hundreds of oscillations.
_MOST = 2000
# A ball at rest, in parts of V: its q is slow, and its time is not.
_AT_REST = 1e-9
_TINY = 1e-300


class Touch(NamedTuple):
    """Starts of contact, one-dimensional: p, p′, the table's phase and Λ."""

    depth: np.ndarray
    rate: np.ndarray
    phase: np.ndarray
    amplitude: Any

    def take(self, which) -> "Touch":
        """Some of them."""
        return Touch(*(pick(x, which) for x in self))


class ContactEnd(NamedTuple):
    """Ends of contact: duration, p, p′; NaN and ``undecided`` where none was found."""

    duration: np.ndarray
    depth: np.ndarray
    rate: np.ndarray
    undecided: np.ndarray


class _Panel(NamedTuple):
    """Gauss' nodes in (0, 1), the integrals up to them and up to 1, the last Legendre
    coefficients."""

    node: np.ndarray
    integral: np.ndarray
    tail: np.ndarray


@lru_cache(maxsize=1)
def _panel() -> _Panel:
    s = scheme(_NODES, 1)
    inner = s.rate + np.outer(~s.early, s.gain)
    return _Panel(s.node[:, np.newaxis], np.vstack([inner, s.gain]), s.spectrum[-_TAIL:])


class _Balls(NamedTuple):
    """Balls in contact: their place in the row, law, table, motion, scales, next lengths.

    ``first`` marks those that have not moved, ``last`` those that may reach the release by one
    panel, and ``tried`` how many panels have been computed.
    """

    place: np.ndarray
    law: ContactLaw
    phase: np.ndarray
    amplitude: Any
    depth: np.ndarray
    rate: np.ndarray
    time: np.ndarray
    length: np.ndarray
    speed: np.ndarray
    first: np.ndarray
    last: np.ndarray
    step: np.ndarray
    tried: np.ndarray

    def take(self, which) -> "_Balls":
        parts: Any = (x.take(which) if isinstance(x, ContactLaw) else pick(x, which) for x in self)
        return _Balls(*parts)

    def load(self, time):
        """a = 1 - Λ sin(φ + t)."""
        result = self.phase + time
        np.sin(result, out=result)
        result *= self.amplitude
        return np.subtract(1, result, out=result)


class _End(NamedTuple):
    """The ends of panels: p, p′, t, and the last coefficients, infinite for a panel that
    has not converged or in which the ball is not held."""

    depth: np.ndarray
    rate: np.ndarray
    time: np.ndarray
    error: np.ndarray


def _power(q, exponent: int):
    result = np.ones_like(q) if exponent == 0 else q
    for _ in range(exponent - 1):
        result = result * q
    return result


def _settle(sweep, start, speed):
    """Iterate p′ at the nodes, from a constant; what the last sweep gave, and its change."""
    rate = start
    for _ in range(_SWEEPS):
        end = sweep(rate)
        change = np.max(np.abs(end[0][:-1] - rate), axis=0) / speed
        rate = end[0][:-1]
        if not np.any(change > _SETTLED):
            break
    return end, np.where(np.isnan(change), np.inf, change)


def _along_time(balls: _Balls) -> _End:
    """A panel of the length ``step`` in time."""
    node, integral, tail = _panel()
    inner = integral[:-1]
    h, law, start = balls.step, balls.law, balls.rate
    load = balls.load(balls.time + h * node)

    def sweep(rate):
        p = np.maximum(balls.depth + h * (inner @ rate), _TINY)
        push = load - law.force(p, rate)
        return start + h * (integral @ push), push

    first = load[0] - law.force(np.maximum(balls.depth, _TINY), start)
    (rate, push), change = _settle(sweep, start + h * node * first, balls.speed)
    path = balls.depth + h * (integral @ rate[:-1])
    held = np.all(path > 0, axis=0)
    if law.release is not Release.DISPLACEMENT:
        held &= np.all(law.grip(path, rate) > 0, axis=0)
    error = _error(change, np.abs(h) / balls.speed, tail @ push)
    return _End(path[-1], rate[-1], balls.time + h, np.where(held, error, np.inf))


def _error(change, unit, *tails):
    """The largest of the last coefficients, relative; infinite without convergence."""
    error = np.max([np.max(np.abs(x), axis=0) for x in tails], axis=0) * unit
    return np.where((change <= 4 * _SETTLED) & np.isfinite(error), error, np.inf)


def _along_root(balls: _Balls, reach) -> _End:
    """A panel from p to the root q + ``reach``, 0 for the last."""
    node, integral, tail = _panel()
    law, m = balls.law, balls.law.root
    root = balls.depth ** (1 / m)
    q = root + reach * node
    before = _power(q, m - 1)
    p, lever = before * q, (m * reach) * before
    sign, energy = np.sign(balls.rate), balls.rate * balls.rate / 2

    def sweep(rate):
        slow = lever / rate
        time = balls.time + integral[:-1] @ slow
        push = lever * (balls.load(time) - law.force(p, rate))
        return sign * np.sqrt(2 * (energy + integral @ push)), push, slow

    begin = np.broadcast_to(balls.rate, p.shape)
    (rate, push, slow), change = _settle(sweep, begin, balls.speed)
    end = root + reach
    time = balls.time + integral[-1] @ (lever / rate[:-1])
    v = balls.speed
    error = np.maximum(
        _error(change, 1 / (v * v), tail @ push), _error(change, v / balls.length, tail @ slow)
    )
    return _End(_power(end, m), rate[-1], time, error)


def _along_grip(balls: _Balls) -> _End:
    """A panel along the grip, down to 0."""
    _, integral, tail = _panel()
    law, size = balls.law, balls.speed
    grip = law.grip(balls.depth, balls.rate)
    others = np.stack([balls.depth, balls.time])
    state = np.repeat(others[:, np.newaxis], _NODES, axis=1)
    changes = state

    def sweep(rate):
        nonlocal state, changes
        p, time = np.maximum(state[0], _TINY), state[1]
        push = balls.load(time) - law.force(p, rate)
        slopes = law.grip_slopes(p, rate)
        ahead = -grip / (slopes.by_penetration * rate + slopes.by_rate * push)
        changes = np.stack([rate * ahead, ahead, push * ahead])
        after = others[:, np.newaxis] + integral @ changes[:2]
        state = after[:, :-1]
        return balls.rate + integral @ changes[2], after[:, -1]

    begin = np.broadcast_to(balls.rate, state[0].shape)
    (rate, (depth, time)), change = _settle(sweep, begin, size)
    unit = np.stack([1 / balls.length, size / balls.length, 1 / size])
    error = _error(change, 1.0, *(tail @ changes * unit[:, np.newaxis]))
    fine = (depth > 0) & (rate[-1] < 0)
    return _End(depth, rate[-1], time, np.where(fine, error, np.inf))


def _panels(balls: _Balls) -> _End:
    """One panel of each ball, of its own kind."""
    law, out = balls.law, np.empty((4, balls.rate.size))

    def last(some):
        if law.release is not Release.DISPLACEMENT:
            return _along_grip(some)
        return _along_root(some, -(some.depth ** (1 / law.root)))

    kinds = (
        (balls.first, lambda some: _along_root(some, some.step)),
        (~(balls.first | balls.last), _along_time),
        (balls.last, last),
    )
    for which, panel in kinds:
        part = np.flatnonzero(which)
        if part.size:
            out[:, part] = panel(balls.take(part))
    return _End(*out)


def _begin(law: ContactLaw, touch: Touch) -> _Balls:
    """The balls at the start of contact."""
    zero = np.zeros(touch.rate.size)
    scale = scales(law, np.abs(touch.rate), 1 + np.abs(touch.amplitude) + zero)
    slow = (touch.depth == 0) & (touch.rate < _AT_REST * scale.speed)
    first = (touch.depth == 0) & ~slow
    reach = (_DEEP * scale.length) ** (1 / law.root)
    return _Balls(
        place=np.arange(zero.size),
        law=law,
        phase=touch.phase,
        amplitude=touch.amplitude,
        depth=touch.depth + zero,
        rate=np.where(slow, _AT_REST * scale.speed, touch.rate),
        time=zero,
        length=scale.length,
        speed=scale.speed,
        first=first,
        last=np.zeros(zero.size, dtype=bool),
        step=np.where(first, reach, _LONG * scale.length / scale.speed),
        tried=np.zeros(zero.size, dtype=int),
    )


def _outlook(law: ContactLaw, load, depth, rate) -> tuple[np.ndarray, np.ndarray]:
    """Whether a panel may reach the release, and how long one in time may be."""
    p = np.maximum(depth, _TINY)
    force, slopes = law.force(p, rate), law.slopes(p, rate)
    stiffness = np.maximum(slopes.by_penetration, 0.0) + slopes.by_rate**2
    longest = _TURN / np.sqrt(np.maximum(stiffness, _TINY))
    if law.release is Release.DISPLACEMENT:
        # p′² now, and about what is left of it at p = 0.
        now = rate * rate
        then = now + depth * (force - 2 * load)
        sure = (now > _FAST * then) & (then > _FAST * now)
        left, fall = depth, -rate
    else:
        by = law.grip_slopes(p, rate)
        left, fall = law.grip(p, rate), -by.by_penetration * rate - by.by_rate * (load - force)
        sure = left < _NEAR * fall * longest
    ahead = np.where(fall > 0, left / np.maximum(fall, _TINY), np.inf)
    return sure & (rate < 0) & (fall > 0), np.minimum(longest, _SURE * ahead)


def _advanced(balls: _Balls, end: _End) -> tuple[_Balls, np.ndarray]:
    """The balls after a panel, where it was good, and which have been released."""
    excess = end.error / _SPECTRUM
    good = excess <= 1
    factor = _SAFETY * np.maximum(excess, _TINY) ** (-1 / _NODES)
    factor = np.where(np.isfinite(factor), np.clip(factor, _SHORTER, _LONGER), _SHORTER)
    step = balls.step * np.where(good, factor, np.minimum(factor, _AGAIN))
    # The next after the first goes along the time; after a last that was refused, as before it.
    step = np.where(balls.last, balls.step, step)
    step = np.where(good & balls.first, _LONG * balls.length / balls.speed, step)
    moved = zip(end[:3], (balls.depth, balls.rate, balls.time), strict=True)
    depth, rate, time = (np.where(good, after, before) for after, before in moved)
    last, longest = _outlook(balls.law, balls.load(time), depth, rate)
    last &= good
    first = balls.first & ~good
    return balls._replace(
        depth=depth,
        rate=rate,
        time=time,
        step=np.where(last | first, step, np.minimum(step, longest)),
        first=first,
        last=last,
        tried=balls.tried + 1,
    ), good & balls.last


def release(law: ContactLaw, touch: Touch) -> ContactEnd:
    """The release of each ball.

    Examples
    --------
    >>> from bouncing_ball.contacts.laws.linear import Linear
    >>> zero, two = np.zeros(1), np.full(1, 2.0)
    >>> end = release(Linear(1e3, 0.0), Touch(zero, two, zero, zero))
    >>> end.rate.round(12).tolist()
    [-2.0]
    """
    depth, rate, time = out = np.full((3, touch.rate.size), np.nan)
    with np.errstate(all="ignore"):
        waiting = _begin(law, touch)
        pool, waiting = waiting.take(slice(_POOL)), waiting.take(slice(_POOL, None))
        while pool.rate.size:
            pool, done = _advanced(pool, _panels(pool))
            out[:, pool.place[done]] = pool.depth[done], pool.rate[done], pool.time[done]
            pool = pool.take(np.flatnonzero(~done & (pool.tried < _MOST)))
            free = _POOL - pool.rate.size
            if waiting.rate.size and free > _POOL / 4:
                pool = _joined(pool, waiting.take(slice(free)), law)
                waiting = waiting.take(slice(free, None))
    if law.release is Release.DISPLACEMENT:
        depth = np.where(np.isnan(time), np.nan, 0.0)
    return ContactEnd(time, depth, rate, np.isnan(time))


def _joined(some: _Balls, more: _Balls, law: ContactLaw) -> _Balls:
    """Balls of two rows in one; ``law`` is that of all balls."""
    pairs = zip(some._replace(law=law), more._replace(law=law), strict=True)
    parts: Any = (np.concatenate(x) if np.ndim(x[0]) else x[0] for x in pairs)
    both = _Balls(*parts)
    return both._replace(law=law.take(both.place))


def state_at(law: ContactLaw, touch: Touch, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """p and p′ of each ball at its own time after the start, in contact; NaN if not reached.

    Examples
    --------
    >>> from bouncing_ball.contacts.laws.linear import Linear
    >>> zero, one = np.zeros(1), np.ones(1)
    >>> touch = Touch(zero, 1e3 * one, zero, zero)
    >>> depth, rate = state_at(Linear(1e3, 0.0), touch, 5e-4 * np.pi * one)
    >>> depth.round(5).tolist()
    [1.0]
    """
    with np.errstate(all="ignore"):
        balls = _begin(law, touch)
        longest = _LONG * balls.length / balls.speed
        balls = balls._replace(first=np.zeros_like(balls.first), step=longest)
        out = np.stack([balls.depth, balls.rate])
        for _ in range(_MOST):
            left = time[balls.place] - balls.time
            balls = balls.take(left > 0)._replace(last=np.zeros(np.count_nonzero(left > 0), bool))
            if not balls.place.size:
                return out[0], out[1]
            short = balls._replace(step=np.minimum(balls.step, left[left > 0]))
            balls, _ = _advanced(short, _along_time(short))
            out[:, balls.place] = balls.depth, balls.rate
    out[:, balls.place] = np.nan
    return out[0], out[1]
