"""Orbits along a parameter, cascades of doublings, and the limits of orbits with one impact."""

from collections.abc import Iterable
from dataclasses import replace
from itertools import groupby
from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_beyond.balls import Ball, brief, check_whole_numbers, whole_number
from bouncing_ball_beyond.branches import FollowedBranch, followed, joined
from bouncing_ball_beyond.equations import OrbitEquations, OrbitNotFound, PeriodicOrbit, alone
from bouncing_ball_beyond.one_ball import PERIOD
from bouncing_ball_beyond.paths import Path, path_of, usual_range
from bouncing_ball_beyond.search import near_instants, rows_of, shortest_contacts
from bouncing_ball_beyond.starts import STARTS, Task
from bouncing_ball_beyond.tables import SINE, Table, check_table

SHARES = (0.5, 0.9, 0.2, 2.0, 4.0)
AROUND = (0.95, 0.8, 0.65, 0.5, 0.35, 1.5, 2.5)
"""Where `limits` looks for an orbit: at shares of the -w″ at which instants double, and then at
multiples of nπ, their saddle-node with r = 0."""


def follow(orbit: Any, *, along: str | None = None, to: Any = None, points: int = 500) -> Any:
    """Follow a periodic orbit along a parameter, or many orbits side by side.

    It goes through an orbit, or begins at a special one: stable from a saddle-node, with twice the
    period from a doubling, half of it from a halving, one impact more from the grazing of a flight.
    OrbitNotFound if a single orbit has no branch, such as towards `to` from a period doubling.

    Parameters
    ----------
    orbit : PeriodicOrbit, or a sequence of PeriodicOrbit and OrbitNotFound
        A sequence has a list of branches, and the reason in place of one that there is not.
    along : str, optional
        "amplitude", a parameter of the ball or the table, or "frequency" (at a fixed stroke,
        Ω/√(g/a) = √Λ); by default what changed on the branch of the orbit.
    to : float, array_like or tuple (low, high), optional
        Where a branch ends, one value or one for each orbit; a tuple has both ways. Behind a
        saddle-node the parameter moves back, at most as far beyond its first value. By default it
        rises to the end of its range, or to ten times its value and at least 10; a phase by a turn.
    points : int
        The largest number of orbits on a branch, of each direction.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid, orbit
    >>> branch = follow(orbit(Rigid(0.5), amplitude=1.4), to=1.8)
    >>> [(each.kind, round(each.amplitude, 6)) for each in branch.special]
    [('period doubling', 1.526824)]
    """
    orbits = _listed(orbit, "orbit", "a periodic orbit, such as orbit(ball, amplitude=1.0)")
    points = whole_number("points", points, 2)
    found = _follow_all(orbits, along, to, points, [None] * len(orbits))
    return alone(found[0]) if isinstance(orbit, PeriodicOrbit) else found


def cascade(doubling: Any, *, to: Any, impacts: int = 64) -> Any:
    """Follow a cascade of period doublings, each branch up to the doubling where the next begins.

    Nothing is followed beyond `to`, one value or one for each doubling, and orbits have at most so
    many `impacts`. A sequence of doublings has a list of cascades, with the OrbitNotFound in place
    of one; a single one raises it.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid, orbit
    >>> branch = follow(orbit(Rigid(0.5), amplitude=1.4), to=1.8)
    >>> branches = cascade(branch.first("period doubling"), to=1.8, impacts=4)
    >>> [(each.impacts, each.special[-1].kind) for each in branches]
    [(2, 'period doubling'), (4, 'period doubling')]
    """
    impacts = whole_number("impacts", impacts, 2)
    wanted = "a period doubling, such as branch.first('period doubling')"
    latest = _listed(doubling, "doubling", wanted)
    whole = [[] if isinstance(each, PeriodicOrbit) else each for each in latest]
    if np.ndim(to) and len(to) != len(latest):
        raise ValueError(f"to: has {len(to)} values for {len(latest)} orbits")
    to = np.broadcast_to(np.asarray(to, float), len(latest))
    going = [i for i, each in enumerate(latest) if isinstance(each, PeriodicOrbit)]
    while going := [i for i in going if 2 * latest[i].impacts <= impacts]:
        until = ["period doubling"] * len(going)
        found = _follow_all([latest[i] for i in going], None, to[going], 500, until)
        further = []
        for i, branch in zip(going, found, strict=True):
            if isinstance(branch, OrbitNotFound):
                whole[i] = whole[i] or branch
                continue
            whole[i].append(branch)
            if branch.special and branch.special[-1].kind == "period doubling":
                latest[i] = branch.special[-1]
                further.append(i)
        going = further
    return alone(whole[0]) if isinstance(doubling, PeriodicOrbit) else whole


def _listed(given: Any, name: str, wanted: str) -> list:
    """Several orbits as a list; ValueError with one line for anything else."""
    found = list(given) if isinstance(given, Iterable) else [given]
    if not all(isinstance(each, PeriodicOrbit | OrbitNotFound) for each in found):
        raise ValueError(f"{name} = {brief(given)}: must be {wanted}, or a list of them")
    return found


def _follow_all(orbits: list, along: str | None, to: Any, points: int, until: list) -> list:
    """Branches of orbits, or reasons, in order; those with the same equations side by side."""
    several = 2 if isinstance(to, tuple) else len(orbits)
    if to is not None and np.shape(to) not in ((), (several,)):
        raise ValueError(
            f"to = {brief(to)}: must be a number, a tuple (low, high), or one number for each orbit"
        )
    ways = []
    for i, each in enumerate(orbits):
        if not isinstance(each, PeriodicOrbit):
            continue
        path = each.equations.along[-1] if along is None else path_of(along, each.ball, each.table)
        goal = to if isinstance(to, tuple) or np.ndim(to) == 0 else to[i]
        alike = (x.at(**dict.fromkeys(x.parameters, 0.0)) for x in (each.ball, each.table))
        common = each.kind, type(each.equations), path, each.impacts, *alike
        ways += [(common, i, task) for task in _tasks(each, path, goal, until[i])]
    parts: list[list] = [[] for _ in orbits]
    for (kind, *_), rows in groupby(ways, key=itemgetter(0)):
        _, numbers, tasks = zip(*rows, strict=True)
        branches = _from_special(_stacked(tasks), kind, points)
        for i, branch in zip(numbers, branches, strict=True):
            parts[i].append(branch)
    return [_whole(some) if some else each for some, each in zip(parts, orbits, strict=True)]


def _whole(ways: list) -> FollowedBranch | OrbitNotFound:
    """The branch that is followed one way or both ways, or the reason why there is none."""
    branches = [each for each in ways if isinstance(each, FollowedBranch)]
    if len(branches) == 2:
        return joined(*branches)
    return branches[0] if branches else ways[0]


def _tasks(orbit: PeriodicOrbit, path: Path, to: Any, until: str | None) -> list[Task]:
    """What is to be followed from one orbit, as one row for each way."""
    equations, z = orbit.on(path)
    value = float(z[-1])
    low, high = (float(each) for each in path.limits(orbit.ball, orbit.amplitude))
    if to is None:
        turn = path.name.startswith("phase_")
        to = value + PERIOD if turn else usual_range(path, value, low, high)[1]
    goals = np.atleast_1d(np.asarray(to, float))
    for goal in goals:
        if not (low <= goal <= high and np.isfinite(goal)):
            raise ValueError(f"to = {goal:g}: {path.name} must be in [{low:g}, {high:g}]")
    if len(goals) == 2 and not goals[0] <= value <= goals[1]:
        raise ValueError(f"to = {to}: {path.name} = {value:.10g} of the orbit must be between them")
    others = goals[::-1] if len(goals) == 2 else np.array([np.nan])
    common = np.array([[low, high]]), np.array([until])
    return [
        Task(equations, z[np.newaxis], goals[[i]], others[[i]], *common) for i in range(len(goals))
    ]


def _stacked(tasks: tuple[Task, ...]) -> Task:
    """Tasks of single orbits as rows of one."""
    if len(tasks) == 1:
        return tasks[0]
    equations = replace(
        tasks[0].equations,
        ball=_in_rows([each.equations.ball for each in tasks]),
        table=_in_rows([each.equations.table for each in tasks]),
        periods=np.array([each.equations.periods for each in tasks]),
        amplitude=np.array([each.equations.amplitude for each in tasks]),
    )
    columns = zip(*(each[1:] for each in tasks), strict=True)
    return Task(equations, *(np.concatenate(rows) for rows in columns))


def _in_rows(several: list) -> Any:
    """One ball, or one table, with the parameters of several as arrays."""
    first = several[0]
    values = {
        name: np.array([each.parameters[name] for each in several]) for name in first.parameters
    }
    return first.at(**values) if values else first


def _from_special(task: Task, kind: str, points: int) -> list:
    """Branches from orbits of one kind, or the reasons for none."""
    if kind not in STARTS:
        return [OrbitNotFound("branches end at a special orbit of this kind")] * len(task.z)
    start = STARTS[kind](task)
    found: list = [OrbitNotFound(reason) for reason in start.reasons]
    going = np.flatnonzero(start.reasons == "")
    if not going.size:
        return found
    # The parameter stays between the goal and a value as far behind the start.
    behind = np.clip(2 * task.z[:, -1] - start.goal, *task.limits.T)
    window = np.sort(np.stack([start.goal, behind], axis=-1), axis=-1)[going, :, np.newaxis]
    branches = followed(start.take(going), window, task.until[going], points, kind)
    name = task.equations.along[-1].name
    for i, branch in zip(going, branches, strict=True):
        path = branch.z if start.origin is None else np.vstack([start.origin[i], branch.z])
        text = f"{kind or 'an orbit'} at {name} = {task.z[i, -1]:.10g}"
        found[i] = replace(branch, z=path, start=text)
    return found


class Limits(NamedTuple):
    """The orbits between which those with one impact are stable, or the reasons for none."""

    saddle_node: PeriodicOrbit | OrbitNotFound
    period_doubling: PeriodicOrbit | OrbitNotFound

    def __repr__(self) -> str:
        places = (
            f"{each.kind} at Λ = {each.amplitude:.10g}"
            if isinstance(each, PeriodicOrbit)
            else str(each)
            for each in self
        )
        return "Limits: {}; {}".format(*places)


def limits(ball: Ball, *, n: Any = 1, table: Table = SINE) -> Any:
    """Find the saddle-node and the period doubling of the n-T orbits of a ball, as `Limits`.

    An orbit is followed towards smaller and greater Λ, around the phase at which the table rises
    fastest. In place of a limit there may be an OrbitNotFound with the reason, such as the grazing
    of an impact. If n or a parameter is an array, there is a list. A law without a rebound, r = 0,
    may take minutes: its contacts last longer and longer as Λ falls.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> round(limits(Rigid(0.5)).saddle_node.amplitude, 6)
    1.047198
    """
    check_table(table)
    check_whole_numbers("n", n)
    row, (periods,), shape = rows_of(ball, n=n)
    between = _between_limits(OrbitEquations(row, 1, periods, table=table))
    rows = len(between)
    until = ["saddle-node"] * rows + ["period doubling"] * rows
    branches = _follow_all(between * 2, "amplitude", [1e-6] * rows + [None] * rows, 500, until)
    found = []
    for below, above in zip(branches[:rows], branches[rows:], strict=True):
        if isinstance(below, OrbitNotFound):
            found.append(Limits(below, below))
            continue
        special = (*below.special[::-1], *above.special)
        fold = _limit(special, "saddle-node", below.end)
        found.append(Limits(fold, _limit(special, "period doubling", above.end)))
    return found if shape else found[0]


def _limit(special: tuple, kind: str, end: str) -> PeriodicOrbit | OrbitNotFound:
    """The first special orbit of a kind, or the reason why there is none: how the branch ends."""
    of_kind = (each for each in special if each.kind == kind)
    return next(of_kind, OrbitNotFound(f"no {kind} before the branch ends: {end}"))


def _between_limits(equations: OrbitEquations) -> list:
    """For each row an orbit that a ball follows, if possible between the limits of instants."""
    n = np.asarray(equations.periods)
    r = equations.ball.signature(1.5 * np.pi * n).restitution
    r = np.where(np.isfinite(r), r, 0.5)
    table = equations.table
    fold = np.pi * n * (1 - r) / (1 + r)
    # Instants at ΛW′ = fold and -ΛW″ = a share of that at the period doubling.
    push = np.multiply.outer(SHARES, 2 * (1 + r * r) / (1 + r) ** 2)
    phase = table.phase_of_angle(np.arctan2(push, fold))
    amplitudes = [*(np.hypot(fold, push) / np.hypot(table(phase, 1), table(phase, 2)))]
    around = [times * np.pi * n / table.slope for times in AROUND]
    found: list = [OrbitNotFound("no orbit with one impact is found")] * len(n)
    done = np.zeros(len(n), bool)
    ways = [(near_instants, amplitude) for amplitude in amplitudes]
    ways += [(shortest_contacts, amplitude) for amplitude in [*amplitudes, *around]]
    for search, amplitude in ways:
        todo = np.flatnonzero(~done)
        if not todo.size:
            break
        orbits, done[todo] = search(equations.rows(todo), amplitude[todo], 1)
        for row, each in zip(todo, orbits, strict=True):
            if each and (done[row] or isinstance(found[row], OrbitNotFound)):
                found[row] = each
    return found
