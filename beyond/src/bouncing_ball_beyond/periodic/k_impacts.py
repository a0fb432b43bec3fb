"""Periodic orbits with k impacts in m periods, by Newton's method from many impacts or from a
guess.

There is no closed form of these orbits for k > 1. The search takes first impacts on a grid, follows
each ball for k impacts, a few of them after a transient, and lets Newton's method close those of
these motions that last for about m periods. An unstable orbit with large multipliers attracts
fewer of these starts than a stable one: a search finds no complete list.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.models.flight import table
from bouncing_ball_beyond.inherited.numerics.arrays import blocks
from bouncing_ball_beyond.inherited.numerics.corrector import checked
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit, orbit_of_point
from bouncing_ball_beyond.periodic.orbits.short_steps import solve_short
from bouncing_ball_beyond.periodic.orbits.steps import PATIENT

PHASES = 72
"""Number of phases of the first impacts of a search."""
SPEEDS = 36
"""Number of speeds of the first impacts of a search."""
# One ball of so many is also followed for so many impacts before the search begins with it: it may
# then be next to a stable orbit.
_SETTLING = 41
_TRANSIENT = 200
# Motions are closed whose k flights last for m periods up to this part of a period.
_NEAR = 1.0
# Two results of Newton's method are the same orbit if they are as near to each other.
_SAME = 1e-6
# Number of orbits that are solved for at the same time.
_BLOCK = 512


def found_orbits(model: Model, impacts: int, periods: int, amplitude: float) -> list[Orbit]:
    """Orbits with k impacts in m periods that a ball follows, from the highest to the lowest.

    They are those that Newton's method reaches from a grid of first impacts. Motions in which a
    ball rests on the table are left out, as are orbits that repeat sooner.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> found = found_orbits(RestitutionModel(0.5), 2, 2, 1.6)
    >>> [(each.impacts, each.periods, each.is_stable()) for each in found]
    [(2, 2, True)]
    """
    phase, speed = np.meshgrid(
        np.linspace(-np.pi, np.pi, PHASES, endpoint=False),
        # A flight over all m periods ends with the speed πm, and the table moves with Λ at most.
        np.linspace(0.0, np.pi * periods + 2 * amplitude, SPEEDS + 1)[1:],
    )
    start = phase.ravel()
    velocity = table(start, np.asarray(amplitude))[0] - speed.ravel()
    first = _followed(model, amplitude, start, velocity, impacts)
    later = _followed(
        model, amplitude, start[::_SETTLING], velocity[::_SETTLING], impacts, after=_TRANSIENT
    )
    legs = _Followed(*(np.concatenate(rows, axis=-1) for rows in zip(first, later, strict=True)))
    passed = legs.time[-1] / (2 * np.pi)
    with np.errstate(invalid="ignore"):
        near = np.flatnonzero(legs.bounces & (np.abs(passed - periods) <= _NEAR))
    phases, velocities, durations = (
        row[:impacts, near].T for row in (legs.phase, legs.velocity, legs.duration)
    )
    turns = _turns(np.diff(legs.time[:, near], axis=0).T, phases)
    turns[:, -1] += periods - turns.sum(axis=-1)
    found: list[Orbit] = []
    for part in blocks(near.size, _BLOCK):
        guess = Orbit(
            model, amplitude, turns[part], phases[part], velocities[part], durations[part]
        )
        for orbit in _closed(guess):
            if not _repeats(orbit) and not any(_is_same(orbit, other) for other in found):
                found.append(orbit)
    return sorted(found, key=lambda orbit: -orbit.max_height)


def orbit_from(model: Model, amplitude: float, phases: np.ndarray, velocities: np.ndarray) -> Orbit:
    """The orbit near the impacts of a guess, with φ and z′ of each.

    The contacts and the number of periods are those of balls that begin with these impacts.

    Raises
    ------
    NoOrbitError
        If Newton's method finds none.
    """
    legs = _followed(model, amplitude, phases, velocities, 1)
    if not legs.bounces.all():
        raise NoOrbitError("a ball comes to rest on the table after one of these impacts")
    turns = _turns(legs.time[1], phases)
    rows = (turns, phases, velocities, legs.duration[0])
    turns, phases, velocities, durations = (row[np.newaxis] for row in rows)
    found = _closed(Orbit(model, amplitude, turns, phases, velocities, durations))
    if not found:
        count = f"{phases.size} impact{'s' if phases.size > 1 else ''}"
        raise NoOrbitError(f"no orbit with {count} that a ball follows was found near this guess")
    return found[0]


class _Followed(NamedTuple):
    """Balls that were followed for k impacts, from the time 0 of the first one: times, φ and z′ of
    k + 1 impacts and the durations of k contacts, one row for each impact, and whether each ball
    bounces throughout.
    """

    time: np.ndarray
    phase: np.ndarray
    velocity: np.ndarray
    duration: np.ndarray
    bounces: np.ndarray


def _followed(
    model: Model,
    amplitude: float,
    phase: np.ndarray,
    velocity: np.ndarray,
    impacts: int,
    after: int = 0,
) -> _Followed:
    """The motions from these impacts on, or after a number of further impacts."""
    found = model.simulate(amplitude, phase, velocity, after + impacts + 1)
    rests = ((found.settling > 0) | (found.displacement != 0))[after:]
    return _Followed(
        time=found.time[after:] - found.time[after],
        phase=found.phase[after:],
        velocity=found.impact_velocity[after:],
        duration=found.contact_duration[after:-1],
        bounces=np.isfinite(found.time[-1]) & ~rests.any(axis=0),
    )


def _turns(time: np.ndarray, phases: np.ndarray) -> np.ndarray:
    """The whole turns of the table between impacts at these phases, shape (..., k), that are
    nearest to the times between them.
    """
    apart = np.roll(phases, -1, axis=-1) - phases
    return np.round((time - apart) / (2 * np.pi)).astype(int)


def _closed(guess: Orbit) -> list[Orbit]:
    """The orbits to which Newton's method leads from a row of guesses, which balls follow."""
    problem, y = equations_of(guess)
    with np.errstate(all="ignore"):
        solved = solve_short(problem.equations_at, y, PATIENT)
        which = np.flatnonzero(checked(solved, problem.residual).converged)
        if not which.size:
            return []
        row = orbit_of_point(problem.take(which), solved.point[which])
        # Most of the guesses lead to a few orbits.
        seen = np.round(np.concatenate([row.phases, row.velocities], axis=-1) / _SAME)
        _, first = np.unique(seen, axis=0, return_index=True)
        row = row[np.sort(first)]
        row = row[np.flatnonzero(row.is_admissible())]
    return [row[k] for k in range(row.size)]


def _is_same(one: Orbit, other: Orbit, rolls: Iterable[int] | None = None) -> bool:
    """Whether two orbits are the same, also if they begin with another of their impacts."""
    for number in range(one.impacts) if rolls is None else rolls:
        turned = reduce_angle(np.roll(one.phases, number) - other.phases)
        faster = np.roll(one.velocities, number) - other.velocities
        if max(np.abs(turned).max(), np.abs(faster).max()) < _SAME:
            return True
    return False


def _repeats(orbit: Orbit) -> bool:
    """Whether an orbit repeats after fewer than its k impacts."""
    return _is_same(orbit, orbit, range(1, orbit.impacts))
