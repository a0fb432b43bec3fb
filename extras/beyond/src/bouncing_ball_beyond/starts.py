"""Where branches start: at an ordinary orbit, or at a special one at which another one begins."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.chains import solve_bordered
from bouncing_ball_beyond.equations import OrbitEquations, OrbitNotFound
from bouncing_ball_beyond.forms import one_impact_more
from bouncing_ball_beyond.march import Start, newton, tangents, unit
from bouncing_ball_beyond.search import single

NEAREST = 1e-9
"""Relative distance from a period doubling below which doubled orbits are not told apart.

At a distance ξ, rounding errors of the orbits are eps/ξ², and ξ² is proportional to the change of
the parameter.
"""


class Task(NamedTuple):
    """Orbits to be followed, by rows.

    Their goals, one or two, the limits of the parameter, and the kinds of special orbits at which
    branches end, or None.
    """

    equations: OrbitEquations
    z: NDArray
    goals: NDArray
    limits: NDArray
    until: NDArray


def _none(task: Task) -> NDArray:
    """No reasons against a branch."""
    return np.full(len(task.z), "", object)


def _on_side(reasons: NDArray, away: NDArray, task: Task, goal: NDArray, what: str) -> None:
    """Add the reason that orbits are on the other side of a special orbit than the goal."""
    name = task.equations.along[-1].name
    here = task.z[:, -1]
    for i in np.flatnonzero((reasons == "") & ~(away * (goal - here) > 0)):
        side = "above" if away[i] > 0 else "below"
        reasons[i] = what.format(side=side, place=f"{name} = {here[i]:.10g}")


def flip(equations: OrbitEquations, z: NDArray) -> NDArray:
    """Directions in which orbits of twice the period leave period doublings; shape (rows, 2kq + p).

    It is the null vector of the equations of an orbit whose first impact comes back with the other
    sign, and after it this vector with the other sign.
    """
    q = equations.unknowns
    derivatives = equations.linear(z).derivatives[..., : q + 3].copy()
    rows, k, _, _ = derivatives.shape
    derivatives[:, -1, :, q : q + 2] *= -1
    # Any column and any row beside the singular matrix, if they are not special.
    derivatives[..., q + 2 :] = np.cos(np.arange(k * q)).reshape(k, q, 1)
    border = np.cos(np.sqrt(2) * np.arange(k * q + 1))
    border[-1] = 0.0
    border = np.broadcast_to(border, (rows, 1, k * q + 1))
    none = np.zeros((rows, k, q, 1))
    null = solve_bordered(derivatives, none, border, np.ones((rows, 1, 1)))[:, :-1, 0]
    return np.concatenate([null, -null, np.zeros((rows, len(equations.along)))], axis=1)


def _ordinary_start(task: Task, way: int) -> Start:
    """The branch through orbits."""
    goal = task.goals[:, way]
    ahead = goal - task.z[:, -1]
    direction = tangents(task.equations, task.z)
    direction = direction * np.sign(ahead * direction[:, -1])[:, np.newaxis]
    reasons = _none(task)
    for i in np.flatnonzero(ahead == 0):
        name = task.equations.along[-1].name
        reasons[i] = f"{name} = {goal[i]:.10g} is that of the orbit already"
    return Start(task.equations, task.z, direction, goal, reasons)


def _fold_start(task: Task, way: int) -> Start:
    """The branch that is stable next to a saddle-node; also the other one, if both are followed.

    Both are on the same side of the parameter.
    """
    units = task.equations.scales(task.z)
    direction = unit(tangents(task.equations, task.z) / units)
    near = newton(task.equations, task.z + 1e-3 * direction * units, direction / units)
    away = near.z[:, -1] - task.z[:, -1]
    stable = np.sign(1 - task.equations.turn(near.linear))
    other = task.goals.shape[1] == 2 and way == 0
    direction = direction * units * (-stable if other else stable)[:, np.newaxis]
    goal = np.where(away > 0, task.goals.max(axis=1), task.goals.min(axis=1))
    reasons = _none(task)
    reasons[~near.found] = "no orbit is found beside the saddle-node"
    _on_side(reasons, away, task, goal, "the orbits of the saddle-node at {place} are {side} it")
    return Start(task.equations, task.z, direction, goal, reasons)


def _grazing_start(task: Task, way: int) -> Start:
    """The branch with one impact more, from orbits with a flight that touches the table."""
    more = replace(task.equations, impacts=task.equations.impacts + 1)
    origin = np.zeros((len(task.z), more.length))
    direction = np.ones(origin.shape)
    reasons = _none(task)
    for i, z in enumerate(task.z):
        try:
            _, origin[i], direction[i] = one_impact_more(single(task.equations, i), z)
        except OrbitNotFound as error:
            reasons[i] = str(error)
    # One step away from the touch, where the added impact has the speed 0.
    units = more.scales(origin)
    ahead = unit(direction / units)
    start = newton(more, origin + 1e-3 * ahead * units, ahead / units)
    reasons[(reasons == "") & ~start.found] = "the orbits with one impact more are not found"
    goal = task.goals[:, way]
    away = start.z[:, -1] - origin[:, -1]
    what = "the orbits with one impact more are {side} the grazing at {place}"
    _on_side(reasons, away, task, goal, what)
    return Start(more, start.z, start.z - origin, goal, reasons, step=1e-3, origin=origin)


def _halved_start(task: Task, way: int) -> Start:
    """The branch of half the period."""
    equations, z = task.equations.halved(task.z)
    return _ordinary_start(task._replace(equations=equations, z=z), way)


def _doubled_start(task: Task, way: int) -> Start:
    """The branch of twice the period.

    The parameter and tr/(1 + det), which is 1 at the doubling, change there with the square of the
    distance. The first step is halved until both fall by about four from it to half of it, and
    until the latter has hardly changed: then no bifurcation is between the doubling and the step.
    """
    twice, origin = task.equations.doubled(task.z)
    rows = len(origin)
    units = twice.scales(origin)
    direction = unit(flip(task.equations, task.z) / units)
    pair = twice.rows(np.tile(np.arange(rows), 2))
    start = origin.copy()
    step = np.full(rows, 0.02)
    good = np.zeros(rows, bool)
    for _ in range(40):
        reach = np.concatenate([step, step / 2])[:, np.newaxis]
        guess = np.tile(origin, (2, 1)) + reach * np.tile(direction * units, (2, 1))
        solution = newton(pair, guess, np.tile(direction / units, (2, 1)))
        with np.errstate(all="ignore"):
            away = (solution.z[:, -1] - np.tile(origin[:, -1], 2)).reshape(2, rows)
            lost = 1 - pair.turn(solution.linear).reshape(2, rows)
            bend = np.linalg.norm((solution.z - guess)[:rows] / units, axis=1)
            new = ~good & solution.found.reshape(2, rows).all(axis=0) & (bend < 0.2 * step)
            new &= _about_four(away) & _about_four(lost) & (np.abs(lost[0]) < 0.3)
        start[new] = solution.z[:rows][new]
        good |= new
        if good.all():
            break
        step[~good] /= 2
    goal = task.goals[:, way]
    reasons = _none(task)
    reasons[~good] = "the start of the orbits of twice the period is not found"
    away = start[:, -1] - origin[:, -1]
    what = "the orbits of twice the period are {side} the period doubling at {place}"
    _on_side(reasons, away, task, goal, what)
    near = (reasons == "") & (np.abs(goal - origin[:, -1]) < NEAREST * units[:, -1])
    name = twice.along[-1].name
    reasons[near] = f"{name} is too near to the period doubling: rounding errors hide the orbits"
    with np.errstate(all="ignore"):
        share = (goal - origin[:, -1]) / away
    short = (reasons == "") & (share < 1.5)
    if short.any():
        # The whole branch is hardly longer than its start, or shorter.
        step = np.where(short, 0.3 * step * np.sqrt(np.abs(share)), step)
        guess = origin + step[:, np.newaxis] * direction * units
        solution = newton(twice, guess, direction / units)
        start[short] = solution.z[short]
        reasons[short & ~solution.found] = (
            "the start of the orbits of twice the period is not found"
        )
    return Start(twice, start, start - origin, goal, reasons, step=step, origin=origin)


def _about_four(pair: NDArray) -> NDArray:
    """Whether the second row is about a quarter of the first."""
    ratio = pair[0] / pair[1]
    return (ratio > 3) & (ratio < 5.5)


STARTS = {
    "": _ordinary_start,
    "grazing of a release": _ordinary_start,
    "saddle-node": _fold_start,
    "period doubling": _doubled_start,
    "period halving": _halved_start,
    "grazing of a flight": _grazing_start,
}
