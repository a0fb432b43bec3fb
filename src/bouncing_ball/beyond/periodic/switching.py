"""From one branch to another: to the doubled orbit, and from a simulated motion to its branch.

At a period doubling the orbit, taken twice, is also an orbit with 2k impacts, and there the
equations of such orbits have two directions of solutions: along the old branch, and one along which
the two turns move apart in opposite directions. The doubled branch leaves in the latter.
"""

from typing import Any

import numpy as np

from bouncing_ball.beyond.long_run.destination import final_motions
from bouncing_ball.beyond.periodic.family import AMPLITUDE, Family
from bouncing_ball.beyond.periodic.following import State, corrected
from bouncing_ball.beyond.periodic.problem import PeriodicOrbits, simulated, twice
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.numerics.corrector import Correction, NewtonSettings, newton, plane

ASIDE = 0.02
"""The distance of the first doubled orbit from the old one, in y."""
_SETTINGS = NewtonSettings(max_iterations=20, longest=0.3)


def apart(whole: PeriodicOrbits, y: np.ndarray) -> np.ndarray:
    """The unit direction in which two equal turns move apart, of the shape of y.

    Among the two null vectors of the Jacobian it is the one that changes its sign from turn to turn
    and leaves the parameters as they are.
    """
    _, _, vectors = np.linalg.svd(whole.jacobian(y))
    null = vectors[..., -2:, :]
    odd = np.zeros_like(null)
    start = 0
    for size in (2 * whole.impacts, whole.equations - 2 * whole.impacts):
        part = null[..., start : start + size]
        odd[..., start : start + size] = (part - np.roll(part, size // 2, axis=-1)) / 2
        start += size
    length = np.linalg.norm(odd, axis=-1, keepdims=True)
    better = length.argmax(axis=-2)[..., np.newaxis]
    chosen = np.take_along_axis(odd / length, better, axis=-2)
    return chosen[..., 0, :]


def doubled(
    orbits: PeriodicOrbits, y: np.ndarray, aside: np.ndarray | float = ASIDE
) -> tuple[PeriodicOrbits, Correction]:
    """The orbits of twice the period at the distance ``aside`` from orbits at period doublings."""
    whole, at = twice(orbits, y)
    direction = apart(whole, at)
    guess = at + np.asarray(aside)[..., np.newaxis] * direction
    return whole, newton(whole, guess, plane(direction, guess), _SETTINGS)


def switch(doubling: State, aside: float = ASIDE) -> State:
    """The first orbit on the branch of twice the period that begins at a period doubling.

    Raises
    ------
    NoOrbitError
        If no orbit of twice the period is found.
    """
    with np.errstate(all="ignore"):
        whole, found = doubled(doubling.orbits, doubling.y, aside)
    if not found.converged:
        raise NoOrbitError(
            f"no orbit of twice the period was found beside the period doubling: residual "
            f"{float(found.residual):.1e} after {found.iterations} Newton iterations"
        )
    return State(whole, found.point)


def of_motion(
    family: Family, phase: float, velocity: float, along: str, impacts: int = 4000
) -> State:
    """The orbit on which a simulated ball ends, as the start of a branch.

    Parameters
    ----------
    family : Family
        The balls, with the values of all parameters.
    phase, velocity : float
        The phase φ of the first impact and the absolute velocity z′ before it.
    along : str
        The parameter along which the orbit is to be followed.
    impacts : int
        Number of impacts after which the search for a repetition ends.

    Raises
    ------
    NoOrbitError
        If the motion does not repeat, or the ball stays on the table.
    """
    given = dict(family.values)
    amplitude = given.pop(AMPLITUDE)
    model: Any = family.make(given)
    motion = final_motions(model, amplitude, phase, velocity, impacts=impacts)
    count = int(motion.impacts)
    if not count:
        raise NoOrbitError(
            f"the motion ends on no orbit that could be followed: it is {motion.kind}"
            + (f", because {motion.reason}" if str(motion.reason) else "")
        )
    return of_impact(family, float(motion.end_phase), float(motion.end_velocity), count, along)


def of_impact(family: Family, phase: float, velocity: float, impacts: int, along: str) -> State:
    """The orbit with k impacts near the impact of a simulation with φ and z′.

    Raises
    ------
    NoOrbitError
        If there is no such orbit.
    """
    dynamics = family.dynamics({})
    row, start, relative, _ = dynamics.first_impacts([phase], [velocity])
    section = row.section(row.start(start, relative))
    guess = simulated(family, float(section[0][0]), float(section[1][0]), impacts, (along,))
    return corrected(State(*guess))
