"""Follow orbits along a parameter, follow cascades, and find the limits of n-T orbits."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby, pairwise
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from bouncing_ball_beyond.contacts.balls import (
    Ball,
    brief,
    check_whole_numbers,
    checked,
    one_number,
    whole_number,
)
from bouncing_ball_beyond.motions.effort import EVALUATIONS, Effort, SearchEnded
from bouncing_ball_beyond.periodic.branches import FollowedBranch, followed, joined
from bouncing_ball_beyond.periodic.equations import (
    CHANGES,
    KINDS,
    LASTING,
    OrbitEquations,
    OrbitNotFound,
    PeriodicOrbit,
    alone,
)
from bouncing_ball_beyond.periodic.instants import closing_speeds, folds, others, where_begun
from bouncing_ball_beyond.periodic.march import CLOSED, newton
from bouncing_ball_beyond.periodic.paths import Path, path_of, usual_range
from bouncing_ball_beyond.periodic.search import near_instants, rows_of, shortest_contacts
from bouncing_ball_beyond.periodic.starts import STARTS, Task
from bouncing_ball_beyond.tables.table import PERIOD, SINE, Table, check_table

AROUND = (0.95, 0.8, 0.65, 0.5, 0.35, 1.5, 2.5)
"""Values of Λ, in multiples of nπ, at which `limits` looks for an orbit.

The Λ of the saddle-node of instantaneous impacts is nπ for r = 0 on a sine. Without `AROUND`, a
contact with ζ = 1.3 has no limits. In 251 other balls only 2.5 had an effect.
"""


LOWEST = 1e-6
"""Smallest Λ of the orbits that `limits` follows."""


def follow(
    orbit: PeriodicOrbit | Sequence,
    *,
    along: str | None = None,
    to: ArrayLike | None = None,
    points: int = 500,
) -> Any:
    """Follow a periodic orbit, or many orbits at once, along a parameter.

    The branch of an ordinary orbit goes through this orbit. The branch of a special orbit depends
    on the kind of this orbit:

    - saddle-node: the branch on its stable side, where tr < 1 + det;
    - period doubling: orbits of twice the period;
    - period halving: orbits of half the period;
    - grazing of a flight: orbits with one more impact;
    - grazing or switch of a release, Neimark-Sacker: the branch that contains the orbit.

    Parameters
    ----------
    orbit : PeriodicOrbit, or a list from :func:`.orbit`
        Orbit, or several orbits, from which to start.
    along : str, optional
        "amplitude", "frequency", or a parameter of the ball or the table. "frequency" changes Ω at
        a fixed displacement amplitude a; its values are Ω/√(g/a) = √Λ. The default is the parameter
        of the branch that contains the orbit.
    to : float, array_like or tuple (low, high), optional
        Value at which the branch ends, or one value for each orbit. With a tuple, the orbit is
        followed in both directions, and the parameter stays in this range. With one value, if the
        parameter turns back at a saddle-node and passes its start, the branch ends at the mirror
        image of `to` on the other side of the start. The default is the upper end of the range of
        the parameter, but at most the larger of 10 and ten times the value. For a phase the default
        is one turn ahead.
    points : int
        Maximum number of orbits on a branch in each direction.

    Returns
    -------
    FollowedBranch, or a list
        A list for a sequence of orbits. Its entries are a FollowedBranch, or the OrbitNotFound or
        SearchEnded with the reason why a branch is missing.

    Raises
    ------
    OrbitNotFound
        If a single orbit has no branch. For example, doubled orbits exist only on one side of a
        period doubling, and `to` may be on the other side.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid, orbit
    >>> branch = follow(orbit(Rigid(0.5), amplitude=1.4), to=1.8)
    >>> [(special.kind, round(special.amplitude, 6)) for special in branch.special]
    [('period doubling', 1.526824)]
    """
    orbits = list(orbit) if isinstance(orbit, Iterable) else [orbit]
    if not all(isinstance(start, PeriodicOrbit | OrbitNotFound | SearchEnded) for start in orbits):
        raise ValueError(
            f"orbit = {brief(orbit)}: must be a periodic orbit, such as orbit(ball, amplitude=1.0),"
            " or a list of them"
        )
    points = whole_number("points", points, 2)
    branches = _follow_all(orbits, along, to, points, [None] * len(orbits))
    return alone(branches[0]) if isinstance(orbit, PeriodicOrbit) else branches


def cascade(doubling: PeriodicOrbit, *, to: float, impacts: int = 64) -> list[FollowedBranch]:
    """Follow a cascade of period doublings, each branch up to the next doubling.

    Parameters
    ----------
    doubling : PeriodicOrbit
        First period doubling, from which to start.
    to : float
        Value of the parameter at which branches end.
    impacts : int
        Maximum number of impacts of the orbits.

    Returns
    -------
    list of FollowedBranch
        Branches of the cascade. It ends before a doubling whose branch is not found.

    Raises
    ------
    OrbitNotFound
        If the doubling has no cascade.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid, orbit
    >>> branch = follow(orbit(Rigid(0.5), amplitude=1.4), to=1.8)
    >>> branches = cascade(branch.first("period doubling"), to=1.8, impacts=4)
    >>> [(branch.impacts, branch.special[-1].kind) for branch in branches]
    [(2, 'period doubling'), (4, 'period doubling')]
    """
    impacts = whole_number("impacts", impacts, 2)
    if not isinstance(doubling, PeriodicOrbit):
        raise ValueError(
            f"doubling = {brief(doubling)}: must be a period doubling, such as"
            " branch.first('period doubling')"
        )
    latest = doubling
    whole: list[FollowedBranch] = []
    while 2 * latest.impacts <= impacts:
        (branch,) = _follow_all([latest], None, to, 500, ["period doubling"])
        if isinstance(branch, OrbitNotFound):
            return whole or alone(branch)
        whole.append(branch)
        if not branch.special or branch.special[-1].kind != "period doubling":
            break
        latest = branch.special[-1]
    return whole


def _follow_all(
    orbits: list,
    along: str | None,
    to: Any,
    points: int,
    until: list,
    grazings: bool = True,
    effort: Effort | None = None,
) -> list:
    """Follow orbits. For each orbit, return its branch, or the reason why there is none.

    Consecutive orbits with the same equations are followed at once.
    """
    several = 2 if isinstance(to, tuple) else len(orbits)
    if to is not None and np.shape(to) not in ((), (several,)):
        raise ValueError(
            f"to = {brief(to)}: must be a number, a tuple (low, high), or one number for each orbit"
        )
    ways = []
    for i, orbit in enumerate(orbits):
        if not isinstance(orbit, PeriodicOrbit):
            continue
        path = (
            orbit.equations.along[-1] if along is None else path_of(along, orbit.ball, orbit.table)
        )
        goal = to if isinstance(to, tuple) or np.ndim(to) == 0 else to[i]
        alike = (x.at(**dict.fromkeys(x.parameters, 0.0)) for x in (orbit.ball, orbit.table))
        common = orbit.kind, path, orbit.impacts, *alike
        ways += [(common, i, task) for task in _tasks(orbit, path, goal, until[i])]
    parts: list[list] = [[] for _ in orbits]
    for (kind, *_), rows in groupby(ways, key=itemgetter(0)):
        _, numbers, tasks = zip(*rows, strict=True)
        task = _stacked(tasks)
        task = task._replace(equations=replace(task.equations, effort=effort))
        branches = _from_special(task, kind, points, grazings)
        for i, branch in zip(numbers, branches, strict=True):
            parts[i].append(branch)
    return [_whole(some) if some else orbit for some, orbit in zip(parts, orbits, strict=True)]


def _whole(ways: list) -> FollowedBranch | OrbitNotFound:
    """Join the branches of one orbit, or return the reason why there is none."""
    branches = [way for way in ways if isinstance(way, FollowedBranch)]
    if len(branches) == 2:
        return joined(*branches)
    return branches[0] if branches else ways[0]


def _tasks(orbit: PeriodicOrbit, path: Path, to: Any, until: str | None) -> list[Task]:
    """Return tasks, one for each direction in which the orbit is followed."""
    equations, z = orbit.on(path)
    value = float(z[-1])
    low, high = (float(limit) for limit in path.limits(orbit.ball, orbit.amplitude))
    if to is None:
        turn = path.name.startswith("phase_")
        to = value + PERIOD if turn else usual_range(path, value, low, high)[1]
    goals = np.atleast_1d(checked(f"to: {path.name}", to, low, high, low_allowed=True))
    if len(goals) == 2 and not goals[0] <= value <= goals[1]:
        raise ValueError(
            f"to = {to}: {path.name} = {value:.10g} of the orbit must be in this range"
        )
    others = goals[::-1] if len(goals) == 2 else np.array([np.nan])
    common = np.array([[low, high]]), np.array([until])
    return [
        Task(equations, z[np.newaxis], goals[[i]], others[[i]], *common) for i in range(len(goals))
    ]


def _stacked(tasks: tuple[Task, ...]) -> Task:
    """Combine tasks of single orbits into one task with a row for each orbit."""
    if len(tasks) == 1:
        return tasks[0]
    equations = replace(
        tasks[0].equations,
        ball=_in_rows([task.equations.ball for task in tasks]),
        table=_in_rows([task.equations.table for task in tasks]),
        periods=np.array([task.equations.periods for task in tasks]),
        amplitude=np.array([task.equations.amplitude for task in tasks]),
    )
    columns = zip(*(task[1:] for task in tasks), strict=True)
    return Task(equations, *(np.concatenate(rows) for rows in columns))


def _in_rows(several: list) -> Any:
    """Combine several balls, or several tables, into one with arrays as parameters."""
    first = several[0]
    values = {
        name: np.array([ball_or_table.parameters[name] for ball_or_table in several])
        for name in first.parameters
    }
    return first.at(**values) if values else first


def _from_special(task: Task, kind: str, points: int, grazings: bool) -> list:
    """Return branches that start at orbits of one kind, or the reasons why there are none."""
    if kind not in STARTS:
        return [OrbitNotFound(f"{kind}: branches end at orbits of this kind")] * len(task.z)
    start = STARTS[kind](task)
    branches: list = [OrbitNotFound(reason) for reason in start.reasons]
    going = np.flatnonzero(start.reasons == "")
    if not going.size:
        return branches
    # The parameter stays between both goals, or between the goal and its mirror image on the other
    # side of the start.
    mirror = np.clip(2 * task.z[:, -1] - start.goal, *task.limits.T)
    other = np.where(start.goal == task.goal, task.other, task.goal)
    behind = np.where(np.isfinite(task.other), other, mirror)
    window = np.sort(np.stack([start.goal, behind], axis=-1), axis=-1)[going, :, np.newaxis]
    started = followed(start.take(going), window, task.until[going], points, kind, grazings)
    name = task.equations.along[-1].name
    for i, branch in zip(going, started, strict=True):
        path = branch.z if start.origin is None else np.vstack([start.origin[i], branch.z])
        text = f"{kind or 'an orbit'} at {name} = {task.z[i, -1]:.10g}"
        branches[i] = replace(branch, z=path, start=text)
    return branches


@dataclass(frozen=True, repr=False)
class Limits(Sequence):
    """Special orbits at which n-T orbits begin and double their period; a sequence of these two.

    Attributes
    ----------
    saddle_node, period_doubling : PeriodicOrbit, OrbitNotFound or SearchEnded
        Special orbit, or the reason why there is none.
    stable_ranges : tuple of (low, high)
        Ranges of Λ in which orbits of the branch are stable and a ball follows them, in their order
        on the branch. With a constant r above about 0.01 on a sine there is one range, from the
        saddle-node to the period doubling. A range also ends where a flight grazes the table or a
        contact its release, at a Neimark-Sacker bifurcation if faster impacts lose less energy, and
        where the branch ends: at Λ = 1e-6 or where it has turned back and reaches twice the Λ at
        which it was entered. There may be none.
    others : array, shape (folds, 3)
        Λ, τ and u at which n-T orbits of instantaneous impacts with the r(u) of the ball begin, if
        they are not on the branch: those of other closing speeds, and those next to other rises of
        the table. The orbits of contacts begin near them. :func:`.orbits` finds these orbits.
    """

    saddle_node: PeriodicOrbit | OrbitNotFound | SearchEnded
    period_doubling: PeriodicOrbit | OrbitNotFound | SearchEnded
    stable_ranges: tuple[tuple[float, float], ...] = ()
    others: NDArray = field(default_factory=lambda: np.empty((0, 3)), compare=False)

    def __getitem__(self, i: Any) -> Any:
        return (self.saddle_node, self.period_doubling)[i]

    def __len__(self) -> int:
        return 2

    def __repr__(self) -> str:
        places = [str(limit) for limit in self]
        for i, limit in enumerate(self):
            if isinstance(limit, PeriodicOrbit):
                places[i] = f"{limit.kind} at Λ = {limit.amplitude:.10g}"
                places[i] += f" ({limit.obstacle})" if limit.obstacle else ""
        known = {limit.amplitude for limit in self if isinstance(limit, PeriodicOrbit)}
        if known and not (len(self.stable_ranges) == 1 and known <= {*self.stable_ranges[0]}):
            ranges = (f"from {low:.10g} to {high:.10g}" for low, high in self.stable_ranges)
            places.append(f"stable {' and '.join(ranges) or 'nowhere on this branch'}")
        if len(self.others):
            places.append(f"other n-T orbits begin {where_begun(self.others)}")
        return f"Limits: {'; '.join(places)}"


def limits(
    ball: Ball,
    *,
    n: ArrayLike = 1,
    table: Table = SINE,
    evaluations: int = EVALUATIONS,
    progress: Callable | None = None,
) -> Any:
    """Find the saddle-node and the period doubling of n-T orbits, and where they are stable.

    n-T orbits have one impact in n periods of the table. One of them, next to the phase at which
    the table rises fastest, is followed towards smaller and larger Λ. On tables that rise several
    times in a period, the branch may turn back at two other saddle-nodes before its period
    doubling; its ``stable_ranges`` may then overlap. Orbits that are not on this branch, such as
    those next to another rise, may be stable, too: see :func:`.orbits`.

    Parameters
    ----------
    ball : Ball
        The ball.
    n : int or array_like
        Number of periods of the table in one period of the orbits.
    table : Table
        The waveform.
    evaluations, progress
        As in :func:`.orbit`.

    Returns
    -------
    Limits or list of Limits
        A list if n or a parameter of the ball is an array. If a branch ends before a limit, for
        example because an impact grazes, the limit is an OrbitNotFound with this reason.

    Raises
    ------
    SearchEnded
        If the evaluations for a single ball are used up.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> round(limits(Rigid(0.5)).saddle_node.amplitude, 6)
    1.047198
    """
    check_table(table)
    check_whole_numbers("n", n)
    row, (periods,), shape = rows_of(ball, n=n)
    most = one_number("evaluations", evaluations)
    effort = Effort("limits", most, progress, balls=periods.size)
    limits_of_rows = limits_of(OrbitEquations(row, 1, periods, table=table, effort=effort))
    if not shape and isinstance(limits_of_rows[0].saddle_node, SearchEnded):
        raise limits_of_rows[0].saddle_node
    return limits_of_rows if shape else limits_of_rows[0]


def limits_of(equations: OrbitEquations) -> list[Limits]:
    """Find the limits of each row of orbits with one impact."""
    between = _between_limits(equations)
    equations.spend(0, "the branches of these orbits")
    rows = len(between)
    until: list = ["saddle-node"] * rows + ["period doubling"] * rows
    if equations.table.next_low_slope > 0:
        # Where W′ has another maximum, the branch turns back, and may be stable again.
        until = [None] * (2 * rows)
    to = [LOWEST] * rows + [None] * rows
    branches = _follow_all(between * 2, "amplitude", to, 500, until, False, equations.effort)
    limits_of_rows = []
    for start, below, above in zip(between, branches[:rows], branches[rows:], strict=True):
        if not isinstance(below, FollowedBranch):
            limits_of_rows.append(Limits(below, below))
            continue
        folds = [i for i, orbit in enumerate(below.special) if orbit.kind == "saddle-node"]
        to_fold = below.special[: folds[0] + 1] if folds else below.special
        special = (*to_fold[::-1], *above.special)
        fold = _limit(special, "saddle-node", below.end)
        doubling = _limit(special, "period doubling", above.end)
        branch = joined(below, above)
        ranges = _stable_ranges(branch)
        limits_of_rows.append(Limits(fold, doubling, ranges, _other_folds(start, branch)))
    return limits_of_rows


def _other_folds(start: PeriodicOrbit, branch: FollowedBranch) -> NDArray:
    """Saddle-nodes (Λ, τ, u) of instantaneous impacts, without those that a branch passes."""
    speeds = closing_speeds(start.ball, start.periods)
    saddle_nodes = folds(start.periods, start.table, speeds)
    passed = [orbit for orbit in branch.special if orbit.kind == "saddle-node"]
    for orbit in passed or [start]:
        saddle_nodes = others(saddle_nodes, speeds, orbit.times[0], orbit.speeds[0])
    return saddle_nodes[saddle_nodes[:, 0] > LOWEST]


def _stable_ranges(branch: FollowedBranch) -> tuple[tuple[float, float], ...]:
    """Ranges of the parameter in which the orbits of a branch are stable and a ball follows them.

    Between special orbits that change the stability, the middle orbit decides on it. Of contacts
    that last long, which take longest, only the orbits of the branch are asked.
    """
    T = branch.equations.split(branch.z)[0][..., 2:]
    path = (branch if T.max(initial=0.0) > LASTING else branch.refined()).with_special()
    special = [i for i, orbit in enumerate(path) if orbit.kind in CHANGES]
    ranges = []
    for first, last in pairwise([0, *special, len(path) - 1]):
        ends = np.array([path[first].z, path[last].z])
        if np.array_equal(*ends):
            continue
        z = np.array([orbit.z for orbit in path[first : last + 1]])
        # A branch that ends at a special orbit has this orbit twice.
        z = z[np.insert(np.diff(z, axis=0).any(axis=1), 0, True)]
        if len(z) == 2:
            middle = _between(branch.equations, z[[0]], z[[1]], 0.5)
            z = np.insert(z, 1, middle, axis=0)
        if branch.equations.orbit(z[len(z) // 2]).stable:
            ranges += _followed(branch.equations, z)
    return tuple(ranges)


def _between(equations: OrbitEquations, start: NDArray, end: NDArray, share: float) -> NDArray:
    """Orbit at a share of the step between two orbits, shape (1, N)."""
    chord = end - start
    return newton(equations, start + share * chord, chord / equations.scales(start) ** 2).z


def _followed(equations: OrbitEquations, z: NDArray) -> list[tuple[float, float]]:
    """Ranges of the parameter in which a ball follows the orbits between two special orbits.

    The special orbits, in the first and the last row, count as their neighbours.
    """
    # Rounding decides on orbits at a switch of a release: they count as their neighbours.
    inside = [not equations.at_switch(row[np.newaxis]) for row in z[1:-1]]
    z = z[[True, *inside, True]] if any(inside) else z
    inner = equations.admissible(z[1:-1])
    followed = np.concatenate([inner[:1], inner, inner[-1:]])
    ends = [z[0, -1]]
    for i in np.flatnonzero(followed[1:] != followed[:-1]).tolist():

        def margin(share: float, i: int = i) -> float:
            here = _between(equations, z[[i]], z[[i + 1]], share)
            return float(min(equations.clearance(here)[0], equations.contact_clearance(here)[0]))

        # If the margins have one sign, the range ends at the last orbit that a ball follows.
        share = float(followed[i + 1])
        if margin(0.0) * margin(1.0) < 0:
            share = brentq(margin, 0.0, 1.0, xtol=1e-12)
        ends.append(_between(equations, z[[i]], z[[i + 1]], share)[0, -1])
    pieces = list(pairwise([*ends, z[-1, -1]]))[0 if followed[0] else 1 :: 2]
    return [(float(min(piece)), float(max(piece))) for piece in pieces]


def _limit(special: tuple, kind: str, end: str) -> PeriodicOrbit | OrbitNotFound:
    """First special orbit of a kind, or an OrbitNotFound with the reason why the branch ends."""
    of_kind = (orbit for orbit in special if orbit.kind == kind)
    if end.startswith(tuple(name for name in KINDS if KINDS[name].end)):
        why = f"there is no {kind} on the branch of orbits, which ends at the {end}"
    elif end.startswith(CLOSED):
        why = f"there is no {kind} on the branch of orbits: {end}"
    else:
        why = f"no {kind} is known: the branch of orbits is followed until {end}"
    return next(of_kind, OrbitNotFound(why))


def _between_limits(equations: OrbitEquations) -> list:
    """For each row, return an orbit with one impact, or an OrbitNotFound.

    The search starts between the limits of instantaneous impacts. It prefers admissible orbits.
    """
    n = np.asarray(equations.periods)
    r = equations.ball.signature(1.5 * np.pi * n).restitution
    r = np.where(np.isfinite(r), r, 0.5)
    table = equations.table
    fold = np.pi * n * (1 - r) / (1 + r)
    # Orbits of instantaneous impacts have ΛW′ = fold. `push` is half of -ΛW″ at the doubling.
    push = (1 + r * r) / (1 + r) ** 2
    phase = table.phase_of_angle(np.arctan2(push, fold))
    between = np.hypot(fold, push) / np.hypot(table(phase, 1), table(phase, 2))
    around = [times * np.pi * n / table.slope for times in AROUND]
    orbit_of_row: list = [OrbitNotFound("no orbit with one impact is found")] * len(n)
    done = np.zeros(len(n), bool)
    # Where W′ has several maxima, a larger Λ may belong to orbits next to another one.
    nearest = 2 * fold / (table.slope + max(table.next_low_slope, 0.0))
    # At r = 1 a fold above 0 is a rounding error.
    nearest = np.where(nearest > LOWEST, np.fmin(between, nearest), between)
    ways: list[tuple] = [(near_instants, nearest), (near_instants, between)]
    ways += [(shortest_contacts, amplitude) for amplitude in [between, *around]]
    for search, amplitude in ways:
        todo = np.flatnonzero(~done)
        if not todo.size:
            break
        orbits, done[todo] = search(equations.rows(todo), amplitude[todo], 1)
        for row, orbit in zip(todo, orbits, strict=True):
            if orbit and (done[row] or isinstance(orbit_of_row[row], OrbitNotFound)):
                orbit_of_row[row] = orbit
            done[row] |= isinstance(orbit, SearchEnded)
    return orbit_of_row
