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
from bouncing_ball.numerics.arrays import pick
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.paper.motion.deviations import Jacobian
from bouncing_ball.paper.motion.dynamics import Departure, Dynamics, HasDynamics, Impact
from bouncing_ball.paper.motion.flight import table
from bouncing_ball.paper.motion.sequence import Status

IMPACTS = 2000
"""Number of impacts after which the search for a repetition ends."""
# Distance from the orbit within which a ball on its second turn is regarded as being on the orbit,
# as NEAR is on the first turn: an angle, and a velocity over 1 + Λ. The error of the multipliers is
# then this distance times the curvature of the map.
_NEAR_AGAIN = 1e-6
# The margin by which the multipliers of an attracting motion must be smaller than 1.
_MARGIN = 1e-3
# Returns farther away than this are ignored.
_SIGHT = 1e-2
# A mark is moved forward after this fraction of all impacts so far, and at least this number.
_SHARE = 0.5
_LEAST = 8
# Number of standard errors by which the exponent of a chaotic motion must be positive; this happens
# by chance once in three million.
_ERRORS = 5.0
# Number of balls followed at the same time.
_BLOCK = 1 << 16
# Number of bytes that are allocated once at the start.
_KEPT = 1 << 24
# The reasons as an array, so that a ball can hold the index of one.
_REASONS = np.array(list(Reason))
_NO_RECURRENCE = list(Reason).index(Reason.NO_RECURRENCE)
_MARGINAL = list(Reason).index(Reason.MARGINAL)
_ROUNDING = list(Reason).index(Reason.ROUNDING)


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


class _Balls(NamedTuple):
    """The balls that are followed, arrays with an entry per ball."""

    # The place of the ball in the results.
    lane: np.ndarray
    amplitude: np.ndarray
    # The number of impacts, and the time, since the start.
    seen: np.ndarray
    time: np.ndarray
    # The reason for which the motion may stay undecided, as an index into the array of reasons.
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
    def new(cls, lane: np.ndarray, amplitude: np.ndarray, impact: Impact) -> Self:
        """Balls at their first impacts, which are their first marks."""

        def whole(number: int) -> np.ndarray:
            return np.full(lane.size, number)

        mark = _Mark(
            impact=whole(0),
            time=np.zeros(lane.size),
            phase=impact.phase.copy(),
            velocity=impact.velocity.copy(),
            since=Jacobian.identity(lane.size),
            stuck=whole(0),
            until=whole(_LEAST),
            turn=whole(0),
        )
        return cls(
            lane=lane,
            amplitude=amplitude + np.zeros(lane.size),
            seen=whole(0),
            time=np.zeros(lane.size),
            doubt=whole(_NO_RECURRENCE),
            lift=whole(-1),
            lift_time=np.zeros(lane.size),
            lap=whole(0),
            mark=mark,
            stretch=Stretching.of(lane.size),
        )


def final_motions(
    model: HasDynamics,
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
    model : HasDynamics
        The model, or the law, of the impact.
    amplitude, phase, velocity : array_like
        Λ ≥ 0, the phase φ of the first impact, and the absolute velocity z′ before it.
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

    >>> from bouncing_ball.paper.orbits.restitution_model import RestitutionModel
    >>> model = RestitutionModel(0.5)
    >>> found = final_motions(model, [1.2, 1.6, 2.5], 1.0, -3.0)
    >>> found.kind.tolist(), found.periods.tolist(), found.impacts.tolist()[:2]
    (['orbit', 'subharmonic', 'locked'], [1, 2, 6], [1, 2])

    The path to a motion is the one that a simulation has, up to a rounding of the velocity:

    >>> path = np.empty((3, 20, 2))
    >>> start = [1.2, 1.6], 1.0, -3.0
    >>> found = final_motions(model, *start, impacts=20, path=path)
    >>> way = model.simulate(*start, 20)
    >>> apart = np.abs(path - [way.time, way.phase, way.impact_velocity])
    >>> found.followed.tolist(), apart[:2].max().tolist(), bool(apart[2].max() < 1e-15)
    ([20, 20], 0.0, True)
    """
    dynamics, start, relative, shape = model.dynamics(amplitude).first_impacts(phase, velocity)
    # After memory of this size has been freed once, the process keeps it and need not request it
    # from the system at each step.
    np.empty(_KEPT, dtype=np.int8)
    # The derivatives of a long turn may overflow, and those of a ball that sticks are zero.
    with np.errstate(all="ignore"):
        found = _follow(dynamics, start, relative, impacts, path)
    return Motions(**{name: values.reshape(shape) for name, values in vars(found).items()})


def _follow(
    dynamics: Dynamics,
    start: np.ndarray,
    relative: np.ndarray,
    impacts: int,
    path: np.ndarray | None,
) -> Motions:
    """Follow all balls, in a block to which new balls are added when a quarter of it is free."""
    found = Motions.unknown(start.size)
    balls: Any = None
    impact: Any = None
    started = 0
    alive = 0
    while alive or started < start.size:
        free = _BLOCK - alive
        if started < start.size and 4 * free >= _BLOCK:
            lanes = np.arange(started, min(started + free, start.size))
            started += lanes.size
            first, new = _new_balls(dynamics.take(lanes), lanes, start[lanes], relative[lanes])
            impact = _joined(impact, first) if alive else first
            balls = _joined(balls, new) if alive else new
            now = dynamics.take(balls.lane)
        if path is not None:
            _record(path.reshape(3, impacts, -1), balls, impact)

        departure = now.depart(impact, differentiate=True)
        going = _flying(now, departure, balls, found)
        if going.size < balls.lane.size:
            _store_last_impacts(found, balls, impact, going)
            now, impact, departure, balls = now.kept(going, impact, departure, balls)

        if going.size:
            after, passed = now.fly(departure)
            change = now.jacobian(impact, departure, after, passed)
            _advance(balls, change, passed, departure.sticks)
            phase, velocity = now.section(after)
            going = _not_repeating(balls, phase, velocity, impacts, found)
            impact = after
            if going.size < balls.lane.size:
                _store_last_impacts(found, balls, impact, going)
                now, impact, balls = now.kept(going, impact, balls)
        alive = going.size
    return found


def _new_balls(
    dynamics: Dynamics, lanes: np.ndarray, phase: np.ndarray, relative: np.ndarray
) -> tuple[Impact, _Balls]:
    """The first impacts of balls, and the balls."""
    first = dynamics.start(phase, relative)
    return first, _Balls.new(lanes, dynamics.amplitude, first)


def _joined(one: Any, other: Any) -> Any:
    """Join the arrays of two groups of balls; a number applies to all balls and stays a number."""
    if isinstance(one, tuple):
        joined = (_joined(a, b) for a, b in zip(one, other, strict=True))
        return getattr(one, "_make", tuple)(joined)
    return np.concatenate([one, other]) if isinstance(one, np.ndarray) and one.ndim else one


def _absolute_velocity(
    phase: np.ndarray, relative: np.ndarray, amplitude: np.ndarray
) -> np.ndarray:
    """z′ of balls with δ′ at phases of the table; NaN where the phase is NaN."""
    return relative + table(phase, amplitude)[0]


def _record(path: np.ndarray, balls: _Balls, impact: Impact) -> None:
    """Store time, φ and z′ of the impacts in the path, shape (3, impacts, balls)."""
    velocity = _absolute_velocity(impact.phase, impact.velocity, balls.amplitude)
    path[:, balls.seen, balls.lane] = balls.time, impact.phase, velocity


def _store_last_impacts(found: Motions, balls: _Balls, impact: Impact, going: np.ndarray) -> None:
    """Store the impacts of all balls except those that continue."""
    last = np.delete(np.arange(balls.lane.size), going)
    lane = balls.lane[last]
    phase = impact.phase[last]
    phase[found.kind[lane] == Kind.PERMANENT_CONTACT] = np.nan
    velocity = _absolute_velocity(phase, impact.velocity[last], balls.amplitude[last])
    found.fill(lane, end_phase=phase, end_velocity=velocity)


def _store(found: Motions, balls: _Balls, which: np.ndarray, **values: ArrayLike) -> None:
    """Store results of some balls, with the impacts followed and the digits lost until now."""
    found.fill(
        balls.lane[which],
        followed=balls.seen[which],
        digits_lost=balls.stretch.most[which] / np.log(10),
        **values,
    )


def _flying(dynamics: Dynamics, departure: Departure, balls: _Balls, found: Motions) -> np.ndarray:
    """Store which balls stay on the table, are not released, or lock because they stick again;
    return the indices of the others.
    """
    done = departure.status != Status.BOUNCING
    if done.any():
        stays = departure.status == Status.PERMANENT_CONTACT
        _store(found, balls, stays, kind=Kind.PERMANENT_CONTACT, periods=1, exponent_error=0.0)
        _store(found, balls, done & ~stays, kind=Kind.UNDECIDED, reason=Reason.NO_RELEASE)
    if dynamics.forgets:
        sticks = ~done & departure.sticks
        if sticks.any():
            done |= _sticking_again(balls, sticks, balls.time + departure.duration, found)
    return np.flatnonzero(~done)


def _sticking_again(
    balls: _Balls, sticks: np.ndarray, time: np.ndarray, found: Motions
) -> np.ndarray:
    """Store which balls lock because they stick for the second time, and return which do.

    Between two lift-offs after which rounding errors have grown too much, nothing is known. The
    time of the present lift-off is ``time``.
    """
    again = sticks & (balls.lift >= 0)
    lost = balls.stretch.lost()
    lap = balls.seen - balls.lift
    periods = _periods(time - balls.lift_time)
    balls.lap[again & lost] = lap[again & lost]
    locks = again & ~lost
    _store(
        found,
        balls,
        locks,
        kind=Kind.LOCKED,
        periods=periods[locks],
        impacts=lap[locks],
        exponent=-np.inf,
        exponent_error=0.0,
    )
    balls.lift[sticks] = balls.seen[sticks]
    balls.lift_time[sticks] = time[sticks]
    return locks


def _periods(time: np.ndarray) -> np.ndarray:
    """The nearest numbers of table periods."""
    return np.rint(time / (2 * np.pi)).astype(int)


def _advance(balls: _Balls, change: Jacobian, passed: np.ndarray, sticks: np.ndarray) -> None:
    """Advance the counts, times, derivatives and deviations of all balls to the next impact."""
    mark = balls.mark
    stretch = balls.stretch
    balls.seen[:] += 1
    balls.time[:] += passed
    mark.stuck[:] += sticks
    for values, new in zip(mark.since, change.after(mark.since), strict=True):
        values[:] = new
    grown = stretch.grow(change)
    forgot = np.flatnonzero(sticks & (stretch.growth + grown < stretch.least - DIGITS))
    if forgot.size:
        balls.doubt[forgot[stretch.lost()[forgot]]] = _ROUNDING
        stretch.forget(forgot, grown, balls.time)
    stretch.add(grown, balls.time, balls.seen)


def _not_repeating(
    balls: _Balls, phase: np.ndarray, velocity: np.ndarray, impacts: int, found: Motions
) -> np.ndarray:
    """Compare balls with their marks, and store which balls repeat or reach the last impact; return
    the indices of the others.
    """
    phase_shift = reduce_angle(phase - balls.mark.phase)
    velocity_shift = (velocity - balls.mark.velocity) / (1 + balls.amplitude)
    near = np.flatnonzero((np.abs(phase_shift) < _SIGHT) & (np.abs(velocity_shift) < _SIGHT))
    done = np.zeros(phase.size, dtype=bool)
    moves = balls.seen >= balls.mark.until
    if near.size:
        first, second = _returning(balls, near, phase_shift[near], velocity_shift[near], found)
        moves[first] = True
        done[second] = True
    _move_marks(balls, np.flatnonzero(moves & ~done), phase, velocity)
    over = np.flatnonzero((balls.seen >= impacts) & ~done)
    if over.size:
        _give_up(balls, over, found)
        done[over] = True
    return np.flatnonzero(~done)


def _returning(
    balls: _Balls,
    near: np.ndarray,
    phase_shift: np.ndarray,
    velocity_shift: np.ndarray,
    found: Motions,
) -> tuple[np.ndarray, np.ndarray]:
    """The indices of the balls that return to their marks for the first time, and for the second
    time in as many impacts or fewer; the motions of the latter are stored.

    ``near`` are the indices of balls near their marks. The shifts of their states from the marks
    are an angle, and a velocity over 1 + Λ.
    """
    mark = balls.mark
    scale = 1 + balls.amplitude[near]
    since = pick(mark.since, near)
    radius = since.spectral_radius()
    length = balls.seen[near] - mark.impact[near]
    periods = _periods(balls.time[near] - mark.time[near])

    step_phase, step_velocity = since.to_fixed_point(phase_shift, velocity_shift * scale)
    from_orbit = np.maximum(np.abs(step_phase), np.abs(step_velocity) / scale)
    returned_before = mark.turn[near] > 0
    on_orbit = from_orbit <= np.where(returned_before, _NEAR_AGAIN, NEAR)
    attracting = radius <= 1 - _MARGIN
    resolved = balls.stretch.worst[near] <= FORGOTTEN
    back = on_orbit & attracting & (periods > 0) & resolved

    from_mark = np.maximum(np.abs(phase_shift), np.abs(velocity_shift))
    marginal = (from_mark < _NEAR_AGAIN) & (np.abs(radius - 1) < _MARGIN)
    balls.doubt[near[marginal]] = _MARGINAL

    first = back & ~returned_before
    mark.turn[near[first]] = length[first]
    second = back & returned_before
    _store_repeating(
        found,
        balls,
        near[second],
        periods=periods[second],
        impacts=length[second],
        exponent=(np.log(radius) / periods)[second],
    )
    return near[first], near[second]


def _store_repeating(
    found: Motions,
    balls: _Balls,
    which: np.ndarray,
    periods: np.ndarray,
    impacts: np.ndarray,
    exponent: np.ndarray,
) -> None:
    """Store motions that repeat after these numbers of table periods and of impacts."""
    coprime = np.gcd(periods, impacts) == 1
    bouncing = np.where(coprime, Kind.ORBIT, Kind.SUBHARMONIC)
    _store(
        found,
        balls,
        which,
        kind=np.where(balls.mark.stuck[which] > 0, Kind.LOCKED, bouncing),
        periods=periods,
        impacts=impacts,
        exponent=exponent,
        exponent_error=0.0,
    )


def _move_marks(balls: _Balls, here: np.ndarray, phase: np.ndarray, velocity: np.ndarray) -> None:
    """Move the marks of some balls to their current impacts; after a first return the mark stays
    for one more turn.
    """
    mark = balls.mark
    count = balls.seen[here]
    # If the ball did not return for the second time, its first return no longer counts.
    turn = np.where(mark.until[here] > count, mark.turn[here], 0)
    stay = np.where(turn, turn + 1, np.maximum(_LEAST, (_SHARE * count).astype(int)))
    mark.impact[here] = count
    mark.time[here] = balls.time[here]
    mark.phase[here] = phase[here]
    mark.velocity[here] = velocity[here]
    for values, value in zip(mark.since, Jacobian.identity(here.size), strict=True):
        values[here] = value
    mark.stuck[here] = 0
    mark.until[here] = count + stay
    mark.turn[here] = turn
    balls.stretch.mark(here)


def _give_up(balls: _Balls, which: np.ndarray, found: Motions) -> None:
    """Store which of the balls that have not repeated are chaotic, and which are undecided."""
    rate, error = balls.stretch.exponent(which, balls.lap[which])
    separates = rate > _ERRORS * error
    # Next to a bifurcation neighbours may separate, but not exponentially.
    exponentially = balls.stretch.sums[which, 1] > -np.log(NEAR)
    doubt = balls.doubt[which]
    chaotic = separates & exponentially & (doubt != _MARGINAL)
    _store(
        found,
        balls,
        which,
        kind=np.where(chaotic, Kind.CHAOTIC, Kind.UNDECIDED),
        reason=np.where(chaotic, Reason.NONE, _REASONS[doubt]),
        exponent=2 * np.pi * rate,
        exponent_error=2 * np.pi * error,
    )
