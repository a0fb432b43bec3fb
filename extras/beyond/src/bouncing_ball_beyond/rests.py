"""Orbits of a ball that comes to rest on the table and leaves it with the next lift-off.

The return to rest is no equation, because it holds for all values of the parameters nearby; the
length of the rest is a test function: docs/orbits.md.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.balls import Ball, H, check_ball, whole_number
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
from bouncing_ball_beyond.tables import SINE, Table, check_table

SLOW_BOUNCE = 1e-2
"""The last bounces that are slower than this do not tell where a flight or an impact grazes."""

SOON = 1e-6
"""A flight after a lift-off does not turn back so soon: it starts as slowly as t³."""

MOST = 2000
"""The largest number of impacts between a lift-off and the rest after it."""

CYCLES = 20
"""The largest number of rests after which a ball leaves at the same lift-off again."""


@dataclass(frozen=True)
class RestEquations(OrbitEquations):
    """Orbits with a rest: z = (τ₁, u₁, …, τ_k, u_k, τ₀, parameters), with the lift-off at τ₀, and
    the functions of :class:`OrbitEquations`. After the last of the k impacts the bounces are summed
    up.
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
    """The first two have no tests: both multipliers are zero."""

    def orbit(self, z: NDArray, kind: str = "") -> "RestOrbit":
        return RestOrbit(self, z, kind)

    def split(self, z: NDArray) -> tuple[NDArray, Ball, NDArray, Table]:
        """The impacts (rows, k, 2), ball, Λ and table; the lift-off is not among them."""
        x = z[..., : 2 * self.impacts].reshape(*z.shape[:-1], self.impacts, 2)
        return x, *self.at(z[..., self.size :])

    def ends(self, z: NDArray) -> Flights:
        """The flights after the lift-off and after all impacts but the last."""
        x, ball, amplitude, table = self.split(z)
        before = x[..., :-1, :]
        bounce = ball.contact(before[..., 0], before[..., 1], None, amplitude, table=table)
        start = z[..., self.size - 1 : self.size]
        leaves = np.concatenate([start, before[..., 0]], axis=-1)
        speed = np.concatenate([0 * start, bounce.speed], axis=-1)
        time = x[..., 0] - leaves
        return Flights(leaves, 0 * time, speed, time, amplitude + 0 * leaves, table)

    def linearized(self, z: NDArray) -> LinearizedLegs:
        """The equations, shape (rows, N - p, 1), their derivatives, and the times of flight,
        without the last slow bounces.
        """
        y = z + 1j * H * np.eye(z.shape[1])[:, np.newaxis]
        x, _, amplitude, _ = self.split(y)
        leaves, gap, speed, time, _, table = self.ends(y)
        gap, rate = flight(time, leaves, gap, speed, amplitude, table)
        lifts = 1 + amplitude * table(leaves[..., :1], 2)
        values = np.concatenate([lifts, gap, rate + x[..., 1]], axis=-1)
        derivatives = np.moveaxis(values.imag, 0, -1) / H
        lasting = np.where(self._tail(speed[0].real), FAR, time[0].real)
        return _Superstable(values[0].real[..., np.newaxis], derivatives, lasting)

    @staticmethod
    def _tail(speeds: NDArray) -> NDArray:
        """Which of the speeds are those of the last slow bounces, shape (rows, k)."""
        return np.cumprod(np.abs(speeds[:, ::-1]) < SLOW_BOUNCE, axis=1)[:, ::-1].astype(bool)

    def solve(self, linear: LinearizedLegs, border: NDArray, right: NDArray) -> NDArray:
        legs = np.stack([-linear.legs[..., 0], 0 * linear.legs[..., 0]], axis=-1)
        matrix = np.concatenate([linear.derivatives, border], axis=1)
        return solved_or_nan(matrix, np.concatenate([legs, right], axis=1))

    def residuals(self, z: NDArray) -> tuple[NDArray, NDArray]:
        linear = self.linearized(z)
        return linear.legs[..., 0], linear.derivatives

    def rest(self, z: NDArray) -> NDArray:
        """How long the ball rests, shape (rows,), by the sum of :func:`.one_ball.settling`."""
        x, ball, amplitude, table = self.split(z)
        tau, u = (x[..., -1:, i] for i in (0, 1))
        w = ball.contact(tau, u, None, amplitude, table=table).speed
        gravity = 1 + amplitude * table(tau, 2)
        whole = 2 * w / (gravity * (1 - w / u))
        bounces = whole * (1 - amplitude * table(tau, 3) * whole / (3 * gravity))
        period = 2 * np.pi * np.asarray(self.periods)
        return z[:, self.size - 1] + period - (tau + bounces)[..., 0]

    def fall(self, z: NDArray) -> NDArray:
        """How fast the table falls away at the lift-off, shape (rows,): -w‴."""
        _, _, amplitude, table = self.split(z)
        return -(amplitude * table(z[:, self.size - 1 : self.size], 3))[..., 0]

    def least_speed(self, z: NDArray) -> NDArray:
        """The least closing speed, without the last slow bounces."""
        speeds = self.split(z)[0][..., 1]
        return np.where(self._tail(speeds), FAR, speeds).min(axis=1)

    def clearance(self, z: NDArray, flights: Flights | None = None) -> NDArray:
        """How far the ball is above the table where flights turn back, without the last slow
        bounces.
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
        """Whether a ball follows the orbit: it touches the table only at its impacts, and rests."""
        linear = linear or self.linearized(z)
        good = (self.least_speed(z) > 0) & (linear.flights > 0).all(axis=1)
        return good & (self.rest(z) > 0) & (self.fall(z) > 0) & (self.clearance(z) > 0)


class _Superstable(LinearizedLegs):
    """Equations of orbits whose multipliers are zero, because the ball leaves without a memory."""

    @property
    def trace_and_determinant(self) -> tuple[NDArray, NDArray]:
        return np.zeros(len(self.legs)), np.zeros(len(self.legs))


class _Lifted(Flights):
    """Flights of which the first one starts with a lift-off."""

    def bends(self) -> NDArray:
        """As of other flights, without the lift-off itself."""
        times = super().bends()
        first = times[:, 0]
        times[:, 0] = np.where(first < SOON, self.flight[:, :1], first)
        return times


class RestOrbit(PeriodicOrbit):
    """A periodic motion of a ball that rests on the table once in its period.

    Its impacts are those up to the bounces that are summed up. Times of flight are those before the
    impacts, the first one from the lift-off on; see :class:`PeriodicOrbit`.
    """

    equations: RestEquations

    @property
    def _further(self) -> dict:
        return {"lift_off": self.lift_off, "rest": self.rest}

    @property
    def lift_off(self) -> float:
        """Phase of the table at which the ball leaves it, in (-π, π]."""
        return float(np.pi - (np.pi - self.z[self.equations.size - 1]) % (2 * np.pi))

    @property
    def rest(self) -> float:
        """How long the ball rests on the table."""
        return float(self.equations.rest(self.z[np.newaxis])[0])

    @cached_property
    def _release(self) -> tuple[NDArray, NDArray]:
        given = self.times, self.speeds, None, self.amplitude
        return self.times, self.ball.contact(*given, table=self.table).speed

    @property
    def monodromy(self) -> NDArray:
        """Zero: the ball leaves without a memory."""
        return np.zeros((2, 2))

    @property
    def multipliers(self) -> NDArray:
        """Both are zero."""
        return np.zeros(2, complex)


def orbit_with_rest(
    ball: Ball, *, amplitude: float, impacts: int | None = None, table: Table = SINE
) -> RestOrbit:
    """Find the periodic motion with one rest of a ball with instantaneous impacts.

    After so many `impacts` the bounces are summed up; by default after those of the simulation,
    which leaves an error of 1e-15. OrbitNotFound if the ball does not leave, or come to rest.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid
    >>> orbit = orbit_with_rest(Rigid(0.3), amplitude=1.9)
    >>> orbit.periods, round(orbit.rest, 6)
    (1, 0.449792)
    """
    check_ball(ball)
    check_table(table)
    amplitude = one_amplitude(amplitude)
    if ball.has_duration or ball.below_table:
        raise ValueError(
            f"ball = {ball!r}: must have impacts at the level of the table, such as Rigid(0.3)"
        )
    impacts = None if impacts is None else whole_number("impacts", impacts)
    starts = table.lift_offs(amplitude)
    if np.isnan(starts[0]):
        raise OrbitNotFound(
            f"the table never falls faster than a ball: its greatest -w″ is"
            f" {amplitude * table.lift:.6g}"
        )
    start = float(starts[0])
    zero = np.zeros(1)
    for _ in range(CYCLES):
        # A ball that is laid on the table where it lifts off leaves at once.
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
            "the ball leaves at other lift-offs each time: its motion does not repeat, or has"
            " several rests, with which it is not followed"
        )
    hops = list(zip(times[: at + 1], u[: at + 1], strict=True))
    # Bounces that the simulation sums up: Newton's method makes them exact.
    while impacts is not None and len(hops) < impacts:
        tau, fast = hops[-1]
        slow = float(ball.contact(tau, fast, None, amplitude, table=table).speed)
        hops.append((tau + 2 * slow / (1 + amplitude * float(table(tau, 2))), slow))
    hops = hops[:impacts]
    equations = RestEquations(ball, len(hops), round(length / PERIOD), table=table)
    columns = np.array(hops).ravel()
    z = np.concatenate([columns, [start, amplitude]])
    solution = newton(equations, z[np.newaxis], iterations=40)
    if not solution.found[0]:
        raise OrbitNotFound("the orbit with a rest is not found: Newton's method does not converge")
    return equations.orbit(solution.z[0])
