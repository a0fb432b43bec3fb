"""From a simulated ball to an orbit, and whether a simulated ball follows an orbit."""

from collections.abc import Sequence
from itertools import islice

import numpy as np

from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.numerics.arrays import pick
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.periodic.orbits.balls import Balls
from bouncing_ball_beyond.periodic.orbits.legs import (
    lag_of,
    rests_as_expected,
    selects_ends,
)
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations

# Relative to its length, and to the speeds of its impacts, a leg of the simulation differs from
# that of the orbit by less than this if both are the same; another landing or release differs by
# far more.
_SAME = 1e-6


def simulated(
    balls: Balls, phase: float, velocity: float, impacts: int, along: Sequence[str]
) -> tuple[OrbitEquations, np.ndarray]:
    """The problem and the guess y of an orbit with k impacts near a simulated impact.

    ``phase`` and ``velocity`` are those of an impact on the section; with a positive velocity the
    contact resumes. The number of periods is the whole number nearest to the time of k legs.

    Raises
    ------
    ModelError
        If the parameters are outside their ranges.
    NoOrbitError
        If a contact resumes, and its law has no fixed κ.
    """
    dynamics = balls.dynamics()
    dynamics, start, _ = dynamics.in_a_row([phase], [velocity])
    if velocity > 0:
        _check_resumption(dynamics)
    section = dynamics.section(lag_of(dynamics, np.array([velocity > 0])))
    impact = section.impact(*start)
    phases = [float(reduce_angle(start[0])[0])]
    turns = []
    velocities = []
    durations = []
    resumes = []
    selects = False
    for leg in islice(dynamics.legs(impact), impacts):
        after, passed = leg.fly()
        velocities.append(float(section.state(leg.impact)[1][0]))
        durations.append(float(leg.departure.duration[0]))
        selects |= selects_ends(dynamics, leg.impact, leg.departure.duration)
        resumes.append(bool(leg.impact.displacement[0] < 0))
        later = passed + section.delay(after) - section.delay(leg.impact)
        last = phases[-1] + float(later[0])
        phases.append(float(reduce_angle(np.array(last))))
        turns.append(round((last - phases[-1]) / (2 * np.pi)))
    # The last phase is replaced by the first one.
    turns[-1] += round((phases[-1] - phases[0]) / (2 * np.pi))
    if any(resumes):
        _check_resumption(dynamics)
    problem = OrbitEquations(
        balls=balls,
        impacts=impacts,
        turns=np.array(turns),
        along=tuple(along),
        selects=selects,
        resumes=np.array(resumes),
    )
    values = {name: balls.values[name] for name in along}
    rows = (np.array(row) for row in (phases[:-1], velocities, durations))
    return problem, problem.point(*rows, **values)


def _check_resumption(dynamics: Dynamics) -> None:
    if dynamics.contact is None or dynamics.contact.lag is None:
        raise NoOrbitError(
            "in this orbit a contact resumes below the level of the table while the ball rises, "
            "and for its law no equations are defined for such a start"
        )


def is_admissible(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """Whether a simulated ball follows the orbits, with the first releases and landings.

    The events of the simulation are certified
    (:mod:`bouncing_ball_beyond.inherited.numerics.first_zero`).
    """
    dynamics, inside = equations.dynamics(y)
    shape = (*y.shape[:-1], equations.impacts)
    if dynamics is None:
        return np.zeros(y.shape[:-1], dtype=bool)
    _, velocity = equations.states(y)
    same = np.zeros(inside.shape, dtype=bool)
    closing = np.where(equations.resuming, -velocity, velocity).ravel()
    possible = np.flatnonzero(inside & (closing < 0) & np.isfinite(closing))
    if not possible.size:
        return np.all(same.reshape(shape), axis=-1)
    expected = equations.durations(y).ravel()[possible]
    start = pick(equations.impact(dynamics, y), possible)
    leg = next(dynamics.take(possible).legs(start, differentiate=True))
    if equations.selects and dynamics.forgets:
        # The bounces before a rest belong to the leg in which the ball comes to rest.
        early = leg.departure.sticks & (expected == 0)
        leg.departure = leg.dynamics.depart(start, near=np.where(early, np.nan, expected))
    possible, expected = leg.keep(leg.bouncing(), possible, expected)
    after, passed = leg.fly()
    part = leg.dynamics
    interval = equations.intervals(y).ravel()[possible]
    before = velocity.ravel()[possible]
    next_velocity = np.roll(velocity, -1, axis=-1).ravel()[possible]
    section = part.section()
    faster = section.state(after)[1] - next_velocity
    late = passed + section.delay(after) - section.delay(leg.impact) - interval
    longer = leg.departure.duration - expected if equations.selects else np.zeros_like(late)
    resumes = np.broadcast_to(np.roll(equations.resuming, -1), shape).ravel()[possible]
    alike = (after.displacement < 0) == resumes
    same[possible] = alike & (np.maximum(np.abs(late), np.abs(longer)) < _SAME * interval)
    same[possible] &= np.abs(faster) < _SAME * np.maximum(np.abs(before), np.abs(next_velocity))
    same[possible] &= rests_as_expected(part, leg.impact, expected)
    if part.forgets and not equations.selects:
        # A short rest hardly changes the motion, above all for r = 0.
        same[possible] &= ~leg.departure.sticks
    return np.all(same.reshape(shape), axis=-1)
