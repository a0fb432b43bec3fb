"""Search for periodic orbits.

Newton's method starts from orbits of instantaneous impacts, or from motions that nearly repeat.
"""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import maximum_filter, minimum_filter

from bouncing_ball_beyond.contacts.balls import Ball, Rigid, broadcast_named, check_ball
from bouncing_ball_beyond.motions.bounces import Balls, bounce
from bouncing_ball_beyond.motions.effort import Effort, SearchEnded
from bouncing_ball_beyond.periodic.equations import AT_FOLD, OrbitEquations, PeriodicOrbit, flight
from bouncing_ball_beyond.periodic.instants import instants
from bouncing_ball_beyond.periodic.march import newton
from bouncing_ball_beyond.tables.table import SINE, Table


def rows_of(ball: Ball, **others: ArrayLike) -> tuple[Ball, list[NDArray], tuple[int, ...]]:
    """Broadcast the parameters of a ball and further numbers to rows of one length.

    Returns the ball, a list of arrays of the shape (rows,), and the shape of the broadcast
    arguments.
    """
    check_ball(ball)
    fields = ball.parameters
    broadcast = broadcast_named([*fields.items(), *others.items()])
    shape = broadcast[0].shape if broadcast else ()
    arrays = [np.array(values).reshape(-1) for values in broadcast]
    names = list(fields)
    row = ball.at(**dict(zip(names, arrays[: len(names)], strict=True))) if names else ball
    return row, arrays[len(names) :], shape


def guess_of_instants(
    ball: Ball,
    periods: int | NDArray,
    amplitude: NDArray,
    side: int = 1,
    table: Table = SINE,
    start: NDArray | None = None,
) -> NDArray:
    """Guess n-T orbits from the corrected model, which replaces contacts by instantaneous impacts.

    Such an impact takes place at the phase ψ of the centroid of the contact force. The speed u and
    ψ satisfy (1 + r(u)) u + σ (1 + w″(ψ)) = 2πn and w′(ψ) = u - πn. Below the saddle-node these
    equations have no solution, and ψ is the phase at which the table rises fastest. If ``side`` is
    1, orbits are on the stable side of the saddle-node. If ``side`` is -1, they are on the unstable
    side.

    ``amplitude`` has the shape (rows,). The search for u starts at 1.2 πn, or at ``start``. Returns
    rows z, shape (rows, N).
    """
    u = np.full(amplitude.shape, 1.2 * np.pi) * periods if start is None else np.array(start)
    psi = np.full(amplitude.shape, table.phase_of_slope(table.slope / 2, side))
    step, before = np.zeros((2, *amplitude.shape))
    at: Any = np.inf
    with np.errstate(all="ignore"):
        for _ in range(30):
            # A signature computed at a speed within 5 % of u is exact enough for a guess.
            if np.any(np.abs(u - at) > 0.05 * u):
                at = u
                r, _, centroid, loss = ball.signature(u)
            known = np.isfinite(r)
            load = np.where(known, loss * (1 + amplitude * table(psi, 2)), 0.0)
            excess = (2 * np.pi * periods - load) / (1 + np.where(known, r, 0.5)) - u
            # Secant method. The first slope is -2. Slopes are limited, because they become large
            # when the phase approaches 0.
            slope = np.where(step == 0, -2.0, np.clip((excess - before) / step, -8.0, -1.0))
            step = -excess / slope
            before = excess
            u = u + step
            psi = table.phase_of_slope((u - np.pi * periods) / amplitude, side)
            if np.all(np.abs(step) < 1e-7 * u):
                break
    # An instantaneous impact of the corrected model takes place at ψ itself.
    touch = psi - np.where(known, centroid, 0.0) - ball.start(u) / u
    T = ball.first_release(touch, u, amplitude, table=table)
    impacts = [touch, u, np.where(np.isfinite(T), T, np.pi)][: ball.unknowns]
    return np.stack(np.broadcast_arrays(*impacts, amplitude), axis=-1)


def near_instants(
    equations: OrbitEquations, amplitude: NDArray, sign: int
) -> tuple[list[PeriodicOrbit | None], NDArray]:
    """Find orbits with one impact near the orbits of the corrected model.

    ``sign`` is the side of the saddle-node (:func:`guess_of_instants`). Returns the orbit of each
    row, or None, and whether a ball follows it, shape (rows,).
    """
    equations.spend(0, "orbits near those of instantaneous impacts")
    guess = guess_of_instants(equations.ball, equations.periods, amplitude, sign, equations.table)
    solution = newton(equations, guess, iterations=40)
    good = solution.converged & (sign * (1 - equations.turn(solution.linear)) > -AT_FOLD)
    z = np.where(good[:, np.newaxis], solution.z, guess)
    # The first impact is in the first period of the table.
    z = equations.later(z, -np.floor(z[:, 0] / (2 * np.pi)))
    good &= (z[:, 1] > 0) & (solution.linear.flights[:, 0] > 0)
    rows = enumerate(zip(good, z, strict=True))
    orbits = [single(equations, i).orbit(row) if is_good else None for i, (is_good, row) in rows]
    return orbits, good & equations.admissible(z, solution.linear)


def shortest_contacts(
    equations: OrbitEquations, amplitude: NDArray, sign: int
) -> tuple[list[PeriodicOrbit | SearchEnded | None], NDArray]:
    """For each row, find the orbit with the shortest contact on one side of the saddle-node.

    Orbits that a ball follows come first. Returns the orbit of each row, None, or a SearchEnded,
    and whether a ball follows the orbit, shape (rows,).
    """
    orbit_of_row: list[PeriodicOrbit | SearchEnded | None] = []
    whole = equations.effort or Effort("", np.inf)
    for i, row_amplitude in enumerate(amplitude):
        effort = replace(whole, spent=0, balls=1, tried=[*whole.tried])
        alone = replace(single(equations, i), effort=effort)
        try:
            orbits = [alone.orbit(z) for z in all_orbits(alone, float(row_amplitude))]
        except SearchEnded as reason:
            orbit_of_row.append(reason)
            continue
        whole.told = effort.told
        on_side = [orbit for orbit in orbits if sign * (1 - orbit.turn) > -AT_FOLD]
        on_side.sort(key=lambda orbit: (not orbit.admissible, orbit.contact_duration))
        orbit_of_row.append(on_side[0] if on_side else None)
    return orbit_of_row, np.array(
        [isinstance(orbit, PeriodicOrbit) and orbit.admissible for orbit in orbit_of_row]
    )


def single(equations: OrbitEquations, i: int) -> OrbitEquations:
    """Return the equations of row i, with numbers instead of arrays."""
    return replace(
        equations,
        ball=equations.ball.rows(i),
        periods=int(np.ravel(equations.periods)[i if np.ndim(equations.periods) else 0]),
        amplitude=float(np.ravel(equations.amplitude)[i if np.ndim(equations.amplitude) else 0]),
        table=equations.table.rows(i),
    )


def all_orbits(equations: OrbitEquations, amplitude: float) -> NDArray:
    """Find orbits of one ball, shape (orbits, N), including those that the ball does not follow."""
    if equations.impacts > 1:
        guesses = [_motions(equations, amplitude)]
    elif isinstance(equations.ball, Rigid) and callable(equations.ball.restitution):
        z = instants(equations.ball, int(equations.periods), amplitude, equations.table)
        return np.column_stack([z, np.full(len(z), amplitude)])
    else:
        guesses = [_returns(equations, amplitude), _near_instants(equations, amplitude)]
    guesses = [z[np.isfinite(z).all(axis=1)] for z in guesses]
    equations.spend(0, f"orbits near {sum(map(len, guesses))} of these motions")
    z = np.concatenate([_solutions_near(equations, z) for z in guesses])
    x = equations.split(z)[0]
    z = z[(x[..., 2:] >= 0).all(axis=(1, 2)) & (x[..., 1] > 0).all(axis=1)]
    z = z[(equations.ends(z).flight > 0).all(axis=1)]
    z = _distinct(equations, z)
    # Some starts lead to orbits many periods later, whose times have fewer digits. Iterate again.
    return _distinct(equations, newton(equations, z).z) if len(z) else z


@np.errstate(all="ignore")
def _returns(equations: OrbitEquations, amplitude: float) -> NDArray:
    """Guess all orbits with one impact.

    The guesses are impacts at many phases. After n periods the ball has the same closing speed
    again.
    """
    ball = equations.ball
    table = equations.table
    length = 2 * np.pi * equations.periods
    longest = 1.1 * length + amplitude * table.bounds[1]
    phases = np.linspace(0, 2 * np.pi, max(96, 32 * table.orders[-1]), endpoint=False)
    speeds = np.geomspace(1e-3, longest, 32)
    # The contact of an orbit is shorter than its period.
    within: dict[str, Any] = {"periods": equations.periods, "table": table}
    tau, u = np.meshgrid(phases, speeds, indexing="ij")
    equations.spend(tau.size, f"motions from {tau.size} first impacts")
    gap, rate = np.empty((2, *tau.shape))
    for rows in np.array_split(np.arange(phases.size), phases.size // 32):
        _, impact = ball.first_impact(tau[rows], u[rows], amplitude, **within)
        time = length - impact.duration
        leaves = tau[rows] + impact.duration, impact.gap, impact.speed
        gap[rows], rate[rows] = flight(time, *leaves, amplitude, table)
    change = rate + u
    crossed = change[:, :-1] * change[:, 1:] < 0
    at = np.nonzero(crossed & _nearly_zero(gap - ball.start(u))[:, :-1])
    share = change[:, :-1][at] / (change[:, :-1] - change[:, 1:])[at]
    tau = tau[:, :-1][at]
    u = u[:, :-1][at] + share * np.diff(u, axis=1)[at]
    # Durations of contacts may jump between samples. Compute them again instead of interpolating.
    T = ball.first_release(tau, u, amplitude, **within)
    columns = [tau, u, T][: equations.unknowns]
    return np.stack([*columns, np.full(tau.size, amplitude)], axis=-1)


def _near_instants(equations: OrbitEquations, amplitude: float) -> NDArray:
    """Guess orbits with one impact from all orbits of instantaneous impacts."""
    ball = equations.ball
    tau, u = instants(ball, int(equations.periods), amplitude, equations.table).T
    if not u.size:
        return np.empty((0, equations.length))
    with np.errstate(all="ignore"):
        touch = tau - ball.signature(u).centroid - ball.start(u) / u
    T = ball.first_release(touch, u, amplitude, periods=equations.periods, table=equations.table)
    columns = [touch, u, T][: equations.unknowns]
    return np.stack([*columns, np.full(tau.size, amplitude)], axis=-1)


def _nearly_zero(values: NDArray) -> NDArray:
    """Whether a function may vanish near points of a grid that is periodic along its first axis.

    It may if its values at a point and the eight points around it have both signs, or are as small
    as their range. Two zeros between neighbouring points are then not missed.
    """
    none = np.isnan(values)
    low = minimum_filter(np.where(none, np.inf, values), 3, mode=("wrap", "nearest"))
    high = maximum_filter(np.where(none, -np.inf, values), 3, mode=("wrap", "nearest"))
    return (2 * low <= high) & (2 * high >= low)


def _motions(equations: OrbitEquations, amplitude: float) -> NDArray:
    """Guess orbits with k impacts. The guesses are simulated motions of about m periods."""
    turn = 2 * np.pi
    fastest = 1.1 * np.pi * equations.periods + amplitude * equations.table.bounds[1]
    phases = np.linspace(0, turn, 54, endpoint=False)
    tau, u = np.meshgrid(phases, np.linspace(0.1, fastest, 48))
    equations.spend(tau.size, f"motions from {tau.size} first impacts")
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
    """Iterate Newton's method from many starts, and return the solutions.

    An iteration ends without a solution if it becomes larger than twice the largest start.
    """

    def sizes(z: NDArray) -> NDArray:
        return np.abs(equations.split(z)[0][..., 1:]).max(axis=1)

    largest = 2 * sizes(z).max(axis=0, initial=0.0)
    solutions = [z[:0]]
    for _ in range(30):
        if not len(z):
            break
        solution = newton(equations, z, iterations=1)
        solutions.append(solution.z[solution.converged])
        # The comparison is false for NaN.
        inside = (sizes(solution.z) <= largest).all(axis=1)
        z = solution.z[inside & ~solution.converged]
    return np.concatenate(solutions)


def _distinct(equations: OrbitEquations, z: NDArray) -> NDArray:
    """Return each orbit once, with its fastest impact first.

    An orbit that repeats an orbit of a shorter period is left out.
    """
    k = equations.impacts
    x = equations.split(z)[0]
    later = x.copy()
    later[..., 0] += 2 * np.pi * equations.periods
    # If impacts have the same speed, as for an elastic ball, the smallest phase comes first.
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
    # Remove the second of two rows that were rounded differently but are the same orbit.
    apart = np.abs(rows[:, np.newaxis] - rows).max(axis=-1, initial=0.0)
    rows = rows[~np.tril(apart < 1e-5, -1).any(axis=1)]
    return np.concatenate([rows, z[: len(rows), -1:]], axis=1)
