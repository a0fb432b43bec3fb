r"""The sweeps that solve the equations of a panel, for many contacts at the same time.

The values of p′ at the Gauss nodes of a panel are found by Picard's iteration; a sweep consists of
three products with one small matrix. The length of the panel that reaches the release is found in
the same sweeps, by Newton's method.

Picard's iteration converges in panels of about a radian of the contact's oscillation. For laws with
m = 1, which are nearly linear, the sweeps are therefore those of Newton's method with the slopes
of the force at the start of the panel, unless derivatives are computed. In the eigenvectors of the
integration over the nodes the linearised equations are one division for each. These panels may be
as long as the nodes resolve. A ball that lies on a contact with m > 1 for many of its oscillations
hardly moves in each of them, so that its sweeps are Newton's, too.

A panel is accepted if the sweeps have converged, if the last Legendre coefficients of the
integrands are small, and if the grip is positive at all nodes; otherwise a shorter panel is tried.
The error at the end of a panel is of the order of the square of these coefficients (Gauss), so
that the errors of D, p and p′ are below 10⁻¹² of their scales. Two limits remain: the grip could
vanish and return between two nodes, which are a small part of an oscillation apart, and the method
cannot prove that a contact never ends.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from bouncing_ball_beyond.models.laws.force_law import ForceLaw
from bouncing_ball_beyond.models.laws.loaded import LoadedLaw, under
from bouncing_ball_beyond.models.laws.panel import (
    IMAGINARY_STEP,
    NODES,
    BallsInContact,
    Panel,
    Slopes,
    Start,
    gauss_rule,
    grip_of,
    lever_of,
    load_of,
    slopes_of,
)


class _Kind(NamedTuple):
    """The settings of a kind of sweeps.

    ``look`` is the first sweep that computes the end of the panel. ``patient`` is the number of
    sweeps for which all panels are waited for. ``early`` is the sweep whose change of p′ determines
    the length of the next panel. ``spectrum`` bounds the last Legendre coefficients of the
    integrands over V or P/V, and ``longer`` the ratio of successive lengths.
    """

    look: int
    patient: int
    early: int
    spectrum: float
    longer: float


# Newton's sweeps in which a panel's end is found are about twice as many as those of the other
# panels, and are waited for. The panels of Newton's sweeps are limited by the spectrum, those of
# Picard's by the convergence; with 1e-6 for both, Newton's would miss more short losses of the
# grip.
_PICARD = _Kind(look=2, patient=0, early=5, spectrum=1e-6, longer=1.3)
_NEWTON = _Kind(look=1, patient=8, early=2, spectrum=1e-9, longer=2.0)
LONGER = _PICARD.longer
"""The largest ratio of the lengths of successive panels with Picard's sweeps."""
# The largest number of sweeps; the change of p′ over V at which they stop; and the change at
# which a panel is still accepted, because the next change would be a hundredth of it.
_SWEEPS = 22
_SETTLED = 3e-13
_ENOUGH = 1e-12
# The sweeps stop when this share of the panels has converged: the few others are tried again,
# because they would delay all panels.
_MOST = 0.95
# The remainder of the grip, or of the time, relative to its change over the panel, up to which a
# first-order correction suffices.
_REACHED = 1e-12
# The unit of a remaining time, over P/V.
_OF_TIME = 1e-4
# The change of p′ over V that is wanted in the early sweep.
_CHANGE = 1e-3
# The longest panel of Newton's sweeps, in radians of the linearised oscillation without damping:
# neighbouring nodes are then at most a fifth of an oscillation apart.
_LONGEST = 3 * np.pi
# The decay, in powers of e, after which the oscillation since the impact is lost in rounding, so
# that the nodes need not resolve it; the spectrum still limits the panel.
_CALM = -np.log(np.finfo(float).eps)
# Smallest ratio of successive lengths and its safety factor; the greatest ratio after a rejected
# panel.
_SHORTER = 0.3
_SAFETY = 0.9
_AGAIN = 0.6


@lru_cache(maxsize=1)
def _modes() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The eigenvalues of the integration from node to node, one of each pair, and two matrices:
    from values at the nodes to coordinates in the eigenvectors, and back to nodes and end.
    """
    rule = gauss_rule(NODES)
    value, vector = np.linalg.eig(rule.integral[:-1])
    one = value.imag > 0
    back = np.vstack([vector, rule.end @ vector])[:, one]
    return value[one, np.newaxis], np.linalg.inv(vector)[one], 2 * back


def _excess(slopes: Slopes, step: np.ndarray, change: np.ndarray) -> np.ndarray:
    """The part of the change of p′ in Picard's sweep that Newton's method does not make.

    The linearised equations with constant slopes turn a change c of p′ at the nodes into
    ``(1 + h f_u Q + h² f_p Q²)⁻¹ c``, where hQ is the integration from node to node. The result
    is the difference, at the nodes and at the end.
    """
    value, into, back = _modes()
    ratio = value * (step * slopes.by_rate + value * (step * step * slopes.by_penetration))
    return (back @ (ratio / (1 + ratio) * (into @ change))).real


class Sweeps:
    """The sweeps that compute the next panel of each ball.

    Parameters
    ----------
    law : ForceLaw
    start : Start
    now : BallsInContact
        The states at the start of the panels.
    until : array or None
        Times at which the panels end at the latest. If they are given, releases are not looked for.
    count : int
        Number of nodes.
    m : int, optional
        The root of the independent variable. With 1 it is plain time; by default it is that of the
        law.
    linearised : bool
        Whether the sweeps of a law with m > 1 are Newton's, in plain time.
    """

    def __init__(
        self,
        law: ForceLaw,
        start: Start,
        now: BallsInContact,
        until: np.ndarray | None,
        count: int = NODES,
        m: int = 0,
        *,
        linearised: bool = False,
    ) -> None:
        self.m = m or law.root
        self.law = law
        # Whether the contact may end at p = 0 before the grip vanishes.
        self.also_at_surface = isinstance(law, LoadedLaw)
        if isinstance(law, LoadedLaw) and law.has_kink:
            self.law = law.continued(now.root**self.m, now.side)
        self.start = start
        self.now = now
        self.until = until
        self.rule = gauss_rule(count)
        size = now.step.size
        # These arrays are overwritten in each sweep, because allocating them again would take as
        # long as the computation.
        self.root = np.empty((count + 1, size))
        self.time = np.empty((count + 1, size))
        self.old_rate = np.empty((count + 1, size))
        self.rate = np.empty((count + 1, size))
        self.push = np.empty((count, size))
        self.lever = np.ones_like(self.push)
        self.rate[:-1] = now.rate + self.rule.node * (now.step * now.push)
        self.last = np.zeros(size, dtype=bool)
        # Which of the functions that are positive up to the end of a panel vanishes first, the
        # length that the panel still lacks, and whether its end is reached.
        self.first = np.zeros(size, dtype=int)
        self.missing = np.zeros(size)
        self.reached = np.ones(size, dtype=bool)
        self.step = now.step
        self.next_step = now.step
        # Derivatives need short panels, for which Picard's sweeps suffice.
        self.is_newton = (law.root == 1 and count == NODES) or linearised
        self.kind = _NEWTON if self.is_newton else _PICARD
        # Under any load at first, because the slopes need not be exact.
        self.loaded = under(self.law, start.weight)
        if self.is_newton:
            self.slopes = slopes_of(self.loaded.force, now.root, now.rate)

    def panel(self) -> Panel:
        """The panels, after as many sweeps as most of them need."""
        for sweep in range(_SWEEPS):
            self._sweep(is_first=sweep == 0)
            if sweep < self.kind.look:
                continue
            if self.is_newton and sweep == self.kind.look:
                self._shorten()
                continue
            self._aim()
            if sweep < self.kind.early:
                continue
            self._compare(is_early=sweep == self.kind.early)
            share = _MOST if sweep > self.kind.patient else 1.0
            settled = self.reached & (self.change <= _SETTLED)
            if np.count_nonzero(settled) >= share * settled.size:
                break
        self._correct()
        return self._result()

    def _sweep(self, is_first: bool) -> None:
        """New values of p′ from the old ones, by integrating q, t and F over the panel."""
        self.old_rate, self.rate = self.rate, self.old_rate
        rate = self.old_rate[:-1]
        inside = self.root[:-1]
        # If the length of the panel has changed, the nodes have moved.
        moved = self.next_step is not self.step
        if moved:
            rate += self.rule.node * ((self.next_step - self.step) * self.push)
        self.step = self.next_step
        self._integrate(self.now.root, rate, self.root)
        # In plain time, m = 1, these arrays change only if the nodes have moved.
        if self.m > 1 or moved or is_first:
            lever_of(self.m, inside, self.lever)
            self._integrate(self.now.time, self.lever, self.time)
            self.load = load_of(self.start, self.time[:-1])
            self.loaded = under(self.law, self.load)
        if self.m > 1:
            np.subtract(self.load, self.loaded.root_force(inside, rate), out=self.push)
            self.push *= self.lever
        else:
            np.subtract(self.load, self.loaded.force(inside, rate), out=self.push)
        self._integrate(self.now.rate, self.push, self.rate)
        if self.is_newton:
            self.rate -= _excess(self.slopes, self.step, self.rate[:-1] - rate)
            self.root[-1] = self.now.root + self.step * (self.rule.integral[-1] @ self.rate[:-1])

    def _integrate(self, begin: np.ndarray, values: np.ndarray, out: np.ndarray) -> None:
        """Write the value at the start plus the integral of a rate, up to each node and the end."""
        np.matmul(self.rule.integral, values, out=out)
        out *= self.step
        out += begin

    def _loaded_at(self, time: np.ndarray) -> ForceLaw:
        """The law under the load at these times."""
        # Most laws are the same under any load, which need not be computed for them.
        if self.loaded is self.law:
            return self.law
        return under(self.law, load_of(self.start, time))

    def ahead(self, root: np.ndarray, rate: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Functions that are positive up to the end of a panel, one in each row.

        The rows are the grip, or the time that is left; q if the contact may also end at p = 0; and
        the law's kink function, with its sign at the start.
        """
        law = self.law
        if self.until is None:
            rows = [grip_of(self._loaded_at(time), self.m, root, rate)]
            if self.also_at_surface:
                rows.append(root)
        else:
            rows = [self.until - time]
        if law.has_kink:
            rows.append(self.now.side * law.kink(root**self.m, rate))
        return np.array(rows)

    def left(
        self, root: np.ndarray, rate: np.ndarray, time: np.ndarray, final: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """These functions at the end of a panel, and their derivatives along the motion with
        respect to s. ``final`` is F at the end.
        """
        found = self.ahead(
            root + IMAGINARY_STEP * rate,
            rate + IMAGINARY_STEP * final,
            time + IMAGINARY_STEP * lever_of(self.m, root),
        )
        return found.real, found.imag / IMAGINARY_STEP.imag

    def _shorten(self) -> None:
        """End each panel at the first node beyond its end.

        Newton's method for the end starts there; otherwise several sweeps would be spent on halving
        a long panel.
        """
        ahead = self.ahead(self.root[:-1], self.old_rate[:-1], self.time[:-1])
        inside = (ahead > 0).all(axis=0)
        self.next_step = self.step * np.where(inside, 1.0, self.rule.node).min(axis=0)
        self.last = self.next_step < self.step

    def _aim(self) -> None:
        """A step of Newton's method for the length of the panels that reach their end."""
        left = self.ahead(self.root[-1], self.rate[-1], self.time[-1])
        self.functions = len(left)
        self.last |= (left <= 0).any(axis=0)
        # Most panels end within the contact, so that no slopes are needed.
        if not self.last.any():
            return
        final = self.rule.end @ self.push
        left, falls = self.left(self.root[-1], self.rate[-1], self.time[-1], final)
        without_fall = np.where(left > 0, np.inf, -self.step)
        distance = np.where(falls < 0, -left / falls, without_fall)
        self.first = distance.argmin(axis=0)
        column = np.arange(self.first.size)
        missing = distance[self.first, column]
        fall = falls[self.first, column]
        if self.until is None:
            unit = np.abs(fall) * self.step
        else:
            unit = _OF_TIME * self.now.length / self.now.speed
        self.reached = ~self.last | (np.abs(missing * fall) <= _REACHED * unit)
        half = self.step / 2
        self.missing = np.where(self.last, np.maximum(np.minimum(missing, half), -half), 0.0)
        self.next_step = self.step + self.missing

    def _compare(self, is_early: bool) -> None:
        """The largest change of p′ over V at the nodes; the old values are overwritten."""
        rate = self.old_rate[:-1]
        rate -= self.rate[:-1]
        self.change = np.abs(rate, out=rate).max(axis=0) / self.now.speed
        if is_early:
            self.early_change = self.change

    def _correct(self) -> None:
        """Correct the ends of the panels for the missing lengths, to first order.

        At the end of a short panel, or where the grip vanishes slowly, rounding of the load may
        keep the missing length above its bound.
        """
        time = self.now.length ** (1 / self.m) / self.now.speed
        unit = np.maximum(time, self.time[-1]) if self.m == 1 else time
        self.reached |= np.abs(self.missing) <= _REACHED * unit
        self.root[-1] += self.rate[-1] * self.missing
        self.time[-1] += lever_of(self.m, self.root[-1]) * self.missing
        self.final = self.rule.end @ self.push
        self.rate[-1] += self.final * self.missing

    def _result(self) -> Panel:
        law = self.law
        until = self.until
        none = np.zeros_like(self.last)
        # The kink function is the last of the functions, and q the second.
        turned = self.last & (self.first == self.functions - 1) if law.has_kink else none
        surfaced = self.first == 1 if self.also_at_surface and until is None else none
        error = self._error()
        good = self.reached & self._held() & (self.change <= _ENOUGH)
        good &= error <= self.kind.spectrum
        released = self.last & ~turned
        surfaced = surfaced & ~turned
        # Just below p = 0, at a rounding error, the positive grip would hold the ball again.
        self.root[-1, released & surfaced] = 0.0
        return Panel(
            root=self.root,
            rate=self.rate,
            time=self.time,
            push=self.push,
            final=self.final,
            step=self.step,
            following=self._following(good, turned, error),
            good=good,
            last=released,
            surfaced=surfaced,
            turned=turned,
        )

    def _error(self) -> np.ndarray:
        """The largest of the last Legendre coefficients of the integrands, over V or P/V."""
        by_rate = np.abs(self.rule.tail @ self.push).max(axis=0)
        by_time = np.abs(self.rule.tail @ self.lever).max(axis=0)
        speed = self.now.speed
        return np.maximum(by_rate / speed, by_time * speed / self.now.length) * self.step

    def _held(self) -> np.ndarray:
        """Whether the law holds the ball at all nodes, on one side of its kink."""
        law = self.law
        inside = self.root[:-1]
        grip = grip_of(self.loaded, self.m, inside, self.rate[:-1])
        held = ((inside > 0) & (grip > 0)).all(axis=0)
        if law.has_kink:
            # A sign that changes twice within a panel is not seen at its end. A panel up to a given
            # time may be so short that the sign is determined by rounding.
            kink = self.now.side * law.kink(inside**self.m, self.rate[:-1])
            smooth = (kink > 0).all(axis=0)
            held &= smooth if self.until is None else smooth | self.last
        return held

    def _is_calm(self) -> np.ndarray:
        """Whether the contact's oscillation has decayed since its start to rounding.

        The slower root of s² + f_u s + f_p decides, with the slopes f_u and f_p of the force.
        """
        half = self.slopes.by_rate / 2
        oscillates = self.slopes.by_penetration >= half * half
        root = np.sqrt(np.maximum(half * half - self.slopes.by_penetration, 0.0))
        return np.where(oscillates, half, half - root) * self.now.time > _CALM

    def _following(self, good: np.ndarray, turned: np.ndarray, error: np.ndarray) -> np.ndarray:
        """The lengths of the next panels, from the errors and the convergence of these."""
        kind = self.kind
        by_convergence = (self.early_change / _CHANGE) ** (-1 / (2 * kind.early))
        by_error = (error / kind.spectrum) ** (-1 / len(self.push))
        ratio = np.nan_to_num(np.minimum(by_error, by_convergence))
        factor = np.clip(_SAFETY * ratio, _SHORTER, kind.longer)
        if self.is_newton:
            longest = _LONGEST / np.sqrt(np.abs(self.slopes.by_penetration))
            longest = np.where(self._is_calm(), np.inf, longest)
            factor = np.where(turned, 1.0, np.fmin(factor, longest / self.step))
        # The length of a panel that ends at a kink is unrelated to that of the next panel.
        taken = np.where(turned, self.now.step, self.step)
        return np.where(good, taken * factor, self.now.step * np.minimum(factor, _AGAIN))
