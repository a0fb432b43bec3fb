"""Find periodic orbits of a ball at one amplitude.

Three searches are possible: for the n-T orbit, for all orbits with k impacts in m periods, and for
the orbit near a guess.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bouncing_ball_beyond.contacts.balls import (
    ENDLESS,
    Ball,
    check_one_ball,
    check_whole_numbers,
    checked,
    one_number,
    whole_number,
)
from bouncing_ball_beyond.motions.effort import EVALUATIONS, Effort, SearchEnded
from bouncing_ball_beyond.periodic.continuation import limits_of
from bouncing_ball_beyond.periodic.equations import (
    OrbitEquations,
    OrbitNotFound,
    PeriodicOrbit,
    alone,
)
from bouncing_ball_beyond.periodic.instants import where_begun
from bouncing_ball_beyond.periodic.search import (
    all_orbits,
    near_instants,
    rows_of,
    shortest_contacts,
)
from bouncing_ball_beyond.tables.table import SINE, Table, check_table


def orbit(
    ball: Ball,
    *,
    amplitude: ArrayLike,
    n: ArrayLike = 1,
    side: str = "stable",
    table: Table = SINE,
    evaluations: int = EVALUATIONS,
    progress: Callable | None = None,
) -> Any:
    """Find the n-T orbit of a ball, with one impact in n periods of the table.

    Parameters
    ----------
    ball : Ball
        A ball. Its parameters may be arrays.
    amplitude : float or array
        Λ > 0.
    n : int or array
        Number of periods of the table in one period of the orbit.
    side : {"stable", "unstable"}
        Side of the saddle-node. On the stable side the impact comes after the phase at which the
        table rises fastest, and on the unstable side before it. Tables that rise several times in a
        period have more orbits: see `orbits`.
    table : Table
        Waveform of the table, by default a sine.
    evaluations : int
        Number of contacts after which the search for one ball ends.
    progress : callable, optional
        Function that receives a line of text, such as ``print``: every two seconds, or when a step
        of the search that takes longer has ended. By default the lines appear in a terminal only.

    Returns
    -------
    PeriodicOrbit or list
        One orbit if all arguments are numbers. If arguments are arrays, a list with one entry for
        each element of the broadcast arrays. The entry is an orbit, an OrbitNotFound if the orbit
        does not exist, or a SearchEnded if its evaluations are used up. If no ball follows an
        orbit, ``admissible`` of the orbit is False, and ``obstacle`` says why. If r depends on the
        speed, or the table rises several times, ``others`` of the orbit names other n-T orbits.

    Raises
    ------
    OrbitNotFound
        If all arguments are numbers and the orbit does not exist.
    SearchEnded
        If all arguments are numbers and the evaluations are used up.
    ValueError
        If an argument is out of range.

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
    most = one_number("evaluations", evaluations)
    effort = Effort("orbit", most, progress, balls=amplitudes.size)
    equations = OrbitEquations(row, 1, periods, table=table, effort=effort)
    sign = 1 if side == "stable" else -1
    orbit_of_row, admissible = near_instants(equations, amplitudes.astype(float), sign)
    missing = np.flatnonzero(~admissible)
    if missing.size:
        near = [orbit_of_row[i] for i in missing]
        searched = _searched(equations.rows(missing), amplitudes[missing], sign, near)
        for i, orbit_or_reason in zip(missing, searched, strict=True):
            orbit_of_row[i] = orbit_or_reason
    return orbit_of_row if shape else alone(orbit_of_row[0])


def _searched(equations: OrbitEquations, amplitude: NDArray, sign: int, near: list) -> list:
    """Return one orbit, or the reason why there is none, for each row.

    The first possible result of this list is returned:

    1. the orbit with the shortest contact on the given side of the saddle-node, if a ball follows
       this orbit;
    2. an OrbitNotFound, if Λ is below the saddle-node of the branch;
    3. an orbit that no ball follows, from ``near`` or, if there is none, from the search;
    4. an OrbitNotFound, or a SearchEnded.
    """
    shortest, admissible = shortest_contacts(equations, amplitude, sign)
    orbit_of_row: list = [*shortest]
    ended = np.array([isinstance(orbit_or_reason, SearchEnded) for orbit_or_reason in orbit_of_row])
    missing = np.flatnonzero(~admissible & ~ended)
    ends = np.isfinite(equations.ball.free(1.5 * np.pi * equations.periods + 0 * amplitude))
    # Limits are slow to find if free impacts do not end, because the ball creeps off the table.
    ending = missing[ends[missing]]
    rows = equations.rows(ending)
    lowest = limits_of(rows) if len(ending) else []
    folds = {i: limits.saddle_node for i, limits in zip(ending, lowest, strict=True)}
    others = {i: limits.others for i, limits in zip(ending, lowest, strict=True)}
    for i in missing:
        fold = folds.get(i)
        why = "none is found on this side of the saddle-node"
        if isinstance(fold, PeriodicOrbit) and amplitude[i] < fold.amplitude:
            why = f"below the saddle-node at Λ = {fold.amplitude:.10g}{_of_others(others[i])}"
        elif near[i] or orbit_of_row[i]:
            orbit_of_row[i] = near[i] or orbit_of_row[i]
            continue
        elif not ends[i]:
            why = f"none is found; {ENDLESS}"
        ball = equations.ball.rows(i)
        values = ", ".join(f"{name} = {value:.6g}" for name, value in ball.parameters.items())
        orbit_of_row[i] = OrbitNotFound(
            f"no {np.ravel(equations.periods)[i]}-T orbit at Λ = {amplitude[i]:.10g} for"
            f" {type(ball).__name__}({values}): {why}"
        )
    return orbit_of_row


def _of_others(folds: NDArray) -> str:
    """Text on other saddle-nodes (Λ, τ, u), above which no orbit was found."""
    return f"; no other that begins {where_begun(folds)}, either" if len(folds) else ""


def orbits(
    ball: Ball,
    *,
    amplitude: float,
    impacts: int = 1,
    periods: int = 1,
    table: Table = SINE,
    evaluations: int = EVALUATIONS,
    progress: Callable | None = None,
) -> list[PeriodicOrbit]:
    """Find the stable and unstable orbits with k impacts in m periods that a ball follows.

    With a constant r and k = 1 the list is complete, because these orbits are the roots of scalar
    equations (:mod:`.instants`). With r(u) it is complete to a resolution: r must not leave its
    course and return to it while u changes by mπ/1024. Contacts
    of finite duration are searched from 3072 first impacts (more on a table with many harmonics)
    and from all orbits of instantaneous impacts with the same r(u). If k > 1, the search starts
    from 2592 first impacts. These two searches may miss orbits. With a contact law the search takes
    seconds, or up to a minute if k > 1. Orbits are sorted by the total duration of their contacts,
    and then by the phase of their first impact.

    Parameters
    ----------
    ball : Ball
        A single ball.
    amplitude : float
        Λ > 0.
    impacts, periods : int
        Numbers k and m.
    table : Table
        Waveform of the table, by default a sine.
    evaluations, progress
        As in :func:`orbit`.

    Returns
    -------
    list of PeriodicOrbit

    Raises
    ------
    SearchEnded
        If the evaluations are used up.
    ValueError
        If the ball or the amplitude is an array, or if an argument is out of range.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> in_three_periods = orbits(Rigid(0.5), impacts=3, periods=3, amplitude=1.6)
    >>> [(round(orbit.max_height, 3), orbit.stable) for orbit in in_three_periods]
    [(8.209, True), (8.007, False)]
    """
    check_one_ball(ball)
    amplitude = one_number("amplitude", amplitude)
    check_table(table)
    counts = whole_number("impacts", impacts), whole_number("periods", periods)
    effort = Effort("orbits", one_number("evaluations", evaluations), progress)
    equations = OrbitEquations(ball, *counts, table=table, effort=effort)
    z = all_orbits(equations, amplitude)
    if not len(z):
        return []
    admissible = [equations.orbit(row) for row in z[equations.admissible(z)]]
    return sorted(
        admissible, key=lambda orbit: (round(np.sum(orbit.contact_duration), 9), orbit.times[0])
    )
