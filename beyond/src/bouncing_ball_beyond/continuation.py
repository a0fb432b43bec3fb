"""Orbits along a parameter, their special orbits, and cascades of period doublings.

A branch is followed by pseudo-arclength continuation: the predictor goes along the tangent, and the
corrector is Newton's method on the plane across it. Many branches, rows, are followed side by side.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.balls import Ball
from bouncing_ball_beyond.equations import Linear, OrbitEquations, newton, solve_bordered
from bouncing_ball_beyond.forms import one_impact_more
from bouncing_ball_beyond.orbits import (
    OrbitNotFound,
    PeriodicOrbit,
    near_instants,
    rows_of,
    shortest_contacts,
    single,
)
from bouncing_ball_beyond.paths import Path, path_of

FIRST_STEP = 0.1
LONGEST_STEP = 0.4
SHORTEST_STEP = 1e-9
"""Lengths of steps: changes of the unknowns, root mean square over the impacts, and relative ones of
the parameter."""

STRAIGHT = 0.95
"""The least cosine of the angle between the tangents at the ends of a step."""

TURN = 0.3
"""The largest change of arctan(tr/(1 + det)) in a step, so that no two bifurcations hide in it."""


NEAREST = 1e-9
"""Relative distance from a period doubling below which doubled orbits are not told apart: at a distance
ξ, rounding errors of the orbits are eps/ξ², and ξ² is proportional to the change of the parameter."""


class Kind(NamedTuple):
    """A kind of special orbit.

    ``test`` is zero there, a function of the equations, orbits and their derivatives; ``end`` says why
    branches end there, and is empty if they go on.
    """

    test: Callable[[OrbitEquations, NDArray, Linear], NDArray]
    end: str


KINDS = {
    "saddle-node": Kind(lambda equations, z, linear: 1 - equations.turn(linear), ""),
    "period doubling": Kind(lambda equations, z, linear: 1 + equations.turn(linear), ""),
    "grazing of a flight": Kind(lambda equations, z, linear: equations.clearance(z), ""),
    "grazing of a release": Kind(lambda equations, z, linear: equations.contact_clearance(z), ""),
    "period halving": Kind(
        lambda equations, z, linear: equations.halving(z),
        "the orbit merges with one of half its period",
    ),
    "vanishing flight": Kind(
        lambda equations, z, linear: linear.flights.min(axis=1),
        "the contacts before and after a flight merge",
    ),
    "grazing of an impact": Kind(
        lambda equations, z, linear: equations.least_speed(z),
        "an impact vanishes, because the ball lands with the speed of the table",
    ),
    "lost release": Kind(
        lambda equations, z, linear: equations.least_release(linear, z),
        "the ball no longer leaves the table as a contact ends",
    ),
}
"""The kinds of special orbits of a branch, by name."""


def tests_on_the_way(equations: OrbitEquations, z: NDArray, linear: Linear) -> dict[str, NDArray]:
    """The tests that cost little, or that end a branch, by kind."""
    turn = equations.turn(linear)
    return {
        "saddle-node": 1 - turn,
        "period doubling": 1 + turn,
        "grazing of an impact": equations.least_speed(z),
        "lost release": equations.least_release(linear, z),
        "vanishing flight": linear.flights.min(axis=1),
    }


def kind_named(name: str) -> str:
    """The name of a kind that is written with spaces or hyphens.

    Raises
    ------
    ValueError
        If there is none.
    """
    plain = {kind.replace("-", " "): kind for kind in KINDS}
    found = plain.get(str(name).replace("-", " ").lower())
    if found is None:
        raise ValueError(f"kind = {name!r}: must be one of {', '.join(KINDS)}")
    return found


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

    def __repr__(self):
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

    def __len__(self):
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
        return tuple(PeriodicOrbit(self.equations, row) for row in self.z)

    @cached_property
    def stable(self) -> NDArray:
        """Whether the orbits are stable, shape (points,)."""
        trace, determinant = self.equations.trace_and_determinant(self.equations.linear(self.z))
        return (np.abs(trace) < 1 + determinant) & (determinant < 1 + 1e-9)

    @cached_property
    def admissible(self) -> NDArray:
        """Whether a ball follows the orbits, shape (points,)."""
        return self.equations.admissible(self.z)

    def first(self, kind: str) -> PeriodicOrbit:
        """The first special orbit of a kind.

        Raises
        ------
        OrbitNotFound
            If the branch has none.
        """
        name = kind_named(kind)
        for each in self.special:
            if each.kind == name:
                return each
        others = ", ".join(dict.fromkeys(each.kind for each in self.special)) or "none"
        raise OrbitNotFound(f"no {name} on this branch; its special orbits are: {others}")


class _Start(NamedTuple):
    """Where branches start, by rows.

    The orbits z and the directions from there; the first steps; the values of the parameter that are
    to be reached, and windows in which it stays, shape (rows, 2); the special orbits before z, if
    there are any; and the reasons for no branch, "" if there is one.
    """

    equations: OrbitEquations
    z: NDArray
    direction: NDArray
    step: NDArray
    goal: NDArray
    window: NDArray
    origin: NDArray | None
    reasons: NDArray


def scales(equations: OrbitEquations, z: NDArray) -> NDArray:
    """Units of the unknowns in which steps are measured, shape (rows, N)."""
    units = np.full(z.shape, np.sqrt(equations.impacts))
    units[:, equations.size :] = np.maximum(np.abs(z[:, equations.size :]), 1e-2)
    return units


def tangents(equations: OrbitEquations, z: NDArray) -> NDArray:
    """Directions of the curves of orbits through z, also where the parameter turns back; (rows, N)."""
    normal = np.ones(z.shape)
    for _ in range(2):
        normal = newton(equations, z, normal, iterations=1).tangent
        normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    return normal


class _Steps(NamedTuple):
    """The accepted points of one row: orbits, tangents, tests on the way, and why it stopped."""

    z: NDArray
    tangents: NDArray
    tests: dict[str, NDArray]
    end: str


def _march(start: _Start, points: int, until: str | None) -> list[_Steps]:
    """Accepted steps of branches until their parameter leaves its window, or until they end.

    A step is halved if Newton's method fails, if the tangent turns, or if the multipliers change too
    much. A step that leads to an end of the window ends exactly there.
    """
    rows, equations = len(start.z), start.equations
    units = scales(equations, start.z)
    z, t, step = start.z.copy(), _unit(start.direction / units), start.step.copy()
    linear = equations.linear(z)
    tests = tests_on_the_way(equations, z, linear)
    halves = equations.halves(z)
    tests["period halving"] = np.linalg.norm(halves, axis=1)
    history = [_Visited(np.ones(rows, bool), z, t, tests)]
    count, end, farthest = np.ones(rows, int), np.full(rows, "", object), np.zeros(rows)
    active, part = np.arange(rows), equations
    while active.size:
        unit, here, ahead, before = units[active], z[active], t[active], step[active]
        low, high = start.window[active].T
        rate = ahead[:, -1] * unit[:, -1]
        target = np.where(rate > 0, high, low)
        with np.errstate(divide="ignore", invalid="ignore"):
            whole = (target - here[:, -1]) / rate
        last = whole <= before
        length = np.where(last, whole, before)
        guess, normal = here + length[:, np.newaxis] * ahead * unit, ahead / unit
        guess[last, -1], normal[last] = target[last], 0.0
        normal[last, -1] = np.sign(rate[last])
        solution = newton(part, guess, normal, iterations=7)
        new, following = solution.z, _unit(solution.tangent / unit)
        new[last, -1] = target[last]
        with np.errstate(all="ignore"):
            values = tests_on_the_way(part, new, solution.linear)
            change = _change_of_angle(values["period doubling"], tests["period doubling"][active])
            cosine = np.sum(following * ahead, axis=1)
            moved = np.linalg.norm((new - guess) / unit, axis=1)
            outside = (new[:, -1] < low) | (new[:, -1] > high)
            good = solution.found & (cosine > STRAIGHT) & (moved < 0.4 * length) & ~outside
            good &= (change < TURN) | (length < 1e-6)
            apart = part.halves(new)
            merged = np.sum(apart * halves[active], axis=1) < 0
        sign = np.where(merged, -1, 1) * np.sign(tests["period halving"][active])
        values["period halving"] = sign * np.linalg.norm(apart, axis=1)
        ends = _ends_on_the_way(tests, values, active, until)
        ends[(ends == "") & last] = _AT_GOAL
        taken = np.flatnonzero(good)
        accepted = active[taken]
        end[accepted] = ends[taken]
        step[active[~good]] = length[~good] / 2
        easy = (cosine > 0.99) & (change < TURN / 2)
        step[accepted] = np.minimum(np.where(easy, 2.0, 1.0)[taken] * before[taken], LONGEST_STEP)
        z, t, halves = z.copy(), t.copy(), halves.copy()
        z[accepted], t[accepted], halves[accepted] = new[taken], following[taken], apart[taken]
        tests = {name: value.copy() for name, value in tests.items()}
        for name, value in tests.items():
            value[accepted] = values[name][taken]
        count[accepted] += 1
        away, same_way = _from_start(start, z, t, units)
        closed = same_way & (np.linalg.norm(away, axis=1) < step / 2) & (farthest > 2 * step)
        farthest = np.maximum(farthest, np.linalg.norm(away, axis=1))
        end[closed & (end == "")] = _CLOSED
        end[(count >= points) & (end == "")] = f"all {points} points are used"
        end[(step < SHORTEST_STEP) & (end == "")] = "no further orbit is found"
        history.append(_Visited(np.isin(np.arange(rows), accepted), z, t, tests))
        still = end[active] == ""
        if not still.all():
            active = active[still]
            part = equations.rows(active)
    return [_row_of(history, units, end, i) for i in range(rows)]


_AT_GOAL = "the end of the window"
_CLOSED = "the branch is closed: it is back at its start"


class _Visited(NamedTuple):
    """All rows after a step, and which of them have moved."""

    moved: NDArray
    z: NDArray
    t: NDArray
    tests: dict[str, NDArray]


def _unit(vectors: NDArray) -> NDArray:
    """Rows of the length 1."""
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def _change_of_angle(new: NDArray, old: NDArray) -> NDArray:
    """Changes of arctan(tr/(1 + det)), for tests of period doublings; a pole of it is no obstacle."""
    change = np.abs(np.arctan(new - 1) - np.arctan(old - 1))
    return np.minimum(change, np.pi - change)


def _ends_on_the_way(tests, values, active, until) -> NDArray:
    """Why the rows end in a step, "" where they go on."""
    ends = np.full(len(active), "", object)
    for name, value in values.items():
        if KINDS[name].end or name == until:
            ends[tests[name][active] * value < 0] = name
    return ends


def _from_start(start: _Start, z, t, units) -> tuple[NDArray, NDArray]:
    """How far branches are from their starts, up to whole turns, and whether they go the same way."""
    away = z - start.z
    turns = 2 * np.pi * np.round(away[:, [0]] / (2 * np.pi))
    away[:, : start.equations.size : start.equations.unknowns] -= turns
    same_way = np.sum(t * _unit(start.direction / units), axis=1) > STRAIGHT
    return away / units, same_way


def _row_of(history: list[_Visited], units, end, i) -> _Steps:
    """The accepted steps of one row; a closed branch ends exactly at its start."""
    taken = [each for each in history if each.moved[i]]
    if end[i] == _CLOSED:
        ahead = taken[0].t[i] @ ((taken[-1].z[i] - taken[0].z[i]) / units[i]) > 0
        taken = [*(taken[:-1] if ahead else taken), taken[0]]
    tests = {name: np.array([each.tests[name][i] for each in taken]) for name in taken[0].tests}
    z = np.array([each.z[i] for each in taken])
    t = np.array([each.t[i] * units[i] for each in taken])
    return _Steps(z, t, tests, end[i])


class _Crossings(NamedTuple):
    """Steps in which a test changes its sign: row, number of the step, kind, ends and their tests."""

    row: NDArray
    number: NDArray
    kind: NDArray
    ends: NDArray
    slopes: NDArray
    values: NDArray


def _crossings(equations, steps: list[_Steps]) -> _Crossings:
    """All steps of all rows in which a test changes its sign."""
    row = np.repeat(np.arange(len(steps)), [len(each.z) for each in steps])
    z, t = (
        np.concatenate([each.z for each in steps]),
        np.concatenate([each.tangents for each in steps]),
    )
    tests = {name: np.concatenate([each.tests[name] for each in steps]) for name in steps[0].tests}
    tests["saddle-node"] = 2 - tests["period doubling"]
    all_rows = equations.rows(row)
    tests["grazing of a flight"] = all_rows.clearance(z)
    tests["grazing of a release"] = all_rows.contact_clearance(z)
    names = np.array(list(tests))
    values = np.array(list(tests.values()))
    number = np.arange(len(z))
    within = row[1:] == row[:-1]
    # Where tr/(1 + det) has a pole, it changes its sign without passing 1 or -1.
    turn = np.arctan(tests["period doubling"] - 1)
    pole = np.abs(np.diff(turn)) > np.pi / 2
    by_turn = np.isin(names, ["saddle-node", "period doubling"])[:, np.newaxis]
    crossed = (values[:, :-1] * values[:, 1:] < 0) & within & ~(by_turn & pole)
    which, at = np.nonzero(crossed)
    return _Crossings(
        row[at],
        number[at],
        names[which],
        np.stack([z[at], z[at + 1]]),
        np.stack([t[at], t[at + 1]]),
        np.stack([values[which, at], values[which, at + 1]]),
    )


def _cubic(part, ends, slopes):
    """Hermite's cubic between the ends of steps, whose slopes are per unit of the part of the step."""
    x = part[:, np.newaxis]
    chord = ends[1] - ends[0]
    bend = slopes[0] + slopes[1] - 2 * chord
    return ends[0] + x * (slopes[0] + x * (chord - slopes[0] - bend + x * bend))


def _values_of_kinds(equations, kinds, solution) -> NDArray:
    """The tests of orbits, each that of its kind."""
    values = np.zeros(len(kinds))
    for name in np.unique(kinds):
        these = kinds == name
        linear = Linear(*(each[these] for each in solution.linear))
        values[these] = KINDS[name].test(equations.rows(these), solution.z[these], linear)
    return values


@np.errstate(all="ignore")
def _located(equations, crossings: _Crossings) -> tuple[NDArray, NDArray]:
    """The orbits at which the tests are zero, and which of them were found.

    The zero is bracketed along the chord of each step, by the rule of Anderson and Björck (BIT 13,
    253, 1973); the orbits are on the planes across the chord.
    """
    equations = equations.rows(crossings.row)
    ends, values = crossings.ends.copy(), crossings.values.copy()
    units = scales(equations, ends[0])
    chord = (ends[1] - ends[0]) / units
    normal = chord / units / np.sum(chord**2, axis=1, keepdims=True)
    place = np.array([np.zeros(len(chord)), np.ones(len(chord))])
    slopes = crossings.slopes / np.sum(normal * crossings.slopes, axis=2, keepdims=True)
    weights = values.copy()
    # The equations are singular at a period halving, which is found by those of half the period.
    found = crossings.kind != "period halving"
    each, latest = np.arange(len(chord)), np.full(len(chord), -1)
    z = _cubic(weights[0] / (weights[0] - weights[1]), ends, slopes)
    for _ in range(60):
        step = place[1] - place[0]
        part = weights[0] / (weights[0] - weights[1])
        solution = newton(equations, _cubic(part, ends, slopes * step[:, np.newaxis]), normal)
        found &= solution.found
        z = np.where(found[:, np.newaxis], solution.z, z)
        value = _values_of_kinds(equations, crossings.kind, solution)
        side = (value * values[1] > 0).astype(int)
        again = side == latest
        ratio = 1 - value / values[side, each]
        weights[1 - side, each] *= np.where(again, np.where(ratio > 0, ratio, 0.5), 1.0)
        moved = np.abs(place[0] + part * step - place[side, each])
        place[side, each] = place[0] + part * step
        values[side, each], weights[side, each] = value, value
        ends[side, each], slopes[side, each] = solution.z, solution.tangent
        latest = side
        if ((np.abs(value) < 1e-13) | (moved < 1e-14) | ~found).all():
            break
    smallest = np.abs(crossings.values).max(axis=0)
    return z, found & (np.abs(value) < 1e-6 * np.maximum(smallest, 1e-3))


def _followed(start: _Start, points, until, own) -> list[FollowedBranch]:
    """Branches from their starts to a value of their parameter, with their special orbits.

    ``own`` is the kind of the special orbits at the starts, which are not listed.
    """
    equations = start.equations
    steps = _march(start, points, until)
    crossings = _crossings(equations, steps)
    z, found = _located(equations, crossings) if len(crossings.row) else (None, None)
    first = np.cumsum([0, *(len(each.z) for each in steps)])
    branches = []
    for i, each in enumerate(steps):
        alone, passed = single(equations, i), []
        for j in np.flatnonzero(crossings.row == i):
            kind, number = str(crossings.kind[j]), int(crossings.number[j] - first[i])
            here = z[j] if found[j] else None
            if kind == "period halving":
                here = _halved_at(alone, crossings.ends[:, j])
            if here is not None and not (number == 0 and kind == own):
                place = np.sum(crossings.slopes[0, j] * (here - crossings.ends[0, j]))
                passed.append((number, place, PeriodicOrbit(alone, here, kind)))
        passed.sort(key=lambda entry: entry[:2])
        ending = [n for n, entry in enumerate(passed) if _ends_at(entry[2].kind, until)]
        path, near = each.z, np.nan
        if each.end in KINDS and not ending:
            # The equations are singular where a flight vanishes.
            path, near = each.z[:-1], z[np.flatnonzero(crossings.row == i)[-1], -1]
            passed = [entry for entry in passed if entry[0] + 1 < len(path)]
        special = [entry[2] for entry in passed]
        if ending:
            number, _, last = passed[ending[0]]
            special = special[: ending[0] + 1]
            path = np.concatenate([path[: number + 1], last.z[np.newaxis]])
        if each.end in KINDS and not ending:
            end = f"{each.end} near {alone.along[-1].name} = {near:.4g}: {KINDS[each.end].end}"
        else:
            end = _end_in_words(each.end, alone, special, path, float(start.goal[i]), bool(ending))
        branches.append(FollowedBranch(alone, path, tuple(special), "", end))
    return branches


def _ends_at(kind: str, until: str | None) -> bool:
    """Whether a branch ends at a kind of special orbit."""
    return kind == until or KINDS[kind].end != ""


def _end_in_words(end, equations, special, path, goal, at_special) -> str:
    """Why a branch ends."""
    name, value = equations.along[-1].name, path[-1, -1]
    here = f"{name} = {value:.10g}"
    if at_special:
        reason = KINDS[special[-1].kind].end
        return f"{special[-1].kind} at {here}" + (f": {reason}" if reason else "")
    if end == _CLOSED:
        return end
    if end != _AT_GOAL:
        return f"{end}; the last one is at {here}"
    if abs(value - goal) <= 1e-12 * abs(goal):
        return f"{here} is reached"
    folds = [each.z[-1] for each in special if each.kind == "saddle-node"]
    turned = f": {name} = {goal:.10g} is beyond the saddle-node at {folds[0]:.10g}" if folds else ""
    return f"{here} is reached, as far behind the start as the goal is ahead of it{turned}"


def test_with_gradient(equations: OrbitEquations, kind: str, z: NDArray) -> tuple[NDArray, NDArray]:
    """The test of a kind of special orbit, shape (rows,), and its gradient, shape (rows, N).

    The gradient is a central difference. Its errors, some 1e-10, slow Newton's method down a little
    and do not move what it finds.
    """
    rows, length = z.shape
    shift = 1e-6 * np.maximum(1.0, np.abs(z))
    nudges = shift[:, np.newaxis] * np.eye(length)
    nearby = np.concatenate([z[:, np.newaxis] + nudges, z[:, np.newaxis] - nudges], axis=1)
    nearby = nearby.reshape(-1, length)
    each = equations.rows(np.repeat(np.arange(rows), 2 * length))
    values = KINDS[kind].test(each, nearby, each.linear(nearby)).reshape(rows, 2, length)
    gradient = (values[:, 0] - values[:, 1]) / (2 * shift)
    return KINDS[kind].test(equations, z, equations.linear(z)), gradient


@np.errstate(all="ignore")
def special_near(
    equations: OrbitEquations, kind: str, z: NDArray, iterations: int = 20
) -> tuple[NDArray, NDArray]:
    """Special orbits of a kind near guesses, shape (rows, N), and which of them are found.

    Newton's method for the equations of orbits together with the test of the kind.
    """
    found = np.zeros(len(z), bool)
    for _ in range(iterations):
        legs, jacobian = equations.residuals(z)
        value, gradient = test_with_gradient(equations, kind, z)
        matrix = np.concatenate([jacobian, gradient[:, np.newaxis]], axis=1)
        right = np.concatenate([legs, value[:, np.newaxis]], axis=1)
        finite = np.isfinite(matrix).all(axis=(1, 2)) & np.isfinite(right).all(axis=1)
        matrix[~finite] = np.eye(z.shape[1])
        step = np.linalg.solve(matrix, right[..., np.newaxis])[..., 0]
        z = np.where(finite[:, np.newaxis], z - step, np.nan)
        found = finite & (np.abs(step).max(axis=1) < 1e-11 * (1 + np.abs(z).max(axis=1)))
        if (found | ~finite).all():
            break
    return z, found


def halves_of(equations: OrbitEquations, z: NDArray) -> tuple[OrbitEquations, NDArray]:
    """The equations of half the period, and the mean of the halves of orbits."""
    k = equations.impacts // 2
    half = replace(equations, impacts=k, periods=np.asarray(equations.periods) // 2)
    x = z[:, : equations.size].reshape(len(z), 2 * k, -1).copy()
    x[:, k:, 0] -= 2 * np.pi * np.reshape(half.periods, (-1, 1))
    mean = ((x[:, :k] + x[:, k:]) / 2).reshape(len(z), -1)
    return half, np.concatenate([mean, z[:, equations.size :]], axis=1)


def doubled_of(equations: OrbitEquations, z: NDArray) -> tuple[OrbitEquations, NDArray]:
    """The equations of twice the period, and orbits taken twice."""
    twice = replace(
        equations, impacts=2 * equations.impacts, periods=2 * np.asarray(equations.periods)
    )
    x = z[:, : equations.size].reshape(len(z), equations.impacts, -1)
    again = x.copy()
    again[..., 0] += 2 * np.pi * np.reshape(equations.periods, (-1, 1))
    both = np.concatenate([x, again], axis=1).reshape(len(z), -1)
    return twice, np.concatenate([both, z[:, equations.size :]], axis=1)


def _halved_at(equations: OrbitEquations, ends: NDArray) -> NDArray | None:
    """Where orbits merge with those of half their period: the period doubling of these, taken twice.

    The equations of the longer orbit are singular there, those of the shorter one are not.
    """
    half, near = halves_of(equations, ends)
    z = near.mean(axis=0, keepdims=True)
    solution, found = special_near(half, "period doubling", z)
    if not found[0]:
        return None
    _, twice = doubled_of(half, solution)
    x = twice[0].copy()
    turns = 2 * np.pi * np.round((ends[0, 0] - x[0]) / (2 * np.pi))
    x[: equations.size : equations.unknowns] += turns
    units = scales(equations, ends[:1])[0]
    reach = np.abs((ends[1] - ends[0]) / units).max()
    return x if np.abs((x - ends[0]) / units).max() < 3 * reach else None


def _flip(equations: OrbitEquations, z: NDArray) -> NDArray:
    """Directions in which orbits of twice the period leave period doublings; shape (rows, 2kq + 1).

    It is the null vector of the equations of an orbit whose first impact comes back with the other
    sign, and after it this vector with the other sign.
    """
    linear = equations.linear(z)
    rows, k, q, _ = linear.derivatives.shape
    derivatives = linear.derivatives.copy()
    derivatives[:, -1, :, q : q + 2] *= -1
    # Any column and any row beside the singular matrix, if they are not special.
    derivatives[..., q + 2 :] = np.cos(np.arange(k * q)).reshape(k, q, 1)
    border = np.cos(np.sqrt(2) * np.arange(k * q + 1))
    border[-1] = 0.0
    border = np.broadcast_to(border, (rows, 1, k * q + 1))
    zeros, one = np.zeros((rows, k, q, 1)), np.ones((rows, 1, 1))
    null = solve_bordered(derivatives, zeros, border, one)[:, :-1, 0]
    return np.concatenate([null, -null, np.zeros((rows, 1))], axis=1)


def follow(orbit, *, along: str | Path | None = None, to=None, points: int = 500):
    """The branch of a periodic orbit along a parameter, or the branches of many, side by side.

    From an ordinary orbit and from the grazing of a release the branch through it is followed; from a
    saddle-node the branch that is stable there; from a period doubling that of twice the period; from
    a period halving that of half the period; from the grazing of a flight that with one impact
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
        range, or to ten times its value and at least 10.
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
    found = _follow_all(list(orbit) if many else [orbit], along, to, points, None)
    if not many and isinstance(found[0], OrbitNotFound):
        raise found[0]
    return found if many else found[0]


def cascade(doubling, *, to, impacts: int = 64):
    """The branches of a cascade of period doublings: each up to the doubling from which the next goes on.

    Parameters
    ----------
    doubling : PeriodicOrbit, or a sequence of PeriodicOrbit and OrbitNotFound
        Period doublings.
    to : float or array_like
        A value of the parameter beyond which nothing is followed.
    impacts : int
        The largest number of impacts of an orbit.

    Returns
    -------
    list of FollowedBranch, or a list of such lists
        For a sequence; an OrbitNotFound in place of a doubling is one in its place.

    Raises
    ------
    OrbitNotFound
        If there is no doubled orbit towards `to`.
    """
    if isinstance(doubling, PeriodicOrbit):
        branches = cascade([doubling], to=to, impacts=impacts)[0]
        if isinstance(branches, OrbitNotFound):
            raise branches
        return branches
    latest = list(doubling)
    whole = [[] if isinstance(each, PeriodicOrbit) else each for each in latest]
    to = np.broadcast_to(np.asarray(to, float), len(latest))
    going = [i for i, each in enumerate(latest) if isinstance(each, PeriodicOrbit)]
    while going := [i for i in going if 2 * latest[i].impacts <= impacts]:
        found = _follow_all([latest[i] for i in going], None, to[going], 500, "period doubling")
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


def _follow_all(orbits, along, to, points, until) -> list:
    """Branches of orbits, or reasons, in order; orbits with the same kind of equations side by side."""
    found, tasks, groups = list(orbits), {}, []
    for i, each in enumerate(orbits):
        if not isinstance(each, PeriodicOrbit):
            continue
        path = each.equations.along[-1] if along is None else path_of(along, each.ball)
        goal = to if isinstance(to, tuple) or np.ndim(to) == 0 else to[i]
        tasks[i] = _task(each, path, goal)
        same_ball = each.ball.at(**dict.fromkeys(each.ball.parameters, 0.0))
        key = each.kind, path, each.impacts, same_ball
        same = next((rows for other, rows in groups if other == key), None)
        if same is None:
            groups.append((key, same := []))
        same.append(i)
    for (kind, *_), rows in groups:
        together = _stacked([tasks[i] for i in rows])
        ways = range(together.goals.shape[1])
        parts = [_from_special(together, way, kind, points, until) for way in ways]
        for place, i in enumerate(rows):
            found[i] = _joined([part[place] for part in parts])
    return found


class _Task(NamedTuple):
    """Orbits to be followed, by rows: their goals, one or two, and the limits of the parameter."""

    equations: OrbitEquations
    z: NDArray
    goals: NDArray
    limits: NDArray


def along_path(orbit: PeriodicOrbit, path: Path) -> tuple[OrbitEquations, NDArray]:
    """The equations of an orbit along a path, and the orbit there, shape (N,).

    Raises
    ------
    ValueError
        If the orbit is not on the path.
    """
    ball, amplitude = orbit.ball, orbit.amplitude
    equations = OrbitEquations(ball, orbit.impacts, orbit.periods, amplitude, (path,))
    value = float(path.place(ball, amplitude))
    return equations, np.append(orbit.z[: orbit.equations.size], value)


def _task(orbit: PeriodicOrbit, path: Path, to) -> _Task:
    """What is to be followed from one orbit, as one row.

    Raises
    ------
    ValueError
        If a goal is out of its range, or the orbit not on the path.
    """
    equations, z = along_path(orbit, path)
    low, high = (float(each) for each in path.limits(orbit.ball, orbit.amplitude))
    value = z[-1]
    if to is None:
        to = high if high <= 10 else min(high, max(10.0, 10 * value))
    goals = np.atleast_1d(np.asarray(to, float))
    for goal in goals:
        if not low <= goal <= high:
            raise ValueError(f"to = {goal:g}: {path.name} must be in [{low:g}, {high:g}]")
    if len(goals) == 2 and not goals[0] <= value <= goals[1]:
        raise ValueError(f"to = {to}: {path.name} = {value:.10g} of the orbit must be between them")
    return _Task(equations, z[np.newaxis], goals[np.newaxis], np.array([[low, high]]))


def _stacked(tasks: list[_Task]) -> _Task:
    """Tasks of single orbits as rows of one."""
    if len(tasks) == 1:
        return tasks[0]
    balls = [each.equations.ball for each in tasks]
    values = {name: np.array([b.parameters[name] for b in balls]) for name in balls[0].parameters}
    equations = replace(
        tasks[0].equations,
        ball=balls[0].at(**values) if values else balls[0],
        periods=np.array([each.equations.periods for each in tasks]),
        amplitude=np.array([each.equations.amplitude for each in tasks]),
    )
    return _Task(equations, *(np.concatenate(rows) for rows in zip(*(t[1:] for t in tasks))))


def _windows(z, goal, limits) -> NDArray:
    """The values between which the parameter stays: the goal, and as far behind z; shape (rows, 2)."""
    behind = np.clip(2 * z[:, -1] - goal, *limits.T)
    return np.sort(np.stack([goal, behind], axis=-1), axis=-1)


def _from_special(task: _Task, way: int, kind, points, until) -> list:
    """Branches from orbits of one kind towards one of their goals, or the reasons for none."""
    start = _STARTS.get(kind, _no_start)(task, way)
    name = task.equations.along[-1].name
    found = [OrbitNotFound(reason) for reason in start.reasons]
    going = np.flatnonzero(start.reasons == "")
    if going.size:
        arrays = {"z", "direction", "step", "goal", "window"}
        part = start._replace(
            equations=start.equations.rows(going),
            **{field: getattr(start, field)[going] for field in arrays},
        )
        for i, branch in zip(going, _followed(part, points, until, kind), strict=True):
            path = branch.z if start.origin is None else np.vstack([start.origin[[i]], branch.z])
            text = f"{kind or 'an orbit'} at {name} = {task.z[i, -1]:.10g}"
            found[i] = replace(branch, z=path, start=text)
    return found


def _ordinary_start(task: _Task, way: int) -> _Start:
    """The branch through orbits."""
    equations, z, goals, limits = task
    goal = goals[:, way]
    direction = tangents(equations, z)
    direction = direction * np.sign((goal - z[:, -1]) * direction[:, -1])[:, np.newaxis]
    reasons = np.full(len(z), "", object)
    for i in np.flatnonzero(goal == z[:, -1]):
        reasons[i] = f"{equations.along[-1].name} = {goal[i]:.10g} is that of the orbit already"
    step, window = np.full(len(z), FIRST_STEP), _windows(z, goal, limits)
    return _Start(equations, z, direction, step, goal, window, None, reasons)


def _fold_start(task: _Task, way: int) -> _Start:
    """The branch that is stable next to a saddle-node; and the other one, if both ways are followed.

    Both are on the same side of the parameter.
    """
    equations, z, goals, limits = task
    direction, units = tangents(equations, z), scales(equations, z)
    direction = _unit(direction / units)
    length = np.full((len(z), 1), 1e-2)
    for _ in range(8):
        near = newton(equations, z + length * direction * units, direction / units)
        length = np.where(near.found[:, np.newaxis], length, length / 4)
        if near.found.all():
            break
    upwards = near.z[:, -1] > z[:, -1]
    stable = np.sign(1 - equations.turn(near.linear))[:, np.newaxis] * direction * units
    goal = np.where(upwards, goals.max(axis=1), goals.min(axis=1))
    reasons = np.full(len(z), "", object)
    for i in np.flatnonzero((goal > z[:, -1]) != upwards):
        place = f"{equations.along[-1].name} = {z[i, -1]:.10g}"
        side = "above" if upwards[i] else "below"
        reasons[i] = f"the orbits of the saddle-node at {place} are {side} it"
    if goals.shape[1] == 2 and way == 0:
        stable = -stable
    step, window = np.full(len(z), FIRST_STEP), _windows(z, goal, limits)
    return _Start(equations, z, stable, step, goal, window, None, reasons)


def _grazing_start(task: _Task, way: int) -> _Start:
    """The branch with one impact more, from orbits with a flight that touches the table."""
    rows, name = len(task.z), task.equations.along[-1].name
    size, q = task.equations.length, task.equations.unknowns
    origin, direction = np.zeros((2, rows, size + q))
    reasons = np.full(rows, "", object)
    more = replace(task.equations, impacts=task.equations.impacts + 1)
    for i in range(rows):
        try:
            _, origin[i], direction[i] = one_impact_more(single(task.equations, i), task.z[i])
        except OrbitNotFound as error:
            reasons[i] = str(error)
    # One step away from the touch, where the added impact has the speed 0.
    units, step = scales(more, origin), np.full(rows, 1e-3)
    ahead = np.where((reasons == "")[:, np.newaxis], _unit(direction / units), 0.0)
    start = newton(more, origin + step[:, np.newaxis] * ahead * units, ahead / units)
    goal = task.goals[:, way]
    reasons[(reasons == "") & ~start.found] = "the orbits with one impact more are not found"
    away = start.z[:, -1] - origin[:, -1]
    for i in np.flatnonzero((reasons == "") & (away * (goal - origin[:, -1]) <= 0)):
        side = "above" if away[i] > 0 else "below"
        place = f"{name} = {origin[i, -1]:.10g}"
        reasons[i] = f"the orbits with one impact more are {side} the grazing at {place}"
    window = _windows(origin, goal, task.limits)
    return _Start(more, start.z, start.z - origin, step, goal, window, origin, reasons)


def _halved_start(task: _Task, way: int) -> _Start:
    """The branch of half the period."""
    equations, z = halves_of(task.equations, task.z)
    return _ordinary_start(task._replace(equations=equations, z=z), way)


def _no_start(task: _Task, way: int) -> _Start:
    """No branch goes on from this kind of special orbit."""
    reasons = np.full(len(task.z), "branches end at a special orbit of this kind", object)
    goal = task.goals[:, way]
    return _Start(task.equations, task.z, task.z, goal, goal, task.limits, None, reasons)


def _doubled_start(task: _Task, way: int) -> _Start:
    """The branch of twice the period.

    The parameter and tr/(1 + det), which is 1 at the doubling, change there with the square of the
    distance. The first step is halved until both fall by about four from it to half of it, and
    until the latter has hardly changed: then no bifurcation is between the doubling and the step.
    """
    twice, origin = doubled_of(task.equations, task.z)
    goal, rows, name = task.goals[:, way], len(origin), twice.along[-1].name
    units = scales(twice, origin)
    direction = _unit(_flip(task.equations, task.z) / units)
    length, good = np.full(rows, 0.02), np.zeros(rows, bool)
    start, pair = origin.copy(), twice.rows(np.tile(np.arange(rows), 2))
    for _ in range(40):
        reach = np.concatenate([length, length / 2])[:, np.newaxis]
        guess = np.tile(origin, (2, 1)) + reach * np.tile(direction * units, (2, 1))
        solution = newton(pair, guess, np.tile(direction / units, (2, 1)))
        with np.errstate(all="ignore"):
            away = (solution.z[:, -1] - np.tile(origin[:, -1], 2)).reshape(2, rows)
            lost = 1 - pair.turn(solution.linear).reshape(2, rows)
            bend = np.linalg.norm((solution.z - guess)[:rows] / units, axis=1)
            quadratic = _about_four(away) & _about_four(lost) & (bend < 0.2 * length)
            new = ~good & solution.found.reshape(2, rows).all(axis=0) & quadratic
            new &= np.abs(lost[0]) < 0.3
        start[new] = solution.z[:rows][new]
        good |= new
        if good.all():
            break
        length[~good] /= 2
    reasons = np.full(rows, "", object)
    reasons[~good] = "the start of the orbits of twice the period is not found"
    with np.errstate(all="ignore"):
        share = (goal - origin[:, -1]) / (start[:, -1] - origin[:, -1])
    for i in np.flatnonzero(good & ~(share > 0)):
        side = "above" if start[i, -1] > origin[i, -1] else "below"
        place = f"{name} = {origin[i, -1]:.10g}"
        reasons[i] = f"the orbits of twice the period are {side} the period doubling at {place}"
    near = np.abs(goal - origin[:, -1]) < NEAREST * units[:, -1]
    reasons[near] = f"{name} is too near to the period doubling: rounding errors hide the orbits"
    short = (reasons == "") & (share < 1.5)
    if short.any():
        # The whole branch is hardly longer than its start, or shorter.
        length = np.where(short, 0.3 * length * np.sqrt(np.abs(share)), length)
        guess = origin + length[:, np.newaxis] * direction * units
        solution = newton(twice, guess, direction / units)
        start[short] = solution.z[short]
        reasons[short & ~solution.found] = (
            "the start of the orbits of twice the period is not found"
        )
    window = _windows(origin, goal, task.limits)
    return _Start(twice, start, start - origin, length, goal, window, origin, reasons)


def _about_four(pair: NDArray) -> NDArray:
    """Whether the second row is about a quarter of the first."""
    ratio = pair[0] / pair[1]
    return (ratio > 3) & (ratio < 5.5)


_STARTS = {
    "": _ordinary_start,
    "grazing of a release": _ordinary_start,
    "saddle-node": _fold_start,
    "period doubling": _doubled_start,
    "period halving": _halved_start,
    "grazing of a flight": _grazing_start,
}


def _joined(parts: list):
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
    """The special orbits between which orbits with one impact are stable; None where there is none."""

    saddle_node: PeriodicOrbit | None
    period_doubling: PeriodicOrbit | None


def limits(ball: Ball, *, n=1):
    """The saddle-node and the period doubling of the n-T orbits of a ball.

    An orbit is followed towards smaller and greater Λ. An elastic ball has orbits down to Λ = 0, and no
    saddle-node.

    Parameters
    ----------
    ball : Ball
        Its parameters are numbers or arrays.
    n : array_like of int

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
    row, (periods,), shape = rows_of(ball, n)
    between = _between_limits(OrbitEquations(row, 1, periods))
    down = _follow_all(between, "amplitude", 1e-6, 500, "saddle-node")
    up = _follow_all(between, "amplitude", None, 500, "period doubling")
    found = []
    for below, above in zip(down, up, strict=True):
        special = () if isinstance(below, OrbitNotFound) else (*below.special[::-1], *above.special)
        folds = (each for each in special if each.kind == "saddle-node")
        doublings = (each for each in special if each.kind == "period doubling")
        found.append(Limits(next(folds, None), next(doublings, None)))
    return found if shape else found[0]


def _between_limits(equations: OrbitEquations) -> list:
    """An orbit with one impact for each row, between the limits of the restitution model if it can be."""
    ball, n = equations.ball, np.asarray(equations.periods)
    r = ball.signature(1.5 * np.pi * n).restitution
    r = np.where(np.isfinite(r), r, 0.5)
    fold = np.pi * n * (1 - r) / (1 + r)
    found = [OrbitNotFound("no orbit with one impact is found")] * len(n)
    for share in (0.5, 0.9, 0.2, 2.0, 4.0):
        amplitude = np.hypot(fold, 2 * share * (1 + r * r) / (1 + r) ** 2)
        z, good, _ = near_instants(equations, amplitude, 1)
        for i in range(len(n)):
            if isinstance(found[i], PeriodicOrbit):
                continue
            alone = single(equations, i)
            ones = [PeriodicOrbit(alone, z[i])] if good[i] else []
            ones = ones or shortest_contacts(alone, float(amplitude[i]), 1)
            found[i] = ones[0] if ones else found[i]
        if all(isinstance(each, PeriodicOrbit) for each in found):
            break
    return found
