r"""From the start of a ball to the motion on which it ends, for every model.

A motion repeats if its state returns and neighbouring motions approach it. The state of a ball is
compared with its state at a mark, an impact that is moved forward from time to time (Brent's
method), and the derivative M of the motion F since the mark is stored. The fixed point of F near
the state s of the mark is

    s* = s + (I - M)⁻¹ (F(s) - s).

At the first impact at which s* is nearer to s than a small distance, and at which the multipliers
of M are smaller than 1 by a margin, the mark is moved to this impact. The motion repeats if the
ball then returns to the mark again in as many impacts or fewer. The small distance is far above
rounding errors and far below the distance of two orbits whose multipliers have that margin, so that
neither affects the result.

With instantaneous impacts the motion after sticking does not depend on earlier impacts, because a
ball always leaves in the state of the lift-off. A motion that sticks twice therefore repeats,
unless rounding errors grow to its size in between. In a contact of finite stiffness the
dependence decreases by a finite factor, and the state is compared as for any other motion.

Balls are followed with the operations + - × ÷ and √ only, so that the same bits give the same
motion on every processor. A ball with a long transient loses the digits of its start, and the last
digit then decides on which motion the ball ends: see ``digits_lost`` of
:class:`~bouncing_ball.beyond.long_run.motions.Motions`.
"""

from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.beyond.long_run.lyapunov import DIGITS, FORGOTTEN, NEAR, Stretching
from bouncing_ball.beyond.long_run.motions import Kind, Motions, Reason
from bouncing_ball.beyond.simulation import Law, dynamics_of
from bouncing_ball.numerics.arrays import pick
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.paper.motion.deviations import Jacobian
from bouncing_ball.paper.motion.dynamics import Departure, Dynamics, Impact
from bouncing_ball.paper.motion.flight import table
from bouncing_ball.paper.motion.sequence import Status

IMPACTS = 2000
"""Number of impacts after which the search for a repetition ends."""
# Distance from the orbit within which a ball on its second turn is regarded as being on the orbit,
# as NEAR is on the first turn: an angle, and a velocity over 1 + Λ. The error of the multipliers is
# then this distance times the curvature of the map; they must be below 1 by the margin.
_AGAIN, _MARGIN = 1e-6, 1e-3
# Returns farther away than this are ignored.
_SIGHT = 1e-2
# A mark is moved forward after this fraction of all impacts so far, and at least this number.
_SHARE, _LEAST = 0.5, 8
# Number of standard errors by which the exponent of a chaotic motion must be positive; this happens
# by chance once in three million.
_ERRORS = 5.0
# Number of balls followed at the same time, and the bytes that are allocated once at the start.
_BLOCK, _KEPT = 1 << 16, 1 << 24
_REASONS = list(Reason)


class _Mark(NamedTuple):
    """The impact with which the state of each ball is compared, and the motion since then."""

    impact: np.ndarray
    time: np.ndarray
    phase: np.ndarray
    velocity: np.ndarray
    # The derivative of the motion since the mark, and the number of stickings since the mark.
    since: Jacobian
    stuck: np.ndarray
    # The impact at which the mark is moved forward, and the number of impacts until a first return,
    # 0 if there was none.
    until: np.ndarray
    turn: np.ndarray


class _Ball(NamedTuple):
    """The state of each ball that is followed."""

    lane: np.ndarray
    amplitude: np.ndarray
    # The number of impacts, and the time, since the start.
    seen: np.ndarray
    time: np.ndarray
    # The reason for which the motion may stay undecided, as an index into the list of reasons.
    doubt: np.ndarray
    # The last lift-off of a ball with instantaneous impacts: the number of its impact, -1 if there
    # was none, and its time. A lap is the number of impacts between two lift-offs between which
    # rounding errors have grown too much, 0 if there was none.
    lift: np.ndarray
    lift_time: np.ndarray
    lap: np.ndarray
    mark: _Mark
    stretch: Stretching

    @classmethod
    def new(cls, index: np.ndarray, amplitude: np.ndarray, impact: Impact) -> Self:
        """Balls at their first impacts, which are their first marks."""
        seen, doubt, lift, lap, marked, stuck, until, turn = np.zeros((8, index.size), dtype=int)
        time, lift_time, mark_time = np.zeros((3, index.size))
        one = Jacobian.identity(index.size)
        place = impact.phase.copy(), impact.velocity.copy()
        mark = _Mark(marked, mark_time, *place, one, stuck, until + _LEAST, turn)
        of = seen, time, doubt + 1, lift - 1, lift_time, lap, mark, Stretching.of(index.size)
        return cls(index, amplitude + time, *of)


def label(
    law: Law,
    amplitude: ArrayLike,
    phase: ArrayLike,
    velocity: ArrayLike,
    *,
    impacts: int = IMPACTS,
    path: np.ndarray | None = None,
) -> Motions:
    """The motions on which balls end that start with an impact.

    Parameters
    ----------
    law, amplitude, phase, velocity
        As in :func:`bouncing_ball.beyond.simulation.simulate`. The phase is φ, and the velocity is
        the absolute velocity z′ before the impact.
    impacts : int
        Number of impacts after which the search for a repetition ends. A motion is found if it
        repeats within about a third of them.
    path : array, optional
        Contiguous, with the shape (3, impacts) in front of that of the result. It is filled with
        time, φ and z′ of each impact before the one at which the motion is found.

    Returns
    -------
    Motions
        Arrays of the shape to which the arguments broadcast.

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

    The path to a motion is the one that a simulation has, up to a rounding of the velocity:

    >>> from bouncing_ball.beyond.simulation import simulate
    >>> path, start = np.empty((3, 20, 2)), (0.5, [1.2, 1.6], 1.0, -3.0)
    >>> found, way = label(*start, impacts=20, path=path), simulate(*start, 20)
    >>> apart = np.abs(path - [way.time, way.phase, way.impact_velocity])
    >>> found.followed.tolist(), apart[:2].max().tolist(), bool(apart[2].max() < 1e-15)
    ([20, 20], 0.0, True)
    """
    dynamics, start, relative, shape = dynamics_of(law, amplitude).first_impacts(phase, velocity)
    # After memory of this size has been freed once, the process keeps it and need not request it
    # from the system at each step.
    np.empty(_KEPT, dtype=np.int8)
    # The derivatives of a long turn may overflow, and those of a ball that sticks are zero.
    with np.errstate(all="ignore"):
        found = _follow(dynamics, start, relative, impacts, path)
    return Motions(*(x.reshape(shape) for x in vars(found).values()))


def _follow(
    dynamics: Dynamics, start: np.ndarray, relative: np.ndarray, impacts: int, path: Any
) -> Motions:
    """Follow all balls, in a block to which new balls are added when a quarter of it is free."""
    found, size = Motions.unknown(start.size), start.size
    ball: Any = None
    impact: Any = None
    alive = ahead = 0
    while alive or ahead < size:
        if ahead < size and 4 * (_BLOCK - alive) >= _BLOCK:
            more = np.arange(ahead, min(ahead + _BLOCK - alive, size))
            ahead += more.size
            fresh = dynamics.take(more).start(start[more], relative[more])
            born = _Ball.new(more, pick(dynamics.amplitude, more), fresh), fresh
            ball, impact = _joined((ball, impact), born) if alive else born
            now = dynamics.take(ball.lane)
        if path is not None:
            thrown = impact.velocity + table(impact.phase, ball.amplitude)[0]
            path.reshape(3, impacts, -1)[:, ball.seen, ball.lane] = ball.time, impact.phase, thrown
        departure = now.depart(impact, differentiate=True)
        going = _resting(now, departure, ball, found)
        now, impact, departure, ball = _kept(going, found, now, impact, departure, ball)
        if going.size:
            after, passed = now.fly(departure)
            _move(ball, now.jacobian(impact, departure, after, passed), passed, departure.sticks)
            going = _returning(ball, now.section(after), impacts, found)
            now, impact, ball = _kept(going, found, now, after, ball)
        alive = going.size
    return found


def _kept(going: np.ndarray, found: Motions, now: Dynamics, impact: Impact, *rows: Any) -> Any:
    """Select the balls that continue, in all arrays; store the last impacts of the other balls."""
    ball = rows[-1]
    if going.size < ball.lane.size:
        last = np.delete(np.arange(ball.lane.size), going)
        index, phase = ball.lane[last], impact.phase[last]
        phase[found.kind[index] == Kind.PERMANENT_CONTACT] = np.nan
        thrown = impact.velocity[last] + table(phase, ball.amplitude[last])[0]
        found.fill(index, end_phase=phase, end_velocity=thrown)
        now, impact, *rows = now.kept(going, impact, *rows)
    return now, impact, *rows


def _joined(one: Any, other: Any) -> Any:
    """Join the arrays of two groups of balls; a number applies to all balls and stays a number."""
    if isinstance(one, tuple):
        joined = (_joined(a, b) for a, b in zip(one, other, strict=True))
        return getattr(one, "_make", tuple)(joined)
    return np.concatenate([one, other]) if isinstance(one, np.ndarray) and one.ndim else one


def _write(found: Motions, ball: _Ball, which: np.ndarray, kind: ArrayLike, **values: Any) -> None:
    lost = ball.stretch.most[which] / np.log(10)
    found.fill(ball.lane[which], kind=kind, followed=ball.seen[which], digits_lost=lost, **values)


def _repeats(
    found: Motions, ball: _Ball, which: np.ndarray, kind: ArrayLike, *values: ArrayLike
) -> None:
    """Store the kinds, periods, impacts and exponents of motions that repeat."""
    known = dict(zip(("periods", "impacts", "exponent"), values, strict=True))
    _write(found, ball, which, kind, exponent_error=0.0, **known)


def _resting(dynamics: Dynamics, departure: Departure, ball: _Ball, found: Motions) -> np.ndarray:
    """Store which balls stay on the table, are not released, or lock because they stick again;
    return the indices of the others.
    """
    done = departure.status != Status.BOUNCING
    stays = departure.status == Status.PERMANENT_CONTACT
    if done.any():
        _write(found, ball, stays, Kind.PERMANENT_CONTACT, periods=1, exponent_error=0.0)
        _write(found, ball, done & ~stays, Kind.UNDECIDED, reason=Reason.NO_RELEASE)
    if dynamics.forgets:
        sticks = ~done & departure.sticks
        if sticks.any():
            time = ball.time + departure.duration
            again, lost = sticks & (ball.lift >= 0), ball.stretch.lost()
            lap, periods = ball.seen - ball.lift, _periods(time - ball.lift_time)
            ball.lap[again & lost] = lap[again & lost]
            again &= ~lost
            _repeats(found, ball, again, Kind.LOCKED, periods[again], lap[again], -np.inf)
            ball.lift[sticks], ball.lift_time[sticks] = ball.seen[sticks], time[sticks]
            done |= again
    return np.flatnonzero(~done)


def _periods(time: np.ndarray) -> np.ndarray:
    return np.rint(time / (2 * np.pi)).astype(int)


def _move(ball: _Ball, change: Jacobian, passed: np.ndarray, sticks: np.ndarray) -> None:
    """Advance the counts, times, derivatives and deviations of all balls to the next impact."""
    mark, stretch = ball.mark, ball.stretch
    ball.seen[:] += 1
    ball.time[:] += passed
    mark.stuck[:] += sticks
    for values, new in zip(mark.since, change.after(mark.since), strict=True):
        values[:] = new
    grown = stretch.grow(change)
    forgot = np.flatnonzero(sticks & (stretch.growth + grown < stretch.least - DIGITS))
    if forgot.size:
        ball.doubt[forgot[stretch.lost()[forgot]]] = _REASONS.index(Reason.ROUNDING)
        stretch.forget(forgot, grown, ball.time)
    stretch.add(grown, ball.time, ball.seen)


def _returning(
    ball: _Ball, state: tuple[np.ndarray, np.ndarray], impacts: int, found: Motions
) -> np.ndarray:
    """Compare balls with their marks, and store which balls repeat or reach the last impact; return
    the indices of the others.
    """
    mark, scale = ball.mark, 1 + ball.amplitude
    turned, faster = reduce_angle(state[0] - mark.phase), (state[1] - mark.velocity) / scale
    near = np.flatnonzero((np.abs(turned) < _SIGHT) & (np.abs(faster) < _SIGHT))
    done, moves = np.zeros(turned.size, dtype=bool), ball.seen >= mark.until
    if near.size:
        change, unit = pick(mark.since, near), scale[near]
        step = change.to_fixed_point(turned[near], faster[near] * unit)
        away = np.maximum(np.abs(step[0]), np.abs(step[1]) / unit)
        radius, second = change.spectral_radius(), mark.turn[near] > 0
        periods = _periods(ball.time[near] - mark.time[near])
        back = (away <= np.where(second, _AGAIN, NEAR)) & (radius <= 1 - _MARGIN)
        back &= (periods > 0) & (ball.stretch.worst[near] <= FORGOTTEN)
        close = np.maximum(np.abs(turned[near]), np.abs(faster[near])) < _AGAIN
        close &= np.abs(radius - 1) < _MARGIN
        ball.doubt[near[close]] = _REASONS.index(Reason.MARGINAL)
        length, sure, first = ball.seen[near] - mark.impact[near], back & second, back & ~second
        own, whole = near[sure], np.gcd(periods, length)[sure] == 1
        repeats = np.where(whole, Kind.ORBIT, Kind.SUBHARMONIC)
        kind = np.where(mark.stuck[own] > 0, Kind.LOCKED, repeats)
        exponent = np.log(radius) / periods
        _repeats(found, ball, own, kind, periods[sure], length[sure], exponent[sure])
        done[own] = True
        mark.turn[near[first]], moves[near[first]] = length[first], True
    _mark(ball, np.flatnonzero(moves & ~done), *state)
    over = np.flatnonzero((ball.seen >= impacts) & ~done)
    if over.size:
        _give_up(ball, over, found)
        done[over] = True
    return np.flatnonzero(~done)


def _mark(ball: _Ball, here: np.ndarray, phase: np.ndarray, velocity: np.ndarray) -> None:
    """Move the marks of some balls to their current impact; after a first return the mark stays for
    one more turn.
    """
    mark, count = ball.mark, ball.seen[here]
    # If the ball did not return for the second time, its first return no longer counts.
    turn = np.where(mark.until[here] > count, mark.turn[here], 0)
    later = np.where(turn, turn + 1, np.maximum(_LEAST, (_SHARE * count).astype(int)))
    state = count, ball.time[here], phase[here], velocity[here]
    new = *state, *Jacobian.identity(here.size), 0, count + later, turn
    for values, value in zip((*mark[:4], *mark.since, *mark[5:]), new, strict=True):
        values[here] = value
    ball.stretch.mark(here)


def _give_up(ball: _Ball, which: np.ndarray, found: Motions) -> None:
    """Store which of the balls that have not repeated are chaotic, and which are undecided."""
    rate, error = ball.stretch.exponent(which, ball.lap[which])
    # Next to a bifurcation neighbours may separate, but not exponentially.
    chaotic = (rate > _ERRORS * error) & (ball.stretch.sums[which, 1] > -np.log(NEAR))
    chaotic &= ball.doubt[which] != _REASONS.index(Reason.MARGINAL)
    _write(
        *(found, ball, which, np.where(chaotic, Kind.CHAOTIC, Kind.UNDECIDED)),
        reason=np.where(chaotic, Reason.NONE, np.array(_REASONS)[ball.doubt[which]]),
        exponent=2 * np.pi * rate,
        exponent_error=2 * np.pi * error,
    )
