"""From a simulated ball to an orbit, and whether a simulated ball follows an orbit."""

from collections.abc import Sequence

import numpy as np

from bouncing_ball.beyond.periodic.family import Family
from bouncing_ball.beyond.periodic.legs import time_to_section
from bouncing_ball.beyond.periodic.problem import PeriodicOrbits
from bouncing_ball.beyond.periodic.special import sticking
from bouncing_ball.numerics.arrays import pick
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.paper.motion.sequence import Status

# Relative to its length, a leg of the simulation differs from that of the orbit by less than this
# if both are the same; another landing or release differs by far more.
_SAME = 1e-6


def simulated(
    family: Family, phase: float, velocity: float, impacts: int, along: Sequence[str]
) -> tuple[PeriodicOrbits, np.ndarray]:
    """The problem and the guess y of an orbit with k impacts near a simulated impact.

    ``phase`` and ``velocity`` are those of an impact on the section. The number of periods is the
    whole number nearest to the time of k legs.

    Raises
    ------
    ModelError
        If the parameters are outside their ranges.
    """
    dynamics = family.dynamics({})
    dynamics, start, _ = dynamics.in_a_row([phase], [velocity])
    impact = dynamics.at_section(*start)
    phases = [float(reduce_angle(start[0])[0])]
    turns = []
    velocities = []
    durations = []
    for _ in range(impacts):
        departure = dynamics.depart(impact)
        after, passed = dynamics.fly(departure)
        velocities.append(float(dynamics.section(impact)[1][0]))
        durations.append(float(departure.duration[0]))
        later = passed + time_to_section(dynamics, after) - time_to_section(dynamics, impact)
        last = phases[-1] + float(later[0])
        phases.append(float(reduce_angle(np.array(last))))
        turns.append(round((last - phases[-1]) / (2 * np.pi)))
        impact = after
    # The last phase is replaced by the first one.
    turns[-1] += round((phases[-1] - phases[0]) / (2 * np.pi))
    selects = dynamics.continues and max(durations) > 0
    problem = PeriodicOrbits(family, impacts, np.array(turns), tuple(along), selects)
    values = {name: family.values[name] for name in along}
    rows = (np.array(row) for row in (phases[:-1], velocities, durations))
    return problem, problem.point(*rows, **values)


def is_admissible(orbits: PeriodicOrbits, y: np.ndarray) -> np.ndarray:
    """Whether a simulated ball follows the orbits, with the first releases and landings.

    The events of the simulation are certified (:mod:`bouncing_ball.numerics.first_zero`).
    """
    dynamics, inside = orbits.dynamics(y)
    shape = (*y.shape[:-1], orbits.impacts)
    if dynamics is None:
        return np.zeros(y.shape[:-1], dtype=bool)
    _, velocity = orbits.states(y)
    same = np.zeros(inside.shape, dtype=bool)
    possible = np.flatnonzero(inside & (velocity.ravel() < 0) & np.isfinite(velocity.ravel()))
    if not possible.size:
        return np.all(same.reshape(shape), axis=-1)
    part = dynamics.take(possible)
    impact = pick(orbits.impact(dynamics, y), possible)
    expected = orbits.durations(y).ravel()[possible]
    departure = part.depart(impact, differentiate=True)
    if orbits.selects and part.forgets:
        # The bounces before a rest belong to the leg in which the ball comes to rest.
        early = departure.sticks & (expected == 0)
        departure = part.depart_after(impact, np.where(early, np.nan, expected))
    going = np.flatnonzero(departure.status == Status.BOUNCING)
    possible = possible[going]
    expected = expected[going]
    part, impact, departure = part.kept(going, impact, departure)
    after, passed = part.fly(departure)
    interval = orbits.intervals(y).ravel()[possible]
    late = passed + time_to_section(part, after) - time_to_section(part, impact) - interval
    longer = departure.duration - expected if orbits.selects else np.zeros_like(late)
    at_level = after.displacement >= 0
    same[possible] = at_level & (np.maximum(np.abs(late), np.abs(longer)) < _SAME * interval)
    return np.all(same.reshape(shape), axis=-1) & (sticking(orbits, y) > 0)
