"""From one branch to another: to the doubled orbit and back, and to a side of a saddle-node.

At a period doubling the orbit, taken twice, is also an orbit with 2k impacts, and there the
equations of such orbits have two directions of solutions: along the old branch, and one in which
the two turns move apart. The doubled branch leaves in the latter.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.numerics.corrector import Correction, plane, tangent
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation
from bouncing_ball_beyond.periodic.branches.following import point_near
from bouncing_ball_beyond.periodic.orbits.balls import LAMBDA, Path
from bouncing_ball_beyond.periodic.orbits.halves import turns_of_half, twice
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit, orbit_of_point
from bouncing_ball_beyond.periodic.orbits.paths import name_of, place_along
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations
from bouncing_ball_beyond.periodic.orbits.short_steps import newton_short
from bouncing_ball_beyond.periodic.orbits.stability import is_stable
from bouncing_ball_beyond.periodic.orbits.steps import PATIENT

ASIDE = 0.02
"""The distance of the first doubled orbit from the old one, in y."""
# The branch of twice the period bends, so that its first orbit is a little farther away.
_FARTHER = 2.0
# det(M + 1) at a period doubling, over the size of the entries of M. Doublings are located to
# 1e-12 in y, and the derivatives of M grow as the impacts become slow.
_DOUBLES = 1e-6
# A change of the parameter over the distance ASIDE that is smaller than this part of it is an
# error, and the doubling has no side: doublings are located to 1e-12.
_VERTICAL = 1e-11
# The distance from a saddle-node at which its sides are told apart.
_SIDE = 1e-3


def apart(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """The unit direction in which two turns of orbits at their period doublings move apart.

    It is a direction of the doubled orbit's unknowns. The first impact moves along the eigenvector
    of the multiplier -1, each leg maps its deviation to the next impact, and the second turn moves
    against the first.
    """
    product = equations.monodromy(y)
    first = np.stack([-1 - product.d, product.c], axis=-1)
    second = np.stack([product.b, -1 - product.a], axis=-1)
    longer = np.linalg.norm(first, axis=-1) > np.linalg.norm(second, axis=-1)
    deviation = np.where(longer[..., np.newaxis], first, second)
    deviations = []
    for matrix in np.moveaxis(equations.matrices(y), -3, 0):
        deviations.append(deviation)
        deviation = (matrix @ deviation[..., np.newaxis])[..., 0]
    turn = np.concatenate(deviations, axis=-1)
    # The equation of a duration says how it follows from the states.
    rows = equations.jacobian(y)[..., 2 * equations.impacts :, : 2 * equations.impacts]
    longer_contacts = -(rows @ turn[..., np.newaxis])[..., 0]
    parameters = np.zeros((*y.shape[:-1], len(equations.along)))
    parts = [turn, -turn, longer_contacts, -longer_contacts, parameters]
    whole = np.concatenate(parts, axis=-1)
    return whole / np.linalg.norm(whole, axis=-1, keepdims=True)


def doubled(
    equations: OrbitEquations, y: np.ndarray, aside: np.ndarray | float = ASIDE
) -> tuple[OrbitEquations, Correction]:
    """The orbits of twice the period at the distance ``aside`` from orbits at period doublings."""
    whole, at = twice(equations, y)
    direction = apart(equations, y)
    guess = at + np.asarray(aside)[..., np.newaxis] * direction
    return whole, newton_short(whole, guess, plane(direction, guess), PATIENT)


def switch(doubling: Orbit, along: str | Path = LAMBDA, aside: float = ASIDE) -> Orbit:
    """The first orbit on the branch of twice the period that begins at a period doubling.

    Raises
    ------
    NoOrbitError
        If the orbit is no period doubling, or if no orbit of twice the period is found beside it.
    """
    equations, here = equations_of(doubling, along)
    with np.errstate(all="ignore"):
        product = equations.monodromy(here)
        off = float(Bifurcation.PERIOD_DOUBLING.test(*equations.trace_and_determinant(here)))
        size = 1 + float(np.max(np.abs(product)))
        if not abs(off) <= _DOUBLES * size:
            raise NoOrbitError(
                f"the orbit is no period doubling: det(M + 1) = {off:.1e}, which is 0 at one"
            )
        whole, found = doubled(equations, here, aside)
    if not found.converged:
        raise NoOrbitError(
            f"no orbit of twice the period was found beside the period doubling: residual "
            f"{float(found.residual):.1e} after {int(found.iterations)} Newton iterations"
        )
    _, at = twice(equations, here)
    away = float(np.linalg.norm(found.point - at))
    if not away <= _FARTHER * aside:
        raise NoOrbitError(
            f"the orbit of twice the period that was found is {away:.1e} from the period doubling, "
            f"and not about {aside:g}: it is on another branch"
        )
    return orbit_of_point(whole, found.point)


def first_doubled(
    doubling: Orbit, along: str | Path, to: float | None
) -> tuple[Orbit, np.ndarray | None]:
    """The first orbit of twice the period, and the direction that leads away from the doubling;
    None if a value ``to`` lies between the two.

    Raises
    ------
    NoOrbitError
        If there is none, or if the orbits exist on the other side than a value ``to``.
    """
    found = switch(doubling, along)
    at = place_along(doubling.model, doubling.amplitude, along)
    change = place_along(found.model, found.amplitude, along) - at
    if to is not None and (to - at) * change < 0 and abs(change) > _VERTICAL * abs(at):
        where = "above" if change > 0 else "below"
        raise NoOrbitError(
            f"to = {to:g} is beyond the period doubling: the orbits of twice the period exist next "
            f"to it only for {name_of(along)} {where} {at:g}"
        )
    if to is not None and (to - at) * change >= 0 and abs(to - at) < abs(change):
        return found, None
    return found, apart(*equations_of(doubling, along))


def halved(halving: Orbit) -> Orbit:
    """The orbit of half the period with which a branch merges at a period halving."""
    k = halving.impacts // 2
    phases = halving.phases
    return replace(
        halving,
        turns=turns_of_half(halving.turns, phases),
        phases=phases[:k],
        velocities=halving.velocities[:k],
        durations=halving.durations[:k],
        resumes=np.broadcast_to(halving.resumes, halving.impacts)[:k],
        kind="",
    )


class Sides(NamedTuple):
    """The two sides of a saddle-node along a parameter, whose value there is ``at``.

    ``above`` tells whether the orbits are at larger values of the parameter; None if they are on
    both sides. ``stable`` is the direction of the unknowns in which a branch leaves to the stable
    side. If not exactly one side is stable it is one of the two directions.
    """

    at: float
    above: bool | None
    stable: np.ndarray


def sides(fold: Orbit, along: str | Path) -> Sides:
    """The sides of a saddle-node.

    Raises
    ------
    NoOrbitError
        If there is no orbit near the saddle-node.
    """
    equations, guess = equations_of(fold, along)
    here = point_near(equations, guess)
    axis = np.eye(here.size)[-1]
    # The direction of a branch whose parameter increases at the start, and the opposite one.
    leaves = tangent(equations.jacobian(here), axis)
    beside = here + _SIDE * np.array([1.0, -1.0])[:, np.newaxis] * leaves
    with np.errstate(all="ignore"):
        found = newton_short(equations, beside, plane(np.stack([leaves, leaves]), beside), PATIENT)
    rises = found.point[:, -1] > here[-1]
    stable = is_stable(*equations.trace_and_determinant(found.point)) & found.converged
    is_fold = bool(found.converged.all() and rises[0] == rises[1])
    return Sides(
        at=float(equations.values(here)[equations.along[0]]),
        above=bool(rises[0]) if is_fold else None,
        stable=leaves if stable[0] or not stable[1] else -leaves,
    )
