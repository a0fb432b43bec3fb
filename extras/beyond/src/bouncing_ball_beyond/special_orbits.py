"""Special orbits: their kinds, and how they are located between two orbits or near a guess."""

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.equations import (
    Linear,
    OrbitEquations,
    dense,
    newton,
    solved_or_nan,
)

LONG = 2.0
"""A step of Newton's method for special orbits, relative to 1 + |z|, that leads too far away: to
contacts that last for many periods, and seldom back."""


LASTING = 4 * np.pi
"""The T from which on its changes count relatively: two free oscillations."""


class Kind(NamedTuple):
    """A kind of special orbit.

    ``test`` is zero there, a function of the equations, orbits and their derivatives; ``end`` says
    why branches end there, and is empty if they go on.
    """

    test: Callable[[OrbitEquations, NDArray, Linear], NDArray]
    end: str = ""


KINDS = {
    "saddle-node": Kind(lambda equations, z, linear: 1 - equations.turn(linear)),
    "period doubling": Kind(lambda equations, z, linear: 1 + equations.turn(linear)),
    "grazing of a flight": Kind(lambda equations, z, linear: equations.clearance(z)),
    "grazing of a release": Kind(lambda equations, z, linear: equations.contact_clearance(z)),
    "vanishing flight": Kind(
        lambda equations, z, linear: linear.flights.min(axis=1),
        "the contacts before and after a flight merge",
    ),
    "grazing of an impact": Kind(
        lambda equations, z, linear: equations.least_speed(z),
        "the ball lands with the speed of the table: an impact vanishes, or is one that resumes",
    ),
    "lost release": Kind(
        lambda equations, z, linear: equations.least_release(linear, z),
        "the ball no longer leaves the table as a contact ends",
    ),
    "period halving": Kind(
        lambda equations, z, linear: equations.halving(z),
        "the orbit merges with one of half its period",
    ),
    "end of a rest": Kind(
        lambda equations, z, linear: equations.rest(z),
        "the ball no longer comes to rest before it leaves the table",
    ),
    "lost lift-off": Kind(
        lambda equations, z, linear: equations.fall(z),
        "the table no longer falls faster than a ball",
    ),
}
"""The kinds of special orbits of a branch, by name."""


OF_RESTS = ("end of a rest", "lost lift-off")
"""Those of orbits with a rest."""

SINGULAR = slice(2, 5)
"""Those tests of `OrbitEquations.watched` at which multipliers have poles or jump: beyond them
there are no orbits."""


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


def scales(equations: OrbitEquations, z: NDArray) -> NDArray:
    """Units of the unknowns in which steps are measured, shape (rows, N).

    Changes of T count relatively where a contact lasts for many free oscillations.
    """
    units = np.full(z.shape, np.sqrt(equations.impacts))
    if equations.ball.lasts:
        lasts = np.s_[:, 2 : equations.size : 3]
        units[lasts] *= np.maximum(np.abs(z[lasts]) / LASTING, 1.0)
    units[:, equations.size :] = np.maximum(np.abs(z[:, equations.size :]), 1e-2)
    return units


class Crossings(NamedTuple):
    """Steps in which a test changes its sign.

    The row, the number of the step, the kind; the orbits at both ends of the step, the tangents and
    the tests there, whose first axis is the end.
    """

    row: NDArray
    number: NDArray
    kind: NDArray
    ends: NDArray
    slopes: NDArray
    values: NDArray


def crossings_of(equations: OrbitEquations, row, z, slopes, tests) -> Crossings:
    """All steps in which a test changes its sign, of orbits that belong to rows of the equations.

    Parameters
    ----------
    row : ndarray of int, shape (points,)
    z, slopes : ndarray, shape (points, N)
    tests : ndarray, shape (points, tests)
        Those of `OrbitEquations.tests`.
    """
    number = np.arange(len(row)) - np.searchsorted(row, row)
    every = equations.rows(row)
    columns = [*tests.T, every.clearance(z), every.contact_clearance(z)]
    names = np.array([*equations.watched, "grazing of a flight", "grazing of a release"])
    values = np.array(columns)
    crossed = (values[:, :-1] * values[:, 1:] < 0) & (row[1:] == row[:-1])
    # Where tr/(1 + det) has a pole or jumps, it changes its sign without passing 1 or -1.
    pole = np.abs(np.diff(np.arctan(values[1] - 1))) > np.pi / 2
    crossed[:2] &= ~(pole | crossed[SINGULAR].any(axis=0))
    which, at = np.nonzero(crossed)
    both = np.stack([at, at + 1])
    return Crossings(row[at], number[at], names[which], z[both], slopes[both], values[which, both])


def _cubic(part, ends, slopes):
    """Hermite's cubic between the ends of steps, with slopes per unit of the part of a step."""
    x = part[:, np.newaxis]
    chord = ends[1] - ends[0]
    bend = slopes[0] + slopes[1] - 2 * chord
    return ends[0] + x * (slopes[0] + x * (chord - slopes[0] - bend + x * bend))


def _tests_of(kinds, equations, solution) -> NDArray:
    """The tests of orbits, each that of its kind."""
    values = np.zeros(len(kinds))
    for name in np.unique(kinds):
        these = kinds == name
        linear = Linear(*(each[these] for each in solution.linear))
        values[these] = KINDS[name].test(equations.rows(these), solution.z[these], linear)
    return values


@np.errstate(all="ignore")
def located(equations, crossings: Crossings) -> tuple[NDArray, NDArray]:
    """The orbits at which the tests are zero, and which of them were found.

    The zero is bracketed along the chord of each step, by the rule of Anderson and Björck (BIT 13,
    253, 1973); the orbits are on the planes across the chord.
    """
    equations = equations.rows(crossings.row)
    ends = crossings.ends.copy()
    values = crossings.values.copy()
    weights = values.copy()
    units = scales(equations, ends[0])
    chord = (ends[1] - ends[0]) / units
    normal = chord / units / np.sum(chord**2, axis=1, keepdims=True)
    slopes = crossings.slopes / np.sum(normal * crossings.slopes, axis=2, keepdims=True)
    each = np.arange(len(chord))
    place = np.array([0 * each, 0 * each + 1.0])
    latest = 0 * each - 1
    # The equations are singular at a period halving, which is found by those of half the period.
    found = crossings.kind != "period halving"
    z = ends[0]
    for _ in range(60):
        step = place[1] - place[0]
        part = weights[0] / (weights[0] - weights[1])
        guess = _cubic(part, ends, slopes * step[:, np.newaxis])
        solution = newton(equations, guess, normal)
        found &= solution.found
        z = np.where(found[:, np.newaxis], solution.z, guess)
        value = _tests_of(crossings.kind, equations, solution)
        side = (value * values[1] > 0).astype(int)
        ratio = 1 - value / values[side, each]
        again = np.where(ratio > 0, ratio, 0.5)
        weights[1 - side, each] *= np.where(side == latest, again, 1.0)
        moved = np.abs(place[0] + part * step - place[side, each])
        place[side, each] = place[0] + part * step
        values[side, each] = value
        weights[side, each] = value
        ends[side, each] = solution.z
        slopes[side, each] = solution.tangent
        latest = side
        if ((np.abs(value) < 1e-13) | (moved < 1e-14) | ~found).all():
            break
    largest = np.abs(crossings.values).max(axis=0)
    return z, found & (np.abs(value) < 1e-6 * np.maximum(largest, 1e-3))


def value_and_gradient(
    equations: OrbitEquations, kind: str, z: NDArray
) -> tuple[NDArray, NDArray, Linear]:
    """The test of a kind of special orbit, shape (rows,), its gradient, shape (rows, N), and the
    legs.

    The gradient is a central difference. Its errors, some 1e-10, slow Newton's method down a little
    and do not move what it finds.
    """
    rows, length = z.shape
    shift = 1e-6 * np.maximum(1.0, np.abs(z))
    nudges = np.concatenate([np.zeros((1, length)), np.eye(length), -np.eye(length)])
    nearby = (z + nudges[:, np.newaxis] * shift).reshape(-1, length)
    each = equations.rows(np.tile(np.arange(rows), len(nudges)))
    linear = each.linear(nearby)
    values = KINDS[kind].test(each, nearby, linear).reshape(-1, rows)
    above, below = values[1:].reshape(2, length, rows)
    return values[0], (above - below).T / (2 * shift), Linear(*(x[:rows] for x in linear))


@np.errstate(all="ignore")
def special_near(
    equations: OrbitEquations, kind: str, z: NDArray, iterations: int = 20
) -> tuple[NDArray, NDArray]:
    """Special orbits of a kind near guesses, shape (rows, N), and which of them are found.

    Newton's method for the equations of orbits together with the test of the kind.
    """
    z = z.copy()
    found = np.zeros(len(z), bool)
    left = np.arange(len(z))
    for _ in range(iterations):
        part = equations.rows(left)
        value, gradient, linear = value_and_gradient(part, kind, z[left])
        jacobian = dense(linear.derivatives).reshape(-1, part.size, part.length)
        matrix = np.concatenate([jacobian, gradient[:, np.newaxis]], axis=1)
        right = np.column_stack([linear.legs.reshape(-1, part.size), value])
        finite = np.isfinite(matrix).all(axis=(1, 2)) & np.isfinite(right).all(axis=1)
        matrix[~finite] = np.eye(z.shape[1])
        step = solved_or_nan(matrix, right[..., np.newaxis])[..., 0]
        size = np.abs(step).max(axis=1) / (1 + np.abs(z[left]).max(axis=1))
        finite &= size < LONG
        z[left] = np.where(finite[:, np.newaxis], z[left] - step, np.nan)
        small = np.all(np.abs(step) < 1e-11 * part.sizes(z[left]), axis=1)
        found[left] = finite & small
        left = left[finite & ~small]
        if left.size == 0:
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


def halved_at(equations: OrbitEquations, ends: NDArray) -> NDArray | None:
    """Where orbits merge with those of half their period: the doubling of these, taken twice.

    The equations of the longer orbit are singular there, those of the shorter one are not.
    """
    half, near = halves_of(equations, ends)
    solution, found = special_near(half, "period doubling", near.mean(axis=0, keepdims=True))
    if not found[0]:
        return None
    z = doubled_of(half, solution)[1][0]
    turns = 2 * np.pi * np.round((ends[0, 0] - z[0]) / (2 * np.pi))
    z[: equations.size : equations.unknowns] += turns
    units = scales(equations, ends[:1])[0]
    reach = np.abs((ends[1] - ends[0]) / units).max()
    return z if np.abs((z - ends[0]) / units).max() < 3 * reach else None
