"""Periodic orbits with k impacts in m periods of the table: what they are and how they are found.

An n-T orbit of the paper has one impact in n periods of the table.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bouncing_ball_beyond.balls import (
    Ball,
    brief,
    broadcast_named,
    check_ball,
    checked,
    whole_number,
)
from bouncing_ball_beyond.equations import VANISHED, Linear, OrbitEquations, newton, product_of
from bouncing_ball_beyond.tables import SINE, Table, check_table

TOGETHER = 16
"""Rows whose orbits are searched for at a time, with 3072 impacts each."""


class OrbitNotFound(ValueError):
    """There is no such orbit, or it is not found: one line with what was looked for, and why."""


@dataclass(frozen=True, eq=False, repr=False)
class PeriodicOrbit:
    """A periodic orbit: its equations and their solution.

    Quantities of the impacts are floats for one impact, and arrays of the shape (impacts,)
    otherwise. Velocities are absolute unless their names say relative, in units of g/Ω; times are
    in units of 1/Ω, heights in units of g/Ω².

    Parameters
    ----------
    equations : OrbitEquations
        Those of one ball.
    z : ndarray, shape (N,)
        τ, u and, in contacts of finite duration, T of each impact, and the values of what changes.
    kind : str
        The kind of a special orbit, such as "saddle-node", and "" for others.
    """

    equations: OrbitEquations
    z: NDArray
    kind: str = ""

    def __repr__(self):
        rows = {
            **({"kind": self.kind} if self.kind else {}),
            "impacts": self.impacts,
            "periods": self.periods,
            **self.parameters,
            "phase": self.phase,
            "contact_duration": self.contact_duration,
            "impact_velocity": self.impact_velocity,
            "bounce_velocity": self.bounce_velocity,
            "apparent_restitution": self.apparent_restitution,
            "max_height": self.max_height,
            "stable": self.stable,
            "admissible": self.admissible,
        }
        width = max(map(len, rows))
        return "\n".join(
            ["PeriodicOrbit", *(f"  {name:{width}}  {_short(row)}" for name, row in rows.items())]
        )

    @property
    def impacts(self) -> int:
        """Their number k in one period of the orbit."""
        return self.equations.impacts

    @property
    def periods(self) -> int:
        """The number m of periods of the table in one period of the orbit."""
        return int(self.equations.periods)

    @cached_property
    def _changed(self) -> tuple[Ball, float, Table]:
        ball = self.equations.ball
        amplitude = self.equations.amplitude
        table = self.equations.table
        for path, value in zip(self.equations.along, self.z[self.equations.size :], strict=True):
            ball, amplitude = path.apply(ball, amplitude, value)
            table = path.shape(table, float(value)) if table.parameters else table
        return ball, float(amplitude), table

    @property
    def ball(self) -> Ball:
        """The ball with the parameters of this orbit."""
        return self._changed[0]

    @property
    def amplitude(self) -> float:
        """Λ."""
        return self._changed[1]

    @property
    def table(self) -> Table:
        """The waveform of the table."""
        return self._changed[2]

    @property
    def parameters(self) -> dict[str, float]:
        """Λ, the parameters of ball and table, and the variables of the paths of the orbit."""
        values = {"amplitude": self.amplitude, **self.ball.parameters, **self.table.parameters}
        names = [path.name for path in self.equations.along]
        values |= dict(zip(names, self.z[self.equations.size :], strict=True))
        return {name: float(value) for name, value in values.items()}

    @cached_property
    def _impacts(self) -> NDArray:
        return self.z[: self.equations.size].reshape(self.impacts, -1)

    @cached_property
    def _ends(self):
        ends = self.equations.ends(self.z[np.newaxis])
        return type(ends)(*(each[0] for each in ends[:5]), self.table)

    @cached_property
    def _linear(self) -> Linear:
        return self.equations.linear(self.z[np.newaxis])

    def _each(self, values):
        """A float for one impact, an array for several."""
        return float(values[0]) if self.impacts == 1 else values

    @property
    def times(self) -> NDArray:
        """The times of the impacts, shape (impacts,)."""
        return self._impacts[:, 0]

    @property
    def speeds(self) -> NDArray:
        """The closing speeds u = -δ′ of the impacts, shape (impacts,)."""
        return self._impacts[:, 1]

    @property
    def phase(self):
        """Phase of the table as an impact starts, in (-π, π]."""
        return self._each(np.pi - (np.pi - self.times) % (2 * np.pi))

    @property
    def release_phase(self):
        """Phase of the table at the end of the contact, in (-π, π]."""
        return self._each(np.pi - (np.pi - self._ends.leaves) % (2 * np.pi))

    @property
    def contact_duration(self):
        """Duration of the contact."""
        return self._each(self._ends.leaves - self.times)

    @property
    def flight_time(self):
        """Duration of the flight after the contact."""
        return self._each(self._ends.flight)

    @property
    def relative_impact_velocity(self):
        """δ′ as an impact starts, negative but where a contact resumes."""
        return self._each(-self.speeds)

    @property
    def relative_bounce_velocity(self):
        """δ′ as the contact ends."""
        return self._each(self._ends.speed)

    @property
    def impact_velocity(self):
        """Absolute velocity of the ball as an impact starts, in units of g/Ω."""
        return self._each(self.amplitude * self.table(self.times, 1) - self.speeds)

    @property
    def bounce_velocity(self):
        """Velocity of the ball as the contact ends."""
        velocity = self.amplitude * self.table(self._ends.leaves, 1)
        return self._each(velocity + self._ends.speed)

    @property
    def apparent_restitution(self):
        """r_a = -δ′_b/δ′_i (Eq. 17)."""
        return self._each(self._ends.speed / self.speeds)

    @cached_property
    def max_height(self) -> float:
        """The greatest height of the ball, in a flight or in a contact."""
        return float(self.equations.max_height(self.z[np.newaxis])[0])

    @property
    def monodromy(self) -> NDArray:
        """Derivative of the return map in (τ, δ′) as the first impact starts, shape (2, 2)."""
        signs = np.diag([1.0, -1.0])
        return signs @ product_of(self.equations.maps(self._linear))[0] @ signs

    @cached_property
    def trace_and_determinant(self) -> tuple[float, float]:
        """Trace and determinant of the derivative of the return map."""
        trace, determinant = self.equations.trace_and_determinant(self._linear)
        return float(trace[0]), float(determinant[0])

    @property
    def multipliers(self) -> NDArray:
        """The two Floquet multipliers, complex, that of the larger modulus first."""
        trace, determinant = self.trace_and_determinant
        root = np.sqrt(complex(trace**2 / 4 - determinant))
        larger = trace / 2 - root if trace < 0 else trace / 2 + root
        return np.array([larger, determinant / larger])

    @property
    def turn(self) -> float:
        """tr/(1 + det): 1 at a saddle-node, -1 at a period doubling.

        Where an impact grazes or a release is lost, rounding decides on it, and it may be infinite.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            return float(self.equations.turn(self._linear)[0])

    @property
    def stable(self) -> bool:
        """Whether no neighbouring motion leaves; those of an elastic ball stay near."""
        return bool(self.equations.stable(self._linear)[0])

    @cached_property
    def admissible(self) -> bool:
        """Whether a ball follows the orbit: nothing else happens in its contacts and flights."""
        return bool(self.equations.admissible(self.z[np.newaxis])[0])

    @property
    def defect(self) -> float:
        """The largest residual of the equations."""
        return float(np.abs(self._linear.legs).max())

    @cached_property
    def digits_left(self) -> float:
        """How many decimal places of the times and speeds of the impacts are certain.

        The rounding errors of the numbers z and of the terms of the equations, eps |J| |z|, move
        the solution by at most |J⁻¹| times as much (R. D. Skeel, J. ACM 26, 494, 1979).
        """
        _, jacobian = self.equations.residuals(self.z[np.newaxis])
        size = self.equations.size
        # A phase is known no better than the time from which it is computed.
        z = np.abs(self.z)
        rounding = np.finfo(float).eps * np.abs(jacobian[0]) @ z
        error = np.abs(np.linalg.pinv(jacobian[0, :, :size])) @ rounding
        return float(-np.log10(error.max()))

    def distance(self, other: "PeriodicOrbit") -> float:
        """The largest difference of the impacts of two orbits, from whichever of them one starts.

        It is that of the phases, closing speeds and unknowns T; infinite for other numbers of
        impacts or periods.
        """
        if (self.impacts, self.periods) != (other.impacts, other.periods):
            return np.inf
        shifts = [np.roll(other._impacts, j, axis=0) - self._impacts for j in range(self.impacts)]
        for shift in shifts:
            shift[:, 0] = (shift[:, 0] + np.pi) % (2 * np.pi) - np.pi
        return float(min(np.abs(shift).max() for shift in shifts))


def _short(value) -> str:
    """A value of a quantity with six digits."""
    if isinstance(value, np.ndarray):
        text = " ".join(f"{each:.6g}" for each in value[:4])
        return f"[{text}{' …' if len(value) > 4 else ''}]"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def solved(equations: OrbitEquations, z: NDArray, what: str = "an orbit") -> PeriodicOrbit:
    """The orbit near a guess, by Newton's method.

    Raises
    ------
    OrbitNotFound
        If it does not converge.
    """
    solution = newton(equations, z[np.newaxis], iterations=40)
    if not solution.found[0]:
        raise OrbitNotFound(f"{what} is not found: Newton's method does not converge")
    return PeriodicOrbit(equations, _first_turn(equations, solution.z)[0])


def _first_turn(equations: OrbitEquations, z: NDArray) -> NDArray:
    """Orbits whose first impact is in the first period of the table, at a time in [0, 2π)."""
    z = z.copy()
    turns = 2 * np.pi * np.floor(z[:, [0]] / (2 * np.pi))
    z[:, : equations.size : equations.unknowns] -= turns
    return z


def guess_of_instants(
    ball: Ball, periods, amplitude, side: int = 1, table: Table = SINE
) -> NDArray:
    """Rows z near n-T orbits, from impacts as instants of free impacts (the corrected model).

    At the centroid of its force, which is at the phase ψ, an impact has the speed u with
    (1 + r(u)) u + σ (1 + w″(ψ)) = 2πn and w′(ψ) = u - πn. Below the saddle-node, ψ is the phase at
    which the table rises fastest.

    Parameters
    ----------
    ball : Ball
        With parameters of the shape (rows,) or numbers.
    periods, amplitude : ndarray, shape (rows,)
    side : {1, -1}
        The side of the saddle-node: 1 for the orbits that are stable next to it.
    table : Table
        With numbers as its parameters.
    """
    u = np.full(amplitude.shape, 1.2 * np.pi) * periods
    psi = np.full(amplitude.shape, table.phase_of_slope(table.slope / 2, side))
    step, before = np.zeros((2, *amplitude.shape))
    at = np.inf
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
    # The impacts of a corrected ball are at the centroids themselves.
    touch = psi if ball.sinks else psi - np.where(known, centroid, 0.0)
    columns = [touch, u, amplitude]
    if ball.lasts:
        free = ball.free(u)
        columns.insert(2, np.where(np.isfinite(free), free, np.pi))
    return np.stack(np.broadcast_arrays(*columns), axis=-1)


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


def orbit(
    ball: Ball,
    *,
    amplitude: ArrayLike,
    n: ArrayLike = 1,
    side: str = "stable",
    table: Table = SINE,
):
    """The n-T orbit of a ball at the amplitude Λ of the table.

    Parameters
    ----------
    ball : Ball
        Its parameters are numbers or arrays.
    amplitude : array_like
    n : array_like of int
        The number of periods of the table between two impacts.
    side : {"stable", "unstable"}
        The side of the saddle-node on which the orbit is: impacts after or before the phase at
        which the table rises fastest. A table that rises several times in a period has more orbits,
        which `orbits` lists.
    table : Table
        The waveform of the table, by default a sine.

    Returns
    -------
    PeriodicOrbit, or a list of PeriodicOrbit and OrbitNotFound
        A list if an argument is an array: its elements in order, with the reason for those that
        have no orbit.

    Raises
    ------
    OrbitNotFound
        If all arguments are numbers and there is no orbit.
    ValueError
        If an argument is out of its range.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> round(orbit(Rigid(0.5), amplitude=1.2).phase, 6)
    0.510164
    """
    check_table(table)
    checked("amplitude", amplitude, 0, np.inf, low_allowed=False)
    counts = np.ravel(checked("n", n, 1, 1000, low_allowed=True))
    for count in counts[counts % 1 != 0]:
        raise ValueError(f"n = {count:g}: must be a whole number")
    if side not in ("stable", "unstable"):
        raise ValueError(f"side = {side!r}: must be 'stable' or 'unstable'")
    row, (amplitudes, periods), shape = rows_of(ball, amplitude=amplitude, n=n)
    equations = OrbitEquations(row, 1, periods, table=table)
    sign = 1 if side == "stable" else -1
    z, good = near_instants(equations, amplitudes.astype(float), sign)
    admissible = good & equations.admissible(z)
    found: list = [
        PeriodicOrbit(single(equations, i), z[i]) if good[i] else None for i in range(len(z))
    ]
    missing = np.flatnonzero(~admissible)
    if missing.size:
        others = [found[i] for i in missing]
        searched = _searched(equations.rows(missing), amplitudes[missing], sign, others)
        for i, each in zip(missing, searched, strict=True):
            found[i] = each
    if shape:
        return found
    if isinstance(found[0], OrbitNotFound):
        raise found[0]
    return found[0]


def near_instants(equations: OrbitEquations, amplitude: NDArray, sign: int) -> tuple:
    """Orbits with one impact near those of the corrected model, as rows, and which of them are
    found on a side of the saddle-node.
    """
    on_table = sign, equations.table
    guess = guess_of_instants(equations.ball, equations.periods, amplitude, *on_table)
    solution = newton(equations, guess, iterations=40)
    good = solution.found & (sign * (1 - equations.turn(solution.linear)) > 0)
    z = _first_turn(equations, np.where(good[:, np.newaxis], solution.z, guess))
    good &= (z[:, 1] > 0) & (solution.linear.flights[:, 0] > VANISHED)
    return z, good


def _searched(equations: OrbitEquations, amplitude: NDArray, sign: int, others: list) -> list:
    """The orbits with one impact and the shortest contact on a side of the saddle-node, by rows.

    If a ball follows no such orbit, it is one that no ball follows, of ``others`` if there is one.
    Below the saddle-node of the branch it is the reason.
    """
    # The module of branches imports this one.
    from bouncing_ball_beyond.continuation import limits

    found: list = [None] * len(amplitude)
    # With a number r and a sine the instants are the impacts, so that there are no others.
    if not (equations.ball.simple and equations.table.compiled):
        orbits = shortest_contacts(equations, amplitude, sign)
        found = [each[0] if each else None for each in orbits]
    missing = [i for i, each in enumerate(found) if not (each and each.admissible)]
    ends = np.isfinite(equations.ball.free(1.5 * np.pi * equations.periods + 0 * amplitude))
    # The limits of balls that creep off the table take long to find.
    ending = [i for i in missing if ends[i]]
    rows = equations.rows(ending)
    lowest = limits(rows.ball, n=rows.periods, table=equations.table) if ending else []
    folds = {i: each.saddle_node for i, each in zip(ending, lowest, strict=True)}
    for i in missing:
        fold = folds.get(i)
        where = f"{amplitude[i]:.10g}"
        why = "none is found on this side of the saddle-node"
        if isinstance(fold, PeriodicOrbit) and amplitude[i] < fold.amplitude:
            where, limit = apart(amplitude[i], fold.amplitude)
            why = f"below the saddle-node at Λ = {limit}"
        elif others[i] or found[i]:
            found[i] = others[i] or found[i]
            continue
        elif not ends[i]:
            why = "none is found, and without a table its impacts do not end"
        ball = equations.ball.rows(i)
        values = ", ".join(f"{name} = {value:.6g}" for name, value in ball.parameters.items())
        found[i] = OrbitNotFound(
            f"no {np.ravel(equations.periods)[i]}-T orbit at Λ = {where} for"
            f" {type(ball).__name__}({values}): {why}"
        )
    return found


def shortest_contacts(
    equations: OrbitEquations, amplitude: NDArray, sign: int
) -> list[list[PeriodicOrbit]]:
    """Orbits with one impact on a side of the saddle-node, a list for each row.

    Those that a ball follows, and of these those with short contacts, come first.
    """
    found = []
    for i, z in enumerate(_all_orbits(equations, amplitude)):
        orbits = [PeriodicOrbit(single(equations, i), row) for row in z]
        on_side = [each for each in orbits if sign * (1 - each.turn) > 0]
        found.append(sorted(on_side, key=lambda each: (not each.admissible, each.contact_duration)))
    return found


def single(equations: OrbitEquations, i: int) -> OrbitEquations:
    """The equations of one row alone, with numbers in place of arrays."""
    return replace(
        equations,
        ball=equations.ball.rows(i),
        periods=int(np.ravel(equations.periods)[i if np.ndim(equations.periods) else 0]),
        amplitude=float(np.ravel(equations.amplitude)[i if np.ndim(equations.amplitude) else 0]),
        table=equations.table.rows(i),
    )


def one_amplitude(amplitude) -> float:
    """The amplitude as a number; ValueError unless it is a positive one."""
    value = checked("amplitude", amplitude, 0, np.inf, low_allowed=False)
    if np.ndim(value):
        raise ValueError(f"amplitude = {brief(amplitude)}: must be one number")
    return value


def apart(first: float, second: float) -> tuple[str, str]:
    """Two different numbers with as many digits as tell them apart, at least six."""
    for digits in range(6, 18):
        texts = f"{first:.{digits}g}", f"{second:.{digits}g}"
        if texts[0] != texts[1]:
            break
    return texts


def orbits(
    ball: Ball, *, amplitude: float, impacts: int = 1, periods: int = 1, table: Table = SINE
) -> list[PeriodicOrbit]:
    """Orbits with k impacts in m periods of the table that a ball follows, stable and unstable.

    With one impact, the speeds at which a ball comes back are found at 96 phases, or at as many for
    each wave of the table, and from there all orbits. With several impacts this is a search:
    Newton's method closes the motions of 2592 first impacts, and orbits may be missed.

    Parameters
    ----------
    ball : Ball
    amplitude : float
        Λ.
    impacts, periods : int
    table : Table
        The waveform of the table, by default a sine.

    Returns
    -------
    list of PeriodicOrbit
        In the order of the durations of their contacts, then of their first phases.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> found = orbits(Rigid(0.5), impacts=3, periods=3, amplitude=1.6)
    >>> [(round(each.max_height, 3), each.stable) for each in found]
    [(8.209, True), (8.007, False)]
    """
    check_ball(ball)
    amplitude = one_amplitude(amplitude)
    check_table(table)
    counts = whole_number("impacts", impacts), whole_number("periods", periods)
    equations = OrbitEquations(ball, *counts, table=table)
    (z,) = _all_orbits(equations, np.array([amplitude]))
    found = [PeriodicOrbit(equations, row) for row in z[equations.admissible(z)]]
    return sorted(found, key=lambda each: (round(np.sum(each.contact_duration), 9), each.times[0]))


def _all_orbits(equations: OrbitEquations, amplitude: NDArray) -> list[NDArray]:
    """Solutions of the equations at the amplitudes of rows, also those no ball follows.

    An array of the shape (orbits, N) for each row; with several impacts there is one row.
    """
    found = []
    for first in range(0, len(amplitude), TOGETHER):
        block = np.arange(first, min(first + TOGETHER, len(amplitude)))
        part = equations.rows(block)
        nearby = _returns if part.impacts == 1 else _motions
        starts, row = nearby(part, amplitude[block])
        good = np.isfinite(starts).all(axis=1)
        z, row = _solutions_near(part, starts[good], row[good])
        z, row = _motions_among(part, z, row)
        each = [_distinct(part.rows(i), z[row == i]) for i in range(len(block))]
        row = np.repeat(np.arange(len(block)), [len(z) for z in each])
        # Some starts lead to orbits many periods later, at times with fewer digits.
        z = newton(part.rows(row), np.concatenate(each)).z if len(row) else np.concatenate(each)
        found += [z[row == i] for i in range(len(block))]
    return found


def _solutions_near(equations: OrbitEquations, z: NDArray, row: NDArray) -> tuple[NDArray, NDArray]:
    """The solutions to which Newton's method leads from starts of rows, and their rows.

    Where impacts become much faster or longer than all of those at the starts, it is lost.
    """

    def sizes(z):
        x = z[:, : equations.size].reshape(len(z), equations.impacts, equations.unknowns)
        return np.abs(x[..., 1:]).max(axis=1)

    largest = np.zeros((row.max(initial=0) + 1, equations.unknowns - 1))
    np.maximum.at(largest, row, 2 * sizes(z))
    found = [z[:0]]
    rows = [row[:0]]
    for _ in range(30):
        if not len(z):
            break
        solution = newton(equations.rows(row), z, iterations=1)
        found.append(solution.z[solution.found])
        rows.append(row[solution.found])
        z = solution.z
        inside = np.isfinite(z).all(axis=1) & (sizes(z) <= largest[row]).all(axis=1)
        z = z[inside & ~solution.found]
        row = row[inside & ~solution.found]
    return np.concatenate(found), np.concatenate(rows)


@np.errstate(all="ignore")
def _returns(equations: OrbitEquations, amplitude: NDArray) -> tuple[NDArray, NDArray]:
    """Starts near all orbits with one impact, and their rows: impacts whose speed is the same after
    m periods.

    Orbits lie on the curves of such impacts, which are crossed at 96 phases.
    """
    table = equations.table
    longest = 2.2 * np.pi * equations.periods + amplitude * table.bounds[1]
    speeds = np.geomspace(1e-3, longest, 32, axis=-1)[:, np.newaxis]
    phases = np.linspace(0, 2 * np.pi, 96 * table.orders[-1], endpoint=False)[:, np.newaxis]
    tau, u = np.broadcast_arrays(phases, speeds)

    def impacts(tau, u, row):
        columns = [tau, u, amplitude[row]]
        ball = equations.ball.rows(row)
        if ball.lasts:
            # Contacts of an orbit are shorter than its period.
            periods = np.broadcast_to(equations.periods, len(amplitude))[row]
            columns.insert(2, ball.first_release(*columns, periods=periods, table=table))
        return np.stack(columns, axis=-1)

    row = np.repeat(np.arange(len(amplitude)), tau[0].size)
    some = np.arange(tau.size).reshape(tau.shape)[:, ::4, ::4].ravel()
    if not np.isfinite(impacts(tau.flat[some], u.flat[some], row[some])).any(axis=0).all():
        # Balls that never leave the table take long to follow.
        return np.zeros((0, equations.length)), row[:0]
    z = impacts(tau.ravel(), u.ravel(), row)
    change = equations.rows(row).legs(z)[:, 0, -1].reshape(tau.shape)
    row, at, number = np.nonzero(change[..., :-1] * change[..., 1:] < 0)
    low = change[row, at, number]
    part = low / (low - change[row, at, number + 1])
    between = u[row, at, number] + part * np.diff(u)[row, at, number]
    return impacts(tau[row, at, 0], between, row), row


def _motions(equations: OrbitEquations, amplitude: NDArray) -> tuple[NDArray, NDArray]:
    """Starts near orbits of k impacts: simulated motions of them that take about m periods."""
    # The simulation is not needed by orbits with one impact.
    from bouncing_ball_beyond.simulation import Balls, follow

    k = equations.impacts
    turn = 2 * np.pi
    (amplitude,) = amplitude
    fastest = 1.1 * np.pi * int(equations.periods) + amplitude * equations.table.bounds[1]
    phases = np.linspace(0, turn, 54, endpoint=False)
    tau, u = np.meshgrid(phases, np.linspace(0.1, fastest, 48))
    none = np.zeros(tau.size)
    first = Balls(equations.ball, none + amplitude, none, tau.ravel(), u.ravel(), equations.table)
    record, going, after = follow(first, k)
    turns, phase, speed, T, *_ = np.moveaxis(record[..., going], 1, 0)
    times = turn * turns + phase
    length = turn * after.turns + after.phase - times[0]
    near = np.abs(length - turn * equations.periods) < np.pi
    columns = [times, speed, T][: equations.unknowns]
    x = np.stack(columns, axis=-1)[:, near].swapaxes(0, 1)
    x = x.reshape(len(x), equations.size)
    return np.column_stack([x, np.full(len(x), amplitude)]), np.zeros(len(x), int)


def _motions_among(equations: OrbitEquations, z: NDArray, row: NDArray) -> tuple[NDArray, NDArray]:
    """The solutions whose impacts and flights last, and their rows."""
    x = z[:, : equations.size].reshape(len(z), equations.impacts, equations.unknowns)
    good = x[..., 2:].min(axis=(1, 2), initial=np.inf) >= 0
    good &= (x[..., 1] > 0).all(axis=1)
    good[good] &= (equations.rows(row[good]).ends(z[good]).flight > 0).all(axis=1)
    return z[good], row[good]


def _distinct(equations: OrbitEquations, z: NDArray) -> NDArray:
    """One row for each orbit: its first impact is the one of the greatest speed.

    Orbits of a shorter period, taken several times, are left out.
    """
    if not len(z):
        return z
    k = equations.impacts
    x = z[:, : equations.size].reshape(len(z), k, equations.unknowns)
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
    return np.concatenate([rows, np.full((len(rows), 1), z[0, -1])], axis=1)


def orbit_near(
    ball: Ball,
    *,
    amplitude: float,
    phases: ArrayLike,
    velocities: ArrayLike,
    table: Table = SINE,
) -> PeriodicOrbit:
    """The periodic orbit near a guess: phases and velocities of the ball before its impacts.

    The number of periods follows from the velocities, because a flight lasts as long as its
    velocity falls by.

    Parameters
    ----------
    ball : Ball
    amplitude : float
    phases, velocities : array_like, shape (impacts,)
        Velocities are absolute.
    table : Table
        The waveform of the table, by default a sine.

    Raises
    ------
    OrbitNotFound
        If Newton's method does not converge.
    """
    check_ball(ball)
    amplitude = one_amplitude(amplitude)
    phases, velocities = (np.atleast_1d(np.asarray(x, float)) for x in (phases, velocities))
    if phases.shape != velocities.shape or phases.ndim != 1:
        raise ValueError("phases, velocities: must have one entry for each impact")
    check_table(table)
    u = amplitude * table(phases, 1) - velocities
    T = ball.first_release(phases, u, amplitude, table=table)
    if not np.isfinite(T).all():
        raise OrbitNotFound("an impact of the guess does not end: the ball stays on the table")
    impact = ball.contact(phases, u, T, amplitude, table=table)
    bounce = impact.speed + amplitude * table(phases + impact.duration, 1)
    lengths = impact.duration + bounce - np.roll(velocities, -1)
    turns = np.round((phases + lengths - np.roll(phases, -1)) / (2 * np.pi))
    times = phases[0] + np.append(0.0, np.cumsum(np.roll(phases, -1) - phases + 2 * np.pi * turns))
    periods = int(np.round((times[-1] - times[0]) / (2 * np.pi)))
    if periods < 1:
        raise OrbitNotFound("the guess takes no time: its velocities are not those of flights")
    columns = [times[:-1], u, T] if ball.lasts else [times[:-1], u]
    z = np.append(np.stack(columns, axis=-1).ravel(), amplitude)
    what = f"an orbit with {len(u)} impacts in {periods} periods near this guess"
    return solved(OrbitEquations(ball, len(u), periods, table=table), z, what)
