"""Orbits of a ball that comes to rest on the table and leaves it at the next lift-off.

The ball also comes to rest at all neighbouring values of the parameters. The equations therefore
do not contain the return to rest. The length of the rest is a test function (docs/orbits.md).
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond import one_ball
from bouncing_ball_beyond.balls import Ball, H, check_one_ball
from bouncing_ball_beyond.bounces import Balls, bounce, reduced
from bouncing_ball_beyond.chains import solved_or_nan
from bouncing_ball_beyond.equations import (
    FAR,
    Flights,
    LinearizedLegs,
    OrbitEquations,
    OrbitNotFound,
    PeriodicOrbit,
    flight,
)
from bouncing_ball_beyond.march import newton
from bouncing_ball_beyond.one_ball import PERIOD
from bouncing_ball_beyond.periodic import one_amplitude
from bouncing_ball_beyond.search import single
from bouncing_ball_beyond.tables import SINE, Table, check_table

SLOW_BOUNCE = 1e-2
"""Speed of the last impact of an orbit.

Slower bounces are simulated, and are left out of the tests for grazing flights and impacts.
"""

BOUNCES_AT_ONCE = 8
"""Number of bounces that are simulated before it is checked whether the ball is at rest."""

SOON = 1e-6
"""Time after a lift-off in which zeros of δ′ are ignored. There δ grows as slowly as t³.

The phases of successive lift-offs must agree within the same tolerance.

At half and at twice: no effect.
"""

MOST = 2000
"""Maximum number of impacts between a lift-off and the next rest.

At half and at twice: no effect, except on the time of a search without success.
"""

CYCLES = 20
"""Maximum number of rests that are followed until two successive lift-offs have the same phase.

At half and at twice: no effect, except on the time of a search without success.
"""


@dataclass(frozen=True)
class RestEquations(OrbitEquations):
    """Equations of orbits with a rest.

    An orbit is a row z = (τ₁, u₁, …, τ_k, u_k, τ₀, parameters), where τ₀ is the time of the
    lift-off. The bounces after the last of the k impacts are simulated. Methods are those of
    :class:`OrbitEquations`.
    """

    unknowns = 2

    @cached_property
    def size(self) -> int:
        return 2 * self.impacts + 1

    kinds = (
        "saddle-node",
        "period doubling",
        "vanishing flight",
        "grazing of an impact",
        "lost lift-off",
        "end of a rest",
    )
    """Kinds of special orbits. The first two never occur, because both multipliers are zero."""

    def orbit(self, z: NDArray, kind: str = "") -> "RestOrbit":
        return RestOrbit(self, z, kind)

    def split(self, z: NDArray) -> tuple[NDArray, Ball, NDArray, Table]:
        """Split z into impacts, shape (rows, k, 2), ball, Λ and table. The lift-off is left out."""
        x = z[..., : 2 * self.impacts].reshape(*z.shape[:-1], self.impacts, 2)
        return x, *self.at(z[..., self.size :])

    def ends(self, z: NDArray) -> Flights:
        """Flights after the lift-off and after all impacts except the last, shape (rows, k)."""
        x, ball, amplitude, table = self.split(z)
        before = x[..., :-1, :]
        bounce = ball.contact(before[..., 0], before[..., 1], None, amplitude, table=table)
        start = z[..., self.size - 1 : self.size]
        leaves = np.concatenate([start, before[..., 0]], axis=-1)
        speed = np.concatenate([0 * start, bounce.speed], axis=-1)
        time = x[..., 0] - leaves
        return Flights(leaves, 0 * time, speed, time, amplitude + 0 * leaves, table)

    def linearized(self, z: NDArray) -> LinearizedLegs:
        """Evaluate the residuals, shape (rows, N - p, 1), their derivatives, and times of flight.

        The times of flight to the last slow bounces are replaced by `FAR`.
        """
        y = z + 1j * H * np.eye(z.shape[1])[:, np.newaxis]
        x, _, amplitude, _ = self.split(y)
        leaves, gap, speed, time, _, table = self.ends(y)
        gap, rate = flight(time, leaves, gap, speed, amplitude, table)
        lifts = 1 + amplitude * table(leaves[..., :1], 2)
        # A flight of no length ends on the table, too. The quotient excludes it.
        values = np.concatenate([lifts, gap / time, rate + x[..., 1]], axis=-1)
        derivatives = np.moveaxis(values.imag, 0, -1) / H
        lasting = np.where(self._tail(speed[0].real), FAR, time[0].real)
        return _Superstable(values[0].real[..., np.newaxis], derivatives, lasting)

    @staticmethod
    def _tail(speeds: NDArray) -> NDArray:
        """Whether each speed belongs to the last slow bounces (`SLOW_BOUNCE`), shape (rows, k)."""
        return np.cumprod(np.abs(speeds[:, ::-1]) < SLOW_BOUNCE, axis=1)[:, ::-1].astype(bool)

    def solve(self, linear: LinearizedLegs, border: NDArray, right: NDArray) -> NDArray:
        legs = np.stack([-linear.legs[..., 0], 0 * linear.legs[..., 0]], axis=-1)
        matrix = np.concatenate([linear.derivatives, border], axis=1)
        return solved_or_nan(matrix, np.concatenate([legs, right], axis=1))

    def residuals(self, z: NDArray) -> tuple[NDArray, NDArray]:
        linear = self.linearized(z)
        return linear.legs[..., 0], linear.derivatives

    def rest(self, z: NDArray) -> NDArray:
        """Durations of the rests, shape (rows,); see :attr:`RestOrbit.rest`."""
        equations: list[Any] = [single(self, i) for i in range(len(z))]
        return np.array([each.orbit(row).rest for each, row in zip(equations, z, strict=True)])

    def fall(self, z: NDArray) -> NDArray:
        """Rate -w‴ at which the table falls away at the lift-off, shape (rows,)."""
        _, _, amplitude, table = self.split(z)
        return -(amplitude * table(z[:, self.size - 1 : self.size], 3))[..., 0]

    def least_speed(self, z: NDArray) -> NDArray:
        """Minimum closing speed, without the last slow bounces, shape (rows,)."""
        speeds = self.split(z)[0][..., 1]
        return np.where(self._tail(speeds), FAR, speeds).min(axis=1)

    def clearance(self, z: NDArray, flights: Flights | None = None) -> NDArray:
        """Smallest local minimum of the gap in all flights, shape (rows,).

        The last slow bounces are left out.
        """
        ends = self.ends(z)
        slow = self._tail(ends.speed)
        slow[:, 0] = False
        time = np.where(slow, 0.0, ends.flight)
        return super().clearance(z, _Lifted(*ends._replace(flight=time)))

    def contact_clearance(self, z: NDArray) -> NDArray:
        return np.full(len(z), FAR)

    def halves(self, z: NDArray) -> NDArray:
        return np.ones((len(z), 1))

    def admissible(self, z: NDArray, linear: LinearizedLegs | None = None) -> NDArray:
        """Whether a ball follows the orbits, shape (rows,).

        The ball must touch the table only at the impacts, rest for a positive time, and leave it at
        the lift-off.
        """
        linear = linear or self.linearized(z)
        good = (self.least_speed(z) > 0) & (linear.flights > 0).all(axis=1)
        return good & (self.rest(z) > 0) & (self.fall(z) > 0) & (self.clearance(z) > 0)


class _Superstable(LinearizedLegs):
    """Linearised equations of orbits with a rest.

    Both multipliers are zero, because the state at the lift-off does not depend on earlier impacts.
    """

    @property
    def trace_and_determinant(self) -> tuple[NDArray, NDArray]:
        return np.zeros(len(self.legs)), np.zeros(len(self.legs))


class _Lifted(Flights):
    """Flights. The first flight starts with a lift-off."""

    def bends(self) -> NDArray:
        """Times of the turning points of flights, without the lift-off itself."""
        times = super().bends()
        first = times[:, 0]
        times[:, 0] = np.where(first < SOON, self.flight[:, :1], first)
        return times


class RestOrbit(PeriodicOrbit):
    """A periodic motion of a ball that rests on the table once in a period.

    It has the attributes of a :class:`PeriodicOrbit`. Bounces that are simulated do not count as
    impacts. Times of flight are those of the flights *before* the impacts; the first flight starts
    at the lift-off.
    """

    equations: RestEquations

    @property
    def _further(self) -> dict:
        return {"lift_off": self.lift_off, "rest": self.rest}

    @property
    def lift_off(self) -> float:
        """Phase of the table at which the ball leaves the table, in (-π, π]."""
        return float(np.pi - (np.pi - self.z[self.equations.size - 1]) % (2 * np.pi))

    @cached_property
    def rest(self) -> float:
        """Duration of the rest on the table.

        The bounces after the last impact are simulated, and summed up by
        :func:`.one_ball.settling`. If the ball does not come to rest, the duration is negative:
        minus the time between its last impact and the lift-off.
        """
        lift_off = float(self.z[self.equations.size - 1]) + PERIOD * self.periods
        last = float(self.times[-1])
        if self.speeds[-1] <= 0:
            return -abs(lift_off - last)
        turns, phase = reduced(self.times[-1:])
        amplitude = np.array([self.amplitude])
        one = Balls(self.ball, amplitude, turns, phase, self.speeds[-1:], self.table)
        while one.phase.size and PERIOD * one.turns[0] + one.phase[0] < lift_off:
            record, _, one = bounce(one, BOUNCES_AT_ONCE)
            for turns, phase, u, _, duration, *_ in record[:, :, 0]:
                tau = float(PERIOD * turns + phase)
                if not tau < lift_off:
                    break
                last = tau
                if duration > 0:
                    return lift_off - tau - self._last_bounces(phase, u)
        return -abs(lift_off - last)

    def _last_bounces(self, phase: float, u: float) -> float:
        """Total time of the bounces after an impact at which the simulation sums them up."""
        w = float(self.ball.contact(phase, u, None, self.amplitude, table=self.table).speed)
        _, y, x = self.table.pulls(self.table.waves(phase, self.amplitude))
        fourth = self.amplitude * self.table.bounds[4]
        return one_ball.settling(w, w / u, float(x), float(y), fourth)

    @cached_property
    def _release(self) -> tuple[NDArray, NDArray]:
        given = self.times, self.speeds, None, self.amplitude
        return self.times, self.ball.contact(*given, table=self.table).speed

    @property
    def monodromy(self) -> NDArray:
        """Zero matrix, shape (2, 2): the lift-off does not depend on earlier impacts."""
        return np.zeros((2, 2))

    @property
    def multipliers(self) -> NDArray:
        """Floquet multipliers, shape (2,): both are zero."""
        return np.zeros(2, complex)


def orbit_with_rest(ball: Ball, *, amplitude: float, table: Table = SINE) -> RestOrbit:
    """Find the periodic motion, with one rest, of a ball with instantaneous impacts.

    Parameters
    ----------
    ball : Ball
        A single ball with instantaneous impacts at the level of the table, such as ``Rigid(0.3)``.
    amplitude : float
        Λ > 0.
    table : Table
        Waveform of the table, by default a sine.

    Returns
    -------
    RestOrbit

    Raises
    ------
    OrbitNotFound
        If the impacts have a duration or are below the table (:class:`.Corrected`). If the ball
        never leaves the table, or does not come to rest again. If it rests several times before
        its motion repeats.
    ValueError
        If an argument is out of range.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> orbit = orbit_with_rest(Rigid(0.3), amplitude=1.9)
    >>> orbit.periods, round(orbit.rest, 6)
    (1, 0.449792)
    """
    check_one_ball(ball)
    check_table(table)
    amplitude = one_amplitude(amplitude)
    if ball.has_duration or ball.below_table:
        raise OrbitNotFound(
            f"ball = {ball!r}: must have impacts at the level of the table, such as Rigid(0.3)"
        )
    starts = table.lift_offs(amplitude)
    if np.isnan(starts[0]):
        raise OrbitNotFound(
            f"the table never falls faster than a ball: its maximum -w″ is"
            f" {amplitude * table.lift:.6g}, but must be above 1: increase the amplitude"
        )
    start = float(starts[0])
    zero = np.zeros(1)
    for _ in range(CYCLES):
        # A ball laid on the table at a lift-off phase leaves at once.
        laid = Balls(ball, zero + amplitude, zero, zero + start, zero, table)
        record = bounce(laid, MOST)[0][1:, :, 0]
        turns, phase, u, _, rests, _, w, _ = record.T
        ends = np.flatnonzero((rests > 0) & (w == 0))
        if not len(ends) or not np.isfinite(rests[ends[0]]):
            raise OrbitNotFound(
                f"the ball does not come to rest and leave again within {MOST} impacts after the"
                f" lift-off at the phase {start:.6g}"
            )
        at = ends[0]
        times = PERIOD * turns + phase
        length = times[at] + rests[at] - start
        if abs(length - PERIOD * round(length / PERIOD)) < SOON:
            break
        start = float(reduced(start + length)[1])
    else:
        raise OrbitNotFound(
            f"the lift-offs of {CYCLES} successive rests differ: the motion does not repeat, or has"
            " several rests; only motions with one rest are found"
        )
    # Newton's method confuses slower bounces with each other. They are no unknowns.
    k = 1 + int(np.argmax(u[: at + 1] < SLOW_BOUNCE))
    equations = RestEquations(ball, k, round(length / PERIOD), table=table)
    columns = np.stack([times[:k], u[:k]], axis=-1).ravel()
    z = np.concatenate([columns, [start, amplitude]])
    solution = newton(equations, z[np.newaxis], iterations=40)
    if not solution.found[0]:
        raise OrbitNotFound("the orbit with a rest is not found: Newton's method does not converge")
    return equations.orbit(solution.z[0])
