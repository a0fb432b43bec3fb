"""Periodic orbits of a ball at an amplitude: the n-T orbit, all orbits, or the one near a guess."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bouncing_ball_beyond.balls import (
    Ball,
    brief,
    check_ball,
    check_whole_numbers,
    checked,
    whole_number,
)
from bouncing_ball_beyond.continuation import limits
from bouncing_ball_beyond.equations import (
    OrbitEquations,
    OrbitNotFound,
    PeriodicOrbit,
    alone,
    row_of,
)
from bouncing_ball_beyond.march import newton
from bouncing_ball_beyond.search import (
    all_orbits,
    first_turn,
    near_instants,
    rows_of,
    shortest_contacts,
)
from bouncing_ball_beyond.tables import SINE, Table, check_table, finite_row


def solved(equations: OrbitEquations, z: NDArray, what: str) -> PeriodicOrbit:
    """The orbit near a guess, shape (N,); OrbitNotFound if Newton's method does not converge."""
    solution = newton(equations, z[np.newaxis], iterations=40)
    if not solution.found[0]:
        raise OrbitNotFound(f"{what} is not found: Newton's method does not converge")
    return equations.orbit(first_turn(equations, solution.z)[0])


def orbit(
    ball: Ball,
    *,
    amplitude: ArrayLike,
    n: ArrayLike = 1,
    side: str = "stable",
    table: Table = SINE,
) -> Any:
    """Find the n-T orbit of a ball, with one impact in n periods of the table.

    OrbitNotFound if all arguments are numbers and there is none.

    Parameters
    ----------
    ball, amplitude, n
        Numbers, or arrays: then there is a list of orbits, with the OrbitNotFound in place of one
        that there is not.
    side : {"stable", "unstable"}
        The side of the saddle-node: impacts after or before the phase at which the table rises
        fastest. Tables that rise several times in a period have more orbits: see `orbits`.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> round(orbit(Rigid(0.5), amplitude=1.2).phase, 6)
    0.510164
    """
    check_table(table)
    checked("amplitude", amplitude, 0, np.inf, low_allowed=False)
    check_whole_numbers("n", n)
    if side not in ("stable", "unstable"):
        raise ValueError(f"side = {side!r}: must be 'stable' or 'unstable'")
    row, (amplitudes, periods), shape = rows_of(ball, amplitude=amplitude, n=n)
    equations = OrbitEquations(row, 1, periods, table=table)
    sign = 1 if side == "stable" else -1
    found, admissible = near_instants(equations, amplitudes.astype(float), sign)
    missing = np.flatnonzero(~admissible)
    if missing.size:
        near = [found[i] for i in missing]
        searched = _searched(equations.rows(missing), amplitudes[missing], sign, near)
        for i, each in zip(missing, searched, strict=True):
            found[i] = each
    return found if shape else alone(found[0])


def _searched(equations: OrbitEquations, amplitude: NDArray, sign: int, near: list) -> list:
    """The orbits with the shortest contact on a side of the saddle-node, by rows; else those that
    no ball follows, if possible of ``near``; and the reason below the saddle-node of the branch."""
    shortest, admissible = shortest_contacts(equations, amplitude, sign)
    found: list = [*shortest]
    missing = np.flatnonzero(~admissible)
    ends = np.isfinite(equations.ball.free(1.5 * np.pi * equations.periods + 0 * amplitude))
    # The limits of balls that creep off the table take long to find.
    ending = missing[ends[missing]]
    rows = equations.rows(ending)
    lowest = limits(rows.ball, n=rows.periods, table=equations.table) if len(ending) else []
    folds = {i: each.saddle_node for i, each in zip(ending, lowest, strict=True)}
    for i in missing:
        fold = folds.get(i)
        why = "none is found on this side of the saddle-node"
        if isinstance(fold, PeriodicOrbit) and amplitude[i] < fold.amplitude:
            why = f"below the saddle-node at Λ = {fold.amplitude:.10g}"
        elif near[i] or found[i]:
            found[i] = near[i] or found[i]
            continue
        ball = equations.ball.rows(i)
        values = ", ".join(f"{name} = {value:.6g}" for name, value in ball.parameters.items())
        found[i] = OrbitNotFound(
            f"no {np.ravel(equations.periods)[i]}-T orbit at Λ = {amplitude[i]:.10g} for"
            f" {type(ball).__name__}({values}): {why}"
        )
    return found


def one_amplitude(amplitude: Any) -> float:
    """The amplitude as a positive number, or ValueError."""
    value = checked("amplitude", amplitude, 0, np.inf, low_allowed=False)
    if np.ndim(value):
        raise ValueError(f"amplitude = {brief(amplitude)}: must be one number")
    return value


def orbits(
    ball: Ball, *, amplitude: float, impacts: int = 1, periods: int = 1, table: Table = SINE
) -> list[PeriodicOrbit]:
    """Find the orbits with k impacts in m periods that a ball follows, stable and unstable.

    With one impact the list is complete; with several this is a search from 2592 first impacts, and
    orbits may be missed. With a contact law it takes seconds, and several impacts up to a minute.
    They are in the order of the durations of their contacts, then of phases.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> found = orbits(Rigid(0.5), impacts=3, periods=3, amplitude=1.6)
    >>> [(round(each.max_height, 3), each.stable) for each in found]
    [(8.209, True), (8.007, False)]
    """
    check_ball(ball)
    if any(map(np.ndim, ball.parameters.values())):
        raise ValueError(f"ball = {ball!r}: must be one ball")
    amplitude = one_amplitude(amplitude)
    check_table(table)
    counts = whole_number("impacts", impacts), whole_number("periods", periods)
    equations = OrbitEquations(ball, *counts, table=table)
    z = all_orbits(equations, amplitude)
    if not len(z):
        return []
    found = [equations.orbit(row) for row in z[equations.admissible(z)]]
    return sorted(found, key=lambda each: (round(np.sum(each.contact_duration), 9), each.times[0]))


def orbit_near(
    ball: Ball,
    *,
    amplitude: float,
    phases: ArrayLike,
    velocities: ArrayLike,
    table: Table = SINE,
) -> PeriodicOrbit:
    """Find the periodic orbit near a guess: phases and absolute velocities before its impacts.

    Both have the shape (impacts,). The number of periods follows from the velocities.
    OrbitNotFound if Newton's method does not converge.
    """
    check_ball(ball)
    amplitude = one_amplitude(amplitude)
    tau = finite_row("phases", np.atleast_1d(phases))
    before = finite_row("velocities", np.atleast_1d(velocities))
    if tau.shape != before.shape:
        raise ValueError("phases, velocities: must have one entry for each impact")
    check_table(table)
    u = amplitude * table(tau, 1) - before
    T = ball.first_release(tau, u, amplitude, table=table)
    if not np.isfinite(T).all():
        raise OrbitNotFound("an impact of the guess does not end: the ball stays on the table")
    impact = ball.contact(tau, u, T, amplitude, table=table)
    bounce = impact.speed + amplitude * table(tau + impact.duration, 1)
    lengths = impact.duration + bounce - np.roll(before, -1)
    turns = np.round((tau + lengths - np.roll(tau, -1)) / (2 * np.pi))
    times = tau[0] + np.append(0.0, np.cumsum(np.roll(tau, -1) - tau + 2 * np.pi * turns))
    periods = int(np.round((times[-1] - times[0]) / (2 * np.pi)))
    if periods < 1:
        raise OrbitNotFound("the guess takes no time: its velocities are not those of flights")
    z = row_of(ball, times[:-1], u, T, amplitude)
    equations = OrbitEquations(ball, len(u), periods, table=table)
    what = f"an orbit with {len(u)} impacts in {periods} periods near this guess"
    return solved(equations, z, what)
