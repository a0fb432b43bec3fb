"""Equations and quantities of periodic orbits with k impacts in m periods of the table.

An impact has q unknowns: its time τ, its closing speed u and, if it has a duration, its T. An orbit
is a row z with N = kq + p entries: the unknowns of its k impacts one after the other, then the
values of the p parameters that may change. Functions take many orbits at once, shape (rows, N).

A *leg* is a contact and the flight after it. The q equations of a leg require that the contact ends
at a release (:mod:`.balls`), and the flight at the next impact. ``legs`` are their residuals. The
mathematics is in docs/equations.md.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.contacts.balls import Ball, H, Impact, Rigid
from bouncing_ball_beyond.motions.effort import Effort, SearchEnded
from bouncing_ball_beyond.periodic.chains import product_of, solve_bordered, solved_or_nan
from bouncing_ball_beyond.periodic.instants import (
    closing_speeds,
    instants,
    named,
    others,
    same_side,
)
from bouncing_ball_beyond.periodic.paths import AMPLITUDE, Path
from bouncing_ball_beyond.tables.table import FUNDAMENTAL, SINE, Table

FAR = 10.0
"""Maximum clearance. It is also the clearance of a flight whose gap has no local minimum."""


POINT = (1.0,), (1.0,), 1e-7
CURVE = (1.0, -1.0, 2.0, -2.0), (2 / 3, -2 / 3, -1 / 12, 1 / 12), 1e-4
"""Nodes, weights and step of the differences that give gradients of test functions.

`POINT` has errors of 1e-7, which are small enough for Newton's method at isolated points. `CURVE`
has errors of 1e-12, which are small enough for tangents of curves.
"""

NEUTRAL = 1e-9
"""Modulus of 1 - det below which det counts as 1: that of an elastic ball is 1 within rounding."""

AT_FOLD = 1e-6
"""Limit of |1 - tr/(1 + det)| below which an orbit counts as the saddle-node.

Such an orbit belongs to both sides of the saddle-node.

1 - tr/(1 + det) grows with the square root of the distance in Λ. Errors of 1e-13 in a contact
therefore cause a value of 3e-7.

At half: 1005 of 1020 orbits next to saddle-nodes are found, instead of 1011. At twice: 1015.
"""

AT_SURFACE = 1e-11
"""q = p^{1/m} below which a contact ends at p = 0. Rounding gives values up to about 1e-15."""

AT_SWITCH = 1e-6
"""Largest p and f(p, p′)/f(p, 0) of a switch of a release that is not located."""

LASTING = 4 * np.pi
"""T of two free oscillations. Above this T, step lengths count relative changes of T.

At half: 7 % fewer points on branches of long contacts. At twice: 8 % more.
"""


@dataclass(frozen=True, eq=False)
class LinearizedLegs:
    """Residuals of the legs of orbits, and their derivatives.

    Attributes
    ----------
    legs : array, shape (rows, k, q)
        Residuals of the q equations of each leg.
    derivatives : array, shape (rows, k, q, q + 2 + p)
        Derivatives with respect to the q unknowns of the impact, to τ and u of the next impact, and
        to the p parameters.
    flights : array, shape (rows, k)
        Durations of the flights.
    """

    legs: NDArray
    derivatives: NDArray
    flights: NDArray

    def rows(self, which: Any) -> "LinearizedLegs":
        """Select rows."""
        taken = self.legs[which], self.derivatives[which], self.flights[which]
        return LinearizedLegs(*taken)

    @cached_property
    def maps(self) -> NDArray:
        """Derivatives of the next (τ, u) with respect to τ and u, shape (rows, k, 2, 2)."""
        by_impact = self.derivatives[..., :2]
        by_others = self.derivatives[..., 2 : self.derivatives.shape[-2] + 2]
        return -solved_or_nan(by_others, by_impact)[..., -2:, :]

    @cached_property
    def trace_and_determinant(self) -> tuple[NDArray, NDArray]:
        """Trace and determinant of the derivative of the return map, shape (rows,) each."""
        maps = self.maps
        # The product of determinants keeps all digits; the determinant of the product may not.
        determinants = maps[..., 0, 0] * maps[..., 1, 1] - maps[..., 0, 1] * maps[..., 1, 0]
        product = product_of(maps)
        return product[:, 0, 0] + product[:, 1, 1], determinants.prod(axis=-1)


class Flights(NamedTuple):
    """Flights after contacts, as arrays of the shape (rows, k).

    Attributes
    ----------
    leaves : array
        Times of the release.
    gap, speed : array
        δ and δ′ at the release.
    flight : array
        Durations of the flights.
    amplitude : array
        Λ.
    table : Table
        The waveform.
    """

    leaves: NDArray
    gap: NDArray
    speed: NDArray
    flight: NDArray
    amplitude: NDArray
    table: Table

    def at(self, t: NDArray) -> tuple[NDArray, NDArray]:
        """δ and δ′ at times t after the release, shape (rows, k, times)."""
        leaves, gap, speed, _, amplitude = (quantity[..., np.newaxis] for quantity in self[:5])
        table = self.table.rows(np.s_[..., np.newaxis])
        return flight(t, leaves, gap, speed, amplitude, table)

    def bends(self) -> NDArray:
        """Times at which -w″ = 1 and δ′ has an extremum, shape (rows, k, times).

        Times after the end of a flight are replaced by the time of this end.
        """
        phases = self.table.levels(self.amplitude)
        turns = int(np.fmin(_longest(self.flight) / (2 * np.pi), 1000)) + 1
        first = (phases - self.leaves[..., np.newaxis]) % (2 * np.pi)
        times = first[..., np.newaxis] + 2 * np.pi * np.arange(turns)
        times = times.reshape(*self.leaves.shape, phases.shape[-1] * turns)
        return np.fmin(times, self.flight[..., np.newaxis])


def _some(values: Any, which: Any) -> Any:
    """Select rows of an array; a number is the same for all rows."""
    return values[which] if np.ndim(values) else values


@dataclass(frozen=True)
class OrbitEquations:
    """Equations of orbits of one ball, or of a row of balls that differ in their parameters.

    Parameters
    ----------
    ball : Ball
        The ball. Its parameters are numbers, or arrays of the shape (rows,).
    impacts : int
        Number k of impacts.
    periods : int or array, shape (rows,)
        Number m of periods of the table.
    amplitude : float or array, shape (rows,)
        Λ, unless it is one of the parameters that may change.
    along : tuple of Path
        Parameters that may change. Their values are the last entries of z.
    table : Table
        The waveform. Its parameters are numbers, or arrays of the shape (rows,).
    kind : str
        Kind of special orbits, whose test function is one more equation; "" for ordinary orbits.
    effort : Effort, optional
        Search to which the contacts of :meth:`linearized` count.
    """

    ball: Ball
    impacts: int
    periods: int | NDArray
    amplitude: float | NDArray = np.nan
    along: tuple[Path, ...] = (AMPLITUDE,)
    table: Table = SINE
    kind: str = ""
    effort: Effort | None = None

    @cached_property
    def unknowns(self) -> int:
        """Number q of unknowns of an impact."""
        return self.ball.unknowns

    @cached_property
    def size(self) -> int:
        """Number kq of unknowns of all impacts."""
        return self.impacts * self.unknowns

    @cached_property
    def length(self) -> int:
        """Number N of entries of a row."""
        return self.size + len(self.along)

    def rows(self, which: Any) -> "OrbitEquations":
        """Select the equations of rows by an index, a slice or a mask."""
        return replace(
            self,
            ball=self.ball.rows(which),
            periods=_some(self.periods, which),
            amplitude=_some(self.amplitude, which),
            table=self.table.rows(which),
        )

    @cached_property
    def _beside_impacts(self) -> tuple[Ball, NDArray, Table]:
        """Ball, Λ and table as columns, which broadcast with arrays of the shape (rows, k)."""
        beside = np.s_[:, np.newaxis]
        amplitude = np.asarray(self.amplitude, float)[..., np.newaxis]
        return self.ball.rows(beside), amplitude, self.table.rows(beside)

    def at(self, values: NDArray) -> tuple[Ball, NDArray, Table]:
        """Ball, Λ and table as columns, at the values (..., p) of the parameters that change."""
        here = self._beside_impacts
        for j, path in enumerate(self.along):
            here = path.apply(values[..., j, np.newaxis], *here)
        return here

    def orbit(self, z: NDArray, kind: str = "") -> "PeriodicOrbit":
        """Return the orbit z, shape (N,), as a `PeriodicOrbit`."""
        equations = replace(self, kind="", effort=None) if self.kind or self.effort else self
        return PeriodicOrbit(equations, z, kind)

    def split(self, z: NDArray) -> tuple[NDArray, Ball, NDArray, Table]:
        """Return impacts, shape (rows, k, q); then the ball, Λ and the table, as columns."""
        x = z[:, : self.size].reshape(len(z), self.impacts, self.unknowns)
        return x, *self.at(z[:, self.size :])

    def sizes(self, z: NDArray) -> NDArray:
        """Sizes of the entries of z, shape (rows, N).

        Newton steps are measured in these sizes: 1 + the largest modulus of the unknowns of the
        impacts, and 1 + |λ| for a parameter λ.
        """
        sizes = 1 + np.abs(z)
        sizes[:, : self.size] = sizes[:, : self.size].max(axis=1, keepdims=True)
        return sizes

    def scales(self, z: NDArray) -> NDArray:
        """Units in which steps of the entries of z are measured, shape (rows, N)."""
        units = np.full(z.shape, np.sqrt(self.impacts))
        x = self.split(z)[0]
        stretch = np.ones(x.shape)
        stretch[..., 2:] = np.maximum(np.abs(x[..., 2:]) / LASTING, 1.0)
        units[:, : stretch[0].size] *= stretch.reshape(len(z), -1)
        units[:, self.size :] = np.maximum(np.abs(z[:, self.size :]), 1e-2)
        return units

    def following(self, x: NDArray) -> NDArray:
        """Impact after each impact. The last is followed by the first, m periods later."""
        following = np.concatenate([x[:, 1:], x[:, :1]], axis=1)
        following[:, -1, 0] += 2 * np.pi * np.asarray(self.periods)
        return following

    @cached_property
    def _steps(self) -> tuple[NDArray, NDArray]:
        """Complex steps, one for each unknown of a leg and one for each parameter."""
        inner = self.unknowns + 2
        steps = 1j * H * np.eye(inner + len(self.along))
        return steps[:, np.newaxis, np.newaxis, :inner], steps[:, np.newaxis, inner:]

    def spend(self, rows: int, step: str = "") -> None:
        """Count the contacts of a number of orbits; see :meth:`.Effort.spend`."""
        if self.effort:
            self.effort.spend(rows * self.impacts, step)

    def linearized(self, z: NDArray) -> LinearizedLegs:
        """Residuals of the legs, and their derivatives.

        The equations of a leg require that the release function vanishes when the contact ends, and
        that the flight ends with the gap and the speed of the next impact.
        """
        self.spend(len(z))
        q = self.unknowns
        x = z[:, : self.size].reshape(len(z), self.impacts, q)
        of_legs, of_parameters = self._steps
        y = np.concatenate([x, self.following(x)[..., :2]], axis=-1) + of_legs
        values = z[:, self.size :] + of_parameters
        legs, flights = self._legs(y, *self.at(values))
        return LinearizedLegs(legs[0].real, legs.imag.transpose(1, 2, 3, 0) / H, flights[0].real)

    def _legs(
        self, y: NDArray, ball: Ball, amplitude: Any, table: Table
    ) -> tuple[NDArray, NDArray]:
        """Residuals of the legs, and durations of the flights.

        The last axis of y has the q unknowns of an impact, and then τ and u of the next impact.
        """
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
        """Step of Newton's method in a plane, and tangent of the branch, shape (rows, N, 2).

        The plane contains z and is perpendicular to ``normal``. The tangent is scaled to normal ·
        tangent = 1. Step and tangent are NaN if the equations are singular. Special orbits with one
        free parameter are isolated points and need no plane.
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
        """Solve the linear equations for two right-hand sides, shape (rows, N, 2).

        In the equations of the legs, the first right-hand side is minus the residual, and the
        second is 0. The other equations are the border; ``right`` contains their right-hand sides.
        """
        legs = np.zeros((*linear.legs.shape, 2))
        legs[..., 0] = -linear.legs
        return solve_bordered(linear.derivatives, legs, border, right)

    def excess(self, z: NDArray, linear: LinearizedLegs) -> NDArray:
        """Function that vanishes at special orbits of the kind, shape (rows,); see `condition`."""
        if self.kind not in MULTIPLIERS:
            return KINDS[self.kind].test(self, z, linear)
        trace, determinant = linear.trace_and_determinant
        return 1 - MULTIPLIERS[self.kind] * trace + determinant

    def condition(self, z: NDArray) -> tuple[NDArray, NDArray]:
        """Residual of the equation of special orbits, shape (rows,), and gradient, shape (rows, N).

        For a multiplier μ the equation is χ = 1 - μ tr + det = 0. Its gradient is computed from
        differences of the products χ ∏ρ and ∏ρ, where ρ is the rate of the release function of a
        contact. These products have no poles, but χ has poles (docs/equations.md).
        """
        rows, length = z.shape
        nodes, weights, step = CURVE if len(self.along) > 1 else POINT
        shift = step * self.scales(z)
        nudges = np.concatenate([np.zeros((1, length)), *np.multiply.outer(nodes, np.eye(length))])
        nearby = (z + nudges[:, np.newaxis] * shift).reshape(-1, length)
        equations = self.rows(np.tile(np.arange(rows), len(nudges)))
        linear = equations.linearized(nearby)
        values = equations.excess(nearby, linear)
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
        "Neimark-Sacker",
        "vanishing flight",
        "grazing of an impact",
        "lost release",
        "period halving",
    )
    """Kinds of special orbits that a march watches. Their tests are cheap, or curves end there."""

    def tests(self, z: NDArray, linear: LinearizedLegs) -> NDArray:
        """Test functions, shape (rows, tests). They vanish at special orbits of `kinds`.

        On a curve, the test function of its kind vanishes everywhere, and is replaced by 1.
        """
        columns = {
            name: np.ones(len(z)) if name == self.kind else KINDS[name].test(self, z, linear)
            for name in self.kinds
        }
        # Rounding errors of an elastic ball change no sign.
        loss = columns["Neimark-Sacker"]
        columns["Neimark-Sacker"] = np.where(np.abs(loss) < NEUTRAL, 0.0, loss)
        return np.stack([*columns.values()], axis=1)

    def turn(self, linear: LinearizedLegs) -> NDArray:
        """tr/(1 + det). It is ±1 if a multiplier is ±1, and in between if orbits are stable."""
        trace, determinant = linear.trace_and_determinant
        return trace / (1 + determinant)

    def stable(self, linear: LinearizedLegs) -> NDArray:
        """Whether neighbouring motions stay near the orbits, shape (rows,)."""
        return are_stable(*linear.trace_and_determinant)

    def ends(self, z: NDArray) -> Flights:
        """Return the flights after the contacts."""
        x, ball, amplitude, table = self.split(z)
        impact = ball.contact(x[..., 0], x[..., 1], x[..., -1], amplitude, table=table)
        leaves = x[..., 0] + impact.duration
        time = self.following(x)[..., 0] - leaves
        amplitude = np.broadcast_to(amplitude, leaves.shape)
        return Flights(leaves, impact.gap, impact.speed, time, amplitude, table)

    def clearance(self, z: NDArray, flights: Flights | None = None) -> NDArray:
        """Smallest local minimum of the gap in all flights, shape (rows,); at most `FAR`.

        A local minimum is a point at which the ball turns back from the table.
        """
        flights = flights or self.ends(z)
        # δ′ is monotonic between these times, so even short dips after a slow start are found.
        bends = flights.bends()
        return turns_back(
            lambda t: flights.at(t)[1],
            lambda t: flights.at(t)[0],
            flights.flight,
            among=bends,
            waves=self.table.orders[-1],
        ).min(axis=-1)

    def contact_clearance(self, z: NDArray) -> NDArray:
        """How far release functions stay below zero where they turn back, shape (rows,).

        The largest local maximum in all contacts of an orbit counts, with a negative sign. The
        result is at most `FAR`, and it is `FAR` for instantaneous impacts.
        """
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
        """Maximum height of the ball in flights and contacts, shape (rows,).

        During a compliant contact, the table may lift the ball above the height of all flights.
        """
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
        """Return a function that maps T, shape (rows, k, times), to the states of the contacts."""
        x, ball, amplitude, table = self.split(z)
        beside = ball.rows(np.s_[..., np.newaxis])
        table = table.rows(np.s_[..., np.newaxis])
        given = x[..., 0, np.newaxis], x[..., 1, np.newaxis]
        amplitude = np.asarray(amplitude)[..., np.newaxis]
        return lambda t: beside.contact(*given, t, amplitude, table=table)

    def least_speed(self, z: NDArray) -> NDArray:
        """Minimum of |u|, shape (rows,), with the sign of the product of all u."""
        speeds = self.split(z)[0][..., 1]
        return np.abs(speeds).min(axis=-1) * np.sign(speeds).prod(axis=-1)

    def least_release(
        self, linear: LinearizedLegs | None, z: NDArray, flights: Flights | None = None
    ) -> NDArray:
        """Test function of a lost release, shape (rows,).

        It is the minimum over all impacts of one of these quantities:

        1. for contacts, the rate of the release function;
        2. for instantaneous impacts, δ′, which needs no derivatives.
        """
        if self.ball.has_duration:
            linear = self.linearized(z) if linear is None else linear
            rates = linear.derivatives[..., 0, 2].min(axis=-1)
            if not self.ball.has_two_ends:
                return rates
            # At p = 0 the rate is proportional to the force, except if rounding makes p negative.
            gap = (flights or self.ends(z)).gap
            law: Any = self.ball
            depth = np.abs(gap).max(axis=-1) ** (1 / law.root)
            return np.where(depth < AT_SURFACE, self.surface_share(z), rates)
        flights = flights or self.ends(z)
        return flights.speed.min(axis=-1)

    def surface_share(self, z: NDArray) -> NDArray:
        """Smallest f(p, p′)/f(p, 0) at the ends of the contacts, shape (rows,).

        It is 0 if the force ends a contact, and negative if the force already ended it.
        """
        x, ball, amplitude, table = self.split(z)
        law: Any = ball
        ends = self.ends(z)
        given = {**law.parameters, "u": x[..., 1]}
        load = 1 + amplitude * table(ends.leaves, 2)
        return law.share(-ends.gap, -ends.speed, load, given).min(axis=-1)

    def at_switch(self, z: NDArray) -> bool:
        """Whether p and f nearly vanish together at the end of a contact of the orbit z."""
        if not self.ball.has_two_ends:
            return False
        near = np.abs(self.ends(z).gap).min() < AT_SWITCH
        return bool(near and self.surface_share(z)[0] < AT_SWITCH)

    def halves(self, z: NDArray) -> NDArray:
        """First half of each orbit minus its second half, shape (rows, kq/2).

        The differences are 1 if k or m is odd. If k is odd, their shape is (rows, 1).
        """
        if self.impacts % 2:
            return np.ones((len(z), 1))
        x = self.split(z)[0]
        half = self.impacts // 2
        periods = np.reshape(self.periods, (-1, 1))
        apart = x[:, :half] - x[:, half:]
        apart[..., 0] += np.pi * periods
        return np.where(periods % 2 == 0, apart.reshape(len(z), -1), 1.0)

    def halved(self, z: NDArray) -> tuple["OrbitEquations", NDArray]:
        """Return equations of half the period, and the mean of the two halves of each orbit."""
        half = replace(self, impacts=self.impacts // 2, periods=np.asarray(self.periods) // 2)
        mean = z[:, : half.size] - self.halves(z) / 2
        return half, np.concatenate([mean, z[:, self.size :]], axis=1)

    def doubled(self, z: NDArray) -> tuple["OrbitEquations", NDArray]:
        """Return the equations of twice the period, and each orbit repeated once."""
        twice = replace(self, impacts=2 * self.impacts, periods=2 * np.asarray(self.periods))
        return twice, np.concatenate([z[:, : self.size], self.later(z, self.periods)], axis=1)

    def later(self, z: NDArray, turns: Any) -> NDArray:
        """Shift each orbit by a number of turns of the table."""
        z = z.copy()
        z[:, : self.size : self.unknowns] += 2 * np.pi * np.reshape(turns, (-1, 1))
        return z

    def admissible(self, z: NDArray, linear: LinearizedLegs | None = None) -> NDArray:
        """Whether a ball follows each orbit, shape (rows,)."""
        return self.obstacles(z, linear) == ""

    def obstacles(self, z: NDArray, linear: LinearizedLegs | None = None) -> NDArray:
        """Why no ball follows each orbit, shape (rows,); "" if a ball follows it.

        A ball follows an orbit if each contact ends at its first release, and each flight at its
        first impact.
        """
        x, ball, *_ = self.split(z)
        ends = self.ends(z)
        landing = (x[..., 1] > 0) | (np.broadcast_to(ball.kappa, x.shape[:2]) > 0)
        release = self.least_release(linear, z, ends)
        # A ball without speed leaves the table if the table falls faster than the ball: δ″ > 0.
        falls = (ends.amplitude * ends.table(ends.leaves, 2) < -1).all(axis=-1)
        # At a switch of a release p and f vanish within rounding, and the ball leaves with δ′ > 0.
        least = -AT_SWITCH if self.ball.has_two_ends else 0.0
        leaving = (release > least) | ((release == 0) & falls)
        lasting = (ends.flight > 0) & (ends.leaves >= x[..., 0])
        obstacles = {
            "a contact or a flight would end before it begins": lasting.all(axis=-1),
            "a contact ends earlier": self.contact_clearance(z) > 0,
            "a flight passes below the table": self.clearance(z, ends) > 0,
            "the ball does not leave the table as a contact ends": leaving,
            "the ball does not land": landing.all(axis=-1),
        }
        return np.select([~clear for clear in obstacles.values()], [*obstacles], "")


def are_stable(trace: NDArray, determinant: NDArray) -> NDArray:
    """Whether both multipliers are in the unit circle, or on it if impacts lose nothing."""
    return (np.abs(trace) < 1 + determinant) & (determinant < 1 + NEUTRAL)


def multipliers_of(trace: float, determinant: float) -> NDArray:
    """Complex Floquet multipliers, shape (2,), in order of decreasing modulus."""
    root = np.sqrt(complex(trace**2 / 4 - determinant))
    larger = trace / 2 - root if trace < 0 else trace / 2 + root
    with np.errstate(invalid="ignore"):
        return np.array([larger, determinant / larger])


def _derivative(function: Callable, t: NDArray) -> NDArray:
    """Derivative of an analytic function.

    If t has a complex step, the imaginary part of the result is the step times its derivative.
    """
    if not np.iscomplexobj(t):
        return function(t + 1j * H).imag / H
    # A difference of complex steps gives the second derivative well enough for Newton's method.
    step = 1e-6
    slopes = [function(t.real + shift + 1j * H).imag / H for shift in (-step, 0.0, step)]
    return slopes[1] + 1j * H * (slopes[2] - slopes[0]) / (2 * step)


def flight(
    s: Any, leaves: Any, gap: Any, speed: Any, amplitude: Any, table: Table = SINE
) -> tuple[Any, Any]:
    """δ and δ′ in a flight with δ″ = -1 - w″, at the time s after the release.

    The release is at the time `leaves` with δ = gap and δ′ = speed.
    """
    height, gained = table.displacement(leaves, s)
    bounce = speed + amplitude * table(leaves, 1)
    return gap + (bounce - s / 2) * s - amplitude * height, speed - s - amplitude * gained


def _longest(times: NDArray) -> float:
    """Maximum of times and 0. The NaN of a ball that stays on the table is ignored."""
    return np.fmax.reduce(times, axis=None, initial=0.0)


def samples_in(ends: NDArray, waves: int = 1) -> NDArray:
    """Fractions of the time, from 0 to 1, at which :func:`turns_back` takes samples."""
    return np.linspace(0, 1, int(np.clip(32 * waves * _longest(ends) / (2 * np.pi), 32, 2000)) + 1)


def turns_back(
    slope: Callable,
    value: Callable,
    ends: NDArray,
    *,
    among: NDArray | None = None,
    waves: int = 1,
    slopes: NDArray | None = None,
) -> NDArray:
    """Return the smallest local minimum of functions of time in (0, ends), but at most `FAR`.

    The result is `FAR` if there is no local minimum.

    Parameters
    ----------
    slope : callable
        Derivative of the function, or an analytic positive multiple of it.
    value : callable
        The function.
    ends : array
        Ends of the intervals.
    among : array, shape (..., m), optional
        Additional times at which the slope is sampled.
    waves : int
        Number of waves in a period of the table. Each wave has 32 samples.
    slopes : array, optional
        Slopes at the samples, if they are already known within small errors.
    """
    times = ends[..., np.newaxis] * samples_in(ends, waves)
    if among is not None:
        times = np.sort(np.concatenate([times, among], axis=-1), axis=-1)
    slopes = slope(times) if slopes is None else slopes
    turns = (slopes[..., :-1] < 0) & (slopes[..., 1:] >= 0)
    if not turns.any():
        return np.full(ends.shape, FAR)
    # The turns of each interval come first. Only those of an interval with several are compared.
    which = np.argsort(~turns, axis=-1, kind="stable")[..., : turns.sum(axis=-1).max()]
    if which.shape[-1] > 1:
        heights = value(np.take_along_axis(times, which + 1, axis=-1))
        heights = np.where(np.take_along_axis(turns, which, axis=-1), heights, np.inf)
        lowest = heights.argmin(axis=-1)[..., np.newaxis]
        which = np.take_along_axis(which, lowest, axis=-1)
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
    """Raised or returned if an orbit does not exist or is not found.

    The message is one line: what was searched for, and why it is missing.
    """


def alone(outcome: Any) -> Any:
    """Return the result for a single ball or orbit, or raise it if it is a reason why none is."""
    if isinstance(outcome, OrbitNotFound | SearchEnded):
        raise outcome
    return outcome


@dataclass(frozen=True, eq=False, repr=False)
class PeriodicOrbit:
    """Periodic orbit.

    Quantities of the impacts are floats for one impact, and arrays of the shape (impacts,)
    otherwise. Velocities are in units of g/Ω, times in units of 1/Ω, and heights in units of g/Ω².
    Velocities are absolute unless their names start with ``relative``.

    Parameters
    ----------
    equations : OrbitEquations
        Equations of the orbit.
    z : ndarray, shape (N,)
        Solution of the equations.
    kind : str
        Kind of a special orbit; "" for an ordinary orbit.
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
            **({"release": "force"} if getattr(self.ball, "release", "") == "force" else {}),
            "phase": self.phase,
            "contact_duration": self.contact_duration,
            "impact_velocity": self.impact_velocity,
            "bounce_velocity": self.bounce_velocity,
            "apparent_restitution": self.apparent_restitution,
            "max_height": self.max_height,
            # Rounding errors would decide on the stability of a special orbit.
            **({} if self.kind else {"stable": self.stable}),
            "admissible": self.admissible or f"no, {self.obstacle}",
            **({} if self.kind or not len(self.others) else {"others": named(self.others)}),
        }
        width = max(map(len, rows))
        return "\n".join(
            [
                type(self).__name__,
                *(f"  {name:{width}}  {_short(row)}" for name, row in rows.items()),
            ]
        )

    @property
    def impacts(self) -> int:
        """Number k of impacts in one period of the orbit."""
        return self.equations.impacts

    @property
    def periods(self) -> int:
        """Number m of periods of the table in one period of the orbit."""
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
        """Ball with the parameters of this orbit."""
        return self._changed[0]

    @property
    def amplitude(self) -> float:
        """Amplitude Λ of the table."""
        return self._changed[1]

    @property
    def table(self) -> Table:
        """Waveform of the table."""
        return self._changed[2]

    @property
    def parameters(self) -> dict[str, float]:
        """Λ, the parameters of ball and table, and others along a branch, such as Ω/√(g/a)."""
        values = {"amplitude": self.amplitude, **self.ball.parameters, **self.table.parameters}
        names = [path.name for path in self.equations.along]
        values |= dict(zip(names, self.z[self.equations.size :], strict=True))
        return {name: float(value) for name, value in values.items()}

    @cached_property
    def _impacts(self) -> NDArray:
        return self.equations.split(self.z[np.newaxis])[0][0]

    def on(self, *paths: Path) -> tuple[OrbitEquations, NDArray]:
        """Return the equations with ``paths`` as the parameters that may change, and the row z."""
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
        """Times at which the ball leaves the table, and δ′ there, shape (impacts,) each."""
        return self._ends.leaves[0], self._ends.speed[0]

    @cached_property
    def _linear(self) -> LinearizedLegs:
        return self.equations.linearized(self.z[np.newaxis])

    def _each(self, values: NDArray) -> float | NDArray:
        """Return a float for one impact, and an array for several."""
        return float(values[0]) if self.impacts == 1 else values

    @property
    def times(self) -> NDArray:
        """Times of the impacts, shape (impacts,)."""
        return self._impacts[:, 0]

    @property
    def speeds(self) -> NDArray:
        """Closing speeds u = -δ′ of the impacts, shape (impacts,)."""
        return self._impacts[:, 1]

    @property
    def scaled_durations(self) -> NDArray:
        """T of the contacts, shape (impacts,); empty for instantaneous impacts."""
        return self._impacts[:, 2:].ravel()

    @property
    def phase(self) -> float | NDArray:
        """Phase of the table at the start of the impact, in (-π, π]."""
        return self._each(np.pi - (np.pi - self.times) % (2 * np.pi))

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
        """δ′ at the start of the impact. It is negative, or positive if a contact resumes."""
        return self._each(-self.speeds)

    @property
    def relative_bounce_velocity(self) -> float | NDArray:
        """δ′ at the end of the contact."""
        return self._each(self._release[1])

    @property
    def impact_velocity(self) -> float | NDArray:
        """Absolute velocity of the ball at the start of the impact, in units of g/Ω."""
        return self._each(self.amplitude * self.table(self.times, 1) - self.speeds)

    @property
    def bounce_velocity(self) -> float | NDArray:
        """Absolute velocity of the ball at the end of the contact, in units of g/Ω."""
        leaves, speed = self._release
        return self._each(self.amplitude * self.table(leaves, 1) + speed)

    @property
    def apparent_restitution(self) -> float | NDArray:
        """r_a = -δ′_b/δ′_i (Eq. 17).

        δ′_b is `relative_bounce_velocity` and δ′_i is `relative_impact_velocity`.
        """
        return self._each(self._release[1] / self.speeds)

    @cached_property
    def max_height(self) -> float:
        """Maximum height of the ball in flights and contacts."""
        return float(self.equations.max_height(self.z[np.newaxis])[0])

    @property
    def monodromy(self) -> NDArray:
        """Derivative of the return map of (τ, δ′) at the first impact, shape (2, 2)."""
        signs = np.diag([1.0, -1.0])
        return signs @ product_of(self._linear.maps)[0] @ signs

    @cached_property
    def trace_and_determinant(self) -> tuple[float, float]:
        """Trace and determinant of the derivative of the return map."""
        trace, determinant = self._linear.trace_and_determinant
        return float(trace[0]), float(determinant[0])

    @property
    def multipliers(self) -> NDArray:
        """Complex Floquet multipliers, shape (2,), in order of decreasing modulus."""
        return multipliers_of(*self.trace_and_determinant)

    @property
    def turn(self) -> float:
        """tr/(1 + det). It is 1 at a saddle-node, -1 at a doubling, maybe infinite at a grazing."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return float(self.equations.turn(self._linear)[0])

    @property
    def stable(self) -> bool:
        """Whether neighbouring motions stay near the orbit.

        Neighbouring motions converge to the orbit, except if the ball is elastic.
        """
        return bool(self.equations.stable(self._linear)[0])

    @property
    def admissible(self) -> bool:
        """Whether a ball follows the orbit.

        A ball follows the orbit if each contact ends at its first release, and each flight at its
        first impact.
        """
        return not self.obstacle

    @cached_property
    def obstacle(self) -> str:
        """Why no ball follows the orbit, such as "a flight passes below the table"; or ""."""
        return str(self.equations.obstacles(self.z[np.newaxis], self._linear)[0])

    @cached_property
    def others(self) -> NDArray:
        """τ and u of other n-T orbits on this side of their saddle-nodes, shape (orbits, 2).

        They are orbits of instantaneous impacts with the r(u) of the ball, at the same Λ: those of
        other closing speeds, and those next to another rise of the table. Orbits of contacts are
        near them; `orbits` finds these. Empty for orbits with several impacts.
        """
        if self.impacts > 1:
            return np.empty((0, 2))
        side = 1 if self.turn < 1 + AT_FOLD else -1
        here = self.ball, self.periods, self.amplitude, self.table
        return other_orbits(*here, self.times[0], self.speeds[0], side)


def other_orbits(
    ball: Ball, n: int, amplitude: float, table: Table, tau: float, u: float, side: int = 1
) -> NDArray:
    """τ and u of other n-T orbits than that of an impact; see :attr:`PeriodicOrbit.others`."""
    speeds = closing_speeds(ball, n)
    orbits = same_side(instants(ball, n, amplitude, table, speeds), ball, table, side)
    orbits = others(orbits, speeds, tau, u)
    if not len(orbits):
        return orbits
    simple = Rigid(np.clip(ball.signature(orbits[:, 1]).restitution, 0, 1))
    equations = OrbitEquations(simple, 1, n, table=table)
    return orbits[equations.admissible(np.insert(orbits, 2, amplitude, axis=1))]


def _short(value: Any) -> str:
    """Text of a value with six digits. At most four entries of an array are shown."""
    if isinstance(value, np.ndarray):
        text = " ".join(f"{number:.6g}" for number in value[:4])
        return f"[{text}{' …' if len(value) > 4 else ''}]"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


class Kind(NamedTuple):
    """Kind of special orbit.

    Attributes
    ----------
    test : callable
        Test function ``test(equations, z, linear)``, which vanishes at special orbits of the kind.
    end : str
        Reason why branches end there; "" if they continue.
    """

    test: Callable[[Any, NDArray, Any], NDArray]
    end: str = ""


KINDS = {
    "saddle-node": Kind(lambda equations, z, linear: 1 - equations.turn(linear)),
    "period doubling": Kind(lambda equations, z, linear: 1 + equations.turn(linear)),
    "Neimark-Sacker": Kind(lambda equations, z, linear: 1 - linear.trace_and_determinant[1]),
    "grazing of a flight": Kind(lambda equations, z, linear: equations.clearance(z)),
    "grazing of a release": Kind(lambda equations, z, linear: equations.contact_clearance(z)),
    "switch of a release": Kind(lambda equations, z, linear: equations.surface_share(z)),
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
}
"""Kinds of special orbits of a branch, by name."""


SINGULAR = slice(3, 6)
"""Part of `OrbitEquations.kinds`: the kinds at which multipliers jump or have poles.

There are no orbits beyond special orbits of these kinds.
"""

CHANGES = {"saddle-node", "period doubling", "Neimark-Sacker"}
"""Kinds of special orbits at which the stability changes."""

MULTIPLIERS = {"saddle-node": 1, "period doubling": -1}
"""Multiplier at special orbits, by kind."""
