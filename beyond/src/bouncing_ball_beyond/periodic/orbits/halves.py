"""Orbits that repeat after half their period: the distance of their halves, and twice an orbit.

At a period doubling an orbit with k impacts in m periods, taken twice, is one with 2k impacts in 2m
periods whose two halves are equal.
"""

from dataclasses import replace

import numpy as np

from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations

# The distance of the halves of an orbit that cannot repeat after half its period.
_FAR = 1.0


def halves(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """The differences of the second half of each orbit to the first: those of the times from half
    the period after an impact to the impact that is k/2 later, and those of the velocities.

    They all vanish for an orbit that repeats after half its period, and change continuously along a
    branch. Their shape is (..., k), with an axis of length 0 if k or m is odd: such orbits do not
    repeat after half their period.
    """
    half, odd = divmod(equations.impacts, 2)
    if odd or np.any(np.asarray(equations.periods) % 2):
        return np.empty((*y.shape[:-1], 0))
    interval = equations.intervals(y)
    begun = np.cumsum(interval, axis=-1) - interval
    of_half = np.pi * np.asarray(equations.periods)[..., np.newaxis]
    later = begun[..., half:] - begun[..., :half] - of_half
    _, velocity = equations.states(y)
    faster = velocity[..., half:] - velocity[..., :half]
    return np.concatenate([later, faster], axis=-1)


def turns_apart(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """The distance of the two halves of each orbit, the root of the mean square over its impacts.

    It vanishes for an orbit that repeats after half its period; 1 where no orbit does.
    """
    apart = halves(equations, y)
    if not apart.shape[-1]:
        return np.full(y.shape[:-1], _FAR)
    return np.sqrt(np.sum(apart**2, axis=-1) * 2 / equations.impacts)


def twice(equations: OrbitEquations, y: np.ndarray) -> tuple[OrbitEquations, np.ndarray]:
    """The same orbits, taken twice: the problem with 2k impacts and its points."""
    phase, velocity = equations.states(y)
    duration = equations.durations(y)
    turns = np.concatenate([equations.turns, equations.turns], axis=-1)
    resumes = np.tile(equations.resuming, 2)
    whole = replace(equations, impacts=2 * equations.impacts, turns=turns, resumes=resumes)
    phases = np.concatenate([phase, phase], axis=-1)
    velocities = np.concatenate([velocity, velocity], axis=-1)
    durations = np.concatenate([duration, duration], axis=-1)
    return whole, whole.point(phases, velocities, durations, **equations.values(y))


def turns_of_half(turns: np.ndarray, phase: np.ndarray) -> np.ndarray:
    """The turns of the first half of an orbit that repeats after half its period, from the turns
    and the phases of the whole orbit, each of shape (2k,).
    """
    half = len(turns) // 2
    found = np.array(turns[:half])
    # The half ends at its own first impact in place of that of the second half.
    found[-1] += round(float(phase[half] - phase[0]) / (2 * np.pi))
    return found
