"""Periodic orbits with k impacts in m periods of the table: what they are and how they are found.

An n-T orbit of the paper has one impact in n periods of the table.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bouncing_ball_beyond.balls import H, Ball, Corrected
from bouncing_ball_beyond.equations import Linear, OrbitEquations, newton
from bouncing_ball_beyond.paths import AMPLITUDE


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
    def _changed(self) -> tuple[Ball, float]:
        ball, amplitude = self.equations.ball, self.equations.amplitude
        for path, value in zip(self.equations.along, self.z[self.equations.size :], strict=True):
            ball, amplitude = path.apply(ball, amplitude, value)
        return ball, float(amplitude)

    @property
    def ball(self) -> Ball:
        """The ball with the parameters of this orbit."""
        return self._changed[0]

    @property
    def amplitude(self) -> float:
        """Λ."""
        return self._changed[1]

    @property
    def parameters(self) -> dict[str, float]:
        """Λ, the parameters of the ball, and the variables of the paths on which the orbit was found."""
        values = {"amplitude": self.amplitude, **self.ball.parameters}
        names = [path.name for path in self.equations.along]
        values |= dict(zip(names, self.z[self.equations.size :], strict=True))
        return {name: float(value) for name, value in values.items()}

    @cached_property
    def _impacts(self) -> NDArray:
        return self.z[: self.equations.size].reshape(self.impacts, -1)

    @cached_property
    def _ends(self):
        ends = self.equations.ends(self.z[np.newaxis])
        return type(ends)(*(each[0] for each in ends))

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
        """Velocity of the ball as an impact starts."""
        return self._each(self.amplitude * np.cos(self.times) - self.speeds)

    @property
    def bounce_velocity(self):
        """Velocity of the ball as the contact ends."""
        return self._each(self.amplitude * np.cos(self._ends.leaves) + self._ends.speed)

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
        """Derivative of the return map in (τ, δ′) at the start of the first impact, shape (2, 2)."""
        maps = self.equations.maps(self._linear)[0]
        signs = np.diag([1.0, -1.0])
        return (
            signs @ np.linalg.multi_dot([*maps[::-1], signs])
            if len(maps) > 1
            else signs @ maps[0] @ signs
        )

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
        """tr/(1 + det): 1 at a saddle-node, -1 at a period doubling."""
        trace, determinant = self.trace_and_determinant
        return trace / (1 + determinant)

    @property
    def stable(self) -> bool:
        """Whether no neighbouring motion leaves: an elastic ball's stays near, others' come nearer."""
        # The determinant of an elastic ball is 1 up to rounding.
        return abs(self.turn) < 1 and self.trace_and_determinant[1] < 1 + 1e-9

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

        The rounding errors of the numbers z and of the terms of the equations, eps |J| |z|, move the
        solution by at most |J⁻¹| times as much (R. D. Skeel, J. ACM 26, 494, 1979).
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


def guess_of_instants(ball: Ball, periods, amplitude, side: int = 1) -> NDArray:
    """Rows z near n-T orbits, from impacts as instants of free impacts (the corrected model).

    At the centroid of its force, which is at the phase ψ, an impact has the speed u with
    (1 + r(u)) u + σ (1 - Λ sin ψ) = 2πn and Λ cos ψ = u - πn. Below the saddle-node, ψ is 0.

    Parameters
    ----------
    ball : Ball
        With parameters of the shape (rows,) or numbers.
    periods, amplitude : ndarray, shape (rows,)
    side : {1, -1}
        The side of the saddle-node: 1 for the orbits that are stable next to it.
    """
    u = np.full(amplitude.shape, 1.2 * np.pi) * periods
    psi = np.full(amplitude.shape, side * np.pi / 3)
    with np.errstate(all="ignore"):
        for _ in range(30):
            r, _, centroid, loss = ball.signature(u)
            known = np.isfinite(r)
            load = np.where(known, loss * (1 - amplitude * np.sin(psi)), 0.0)
            u = (u + (2 * np.pi * periods - load) / (1 + np.where(known, r, 0.5))) / 2
            psi = side * np.arccos(np.clip((u - np.pi * periods) / amplitude, -1, 1))
    # The impacts of a corrected ball are at the centroids themselves.
    touch = psi if isinstance(ball, Corrected) else psi - np.where(known, centroid, 0.0)
    columns = [touch, u, amplitude]
    if ball.lasts:
        free = ball.free(u)
        columns.insert(2, np.where(np.isfinite(free), free, np.pi))
    return np.stack(np.broadcast_arrays(*columns), axis=-1)


def rows_of(ball: Ball, *others: ArrayLike) -> tuple[Ball, list[NDArray], tuple[int, ...]]:
    """A ball and further numbers as rows of one length, and the shape which these had."""
    fields = ball.parameters
    arrays = np.broadcast_arrays(*fields.values(), *others)
    shape = arrays[0].shape if arrays else ()
    arrays = [np.array(each).reshape(-1) for each in arrays]
    names = list(fields)
    row = ball.at(**dict(zip(names, arrays[: len(names)], strict=True))) if names else ball
    return row, arrays[len(names) :], shape


def orbit(ball: Ball, *, amplitude: ArrayLike, n: ArrayLike = 1, side: str = "stable"):
    """The n-T orbit of a ball at the amplitude Λ of the table.

    Parameters
    ----------
    ball : Ball
        Its parameters are numbers or arrays.
    amplitude : array_like
    n : array_like of int
        The number of periods of the table between two impacts.
    side : {"stable", "unstable"}
        The side of the saddle-node on which the orbit is.

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
    _check_arguments(amplitude, n, side)
    row, (amplitudes, periods), shape = rows_of(ball, amplitude, n)
    equations = OrbitEquations(row, 1, periods)
    sign = 1 if side == "stable" else -1
    guess = guess_of_instants(row, periods, amplitudes.astype(float), sign)
    solution = newton(equations, guess, iterations=40)
    on_side = sign * (1 - equations.turn(solution.linear)) > 0
    good = solution.found & on_side
    if good.any():
        z = np.where(good[:, np.newaxis], solution.z, guess)
        good &= equations.admissible(z)
    found = []
    z = _first_turn(equations, solution.z)
    for i, amplitude in enumerate(amplitudes):
        alone = single(equations, i)
        if good[i]:
            found.append(PeriodicOrbit(alone, z[i]))
        else:
            found.append(_searched_orbit(alone, float(amplitude), sign))
    if shape:
        return found
    if isinstance(found[0], OrbitNotFound):
        raise found[0]
    return found[0]


def single(equations: OrbitEquations, i: int) -> OrbitEquations:
    """The equations of one row alone, with numbers in place of arrays."""
    arrays = {name: each for name, each in equations.ball.parameters.items() if np.ndim(each)}
    return replace(
        equations,
        ball=equations.ball.at(**{name: float(each[i]) for name, each in arrays.items()}),
        periods=int(np.ravel(equations.periods)[i if np.ndim(equations.periods) else 0]),
        amplitude=float(np.ravel(equations.amplitude)[i if np.ndim(equations.amplitude) else 0]),
    )


def _check_arguments(amplitude, n, side):
    """Raise ValueError with one line for a wrong argument."""
    for value in np.ravel(amplitude):
        if not (np.isreal(value) and 0 < value < np.inf):
            raise ValueError(f"amplitude = {value!r}: must be a positive number")
    for value in np.ravel(n):
        if value != int(value) or not 1 <= value <= 1000:
            raise ValueError(f"n = {value!r}: must be a whole number from 1 to 1000")
    if side not in ("stable", "unstable"):
        raise ValueError(f"side = {side!r}: must be 'stable' or 'unstable'")


def _searched_orbit(equations: OrbitEquations, amplitude: float, sign: int):
    """The orbit with the shortest contact on a side of the saddle-node, or the reason for none."""
    return OrbitNotFound(f"no {int(equations.periods)}-T orbit is found at Λ = {amplitude:.10g}")
