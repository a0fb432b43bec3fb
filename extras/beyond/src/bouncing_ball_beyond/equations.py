"""Periodic orbits with k impacts in m periods of the table: their equations and their quantities.

The unknowns of an impact are its time τ, its closing speed u and, if it has a duration, its T. An
orbit is a row z: the unknowns of its k impacts one after the other, and after them the values of
what may change. Functions take many rows at once, (rows, N). docs/orbits.md has the mathematics.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.balls import Ball, H, Impact
from bouncing_ball_beyond.chains import dense, product_of, solve_bordered, solved_or_nan
from bouncing_ball_beyond.paths import AMPLITUDE, Path
from bouncing_ball_beyond.tables import FUNDAMENTAL, SINE, Table

FAR = 10.0
"""A clearance is at most this large: the value where a flight does not come back to the table."""


POINT = (1.0,), (1.0,), 1e-7
CURVE = (1.0, -1.0, 2.0, -2.0), (2 / 3, -2 / 3, -1 / 12, 1 / 12), 1e-4
"""Nodes, weights and steps of the differences for gradients of tests, with errors of 1e-7 in
Newton's method for points and of 1e-12 in tangents of curves."""

LASTING = 4 * np.pi
"""The T from which on its changes count relatively: two free oscillations."""

VANISHED = 1e-12
"""A flight that is no longer than this is none: its times are some thousand roundings."""


@dataclass(frozen=True, eq=False)
class LinearizedLegs:
    """Legs (rows, k, q), their derivatives (rows, k, q, q + 2 + p) by the q unknowns of the impact,
    τ and u of the next one and the p parameters, and their times of flight (rows, k)."""

    legs: NDArray
    derivatives: NDArray
    flights: NDArray

    def rows(self, which: Any) -> "LinearizedLegs":
        """Some of the rows."""
        taken = self.legs[which], self.derivatives[which], self.flights[which]
        return type(self)(*taken)

    @cached_property
    def maps(self) -> NDArray:
        """Derivatives of each next (τ, u) by τ and u of an impact, shape (rows, k, 2, 2)."""
        by_impact = self.derivatives[..., :2]
        by_others = self.derivatives[..., 2 : self.derivatives.shape[-2] + 2]
        return -solved_or_nan(by_others, by_impact)[..., -2:, :]

    @cached_property
    def trace_and_determinant(self) -> tuple[NDArray, NDArray]:
        """Trace and determinant of the derivative of the return map, each of the shape (rows,)."""
        maps = self.maps
        # Their product has all digits where the determinant of the product of the maps has none.
        determinants = maps[..., 0, 0] * maps[..., 1, 1] - maps[..., 0, 1] * maps[..., 1, 0]
        product = product_of(maps)
        return product[:, 0, 0] + product[:, 1, 1], determinants.prod(axis=-1)


class Flights(NamedTuple):
    """The flights after contacts, of the shape (rows, k): the time of the release, δ and δ′ there,
    the time to the next impact, Λ, and the waveform of the table."""

    leaves: NDArray
    gap: NDArray
    speed: NDArray
    flight: NDArray
    amplitude: NDArray
    table: Table

    def at(self, t: NDArray) -> tuple[NDArray, NDArray]:
        """δ and δ′ at times t since the release, shape (rows, k, times)."""
        leaves, gap, speed, _, amplitude = (each[..., np.newaxis] for each in self[:5])
        table = self.table.rows(np.s_[..., np.newaxis])
        return flight(t, leaves, gap, speed, amplitude, table)

    def bends(self) -> NDArray:
        """Times at which δ′ is least or greatest, where -w″ = 1, or ends; (rows, k, times)."""
        phases = self.table.levels(self.amplitude)
        turns = int(np.fmin(_longest(self.flight) / (2 * np.pi), 1000)) + 1
        first = (phases - self.leaves[..., np.newaxis]) % (2 * np.pi)
        times = first[..., np.newaxis] + 2 * np.pi * np.arange(turns)
        times = times.reshape(*self.leaves.shape, phases.shape[-1] * turns)
        return np.fmin(times, self.flight[..., np.newaxis])


def unknowns_of(ball: Ball) -> int:
    """Number q of unknowns of an impact: τ, u and, if it has a duration, T."""
    return 3 if ball.has_duration else 2


def row_of(ball: Ball, times: NDArray, speeds: NDArray, T: Any, *values: Any) -> NDArray:
    """The row z of impacts, without the T of instants, and the values of what may change."""
    columns = np.stack([times, speeds, T][: unknowns_of(ball)], axis=-1)
    return np.append(columns.ravel(), values)


def _some(values: Any, which: Any) -> Any:
    """The values of some rows; a number is that of all."""
    return values[which] if np.ndim(values) else values


@dataclass(frozen=True)
class OrbitEquations:
    """Equations of orbits of one ball, or of a row of balls that differ in their parameters.

    Parameters
    ----------
    ball, periods, amplitude, table
        A ball, m, Λ where it is not what changes, and a waveform: by numbers, or by arrays of the
        shape (rows,).
    impacts : int
        Their number k.
    along : tuple of Path
        What may change. Its values are the last entries of z.
    kind : str
        The kind of special orbits, whose test is one more equation, and "" for all orbits.
    """

    ball: Ball
    impacts: int
    periods: int | NDArray
    amplitude: float | NDArray = np.nan
    along: tuple[Path, ...] = (AMPLITUDE,)
    table: Table = SINE
    kind: str = ""

    @cached_property
    def unknowns(self) -> int:
        """The number q of unknowns of an impact."""
        return unknowns_of(self.ball)

    @cached_property
    def size(self) -> int:
        """The number kq of unknowns of all impacts."""
        return self.impacts * self.unknowns

    @cached_property
    def length(self) -> int:
        """The number N of entries of a row."""
        return self.size + len(self.along)

    def rows(self, which: Any) -> "OrbitEquations":
        """The equations of some of the rows, by an index, a slice or a mask of them."""
        return replace(
            self,
            ball=self.ball.rows(which),
            periods=_some(self.periods, which),
            amplitude=_some(self.amplitude, which),
            table=self.table.rows(which),
        )

    @cached_property
    def _beside_impacts(self) -> tuple[Ball, NDArray, Table]:
        """The ball, Λ and the table as columns, beside arrays of the shape (rows, k)."""
        beside = np.s_[:, np.newaxis]
        amplitude = np.asarray(self.amplitude, float)[..., np.newaxis]
        return self.ball.rows(beside), amplitude, self.table.rows(beside)

    def at(self, values: NDArray) -> tuple[Ball, NDArray, Table]:
        """The ball, Λ and the table, beside impacts, at values of what changes, (..., p)."""
        here = self._beside_impacts
        for j, path in enumerate(self.along):
            here = path.apply(values[..., j, np.newaxis], *here)
        return here

    def orbit(self, z: NDArray, kind: str = "") -> "PeriodicOrbit":
        """One orbit, shape (N,), with its quantities."""
        return PeriodicOrbit(replace(self, kind="") if self.kind else self, z, kind)

    def split(self, z: NDArray) -> tuple[NDArray, Ball, NDArray, Table]:
        """The impacts (rows, k, q) of orbits, and beside them their ball, Λ and table."""
        x = z[:, : self.size].reshape(len(z), self.impacts, self.unknowns)
        return x, *self.at(z[:, self.size :])

    def sizes(self, z: NDArray) -> NDArray:
        """1 + the largest unknown of the impacts, and 1 + |p| of parameters, shape (rows, N)."""
        sizes = 1 + np.abs(z)
        sizes[:, : self.size] = sizes[:, : self.size].max(axis=1, keepdims=True)
        return sizes

    def scales(self, z: NDArray) -> NDArray:
        """Units of the unknowns in which steps are measured, shape (rows, N)."""
        units = np.full(z.shape, np.sqrt(self.impacts))
        x = self.split(z)[0]
        stretch = np.ones(x.shape)
        stretch[..., 2:] = np.maximum(np.abs(x[..., 2:]) / LASTING, 1.0)
        units[:, : stretch[0].size] *= stretch.reshape(len(z), -1)
        units[:, self.size :] = np.maximum(np.abs(z[:, self.size :]), 1e-2)
        return units

    def following(self, x: NDArray) -> NDArray:
        """For each impact the next one; after the last the first, m periods later."""
        following = np.concatenate([x[:, 1:], x[:, :1]], axis=1)
        following[:, -1, 0] += 2 * np.pi * np.asarray(self.periods)
        return following

    @cached_property
    def _steps(self) -> tuple[NDArray, NDArray]:
        """Complex steps of the unknowns of a leg and of the parameters, one each."""
        inner = self.unknowns + 2
        steps = 1j * H * np.eye(inner + len(self.along))
        return steps[:, np.newaxis, np.newaxis, :inner], steps[:, np.newaxis, inner:]

    def linearized(self, z: NDArray) -> LinearizedLegs:
        """The legs, contacts with the flights after them, and their derivatives: the contact ends
        where its release is zero, and the flight with the gap and the speed of the next impact."""
        q = self.unknowns
        x = z[:, : self.size].reshape(len(z), self.impacts, q)
        of_legs, of_parameters = self._steps
        y = np.concatenate([x, self.following(x)[..., :2]], axis=-1) + of_legs
        values = z[:, self.size :] + of_parameters
        legs, flights = self._legs(y, *self.at(values))
        return LinearizedLegs(legs[0].real, legs.imag.transpose(1, 2, 3, 0) / H, flights[0].real)

    def legs(self, z: NDArray) -> NDArray:
        """The legs alone, shape (rows, k, q)."""
        x, ball, amplitude, table = self.split(z)
        y = np.concatenate([x, self.following(x)[..., :2]], axis=-1)
        return self._legs(y, ball, amplitude, table)[0]

    def _legs(
        self, y: NDArray, ball: Ball, amplitude: Any, table: Table
    ) -> tuple[NDArray, NDArray]:
        """Legs and times of flight from y: q unknowns of an impact, then τ and u of the next."""
        q = self.unknowns
        impact = ball.contact(y[..., 0], y[..., 1], y[..., q - 1], amplitude, table=table)
        leaves = y[..., 0] + impact.duration
        flights = y[..., q] - leaves
        gap, rate = flight(flights, leaves, impact.gap, impact.speed, amplitude, table)
        legs = np.empty((*y.shape[:-1], q), y.dtype)
        legs[..., : q - 2] = impact.release[..., np.newaxis]
        legs[..., q - 2] = gap - ball.start(y[..., q + 1])
        legs[..., q - 1] = rate + y[..., q + 1]
        return legs, flights

    def bordered(
        self, z: NDArray, linear: LinearizedLegs, normal: NDArray, condition: tuple | None = None
    ) -> NDArray:
        """The step of Newton's method to the plane through z across a normal, and the tangent with
        normal · tangent = 1, shape (rows, N, 2); NaN for singular equations.

        Special orbits are points along one parameter, and need no plane.
        """
        border = normal[:, np.newaxis]
        right = np.zeros((len(z), 1, 2))
        right[..., 1] = 1.0
        if self.kind:
            value, gradient = condition or self.condition(z)
            special = np.stack([-value, 0 * value], axis=-1)[:, np.newaxis]
            points = len(self.along) == 1
            border = np.concatenate([gradient[:, np.newaxis], border[:, points:]], axis=1)
            right = np.concatenate([special, right[:, points:]], axis=1)
        return self.solve(linear, border, right)

    def solve(self, linear: LinearizedLegs, border: NDArray, right: NDArray) -> NDArray:
        """The solutions of the linear equations and the border, for -legs and for no legs."""
        legs = np.zeros((*linear.legs.shape, 2))
        legs[..., 0] = -linear.legs
        return solve_bordered(linear.derivatives, legs, border, right)

    def excess(self, z: NDArray, linear: LinearizedLegs) -> NDArray:
        """What is zero at special orbits of the kind, shape (rows,): see :meth:`condition`."""
        if self.kind not in MULTIPLIERS:
            return KINDS[self.kind].test(self, z, linear)
        trace, determinant = linear.trace_and_determinant
        return 1 - MULTIPLIERS[self.kind] * trace + determinant

    def condition(self, z: NDArray) -> tuple[NDArray, NDArray]:
        """The equation of special orbits, shape (rows,), and its gradient, shape (rows, N).

        For a multiplier μ it is χ = 1 - μ tr + det = 0, and the gradient is that of χ ∏ρ with the
        rates ρ of the release functions, which has no poles (docs/orbits.md).
        """
        rows, length = z.shape
        nodes, weights, step = CURVE if len(self.along) > 1 else POINT
        shift = step * self.scales(z)
        nudges = np.concatenate([np.zeros((1, length)), *np.multiply.outer(nodes, np.eye(length))])
        nearby = (z + nudges[:, np.newaxis] * shift).reshape(-1, length)
        each = self.rows(np.tile(np.arange(rows), len(nudges)))
        linear = each.linearized(nearby)
        values = each.excess(nearby, linear)
        rates = np.ones(len(nearby))
        if self.kind in MULTIPLIERS:
            rates = linear.derivatives[..., 0, 2 : self.unknowns].prod(axis=(1, 2))
        here, beside = np.split(np.stack([values * rates, rates]), [rows], axis=1)
        beside = beside.reshape(2, len(nodes), length, rows)
        beside -= here[:, np.newaxis, np.newaxis]
        slopes = np.einsum("n,inlr->irl", weights, beside) / shift
        value = values[:rows]
        gradient = slopes[0] - value[:, np.newaxis] * slopes[1]
        return value, gradient / rates[:rows, np.newaxis]

    kinds = (
        "saddle-node",
        "period doubling",
        "vanishing flight",
        "grazing of an impact",
        "lost release",
        "period halving",
    )
    """The kinds of special orbits that a march watches: they cost little, or end a curve."""

    def tests(self, z: NDArray, linear: LinearizedLegs) -> NDArray:
        """What is zero at the special orbits that a march watches, shape (rows, tests); 1 for those
        of the kind of a curve."""
        columns = [
            np.ones(len(z)) if name == self.kind else KINDS[name].test(self, z, linear)
            for name in self.kinds
        ]
        return np.stack(columns, axis=1)

    def residuals(self, z: NDArray) -> tuple[NDArray, NDArray]:
        """The equations, shape (rows, kq), and their Jacobian, shape (rows, kq, N)."""
        linear = self.linearized(z)
        legs = linear.legs.reshape(len(z), self.size)
        return legs, dense(linear.derivatives).reshape(len(z), self.size, self.length)

    def turn(self, linear: LinearizedLegs) -> NDArray:
        """tr/(1 + det): 1 where a multiplier is 1, -1 where one is -1, between them if stable."""
        trace, determinant = linear.trace_and_determinant
        return trace / (1 + determinant)

    def stable(self, linear: LinearizedLegs) -> NDArray:
        """Whether no neighbouring motion leaves the orbits, shape (rows,)."""
        trace, determinant = linear.trace_and_determinant
        # The determinant of an elastic ball is 1 up to rounding.
        return (np.abs(trace) < 1 + determinant) & (determinant < 1 + 1e-9)

    def ends(self, z: NDArray) -> Flights:
        """The ends of the contacts and the flights after them."""
        x, ball, amplitude, table = self.split(z)
        impact = ball.contact(x[..., 0], x[..., 1], x[..., -1], amplitude, table=table)
        leaves = x[..., 0] + impact.duration
        time = self.following(x)[..., 0] - leaves
        amplitude = np.broadcast_to(amplitude, leaves.shape)
        return Flights(leaves, impact.gap, impact.speed, time, amplitude, table)

    def clearance(self, z: NDArray, flights: Flights | None = None) -> NDArray:
        """How far balls are above the table where flights turn back from it: the least of all."""
        flights = flights or self.ends(z)
        # Between these times δ′ is monotonic, so that short dips after a slow start are found, too.
        bends = flights.bends()
        return turns_back(
            lambda t: flights.at(t)[1],
            lambda t: flights.at(t)[0],
            flights.flight,
            among=bends,
            waves=self.table.orders[-1],
        ).min(axis=-1)

    def contact_clearance(self, z: NDArray) -> NDArray:
        """How far release functions are below zero where they turn back: the least of all."""
        if not self.ball.has_duration:
            return np.full(len(z), FAR)
        x, ball, amplitude, table = self.split(z)
        length = x[..., 2]
        places = samples_in(length)
        slopes = ball.release_slopes(x[..., 0], x[..., 1], length, places, amplitude, table)
        falling = None if slopes is None else -slopes
        during: Any = self._during(z)
        return turns_back(
            lambda t: -_derivative(lambda s: during(s).release, t),
            lambda t: -during(t).release,
            length,
            slopes=falling,
        ).min(axis=-1)

    def max_height(self, z: NDArray) -> NDArray:
        """The greatest height of the ball, shape (rows,): in a flight, or in a compliant contact in
        which the table lifts it higher than it flies."""
        leaves, gap, speed, time, amplitude, table = self.ends(z)
        bounce = speed + amplitude * table(leaves, 1)
        rise = np.clip(bounce, 0, time)
        height = gap + amplitude * table(leaves) + (bounce - rise / 2) * rise
        height = height.max(axis=-1)
        lifts = amplitude * sum(np.abs(size) for size in table.sizes)
        low = height < lifts.max(axis=-1)
        if not self.ball.has_duration or not low.any():
            return height
        if not low.all():
            height[low] = self.rows(low).max_height(z[low])
            return height
        x = self.split(z)[0]
        during = self._during(z)
        table = table.rows(np.s_[..., np.newaxis])

        def moved(t: NDArray, order: int) -> NDArray:
            phase = x[..., 0, np.newaxis] + during(t).duration
            return amplitude[..., np.newaxis] * table(phase, order)

        lifted = turns_back(
            lambda t: -during(t).speed - moved(t, 1),
            lambda t: -during(t).gap - moved(t, 0),
            x[..., 2],
        )
        return np.maximum(height, -lifted.min(axis=-1))

    def _during(self, z: NDArray) -> Callable[[NDArray], Impact]:
        """The contacts of orbits as a function of T, shape (rows, k, times)."""
        x, ball, amplitude, table = self.split(z)
        beside = ball.rows(np.s_[..., np.newaxis])
        table = table.rows(np.s_[..., np.newaxis])
        given = x[..., 0, np.newaxis], x[..., 1, np.newaxis]
        amplitude = np.asarray(amplitude)[..., np.newaxis]
        return lambda t: beside.contact(*given, t, amplitude, table=table)

    def least_speed(self, z: NDArray) -> NDArray:
        """The closing speed next to zero, negative if an odd number of impacts have u < 0."""
        speeds = self.split(z)[0][..., 1]
        return np.abs(speeds).min(axis=-1) * np.sign(speeds).prod(axis=-1)

    def least_release(
        self, linear: LinearizedLegs | None, z: NDArray, flights: Flights | None = None
    ) -> NDArray:
        """How well balls leave after impacts, the least of all: the rate of the release, δ′ of an
        instant, which needs no derivatives, or the summit after one below the table."""
        if self.ball.has_duration:
            linear = self.linearized(z) if linear is None else linear
            return linear.derivatives[..., 0, 2].min(axis=-1)
        flights = flights or self.ends(z)
        if np.all(flights.gap >= 0):
            return flights.speed.min(axis=-1)
        depth = turns_back(
            lambda t: -flights.at(t)[1], lambda t: -flights.at(t)[0], flights.flight, first=True
        )
        return -depth.max(axis=-1)

    def halves(self, z: NDArray) -> NDArray:
        """Differences of the impacts half an orbit apart, shape (rows, kq/2); 1 without halves."""
        if self.impacts % 2:
            return np.ones((len(z), 1))
        x = self.split(z)[0]
        half = self.impacts // 2
        periods = np.reshape(self.periods, (-1, 1))
        apart = x[:, :half] - x[:, half:]
        apart[..., 0] += np.pi * periods
        return np.where(periods % 2 == 0, apart.reshape(len(z), -1), 1.0)

    def halved(self, z: NDArray) -> tuple["OrbitEquations", NDArray]:
        """The equations of half the period, and the mean of the halves of orbits."""
        half = replace(self, impacts=self.impacts // 2, periods=np.asarray(self.periods) // 2)
        mean = z[:, : half.size] - self.halves(z) / 2
        return half, np.concatenate([mean, z[:, self.size :]], axis=1)

    def doubled(self, z: NDArray) -> tuple["OrbitEquations", NDArray]:
        """The equations of twice the period, and orbits taken twice."""
        twice = replace(self, impacts=2 * self.impacts, periods=2 * np.asarray(self.periods))
        return twice, np.concatenate([z[:, : self.size], self.later(z, self.periods)], axis=1)

    def later(self, z: NDArray, turns: Any) -> NDArray:
        """Shift orbits by a number of turns of the table, by rows."""
        z = z.copy()
        z[:, : self.size : self.unknowns] += 2 * np.pi * np.reshape(turns, (-1, 1))
        return z

    def admissible(self, z: NDArray, linear: LinearizedLegs | None = None) -> NDArray:
        """Whether a ball follows the orbit: nothing else happens in its contacts and flights."""
        x, ball, *_ = self.split(z)
        ends = self.ends(z)
        landing = (x[..., 1] > 0) | (np.broadcast_to(ball.kappa, x.shape[:2]) > 0)
        release = self.least_release(linear, z, ends)
        # A ball without speed leaves the table if this falls faster than the ball: δ″ > 0.
        falls = (ends.amplitude * ends.table(ends.leaves, 2) < -1).all(axis=-1)
        leaving = (release > 0) | ((release == 0) & falls)
        lasting = (ends.flight > 0) & (ends.leaves >= x[..., 0])
        clear = (self.clearance(z, ends) > 0) & (self.contact_clearance(z) > 0)
        return clear & leaving & (landing & lasting).all(axis=-1)


def _derivative(function: Callable, t: NDArray) -> NDArray:
    """The derivative of an analytic function, also at complex steps, whose derivatives it has."""
    if not np.iscomplexobj(t):
        return function(t + 1j * H).imag / H
    # Two derivatives: a difference of complex steps serves Newton's method.
    step = 1e-6
    slopes = [function(t.real + shift + 1j * H).imag / H for shift in (-step, 0.0, step)]
    return slopes[1] + 1j * H * (slopes[2] - slopes[0]) / (2 * step)


def flight(
    s: Any, leaves: Any, gap: Any, speed: Any, amplitude: Any, table: Table = SINE
) -> tuple[Any, Any]:
    """δ and δ′ a time s after a ball left at the time `leaves` with δ′ = speed: δ″ = -1 - w″."""
    height, gained = table.rise(leaves, s)
    bounce = speed + amplitude * table(leaves, 1)
    return gap + (bounce - s / 2) * s - amplitude * height, speed - s - amplitude * gained


def _longest(times: NDArray) -> float:
    """The greatest of times, at least 0; NaN, of a ball that does not leave the table, is none."""
    return np.fmax.reduce(times, axis=None, initial=0.0)


def samples_in(ends: NDArray, waves: int = 1) -> NDArray:
    """Places on [0, 1] at which :func:`turns_back` takes samples."""
    return np.linspace(0, 1, int(np.clip(32 * waves * _longest(ends) / (2 * np.pi), 32, 2000)) + 1)


def turns_back(
    slope: Callable,
    value: Callable,
    ends: NDArray,
    *,
    first: bool = False,
    among: NDArray | None = None,
    waves: int = 1,
    slopes: NDArray | None = None,
) -> NDArray:
    """Return the smallest local minimum of functions of the time in (0, ends), or the first one.

    The minimum is at most FAR, and FAR if there is none. The slope is an analytic positive multiple
    of the derivative. It is sampled at 32 times in each wave of a table, and also at the times
    ``among``, shape (..., m). ``slopes`` are the slopes at the samples, if they are known within
    small errors.
    """
    times = ends[..., np.newaxis] * samples_in(ends, waves)
    if among is not None:
        times = np.sort(np.concatenate([times, among], axis=-1), axis=-1)
    slopes = slope(times) if slopes is None else slopes
    turns = (slopes[..., :-1] < 0) & (slopes[..., 1:] >= 0)
    if not turns.any():
        return np.full(ends.shape, FAR)
    lowest = np.where(turns, value(times)[..., 1:], np.inf).argmin(axis=-1)
    which = (turns.argmax(axis=-1) if first else lowest)[..., np.newaxis]
    low = np.take_along_axis(times, which, axis=-1)
    high = np.take_along_axis(times, which + 1, axis=-1)
    middle = (low + high) / 2
    for _ in range(6):
        here = slope(middle + 1j * H)
        with np.errstate(divide="ignore", invalid="ignore"):
            middle = middle - here.real * H / here.imag
        middle = np.clip(np.where(np.isnan(middle), low, middle), low, high)
    least = np.where(turns.any(axis=-1), value(middle)[..., 0], FAR)
    return np.minimum(least, FAR)


class OrbitNotFound(ValueError):
    """There is no such orbit, or it is not found: one line with what was looked for, and why."""


def alone(found: Any) -> Any:
    """What was found for a single ball or orbit; the reason is raised if there is nothing."""
    if isinstance(found, OrbitNotFound):
        raise found
    return found


@dataclass(frozen=True, eq=False, repr=False)
class PeriodicOrbit:
    """A periodic orbit: its equations, their solution z, shape (N,), and the kind of a special one.

    Quantities of the impacts are floats for one impact, and arrays of the shape (impacts,)
    otherwise. Velocities are absolute unless their names say relative, in units of g/Ω; times are
    in units of 1/Ω, heights in units of g/Ω².
    """

    equations: OrbitEquations
    z: NDArray
    kind: str = ""

    def __repr__(self) -> str:
        rows = {
            **({"kind": self.kind} if self.kind else {}),
            "impacts": self.impacts,
            "periods": self.periods,
            **{name: x for name, x in self.parameters.items() if FUNDAMENTAL.get(name) != x},
            **self._further,
            "phase": self.phase,
            "contact_duration": self.contact_duration,
            "impact_velocity": self.impact_velocity,
            "bounce_velocity": self.bounce_velocity,
            "apparent_restitution": self.apparent_restitution,
            "max_height": self.max_height,
            # A special orbit is between both, and rounding would decide.
            **({} if self.kind else {"stable": self.stable}),
            "admissible": self.admissible,
        }
        width = max(map(len, rows))
        return "\n".join(
            [
                type(self).__name__,
                *(f"  {name:{width}}  {_short(row)}" for name, row in rows.items()),
            ]
        )

    @property
    def _further(self) -> dict:
        """What orbits of a kind of their own have besides."""
        return {}

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
        equations = self.equations
        here = equations.ball, equations.amplitude, equations.table
        for path, value in zip(equations.along, self.z[equations.size :], strict=True):
            here = path.apply(value, *here)
        return here[0], float(here[1]), here[2]

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
        return self.equations.split(self.z[np.newaxis])[0][0]

    def on(self, *paths: Path) -> tuple[OrbitEquations, NDArray]:
        """The equations along paths, and its row; ValueError if the orbit is not on a path."""
        here = self.ball, self.amplitude, self.table
        equations = replace(
            self.equations, ball=here[0], amplitude=here[1], table=here[2], along=paths
        )
        values = [float(path.place(*here)) for path in paths]
        return equations, np.append(self.z[: equations.size], values)

    @cached_property
    def _ends(self) -> Flights:
        return self.equations.ends(self.z[np.newaxis])

    @cached_property
    def _release(self) -> tuple[NDArray, NDArray]:
        """When the ball leaves the table after its impacts, and δ′ then."""
        return self._ends.leaves[0], self._ends.speed[0]

    @cached_property
    def _linear(self) -> LinearizedLegs:
        return self.equations.linearized(self.z[np.newaxis])

    def _each(self, values: NDArray) -> float | NDArray:
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
    def scaled_durations(self) -> NDArray:
        """T of the contacts, shape (impacts,); empty for instants."""
        return self._impacts[:, 2:].ravel()

    @property
    def phase(self) -> float | NDArray:
        """Phase of the table as an impact starts, in (-π, π]."""
        return self._each(np.pi - (np.pi - self.times) % (2 * np.pi))

    @property
    def release_phase(self) -> float | NDArray:
        """Phase of the table at the end of the contact, in (-π, π]."""
        return self._each(np.pi - (np.pi - self._release[0]) % (2 * np.pi))

    @property
    def contact_duration(self) -> float | NDArray:
        """Duration of the contact."""
        return self._each(self._release[0] - self.times)

    @property
    def flight_time(self) -> float | NDArray:
        """Duration of the flight after the contact."""
        return self._each(self._ends.flight[0])

    @property
    def relative_impact_velocity(self) -> float | NDArray:
        """δ′ as an impact starts, negative but where a contact resumes."""
        return self._each(-self.speeds)

    @property
    def relative_bounce_velocity(self) -> float | NDArray:
        """δ′ as the contact ends."""
        return self._each(self._release[1])

    @property
    def impact_velocity(self) -> float | NDArray:
        """Absolute velocity of the ball as an impact starts, in units of g/Ω."""
        return self._each(self.amplitude * self.table(self.times, 1) - self.speeds)

    @property
    def bounce_velocity(self) -> float | NDArray:
        """Velocity of the ball as the contact ends."""
        leaves, speed = self._release
        return self._each(self.amplitude * self.table(leaves, 1) + speed)

    @property
    def apparent_restitution(self) -> float | NDArray:
        """r_a = -δ′_b/δ′_i (Eq. 17)."""
        return self._each(self._release[1] / self.speeds)

    @cached_property
    def max_height(self) -> float:
        """The greatest height of the ball, in a flight or in a contact."""
        return float(self.equations.max_height(self.z[np.newaxis])[0])

    @property
    def monodromy(self) -> NDArray:
        """Derivative of the return map in (τ, δ′) as the first impact starts, shape (2, 2)."""
        signs = np.diag([1.0, -1.0])
        return signs @ product_of(self._linear.maps)[0] @ signs

    @cached_property
    def trace_and_determinant(self) -> tuple[float, float]:
        """Trace and determinant of the derivative of the return map."""
        trace, determinant = self._linear.trace_and_determinant
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
        """tr/(1 + det): 1 at a saddle-node, -1 at a doubling; it may be infinite at a grazing."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return float(self.equations.turn(self._linear)[0])

    @property
    def stable(self) -> bool:
        """Whether no neighbouring motion leaves; those of an elastic ball stay near."""
        return bool(self.equations.stable(self._linear)[0])

    @cached_property
    def admissible(self) -> bool:
        """Whether a ball follows the orbit: nothing else happens in its contacts and flights."""
        return bool(self.equations.admissible(self.z[np.newaxis], self._linear)[0])

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
        """The largest difference of phases, speeds and T of two orbits, from whichever impact one
        starts; infinite for other numbers of impacts or periods."""
        if (self.impacts, self.periods) != (other.impacts, other.periods):
            return np.inf
        shifts = [np.roll(other._impacts, j, axis=0) - self._impacts for j in range(self.impacts)]
        for shift in shifts:
            shift[:, 0] = (shift[:, 0] + np.pi) % (2 * np.pi) - np.pi
        return float(min(np.abs(shift).max() for shift in shifts))


def _short(value: Any) -> str:
    """A value of a quantity with six digits."""
    if isinstance(value, np.ndarray):
        text = " ".join(f"{each:.6g}" for each in value[:4])
        return f"[{text}{' …' if len(value) > 4 else ''}]"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


class Kind(NamedTuple):
    """A kind of special orbit: what is zero there, a function of equations, orbits and their
    derivatives, and why branches end there, empty if they go on."""

    test: Callable[[Any, NDArray, Any], NDArray]
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
        lambda equations, z, linear: np.linalg.norm(equations.halves(z), axis=1),
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
"""Those tests of `OrbitEquations.kinds` at which multipliers have poles or jump: beyond them
there are no orbits."""

MULTIPLIERS = {"saddle-node": 1, "period doubling": -1}
"""The multiplier that a kind of special orbit has."""
