"""Where periodic orbits are: near those of instants, or near motions that come back."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bouncing_ball_beyond.balls import Ball, broadcast_named, check_ball
from bouncing_ball_beyond.bounces import Balls, bounce
from bouncing_ball_beyond.equations import VANISHED, OrbitEquations, PeriodicOrbit, unknowns_of
from bouncing_ball_beyond.march import newton
from bouncing_ball_beyond.tables import SINE, Table

AT_FOLD = 1e-6
"""1 - tr/(1 + det) below which an orbit is that of the saddle-node, and of both its sides. It grows
with the square root of Λ - Λ_SN, so that errors of 1e-13 of a contact make it 3e-7."""


def rows_of(ball: Ball, **others: ArrayLike) -> tuple[Ball, list[NDArray], tuple[int, ...]]:
    """A ball and further numbers as rows of one length, and the shape which these had."""
    check_ball(ball)
    fields = ball.parameters
    broadcast = broadcast_named([*fields.items(), *others.items()])
    shape = broadcast[0].shape if broadcast else ()
    arrays = [np.array(each).reshape(-1) for each in broadcast]
    names = list(fields)
    row = ball.at(**dict(zip(names, arrays[: len(names)], strict=True))) if names else ball
    return row, arrays[len(names) :], shape


def first_turn(equations: OrbitEquations, z: NDArray) -> NDArray:
    """Orbits whose first impact is in the first period of the table, at a time in [0, 2π)."""
    return equations.later(z, -np.floor(z[:, 0] / (2 * np.pi)))


def guess_of_instants(
    ball: Ball, periods: int | NDArray, amplitude: NDArray, side: int = 1, table: Table = SINE
) -> NDArray:
    """Rows z near n-T orbits, from impacts as instants of free impacts (the corrected model).

    At the centroid of its force, at the phase ψ, an impact has the speed u with
    (1 + r(u)) u + σ (1 + w″(ψ)) = 2πn and w′(ψ) = u - πn; below the saddle-node the table rises
    fastest at ψ. Orbits are stable on the side 1 and not on -1. The amplitude is that of rows.
    """
    u = np.full(amplitude.shape, 1.2 * np.pi) * periods
    psi = np.full(amplitude.shape, table.phase_of_slope(table.slope / 2, side))
    step, before = np.zeros((2, *amplitude.shape))
    at: Any = np.inf
    with np.errstate(all="ignore"):
        for _ in range(30):
            # For a guess, the signature at a speed is that at another one within some percent.
            if np.any(np.abs(u - at) > 0.05 * u):
                at = u
                r, _, centroid, loss = ball.signature(u)
            known = np.isfinite(r)
            load = np.where(known, loss * (1 + amplitude * table(psi, 2)), 0.0)
            excess = (2 * np.pi * periods - load) / (1 + np.where(known, r, 0.5)) - u
            # The secant method, with a slope of -2 at first, and limited as the phase nears 0.
            slope = np.where(step == 0, -2.0, np.clip((excess - before) / step, -8.0, -1.0))
            step = -excess / slope
            before = excess
            u = u + step
            psi = table.phase_of_slope((u - np.pi * periods) / amplitude, side)
            if np.all(np.abs(step) < 1e-7 * u):
                break
    touch = psi - np.where(known, centroid, 0.0) + ball.elapsed_contact(u)
    free = ball.free(u)
    impacts = [touch, u, np.where(np.isfinite(free), free, np.pi)][: unknowns_of(ball)]
    return np.stack(np.broadcast_arrays(*impacts, amplitude), axis=-1)


def near_instants(
    equations: OrbitEquations, amplitude: NDArray, sign: int
) -> tuple[list[PeriodicOrbit | None], NDArray]:
    """Orbits with one impact near those of the corrected model on a side of the saddle-node, by
    rows, or None; and which of them a ball follows."""
    guess = guess_of_instants(equations.ball, equations.periods, amplitude, sign, equations.table)
    solution = newton(equations, guess, iterations=40)
    good = solution.found & (sign * (1 - equations.turn(solution.linear)) > -AT_FOLD)
    z = first_turn(equations, np.where(good[:, np.newaxis], solution.z, guess))
    good &= (z[:, 1] > 0) & (solution.linear.flights[:, 0] > VANISHED)
    rows = enumerate(zip(good, z, strict=True))
    found = [single(equations, i).orbit(row) if is_good else None for i, (is_good, row) in rows]
    return found, good & equations.admissible(z, solution.linear)


def shortest_contacts(
    equations: OrbitEquations, amplitude: NDArray, sign: int
) -> tuple[list[PeriodicOrbit | None], NDArray]:
    """Orbits with the shortest contact on a side of the saddle-node, by rows, or None, if possible
    some that a ball follows; and which of them it follows."""
    found: list[PeriodicOrbit | None] = []
    for i, each in enumerate(amplitude):
        alone = single(equations, i)
        orbits = [alone.orbit(z) for z in all_orbits(alone, float(each))]
        on_side = [each for each in orbits if sign * (1 - each.turn) > -AT_FOLD]
        on_side.sort(key=lambda each: (not each.admissible, each.contact_duration))
        found.append(on_side[0] if on_side else None)
    return found, np.array([each is not None and each.admissible for each in found])


def single(equations: OrbitEquations, i: int) -> OrbitEquations:
    """The equations of one row alone, with numbers in place of arrays."""
    return replace(
        equations,
        ball=equations.ball.rows(i),
        periods=int(np.ravel(equations.periods)[i if np.ndim(equations.periods) else 0]),
        amplitude=float(np.ravel(equations.amplitude)[i if np.ndim(equations.amplitude) else 0]),
        table=equations.table.rows(i),
    )


def all_orbits(equations: OrbitEquations, amplitude: float) -> NDArray:
    """Orbits of one ball, also those it does not follow, shape (orbits, N)."""
    z = (_returns if equations.impacts == 1 else _motions)(equations, amplitude)
    z = _solutions_near(equations, z[np.isfinite(z).all(axis=1)])
    x = equations.split(z)[0]
    z = z[(x[..., 2:] >= 0).all(axis=(1, 2)) & (x[..., 1] > 0).all(axis=1)]
    z = z[(equations.ends(z).flight > 0).all(axis=1)]
    z = _distinct(equations, z)
    # Some starts lead to orbits many periods later, at times with fewer digits.
    return newton(equations, z).z if len(z) else z


@np.errstate(all="ignore")
def _returns(equations: OrbitEquations, amplitude: float) -> NDArray:
    """Starts near all orbits with one impact: impacts at many phases whose speed comes back."""
    table = equations.table
    longest = 2.2 * np.pi * equations.periods + amplitude * table.bounds[1]
    phases = np.linspace(0, 2 * np.pi, 96 * table.orders[-1], endpoint=False)
    speeds = np.geomspace(1e-3, longest, 32)
    tau, u = np.meshgrid(phases, speeds, indexing="ij")

    def impacts(tau: NDArray, u: NDArray) -> NDArray:
        # Contacts of an orbit are shorter than its period.
        within: dict[str, Any] = {"periods": equations.periods, "table": table}
        T = equations.ball.first_release(tau, u, amplitude, **within)
        columns = [tau, u, T][: equations.unknowns]
        return np.stack([*columns, np.full(tau.size, amplitude)], axis=-1)

    change = equations.legs(impacts(tau.ravel(), u.ravel()))[:, 0, -1].reshape(tau.shape)
    at = np.nonzero(change[:, :-1] * change[:, 1:] < 0)
    share = change[:, :-1][at] / (change[:, :-1] - change[:, 1:])[at]
    # The lengths of contacts may jump from one sample to the next, and are not interpolated.
    return impacts(tau[:, :-1][at], u[:, :-1][at] + share * np.diff(u, axis=1)[at])


def _motions(equations: OrbitEquations, amplitude: float) -> NDArray:
    """Starts near orbits of k impacts: simulated motions of them that take about m periods."""
    turn = 2 * np.pi
    fastest = 1.1 * np.pi * equations.periods + amplitude * equations.table.bounds[1]
    phases = np.linspace(0, turn, 54, endpoint=False)
    tau, u = np.meshgrid(phases, np.linspace(0.1, fastest, 48))
    none = np.zeros(tau.size)
    first = Balls(equations.ball, none + amplitude, none, tau.ravel(), u.ravel(), equations.table)
    record, going, after = bounce(first, equations.impacts)
    turns, phase, speed, T, *_ = np.moveaxis(record[..., going], 1, 0)
    times = turn * turns + phase
    length = turn * after.turns + after.phase - times[0]
    near = np.abs(length - turn * equations.periods) < np.pi
    columns = [times, speed, T][: equations.unknowns]
    x = np.stack(columns, axis=-1)[:, near].swapaxes(0, 1)
    x = x.reshape(len(x), equations.size)
    return np.column_stack([x, np.full(len(x), amplitude)])


def _solutions_near(equations: OrbitEquations, z: NDArray) -> NDArray:
    """The solutions to which Newton's method leads from starts, lost where it is far from all."""

    def sizes(z: NDArray) -> NDArray:
        return np.abs(equations.split(z)[0][..., 1:]).max(axis=1)

    largest = 2 * sizes(z).max(axis=0, initial=0.0)
    found = [z[:0]]
    for _ in range(30):
        if not len(z):
            break
        solution = newton(equations, z, iterations=1)
        found.append(solution.z[solution.found])
        # NaN is not inside either.
        inside = (sizes(solution.z) <= largest).all(axis=1)
        z = solution.z[inside & ~solution.found]
    return np.concatenate(found)


def _distinct(equations: OrbitEquations, z: NDArray) -> NDArray:
    """One row for each orbit: its first impact is the one of the greatest speed.

    Orbits of a shorter period, taken several times, are left out.
    """
    k = equations.impacts
    x = equations.split(z)[0]
    later = x.copy()
    later[..., 0] += 2 * np.pi * equations.periods
    # Of impacts with the same speed, such as those of an elastic ball, that of the least phase.
    rank = x[..., 1].round(6) - 1e-8 * (x[..., 0] % (2 * np.pi))
    first = rank.argmax(axis=1)[:, np.newaxis] + np.arange(k)
    x = np.take_along_axis(np.concatenate([x, later], axis=1), first[..., np.newaxis], axis=1)
    x[..., 0] -= 2 * np.pi * np.floor(x[:, :1, 0] / (2 * np.pi) + 1e-9)
    for j in range(1, k):
        change = np.roll(x, j, axis=1) - x
        change[..., 0] -= 2 * np.pi * np.round(change[..., 0] / (2 * np.pi))
        again = np.abs(change).max(axis=(1, 2)) < 1e-7
        x = x[~again] if k % j == 0 else x
    rows = x.reshape(len(x), equations.size)
    rows = rows[np.unique(rows.round(6), axis=0, return_index=True)[1]]
    # Two roundings of one orbit.
    apart = np.abs(rows[:, np.newaxis] - rows).max(axis=-1, initial=0.0)
    rows = rows[~np.tril(apart < 1e-5, -1).any(axis=1)]
    return np.concatenate([rows, z[: len(rows), -1:]], axis=1)
