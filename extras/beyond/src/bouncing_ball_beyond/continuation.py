"""Orbits along a parameter, their special orbits, and cascades of period doublings.

A branch is followed by pseudo-arclength continuation: the predictor goes along the tangent, and the
corrector is Newton's method on the plane across it. Many branches, rows, are followed side by side.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.balls import Ball, brief, whole_number
from bouncing_ball_beyond.equations import (
    KINDS,
    MULTIPLIERS,
    OrbitEquations,
    OrbitNotFound,
    PeriodicOrbit,
    kind_named,
)
from bouncing_ball_beyond.forms import RESONANT
from bouncing_ball_beyond.march import (
    AT_GOAL,
    CLOSED,
    FIRST_STEP,
    Points,
    Start,
    ends_at,
    march,
    newton,
    tangents,
)
from bouncing_ball_beyond.one_ball import TURN
from bouncing_ball_beyond.paths import Path, path_of, usual_range
from bouncing_ball_beyond.search import near_instants, rows_of, shortest_contacts, single
from bouncing_ball_beyond.special_orbits import (
    GENERALIZED,
    Crossings,
    crossings_of,
    halved_at,
    located,
)
from bouncing_ball_beyond.starts import STARTS, Task
from bouncing_ball_beyond.tables import SINE, Table, check_table

SHARES = (0.5, 0.9, 0.2, 2.0, 4.0)
AROUND = (0.95, 0.8, 0.65, 0.5, 0.35, 1.5, 2.5)
"""Where `limits` looks for an orbit: in shares of the range between the saddle-node and the period
doubling of instants, and then at multiples of nπ, the saddle-node of instants with r = 0."""


@dataclass(frozen=True, eq=False, repr=False)
class FollowedBranch:
    """Orbits along a parameter, in order.

    Parameters
    ----------
    equations : OrbitEquations
    z : ndarray, shape (points, N)
        The orbits, as rows of the equations.
    special : tuple of PeriodicOrbit
        The special orbits in their order, without that at which the branch starts.
    start, end : str
        Where the branch starts, and why it ends.
    """

    equations: OrbitEquations
    z: NDArray
    special: tuple[PeriodicOrbit, ...]
    start: str
    end: str

    def __repr__(self) -> str:
        first, last = self.values[[0, -1]]
        kinds = ", ".join(f"{each.kind} at {each.z[-1]:.8g}" for each in self.special)
        rows = {
            "orbits": len(self),
            "impacts": self.impacts,
            "periods": self.periods,
            "along": f"{self.along}, {first:.6g} to {last:.6g}",
            "special orbits": kinds or "none",
            "start": self.start,
            "end": self.end,
        }
        return "\n".join(["FollowedBranch", *(f"  {name:16}{row}" for name, row in rows.items())])

    def __len__(self) -> int:
        return len(self.z)

    @property
    def impacts(self) -> int:
        """The number k of impacts of the orbits."""
        return self.equations.impacts

    @property
    def periods(self) -> int:
        """The number m of periods of the table in one period of the orbits."""
        return int(self.equations.periods)

    @property
    def along(self) -> str:
        """The name of what changes."""
        return self.equations.along[-1].name

    @property
    def values(self) -> NDArray:
        """The values of what changes, shape (points,)."""
        return self.z[:, -1]

    @cached_property
    def orbits(self) -> tuple[PeriodicOrbit, ...]:
        """The orbits one by one."""
        return tuple(self.equations.orbit(row) for row in self.z)

    @cached_property
    def stable(self) -> NDArray:
        """Whether the orbits are stable, shape (points,)."""
        return self.equations.stable(self.equations.linear(self.z))

    @cached_property
    def admissible(self) -> NDArray:
        """Whether a ball follows the orbits, shape (points,)."""
        return self.equations.admissible(self.z)

    def refined(self, spacing: float = 0.04) -> "FollowedBranch":
        """The branch with further orbits in between, so that lines through them have no corners.

        Orbits follow one another at most so far apart, as root mean square of the changes of the
        times and speeds of the impacts and as relative change of the parameter; but there are no
        more than 50 in a step of the branch. All are solved as those of the branch are.
        """
        if len(self) < 2:
            return self
        units = self.equations.scales(self.z[:-1])
        chords = np.diff(self.z, axis=0)
        counts = np.ceil(np.linalg.norm(chords / units, axis=1) / spacing).astype(int).clip(1, 50)
        which = np.repeat(np.arange(len(chords)), counts)
        share = np.concatenate([np.arange(count) / count for count in counts])[:, np.newaxis]
        guess = self.z[which] + share * chords[which]
        solution = newton(self.equations, guess, (chords / units**2)[which])
        good = solution.found | (share[:, 0] == 0)
        z = np.where(share == 0, guess, solution.z)[good]
        return replace(self, z=np.concatenate([z, self.z[-1:]]))

    def first(self, kind: str) -> PeriodicOrbit:
        """The first special orbit of a kind.

        Raises
        ------
        OrbitNotFound
            If the branch has none.
        """
        return self._first(kind_named(kind), "this branch; its special orbits are")

    def _first(self, kind: str, where: str) -> PeriodicOrbit:
        """The first special orbit of a kind, with spaces or hyphens in its name."""
        for each in self.special:
            if each.kind.replace("-", " ") == kind.replace("-", " ").lower():
                return each
        others = ", ".join(dict.fromkeys(each.kind for each in self.special)) or "none"
        raise OrbitNotFound(f"no {kind} on {where}: {others}")


def followed(
    start: Start, window: NDArray, until: Sequence[str | None] | NDArray, points: int, own: str
) -> list[FollowedBranch]:
    """Branches from their starts to a value of their parameter, with their special orbits.

    ``own`` is the kind of the special orbits at the starts, which are not listed.
    """
    steps = march(start, window, until, points)
    row = np.repeat(np.arange(len(steps)), [len(points.z) for points, _ in steps])
    every = zip(*(points for points, _ in steps), strict=True)
    z, slopes, tests, _ = (np.concatenate(each) for each in every)
    crossings = crossings_of(start.equations, row, z, slopes, tests)
    z, found = np.empty((2, 0))
    if len(crossings.row):
        z, found = located(start.equations, crossings)
    branches = []
    for i, (path, end) in enumerate(steps):
        equations = single(start.equations, i)
        passed = []
        for j in np.flatnonzero(crossings.row == i):
            kind = str(crossings.kind[j])
            number = crossings.number[j]
            here = z[j] if found[j] else None
            if kind == "period halving":
                here = _merged(equations, crossings.ends[:, j])
            if here is not None and not (number == 0 and kind == own):
                place = crossings.slopes[0, j] @ (here - crossings.ends[0, j])
                passed.append(_Passed(number, place, equations.orbit(here, kind)))
        orbits = path.z
        passed += _resonant(equations, path)
        passed.sort(key=lambda each: each[:2])
        last = _first_end([each for each in passed if ends_at(each.orbit.kind, until[i])])
        if last is not None:
            passed = [*(each for each in passed if each[:2] < last[:2]), last]
            orbits = np.vstack([orbits[: last.number + 1], last.orbit.z])
            end = f"{last.orbit.kind} at {_place(equations, orbits[-1])}"
            if last.orbit.kind in KINDS:
                end = ": ".join(filter(None, [end, KINDS[last.orbit.kind].end]))
        elif end in KINDS:
            # Newton's method does not find it, but it is between the last two points.
            end = f"{end} near {_place(equations, orbits[-1], 4)}: {KINDS[end].end}"
            orbits = orbits[:-1]
            passed = [each for each in passed if each.number + 1 < len(orbits)]
        else:
            end = _in_words(end, equations, orbits[-1], window[i], start.goal[i], passed)
            end += _in_words_of_symmetry(crossings, i, equations.along[-1].name)
        special = tuple(each.orbit for each in passed)
        branches.append(FollowedBranch(equations, orbits, special, "", end))
    return branches


def both_ways(
    equations: OrbitEquations,
    z: NDArray,
    direction: NDArray,
    window: NDArray,
    points: int,
    until: str | None = None,
    step: float = FIRST_STEP,
) -> list[FollowedBranch]:
    """A curve from one of its points, shape (1, N), along a direction and against it."""
    start = Start(
        equations,
        np.tile(z, (2, 1)),
        np.concatenate([direction, -direction]),
        np.full(2, np.nan),
        np.full(2, ""),
        step,
    )
    return followed(start, np.array([window, window]), [until, until], points, "")


def _merged(equations: OrbitEquations, ends: NDArray) -> NDArray | None:
    """Where orbits merge with those of half their period.

    Curves of saddle-nodes do so where the doubling of half the period is a generalized one.
    """
    if not equations.kind:
        return halved_at(equations, ends)
    half, near = equations.halved(ends)
    half = replace(half, kind="period doubling")
    start = newton(half, near.mean(axis=0, keepdims=True))
    if equations.kind != "saddle-node" or not start.found[0]:
        return None
    reach = float(np.linalg.norm((ends[1] - ends[0]) / equations.scales(ends[:1])[0]))
    window = start.z[0, half.size :] + reach * np.array([[-1.0], [1.0]])
    given = half, start.z, tangents(half, start.z), window, 20
    for curve in both_ways(*given, until=GENERALIZED, step=reach / 2):
        for each in curve.special:
            if each.kind == GENERALIZED:
                return half.doubled(each.z[np.newaxis])[1][0]
    return None


def _resonant(equations: OrbitEquations, path: Points) -> list:
    """The resonance at the end of a curve, if it ends with one."""
    if equations.kind not in MULTIPLIERS:
        return []
    column = equations.kinds.index(equations.kind)
    resonant = np.abs(path.tests[:, column]) < RESONANT
    if not resonant[-1] or resonant.all():
        return []
    orbit = equations.orbit(path.z[-1], equations.watched[column])
    return [_Passed(len(path.z) - 1, 0.0, orbit)]


class _Passed(NamedTuple):
    """A special orbit, the number of the step in which it is, and how far on this step."""

    number: int
    place: float
    orbit: PeriodicOrbit


def _first_end(ends: list[_Passed]) -> _Passed | None:
    """The first of the special orbits at which a branch ends, if there are any."""
    # Where a flight vanishes, an impact and a release do so at the same place.
    same = [each for each in ends if each.number == ends[0].number]
    same = [each for each in same if each.place < ends[0].place + 1e-6]
    watched = [*KINDS, GENERALIZED]
    return min(same, key=lambda each: watched.index(each.orbit.kind), default=None)


def _place(equations: OrbitEquations, z: NDArray, digits: int = 10) -> str:
    """The values of what changes."""
    values = zip(equations.along, z[equations.size :], strict=True)
    return ", ".join(f"{path.name} = {value:.{digits}g}" for path, value in values)


def _in_words(
    end: str,
    equations: OrbitEquations,
    z: NDArray,
    window: NDArray,
    goal: float,
    passed: list[_Passed],
) -> str:
    """Why a branch ends at an orbit that is not special."""
    if end == CLOSED:
        return end
    if end != AT_GOAL:
        return f"{end}; the last one is at {_place(equations, z)}"
    values = z[equations.size :]
    j = np.flatnonzero((values == window).any(axis=0))[-1]
    name = equations.along[j].name
    here = f"{name} = {values[j]:.10g}"
    if len(values) > 1 or abs(values[j] - goal) <= 1e-12 * abs(goal):
        return f"{here} is reached"
    folds = [each.orbit.z[-1] for each in passed if each.orbit.kind == "saddle-node"]
    turned = f": {name} = {goal:.10g} is beyond the saddle-node at {folds[0]:.10g}" if folds else ""
    return f"{here} is reached, on the other side of the start than the goal{turned}"


def _in_words_of_symmetry(crossings: Crossings, row: int, name: str) -> str:
    """Where a multiplier passes 1 and the parameter does not turn back, or ""."""
    at_one = (crossings.row == row) & (crossings.kind == "saddle-node")
    rising = crossings.slopes[..., -1]
    places = []
    for j in np.flatnonzero(at_one & (rising[0] * rising[1] > 0)):
        before, after = crossings.values[:, j]
        places.append(crossings.ends[:, j, -1] @ [after, -before] / (after - before))
    if not places:
        return ""
    near = ", ".join(f"{place:.3g}" for place in places)
    return (
        f"; near {name} = {near} a multiplier passes 1 without a saddle-node: there orbits of less"
        " symmetry branch off"
    )


def follow(
    orbit: Any, *, along: str | Path | None = None, to: Any = None, points: int = 500
) -> Any:
    """The branch of a periodic orbit along a parameter, or the branches of many, side by side.

    From an ordinary orbit and from the grazing of a release the branch through it is followed; from
    a saddle-node the branch that is stable there; from a period doubling that of twice the period;
    from a period halving that of half the period; from the grazing of a flight that with one impact
    more. At other special orbits branches end.

    Parameters
    ----------
    orbit : PeriodicOrbit, or a sequence of PeriodicOrbit and OrbitNotFound
    along : str or Path, optional
        "amplitude", a parameter of the ball, "frequency" (that of a table with a fixed stroke,
        Ω/√(g/a) = √Λ, along which the ball's parameters change as well), or a `ParameterPath`. By
        default what changed on the branch of the orbit, and otherwise the amplitude.
    to : float, array_like or tuple of two floats, optional
        The value at which a branch ends; an array has one for each orbit. Behind a saddle-node the
        parameter moves back, at most as far beyond its first value. With a tuple (low, high) the
        branch is followed both ways. By default the parameter rises to the end of its
        range, or to ten times its value and at least 10; a phase by one turn.
    points : int
        The largest number of orbits on a branch, of each direction.

    Returns
    -------
    FollowedBranch, or a list of FollowedBranch and OrbitNotFound
        A list for a sequence; in place of a branch it has the reason why there is none.

    Raises
    ------
    OrbitNotFound
        If there is no branch from a single orbit: for example, if `to` is on the side of a period
        doubling on which there are no doubled orbits.
    ValueError
        If the parameter is unknown, or `to` out of its range.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid, orbit
    >>> branch = follow(orbit(Rigid(0.5), amplitude=1.4), to=1.8)
    >>> [(each.kind, round(each.amplitude, 6)) for each in branch.special]
    [('period doubling', 1.526824)]
    """
    many = not isinstance(orbit, PeriodicOrbit)
    wanted = "a periodic orbit, such as orbit(ball, amplitude=1.0), or a list of them"
    orbits = _listed(orbit, "orbit", wanted) if many else [orbit]
    points = whole_number("points", points, 2)
    found = _follow_all(orbits, along, to, points, np.full(len(orbits), None))
    if not many and isinstance(found[0], OrbitNotFound):
        raise found[0]
    return found if many else found[0]


def cascade(doubling: Any, *, to: Any, impacts: int = 64) -> Any:
    """The branches of a cascade of period doublings, each up to the doubling where the next begins.

    Parameters
    ----------
    doubling : PeriodicOrbit, or a sequence of PeriodicOrbit and OrbitNotFound
        Period doublings.
    to : float or array_like
        A value of the parameter beyond which nothing is followed.
    impacts : int
        The largest number of impacts of an orbit. The doubling of orbits with that many impacts is
        included: their branch is followed up to it.

    Returns
    -------
    list of FollowedBranch, or a list of such lists
        For a sequence; an OrbitNotFound in place of a doubling is one in its place.

    Raises
    ------
    OrbitNotFound
        If there is no doubled orbit towards `to`.
    ValueError
        If `doubling` is no orbit and no list of them.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid, orbit
    >>> branch = follow(orbit(Rigid(0.5), amplitude=1.4), to=1.8)
    >>> branches = cascade(branch.first("period doubling"), to=1.8, impacts=4)
    >>> [(each.impacts, each.special[-1].kind) for each in branches]
    [(2, 'period doubling'), (4, 'period doubling')]
    """
    if isinstance(doubling, PeriodicOrbit):
        branches = cascade([doubling], to=to, impacts=impacts)[0]
        if isinstance(branches, OrbitNotFound):
            raise branches
        return branches
    impacts = whole_number("impacts", impacts, 2)
    latest = _listed(
        doubling,
        "doubling",
        "a period doubling, such as branch.first('period doubling'), or a list of them",
    )
    whole = [[] if isinstance(each, PeriodicOrbit) else each for each in latest]
    if np.ndim(to) and len(to) != len(latest):
        raise ValueError(f"to: has {len(to)} values for {len(latest)} orbits")
    to = np.broadcast_to(np.asarray(to, float), len(latest))
    going = [i for i, each in enumerate(latest) if isinstance(each, PeriodicOrbit)]
    while going := [i for i in going if 2 * latest[i].impacts <= impacts]:
        until = np.full(len(going), "period doubling")
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
    return whole


def _listed(given: Any, name: str, wanted: str) -> list:
    """Several orbits as a list; ValueError with one line for anything else."""
    found = list(given) if isinstance(given, Iterable) else [given]
    if not all(isinstance(each, PeriodicOrbit | OrbitNotFound) for each in found):
        raise ValueError(f"{name} = {brief(given)}: must be {wanted}")
    return found


def _follow_all(
    orbits: list, along: str | Path | None, to: Any, points: int, until: NDArray
) -> list:
    """Branches of orbits, or reasons, in order; orbits with the same equations side by side."""
    found = list(orbits)
    several = 2 if isinstance(to, tuple) else len(found)
    if to is not None and np.shape(to) not in ((), (several,)):
        raise ValueError(
            f"to = {brief(to)}: must be a number, a tuple (low, high), or one number for each orbit"
        )
    groups: list = []
    for i, each in enumerate(orbits):
        if not isinstance(each, PeriodicOrbit):
            continue
        path = each.equations.along[-1] if along is None else path_of(along, each.ball, each.table)
        goal = to if isinstance(to, tuple) or np.ndim(to) == 0 else to[i]
        task = _task(each, path, goal, until[[i]])
        same_ball = each.ball.at(**dict.fromkeys(each.ball.parameters, 0.0))
        same_table = each.table.at(**dict.fromkeys(each.table.parameters, 0.0))
        key = type(each.equations), each.kind, path, each.impacts, same_ball, same_table
        same = next((rows for other, rows in groups if other == key), None)
        if same is None:
            groups.append((key, same := []))
        same.append((i, task))
    for (_, kind, *_), rows in groups:
        together = _stacked([task for _, task in rows])
        parts = _from_special(together, kind, points)
        for (i, _), *branches in zip(rows, *parts, strict=True):
            found[i] = _joined(branches)
    return found


def _task(orbit: PeriodicOrbit, path: Path, to: Any, until: NDArray) -> Task:
    """What is to be followed from one orbit, as one row.

    Raises
    ------
    ValueError
        If a goal is out of its range, or the orbit not on the path.
    """
    equations, z = orbit.on(path)
    value = float(z[-1])
    low, high = (float(each) for each in path.limits(orbit.ball, orbit.amplitude))
    if to is None:
        turn = path.name.startswith("phase_")
        to = value + TURN if turn else usual_range(path, value, low, high)[1]
    goals = np.atleast_1d(np.asarray(to, float))
    for goal in goals:
        if not (low <= goal <= high and np.isfinite(goal)):
            raise ValueError(f"to = {goal:g}: {path.name} must be in [{low:g}, {high:g}]")
    if len(goals) == 2 and not goals[0] <= value <= goals[1]:
        raise ValueError(f"to = {to}: {path.name} = {value:.10g} of the orbit must be between them")
    return Task(equations, z[np.newaxis], goals[np.newaxis], np.array([[low, high]]), until)


def _stacked(tasks: list[Task]) -> Task:
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


def _from_special(task: Task, kind: str, points: int) -> list[list]:
    """Branches from orbits of one kind, or the reasons for none, a list for each of their goals."""
    if kind not in STARTS:
        return [[OrbitNotFound("branches end at a special orbit of this kind")] * len(task.z)]
    ways = task.goals.shape[1]
    start = _side_by_side([STARTS[kind](task, way) for way in range(ways)])
    row = np.tile(np.arange(len(task.z)), ways)
    name = task.equations.along[-1].name
    found: list = [OrbitNotFound(reason) for reason in start.reasons]
    going = np.flatnonzero(start.reasons == "")
    if going.size:
        # The parameter stays between the goal and a value as far behind the start.
        behind = np.clip(2 * task.z[row, -1] - start.goal, *task.limits[row].T)
        window = np.sort(np.stack([start.goal, behind], axis=-1), axis=-1)[going, :, np.newaxis]
        branches = followed(start.take(going), window, task.until[row[going]], points, kind)
        for i, branch in zip(going, branches, strict=True):
            path = branch.z if start.origin is None else np.vstack([start.origin[i], branch.z])
            text = f"{kind or 'an orbit'} at {name} = {task.z[row[i], -1]:.10g}"
            found[i] = replace(branch, z=path, start=text)
    return [found[way * len(task.z) : (way + 1) * len(task.z)] for way in range(ways)]


def _side_by_side(starts: list[Start]) -> Start:
    """The starts of both ways as rows."""
    first = starts[0]
    if len(starts) == 1:
        return first
    columns = {
        name: np.concatenate([getattr(each, name) for each in starts])
        for name, value in first._asdict().items()
        if np.ndim(value)
    }
    rows = np.tile(np.arange(len(first.z)), len(starts))
    return first._replace(equations=first.equations.rows(rows), **columns)


def _joined(parts: list) -> Any:
    """A branch that is followed both ways, or the one part that there is."""
    branches = [each for each in parts if not isinstance(each, OrbitNotFound)]
    if len(branches) < 2:
        return branches[0] if branches else parts[0]
    back, forth = branches
    return replace(
        forth,
        z=np.concatenate([back.z[:0:-1], forth.z]),
        special=(*back.special[::-1], *forth.special),
        start=back.end,
    )


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
    """The saddle-node and the period doubling of the n-T orbits of a ball.

    An orbit is followed towards smaller and greater Λ. An elastic ball has orbits down to Λ = 0,
    and no saddle-node. The orbits of other balls may end otherwise, for example with the grazing of
    an impact if ζ > 1. In place of a limit there is then an OrbitNotFound with the reason.

    Parameters
    ----------
    ball : Ball
        Its parameters are numbers or arrays.
    n : array_like of int
    table : Table
        The waveform of the table, by default a sine. On other tables these are the orbits on both
        sides of the phase at which the table rises fastest.

    Returns
    -------
    Limits, or a list of Limits
        A list if an argument is an array.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> round(limits(Rigid(0.5)).saddle_node.amplitude, 6)
    1.047198
    """
    check_table(table)
    row, (periods,), shape = rows_of(ball, n=n)
    between = _between_limits(OrbitEquations(row, 1, periods, table=table))
    both = np.repeat(["saddle-node", "period doubling"], len(between))
    to = [1e-6] * len(between) + [None] * len(between)
    branches = _follow_all(between * 2, "amplitude", to, 500, both)
    found = []
    for below, above in zip(branches[: len(between)], branches[len(between) :], strict=True):
        if isinstance(below, OrbitNotFound):
            found.append(Limits(below, below))
            continue
        special = (*below.special[::-1], *above.special)
        fold = _limit(special, "saddle-node", below.end)
        found.append(Limits(fold, _limit(special, "period doubling", above.end)))
    return found if shape else found[0]


def _limit(special: Sequence, kind: str, end: str) -> PeriodicOrbit | OrbitNotFound:
    """The first special orbit of a kind, or the reason why there is none: how the branch ends."""
    of_kind = (each for each in special if each.kind == kind)
    return next(of_kind, OrbitNotFound(f"no {kind} before the branch ends: {end}"))


def _between_limits(equations: OrbitEquations) -> list:
    """An orbit with one impact for each row, if possible between the limits of instants.

    A ball follows it, wherever such an orbit is found at one of the amplitudes. Newton's method may
    lead to another branch instead, such as one on which the ball never leaves; then it is the one
    with the shortest contact among all orbits.
    """
    n = np.asarray(equations.periods)
    r = equations.ball.signature(1.5 * np.pi * n).restitution
    r = np.where(np.isfinite(r), r, 0.5)
    table = equations.table
    fold = np.pi * n * (1 - r) / (1 + r)
    rise = 2 * (1 + r * r) / (1 + r) ** 2
    # Instants at ΛW′ = fold and -ΛW″ = share · rise.
    push = np.multiply.outer(SHARES, rise)
    phase = table.phase_of_angle(np.arctan2(push, fold))
    size = np.hypot(table(phase, 1), table(phase, 2))
    amplitudes = [*(np.hypot(fold, push) / size)]
    found: list = [OrbitNotFound("no orbit with one impact is found")] * len(n)
    followed = np.zeros(len(n), bool)

    for amplitude in amplitudes:
        left = np.flatnonzero(~followed)
        if not left.size:
            return found
        rows = equations.rows(left)
        z, good, linear = near_instants(rows, amplitude[left], 1)
        followed[left] = good & rows.admissible(z, linear)
        for i, row in enumerate(left):
            if good[i] and (followed[row] or isinstance(found[row], OrbitNotFound)):
                found[row] = PeriodicOrbit(single(rows, i), z[i])
    around = [times * np.pi * n / table.slope for times in AROUND]
    for amplitude in [*amplitudes, *around]:
        left = np.flatnonzero(~followed)
        if not left.size:
            return found
        searched = shortest_contacts(equations.rows(left), amplitude[left], 1)
        for row, orbits in zip(left, searched, strict=True):
            followed[row] = bool(orbits) and orbits[0].admissible
            if orbits and (followed[row] or isinstance(found[row], OrbitNotFound)):
                found[row] = orbits[0]
    return found
