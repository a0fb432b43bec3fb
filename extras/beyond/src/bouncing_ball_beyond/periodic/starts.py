"""Start branches at ordinary orbits, or at special orbits at which other branches begin."""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.periodic.chains import solve_bordered
from bouncing_ball_beyond.periodic.equations import OrbitEquations, OrbitNotFound
from bouncing_ball_beyond.periodic.forms import one_impact_more
from bouncing_ball_beyond.periodic.march import Solution, Start, newton, tangents, unit
from bouncing_ball_beyond.periodic.search import single
from bouncing_ball_beyond.periodic.switches import SWITCH, at_surface, beyond_switch

NEAREST = 1e-9
"""Relative distance from a period doubling, in the parameter, below which rounding hides orbits.

The distance of the parameter is proportional to ξ², where ξ is the distance of the doubled orbits
from the period doubling. Rounding errors of the doubled orbits are eps/ξ².

At half, all 12 branches at 0.6 and 0.9 of this distance are found. At twice, all 6 branches at 1.5
of it are refused.
"""


class Task(NamedTuple):
    """Orbits to be followed, one per row.

    Attributes
    ----------
    equations : OrbitEquations
    z : array, shape (rows, N)
        Orbits.
    goal : array, shape (rows,)
        Parameter values at which the branches end.
    other : array, shape (rows,)
        Parameter values at which the branches in the opposite direction end; NaN if only one
        direction is followed.
    limits : array, shape (rows, 2)
        Minimum and maximum of the parameter.
    until : array of str or None, shape (rows,)
        Kinds of special orbits at which branches end.
    """

    equations: OrbitEquations
    z: NDArray
    goal: NDArray
    other: NDArray
    limits: NDArray
    until: NDArray


def _refuse(reasons: NDArray, which: NDArray, task: Task, text: str, away: NDArray) -> None:
    """Store a reason for the rows ``which`` that do not have one yet.

    ``text`` may contain three fields. {name} is the parameter, {place} is the parameter with its
    value, and {side} is "above" or "below".
    """
    name = task.equations.along[-1].name
    for i in np.flatnonzero((reasons == "") & which):
        place = f"{name} = {task.z[i, -1]:.10g}"
        side = "above" if away[i] > 0 else "below"
        reasons[i] = text.format(name=name, place=place, side=side)


def flip(equations: OrbitEquations, z: NDArray) -> NDArray:
    """Directions in which the doubled orbits leave period doublings, shape (rows, 2kq + p).

    If a multiplier is -1, a deviation of the first impact changes its sign after a period. Let v be
    the null vector of the equations with this condition. The direction is v in the first half of
    the doubled orbit, and -v in the second half.
    """
    q = equations.unknowns
    derivatives = equations.linearized(z).derivatives[..., : q + 3].copy()
    rows, k, _, _ = derivatives.shape
    derivatives[:, -1, :, q : q + 2] *= -1
    # Border the singular matrix with an arbitrary column and row.
    derivatives[..., q + 2 :] = np.cos(np.arange(k * q)).reshape(k, q, 1)
    border = np.cos(np.sqrt(2) * np.arange(k * q + 1))
    border[-1] = 0.0
    border = np.broadcast_to(border, (rows, 1, k * q + 1))
    none = np.zeros((rows, k, q, 1))
    null = solve_bordered(derivatives, none, border, np.ones((rows, 1, 1)))[:, :-1, 0]
    return np.concatenate([null, -null, np.zeros((rows, len(equations.along)))], axis=1)


def _beside(equations: OrbitEquations, z: NDArray, direction: NDArray, step: Any) -> Solution:
    """Go the distance ``step`` from special orbits in a direction, and find orbits there.

    Newton's method corrects the orbits on planes perpendicular to this direction.
    """
    units = equations.scales(z)
    ahead = unit(direction / units)
    return newton(equations, z + step * ahead * units, ahead / units)


def _ordinary_start(task: Task) -> Start:
    """Start branches that pass through ordinary orbits."""
    ahead = task.goal - task.z[:, -1]
    direction = tangents(task.equations, task.z)
    direction = direction * np.sign(ahead * direction[:, -1])[:, np.newaxis]
    reasons = np.full(len(task.z), "", object)
    _refuse(reasons, ahead == 0, task, "{place} is already the value of the orbit", ahead)
    return Start(task.equations, task.z, direction, task.goal, reasons)


def _switch_start(task: Task) -> Start:
    """Start branches with the other end of the contact at switches of a release."""
    direction = tangents(at_surface(task.equations), task.z)
    ahead = task.goal - task.z[:, -1]
    direction = direction * np.sign(ahead * direction[:, -1])[:, np.newaxis]
    return beyond_switch(task.equations, task.z, direction, task.goal)


def _fold_start(task: Task) -> Start:
    """Start the branch on the stable side of a saddle-node, where tr < 1 + det.

    If both directions are followed, the second branch is on the unstable side. The parameter of
    both branches is on the same side of the saddle-node.
    """
    direction = tangents(task.equations, task.z)
    near = _beside(task.equations, task.z, direction, 1e-3)
    away = near.z[:, -1] - task.z[:, -1]
    stable = np.sign(1 - task.equations.turn(near.linear))
    side = np.where(task.goal < task.other, -stable, stable)
    farthest = np.fmax(task.goal, task.other), np.fmin(task.goal, task.other)
    goal = np.where(away > 0, *farthest)
    reasons = np.full(len(task.z), "", object)
    reasons[~near.converged] = "no orbit is found next to the saddle-node"
    on_side = away * (goal - task.z[:, -1]) > 0
    text = "the orbits of the saddle-node at {place} are {side} it"
    _refuse(reasons, ~on_side, task, text, away)
    return Start(task.equations, task.z, direction * side[:, np.newaxis], goal, reasons)


def _grazing_start(task: Task) -> Start:
    """Start branches with one more impact at orbits with a flight that touches the table."""
    more = replace(task.equations, impacts=task.equations.impacts + 1)
    origin = np.zeros((len(task.z), more.length))
    direction = np.ones(origin.shape)
    reasons = np.full(len(task.z), "", object)
    for i, z in enumerate(task.z):
        try:
            _, origin[i], direction[i] = one_impact_more(single(task.equations, i), z)
        except OrbitNotFound as error:
            reasons[i] = str(error)
    # Start one step away from the grazing orbit, where the added impact has the speed 0.
    start = _beside(more, origin, direction, 1e-3)
    away = start.z[:, -1] - origin[:, -1]
    _refuse(reasons, ~start.converged, task, "the orbits with one impact more are not found", away)
    on_side = away * (task.goal - task.z[:, -1]) > 0
    text = "the orbits with one impact more are {side} the grazing at {place}"
    _refuse(reasons, ~on_side, task, text, away)
    return Start(more, start.z, start.z - origin, task.goal, reasons, step=1e-3, origin=origin)


def _halved_start(task: Task) -> Start:
    """Start the branch of orbits of half the period at a period halving."""
    equations, z = task.equations.halved(task.z)
    return _ordinary_start(task._replace(equations=equations, z=z))


def _doubled_start(task: Task) -> Start:
    """Start the branch of orbits of twice the period at a period doubling.

    Near the period doubling, the parameter and tr/(1 + det) change with the square of the distance.
    For the doubled orbits, tr/(1 + det) is 1 at the period doubling. The first step is halved until

    1. a step of half the length changes the parameter and tr/(1 + det) by about a quarter as much;
    2. the whole step changes tr/(1 + det) by less than 0.3.

    Then no bifurcation is between the period doubling and the end of the step.
    """
    twice, origin = task.equations.doubled(task.z)
    rows = len(origin)
    units = twice.scales(origin)
    direction = flip(task.equations, task.z)
    pair = twice.rows(np.tile(np.arange(rows), 2))
    origins, directions = (np.tile(vectors, (2, 1)) for vectors in (origin, direction))
    start = origin.copy()
    step = np.full(rows, 0.02)
    good = np.zeros(rows, bool)
    for _ in range(40):
        reach = np.concatenate([step, step / 2])[:, np.newaxis]
        solution = _beside(pair, origins, directions, reach)
        with np.errstate(all="ignore"):
            change = (solution.z - origins).reshape(2, rows, -1)
            away = change[..., -1]
            lost = 1 - pair.turn(solution.linear).reshape(2, rows)
            ratios = np.stack([away[0] / away[1], lost[0] / lost[1]])
        # Where the branch bends, the distance of the orbits on the planes is larger than the step.
        bend = np.linalg.norm(change[0] / units, axis=1) / step
        new = ~good & solution.converged.reshape(2, rows).all(axis=0) & (bend < np.hypot(1, 0.2))
        new &= ((ratios > 3) & (ratios < 5.5)).all(axis=0) & (np.abs(lost[0]) < 0.3)
        start[new] = solution.z[:rows][new]
        good |= new
        if good.all():
            break
        step[~good] /= 2
    reasons = np.full(rows, "", object)
    missing = "the start of the orbits of twice the period is not found"
    reasons[~good] = missing
    here = origin[:, -1]
    away = start[:, -1] - here
    text = "the orbits of twice the period are {side} the period doubling at {place}"
    _refuse(reasons, ~(away * (task.goal - here) > 0), task, text, away)
    near = np.abs(task.goal - here) < NEAREST * units[:, -1]
    text = "{name} is too near to the period doubling: rounding errors hide the orbits"
    _refuse(reasons, near, task, text, away)
    with np.errstate(all="ignore"):
        share = (task.goal - here) / away
    short = (reasons == "") & (share < 1.5)
    if short.any():
        # The goal is near the first point or before it: take a shorter step.
        step = np.where(short, 0.3 * step * np.sqrt(np.abs(share)), step)
        solution = _beside(twice, origin, direction, step[:, np.newaxis])
        start[short] = solution.z[short]
        reasons[short & ~solution.converged] = missing
    return Start(twice, start, start - origin, task.goal, reasons, step=step, origin=origin)


STARTS = {
    "": _ordinary_start,
    "grazing of a release": _ordinary_start,
    SWITCH: _switch_start,
    "Neimark-Sacker": _ordinary_start,
    "saddle-node": _fold_start,
    "period doubling": _doubled_start,
    "period halving": _halved_start,
    "grazing of a flight": _grazing_start,
}
