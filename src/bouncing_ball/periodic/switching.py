"""From one branch to another: to the doubled orbit, and from a simulated motion to its branch.

At a period doubling the orbit, taken twice, is also an orbit with 2k impacts, and there the
equations of such orbits have two directions of solutions: along the old branch, and one in which
the two turns move apart. The doubled branch leaves in the latter.
"""

from typing import Any

import numpy as np

from bouncing_ball.errors import NoOrbitError
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.models.flight import table
from bouncing_ball.numerics.corrector import Correction, newton, plane
from bouncing_ball.periodic.family import AMPLITUDE, Family
from bouncing_ball.periodic.following import PATIENT, State, corrected
from bouncing_ball.periodic.problem import PeriodicOrbits, twice
from bouncing_ball.periodic.simulation import simulated

ASIDE = 0.02
"""The distance of the first doubled orbit from the old one, in y."""
# The distance at which the rise of the parameter is measured.
_MEASURED = 1e-4


def apart(orbits: PeriodicOrbits, y: np.ndarray) -> np.ndarray:
    """The unit direction in which two turns of orbits at their period doublings move apart.

    It is a direction of the doubled orbit's unknowns. The first impact moves along the eigenvector
    of the multiplier -1, each leg maps its deviation to the next impact, and the second turn moves
    against the first.
    """
    product = orbits.monodromy(y)
    first = np.stack([-1 - product.d, product.c], axis=-1)
    second = np.stack([product.b, -1 - product.a], axis=-1)
    longer = np.linalg.norm(first, axis=-1) > np.linalg.norm(second, axis=-1)
    deviation = np.where(longer[..., np.newaxis], first, second)
    deviations = []
    for matrix in np.moveaxis(orbits.matrices(y), -3, 0):
        deviations.append(deviation)
        deviation = (matrix @ deviation[..., np.newaxis])[..., 0]
    turn = np.concatenate(deviations, axis=-1)
    # The equation of a duration says how it follows from the states.
    rows = orbits.jacobian(y)[..., 2 * orbits.impacts :, : 2 * orbits.impacts]
    longer_contacts = -(rows @ turn[..., np.newaxis])[..., 0]
    parameters = np.zeros((*y.shape[:-1], len(orbits.along)))
    parts = [turn, -turn, longer_contacts, -longer_contacts, parameters]
    whole = np.concatenate(parts, axis=-1)
    return whole / np.linalg.norm(whole, axis=-1, keepdims=True)


def doubled(
    orbits: PeriodicOrbits, y: np.ndarray, aside: np.ndarray | float = ASIDE
) -> tuple[PeriodicOrbits, Correction]:
    """The orbits of twice the period at the distance ``aside`` from orbits at period doublings."""
    whole, at = twice(orbits, y)
    direction = apart(orbits, y)
    guess = at + np.asarray(aside)[..., np.newaxis] * direction
    return whole, newton(whole, guess, plane(direction, guess), PATIENT)


def ahead(orbits: PeriodicOrbits, y: np.ndarray, above: np.ndarray) -> np.ndarray:
    """Orbits of twice the period, at a coordinate of the parameter ``above`` that of the doublings.

    The coordinate rises with the square of the distance from the doubling,
    by an amount that is measured at a small distance; Newton's method then corrects the orbits.
    """
    whole, at = twice(orbits, y)
    _, near = doubled(orbits, y, np.full(y.shape[:-1], _MEASURED))
    step = near.point - at
    share = np.sqrt(np.abs(above / step[..., -1]))
    guess = at + share[..., np.newaxis] * step
    guess[..., -1] = at[..., -1] + above
    axis = np.eye(guess.shape[-1])[-1]
    found = newton(whole, guess, plane(axis, guess), PATIENT)
    return np.where(found.converged[..., np.newaxis], found.point, guess)


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
    guess = simulated(family, *_on_section(family, phase, velocity), impacts, (along,))
    return corrected(State(*guess))


def of_single_impact(
    family: Family, phase: float, velocity: float, duration: float, periods: int, along: str
) -> State:
    """The orbit of one impact in m periods near one with φ, z′ and a duration of its contact.

    No ball is simulated, because a ball leaves an orbit that is not admissible.

    Raises
    ------
    NoOrbitError
        If there is no such orbit.
    """
    orbits = PeriodicOrbits(
        family=family,
        impacts=1,
        turns=np.array([periods]),
        along=(along,),
        selects=family.dynamics({}).continues and duration > 0,
    )
    theta, closing = (np.array([x]) for x in _on_section(family, phase, velocity))
    guess = orbits.point(theta, closing, np.array([duration]), **{along: family.values[along]})
    return corrected(State(orbits, guess))


def _on_section(family: Family, phase: float, velocity: float) -> tuple[float, float]:
    """θ and v of an impact with φ and z′."""
    dynamics = family.dynamics({})
    relative = velocity - float(table(np.asarray(phase), dynamics.amplitude)[0])
    row, (start, before), _ = dynamics.in_a_row([phase], [relative])
    theta, closing = row.section(row.start(start, before))
    return float(theta[0]), float(closing[0])
