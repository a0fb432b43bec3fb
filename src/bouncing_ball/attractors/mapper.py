r"""From the start of a ball to the motion on which it ends, for every model.

A motion repeats if its state returns and its neighbours approach it. A ball is compared
with its state at a mark, an impact that is moved forward from time to time (Brent's method), and
the derivative M of the motion since the mark is kept. Consider the first impact at which the orbit
that is fixed under the motion since the mark,

    s* = s + (I - M)⁻¹ (F(s) - s),

is nearer to the state s of the mark than a small distance, and at which the multipliers of M are
smaller than 1 by a margin. The mark is then moved to this impact, and the motion repeats if the
ball returns to it again in as many impacts or fewer. The distance is far above rounding and far
below the distance of two orbits whose multipliers have that margin, so that neither affects the
result.

With instantaneous impacts the motion after sticking does not depend on earlier impacts, because a
ball always leaves in the state of the lift-off. A motion that sticks twice therefore repeats,
unless rounding errors grow to its size in between. In a contact of finite stiffness the
dependence decreases by a finite factor, and the state is compared as for any other motion.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.attractors.motions import Kind, Motions, Reason
from bouncing_ball.motion.angles import reduce_angle, table
from bouncing_ball.motion.dynamics import Departure, Dynamics, Impact
from bouncing_ball.motion.ensembles import pick
from bouncing_ball.motion.sequence import Status
from bouncing_ball.motion.simulation import Law, first_impacts
from bouncing_ball.motion.tangent import Jacobian

IMPACTS = 2000
"""Number of impacts after which the search for a repetition ends."""

# Distance of a state from the orbit at which a ball is taken to be on it, and on its second
# turn: an angle, and a velocity over 1 + Λ. Multipliers are then known to their product with the
# curvature of the map; they must be below 1 by the margin.
_NEAR, _AGAIN, _MARGIN = 1e-7, 1e-6, 1e-3
# Returns farther away than this are ignored.
_SIGHT = 1e-2
# A mark is moved on after this part of all impacts, and these.
_SHARE, _LEAST = 0.5, 8
# Logarithms of the growth from a rounding error to 1, and to the distance above.
_DIGITS = -float(np.log(np.finfo(float).eps))
_FORGOTTEN = _DIGITS + float(np.log(_NEAR))
# Impacts of a mean of the stretching, means left out, and standard errors by which an exponent is
# positive: once in three million by chance.
_BATCH, _TRANSIENT, _ERRORS = 32, 2, 5.0
# Balls followed at once: the late ones among fewer decide on the number of steps.
_BLOCK = 1 << 16
# Stretching by less is as good as forgetting.
_TINY = 1e-300


class _Ball(NamedTuple):
    """The state of each ball that is followed."""

    lane: np.ndarray
    amplitude: np.ndarray
    seen: np.ndarray
    time: np.ndarray
    # The mark: its impact, time and state, the derivative and the impacts that stuck since then,
    # the impact at which it is moved on, and the impacts until a first return, 0 for none.
    marked: np.ndarray
    mark_time: np.ndarray
    phase: np.ndarray
    velocity: np.ndarray
    since: Jacobian
    stuck: np.ndarray
    moves: np.ndarray
    turn: np.ndarray
    # The reason for which it may stay undecided.
    doubt: np.ndarray
    # The last lift-off of a ball that forgets: its impact, -1 for none, and its time.
    lift: np.ndarray
    lift_time: np.ndarray
    # A deviation of length 1, the logarithm of its growth, and the least that this has been.
    along: np.ndarray
    across: np.ndarray
    growth: np.ndarray
    least: np.ndarray
    # The least since the mark, and the most by which it has grown since.
    lowest: np.ndarray
    worst: np.ndarray
    # Growth and time at the last mean; the number of means, sums of growth and time over them and
    # of their products.
    mean_growth: np.ndarray
    mean_time: np.ndarray
    sums: np.ndarray


def _new(index: np.ndarray, amplitude: np.ndarray, impact: Impact) -> _Ball:
    """Balls at their first impacts, which are their first marks."""
    balls = index.size
    none, zero = np.zeros(balls, dtype=int), np.zeros(balls)
    fresh = (
        *(index, amplitude + zero, none, zero, none, zero, impact.phase, impact.velocity),
        *(Jacobian.identity(balls), none, none + _LEAST, none, none + 1, none - 1, zero),
        *(zero + 1, zero, zero, zero, zero, zero, zero, zero, np.zeros((balls, 6))),
    )
    columns: Any = (x if isinstance(x, tuple) else x.copy() for x in fresh)
    return _Ball(*columns)


class _Found(NamedTuple):
    """The fields of :class:`Motions`, with numbers in place of texts."""

    kind: np.ndarray
    periods: np.ndarray
    impacts: np.ndarray
    exponent: np.ndarray
    exponent_error: np.ndarray
    reason: np.ndarray
    followed: np.ndarray
    end_phase: np.ndarray
    end_velocity: np.ndarray

    def write(self, ball: _Ball, which: np.ndarray, kind, reason=Reason.NONE, **values) -> None:
        """Store the results for some of the balls that are followed."""
        index = ball.lane[which]
        self.kind[index], self.reason[index] = _KINDS.index(kind), _REASONS.index(reason)
        self.followed[index] = ball.seen[which]
        for name, value in values.items():
            getattr(self, name)[index] = value


_KINDS, _REASONS = list(Kind), list(Reason)


def label(
    law: Law,
    amplitude: ArrayLike,
    phase: ArrayLike,
    velocity: ArrayLike,
    *,
    impacts: int = IMPACTS,
) -> Motions:
    """The motions on which balls end that start with an impact.

    Parameters
    ----------
    law, amplitude, phase, velocity
        As in :func:`bouncing_ball.motion.simulation.simulate`: φ and the absolute velocity z′
        before the impact.
    impacts : int
        Number of impacts after which the search for a repetition ends. A motion is found if it
        repeats within about a third of them.

    Returns
    -------
    Motions
        Of the shape to which the arguments broadcast.

    Raises
    ------
    ModelError
        If r, Λ or a state is outside its range, or if a ball rises from the table.

    Examples
    --------
    Below and above the period doubling at Λ = 1.527, and a motion that sticks to the table:

    >>> found = label(0.5, [1.2, 1.6, 2.5], 1.0, -3.0)
    >>> found.kind.tolist(), found.periods.tolist(), found.impacts.tolist()[:2]
    (['orbit', 'subharmonic', 'locked'], [1, 2, 6], [1, 2])
    """
    dynamics, start, relative, shape = first_impacts(law, amplitude, phase, velocity)
    # Derivatives of long turns may overflow, and those of a ball that sticks are zero.
    with np.errstate(all="ignore"):
        found = _follow(dynamics, start, relative, impacts)
    words = (
        np.array([str(x) for x in names])[numbers]
        for names, numbers in ((_KINDS, found.kind), (_REASONS, found.reason))
    )
    kind, reason = words
    values = found._replace(kind=kind, reason=reason)
    return Motions(*(x.reshape(shape) for x in values))


def _follow(dynamics: Dynamics, start: np.ndarray, relative: np.ndarray, impacts: int) -> _Found:
    """Follow all balls, in a block that is refilled when some of its balls are done."""
    size, block = start.size, _BLOCK
    whole, real = np.zeros((5, size), dtype=int), np.full((4, size), np.nan)
    found = _Found(*whole[:3], *real[:2], *whole[3:], *real[2:])
    ahead = 0
    now: Any = None
    ball: Any = None
    impact: Any = None
    while size:
        room = block - (0 if ball is None else ball.lane.size)
        if ahead < size and 4 * room >= block:
            more = np.arange(ahead, min(ahead + room, size))
            ahead += more.size
            fresh = dynamics.take(more).start(start[more], relative[more])
            born = _new(more, pick(dynamics.amplitude, more), fresh)
            ball, impact = (born, fresh) if ball is None else _joined((ball, impact), (born, fresh))
            now = dynamics.take(ball.lane)
        departure = now.depart(impact)
        going = _resting(now, impact, departure, ball, found)
        if going.size < ball.lane.size:
            _end(ball, impact, going, found)
            now, impact, departure, ball = _those(going, now, impact, departure, ball)
        if going.size:
            sticks = now.sticks(impact, departure)
            after, passed = now.fly(departure)
            change = now.jacobian(impact, departure, after, passed)
            impact = after
            _move(ball, change, passed, sticks)
            going = _returning(ball, now.section(impact), impacts, found)
            if going.size < ball.lane.size:
                _end(ball, impact, going, found)
                now, impact, ball = _those(going, now, impact, ball)
        if not ball.lane.size:
            if ahead == size:
                break
            ball = None
    return found


def _those(which: np.ndarray, *rows: Any) -> Any:
    """Some of the balls, from all arrays about them."""
    return (x.take(which) if isinstance(x, Dynamics) else pick(x, which) for x in rows)


def _end(ball: _Ball, impact: Impact, going: np.ndarray, found: _Found) -> None:
    """Write down where those are that go no further."""
    last = np.delete(np.arange(ball.lane.size), going)
    lane, phase = ball.lane[last], impact.phase[last]
    rests = found.kind[lane] == _KINDS.index(Kind.PERMANENT_CONTACT)
    thrown = impact.velocity[last] + table(phase, ball.amplitude[last])[0]
    found.end_phase[lane] = np.where(rests, np.nan, phase)
    found.end_velocity[lane] = np.where(rests, np.nan, thrown)


def _joined(one: Any, other: Any) -> Any:
    """Two rows as one; a number applies to all balls."""
    if isinstance(one, tuple):
        joined = (_joined(a, b) for a, b in zip(one, other, strict=True))
        return type(one)(*joined) if hasattr(one, "_fields") else tuple(joined)
    return np.concatenate([one, other]) if isinstance(one, np.ndarray) and one.ndim else one


def _resting(
    dynamics: Dynamics, impact: Impact, departure: Departure, ball: _Ball, found: _Found
) -> np.ndarray:
    """Store which balls stay on the table, or stick for the second time; return the others."""
    status = departure.status
    done = status != Status.BOUNCING
    if done.any():
        stays = status == Status.PERMANENT_CONTACT
        found.write(ball, stays, Kind.PERMANENT_CONTACT, periods=1, exponent_error=0.0)
        found.write(ball, done & ~stays, Kind.UNDECIDED, Reason.NO_RELEASE)
    if dynamics.forgets:
        sticks = ~done & dynamics.sticks(impact, departure)
        if sticks.any():
            time = ball.time + departure.duration
            again = sticks & (ball.lift >= 0) & ~_lost(ball)
            found.write(
                *(ball, again, Kind.LOCKED),
                periods=_periods(time - ball.lift_time)[again],
                impacts=(ball.seen - ball.lift)[again],
                exponent=-np.inf,
                exponent_error=0.0,
            )
            ball.lift[sticks], ball.lift_time[sticks] = ball.seen[sticks], time[sticks]
            done |= again
    return np.flatnonzero(~done)


def _lost(ball: _Ball) -> np.ndarray:
    """Whether a rounding error has grown too much since the ball last stuck."""
    return ball.growth - ball.least > _FORGOTTEN


def _doubt(ball: _Ball, which: np.ndarray, reason: Reason) -> None:
    ball.doubt[which] = _REASONS.index(reason)


def _periods(time: np.ndarray) -> np.ndarray:
    return np.rint(time / (2 * np.pi)).astype(int)


def _move(ball: _Ball, change: Jacobian, passed: np.ndarray, sticks: np.ndarray) -> None:
    """Advance all arrays to the next impact."""
    ball.seen[:] += 1
    ball.time[:] += passed
    ball.stuck[:] += sticks
    for values, new in zip(ball.since, change.after(ball.since), strict=True):
        values[:] = new
    along, across = change.apply(ball.along, ball.across)
    length = np.sqrt(along * along + across * across)
    # A resumption of the contact of a law without a lag has no derivative here.
    grown = np.where(np.isnan(length), 0.0, np.log(length))
    straight = length > _TINY
    ball.along[:] = np.where(straight, along / length, 1.0)
    ball.across[:] = np.where(straight, across / length, 0.0)
    forgot = np.flatnonzero(sticks & (ball.growth + grown < ball.least - _DIGITS))
    if forgot.size:
        _doubt(ball, forgot[_lost(ball)[forgot]], Reason.ROUNDING)
        for values in (ball.growth, ball.least, ball.lowest, ball.mean_growth, grown):
            values[forgot] = 0
        ball.mean_time[forgot] = ball.time[forgot]
    ball.growth[:] += grown
    np.minimum(ball.least, ball.growth, out=ball.least)
    np.minimum(ball.lowest, ball.growth, out=ball.lowest)
    np.maximum(ball.worst, ball.growth - ball.lowest, out=ball.worst)
    mean = np.flatnonzero(ball.seen % _BATCH == 0)
    if mean.size:
        growth, time = (
            ball.growth[mean] - ball.mean_growth[mean],
            ball.time[mean] - ball.mean_time[mean],
        )
        ball.mean_growth[mean], ball.mean_time[mean] = ball.growth[mean], ball.time[mean]
        terms = (np.ones_like(time), growth, time, growth * growth, growth * time, time * time)
        ball.sums[mean] += (
            np.stack(terms, axis=1) * (ball.seen[mean] > _TRANSIENT * _BATCH)[:, np.newaxis]
        )


def _returning(
    ball: _Ball, state: tuple[np.ndarray, np.ndarray], impacts: int, found: _Found
) -> np.ndarray:
    """Compare balls with their marks, and store which repeat or reach the last impact; return the
    others.
    """
    phase, velocity = state
    scale = 1 + ball.amplitude
    turned, faster = reduce_angle(phase - ball.phase), (velocity - ball.velocity) / scale
    near = np.flatnonzero((np.abs(turned) < _SIGHT) & (np.abs(faster) < _SIGHT))
    done = np.zeros(phase.size, dtype=bool)
    moves = ball.seen >= ball.moves
    if near.size:
        change, unit = pick(ball.since, near), scale[near]
        step = change.to_fixed_point(turned[near], faster[near] * unit)
        away = np.maximum(np.abs(step[0]), np.abs(step[1]) / unit)
        radius, second = change.spectral_radius(), ball.turn[near] > 0
        periods = _periods(ball.time[near] - ball.mark_time[near])
        back = (away <= np.where(second, _AGAIN, _NEAR)) & (radius <= 1 - _MARGIN)
        back &= (periods > 0) & (ball.worst[near] <= _FORGOTTEN)
        close = np.maximum(np.abs(turned[near]), np.abs(faster[near])) < _AGAIN
        _doubt(ball, near[close & (np.abs(radius - 1) < _MARGIN)], Reason.MARGINAL)
        count = ball.seen[near] - ball.marked[near]
        sure = back & second
        own, periods, length = near[sure], periods[sure], count[sure]
        common = np.gcd(periods, length) > 1
        kinds = np.where(
            ball.stuck[own] > 0, Kind.LOCKED, np.where(common, Kind.SUBHARMONIC, Kind.ORBIT)
        )
        for kind in (Kind.ORBIT, Kind.SUBHARMONIC, Kind.LOCKED):
            is_it = kinds == kind
            found.write(
                *(ball, own[is_it], kind),
                periods=periods[is_it],
                impacts=length[is_it],
                exponent=(np.log(radius[sure]) / periods)[is_it],
                exponent_error=0.0,
            )
        done[own] = True
        first = near[back & ~second]
        ball.turn[first], moves[first] = count[back & ~second], True
    _mark(ball, np.flatnonzero(moves & ~done), phase, velocity)
    over = np.flatnonzero((ball.seen >= impacts) & ~done)
    if over.size:
        _give_up(ball, over, found)
        done[over] = True
    return np.flatnonzero(~done)


def _mark(ball: _Ball, here: np.ndarray, phase: np.ndarray, velocity: np.ndarray) -> None:
    """Move the marks of some balls to their current impact; for one turn after a first return."""
    if not here.size:
        return
    count = ball.seen[here]
    # A second turn that did not come is forgotten.
    turn = np.where(ball.moves[here] > count, ball.turn[here], 0)
    ball.turn[here] = turn
    ball.marked[here], ball.mark_time[here] = count, ball.time[here]
    ball.phase[here], ball.velocity[here] = phase[here], velocity[here]
    for values, one in zip(ball.since, (1.0, 0.0, 0.0, 1.0), strict=True):
        values[here] = one
    ball.stuck[here] = ball.worst[here] = 0
    ball.lowest[here] = ball.growth[here]
    ball.moves[here] = count + np.where(
        turn, turn + 1, np.maximum(_LEAST, (_SHARE * count).astype(int))
    )


def _give_up(ball: _Ball, which: np.ndarray, found: _Found) -> None:
    """Store which of the balls that have not repeated are chaotic."""
    number, growth, time, square, product, times = ball.sums[which].T
    rate = growth / time
    # The error of a ratio of means, each over a stretch of the motion.
    rest = square - 2 * rate * product + rate * rate * times
    error = np.sqrt(np.maximum(rest, 0.0) * number / (number - 1)) / time
    known = {"exponent": 2 * np.pi * rate, "exponent_error": 2 * np.pi * error}
    # Next to a bifurcation neighbours part, and not exponentially.
    chaotic = (rate > _ERRORS * error) & (growth > -np.log(_NEAR))
    chaotic &= ball.doubt[which] != _REASONS.index(Reason.MARGINAL)
    found.write(ball, which, Kind.UNDECIDED, **known)
    found.reason[ball.lane[which]] = np.where(chaotic, 0, ball.doubt[which])
    found.kind[ball.lane[which[chaotic]]] = _KINDS.index(Kind.CHAOTIC)
