r"""From the start of a ball to the motion on which it ends, for every model.

A motion repeats if its state returns and neighbouring motions approach it. The return to a mark is
examined in :mod:`bouncing_ball_beyond.motions.recurrence`, and the growth of deviations in
:mod:`bouncing_ball_beyond.motions.lyapunov`.

A ball *sticks* to the table if a contact lasts until the table's motion ends it. With instantaneous
impacts this is a rest on the table up to the lift-off. A contact of finite stiffness sticks if it
lasts longer than one of its damped oscillations, 2π/ϖ_d, because an undamped contact under a
constant load lasts no longer. A motion that repeats and sticks in each repetition is *locked*. If
the contact is compliant, an n-T orbit may be locked in this sense as well.

With instantaneous impacts the motion after sticking does not depend on earlier impacts, because a
ball always leaves in the state of the lift-off. A motion that sticks twice is therefore locked. If
rounding errors have grown to its size between the two stickings, its period is not known: another
rounding gives another lap, but also one that begins and ends at the lift-off. Whether the true lap
ends only more digits can tell.

In a contact of finite stiffness the dependence decreases by a finite factor, and the state is
compared as for any other motion. If rounding errors grow too much for a return, a ball that sticks
again and again is locked if the deviations decrease on the whole by more than all digits, with an
unknown period as well.

A motion is called chaotic if it is not known to repeat in the impacts for which it was followed,
and if its neighbours separate exponentially. More impacts may show that it is a long transient.
With instantaneous impacts such a ball has stuck once at most. On a contact of finite stiffness it
may have stuck many times, because a contact that shrinks deviations by a finite factor makes no
motion repeat; ``times_stuck`` of :class:`~bouncing_ball_beyond.motions.motions.Motions` is their
number.

Balls are followed with the operations + - × ÷ and √ only, so that the same bits give the same
motion on every processor. A ball with a long transient loses the digits of its start, and the last
digit then decides on which motion the ball ends: see ``digits_lost`` of
:class:`~bouncing_ball_beyond.motions.motions.Motions`.
"""

from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import count
from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.models.contacts_and_flights import Impact
from bouncing_ball_beyond.models.dynamics import Dynamics, HasDynamics, Leg
from bouncing_ball_beyond.motions.followed import (
    MARGINAL,
    REASONS,
    ROUNDING,
    Tracked,
    concatenated,
    store,
    store_ends,
)
from bouncing_ball_beyond.motions.lyapunov import DIGITS, FORGOTTEN, NEAR
from bouncing_ball_beyond.motions.motions import Kind, Motions, Reason
from bouncing_ball_beyond.motions.recurrence import periods_in, returns_to_marks

FOLLOWED = count(10_000_000, low=10)
"""The number of impacts that a call may follow."""

FollowedImpacts = Annotated[int, FOLLOWED]

IMPACTS = 2000
"""Number of impacts after which the search for a repetition ends, in all calls that judge a motion.
"""
# Number of standard errors by which the exponent of a chaotic motion must be positive; this happens
# by chance once in three million.
_ERRORS = 5.0
# Number of balls followed at the same time.
_BLOCK = 1 << 16
# Number of bytes that are allocated once at the start.
_KEPT = 1 << 24
_BOUNCING = np.array(Status.BOUNCING)


def final_motions(
    model: HasDynamics,
    amplitude: ArrayLike,
    phase: ArrayLike,
    velocity: ArrayLike,
    *,
    impacts: int = IMPACTS,
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

    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> model = RestitutionModel(0.5)
    >>> found = final_motions(model, [1.2, 1.6, 2.5], 1.0, -3.0)
    >>> found.kind.tolist(), found.periods.tolist(), found.impacts.tolist()[:2]
    (['orbit', 'subharmonic', 'locked'], [1, 2, 6], [1, 2])
    """
    dynamics, start, relative, shape = model.dynamics(amplitude).first_impacts(phase, velocity)
    # After memory of this size has been freed once, the process keeps it and need not request it
    # from the system at each step.
    np.empty(_KEPT, dtype=np.int8)
    # The derivatives of a long turn may overflow, and those of a ball that sticks are zero.
    with np.errstate(all="ignore"):
        found = _follow(dynamics, start, relative, impacts)
    return Motions(**{name: values.reshape(shape) for name, values in vars(found).items()})


def _follow(dynamics: Dynamics, start: np.ndarray, relative: np.ndarray, impacts: int) -> Motions:
    """Follow all balls, in a block to which new balls are added when a quarter of it is free."""
    found = Motions.unknown(start.size)
    balls: Any = None
    impact: Any = None
    started = 0
    alive = 0
    while alive or started < start.size:
        lanes = np.arange(started, min(started + _BLOCK - alive, start.size))
        started += lanes.size
        entering = dynamics.take(lanes)
        first = entering.start(start[lanes], relative[lanes])
        new = Tracked.new(lanes, entering.amplitude, first)
        impact = concatenated(impact, first) if alive else first
        balls = concatenated(balls, new) if alive else new
        for leg in dynamics.take(balls.lane).legs(impact, differentiate=True):
            done = _departing(leg, balls, found)
            balls = _without(done, leg, leg.impact, balls, found)
            if balls.lane.size:
                _advance(balls, leg)
                done = _ending(balls, *leg.dynamics.section().state(leg.after), impacts, found)
                balls = _without(done, leg, leg.after, balls, found)
            impact = leg.after
            alive = balls.lane.size
            free = _BLOCK - alive
            if started < start.size and 4 * free >= _BLOCK:
                break
    return found


def _without(done: np.ndarray, leg: Leg, impact: Impact, balls: Tracked, found: Motions) -> Tracked:
    """Store the last impacts of the balls that are done, and leave them out."""
    if not done.any():
        return balls
    (going,) = (~done).nonzero()
    store_ends(found, balls, impact, going)
    (balls,) = leg.keep(going, balls)
    return balls


def _departing(leg: Leg, balls: Tracked, found: Motions) -> np.ndarray:
    """Store which balls stay on the table, are not released, or lock because they stick again;
    return which do.
    """
    departure = leg.departure
    done = departure.status != _BOUNCING
    if done.any():
        stays = departure.status == Status.PERMANENT_CONTACT
        store(found, balls, stays, kind=Kind.PERMANENT_CONTACT, periods=1, exponent_error=0.0)
        store(found, balls, done & ~stays, kind=Kind.UNDECIDED, reason=Reason.NO_RELEASE)
    sticks = ~done & departure.sticks
    if sticks.any():
        lift_off = balls.time + departure.duration
        balls.sticking.tally(sticks, lift_off)
        if leg.dynamics.forgets:
            done |= _sticking_again(balls, sticks, lift_off, found)
    return done


def _sticking_again(
    balls: Tracked, sticks: np.ndarray, time: np.ndarray, found: Motions
) -> np.ndarray:
    """Store which balls lock because they stick for the second time, and return which do.

    If rounding errors have grown too much since the first lift-off, only the kind is known. The
    time of the present lift-off is ``time``.
    """
    sticking = balls.sticking
    again = sticks & (sticking.impact >= 0)
    resolved = again & ~balls.stretch.lost()
    store(
        found,
        balls,
        resolved,
        kind=Kind.LOCKED,
        periods=periods_in(time - sticking.time)[resolved],
        impacts=(balls.seen - sticking.impact)[resolved],
        exponent=-np.inf,
        exponent_error=0.0,
    )
    _store_unresolved(found, balls, again & ~resolved, -np.inf, 0.0)
    sticking.time[sticks] = time[sticks]
    return again


def _store_unresolved(
    found: Motions, balls: Tracked, which: np.ndarray, exponent: ArrayLike, error: ArrayLike
) -> None:
    """Store motions that lock after a period that is not known."""
    store(
        found,
        balls,
        which,
        kind=Kind.LOCKED,
        periods=0,
        impacts=0,
        reason=Reason.ROUNDING,
        exponent=exponent,
        exponent_error=error,
    )


def _advance(balls: Tracked, leg: Leg) -> None:
    """Advance the counts, times, derivatives and deviations of all balls to the next impact."""
    change = leg.jacobian()
    sticks = leg.departure.sticks
    stretch = balls.stretch
    sticking = balls.sticking
    balls.mark.advance(change)
    balls.mark.stuck[:] += sticks
    grown = stretch.grow(change)
    forgot = stretch.forgetting(grown, sticks)
    if forgot.size:
        again = forgot[sticking.impact[forgot] >= 0]
        balls.doubt[again[stretch.lost()[again]]] = ROUNDING
        first = sticking.store(forgot, leg.impact, balls.seen)
    balls.seen[:] += 1
    balls.time[:] += leg.passed
    contraction = leg.dynamics.contraction(leg.impact, leg.departure)
    stretch.add(grown, contraction, forgot, balls.time, balls.seen)
    if forgot.size:
        stretch.restart(first, balls.time)


def _ending(
    balls: Tracked, phase: np.ndarray, velocity: np.ndarray, impacts: int, found: Motions
) -> np.ndarray:
    """Compare balls with their marks, and store which balls repeat or reach the last impact; return
    which do.
    """
    mark = balls.mark
    done = np.zeros(phase.size, dtype=bool)
    moves = balls.seen >= mark.until
    near, *shifts = mark.near(phase, velocity, balls.amplitude)
    if near.size:
        first, second = _returning(balls, near, (shifts[0], shifts[1]), found)
        moves[first] = True
        moves[second] = False
        done[second] = True
    if moves.any():
        mark.move(moves.nonzero()[0], balls.seen, balls.time, phase, velocity)
        balls.stretch.mark(moves)
    over = balls.seen >= impacts
    if over.any():
        last = (over & ~done).nonzero()[0]
        _give_up(balls, last, found)
        done[last] = True
    return done


def _returning(
    balls: Tracked, near: np.ndarray, shifts: tuple[np.ndarray, np.ndarray], found: Motions
) -> tuple[np.ndarray, np.ndarray]:
    """The indices of the balls that return to their marks for the first time, and for the second
    time; the motions of the latter are stored.
    """
    mark = balls.mark
    seen = returns_to_marks(
        mark,
        near,
        shifts,
        seen=balls.seen,
        time=balls.time,
        amplitude=balls.amplitude,
        worst=balls.stretch.worst,
    )
    balls.doubt[near[seen.marginal]] = MARGINAL
    first = near[seen.first]
    mark.turn[first] = seen.length[seen.first]
    second = near[seen.second]
    if second.size:
        periods = seen.periods[seen.second]
        radius = seen.radius[seen.second]
        exponent = np.log(radius) / periods
        _store_repeating(found, balls, second, periods, seen.length[seen.second], exponent)
    return first, second


def _store_repeating(
    found: Motions,
    balls: Tracked,
    which: np.ndarray,
    periods: np.ndarray,
    impacts: np.ndarray,
    exponent: np.ndarray,
) -> None:
    """Store motions that repeat after these numbers of table periods and of impacts."""
    coprime = np.gcd(periods, impacts) == 1
    bouncing = np.where(coprime, Kind.ORBIT, Kind.SUBHARMONIC)
    store(
        found,
        balls,
        which,
        kind=np.where(balls.mark.stuck[which] > 0, Kind.LOCKED, bouncing),
        periods=periods,
        impacts=impacts,
        exponent=exponent,
        exponent_error=0.0,
    )


def _give_up(balls: Tracked, which: np.ndarray, found: Motions) -> None:
    """Store which of the balls that have not repeated are locked after an unknown period, which are
    chaotic, and which are undecided.
    """
    stretch = balls.stretch
    rate, error = stretch.exponent(which)
    growth = stretch.of_motion(which)[:, 1]
    doubt = balls.doubt[which]
    separates = rate > _ERRORS * error
    # Next to a bifurcation neighbours may separate, but not exponentially.
    exponentially = growth > -np.log(NEAR)
    chaotic = separates & exponentially & (doubt != MARGINAL)
    sticks_again = balls.sticking.number[which] > 1
    # Slow changes are part of the error that is stored, and not of the test, which is one of the
    # sign.
    uncertain = np.where(np.isnan(error), np.nan, stretch.uncertainty(which))
    locked = sticks_again & (growth < -DIGITS) & (stretch.most[which] > FORGOTTEN)
    store(
        found,
        balls,
        which,
        kind=np.where(chaotic, Kind.CHAOTIC, Kind.UNDECIDED),
        reason=np.where(chaotic, Reason.NONE, REASONS[doubt]),
        exponent=2 * np.pi * rate,
        exponent_error=2 * np.pi * uncertain,
    )
    of_locked = (2 * np.pi * rate[locked], 2 * np.pi * uncertain[locked])
    _store_unresolved(found, balls, which[locked], *of_locked)
