"""The equations of periodic orbits with k impacts in m periods of the table, and Newton's method.

The unknowns of an impact are its time τ, its closing speed u and, if it has a duration, its T.
Times grow along an orbit, so that a flight ends where the next impact starts, and nothing has to
be searched for. An orbit is a row z: the unknowns of its k impacts one after the other, and after
them the values of the parameters that may change. Functions take many rows at once, (rows, N).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.balls import Ball, H, Impact
from bouncing_ball_beyond.paths import AMPLITUDE, Path
from bouncing_ball_beyond.tables import SINE, Table

FAR = 10.0
"""A clearance is at most this large: the value where a flight does not come back to the table."""

ROUNDING = 4 * np.finfo(float).eps
"""Rounding errors of the equations, relative to their largest terms."""

VANISHED = 1e-12
"""A flight that is no longer than this is none: its times are some thousand roundings."""

DENSE = 16
"""Systems of more legs are halved: libraries of linear algebra start threads for large matrices."""


class Linear(NamedTuple):
    """The legs of orbits and their derivatives.

    ``legs`` has the shape (rows, k, q) for q unknowns of an impact. ``derivatives`` has the shape
    (rows, k, q, q + 2 + p): by the unknowns of the impact, by τ and u of the next one, and by the p
    parameters. ``flights`` are the times between contacts, shape (rows, k).
    """

    legs: NDArray
    derivatives: NDArray
    flights: NDArray


class Flights(NamedTuple):
    """The flights after contacts, each field of the shape (rows, k).

    ``leaves`` is the time of the release, ``gap`` and ``speed`` are δ and δ′ there, ``flight`` is
    the time to the next impact, ``amplitude`` is Λ, and ``table`` the waveform.
    """

    leaves: NDArray
    gap: NDArray
    speed: NDArray
    flight: NDArray
    amplitude: NDArray
    table: Table

    def at(self, t) -> tuple[NDArray, NDArray]:
        """δ and δ′ at times t since the release, shape (rows, k, times)."""
        leaves, gap, speed, _, amplitude = (each[..., np.newaxis] for each in self[:5])
        table = self.table.rows(np.s_[..., np.newaxis])
        return flight(t, leaves, gap, speed, amplitude, table)

    def bends(self) -> NDArray:
        """Times in the flights at which δ′ is least or greatest, because -w″ = 1 there.

        Shape (rows, k, times), with the end of a flight in place of times after it.
        """
        phases = self.table.levels(self.amplitude)
        turns = int(np.fmin(_longest(self.flight) / (2 * np.pi), 1000)) + 1
        first = (phases - self.leaves[..., np.newaxis]) % (2 * np.pi)
        times = first[..., np.newaxis] + 2 * np.pi * np.arange(turns)
        times = times.reshape(*self.leaves.shape, phases.shape[-1] * turns)
        return np.fmin(times, self.flight[..., np.newaxis])


def _some(values, which):
    """The values of some rows; a number is that of all."""
    return values[which] if np.ndim(values) else values


@dataclass(frozen=True)
class OrbitEquations:
    """Equations of orbits of one ball, or of a row of balls that differ in their parameters.

    Parameters
    ----------
    ball : Ball
        Its parameters are numbers, or arrays of the shape (rows,).
    impacts : int
        Their number k.
    periods : int or ndarray, shape (rows,)
        The number m of periods of the table after which the motion repeats.
    amplitude : float or ndarray, shape (rows,)
        Λ, where it is not what changes.
    along : tuple of Path
        What may change. Its values are the last entries of z.
    table : Table
        The waveform of the table; its parameters are numbers, or arrays of the shape (rows,).
    """

    ball: Ball
    impacts: int
    periods: int | NDArray
    amplitude: float | NDArray = np.nan
    along: tuple[Path, ...] = (AMPLITUDE,)
    table: Table = SINE

    @cached_property
    def unknowns(self) -> int:
        """The number q of unknowns of an impact."""
        return 3 if self.ball.lasts else 2

    @cached_property
    def size(self) -> int:
        """The number kq of unknowns of all impacts."""
        return self.impacts * self.unknowns

    @cached_property
    def length(self) -> int:
        """The number N of entries of a row."""
        return self.size + len(self.along)

    def rows(self, which) -> "OrbitEquations":
        """The equations of some of the rows, by an index, a slice or a mask of them."""
        return replace(
            self,
            ball=self.ball.rows(which),
            periods=_some(self.periods, which),
            amplitude=_some(self.amplitude, which),
            table=self.table.rows(which),
        )

    @cached_property
    def _beside_impacts(self) -> tuple[Ball, NDArray]:
        """The ball and Λ as columns, which go beside arrays of the shape (rows, k)."""
        ball = self.ball.rows(np.s_[:, np.newaxis])
        return ball, np.asarray(self.amplitude, float)[..., np.newaxis]

    def at(self, values) -> tuple[Ball, NDArray]:
        """The ball and Λ, beside impacts, at values of what changes, shape (..., p)."""
        ball, amplitude = self._beside_impacts
        for j, path in enumerate(self.along):
            ball, amplitude = path.apply(ball, amplitude, values[..., j, np.newaxis])
        return ball, amplitude

    def table_at(self, values) -> Table:
        """The table, beside impacts, at values of what changes."""
        table = self.table.rows(np.s_[:, np.newaxis])
        for j, path in enumerate(self.along if table.parameters else ()):
            table = path.shape(table, values[..., j, np.newaxis])
        return table

    def orbit(self, z: NDArray, kind: str = ""):
        """One orbit, shape (N,), with its quantities."""
        # The module of orbits imports this one.
        from bouncing_ball_beyond.periodic import PeriodicOrbit

        return PeriodicOrbit(self, z, kind)

    def split(self, z) -> tuple[NDArray, Ball, NDArray]:
        """The impacts (rows, k, q) of orbits, their ball and their Λ, both beside impacts."""
        x = z[:, : self.size].reshape(len(z), self.impacts, self.unknowns)
        return x, *self.at(z[:, self.size :])

    def sizes(self, z) -> NDArray:
        """1 + the largest unknown of the impacts, and 1 + |p| of parameters, shape (rows, N)."""
        sizes = 1 + np.abs(z)
        sizes[:, : self.size] = sizes[:, : self.size].max(axis=1, keepdims=True)
        return sizes

    def following(self, x) -> NDArray:
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

    def linear(self, z) -> Linear:
        """The legs and their derivatives.

        A leg is a contact and the flight after it. Its equations are that the contact ends where
        the release function is zero, and the flight at the gap and with the speed of the next
        impact.
        """
        q = self.unknowns
        x = z[:, : self.size].reshape(len(z), self.impacts, q)
        of_legs, of_parameters = self._steps
        y = np.concatenate([x, self.following(x)[..., :2]], axis=-1) + of_legs
        values = z[:, self.size :] + of_parameters
        legs, flights = self._legs(y, *self.at(values), self.table_at(values))
        return Linear(legs[0].real, legs.imag.transpose(1, 2, 3, 0) / H, flights[0].real)

    def legs(self, z) -> NDArray:
        """The legs alone, shape (rows, k, q)."""
        x, ball, amplitude = self.split(z)
        y = np.concatenate([x, self.following(x)[..., :2]], axis=-1)
        return self._legs(y, ball, amplitude, self.table_at(z[:, self.size :]))[0]

    def _legs(self, y, ball, amplitude, table) -> tuple[NDArray, NDArray]:
        """Legs between impacts and the next ones, and their times of flight.

        y has the q unknowns of the former, then τ and u of the latter.
        """
        q = self.unknowns
        impact = ball.contact(y[..., 0], y[..., 1], y[..., q - 1], amplitude, table=table)
        leaves = y[..., 0] + impact.duration
        flights = y[..., q] - leaves
        gap, rate = flight(flights, leaves, impact.gap, impact.speed, amplitude, table)
        legs = np.empty((*y.shape[:-1], q), y.dtype)
        if self.ball.lasts:
            legs[..., 0] = impact.release
        legs[..., q - 2] = gap - ball.start(y[..., q + 1])
        legs[..., q - 1] = rate + y[..., q + 1]
        return legs, flights

    def bordered(self, z, linear: Linear, normal: NDArray) -> NDArray:
        """The step of Newton's method to the plane through z across a normal, and the tangent.

        Shape (rows, N, 2); the tangent has normal · tangent = 1. NaN for singular equations.
        """
        right = np.zeros((*linear.legs.shape, 2))
        right[..., 0] = -linear.legs
        border_right = np.broadcast_to([0.0, 1.0], (len(z), 1, 2))
        return solve_bordered(linear.derivatives, right, normal[:, np.newaxis], border_right)

    def tests(self, z, linear: Linear) -> NDArray:
        """What is zero at the special orbits that a march watches, shape (rows, tests).

        That of a period halving is the distance from one.
        """
        turn = self.turn(linear)
        columns = [
            1 - turn,
            1 + turn,
            linear.flights.min(axis=1),
            self.least_speed(z),
            self.least_release(linear, z),
            np.linalg.norm(self.halves(z), axis=1),
        ]
        return np.stack(columns, axis=1)

    @property
    def watched(self) -> tuple[str, ...]:
        """The kinds of special orbits of these tests: they cost little, or end a branch."""
        return (
            "saddle-node",
            "period doubling",
            "vanishing flight",
            "grazing of an impact",
            "lost release",
            "period halving",
        )

    def residuals(self, z) -> tuple[NDArray, NDArray]:
        """The equations, shape (rows, kq), and their Jacobian, shape (rows, kq, N)."""
        linear = self.linear(z)
        legs = linear.legs.reshape(len(z), self.size)
        return legs, dense(linear.derivatives).reshape(len(z), self.size, self.length)

    def maps(self, linear: Linear) -> NDArray:
        """Derivatives of each next (τ, u) by τ and u of an impact, shape (rows, k, 2, 2)."""
        by_impact = linear.derivatives[..., :2]
        by_others = linear.derivatives[..., 2 : self.unknowns + 2]
        return -solved_or_nan(by_others, by_impact)[..., -2:, :]

    def trace_and_determinant(self, linear: Linear) -> tuple[NDArray, NDArray]:
        """Those of the derivative of the return map, each of the shape (rows,).

        The determinant is the product of those of the legs, which has all digits where that of
        the product of the maps has none.
        """
        maps = self.maps(linear)
        determinants = maps[..., 0, 0] * maps[..., 1, 1] - maps[..., 0, 1] * maps[..., 1, 0]
        product = product_of(maps)
        return product[:, 0, 0] + product[:, 1, 1], determinants.prod(axis=-1)

    def turn(self, linear: Linear) -> NDArray:
        """tr/(1 + det): 1 where a multiplier is 1, -1 where one is -1, between them if stable."""
        trace, determinant = self.trace_and_determinant(linear)
        return trace / (1 + determinant)

    def stable(self, linear: Linear) -> NDArray:
        """Whether no neighbouring motion leaves the orbits, shape (rows,).

        Neighbours come nearer, or stay near if the ball is elastic.
        """
        trace, determinant = self.trace_and_determinant(linear)
        # The determinant of an elastic ball is 1 up to rounding.
        return (np.abs(trace) < 1 + determinant) & (determinant < 1 + 1e-9)

    def ends(self, z) -> Flights:
        """The ends of the contacts and the flights after them."""
        x, ball, amplitude = self.split(z)
        table = self.table_at(z[:, self.size :])
        impact = ball.contact(x[..., 0], x[..., 1], x[..., -1], amplitude, table=table)
        leaves = x[..., 0] + impact.duration
        time = self.following(x)[..., 0] - leaves
        amplitude = np.broadcast_to(amplitude, leaves.shape)
        return Flights(leaves, impact.gap, impact.speed, time, amplitude, table)

    def clearance(self, z, flights: Flights | None = None) -> NDArray:
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

    def contact_clearance(self, z) -> NDArray:
        """How far release functions are below zero where they turn back: the least of all."""
        if not self.ball.lasts:
            return np.full(len(z), FAR)
        during = self._during(z)

        def release(t):
            return during(t).release

        def falls(t):
            return -_derivative(release, t)

        length = self.split(z)[0][..., 2]
        return turns_back(falls, lambda t: -release(t), length).min(axis=-1)

    def max_height(self, z) -> NDArray:
        """The greatest height of the ball, shape (rows,): at a summit of a flight or in a contact.

        In a compliant contact the table may lift the ball higher than it flies.
        """
        leaves, gap, speed, time, amplitude, table = self.ends(z)
        bounce = speed + amplitude * table(leaves, 1)
        rise = np.clip(bounce, 0, time)
        height = gap + amplitude * table(leaves) + (bounce - rise / 2) * rise
        if not self.ball.lasts:
            return height.max(axis=-1)
        x, _, _ = self.split(z)
        during = self._during(z)

        table = table.rows(np.s_[..., np.newaxis])

        def moved(t, order):
            phase = x[..., 0, np.newaxis] + during(t).duration
            return amplitude[..., np.newaxis] * table(phase, order)

        lifted = turns_back(
            lambda t: -during(t).speed - moved(t, 1),
            lambda t: -during(t).gap - moved(t, 0),
            x[..., 2],
        )
        return np.maximum(height, -lifted).max(axis=-1)

    def _during(self, z) -> Callable[[NDArray], Impact]:
        """The contacts of orbits as a function of T, shape (rows, k, times)."""
        x, ball, amplitude = self.split(z)
        beside = ball.rows(np.s_[..., np.newaxis])
        table = self.table_at(z[:, self.size :]).rows(np.s_[..., np.newaxis])
        given = x[..., 0, np.newaxis], x[..., 1, np.newaxis]
        amplitude = np.asarray(amplitude)[..., np.newaxis]
        return lambda t: beside.contact(*given, t, amplitude, table=table)

    def least_speed(self, z) -> NDArray:
        """The closing speed next to zero, negative if an odd number of impacts have u < 0."""
        speeds = self.split(z)[0][..., 1]
        return np.abs(speeds).min(axis=-1) * np.sign(speeds).prod(axis=-1)

    def least_release(self, linear: Linear, z) -> NDArray:
        """How well balls leave the table after impacts: the least of all, zero if one does not.

        It is the speed with which the release function passes zero, or the relative speed after an
        instant. After an instant below the table it is the height of the summit of the flight.
        """
        if self.ball.lasts:
            return linear.derivatives[..., 0, 2].min(axis=-1)
        flights = self.ends(z)
        if np.all(flights.gap >= 0):
            return flights.speed.min(axis=-1)
        depth = turns_back(
            lambda t: -flights.at(t)[1], lambda t: -flights.at(t)[0], flights.flight, first=True
        )
        return -depth.max(axis=-1)

    def rest(self, z) -> NDArray:
        """How long the ball rests on the table in each period: not at all."""
        return np.zeros(len(z))

    def fall(self, z) -> NDArray:
        """How fast the table falls away at a lift-off: there is none."""
        return np.full(len(z), FAR)

    def halves(self, z) -> NDArray:
        """Differences of the impacts half an orbit apart, shape (rows, kq/2).

        They are zero if the orbit is one of half the period, taken twice, and 1 if the impacts or
        the periods have no half.
        """
        if self.impacts % 2:
            return np.ones((len(z), 1))
        x, _, _ = self.split(z)
        half = self.impacts // 2
        periods = np.reshape(self.periods, (-1, 1))
        apart = x[:, :half] - x[:, half:]
        apart[..., 0] += np.pi * periods
        return np.where(periods % 2 == 0, apart.reshape(len(z), -1), 1.0)

    def halving(self, z) -> NDArray:
        """Difference of the speeds at two impacts half an orbit apart, shape (rows,).

        It is zero at a period halving, and perhaps elsewhere; 1 for an odd number of impacts.
        """
        return self.halves(z)[:, 1 if self.impacts % 2 == 0 else 0]

    def admissible(self, z) -> NDArray:
        """Whether a ball follows the orbit: nothing else happens in its contacts and flights."""
        x, ball, _ = self.split(z)
        ends = self.ends(z)
        landing = (x[..., 1] > 0) | (np.broadcast_to(ball.kappa, x.shape[:2]) > 0)
        release = self.least_release(self.linear(z), z)
        # A ball without speed leaves the table if this falls faster than the ball: δ″ > 0.
        falls = (ends.amplitude * ends.table(ends.leaves, 2) < -1).all(axis=-1)
        leaving = (release > 0) | ((release == 0) & falls)
        lasting = (ends.flight > 0) & (ends.leaves >= x[..., 0])
        clear = (self.clearance(z, ends) > 0) & (self.contact_clearance(z) > 0)
        return clear & leaving & (landing & lasting).all(axis=-1)


def _derivative(function, t):
    """The derivative of an analytic function, also at complex steps, whose derivatives it has."""
    if not np.iscomplexobj(t):
        return function(t + 1j * H).imag / H
    # Two derivatives: a difference of complex steps serves Newton's method.
    step = 1e-6
    slopes = [function(t.real + shift + 1j * H).imag / H for shift in (-step, 0.0, step)]
    return slopes[1] + 1j * H * (slopes[2] - slopes[0]) / (2 * step)


def flight(s, leaves, gap, speed, amplitude, table=SINE):
    """Gap δ and its derivative δ′ a time s after a ball left at the time `leaves` with δ′ = speed.

    The table is at w = ΛW(τ) and 1 is gravity, so that δ″ = -1 - w″.
    """
    height, gained = table.rise(leaves, s)
    bounce = speed + amplitude * table(leaves, 1)
    return gap + (bounce - s / 2) * s - amplitude * height, speed - s - amplitude * gained


def _longest(times) -> float:
    """The greatest of times, at least 0; NaN, of a ball that does not leave the table, is none."""
    return np.fmax.reduce(times, axis=None, initial=0.0)


def turns_back(slope, value, ends, *, first: bool = False, among=None, waves: int = 1) -> NDArray:
    """The least value at a local minimum of functions of the time within (0, ends).

    Minima are found if the slope changes its sign between two of 32 samples in a time of 2π, or of
    those given.

    Parameters
    ----------
    slope, value : callable
        The function's derivative, or a positive multiple of it, and the function, of times of the
        shape (..., n); the slope is analytic.
    ends : ndarray
    first : bool
        Whether the value is that of the first minimum and not of the lowest.
    among : ndarray, shape (..., m), optional
        Further times at which the slope is sampled.
    waves : int
        How many times more samples a table of so many waves in a period needs.

    Returns
    -------
    ndarray
        Of the shape of `ends`, FAR where there is no minimum, and at most FAR.
    """
    samples = int(np.clip(32 * waves * _longest(ends) / (2 * np.pi), 32, 2000)) + 1
    times = ends[..., np.newaxis] * np.linspace(0, 1, samples)
    if among is not None:
        times = np.sort(np.concatenate([times, among], axis=-1), axis=-1)
    slopes = slope(times)
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


def product_of(maps: NDArray) -> NDArray:
    """The product of the maps of the legs, the last one at the left, shape (rows, 2, 2)."""
    while maps.shape[1] > 1:
        even = maps.shape[1] // 2 * 2
        pairs = maps[:, 1:even:2] @ maps[:, 0:even:2]
        maps = np.concatenate([pairs, maps[:, even:]], axis=1)
    return maps[:, 0]


def dense(derivatives: NDArray) -> NDArray:
    """The Jacobian (rows, k, q, N) from the derivatives of legs."""
    rows, k, q, columns = derivatives.shape
    matrix = np.zeros((rows, k, q, k * q + columns - q - 2))
    for i in range(k):
        after = (i + 1) % k * q
        matrix[:, i, :, i * q : (i + 1) * q] += derivatives[:, i, :, :q]
        matrix[:, i, :, after : after + 2] += derivatives[:, i, :, q : q + 2]
    matrix[..., k * q :] = derivatives[..., q + 2 :]
    return matrix


def solved_or_nan(matrix, values) -> NDArray:
    """Solutions of linear equations, NaN where a matrix is singular."""
    try:
        return np.linalg.solve(matrix, values)
    except np.linalg.LinAlgError:
        singular = np.linalg.det(matrix) == 0
        return np.linalg.solve(
            np.where(singular[..., np.newaxis, np.newaxis], np.nan, matrix), values
        )


def solve_bordered(derivatives, right, border, border_right) -> NDArray:
    """Solve the linear equations of the legs together with p further ones.

    Each pair of legs is turned by an orthogonal matrix, so that one half of its equations tells the
    impact between the two and the other half is a leg from the first impact to the one after the
    second. The number of legs is halved until one matrix is small. This is stable for
    orbits of any instability, and its work is proportional to the number of legs.

    Parameters
    ----------
    derivatives : ndarray, shape (rows, k, q, q + 2 + p)
    right : ndarray, shape (rows, k, q, m)
        Right sides of the legs.
    border : ndarray, shape (rows, p, N)
    border_right : ndarray, shape (rows, p, m)

    Returns
    -------
    ndarray, shape (rows, N, m)
        NaN for singular equations.
    """
    rows, k, q, columns = derivatives.shape
    m = right.shape[-1]
    if k <= DENSE:
        matrix = np.concatenate([dense(derivatives).reshape(rows, k * q, -1), border], axis=1)
        values = np.concatenate([right.reshape(rows, k * q, m), border_right], axis=1)
        return solved_or_nan(matrix, values)
    p = columns - q - 2
    pairs = k // 2
    first = derivatives[:, 0 : 2 * pairs : 2]
    second = derivatives[:, 1 : 2 * pairs : 2]
    between = np.zeros((rows, pairs, 2 * q, q))
    between[:, :, :q, :2] = first[..., q : q + 2]
    between[:, :, q:] = second[..., :q]
    others = np.zeros((rows, pairs, 2 * q, columns + m))
    others[:, :, :q, :q] = first[..., :q]
    others[:, :, q:, q : q + 2] = second[..., q : q + 2]
    others[:, :, :q, q + 2 : columns] = first[..., q + 2 :]
    others[:, :, q:, q + 2 : columns] = second[..., q + 2 :]
    others[:, :, :q, columns:] = right[:, 0 : 2 * pairs : 2]
    others[:, :, q:, columns:] = right[:, 1 : 2 * pairs : 2]
    orthogonal, triangle = np.linalg.qr(between, mode="complete")
    others = orthogonal.swapaxes(-1, -2) @ others
    eliminated = solved_or_nan(triangle[..., :q, :], others[..., :q, :])
    legs = np.concatenate([others[..., q:, :columns], derivatives[:, 2 * pairs :]], axis=1)
    legs_right = np.concatenate([others[..., q:, columns:], right[:, 2 * pairs :]], axis=1)
    # What the impacts between the pairs add to the border.
    blocks = border[..., : k * q].reshape(rows, p, k, q).swapaxes(1, 2)
    kept = blocks[:, ::2].copy()
    added = blocks[:, 1 : 2 * pairs : 2] @ eliminated
    after = np.arange(1, pairs + 1) % kept.shape[1]
    kept[:, :pairs] -= added[..., :q]
    kept[:, after, :, :2] -= added[..., q : q + 2]
    total = added.sum(axis=1)
    kept = kept.swapaxes(1, 2).reshape(rows, p, -1)
    outer = np.concatenate([kept, border[..., k * q :] - total[..., q + 2 : columns]], axis=-1)
    solution = solve_bordered(legs, legs_right, outer, border_right - total[..., columns:])
    states = solution[:, :-p].reshape(rows, -1, q, m)
    whole = np.empty((rows, k, q, m))
    whole[:, ::2] = states
    whole[:, 1 : 2 * pairs : 2] = (
        eliminated[..., columns:]
        - eliminated[..., :q] @ states[:, :pairs]
        - eliminated[..., q : q + 2] @ states[:, after, :2]
        - eliminated[..., q + 2 : columns] @ solution[:, np.newaxis, -p:]
    )
    return np.concatenate([whole.reshape(rows, k * q, m), solution[:, -p:]], axis=1)


class Solution(NamedTuple):
    """What Newton's method ends with, by rows.

    ``z`` are the orbits, NaN where the equations are not finite; ``found`` says which of them are
    solutions; ``tangent`` is the direction of the curve of orbits, with normal · tangent = 1;
    ``linear`` are the legs and derivatives at z.
    """

    z: NDArray
    found: NDArray
    tangent: NDArray
    linear: Linear


@np.errstate(all="ignore")
def newton(
    equations: OrbitEquations,
    z: NDArray,
    normal: NDArray | None = None,
    iterations: int = 12,
    tolerance: float = 1e-11,
) -> Solution:
    """Orbits on the planes through z across a normal, by Newton's method, for one free parameter.

    Parameters
    ----------
    equations : OrbitEquations
    z : ndarray, shape (rows, N)
    normal : ndarray, shape (rows, N), optional
        By default the parameter is fixed.
    iterations : int
    tolerance : float
        The largest last step, in units of `OrbitEquations.sizes`. Steps fall quadratically, so that
        the error after one of 1e-11 is that of rounding.

    Returns
    -------
    Solution
    """
    if normal is None:
        normal = np.zeros_like(z)
        normal[:, -1] = 1.0
    for _ in range(iterations):
        linear = equations.linear(z)
        solution = equations.bordered(z, linear, normal)
        step = solution[..., 0]
        z = z + step
        defect = np.abs(linear.legs).max(axis=(1, 2))
        moved = (np.abs(step) / equations.sizes(z)).max(axis=1)
        # Lengths in the equations are of the size of Λ, or of the times and the speeds.
        _, amplitude = equations.at(z[:, equations.size :])
        size = np.abs(z[:, : equations.size]).max(axis=1) + np.abs(amplitude[..., 0])
        # Steps become small, or they are made of nothing but rounding errors of the equations.
        found = (moved < tolerance) | (defect < ROUNDING * (1 + size))
        if (found | np.isnan(moved)).all():
            break
    # Far away, where times have no digits left, steps are small as well.
    found &= defect < 1e-7
    return Solution(z, found, solution[..., 1], linear)
